//! What lines hang on besides coordinates: bodies with a pose, and points; and how an end of a line says so.

use crate::algebra::rotation;
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A position, or what else has three components.
type Triple = [f64; 3];

/// A body that lines hang on: a vessel, a buoy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name, unique among lines, bodies and points.
    pub name: String,
    /// Position of its reference point at the start, or about which it moves [m]. Default [0, 0, 0].
    #[serde(default)]
    pub position: Triple,
    /// Roll, pitch and yaw there [deg]: the rotation Rz(yaw) Ry(pitch) Rx(roll) takes body axes to global ones. Default 0.
    #[serde(default)]
    pub attitude_deg: Triple,
    /// How it moves. Default: fixed.
    #[serde(default)]
    pub motion: BodyMotion,
    /// Mass [kg], ≥ 0, without that of its cylinders. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub mass: f64,
    /// Centre of that mass in body axes [m]. Default: the reference point.
    #[serde(default)]
    pub centre_of_mass: Triple,
    /// Inertia about the centre of mass in body axes [kg·m²]: [Ixx, Iyy, Izz] or a 3×3 matrix. Default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Inertia>,
    /// Circular cylinders that it is made of, as far as water is concerned. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("default" = []))]
    pub cylinders: Vec<Cylinder>,
    /// Displaced volume that is always wet [m³], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub volume: f64,
    /// Centre of that volume in body axes [m]. Default: the reference point.
    #[serde(default)]
    pub centre_of_buoyancy: Triple,
    /// Added mass about the reference point in body axes, 6×6 [kg, kg·m, kg·m²]. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_mass: Option<Matrix>,
    /// Linear damping about the reference point in body axes, 6×6 [N·s/m, N·s, N·m·s]. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Matrix>,
    /// Quadratic damping along and about the body's axes: force -d|v|v [N·s²/m², N·m·s²]. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quadratic_damping: Option<[f64; 6]>,
    /// Stiffness against displacement from the pose given, 6×6, along global axes and about the reference point [N/m, N, N·m]; for a
    /// ship whose hydrostatics are known. Weight and buoyancy at that pose are then taken to be in balance. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Matrix>,
    /// Constant force on the reference point [N]. Default 0.
    #[serde(default)]
    pub force: Triple,
    /// Constant moment [N·m]. Default 0.
    #[serde(default)]
    pub moment: Triple,
    /// Path of a CSV file, relative to the scene file, with columns t,fx,fy,fz,mx,my,mz in s, N and N·m: force on the reference point and
    /// moment along global axes, linear in time between its rows. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub load: Option<String>,
}

/// Six by six numbers, row by row.
pub type Matrix = [[f64; 6]; 6];

/// Inertia of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Inertia {
    /// Ixx, Iyy, Izz [kg·m²].
    Principal(Triple),
    /// The whole matrix [kg·m²].
    Full([Triple; 3]),
}

impl Inertia {
    /// The matrix [kg·m²].
    pub fn matrix(&self) -> Matrix3<f64> {
        match self {
            Inertia::Principal(diagonal) => Matrix3::from_diagonal(&Vector3::from(*diagonal)),
            Inertia::Full(rows) => Matrix3::from_fn(|row, column| rows[row][column]),
        }
    }
}

/// A circular cylinder of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Middle of one end in body axes [m].
    pub from: Triple,
    /// Middle of the other end in body axes [m].
    pub to: Triple,
    /// Diameter [m], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub diameter: f64,
    /// Mass, spread evenly [kg], ≥ 0; added to the body's with its inertia. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub mass: f64,
    /// Drag coefficients: across on diameter × length, along on the skin, and of each end on its area. Default 0.
    #[serde(default)]
    pub drag: EndCoefficients,
    /// Added-mass coefficients: across and along on the displaced mass, and of each end on that of a half sphere. Default 0.
    #[serde(default)]
    pub added_mass: EndCoefficients,
}

/// Coefficients of a cylinder.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndCoefficients {
    /// Across [-], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub normal: f64,
    /// Along [-], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub tangential: f64,
    /// Of an end [-], ≥ 0. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub end: f64,
}

/// How a body moves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum BodyMotion {
    /// It stays where the scene puts it; in an FMU, inputs move it.
    #[default]
    Fixed,
    /// Surge, sway, heave, roll, pitch and yaw about the pose given: sine·sin(wt) + cosine·cos(wt), w = 2 pi/period, eased in as `motion`.
    Sinusoidal {
        /// Period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Amplitudes of the sine part, three in m and three in deg. Default 0.
        #[serde(default)]
        sine: [f64; 6],
        /// Amplitudes of the cosine part, three in m and three in deg. Default 0.
        #[serde(default)]
        cosine: [f64; 6],
        /// Length of the ramp [s], ≥ 0; 0 = none. Default: 3.25 periods.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// Absolute poses from a CSV file with columns t,x,y,z,roll,pitch,yaw in s, m and deg; C2 interpolation.
    File {
        /// Path of the file, relative to the scene file.
        #[schemars(length(min = 1))]
        path: String,
    },
    /// It moves as the forces on it make it.
    Free,
}

/// A point that lines meet at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Name, unique among lines, bodies and points.
    pub name: String,
    /// Position at the start, or about which it moves [m]; of a free point, where its equilibrium is looked for first.
    pub position: Triple,
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
    /// Constant force on it [N]. Default 0.
    #[serde(default)]
    pub force: Triple,
    /// How it moves. Default: free.
    #[serde(default)]
    pub motion: PointMotion,
}

