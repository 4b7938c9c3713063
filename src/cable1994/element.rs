//! The mixed element of the 1994 report: cubic position, quadratic effective tension λ as an unknown of its own.
//!
//! ```text
//! M_ik Ü_k = c_i,   c_i = μ_im q_m L - (α_ikm B_m/L³ + β_ikm λ_m/L) U_k + mat                          (2.16a)
//! d_m = ½ (τ_m L + 2 η_lm ε_l L - β_ikm U_i·U_k/L) = 0,   ε = (λ - p_f A_f)/EA,   r'·r' = 1 + 2 ε      (2.16b)
//! q = -w e_z + ½ ρ d C_n |N v| N v,   v = V - ṙ,   M = m I + ρ (π/4) d² C_m N,   N = I - r' r'ᵀ        (2.8, 2.10)
//! ```
//!
//! λ effective tension divided by |r'| [N]: the force in the line is λ r'. p_f A_f the pressure of still water on the section [N],
//! left out where the scene does not ask for it. q and M are taken at x = 0, ½ and 1 and are quadratic between. N is the
//! report's, without the division by r'·r'. Signs are those of the listing (docs/cable-1994.md names the misprints).

use crate::algebra::shape::Shape;
use crate::cable1994::mat::{self, Push};
use crate::cable1994::shapes::{Integrals, Triad};
use crate::rod::properties::Properties;
use crate::rod::seabed::{Plane, Resistance};
use crate::rod::state::Field;
use crate::sea::current::Current;
use nalgebra::{Matrix3, Vector3};

/// Shape functions at x = 0, ½ and 1, where loads are taken.
const STATIONS: [Shape; 3] = [Shape::at(0.0), Shape::at(0.5), Shape::at(1.0)];

/// An element and what it is made of.
#[derive(Debug, Clone)]
pub struct Element {
    /// Unstretched length [m].
    pub length: f64,
    /// Its material.
    pub properties: Properties,
    /// ρ g A_f [N/m]: tension that the water's pressure takes from the strain, per metre of depth; 0 leaves it out.
    pub pressure: f64,
    /// The mat under it.
    pub mat: Option<(Plane, Resistance)>,
}

/// Ends of an element, or their rates: (r_0, L r_0', r_1, L r_1').
pub type Ends = [Vector3<f64>; 4];

/// An element at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Instant {
    /// U.
    pub u: Ends,
    /// dU/dt.
    pub v: Ends,
    /// λ at both ends and in the middle.
    pub tension: [f64; 3],
}

/// What an element adds to the equations.
#[derive(Debug, Clone)]
pub struct Terms {
    /// c_i [N].
    pub force: Ends,
    /// d_m [m].
    pub strain: [f64; 3],
    /// -∂c_i/∂U_k = K_ik I (the mat aside) [N/m].
    pub stiffness: [[f64; 4]; 4],
    /// The mat.
    pub push: Push,
    /// M_ik [kg].
    pub mass: [[Matrix3<f64>; 4]; 4],
    /// -∂c_i/∂λ_m = -∂d_m/∂U_i = β_ikm U_k/L.
    pub coupling: [[Vector3<f64>; 3]; 4],
    /// ∂d_l/∂λ_m = η_lm L/EA [m/N].
    pub compliance: [[f64; 3]; 3],
    /// ∂d_m/∂z_k by the water's pressure [-].
    pub squeeze: [[f64; 3]; 4],
}

/// The ends of element `e` of a field.
pub fn ends(field: &Field, e: usize, length: f64) -> Ends {
    [field.position(e), field.slope(e) * length, field.position(e + 1), field.slope(e + 1) * length]
}

/// The same seen from r_0, so that a place far from the origin costs no digits.
fn seen_from_first(u: &Ends) -> Ends {
    [Vector3::zeros(), u[1], u[2] - u[0], u[3]]
}

fn sum(ends: &Ends, n: &[f64; 4]) -> Vector3<f64> {
    ends[0] * n[0] + ends[1] * n[1] + ends[2] * n[2] + ends[3] * n[3]
}

fn weighted(triad: &Triad, m: &[f64; 3], factor: f64) -> [[f64; 4]; 4] {
    triad.map(|row| row.map(|psi| (psi[0] * m[0] + psi[1] * m[1] + psi[2] * m[2]) * factor))
}

