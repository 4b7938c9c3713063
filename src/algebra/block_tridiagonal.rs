//! Block-tridiagonal systems in O(N): D_i x_i + U_i x_{i+1} + L_{i-1} x_{i-1} = b_i with B×B blocks.
//!
//! Block elimination from both ends to a block in the middle: two chains that do not wait for each other, so that the processor works
//! on both at a time. The factor keeps E_i = D_i⁻¹ and, with j the neighbour towards the middle, A_ij the block that couples row i with
//! unknown j, G_i = D_i⁻¹ A_ij and H_i = A_ji D_i⁻¹, so that a solution costs three small products per block:
//! b_j becomes b_j - H_i b_i, then x_i = E_i b_i - G_i x_j.
//!
//! Two neighbours i, i+1 may be *tied*: the first half of their unknowns is the same (two slopes at one position). Then the
//! second half of block i is condensed into block i+1, and the same two recursions hold with other E, G, H. The middle lies behind all ties.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real};
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
    /// -G_i.
    back: Vec<Columns<B>>,
    /// -H_i.
    forward: Vec<Columns<B>>,
    /// The block that is eliminated last.
    middle: usize,
    /// The unknowns of a block that are solved for, in order.
    entries: [usize; B],
    processor: Arch,
}

/// A block of at most 8 rows by columns, padded with zeros, so that a product takes few registers.
#[derive(Debug, Clone)]
#[repr(align(64))]
struct Columns<const B: usize>([[f64; MOST_LANES]; B]);

/// For each row: zero there, one elsewhere.
const OTHERS: [[f64; MOST_LANES]; MOST_LANES] = {
    let mut others = [[1.0; MOST_LANES]; MOST_LANES];
    let mut k = 0;
    while k < MOST_LANES {
        others[k][k] = 0.0;
        k += 1;
    }
    others
};

impl<const B: usize> Columns<B> {
    /// The rows and columns `entries` of a block.
    fn of<const M: usize>(block: &Block<M>, entries: &[usize; B]) -> Self {
        let mut columns = [[0.0; MOST_LANES]; B];
        for (column, &c) in columns.iter_mut().zip(entries) {
            for (to, &r) in column.iter_mut().zip(entries) {
                *to = block[(r, c)];
            }
        }
        Columns(columns)
    }

    /// A x + term.
    #[inline(always)]
    fn multiply_add<V: Simd>(&self, cpu: V, x: &[f64; MOST_LANES], term: &[f64; MOST_LANES]) -> [f64; MOST_LANES] {
        let mut y = [0.0; MOST_LANES];
        let mut r = 0;
        while r < MOST_LANES {
            // Two chains of additions, each half as long.
            let mut sums = [Lanes::<V>::load(cpu, term, r), Lanes::<V>::splat(cpu, 0.0)];
            for c in 0..B {
                sums[c % 2] = Lanes::<V>::load(cpu, &self.0[c], r).scale_add(x[c], sums[c % 2]);
            }
            (sums[0] + sums[1]).store(&mut y, r);
            r += V::F64_LANES;
        }
        y
    }

    /// A B + term, A being self.
    #[inline(always)]
    fn product<V: Simd>(&self, cpu: V, b: &Self, term: &Self) -> Self {
        let mut product = term.clone();
        for c in 0..B {
            product.0[c] = self.multiply_add(cpu, &b.0[c], &term.0[c]);
        }
        product
    }

    /// -A B, A being self.
    #[inline(always)]
    fn minus_product<V: Simd>(&self, cpu: V, b: &Self) -> Self {
        let mut product = b.clone();
        for c in 0..B {
            let mut minus = b.0[c];
            minus.iter_mut().for_each(|x| *x = -*x);
            product.0[c] = self.multiply_add(cpu, &minus, &[0.0; MOST_LANES]);
        }
        product
    }

