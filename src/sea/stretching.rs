//! Where, under a moving surface, the motion that linear theory knows below still water is taken from.
//!
//! ```text
//! wheeler         z′ + d = (z + d) d/(d + η)                    none            z′ = z, and nothing moves above z = 0
//! vertical        z′ = min(z, 0)                                extrapolation   z′ = min(z, 0), and z - z′ times the slope there
//! ```
//!
//! z ≤ η height [m], η elevation [m], d depth [m]. What lies above the surface has the motion of the surface.

use crate::algebra::real::Real;
use crate::scene::types::Stretching;

/// The water never becomes shallower than this share of its depth.
pub const SHALLOWEST: f64 = 0.05;

/// Where a motion is taken from.
#[derive(Debug, Clone, Copy)]
pub struct Level<F> {
    /// z′ [m], from the bed to still water.
    pub z: F,
    /// How far above still water its slope carries on the motion at z′ [m]; 0 where it does not.
    pub above: F,
    /// 0 where nothing moves, else 1.
    pub share: F,
}

impl Stretching {
    /// The level for a height z under a surface at η, in water of a depth [m].
    #[inline(always)]
    pub fn level<F: Real>(self, cpu: F::Cpu, z: F, elevation: F, depth: f64) -> Level<F> {
        let (zero, bed) = (F::splat(cpu, 0.0), F::splat(cpu, -depth));
        let still = Level { z: zero, above: zero, share: F::splat(cpu, 1.0) };
        if self == Stretching::Wheeler {
            let deep = (elevation + depth).max(F::splat(cpu, SHALLOWEST * depth));
            return Level { z: ((z + depth) * depth * deep.reciprocal() + -depth).min(zero).max(bed), ..still };
        }
        let z = z.min(elevation);
        let level = Level { z: z.min(zero).max(bed), ..still };
        match self {
            Stretching::None => Level { share: (-z).step(), ..level },
            Stretching::Extrapolation => Level { above: z.max(zero), ..level },
            Stretching::Vertical | Stretching::Wheeler => level,
        }
    }
}
