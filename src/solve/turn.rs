//! How far a step turns a line: the measure of steps towards equilibrium.

use crate::rod::state::{COMPONENTS, Field};

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
