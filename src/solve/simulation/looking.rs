//! What a line tells about itself: outputs and their rates, nodes, mesh, physics, and the work done so far.

use super::{Counters, LastStep, NodeOutput, Outputs, Simulation};
use crate::rod::physics::Decision;
use crate::rod::state::{Field, State};
use crate::scene::state::LineState;
use crate::solve::between::{self, Place};
use crate::solve::newton::motion;
use crate::solve::scheme::Moment;
use crate::solve::{line_state, outputs, tangent};
use nalgebra::Vector3;

impl Simulation {
    /// Rates of the outputs in time, from the motion of the line now and the change of its acceleration over the last step.
    pub fn output_rates(&self) -> Outputs {
        if let Some(mixed) = &self.mixed {
            return mixed.output_rates(self.line.as_ref(), &self.moment);
        }
        let (state, moment) = (&self.moment.state, &self.moment);
        let mut jerk = Field::new(state.a.nodes());
        if moment.last_step > 0.0 {
            jerk.set_sum([(1.0, &state.a), (-1.0, &moment.earlier)]);
            jerk.data_mut().iter_mut().for_each(|x| *x /= moment.last_step);
        }
        let holds = tangent::hold_rate(self.line.as_ref(), state);
        let rate = State { clock: state.clock, u: state.v.clone(), v: state.a.clone(), a: jerk, holds, frames: Vec::new() };
        let mut rates = outputs::along(self.line.as_ref(), state, &rate, 1.0, 1.0e-4);
        let velocity = state.v.position(self.line.last());
        (rates.time, rates.work) = (1.0, self.line.end_force(&motion(state)).dot(&velocity));
        rates
    }

    /// Outputs now.
    pub fn outputs(&self) -> Outputs {
        if let Some(mixed) = &self.mixed {
            return mixed.outputs(self.line.as_ref(), &self.moment, self.work);
        }
        outputs::outputs(self.line.as_ref(), &self.moment.state, self.moment.state.clock.now, self.work, &mut Vec::new())
    }

    /// Outputs now, without allocating anything.
    pub fn observe(&mut self) -> Outputs {
        if let Some(mixed) = &self.mixed {
            return mixed.outputs(self.line.as_ref(), &self.moment, self.work);
        }
        let time = self.moment.state.clock.now;
        outputs::outputs(self.line.as_ref(), &self.moment.state, time, self.work, &mut self.forces)
    }

    /// Nodes now, from the fairlead.
    pub fn nodes(&self) -> Vec<NodeOutput> {
        if let Some(mixed) = &self.mixed {
            return mixed.nodes(self.line.as_ref(), &self.moment.state);
        }
        outputs::nodes(self.line.as_ref(), &self.moment.state)
    }

    /// What it is like now at arc lengths from the fairlead [m].
    pub fn places(&self, at: &[f64]) -> Vec<Place> {
        let (line, state) = (self.line.as_ref(), &self.moment.state);
        let forces = match &self.mixed {
            Some(mixed) => mixed.node_forces(state),
            None => outputs::node_forces(line, state),
        };
        at.iter().map(|s| between::at(line, state, &forces, *s)).collect()
    }

    /// Nodes now as the files of 1994 have them, from the fairlead: with slopes, rates and λ.
    pub fn line_state(&self) -> LineState {
        let (line, state) = (self.line.as_ref(), &self.moment.state);
        match &self.mixed {
            Some(mixed) => line_state::of(line, state, &mixed.tensions().now),
            None => {
                let forces = outputs::node_forces(line, state);
                line_state::of(line, state, &line_state::tensions(line, self.surroundings.stretch, state, &forces))
            }
        }
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.line.mesh().element_count()
    }

    /// Runs of elements of nearly one length, from the fairlead: from and to which arc length [m], and how many.
    pub fn mesh(&self) -> Vec<(f64, f64, usize)> {
        let mesh = self.line.mesh();
        let mut runs: Vec<(f64, f64, usize)> = Vec::new();
        for element in mesh.elements.iter().rev().filter(|element| !element.is_joint()) {
            let (from, to) = (mesh.length - element.start - element.length, mesh.length - element.start);
            match runs.last_mut() {
                Some(run) if (element.length * run.2 as f64 / (run.1 - run.0) - 1.0).abs() < 0.1 => {
                    (run.1, run.2) = (to, run.2 + 1)
                }
                _ => runs.push((from, to, 1)),
            }
        }
        runs
    }

    /// Which physics is in the step and why.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        let (tally, effort) = (&self.controller.tally, &self.newton.effort);
        Counters {
            steps: tally.steps,
            rejected_steps: tally.rejected,
            unresolved_steps: tally.unresolved,
            pushing_steps: tally.pushing,
            newton_iterations: effort.iterations,
            factorisations: effort.factorisations,
            element_iterations: effort.iterations * self.elements(),
        }
    }

    /// The last `advance`.
    pub fn last_step(&self) -> LastStep {
        self.last
    }

    /// Becomes the part of a larger system's moment that begins at a node, to be looked at.
    pub(in crate::solve) fn show(&mut self, moment: &Moment, start: usize, work: [f64; 2]) {
        let own = &mut self.moment;
        let copy = |to: &mut Field, from: &Field| {
            for c in 0..6 {
                let nodes = to.nodes();
                to.component_mut(c).copy_from_slice(&from.component(c)[start..start + nodes]);
            }
        };
        copy(&mut own.state.u, &moment.state.u);
        copy(&mut own.state.v, &moment.state.v);
        copy(&mut own.state.a, &moment.state.a);
        copy(&mut own.earlier, &moment.earlier);
        if own.state.holds.nodes() > 0 {
            copy(&mut own.state.holds, &moment.state.holds);
        }
        (own.state.clock, own.last_step) = (moment.state.clock, moment.last_step);
        [self.work, self.anchor_work] = work;
    }

    /// Work done on what moves the fairlead since the start [J].
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Work done on what moves the anchor since the start [J], where it is summed up.
    pub fn anchor_work(&self) -> f64 {
        self.anchor_work
    }

    /// Position of the anchor now [m].
    pub fn anchor_position(&self) -> Vector3<f64> {
        self.moment.state.u.position(0)
    }
}
