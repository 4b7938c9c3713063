//! The scene as the user writes it: plain data with units, defaults and the texts of the JSON Schema.
//!
//! Axes: right-handed, z up, still water at z = 0, seabed at z = -depth. SI units; angles in degrees only where a
//! name ends in `_deg`. Arc length runs unstretched from the fairlead (0) to the anchor (L).
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::scene::bodies::{Body, End, Mount, Point};
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;

/// A position, velocity or offset (x, y, z).
pub type Triple = [f64; 3];

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
    /// Waves. The equilibrium at the start is that of calm water. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub waves: Option<Waves>,
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

/// Properties of a kind of chain, rope or pipe, per unstretched length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineType {
    /// Axial stiffness EA [N], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub ea: f64,
    /// Mass per length in air, contents excluded [kg/m], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mass: f64,
    /// Diameter on which drag and added mass act [m], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub diameter: f64,
    /// Weight in water [N/m]; may be zero or negative. Give this or `buoyancy` or neither (then the buoyancy of `diameter`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub submerged_weight: Option<f64>,
    /// Buoyancy in water [N/m], ≥ 0. Give this or `submerged_weight` or neither.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub buoyancy: Option<f64>,
    /// Bending stiffness EI [N·m²], ≥ 0. Default 0. A line without bending stiffness carries no compression.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub ei: f64,
    /// Morison drag coefficients. Default: normal 0, tangential 0.
    #[serde(default)]
    pub drag: NormalTangential,
    /// Added-mass coefficients on (pi/4)·diameter². Default: normal 0, tangential 0.
    #[serde(default)]
    pub added_mass: NormalTangential,
    /// Kelvin–Voigt time constant of axial damping [s], ≥ 0: T = EA(e + damping·de/dt). Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping: f64,
    /// Points [strain, tension in N], rising from [0, 0], between which the tension is linear; they replace `ea`, which then acts in
    /// `damping` alone. Beyond the last the tension goes on rising as before it. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_strain: Option<Vec<[f64; 2]>>,
    /// Breaking load [N], > 0: a warning is given where the tension exceeds it. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub breaking_load: Option<f64>,
    /// Fluid inside a pipe. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner_fluid: Option<InnerFluid>,
    /// Area on which the pressure of the water acts where `solver.hydrostatic_strain` is on [m²], ≥ 0.
    /// Default: the displaced volume per length, buoyancy / (density · gravity).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub outer_area: Option<f64>,
    /// Normal stiffness of the seabed under this type [Pa], > 0. Default: `environment.seabed.stiffness`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub seabed_stiffness: Option<f64>,
}

/// A coefficient across and along the line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NormalTangential {
    /// Across the line [-], ≥ 0. Drag: on `diameter`. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub normal: f64,
    /// Along the line [-], ≥ 0. Drag: on pi·`diameter`. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub tangential: f64,
}

/// Fluid inside a pipe: its mass and weight are added to those of the pipe, its pressure is at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InnerFluid {
    /// Density [kg/m³], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub density: f64,
    /// Inner area [m²], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub area: f64,
    /// Pressure at the height of the fairlead [Pa]. Default 0.
    #[serde(default)]
    pub pressure: f64,
}

/// One mooring line from fairlead to anchor. Both ends are pinned, unless a constraint says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "LineKeys", into = "LineKeys")]
pub struct Line {
    /// Name, unique in the scene.
    pub name: String,
    /// Position of the fairlead at the start [m].
    pub fairlead: Triple,
    /// What the fairlead hangs on; none: on nothing but its coordinates.
    pub fairlead_on: Option<Mount>,
    /// Position of the anchor at the start [m].
    pub anchor: Triple,
    /// What the anchor hangs on; none: on nothing but its coordinates.
    pub anchor_on: Option<Mount>,
    /// Sections from fairlead to anchor, at least one.
    pub sections: Vec<Section>,
    /// Clump weights and buoys.
    pub attachments: Vec<Attachment>,
    /// Springs, dampers, locked directions, dead forces and masses at points of the line.
    pub constraints: Vec<Constraint>,
}

