//! Equilibrium of a network: free bodies and points are moved until the forces on them vanish, the lines settled between their ends at every place.
//!
//! ```text
//! (S + μ D) δy = -(r_y + Bᵀ r_e),   S the stiffness of all that hangs on them (`condensed`)
//! ```
//!
//! Every line is settled as it would be alone, by the same ladder, so that lines that are slack or lie on the bed have their equilibrium at every
//! step. μ rises where a step overshoots or S is not positive definite, and falls where steps are taken whole. An equilibrium is an answer only
//! if S is positive semidefinite there; another is left along its softest direction.

use super::{Group, still};
use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::error::{Adrift, Error, Trouble};
use crate::rod::motion::Weights;
use crate::rod::pose::PosePath;
use crate::rod::rigid::Rigid;
use crate::rod::state::{Field, State};
use crate::rod::system::System;
use crate::scene::types::Scene;
use crate::solve::condensed::Condensed;
use crate::solve::motion::Path;
use crate::solve::newton::{Effort, motion};
use crate::solve::rounding;
use crate::solve::simulation::{LastStep, StaticsReport};
use nalgebra::{DMatrix, DVector, Vector3};
use std::sync::Arc;

/// Iterations at most.
const ITERATIONS: usize = 200;
/// Unbalanced force that is aimed at, and that counts as equilibrium, relative to the weights and tensions there.
const AIMED: f64 = 1.0e-7;
const PROMISED: f64 = 2.0e-6;
/// Longest step, as a share of the shortest line, and largest turn [rad].
const FARTHEST: f64 = 0.25;
const LARGEST_TURN: f64 = 0.2;
/// Shortenings of a step that overshoots, and by how much.
const SHORTENINGS: usize = 5;
const SHORTER: f64 = 0.4;
/// An eigenvalue of the scaled stiffness below this share of the largest entry is none that holds.
const SOFT: f64 = 1.0e-9;
/// Unstable equilibria left at most.
const DEPARTURES: usize = 8;
/// Steps after which all at once is tried again.
const PATIENCE: usize = 10;
/// Steps in a row that bring nothing.
const STALLED: usize = 40;

/// A place that was tried.
struct Trial {
    state: State,
    residual: Field,
    /// Largest force out of balance over the one aimed at.
    excess: f64,
    /// Number of the body or point where it is.
    worst: usize,
    /// The force [N], and the one aimed at.
    force: f64,
    aimed: f64,
}

