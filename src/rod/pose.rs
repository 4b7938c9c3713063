//! Paths of a body: pose, velocity and acceleration at any time, and of any place of it.
//!
//! ```text
//! r = X + R a,   ṙ = V + ω × R a,   r̈ = A + α × R a + ω × (ω × R a)
//! ```

use crate::algebra::rotation::Attitude;
use crate::algebra::sinusoid::Sinusoid;
use crate::algebra::spline;
use crate::scene::pose_file::PoseTable;
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// Motion of a point: position [m], velocity [m/s] and acceleration [m/s²].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
}

impl Kinematics {
    /// At rest at a point.
    pub fn at_rest(position: Vector3<f64>) -> Kinematics {
        Kinematics { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
    }
}

/// Motion of a body in global axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMotion {
    /// Of the reference point.
    pub reference: Kinematics,
    /// R: body axes to global ones.
    pub rotation: Matrix3<f64>,
    /// ω [rad/s].
    pub omega: Vector3<f64>,
    /// α [rad/s²].
    pub alpha: Vector3<f64>,
}

impl BodyMotion {
    /// From roll, pitch and yaw [rad], their rates and second rates.
    pub fn of_angles(reference: Kinematics, angles: [Vector3<f64>; 3]) -> BodyMotion {
        let [q, rate, second] = angles;
        let attitude = Attitude::of(&q);
        if rate == Vector3::zeros() && second == rate {
            return BodyMotion { reference, rotation: attitude.rotation(), omega: rate, alpha: rate };
        }
        let turning = attitude.rates_to_omega();
        BodyMotion {
            reference,
            rotation: attitude.rotation(),
            omega: turning * rate,
            alpha: turning * second + attitude.turning(&rate),
        }
    }

    /// Motion of a place of the body, given in its axes [m].
    pub fn place(&self, at: &Vector3<f64>) -> Kinematics {
        let arm = self.rotation * at;
        let swing = self.omega.cross(&arm);
        Kinematics {
            position: self.reference.position + arm,
            velocity: self.reference.velocity + swing,
            acceleration: self.reference.acceleration + self.alpha.cross(&arm) + self.omega.cross(&swing),
        }
    }
}

/// The motion of a body in time.
#[derive(Debug, Clone)]
pub enum PosePath {
    /// At rest.
    Fixed {
        /// Position of the reference point [m].
        position: Vector3<f64>,
        /// Roll, pitch and yaw [rad].
        angles: Vector3<f64>,
    },
    /// Sinusoidal motions of position and angles about a pose, of one period and eased in together.
    Sinusoidal {
        /// Position [m] and angles [rad] of the pose.
        about: [Vector3<f64>; 2],
        /// Offsets from them [m], [rad].
        offsets: [Sinusoid; 2],
    },
    /// A spline through poses, at rest outside them.
    Table(Arc<PoseTable>),
    /// Polynomials of position and angles in tau = t - start.
    Polynomial {
        /// Time of tau = 0 [s].
        start: f64,
        /// Coefficients of tau⁰, tau¹, … of the position [m].
        position: Vec<Vector3<f64>>,
        /// The same of the angles [rad].
        angles: Vec<Vector3<f64>>,
    },
    /// Another path and a share of a change of it.
    Moved {
        /// The path.
        of: Arc<PosePath>,
        /// The change.
        by: Arc<PosePath>,
        /// Its share.
        share: f64,
    },
    /// A small change of another path, per unit of what changes: its motion is that of the places, to first order.
    Variation {
        /// The path that is changed.
        of: Arc<PosePath>,
        /// Change of position and angles in time.
        by: Arc<PosePath>,
    },
}

/// Share of a variation by which places are moved to and fro to differentiate them.
const SHARE: f64 = 1.0e-4;