    /// Becomes the inverse, by Gauss–Jordan elimination in place with row pivoting; false if a pivot vanishes or is not finite.
    #[inline(always)]
    fn invert<V: Simd>(&mut self, cpu: V) -> bool {
        let mut swapped = [0; B];
        for k in 0..B {
            let mut pivot = k;
            for r in k + 1..B {
                if self.0[k][r].abs() > self.0[k][pivot].abs() {
                    pivot = r;
                }
            }
            swapped[k] = pivot;
            if pivot != k {
                self.0.iter_mut().for_each(|column| column.swap(k, pivot));
            }
            let scale = 1.0 / self.0[k][k];
            if !scale.is_finite() {
                return false;
            }
            let mut factors = [-scale; B];
            for c in 0..B {
                if c != k {
                    factors[c] *= self.0[c][k];
                }
            }
            let pivots = std::mem::replace(&mut self.0[k], [0.0; MOST_LANES]);
            let mut r = 0;
            while r < MOST_LANES {
                // Row k is replaced, the others are added to.
                let others = Lanes::<V>::load(cpu, &OTHERS[k], r);
                let pivots = Lanes::<V>::load(cpu, &pivots, r).mul_add(others, others + -1.0);
                for (column, factor) in self.0.iter_mut().zip(factors) {
                    pivots.scale_add(factor, Lanes::<V>::load(cpu, column, r) * others).store(column, r);
                }
                r += V::F64_LANES;
            }
        }
        for k in (0..B).rev() {
            self.0.swap(k, swapped[k]);
        }
        true
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

    /// Sets the blocks `first` to before `end`, and those that couple them with each other, to zero.
    pub fn clear_between(&mut self, first: usize, end: usize) {
        self.diagonal[first..end].fill(Block::zeros());
        self.upper[first..end - 1].fill(Block::zeros());
        self.lower[first..end - 1].fill(Block::zeros());
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
    /// Room for the factor of a matrix of `n` blocks, of which only the unknowns `entries` are solved for: as many of the first half of a
    /// block as of the second.
    pub fn new(n: usize, entries: [usize; B]) -> Self {
        const { assert!(B <= MOST_LANES) };
        let zeros = || vec![Columns([[0.0; MOST_LANES]; B]); n];
        Factor { inverse: zeros(), back: zeros(), forward: zeros(), middle: 0, entries, processor: Arch::new() }
    }

    /// Factors a matrix. On an error the factor must not be used.
    pub fn factor<const M: usize>(&mut self, a: &BlockTridiagonal<M>) -> Result<(), Singular> {
        self.processor.dispatch(Elimination { factor: self, a })
    }

    /// Factors the blocks of `runs` anew, each from its first to before its end, after all have been factored; none of them may be coupled with a block
    /// outside, nor may a run that holds the block in the middle be tied behind it. On an error the factor must not be used.
    pub fn factor_runs<const M: usize>(&mut self, a: &BlockTridiagonal<M>, runs: &[(usize, usize)]) -> Result<(), Singular> {
        self.processor.dispatch(PartialElimination { factor: self, a, runs })
    }

    /// The block that is eliminated last.
    pub fn middle(&self) -> usize {
        self.middle
    }

    /// Solves for one right-hand side in place, given component-major: entry c of block i stands at `b[c * stride + i]`.
    /// Three products of 2B² operations per block.
    pub fn solve(&self, b: &mut [f64], stride: usize) {
        self.processor.dispatch(Solution { factor: self, b, stride });
    }

    /// The same for the blocks of `runs` alone, each from its first to before its end, in order; none of them may be coupled with a block outside.
    pub fn solve_runs(&self, b: &mut [f64], stride: usize, runs: &[(usize, usize)]) {
        self.processor.dispatch(PartialSolution { factor: self, b, stride, runs });
    }
}

struct Elimination<'a, const B: usize, const M: usize> {
    factor: &'a mut Factor<B>,
    a: &'a BlockTridiagonal<M>,
}

impl<const B: usize, const M: usize> WithSimd for Elimination<'_, B, M> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Result<(), Singular> {
        let Elimination { factor, a } = self;
        let last = a.diagonal.len() - 1;
        factor.middle = last / 2;
        for (i, tied) in a.tied.iter().enumerate() {
            if *tied {
                factor.middle = factor.middle.max(i + 1);
            }
        }
        let (middle, entries) = (factor.middle, factor.entries);
        let mut diagonal = Columns::of(&a.diagonal[0], &entries);
        for i in 0..middle {
            diagonal = factor.take_up(cpu, a, i, diagonal)?;
        }
        // The block in the middle is what the first half has left of it.
        let centre = diagonal;
        let block = |i: usize| if i == middle { centre.clone() } else { Columns::of(&a.diagonal[i], &entries) };
        let mut diagonal = block(last);
        for i in (middle + 1..=last).rev() {
            diagonal = factor.take_down(cpu, a, i, diagonal, &block(i - 1))?;
        }
        factor.take_last(cpu, middle, diagonal)
    }
}

