//! The part `environment.waves` of a scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Waves by linear theory in water of `depth`, with Wheeler's stretching to the surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Waves {
    /// One regular wave: elevation a·cos(k(x cos b + y sin b) - w t + phase).
    Regular {
        /// Amplitude [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        amplitude: f64,
        /// Period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Phase at the origin at t = 0 [deg]. Default 0.
        #[serde(default)]
        phase_deg: f64,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A JONSWAP sea: components of equal energy at random frequencies with random phases.
    Jonswap {
        /// Significant wave height [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        hs: f64,
        /// Peak period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        tp: f64,
        /// Peak enhancement [-], from 1 to 20. Default 3.3.
        #[serde(default = "jonswap_gamma")]
        #[schemars(range(min = 1.0, max = 20.0))]
        gamma: f64,
        /// Seed of the random frequencies and phases: the same seed, the same sea. Default 0.
        #[serde(default)]
        seed: u64,
        /// Number of components, 1 to 5000. Default 200.
        #[serde(default = "jonswap_components")]
        #[schemars(range(min = 1, max = 5000))]
        components: usize,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one peak period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A list of regular components.
    Components {
        /// The components, 1 to 5000.
        #[schemars(length(min = 1, max = 5000))]
        components: Vec<WaveComponent>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the longest period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
}

/// One component of a sea.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveComponent {
    /// Amplitude [m], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub amplitude: f64,
    /// Period [s], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub period: f64,
    /// Direction of travel from +x towards +y [deg]. Default 0.
    #[serde(default)]
    pub direction_deg: f64,
    /// Phase at the origin at t = 0 [deg]. Default 0.
    #[serde(default)]
    pub phase_deg: f64,
}

fn jonswap_gamma() -> f64 {
    3.3
}
fn jonswap_components() -> usize {
    200
}