impl PosePath {
    /// Value and rates of position and angles at a time.
    fn coordinates(&self, time: f64) -> [[Vector3<f64>; 3]; 2] {
        let zero = Vector3::zeros();
        match self {
            PosePath::Fixed { position, angles } => [[*position, zero, zero], [*angles, zero, zero]],
            PosePath::Sinusoidal { about, offsets } => {
                let phase = offsets[0].phase(time);
                [0, 1].map(|part: usize| {
                    if offsets[part].is_still() {
                        return [about[part], zero, zero];
                    }
                    let [x, v, a] = offsets[part].at_phase(&phase);
                    [about[part] + x, v, a]
                })
            }
            PosePath::Table(table) => of_table(table, time),
            PosePath::Polynomial { start, position, angles } => [position, angles].map(|terms| polynomial(terms, time - start)),
            PosePath::Variation { by, .. } => by.coordinates(time),
            PosePath::Moved { of, by, share } => {
                let (base, change) = (of.coordinates(time), by.coordinates(time));
                [0, 1].map(|part: usize| [0, 1, 2].map(|order: usize| base[part][order] + change[part][order] * *share))
            }
        }
    }

    /// Motion of the body at a time.
    pub fn at(&self, time: f64) -> BodyMotion {
        let [x, q] = self.coordinates(time);
        BodyMotion::of_angles(Kinematics { position: x[0], velocity: x[1], acceleration: x[2] }, q)
    }

    /// R at a time: body axes to global ones.
    pub fn rotation(&self, time: f64) -> Matrix3<f64> {
        Attitude::of(&self.coordinates(time)[1][0]).rotation()
    }

    /// Position [m] and roll, pitch and yaw [rad] at a time.
    pub fn pose(&self, time: f64) -> [Vector3<f64>; 2] {
        self.coordinates(time).map(|[value, ..]| value)
    }

    /// Motion of a place of the body, given in its axes, at a time; of a variation, its change.
    pub fn place(&self, at: &Vector3<f64>, time: f64) -> Kinematics {
        let PosePath::Variation { of, by } = self else { return self.at(time).place(at) };
        let (base, change) = (of.coordinates(time), by.coordinates(time));
        let moved = |share: f64| {
            let [x, q] = [0, 1].map(|part: usize| [0, 1, 2].map(|order: usize| base[part][order] + change[part][order] * share));
            BodyMotion::of_angles(Kinematics { position: x[0], velocity: x[1], acceleration: x[2] }, q).place(at)
        };
        let (after, before) = (moved(SHARE), moved(-SHARE));
        let per = 0.5 / SHARE;
        Kinematics {
            position: (after.position - before.position) * per,
            velocity: (after.velocity - before.velocity) * per,
            acceleration: (after.acceleration - before.acceleration) * per,
        }
    }

    /// Whether the body stays in its pose from one time to another, up to `slight` [m] of the reference point and of places an `arm` [m] away.
    pub fn rests(&self, from: f64, until: f64, arm: f64, slight: f64) -> bool {
        match self {
            PosePath::Fixed { .. } => true,
            PosePath::Sinusoidal { offsets, .. } => offsets.iter().all(Sinusoid::is_still),
            PosePath::Table(table) => {
                let (first, last) = (table.times.first().copied().unwrap_or(0.0), table.times.last().copied().unwrap_or(0.0));
                let constant = |values: &Vec<f64>| values.windows(2).all(|pair| pair[0] == pair[1]);
                until <= first || from >= last || table.values.iter().all(constant)
            }
            PosePath::Polynomial { start, position, angles } => {
                let span = (from - start).abs().max((until - start).abs());
                let way = |terms: &[Vector3<f64>]| {
                    terms.iter().enumerate().skip(1).map(|(power, c)| c.norm() * span.powi(power as i32)).sum::<f64>()
                };
                way(position) + arm * way(angles) <= slight
            }
            PosePath::Variation { .. } | PosePath::Moved { .. } => false,
        }
    }

