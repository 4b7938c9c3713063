//! The water on elements that may not be all wet: force on the wet share, integrated over the parts below the surface.
//!
//! The fast loop leaves the water out on such elements. Their quadrature points are few and unlike those of the loop, but all of one
//! element: they are looked at side by side, as the loop does with elements.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::lanes::{Lanes, MOST_LANES, Real, Triple};
use crate::algebra::polynomial::{Cubic, Interval};
use crate::algebra::shape::{self, GAUSS3, GAUSS4, GaussPoint, Shape};
use crate::rod::element::{Ends, Motion, Table, Weights};
use crate::rod::element_tangent::{ElementTangent, PointTangent};
use crate::rod::mesh::Mesh;
use crate::rod::morison::{self, Coefficients, PointMotion, Water};
use crate::rod::stretch::Direction;
use crate::rod::surface::{self, MOST_PARTS};
use crate::sea::clock::Clock;
use nalgebra::Vector3;
use pulp::{Simd, WithSimd};

/// What leaves a line when it leaves the water: buoyancy, drag and added mass.
#[derive(Debug, Clone)]
pub struct Surface {
    diameter: Vec<f64>,
    buoyancy: Vec<f64>,
}

impl Surface {
    /// The surface for a mesh.
    pub fn new(mesh: &Mesh) -> Surface {
        let of = |f: &dyn Fn(usize) -> f64| (0..mesh.elements.len()).map(f).collect();
        Surface {
            diameter: of(&|e| mesh.properties_of(e).diameter),
            buoyancy: of(&|e| mesh.properties_of(e).weight_in_air - mesh.properties_of(e).weight),
        }
    }

    /// The element and its height above the surface, unless it is certainly all wet.
    fn lifted<W: Water>(&self, table: &Table, water: &W, at: &Motion, e: usize) -> Option<(Ends<f64>, Cubic)> {
        let ends = Ends::gather(at.u, e, table.length_of(e));
        let height = ends.height();
        if height.below(water.lowest_surface() - 0.5 * self.diameter[e]) || table.is_joint(e) {
            return None;
        }
        Some((ends, if W::WAVES { surface::above_waves(&ends, water, &at.clock) } else { height }))
    }

    /// What the force of the water on the wet share of element `e` adds to the forces on its ends, if the element is lifted.
    pub fn forces<W: Water>(&self, table: &Table, water: &W, at: &Motion, e: usize) -> Option<[Triple<f64>; 4]> {
        let (u, height) = self.lifted(table, water, at, e)?;
        let length = table.length_of(e);
        let (v, a) = (Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
        let points = self.points(&height, e, length);
        let coefficients = table.coefficients(e);
        let wet = WetShare {
            water,
            clock: at.clock,
            ends: [&u, &v, &a],
            per_length: 1.0 / length,
            height: &height,
            per_diameter: 1.0 / self.diameter[e],
            buoyancy: self.buoyancy[e],
            coefficients: &coefficients,
            points: &points,
        };
        Some(table.processor.dispatch(wet))
    }

    /// Quadrature points of the wet parts of an element, given its height above the water and its length.
    fn points(&self, height: &Cubic, e: usize, length: f64) -> Points {
        let mut points = Points::default();
        for &part in surface::wet_parts(height, self.diameter[e]).as_slice() {
            for point in self.rule(height, part, e) {
                let span = part.to - part.from;
                points.push(part.from + span * point.x, span * point.weight * length);
            }
        }
        points
    }

    /// Three points under water, as in the fast loop; four where the line is awash, which are exact for its buoyancy.
    fn rule(&self, height: &Cubic, part: Interval, e: usize) -> &'static [GaussPoint] {
        if height.at(0.5 * (part.from + part.to)) < -0.5 * self.diameter[e] { &GAUSS3 } else { &GAUSS4 }
    }

    /// Wet fraction φ at x in [0, 1] of an element, and its change with height [1/m].
    fn wet<W: Water>(&self, height: &Cubic, x: f64, point: &PointMotion<f64>, e: usize) -> (f64, f64) {
        surface::wet_fraction(if W::WAVES { height.at(x) } else { point.place.z }, self.diameter[e])
    }

    /// Force of the water under water [N/m].
    fn force<W: Water>(&self, water: &W, k: &Coefficients<f64>, point: &PointMotion<f64>, e: usize) -> Vector3<f64> {
        let buoyancy = Vector3::new(0.0, 0.0, self.buoyancy[e]);
        if W::PRESENT { Vector3::from(morison::force((), water, k, point)) + buoyancy } else { buoyancy }
    }

