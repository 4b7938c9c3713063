//! The report's line behind the facade: statics from the default method's equilibrium, and steps of one length without control.

use crate::cable1994::line::{MixedLine, Tensions};
use crate::cable1994::step::{NoStep, shortest_step};
use crate::rod::line::Line;
use crate::rod::state::State;
use crate::scene::types::Stretch;
use crate::solve::controller::Failure;
use crate::solve::line_state;
use crate::solve::newton::Stall;
use crate::solve::outputs::{self, NodeOutput, Outputs};
use crate::solve::scheme::Moment;
use crate::solve::statics::Balance;
use nalgebra::Vector3;

/// A line of mixed elements with the length of its steps.
pub struct Mixed {
    line: MixedLine,
    /// Longest step [s].
    step: f64,
}

/// What an advance amounts to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Advance {
    /// Steps taken.
    pub steps: usize,
    /// Those with a part of the line pushing.
    pub pushing: usize,
    /// Work done on the vessel [J].
    pub work: f64,
}

/// The velocity of the fairlead at a time.
pub type Velocity<'a> = &'a dyn Fn(f64) -> Vector3<f64>;

impl Mixed {
    /// Steps of at most `step` [s].
    pub fn new(line: MixedLine, step: f64) -> Mixed {
        Mixed { line, step }
    }

    /// Tensions, now and a step before.
    pub fn tensions(&self) -> &Tensions {
        &self.line.tensions
    }

    /// Puts back tensions of this line.
    pub fn restore(&mut self, tensions: &Tensions) {
        self.line.tensions.clone_from(tensions);
    }

    /// Whether tensions belong to a line like this.
    pub fn fits(&self, tensions: &Tensions) -> bool {
        [&tensions.now, &tensions.before].iter().all(|list| list.len() == self.line.tensions.now.len())
    }

    /// Equilibrium of the mixed elements, from that of `rod`, the same line by the default method.
    pub fn settle(&mut self, rod: &dyn Line, state: &mut State, before: Balance) -> Balance {
        self.line.tensions.now = line_state::tensions(rod, Stretch::Report, state, &outputs::node_forces(rod, state));
        let settled = self.line.settle(state, before.allowed);
        let iterations = before.iterations + settled.iterations;
        Balance { iterations, residual: settled.residual, node: settled.node, ..before }
    }

    /// Steps to a time, evenly divided over the way.
    pub fn advance(&mut self, moment: &mut Moment, until: f64, velocity: Velocity) -> Result<Advance, Failure> {
        let (start, mut advance) = (moment.state.clock.now, Advance::default());
        let count = ((until - start) / self.step - 1e-6).ceil().max(1.0);
        let h = (until - start) / count;
        if !(h > 1e-12 * until.abs().max(1.0)) {
            moment.state.clock.now = until;
            return Ok(advance);
        }
        for number in 1..=count as usize {
            let time = if number as f64 == count { until } else { start + number as f64 * h };
            let failed = |stall| Failure { time, step: h, stall };
            if h <= self.shortest_step() {
                return Err(failed(None));
            }
            let (force, place) = (self.end_force(moment), self.end_place(moment));
            self.line
                .step(&mut moment.state, moment.last_step, h, &velocity(time))
                .map_err(|NoStep { node }| failed(Some(Stall::NotFinite { node })))?;
            (moment.last_step, moment.state.clock.now) = (h, time);
            advance.steps += 1;
            advance.pushing += usize::from(self.line.is_pushing());
            advance.work += 0.5 * (force + self.end_force(moment)).dot(&(self.end_place(moment) - place));
        }
        Ok(advance)
    }

    /// The step that the damping rules out, and all that are shorter [s].
    pub fn shortest_step(&self) -> f64 {
        shortest_step(self.line.damping())
    }

    /// Force that the fairlead side exerts on the anchor side at every node now [N].
    pub fn node_forces(&self, state: &State) -> Vec<Vector3<f64>> {
        self.forces(state, &self.line.tensions.now)
    }

    fn forces(&self, state: &State, tensions: &[f64]) -> Vec<Vector3<f64>> {
        (0..self.line.nodes()).map(|node| self.line.node_force(&state.u, tensions, node)).collect()
    }

    fn end_force(&self, moment: &Moment) -> Vector3<f64> {
        -self.line.node_force(&moment.state.u, &self.line.tensions.now, self.line.nodes() - 1)
    }

    fn end_place(&self, moment: &Moment) -> Vector3<f64> {
        moment.state.u.position(self.line.nodes() - 1)
    }

    /// Outputs now. Forces are λ r', as the report prints them.
    pub fn outputs(&self, rod: &dyn Line, moment: &Moment, work: f64) -> Outputs {
        let forces = self.forces(&moment.state, &self.line.tensions.now);
        outputs::from_forces(rod, &moment.state, &forces, moment.state.clock.now, work)
    }

    /// Nodes now, from the fairlead.
    pub fn nodes(&self, rod: &dyn Line, state: &State) -> Vec<NodeOutput> {
        outputs::nodes_from_forces(rod, state, &self.forces(state, &self.line.tensions.now))
    }

    /// Rates of the outputs: those of the places now, those of λ over the last step.
    pub fn output_rates(&self, rod: &dyn Line, moment: &Moment) -> Outputs {
        let Tensions { now, before } = &self.line.tensions;
        let per_second = if moment.last_step > 0.0 { 1.0 / moment.last_step } else { 0.0 };
        let moved = |seconds: f64| {
            let mut state = moment.state.clone();
            state.u.add(seconds, &moment.state.v);
            let tensions: Vec<f64> =
                now.iter().zip(before).map(|(now, before)| now + seconds * per_second * (now - before)).collect();
            outputs::from_forces(rod, &state, &self.forces(&state, &tensions), 0.0, 0.0)
        };
        let velocity = moment.state.v.position(self.line.nodes() - 1);
        let rates = outputs::difference(&moved(1.0e-4), &moved(-1.0e-4), 0.5e4);
        Outputs { time: 1.0, work: self.end_force(moment).dot(&velocity), ..rates }
    }
}
