//! Block-tridiagonal systems in O(N): D_i x_i + U_i x_{i+1} + L_{i-1} x_{i-1} = b_i with B×B blocks.
//!
//! Block elimination from the first block to the last. The factor keeps E_i = D_i⁻¹, G_i = D_i⁻¹ U_i and H_i = L_i D_i⁻¹, so that
//! a solution costs three small products per block: y_{i+1} = b_{i+1} - H_i y_i, then x_i = E_i y_i - G_i x_{i+1}.
//!
//! Two neighbours i, i+1 may be *tied*: the first half of their unknowns is the same (two slopes at one position). Then the
//! second half of block i is condensed into block i+1, and the same two recursions hold with other E, G, H.

use crate::algebra::lanes::{Lanes, MOST_LANES, Real};
use nalgebra::{SMatrix, SVector};
use pulp::{Arch, Simd, WithSimd};

/// A B×B block.
pub type Block<const B: usize> = SMatrix<f64, B, B>;

/// The matrix: diagonal, upper and lower blocks, and which neighbours are tied.
#[derive(Debug, Clone)]
pub struct BlockTridiagonal<const B: usize> {
    /// Diagonal blocks D_i.
    pub diagonal: Vec<Block<B>>,
    /// Blocks U_i that couple row i with unknown i+1.
    pub upper: Vec<Block<B>>,
    /// Blocks L_i that couple row i+1 with unknown i.
    pub lower: Vec<Block<B>>,
    /// tied[i]: unknowns i and i+1 share their first B/2 entries.
    pub tied: Vec<bool>,
}

/// The factor of a matrix, ready to solve.
#[derive(Debug, Clone)]
pub struct Factor<const B: usize> {
    inverse: Vec<Columns<B>>,
    back: Vec<Columns<B>>,
    forward: Vec<Columns<B>>,
    processor: Arch,
}

/// A block of at most 8 rows by columns, padded with zeros, so that a product takes few registers.
#[derive(Debug, Clone)]
#[repr(align(64))]
struct Columns<const B: usize>([[f64; MOST_LANES]; B]);

impl<const B: usize> Columns<B> {
    fn of(block: &Block<B>) -> Self {
        let mut columns = [[0.0; MOST_LANES]; B];
        for (column, from) in columns.iter_mut().zip(block.column_iter()) {
            column.iter_mut().zip(from.iter()).for_each(|(to, from)| *to = *from);
        }
        Columns(columns)
    }

    fn block(&self) -> Block<B> {
        Block::from_fn(|r, c| self.0[c][r])
    }

    /// sign·A x + term.
    #[inline(always)]
    fn multiply_add<V: Simd>(&self, cpu: V, sign: f64, x: &[f64; MOST_LANES], term: &[f64; MOST_LANES]) -> [f64; MOST_LANES] {
        let mut y = [0.0; MOST_LANES];
        let mut r = 0;
        while r < MOST_LANES {
            // Two chains of additions, each half as long.
            let mut sums = [Lanes::load(cpu, term, r), Lanes::splat(cpu, 0.0)];
            for c in 0..B {
                sums[c % 2] = Lanes::load(cpu, &self.0[c], r).scale_add(sign * x[c], sums[c % 2]);
            }
            (sums[0] + sums[1]).store(&mut y, r);
            r += V::F64_LANES;
        }
        y
    }
}

/// Block `index` could not be inverted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Singular {
    /// Number of the block, from the first.
    pub index: usize,
}

impl<const B: usize> BlockTridiagonal<B> {
    /// A zero matrix of `tied.len() + 1` blocks.
    pub fn new(tied: Vec<bool>) -> Self {
        let n = tied.len() + 1;
        BlockTridiagonal {
            diagonal: vec![Block::zeros(); n],
            upper: vec![Block::zeros(); n - 1],
            lower: vec![Block::zeros(); n - 1],
            tied,
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(Block::zeros());
        self.upper.fill(Block::zeros());
        self.lower.fill(Block::zeros());
    }

    /// Takes unknown `entry` of block `index` out of the system: its row and column become those of the identity.
    pub fn fix(&mut self, index: usize, entry: usize) {
        self.diagonal[index].row_mut(entry).fill(0.0);
        self.diagonal[index].column_mut(entry).fill(0.0);
        self.diagonal[index][(entry, entry)] = 1.0;
        if index < self.upper.len() {
            self.upper[index].row_mut(entry).fill(0.0);
            self.lower[index].column_mut(entry).fill(0.0);
        }
        if index > 0 {
            self.lower[index - 1].row_mut(entry).fill(0.0);
            self.upper[index - 1].column_mut(entry).fill(0.0);
        }
    }

    /// y = A x, block by block.
    pub fn multiply(&self, x: &[SVector<f64, B>], y: &mut [SVector<f64, B>]) {
        for i in 0..self.diagonal.len() {
            y[i] = self.diagonal[i] * x[i];
            if i > 0 {
                y[i] += self.lower[i - 1] * x[i - 1];
            }
            if i < self.upper.len() {
                y[i] += self.upper[i] * x[i + 1];
            }
        }
    }
}

impl<const B: usize> Factor<B> {
    /// Room for the factor of a matrix of `n` blocks.
    pub fn new(n: usize) -> Self {
        const { assert!(B <= MOST_LANES) };
        let zeros = || vec![Columns([[0.0; MOST_LANES]; B]); n];
        Factor { inverse: zeros(), back: zeros(), forward: zeros(), processor: Arch::new() }
    }