struct PartialElimination<'a, const B: usize, const M: usize> {
    factor: &'a mut Factor<B>,
    a: &'a BlockTridiagonal<M>,
    runs: &'a [(usize, usize)],
}

impl<const B: usize, const M: usize> WithSimd for PartialElimination<'_, B, M> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Result<(), Singular> {
        let PartialElimination { factor, a, runs } = self;
        let (middle, entries) = (factor.middle, factor.entries);
        for &(first, end) in runs {
            let last = end - 1;
            let centre = first.max(middle.min(last));
            let mut diagonal = Columns::of(&a.diagonal[first], &entries);
            for i in first..centre {
                diagonal = factor.take_up(cpu, a, i, diagonal)?;
            }
            if centre < last {
                let left = diagonal;
                let block = |i: usize| if i == centre { left.clone() } else { Columns::of(&a.diagonal[i], &entries) };
                diagonal = block(last);
                for i in (centre + 1..=last).rev() {
                    diagonal = factor.take_down(cpu, a, i, diagonal, &block(i - 1))?;
                }
            }
            factor.take_last(cpu, centre, diagonal)?;
        }
        Ok(())
    }
}

impl<const B: usize> Factor<B> {
    /// Eliminates block `i`, of which `diagonal` is left, into the next, and returns what is left of that.
    #[inline(always)]
    fn take_up<V: Simd, const M: usize>(
        &mut self,
        cpu: V,
        a: &BlockTridiagonal<M>,
        i: usize,
        mut diagonal: Columns<B>,
    ) -> Result<Columns<B>, Singular> {
        let Factor { inverse, back, forward, entries, .. } = self;
        let (mut upper, mut lower) = (Columns::of(&a.upper[i], entries), Columns::of(&a.lower[i], entries));
        let mut next = Columns::of(&a.diagonal[i + 1], entries);
        if a.tied[i] {
            condense(&mut diagonal, &mut upper, &mut lower, &mut next);
        }
        if !diagonal.invert(cpu) {
            return Err(Singular { index: i });
        }
        if a.tied[i] {
            // The first half is solved for in the next block.
            (0..B / 2).for_each(|r| diagonal.0[r][r] = 0.0);
        }
        back[i] = diagonal.minus_product(cpu, &upper);
        forward[i] = lower.minus_product(cpu, &diagonal);
        inverse[i] = diagonal;
        let left = lower.product(cpu, &back[i], &next);
        if a.tied[i] {
            for r in 0..B / 2 {
                back[i].0[r][r] = 1.0;
                forward[i].0[r][r] = 1.0;
            }
        }
        Ok(left)
    }

    /// The same into the block before, whose own is `next`.
    #[inline(always)]
    fn take_down<V: Simd, const M: usize>(
        &mut self,
        cpu: V,
        a: &BlockTridiagonal<M>,
        i: usize,
        mut diagonal: Columns<B>,
        next: &Columns<B>,
    ) -> Result<Columns<B>, Singular> {
        let Factor { inverse, back, forward, entries, .. } = self;
        let (upper, lower) = (Columns::of(&a.upper[i - 1], entries), Columns::of(&a.lower[i - 1], entries));
        if !diagonal.invert(cpu) {
            return Err(Singular { index: i });
        }
        back[i] = diagonal.minus_product(cpu, &lower);
        forward[i] = upper.minus_product(cpu, &diagonal);
        inverse[i] = diagonal;
        Ok(upper.product(cpu, &back[i], next))
    }

    /// The block that nothing is left to be eliminated into.
    #[inline(always)]
    fn take_last<V: Simd>(&mut self, cpu: V, i: usize, mut diagonal: Columns<B>) -> Result<(), Singular> {
        if !diagonal.invert(cpu) {
            return Err(Singular { index: i });
        }
        self.inverse[i] = diagonal;
        Ok(())
    }
}

