//! One instance of the FMU: in which phase which call is allowed, the clock, from inputs to a path, and the step. No C types.
//!
//! A refused call changes nothing. A step that fails leaves the line as it was before; `set_state` and `reset` go on from there.

use crate::error::Error;
use crate::fmi::input_path::{InputPath, Inputs, Plan, Segment};
use crate::fmi::refusal::Refusal;
use crate::fmi::resource;
use crate::fmi::snapshot::{Moment, State};
use crate::fmi::variables::{DEFAULT_STEP, Interface, Interpolation, Kind, LOG_CATEGORIES, Meaning, Variable};
use crate::scene::check;
use crate::scene::types::{Motion, Scene};
use crate::solve::simulation::{LastStep, Outputs, Simulation};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Longest communication step [s]; more is a mistake of units or an uninitialised number.
const LONGEST_STEP: f64 = 1.0e6;
/// Shortest communication step [s]; less drowns in rounding wherever the solver divides by its square.
const SHORTEST_STEP: f64 = 1.0e-9;
/// Two times are the same if they differ by less than this part of their size.
const SAME_TIME: f64 = 1.0e-9;

/// Where an instance stands in its life (FMI 2.0, state machine of co-simulation).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Made or reset.
    Instantiated,
    /// Between fmi2EnterInitializationMode and fmi2ExitInitializationMode.
    Initialization,
    /// At a communication point.
    StepComplete,
    /// A step was done only in part (fmi2Discard).
    StepFailed,
    /// After fmi2Terminate.
    Terminated,
    /// A step or the initialisation failed.
    Error,
}

/// The functions that are not allowed always.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Call {
    SetupExperiment,
    EnterInitialization,
    ExitInitialization,
    Terminate,
    Get,
    Set,
    GetState,
    DirectionalDerivative,
    SetInputDerivatives,
    GetOutputDerivatives,
    DoStep,
    GetStatus,
}

/// The phases in which each function is allowed. All others (reset, states other than taking one, logging, free) are allowed always.
fn allowed(call: Call) -> &'static [Phase] {
    use Phase::{Error, Initialization, Instantiated, StepComplete, StepFailed, Terminated};
    match call {
        Call::SetupExperiment => &[Instantiated],
        Call::EnterInitialization => &[Instantiated],
        Call::ExitInitialization => &[Initialization],
        Call::Terminate => &[StepComplete, StepFailed],
        Call::Get => &[Instantiated, Initialization, StepComplete, StepFailed, Terminated, Error],
        Call::Set => &[Instantiated, Initialization, StepComplete],
        Call::GetState => &[Instantiated, Initialization, StepComplete, StepFailed, Terminated],
        Call::DirectionalDerivative => &[Initialization, StepComplete],
        Call::SetInputDerivatives => &[Instantiated, Initialization, StepComplete],
        Call::GetOutputDerivatives => &[StepComplete, StepFailed, Terminated],
        Call::DoStep => &[StepComplete],
        Call::GetStatus => &[StepComplete, StepFailed, Terminated, Error],
    }
}

impl Phase {
    const ALL: [Phase; 6] =
        [Phase::Instantiated, Phase::Initialization, Phase::StepComplete, Phase::StepFailed, Phase::Terminated, Phase::Error];

    /// Number in a serialized state.
    pub fn number(self) -> usize {
        self as usize
    }

    /// The phase of a number.
    pub fn from_number(number: usize) -> Option<Phase> {
        Phase::ALL.get(number).copied()
    }

    fn words(self) -> &'static str {
        match self {
            Phase::Instantiated => "before fmi2EnterInitializationMode",
            Phase::Initialization => "in initialization mode",
            Phase::StepComplete => "at a communication point",
            Phase::StepFailed => "after a discarded step",
            Phase::Terminated => "after fmi2Terminate",
            Phase::Error => "after an error (go back with fmi2SetFMUstate or fmi2Reset)",
        }
    }
}

/// How the last step ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepStatus {
    /// Done, or no step yet.
    Done,
    /// Done in part.
    Discarded,
    /// Not done.
    Failed,
}

impl StepStatus {
    const ALL: [StepStatus; 3] = [StepStatus::Done, StepStatus::Discarded, StepStatus::Failed];

