//! A circular cylinder of a body in the water: buoyancy of what is wet, and Morison's forces along it and on its ends.
//!
//! ```text
//! F = ρ g Ω e_z + ∫ φ [ ½ρ D Cn |qn| qn + ½ρ πD Ct |qt| qt + ρA V̇ - ρA Can (a - V̇)n - ρA Cat (a - V̇)t ] ds
//!     + Σ_ends φ [ ½ρ A Ce |qt| qt - ρ ⅔πr³ Cae (a - V̇)t ]
//! ```
//!
//! Ω volume below the surface, by fibres along the axis, each cut by the surface plane, so that draught and waterplane are exact as long as the
//! surface cuts the mantle; φ wet share of a section; q = V - ṙ, V velocity and V̇ acceleration of the water, ρA V̇ Froude & Krylov's force.

use crate::algebra::triple::Triple;
use crate::rod::morison::{PointMotion, Sea, Water};
use crate::rod::stretch::Direction;
use crate::sea::clock::Clock;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// Rings of fibres, by the square of the radius as a share of that of the cylinder (Gauss), and their weights.
const RINGS: [(f64, f64); 3] = [(0.1127016653792583, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.8872983346207417, 5.0 / 18.0)];
/// Fibres of a ring.
const FIBRES: usize = 8;
/// Sections along the axis.
const SECTIONS: usize = 20;

/// What the water is around a body.
#[derive(Debug, Clone)]
pub struct Surround {
    /// Waves and current; none: still water.
    pub sea: Option<Sea>,
    /// Whether there is a surface; else water is everywhere.
    pub surface: bool,
    /// ρ [kg/m³].
    pub density: f64,
    /// g [m/s²].
    pub gravity: f64,
}

impl Surround {
    /// Velocity [m/s] and acceleration [m/s²] of the water at a place.
    pub fn water(&self, clock: Clock, place: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let Some(sea) = &self.sea else { return (Vector3::zeros(), Vector3::zeros()) };
        let zero = Triple::from(Vector3::zeros());
        let point: PointMotion<f64> = PointMotion {
            clock,
            direction: Direction::of(Triple::from(Vector3::x())),
            place: (*place).into(),
            velocity: zero,
            acceleration: zero,
        };
        let past = sea.past((), &point);
        (past.velocity.into(), past.acceleration.into())
    }

    /// Height of the surface at a place [m]; infinite without one.
    pub fn elevation(&self, clock: &Clock, place: &Vector3<f64>) -> f64 {
        match (&self.sea, self.surface) {
            (_, false) => f64::INFINITY,
            (Some(sea), true) => sea.elevation(clock, place),
            (None, true) => 0.0,
        }
    }
}

/// Motion of the body at an instant.
#[derive(Debug, Clone, Copy)]
pub struct BodyState {
    /// Position of the reference point [m].
    pub position: Vector3<f64>,
    /// Body axes to global ones.
    pub rotation: Matrix3<f64>,
    /// Velocity of the reference point [m/s].
    pub velocity: Vector3<f64>,
    /// Angular velocity [rad/s].
    pub omega: Vector3<f64>,
    /// Acceleration of the reference point [m/s²].
    pub acceleration: Vector3<f64>,
    /// Angular acceleration [rad/s²].
    pub alpha: Vector3<f64>,
}

impl BodyState {
    /// Velocity [m/s] and acceleration [m/s²] of a place at an arm from the reference point [m].
    pub fn at(&self, arm: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let swing = self.omega.cross(arm);
        (self.velocity + swing, self.acceleration + self.alpha.cross(arm) + self.omega.cross(&swing))
    }
}

/// A force [N] and its moment about the reference point [N·m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// Force [N].
    pub force: Vector3<f64>,
    /// Moment [N·m].
    pub moment: Vector3<f64>,
}

impl Load {
    /// None.
    pub fn zero() -> Load {
        Load { force: Vector3::zeros(), moment: Vector3::zeros() }
    }

    /// Adds a force at an arm.
    pub fn add(&mut self, force: Vector3<f64>, arm: &Vector3<f64>) {
        self.force += force;
        self.moment += arm.cross(&force);
    }
}

/// The cylinder, in body axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// Middle of an end [m].
    pub from: Vector3<f64>,
    /// Middle of the other [m].
    pub to: Vector3<f64>,
    /// D [m].
    pub diameter: f64,
    /// Cn, Ct, Ce.
    pub drag: [f64; 3],
    /// Can, Cat, Cae.
    pub added_mass: [f64; 3],
}

