//! The part `solver` of a scene: scheme, tolerance, step limits and the law of extension.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scheme, tolerance and step limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Time integration scheme. Default `adams-moulton`.
    #[serde(default)]
    pub scheme: Scheme,
    /// Relative accuracy aimed for in the end tension, between 1e-8 and 0.1. Default 1e-3.
    #[serde(default = "default_tolerance")]
    #[schemars(range(min = 1e-8, max = 0.1))]
    pub tolerance: f64,
    /// Tension [N] below which errors count as if it were the tension, ≥ 0: for lines that go slack. Default: a tenth of the line's weight in
    /// water or of the largest static tension on the way of its fairlead, the larger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub tension_scale: Option<f64>,
    /// Longest time step [s], > 0. Default 0.5.
    #[serde(default = "default_max_step")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_step: f64,
    /// Time step without step control [s], > 0. Default: none, the step is controlled; 0.1 with the scheme `cable-1994`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub fixed_step: Option<f64>,
    /// Law of extension. Default `exact`; with the scheme `cable-1994` it is `report`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretch: Option<Stretch>,
    /// Strain from the hydrostatic pressure on the wall, as in the 1994 report. Default false.
    #[serde(default)]
    pub hydrostatic_strain: bool,
}

/// Time integration schemes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Converged trapezoidal Adams–Moulton steps with error control; L-stable steps where the line snaps.
    #[default]
    AdamsMoulton,
    /// L-stable diagonally implicit Runge–Kutta of order 3 with error control.
    Esdirk3,
    /// Generalised alpha with spectral radius 0.6.
    GeneralizedAlpha,
    /// The 1994 report's own one-solve step, for reproduction.
    #[serde(rename = "cable-1994")]
    Cable1994,
}

/// Laws of extension.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stretch {
    /// T = EA(|r'| - 1), Hooke in engineering strain.
    #[default]
    Exact,
    /// r'·r' = 1 + 2 T/EA with the force T r', the 1994 report's law.
    Report,
}

/// Time step of the 1994 report's example [s].
const REPORT_STEP: f64 = 0.1;

fn default_tolerance() -> f64 {
    1.0e-3
}
fn default_max_step() -> f64 {
    0.5
}

impl Default for Solver {
    fn default() -> Self {
        Solver {
            scheme: Scheme::default(),
            tolerance: default_tolerance(),
            max_step: default_max_step(),
            fixed_step: None,
            stretch: None,
            hydrostatic_strain: false,
            tension_scale: None,
        }
    }
}

impl Solver {
    /// The law of extension.
    pub fn law(&self) -> Stretch {
        self.stretch.unwrap_or(if self.scheme == Scheme::Cable1994 { Stretch::Report } else { Stretch::Exact })
    }

    /// Time step without step control [s]; none: the step is controlled.
    pub fn uncontrolled_step(&self) -> Option<f64> {
        self.fixed_step.or((self.scheme == Scheme::Cable1994).then_some(REPORT_STEP))
    }
}
