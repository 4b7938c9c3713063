//! The numbers that the element loop reckons with: one, or a short row of them, and what a vector of such numbers has across a plane.
//!
//! A kernel is written once over `Real`. A planar line has nothing across its plane: then the second component has a type of its own,
//! which holds no number and takes no instruction. The two are one idea, since each names the other.

use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

/// Arrays that are read in batches are padded to a multiple of this many numbers, the most that any processor takes at once.
pub const MOST_LANES: usize = 8;

/// The length of a padded array for `count` numbers.
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(MOST_LANES)
}

/// A number or a short row of numbers on which the same arithmetic is done.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Proof that the processor can do it.
    type Cpu: Copy;
    /// What a vector has across the plane of a planar line: one more such number, or nothing where all happens in that plane.
    type Across: Across<Self>;
    /// How many numbers it holds.
    const LANES: usize;
    /// The same number in every lane.
    fn splat(cpu: Self::Cpu, x: f64) -> Self;
    /// Consecutive numbers from place `at` of a slice.
    fn load(cpu: Self::Cpu, from: &[f64], at: usize) -> Self;
    /// Writes to consecutive numbers from place `at` of a slice.
    fn store(self, to: &mut [f64], at: usize);
    /// self·factor + term, with one rounding where the processor can.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// self·factor + term.
    fn scale_add(self, factor: f64, term: Self) -> Self;
    /// 1/self.
    fn reciprocal(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// The smaller of two.
    fn min(self, other: Self) -> Self;
    /// 1 where self ≥ 0, else 0.
    fn step(self) -> Self;
    /// 1 where self > 0, else 0.
    #[inline(always)]
    fn positive(self) -> Self {
        -(-self).step() + 1.0
    }
    /// Whether any lane is greater than zero.
    fn any_positive(self) -> bool;

    /// The number in the first lane.
    #[inline(always)]
    fn first(self) -> f64 {
        self.lanes()[0]
    }

    /// The largest number in any lane.
    #[inline(always)]
    fn highest(self) -> f64 {
        self.lanes()[..Self::LANES].iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The sum of all lanes.
    #[inline(always)]
    fn total(self) -> f64 {
        self.lanes().iter().sum()
    }

    /// The numbers in order; zeros beyond the last lane.
    #[inline(always)]
    fn lanes(self) -> [f64; MOST_LANES] {
        let mut lanes = [0.0; MOST_LANES];
        self.store(&mut lanes, 0);
        lanes
    }

    /// Adds to consecutive numbers from place `at` of a slice.
    #[inline(always)]
    fn add_to(self, cpu: Self::Cpu, to: &mut [f64], at: usize) {
        (Self::load(cpu, to, at) + self).store(to, at);
    }
}

impl Real for f64 {
    type Cpu = ();
    type Across = f64;
    const LANES: usize = 1;
    #[inline(always)]
    fn splat(_: (), x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn load(_: (), from: &[f64], at: usize) -> f64 {
        from[at]
    }
    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        to[at] = self;
    }
    #[inline(always)]
    fn mul_add(self, factor: f64, term: f64) -> f64 {
        self * factor + term
    }
    #[inline(always)]
    fn scale_add(self, factor: f64, term: f64) -> f64 {
        self * factor + term
    }
    #[inline(always)]
    fn reciprocal(self) -> f64 {
        1.0 / self
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
    #[inline(always)]
    fn step(self) -> f64 {
        if self >= 0.0 { 1.0 } else { 0.0 }
    }
    #[inline(always)]
    fn any_positive(self) -> bool {
        self > 0.0
    }
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
    /// x·self + term.
    fn onto(self, x: F, term: F) -> F;
    /// other·self + term, along the second component too.
    fn onto_across(self, other: Self, term: Self) -> Self;
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
    fn onto(self, x: F, term: F) -> F {
        Real::mul_add(x, self, term)
    }
    #[inline(always)]
    fn onto_across(self, other: Self, term: Self) -> Self {
        Real::mul_add(other, self, term)
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