/// Prepares a tied block for elimination of its second half q; its first half p is that of the next block.
/// Rows q: D_qp p + D_qq q + U_qq q' = b_q. The couplings with p and q' are then all with the next block.
fn condense<const B: usize>(d: &mut Columns<B>, upper: &mut Columns<B>, lower: &mut Columns<B>, next: &mut Columns<B>) {
    let h = B / 2;
    let at = |m: &Columns<B>, r: usize, c: usize| m.0[c][r];
    let (from, up, low) = (d.clone(), upper.clone(), lower.clone());
    for m in [&mut *d, &mut *upper, &mut *lower] {
        *m = Columns([[0.0; MOST_LANES]; B]);
    }
    for r in 0..h {
        d.0[r][r] = 1.0;
        for c in 0..h {
            d.0[h + c][h + r] = at(&from, h + r, h + c);
            upper.0[c][h + r] = at(&from, h + r, c);
            upper.0[h + c][h + r] = at(&up, h + r, h + c);
            lower.0[h + c][r] = at(&from, r, h + c);
            lower.0[h + c][h + r] = at(&low, h + r, h + c);
            next.0[c][r] += at(&from, r, c);
        }
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
        let (middle, last) = (factor.middle, factor.inverse.len() - 1);
        let mut at = factor.entries;
        let mut c = 0;
        while c < B {
            at[c] *= stride;
            c += 1;
        }
        let (mut low, mut high) = (gather(b, &at, 0), gather(b, &at, last));
        for k in 0..middle.max(last - middle) {
            if k < middle {
                low = factor.eliminate(cpu, b, &at, &low, k, k + 1);
            }
            if k < last - middle {
                high = factor.eliminate(cpu, b, &at, &high, last - k, last - k - 1);
            }
        }
        low = factor.inverse[middle].multiply_add(cpu, &gather(b, &at, middle), &[0.0; MOST_LANES]);
        scatter(b, &at, middle, &low);
        high = low;
        for k in 1..=middle.max(last - middle) {
            if k <= middle {
                low = factor.substitute(cpu, b, &at, &low, middle - k);
            }
            if k <= last - middle {
                high = factor.substitute(cpu, b, &at, &high, middle + k);
            }
        }
    }
}

struct PartialSolution<'a, const B: usize> {
    factor: &'a Factor<B>,
    b: &'a mut [f64],
    stride: usize,
    runs: &'a [(usize, usize)],
}

impl<const B: usize> WithSimd for PartialSolution<'_, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) {
        let PartialSolution { factor, b, stride, runs } = self;
        let middle = factor.middle;
        let mut at = factor.entries;
        at.iter_mut().for_each(|entry| *entry *= stride);
        // The blocks on this side of the middle, and those beyond it, each run towards the middle: a block and whether a run begins with it.
        let below = || runs.iter().flat_map(|&(first, end)| (first..end.min(middle)).map(move |k| (k, k == first, k + 1 == end)));
        let above = || {
            runs.iter()
                .rev()
                .flat_map(|&(first, end)| (first.max(middle + 1)..end).rev().map(move |k| (k, k + 1 == end, k == first)))
        };
        let zero = [0.0; MOST_LANES];
        let (mut low, mut high) = (zero, zero);
        let (mut lows, mut highs) = (below(), above());
        loop {
            let (one, other) = (lows.next(), highs.next());
            if let Some((k, begins, ends)) = one {
                low = if begins { gather(b, &at, k) } else { low };
                if !ends {
                    low = factor.eliminate(cpu, b, &at, &low, k, k + 1);
                }
            }
            if let Some((k, begins, ends)) = other {
                high = if begins { gather(b, &at, k) } else { high };
                if !ends {
                    high = factor.eliminate(cpu, b, &at, &high, k, k - 1);
                }
            }
            if one.is_none() && other.is_none() {
                break;
            }
        }
        let mut centre = zero;
        if runs.iter().any(|(first, end)| (*first..*end).contains(&middle)) {
            centre = factor.inverse[middle].multiply_add(cpu, &gather(b, &at, middle), &zero);
            scatter(b, &at, middle, &centre);
        }
        (low, high) = (centre, centre);
        // Back again: what a run ends with towards the middle has no neighbour there, or the block in the middle.
        let back_below =
            || runs.iter().rev().flat_map(|&(first, end)| (first..end.min(middle)).rev().map(move |k| (k, k + 1 == end)));
        let back_above = || runs.iter().flat_map(|&(first, end)| (first.max(middle + 1)..end).map(move |k| (k, k == first)));
        let (mut lows, mut highs) = (back_below(), back_above());
        loop {
            let (one, other) = (lows.next(), highs.next());
            if let Some((k, apart)) = one {
                low = factor.substitute(cpu, b, &at, if apart { &zero } else { &low }, k);
            }
            if let Some((k, apart)) = other {
                high = factor.substitute(cpu, b, &at, if apart { &zero } else { &high }, k);
            }
            if one.is_none() && other.is_none() {
                break;
            }
        }
    }
}

