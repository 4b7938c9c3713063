//! A sinusoidal motion that is eased in.
//!
//! ```text
//! x(t) = (sine·sin wt + cosine·cos wt) S(t/ramp),   S(xi) = xi²(3 - 2 xi) up to 1, then 1
//! ```

use nalgebra::Vector3;

/// The motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sinusoid {
    /// Angular frequency [rad/s].
    pub omega: f64,
    /// Amplitude of the sine.
    pub sine: Vector3<f64>,
    /// Amplitude of the cosine.
    pub cosine: Vector3<f64>,
    /// Length of the ramp [s]; 0 = none.
    pub ramp: f64,
}

impl Sinusoid {
    /// The motion of a period [s] with amplitudes; without a ramp [s] it is eased in over 3.25 periods.
    pub fn new(period: f64, sine: [f64; 3], cosine: [f64; 3], ramp: Option<f64>) -> Sinusoid {
        let omega = 2.0 * std::f64::consts::PI / period;
        Sinusoid { omega, sine: sine.into(), cosine: cosine.into(), ramp: ramp.unwrap_or(3.25 * period) }
    }

    /// Value, rate and second rate at a time [s].
    pub fn at(&self, time: f64) -> [Vector3<f64>; 3] {
        self.at_phase(&self.phase(time))
    }

    /// Whether nothing moves.
    pub fn is_still(&self) -> bool {
        self.sine == Vector3::zeros() && self.cosine == Vector3::zeros()
    }

    /// What all motions of this period and ramp share at a time [s].
    pub fn phase(&self, time: f64) -> Phase {
        Phase { sin_cos: (self.omega * time).sin_cos(), ramp: ramp_at(time, self.ramp) }
    }

    /// Value, rate and second rate.
    pub fn at_phase(&self, phase: &Phase) -> [Vector3<f64>; 3] {
        let Phase { sin_cos: (sin, cos), ramp: [s, s1, s2] } = *phase;
        let x = self.sine * sin + self.cosine * cos;
        let v = (self.sine * cos - self.cosine * sin) * self.omega;
        let a = -x * (self.omega * self.omega);
        [x * s, v * s + x * s1, a * s + v * (2.0 * s1) + x * s2]
    }
}

/// What sinusoidal motions of one period and ramp share at a time.
#[derive(Debug, Clone, Copy)]
pub struct Phase {
    sin_cos: (f64, f64),
    ramp: [f64; 3],
}

/// The ramp S and its first and second derivative; 1 without a ramp and after it.
fn ramp_at(time: f64, ramp: f64) -> [f64; 3] {
    if !(ramp > 0.0) || time >= ramp {
        return [1.0, 0.0, 0.0];
    }
    let xi = (time / ramp).max(0.0);
    [xi * xi * (3.0 - 2.0 * xi), 6.0 * xi * (1.0 - xi) / ramp, (6.0 - 12.0 * xi) / (ramp * ramp)]
}