    /// Factors a matrix. On an error the factor must not be used.
    pub fn factor(&mut self, a: &BlockTridiagonal<B>) -> Result<(), Singular> {
        let n = a.diagonal.len();
        let mut diagonal = a.diagonal[0];
        for i in 0..n {
            let fails = Singular { index: i };
            if i + 1 == n {
                self.inverse[i] = Columns::of(&inverse(&diagonal).ok_or(fails)?);
            } else if a.tied[i] {
                let mut next = a.diagonal[i + 1];
                self.condense(i, &diagonal, &a.upper[i], &a.lower[i], &mut next).ok_or(fails)?;
                diagonal = next;
            } else {
                let inverse = Columns::of(&inverse(&diagonal).ok_or(fails)?);
                let (upper, lower) = (Columns::of(&a.upper[i]), Columns::of(&a.lower[i]));
                let back = self.product(1.0, &inverse, &upper, None);
                diagonal = self.product(-1.0, &lower, &back, Some(&Columns::of(&a.diagonal[i + 1]))).block();
                self.forward[i] = self.product(1.0, &lower, &inverse, None);
                (self.inverse[i], self.back[i]) = (inverse, back);
            }
        }
        Ok(())
    }

    /// Eliminates the second half q of a tied block; its first half p is that of the next block.
    /// Rows q: D_qp p + D_qq q + U_qq q' = b_q.
    fn condense(&mut self, i: usize, d: &Block<B>, upper: &Block<B>, lower: &Block<B>, next: &mut Block<B>) -> Option<()> {
        let h = B / 2;
        let mut corner = Block::<B>::identity();
        let mut row = Block::<B>::zeros();
        let mut column = Block::<B>::zeros();
        for r in 0..h {
            for c in 0..h {
                corner[(h + r, h + c)] = d[(h + r, h + c)];
                row[(h + r, c)] = d[(h + r, c)];
                row[(h + r, h + c)] = upper[(h + r, h + c)];
                column[(r, h + c)] = d[(r, h + c)];
                column[(h + r, h + c)] = lower[(h + r, h + c)];
                next[(r, c)] += d[(r, c)];
            }
        }
        let mut inverse = inverse(&corner)?;
        for r in 0..h {
            inverse[(r, r)] = 0.0;
        }
        let (mut back, mut forward) = (inverse * row, column * inverse);
        *next -= column * back;
        for r in 0..h {
            back[(r, r)] = -1.0;
            forward[(r, r)] = -1.0;
        }
        self.keep(i, &inverse, &back, &forward);
        Some(())
    }

    /// sign·A B + term.
    fn product(&self, sign: f64, a: &Columns<B>, b: &Columns<B>, term: Option<&Columns<B>>) -> Columns<B> {
        self.processor.dispatch(Product { sign, a, b, term })
    }

    fn keep(&mut self, i: usize, inverse: &Block<B>, back: &Block<B>, forward: &Block<B>) {
        (self.inverse[i], self.back[i], self.forward[i]) = (Columns::of(inverse), Columns::of(back), Columns::of(forward));
    }

    /// Solves for one right-hand side in place, given component-major: entry c of block i stands at `b[c * stride + i]`.
    /// Three products of 2B² operations per block.
    pub fn solve(&self, b: &mut [f64], stride: usize) {
        self.processor.dispatch(Solution { factor: self, b, stride });
    }
}

struct Product<'a, const B: usize> {
    sign: f64,
    a: &'a Columns<B>,
    b: &'a Columns<B>,
    term: Option<&'a Columns<B>>,
}

impl<const B: usize> WithSimd for Product<'_, B> {
    type Output = Columns<B>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Columns<B> {
        let mut product = Columns([[0.0; MOST_LANES]; B]);
        for c in 0..B {
            let term = self.term.map_or([0.0; MOST_LANES], |term| term.0[c]);
            product.0[c] = self.a.multiply_add(cpu, self.sign, &self.b.0[c], &term);
        }
        product
    }
}

