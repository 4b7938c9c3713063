//! Force and moment of the lines on a body, about its reference point.
//!
//! ```text
//! F = Σ f_i,   M = Σ (r_i - X) × f_i + m_i      over all ends that hang on it
//! ```
//!
//! m_i the moments of ends that are clamped.

use crate::algebra::rotation;
use crate::rod::pose::BodyMotion;
use crate::scene::bodies::Mount;
use crate::scene::types::Scene;
use crate::solve::outputs::Outputs;
use nalgebra::Vector3;

/// Where a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Its reference point [m].
    pub position: Vector3<f64>,
    /// Roll, pitch and yaw [rad].
    pub angles: Vector3<f64>,
}

impl Pose {
    /// The pose of a motion.
    pub fn of(motion: &BodyMotion) -> Pose {
        Pose { position: motion.reference.position, angles: rotation::angles(&motion.rotation) }
    }
}

/// A body at one instant, and what the lines do to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOutputs {
    /// Where it is.
    pub pose: Pose,
    /// Force of the lines [N].
    pub force: Vector3<f64>,
    /// Moment of the lines about its reference point [N·m].
    pub moment: Vector3<f64>,
}

/// Ends of lines that hang on a body, as (line, whether it is its anchor).
pub fn hanging(scene: &Scene, body: usize) -> Vec<(usize, bool)> {
    let name = scene.bodies.get(body).map(|body| body.name.as_str());
    let on = |mount: &Option<Mount>| matches!(mount, Some(Mount::Body { body, .. }) if Some(body.as_str()) == name);
    let ends = scene
        .lines
        .iter()
        .enumerate()
        .flat_map(|(index, line)| [(index, false, &line.fairlead_on), (index, true, &line.anchor_on)]);
    ends.filter(|(.., mount)| on(mount)).map(|(index, anchor, _)| (index, anchor)).collect()
}

/// Force and moment about a place of ends of lines with these outputs.
pub fn on(reference: &Vector3<f64>, ends: &[(usize, bool)], outputs: &[Outputs]) -> (Vector3<f64>, Vector3<f64>) {
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for (line, anchor) in ends {
        let Some(outputs) = outputs.get(*line) else { continue };
        let (place, pull, own) = outputs.of_end(*anchor);
        force += pull;
        moment += (place - reference).cross(&pull) + own;
    }
    (force, moment)
}