    /// Adds the tangent of the force of the water on the wet share of a lifted element to the matrix.
    pub fn tangent<W: Water>(
        &self,
        table: &Table,
        water: &W,
        at: &Motion,
        e: usize,
        weights: &Weights,
        matrix: &mut BlockTridiagonal<6>,
    ) {
        let Some((u, height)) = self.lifted(table, water, at, e) else { return };
        let length = table.length_of(e);
        let (v, a) = (Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
        let coefficients = table.coefficients(e);
        let mut sum = ElementTangent::zero(());
        let points = self.points(&height, e, length);
        for (&x, &weight) in points.x.iter().zip(&points.weight).take(points.count) {
            let shape = Shape::at(x);
            let point = point_motion(at.clock, &u, &v, &a, length, &shape);
            let (wet, by_height) = self.wet::<W>(&height, x, &point, e);
            let force = self.force(water, &coefficients, &point, e);
            let by_rising = force * Vector3::z().transpose() * (-by_height * weights.u);
            let mut tangent = PointTangent::of_load(by_rising.into());
            if W::PRESENT {
                let water = morison::tangent((), water, &coefficients, &point, weights);
                tangent.load = water.by_motion.scale_add(-wet, tangent.load);
                tangent.turning = water.by_slope.times(-wet);
            }
            sum.add(&shape, weight, 1.0 / length, &tangent);
        }
        sum.add_to(matrix, e, length, e + 1);
    }
}

/// Room for the quadrature points of an element, and for zeros behind them.
const ROOM: usize = MOST_PARTS * GAUSS4.len() + MOST_LANES;

/// Quadrature points on [0, 1] and their weights [m]; of weight zero beyond the last.
struct Points {
    x: [f64; ROOM],
    weight: [f64; ROOM],
    count: usize,
}

impl Default for Points {
    fn default() -> Self {
        Points { x: [0.0; ROOM], weight: [0.0; ROOM], count: 0 }
    }
}

impl Points {
    fn push(&mut self, x: f64, weight: f64) {
        (self.x[self.count], self.weight[self.count]) = (x, weight);
        self.count += 1;
    }
}

/// Minus the force of the water on the wet share of one element, on its ends: the points of its quadrature side by side.
struct WetShare<'a, W> {
    water: &'a W,
    clock: Clock,
    /// Of u, v and a.
    ends: [&'a Ends<f64>; 3],
    per_length: f64,
    height: &'a Cubic,
    per_diameter: f64,
    buoyancy: f64,
    coefficients: &'a Coefficients<f64>,
    points: &'a Points,
}

impl<W: Water> WithSimd for WetShare<'_, W> {
    type Output = [Triple<f64>; 4];

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> [Triple<f64>; 4] {
        let (u, v, a) = (self.ends[0].splat(cpu), self.ends[1].splat(cpu), self.ends[2].splat(cpu));
        let coefficients = self.coefficients.splat(cpu);
        let mut sum = [Triple::<Lanes<V>>::zero(cpu); 4];
        let mut first = 0;
        while first < self.points.count {
            let (x, weight) = (Lanes::<V>::load(cpu, &self.points.x, first), Lanes::<V>::load(cpu, &self.points.weight, first));
            let (value, slope) = shape::in_lanes(x);
            let place = u.combine_lanes(&value);
            let height = if W::WAVES { self.height.in_lanes(x) } else { place.z };
            let wet = (height * -self.per_diameter + 0.5).max(Lanes::<V>::splat(cpu, 0.0)).min(Lanes::<V>::splat(cpu, 1.0));
            let mut force = Triple::zero(cpu);
            if W::PRESENT {
                let point = PointMotion {
                    clock: self.clock,
                    direction: Direction::of(u.combine_lanes(&slope) * Lanes::<V>::splat(cpu, self.per_length)),
                    place,
                    velocity: v.combine_lanes(&value),
                    acceleration: a.combine_lanes(&value),
                };
                force = morison::force(cpu, self.water, &coefficients, &point);
            }
            force.z = force.z + self.buoyancy;
            let force = force * (-wet * weight);
            let mut k = 0;
            while k < 4 {
                sum[k] = force.mul_add(value[k], sum[k]);
                k += 1;
            }
            first += V::F64_LANES;
        }
        [sum[0].total(), sum[1].total(), sum[2].total(), sum[3].total()]
    }
}

fn point_motion(clock: Clock, u: &Ends<f64>, v: &Ends<f64>, a: &Ends<f64>, length: f64, shape: &Shape) -> PointMotion<f64> {
    PointMotion {
        clock,
        direction: Direction::of(u.combine(&shape.slope).scale(1.0 / length)),
        place: u.combine(&shape.value),
        velocity: v.combine(&shape.value),
        acceleration: a.combine(&shape.value),
    }
}