/// One mooring line from fairlead to anchor. Both ends are pinned, unless a constraint says otherwise.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Line")]
struct LineKeys {
    /// Name, unique among lines, bodies and points. Default: `line1`, `line2`, … by position.
    #[serde(default)]
    name: String,
    /// Position of the fairlead at the start [m], or what it hangs on.
    fairlead: End,
    /// Position of the anchor [m], or what it hangs on.
    anchor: End,
    /// Sections from fairlead to anchor, at least one.
    #[schemars(length(min = 1))]
    sections: Vec<Section>,
    /// Clump weights and buoys. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    attachments: Vec<Attachment>,
    /// Springs, dampers, locked directions, dead forces and masses at points of the line. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    constraints: Vec<Constraint>,
}

impl From<LineKeys> for Line {
    fn from(keys: LineKeys) -> Line {
        let LineKeys { name, fairlead, anchor, sections, attachments, constraints } = keys;
        let parted = |end| match end {
            End::At(at) => (at, None),
            End::On(mount) => ([0.0; 3], Some(mount)),
        };
        let ((fairlead, fairlead_on), (anchor, anchor_on)) = (parted(fairlead), parted(anchor));
        Line { name, fairlead, fairlead_on, anchor, anchor_on, sections, attachments, constraints }
    }
}

impl From<Line> for LineKeys {
    fn from(line: Line) -> LineKeys {
        let Line { name, fairlead, fairlead_on, anchor, anchor_on, sections, attachments, constraints } = line;
        let joined = |at: Triple, on: Option<Mount>| on.map_or(End::At(at), End::On);
        let (fairlead, anchor) = (joined(fairlead, fairlead_on), joined(anchor, anchor_on));
        LineKeys { name, fairlead, anchor, sections, attachments, constraints }
    }
}

impl JsonSchema for Line {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        LineKeys::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        LineKeys::json_schema(generator)
    }
}

/// A stretch of one line type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Name of a line type.
    #[serde(rename = "type")]
    pub line_type: String,
    /// Unstretched length [m], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub length: f64,
    /// Number of equal elements, ≥ 1. Default: chosen by the program to meet the tolerance. A section that an attachment or constraint
    /// divides shares them out among its parts, at least one each.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 20000))]
    pub elements: Option<usize>,
}

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

/// Motion of the fairleads.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Motion {
    /// The fairleads stay where the scene puts them.
    #[default]
    Fixed,
    /// Offset sine·sin(wt) + cosine·cos(wt), w = 2 pi/period, times xi²(3 - 2 xi), xi = t/ramp, until `ramp` seconds.
    Sinusoidal {
        /// Period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Amplitudes of the sine part [m]. Default 0.
        #[serde(default)]
        sine: Triple,
        /// Amplitudes of the cosine part [m]. Default 0.
        #[serde(default)]
        cosine: Triple,
        /// Length of the ramp [s], ≥ 0; 0 = none. Default: 3.25 periods.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// Absolute positions from a CSV file with columns t,x,y,z[,vx,vy,vz]; C1 interpolation.
    File {
        /// Path of the file, relative to the scene file.
        #[schemars(length(min = 1))]
        path: String,
    },
}

