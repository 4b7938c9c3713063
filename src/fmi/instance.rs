//! One instance of the FMU: in which phase which call is allowed, variables, equilibrium and states. No C types.
//!
//! A refused call changes nothing. A step that fails leaves the line as it was before; `set_state` and `reset` go on from there.

use crate::error::Error;
use crate::fmi::body_variables::{BodyInput, Part, Said, number_of};
use crate::fmi::experiment::Experiment;
use crate::fmi::filter::Filter;
use crate::fmi::input_path::InputPath;
use crate::fmi::inputs::Inputs;
use crate::fmi::phase::{Call, Phase, StepStatus, allowed};
use crate::fmi::refusal::Refusal;
use crate::fmi::resource;
use crate::fmi::snapshot::{End, Moment, State};
use crate::fmi::variables::{DEFAULT_STEP, Interface, Kind, LOG_CATEGORIES, Meaning, Variable};
use crate::fmi::vessel::{Reached, Vessel};
use crate::fmi::warnings::{self, Limits};
use crate::scene::check;
use crate::scene::types::{Motion, Scene};
use crate::solve::between::Place;
use crate::solve::simulation::{LastStep, Outputs};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Log category of warnings, which are told always.
pub const WARNING: &str = "logStatusWarning";

/// Something to tell the master.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Log category, one of `LOG_CATEGORIES`.
    pub category: &'static str,
    /// The text.
    pub text: String,
}

mod bodies;
mod built;
mod step;

use built::Built;

/// One or several mooring lines in the hands of a master.
pub struct Instance {
    interface: Interface,
    fingerprint: u128,
    moment: Moment,
    built: Option<Built>,
    /// States handed out, by their address, which serves as handle and is never dereferenced.
    states: BTreeMap<usize, Box<State>>,
    logged: Vec<&'static str>,
    messages: Vec<Message>,
    /// What is free is not put in equilibrium, but let go where the scene has it.
    let_go: bool,
}

impl Instance {
    /// An instance of the FMU whose resources lie at a URI; its GUID must be the one the master read.
    /// `own`: where its resources lie by the place of the library, for masters that do not say.
    pub fn new(guid: &str, location: Option<&str>, own: Option<PathBuf>, logging: bool) -> Result<Instance, Refusal> {
        let scene = resource::read_scene(location, own)?;
        let expected = resource::guid(&scene);
        if guid != expected {
            return Err(Refusal::Guid { given: guid.to_owned(), expected });
        }
        Ok(Instance::of_scene(&scene, logging))
    }

    /// An instance for a scene.
    pub fn of_scene(scene: &Scene, logging: bool) -> Instance {
        let interface = Interface::new(scene);
        let moment = first_moment(&interface);
        let fingerprint = resource::fingerprint(resource::guid(scene).as_bytes());
        let logged = if logging { LOG_CATEGORIES.to_vec() } else { Vec::new() };
        Instance {
            interface,
            fingerprint,
            moment,
            built: None,
            states: BTreeMap::new(),
            logged,
            messages: Vec::new(),
            let_go: false,
        }
    }

    /// Whether free bodies and points begin where the scene has them, at rest and out of balance, instead of in equilibrium.
    pub fn let_go(&mut self, on: bool) {
        if self.let_go != on {
            (self.let_go, self.moment.settled) = (on, false);
        }
    }

    /// What there is to tell since the last call of this function.
    pub fn take_messages(&mut self) -> Vec<Message> {
        std::mem::take(&mut self.messages)
    }

    /// Marks the instance as failed after a fault of the program itself.
    pub fn fail(&mut self) {
        self.moment.phase = Phase::Error;
        self.moment.step_status = StepStatus::Failed;
        self.built = None;
    }

    fn warn(&mut self, line: usize, text: Option<String>) {
        if let Some(text) = text {
            let text = format!("{}{text}", self.interface.prefix(line));
            self.messages.push(Message { category: WARNING, text });
        }
    }

    fn event(&mut self, text: String) {
        if self.logged.iter().any(|category| matches!(*category, "logEvents" | "logAll")) {
            self.messages.push(Message { category: "logEvents", text });
        }
    }

