//! What every time integration scheme is made of: a step from one state to the next as a few stages, and an estimate of its error.

use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::rod::system::System;
use crate::sea::clock::Clock;
use crate::solve::motion::{Kinematics, Path};
use crate::solve::newton::{Criteria, Newton, Stall, motion};
use crate::solve::tangent::{LinearStage, SolvedStage};
use nalgebra::Vector3;

/// The line in time: the state and what the predictor remembers of the step before.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Unknowns and rates, and their time.
    pub state: State,
    /// Accelerations one step before.
    pub earlier: Field,
    /// Length of the step that led here [s]; 0: no history.
    pub last_step: f64,
    /// Length aimed at for the next step [s].
    pub step: f64,
    /// Length of the step tried last [s].
    pub tried: f64,
    /// Steps still to be taken by the L-stable method.
    pub guard: u32,
}

impl Moment {
    /// The clock after `span` seconds.
    pub fn clock_after(&self, span: f64) -> Clock {
        Clock { now: self.state.clock.now + span, ..self.state.clock }
    }
}

/// What a step works with.
pub struct Bench<'a> {
    /// What moves.
    pub line: &'a dyn System,
    /// The stage solver.
    pub newton: &'a mut Newton,
    /// The motion of the fairlead.
    pub path: &'a Path,
    /// The motion of the anchor, where it may move.
    pub anchor: Option<&'a Path>,
    /// When a stage is solved.
    pub criteria: Criteria,
    /// Error of the positions that is small enough [m].
    pub allowed: f64,
    /// What else happens to a stage.
    pub stages: Stages<'a>,
}

/// What happens to the stages of a step.
pub enum Stages<'a> {
    /// They are solved.
    Solve,
    /// They are solved and kept.
    Record(&'a mut Vec<SolvedStage>),
    /// What moves are changes, and the stages are the linearised ones of a step taken before, in their order.
    Linear(std::slice::Iter<'a, LinearStage>),
}

impl Bench<'_> {
    /// Sets a state to a time, its fairlead where the path has it then, and locked nodes where their locks have them.
    pub fn prescribe(&self, state: &mut State, clock: Clock) {
        state.clock = clock;
        let at = self.path.at(clock.now);
        for (order, field) in [&mut state.u, &mut state.v, &mut state.a].into_iter().enumerate() {
            self.put(order, field, clock, &at);
        }
        if let Some(anchor) = self.anchor {
            let at = anchor.at(clock.now);
            let State { u, v, a, .. } = state;
            [(u, at.position), (v, at.velocity), (a, at.acceleration)]
                .into_iter()
                .for_each(|(field, to)| self.put_anchor(field, &to));
        }
        if !matches!(self.stages, Stages::Linear(_)) {
            self.line.follow(state);
        }
    }

    /// The same for positions (order 0), velocities (1) or accelerations (2) alone.
    pub fn prescribe_order(&self, order: usize, field: &mut Field, clock: Clock) {
        self.put(order, field, clock, &self.path.at(clock.now));
        if let Some(anchor) = self.anchor {
            let at = anchor.at(clock.now);
            self.put_anchor(field, &[at.position, at.velocity, at.acceleration][order]);
        }
    }

    fn put_anchor(&self, field: &mut Field, to: &Vector3<f64>) {
        for &(_, component) in self.line.fixed().iter().filter(|(node, component)| *node == 0 && *component < 3) {
            field.component_mut(component)[0] = to[component];
        }
    }

    fn put(&self, order: usize, field: &mut Field, clock: Clock, at: &Kinematics) {
        let last = self.line.last();
        let prescribed = [at.position, at.velocity, at.acceleration][order];
        for &(_, component) in self.line.fixed().iter().filter(|(node, component)| *node == last && *component < 3) {
            field.component_mut(component)[last] = prescribed[component];
        }
        // Changes of the motion of a lock are zero, and stay so.
        if !matches!(self.stages, Stages::Linear(_)) {
            self.line.place(order, field, clock.now);
        }
    }

    /// Passes an error of u through the stage matrix, J⁻¹ M e: what stiff waves that the step does not resolve contribute is damped
    /// as the step itself damps it (Hosea & Shampine 1996). Needs the factor of the stage. An error that is small enough as it is
    /// stays: nine of ten are.
    pub fn filter(&mut self, state: &State, error: &mut Field, scratch: &mut Field) {
        if matches!(self.stages, Stages::Linear(_)) || self.line.error_size(error) <= self.allowed {
            return;
        }
        self.line.inertia(&motion(state), error, scratch);
        self.line.gather(&motion(state), scratch);
        self.newton.solve_linear(self.line, scratch);
        std::mem::swap(error, scratch);
    }

    /// Solves a stage. `trial` holds the prediction, with the prescribed unknowns in place, and becomes the solution.
    pub fn solve(&mut self, weights: &Weights, trial: &mut State) -> Result<(), Stall> {
        match &mut self.stages {
            Stages::Linear(stages) => {
                if let Some(stage) = stages.next() {
                    stage.solve(self.line, trial);
                }
                Ok(())
            }
            Stages::Solve => self.newton.solve(self.line, weights, trial, &self.criteria),
            Stages::Record(kept) => {
                self.newton.solve(self.line, weights, trial, &self.criteria)?;
                kept.push(SolvedStage { weights: *weights, state: trial.clone() });
                Ok(())
            }
        }
    }

    /// Forgets the stages kept of a step that was rejected.
    pub fn forget_stages(&mut self, kept_before: usize) {
        if let Stages::Record(kept) = &mut self.stages {
            kept.truncate(kept_before);
        }
    }

    /// Accelerations that fit positions, velocities and the prescribed acceleration: R(u, v, a) = 0 for a alone.
    pub fn accelerate(&mut self, state: &mut State) -> Result<(), Stall> {
        self.solve(&Weights { u: 0.0, v: 0.0, a: 1.0 }, state)
    }
}

/// A recipe of stages.
pub trait Scheme: Send {
    /// Tries a step of length h from `from`; on success `next` holds the state at the end, and the estimated error of the
    /// positions [m] is returned.
    fn step(&mut self, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<f64, Stall>;
    /// Order of the error estimate in h.
    fn error_order(&self) -> f64;
    /// Whether what rings dies away by itself (L-stable).
    fn is_l_stable(&self) -> bool {
        false
    }
}

/// Linear extrapolation of the accelerations to the end of a step, factor·(a - a_before) beyond a; constant without history.
pub fn predict(from: &Moment, h: f64, a: &mut Field) {
    let factor = if from.last_step > 0.0 { h / from.last_step } else { 0.0 };
    a.set_sum([(1.0 + factor, &from.state.a), (-factor, &from.earlier)]);
}
