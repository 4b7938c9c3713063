//! The part `environment` of a scene: water, seabed and gravity.

use crate::scene::types::vector::Triple;
use crate::scene::types::waves::Seas;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Water, seabed and gravity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Acceleration of gravity [m/s²], > 0. Default 9.80665.
    #[serde(default = "standard_gravity")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub gravity: f64,
    /// Density of the water [kg/m³], ≥ 0. Default 1025.
    #[serde(default = "sea_water_density")]
    #[schemars(range(min = 0.0))]
    pub water_density: f64,
    /// Depth of the water at x = y = 0 [m], > 0: the seabed lies at z = -depth.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub depth: f64,
    /// The seabed's resistance. Default: see each field.
    #[serde(default)]
    pub seabed: Seabed,
    /// Current profile: velocity at rising or falling z, piecewise linear, held constant outside the table. Default: none.
    #[serde(default)]
    pub current: Vec<CurrentPoint>,
    /// A current that changes in time, in place of `current`. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub current_over_time: Option<CurrentOverTime>,
    /// Waves: a sea, or a list of seas that meet. The equilibrium at the start is that of calm water. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<Seas>,
    /// What the water surface does to a line. Default `pierced`.
    #[serde(default)]
    pub surface: Surface,
}

/// The seabed as a bed of springs on which a line lies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Seabed {
    /// Normal stiffness [N/m per metre of line per metre of penetration, Pa], > 0. Default: for each line type its
    /// submerged weight per length / diameter (of a type that does not sink: its weight in air / diameter).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness: Option<f64>,
    /// Normal damping [Pa·s], ≥ 0; it pushes only. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping: f64,
    /// Coulomb friction coefficient [-], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Rise of the bed along +x and +y [deg], each within ±45: z = -depth + x tan(a) + y tan(b). Default [0, 0].
    #[serde(default)]
    #[schemars(inner(range(min = -45.0, max = 45.0)))]
    pub slope_deg: [f64; 2],
}

/// One row of the current profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurrentPoint {
    /// Height of the row [m], up from still water.
    pub z: f64,
    /// Velocity of the water there [m/s].
    pub velocity: Triple,
}

/// A current that changes in time: a profile at each of several times. In time and in z it is linear between its rows and held constant outside
/// them, each component by itself, so that it may turn with depth. Either `path` or `rows`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurrentOverTime {
    /// CSV file with rows `t,z,u,v,w` in s, m and m/s: time, height, velocity along x, y and z; relative to the scene's file. Rows of one time stand
    /// together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// The same rows in the scene itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<[f64; 5]>>,
}

/// What the water surface does to a line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Surface {
    /// Above the water a line has its weight in air and no buoyancy, drag, added mass or wave load.
    #[default]
    Pierced,
    /// Water everywhere, as in the 1994 report.
    None,
}

fn standard_gravity() -> f64 {
    9.80665
}
fn sea_water_density() -> f64 {
    1025.0
}

impl Environment {
    /// Height of the bed at (x, y) [m]: -depth + x tan(a) + y tan(b).
    pub fn bed_height(&self, x: f64, y: f64) -> f64 {
        let [a, b] = self.seabed.slope_deg.map(|slope| slope.to_radians().tan());
        -self.depth + x * a + y * b
    }

    /// Whether a point lies below the bed; one exactly on it, up to rounding, does not, and NaN does.
    pub fn is_below_bed(&self, at: Triple) -> bool {
        let [a, b] = self.seabed.slope_deg.map(|slope| slope.to_radians().tan());
        let size = self.depth.abs() + at[2].abs() + (at[0] * a).abs() + (at[1] * b).abs();
        !(at[2] >= self.bed_height(at[0], at[1]) - 1.0e-9 * size)
    }
}
