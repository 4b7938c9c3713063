//! The water surface: how much of the line's section is wet.
//!
//! ```text
//! φ(z) = min(1, max(0, ½ - z/d))
//! ```
//!
//! z height of the centreline above the water [m], d diameter [m], φ wet fraction [-]. Buoyancy, drag and added mass are φ times
//! those under water; a floating line so finds its draught. In waves z is the height above the wave's surface: on an element, the cubic
//! through its values at x = 0, ⅓, ⅔, 1, which is good to a (k l)⁴/2000 for a wave of amplitude a and number k that travels along an
//! element of length l. On elements that are not certainly all wet, the water's force is
//! integrated over the parts below +d/2, cut at -d/2, which are found exactly. (Taking a dry share off the force on the whole
//! element would be shorter, but its error can have the sign of a negative drag.)

use crate::algebra::polynomial::{Cubic, Interval};
use crate::algebra::shape::Shape;
use crate::rod::ends::Ends;
use crate::rod::morison::Water;
use crate::sea::clock::Clock;
use nalgebra::Vector3;

/// Most parts of an element that differ in how wet they are.
pub const MOST_PARTS: usize = 12;

/// Where on an element, by its length, its height above waves is taken.
pub const TAKEN_AT: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];

/// Height of an element above the surface of the waves [m].
pub fn above_waves<W: Water>(u: &Ends<f64>, water: &W, clock: &Clock) -> Cubic {
    above(u, TAKEN_AT.map(|x| water.elevation(clock, &Vector3::from(u.combine(&Shape::at(x).value)))))
}

/// Height of an element above a surface whose elevation at `TAKEN_AT` is known [m].
pub fn above(u: &Ends<f64>, elevations: [f64; 4]) -> Cubic {
    let height = |k: usize| u.combine(&Shape::at(TAKEN_AT[k]).value).z - elevations[k];
    Cubic::through([0, 1, 2, 3].map(height))
}

/// Parts of an element, in order, with room for the most there can be.
pub struct Parts {
    parts: [Interval; MOST_PARTS],
    count: usize,
}

impl Parts {
    fn push(&mut self, from: f64, to: f64) {
        if to > from && self.count < MOST_PARTS {
            self.parts[self.count] = Interval { from, to };
            self.count += 1;
        }
    }

    /// The parts.
    pub fn as_slice(&self) -> &[Interval] {
        &self.parts[..self.count]
    }
}

/// The parts of an element that are wet or awash, cut at z = -d/2, given its height above the water.
pub fn wet_parts(height: &Cubic, diameter: f64) -> Parts {
    let half = 0.5 * diameter;
    let depth = Cubic(height.0.map(|z| -z));
    let mut parts = Parts { parts: [Interval { from: 0.0, to: 0.0 }; MOST_PARTS], count: 0 };
    // The usual element at the fairlead goes through the surface once, and both cuts are close together.
    if depth.0[0] > half
        && let Some(under) = depth.only_crossing_near(half, f64::NAN)
    {
        if depth.above(-half) {
            parts.push(0.0, under);
            parts.push(under, 1.0);
            return parts;
        }
        if let Some(awash) = depth.only_crossing_near(-half, under) {
            parts.push(0.0, under);
            parts.push(under, awash);
            return parts;
        }
    }
    let awash = depth.parts_above(-half);
    let under = depth.parts_above(half);
    for part in awash.iter() {
        let mut from = part.from;
        for wet in under.iter().filter(|wet| wet.from >= part.from && wet.to <= part.to) {
            parts.push(from, wet.from);
            parts.push(wet.from, wet.to);
            from = wet.to;
        }
        parts.push(from, part.to);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight element from z = -1 to z = +1 with d = 0.2: wet for x < 0.45, awash to 0.55, dry beyond.
    #[test]
    fn a_rising_element_is_cut_where_it_enters_and_leaves_the_surface() {
        let parts: Vec<_> = wet_parts(&Cubic::hermite(-1.0, 2.0, 1.0, 2.0), 0.2).as_slice().to_vec();
        assert_eq!(parts.len(), 2);
        for (found, exact) in [(parts[0].from, 0.0), (parts[0].to, 0.45), (parts[1].from, 0.45), (parts[1].to, 0.55)] {
            assert!((found - exact).abs() < 1e-14);
        }
        assert_eq!(wet_parts(&Cubic::hermite(0.2, 0.0, 1.0, 0.0), 0.2).as_slice().len(), 0);
    }
}
