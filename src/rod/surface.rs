//! The water surface: how much of the line's section is wet.
//!
//!     φ(z) = min(1, max(0, ½ - z/d))
//!
//! z height of the centreline above the water [m], d diameter [m], φ wet fraction [-]. Buoyancy, drag and added mass are φ times
//! those under water; a floating line so finds its draught. Elements that are not all wet have the dry share 1 - φ of the water's
//! force taken off again, on the parts above -d/2 and above +d/2, which are found exactly.

use crate::algebra::polynomial::{Cubic, Interval};

/// The parts of an element that are out of the water or awash, cut at z = -d/2 and z = +d/2, given its height above the water.
pub fn dry_parts(height: &Cubic, diameter: f64) -> impl Iterator<Item = Interval> {
    let half = 0.5 * diameter;
    let lifted = height.parts_above(-half);
    let out = height.parts_above(half);
    let mut parts = [None; 12];
    let mut count = 0;
    for part in lifted.iter() {
        let mut from = part.from;
        for dry in out.iter().filter(|dry| dry.from >= part.from && dry.to <= part.to) {
            for (start, end) in [(from, dry.from), (dry.from, dry.to)] {
                if end > start && count < parts.len() {
                    parts[count] = Some(Interval { from: start, to: end });
                    count += 1;
                }
            }
            from = dry.to;
        }
        if part.to > from && count < parts.len() {
            parts[count] = Some(Interval { from, to: part.to });
            count += 1;
        }
    }
    parts.into_iter().flatten()
}

/// Dry fraction 1 - φ [-] and its change with height [1/m].
pub fn dry_fraction(z: f64, diameter: f64) -> (f64, f64) {
    let dry = 0.5 + z / diameter;
    if dry <= 0.0 {
        (0.0, 0.0)
    } else if dry >= 1.0 {
        (1.0, 0.0)
    } else {
        (dry, 1.0 / diameter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight element from z = -1 to z = +1 with d = 0.2: awash for x in (0.45, 0.55), dry beyond.
    #[test]
    fn a_rising_element_is_cut_where_it_enters_and_leaves_the_surface() {
        let parts: Vec<_> = dry_parts(&Cubic::hermite(-1.0, 2.0, 1.0, 2.0), 0.2).collect();
        assert_eq!(parts.len(), 2);
        for (found, exact) in [(parts[0].from, 0.45), (parts[0].to, 0.55), (parts[1].from, 0.55), (parts[1].to, 1.0)] {
            assert!((found - exact).abs() < 1e-14);
        }
        assert_eq!(dry_parts(&Cubic::hermite(-1.0, 0.0, -0.2, 0.0), 0.2).count(), 0);
    }
}
