//! The seabed: a plane bed of springs and dampers that pushes, never pulls.
//!
//! ```text
//! f = max(0, k p - c v_n min(1, p/δ)) N,   p = δ_0 - g > 0,   g = N·(r - r_b)
//! ```
//!
//! N unit normal of the bed, upwards; g height above it [m]; v_n = N·ṙ [m/s]; k stiffness [Pa]; c damping [Pa·s]; f force on
//! the line per unstretched length [N/m]. Contact starts δ_0 = w N_z / k above the bed, so that a line at rest lies exactly on
//! it; δ = max(δ_0, d/10) eases the damper in. On an element g is a cubic, so its touching part is found exactly and integrated
//! with four Gauss points, which are exact for the spring. Where the bed has neither damping nor friction and an element touches all
//! along, the push on its ends is linear in p there:
//!
//! ```text
//! R = -k L M p N,   M_ij = ∫ N_i N_j dx
//! ```

use crate::algebra::polynomial::{Cubic, Intervals};
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::triple::Triple;
use crate::rod::ends::Ends;
use crate::scene::types::Environment;
use nalgebra::{Matrix3, Vector3};

/// The plane of the bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal, upwards.
    pub normal: Vector3<f64>,
    /// N·r_b of a point of the bed [m].
    pub offset: f64,
}

/// Resistance of the bed against one line type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resistance {
    /// k [Pa].
    pub stiffness: f64,
    /// c [Pa·s].
    pub damping: f64,
    /// δ_0 [m].
    pub onset: f64,
    /// δ [m].
    pub easing: f64,
}

impl Plane {
    /// The bed of an environment: z = -depth + x tan(a) + y tan(b).
    pub fn of(environment: &Environment) -> Plane {
        let [a, b] = environment.seabed.slope_deg.map(|angle| angle.to_radians().tan());
        let normal = Vector3::new(-a, -b, 1.0).normalize();
        Plane { normal, offset: -environment.depth * normal.z }
    }

    /// Height above the bed, along its normal [m].
    pub fn height(&self, r: &Vector3<f64>) -> f64 {
        self.normal.dot(r) - self.offset
    }

    /// z of the bed under or above a point [m].
    pub fn level(&self, x: f64, y: f64) -> f64 {
        (self.offset - self.normal.x * x - self.normal.y * y) / self.normal.z
    }

    /// Height above the bed along an element with end positions r and end slopes times length l.
    #[inline(always)]
    pub fn profile(&self, r0: &Vector3<f64>, l0: &Vector3<f64>, r1: &Vector3<f64>, l1: &Vector3<f64>) -> Cubic {
        Cubic::hermite(self.height(r0), self.normal.dot(l0), self.height(r1), self.normal.dot(l1))
    }
}

impl Resistance {
    /// The parts of an element that touch, given its height above the bed.
    pub fn touching(&self, profile: &Cubic) -> Intervals {
        Cubic(profile.0.map(|g| self.onset - g)).parts_above(0.0)
    }

    /// Size of the push [N/m] at height g [m] with normal velocity v [m/s].
    pub fn push(&self, g: f64, v: f64) -> f64 {
        let penetration = self.onset - g;
        if penetration <= 0.0 {
            // Clear of the bed, nothing of the damper is left either.
            return 0.0;
        }
        (self.stiffness * penetration - self.damping * v * (penetration / self.easing).min(1.0)).max(0.0)
    }

    /// ∂push/∂r = (returned.0) Nᵀ and ∂push/∂ṙ = (returned.1) Nᵀ, as multiples of N Nᵀ.
    pub fn tangent(&self, g: f64, v: f64) -> (f64, f64) {
        let penetration = self.onset - g;
        let eased = penetration / self.easing;
        if self.push(g, v) <= 0.0 {
            (0.0, 0.0)
        } else if eased < 1.0 {
            (-self.stiffness + self.damping * v / self.easing, -self.damping * eased)
        } else {
            (-self.stiffness, -self.damping)
        }
    }
}

/// N Nᵀ.
pub fn projector(normal: &Vector3<f64>) -> Matrix3<f64> {
    normal * normal.transpose()
}

/// ∫ N_i N_j dx of the Hermite functions of an element of unit length, times 420.
pub const PRODUCTS: [[f64; 4]; 4] =
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]];

/// Tangent of the push on the ends of an element that touches an undamped bed all along, as multiples of N Nᵀ.
pub fn grounded_tangent(stiffness: f64, length: f64) -> [[f64; 4]; 4] {
    let lever = [1.0, length, 1.0, length];
    std::array::from_fn(|k| std::array::from_fn(|l| stiffness * length * PRODUCTS[k][l] * lever[k] * lever[l] / 420.0))
}

