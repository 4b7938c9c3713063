//! What a line is like between its nodes: at any arc length, by the shapes of its elements.
//!
//! ```text
//! r(x) = N(x) · (r_i, p_i, r_j, p_j)   and so its rates;   κ = |r' × r''| / |r'|³
//! ```
//!
//! The force from the fairlead side on the anchor side changes along an element by the load on it, which is taken to be spread evenly.

use crate::algebra::shape::Shape;
use crate::rod::line::Line;
use crate::rod::state::{Field, State};
use nalgebra::Vector3;

/// A place of a line at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Unstretched arc length from the fairlead [m].
    pub s: f64,
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
    /// Unit tangent from fairlead to anchor [-].
    pub tangent: Vector3<f64>,
    /// Force that the fairlead side exerts on the anchor side [N]; its size is the effective tension where the line does not bend.
    pub force: Vector3<f64>,
    /// Curvature [1/m].
    pub curvature: f64,
}

/// The place at an arc length from the fairlead [m], with given forces at the nodes [N]. What lies beyond an end is that end. Where sections
/// meet, the one nearer to the anchor counts.
pub fn at(line: &dyn Line, state: &State, forces: &[Vector3<f64>], s: f64) -> Place {
    let mesh = line.mesh();
    let from_anchor = (mesh.length - s).clamp(0.0, mesh.length);
    let whole = |e: &usize| !mesh.elements[*e].is_joint();
    let holds = |e: &usize| from_anchor <= mesh.elements[*e].start + mesh.elements[*e].length;
    let e = (0..mesh.elements.len()).filter(whole).find(holds);
    let e = e.or_else(|| (0..mesh.elements.len()).rev().find(whole)).unwrap_or(0);
    let element = &mesh.elements[e];
    let x = ((from_anchor - element.start) / element.length.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let shape = Shape::at(x).scaled(element.length.max(f64::MIN_POSITIVE));
    let sum = |field: &Field, weights: &[f64; 4]| {
        field.position(e) * weights[0]
            + field.slope(e) * weights[1]
            + field.position(e + 1) * weights[2]
            + field.slope(e + 1) * weights[3]
    };
    let (slope, bend) = (sum(&state.u, &shape.slope), sum(&state.u, &shape.curvature));
    let stretch = slope.norm();
    Place {
        s,
        position: sum(&state.u, &shape.value),
        velocity: sum(&state.v, &shape.value),
        acceleration: sum(&state.a, &shape.value),
        tangent: if stretch > 0.0 { -slope / stretch } else { Vector3::zeros() },
        force: forces[e] * (1.0 - x) + forces[e + 1] * x,
        curvature: if stretch > 0.0 { slope.cross(&bend).norm() / stretch.powi(3) } else { 0.0 },
    }
}
