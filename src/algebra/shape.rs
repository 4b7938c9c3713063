//! Cubic Hermite shape functions on [0, 1] and Gauss points.
//!
//! r(x) = N0 r_i + N1 p_i + N2 r_j + N3 p_j with p = dr/ds, s = L x:
//! N = [1 - 3x² + 2x³, L(x - 2x² + x³), 3x² - 2x³, L(x³ - x²)].

use crate::algebra::real::Real;

/// Shape functions and their first and second derivatives by arc length, for unit length: multiply entry k of the
/// value by L^(k odd), of the slope by L^(k odd) / L, of the curvature by L^(k odd) / L².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// N at x, unit length.
    pub value: [f64; 4],
    /// dN/dx at x, unit length.
    pub slope: [f64; 4],
    /// d²N/dx² at x, unit length.
    pub curvature: [f64; 4],
}

impl Shape {
    /// Shape functions of an element of unit length at x in [0, 1].
    pub const fn at(x: f64) -> Shape {
        Shape {
            value: [
                1.0 - 3.0 * x * x + 2.0 * x * x * x,
                x - 2.0 * x * x + x * x * x,
                3.0 * x * x - 2.0 * x * x * x,
                x * x * x - x * x,
            ],
            slope: [6.0 * x * x - 6.0 * x, 1.0 - 4.0 * x + 3.0 * x * x, 6.0 * x - 6.0 * x * x, 3.0 * x * x - 2.0 * x],
            curvature: [12.0 * x - 6.0, 6.0 * x - 4.0, 6.0 - 12.0 * x, 6.0 * x - 2.0],
        }
    }

    /// The same functions for an element of length `length` [m]: values [1, m, 1, m], slopes [1/m, 1, …], curvatures [1/m², 1/m, …].
    pub fn scaled(&self, length: f64) -> Shape {
        let factor = [1.0, length, 1.0, length];
        Shape {
            value: std::array::from_fn(|k| self.value[k] * factor[k]),
            slope: std::array::from_fn(|k| self.slope[k] * factor[k] / length),
            curvature: std::array::from_fn(|k| self.curvature[k] * factor[k] / (length * length)),
        }
    }
}

/// Values and slopes of the shape functions of unit length, as `Shape::at`, with an x in every lane.
#[inline(always)]
pub fn in_lanes<F: Real>(x: F) -> ([F; 4], [F; 4]) {
    let y = -x + 1.0;
    let (xx, xy) = (x * x, x * y);
    let b = xx * (x * -2.0 + 3.0);
    let turn = xy * 6.0;
    ([-b + 1.0, xy * y, b, -(xy * x)], [-turn, y * (x * -3.0 + 1.0), turn, x * (x * 3.0 + -2.0)])
}

/// A quadrature point on [0, 1] and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussPoint {
    /// Place in [0, 1].
    pub x: f64,
    /// Weight; all weights add up to 1.
    pub weight: f64,
}

const G3: f64 = 0.112_701_665_379_258_31;
const G4A: f64 = 0.069_431_844_202_973_71;
const G4B: f64 = 0.330_009_478_207_571_87;
const W4A: f64 = 0.173_927_422_568_726_92;
const W4B: f64 = 0.326_072_577_431_273_1;

/// Three Gauss points: exact for polynomials of degree 5.
pub const GAUSS3: [GaussPoint; 3] = [
    GaussPoint { x: G3, weight: 5.0 / 18.0 },
    GaussPoint { x: 0.5, weight: 8.0 / 18.0 },
    GaussPoint { x: 1.0 - G3, weight: 5.0 / 18.0 },
];

/// Four Gauss points: exact for polynomials of degree 7.
pub const GAUSS4: [GaussPoint; 4] = [
    GaussPoint { x: G4A, weight: W4A },
    GaussPoint { x: G4B, weight: W4B },
    GaussPoint { x: 1.0 - G4B, weight: W4B },
    GaussPoint { x: 1.0 - G4A, weight: W4A },
];

/// Shape functions of unit length at the three Gauss points.
pub const SHAPES3: [Shape; 3] = [Shape::at(GAUSS3[0].x), Shape::at(GAUSS3[1].x), Shape::at(GAUSS3[2].x)];

/// Shape functions of unit length at the four Gauss points.
pub const SHAPES4: [Shape; 4] = [Shape::at(GAUSS4[0].x), Shape::at(GAUSS4[1].x), Shape::at(GAUSS4[2].x), Shape::at(GAUSS4[3].x)];

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(points: &[GaussPoint], degree: i32) -> f64 {
        points.iter().map(|g| g.weight * g.x.powi(degree)).sum()
    }

    /// ∫ x^n dx = 1/(n+1) on [0, 1], exact to rounding up to degree 2n - 1 and not beyond.
    #[test]
    fn gauss_points_are_exact_to_their_degree_and_no_further() {
        for (points, degree) in [(&GAUSS3[..], 5), (&GAUSS4[..], 7)] {
            for n in 0..=degree {
                assert!((integral(points, n) - 1.0 / (n + 1) as f64).abs() < 1e-15, "degree {n}");
            }
            assert!((integral(points, degree + 1) - 1.0 / (degree + 2) as f64).abs() > 1e-6);
        }
    }

    /// The derivatives are those of the values: central differences with step 1e-5 have an error below 1e-9.
    #[test]
    fn derivatives_are_those_of_the_values() {
        let (x, d) = (0.37, 1e-5);
        for k in 0..4 {
            let first = (Shape::at(x + d).value[k] - Shape::at(x - d).value[k]) / (2.0 * d);
            let second = (Shape::at(x + d).slope[k] - Shape::at(x - d).slope[k]) / (2.0 * d);
            assert!((first - Shape::at(x).slope[k]).abs() < 1e-9);
            assert!((second - Shape::at(x).curvature[k]).abs() < 1e-9);
        }
    }
}
