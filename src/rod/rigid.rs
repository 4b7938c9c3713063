//! A free rigid body: inertia, weight, the water on it, and what its matrices say.
//!
//! ```text
//! F = m r̈_G - f,   M = I_G α + ω × I_G ω + c × m r̈_G - m_f,   r̈_G = A + α × c + ω × (ω × c)
//! ```
//!
//! F, M force and moment about the reference point to be applied from outside; f, m_f what acts on it: weight, buoyancy, cylinders, the 6×6
//! matrices -A₆ a - D₆ v in body axes and -K₆ (x, ϑ) along global ones, the bed, constant forces. c centre of mass from the reference point.
//!
//! The six unknowns of its node are position X and rotation vector ϑ, R = exp(ϑ) R₀ with R₀ the rotation at the start of the step; the residual
//! of ϑ is Jᵀ M.

use crate::algebra::rotation;
use crate::rod::cylinder::{BodyState, Cylinder, Load, Surround};
use crate::rod::motion::{Motion, Weights};
use crate::rod::seabed::Plane;
use crate::scene::bodies;
use crate::scene::load_file::LoadTable;
use crate::scene::types::Environment;
use crate::sea::clock::Clock;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use std::sync::Arc;

/// The body.
#[derive(Debug, Clone)]
pub struct Rigid {
    /// Its node.
    pub node: usize,
    /// Number among the frames of a state.
    pub frame: usize,
    /// m [kg].
    pub mass: f64,
    /// Centre of mass in body axes [m].
    pub centre: Vector3<f64>,
    /// I_G in body axes [kg·m²].
    pub inertia: Matrix3<f64>,
    /// Force applied by the master [N].
    pub applied: Load,
    /// Force and moment over time, where a file gives them.
    pub in_time: Option<Arc<LoadTable>>,
    cylinders: Vec<Cylinder>,
    around: Surround,
    volume: f64,
    centre_of_buoyancy: Vector3<f64>,
    added_mass: Option<Matrix6<f64>>,
    damping: Option<Matrix6<f64>>,
    quadratic: Option<Vector6<f64>>,
    stiffness: Option<Matrix6<f64>>,
    /// Pose from which the stiffness counts.
    pose: (Vector3<f64>, Matrix3<f64>),
    constant: Load,
    bed: Option<Bed>,
}

/// The bed under a body.
#[derive(Debug, Clone)]
struct Bed {
    plane: Plane,
    /// Places that may touch it, and how far below them the body reaches [m].
    places: Vec<(Vector3<f64>, f64)>,
    stiffness: f64,
    damping: f64,
}

/// Penetration of the bed under the weight of a body [m].
const PENETRATION: f64 = 0.05;
/// Step of the differences of the tangent, in what moves.
const DIFFERENCE: f64 = 1.0e-6;

impl Rigid {
    /// The body of a scene at a node.
    pub fn new(body: &bodies::Body, environment: &Environment, around: Surround, node: usize, frame: usize) -> Rigid {
        let (mut mass, mut first) = (body.mass, Vector3::from(body.centre_of_mass) * body.mass);
        let parts = |cylinder: &bodies::Cylinder| (Vector3::from(cylinder.from), Vector3::from(cylinder.to));
        for cylinder in &body.cylinders {
            let (from, to) = parts(cylinder);
            mass += cylinder.mass;
            first += (from + to) * (0.5 * cylinder.mass);
        }
        let centre = if mass > 0.0 { first / mass } else { Vector3::zeros() };
        let displaced = |mass: f64, by: Vector3<f64>| (Matrix3::identity() * by.dot(&by) - by * by.transpose()) * mass;
        let mut inertia = body.inertia.as_ref().map_or(Matrix3::zeros(), bodies::Inertia::matrix);
        inertia += displaced(body.mass, Vector3::from(body.centre_of_mass) - centre);
        for cylinder in &body.cylinders {
            let (from, to) = parts(cylinder);
            let (axis, length, radius) = ((to - from).normalize(), (to - from).norm(), 0.5 * cylinder.diameter);
            let along = 0.5 * radius * radius;
            let across = 0.25 * radius * radius + length * length / 12.0;
            inertia += (Matrix3::identity() * across + axis * axis.transpose() * (along - across)) * cylinder.mass;
            inertia += displaced(cylinder.mass, (from + to) * 0.5 - centre);
        }
        let matrix = |m: &bodies::Matrix| Matrix6::from_fn(|row, column| m[row][column]);
        let reach: Vec<(Vector3<f64>, f64)> = if body.cylinders.is_empty() {
            vec![(Vector3::zeros(), 0.0)]
        } else {
            body.cylinders.iter().flat_map(|c| [(c.from.into(), 0.5 * c.diameter), (c.to.into(), 0.5 * c.diameter)]).collect()
        };
        let weight = mass * environment.gravity;
        let stiffness = weight / PENETRATION;
        let bed = Bed { plane: Plane::of(environment), places: reach, stiffness, damping: (stiffness * mass).sqrt() };
        let of = |c: &bodies::Cylinder| Cylinder {
            from: c.from.into(),
            to: c.to.into(),
            diameter: c.diameter,
            drag: [c.drag.normal, c.drag.tangential, c.drag.end],
            added_mass: [c.added_mass.normal, c.added_mass.tangential, c.added_mass.end],
        };
        Rigid {
            node,
            frame,
            mass,
            centre,
            inertia,
            applied: Load::zero(),
            in_time: None,
            cylinders: body.cylinders.iter().map(of).collect(),
            around,
            volume: body.volume,
            centre_of_buoyancy: body.centre_of_buoyancy.into(),
            added_mass: body.added_mass.as_ref().map(matrix),
            damping: body.damping.as_ref().map(matrix),
            quadratic: body.quadratic_damping.map(Vector6::from),
            stiffness: body.stiffness.as_ref().map(matrix),
            pose: (body.position.into(), rotation::of_angles(&body.attitude())),
            constant: Load { force: body.force.into(), moment: body.moment.into() },
            bed: (weight > 0.0).then_some(bed),
        }
    }