/// Share of a disc of radius one that lies below a height within it.
fn wet_share(height: f64) -> f64 {
    let h = height.clamp(-1.0, 1.0);
    (h.acos() - h * (1.0 - h * h).sqrt()) / PI
}

impl Cylinder {
    /// Volume [m³].
    pub fn volume(&self) -> f64 {
        0.25 * PI * self.diameter * self.diameter * (self.to - self.from).norm()
    }

    /// Force and moment of the water. `buoyant`: with the weight of the water displaced at rest.
    pub fn load(&self, around: &Surround, clock: Clock, body: &BodyState, buoyant: bool) -> Load {
        let mut load = Load::zero();
        let (arm, span) = (body.rotation * self.from, body.rotation * (self.to - self.from));
        let length = span.norm();
        let (axis, radius) = (span / length, 0.5 * self.diameter);
        let place = |arm: &Vector3<f64>| body.position + arm;
        let (lower, upper) = (place(&arm), place(&(arm + span)));
        // The surface as a plane about where it cuts the axis.
        let middle = {
            let (a, b) = (lower.z - around.elevation(&clock, &lower), upper.z - around.elevation(&clock, &upper));
            let share = if around.surface && a != b { (a / (a - b)).clamp(0.0, 1.0) } else { 0.5 };
            lower + span * share
        };
        let level = around.elevation(&clock, &middle);
        let slope = if around.sea.as_ref().is_some_and(|_| around.surface) {
            let d = radius.max(0.1);
            let rise = |by: Vector3<f64>| {
                (around.elevation(&clock, &(middle + by)) - around.elevation(&clock, &(middle - by))) / (2.0 * d)
            };
            [rise(Vector3::x() * d), rise(Vector3::y() * d)]
        } else {
            [0.0; 2]
        };
        let height = |at: &Vector3<f64>| {
            if around.surface {
                at.z - level - slope[0] * (at.x - middle.x) - slope[1] * (at.y - middle.y)
            } else {
                f64::NEG_INFINITY
            }
        };
        let steepest = radius * (1.0 - axis.z * axis.z).max(0.0).sqrt();
        let ds = length / SECTIONS as f64;
        let share = |height: f64, reach: f64| wet_share(height / reach.max(1.0e-9 * length));
        if share(height(&lower).min(height(&upper)), steepest + 1e-12) == 0.0 && height(&lower).min(height(&upper)) > steepest {
            return load;
        }
        if buoyant {
            self.buoyancy(around, &mut load, &arm, &span, &height, body);
        }
        let (rho, area) = (around.density, PI * radius * radius);
        let section = |s: f64, load: &mut Load| {
            let arm = arm + axis * s;
            let at = place(&arm);
            let wet = share(height(&at), steepest + 0.5 * ds * axis.z.abs());
            if wet == 0.0 {
                return;
            }
            let (velocity, acceleration) = body.at(&arm);
            let (flow, swell) = around.water(clock, &at);
            let (q, a) = (flow - velocity, acceleration - swell);
            let (qt, at) = (q.dot(&axis), a.dot(&axis));
            let (qn, an) = (q - axis * qt, a - axis * at);
            let [cn, ct, _] = self.drag;
            let [can, cat, _] = self.added_mass;
            let drag =
                qn * (0.5 * rho * self.diameter * cn * qn.norm()) + axis * (0.5 * rho * PI * self.diameter * ct * qt.abs() * qt);
            let inertia = swell - an * can - axis * (cat * at);
            load.add((drag + inertia * (rho * area)) * (wet * ds), &arm);
        };
        (0..SECTIONS).for_each(|k| section((k as f64 + 0.5) * ds, &mut load));
        let [_, _, ce] = self.drag;
        let [_, _, cae] = self.added_mass;
        if ce > 0.0 || cae > 0.0 {
            for arm in [arm, arm + span] {
                let at = place(&arm);
                let wet = share(height(&at), steepest + 0.5 * ds * axis.z.abs());
                let (velocity, acceleration) = body.at(&arm);
                let (flow, swell) = around.water(clock, &at);
                let (q, a) = ((flow - velocity).dot(&axis), (acceleration - swell).dot(&axis));
                let along = 0.5 * rho * area * ce * q.abs() * q - rho * (2.0 / 3.0 * PI * radius.powi(3)) * cae * a;
                load.add(axis * (along * wet), &arm);
            }
        }
        load
    }

