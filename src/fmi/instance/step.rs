//! The clock of an instance and its step: from inputs to a path, over the step, and what changes with the inputs.

use super::{Instance, Route, is_finite};
use crate::error::Error;
use crate::fmi::inputs::Inputs;
use crate::fmi::phase::{Call, Phase, StepStatus};
use crate::fmi::refusal::Refusal;
use crate::fmi::snapshot::{End, Moment};
use crate::fmi::variables::{Kind, Meaning, Output};
use crate::fmi::warnings;
use crate::solve::simulation::Outputs;
use nalgebra::Vector3;

/// Longest communication step [s]; more is a mistake of units or an uninitialised number.
const LONGEST_STEP: f64 = 1.0e6;
/// Shortest communication step [s]; less drowns in rounding wherever the solver divides by its square.
const SHORTEST_STEP: f64 = 1.0e-9;
/// Two times are the same if they differ by less than this part of a step: a clock in single precision or in nanoseconds is the master's to have.
const SAME_STEP: f64 = 1.0e-3;
/// Or of their size, as far as single precision goes; never more than `MOST_STEP` of a step.
const SAME_TIME: f64 = 1.2e-7;
/// A clock that is off by more than this part of a step means another time.
const MOST_STEP: f64 = 0.1;

/// Error of a step over the allowed one above which it is told of: what is a little more was accepted for being near.
const UNRESOLVED: f64 = 10.0;

impl Instance {
    /// Advances from the master's communication point over its step.
    pub fn do_step(&mut self, time: f64, step: f64) -> Result<(), Refusal> {
        self.check(Call::DoStep)?;
        let until = self.end_of_step(time, step)?;
        self.plan(until)?;
        match self.advance(until) {
            Ok(()) => {
                self.arrive(until)?;
                self.moment.last_step_size = step;
                self.moment.ends.iter_mut().for_each(|end| end.inputs.derivatives = Inputs::default().derivatives);
                self.moment.step_status = StepStatus::Done;
                Ok(())
            }
            Err(error) => Err(self.step_in_part(until, error)),
        }
    }

    /// Advances all lines or, where one fails, none.
    fn advance(&mut self, until: f64) -> Result<(), Error> {
        let lines = self.built.as_mut().map_or(&mut [][..], |built| &mut built.lines);
        for index in 0..lines.len() {
            if let Err(error) = lines[index].advance(until) {
                lines[..index].iter_mut().for_each(|line| line.simulation.undo());
                return Err(error);
            }
        }
        Ok(())
    }

    /// Checks the master's step against our clock; the end it means.
    fn end_of_step(&self, time: f64, step: f64) -> Result<f64, Refusal> {
        let refuse = |allowed| Err(Refusal::StepSize { time, step, allowed });
        if !(step >= SHORTEST_STEP) {
            return refuse("it must be positive, a nanosecond or more");
        }
        if !(step <= LONGEST_STEP) {
            return refuse("a million seconds is the limit");
        }
        let clock = self.moment.clock;
        let tolerance = same(time, step).max(4.0 * f64::EPSILON * clock.abs());
        if !((time - clock).abs() <= tolerance) {
            return Err(Refusal::CommunicationPoint { given: time, clock });
        }
        let until = time + step;
        if !(until > clock && until > time) {
            return refuse("it is too short to be told from the present time");
        }
        match self.moment.experiment.stop {
            Some(stop) if until > stop + same(stop, step) => Err(Refusal::PastStop { time, step, stop }),
            _ => Ok(until),
        }
    }