    /// Motion of the body in a state.
    pub fn motion(&self, at: &Motion) -> BodyState {
        let frame = at.frames.get(self.frame).copied().unwrap_or_else(Matrix3::identity);
        let node = self.node;
        let (theta, rate, second) = (at.u.slope(node), at.v.slope(node), at.a.slope(node));
        let jacobian = rotation::jacobian(&theta);
        BodyState {
            position: at.u.position(node),
            rotation: rotation::exp(&theta) * frame,
            velocity: at.v.position(node),
            omega: jacobian * rate,
            acceleration: at.a.position(node),
            alpha: jacobian * second + rotation::bending(&theta, &rate),
        }
    }

    /// What acts on the body besides lines, at a motion.
    pub fn acting(&self, clock: Clock, body: &BodyState) -> Load {
        let mut load =
            Load { force: self.constant.force + self.applied.force, moment: self.constant.moment + self.applied.moment };
        if let Some(table) = &self.in_time {
            let [force, moment] = table.at(clock.now);
            load.force += force;
            load.moment += moment;
        }
        let g = self.around.gravity;
        let hydrostatic = self.stiffness.is_none();
        if hydrostatic {
            load.add(Vector3::z() * (-self.mass * g), &(body.rotation * self.centre));
            if self.volume > 0.0 {
                load.add(Vector3::z() * (self.around.density * g * self.volume), &(body.rotation * self.centre_of_buoyancy));
            }
        }
        for cylinder in &self.cylinders {
            let of_water = cylinder.load(&self.around, clock, body, hydrostatic);
            load.force += of_water.force;
            load.moment += of_water.moment;
        }
        if let Some(stiffness) = &self.stiffness {
            let turn = rotation_vector(&(body.rotation * self.pose.1.transpose()));
            add_six(&mut load, &(stiffness * six(&(body.position - self.pose.0), &turn)), None, -1.0);
        }
        let to_body =
            |force: &Vector3<f64>, moment: &Vector3<f64>| six(&body.rotation.tr_mul(force), &body.rotation.tr_mul(moment));
        if let Some(added) = &self.added_mass {
            add_six(&mut load, &(added * to_body(&body.acceleration, &body.alpha)), Some(&body.rotation), -1.0);
        }
        let velocity = to_body(&body.velocity, &body.omega);
        if let Some(damping) = &self.damping {
            add_six(&mut load, &(damping * velocity), Some(&body.rotation), -1.0);
        }
        if let Some(quadratic) = &self.quadratic {
            let drag = quadratic.zip_map(&velocity, |d, v| d * v.abs() * v);
            add_six(&mut load, &drag, Some(&body.rotation), -1.0);
        }
        if let Some(bed) = &self.bed {
            bed.push(&mut load, body);
        }
        load
    }

    /// Residual of X and ϑ.
    pub fn residual(&self, at: &Motion) -> [Vector3<f64>; 2] {
        let body = self.motion(at);
        let acting = self.acting(at.clock, &body);
        let c = body.rotation * self.centre;
        let inertia = body.rotation * self.inertia * body.rotation.transpose();
        let (_, of_centre) = body.at(&c);
        let force = of_centre * self.mass;
        let moment = inertia * body.alpha + body.omega.cross(&(inertia * body.omega)) + c.cross(&force) - acting.moment;
        let jacobian = rotation::jacobian(&at.u.slope(self.node));
        [force - acting.force, jacobian.tr_mul(&moment)]
    }

