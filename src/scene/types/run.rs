//! The part `run` of a scene: from when to when, and how often there is output.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Duration and output interval of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Simulated time [s], ≥ 0. Default 120.
    #[serde(default = "default_duration")]
    #[schemars(range(min = 0.0))]
    pub duration: f64,
    /// Time at which the run begins [s]; the fairlead's motion is that of this time and after. Default 0.
    #[serde(default)]
    pub start: f64,
    /// Interval of `timeseries.csv` [s], > 0. Default 0.1.
    #[serde(default = "default_output_step")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub output_step: f64,
    /// Time after the start that the statistics of a random sea and the damage leave out [s], ≥ 0 and below `duration`. Default: the
    /// ramp of the waves or of the sinusoidal motion, whichever is longer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub transient: Option<f64>,
}

fn default_duration() -> f64 {
    120.0
}
fn default_output_step() -> f64 {
    0.1
}

impl Default for Run {
    fn default() -> Self {
        Run { duration: default_duration(), start: 0.0, output_step: default_output_step(), transient: None }
    }
}

impl Run {
    /// Time at which the run ends [s].
    pub fn end(&self) -> f64 {
        self.start + self.duration
    }
}
