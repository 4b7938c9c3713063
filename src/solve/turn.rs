//! How far a step turns a line: the measure of steps towards equilibrium.

use crate::rod::state::{COMPONENTS, Field};
use nalgebra::Vector3;

/// Largest turn of one step towards equilibrium [-].
pub const LONGEST_STEP: f64 = 0.4;

/// Largest turn of a step [-], moves counted by half the length of the line [m]; NaN where there is one.
pub fn largest(step: &Field, length: f64) -> f64 {
    let mut largest: f64 = 0.0;
    for c in 0..COMPONENTS {
        let scale = if c < 3 { 2.0 / length } else { 1.0 };
        for x in step.component(c) {
            let size = (x * scale).abs();
            if !(size <= largest) {
                largest = size;
            }
        }
    }
    largest
}

/// Distance from the plane, as a share of the length, within which a line lies in it.
const FLAT: f64 = 1.0e-10;

/// The normal of the vertical plane through the ends of a line (through x, where one is above the other), if the line lies in it.
pub fn across(u: &Field, length: f64) -> Option<Vector3<f64>> {
    let start = u.position(0);
    let chord = u.position(u.nodes() - 1) - start;
    let normal = Vector3::new(-chord.y, chord.x, 0.0).try_normalize(FLAT * length).unwrap_or(Vector3::y());
    let lies = |node| (u.position(node) - start).dot(&normal).abs() <= FLAT * length && u.slope(node).dot(&normal).abs() <= FLAT;
    (0..u.nodes()).all(lies).then_some(normal)
}
