//! What an element is made of, per unstretched length.

use crate::scene::types::{Environment, LineType};

/// Bending stiffness of a bight as a share of w ℓ³: a bight is then about (EI/w)^⅓ = ℓ/7 wide, which an element can show.
const BIGHT: f64 = 3.0e-3;

/// What an element is made of, per unstretched length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Properties {
    /// EA [N].
    pub ea: f64,
    /// EI [N·m²].
    pub ei: f64,
    /// Kelvin–Voigt time constant [s].
    pub damping: f64,
    /// Mass [kg/m].
    pub mass: f64,
    /// Weight in air [N/m].
    pub weight_in_air: f64,
    /// Weight in water [N/m].
    pub weight: f64,
    /// Diameter [m].
    pub diameter: f64,
    /// ½ ρ d Cn [kg/m²].
    pub drag_normal: f64,
    /// ½ ρ π d Ct [kg/m²].
    pub drag_tangential: f64,
    /// ρ (π/4) d² Cmn [kg/m].
    pub added_normal: f64,
    /// ρ (π/4) d² Cmt [kg/m].
    pub added_tangential: f64,
    /// Stiffness of the bed under it [Pa]; none: the environment's.
    pub seabed_stiffness: Option<f64>,
    /// The line is slack and flexible: its bights are tighter than elements can show, and get a bending stiffness of their own (`bight_stiffness`).
    pub folds: bool,
}

impl Properties {
    /// Properties of a line type in an environment.
    pub fn of(line_type: &LineType, environment: &Environment) -> Properties {
        let (rho, g, d) = (environment.water_density, environment.gravity, line_type.diameter);
        let area = std::f64::consts::FRAC_PI_4 * d * d;
        let contents = line_type.inner_fluid.as_ref().map_or(0.0, |fluid| fluid.density * fluid.area);
        Properties {
            ea: line_type.ea,
            ei: line_type.ei,
            damping: line_type.damping,
            mass: line_type.mass + contents,
            weight_in_air: (line_type.mass + contents) * g,
            weight: line_type.weight_in_water(rho, g) + contents * g,
            diameter: d,
            drag_normal: 0.5 * rho * d * line_type.drag.normal,
            drag_tangential: 0.5 * rho * std::f64::consts::PI * d * line_type.drag.tangential,
            added_normal: rho * area * line_type.added_mass.normal,
            added_tangential: rho * area * line_type.added_mass.tangential,
            seabed_stiffness: line_type.seabed_stiffness,
            folds: false,
        }
    }

    /// Least tension [N]: a line without bending stiffness carries no compression.
    pub fn tension_floor(&self) -> f64 {
        if self.ei > 0.0 { f64::NEG_INFINITY } else { 0.0 }
    }

    /// Weight that the bed carries [N/m]: in water, or in air of what does not sink.
    pub fn sinking_weight(&self) -> f64 {
        if self.weight > 0.0 { self.weight } else { self.weight_in_air }
    }

    /// Weight in air [N/m] of a line that can go slack, else zero.
    pub fn slack_weight(&self) -> f64 {
        if self.ei > 0.0 { 0.0 } else { self.weight_in_air }
    }

    /// EI of an element of length ℓ in a bight that is tighter than it can show [N·m²]: 0.003 w ℓ³, w weight in water. A flexible line in a bight without it is bunched up in an element, whose slope then has no direction. It
    /// vanishes with the mesh, and carries no compression.
    pub fn bight_stiffness(&self, length: f64) -> f64 {
        BIGHT * self.weight.abs() * length.powi(3)
    }

    /// Whether the slope may jump between this and a neighbouring section.
    pub fn joins_with_a_kink(&self, other: &Properties) -> bool {
        self.ea != other.ea || self.damping != other.damping || (self.ei > 0.0) != (other.ei > 0.0)
    }
}