    fn check(&self, call: Call) -> Result<(), Refusal> {
        let phases = allowed(call);
        if phases.contains(&self.moment.phase) {
            return Ok(());
        }
        let allowed = phases.iter().map(|phase| phase.words()).collect::<Vec<_>>().join(", ");
        Err(Refusal::Phase { phase: self.moment.phase.words(), allowed })
    }

    /// Turns events on or off; errors and warnings are told always. No categories: all.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[&str]) -> Result<(), Refusal> {
        let mut logged = Vec::new();
        for category in categories {
            let known = LOG_CATEGORIES.iter().find(|known| *known == category);
            logged.push(*known.ok_or_else(|| Refusal::Category((*category).to_owned()))?);
        }
        if !on {
            logged.clear();
        } else if logged.is_empty() {
            logged = LOG_CATEGORIES.to_vec();
        }
        self.logged = logged;
        Ok(())
    }

    /// Start, stop and tolerance of the experiment.
    pub fn setup_experiment(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Result<(), Refusal> {
        self.check(Call::SetupExperiment)?;
        let refuse = |what, value, allowed: &str| Err(Refusal::Experiment { what, value, allowed: allowed.to_owned() });
        if !start.is_finite() {
            return refuse("startTime", start, "it must be a finite number");
        }
        match stop {
            Some(stop) if !(stop >= start && stop.is_finite()) => {
                return refuse("stopTime", stop, &format!("it must be a finite number not before the start time {start:?}"));
            }
            _ => {}
        }
        match tolerance {
            Some(tolerance) if !(tolerance > 0.0 && tolerance.is_finite()) => {
                return refuse("tolerance", tolerance, "it must be a positive number, such as 0.001");
            }
            _ => {}
        }
        self.moment.experiment = Experiment { start, stop, tolerance };
        self.moment.clock = start;
        self.moment.settled = false;
        Ok(())
    }

    /// Enters initialization mode.
    pub fn enter_initialization(&mut self) -> Result<(), Refusal> {
        self.check(Call::EnterInitialization)?;
        self.moment.phase = Phase::Initialization;
        Ok(())
    }

    /// Puts the line in equilibrium and leaves initialization mode.
    pub fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.check(Call::ExitInitialization)?;
        self.settle().inspect_err(|_| self.moment.phase = Phase::Error)?;
        self.moment.phase = Phase::StepComplete;
        for index in 0..self.moment.ends.len() {
            let given = self.interface.scene().lines.get(index).filter(|line| line.fairlead_on.is_none());
            let Some(given) = given.map(|line| line.fairlead) else { continue };
            let length =
                self.built.as_ref().and_then(|built| built.lines.get(index)).map_or(f64::INFINITY, |line| line.limits.length);
            let end = &mut self.moment.ends[index];
            let distance = end.origin.iter().zip(given).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            let warning = warnings::of_start(&mut end.told, distance, length);
            self.warn(index, warning);
        }
        Ok(())
    }

    /// Ends the simulation.
    pub fn terminate(&mut self) -> Result<(), Refusal> {
        self.check(Call::Terminate)?;
        self.moment.phase = Phase::Terminated;
        Ok(())
    }

    /// Back to the state after instantiation; a rerun is the same bit for bit.
    pub fn reset(&mut self) {
        self.moment = first_moment(&self.interface);
        self.built = None;
    }

    fn variable(&self, reference: u32, kind: Kind) -> Result<&Variable, Refusal> {
        let words = match kind {
            Kind::Real => "Real",
            Kind::Integer => "Integer or Enumeration",
        };
        let variable = self.interface.variable(reference).filter(|variable| variable.kind == kind);
        variable.ok_or(Refusal::UnknownReference { reference, kind: words })
    }

    /// Values of variables of a kind.
    pub fn get(&mut self, kind: Kind, references: &[u32], values: &mut [f64]) -> Result<(), Refusal> {
        self.check(Call::Get)?;
        let computed = |instance: &Instance, reference: &u32| {
            let variable = instance.variable(*reference, kind)?;
            let is_computed = matches!(variable.meaning, Meaning::Output(_) | Meaning::Local(_) | Meaning::BodyOutput(_));
            Ok(is_computed.then(|| variable.name.clone()))
        };
        let mut needs_line = None;
        for reference in references {
            needs_line = needs_line.or(computed(self, reference)?);
        }
        match (self.moment.phase, needs_line) {
            (Phase::Instantiated, Some(name)) => return Err(Refusal::NoValueYet { name }),
            (Phase::Initialization, Some(_)) => self.settle()?,
            _ => {}
        }
        for (reference, value) in references.iter().zip(values) {
            let variable = self.variable(*reference, kind)?;
            let Moment { ends, vessels, parameters, .. } = &self.moment;
            *value = match variable.meaning {
                Meaning::Input(input) => {
                    let (order, axis) = input.component();
                    ends[variable.line].inputs.values[order][axis]
                }
                Meaning::Output(output) => output.of(&ends[variable.line].outputs),
                Meaning::Local(local) => local.of(&ends[variable.line].last),
                Meaning::BodyInput(BodyInput::Motion(part, axis)) => vessels[variable.line].said.values[number_of(part)][axis],
                Meaning::BodyInput(BodyInput::Applied(part, axis)) => vessels[variable.line].said.applied[part][axis],
                Meaning::BodyOutput(output) => self.body_output(variable, output),
                Meaning::Parameter(_) | Meaning::Place(_) | Meaning::Choice(_) => parameters[variable.slot],
            };
        }
        Ok(())
    }

    /// Sets inputs and, up to the end of initialization, parameters. All or none.
    pub fn set(&mut self, kind: Kind, references: &[u32], values: &[f64]) -> Result<(), Refusal> {
        self.check(Call::Set)?;
        for (reference, value) in references.iter().zip(values) {
            self.may_set(self.variable(*reference, kind)?, *value)?;
        }
        for (reference, value) in references.iter().zip(values) {
            let Variable { meaning, slot, line, .. } = *self.variable(*reference, kind)?;
            match meaning {
                Meaning::Input(input) => {
                    let (order, axis) = input.component();
                    self.moment.ends[line].inputs.values[order][axis] = *value;
                }
                Meaning::BodyInput(BodyInput::Motion(part, axis)) => {
                    self.moment.vessels[line].said.values[number_of(part)][axis] = *value;
                }
                Meaning::BodyInput(BodyInput::Applied(part, axis)) => {
                    let applied = &mut self.moment.vessels[line].said.applied[part][axis];
                    if *applied != *value && self.moment.phase != Phase::StepComplete {
                        self.moment.settled = false;
                    }
                    *applied = *value;
                }
                Meaning::Parameter(_) | Meaning::Place(_) | Meaning::Choice(_) => {
                    if self.moment.parameters[slot] != *value {
                        self.moment.parameters[slot] = *value;
                        self.moment.settled = false;
                    }
                }
                Meaning::Output(_) | Meaning::Local(_) | Meaning::BodyOutput(_) => {}
            }
        }
        Ok(())
    }

    fn may_set(&self, variable: &Variable, value: f64) -> Result<(), Refusal> {
        let name = || variable.name.clone();
        match variable.meaning {
            Meaning::Output(_) | Meaning::BodyOutput(_) => {
                return Err(Refusal::Computed { name: name(), causality: "an output" });
            }
            Meaning::Local(_) => return Err(Refusal::Computed { name: name(), causality: "a local variable" }),
            _ if variable.is_parameter() && self.moment.phase == Phase::StepComplete => {
                return Err(Refusal::Fixed { name: name() });
            }
            _ => {}
        }
        if variable.min <= value && value <= variable.max {
            return Ok(());
        }
        Err(Refusal::Limits { name: name(), value, min: variable.min, max: variable.max })
    }

    /// Time derivatives of inputs at the present communication point; they hold for the next step only.
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Result<(), Refusal> {
        self.check(Call::SetInputDerivatives)?;
        let mut inputs: Vec<Inputs> = self.moment.ends.iter().map(|end| end.inputs).collect();
        let mut said: Vec<Said> = self.moment.vessels.iter().map(|vessel| vessel.said).collect();
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = self.variable(*reference, Kind::Real)?;
            let name = || variable.name.clone();
            if !variable.is_input() {
                return Err(Refusal::Order { name: name(), order, allowed: "only inputs have settable derivatives" });
            }
            if !(1..=2).contains(&order) {
                return Err(Refusal::Order { name: name(), order, allowed: "orders 1 and 2 can be set" });
            }
            if !value.is_finite() {
                return Err(Refusal::Derivative { name: name(), order, value });
            }
            match variable.meaning {
                Meaning::Input(input) => {
                    let (component, axis) = input.component();
                    inputs[variable.line].derivatives[order as usize - 1][component][axis] = Some(value);
                }
                Meaning::BodyInput(BodyInput::Motion(part @ (Part::Position | Part::Attitude), axis)) => {
                    said[variable.line].derivatives[order as usize - 1][number_of(part)][axis] = Some(value);
                }
                _ => {
                    let allowed = "of a body, position and attitude have settable derivatives";
                    return Err(Refusal::Order { name: name(), order, allowed });
                }
            }
        }
        self.moment.vessels.iter_mut().zip(said).for_each(|(vessel, said)| vessel.said = said);
        self.moment.ends.iter_mut().zip(inputs).for_each(|(end, inputs)| end.inputs = inputs);
        Ok(())
    }

    /// First time derivatives of outputs.
    pub fn output_derivatives(&mut self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Result<(), Refusal> {
        self.check(Call::GetOutputDerivatives)?;
        let mut rates: Vec<Option<Outputs>> = vec![None; self.moment.ends.len()];
        for ((reference, &order), value) in references.iter().zip(orders).zip(values) {
            let variable = self.variable(*reference, Kind::Real)?;
            let refuse = |allowed| Refusal::Order { name: variable.name.clone(), order, allowed };
            if !variable.is_output() {
                return Err(refuse("only outputs have derivatives to be read"));
            }
            if order != 1 {
                return Err(refuse("order 1 is available"));
            }
            let (meaning, line) = (variable.meaning, variable.line);
            *value = match meaning {
                Meaning::Output(output) => {
                    let rates = &mut rates[line];
                    *rates = rates.or_else(|| self.built.as_mut().map(|built| built.output_rates(line)));
                    rates.as_ref().map_or(0.0, |rates| output.of(rates))
                }
                Meaning::BodyOutput(output) => self.body_rate(line, output),
                _ => 0.0,
            };
        }
        Ok(())
    }

    /// Makes the lines, if parameters or positions changed since, and puts them in equilibrium at rest at the start time.
    fn settle(&mut self) -> Result<(), Refusal> {
        let placed = |vessel: &Vessel| vessel.origin == [vessel.said.values[0], vessel.said.values[1]];
        let unmoved =
            self.moment.ends.iter().all(|end| end.origin == end.inputs.values[0]) && self.moment.vessels.iter().all(placed);
        if self.moment.settled && unmoved && self.built.is_some() {
            return Ok(());
        }
        self.moment.settled = false;
        self.moment.ends.iter_mut().for_each(|end| end.origin = end.inputs.values[0]);
        self.moment.vessels.iter_mut().for_each(|vessel| vessel.origin = [vessel.said.values[0], vessel.said.values[1]]);
        let start = self.moment.experiment.start;
        let mut built = self.build()?;
        for (vessel, of) in self.moment.vessels.iter_mut().zip(&built.vessels) {
            let index = built.vessels.iter().position(|other| std::ptr::eq(other, of)).unwrap_or(0);
            vessel.settle(&built.conventions[index], of.arm, start);
        }
        let said: Vec<Said> = self.moment.vessels.iter().map(|vessel| vessel.said).collect();
        let reports =
            built.settle(start, &said, self.let_go.then(|| self.interface.scene())).map_err(|error| self.refusal(error))?;
        for (index, report) in reports.into_iter().enumerate() {
            let outputs = built.outputs(index);
            if !is_finite(&outputs) {
                return Err(Refusal::NotANumber { line: self.interface.prefix(index), until: start });
            }
            self.event(format!(
                "{}static equilibrium after {} iterations, unbalanced force {:.2e} N: tension {:.6e} N at the fairlead, {:.6e} N at \
                 the anchor",
                self.interface.prefix(index),
                report.iterations,
                report.residual,
                outputs.tension,
                outputs.anchor_tension
            ));
            let line = &mut built.lines[index];
            line.limits = Limits { tension: outputs.tension, grounded: outputs.grounded_length, ..line.limits };
            let end = &mut self.moment.ends[index];
            *end = End {
                outputs,
                filter: Filter::at_rest(end.origin, start),
                path: InputPath::at_rest(end.origin),
                last: LastStep::default(),
                ..*end
            };
        }
        self.built = Some(built);
        self.reach(start);
        self.moment.clock = start;
        self.moment.settled = true;
        Ok(())
    }

    /// The lines that the parameters describe, with their fairleads at the moment's origins.
    fn build(&self) -> Result<Built, Refusal> {
        let Moment { parameters, ends, experiment, vessels, .. } = &self.moment;
        let settings = self.interface.settings(parameters).map_err(|reason| Refusal::Parameter {
            name: "of the scene".to_owned(),
            value: "the combination".to_owned(),
            allowed: reason,
        })?;
        let conventions = self.interface.conventions(parameters);
        let mut scene = settings.scene;
        let default_tolerance = self.interface.scene().solver.tolerance;
        if let Some(tolerance) = experiment.tolerance.filter(|_| scene.solver.tolerance == default_tolerance) {
            scene.solver.tolerance = tolerance.clamp(1e-8, 0.1);
        }
        scene.lines.iter_mut().zip(ends).for_each(|(line, end)| line.fairlead = end.origin);
        for (index, body) in scene.bodies.iter_mut().enumerate().filter(|(_, body)| !body.is_free()) {
            let [position, angles] = vessels[index].origin.map(|values| conventions[index].turned(values));
            (body.position, body.attitude_deg) = (position, angles.map(f64::to_degrees));
        }
        scene.place_ends();
        // The scene's own motion says where the line will go, which the mesh is made for; the master may move it otherwise.
        check::check(&Scene { motion: Motion::Fixed, ..scene.clone() }, "parameters").map_err(|error| self.refusal(error))?;
        let (parameters, tolerance) = (parameters.clone(), experiment.tolerance);
        let (interpolation, filter) = (settings.interpolation, settings.filter);
        let (lines, groups) = (Vec::new(), Vec::new());
        let empty = Built { lines, groups, vessels: Vec::new(), conventions, parameters, tolerance, interpolation, filter };
        Built::new(&scene, vessels, empty).map_err(|error| self.refusal(error))
    }

    /// An error of the layers below, with the parameter's name where it speaks of a place in the scene.
    fn refusal(&self, error: Error) -> Refusal {
        match error {
            Error::Value { place, value, allowed, .. } => {
                let (name, allowed) = (self.interface.variable_at(&place), self.interface.in_own_words(allowed));
                Refusal::Parameter { name, value, allowed }
            }
            Error::Reach(ref reach) => {
                let index = (0..self.interface.lines()).find(|line| reach.place == format!("lines[{line}]")).unwrap_or(0);
                Refusal::Reach { line: self.interface.prefix(index), error }
            }
            other => Refusal::Solver(other),
        }
    }

    /// How the last step ended.
    pub fn step_status(&self) -> Result<StepStatus, Refusal> {
        self.check(Call::GetStatus)?;
        Ok(self.moment.step_status)
    }

    /// Time up to which the line was computed [s].
    pub fn last_successful_time(&self) -> Result<f64, Refusal> {
        self.check(Call::GetStatus)?;
        Ok(self.moment.clock)
    }

    /// What a line is like now at arc lengths from its fairlead [m]; none where there is no such line, or no equilibrium yet.
    pub fn places(&mut self, line: usize, at: &[f64]) -> Option<Vec<Place>> {
        let built = self.built.as_mut().filter(|_| self.moment.settled)?;
        (line < built.lines.len()).then(|| built.places(line, at))
    }

    /// Outputs of a line at the time reached; none where there is no such line, or no equilibrium yet.
    pub fn outputs(&self, line: usize) -> Option<&Outputs> {
        self.moment.ends.get(line).filter(|_| self.moment.settled).map(|end| &end.outputs)
    }

    /// Where a body is at the time reached and what the lines do to it, in the axes of the scene; none as for `outputs`.
    pub fn reached(&self, body: usize) -> Option<&Reached> {
        self.moment.vessels.get(body).filter(|_| self.moment.settled).map(|vessel| &vessel.reached)
    }

    /// Position [m] and velocity [m/s] of a free point of the scene at the time reached; none as for `outputs`.
    pub fn point(&self, point: usize) -> Option<[Vector3<f64>; 2]> {
        let (_, motion) = self.moment.points.iter().find(|(number, _)| *number == point)?;
        Some(*motion)
    }

    /// Keeps the present state under a handle: the given one, if it is not zero, else a new one.
    pub fn get_state(&mut self, handle: usize) -> Result<usize, Refusal> {
        self.check(Call::GetState)?;
        let handle = match handle {
            0 => self.keep(State { moment: self.moment.clone(), lines: Vec::new() }),
            given => given,
        };
        let state = self.states.get_mut(&handle).ok_or(Refusal::UnknownState)?;
        state.moment.copy_from(&self.moment);
        let running = matches!(self.moment.phase, Phase::StepComplete | Phase::StepFailed | Phase::Terminated);
        match self.built.as_ref().filter(|_| running) {
            Some(built) => built.save(&mut state.lines),
            None => state.lines.clear(),
        }
        Ok(handle)
    }

    fn keep(&mut self, state: State) -> usize {
        let state = Box::new(state);
        let handle = std::ptr::from_ref(&*state).addr();
        self.states.insert(handle, state);
        handle
    }

    /// Goes back to a state, phase and clock included.
    pub fn set_state(&mut self, handle: usize) -> Result<(), Refusal> {
        let state = self.states.remove(&handle).ok_or(Refusal::UnknownState)?;
        let result = self.go_to(&state);
        self.states.insert(handle, state);
        result
    }

    fn go_to(&mut self, state: &State) -> Result<(), Refusal> {
        let State { moment, lines } = state;
        if lines.is_empty() {
            self.moment.copy_from(moment);
            self.moment.settled = false;
            self.built = None;
            return Ok(());
        }
        let fits = |built: &Built| {
            let placed = built.lines.iter().zip(&moment.ends).all(|(line, end)| line.origin == end.origin);
            let moored = built.vessels.iter().zip(&moment.vessels).all(|(of, vessel)| of.origin == vessel.origin);
            placed && moored && built.parameters == moment.parameters && built.tolerance == moment.experiment.tolerance
        };
        if !self.built.as_ref().is_some_and(fits) {
            let present = std::mem::replace(&mut self.moment, moment.clone());
            match self.build() {
                Ok(built) => self.built = Some(built),
                Err(refusal) => {
                    self.moment = present;
                    return Err(refusal);
                }
            }
            self.moment = present;
        }
        let Some(built) = self.built.as_mut() else { return Err(Refusal::UnknownState) };
        if !built.fits(lines) {
            return Err(Refusal::Serialized("its line has another mesh"));
        }
        built.restore(lines);
        self.moment.copy_from(moment);
        Ok(())
    }

    /// Forgets a state.
    pub fn free_state(&mut self, handle: usize) -> Result<(), Refusal> {
        self.states.remove(&handle).map(|_| ()).ok_or(Refusal::UnknownState)
    }

    /// A state as bytes.
    pub fn serialized(&self, handle: usize) -> Result<Vec<u8>, Refusal> {
        let state = self.states.get(&handle).ok_or(Refusal::UnknownState)?;
        Ok(state.to_bytes(self.fingerprint))
    }

    /// A state from bytes, under a new handle.
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<usize, Refusal> {
        let state = State::from_bytes(bytes, self.fingerprint, &self.moment)?;
        Ok(self.keep(state))
    }
}

