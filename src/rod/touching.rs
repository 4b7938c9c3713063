//! The bed on elements that touch it in part, and the tangent of the bed.
//!
//! The fast loop takes the elements that lie on the bed all along (`lying`); the rest is added here.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::polynomial::{Cubic, Intervals};
use crate::algebra::shape::{GAUSS3, GAUSS4, SHAPES3, SHAPES4, Shape};
use crate::algebra::triple::Triple;
use crate::rod::element::Table;
use crate::rod::element_tangent::ElementTangent;
use crate::rod::ends::Ends;
use crate::rod::friction::{Contact, Friction};
use crate::rod::motion::{Motion, Weights};
use crate::rod::parts::{PART_WEIGHTS, points_on};
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
    fn near(&self, table: &Table, u: &Ends<f64>, e: usize) -> Option<Cubic> {
        let profile = self.profile(u);
        (!profile.above(self.resistance[e].onset) && !table.is_joint(e)).then_some(profile)
    }

    /// End values and slopes of the penetration of an element that touches all along and is pushed by springs alone [m].
    fn grounded(&self, e: usize, profile: &Cubic) -> Option<[f64; 4]> {
        let resistance = &self.resistance[e];
        let springs = resistance.damping == 0.0 && profile.below(resistance.onset);
        springs.then(|| Cubic(profile.0.map(|g| resistance.onset - g)).ends())
    }

    /// What the push of the bed adds to the forces on the ends of element `e`, if it is near.
    pub fn forces(&self, table: &Table, at: &Motion, e: usize) -> Option<[Triple<f64>; 4]> {
        let length = table.length_of(e);
        let u = Ends::gather(at.u, e, length);
        let profile = self.near(table, &u, e)?;
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let (pushes, on_parts) = if let Some(p) = self.grounded(e, &profile) {
            (
                seabed::grounded_push(-resistance.stiffness, length, &p),
                self.friction.as_ref().map(|_| grounded_parts(resistance, &p)),
            )
        } else {
            let dissipates = resistance.damping != 0.0 || self.friction.is_some();
            let rates = if dissipates { Ends::gather(at.v, e, length).along(normal) } else { Cubic([0.0; 4]) };
            let touching = resistance.touching(&profile);
            let (mut pushes, [heights, rising]) = ([0.0; 4], [profile, rates].map(|cubic| cubic.ends()));
            each_point(&touching, |value, weight| {
                let rate = if dissipates { combined(value, &rising) } else { 0.0 };
                let push = resistance.push(combined(value, &heights), rate) * (weight * length);
                (0..4).for_each(|k| pushes[k] -= push * value[k]);
            });
            (pushes, self.friction.as_ref().map(|_| parts(resistance, &profile, &touching, &rates)))
        };
        let mut sum = pushes.map(|push| normal * push);
        if let Some((friction, on_parts)) = self.friction.as_ref().zip(on_parts) {
            let (profiles, mut dragged) = (friction.profiles(&u), [Vector2::zeros(); 4]);
            for (g, push) in on_parts.into_iter().enumerate().filter(|(_, push)| *push > 0.0) {
                let force = friction.force(e, &contact(&profiles, push, (e, g), at.holds)) * -(GAUSS3[g].weight * length);
                (0..4).for_each(|k| dragged[k] += force * SHAPES3[g].value[k]);
            }
            (0..4).for_each(|k| sum[k] += friction.in_space(&dragged[k]));
        }
        Some(sum.map(Triple::from))
    }

    /// Push on the parts of element `e` [N/m], given where it is and how fast.
    fn on_parts(&self, u: &Ends<f64>, v: impl FnOnce() -> Ends<f64>, e: usize) -> [f64; 3] {
        let (profile, resistance) = (self.profile(u), &self.resistance[e]);
        if profile.above(resistance.onset) {
            return [0.0; 3];
        }
        if let Some(p) = self.grounded(e, &profile) {
            return grounded_parts(resistance, &p);
        }
        parts(resistance, &profile, &resistance.touching(&profile), &v().along(&self.plane.normal))
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

    /// Moves the places of the bed to which element `e` holds on after a step to these positions and velocities.
    pub fn hold(&self, table: &Table, u: &Field, v: &Field, e: usize, holds: &mut Field) {
        let Some(friction) = self.friction.as_ref().filter(|_| !table.is_joint(e)) else { return };
        let length = table.length_of(e);
        let u = Ends::gather(u, e, length);
        let profiles = friction.profiles(&u);
        for (g, push) in self.on_parts(&u, || Ends::gather(v, e, length), e).into_iter().enumerate() {
            let hold = friction.hold(e, &contact(&profiles, push, (e, g), holds));
            (0..2).for_each(|c| holds.component_mut(2 * g + c)[e] = hold[c]);
        }
    }

    /// Adds the tangent of the push on element `e` to the matrix.
    pub fn tangent(&self, table: &Table, at: &Motion, e: usize, weights: &Weights, matrix: &mut BlockTridiagonal<6>) {
        let length = table.length_of(e);
        let u = Ends::gather(at.u, e, length);
        let Some(profile) = self.near(table, &u, e) else { return };
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let grounded = self.grounded(e, &profile);
        let touching = if grounded.is_some() { Intervals::whole() } else { resistance.touching(&profile) };
        let rates = Ends::gather(at.v, e, length).along(normal);
        let stiffness = |height: f64, rate: f64| {
            let (by_position, by_rate) = resistance.tangent(height, rate);
            -(by_position * weights.u + by_rate * weights.v)
        };
        let lever = [1.0, length, 1.0, length];
        let products = if grounded.is_some() {
            seabed::grounded_tangent(resistance.stiffness * weights.u, length)
        } else {
            let (mut products, [heights, rising]) = ([[0.0; 4]; 4], [profile, rates].map(|cubic| cubic.ends()));
            each_point(&touching, |shape, weight| {
                let stiffness = stiffness(combined(shape, &heights), combined(shape, &rising));
                let value = std::array::from_fn(|k| shape[k] * lever[k]);
                add_product(&mut products, stiffness * weight * length, &value, &value);
            });
            products
        };
        let mut sum = ElementTangent::zero(());
        sum.add_products(&products, &projector(normal).into());
        if let Some(friction) = &self.friction {
            let on_parts = match &grounded {
                Some(p) => grounded_parts(resistance, p),
                None => parts(resistance, &profile, &touching, &rates),
            };
            let profiles = friction.profiles(&u);
            for (g, push) in on_parts.into_iter().enumerate().filter(|(_, push)| *push > 0.0) {
                let change = friction.tangent(e, &contact(&profiles, push, (e, g), at.holds));
                let shape = SHAPES3[g].scaled(length);
                let mut products = [[0.0; 4]; 4];
                add_product(&mut products, GAUSS3[g].weight * length, &shape.value, &shape.value);
                sum.add_products(&products, &(change.by_position * -weights.u).into());
                if change.by_push == Vector3::zeros() {
                    continue;
                }
                products = [[0.0; 4]; 4];
                if grounded.is_some() {
                    let parts = std::array::from_fn(|k| PART_WEIGHTS[g][k] * lever[k]);
                    add_product(&mut products, resistance.stiffness * weights.u * length, &shape.value, &parts);
                } else {
                    for point in touching.iter().flat_map(|part| points_on(part, g)) {
                        let scale = stiffness(profile.at(point.x), rates.at(point.x)) * point.weight * length;
                        add_product(&mut products, scale, &shape.value, &Shape::at(point.x).scaled(length).value);
                    }
                }
                sum.add_products(&products, &(change.by_push * normal.transpose()).into());
            }
        }
        sum.add_to(matrix, e, 1.0, e + 1);
    }

    /// Unstretched length of element `e` in contact [m].
    pub fn touching_length(&self, table: &Table, u: &Field, e: usize) -> f64 {
        self.near(table, &Ends::gather(u, e, table.length_of(e)), e)
            .map_or(0.0, |profile| self.resistance[e].touching(&profile).length() * table.length_of(e))
    }
}