/// The keys of every kind of motion as one flat object. Read as a tagged enum, an error would not know the key it is about.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionKeys {
    kind: MotionKind,
    period: Option<f64>,
    sine: Option<Triple>,
    cosine: Option<Triple>,
    ramp: Option<f64>,
    path: Option<String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MotionKind {
    Fixed,
    Sinusoidal,
    File,
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let MotionKeys { kind, period, sine, cosine, ramp, path } = MotionKeys::deserialize(deserializer)?;
        let known: &'static [&'static str] = match kind {
            MotionKind::Fixed => &["kind"],
            MotionKind::Sinusoidal => &["kind", "period", "sine", "cosine", "ramp"],
            MotionKind::File => &["kind", "path"],
        };
        let given = [
            ("period", period.is_some()),
            ("sine", sine.is_some()),
            ("cosine", cosine.is_some()),
            ("ramp", ramp.is_some()),
            ("path", path.is_some()),
        ];
        if let Some((key, _)) = given.iter().find(|(key, given)| *given && !known.contains(key)) {
            return Err(D::Error::unknown_field(key, known));
        }
        Ok(match kind {
            MotionKind::Fixed => Motion::Fixed,
            MotionKind::Sinusoidal => Motion::Sinusoidal {
                period: period.ok_or_else(|| D::Error::missing_field("period"))?,
                sine: sine.unwrap_or_default(),
                cosine: cosine.unwrap_or_default(),
                ramp,
            },
            MotionKind::File => Motion::File { path: path.ok_or_else(|| D::Error::missing_field("path"))? },
        })
    }
}

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
}

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

fn standard_gravity() -> f64 {
    9.80665
}
fn sea_water_density() -> f64 {
    1025.0
}
fn global_axes() -> [Triple; 2] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
}
fn jonswap_gamma() -> f64 {
    3.3
}
fn jonswap_components() -> usize {
    200
}
fn default_duration() -> f64 {
    120.0
}
fn default_output_step() -> f64 {
    0.1
}
fn default_tolerance() -> f64 {
    1.0e-3
}
fn default_max_step() -> f64 {
    0.5
}

impl Default for Run {
    fn default() -> Self {
        Run { duration: default_duration(), start: 0.0, output_step: default_output_step() }
    }
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

impl Run {
    /// Time at which the run ends [s].
    pub fn end(&self) -> f64 {
        self.start + self.duration
    }
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

impl LineType {
    /// Buoyancy per length [N/m] in water of density `rho` [kg/m³]: as given, or from the submerged weight, or of `diameter`.
    pub fn buoyancy_per_length(&self, rho: f64, gravity: f64) -> f64 {
        match (self.buoyancy, self.submerged_weight) {
            (Some(buoyancy), _) => buoyancy,
            (None, Some(weight)) => self.mass * gravity - weight,
            (None, None) => rho * gravity * std::f64::consts::FRAC_PI_4 * self.diameter * self.diameter,
        }
    }

    /// Weight in water per length [N/m], negative where the line floats.
    pub fn weight_in_water(&self, rho: f64, gravity: f64) -> f64 {
        match self.submerged_weight {
            Some(weight) => weight,
            None => self.mass * gravity - self.buoyancy_per_length(rho, gravity),
        }
    }
}

impl Constraint {
    /// Whether it holds an end as a pin does: all locked, where the end is, without a motion of its own.
    pub fn is_pin(&self) -> bool {
        self.locked == [true; 3] && self.motion.is_none() && self.reference.is_none()
    }
}

/// Points of a line nearer to each other than this share of its length are one.
pub const SAME_PLACE: f64 = 1.0e-9;

impl Line {
    /// Where the scene puts the end at arc length `s` from the fairlead; none if that is no end.
    pub fn end_at(&self, s: f64) -> Option<Triple> {
        let (length, near) = (self.length(), SAME_PLACE * self.length());
        if s <= near {
            Some(self.fairlead)
        } else if s >= length - near {
            Some(self.anchor)
        } else {
            None
        }
    }

    /// Whether nothing but a pin holds the end at arc length `s`, where there is one.
    pub fn is_pinned(&self, s: f64) -> bool {
        let near = SAME_PLACE * self.length();
        !self.constraints.iter().any(|constraint| (constraint.s - s).abs() <= near && !constraint.is_pin())
    }

    /// Unstretched length [m].
    pub fn length(&self) -> f64 {
        self.sections.iter().map(|section| section.length).sum()
    }
}
