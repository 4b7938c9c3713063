//! Banded systems A x = b in O(n), by Gaussian elimination with row pivoting.
//!
//! Row i of A has entries in columns i - b … i + b. A row that is swapped up during elimination reaches b columns farther to the
//! right, so every row is stored with room for 3 b + 1 entries, the first of them in column i - b.

/// A square matrix with `half` diagonals on either side of the main one, and the right-hand side.
#[derive(Debug, Clone)]
pub struct Banded {
    half: usize,
    width: usize,
    size: usize,
    rows: Vec<f64>,
    /// Right-hand side; after `solve` the solution.
    pub right: Vec<f64>,
}

impl Banded {
    /// A zero matrix of `size` rows with `half` diagonals on either side.
    pub fn new(size: usize, half: usize) -> Banded {
        let width = 3 * half + 1;
        Banded { half, width, size, rows: vec![0.0; size * width], right: vec![0.0; size] }
    }

    /// Sets matrix and right-hand side to zero.
    pub fn clear(&mut self) {
        self.rows.fill(0.0);
        self.right.fill(0.0);
    }

    /// Adds to an entry inside the band.
    #[inline(always)]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row * self.width + column + self.half - row] += value;
    }

    /// Replaces a row by x_row = value.
    pub fn prescribe(&mut self, row: usize, value: f64) {
        self.rows[row * self.width..][..self.width].fill(0.0);
        self.add(row, row, 1.0);
        self.right[row] = value;
    }

    /// Solves in place; the matrix is used up. On failure the row without a usable pivot is returned.
    pub fn solve(&mut self) -> Result<(), usize> {
        let (n, half, width) = (self.size, self.half, self.width);
        for k in 0..n {
            let below = (k + half + 1).min(n);
            // Column k stands at place k + half - i of row i.
            let entry = |rows: &[f64], i: usize| rows[i * width + k + half - i];
            let mut pivot = k;
            for i in k + 1..below {
                if entry(&self.rows, i).abs() > entry(&self.rows, pivot).abs() {
                    pivot = i;
                }
            }
            let reach = (k + 2 * half + 1).min(n) - k;
            if pivot != k {
                let (upper, lower) = self.rows.split_at_mut(pivot * width);
                let start = k + half - pivot;
                upper[k * width + half..][..reach].swap_with_slice(&mut lower[start..][..reach]);
                self.right.swap(k, pivot);
            }
            let (upper, lower) = self.rows.split_at_mut((k + 1) * width);
            let top = &upper[k * width + half..][..reach];
            if !(top[0].abs() > 0.0 && top[0].is_finite()) {
                return Err(k);
            }
            for i in k + 1..below {
                let row = &mut lower[(i - k - 1) * width + k + half - i..][..reach];
                let factor = row[0] / top[0];
                if factor != 0.0 {
                    row.iter_mut().zip(top).for_each(|(x, t)| *x -= factor * t);
                    self.right[i] -= factor * self.right[k];
                }
            }
        }
        for k in (0..n).rev() {
            let reach = (k + 2 * half + 1).min(n) - k;
            let row = &self.rows[k * width + half..][..reach];
            let known: f64 = row[1..].iter().zip(&self.right[k + 1..]).map(|(a, x)| a * x).sum();
            self.right[k] = (self.right[k] - known) / row[0];
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that needs pivoting everywhere (zero diagonal in places), as the mixed element's: the residual is at rounding.
    #[test]
    fn solves_an_indefinite_system_to_rounding() {
        let (n, half) = (23, 4);
        let entry = |i: usize, j: usize| if i == j && i.is_multiple_of(3) { 0.0 } else { ((7 * i + 3 * j) as f64).sin() + 0.3 };
        let mut system = Banded::new(n, half);
        for i in 0..n {
            system.right[i] = (i as f64).cos();
            for j in i.saturating_sub(half)..(i + half + 1).min(n) {
                system.add(i, j, entry(i, j));
            }
        }
        system.solve().expect("regular");
        for i in 0..n {
            let product: f64 = (i.saturating_sub(half)..(i + half + 1).min(n)).map(|j| entry(i, j) * system.right[j]).sum();
            assert!((product - (i as f64).cos()).abs() < 1e-12, "row {i}: {product}");
        }
    }

    #[test]
    fn a_singular_system_names_its_row() {
        let mut system = Banded::new(3, 1);
        system.add(0, 0, 1.0);
        system.add(2, 2, 1.0);
        assert_eq!(system.solve(), Err(1));
    }

    #[test]
    fn a_prescribed_unknown_has_its_value() {
        let mut system = Banded::new(3, 1);
        for i in 0..3 {
            system.add(i, i, 2.0);
        }
        system.add(0, 1, 1.0);
        system.prescribe(1, 5.0);
        system.solve().expect("regular");
        assert_eq!((system.right[1], system.right[0]), (5.0, -2.5));
    }
}