impl Element {
    /// Terms for forces and strains of `now`, and with K and its coupling to λ of `half`; in statics the two are one.
    pub fn terms(&self, integrals: &Integrals, current: Option<&Current>, now: &Instant, half: &Instant) -> Terms {
        let (p, l) = (&self.properties, self.length);
        let stations = STATIONS.map(|shape| Station::at(p, l, current, now, &shape));
        let bending = weighted(&integrals.bending, &[p.ei; 3], 1.0 / (l * l * l));
        let pull = |tension: &[f64; 3]| weighted(&integrals.stretch, tension, 1.0 / l);
        let (taut, taut_half) = (pull(&now.tension), pull(&half.tension));
        let push = self.mat.as_ref().map_or(Push::default(), |(plane, mat)| mat::push(plane, mat, l, &now.u));
        let mut terms = Terms {
            force: [Vector3::zeros(); 4],
            strain: self.strain(integrals, now, &stations),
            stiffness: taut_half,
            push,
            mass: [[Matrix3::zeros(); 4]; 4],
            coupling: [[Vector3::zeros(); 3]; 4],
            compliance: integrals.strain.map(|row| row.map(|eta| eta * l / p.ea)),
            squeeze: self.squeeze(integrals, &stations),
        };
        let (u, u_half) = (seen_from_first(&now.u), seen_from_first(&half.u));
        for i in 0..4 {
            terms.force[i].z += push.force[i];
            for (m, station) in stations.iter().enumerate() {
                terms.force[i] += station.load * (integrals.load[i][m] * l);
                terms.coupling[i][m] = (0..4).map(|k| u_half[k] * (integrals.stretch[i][k][m] / l)).sum();
            }
            for k in 0..4 {
                terms.stiffness[i][k] += bending[i][k];
                terms.force[i] -= u[k] * (taut[i][k] + bending[i][k]);
                for (m, station) in stations.iter().enumerate() {
                    terms.mass[i][k] += station.mass * (integrals.mass[i][k][m] * l);
                }
            }
        }
        terms
    }

    fn strain(&self, integrals: &Integrals, now: &Instant, stations: &[Station; 3]) -> [f64; 3] {
        let (l, ea, u) = (self.length, self.properties.ea, seen_from_first(&now.u));
        let strain: [f64; 3] = std::array::from_fn(|m| (now.tension[m] + self.pressure * stations[m].height.min(0.0)) / ea);
        std::array::from_fn(|m| {
            let stretched: f64 = (0..4)
                .flat_map(|i| (0..4).map(move |k| (i, k)))
                .map(|(i, k)| integrals.stretch[i][k][m] * u[i].dot(&u[k]) / l)
                .sum();
            let free: f64 = (0..3).map(|n| integrals.strain[n][m] * strain[n]).sum();
            0.5 * (integrals.unit[m] * l + 2.0 * free * l - stretched)
        })
    }

    fn squeeze(&self, integrals: &Integrals, stations: &[Station; 3]) -> [[f64; 3]; 4] {
        let per_metre = self.pressure * self.length / self.properties.ea;
        let wet = |n: &usize| stations[*n].height < 0.0;
        std::array::from_fn(|k| {
            std::array::from_fn(|m| (0..3).filter(wet).map(|n| integrals.strain[n][m] * STATIONS[n].value[k] * per_metre).sum())
        })
    }
}

/// Loads at one place of an element.
struct Station {
    /// z [m].
    height: f64,
    /// q [N/m].
    load: Vector3<f64>,
    /// M [kg/m].
    mass: Matrix3<f64>,
}

impl Station {
    fn at(p: &Properties, length: f64, current: Option<&Current>, now: &Instant, shape: &Shape) -> Station {
        let height = sum(&now.u, &shape.value).z;
        let slope = sum(&now.u, &shape.slope) / length;
        let normal = Matrix3::identity() - slope * slope.transpose();
        let flow = current.map_or(Vector3::zeros(), |current| current.velocity(height));
        let across = normal * (flow - sum(&now.v, &shape.value));
        let load = across * (p.drag_normal * across.norm()) - Vector3::z() * p.weight;
        Station { height, load, mass: Matrix3::identity() * p.mass + normal * p.added_normal }
    }
}
