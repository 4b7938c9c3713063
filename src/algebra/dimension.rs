//! How many components a vector of the element loop has: three in space, two in the plane of a planar line.
//!
//! The component across that plane has a type of its own, so that a planar loop holds no instruction for it.

use crate::algebra::lanes::{Real, Triple};
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

/// The second component of a vector: a number, or nothing.
pub trait Across<F: Real>: Copy + Debug {
    /// The same number in every lane.
    fn across(cpu: F::Cpu, x: f64) -> Self;
    /// Consecutive numbers from place `at` of a slice.
    fn read(cpu: F::Cpu, from: &[f64], at: usize) -> Self;
    /// Of a number.
    fn of(x: F) -> Self;
    /// Writes to consecutive numbers from place `at` of a slice; nothing leaves them as they are.
    fn write(self, to: &mut [f64], at: usize);
    /// Adds to consecutive numbers from place `at` of a slice.
    fn write_more(self, cpu: F::Cpu, to: &mut [f64], at: usize);
    /// column + self·a: the second column of a matrix to which a bᵀ is added, self being b's second component.
    fn outer(self, a: Triple<F>, column: Triple<F>) -> Triple<F>;
    /// The number; zero for nothing.
    fn value(self, cpu: F::Cpu) -> F;
    /// Sum of all lanes.
    fn sum_up(self) -> f64;
    /// self + other.
    fn plus(self, other: Self) -> Self;
    /// self - other.
    fn minus(self, other: Self) -> Self;
    /// -self.
    fn negative(self) -> Self;
    /// self·factor.
    fn times(self, factor: F) -> Self;
    /// self·factor.
    fn scale(self, factor: f64) -> Self;
    /// self·factor + term.
    fn times_plus(self, factor: F, term: Self) -> Self;
    /// self·factor + term.
    fn scaled_plus(self, factor: f64, term: Self) -> Self;
    /// self·other + term.
    fn product(self, other: Self, term: F) -> F;
    /// self·x + term.
    fn along(self, x: f64, term: F) -> F;
}

impl<F: Real> Across<F> for F {
    #[inline(always)]
    fn across(cpu: F::Cpu, x: f64) -> Self {
        F::splat(cpu, x)
    }
    #[inline(always)]
    fn read(cpu: F::Cpu, from: &[f64], at: usize) -> Self {
        F::load(cpu, from, at)
    }
    #[inline(always)]
    fn of(x: F) -> Self {
        x
    }
    #[inline(always)]
    fn write(self, to: &mut [f64], at: usize) {
        Real::store(self, to, at);
    }
    #[inline(always)]
    fn write_more(self, cpu: F::Cpu, to: &mut [f64], at: usize) {
        Real::add_to(self, cpu, to, at);
    }
    #[inline(always)]
    fn outer(self, a: Triple<F>, column: Triple<F>) -> Triple<F> {
        a.mul_add(self, column)
    }
    #[inline(always)]
    fn value(self, _: F::Cpu) -> F {
        self
    }
    #[inline(always)]
    fn sum_up(self) -> f64 {
        Real::total(self)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn negative(self) -> Self {
        -self
    }
    #[inline(always)]
    fn times(self, factor: F) -> Self {
        self * factor
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * factor
    }
    #[inline(always)]
    fn times_plus(self, factor: F, term: Self) -> Self {
        Real::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn scaled_plus(self, factor: f64, term: Self) -> Self {
        Real::scale_add(self, factor, term)
    }
    #[inline(always)]
    fn product(self, other: Self, term: F) -> F {
        Real::mul_add(self, other, term)
    }
    #[inline(always)]
    fn along(self, x: f64, term: F) -> F {
        Real::scale_add(self, x, term)
    }
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
    fn outer(self, _: Triple<F>, column: Triple<F>) -> Triple<F> {
        column
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