    /// Whether a place of the body keeps its y exactly: the body moves in the x–z plane alone, without roll and yaw.
    pub fn stays_at(&self, at: &Vector3<f64>, y: f64, from: f64, until: f64) -> bool {
        let upright = |angles: &Vector3<f64>| angles.x == 0.0 && angles.z == 0.0;
        match self {
            PosePath::Fixed { .. } => self.place(at, from).position.y == y,
            PosePath::Sinusoidal { about, offsets } => {
                let [position, angles] = offsets;
                let across = position.sine.y == 0.0 && position.cosine.y == 0.0;
                across && upright(&about[1]) && upright(&angles.sine) && upright(&angles.cosine) && about[0].y + at.y == y
            }
            PosePath::Table(_) => self.rests(from, until, at.norm(), 0.0) && self.place(at, from).position.y == y,
            PosePath::Polynomial { position, angles, .. } => {
                position.first().map_or(0.0, |c| c.y) + at.y == y
                    && position.iter().skip(1).all(|c| c.y == 0.0)
                    && angles.iter().all(upright)
            }
            PosePath::Variation { .. } | PosePath::Moved { .. } => false,
        }
    }
}

/// Value, rate and second rate of a polynomial.
fn polynomial(terms: &[Vector3<f64>], tau: f64) -> [Vector3<f64>; 3] {
    let [mut x, mut v, mut a] = [Vector3::zeros(); 3];
    for term in terms.iter().rev() {
        a = a * tau + v * 2.0;
        v = v * tau + x;
        x = x * tau + term;
    }
    [x, v, a]
}

/// Times within this share of the last row's are at it.
const AT_THE_END: f64 = 1.0e-12;

fn of_table(table: &PoseTable, time: f64) -> [[Vector3<f64>; 3]; 2] {
    let PoseTable { times, values, curvatures } = table;
    // A run that ends with the table ends in motion.
    let at_the_end = times.last().is_some_and(|last| (time - last).abs() <= AT_THE_END * last.abs().max(1.0));
    let after = if at_the_end && times.len() > 1 { times.len() - 1 } else { times.partition_point(|t| *t <= time) };
    let mut sum = [[Vector3::zeros(); 3]; 2];
    for (axis, (values, curvatures)) in values.iter().zip(curvatures).enumerate() {
        let now = if after == 0 || after == times.len() {
            [values[after.min(times.len() - 1)], 0.0, 0.0]
        } else {
            spline::at(times, values, curvatures, after - 1, time)
        };
        for (order, value) in now.into_iter().enumerate() {
            sum[axis / 3][order][axis % 3] = value;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::pose_file;

    /// Velocity and acceleration of a place of a body on every kind of path are the differences of its position (step 1e-4 s, so 1e-7 for numbers
    /// of the size of one).
    #[test]
    fn rates_are_those_of_the_place() {
        let file = "0,0,0,0,0,0,0\n1,1,0.5,0.1,10,5,20\n2,1,1,0.3,12,-5,30\n3,0,1,0.2,-3,-8,10\n4,0,0,0,0,0,0\n";
        let (one, two) = (Vector3::new(1.0, 0.3, 0.5), Vector3::new(0.2, -0.3, 0.4));
        let sinusoid = |scale: f64| Sinusoid { omega: 0.9, sine: one * scale, cosine: two * scale, ramp: 5.0 };
        let polynomial =
            PosePath::Polynomial { start: 1.0, position: vec![one, two, one, two], angles: vec![two, one, two * 0.3] };
        let paths = [
            PosePath::Sinusoidal { about: [one, two], offsets: [sinusoid(1.0), sinusoid(0.4)] },
            PosePath::Table(Arc::new(pose_file::parse(file, "a.csv").expect("a table"))),
            polynomial,
        ];
        let (at, d) = (Vector3::new(3.0, -2.0, 1.5), 1e-4);
        for path in paths {
            for time in [0.4, 2.3, 3.6] {
                let [before, here, after] = [time - d, time, time + d].map(|time| path.place(&at, time));
                let velocity = (after.position - before.position) / (2.0 * d);
                let acceleration = (after.velocity - before.velocity) / (2.0 * d);
                assert!((velocity - here.velocity).norm() < 1e-6 * (1.0 + velocity.norm()), "{path:?} {time}");
                assert!((acceleration - here.acceleration).norm() < 1e-6 * (1.0 + acceleration.norm()), "{path:?} {time}");
            }
        }
    }
}
