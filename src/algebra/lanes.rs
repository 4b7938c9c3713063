//! As many elements side by side as the processor takes at once.
//!
//! `pulp::Arch` looks at the processor when the program starts and runs a kernel with as many lanes as it has:
//! `Lanes<V3>` (AVX2 and FMA, 4), one on any other.

use crate::algebra::dimension::{Dimension, Spatial};
use crate::algebra::real::Real;
use pulp::Simd;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Mul, Neg, Sub};

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
