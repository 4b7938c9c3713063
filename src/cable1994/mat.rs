//! The spring mat of the report (eqs. 2.24 and 2.25), on the part of an element that touches it.
//!
//! ```text
//! q = k (D - (z - z_b)) where positive,   k = S/D,   D = S/k
//! c_i += L ∫ a_i q dx,   ∂c_i/∂z_k = -k L ∫ a_i a_k dx,   over the part with z < z_b + D
//! ```
//!
//! z_b level of the bed [m], D height above it where contact begins [m], S weight in water per length [N/m], k stiffness [Pa]. A
//! line at rest lies exactly at z_b. The height along an element is a cubic, so the touching part is found exactly (the report
//! looked at three points and searched between them); four Gauss points are exact for the products, which are of degree 6.

use crate::algebra::shape::{GAUSS4, Shape};
use crate::rod::seabed::{Plane, Resistance};
use nalgebra::Vector3;

/// What the mat does to the ends of an element.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Push {
    /// Upward force on U_i [N].
    pub force: [f64; 4],
    /// Its loss per metre of z_k [N/m].
    pub stiffness: [[f64; 4]; 4],
}

/// The push on an element of length `length` with ends `u` = (r_0, L r_0', r_1, L r_1').
pub fn push(plane: &Plane, mat: &Resistance, length: f64, u: &[Vector3<f64>; 4]) -> Push {
    let mut push = Push::default();
    let profile = plane.profile(&u[0], &u[1], &u[2], &u[3]);
    if profile.above(mat.onset) {
        return push;
    }
    for part in mat.touching(&profile).iter() {
        for point in GAUSS4 {
            let x = part.from + (part.to - part.from) * point.x;
            let a = Shape::at(x).value;
            let k = mat.stiffness * point.weight * (part.to - part.from) * length;
            let penetration = mat.onset - profile.at(x);
            for i in 0..4 {
                push.force[i] += k * a[i] * penetration;
                (0..4).for_each(|j| push.stiffness[i][j] += k * a[i] * a[j]);
            }
        }
    }
    push
}
