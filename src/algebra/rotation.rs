//! Rotations: roll, pitch and yaw, rotation vectors, and the angular rates that go with both.
//!
//! ```text
//! R = Rz(ψ) Ry(θ) Rx(φ),   ω = E q̇,   α = E q̈ + Ė q̇,   q = (φ, θ, ψ) roll, pitch, yaw
//! R = exp(ϑ) R₀,           ω = J ϑ̇,   α = J ϑ̈ + J̇ ϑ̇,   J = 1 + a [ϑ] + b [ϑ]²,   a = (1 - cos t)/t²,  b = (t - sin t)/t³,  t = |ϑ|
//! ```
//!
//! R takes body axes to global ones; ω [rad/s] and α [rad/s²] in global axes; [ϑ] x = ϑ × x.

use nalgebra::{Matrix3, Vector3};

/// Sines and cosines of roll, pitch and yaw: what R, E and Ė are made of.
#[derive(Debug, Clone, Copy)]
pub struct Attitude {
    roll: (f64, f64),
    pitch: (f64, f64),
    yaw: (f64, f64),
}

impl Attitude {
    /// Of roll, pitch and yaw [rad].
    pub fn of(angles: &Vector3<f64>) -> Attitude {
        // Most bodies that are driven through a test do not turn.
        let of = |angle: f64| if angle == 0.0 { (angle, 1.0) } else { angle.sin_cos() };
        Attitude { roll: of(angles.x), pitch: of(angles.y), yaw: of(angles.z) }
    }

    /// R.
    pub fn rotation(&self) -> Matrix3<f64> {
        let Attitude { roll: (sr, cr), pitch: (sp, cp), yaw: (sy, cy) } = *self;
        Matrix3::new(
            cy * cp,
            cy * sp * sr - sy * cr,
            cy * sp * cr + sy * sr,
            sy * cp,
            sy * sp * sr + cy * cr,
            sy * sp * cr - cy * sr,
            -sp,
            cp * sr,
            cp * cr,
        )
    }

    /// E: the rates of roll, pitch and yaw to ω.
    pub fn rates_to_omega(&self) -> Matrix3<f64> {
        let Attitude { pitch: (sp, cp), yaw: (sy, cy), .. } = *self;
        Matrix3::new(cy * cp, -sy, 0.0, sy * cp, cy, 0.0, -sp, 0.0, 1.0)
    }

    /// Ė q̇: what α has beside E q̈ [rad/s²].
    pub fn turning(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let Attitude { pitch: (sp, cp), yaw: (sy, cy), .. } = *self;
        let by_yaw = Vector3::new(-sy * cp, cy * cp, 0.0) * rates.x + Vector3::new(-cy, -sy, 0.0) * rates.y;
        let by_pitch = Vector3::new(-cy * sp, -sy * sp, -cp) * rates.x;
        by_yaw * rates.z + by_pitch * rates.y
    }
}

/// R of roll, pitch and yaw [rad].
pub fn of_angles(angles: &Vector3<f64>) -> Matrix3<f64> {
    Attitude::of(angles).rotation()
}

/// Roll, pitch and yaw [rad] of R; pitch within ±π/2. At a pitch of ±π/2 only the sum of roll and yaw means anything.
pub fn angles(r: &Matrix3<f64>) -> Vector3<f64> {
    let cosine = r[(2, 1)].hypot(r[(2, 2)]);
    Vector3::new(r[(2, 1)].atan2(r[(2, 2)]), (-r[(2, 0)]).atan2(cosine), r[(1, 0)].atan2(r[(0, 0)]))
}

/// R = Rx(α) Ry(β) Rz(γ) of angles [rad] about x, y and z, each about the axis that the ones before have turned: MoorDyn's.
pub fn of_angles_xyz(angles: &Vector3<f64>) -> Matrix3<f64> {
    // The transpose turns back, in the other order and by the other signs.
    of_angles(&-angles).transpose()
}

/// The angles of `of_angles_xyz` [rad]; that about y within ±π/2.
pub fn angles_xyz(r: &Matrix3<f64>) -> Vector3<f64> {
    -angles(&r.transpose())
}

/// E: the rates of roll, pitch and yaw to ω.
pub fn rates_to_omega(angles: &Vector3<f64>) -> Matrix3<f64> {
    Attitude::of(angles).rates_to_omega()
}

/// Rates of roll, pitch and yaw of ω (E⁻¹ ω) [rad/s]; not finite at a pitch of ±π/2.
pub fn omega_to_rates(angles: &Vector3<f64>, omega: &Vector3<f64>) -> Vector3<f64> {
    let ((sp, cp), (sy, cy)) = (angles.y.sin_cos(), angles.z.sin_cos());
    let roll = (cy * omega.x + sy * omega.y) / cp;
    Vector3::new(roll, cy * omega.y - sy * omega.x, omega.z + roll * sp)
}

/// [x]: the matrix of x ×.
pub fn cross(x: &Vector3<f64>) -> Matrix3<f64> {
    x.cross_matrix()
}

