//! What a step's end depends on: steps taken again as linear ones, or repeated where the scheme is one linear solve itself.

use super::Simulation;
use super::passage::{begin, moving};
use crate::error::Error;
use crate::rod::line::Line;
use crate::rod::physics::{self, Surroundings};
use crate::solve::controller::{self, Failure};
use crate::solve::linearised::{Linearised, Repeated};
use crate::solve::motion::{Ends, Path};
use crate::solve::outputs::{self, Outputs};
use crate::solve::scheme::{Bench, Moment, Stages};
use crate::solve::tangent::{self, LinearStage};
use nalgebra::Vector3;

/// Displacement of the fairlead for a static derivative, as a share of the line's length: forces in balance to 1e-7 of the weight then make derivatives
/// good to 1e-2 of weight per length, and bends of the answer do not show.
const STATIC_SHARE: f64 = 1.0e-5;

impl Simulation {
    /// Takes the steps to a time and linearises them. The simulation stays as it is.
    pub fn linearise(&mut self, until: f64, path: &Path) -> Result<Linearised, Error> {
        self.linearise_ends(until, &Ends::anchored(path.clone(), self.anchor))
    }

    /// The same with both ends on paths.
    pub fn linearise_ends(&mut self, until: f64, ends: &Ends) -> Result<Linearised, Error> {
        let path = &ends.fairlead;
        let now = self.snapshot();
        let spatial = self.line.is_planar().then(|| self.in_space());
        self.leave_plane();
        let tally = (self.controller.tally, self.newton.effort);
        let outcome = if self.mixed.is_some() {
            Ok(Linearised::repeated(&now, until, path))
        } else {
            self.linearise_from_here(until, path, moving(&ends.anchor))
        };
        let outcome = outcome.map_err(|failure| Error::Step(Box::new(self.stuck(&failure, path, now.moment.state.clock.now))));
        self.restore(&now);
        (self.controller.tally, self.newton.effort) = tally;
        outcome.map(|steps| Linearised { spatial, ..steps })
    }

    /// Change of the outputs in equilibrium per displacement of the fairlead along `direction` [m], by central difference: what friction holds and what
    /// lies on the bed follows as statics lets it. The simulation stays as it is.
    pub fn static_derivative(&mut self, fairlead: Vector3<f64>, direction: Vector3<f64>) -> Result<Outputs, Error> {
        self.static_derivative_ends([fairlead, self.anchor], [direction, Vector3::zeros()])
    }

    /// The same per displacement of both ends, fairlead and anchor.
    pub fn static_derivative_ends(&mut self, ends: [Vector3<f64>; 2], directions: [Vector3<f64>; 2]) -> Result<Outputs, Error> {
        let (now, time) = (self.snapshot(), self.moment.state.clock.now);
        let (tally, fresh, length) = ((self.controller.tally, self.newton.effort), self.fresh, self.line.mesh().length);
        let size = directions.iter().map(Vector3::norm).fold(0.0, f64::max);
        let share = STATIC_SHARE * length / size.max(f64::MIN_POSITIVE);
        let mut moved = |share: f64| {
            let [fairlead, anchor] = [0, 1].map(|end: usize| ends[end] + directions[end] * share);
            self.settle_between(fairlead, anchor, time).map(|_| self.outputs())
        };
        let after_and_before = moved(share).and_then(|after| Ok((after, moved(-share)?)));
        self.restore(&now);
        (self.controller.tally, self.newton.effort) = tally;
        self.fresh = fresh;
        self.anchor = ends[1];
        let (after, before) = after_and_before?;
        Ok(outputs::difference(&after, &before, 0.5 / share))
    }

    /// The same line in space.
    pub(in crate::solve) fn in_space(&self) -> Box<dyn Line> {
        let surroundings = Surroundings { planar: false, ..self.surroundings.clone() };
        physics::build(self.line.mesh().clone(), surroundings, self.supports.clone())
    }