    /// c_u ∂R/∂u + c_v ∂R/∂v + c_a ∂R/∂a of X and ϑ, by central differences along each of the six unknowns.
    pub fn tangent(&self, at: &Motion, weights: &Weights) -> Matrix6<f64> {
        let mut sum = Matrix6::zeros();
        let (mut u, mut v, mut a) = (one_node(at.u, self.node), one_node(at.v, self.node), one_node(at.a, self.node));
        let alone = Rigid { node: 0, ..self.clone() };
        let size = weights.u.abs().max(weights.v.abs()).max(weights.a.abs()).max(f64::MIN_POSITIVE);
        let step = DIFFERENCE / size;
        for column in 0..6 {
            let mut moved = |by: f64| {
                for (field, weight) in [(&mut u, weights.u), (&mut v, weights.v), (&mut a, weights.a)] {
                    field.component_mut(column)[0] += weight * by;
                }
                let at = Motion { clock: at.clock, u: &u, v: &v, a: &a, holds: at.holds, frames: at.frames, asking: at.asking };
                let [force, moment] = alone.residual(&at);
                for (field, weight) in [(&mut u, weights.u), (&mut v, weights.v), (&mut a, weights.a)] {
                    field.component_mut(column)[0] -= weight * by;
                }
                six(&force, &moment)
            };
            let difference = (moved(step) - moved(-step)) * (0.5 / step);
            sum.set_column(column, &difference);
        }
        sum
    }

    /// Inertia of X and ϑ with the added mass of its matrix; that of cylinders as if all wet.
    pub fn inertia(&self, at: &Motion) -> Matrix6<f64> {
        let body = self.motion(at);
        let mut sum = Matrix6::zeros();
        let c = rotation::cross(&(body.rotation * self.centre));
        let inertia = body.rotation * self.inertia * body.rotation.transpose();
        sum.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * self.mass));
        sum.fixed_view_mut::<3, 3>(0, 3).copy_from(&(c * -self.mass));
        sum.fixed_view_mut::<3, 3>(3, 0).copy_from(&(c * self.mass));
        sum.fixed_view_mut::<3, 3>(3, 3).copy_from(&(inertia - c * c * self.mass));
        if let Some(added) = &self.added_mass {
            let mut turn = Matrix6::zeros();
            turn.fixed_view_mut::<3, 3>(0, 0).copy_from(&body.rotation);
            turn.fixed_view_mut::<3, 3>(3, 3).copy_from(&body.rotation);
            sum += turn * added * turn.transpose();
        }
        sum
    }

    /// Weight, for comparison [N].
    pub fn weight(&self) -> f64 {
        self.mass * self.around.gravity
    }

    /// A length of the body: how far what it is made of reaches from its reference point, or its radius of gyration [m].
    pub fn reach(&self) -> f64 {
        let ends = self.cylinders.iter().flat_map(|c| [c.from.norm(), c.to.norm()]);
        let gyration = if self.mass > 0.0 { (self.inertia.trace() / (2.0 * self.mass)).sqrt() } else { 0.0 };
        ends.fold(gyration.max(1.0e-3), f64::max)
    }
}

impl Bed {
    fn push(&self, load: &mut Load, body: &BodyState) {
        for (place, below) in &self.places {
            let arm = body.rotation * place;
            let height = self.plane.height(&(body.position + arm)) - below;
            if height < 0.0 {
                let (velocity, _) = body.at(&arm);
                let share = 1.0 / self.places.len() as f64;
                // Damping grows with the penetration, so that nothing jumps.
                let damping = self.damping * (-height / PENETRATION).min(1.0);
                let push = (-self.stiffness * height - damping * self.plane.normal.dot(&velocity)) * share;
                load.add(self.plane.normal * push.max(0.0), &arm);
            }
        }
    }
}

fn one_node(field: &crate::rod::state::Field, node: usize) -> crate::rod::state::Field {
    let mut one = crate::rod::state::Field::new(1);
    one.set_position(0, &field.position(node));
    one.set_slope(0, &field.slope(node));
    one
}

fn six(first: &Vector3<f64>, second: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
}

fn add_six(load: &mut Load, six: &Vector6<f64>, turned: Option<&Matrix3<f64>>, factor: f64) {
    let (force, moment): (Vector3<f64>, Vector3<f64>) = (six.fixed_rows::<3>(0).into(), six.fixed_rows::<3>(3).into());
    let turn = |x: Vector3<f64>| turned.map_or(x, |r| r * x);
    load.force += turn(force) * factor;
    load.moment += turn(moment) * factor;
}

/// ϑ of exp(ϑ), up to half a turn.
pub fn rotation_vector(r: &Matrix3<f64>) -> Vector3<f64> {
    let skew = Vector3::new(r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]) * 0.5;
    let (sin, cos) = (skew.norm(), 0.5 * (r.trace() - 1.0));
    if sin < 1.0e-9 { skew } else { skew * (sin.atan2(cos) / sin) }
}
