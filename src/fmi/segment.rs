//! A piece of a fairlead's path: a polynomial in time, and how polynomials are put through what is known.

use crate::solve::motion::Path;
use nalgebra::Vector3;

/// Most coefficients of a segment: a polynomial of degree 5.
pub const TERMS: usize = 6;
/// A polynomial on one axis, by power.
pub type Terms = [f64; TERMS];

/// The path of one step: a polynomial in τ = time - start, by power and axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Where τ is zero [s].
    pub start: f64,
    /// Coefficients, by power and axis.
    pub coefficients: [[f64; 3]; TERMS],
}

impl Segment {
    /// As a path for the solver.
    pub fn path(&self) -> Path {
        let coefficients = self.coefficients.iter().map(|term| Vector3::from(*term)).collect();
        Path::Polynomial { start: self.start, coefficients }
    }

    /// As a path for the solver, in the place of the last one.
    pub fn write_to(&self, path: &mut Path) {
        match path {
            Path::Polynomial { start, coefficients } if coefficients.len() == TERMS => {
                *start = self.start;
                coefficients.iter_mut().zip(self.coefficients).for_each(|(to, term)| *to = term.into());
            }
            _ => *path = self.path(),
        }
    }

    /// Position [m] and velocity [m/s] at a time.
    pub fn at(&self, time: f64) -> ([f64; 3], [f64; 3]) {
        let tau = time - self.start;
        let (mut position, mut velocity) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            for term in self.coefficients.iter().rev() {
                velocity[axis] = velocity[axis] * tau + position[axis];
                position[axis] = position[axis] * tau + term[axis];
            }
        }
        (position, velocity)
    }
}

/// The same polynomial in τ - `by`.
pub fn shifted(terms: &Terms, by: f64) -> Terms {
    let mut shifted = *terms;
    for lowest in 0..TERMS - 1 {
        for power in (lowest..TERMS - 1).rev() {
            shifted[power] += by * shifted[power + 1];
        }
    }
    shifted
}

/// The polynomial with given value and derivatives at τ = 0 and given values before.
pub fn through_present(present: &[f64], past: impl Iterator<Item = (f64, f64)>) -> Terms {
    let (mut times, mut values) = ([0.0; TERMS], [0.0; TERMS]);
    let mut count = present.len();
    values[..count].copy_from_slice(present);
    for ((time, value), (time_slot, value_slot)) in past.zip(times[count..].iter_mut().zip(&mut values[count..])) {
        (*time_slot, *value_slot) = (time, value);
        count += 1;
    }
    interpolate(&times[..count], &values[..count])
}

/// Newton's divided differences, as coefficients by power. Nodes that are equal to the first stand first and carry derivatives of rising
/// order instead of values. At most `TERMS` nodes.
fn interpolate(nodes: &[f64], values: &[f64]) -> Terms {
    let count = nodes.len();
    let repeated = nodes.iter().take_while(|node| **node == nodes[0]).count();
    let mut differences = [0.0; TERMS];
    for (index, difference) in differences[..count].iter_mut().enumerate() {
        *difference = if index < repeated { values[0] } else { values[index] };
    }
    let mut factorial = 1.0;
    for level in 1..count {
        factorial *= level as f64;
        for index in (level..count).rev() {
            differences[index] = if index < repeated {
                values[level] / factorial
            } else {
                (differences[index] - differences[index - 1]) / (nodes[index] - nodes[index - level])
            };
        }
    }
    let mut terms = [0.0; TERMS];
    for index in (0..count).rev() {
        for power in (1..TERMS).rev() {
            terms[power] = terms[power - 1] - nodes[index] * terms[power];
        }
        terms[0] = differences[index] - nodes[index] * terms[0];
    }
    terms
}

/// The cubic from one (value, slope) to another over `length`.
pub fn hermite(from: (f64, f64), to: (f64, f64), length: f64) -> Terms {
    let chord = (to.0 - from.0) / length;
    [from.0, from.1, (3.0 * chord - 2.0 * from.1 - to.1) / length, (from.1 + to.1 - 2.0 * chord) / (length * length), 0.0, 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shifted_polynomial_has_the_same_values() {
        let terms = [3.0, -1.0, 0.5, 2.0, -0.25, 0.125];
        let at = |terms: &Terms, x: f64| terms.iter().rev().fold(0.0, |sum, term| sum * x + term);
        let moved = shifted(&terms, 0.7);
        for x in [-1.0, 0.0, 0.3, 2.0] {
            assert!((at(&moved, x) - at(&terms, x + 0.7)).abs() < 1e-12);
        }
    }
}
