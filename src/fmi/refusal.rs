//! Every reason for which the FMU refuses a call, as data, and the only file of this layer that words it.

use crate::error::Error;
use thiserror::Error as Wording;

/// Why a call was refused or a step not done. Its `Display` is the line in the master's log.
#[derive(Debug, Clone, PartialEq, Wording)]
pub enum Refusal {
    /// The function may not be called now.
    #[error("not allowed {phase}; it is allowed {allowed}")]
    Phase {
        /// Where the instance stands.
        phase: &'static str,
        /// Where it would have to stand.
        allowed: String,
    },
    /// No variable of this type has this value reference.
    #[error("value reference {reference} is no {kind} variable of this FMU: see modelDescription.xml")]
    UnknownReference {
        /// The value reference.
        reference: u32,
        /// `Real`, `Integer`, `Boolean` or `String`.
        kind: &'static str,
    },
    /// The variable is an output or local: nobody sets it but the FMU.
    #[error("{name} is {causality}, computed by the FMU: it cannot be set")]
    Computed {
        /// The variable.
        name: String,
        /// `an output`, `a local variable`.
        causality: &'static str,
    },
    /// A parameter was set after initialisation.
    #[error("{name} is a fixed parameter: set it before fmi2ExitInitializationMode, or call fmi2Reset first")]
    Fixed {
        /// The parameter.
        name: String,
    },
    /// An output was asked for before there was a line.
    #[error("{name} has no value before fmi2EnterInitializationMode: the line is put in equilibrium there")]
    NoValueYet {
        /// The variable.
        name: String,
    },
    /// A value is no number, or outside the limits of modelDescription.xml.
    #[error("{name} = {value} is not allowed: it must be a number from {min} to {max}")]
    Limits {
        /// The variable.
        name: String,
        /// The value given.
        value: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A derivative of an input is no number.
    #[error("the derivative of order {order} of {name} = {value} is not a finite number")]
    Derivative {
        /// The input.
        name: String,
        /// Order of the derivative.
        order: i32,
        /// The value given.
        value: f64,
    },
    /// A derivative of this order is not known.
    #[error("derivatives of order {order} of {name} are not available: {allowed}")]
    Order {
        /// The variable.
        name: String,
        /// Order asked for.
        order: i32,
        /// What is available.
        allowed: &'static str,
    },
    /// Derivatives are defined for Real outputs by Real inputs.
    #[error("{name} cannot be {role} of a directional derivative: {allowed}")]
    Direction {
        /// The variable.
        name: String,
        /// `an unknown` or `a known`.
        role: &'static str,
        /// What can.
        allowed: &'static str,
    },
    /// The experiment makes no sense.
    #[error("{what} = {value} is not allowed: {allowed}")]
    Experiment {
        /// `startTime`, `stopTime` or `tolerance`.
        what: &'static str,
        /// The value given.
        value: f64,
        /// What is allowed.
        allowed: String,
    },
    /// The step is no positive, finite, representable length.
    #[error("communicationStepSize = {step} s at t = {time} s is not allowed: {allowed}")]
    StepSize {
        /// Communication point [s].
        time: f64,
        /// The step given [s].
        step: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The master's time is not ours.
    #[error("currentCommunicationPoint = {given:?} s, but the FMU stands at t = {clock:?} s: steps must follow each other")]
    CommunicationPoint {
        /// The master's time [s].
        given: f64,
        /// Ours [s].
        clock: f64,
    },
    /// A body is given a pose far from where it is.
    #[error(
        "{body} is given {distance:.1} m from where it is at t = {time:?} s: no step goes farther than 100 m. Are the axes and units those of \
         modelDescription.xml? Nothing was done; set the pose and step again"
    )]
    PoseJump {
        /// The body.
        body: String,
        /// Communication point [s].
        time: f64,
        /// How far [m].
        distance: f64,
    },
    /// A body is given an attitude far from its own.
    #[error(
        "{body} is given an attitude {degrees:.0} degrees from its own at t = {time:?} s: no step turns farther than 90. Are angles in radians, and \
         roll, pitch, yaw in this order? Nothing was done; set the pose and step again"
    )]
    PoseTurn {
        /// The body.
        body: String,
        /// Communication point [s].
        time: f64,
        /// By how much [deg].
        degrees: f64,
    },
    /// The step would end after the experiment.
    #[error("a step of {step:?} s from t = {time:?} s ends after the stop time {stop:?} s of fmi2SetupExperiment")]
    PastStop {
        /// Communication point [s].
        time: f64,
        /// The step given [s].
        step: f64,
        /// The stop time [s].
        stop: f64,
    },
    /// Part of the step was done.
    #[error("the step to t = {until:?} s was done only up to t = {reached:?} s: {cause}")]
    Discarded {
        /// End of the step asked for [s].
        until: f64,
        /// Time reached [s].
        reached: f64,
        /// Why not further.
        cause: String,
    },
    /// The line does not reach from fairlead to anchor.
    #[error("{line}line.length, {line}fairlead.position and {line}anchor.position do not fit together: {error}")]
    Reach {
        /// What stands in front of the line's variables.
        line: String,
        /// By how much it is too short.
        error: Error,
    },
    /// The line could not be put in equilibrium, or a step could not be done at all.
    #[error("{0}")]
    Solver(Error),
    /// A parameter or the fairlead's position, alone or with others, describes no possible line.
    #[error("{name}: {value} is not allowed: {allowed}")]
    Parameter {
        /// The variable.
        name: String,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// The solver claims success with a result that is no number.
    #[error(
        "{line}tension: the step to t = {until:?} s gave a result that is not a number; go back with fmi2SetFMUstate or fmi2Reset"
    )]
    NotANumber {
        /// What stands in front of the line's variables.
        line: String,
        /// End of the step [s].
        until: f64,
    },
    /// A pointer that must not be NULL.
    #[error("{argument} is NULL")]
    Null {
        /// The argument.
        argument: &'static str,
    },
    /// Text that is not UTF-8.
    #[error("{argument} is not valid UTF-8")]
    Text {
        /// The argument.
        argument: &'static str,
    },
    /// The instance cannot be made.
    #[error("cannot instantiate: {0}")]
    Instantiate(String),
    /// The GUID is that of another model description.
    #[error(
        "the master read the GUID {given} from modelDescription.xml, but resources/scene.json and this library belong to {expected}: the \
         FMU was mixed from different files; pack it again"
    )]
    Guid {
        /// The GUID given.
        given: String,
        /// The GUID of interface and scene.
        expected: String,
    },
    /// resources/scene.json cannot be used.
    #[error("{path}: {reason}; the FMU was not unpacked completely or was damaged: unpack it again")]
    Resource {
        /// The file, or the URI given.
        path: String,
        /// What is wrong.
        reason: String,
    },
    /// A state handle that this instance did not give out, or freed.
    #[error("this FMU state does not belong to this instance, or was freed")]
    UnknownState,
    /// A serialized state that cannot be read.
    #[error("the serialized state is refused: {0}")]
    Serialized(&'static str),
    /// A buffer that is too small.
    #[error("the buffer holds {given} bytes, but the serialized state needs {needed}")]
    Buffer {
        /// Its size.
        given: usize,
        /// What is needed.
        needed: usize,
    },
    /// A log category that is not declared.
    #[error("\"{0}\" is no log category of this FMU: see LogCategories in modelDescription.xml")]
    Category(String),
    /// No step is under way that could be cancelled.
    #[error("no step is under way: fmi2DoStep returns when the step is done")]
    NothingToCancel,
    /// A status that does not exist.
    #[error("{0} is no fmi2StatusKind")]
    StatusKind(i32),
    /// A status that this FMU does not keep.
    #[error("this status is not available: steps are done when fmi2DoStep returns")]
    NoStatus,
    /// The program itself is at fault.
    #[error("internal error, please report it: {0}")]
    Panic(String),
}
