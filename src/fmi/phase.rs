//! The life of an instance: phases, which call is allowed when, and how a step ended.

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
pub fn allowed(call: Call) -> &'static [Phase] {
    use Phase::{Error, Initialization, Instantiated, StepComplete, StepFailed, Terminated};
    match call {
        Call::SetupExperiment => &[Instantiated],
        Call::EnterInitialization => &[Instantiated],
        Call::ExitInitialization => &[Initialization],
        Call::Terminate => &[StepComplete, StepFailed],
        Call::Get => &[Instantiated, Initialization, StepComplete, StepFailed, Terminated, Error],
        Call::Set => &[Instantiated, Initialization, StepComplete],
        Call::GetState => &[Instantiated, Initialization, StepComplete, StepFailed, Terminated],
        Call::DirectionalDerivative => &[Initialization, StepComplete, StepFailed, Terminated],
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

    /// What the phase is called in a message.
    pub fn words(self) -> &'static str {
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