/// How a point moves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum PointMotion {
    /// It stays where the scene puts it.
    Fixed,
    /// As the scene's `motion` of this kind.
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
    /// Absolute positions from a CSV file with columns t,x,y,z[,vx,vy,vz].
    File {
        /// Path of the file, relative to the scene file.
        #[schemars(length(min = 1))]
        path: String,
    },
    /// It moves as the lines and its weight make it.
    #[default]
    Free,
}

/// What an end of a line hangs on.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Mount {
    /// A place of a body.
    Body {
        /// Name of the body.
        body: String,
        /// The place in the body's own axes [m].
        at: Triple,
        /// How the end is clamped there. Default: it is pinned.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        clamp: Option<Clamp>,
    },
    /// A point.
    Point {
        /// Name of the point.
        point: String,
    },
}

/// How an end is clamped.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Clamp {
    /// Direction in which the line leaves the body, in its own axes [-]; of any length.
    pub direction: Triple,
    /// Rotational stiffness [N·m/rad], > 0, or "clamped": it does not give way. Default: clamped.
    #[serde(default)]
    pub stiffness: Stiffness,
}

/// How stiff a clamp is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "another value, expected a number or \"clamped\"")]
pub enum Stiffness {
    /// So much [N·m/rad].
    Of(f64),
    /// It does not give way.
    Rigid(Rigid),
}

/// The word for a clamp that does not give way.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rigid {
    /// It does not give way.
    Clamped,
}

impl Default for Stiffness {
    fn default() -> Stiffness {
        Stiffness::Rigid(Rigid::Clamped)
    }
}

/// An end of a line as it is written: coordinates, or what it hangs on.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum End {
    /// Coordinates [m].
    At(Triple),
    /// On a body or point.
    On(Mount),
}

/// The keys of an end that is an object.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MountKeys {
    body: Option<String>,
    at: Option<Triple>,
    point: Option<String>,
    direction: Option<Triple>,
    stiffness: Option<Stiffness>,
}

impl<'de> Deserialize<'de> for End {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<End, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = End;

            fn expecting(&self, to: &mut fmt::Formatter) -> fmt::Result {
                write!(to, "[x, y, z], {{\"body\": NAME, \"at\": [x, y, z]}} or {{\"point\": NAME}}")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, entries: A) -> Result<End, A::Error> {
                Triple::deserialize(de::value::SeqAccessDeserializer::new(entries)).map(End::At)
            }

            fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<End, A::Error> {
                let keys = MountKeys::deserialize(de::value::MapAccessDeserializer::new(entries))?;
                match keys {
                    MountKeys { body: Some(body), at, point: None, direction, stiffness } => {
                        let at = at.ok_or_else(|| de::Error::missing_field("at"))?;
                        let clamp = match (direction, stiffness) {
                            (None, Some(_)) => return Err(de::Error::missing_field("direction")),
                            (direction, stiffness) => {
                                direction.map(|direction| Clamp { direction, stiffness: stiffness.unwrap_or_default() })
                            }
                        };
                        Ok(End::On(Mount::Body { body, at, clamp }))
                    }
                    MountKeys { body: None, direction: Some(_), .. } => Err(de::Error::unknown_field("direction", &["point"])),
                    MountKeys { body: None, stiffness: Some(_), .. } => Err(de::Error::unknown_field("stiffness", &["point"])),
                    MountKeys { body: None, at: None, point: Some(point), .. } => Ok(End::On(Mount::Point { point })),
                    MountKeys { point: Some(_), body: Some(_), .. } => Err(de::Error::unknown_field("point", &["body", "at"])),
                    MountKeys { point: Some(_), at: Some(_), .. } => Err(de::Error::unknown_field("at", &["point"])),
                    _ => Err(de::Error::missing_field("body")),
                }
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl Serialize for End {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            End::At(at) => at.serialize(serializer),
            End::On(mount) => mount.serialize(serializer),
        }
    }
}

impl JsonSchema for End {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "End".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let (at, on) = (generator.subschema_for::<Triple>(), generator.subschema_for::<Mount>());
        schemars::json_schema!({ "anyOf": [at, on] })
    }
}

impl Mount {
    /// How it is clamped there.
    pub fn clamp(&self) -> Option<&Clamp> {
        match self {
            Mount::Body { clamp, .. } => clamp.as_ref(),
            Mount::Point { .. } => None,
        }
    }

    /// Name of what it is on.
    pub fn name(&self) -> &str {
        match self {
            Mount::Body { body, .. } => body,
            Mount::Point { point } => point,
        }
    }
}

impl Body {
    /// A body that is nothing but a pose, at the origin.
    pub fn plain(name: &str) -> Body {
        Body {
            name: name.to_string(),
            position: [0.0; 3],
            attitude_deg: [0.0; 3],
            motion: BodyMotion::Fixed,
            mass: 0.0,
            centre_of_mass: [0.0; 3],
            inertia: None,
            cylinders: Vec::new(),
            volume: 0.0,
            centre_of_buoyancy: [0.0; 3],
            added_mass: None,
            damping: None,
            quadratic_damping: None,
            stiffness: None,
            force: [0.0; 3],
            moment: [0.0; 3],
            load: None,
        }
    }

    /// Roll, pitch and yaw of the pose given [rad].
    pub fn attitude(&self) -> Vector3<f64> {
        Vector3::from(self.attitude_deg).map(f64::to_radians)
    }

    /// Where a place of the body, in its own axes, is at the pose given [m].
    pub fn place(&self, at: &Triple) -> Vector3<f64> {
        Vector3::from(self.position) + rotation::of_angles(&self.attitude()) * Vector3::from(*at)
    }

    /// Whether the forces on it move it.
    pub fn is_free(&self) -> bool {
        self.motion == BodyMotion::Free
    }
}

impl Point {
    /// Whether the forces on it move it.
    pub fn is_free(&self) -> bool {
        self.motion == PointMotion::Free
    }
}