    /// Decides how the fairleads go to a time.
    fn plan(&mut self, until: f64) -> Result<(), Refusal> {
        let Moment { clock, ends, .. } = &self.moment;
        let Some(built) = &mut self.built else { return Err(Refusal::UnknownState) };
        for (line, End { inputs, path, filter, .. }) in built.lines.iter_mut().zip(ends) {
            let (mut inputs, mut filter) = (*inputs, *filter);
            if built.filter > 0.0 {
                filter = filter.after(built.filter, *clock, &inputs);
                inputs = filter.inputs();
            }
            let plan = path.plan(built.interpolation, *clock, until - clock, &inputs);
            let segment = path.segment(&plan, &inputs);
            line.route = Some(Route { plan, segment, inputs, filter });
        }
        Ok(())
    }

    /// Takes over what the lines are after reaching a time.
    fn arrive(&mut self, time: f64) -> Result<(), Refusal> {
        let (begin, mut told) = (self.moment.clock, Vec::new());
        let Some(built) = &mut self.built else { return Err(Refusal::UnknownState) };
        for (index, (line, end)) in built.lines.iter_mut().zip(&mut self.moment.ends).enumerate() {
            end.outputs = line.simulation.observe();
            if !is_finite(&end.outputs) {
                self.moment.phase = Phase::Error;
                self.moment.step_status = StepStatus::Failed;
                return Err(Refusal::NotANumber { line: self.interface.prefix(index), until: time });
            }
            end.last = line.simulation.last_step();
            if let Some(Route { plan, segment, inputs, filter }) = &line.route {
                let missed = end.path.missed(plan, inputs);
                let jump = warnings::of_jump(&mut end.told, begin, time - begin, missed, line.limits.length);
                end.path.advance(plan, inputs, segment, time);
                end.filter = *filter;
                told.extend(
                    jump.into_iter().chain(warnings::of_inputs(&mut end.told, time, &end.path)).map(|text| (index, text)),
                );
            }
            let unresolved = end.last.error_estimate > UNRESOLVED;
            let of_step = warnings::of_step(&mut end.told, time, &end.outputs, &line.limits, unresolved);
            told.extend(of_step.into_iter().map(|text| (index, text)));
            line.linearised = None;
        }
        self.moment.clock = time;
        told.into_iter().for_each(|(index, text)| self.warn(index, Some(text)));
        Ok(())
    }

    /// After a failure: goes as far as the solver came, or half of it, so that the master learns how far that is.
    fn step_in_part(&mut self, until: f64, mut error: Error) -> Refusal {
        let stuck_at = match &error {
            Error::Step(stuck) => stuck.time.min(until),
            _ => self.moment.clock,
        };
        for part in [0.9, 0.5] {
            let reached = self.moment.clock + part * (stuck_at - self.moment.clock);
            let worth_it = reached - self.moment.clock > 1e-3 * (until - self.moment.clock);
            if worth_it && self.advance(reached).is_ok() {
                if let Err(refusal) = self.arrive(reached) {
                    return refusal;
                }
                self.moment.phase = Phase::StepFailed;
                self.moment.step_status = StepStatus::Discarded;
                if let Error::Step(stuck) = &mut error {
                    stuck.last_good_time = reached;
                }
                return Refusal::Discarded { until, reached, cause: error.to_string() };
            }
        }
        self.moment.phase = Phase::Error;
        self.moment.step_status = StepStatus::Failed;
        Refusal::Solver(error)
    }

