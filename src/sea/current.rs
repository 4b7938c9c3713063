//! Current: velocity of the water, piecewise linear in z and constant outside the table.
//!
//! ```text
//! V(z) = V_0 + Σ_k S_k · clamp(z - z_k, 0, z_{k+1} - z_k),   S_k = (V_{k+1} - V_k) / (z_{k+1} - z_k)
//! ```
//!
//! z up from still water [m], V [m/s], rows sorted upwards. The sum has no branches, so it runs on several elements at once.

use crate::algebra::real::Real;
use crate::algebra::triple::Triple;
use crate::scene::types::CurrentPoint;
use nalgebra::Vector3;

/// A current profile.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Current {
    lowest: Vector3<f64>,
    layers: Vec<Layer>,
}

#[derive(Debug, Clone, PartialEq)]
struct Layer {
    from: f64,
    thickness: f64,
    shear: Vector3<f64>,
}

impl Current {
    /// The profile of a table, in any order of z.
    pub fn new(table: &[CurrentPoint]) -> Current {
        let mut rows = table.to_vec();
        rows.sort_by(|a, b| a.z.total_cmp(&b.z));
        let layers = rows.windows(2).filter(|pair| pair[1].z > pair[0].z).map(|pair| {
            let thickness = pair[1].z - pair[0].z;
            let shear = (Vector3::from(pair[1].velocity) - Vector3::from(pair[0].velocity)) / thickness;
            Layer { from: pair[0].z, thickness, shear }
        });
        Current { lowest: rows.first().map_or(Vector3::zeros(), |row| row.velocity.into()), layers: layers.collect() }
    }

    /// Whether the water stands still everywhere.
    pub fn is_still(&self) -> bool {
        self.lowest == Vector3::zeros() && self.layers.iter().all(|layer| layer.shear == Vector3::zeros())
    }

    /// Whether the water flows across the x–z plane anywhere.
    pub fn flows_across(&self) -> bool {
        self.lowest.y != 0.0 || self.layers.iter().any(|layer| layer.shear.y != 0.0)
    }

    /// Velocity at height z [m/s].
    pub fn velocity(&self, z: f64) -> Vector3<f64> {
        self.added_to((), z, Triple::zero(())).into()
    }

    /// V(z) + other [m/s].
    #[inline(always)]
    pub fn added_to<F: Real>(&self, cpu: F::Cpu, z: F, other: Triple<F>) -> Triple<F> {
        let mut velocity = other + Triple::splat(cpu, &self.lowest);
        for layer in &self.layers {
            let above = (z + -layer.from).max(F::splat(cpu, 0.0)).min(F::splat(cpu, layer.thickness));
            velocity = Triple::splat(cpu, &layer.shear).mul_add(above, velocity);
        }
        velocity
    }

    /// dV/dz at height z [1/s].
    #[inline(always)]
    pub fn shear<F: Real>(&self, cpu: F::Cpu, z: F) -> Triple<F> {
        let mut shear = Triple::zero(cpu);
        for layer in &self.layers {
            let inside = (z + -layer.from).positive() * (-z + (layer.from + layer.thickness)).positive();
            shear = Triple::splat(cpu, &layer.shear).mul_add(inside, shear);
        }
        shear
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear interpolation by hand: 0.5 m/s at the surface, 0.1 at 100 m, constant outside.
    #[test]
    fn the_profile_is_linear_between_rows_and_constant_outside() {
        let row = |z, x| CurrentPoint { z, velocity: [x, 0.0, 0.0] };
        let current = Current::new(&[row(0.0, 0.5), row(-100.0, 0.1), row(-50.0, 0.4)]);
        for (z, exact) in [(10.0, 0.5), (0.0, 0.5), (-25.0, 0.45), (-50.0, 0.4), (-75.0, 0.25), (-100.0, 0.1), (-500.0, 0.1)] {
            assert!((current.velocity(z).x - exact).abs() < 1e-15, "{z}");
        }
        assert!((current.shear((), -75.0).x - 0.006).abs() < 1e-15);
        assert_eq!(current.shear((), 10.0).x, 0.0);
    }
}
