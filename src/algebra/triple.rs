//! Vectors of the element loop, in every lane: in space, or in the x–z plane.

use crate::algebra::real::{Across, Real};
use nalgebra::Vector3;
use std::ops::{Add, Mul, Neg, Sub};

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

    /// self + a·y, y the second component of another vector: the second column of a matrix to which an outer product is added.
    #[inline(always)]
    pub fn add_times_across(self, a: Self, y: F::Across) -> Self {
        Triple { x: y.onto(a.x, self.x), y: y.onto_across(a.y, self.y), z: y.onto(a.z, self.z) }
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