    /// Number in a serialized state.
    pub fn number(self) -> usize {
        self as usize
    }

    /// The status of a number.
    pub fn from_number(number: usize) -> Option<StepStatus> {
        StepStatus::ALL.get(number).copied()
    }
}

/// What the master said of the experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Experiment {
    /// First communication point [s].
    pub start: f64,
    /// No step ends after this time [s].
    pub stop: Option<f64>,
    /// Relative tolerance, where the master gives one.
    pub tolerance: Option<f64>,
}

/// Something to tell the master.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Log category, one of `LOG_CATEGORIES`.
    pub category: &'static str,
    /// The text.
    pub text: String,
}

/// A line and what it was made from.
struct BuiltLine {
    simulation: Simulation,
    parameters: Vec<f64>,
    origin: [f64; 3],
    tolerance: Option<f64>,
    interpolation: Interpolation,
}

/// One mooring line in the hands of a master.
pub struct Instance {
    interface: Interface,
    fingerprint: u128,
    moment: Moment,
    line: Option<BuiltLine>,
    /// States handed out, by their address, which serves as handle and is never dereferenced.
    states: BTreeMap<usize, Box<State>>,
    logged: Vec<&'static str>,
    messages: Vec<Message>,
}

impl Instance {
    /// An instance of the FMU whose resources lie at a URI; its GUID must be the one the master read.
    pub fn new(guid: &str, resource_location: &str, logging: bool) -> Result<Instance, Refusal> {
        let scene = resource::read_scene(resource_location)?;
        let expected = resource::guid(&scene);
        if guid != expected {
            return Err(Refusal::Guid { given: guid.to_owned(), expected });
        }
        Ok(Instance::of_scene(&scene, logging))
    }

    /// An instance for a scene with one line.
    pub fn of_scene(scene: &Scene, logging: bool) -> Instance {
        let interface = Interface::new(scene);
        let moment = first_moment(&interface);
        let fingerprint = resource::fingerprint(resource::guid(scene).as_bytes());
        let logged = if logging { LOG_CATEGORIES.to_vec() } else { Vec::new() };
        Instance { interface, fingerprint, moment, line: None, states: BTreeMap::new(), logged, messages: Vec::new() }
    }

    /// What there is to tell since the last call of this function.
    pub fn take_messages(&mut self) -> Vec<Message> {
        std::mem::take(&mut self.messages)
    }

    /// Marks the instance as failed after a fault of the program itself.
    pub fn fail(&mut self) {
        self.moment.phase = Phase::Error;
        self.moment.step_status = StepStatus::Failed;
        self.line = None;
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
        self.line = None;
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
            Ok(matches!(variable.meaning, Meaning::Output(_) | Meaning::Local(_)).then(|| variable.name.clone()))
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
            *value = match variable.meaning {
                Meaning::Input(input) => {
                    let (order, axis) = input.component();
                    self.moment.inputs.values[order][axis]
                }
                Meaning::Output(output) => output.of(&self.moment.outputs),
                Meaning::Local(local) => local.of(&self.moment.last),
                Meaning::Parameter(_) | Meaning::Place(_) => self.moment.parameters[variable.slot],
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
            let Variable { meaning, slot, .. } = *self.variable(*reference, kind)?;
            match meaning {
                Meaning::Input(input) => {
                    let (order, axis) = input.component();
                    self.moment.inputs.values[order][axis] = *value;
                }
                Meaning::Parameter(_) | Meaning::Place(_) => {
                    if self.moment.parameters[slot] != *value {
                        self.moment.parameters[slot] = *value;
                        self.moment.settled = false;
                    }
                }
                Meaning::Output(_) | Meaning::Local(_) => {}
            }
        }
        Ok(())
    }

    fn may_set(&self, variable: &Variable, value: f64) -> Result<(), Refusal> {
        let name = || variable.name.clone();
        match variable.meaning {
            Meaning::Output(_) => return Err(Refusal::Computed { name: name(), causality: "an output" }),
            Meaning::Local(_) => return Err(Refusal::Computed { name: name(), causality: "a local variable" }),
            Meaning::Parameter(_) | Meaning::Place(_) if self.moment.phase == Phase::StepComplete => {
                return Err(Refusal::Fixed { name: name() });
            }
            Meaning::Parameter(_) | Meaning::Place(_) | Meaning::Input(_) => {}
        }
        if variable.min <= value && value <= variable.max {
            return Ok(());
        }
        Err(Refusal::Limits { name: name(), value, min: variable.min, max: variable.max })
    }