/// An instance as it is made.
fn first_moment(interface: &Interface) -> Moment {
    let mut inputs = vec![Inputs::default(); interface.lines()];
    for variable in interface.variables() {
        if let Meaning::Input(input) = variable.meaning {
            let (order, axis) = input.component();
            inputs[variable.line].values[order][axis] = variable.start;
        }
    }
    Moment {
        phase: Phase::Instantiated,
        experiment: Experiment { start: 0.0, stop: None, tolerance: None },
        clock: 0.0,
        last_step_size: DEFAULT_STEP,
        step_status: StepStatus::Done,
        parameters: interface.start_values(),
        settled: false,
        ends: inputs.into_iter().map(End::at_rest).collect(),
        vessels: interface.said_first().into_iter().map(Vessel::at_rest).collect(),
        points: Vec::new(),
    }
}

fn is_finite(outputs: &Outputs) -> bool {
    let Outputs { fairlead, force, anchor_force, .. } = outputs;
    let scalars = [
        outputs.time,
        outputs.tension,
        outputs.anchor_tension,
        outputs.tension_max,
        outputs.declination,
        outputs.azimuth,
        outputs.grounded_length,
        outputs.work,
    ];
    [fairlead, force, anchor_force].into_iter().flatten().chain(&scalars).all(|value| value.is_finite())
}
