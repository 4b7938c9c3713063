//! The three parts of an element that hold on to the bed, each at a Gauss point: as long as the points weigh.

use crate::algebra::polynomial::Interval;
use crate::algebra::shape::{GAUSS3, GaussPoint, Shape};

/// Ends of the parts of an element of unit length.
const PARTS: [f64; 4] = [0.0, 5.0 / 18.0, 13.0 / 18.0, 1.0];

/// Three quadrature points on each part of an element of unit length: shape functions, and weights that add up to 1 on each part.
pub const PART_POINTS: [[([f64; 4], f64); 3]; 3] = [part_points(0), part_points(1), part_points(2)];

/// Integrals of the shape functions over each part of an element of unit length, by three Gauss points, which are exact.
pub const PART_WEIGHTS: [[f64; 4]; 3] = [part_weights(0), part_weights(1), part_weights(2)];

/// The same over the length of the part: means.
pub const PART_MEANS: [[f64; 4]; 3] = [part_means(0), part_means(1), part_means(2)];

const fn part_means(g: usize) -> [f64; 4] {
    let (mut mean, width) = (part_weights(g), PARTS[g + 1] - PARTS[g]);
    let mut k = 0;
    while k < 4 {
        mean[k] /= width;
        k += 1;
    }
    mean
}

const fn part_points(g: usize) -> [([f64; 4], f64); 3] {
    let (from, width) = (PARTS[g], PARTS[g + 1] - PARTS[g]);
    let (mut points, mut at) = ([([0.0; 4], 0.0); 3], 0);
    while at < 3 {
        points[at] = (Shape::at(from + width * GAUSS3[at].x).value, GAUSS3[at].weight);
        at += 1;
    }
    points
}

const fn part_weights(g: usize) -> [f64; 4] {
    let (points, width) = (part_points(g), PARTS[g + 1] - PARTS[g]);
    let (mut sum, mut at) = ([0.0; 4], 0);
    while at < 3 {
        let mut k = 0;
        while k < 4 {
            sum[k] += width * points[at].1 * points[at].0[k];
            k += 1;
        }
        at += 1;
    }
    sum
}

/// Quadrature points of an interval as far as it lies in part `g` of an element.
pub fn points_on(interval: Interval, g: usize) -> impl Iterator<Item = GaussPoint> {
    let (from, to) = (interval.from.max(PARTS[g]), interval.to.min(PARTS[g + 1]));
    let width = (to - from).max(0.0);
    GAUSS3.iter().map(move |point| GaussPoint { x: from + width * point.x, weight: width * point.weight })
}
