//! A clamped end: its direction is that of a place of a body, as far as a rotational spring holds it there.
//!
//! ```text
//! E = ½ k |t - d|²,   d = ± R a
//! ```
//!
//! t unit tangent at the end [-], d the direction of the clamp, R rotation of the body, a the direction in which the line leaves the end in
//! body axes [-], k rotational stiffness [N·m/rad]. The spring is that of a joint (`joint`) whose other side is the body; a clamp that does not
//! give way is as much stiffer than the element beside it.

use crate::rod::joint;
use crate::rod::motion::{Motion, Weights};
use crate::rod::pose::PosePath;
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// The clamp.
#[derive(Debug, Clone)]
pub struct Clamp {
    /// Node of the end.
    pub node: usize,
    /// k [N·m/rad].
    pub stiffness: f64,
    /// Direction of the slope, from the anchor to the fairlead, in body axes [-].
    pub direction: Vector3<f64>,
    /// The motion of the body.
    pub body: Arc<PosePath>,
}

impl Clamp {
    fn direction_at(&self, time: f64) -> Vector3<f64> {
        self.body.rotation(time) * self.direction
    }

    /// R on the slope of the end [N·m].
    pub fn moment(&self, at: &Motion) -> Vector3<f64> {
        joint::moment(self.stiffness, &at.u.slope(self.node), &self.direction_at(at.clock.now))
    }

    /// c_u ∂R/∂u.
    pub fn tangent(&self, at: &Motion, weights: &Weights) -> Matrix3<f64> {
        joint::tangent(self.stiffness, &at.u.slope(self.node), &self.direction_at(at.clock.now)).0 * weights.u
    }
}
