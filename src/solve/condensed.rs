//! The factor of a network: lines that hang on bodies and points, and these.
//!
//! ```text
//! x_e = B y,   S = A_yy + Bᵀ (A_ee - A_ef A_ff⁻¹ A_fe) B,   S y = b_y + Bᵀ b_e - Bᵀ A_ef A_ff⁻¹ b_f,   x_f = A_ff⁻¹ (b_f - A_fe x_e)
//! ```
//!
//! y unknowns of bodies and points (masters), x_e positions of the ends that hang on them, x_f all else of the lines, B levers. With the
//! ends fixed the lines do not know of each other, so that A_ff is block-tridiagonal in one piece, and the columns A_ff⁻¹ A_fe of all lines
//! are solved for at once: three for their first hanging ends, three for their second. The direction of a clamp on a body hangs on it as an end
//! does: it moves nothing but the slope that is clamped to it.

use crate::algebra::block_tridiagonal::{Block, BlockTridiagonal, Factor, Singular};
use crate::rod::motion::Motion;
use crate::rod::state::{COMPONENTS, Field};
use crate::rod::system::{Links, System};
use nalgebra::{DMatrix, DVector, Dyn, LU, Matrix3x6, Matrix6, SMatrix, SymmetricEigen, Vector3, Vector6};

/// A row of blocks of a hanging end.
type Row = SMatrix<f64, 3, 6>;

/// What couples a hanging end with the unknowns beside it.
#[derive(Debug, Clone, Default)]
struct Coupling {
    /// A_ee.
    own: nalgebra::Matrix3<f64>,
    /// (node, its couplings): of the end itself, where only slopes count, and of its neighbour.
    row: Vec<(usize, Row)>,
}

/// The factor.
#[derive(Clone)]
pub struct Condensed {
    links: Links,
    factor: Factor<COMPONENTS>,
    couplings: Vec<Coupling>,
    levers: Vec<Matrix3x6<f64>>,
    /// A_ff⁻¹ A_fe, a column each: components of the first that hangs of every line, then of the second, and so on.
    columns: Vec<Field>,
    condensed: DMatrix<f64>,
    /// Rows of S that are solved for: all but those of prescribed unknowns, of which points have three.
    free: Vec<usize>,
    solver: Option<LU<f64, Dyn, Dyn>>,
}

impl Condensed {
    /// Room for the factor of a network of so many nodes.
    pub fn new(nodes: usize, links: &Links) -> Condensed {
        let hanging = links.links.len() + links.clamped.len();
        let slots = links.links.iter().chain(&links.clamped).map(|link| link.slot + 1).max().unwrap_or(0);
        let size = COMPONENTS * links.masters.len();
        Condensed {
            links: links.clone(),
            factor: Factor::new(nodes, std::array::from_fn(|c| c)),
            couplings: vec![Coupling::default(); hanging],
            levers: vec![Matrix3x6::zeros(); hanging],
            columns: vec![Field::new(nodes); 3 * slots],
            condensed: DMatrix::zeros(size, size),
            free: Vec::with_capacity(size),
            solver: None,
        }
    }