/// exp(ϑ).
pub fn exp(theta: &Vector3<f64>) -> Matrix3<f64> {
    let t = theta.norm();
    let (first, second) =
        if t < 1.0e-4 { (1.0 - t * t / 6.0, 0.5 - t * t / 24.0) } else { (t.sin() / t, (1.0 - t.cos()) / (t * t)) };
    let k = cross(theta);
    Matrix3::identity() + k * first + k * k * second
}

/// a, b, a′/t and b′/t.
fn series(t: f64) -> [f64; 4] {
    let s = t * t;
    if t < 0.05 {
        return [
            0.5 - s / 24.0 + s * s / 720.0,
            1.0 / 6.0 - s / 120.0 + s * s / 5040.0,
            -1.0 / 12.0 + s / 180.0 - s * s / 6720.0,
            -1.0 / 60.0 + s / 1260.0 - s * s / 60480.0,
        ];
    }
    let (sin, cos) = t.sin_cos();
    let (a, b) = ((1.0 - cos) / s, (t - sin) / (s * t));
    [a, b, (sin / t - 2.0 * a) / s, ((1.0 - cos) / s - 3.0 * b) / s]
}

/// J: the rate of the rotation vector to ω.
pub fn jacobian(theta: &Vector3<f64>) -> Matrix3<f64> {
    let [a, b, ..] = series(theta.norm());
    let k = cross(theta);
    Matrix3::identity() + k * a + k * k * b
}

/// J̇ ϑ̇: what α has beside J ϑ̈ [rad/s²].
pub fn bending(theta: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
    let [_, b, da, db] = series(theta.norm());
    let along = theta.dot(rate);
    let once = theta.cross(rate);
    once * (da * along) + theta.cross(&once) * (db * along) + rate.cross(&once) * b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Vector3<f64>, b: &Vector3<f64>, allowed: f64) {
        assert!((a - b).norm() < allowed, "{a:?} {b:?}");
    }

    /// ω of a rotation that changes in time, by central difference: [ω] = Ṙ Rᵀ.
    fn omega(r: impl Fn(f64) -> Matrix3<f64>, t: f64) -> Vector3<f64> {
        let d = 1.0e-5;
        let w = (r(t + d) - r(t - d)) / (2.0 * d) * r(t).transpose();
        Vector3::new(w[(2, 1)], w[(0, 2)], w[(1, 0)])
    }

    /// Rates and accelerations of angles are the differences of the rotation (step 1e-5, so 1e-9; 1e-4 for the second, so 1e-6).
    #[test]
    fn rates_are_those_of_the_rotation() {
        let q = |t: f64| Vector3::new(0.3 + 0.5 * t, -0.4 + 0.2 * t * t, 1.0 - 0.7 * t);
        let (rate, second) = (|t: f64| Vector3::new(0.5, 0.4 * t, -0.7), Vector3::new(0.0, 0.4, 0.0));
        let w = |t: f64| rates_to_omega(&q(t)) * rate(t);
        for t in [0.0, 0.6] {
            close(&w(t), &omega(|t| of_angles(&q(t)), t), 1e-8);
            let alpha = (w(t + 1e-4) - w(t - 1e-4)) / 2e-4;
            close(&(rates_to_omega(&q(t)) * second + Attitude::of(&q(t)).turning(&rate(t))), &alpha, 1e-6);
            close(&omega_to_rates(&q(t), &w(t)), &rate(t), 1e-12);
            close(&angles(&of_angles(&q(t))), &q(t), 1e-12);
        }
    }

    /// Turns about x, y and z one after the other, each about axes that have been turned, as a product of rotation vectors.
    #[test]
    fn angles_about_turned_axes_come_in_their_order() {
        let q = Vector3::new(0.4, -0.7, 2.1);
        let about = |axis: usize| exp(&(Vector3::ith(axis, 1.0) * q[axis]));
        assert!((of_angles_xyz(&q) - about(0) * about(1) * about(2)).norm() < 1e-14);
        close(&angles_xyz(&of_angles_xyz(&q)), &q, 1e-14);
    }

    /// The same for rotation vectors, also where series take over.
    #[test]
    fn a_rotation_vector_has_its_rates() {
        for size in [1.0e-3, 0.04, 0.06, 1.5] {
            let theta = |t: f64| (Vector3::new(0.6, -0.5, 0.3) + Vector3::new(0.2, 0.9, -0.4) * t) * size;
            let rate = Vector3::new(0.2, 0.9, -0.4) * size;
            let w = |t: f64| jacobian(&theta(t)) * rate;
            close(&w(0.2), &omega(|t| exp(&theta(t)), 0.2), 1e-8 * size.max(1e-2));
            let alpha = (w(0.2 + 1e-3) - w(0.2 - 1e-3)) / 2e-3;
            close(&bending(&theta(0.2), &rate), &alpha, 1e-6 * size);
        }
    }
}
