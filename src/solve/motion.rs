//! Paths of a fairlead: position, velocity and acceleration at any time.

use crate::algebra::shape::Shape;
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

impl Path {
    /// Kinematics at a time.
    pub fn at(&self, time: f64) -> Kinematics {
        match self {
            Path::Fixed(position) => Kinematics::at_rest(*position),
            Path::Sinusoidal { origin, omega, sine, cosine, ramp } => {
                let (sin, cos) = (omega * time).sin_cos();
                let x = sine * sin + cosine * cos;
                let v = (sine * cos - cosine * sin) * *omega;
                let a = -x * (omega * omega);
                let (s, s1, s2) = ramp_at(time, *ramp);
                Kinematics {
                    position: origin + x * s,
                    velocity: v * s + x * s1,
                    acceleration: a * s + v * (2.0 * s1) + x * s2,
                }
            }
            Path::Table(table) => table.at(time),
            Path::Polynomial { start, coefficients } => {
                let tau = time - start;
                let mut k = Kinematics::at_rest(Vector3::zeros());
                for coefficient in coefficients.iter().rev() {
                    k.acceleration = k.acceleration * tau + k.velocity * 2.0;
                    k.velocity = k.velocity * tau + k.position;
                    k.position = k.position * tau + coefficient;
                }
                k
            }
        }
    }
}

impl Kinematics {
    /// At rest at a point.
    pub fn at_rest(position: Vector3<f64>) -> Kinematics {
        Kinematics { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
    }
}

/// The ramp S = xi²(3 - 2 xi), xi = t/ramp, and its first and second derivative; 1 without a ramp and after it.
fn ramp_at(time: f64, ramp: f64) -> (f64, f64, f64) {
    if !(ramp > 0.0) || time >= ramp {
        return (1.0, 0.0, 0.0);
    }
    let xi = (time / ramp).max(0.0);
    (xi * xi * (3.0 - 2.0 * xi), 6.0 * xi * (1.0 - xi) / ramp, (6.0 - 12.0 * xi) / (ramp * ramp))
}

impl Table {
    /// Cubic Hermite interpolation; before the first and after the last row the fairlead rests there.
    fn at(&self, time: f64) -> Kinematics {
        let after = self.times.partition_point(|t| *t <= time);
        let position = |row: usize| Vector3::from(self.positions[row]);
        if after == 0 || after == self.times.len() {
            return Kinematics::at_rest(position(after.min(self.times.len() - 1)));
        }
        let row = after - 1;
        let h = self.times[after] - self.times[row];
        let x = (time - self.times[row]) / h;
        let shape = Shape::at(x).scaled(h);
        let ends = [position(row), self.velocities[row].into(), position(after), self.velocities[after].into()];
        let sum = |n: &[f64; 4]| (0..4).map(|k| ends[k] * n[k]).sum();
        Kinematics { position: sum(&shape.value), velocity: sum(&shape.slope), acceleration: sum(&shape.curvature) }
    }
}
