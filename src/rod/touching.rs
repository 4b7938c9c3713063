//! Loads that act on a part of an element only: the bed where it touches, the surface where it is dry.
//!
//! The fast loop knows nothing of the bed, and leaves the water out on elements that may not be all wet; both are added here.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::lanes::Triple;
use crate::algebra::polynomial::{Cubic, Interval, Intervals};
use crate::algebra::shape::{GAUSS3, GAUSS4, GaussPoint, SHAPES3, Shape};
use crate::rod::element::{Ends, Motion, Table, Weights};
use crate::rod::element_tangent::{ElementTangent, PointTangent};
use crate::rod::friction::{Contact, Friction};
use crate::rod::mesh::Mesh;
use crate::rod::morison::{self, Coefficients, PointMotion, Water};
use crate::rod::seabed::{self, Plane, Resistance, projector};
use crate::rod::state::Field;
use crate::rod::stretch::Direction;
use crate::rod::surface;
use crate::sea::clock::Clock;
use nalgebra::{Vector2, Vector3};

/// The bed under a line: its plane, its resistance against each element, and its friction.
#[derive(Debug, Clone)]
pub struct Ground {
    /// The plane.
    pub plane: Plane,
    /// One resistance per element.
    pub resistance: Vec<Resistance>,
    /// Friction, where there is any.
    pub friction: Option<Friction>,
}

/// Adds `force`(point) over an interval of element `e`: R_k += Σ w N_k f, points and weights of a rule on [0, 1].
fn integrate(
    rule: &[GaussPoint],
    part: Interval,
    length: f64,
    mut force: impl FnMut(f64, &Shape) -> Vector3<f64>,
    sum: &mut [Triple<f64>; 4],
) {
    for point in rule {
        let x = part.from + (part.to - part.from) * point.x;
        let shape = Shape::at(x);
        let f = force(x, &shape) * (point.weight * (part.to - part.from) * length);
        for k in 0..4 {
            sum[k] = Triple::from(f).scale_add(shape.value[k], sum[k]);
        }
    }
}

impl Ground {
    fn profile(&self, ends: &Ends<f64>) -> Cubic {
        let [r0, l0, r1, l1] = ends.parts().map(Vector3::from);
        self.plane.profile(&r0, &l0, &r1, &l1)
    }

    /// The element and its height above the bed, unless it is certainly clear of it.
    fn near(&self, table: &Table, u: &Field, e: usize) -> Option<(Ends<f64>, Cubic)> {
        let ends = Ends::gather(u, e, table.length_of(e));
        let profile = self.profile(&ends);
        (!profile.above(self.resistance[e].onset) && !table.is_joint(e)).then_some((ends, profile))
    }

    /// What the push of the bed adds to the forces on the ends of element `e`, if it is near.
    pub fn forces(&self, table: &Table, at: &Motion, e: usize) -> Option<[Triple<f64>; 4]> {
        let (u, profile) = self.near(table, at.u, e)?;
        let length = table.length_of(e);
        let v = Ends::gather(at.v, e, length);
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let mut sum = [Triple::zero(()); 4];
        let touching = resistance.touching(&profile);
        for part in touching.iter() {
            let push = |_: f64, shape: &Shape| {
                let rate = v.combine(&shape.value).along(normal);
                normal * -resistance.push(self.plane.height(&u.combine(&shape.value).into()), rate)
            };
            integrate(&GAUSS4, part, length, push, &mut sum);
        }
        if let Some(friction) = &self.friction {
            let rates = v.along(normal);
            for g in 0..3 {
                let contact = self.contact(&u, (&profile, &touching, &rates), (e, g), at.holds);
                let force = friction.force(e, &contact) * -(GAUSS3[g].weight * length);
                (0..4).for_each(|k| sum[k] = Triple::from(force).scale_add(SHAPES3[g].value[k], sum[k]));
            }
        }
        Some(sum)
    }

    /// Part `g` of element `e` and the place of the bed to which it holds on; given the element's height above the bed, where it
    /// touches, and the rate of that height.
    fn contact(
        &self,
        u: &Ends<f64>,
        (profile, touching, rates): (&Cubic, &Intervals, &Cubic),
        (e, g): (usize, usize),
        holds: &Field,
    ) -> Contact {
        let resistance = &self.resistance[e];
        let push: f64 = touching
            .iter()
            .flat_map(|part| points_on(part, g))
            .map(|point| point.weight * resistance.push(profile.at(point.x), rates.at(point.x)))
            .sum();
        Contact {
            position: u.combine(&SHAPES3[g].value).into(),
            push: push / GAUSS3[g].weight,
            hold: Vector2::new(holds.component(2 * g)[e], holds.component(2 * g + 1)[e]),
        }
    }

    /// Places of the bed to which a line holds on that was laid slack, from its anchor on, to where it lies now, and then stretched.
    pub fn lay(&self, table: &Table, u: &Field, holds: &mut Field) {
        let Some(friction) = &self.friction else { return };
        let (mut stretched, mut landed) = (0.0, false);
        for e in (0..table.len()).filter(|e| !table.is_joint(*e)) {
            let length = table.length_of(e);
            let ends = Ends::gather(u, e, length);
            landed |= self.resistance[e].touching(&self.profile(&ends)).length() > 0.0;
            let direction = |g: usize| Direction::of(ends.combine(&SHAPES3[g].slope) * (1.0 / length));
            let strain = |g: usize| if landed { (direction(g).stretch - 1.0).max(0.0) } else { 0.0 };
            // Elongation up to each point, with the strain of a point halfway to its neighbours.
            let mut before = 0.0;
            for g in 0..3 {
                let span = 0.5 * (GAUSS3[g].x - before) * length;
                stretched += span * (strain(g.max(1) - 1) + strain(g));
                before = GAUSS3[g].x;
                let unstretched = ends.combine(&SHAPES3[g].value) - direction(g).tangent * stretched;
                let hold = friction.along(&unstretched.into());
                (0..2).for_each(|c| holds.component_mut(2 * g + c)[e] = hold[c]);
            }
            stretched += (1.0 - before) * length * strain(2);
        }
    }