struct Solution<'a, const B: usize> {
    factor: &'a Factor<B>,
    b: &'a mut [f64],
    stride: usize,
}

impl<const B: usize> WithSimd for Solution<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let Solution { factor, b, stride } = self;
        let n = factor.inverse.len();
        let none = [0.0; MOST_LANES];
        let mut y = gather::<B>(b, stride, 0);
        for i in 1..n {
            y = factor.forward[i - 1].multiply_add(cpu, -1.0, &y, &gather::<B>(b, stride, i));
            scatter::<B>(b, stride, i, &y);
        }
        let mut x = factor.inverse[n - 1].multiply_add(cpu, 1.0, &y, &none);
        scatter::<B>(b, stride, n - 1, &x);
        for i in (0..n - 1).rev() {
            let own = factor.inverse[i].multiply_add(cpu, 1.0, &gather::<B>(b, stride, i), &none);
            x = factor.back[i].multiply_add(cpu, -1.0, &x, &own);
            scatter::<B>(b, stride, i, &x);
        }
    }
}

#[inline(always)]
fn gather<const B: usize>(b: &[f64], stride: usize, i: usize) -> [f64; MOST_LANES] {
    let mut x = [0.0; MOST_LANES];
    for c in 0..B {
        x[c] = b[c * stride + i];
    }
    x
}

#[inline(always)]
fn scatter<const B: usize>(b: &mut [f64], stride: usize, i: usize, x: &[f64; MOST_LANES]) {
    for c in 0..B {
        b[c * stride + i] = x[c];
    }
}

/// Inverse by Gauss–Jordan elimination with row pivoting; none if a pivot vanishes or is not finite.
fn inverse<const B: usize>(matrix: &Block<B>) -> Option<Block<B>> {
    let mut a = *matrix;
    let mut inverse = Block::<B>::identity();
    for k in 0..B {
        let mut pivot = k;
        for r in k + 1..B {
            if a[(r, k)].abs() > a[(pivot, k)].abs() {
                pivot = r;
            }
        }
        if pivot != k {
            a.swap_rows(k, pivot);
            inverse.swap_rows(k, pivot);
        }
        let scale = 1.0 / a[(k, k)];
        if !scale.is_finite() {
            return None;
        }
        for c in 0..B {
            a[(k, c)] *= scale;
            inverse[(k, c)] *= scale;
        }
        for r in 0..B {
            let factor = a[(r, k)];
            if r != k && factor != 0.0 {
                for c in 0..B {
                    a[(r, c)] -= factor * a[(k, c)];
                    inverse[(r, c)] -= factor * inverse[(k, c)];
                }
            }
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A random, diagonally dominant system: A x = b is recovered to rounding (condition number below 10).
    #[test]
    fn a_solution_multiplied_gives_the_right_hand_side() {
        for tied in [vec![false; 4], vec![false, true, false, true], vec![true, false, false, false]] {
            let mut seed = 7u64;
            let mut random = || {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            };
            let mut a = BlockTridiagonal::<6>::new(tied.clone());
            for i in 0..5 {
                a.diagonal[i] = Block::from_fn(|r, c| random() + if r == c { 8.0 } else { 0.0 });
                if i < 4 {
                    a.upper[i] = Block::from_fn(|r, c| if tied[i] && (r < 3 || c < 3) { 0.0 } else { random() });
                    a.lower[i] = Block::from_fn(|r, c| if tied[i] && (r < 3 || c < 3) { 0.0 } else { random() });
                }
            }
            let mut x: Vec<SVector<f64, 6>> = (0..5).map(|_| SVector::from_fn(|_, _| random())).collect();
            for i in 0..4 {
                if tied[i] {
                    for c in 0..3 {
                        x[i][c] = x[i + 1][c];
                    }
                }
            }
            let mut b = vec![SVector::<f64, 6>::zeros(); 5];
            a.multiply(&x, &mut b);
            let mut flat = vec![0.0; 30];
            for i in 0..5 {
                (0..6).for_each(|c| flat[c * 5 + i] = b[i][c]);
            }
            let mut factor = Factor::new(5);
            factor.factor(&a).unwrap();
            factor.solve(&mut flat, 5);
            for i in 0..5 {
                let found = SVector::<f64, 6>::from_fn(|c, _| flat[c * 5 + i]);
                assert!((found - x[i]).norm() < 1e-13, "{tied:?} block {i}");
            }
        }
    }

    #[test]
    fn a_singular_block_is_named() {
        let mut a = BlockTridiagonal::<6>::new(vec![false; 2]);
        a.diagonal.fill(Block::identity());
        a.diagonal[1][(2, 2)] = 0.0;
        assert_eq!(Factor::new(3).factor(&a), Err(Singular { index: 1 }));
    }
}