impl Group {
    /// Puts all in static equilibrium at a time, at rest: what is driven where its path has it, what is free from where it is.
    pub fn settle(&mut self, time: f64) -> Result<StaticsReport, Error> {
        let mut matrix = BlockTridiagonal::new(self.network.ties());
        let mut condensed = Condensed::new(self.network.nodes(), &self.network.links);
        let scales = self.scales();
        self.clamp_lines();
        let mut here = self.try_at(self.start(time))?;
        if self.masters.is_empty() {
            self.begin_from(here.state);
            return Ok(StaticsReport { iterations: 1, residual: 0.0, converged: true, others: self.others });
        }
        self.hasten(&mut here);
        let (mut mu, mut departures, mut iterations, mut stalled) = (0.0_f64, 0, 0, 0);
        let mut unstable = false;
        while iterations < ITERATIONS && stalled < STALLED {
            iterations += 1;
            if iterations % PATIENCE == 0 {
                self.hasten(&mut here);
            }
            self.assemble(&here, &mut matrix, &mut condensed)?;
            let (least, softest) = condensed.softest(&scales);
            let size = largest(condensed.stiffness(), &scales);
            if here.excess <= 1.0 || here.excess <= PROMISED / AIMED && stalled > 3 {
                unstable = least < -1.0e3 * SOFT * size;
                if !unstable || departures == DEPARTURES {
                    break;
                }
                (departures, stalled) = (departures + 1, 0);
                let push = self.bounded(&(softest * 1.0e9), 0.5);
                here = self.try_at(self.moved(&here.state, &push))?;
                continue;
            }
            let floor = if least < 1.0e-6 * size { 1.0e-3 * size - least } else { SOFT * size };
            condensed.stiffen(&scales.map(|scale| mu.max(floor) / (scale * scale)));
            let mut step = here.residual.clone();
            condensed.solve(&mut step);
            let step = self.bounded(&(self.of_masters(&step) * -1.0), 1.0);
            let along = -self.of_masters(&here.residual).dot(&step);
            let (mut share, mut found) = (1.0, None);
            for _ in 0..=SHORTENINGS {
                if let Ok(next) = self.try_at(self.moved(&here.state, &(&step * share))) {
                    let ahead = -self.of_masters(&next.residual).dot(&step);
                    let fine = ahead > -0.5 * along.abs() || next.excess < here.excess;
                    found = Some(next);
                    if fine {
                        break;
                    }
                }
                share *= SHORTER;
            }
            let Some(next) = found else {
                mu = (10.0 * mu).max(1.0e-3 * size);
                stalled += 1;
                continue;
            };
            stalled = if next.excess < 0.99 * here.excess { 0 } else { stalled + 1 };
            mu = match share {
                1.0 if mu > 1.0e-8 * size => 0.2 * mu,
                1.0 => 0.0,
                _ => (4.0 * mu).max(1.0e-3 * size),
            };
            here = next;
        }
        self.others |= departures > 0;
        let (excess, force, allowed) = (here.excess, here.force, here.aimed * (PROMISED / AIMED));
        let what = self.names[here.worst.min(self.names.len() - 1)].clone();
        self.begin_from(here.state);
        if !(excess <= PROMISED / AIMED) {
            let trouble = Trouble::Unbalanced { iterations, residual: force, allowed };
            return Err(Error::Network(Box::new(Adrift { what, time, trouble })));
        }
        if unstable {
            return Err(Error::Network(Box::new(Adrift { what, time, trouble: Trouble::Unstable })));
        }
        Ok(StaticsReport { iterations, residual: force, converged: true, others: self.others })
    }

    /// Goes on to where Newton's method on all at once leads, if that is nearer to equilibrium.
    fn hasten(&mut self, here: &mut Trial) {
        if here.excess <= 1.0 {
            return;
        }
        let Some(state) = self.approach(&here.state) else { return };
        if let Ok(there) = self.try_at(state)
            && there.excess < here.excess
        {
            *here = there;
        }
    }

    /// Stiffness of what is free against its own displacement, all lines following: six rows for each body and each point, of which three count.
    pub fn stiffness(&self) -> Option<DMatrix<f64>> {
        let mut matrix = BlockTridiagonal::new(self.network.ties());
        let mut condensed = Condensed::new(self.network.nodes(), &self.network.links);
        let state = &self.moment.state;
        self.stiffness_at(state, &mut matrix);
        condensed.condense(&self.network, &motion(state), 1.0, &mut matrix, None).ok()?;
        Some(condensed.stiffness().clone())
    }

    /// Lets the clamped ends of each line alone go with the bodies that drive them.
    fn clamp_lines(&mut self) {
        if !self.together.clamped {
            return;
        }
        for (node, path) in &self.network.driven {
            let local = self.line_of(*node);
            if let Path::OnBody { body, .. } = path {
                self.simulations[local].clamp_to(node - self.starts[local], body);
            }
        }
    }

    /// Lets the ends of each line alone that are clamped to free bodies go with these.
    fn clamp_to_bodies(&mut self, state: &State) {
        for link in &self.network.links.clamped {
            let Some(body) = self.network.bodies.get(link.master) else { continue };
            let pose = body.motion(&motion(state));
            let angles = crate::algebra::rotation::angles(&pose.rotation);
            let held = Arc::new(PosePath::Fixed { position: pose.position, angles });
            self.simulations[link.line].clamp_to(link.node - self.starts[link.line], &held);
        }
    }

    /// At rest, where bodies and points are now.
    fn start(&self, time: f64) -> State {
        let mut state = still(&self.network, time, &self.moment.state.frames);
        for node in &self.masters {
            state.u.set_position(*node, &self.moment.state.u.position(*node));
            state.u.set_slope(*node, &self.moment.state.u.slope(*node));
        }
        self.network.recentre(&mut state);
        state
    }

