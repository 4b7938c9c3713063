//! What sits on a point of a line: the parts `attachments` and `constraints` of a line.

use crate::scene::types::vector::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A clump weight or buoy on the line: a small body at one point of it. It rests on the seabed where it reaches it. At a pinned end it hangs on
/// what holds the end: force and tension there contain it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Arc length from the fairlead [m], from 0 to the line's length.
    #[schemars(range(min = 0.0))]
    pub s: f64,
    /// Mass [kg], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub mass: f64,
    /// Displaced volume [m³], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub volume: f64,
    /// Drag coefficient times area [m²], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub drag_area: f64,
    /// Added mass [kg], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub added_mass: f64,
}

/// What holds or loads one point of the line. At an end (s = 0 or s = the line's length) it releases the pin: the end is then
/// held by what the constraint says and by nothing else, and the scene's `motion` does not move it. (Locked along all axes without
/// `reference` and `motion` it is the pin again.)
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constraint {
    /// Arc length from the fairlead [m], from 0 to the line's length.
    #[schemars(range(min = 0.0))]
    pub s: f64,
    /// Directions of the first and second axis; the second is made perpendicular to the first, the third is their cross product.
    /// Default: x and y, so that the axes are the global ones.
    #[serde(default = "global_axes")]
    pub axes: [Triple; 2],
    /// Position at which springs and locks hold the point [m]. Default: at an end where the scene puts that end, elsewhere where
    /// the point is in equilibrium without springs and locks of this constraint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Triple>,
    /// Stiffness along the axes [N/m], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(inner(range(min = 0.0)))]
    pub stiffness: Triple,
    /// Damping along the axes against motion relative to the reference [N·s/m], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(inner(range(min = 0.0)))]
    pub damping: Triple,
    /// Axes along which the point does not move relative to the reference. Default: none.
    #[serde(default)]
    pub locked: [bool; 3],
    /// Dead force along the global axes [N]. Default 0.
    #[serde(default)]
    pub force: Triple,
    /// Mass [kg], ≥ 0, with its weight. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub mass: f64,
    /// Added mass [kg], ≥ 0, the same in all directions. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub added_mass: f64,
    /// Motion of the reference. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<ReferenceMotion>,
}

/// Motion of a constraint's reference: offset sine·sin(wt) + cosine·cos(wt) along the constraint's axes, w = 2 pi/period, times
/// xi²(3 - 2 xi), xi = t/ramp, until `ramp` seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceMotion {
    /// Period [s], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub period: f64,
    /// Amplitudes of the sine part [m]. Default 0.
    #[serde(default)]
    pub sine: Triple,
    /// Amplitudes of the cosine part [m]. Default 0.
    #[serde(default)]
    pub cosine: Triple,
    /// Length of the ramp [s], ≥ 0; 0 = none. Default: 3.25 periods.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub ramp: Option<f64>,
}

fn global_axes() -> [Triple; 2] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
}

impl Constraint {
    /// Whether it holds an end as a pin does: all locked, where the end is, without a motion of its own.
    pub fn is_pin(&self) -> bool {
        self.locked == [true; 3] && self.motion.is_none() && self.reference.is_none()
    }
}
