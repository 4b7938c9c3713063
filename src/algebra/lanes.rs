//! The number type of the element loop: one f64, or several elements side by side.
//!
//! A kernel is written once over `Real`. `pulp::Arch` looks at the processor when the program starts and runs the kernel with as many
//! lanes as it has: `Lanes<V3>` (AVX2 and FMA, 4), one on any other.

use crate::algebra::dimension::{Across, Dimension, Spatial};
use nalgebra::Vector3;
use pulp::Simd;
use std::fmt::Debug;
use std::marker::PhantomData;
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

/// As many numbers as a register of the processor holds; vectors of them have as many components as `D` says.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<V: Simd, D: Dimension = Spatial> {
    cpu: V,
    x: V::f64s,
    dimension: PhantomData<D>,
}

impl<V: Simd, D: Dimension> Real for Lanes<V, D> {
    type Cpu = V;
    type Across = D::Across<Self>;
    const LANES: usize = V::F64_LANES;
    #[inline(always)]
    fn splat(cpu: V, x: f64) -> Self {
        Lanes { cpu, x: cpu.splat_f64s(x), dimension: PhantomData }
    }
    #[inline(always)]
    fn load(cpu: V, from: &[f64], at: usize) -> Self {
        let (rows, _) = V::as_simd_f64s(&from[at..at + V::F64_LANES]);
        Lanes { cpu, x: rows[0], dimension: PhantomData }
    }
    #[inline(always)]
    fn store(self, to: &mut [f64], at: usize) {
        let (rows, _) = V::as_mut_simd_f64s(&mut to[at..at + V::F64_LANES]);
        rows[0] = self.x;
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Lanes { x: self.cpu.mul_add_e_f64s(self.x, factor.x, term.x), ..self }
    }
    #[inline(always)]
    fn scale_add(self, factor: f64, term: Self) -> Self {
        self.mul_add(Self::splat(self.cpu, factor), term)
    }
    #[inline(always)]
    fn reciprocal(self) -> Self {
        Lanes { x: self.cpu.div_f64s(self.cpu.splat_f64s(1.0), self.x), ..self }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes { x: self.cpu.sqrt_f64s(self.x), ..self }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Lanes { x: self.cpu.max_f64s(self.x, other.x), ..self }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Lanes { x: self.cpu.min_f64s(self.x, other.x), ..self }
    }
    #[inline(always)]
    fn step(self) -> Self {
        let (zero, one) = (self.cpu.splat_f64s(0.0), self.cpu.splat_f64s(1.0));
        Lanes { x: self.cpu.select_f64s(self.cpu.greater_than_or_equal_f64s(self.x, zero), one, zero), ..self }
    }
    #[inline(always)]
    fn any_positive(self) -> bool {
        self.cpu.first_true_m64s(self.cpu.greater_than_f64s(self.x, self.cpu.splat_f64s(0.0))) < V::F64_LANES
    }
}

impl<V: Simd, D: Dimension> Add for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Lanes { x: self.cpu.add_f64s(self.x, other.x), ..self }
    }
}

impl<V: Simd, D: Dimension> Sub for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Lanes { x: self.cpu.sub_f64s(self.x, other.x), ..self }
    }
}

impl<V: Simd, D: Dimension> Mul for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Lanes { x: self.cpu.mul_f64s(self.x, other.x), ..self }
    }
}

impl<V: Simd, D: Dimension> Add<f64> for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + Self::splat(self.cpu, other)
    }
}

impl<V: Simd, D: Dimension> Mul<f64> for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * Self::splat(self.cpu, other)
    }
}

impl<V: Simd, D: Dimension> Neg for Lanes<V, D> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { x: self.cpu.neg_f64s(self.x), ..self }
    }
}

/// A vector, in every lane: in space, or in the x–z plane.
#[derive(Clone, Copy, Debug)]
pub struct Triple<F: Real> {
    /// First component.
    pub x: F,
    /// Second component, if there is one.
    pub y: F::Across,
    /// Third component.
    pub z: F,
}