    fn linearise_from_here(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<Linearised, Failure> {
        let (time, line, criteria) = (self.moment.state.clock.now, self.line.as_ref(), self.demands.criteria);
        let allowed = self.demands.error;
        let failed = |stall| Failure { time, step: 0.0, stall: Some(stall) };
        let mut solved = Vec::new();
        let mut legs = Vec::new();
        let stages = Stages::Record(&mut solved);
        let mut bench = Bench { line, newton: &mut self.newton, path, anchor, criteria, allowed, stages };
        let fresh = std::mem::take(&mut self.fresh);
        if fresh {
            begin(&mut bench, &mut self.moment).map_err(failed)?;
        }
        let mut states = vec![self.moment.state.clone()];
        let history = self.moment.last_step;
        self.controller.advance(&mut bench, &self.demands, &mut self.moment, until, |moment, leg| {
            states.push(moment.state.clone());
            legs.push(*leg);
        })?;
        let stages = solved.iter().map(|stage| LinearStage::new(line, stage)).collect::<Result<Vec<_>, _>>().map_err(failed)?;
        Ok(Linearised { time, history, fresh, legs, states, stages, spatial: None, repeated: None })
    }

    /// Change of all outputs at the end of linearised steps per variation of their path: the steps are differentiated, not repeated.
    pub fn derivative(&mut self, steps: &Linearised, variation: &Path) -> Result<Outputs, Error> {
        self.derivative_ends(steps, variation, None)
    }

    /// The same per variation of the paths of both ends; none: the anchor's stays.
    pub fn derivative_ends(&mut self, steps: &Linearised, variation: &Path, anchor: Option<&Path>) -> Result<Outputs, Error> {
        let outcome = self.change(steps, variation, anchor);
        outcome.map_err(|failure| Error::Step(Box::new(self.stuck(&failure, variation, steps.time))))
    }

    /// Outputs at the end of linearised steps; none where they are repeated.
    pub fn outputs_at_end(&self, steps: &Linearised) -> Option<Outputs> {
        let state = steps.states.last().filter(|_| steps.repeated.is_none())?;
        let line = steps.spatial.as_deref().unwrap_or(self.line.as_ref());
        Some(outputs::outputs(line, state, state.clock.now, 0.0, &mut Vec::new()))
    }

    /// Central differences of the report's steps: each is one linear solve, and takes less time than to differentiate it would.
    fn difference_of_repeats(&mut self, (from, until, path): &Repeated, variation: &Path) -> Result<Outputs, Failure> {
        let now = self.snapshot();
        let tally = (self.controller.tally, self.newton.effort);
        let share = 1.0e-4;
        let mut moved = |share: f64| {
            self.restore(from);
            self.run_mixed(*until, &|time| path.at(time).velocity + variation.at(time).velocity * share)?;
            Ok(self.outputs())
        };
        let ends = moved(share).and_then(|after| Ok((after, moved(-share)?)));
        self.restore(&now);
        (self.controller.tally, self.newton.effort) = tally;
        let (after, before) = ends?;
        let work = (after.work - before.work) * (0.5 / share);
        Ok(Outputs { work, ..outputs::difference(&after, &before, 0.5 / share) })
    }

    fn change(&mut self, steps: &Linearised, variation: &Path, anchor: Option<&Path>) -> Result<Outputs, Failure> {
        if let Some(repeated) = &steps.repeated {
            return self.difference_of_repeats(repeated, variation);
        }
        let Linearised { time, history, fresh, legs, states, stages, spatial, .. } = steps;
        let (line, criteria) = (spatial.as_deref().unwrap_or(self.line.as_ref()), self.demands.criteria);
        let failed = |stall| Failure { time: *time, step: 0.0, stall: Some(stall) };
        let stages = Stages::Linear(stages.iter());
        let allowed = self.demands.error;
        let mut bench = Bench { line, newton: &mut self.newton, path: variation, anchor, criteria, allowed, stages };
        let mut change = controller::at_rest(line, *time, 0.0);
        if *fresh {
            begin(&mut bench, &mut change).map_err(failed)?;
        }
        change.last_step = *history;
        let mut work = 0.0;
        let mut before = outputs::end_along(line, &states[0], &change.state);
        let along = |change: &mut Moment, number: usize| {
            tangent::hold(line, &states[number + 1], &states[number].holds, &mut change.state);
            let now = outputs::end_along(line, &states[number + 1], &change.state);
            work += 0.5 * ((before.force_change + now.force_change).dot(&(now.place - before.place)));
            work += 0.5 * ((before.force + now.force).dot(&(now.place_change - before.place_change)));
            before = now;
        };
        self.controller.repeat(&mut bench, legs, &mut change, along).map_err(failed)?;
        Ok(Outputs { work, ..outputs::along(line, &states[legs.len()], &change.state, 0.0, 1.0e-4) })
    }
}
