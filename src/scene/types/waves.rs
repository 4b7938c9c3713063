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
        /// Frequency above which the energy is left out [Hz], above the peak's. Default, and the most that is used: 5/tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one peak period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A full-grown sea of Pierson and Moskowitz (1964), by its height and peak: components as of `jonswap`.
    PiersonMoskowitz {
        /// Significant wave height [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        hs: f64,
        /// Peak period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        tp: f64,
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
        /// Frequency above which the energy is left out [Hz], above the peak's. Default, and the most that is used: 5/tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one peak period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A sea of two peaks, swell and wind sea (Ochi & Hubble 1976), in one direction: components as of `jonswap`.
    OchiHubble {
        /// The two parts, in any order.
        parts: [OchiHubblePart; 2],
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
        /// Frequency above which the energy is left out [Hz], above both peaks'. Default, and the most that is used: 5/(the shorter tp).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the longer tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A spectrum given as a table, linear between its rows and nothing outside: components as of `jonswap`.
    Table {
        /// Rows of frequency [Hz], rising, and spectral density [m²/Hz], ≥ 0; at least 2. Their integral is hs²/16.
        #[schemars(length(min = 2))]
        spectrum: Vec<[f64; 2]>,
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
        /// Frequency above which the energy is left out [Hz], above the peak's. Default: that of the last row.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the period of the row with the largest density.
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

/// One of the two parts of an Ochi–Hubble sea.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OchiHubblePart {
    /// Significant wave height of the part [m], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub hs: f64,
    /// Peak period of the part [s], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tp: f64,
    /// How narrow the peak is [-], from 1 (a full-grown sea) to 20.
    #[schemars(range(min = 1.0, max = 20.0))]
    pub lambda: f64,
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

impl Waves {
    /// Significant height [m] and the peak period [s] of a sea that is given by its spectrum: of two parts the height of both together and
    /// the period of the higher one. None of waves given one by one.
    pub fn significant(&self) -> Option<(f64, f64)> {
        match self {
            Waves::Jonswap { hs, tp, .. } | Waves::PiersonMoskowitz { hs, tp, .. } => Some((*hs, *tp)),
            Waves::OchiHubble { parts: [one, other], .. } => {
                Some((one.hs.hypot(other.hs), if one.hs >= other.hs { one.tp } else { other.tp }))
            }
            Waves::Table { spectrum, .. } => {
                let peak = spectrum.iter().max_by(|one, other| one[1].total_cmp(&other[1]))?;
                Some((4.0 * variance(spectrum).sqrt(), peak[0].recip()))
            }
            Waves::Regular { .. } | Waves::Components { .. } => None,
        }
    }
}

/// Variance of the elevation [m²] of a sea whose spectrum is a table of frequency [Hz] and density [m²/Hz], linear between its rows.
pub fn variance(spectrum: &[[f64; 2]]) -> f64 {
    spectrum.windows(2).map(|rows| 0.5 * (rows[0][1] + rows[1][1]) * (rows[1][0] - rows[0][0])).sum()
}

fn jonswap_gamma() -> f64 {
    3.3
}
fn jonswap_components() -> usize {
    200
}
