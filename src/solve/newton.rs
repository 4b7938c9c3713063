//! One nonlinear stage: find the increment x with R(u + c_u x, v + c_v x, a + c_a x) = 0 for the unknowns that are free.
//!
//! Statics, every scheme and every stage are this problem with other weights. The iteration is a modified Newton method: the factor
//! of the tangent is kept as long as the iteration contracts well and the weights have not changed much. What it was made from is kept
//! with it, and makes it again after the solver has gone back to an earlier memory.

use crate::algebra::block_tridiagonal::{BlockTridiagonal, Singular};
use crate::algebra::definite::is_positive_definite;
use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::state::{COMPONENTS, Field, State};
use crate::rod::system::System;
use crate::solve::memory::{Memory, Shelf};
use crate::solve::open_lines::{OpenLines, left};
use crate::solve::search;
use crate::solve::unknowns::Unknowns;
use nalgebra::{Matrix3, Matrix6, SVector, Vector3};
use std::ops::AddAssign;
use std::sync::Arc;

mod apart;

/// How a stage is to be solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criteria {
    /// Increment of u that counts as converged: slopes as they are, positions divided by `length`.
    pub tolerance: f64,
    /// Length that scales positions [m].
    pub length: f64,
    /// How much more an increment of free bodies and points counts.
    pub emphasis: f64,
    /// Iterations before giving up.
    pub iterations: usize,
    /// Where whole steps fail, an increment that is not below `tolerance` counts as converged, too, if it is below `loose`
    pub loose: f64,
    /// and changes the energy by less than this [J].
    pub enough: f64,
}

/// Why a stage was not solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stall {
    /// The tangent could not be factored at a node.
    Singular {
        /// The node.
        node: usize,
    },
    /// The iteration did not contract; the increment was largest at a node.
    Diverging {
        /// The node.
        node: usize,
    },
    /// A force or increment was not finite at a node.
    NotFinite {
        /// The node.
        node: usize,
    },
}

impl Stall {
    /// Where it happened.
    pub fn node(&self) -> usize {
        match *self {
            Stall::Singular { node } | Stall::Diverging { node } | Stall::NotFinite { node } => node,
        }
    }

    /// The same with nodes counted from another one.
    pub fn moved_back(self, by: usize) -> Stall {
        let node = self.node().saturating_sub(by);
        match self {
            Stall::Singular { .. } => Stall::Singular { node },
            Stall::Diverging { .. } => Stall::Diverging { node },
            Stall::NotFinite { .. } => Stall::NotFinite { node },
        }
    }
}

/// Work done by the iteration.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Effort {
    /// Iterations: one residual and one solution each.
    pub iterations: usize,
    /// Factorisations.
    pub factorisations: usize,
    /// Those of them that were of some lines of a network alone.
    pub partial: usize,
    /// Elements of lines that were done in an iteration that others still needed, over all iterations.
    pub spared: usize,
}

/// The solver of stages of one line.
pub struct Newton {
    matrix: BlockTridiagonal<COMPONENTS>,
    unknowns: Unknowns,
    memory: Memory,
    /// The factor at hand is the one that the memory speaks of.
    at_hand: bool,
    shelf: Shelf,
    increment: Field,
    residual: Field,
    start: State,
    /// Which lines of a network a stage looks at; none of a line alone.
    open: Option<Box<OpenLines>>,
    /// Work done so far.
    pub effort: Effort,
    /// Whether steps are so short that the contraction is to be looked at now and then.
    pub watched: bool,
}

/// Largest change of c_u (relative) for which an old factor is still tried.
const STALE: f64 = 0.3;
/// Damped iterations before giving up.
const DAMPED: usize = 25;
/// Damped iterations up to which the next stage is tried with whole steps again.
const SMOOTH: usize = 2;
/// Contraction beyond which the tangent is factored anew.
const SLOW: f64 = 0.15;
/// An iteration that ends with its first increment does not show how it contracts. In steps so short that all end so, the factor would grow old
/// unseen, and what a stage leaves comes back three times as large in the next prediction, with the other sign each step. So, where steps
/// are watched, what is known of the contraction grows by this with each such stage,
const AGEING: f64 = 1.05;
/// from here on a second increment is made, which shows it,
const UNSURE: f64 = 0.5;
/// unless the first is below this part of the tolerance,
const FAINT: f64 = 1.0e-3;
/// and a factor that contracts no better than this is made anew: a third would be too much.
const GROWING: f64 = 0.25;

