//! What the master says of the experiment before it begins: start, stop, tolerance.

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
