//! One component of a sea, and the wave number that goes with its frequency.

/// One component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// a [m].
    pub amplitude: f64,
    /// ω [rad/s].
    pub omega: f64,
    /// b, from +x towards +y [rad].
    pub direction: f64,
    /// φ [rad].
    pub phase: f64,
}

/// Wave number k > 0 [1/m] with ω² = g k tanh kd, by Newton's method on y tanh y = ω²d/g from Eckart's (1952) start, for ω [rad/s],
/// g [m/s²], d [m].
pub fn wave_number(omega: f64, gravity: f64, depth: f64) -> f64 {
    let deep = omega * omega * depth / gravity;
    let mut y = deep / deep.tanh().sqrt();
    for _ in 0..20 {
        let tanh = y.tanh();
        let change = (y * tanh - deep) / (tanh + y * (1.0 - tanh * tanh));
        y -= change;
        if change.abs() <= 1e-15 * y {
            break;
        }
    }
    y / depth
}