    /// S: stiffness of the masters against their unknowns, all else following, where the matrix is that of a static tangent.
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.condensed
    }

    /// The smallest eigenvalue of the symmetric part of D S D, D a diagonal that makes entries of one size, and its direction in the unknowns.
    pub fn softest(&self, scales: &DVector<f64>) -> (f64, DVector<f64>) {
        let scaled = DMatrix::from_fn(scales.len(), scales.len(), |row, column| {
            0.5 * (self.condensed[(row, column)] + self.condensed[(column, row)]) * scales[row] * scales[column]
        });
        let eigen = SymmetricEigen::new(scaled);
        let (index, value) = eigen
            .eigenvalues
            .iter()
            .enumerate()
            .fold((0, f64::INFINITY), |least, (index, value)| if *value < least.1 { (index, *value) } else { least });
        let direction = eigen.eigenvectors.column(index.min(scales.len() - 1)).component_mul(scales);
        (value, direction)
    }

    /// Adds to the diagonal of S and factors it anew; false where that fails.
    pub fn stiffen(&mut self, by: &DVector<f64>) -> bool {
        let free = &self.free;
        let mut stiffened = DMatrix::from_fn(free.len(), free.len(), |row, column| self.condensed[(free[row], free[column])]);
        free.iter().enumerate().for_each(|(k, unknown)| stiffened[(k, k)] += by[*unknown]);
        let finite = stiffened.iter().all(|x| x.is_finite());
        let solver = stiffened.lu();
        let fine = finite && (free.is_empty() || solver.is_invertible());
        self.solver = Some(solver);
        fine
    }

    /// Factors the matrix of a motion, of which prescribed unknowns have been taken out; `weight`: that of ∂R/∂u in it. Of `lines`, from their first
    /// nodes to before their ends, it says what they are now, and of bodies and points; all other lines stay as they were factored before.
    /// None: all anew.
    pub fn factor(
        &mut self,
        system: &dyn System,
        at: &Motion,
        weight: f64,
        matrix: &mut BlockTridiagonal<COMPONENTS>,
        lines: Option<&[(usize, usize)]>,
    ) -> Result<(), Singular> {
        self.condense(system, at, weight, matrix, lines)?;
        let fine = self.stiffen(&DVector::zeros(self.condensed.nrows()));
        if fine { Ok(()) } else { Err(Singular { index: self.links.masters.first().copied().unwrap_or(0) }) }
    }

    /// Makes S; `stiffen` must follow before a solution.
    pub fn condense(
        &mut self,
        system: &dyn System,
        at: &Motion,
        weight: f64,
        matrix: &mut BlockTridiagonal<COMPONENTS>,
        lines: Option<&[(usize, usize)]>,
    ) -> Result<(), Singular> {
        let ranges = &self.links.ranges;
        let renewed = lines.unwrap_or(ranges);
        let anew = |line: usize| lines.is_none() || renewed.contains(&ranges[line]);
        system.levers(at, &mut self.levers);
        self.condensed.fill(0.0);
        for (number, &node) in self.links.masters.iter().enumerate() {
            self.condensed.fixed_view_mut::<6, 6>(6 * number, 6 * number).copy_from(&matrix.diagonal[node]);
            (0..COMPONENTS).for_each(|component| matrix.fix(node, component));
        }
        for column in &mut self.columns {
            for &(first, end) in renewed {
                (0..COMPONENTS).for_each(|c| column.component_mut(c)[first..end].fill(0.0));
            }
        }
        for (link, coupling) in self.links.links.iter().zip(&mut self.couplings).filter(|(link, _)| anew(link.line)) {
            let node = link.node;
            let (first, end) = self.links.ranges[link.line];
            let own: Block<6> = matrix.diagonal[node];
            coupling.own = own.fixed_view::<3, 3>(0, 0).into();
            coupling.row.clear();
            let mut slopes: Row = own.fixed_rows::<3>(0).into();
            slopes.fixed_columns_mut::<3>(0).fill(0.0);
            coupling.row.push((node, slopes));
            let add = |columns: &mut [Field], at: usize, block: SMatrix<f64, 6, 3>, from: usize| {
                for c in 0..3 {
                    let column = &mut columns[3 * link.slot + c];
                    (from..COMPONENTS).for_each(|r| column.component_mut(r)[at] += block[(r, c)]);
                }
            };
            add(&mut self.columns, node, own.fixed_columns::<3>(0).into(), 3);
            if node > first {
                coupling.row.push((node - 1, matrix.lower[node - 1].fixed_rows::<3>(0).into()));
                add(&mut self.columns, node - 1, matrix.upper[node - 1].fixed_columns::<3>(0).into(), 0);
            }
            if node + 1 < end {
                coupling.row.push((node + 1, matrix.upper[node].fixed_rows::<3>(0).into()));
                add(&mut self.columns, node + 1, matrix.lower[node].fixed_columns::<3>(0).into(), 0);
            }
        }
        for (number, link) in self.links.clamped.iter().enumerate().filter(|(_, link)| anew(link.line)) {
            let crossed = system.crossed(at, number) * weight;
            let coupling = &mut self.couplings[self.links.links.len() + number];
            coupling.own.fill(0.0);
            let mut row = Row::zeros();
            row.fixed_columns_mut::<3>(3).copy_from(&crossed.transpose());
            coupling.row.clear();
            coupling.row.push((link.node, row));
            for c in 0..3 {
                let column = &mut self.columns[3 * link.slot + c];
                (0..3).for_each(|r| column.component_mut(3 + r)[link.node] += crossed[(r, c)]);
            }
        }
        for link in &self.links.links {
            (0..3).for_each(|component| matrix.fix(link.node, component));
        }
        // The ends take their own part in the row of another end beside them, and no right-hand side.
        let fixed = system.fixed();
        for column in &mut self.columns {
            fixed.iter().for_each(|&(node, component)| column.component_mut(component)[node] = 0.0);
            for link in &self.links.links {
                column.set_position(link.node, &Vector3::zeros());
            }
        }
        match lines {
            None => self.factor.factor(matrix)?,
            Some(lines) => self.factor.factor_runs(matrix, lines)?,
        }
        // The line that holds the block in the middle is summed up in an order that depends on what is solved for beside it: alone, it comes out the same.
        let (central, others): (Vec<_>, Vec<_>) =
            renewed.iter().partition(|(first, end)| (*first..*end).contains(&self.factor.middle()));
        for column in &mut self.columns {
            let stride = column.stride();
            self.factor.solve_runs(column.data_mut(), stride, &others);
            self.factor.solve_runs(column.data_mut(), stride, &central);
        }
        let ends = self.links.links.len();
        for (one, link) in self.links.hanging() {
            for (other, beside) in self.links.hanging().filter(|(_, beside)| beside.line == link.line) {
                let mut block = if one == other { self.couplings[one].own } else { nalgebra::Matrix3::zeros() };
                for (node, row) in &self.couplings[one].row {
                    if *node == beside.node && one != other && other < ends {
                        block += row.fixed_columns::<3>(0);
                    }
                    for c in 0..3 {
                        let column = &self.columns[3 * beside.slot + c];
                        let x = Vector6::from_fn(|r, _| column.component(r)[*node]);
                        block.set_column(c, &(block.column(c) - row * x));
                    }
                }
                let add: Matrix6<f64> = self.levers[one].tr_mul(&(block * self.levers[other]));
                let (row, column) = (6 * link.master, 6 * beside.master);
                let mut view = self.condensed.fixed_view_mut::<6, 6>(row, column);
                view += add;
            }
        }
        let size = self.condensed.diagonal().amax().max(1.0);
        self.free.clear();
        self.free.extend(0..self.condensed.nrows());
        for &(node, component) in fixed {
            if let Some(master) = self.links.masters.iter().position(|master| *master == node) {
                let k = 6 * master + component;
                self.condensed.row_mut(k).fill(0.0);
                self.condensed.column_mut(k).fill(0.0);
                self.condensed[(k, k)] = size;
                self.free.retain(|free| *free != k);
            }
        }
        Ok(())
    }

    /// Solves with the factor: b, of which forces on hanging ends have been taken to their masters, becomes the solution. The levers of the factor
    /// may be those of another time; those of the forces may not.
    pub fn solve(&self, b: &mut Field) {
        let stride = b.stride();
        self.solve_by(b, |factor, b| factor.solve(b.data_mut(), stride));
    }

    /// The same, where b is zero inside all lines but those of `runs`, from their first nodes to before their ends.
    pub fn solve_runs(&self, b: &mut Field, runs: &[(usize, usize)]) {
        let stride = b.stride();
        self.solve_by(b, |factor, b| factor.solve_runs(b.data_mut(), stride, runs));
    }

    /// Takes from the forces on hanging ends [N] what a displacement of all takes from them by the matrix that was factored.
    pub fn relax(&self, x: &Field, forces: &mut [Vector3<f64>]) {
        for ((link, coupling), force) in self.links.links.iter().zip(&self.couplings).zip(forces) {
            *force -= coupling.own * x.position(link.node);
            for (node, row) in &coupling.row {
                *force -= row * Vector6::from_fn(|r, _| x.component(r)[*node]);
            }
        }
    }

    fn solve_by(&self, b: &mut Field, of_lines: impl FnOnce(&Factor<COMPONENTS>, &mut Field)) {
        let mut right = DVector::zeros(self.condensed.nrows());
        for (number, &node) in self.links.masters.iter().enumerate() {
            for c in 0..COMPONENTS {
                right[6 * number + c] = b.component(c)[node];
                b.component_mut(c)[node] = 0.0;
            }
        }
        for link in &self.links.links {
            b.set_position(link.node, &Vector3::zeros());
        }
        of_lines(&self.factor, b);
        for (number, link) in self.links.hanging() {
            let mut force = Vector3::zeros();
            for (node, row) in &self.couplings[number].row {
                force += row * Vector6::from_fn(|r, _| b.component(r)[*node]);
            }
            let mut part = right.fixed_rows_mut::<6>(6 * link.master);
            part -= self.levers[number].tr_mul(&force);
        }
        let mut solved = DVector::from_iterator(self.free.len(), self.free.iter().map(|unknown| right[*unknown]));
        // Lines that are clamped to what is driven have no masters.
        if let Some(solver) = self.solver.as_ref().filter(|_| !solved.is_empty()) {
            solver.solve_mut(&mut solved);
        }
        right.fill(0.0);
        self.free.iter().zip(&solved).for_each(|(unknown, x)| right[*unknown] = *x);
        for (number, link) in self.links.hanging() {
            let moved: Vector3<f64> = self.levers[number] * right.fixed_rows::<6>(6 * link.master);
            let (first, end) = self.links.ranges[link.line];
            let [x, y, z] = [0, 1, 2].map(|c| (-moved[c], &self.columns[3 * link.slot + c]));
            b.add_between(first, end, [x, y, z]);
        }
        for (number, link) in self.links.links.iter().enumerate() {
            let moved: Vector3<f64> = self.levers[number] * right.fixed_rows::<6>(6 * link.master);
            b.set_position(link.node, &moved);
        }
        for (number, &node) in self.links.masters.iter().enumerate() {
            (0..COMPONENTS).for_each(|c| b.component_mut(c)[node] = right[6 * number + c]);
        }
    }
}
