//! The clock of an instance and its step: from inputs to a path, over the step, and what changes with the inputs.

use super::bodies::Directions;
use super::built::Route;
use super::{Instance, Message, WARNING, is_finite};
use crate::error::Error;
use crate::fmi::body_variables::{BodyOutput, Said};
use crate::fmi::inputs::Inputs;
use crate::fmi::phase::{Call, Phase, StepStatus};
use crate::fmi::refusal::Refusal;
use crate::fmi::snapshot::{End, Moment};
use crate::fmi::variables::{Kind, Meaning};
use crate::fmi::vessel::Impossible;
use crate::fmi::warnings;

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
                self.moment.vessels.iter_mut().for_each(|vessel| vessel.said.derivatives = Said::default().derivatives);
                self.moment.step_status = StepStatus::Done;
                Ok(())
            }
            Err(error) => Err(self.step_in_part(until, error)),
        }
    }

    /// Advances all lines or, where one fails, none.
    fn advance(&mut self, until: f64) -> Result<(), Error> {
        self.built.as_mut().map_or(Ok(()), |built| built.advance(until))
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
        let Moment { clock, ends, vessels, .. } = &self.moment;
        let Some(built) = &mut self.built else { return Err(Refusal::UnknownState) };
        let mut voyages = Vec::with_capacity(vessels.len());
        for (index, (vessel, of)) in vessels.iter().zip(&built.vessels).enumerate() {
            if of.free {
                voyages.push(None);
                continue;
            }
            let voyage = vessel.plan(built.interpolation, built.filter, &built.conventions[index], of.arm, *clock, until - clock);
            let name = || self.interface.scene().bodies[index].name.clone();
            voyages.push(Some(voyage.map_err(|impossible| match impossible {
                Impossible::Jump(distance) => Refusal::PoseJump { body: name(), time: *clock, distance },
                Impossible::Turn(turn) => Refusal::PoseTurn { body: name(), time: *clock, degrees: turn.to_degrees() },
            })?));
        }
        built.vessels.iter_mut().zip(voyages).for_each(|(of, voyage)| of.voyage = voyage);
        let said: Vec<Said> = vessels.iter().map(|vessel| vessel.said).collect();
        built.apply(&said);
        let driven = |index: usize| self.interface.scene().lines.get(index).is_some_and(|line| line.fairlead_on.is_none());
        for (_, (line, End { inputs, path, filter, .. })) in
            built.lines.iter_mut().zip(ends).enumerate().filter(|(index, _)| driven(*index))
        {
            let (mut inputs, mut filter) = (*inputs, *filter);
            if built.filter > 0.0 {
                filter = filter.after(built.filter, *clock, &inputs);
                inputs = filter.inputs();
            }
            let plan = path.plan(built.interpolation, *clock, until - clock, &inputs);
            let segment = path.segment(&plan, &inputs);
            line.route = Some(Route { plan, segment, inputs, filter });
        }
        built.set_out();
        Ok(())
    }

    /// Takes over what the lines are after reaching a time.
    fn arrive(&mut self, time: f64) -> Result<(), Refusal> {
        let (begin, mut told) = (self.moment.clock, Vec::new());
        let Some(built) = &mut self.built else { return Err(Refusal::UnknownState) };
        for index in 0..built.lines.len() {
            let (outputs, last) = (built.outputs(index), built.last_step(index));
            let (line, end) = (&mut built.lines[index], &mut self.moment.ends[index]);
            end.outputs = outputs;
            if !is_finite(&end.outputs) {
                self.moment.phase = Phase::Error;
                self.moment.step_status = StepStatus::Failed;
                return Err(Refusal::NotANumber { line: self.interface.prefix(index), until: time });
            }
            end.last = last;
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
        let mut of_bodies = Vec::new();
        for (index, (of, vessel)) in built.vessels.iter().zip(&mut self.moment.vessels).enumerate() {
            let Some(voyage) = &of.voyage else { continue };
            let (missed, told) = (vessel.missed(voyage), &mut vessel.told);
            let length = of.hung.iter().map(|(line, _)| built.lines[*line].limits.length).fold(f64::INFINITY, f64::min);
            of_bodies.extend(warnings::of_jump(told, begin, time - begin, missed, length).map(|text| (index, text)));
            vessel.advance(voyage, time);
            let said = [0, 1].map(|part: usize| warnings::of_inputs(&mut vessel.told, time, &vessel.paths[part]));
            of_bodies.extend(said.into_iter().flatten().map(|text| (index, text)));
        }
        for (index, text) in of_bodies {
            let text = format!("{}: {text}", self.interface.scene().bodies[index].name);
            self.messages.push(Message { category: WARNING, text });
        }
        self.reach(time);
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
            if !variable.is_output() {
                let (role, allowed) = ("an unknown", "unknowns are the Real outputs");
                return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
            }
            if let (Meaning::BodyOutput(BodyOutput::Work), Some(built)) = (variable.meaning, &self.built) {
                let of = &built.vessels[variable.line];
                if of.hung.iter().any(|(line, anchor)| *anchor || !built.lines[*line].is_own()) {
                    let (role, allowed) =
                        ("an unknown", "the work on a body has a derivative where only fairleads of lines alone hang on it");
                    return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
                }
            }
            outputs.push((variable.line, variable.meaning));
        }
        let mut directions = Directions {
            lines: vec![[[0.0; 3]; 2]; self.moment.ends.len()],
            bodies: vec![[[0.0; 3]; 4]; self.moment.vessels.len()],
            applied: vec![[[0.0; 3]; 2]; self.moment.vessels.len()],
        };
        for (reference, seed) in knowns.iter().zip(seeds) {
            let variable = self.variable(*reference, Kind::Real)?;
            if !seed.is_finite() {
                return Err(Refusal::Derivative { name: variable.name.clone(), order: 0, value: *seed });
            }
            Instance::add_direction(variable, *seed, &mut directions)?;
        }
        let changes = if self.moment.phase == Phase::Initialization {
            self.settle()?;
            self.static_changes(&directions.at_rest())?
        } else {
            let until = self.moment.clock + self.moment.last_step_size;
            self.plan(until)?;
            self.changes(until, &directions)?
        };
        let value = |(owner, meaning): &(usize, Meaning)| match meaning {
            Meaning::Output(output) => changes.lines[*owner].as_ref().map_or(0.0, |change| output.of(change)),
            Meaning::BodyOutput(output) => self.body_change(*owner, *output, &changes),
            _ => 0.0,
        };
        Ok(outputs.iter().map(value).collect())
    }
}

/// By how much times may differ and be the same [s].
fn same(time: f64, step: f64) -> f64 {
    (SAME_STEP * step).max((SAME_TIME * time.abs()).min(MOST_STEP * step))
}
