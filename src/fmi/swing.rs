//! The term that a swing adds to an extrapolation.
//!
//! A polynomial through the present and m past values of y lacks D_(m+1)·Π(τ - tⱼ) over its nodes, D_k the divided difference of order k. To
//! measure it takes one value more, and what alternates from one value to the next is then foretold twice as large, which a vessel
//! that answers sends back. What swings about a mean (m = 2) or about a line (m = 3) needs no more values:
//!
//! ```text
//! y⁽ᵐ⁺¹⁾ = -ω² y⁽ᵐ⁻¹⁾,   so   D_(m+1) ≈ -w D_(m-1)/(m (m + 1))
//! ```
//!
//! For equal steps h the next value is exactly that of the swing with w = (2 sin(ω h/2)/h)², m = 2 or 3. w [1/s²] is the one that would have
//! foretold the last values best, by least squares, at least 0 and at most 1/h². An alternation of 1 is foretold as 7 - 2 w h² (m = 2; by the
//! parabola 7, by the cubic 15): no more than without the term. Ships in waves swing within a narrow band; where they do not, w is small.

use crate::fmi::segment::{TERMS, Terms, through_present};
use nalgebra::Vector3;

/// w [1/s²] from the past: of each value what the polynomial before it missed, and what the term brings for w = 1 s⁻² [m/s² or
/// m]; `step`: time from the newest past value to the present [s]. 0 where nothing is known.
pub fn square(past: impl Iterator<Item = (Vector3<f64>, Vector3<f64>)>, step: f64) -> f64 {
    let (along, square) =
        past.fold((0.0, 0.0), |(along, square), (missed, turn)| (along - missed.dot(&turn), square + turn.norm_squared()));
    if square > 0.0 { (along / square).clamp(0.0, step.powi(-2)) } else { 0.0 }
}

/// The polynomial through the present and m past values (time from now [s], value), m ≥ 2, with the term that a swing adds; `square`: w [1/s²].
pub fn through(present: f64, past: impl Iterator<Item = (f64, f64)> + Clone, square: f64) -> Terms {
    let plain = through_present(&[present], past.clone());
    let m = past.clone().count();
    if !(square > 0.0) || m < 2 || m + 1 >= TERMS {
        return plain;
    }
    let lower = through_present(&[present], past.clone().take(m - 1))[m - 1];
    // The product over the nodes, of which the present is τ = 0.
    let mut term = [0.0; TERMS];
    term[1] = -square * lower / (m * (m + 1)) as f64;
    for (time, _) in past {
        for power in (1..TERMS).rev() {
            term[power] = term[power - 1] - time * term[power];
        }
        term[0] *= -time;
    }
    std::array::from_fn(|power| plain[power] + term[power])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(terms: &Terms, x: f64) -> f64 {
        terms.iter().rev().fold(0.0, |sum, term| sum * x + term)
    }

    fn through_motion(motion: impl Fn(f64) -> f64, times: &[f64], square: f64) -> Terms {
        through(motion(0.0), times.iter().map(|time| (*time, motion(*time))), square)
    }

    /// ω h from 0.1 to 1: the next value is that of the swing, about a mean through two past values, about a line through three.
    #[test]
    fn the_next_value_of_a_swing_is_foretold_exactly() {
        for (h, omega) in [(0.1, 1.0), (0.5, 0.9), (1.0, 1.0)] {
            let half: f64 = 0.5 * omega * h;
            let square = (2.0 * half.sin() / h).powi(2);
            let about_a_mean = |t: f64| 3.0 + 2.0 * (omega * t + 0.4).sin();
            let about_a_line = |t: f64| about_a_mean(t) - 0.7 * t;
            let found = [
                at(&through_motion(about_a_mean, &[-h, -2.0 * h], square), h) - about_a_mean(h),
                at(&through_motion(about_a_line, &[-h, -2.0 * h, -3.0 * h], square), h) - about_a_line(h),
            ];
            assert!(found.iter().all(|miss| miss.abs() < 1e-12), "ω h = {}: {found:?}", omega * h);
            // Not at all so without it.
            assert!((at(&through_motion(about_a_mean, &[-h, -2.0 * h], 0.0), h) - about_a_mean(h)).abs() > 1e-4);
        }
    }

    #[test]
    fn unequal_steps_are_foretold_closer_than_by_the_polynomial() {
        let motion = |t: f64| 2.0 * (0.8 * t + 0.4).sin();
        let times = [-0.4, -1.0];
        let miss = |square: f64| (at(&through_motion(motion, &times, square), 0.5) - motion(0.5)).abs();
        assert!(miss(0.64) < 0.2 * miss(0.0), "{} for {}", miss(0.64), miss(0.0));
    }

    #[test]
    fn an_alternation_is_foretold_no_larger_than_without() {
        for square in [0.0, 0.4, 1.0] {
            let alternating = through(1.0, [(-1.0, -1.0), (-2.0, 1.0)].into_iter(), square);
            assert!((at(&alternating, 1.0) - (7.0 - 2.0 * square)).abs() < 1e-12);
        }
    }

    /// From misses of a known w that itself comes back; what grows instead of swinging, and a past without any motion, have none.
    #[test]
    fn the_square_is_that_of_the_past() {
        let turn = Vector3::new(1.0, -2.0, 0.5);
        let of = |w: f64| square([(-turn * w, turn), (turn * (0.3 * w), turn * -0.3)].into_iter(), 0.5);
        assert!((of(0.7) - 0.7).abs() < 1e-12);
        assert_eq!((of(-0.7), of(5.0)), (0.0, 4.0));
        assert_eq!(square([(turn, turn * 0.0)].into_iter(), 0.5), 0.0);
        assert_eq!(square(std::iter::empty(), 0.5), 0.0);
    }
}
