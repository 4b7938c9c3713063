//! A small body on the line: a clump weight, a buoy, a point mass.
//!
//! ```text
//! R = m r̈ + φ A (r̈ - V̇) + (m g - φ b) e_z - φ b V̇/g - φ ½ ρ S |q| q - push N,   q = V - ṙ,   b = ρ g Ω
//! φ = ¼ (1 - ζ)² (2 + ζ),   ζ = 2 z/d within [-1, 1]
//! ```
//!
//! R force to be applied from outside [N]; m mass [kg], A added mass [kg], Ω displaced volume [m³], S drag coefficient times area
//! [m²], V velocity [m/s] and V̇ acceleration [m/s²] of the water; φ wet share of a sphere of diameter d [m] whose centre is z above
//! the water. The body counts as a sphere of its volume, so that it floats at a draught and crosses the surface without a jump. The bed
//! pushes as it does on a line (`seabed`), with a stiffness in N/m. As for lines, the tangent leaves out that waves change from place
//! to place.

use crate::algebra::triple::{Triple, length};
use crate::rod::morison::{PointMotion, Water};
use crate::rod::motion::{Motion, Weights};
use crate::rod::seabed::{Plane, Resistance, projector};
use crate::rod::stretch::Direction;
use nalgebra::{Matrix3, Vector3};

/// The body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Node that carries it.
    pub node: usize,
    /// m [kg].
    pub mass: f64,
    /// A [kg].
    pub added_mass: f64,
    /// m g [N].
    pub weight: f64,
    /// b [N].
    pub buoyancy: f64,
    /// ½ ρ S [kg/m].
    pub drag: f64,
    /// d [m] where the water has a surface.
    pub diameter: Option<f64>,
    /// The bed and its resistance [N/m, N·s/m], where there is one.
    pub bed: Option<(Plane, Resistance)>,
}

impl Body {
    /// Weight less buoyancy under water [N].
    pub fn net_weight(&self) -> f64 {
        self.weight - self.buoyancy
    }

    /// Force R to be applied from outside for a motion [N].
    pub fn force<W: Water>(&self, water: &W, at: &Motion) -> Vector3<f64> {
        let point = self.point(at);
        let (r, v) = (Vector3::from(point.place), Vector3::from(point.velocity));
        let (wet, _) = self.wet(water, &point);
        let mut force = Vector3::from(point.acceleration) * self.mass + self.of_water(water, &point) * wet;
        force.z += self.weight;
        if let Some((plane, resistance)) = &self.bed {
            force -= plane.normal * resistance.push(plane.height(&r), plane.normal.dot(&v));
        }
        force
    }

    /// c_u ∂R/∂u + c_v ∂R/∂v + c_a ∂R/∂a.
    pub fn tangent<W: Water>(&self, water: &W, at: &Motion, weights: &Weights) -> Matrix3<f64> {
        let point = self.point(at);
        let (r, v) = (Vector3::from(point.place), Vector3::from(point.velocity));
        let (wet, by_height) = self.wet(water, &point);
        let q = Vector3::from(water.past((), &point).velocity);
        let speed = length(&q);
        let by_flow = (Matrix3::identity() * speed + q * q.transpose() / speed) * (self.drag * wet);
        let rising = self.of_water(water, &point) * by_height - by_flow * Vector3::from(water.shear((), r.z));
        let mut sum = Matrix3::identity() * (weights.a * (self.mass + self.added_mass * wet));
        sum += by_flow * weights.v + rising * Vector3::z().transpose() * weights.u;
        if let Some((plane, resistance)) = &self.bed {
            let (by_position, by_rate) = resistance.tangent(plane.height(&r), plane.normal.dot(&v));
            sum -= projector(&plane.normal) * (by_position * weights.u + by_rate * weights.v);
        }
        sum
    }

    /// Mass that the body brings to its node, as if it were under water [kg].
    pub fn inertia(&self) -> f64 {
        self.mass + self.added_mass
    }

    /// Motion of the body as a point of the line; its direction has no part in what follows.
    fn point(&self, at: &Motion) -> PointMotion<f64> {
        PointMotion {
            clock: at.clock,
            direction: Direction::of(Triple::from(Vector3::x())),
            place: at.u.position(self.node).into(),
            velocity: at.v.position(self.node).into(),
            acceleration: at.a.position(self.node).into(),
        }
    }

    /// What the water asks for if the body is all wet [N].
    fn of_water<W: Water>(&self, water: &W, point: &PointMotion<f64>) -> Vector3<f64> {
        let past = water.past((), point);
        let (q, swell) = (Vector3::from(past.velocity), Vector3::from(past.acceleration));
        let mut force = Vector3::from(point.acceleration) * self.added_mass - q * (self.drag * q.norm());
        if W::WAVES {
            force -= swell * (self.added_mass + self.buoyancy / water.gravity());
        }
        force.z -= self.buoyancy;
        force
    }

    /// φ [-] and its change with height [1/m].
    fn wet<W: Water>(&self, water: &W, point: &PointMotion<f64>) -> (f64, f64) {
        let Some(diameter) = self.diameter else { return (1.0, 0.0) };
        let height = point.place.z - water.elevation(&point.clock, &point.place.into());
        let zeta = (2.0 * height / diameter).clamp(-1.0, 1.0);
        (0.25 * (1.0 - zeta) * (1.0 - zeta) * (2.0 + zeta), -1.5 * (1.0 - zeta * zeta) / diameter)
    }
}
