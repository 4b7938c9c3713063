//! 3×3 matrices in every lane, built as c·1 + Σ a bᵀ.
//!
//! Written without closures: those are compiled for any processor, and would cost a call for every instruction of a wider one.

use crate::algebra::real::Across;
use crate::algebra::real::Real;
use crate::algebra::triple::Triple;
use nalgebra::Matrix3;

/// A 3×3 matrix in every lane, by columns.
#[derive(Clone, Copy, Debug)]
pub struct Tensor<F: Real>(pub [Triple<F>; 3]);

impl<F: Real> Tensor<F> {
    /// c·1.
    #[inline(always)]
    pub fn isotropic(cpu: F::Cpu, c: F) -> Self {
        let zero = Triple::zero(cpu);
        Tensor([Triple { x: c, ..zero }, Triple { y: F::Across::of(c), ..zero }, Triple { z: c, ..zero }])
    }

    /// self + a bᵀ.
    #[inline(always)]
    pub fn add_outer(self, a: Triple<F>, b: Triple<F>) -> Self {
        let [x, y, z] = self.0;
        Tensor([a.mul_add(b.x, x), y.add_times_across(a, b.y), a.mul_add(b.z, z)])
    }

    /// self·factor + term.
    #[inline(always)]
    pub fn mul_add(self, factor: F, term: Self) -> Self {
        let ([x, y, z], [tx, ty, tz]) = (self.0, term.0);
        Tensor([x.mul_add(factor, tx), y.mul_add(factor, ty), z.mul_add(factor, tz)])
    }

    /// self·factor + term.
    #[inline(always)]
    pub fn scale_add(self, factor: f64, term: Self) -> Self {
        let ([x, y, z], [tx, ty, tz]) = (self.0, term.0);
        Tensor([x.scale_add(factor, tx), y.scale_add(factor, ty), z.scale_add(factor, tz)])
    }

    /// self·factor.
    #[inline(always)]
    pub fn times(self, factor: F) -> Self {
        let [x, y, z] = self.0;
        Tensor([x * factor, y * factor, z * factor])
    }

    /// self·factor.
    #[inline(always)]
    pub fn scale(self, factor: f64) -> Self {
        let [x, y, z] = self.0;
        Tensor([x.scale(factor), y.scale(factor), z.scale(factor)])
    }
}

impl From<Tensor<f64>> for Matrix3<f64> {
    fn from(t: Tensor<f64>) -> Matrix3<f64> {
        Matrix3::from_columns(&t.0.map(Into::into))
    }
}

impl From<Matrix3<f64>> for Tensor<f64> {
    fn from(m: Matrix3<f64>) -> Tensor<f64> {
        Tensor(std::array::from_fn(|c| m.column(c).into_owned().into()))
    }
}