    /// The size of a unit of each unknown: translations as they are, turns at the reach of their body.
    fn scales(&self) -> DVector<f64> {
        let mut scales = DVector::from_element(6 * self.masters.len(), 1.0);
        for (number, body) in self.network.bodies.iter().enumerate() {
            (3..6).for_each(|c| scales[6 * number + c] = 1.0 / body.reach());
        }
        scales
    }

    /// The same step, no longer than `most` of what is sensible.
    fn bounded(&self, step: &DVector<f64>, most: f64) -> DVector<f64> {
        step * self.sensible(step, most)
    }

    /// The share of a step that is no longer than `most` of what is sensible [-].
    pub(super) fn sensible(&self, step: &DVector<f64>, most: f64) -> f64 {
        let shortest = self.simulations.iter().map(|simulation| simulation.line().mesh().length).fold(f64::INFINITY, f64::min);
        let reach = self.network.bodies.iter().map(Rigid::reach).fold(0.0, f64::max);
        let farthest = FARTHEST * if shortest.is_finite() { shortest } else { 4.0 * reach.max(1.0) };
        let mut longest: f64 = f64::MIN_POSITIVE;
        for number in 0..self.masters.len() {
            let part = |from: usize| (0..3).map(|c| step[6 * number + from + c].powi(2)).sum::<f64>().sqrt();
            longest = longest.max(part(0) / farthest);
            if number < self.network.bodies.len() {
                longest = longest.max(part(3) / LARGEST_TURN);
            }
        }
        (most / longest).min(1.0)
    }

    pub(super) fn of_masters(&self, field: &Field) -> DVector<f64> {
        DVector::from_iterator(
            6 * self.masters.len(),
            self.masters.iter().flat_map(|node| (0..6).map(|c| field.component(c)[*node])),
        )
    }

    /// A state with its masters moved.
    fn moved(&self, from: &State, step: &DVector<f64>) -> State {
        let mut state = from.clone();
        for (number, &node) in self.masters.iter().enumerate() {
            let part = |from: usize| Vector3::from_fn(|c, _| step[6 * number + from + c]);
            state.u.set_position(node, &(state.u.position(node) + part(0)));
            if number < self.network.bodies.len() {
                state.u.set_slope(node, &part(3));
            }
        }
        self.network.recentre(&mut state);
        state
    }

    /// Settles the lines between their ends in a state, and looks at the forces that are left.
    fn try_at(&mut self, mut state: State) -> Result<Trial, Error> {
        self.network.place(0, &mut state.u, state.clock.now);
        self.network.follow(&mut state);
        state.v.fill(0.0);
        state.a.fill(0.0);
        let mut pulls = 0.0_f64;
        self.clamp_to_bodies(&state);
        for (simulation, start) in self.simulations.iter_mut().zip(&self.starts) {
            let last = start + simulation.line().last();
            let (anchor, fairlead) = (state.u.position(*start), state.u.position(last));
            simulation.resettle(fairlead, anchor, state.clock.now)?;
            let own = simulation.state();
            for c in 0..6 {
                let nodes = own.u.nodes();
                state.u.component_mut(c)[*start..start + nodes].copy_from_slice(own.u.component(c));
                if own.holds.nodes() > 0 {
                    state.holds.component_mut(c)[*start..start + nodes].copy_from_slice(own.holds.component(c));
                }
            }
            let outputs = simulation.observe();
            pulls = pulls.max(outputs.tension).max(outputs.anchor_tension);
        }
        let mut residual = Field::new(self.network.nodes());
        self.network.gathered(&motion(&state), &mut residual);
        let of_bodies = self.network.bodies.iter().map(Rigid::weight).sum::<f64>();
        let weight = of_bodies + self.network.rod.mesh().total_weight() + self.network.rod.burden();
        let aimed = (AIMED * weight.max(pulls)).max(self.rounding(&state)).max(f64::MIN_POSITIVE);
        let (mut worst, mut force) = (0, 0.0_f64);
        for (number, &node) in self.masters.iter().enumerate() {
            let reach = self.network.bodies.get(number).map_or(1.0, Rigid::reach);
            let turning = if number < self.network.bodies.len() { residual.slope(node).norm() / reach } else { 0.0 };
            let size = residual.position(node).norm().max(turning);
            if !(size <= force) {
                (worst, force) = (number, size);
            }
        }
        Ok(Trial { state, residual, excess: force / aimed, worst, force, aimed })
    }