impl Newton {
    /// A solver for a line.
    pub fn new(line: &dyn System) -> Newton {
        let nodes = line.nodes();
        Newton {
            matrix: BlockTridiagonal::new(line.ties()),
            unknowns: Unknowns::new(line),
            memory: Memory::none(),
            at_hand: false,
            shelf: Shelf::default(),
            increment: Field::new(nodes),
            residual: Field::new(nodes),
            start: State::new(nodes),
            open: line.links().map(|links| Box::new(OpenLines::new(links))),
            effort: Effort::default(),
            watched: false,
        }
    }

    /// Forgets the factor, so that what follows depends on the state alone.
    pub fn forget(&mut self) {
        self.recall(&Memory::none());
    }

    /// Lets lines of a network be looked at until all are done, for comparison.
    #[cfg(test)]
    pub fn look_at_all(&mut self) {
        self.open.iter_mut().for_each(|open| open.lasting = true);
    }

    /// What the next stage takes over from those before.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Whether the last stage lay at a kink that whole steps do not get round.
    pub fn is_rough(&self) -> bool {
        self.memory.rough
    }

    /// Goes on from a memory of this line. A factor that it speaks of is made again when it is needed, if it is not at hand.
    pub fn recall(&mut self, memory: &Memory) {
        let same = match (&self.memory.origin, &memory.origin) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        };
        self.at_hand &= same;
        let left = std::mem::replace(&mut self.memory, memory.clone());
        self.shelf.put(left.origin.filter(|_| !same));
    }

    /// Makes the factor that the memory speaks of, where another is at hand.
    fn remake(&mut self, line: &dyn System) -> Result<(), Stall> {
        if let (Some(origin), false) = (&self.memory.origin, self.at_hand) {
            line.tangent(&motion(&origin.state), &origin.weights, None, &mut self.matrix);
            self.effort.factorisations += 1;
            self.unknowns
                .factor(line, &motion(&origin.state), origin.weights.u, &mut self.matrix, None)
                .map_err(|Singular { index }| Stall::Singular { node: index })?;
            self.at_hand = true;
        }
        Ok(())
    }

    /// Whether the symmetric part of the tangent of a motion is positive definite, with given tensions in its geometric part, or its own.
    /// `across`: a unit vector along which nothing pulls at the line; motion along it does not count. Drops the factor at hand.
    pub fn is_definite(
        &mut self,
        line: &dyn System,
        at: &Motion,
        weights: &Weights,
        geometric: Option<&[f64]>,
        across: Option<Vector3<f64>>,
    ) -> bool {
        self.forget();
        line.tangent(at, weights, geometric, &mut self.matrix);
        line.fixed().iter().for_each(|&(node, component)| self.matrix.fix(node, component));
        if let Some(across) = across {
            without(&mut self.matrix, &across);
        }
        is_positive_definite(&self.matrix)
    }

    /// Factors the tangent of a motion. One with a given geometric part is not used again by later stages.
    pub fn factor(&mut self, line: &dyn System, at: &Motion, weights: &Weights, geometric: Option<&[f64]>) -> Result<(), Stall> {
        self.at_hand = false;
        let left = self.memory.origin.take();
        self.shelf.put(left);
        line.tangent(at, weights, geometric, &mut self.matrix);
        self.effort.factorisations += 1;
        self.unknowns
            .factor(line, at, weights.u, &mut self.matrix, None)
            .map_err(|Singular { index }| Stall::Singular { node: index })?;
        if geometric.is_none() {
            self.memory.origin = Some(self.shelf.origin(at, weights));
            self.at_hand = true;
        }
        Ok(())
    }

    /// Static stiffness of the line against its fairlead, ∂R/∂x condensed on the last node [N/m]; none where the line has no
    /// stiffness of its own (a heap of slack line). The memory stays as it is.
    pub fn fairlead_stiffness(&mut self, line: &dyn System, state: &State) -> Option<Matrix3<f64>> {
        let memory = self.memory.clone();
        let stiffness = self.condense(line, state);
        self.recall(&memory);
        stiffness
    }

    /// Static stiffness against both ends, those of the anchor before those of the fairlead [N/m], as `fairlead_stiffness`.
    pub fn end_stiffness(&mut self, line: &dyn System, state: &State) -> Option<Matrix6<f64>> {
        let memory = self.memory.clone();
        let weights = Weights { u: 1.0, v: 0.0, a: 0.0 };
        line.tangent(&motion(state), &weights, None, &mut self.matrix);
        let full = self.matrix.clone();
        let factored = self.factor(line, &motion(state), &weights, None).is_ok();
        let (last, nodes) = (line.last(), line.nodes());
        let mut stiffness = Matrix6::zeros();
        for column in 0..6 {
            let mut x = vec![SVector::<f64, COMPONENTS>::zeros(); nodes];
            let mut force = x.clone();
            x[if column < 3 { 0 } else { last }][column % 3] = 1.0;
            full.multiply(&x, &mut force);
            let mut field = Field::new(nodes);
            for (node, f) in force.iter().enumerate() {
                field.set_position(node, &-f.fixed_rows::<3>(0));
                field.set_slope(node, &-f.fixed_rows::<3>(3));
            }
            self.solve_linear(line, &mut field);
            for (node, x) in x.iter_mut().enumerate() {
                x.fixed_rows_mut::<3>(0).add_assign(field.position(node));
                x.fixed_rows_mut::<3>(3).add_assign(field.slope(node));
            }
            full.multiply(&x, &mut force);
            stiffness.fixed_view_mut::<3, 1>(0, column).copy_from(&force[0].fixed_rows::<3>(0));
            stiffness.fixed_view_mut::<3, 1>(3, column).copy_from(&force[last].fixed_rows::<3>(0));
        }
        self.recall(&memory);
        (factored && stiffness.iter().all(|k| k.is_finite())).then_some(stiffness)
    }

    fn condense(&mut self, line: &dyn System, state: &State) -> Option<Matrix3<f64>> {
        let weights = Weights { u: 1.0, v: 0.0, a: 0.0 };
        line.tangent(&motion(state), &weights, None, &mut self.matrix);
        let full = self.matrix.clone();
        self.factor(line, &motion(state), &weights, None).ok()?;
        let (last, nodes) = (line.last(), line.nodes());
        let mut stiffness = Matrix3::zeros();
        for c in 0..3 {
            let mut x = vec![SVector::<f64, COMPONENTS>::zeros(); nodes];
            let mut force = x.clone();
            x[last][c] = 1.0;
            full.multiply(&x, &mut force);
            let mut field = Field::new(nodes);
            for (node, f) in force.iter().enumerate() {
                field.set_position(node, &-f.fixed_rows::<3>(0));
                field.set_slope(node, &-f.fixed_rows::<3>(3));
            }
            self.solve_linear(line, &mut field);
            for (node, x) in x.iter_mut().enumerate() {
                x.fixed_rows_mut::<3>(0).add_assign(field.position(node));
                x.fixed_rows_mut::<3>(3).add_assign(field.slope(node));
            }
            full.multiply(&x, &mut force);
            stiffness.set_column(c, &force[last].fixed_rows::<3>(0));
        }
        stiffness.iter().all(|k| k.is_finite()).then_some(stiffness)
    }

    /// Solves with the factor at hand: b becomes the solution; prescribed unknowns stay zero.
    pub fn solve_linear(&self, line: &dyn System, b: &mut Field) {
        self.unknowns.solve(line, b);
    }

    /// Solves a stage. `trial` holds the prediction, with the prescribed unknowns in place, and becomes the solution.
    pub fn solve(&mut self, line: &dyn System, weights: &Weights, trial: &mut State, criteria: &Criteria) -> Result<(), Stall> {
        if !self.memory.rough {
            self.start.copy_from(trial);
            let quick = match self.open.take() {
                None => self.iterate(line, weights, trial, criteria),
                Some(mut open) => {
                    let outcome = self.iterate_apart(&mut open, line, weights, trial, criteria);
                    self.open = Some(open);
                    outcome
                }
            };
            if quick.is_ok() {
                return quick;
            }
            trial.copy_from(&self.start);
        }
        let begun = self.effort.iterations;
        let damped = self.iterate_damped(line, weights, trial, criteria);
        self.memory.rough = self.effort.iterations - begun > SMOOTH;
        if damped.is_err() {
            self.forget();
        }
        damped
    }

    /// Has a factor for a stage at hand: the one of before where it may do, or a new one, of which is not known how it contracts;
    /// returns whether the stage is to show how the old one does.
    fn prepare(&mut self, line: &dyn System, weights: &Weights, trial: &State) -> Result<bool, Stall> {
        let fresh = |kept: &Weights| (kept.u / weights.u - 1.0).abs() < STALE && kept.a == weights.a;
        let old = self.memory.weights().is_some_and(fresh) && self.remake(line).is_ok();
        if !old {
            self.memory.rate = 1.0;
            self.memory.rates.fill(1.0);
            self.factor(line, &motion(trial), weights, None)?;
        }
        Ok(old && self.watched && self.memory.rate >= UNSURE)
    }

    /// At the end of a stage: what is known of the contraction grows old where it was not seen, and a factor that contracts badly is dropped.
    fn grow_old(&mut self, at_once: bool, unsure: bool, contraction: f64) {
        if at_once && self.watched && self.memory.rate < 1.0 {
            self.memory.rate = (AGEING * self.memory.rate).min(0.99);
        } else if unsure && contraction > GROWING {
            self.forget();
        }
    }

    /// Modified Newton: whole steps with an old factor, as long as they contract.
    fn iterate(&mut self, line: &dyn System, weights: &Weights, trial: &mut State, criteria: &Criteria) -> Result<(), Stall> {
        let unsure = self.prepare(line, weights, trial)?;
        let mut last = f64::INFINITY;
        let mut new_factor = self.memory.weights() == Some(weights) && self.memory.rate == 1.0;
        for iteration in 0..criteria.iterations {
            self.find_increment(line, trial, if iteration == 0 { Asking::First } else { Asking::Again });
            let size = self.retreat(line, weights, trial, criteria)?;
            let contraction = self.contracted(size, last);
            if left(size, self.memory.rate) < criteria.tolerance {
                if iteration == 0 && unsure && size > FAINT * criteria.tolerance {
                    last = size;
                    continue;
                }
                self.grow_old(iteration == 0, unsure, contraction);
                return Ok(());
            }
            if contraction > 2.0 && new_factor {
                return Err(Stall::Diverging { node: self.size(weights.u, criteria.length).1 });
            }
            if contraction > SLOW {
                self.factor(line, &motion(trial), weights, None)?;
                new_factor = true;
            }
            last = size;
        }
        Err(Stall::Diverging { node: self.size(weights.u, criteria.length).1 })
    }

    /// Takes the increment away, and returns its largest scaled entry.
    fn retreat(&self, line: &dyn System, weights: &Weights, trial: &mut State, criteria: &Criteria) -> Result<f64, Stall> {
        let scales = [weights.u.abs() / criteria.length, weights.u.abs()];
        let size = trial.retreat([weights.u, weights.v, weights.a], &self.increment, scales);
        line.follow(trial);
        if !size.is_finite() {
            return Err(Stall::NotFinite { node: self.size(weights.u, criteria.length).1 });
        }
        Ok(size)
    }

    /// Size of an increment over that of the last one; keeps it, where there was one.
    fn contracted(&mut self, size: f64, last: f64) -> f64 {
        let contraction = size / last;
        if last.is_finite() {
            self.memory.rate = contraction.max(0.3 * self.memory.rate).min(1.0);
        }
        contraction
    }

    /// Full Newton with a search along each step: slower, but it gets round the kinks where the line goes slack or lands.
    ///
    /// What is slack has no stiffness but its inertia, and is moved by what rounding leaves, back and forth across the kink: its increments never get as small
    /// as the strains of what is taut must be. No tension depends on them. How much one can depend on an increment x, its energy says,
    /// c_u x·R = δu·K δu, of which no more than all can go into stretching one element (`rest`).
    fn iterate_damped(
        &mut self,
        line: &dyn System,
        weights: &Weights,
        trial: &mut State,
        criteria: &Criteria,
    ) -> Result<(), Stall> {
        self.memory.rate = 1.0;
        self.memory.rates.fill(1.0);
        self.weigh(line, trial, Asking::First);
        for _ in 0..DAMPED {
            self.factor(line, &motion(trial), weights, None)?;
            self.effort.iterations += 1;
            self.increment.copy_from(&self.residual);
            self.unknowns.solve(line, &mut self.increment);
            let (size, node) = self.size(weights.u, criteria.length);
            let masters = line.links().map_or(0, |links| links.masters.len());
            let loose = (0..masters).map(|number| line.loose(&self.increment, number)).fold(0.0, f64::max);
            let size = size.max(loose * weights.u.abs() / criteria.length * criteria.emphasis);
            if !size.is_finite() {
                return Err(Stall::NotFinite { node });
            }
            let energy = (weights.u * self.residual.dot(&self.increment)).abs();
            if size < criteria.tolerance || size < criteria.loose && energy < criteria.enough {
                self.apply(weights, -1.0, trial);
                line.follow(trial);
                return Ok(());
            }
            let mut taken = 0.0;
            search::across_kinks(|share| {
                if share != taken {
                    self.apply(weights, taken - share, trial);
                    line.follow(trial);
                    taken = share;
                    self.weigh(line, trial, Asking::Again);
                }
                // The increment of what is prescribed is zero.
                -self.residual.dot(&self.increment)
            });
        }
        Err(Stall::Diverging { node: self.size(weights.u, criteria.length).1 })
    }

    /// R at a state.
    fn weigh(&mut self, line: &dyn System, trial: &State, asking: Asking) {
        line.residual(&Motion { asking, ..motion(trial) }, &mut self.residual);
        line.gather(&motion(trial), &mut self.residual);
    }

    /// J⁻¹ R at a state, with the factor at hand.
    fn find_increment(&mut self, line: &dyn System, trial: &State, asking: Asking) {
        self.effort.iterations += 1;
        line.residual(&Motion { asking, ..motion(trial) }, &mut self.increment);
        line.gather(&motion(trial), &mut self.increment);
        self.unknowns.solve(line, &mut self.increment);
    }

    /// Moves a state by `factor` times the increment.
    fn apply(&self, weights: &Weights, factor: f64, trial: &mut State) {
        trial.u.add(factor * weights.u, &self.increment);
        trial.v.add(factor * weights.v, &self.increment);
        trial.a.add(factor * weights.a, &self.increment);
    }

    /// Largest scaled increment and its node.
    fn size(&self, c_u: f64, length: f64) -> (f64, usize) {
        let mut largest = (0.0, 0);
        for c in 0..COMPONENTS {
            let scale = c_u.abs() / if c < 3 { length } else { 1.0 };
            for (node, x) in self.increment.component(c).iter().enumerate() {
                let size = (x * scale).abs();
                // Written so that NaN is the largest of all.
                if !(size <= largest.0) {
                    largest = (size, node);
                    if size.is_nan() {
                        return largest;
                    }
                }
            }
        }
        largest
    }
}

/// Takes motion along a unit vector out of a matrix: what remains is as if it were locked there.
fn without(matrix: &mut BlockTridiagonal<COMPONENTS>, across: &Vector3<f64>) {
    let mut along = SVector::<f64, COMPONENTS>::zeros();
    let blocks = matrix.diagonal.iter_mut().map(|block| (block, true));
    let others = matrix.upper.iter_mut().chain(matrix.lower.iter_mut()).map(|block| (block, false));
    for (block, own) in blocks.chain(others) {
        for half in [0, 3] {
            along.fill(0.0);
            along.fixed_rows_mut::<3>(half).copy_from(across);
            let size = block.amax().max(f64::MIN_POSITIVE);
            let columns = *block * along;
            *block -= columns * along.transpose();
            let rows = block.transpose() * along;
            *block -= along * rows.transpose();
            if own {
                *block += along * along.transpose() * size;
            }
        }
    }
}

/// The motion of a state.
pub fn motion(state: &State) -> Motion<'_> {
    let State { clock, u, v, a, holds, frames } = state;
    Motion { clock: *clock, u, v, a, holds, frames, asking: Asking::Alone }
}
