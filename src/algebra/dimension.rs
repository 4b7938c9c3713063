//! How many components a vector of the element loop has: three in space, two in the plane of a planar line.
//!
//! The component across that plane has a type of its own, so that a planar loop holds no instruction for it.

use crate::algebra::real::{Across, Real};
use std::fmt::Debug;

/// Space or plane.
pub trait Dimension: Copy + Debug + Default + Send + Sync + 'static {
    /// What a vector has across the x–z plane.
    type Across<F: Real>: Across<F>;
    /// Whether that is nothing.
    const PLANAR: bool;
}

/// Vectors have three components.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spatial;

impl Dimension for Spatial {
    type Across<F: Real> = F;
    const PLANAR: bool = false;
}

/// Vectors lie in the x–z plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Planar;

impl Dimension for Planar {
    type Across<F: Real> = Nothing;
    const PLANAR: bool = true;
}

/// No component.
#[derive(Clone, Copy, Debug)]
pub struct Nothing;

impl<F: Real> Across<F> for Nothing {
    #[inline(always)]
    fn across(_: F::Cpu, _: f64) -> Self {
        Nothing
    }
    #[inline(always)]
    fn read(_: F::Cpu, _: &[f64], _: usize) -> Self {
        Nothing
    }
    #[inline(always)]
    fn of(_: F) -> Self {
        Nothing
    }
    #[inline(always)]
    fn write(self, _: &mut [f64], _: usize) {}
    #[inline(always)]
    fn write_more(self, _: F::Cpu, _: &mut [f64], _: usize) {}
    #[inline(always)]
    fn onto(self, _: F, term: F) -> F {
        term
    }
    #[inline(always)]
    fn onto_across(self, _: Self, _: Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn value(self, cpu: F::Cpu) -> F {
        F::splat(cpu, 0.0)
    }
    #[inline(always)]
    fn sum_up(self) -> f64 {
        0.0
    }
    #[inline(always)]
    fn plus(self, _: Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn minus(self, _: Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn negative(self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn times(self, _: F) -> Self {
        Nothing
    }
    #[inline(always)]
    fn scale(self, _: f64) -> Self {
        Nothing
    }
    #[inline(always)]
    fn times_plus(self, _: F, _: Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn scaled_plus(self, _: f64, _: Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn product(self, _: Self, term: F) -> F {
        term
    }
    #[inline(always)]
    fn along(self, _: f64, term: F) -> F {
        term
    }
}
