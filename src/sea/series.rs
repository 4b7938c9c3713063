//! Sine, cosine and exponential as polynomials, for several numbers at once.

use crate::algebra::real::Real;
use std::f64::consts::PI;

/// Exponents of decay below this are as good as this [-].
pub const DECAYED: f64 = 20.0;

/// cos and sin of an angle in turns, by their series about half the angle, which lies within ± π/2: errors below 3e-11 [-].
#[inline(always)]
pub fn cos_sin<F: Real>(cpu: F::Cpu, turns: F) -> (F, F) {
    // Adding and taking away 1.5·2⁵² rounds to a whole number.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    let half = (turns - ((turns + ROUND) + -ROUND)) * PI;
    let (sin, cos) = (half * series(cpu, half * half, 15), series(cpu, half * half, 16));
    ((sin * sin).scale_add(-2.0, F::splat(cpu, 1.0)), sin * cos * 2.0)
}

/// The series of sin x / x (`last` odd) or of cos x (`last` even) in x², up to the power `last` of sin x or cos x.
#[inline(always)]
fn series<F: Real>(cpu: F::Cpu, square: F, last: u32) -> F {
    let mut sum = F::splat(cpu, 1.0);
    let mut n = last;
    while n > 1 {
        sum = (sum * square).scale_add(-1.0 / f64::from(n * (n - 1)), F::splat(cpu, 1.0));
        n -= 2;
    }
    sum
}

/// e^x for x ≤ 4, by its series at x/32; e^-20 for all x below -20. Relative error below 1e-10.
#[inline(always)]
pub fn decay<F: Real>(cpu: F::Cpu, x: F) -> F {
    let x = x.max(F::splat(cpu, -DECAYED)) * (1.0 / 32.0);
    let mut sum = F::splat(cpu, 1.0);
    for per in [12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0].map(f64::recip) {
        sum = (sum * x).scale_add(per, F::splat(cpu, 1.0));
    }
    for _ in 0..5 {
        sum = sum * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// The series against the standard library.
    #[test]
    fn the_series_are_good_to_their_bound() {
        for n in -4000..4000 {
            let turns = f64::from(n) * 0.00137;
            let (cos, sin) = cos_sin::<f64>((), turns);
            assert!((cos - (TAU * turns).cos()).abs() < 3e-11 && (sin - (TAU * turns).sin()).abs() < 3e-11, "{turns}");
        }
        for n in -400..2000 {
            let x = -0.01 * f64::from(n);
            assert!((decay::<f64>((), x) / x.exp() - 1.0).abs() < 1e-10, "{x}");
        }
        assert!(decay::<f64>((), -1e9) < 1e-8);
    }
}
