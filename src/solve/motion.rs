//! Paths of a fairlead: position, velocity and acceleration at any time.

use crate::scene::types::Triple;
use nalgebra::Vector3;
use std::sync::Arc;

/// Position [m], velocity [m/s] and acceleration [m/s²] of a fairlead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
}

/// The motion of a fairlead in time.
#[derive(Debug, Clone)]
pub enum Path {
    /// At rest at a point.
    Fixed(Vector3<f64>),
    /// `origin` + (sine·sin wt + cosine·cos wt)·S(t/ramp), S = xi²(3 - 2 xi) up to the end of the ramp, then 1.
    Sinusoidal {
        /// Mean position [m].
        origin: Vector3<f64>,
        /// Angular frequency [rad/s].
        omega: f64,
        /// Amplitude of the sine [m].
        sine: Vector3<f64>,
        /// Amplitude of the cosine [m].
        cosine: Vector3<f64>,
        /// Length of the ramp [s]; 0 = none.
        ramp: f64,
    },
    /// Piecewise cubic Hermite through a table, at rest outside it.
    Table(Arc<Table>),
    /// Polynomial in tau = t - start, one coefficient vector per power.
    Polynomial {
        /// Time of tau = 0 [s].
        start: f64,
        /// Coefficients of tau⁰, tau¹, …
        coefficients: Vec<Vector3<f64>>,
    },
}

/// Times, positions and velocities of a measured or computed motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Times [s], rising.
    pub times: Vec<f64>,
    /// Positions [m].
    pub positions: Vec<Triple>,
    /// Velocities [m/s].
    pub velocities: Vec<Triple>,
}