    /// Time derivatives of inputs at the present communication point; they hold for the next step only.
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Result<(), Refusal> {
        self.check(Call::SetInputDerivatives)?;
        let mut derivatives = self.moment.inputs.derivatives;
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = self.variable(*reference, Kind::Real)?;
            let name = || variable.name.clone();
            let Meaning::Input(input) = variable.meaning else {
                return Err(Refusal::Order { name: name(), order, allowed: "only inputs have settable derivatives" });
            };
            if !(1..=2).contains(&order) {
                return Err(Refusal::Order { name: name(), order, allowed: "orders 1 and 2 can be set" });
            }
            if !value.is_finite() {
                return Err(Refusal::Derivative { name: name(), order, value });
            }
            let (component, axis) = input.component();
            derivatives[order as usize - 1][component][axis] = Some(value);
        }
        self.moment.inputs.derivatives = derivatives;
        Ok(())
    }

    /// First time derivatives of outputs.
    pub fn output_derivatives(&self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Result<(), Refusal> {
        self.check(Call::GetOutputDerivatives)?;
        let rates = self.line.as_ref().map(|line| line.simulation.output_rates());
        for ((reference, &order), value) in references.iter().zip(orders).zip(values) {
            let variable = self.variable(*reference, Kind::Real)?;
            let refuse = |allowed| Refusal::Order { name: variable.name.clone(), order, allowed };
            let Meaning::Output(output) = variable.meaning else {
                return Err(refuse("only outputs have derivatives to be read"));
            };
            if order != 1 {
                return Err(refuse("order 1 is available"));
            }
            *value = rates.as_ref().map_or(0.0, |rates| output.of(rates));
        }
        Ok(())
    }

    /// Makes the line, if parameters or position changed since, and puts it in equilibrium at rest at the start time.
    fn settle(&mut self) -> Result<(), Refusal> {
        let origin = self.moment.inputs.values[0];
        if self.moment.settled && self.moment.origin == origin && self.line.is_some() {
            return Ok(());
        }
        self.moment.settled = false;
        self.moment.origin = origin;
        let start = self.moment.experiment.start;
        let mut line = self.build()?;
        let report = line.simulation.settle(Vector3::from(origin), start).map_err(|error| self.refusal(error))?;
        let outputs = line.simulation.outputs();
        if !is_finite(&outputs) {
            return Err(Refusal::NotANumber { until: start });
        }
        self.event(format!(
            "static equilibrium after {} iterations, unbalanced force {:.2e} N: tension {:.6e} N at the fairlead, {:.6e} N at the anchor",
            report.iterations, report.residual, outputs.tension, outputs.anchor_tension
        ));
        self.line = Some(line);
        self.moment.outputs = outputs;
        self.moment.last = LastStep::default();
        self.moment.path = InputPath::at_rest(origin);
        self.moment.clock = start;
        self.moment.settled = true;
        Ok(())
    }

    /// The line that the parameters describe, with its fairlead at the moment's origin.
    fn build(&self) -> Result<BuiltLine, Refusal> {
        let Moment { parameters, origin, experiment, .. } = self.moment.clone();
        let settings = self.interface.settings(&parameters).map_err(|reason| Refusal::Parameter {
            name: "of the scene".to_owned(),
            value: "the combination".to_owned(),
            allowed: reason,
        })?;
        let mut scene = settings.scene;
        let default_tolerance = self.interface.scene().solver.tolerance;
        if let Some(tolerance) = experiment.tolerance.filter(|_| scene.solver.tolerance == default_tolerance) {
            scene.solver.tolerance = tolerance.clamp(1e-8, 0.1);
        }
        if let Some(line) = scene.lines.first_mut() {
            line.fairlead = origin;
        }
        check::check(&Scene { motion: Motion::Fixed, ..scene.clone() }, "parameters").map_err(|error| self.refusal(error))?;
        let mut simulation = Simulation::new(&scene, 0).map_err(|error| self.refusal(error))?;
        simulation.sum_up_work();
        Ok(BuiltLine { simulation, parameters, origin, tolerance: experiment.tolerance, interpolation: settings.interpolation })
    }

    /// An error of the layers below, with the parameter's name where it speaks of a place in the scene.
    fn refusal(&self, error: Error) -> Refusal {
        match error {
            Error::Value { place, value, allowed, .. } => {
                Refusal::Parameter { name: self.interface.variable_at(&place), value, allowed }
            }
            Error::Unsupported { place, feature, .. } => {
                Refusal::Unsupported { name: self.interface.variable_at(&place), feature }
            }
            Error::Reach(_) => Refusal::Reach(error),
            other => Refusal::Solver(other),
        }
    }

    /// Advances from the master's communication point over its step.
    pub fn do_step(&mut self, time: f64, step: f64) -> Result<(), Refusal> {
        self.check(Call::DoStep)?;
        let until = self.end_of_step(time, step)?;
        let (plan, segment) = self.plan(until);
        let Some(line) = &mut self.line else { return Err(Refusal::UnknownState) };
        match line.simulation.advance(until, &segment.path()) {
            Ok(()) => {
                self.arrive(&plan, &segment, until)?;
                self.moment.last_step_size = step;
                self.moment.inputs.derivatives = Inputs::default().derivatives;
                self.moment.step_status = StepStatus::Done;
                Ok(())
            }
            Err(error) => Err(self.step_in_part(&plan, &segment, until, error)),
        }
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
        let tolerance = (SAME_TIME * time.abs().max(step)).min(1e-3 * step).max(4.0 * f64::EPSILON * clock.abs());
        if !((time - clock).abs() <= tolerance) {
            return Err(Refusal::CommunicationPoint { given: time, clock });
        }
        let until = time + step;
        if !(until > clock && until > time) {
            return refuse("it is too short to be told from the present time");
        }
        match self.moment.experiment.stop {
            Some(stop) if until > stop + (SAME_TIME * stop.abs().max(step)).min(1e-3 * step) => {
                Err(Refusal::PastStop { time, step, stop })
            }
            _ => Ok(until),
        }
    }

    fn plan(&self, until: f64) -> (Plan, Segment) {
        let Moment { clock, inputs, path, .. } = &self.moment;
        let interpolation = self.line.as_ref().map_or_else(Interpolation::default, |line| line.interpolation);
        let plan = path.plan(interpolation, *clock, until - clock, inputs);
        let segment = path.segment(&plan, inputs);
        (plan, segment)
    }

    /// Takes over what the line is after reaching a time.
    fn arrive(&mut self, plan: &Plan, segment: &Segment, time: f64) -> Result<(), Refusal> {
        let Some(line) = &self.line else { return Err(Refusal::UnknownState) };
        let outputs = line.simulation.outputs();
        if !is_finite(&outputs) {
            self.moment.phase = Phase::Error;
            self.moment.step_status = StepStatus::Failed;
            return Err(Refusal::NotANumber { until: time });
        }
        self.moment.outputs = outputs;
        self.moment.last = line.simulation.last_step();
        let inputs = self.moment.inputs;
        self.moment.path.advance(plan, &inputs, segment, time);
        self.moment.clock = time;
        Ok(())
    }

    /// After a failure: goes as far as the solver came, or half of it, so that the master learns how far that is.
    fn step_in_part(&mut self, plan: &Plan, segment: &Segment, until: f64, mut error: Error) -> Refusal {
        let stuck_at = match &error {
            Error::Step(stuck) => stuck.time.min(until),
            _ => self.moment.clock,
        };
        for part in [0.9, 0.5] {
            let reached = self.moment.clock + part * (stuck_at - self.moment.clock);
            let worth_it = reached - self.moment.clock > 1e-3 * (until - self.moment.clock);
            let line = self.line.as_mut().filter(|_| worth_it);
            if line.is_some_and(|line| line.simulation.advance(reached, &segment.path()).is_ok()) {
                if let Err(refusal) = self.arrive(plan, segment, reached) {
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

    /// Change of outputs at the end of a step as long as the last one, along a direction of the inputs at its start.
    pub fn directional_derivative(&mut self, unknowns: &[u32], knowns: &[u32], seeds: &[f64]) -> Result<Vec<f64>, Refusal> {
        self.check(Call::DirectionalDerivative)?;
        let mut outputs = Vec::with_capacity(unknowns.len());
        for reference in unknowns {
            let variable = self.variable(*reference, Kind::Real)?;
            let Meaning::Output(output) = variable.meaning else {
                let (role, allowed) = ("an unknown", "unknowns are the Real outputs");
                return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
            };
            outputs.push(output);
        }
        let mut direction = [[0.0; 3]; 2];
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
            direction[order][axis] += seed;
        }
        if self.moment.phase == Phase::Initialization {
            self.settle()?;
        }
        let until = self.moment.clock + self.moment.last_step_size;
        let (plan, segment) = self.plan(until);
        let variation = self.moment.path.variation(&plan, &self.moment.inputs, direction).path();
        let Some(line) = &mut self.line else { return Err(Refusal::UnknownState) };
        let from = line.simulation.snapshot();
        let changes = line.simulation.differentiate(&from, until, &segment.path(), &[variation]).map_err(Refusal::Solver)?;
        Ok(changes.first().map_or_else(Vec::new, |change| outputs.iter().map(|output| output.of(change)).collect()))
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

    fn state(&mut self) -> State {
        let running = matches!(self.moment.phase, Phase::StepComplete | Phase::StepFailed | Phase::Terminated);
        let line = self.line.as_mut().filter(|_| running).map(|line| line.simulation.snapshot());
        State { moment: self.moment.clone(), line }
    }

    /// Keeps the present state under a handle: the given one, if it is not zero, else a new one.
    pub fn get_state(&mut self, handle: usize) -> Result<usize, Refusal> {
        self.check(Call::GetState)?;
        let state = self.state();
        if handle == 0 {
            return Ok(self.keep(state));
        }
        **self.states.get_mut(&handle).ok_or(Refusal::UnknownState)? = state;
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
        let Some(snapshot) = &state.line else {
            self.moment = state.moment.clone();
            self.moment.settled = false;
            self.line = None;
            return Ok(());
        };
        let State { moment, .. } = state;
        let fits = |line: &BuiltLine| {
            let tolerance = moment.experiment.tolerance;
            line.parameters == moment.parameters && line.origin == moment.origin && line.tolerance == tolerance
        };
        if !self.line.as_ref().is_some_and(fits) {
            let present = std::mem::replace(&mut self.moment, moment.clone());
            match self.build() {
                Ok(line) => self.line = Some(line),
                Err(refusal) => {
                    self.moment = present;
                    return Err(refusal);
                }
            }
        }
        if !self.line.as_mut().is_some_and(|line| line.simulation.restore(snapshot)) {
            return Err(Refusal::Serialized("its line has another mesh"));
        }
        self.moment.clone_from(moment);
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
        let state = State::from_bytes(bytes, self.fingerprint, self.moment.parameters.len())?;
        Ok(self.keep(state))
    }
}

/// An instance as it is made.
fn first_moment(interface: &Interface) -> Moment {
    let mut inputs = Inputs::default();
    for variable in interface.variables() {
        if let Meaning::Input(input) = variable.meaning {
            let (order, axis) = input.component();
            inputs.values[order][axis] = variable.start;
        }
    }
    let zero = Vector3::zeros();
    let outputs = Outputs {
        time: 0.0,
        fairlead: zero,
        force: zero,
        tension: 0.0,
        anchor_force: zero,
        anchor_tension: 0.0,
        tension_max: 0.0,
        declination: 0.0,
        azimuth: 0.0,
        grounded_length: 0.0,
        work: 0.0,
    };
    Moment {
        phase: Phase::Instantiated,
        experiment: Experiment { start: 0.0, stop: None, tolerance: None },
        clock: 0.0,
        last_step_size: DEFAULT_STEP,
        step_status: StepStatus::Done,
        parameters: interface.start_values(),
        origin: inputs.values[0],
        settled: false,
        inputs,
        path: InputPath::at_rest(inputs.values[0]),
        outputs,
        last: LastStep::default(),
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