    /// Moves the places of the bed to which the line holds on after a step to these positions and velocities.
    pub fn hold(&self, table: &Table, u: &Field, v: &Field, holds: &mut Field) {
        let Some(friction) = &self.friction else { return };
        for e in (0..table.len()).filter(|e| !table.is_joint(*e)) {
            let length = table.length_of(e);
            let (u, v) = (Ends::gather(u, e, length), Ends::gather(v, e, length));
            let (profile, rates) = (self.profile(&u), v.along(&self.plane.normal));
            let touching = self.resistance[e].touching(&profile);
            for g in 0..3 {
                let hold = friction.hold(e, &self.contact(&u, (&profile, &touching, &rates), (e, g), holds));
                (0..2).for_each(|c| holds.component_mut(2 * g + c)[e] = hold[c]);
            }
        }
    }

    /// Adds the tangent of the push on element `e` to the matrix.
    pub fn tangent(&self, table: &Table, at: &Motion, e: usize, weights: &Weights, matrix: &mut BlockTridiagonal<6>) {
        let Some((u, profile)) = self.near(table, at.u, e) else { return };
        let length = table.length_of(e);
        let v = Ends::gather(at.v, e, length);
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let touching = resistance.touching(&profile);
        let stiffness = |height: f64, rate: f64| {
            let (by_position, by_rate) = resistance.tangent(height, rate);
            -(by_position * weights.u + by_rate * weights.v)
        };
        let products = if resistance.damping == 0.0 && profile.below(resistance.onset) {
            seabed::grounded_tangent(resistance.stiffness * weights.u, length)
        } else {
            let mut products = [[0.0; 4]; 4];
            for part in touching.iter() {
                for point in &GAUSS4 {
                    let shape = Shape::at(part.from + (part.to - part.from) * point.x);
                    let rate = v.combine(&shape.value).along(normal);
                    let stiffness = stiffness(self.plane.height(&u.combine(&shape.value).into()), rate);
                    let value = shape.scaled(length).value;
                    add_product(&mut products, stiffness * point.weight * (part.to - part.from) * length, &value, &value);
                }
            }
            products
        };
        let mut sum = ElementTangent::zero(());
        sum.add_products(&products, &projector(normal).into());
        if let Some(friction) = &self.friction {
            let rates = v.along(normal);
            for g in 0..3 {
                let contact = self.contact(&u, (&profile, &touching, &rates), (e, g), at.holds);
                if contact.push > 0.0 {
                    let (change, measure) = (friction.tangent(e, &contact), GAUSS3[g].weight * length);
                    let shape = SHAPES3[g].scaled(length);
                    let point = PointTangent::of_load((-change.by_position * weights.u).into());
                    sum.add(&shape, measure, 1.0, &point);
                    let mut products = [[0.0; 4]; 4];
                    for point in touching.iter().flat_map(|part| points_on(part, g)) {
                        let scale = stiffness(profile.at(point.x), rates.at(point.x)) * point.weight * length;
                        add_product(&mut products, scale, &shape.value, &Shape::at(point.x).scaled(length).value);
                    }
                    sum.add_products(&products, &(change.by_push * normal.transpose()).into());
                }
            }
        }
        sum.add_to(matrix, e, 1.0, e + 1);
    }

    /// Unstretched length of element `e` in contact [m].
    pub fn touching_length(&self, table: &Table, u: &Field, e: usize) -> f64 {
        self.near(table, u, e).map_or(0.0, |(_, profile)| self.resistance[e].touching(&profile).length() * table.length_of(e))
    }
}

/// products[k][l] += scale a_k b_l.
fn add_product(products: &mut [[f64; 4]; 4], scale: f64, a: &[f64; 4], b: &[f64; 4]) {
    for k in 0..4 {
        (0..4).for_each(|l| products[k][l] += scale * a[k] * b[l]);
    }
}

/// Ends of the three parts of an element that hold on to the bed, each at a Gauss point: as long as the points weigh.
const PARTS: [f64; 4] = [0.0, 5.0 / 18.0, 13.0 / 18.0, 1.0];

/// Quadrature points of an interval as far as it lies in part `g` of an element.
fn points_on(interval: Interval, g: usize) -> impl Iterator<Item = GaussPoint> {
    let (from, to) = (interval.from.max(PARTS[g]), interval.to.min(PARTS[g + 1]));
    let width = (to - from).max(0.0);
    GAUSS3.iter().map(move |point| GaussPoint { x: from + width * point.x, weight: width * point.weight })
}

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
        let coefficients = table.coefficients(e);
        let mut sum = [Triple::zero(()); 4];
        for part in surface::wet_parts(&height, self.diameter[e]) {
            let force = |x: f64, shape: &Shape| {
                let point = point_motion(at.clock, &u, &v, &a, length, shape);
                self.force(water, &coefficients, &point, e) * -self.wet::<W>(&height, x, &point, e).0
            };
            integrate(self.rule(&height, part, e), part, length, force, &mut sum);
        }
        Some(sum)
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
        for part in surface::wet_parts(&height, self.diameter[e]) {
            for gauss in self.rule(&height, part, e) {
                let x = part.from + (part.to - part.from) * gauss.x;
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
                sum.add(&shape, gauss.weight * (part.to - part.from) * length, 1.0 / length, &tangent);
            }
        }
        sum.add_to(matrix, e, length, e + 1);
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