/// Push on the ends of an element that touches an undamped bed all along [N, N·m], given end values and slopes of its penetration p by x [m]:
/// how much of it there is along N.
pub fn grounded_push(stiffness: f64, length: f64, p: &[f64; 4]) -> [f64; 4] {
    let scale = stiffness * length / 420.0;
    PRODUCTS.map(|row| scale * (0..4).map(|l| row[l] * p[l]).sum::<f64>())
}

/// A row with one number per element, padded for batches.
pub fn row(count: usize, of: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut row = vec![0.0; padded(count + 1) + MOST_LANES];
    row.iter_mut().zip(0..count).for_each(|(to, e)| *to = of(e));
    row
}

/// Σ a_k b_k.
#[inline(always)]
pub fn combined<F: Real>(a: &[f64; 4], b: &[F; 4]) -> F {
    b[0].scale_add(a[0], b[1].scale_add(a[1], b[2].scale_add(a[2], b[3] * a[3])))
}

/// How deep elements are in the bed, side by side.
#[derive(Debug, Clone, Copy)]
pub struct Depth<F> {
    /// Penetrations at the Bézier control points [m].
    control: [F; 4],
    /// Largest of them [m].
    pub most: F,
    /// Smallest of them [m].
    pub least: F,
}

impl<F: Real> Depth<F> {
    /// Of elements from `e` on in a plane, with a row of onsets δ_0 [m].
    #[inline(always)]
    pub fn of(cpu: F::Cpu, plane: &Plane, onset: &[f64], u: &Ends<F>, e: usize) -> Depth<F> {
        let level = F::load(cpu, onset, e) + plane.offset;
        let control = u.control_values(&plane.normal).map(|g| level - g);
        let most = control[0].max(control[1]).max(control[2].max(control[3]));
        let least = control[0].min(control[1]).min(control[2].min(control[3]));
        Depth { control, most, least }
    }

    /// End values and slopes [m].
    #[inline(always)]
    pub fn ends(&self) -> [F; 4] {
        let c = &self.control;
        [c[0], (c[1] - c[0]) * 3.0, c[3], (c[3] - c[2]) * 3.0]
    }
}

/// A bed of springs alone, as the fast loop sees it: rows with one number per element. One that dissipates is in `lying`.
#[derive(Debug, Clone)]
pub struct Bed {
    plane: Plane,
    onset: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Bed {
    /// A plane of springs under each element.
    pub fn new(plane: Plane, resistance: &[Resistance]) -> Bed {
        let count = resistance.len();
        Bed { plane, onset: row(count, |e| resistance[e].onset), stiffness: row(count, |e| resistance[e].stiffness) }
    }

    /// Adds the push on those elements from `e` on that touch the bed all along; returns a number that is positive
    /// for those that may touch otherwise.
    #[inline(always)]
    pub fn add_grounded<F: Real>(&self, cpu: F::Cpu, u: &Ends<F>, measure: F, e: usize, sum: &mut [Triple<F>; 4]) -> F {
        let normal = &self.plane.normal;
        let depth = Depth::of(cpu, &self.plane, &self.onset, u, e);
        if depth.most.any_positive() {
            let grounded = depth.least.step();
            let scale = F::load(cpu, &self.stiffness, e) * measure * grounded * (-1.0 / 420.0);
            let p = depth.ends();
            for (sum, row) in sum.iter_mut().zip(&PRODUCTS) {
                let push = scale * combined(row, &p);
                *sum = Triple::splat(cpu, normal).mul_add(push, *sum);
            }
            return depth.most.min(-depth.least) * measure;
        }
        F::splat(cpu, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clear of the bed nothing pushes, however fast it rises or falls; touching it, a push never pulls, and it grows from nothing. Heights
    /// up to a thousand times the easing, speeds up to 20 m/s; a step of 1e-9 m into the bed pushes by no more than its spring and damper can.
    #[test]
    fn what_is_clear_of_the_bed_is_not_pushed() {
        let resistance = Resistance { stiffness: 4.8e5, damping: 4.8e4, onset: 0.02, easing: 0.1 };
        for v in [-20.0, -1.0, -1e-3, 0.0, 1e-3, 0.3, 1.0, 20.0] {
            for above in [1e-12, 1e-3, 0.1, 1.0, 7.0, 100.0] {
                let g = resistance.onset + above;
                assert_eq!(resistance.push(g, v), 0.0, "{above} m above, {v} m/s");
                assert_eq!(resistance.tangent(g, v), (0.0, 0.0));
                assert!(resistance.push(resistance.onset - above, v) >= 0.0);
            }
            let most = 1e-9 * (resistance.stiffness + resistance.damping * v.abs() / resistance.easing);
            assert!(resistance.push(resistance.onset - 1e-9, v) <= 1.001 * most, "{v} m/s");
        }
    }
}
