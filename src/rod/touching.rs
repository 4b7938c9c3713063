//! The bed on elements that touch it in part, or with damping or friction.
//!
//! The fast loop knows no more of the bed than its springs under elements that lie on it all along; the rest is added here.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::polynomial::{Cubic, Interval, Intervals};
use crate::algebra::shape::{GAUSS3, GAUSS4, GaussPoint, SHAPES3, Shape};
use crate::algebra::triple::Triple;
use crate::rod::element::Table;
use crate::rod::element_tangent::{ElementTangent, PointTangent};
use crate::rod::ends::Ends;
use crate::rod::friction::{Contact, Friction};
use crate::rod::motion::{Motion, Weights};
use crate::rod::seabed::{self, Plane, Resistance, projector};
use crate::rod::state::Field;
use crate::rod::stretch::Direction;
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

impl Ground {
    fn profile(&self, ends: &Ends<f64>) -> Cubic {
        let [r0, l0, r1, l1] = ends.parts().map(Vector3::from);
        self.plane.profile(&r0, &l0, &r1, &l1)
    }

    /// Height of the element above the bed, unless it is certainly clear of it.
    fn near(&self, table: &Table, u: &Field, e: usize) -> Option<Cubic> {
        let length = table.length_of(e);
        let profile = self.plane.profile(&u.position(e), &(u.slope(e) * length), &u.position(e + 1), &(u.slope(e + 1) * length));
        (!profile.above(self.resistance[e].onset) && !table.is_joint(e)).then_some(profile)
    }

    /// What the push of the bed adds to the forces on the ends of element `e`, if it is near.
    pub fn forces(&self, table: &Table, at: &Motion, e: usize) -> Option<[Triple<f64>; 4]> {
        let profile = self.near(table, at.u, e)?;
        let length = table.length_of(e);
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let dissipates = resistance.damping != 0.0 || self.friction.is_some();
        let rates = if dissipates { Ends::gather(at.v, e, length).along(normal) } else { Cubic([0.0; 4]) };
        let touching = resistance.touching(&profile);
        let mut pushes = [0.0; 4];
        for part in touching.iter() {
            let span = part.to - part.from;
            for point in &GAUSS4 {
                let x = part.from + span * point.x;
                let push =
                    resistance.push(profile.at(x), if dissipates { rates.at(x) } else { 0.0 }) * (point.weight * span * length);
                let value = Shape::at(x).value;
                (0..4).for_each(|k| pushes[k] -= push * value[k]);
            }
        }
        let mut sum = pushes.map(|push| Triple::from(normal * push));
        if let Some(friction) = &self.friction {
            let u = Ends::gather(at.u, e, length);
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
        let Some(profile) = self.near(table, at.u, e) else { return };
        let length = table.length_of(e);
        let (u, v) = (Ends::gather(at.u, e, length), Ends::gather(at.v, e, length));
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
        self.near(table, u, e).map_or(0.0, |profile| self.resistance[e].touching(&profile).length() * table.length_of(e))
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
