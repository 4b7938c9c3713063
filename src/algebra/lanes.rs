//! The number type of the element loop: one f64, or several elements side by side.

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar, Vector3};
use num_traits::{One, Zero};
use std::ops::Neg;

/// A number or a short row of numbers on which the same arithmetic is done.
pub trait Real:
    Scalar + Copy + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign + ClosedDivAssign + Neg<Output = Self>
{
    /// How many numbers it holds.
    const LANES: usize;
    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// Consecutive numbers from the start of a slice.
    fn load(from: &[f64]) -> Self;
    /// Adds to consecutive numbers at the start of a slice.
    fn add_to(self, to: &mut [f64]);
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// The smaller of two.
    fn min(self, other: Self) -> Self;
}

impl Real for f64 {
    const LANES: usize = 1;
    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn load(from: &[f64]) -> f64 {
        from[0]
    }
    #[inline(always)]
    fn add_to(self, to: &mut [f64]) {
        to[0] += self;
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        f64::max(self, other)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        f64::min(self, other)
    }
}

/// Length of a vector, never exactly zero, so that a quotient by it stays finite: sqrt(v·v + 1e-200).
#[inline(always)]
pub fn length<F: Real>(v: &Vector3<F>) -> F {
    (v.dot(v) + F::splat(1.0e-200)).sqrt()
}