/// Part `g` of element `e`, pushed by `push` [N/m], and the place of the bed to which it holds on; `profiles` along the axes of the bed.
fn contact(profiles: &[[f64; 4]; 2], push: f64, (e, g): (usize, usize), holds: &Field) -> Contact {
    let hold = Vector2::new(holds.component(2 * g)[e], holds.component(2 * g + 1)[e]);
    let [x, y] = profiles.map(|profile| combined(&SHAPES3[g].value, &profile));
    Contact { place: Vector2::new(x, y), push, hold }
}

/// Push on the parts of an element that touches all along and is pushed by springs alone [N/m], given end values and slopes of its penetration.
fn grounded_parts(resistance: &Resistance, p: &[f64; 4]) -> [f64; 3] {
    std::array::from_fn(|g| resistance.stiffness * combined(&PART_WEIGHTS[g], p) / GAUSS3[g].weight)
}

/// Push on the parts of an element [N/m]; given its height above the bed, where it touches, and the rate of that height.
fn parts(resistance: &Resistance, profile: &Cubic, touching: &Intervals, rates: &Cubic) -> [f64; 3] {
    std::array::from_fn(|g| {
        let points = touching.iter().flat_map(|part| points_on(part, g));
        points.map(|point| point.weight * resistance.push(profile.at(point.x), rates.at(point.x))).sum::<f64>() / GAUSS3[g].weight
    })
}

/// Calls `at` for the four Gauss points of each part that touches, with the values of the shape functions there and its weight.
fn each_point(touching: &Intervals, mut at: impl FnMut(&[f64; 4], f64)) {
    for part in touching.iter() {
        let span = part.to - part.from;
        for (point, shape) in GAUSS4.iter().zip(&SHAPES4) {
            if span == 1.0 {
                at(&shape.value, point.weight);
            } else {
                at(&Shape::at(part.from + span * point.x).value, point.weight * span);
            }
        }
    }
}

/// Σ a_k b_k.
fn combined(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// products[k][l] += scale a_k b_l.
fn add_product(products: &mut [[f64; 4]; 4], scale: f64, a: &[f64; 4], b: &[f64; 4]) {
    for k in 0..4 {
        (0..4).for_each(|l| products[k][l] += scale * a[k] * b[l]);
    }
}