impl<const B: usize> Factor<B> {
    /// Takes block `from`, whose right-hand side is `y`, out of the row of its neighbour `to`; returns the right-hand side there.
    #[inline(always)]
    fn eliminate<V: Simd>(
        &self,
        cpu: V,
        b: &mut [f64],
        at: &[usize; B],
        y: &[f64; MOST_LANES],
        from: usize,
        to: usize,
    ) -> [f64; MOST_LANES] {
        let y = self.forward[from].multiply_add(cpu, y, &gather(b, at, to));
        scatter(b, at, to, &y);
        y
    }

    /// Block `i` of the solution from that of its neighbour towards the middle.
    #[inline(always)]
    fn substitute<V: Simd>(&self, cpu: V, b: &mut [f64], at: &[usize; B], x: &[f64; MOST_LANES], i: usize) -> [f64; MOST_LANES] {
        let own = self.inverse[i].multiply_add(cpu, &gather(b, at, i), &[0.0; MOST_LANES]);
        let x = self.back[i].multiply_add(cpu, x, &own);
        scatter(b, at, i, &x);
        x
    }
}

/// Block i of a right-hand side whose entries begin at `at`.
#[inline(always)]
fn gather<const B: usize>(b: &[f64], at: &[usize; B], i: usize) -> [f64; MOST_LANES] {
    let mut x = [0.0; MOST_LANES];
    for c in 0..B {
        x[c] = b[at[c] + i];
    }
    x
}

