//! A joint between two sections that both have bending stiffness: the slopes may differ in size, not in direction.
//!
//! ```text
//! E = ½ κ |t_i - t_j|²,   κ = 10⁴ (EI_i/l_i + EI_j/l_j)
//! ```
//!
//! t_i, t_j unit tangents on the two sides [-], l lengths of the elements beside the joint [m], κ rotational stiffness [N·m]. The
//! joint bends as much as a ten-thousandth of the elements beside it.

use crate::algebra::triple::length;
use crate::rod::mesh::Mesh;
use crate::rod::properties::Properties;
use nalgebra::{Matrix3, Vector3};

/// κ over the EI/l of what is beside it.
pub const STIFFER: f64 = 1.0e4;

/// κ of each element [N·m]: zero where it is no joint or a side has no bending stiffness.
pub fn stiffnesses(mesh: &Mesh) -> Vec<f64> {
    let count = mesh.elements.len();
    (0..count)
        .map(|e| {
            let beside =
                |other: Option<usize>| other.filter(|i| *i < count).map(|i| (mesh.properties_of(i), mesh.elements[i].length));
            match (mesh.elements[e].is_joint() && !mesh.gaps.contains(&e), beside(e.checked_sub(1)), beside(Some(e + 1))) {
                (true, Some((a, l_a)), Some((b, l_b))) if stiff(a) && stiff(b) => STIFFER * (a.ei / l_a + b.ei / l_b),
                _ => 0.0,
            }
        })
        .collect()
}

fn stiff(properties: &Properties) -> bool {
    properties.ei > 0.0
}

/// ∂E/∂p of a side with slope p, given the tangent of the other side [N·m].
pub fn moment(kappa: f64, p: &Vector3<f64>, other: &Vector3<f64>) -> Vector3<f64> {
    let (size, other) = (length(p), other / length(other));
    let t = p / size;
    -(other - t * t.dot(&other)) * (kappa / size)
}

/// ∂²E/∂p² of a side, and ∂²E/∂p∂p_other.
pub fn tangent(kappa: f64, p: &Vector3<f64>, other: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let (size, other_size) = (length(p), length(other));
    let (t, s) = (p / size, other / other_size);
    let across = |t: &Vector3<f64>| Matrix3::identity() - t * t.transpose();
    let turned = across(&t) * s;
    let own = (t * turned.transpose() + turned * t.transpose() + across(&t) * t.dot(&s)) * (kappa / (size * size));
    (own, -(across(&t) * across(&s)) * (kappa / (size * other_size)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences with a step of 1e-6: error about 1e-9 of the stiffness.
    #[test]
    fn tangents_are_the_differences_of_the_moment() {
        let (p, q, d) = (Vector3::new(1.1, 0.2, -0.1), Vector3::new(0.9, 0.1, 0.2), 1e-6);
        let (own, cross) = tangent(5.0, &p, &q);
        for c in 0..3 {
            let step = Vector3::ith(c, d);
            let by_p = (moment(5.0, &(p + step), &q) - moment(5.0, &(p - step), &q)) / (2.0 * d);
            let by_q = (moment(5.0, &p, &(q + step)) - moment(5.0, &p, &(q - step))) / (2.0 * d);
            assert!((by_p - own.column(c)).norm() < 1e-8 && (by_q - cross.column(c)).norm() < 1e-8);
        }
    }
}
