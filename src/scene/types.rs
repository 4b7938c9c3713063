//! The scene as the user writes it: plain data with units, defaults and the texts of the JSON Schema.
//!
//! Axes: right-handed, z up, still water at z = 0, seabed at z = -depth. SI units; angles in degrees only where a
//! name ends in `_deg`. Arc length runs unstretched from the fairlead (0) to the anchor (L).
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

mod environment;
mod line;
mod line_type;
mod motion;
mod point;
mod run;
mod solver;
mod vector;
mod waves;

use crate::scene::bodies::{Body, Point};
pub use environment::{CurrentOverTime, CurrentPoint, Environment, Seabed, Surface};
pub use line::{Line, SAME_PLACE, Section};
pub use line_type::{Fatigue, InnerFluid, LineType, NormalTangential};
pub use motion::Motion;
pub use point::{Attachment, Constraint, ReferenceMotion};
pub use run::Run;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
pub use solver::{Scheme, Solver, Stretch};
use std::collections::BTreeMap;
pub use vector::Triple;
pub use waves::{OchiHubblePart, Seas, Spreading, Stretching, WaveComponent, Waves, variance};

/// A moorline scene: environment, line types, lines, fairlead motion and run settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Free text, shown in the report.
    #[serde(default)]
    pub title: String,
    /// Water, seabed and gravity.
    pub environment: Environment,
    /// Line types by name; sections refer to them.
    #[schemars(extend("minProperties" = 1))]
    pub line_types: BTreeMap<String, LineType>,
    /// The mooring lines.
    #[schemars(length(min = 1))]
    pub lines: Vec<Line>,
    /// Bodies that lines hang on: vessels, buoys. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    pub bodies: Vec<Body>,
    /// Points that lines meet at. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    pub points: Vec<Point>,
    /// Motion of the fairleads. Default: fixed.
    #[serde(default)]
    pub motion: Motion,
    /// Duration and output interval.
    #[serde(default)]
    pub run: Run,
    /// Scheme, tolerance and step limits.
    #[serde(default)]
    pub solver: Solver,
}
