//! Whether a symmetric block-tridiagonal matrix is positive definite.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use nalgebra::{Cholesky, SMatrix};

/// Whether the symmetric part of a matrix is positive definite. Where blocks i and i + 1 are tied, their first halves are the same unknowns.
pub fn is_positive_definite(matrix: &BlockTridiagonal<6>) -> bool {
    type Half<const C: usize> = SMatrix<f64, 3, C>;
    let symmetric = |i: usize| (matrix.diagonal[i] + matrix.diagonal[i].transpose()) * 0.5;
    let mut own = symmetric(0);
    for i in 0..matrix.upper.len() {
        let across = (matrix.upper[i] + matrix.lower[i].transpose()) * 0.5;
        let mut next = symmetric(i + 1);
        if matrix.tied[i] {
            let mut coupling = Half::<6>::zeros();
            coupling.fixed_columns_mut::<3>(0).copy_from(&own.fixed_view::<3, 3>(3, 0));
            coupling.fixed_columns_mut::<3>(3).copy_from(&across.fixed_view::<3, 3>(3, 3));
            let Some(factor) = Cholesky::new(own.fixed_view::<3, 3>(3, 3).into_owned()) else { return false };
            let positions = next.fixed_view::<3, 3>(0, 0) + own.fixed_view::<3, 3>(0, 0);
            next.fixed_view_mut::<3, 3>(0, 0).copy_from(&positions);
            next -= coupling.transpose() * factor.solve(&coupling);
        } else {
            let Some(factor) = Cholesky::new(own) else { return false };
            next -= across.transpose() * factor.solve(&across);
        }
        own = next;
    }
    Cholesky::new(own).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// Random symmetric matrices, shifted by what their smallest eigenvalue (of the whole matrix, tied unknowns taken as one) says to
    /// either side of definite.
    #[test]
    fn definite_is_what_the_smallest_eigenvalue_says() {
        for tied in [vec![false; 4], vec![false, true, false, true], vec![true, false, false, false]] {
            let mut seed = 11u64;
            let mut random = || {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            };
            let mut a = BlockTridiagonal::<6>::new(tied.clone());
            for i in 0..5 {
                let block = SMatrix::<f64, 6, 6>::from_fn(|_, _| random());
                a.diagonal[i] = block + block.transpose();
                if i < 4 {
                    a.upper[i] = SMatrix::from_fn(|r, c| if tied[i] && (r < 3 || c < 3) { 0.0 } else { random() });
                    a.lower[i] = a.upper[i].transpose();
                }
            }
            // The same unknowns written out, tied ones once.
            let mut number = [[0; 6]; 5];
            let mut count = 0;
            for i in (0..5).rev() {
                for c in 0..6 {
                    number[i][c] = if i < 4 && tied[i] && c < 3 { number[i + 1][c] } else { count };
                    count = count.max(number[i][c] + 1);
                }
            }
            let (mut whole, mut ones) = (DMatrix::<f64>::zeros(count, count), DMatrix::<f64>::zeros(count, count));
            for i in 0..5 {
                for r in 0..6 {
                    ones[(number[i][r], number[i][r])] += 1.0;
                    for c in 0..6 {
                        whole[(number[i][r], number[i][c])] += a.diagonal[i][(r, c)];
                        if i < 4 {
                            whole[(number[i][r], number[i + 1][c])] += a.upper[i][(r, c)];
                            whole[(number[i + 1][r], number[i][c])] += a.lower[i][(r, c)];
                        }
                    }
                }
            }
            let least = (0..60).fold((-10.0, 10.0), |(low, high): (f64, f64), _| {
                let middle = 0.5 * (low + high);
                let definite = (&whole + &ones * middle).symmetric_eigenvalues().min() > 0.0;
                if definite { (low, middle) } else { (middle, high) }
            });
            for (shift, definite) in [(least.1 - 1e-6, false), (least.1 + 1e-6, true)] {
                let mut shifted = a.clone();
                shifted.diagonal.iter_mut().for_each(|block| *block += SMatrix::<f64, 6, 6>::identity() * shift);
                assert_eq!(is_positive_definite(&shifted), definite, "{tied:?}, shift {shift}");
            }
        }
    }
}