    /// Force on a body or point that is out of balance by no more than rounding [N].
    fn rounding(&self, state: &State) -> f64 {
        let mut bound = rounding::bound(self.network.rod.as_ref(), state);
        self.network.gather(&motion(state), &mut bound);
        self.masters.iter().map(|node| bound.position(*node).norm()).fold(0.0, f64::max)
    }

    fn assemble(&self, here: &Trial, matrix: &mut BlockTridiagonal<6>, condensed: &mut Condensed) -> Result<(), Error> {
        let at = motion(&here.state);
        self.stiffness_at(&here.state, matrix);
        condensed.condense(&self.network, &at, 1.0, matrix, None).map_err(|_| {
            let trouble = Trouble::Unbalanced { iterations: 0, residual: here.force, allowed: here.aimed };
            Error::Network(Box::new(Adrift { what: self.names[here.worst].clone(), time: here.state.clock.now, trouble }))
        })
    }

    /// The static tangent in a state, what is prescribed taken out.
    fn stiffness_at(&self, state: &State, matrix: &mut BlockTridiagonal<6>) {
        self.network.tangent(&motion(state), &Weights { u: 1.0, v: 0.0, a: 0.0 }, None, matrix);
        // A heap of slack line has no stiffness of its own: a little, so that there is a factor.
        for node in self.network.links.ranges.iter().flat_map(|(first, end)| *first..*end) {
            let size = matrix.diagonal[node].amax().max(1.0e-9);
            (0..6).for_each(|c| matrix.diagonal[node][(c, c)] += 1.0e-9 * size);
        }
        self.network.fixed.iter().for_each(|&(node, component)| matrix.fix(node, component));
    }

    /// Puts the lines in equilibrium at a time, with all that is free at rest where a scene has it, to be let go there.
    pub fn hold(&mut self, time: f64, scene: &Scene) -> Result<StaticsReport, Error> {
        self.put_as_in(scene);
        self.clamp_lines();
        let here = self.try_at(self.start(time))?;
        self.begin_from(here.state);
        Ok(StaticsReport { iterations: 1, residual: here.force, converged: true, others: false })
    }

    /// Begins anew from a state at rest.
    fn begin_from(&mut self, state: State) {
        self.moment.state = state;
        self.moment.earlier.fill(0.0);
        (self.moment.last_step, self.moment.step, self.moment.tried, self.moment.guard) = (0.0, self.demands.max_step, 0.0, 0);
        let finest = self.simulations.iter().map(|simulation| simulation.demands().error).filter(|error| *error > 0.0);
        let finest = finest.fold(f64::INFINITY, f64::min);
        if finest.is_finite() {
            self.demands.error = finest;
        }
        for (own, simulation) in self.errors.iter_mut().zip(&self.simulations) {
            *own = simulation.demands().error.max(self.demands.error);
        }
        self.network.allow(&self.errors, self.demands.error);
        self.emphasise();
        self.newton.forget();
        self.newton.effort = Effort::default();
        (self.fresh, self.resting, self.last) = (true, false, LastStep::default());
        self.works.fill(0.0);
    }
}

/// Largest entry of D S D.
fn largest(matrix: &DMatrix<f64>, scales: &DVector<f64>) -> f64 {
    let mut largest = f64::MIN_POSITIVE;
    for row in 0..scales.len() {
        for column in 0..scales.len() {
            largest = largest.max((matrix[(row, column)] * scales[row] * scales[column]).abs());
        }
    }
    largest
}
