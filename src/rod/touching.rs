//! Loads that act on a part of an element only: the bed where it touches, the surface where it is dry.
//!
//! These few elements leave the fast loop untouched: their share is added (bed) or taken off again (dry part) afterwards.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::polynomial::{Cubic, Interval};
use crate::algebra::shape::{GAUSS3, GAUSS4, GaussPoint, Shape};
use crate::rod::element::{self, Ends, Motion, PointTangent, Table, Weights};
use crate::rod::mesh::Mesh;
use crate::rod::morison::{self, PointMotion, Water};
use crate::rod::seabed::{Plane, Resistance, projector};
use crate::rod::state::Field;
use crate::rod::surface;
use nalgebra::{Matrix3, Vector3};

/// The bed under a line: its plane and its resistance against each element.
#[derive(Debug, Clone)]
pub struct Ground {
    /// The plane.
    pub plane: Plane,
    /// One resistance per element.
    pub resistance: Vec<Resistance>,
}

/// Adds `force`(point) over an interval of element `e`: R_k += Σ w N_k f, points and weights of a rule on [0, 1].
fn integrate(
    rule: &[GaussPoint],
    part: Interval,
    length: f64,
    mut force: impl FnMut(&Shape) -> Vector3<f64>,
    sum: &mut [Vector3<f64>; 4],
) {
    for point in rule {
        let shape = Shape::at(part.from + (part.to - part.from) * point.x);
        let f = force(&shape) * (point.weight * (part.to - part.from) * length);
        for k in 0..4 {
            sum[k] += f * shape.value[k];
        }
    }
}

impl Ground {
    fn profile(&self, ends: &Ends<f64>) -> Cubic {
        let [r0, l0, r1, l1] = ends.parts();
        self.plane.profile(r0, l0, r1, l1)
    }

    /// The element and its height above the bed, unless it is certainly clear of it.
    fn near(&self, table: &Table, u: &Field, e: usize) -> Option<(Ends<f64>, Cubic)> {
        let ends = Ends::gather(u, e, table.length_of(e));
        let profile = self.profile(&ends);
        (!profile.above(self.resistance[e].onset) && !table.is_joint(e)).then_some((ends, profile))
    }

    /// What the push of the bed adds to the forces on the ends of element `e`, if it is near.
    pub fn forces(&self, table: &Table, at: &Motion, e: usize) -> Option<[Vector3<f64>; 4]> {
        let (u, profile) = self.near(table, at.u, e)?;
        let length = table.length_of(e);
        let v = Ends::gather(at.v, e, length);
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        let mut sum = [Vector3::zeros(); 4];
        for part in resistance.touching(&profile).iter() {
            let push = |shape: &Shape| {
                let rate = normal.dot(&v.combine(&shape.value));
                normal * -resistance.push(self.plane.height(&u.combine(&shape.value)), rate)
            };
            integrate(&GAUSS4, part, length, push, &mut sum);
        }
        Some(sum)
    }

    /// Adds the tangent of the push on element `e` to the matrix.
    pub fn tangent(&self, table: &Table, at: &Motion, e: usize, weights: &Weights, matrix: &mut BlockTridiagonal<6>) {
        let Some((u, profile)) = self.near(table, at.u, e) else { return };
        let length = table.length_of(e);
        let v = Ends::gather(at.v, e, length);
        let (resistance, normal) = (&self.resistance[e], &self.plane.normal);
        for part in resistance.touching(&profile).iter() {
            for point in &GAUSS4 {
                let shape = Shape::at(part.from + (part.to - part.from) * point.x);
                let rate = normal.dot(&v.combine(&shape.value));
                let (by_position, by_rate) = resistance.tangent(self.plane.height(&u.combine(&shape.value)), rate);
                let load = projector(normal) * -(by_position * weights.u + by_rate * weights.v);
                let scale = point.weight * (part.to - part.from) * length;
                element::scatter(matrix, e, &shape.scaled(length), scale, &PointTangent::of_load(load, Matrix3::zeros()));
            }
        }
    }

