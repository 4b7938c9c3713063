//! The part `line_types` of a scene: what chains, ropes and pipes are like, per length.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Curve of tension ranges against cycles to failure (a T–N curve), by which `run` sums the damage; needs `breaking_load`.
    /// Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fatigue: Option<Fatigue>,
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

/// A T–N curve: N = k·R^-m cycles to failure, R being the range of the tension (twice the amplitude) over the breaking load. API RP 2SK
/// gives m = 3, k = 1000 for common studlink chain and k = 316 for studless chain, for example. Of a stress curve N = a·S^-m,
/// k = a·(area / breaking load)^m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fatigue {
    /// Exponent [-], from 1 to 20.
    #[schemars(range(min = 1.0, max = 20.0))]
    pub m: f64,
    /// Cycles to failure at a range as large as the breaking load [-], from 1e-3 to 1e7.
    #[schemars(range(min = 1.0e-3, max = 1.0e7))]
    pub k: f64,
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