    /// Buoyancy of the fibres below the surface.
    fn buoyancy(
        &self,
        around: &Surround,
        load: &mut Load,
        arm: &Vector3<f64>,
        span: &Vector3<f64>,
        height: &dyn Fn(&Vector3<f64>) -> f64,
        body: &BodyState,
    ) {
        let (length, radius) = (span.norm(), 0.5 * self.diameter);
        let axis = span / length;
        let aside = if axis.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
        let first = axis.cross(&aside).normalize();
        let second = axis.cross(&first);
        let weight = around.density * around.gravity * PI * radius * radius;
        for (square, share) in RINGS {
            for k in 0..FIBRES {
                let (sin, cos) = (TAU * (k as f64 + 0.5) / FIBRES as f64).sin_cos();
                let from = arm + (first * cos + second * sin) * (radius * square.sqrt());
                let (a, b) = (height(&(body.position + from)), height(&(body.position + from + span)));
                let (begin, end) = match (a < 0.0, b < 0.0) {
                    (true, true) => (0.0, 1.0),
                    (false, false) => continue,
                    (true, false) => (0.0, a / (a - b)),
                    (false, true) => (a / (a - b), 1.0),
                };
                let wet = (end - begin) * length;
                let middle = from + span * (0.5 * (begin + end));
                load.add(Vector3::z() * (weight * share / FIBRES as f64 * wet), &middle);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn still() -> Surround {
        Surround { sea: None, surface: true, density: 1025.0, gravity: 9.81 }
    }

    fn at_rest(position: Vector3<f64>, rotation: Matrix3<f64>) -> BodyState {
        let zero = Vector3::zeros();
        BodyState { position, rotation, velocity: zero, omega: zero, acceleration: zero, alpha: zero }
    }

    fn spar() -> Cylinder {
        Cylinder {
            from: Vector3::new(0.0, 0.0, -20.0),
            to: Vector3::new(0.0, 0.0, 5.0),
            diameter: 6.0,
            drag: [0.0; 3],
            added_mass: [0.0; 3],
        }
    }

    /// Draught, and the righting moment of a heeled cylinder whose mantle the surface cuts: volume πr²L with L the wet length of the axis, its
    /// centre off the axis by r² tan β/(4L) and at L/2 + r² tan² β/(8L) from the end. Exact to rounding.
    #[test]
    fn what_is_wet_is_that_of_the_cut_cylinder() {
        let (cylinder, around) = (spar(), still());
        let area = PI * 9.0;
        let upright = cylinder.load(&around, Clock::at_rest(0.0), &at_rest(Vector3::zeros(), Matrix3::identity()), true);
        assert!((upright.force.z / (1025.0 * 9.81 * area * 20.0) - 1.0).abs() < 1e-12);
        for beta in [1e-3, 0.1, 0.4] {
            let rotation = crate::algebra::rotation::exp(&(Vector3::y() * beta));
            let load = cylinder.load(&around, Clock::at_rest(0.0), &at_rest(Vector3::zeros(), rotation), true);
            let wet = 20.0 / beta.cos() * beta.cos();
            // The reference point is on the surface, so the axis is wet to there: 20 m.
            let (tan, force) = (beta.tan(), 1025.0 * 9.81 * area * wet);
            let (off, up) = (9.0 * tan / (4.0 * wet), wet / 2.0 + 9.0 * tan * tan / (8.0 * wet));
            assert!((load.force.z / force - 1.0).abs() < 1e-12, "{beta}");
            // The wet side is the one that the top leans to: in body axes the centre is at x = off, z = -20 + up.
            let centre = rotation * Vector3::new(off, 0.0, up - 20.0);
            assert!((load.moment.y / (-centre.x * force) - 1.0).abs() < 1e-9, "{beta}: {} {}", load.moment.y, -centre.x * force);
        }
    }

    /// A cylinder lying half under water displaces half its volume (fibres: 2 %), all under all of it.
    #[test]
    fn a_lying_cylinder_floats_half_under() {
        let lying = Cylinder { from: Vector3::x() * -5.0, to: Vector3::x() * 5.0, ..spar() };
        let force =
            |z: f64| lying.load(&still(), Clock::at_rest(0.0), &at_rest(Vector3::z() * z, Matrix3::identity()), true).force.z;
        let whole = 1025.0 * 9.81 * PI * 90.0;
        assert!((force(0.0) / whole - 0.5).abs() < 0.02 && (force(-4.0) / whole - 1.0).abs() < 1e-12 && force(4.0) == 0.0);
    }
}