    /// Unstretched length of element `e` in contact [m].
    pub fn touching_length(&self, table: &Table, u: &Field, e: usize) -> f64 {
        self.near(table, u, e).map_or(0.0, |(_, profile)| self.resistance[e].touching(&profile).length() * table.length_of(e))
    }
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

    fn lifted(&self, table: &Table, u: &Field, e: usize) -> Option<(Ends<f64>, Cubic)> {
        let ends = Ends::gather(u, e, table.length_of(e));
        let [r0, l0, r1, l1] = ends.parts();
        let height = Cubic::hermite(r0.z, l0.z, r1.z, l1.z);
        (!height.below(-0.5 * self.diameter[e]) && !table.is_joint(e)).then_some((ends, height))
    }

    /// What the missing force of the water on the dry share of element `e` adds to the forces on its ends, if it is lifted.
    pub fn forces<W: Water>(&self, table: &Table, water: &W, at: &Motion, e: usize) -> Option<[Vector3<f64>; 4]> {
        let (u, height) = self.lifted(table, at.u, e)?;
        let length = table.length_of(e);
        let (v, a) = (Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
        let coefficients = table.coefficients::<f64>(e);
        let mut sum = [Vector3::zeros(); 4];
        for part in surface::dry_parts(&height, self.diameter[e]) {
            let wet_force = |shape: &Shape| {
                let point = point_motion(&u, &v, &a, length, shape);
                let mut f = Vector3::new(0.0, 0.0, self.buoyancy[e]);
                if W::PRESENT {
                    f += morison::force(water, &coefficients, &point);
                }
                f * surface::dry_fraction(point.height, self.diameter[e]).0
            };
            integrate(&GAUSS3, part, length, wet_force, &mut sum);
        }
        Some(sum)
    }

    /// Takes the tangent of the dry share off the matrix.
    pub fn tangent<W: Water>(
        &self,
        table: &Table,
        water: &W,
        at: &Motion,
        e: usize,
        weights: &Weights,
        matrix: &mut BlockTridiagonal<6>,
    ) {
        let Some((u, height)) = self.lifted(table, at.u, e) else { return };
        let length = table.length_of(e);
        let (v, a) = (Ends::gather(at.v, e, length), Ends::gather(at.a, e, length));
        let coefficients = table.coefficients::<f64>(e);
        for part in surface::dry_parts(&height, self.diameter[e]) {
            for gauss in &GAUSS3 {
                let shape = Shape::at(part.from + (part.to - part.from) * gauss.x);
                let point = point_motion(&u, &v, &a, length, &shape);
                let (dry, by_height) = surface::dry_fraction(point.height, self.diameter[e]);
                let mut f = Vector3::new(0.0, 0.0, self.buoyancy[e]);
                let mut tangent = PointTangent::of_load(Matrix3::zeros(), Matrix3::zeros());
                if W::PRESENT {
                    f += morison::force(water, &coefficients, &point);
                    let (load, turning) = element::water_tangent(water, &coefficients, &point, weights);
                    tangent.load = load * dry;
                    tangent.turning = turning * dry;
                }
                tangent.load += f * Vector3::z().transpose() * (by_height * weights.u);
                let scale = gauss.weight * (part.to - part.from) * length;
                element::scatter(matrix, e, &shape.scaled(length), scale, &tangent);
            }
        }
    }
}

fn point_motion(u: &Ends<f64>, v: &Ends<f64>, a: &Ends<f64>, length: f64, shape: &Shape) -> PointMotion<f64> {
    PointMotion {
        slope: u.combine(&shape.slope) / length,
        height: u.combine_z(&shape.value),
        velocity: v.combine(&shape.value),
        acceleration: a.combine(&shape.value),
    }
}