impl<F: Real> Triple<F> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(cpu: F::Cpu, v: &Vector3<f64>) -> Self {
        Triple { x: F::splat(cpu, v.x), y: F::Across::across(cpu, v.y), z: F::splat(cpu, v.z) }
    }

    /// Consecutive vectors from place `at` of three rows.
    #[inline(always)]
    pub fn load(cpu: F::Cpu, [x, y, z]: [&[f64]; 3], at: usize) -> Self {
        Triple { x: F::load(cpu, x, at), y: F::Across::read(cpu, y, at), z: F::load(cpu, z, at) }
    }

    /// Zero.
    #[inline(always)]
    pub fn zero(cpu: F::Cpu) -> Self {
        Triple { x: F::splat(cpu, 0.0), y: F::Across::across(cpu, 0.0), z: F::splat(cpu, 0.0) }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> F {
        self.x.mul_add(other.x, self.y.product(other.y, self.z * other.z))
    }

    /// Scalar product with one vector.
    #[inline(always)]
    pub fn along(self, v: &Vector3<f64>) -> F {
        self.x.scale_add(v.x, self.y.along(v.y, self.z * v.z))
    }

    /// Length, never exactly zero, so that a quotient by it stays finite: sqrt(v·v + 1e-200).
    #[inline(always)]
    pub fn length(self) -> F {
        (self.dot(self) + 1.0e-200).sqrt()
    }

    /// self·factor + term.
    #[inline(always)]
    pub fn mul_add(self, factor: F, term: Self) -> Self {
        Triple { x: self.x.mul_add(factor, term.x), y: self.y.times_plus(factor, term.y), z: self.z.mul_add(factor, term.z) }
    }

    /// self·factor + term.
    #[inline(always)]
    pub fn scale_add(self, factor: f64, term: Self) -> Self {
        Triple { x: self.x.scale_add(factor, term.x), y: self.y.scaled_plus(factor, term.y), z: self.z.scale_add(factor, term.z) }
    }

    /// self·factor.
    #[inline(always)]
    pub fn scale(self, factor: f64) -> Self {
        Triple { x: self.x * factor, y: self.y.scale(factor), z: self.z * factor }
    }

    /// Sum of the vectors in all lanes.
    #[inline(always)]
    pub fn total(self) -> Triple<f64> {
        Triple { x: self.x.total(), y: self.y.sum_up(), z: self.z.total() }
    }

    /// Components in order; zero where there is none.
    #[inline(always)]
    pub fn components(self, cpu: F::Cpu) -> [F; 3] {
        [self.x, self.y.value(cpu), self.z]
    }
}

impl<F: Real> Add for Triple<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Triple { x: self.x + other.x, y: self.y.plus(other.y), z: self.z + other.z }
    }
}

impl<F: Real> Sub for Triple<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Triple { x: self.x - other.x, y: self.y.minus(other.y), z: self.z - other.z }
    }
}

impl<F: Real> Mul<F> for Triple<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Triple { x: self.x * factor, y: self.y.times(factor), z: self.z * factor }
    }
}

impl<F: Real> Neg for Triple<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Triple { x: -self.x, y: self.y.negative(), z: -self.z }
    }
}

impl From<Triple<f64>> for Vector3<f64> {
    #[inline(always)]
    fn from(v: Triple<f64>) -> Vector3<f64> {
        Vector3::new(v.x, v.y, v.z)
    }
}

impl From<Vector3<f64>> for Triple<f64> {
    #[inline(always)]
    fn from(v: Vector3<f64>) -> Triple<f64> {
        Triple { x: v.x, y: v.y, z: v.z }
    }
}

/// Length of a vector, never exactly zero: `Triple::length` for one vector.
#[inline(always)]
pub fn length(v: &Vector3<f64>) -> f64 {
    Triple::from(*v).length()
}
