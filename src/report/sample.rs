//! Samples for the tests of this layer: outputs and nodes without a solver.

use crate::solve::simulation::{NodeOutput, Outputs};
use nalgebra::Vector3;

/// Outputs of a line that pulls along x with a tension [N] at a time [s]; nothing else about it matters.
pub fn outputs(time: f64, tension: f64) -> Outputs {
    Outputs {
        time,
        fairlead: Vector3::zeros(),
        force: Vector3::x() * tension,
        tension,
        anchor: Vector3::zeros(),
        anchor_force: Vector3::zeros(),
        anchor_tension: 0.0,
        moment: Vector3::zeros(),
        anchor_moment: Vector3::zeros(),
        tension_max: tension,
        declination: 0.0,
        azimuth: 0.0,
        grounded_length: 0.0,
        work: 0.0,
    }
}

/// A node at an arc length [m] of a line along x, with its tension [N].
pub fn node(s: f64, tension: f64) -> NodeOutput {
    NodeOutput { s, position: Vector3::x() * s, tangent: Vector3::x(), tension, wall_tension: None }
}
