//! A clamped end: its direction is that of a place of a body, as far as a rotational spring holds it there.
//!
//! ```text
//! E = ½ k |t - d|²,   d = ± R a
//! ```
//!
//! t unit tangent at the end [-], d the direction of the clamp, R rotation of the body, a the direction in which the line leaves the end in
//! body axes [-], k rotational stiffness [N·m/rad]. The spring is that of a joint (`joint`) whose other side is the body; a clamp that does not
//! give way is as much stiffer than the element beside it. A free body that turns by δφ feels
//!
//! ```text
//! m = d × ∂E/∂d = -k d × t,   δm = -k [t][d] δφ,   δd = δφ × d
//! ```

use crate::algebra::rotation;
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
    /// What it is fast to.
    pub body: Holder,
}

/// The body that a clamp is fast to.
#[derive(Debug, Clone)]
pub enum Holder {
    /// One with a given motion.
    Driven(Arc<PosePath>),
    /// A free one.
    Free {
        /// Its node, whose slope is its rotation vector.
        node: usize,
        /// The number of its frame in the state.
        frame: usize,
    },
}

impl Clamp {
    /// d [-].
    pub fn direction_at(&self, at: &Motion) -> Vector3<f64> {
        match &self.body {
            Holder::Driven(path) => path.rotation(at.clock.now) * self.direction,
            Holder::Free { node, frame } => {
                let frame = at.frames.get(*frame).copied().unwrap_or_else(Matrix3::identity);
                rotation::exp(&at.u.slope(*node)) * frame * self.direction
            }
        }
    }

    /// R on the slope of the end [N·m].
    pub fn moment(&self, at: &Motion) -> Vector3<f64> {
        joint::moment(self.stiffness, &at.u.slope(self.node), &self.direction_at(at))
    }

    /// c_u ∂R/∂u.
    pub fn tangent(&self, at: &Motion, weights: &Weights) -> Matrix3<f64> {
        joint::tangent(self.stiffness, &at.u.slope(self.node), &self.direction_at(at)).0 * weights.u
    }

    /// ∂²E/∂r'∂d: change of the moment on the slope with the direction [N·m].
    pub fn crossed(&self, at: &Motion) -> Matrix3<f64> {
        joint::tangent(self.stiffness, &at.u.slope(self.node), &self.direction_at(at)).1
    }

    /// m on the body [N·m], and its change with a turn of the body.
    pub fn on_body(&self, at: &Motion) -> (Vector3<f64>, Matrix3<f64>) {
        let (t, d) = (at.u.slope(self.node).normalize(), self.direction_at(at));
        (-d.cross(&t) * self.stiffness, -rotation::cross(&t) * rotation::cross(&d) * self.stiffness)
    }
}
