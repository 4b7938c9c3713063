//! Where a line is bunched up, it bows out sideways, to its own length: a start for the equilibrium of a line with bending stiffness.
//!
//! ```text
//! r′ = cos θ e + sin θ n,   θ = θ_0 cos(π ξ),   J_0(θ_0) = |d|/ℓ
//! ```
//!
//! ξ goes from 0 to 1 along the bunched part, ℓ [m] is its length and d = |d| e the way from its start to its end; n is across. The mean of
//! r′ is J_0(θ_0) e, so that the bow ends where the bunched part did (Bessel's integral), whatever its depth: nearly the elastica of a
//! strut under its load.

use crate::algebra::shape::SHAPES3;
use crate::rod::ends::Ends;
use crate::rod::mesh::Mesh;
use crate::rod::state::Field;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Mean |r′| of an element below which it is bunched.
const BUNCHED: f64 = 1.0 - 1.0e-4;
/// Fewest elements of a bow.
const LEAST: usize = 4;
/// First zero of J_0: the bow whose ends meet.
const CLOSED: f64 = 2.404825557695773;
/// Pieces per element in which the bow is summed up.
const PIECES: usize = 16;

/// Bows out what is bunched of a line; false where nothing is.
pub fn out(mesh: &Mesh, u: &mut Field) -> bool {
    let count = mesh.elements.len();
    let mut bunched: Vec<bool> = (0..count).map(|e| !mesh.elements[e].is_joint() && mean_stretch(mesh, u, e) < BUNCHED).collect();
    for e in 1..count.saturating_sub(1) {
        // A joint goes with its neighbours.
        bunched[e] |= mesh.elements[e].is_joint() && bunched[e - 1] && bunched[e + 1];
    }
    let mut any = false;
    let mut e = 0;
    while e < count {
        let first = e;
        while e < count && bunched[e] {
            e += 1;
        }
        if e == first {
            e += 1;
            continue;
        }
        any = true;
        let (mut from, mut to) = (first, e);
        while to - from < LEAST && (from > 0 || to < count) {
            from = from.saturating_sub(1);
            to = (to + 1).min(count);
        }
        bow(mesh, u, from, to);
        e = e.max(to);
    }
    any
}

/// Mean |r′| of an element.
fn mean_stretch(mesh: &Mesh, u: &Field, e: usize) -> f64 {
    let length = mesh.elements[e].length;
    let ends = Ends::gather(u, e, length);
    SHAPES3.iter().map(|shape| Vector3::from(ends.combine(&shape.slope)).norm() / length).sum::<f64>() / SHAPES3.len() as f64
}

/// Lays the elements from `from` up to `to` along a bow between their ends.
fn bow(mesh: &Mesh, u: &mut Field, from: usize, to: usize) {
    let (start, end) = (u.position(from), u.position(to));
    let (s0, s1) = (mesh.node_arc_length(from), mesh.node_arc_length(to));
    let (way, length) = (end - start, s1 - s0);
    let along = way.try_normalize(1e-9 * length).unwrap_or_else(|| u.slope(from).try_normalize(0.0).unwrap_or(Vector3::z()));
    let sideways = Vector3::z().cross(&along).try_normalize(1e-6).unwrap_or_else(|| {
        let chord = u.position(mesh.nodes() - 1) - u.position(0);
        Vector3::new(chord.x, chord.y, 0.0).try_normalize(1e-6 * mesh.length).unwrap_or(Vector3::x())
    });
    let across = (sideways - along * along.dot(&sideways)).normalize();
    let deepest = deepest(way.norm() / length);
    let slope = |s: f64| {
        let (sin, cos) = (deepest * (PI * (s - s0) / length).cos()).sin_cos();
        along * cos + across * sin
    };
    let mut place = start;
    for node in from..to {
        u.set_position(node, &place);
        u.set_slope(node, &slope(mesh.node_arc_length(node)));
        let (s, width) = (mesh.node_arc_length(node), mesh.elements[node].length / PIECES as f64);
        place += (0..PIECES).map(|k| slope(s + (k as f64 + 0.5) * width) * width).sum::<Vector3<f64>>();
    }
    u.set_slope(to, &slope(s1));
}

/// θ_0 with J_0(θ_0) = `share`, from 0 to the bow that closes.
fn deepest(share: f64) -> f64 {
    let bessel = |x: f64| (0..64).map(|k| (x * (PI * (k as f64 + 0.5) / 64.0).cos()).cos()).sum::<f64>() / 64.0;
    let (mut low, mut high) = (0.0, CLOSED);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if bessel(middle) > share { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J_0(1) = 0.7651976865579666, J_0(2) = 0.2238907791412357 (Abramowitz & Stegun, table 9.1).
    #[test]
    fn the_depth_of_a_bow_is_where_the_bessel_function_is_its_share() {
        for (share, depth) in [(0.7651976865579666, 1.0), (0.2238907791412357, 2.0), (0.0, CLOSED)] {
            assert!((deepest(share) - depth).abs() < 1e-12, "{share}");
        }
    }
}