    /// Change of outputs at the end of a step as long as the last one, along a direction of the inputs at its start; in initialization mode, of the
    /// equilibrium.
    pub fn directional_derivative(&mut self, unknowns: &[u32], knowns: &[u32], seeds: &[f64]) -> Result<Vec<f64>, Refusal> {
        self.check(Call::DirectionalDerivative)?;
        let mut outputs = Vec::with_capacity(unknowns.len());
        for reference in unknowns {
            let variable = self.variable(*reference, Kind::Real)?;
            let Meaning::Output(output) = variable.meaning else {
                let (role, allowed) = ("an unknown", "unknowns are the Real outputs");
                return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
            };
            outputs.push((variable.line, output));
        }
        let mut directions = vec![[[0.0; 3]; 2]; self.moment.ends.len()];
        for (reference, seed) in knowns.iter().zip(seeds) {
            let variable = self.variable(*reference, Kind::Real)?;
            let Meaning::Input(input) = variable.meaning else {
                let (role, allowed) = ("a known", "knowns are position and velocity of the fairlead");
                return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
            };
            if !seed.is_finite() {
                return Err(Refusal::Derivative { name: variable.name.clone(), order: 0, value: *seed });
            }
            let (order, axis) = input.component();
            directions[variable.line][order][axis] += seed;
        }
        if self.moment.phase == Phase::Initialization {
            self.settle()?;
            return self.static_directions(&outputs, &directions);
        }
        let until = self.moment.clock + self.moment.last_step_size;
        self.plan(until)?;
        let mut changes = vec![None; directions.len()];
        for (line, _) in &outputs {
            if changes[*line].is_none() && directions[*line] != [[0.0; 3]; 2] {
                changes[*line] = Some(self.change(*line, until, directions[*line])?);
            }
        }
        Ok(outputs.iter().map(|(line, output)| changes[*line].as_ref().map_or(0.0, |change| output.of(change))).collect())
    }

    /// Changes of outputs in equilibrium along directions of the positions; velocities change nothing there.
    fn static_directions(&mut self, outputs: &[(usize, Output)], directions: &[[[f64; 3]; 2]]) -> Result<Vec<f64>, Refusal> {
        let mut changes: Vec<Option<Outputs>> = vec![None; directions.len()];
        for (index, _) in outputs {
            let direction = Vector3::from(directions[*index][0]);
            if changes[*index].is_none() && direction != Vector3::zeros() {
                let line = self.built.as_mut().and_then(|built| built.lines.get_mut(*index)).ok_or(Refusal::UnknownState)?;
                let change = line.simulation.static_derivative(line.origin.into(), direction);
                changes[*index] = Some(change.map_err(Refusal::Solver)?);
            }
        }
        Ok(outputs.iter().map(|(index, output)| changes[*index].as_ref().map_or(0.0, |change| output.of(change))).collect())
    }

    /// Change of a line's outputs at a time along a direction of its inputs now. The steps there are linearised once and kept until
    /// the inputs change or a step is done.
    fn change(&mut self, line: usize, until: f64, direction: [[f64; 3]; 2]) -> Result<Outputs, Refusal> {
        let End { path, filter: before, inputs: given, .. } = &self.moment.ends[line];
        let built = self.built.as_mut().ok_or(Refusal::UnknownState)?;
        let cutoff = built.filter;
        let line = built.lines.get_mut(line).ok_or(Refusal::UnknownState)?;
        let Some(Route { plan, segment, inputs, filter }) = &line.route else { return Err(Refusal::UnknownState) };
        let direction = if cutoff > 0.0 {
            // The filter is linear.
            let values = [std::array::from_fn(|axis| given.values[0][axis] + direction[0][axis]), [0.0; 3]];
            let moved = before.after(cutoff, plan.time(), &Inputs { values, ..Inputs::default() });
            [
                std::array::from_fn(|axis| moved.position[axis] - filter.position[axis]),
                std::array::from_fn(|axis| moved.velocity[axis] - filter.velocity[axis]),
            ]
        } else {
            direction
        };
        let kept = line.linearised.take().filter(|(end, along, _)| *end == until && along == segment);
        let kept = match kept {
            Some(kept) => kept,
            None => (until, segment.clone(), line.simulation.linearise(until, &segment.path()).map_err(Refusal::Solver)?),
        };
        let variation = path.variation(plan, inputs, direction).path();
        let (_, _, steps) = line.linearised.insert(kept);
        line.simulation.derivative(steps, &variation).map_err(Refusal::Solver)
    }
}

/// By how much times may differ and be the same [s].
fn same(time: f64, step: f64) -> f64 {
    (SAME_STEP * step).max((SAME_TIME * time.abs()).min(MOST_STEP * step))
}