#[inline(always)]
fn scatter<const B: usize>(b: &mut [f64], at: &[usize; B], i: usize, x: &[f64; MOST_LANES]) {
    for c in 0..B {
        b[at[c] + i] = x[c];
    }
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
            let mut factor = Factor::new(5, [0, 1, 2, 3, 4, 5]);
            factor.factor(&a).unwrap();
            factor.solve(&mut flat, 5);
            for i in 0..5 {
                let found = SVector::<f64, 6>::from_fn(|c, _| flat[c * 5 + i]);
                assert!((found - x[i]).norm() < 1e-13, "{tied:?} block {i}");
            }
        }
    }

    /// Unknowns 0, 2, 3 and 5 of blocks in which 1 and 4 stand apart: the same as in a solution of all.
    #[test]
    fn some_unknowns_alone_are_solved_for_as_among_all() {
        let tied = vec![false, true, false, false, false];
        let apart = |k: usize| k == 1 || k == 4;
        let entry = |i: usize, r: usize, c: usize| {
            let size = 0.1 * ((7 * i + 3 * r + 5 * c) % 11) as f64 - 0.5;
            if apart(r) || apart(c) { 0.0 } else { size }
        };
        let mut a = BlockTridiagonal::<6>::new(tied.clone());
        for i in 0..6 {
            a.diagonal[i] = Block::from_fn(|r, c| entry(i, r, c) + if r == c { 6.0 } else { 0.0 });
            if i < 5 {
                let held = |r: usize, c: usize| tied[i] && (r < 3 || c < 3);
                a.upper[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { entry(i + 6, r, c) });
                a.lower[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { entry(i + 12, r, c) });
            }
        }
        let mut all: Vec<f64> = (0..36).map(|k| if apart(k / 6) { 0.0 } else { ((k * k) % 13) as f64 }).collect();
        let mut some = all.clone();
        let (mut every, mut few) = (Factor::new(6, [0, 1, 2, 3, 4, 5]), Factor::new(6, [0, 2, 3, 5]));
        every.factor(&a).unwrap();
        few.factor(&a).unwrap();
        every.solve(&mut all, 6);
        few.solve(&mut some, 6);
        all.iter().zip(&some).for_each(|(x, y)| assert!((x - y).abs() < 1e-13, "{x} {y}"));
    }

    /// Three chains that stand apart: any of them alone are solved for as among all (to rounding: what meets in the middle is summed up in another
    /// order), whichever holds the block in the middle, and the right-hand sides of the others stay.
    #[test]
    fn runs_alone_are_solved_for_as_among_all() {
        let chains = [(0, 3), (3, 8), (8, 10), (10, 13)];
        let entry = |i: usize, r: usize, c: usize| 0.1 * ((7 * i + 3 * r + 5 * c) % 11) as f64 - 0.5;
        let tied = (0..12).map(|i| i == 4).collect();
        let mut a = BlockTridiagonal::<6>::new(tied);
        for i in 0..13 {
            a.diagonal[i] = Block::from_fn(|r, c| entry(i, r, c) + if r == c { 6.0 } else { 0.0 });
            if i < 12 && !chains.iter().any(|(_, end)| *end == i + 1) {
                let held = |r: usize, c: usize| i == 4 && (r < 3 || c < 3);
                a.upper[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { entry(i + 6, r, c) });
                a.lower[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { entry(i + 12, r, c) });
            }
        }
        let mut factor = Factor::new(13, [0, 1, 2, 3, 4, 5]);
        factor.factor(&a).unwrap();
        let right: Vec<f64> = (0..78).map(|k| ((k * k) % 13) as f64 - 5.0).collect();
        let mut all = right.clone();
        factor.solve(&mut all, 13);
        for chosen in 0..16 {
            let runs: Vec<(usize, usize)> = (0..4).filter(|k| chosen >> k & 1 == 1).map(|k| chains[k]).collect();
            let mut some = right.clone();
            factor.solve_runs(&mut some, 13, &runs);
            for k in 0..78 {
                let inside = runs.iter().any(|(first, end)| (*first..*end).contains(&(k % 13)));
                let expected = if inside { all[k] } else { right[k] };
                assert!((some[k] - expected).abs() < 1e-13, "{runs:?}, entry {k}: {} {expected}", some[k]);
            }
        }
    }

    /// Four chains that stand apart, any of them with other numbers: factored alone, they solve to the last bit as in a factor of all, and so do the
    /// others, whichever holds the block in the middle.
    #[test]
    fn runs_factored_anew_are_factored_as_among_all() {
        let chains = [(0, 3), (3, 8), (8, 10), (10, 13)];
        let entry = |i: usize, r: usize, c: usize| 0.1 * ((7 * i + 3 * r + 5 * c) % 11) as f64 - 0.5;
        let fill = |a: &mut BlockTridiagonal<6>, (first, end): (usize, usize), by: f64| {
            for i in first..end {
                a.diagonal[i] = Block::from_fn(|r, c| by * entry(i, r, c) + if r == c { 6.0 } else { 0.0 });
                if i + 1 < end {
                    let held = |r: usize, c: usize| i == 4 && (r < 3 || c < 3);
                    a.upper[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { by * entry(i + 6, r, c) });
                    a.lower[i] = Block::from_fn(|r, c| if held(r, c) { 0.0 } else { by * entry(i + 12, r, c) });
                }
            }
        };
        for chosen in 0..16 {
            let mut a = BlockTridiagonal::<6>::new((0..12).map(|i| i == 4).collect());
            chains.iter().for_each(|chain| fill(&mut a, *chain, 1.0));
            let (mut partly, mut wholly) = (Factor::new(13, [0, 1, 2, 3, 4, 5]), Factor::new(13, [0, 1, 2, 3, 4, 5]));
            partly.factor(&a).unwrap();
            let runs: Vec<(usize, usize)> = (0..4).filter(|k| chosen >> k & 1 == 1).map(|k| chains[k]).collect();
            runs.iter().for_each(|run| fill(&mut a, *run, 0.7));
            wholly.factor(&a).unwrap();
            // Of chains that are not to be factored nothing is read.
            for (first, end) in chains.iter().filter(|chain| !runs.contains(chain)) {
                a.clear_between(*first, *end);
            }
            partly.factor_runs(&a, &runs).unwrap();
            let right: Vec<f64> = (0..78).map(|k| ((k * k) % 13) as f64 - 5.0).collect();
            let (mut one, mut other) = (right.clone(), right);
            partly.solve(&mut one, 13);
            wholly.solve(&mut other, 13);
            assert_eq!(one, other, "{runs:?}");
        }
    }

    #[test]
    fn a_singular_block_is_named() {
        let mut a = BlockTridiagonal::<6>::new(vec![false; 2]);
        a.diagonal.fill(Block::identity());
        a.diagonal[1][(2, 2)] = 0.0;
        assert_eq!(Factor::new(3, [0, 1, 2, 3, 4, 5]).factor(&a), Err(Singular { index: 1 }));
    }
}
