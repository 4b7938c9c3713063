//! Paths of a fairlead: position, velocity and acceleration at any time.

use crate::algebra::shape::Shape;
use crate::algebra::sinusoid::Sinusoid;
pub use crate::rod::pose::Kinematics;
use crate::rod::pose::PosePath;
use crate::scene::bodies::{BodyMotion, Mount, PointMotion};
use crate::scene::motion_file::Table;
use crate::scene::read::Loaded;
use crate::scene::types::{Motion, Triple};
use nalgebra::Vector3;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// The motion of a fairlead in time.
#[derive(Debug, Clone)]
pub enum Path {
    /// At rest at a point.
    Fixed(Vector3<f64>),
    /// A sinusoidal motion, eased in, about a point.
    Sinusoidal {
        /// Mean position [m].
        origin: Vector3<f64>,
        /// Offset from it [m].
        offset: Sinusoid,
    },
    /// Piecewise cubic Hermite through a table, at rest outside it.
    Table(Arc<Table>),
    /// Polynomial in tau = t - start, one coefficient vector per power.
    Polynomial {
        /// Time of tau = 0 [s].
        start: f64,
        /// Coefficients of tau⁰, tau¹, …
        coefficients: Vec<Vector3<f64>>,
    },
    /// With a place of a body.
    OnBody {
        /// The path of the body.
        body: Arc<PosePath>,
        /// The place in its axes [m].
        at: Vector3<f64>,
    },
}

/// The motions of both ends of a line.
#[derive(Debug, Clone)]
pub struct Ends {
    /// Of the fairlead.
    pub fairlead: Path,
    /// Of the anchor.
    pub anchor: Path,
}

impl Ends {
    /// The motions of the ends of line `index` of a scene. Free bodies and points are at rest where the scene puts them.
    pub fn of_scene(loaded: &Loaded, index: usize) -> Ends {
        let Some(line) = loaded.scene.lines.get(index) else {
            let nowhere = Path::Fixed(Vector3::zeros());
            return Ends { fairlead: nowhere.clone(), anchor: nowhere };
        };
        let anchor = line.anchor_on.as_ref().map_or(Path::Fixed(line.anchor.into()), |on| Path::on(loaded, on, line.anchor));
        Ends { fairlead: Path::of_scene(loaded, index), anchor }
    }

    /// An anchor that stays where it is.
    pub fn anchored(fairlead: Path, anchor: Vector3<f64>) -> Ends {
        Ends { fairlead, anchor: Path::Fixed(anchor) }
    }
}

impl PosePath {
    /// The motion of body `index` of a scene; a free one is at rest where the scene puts it.
    pub fn of_scene(loaded: &Loaded, index: usize) -> PosePath {
        let body = &loaded.scene.bodies[index];
        let (position, angles) = (Vector3::from(body.position), body.attitude());
        match (&body.motion, loaded.body_motions.get(index).cloned().flatten()) {
            (BodyMotion::Sinusoidal { period, sine, cosine, ramp }, _) => {
                let part = |six: &[f64; 6], from: usize| -> Triple {
                    std::array::from_fn(|axis| if from == 0 { six[axis] } else { six[axis + 3].to_radians() })
                };
                let offset = |from| Sinusoid::new(*period, part(sine, from), part(cosine, from), *ramp);
                PosePath::Sinusoidal { about: [position, angles], offsets: [offset(0), offset(3)] }
            }
            (BodyMotion::File { .. }, Some(table)) => PosePath::Table(table),
            _ => PosePath::Fixed { position, angles },
        }
    }
}

impl Path {
    /// The motion of the fairlead of line `index` of a scene.
    pub fn of_scene(loaded: &Loaded, index: usize) -> Path {
        let origin = loaded.scene.lines.get(index).map_or(Vector3::zeros(), |line| line.fairlead.into());
        if let Some(line) = loaded.scene.lines.get(index)
            && let Some(on) = &line.fairlead_on
        {
            return Path::on(loaded, on, line.fairlead);
        }
        match (&loaded.scene.motion, &loaded.motion) {
            (Motion::Sinusoidal { period, sine, cosine, ramp }, _) => {
                Path::Sinusoidal { origin, offset: Sinusoid::new(*period, *sine, *cosine, *ramp) }
            }
            (Motion::File { .. }, Some(table)) => Path::Table(Arc::clone(table)),
            _ => Path::Fixed(origin),
        }
    }

    /// The motion of what an end hangs on, which is at `place` at the start.
    fn on(loaded: &Loaded, on: &Mount, place: Triple) -> Path {
        let scene = &loaded.scene;
        match on {
            Mount::Body { body, at, .. } => scene.body(body).map_or(Path::Fixed(place.into()), |index| Path::OnBody {
                body: Arc::new(PosePath::of_scene(loaded, index)),
                at: Vector3::from(*at),
            }),
            Mount::Point { point } => {
                let number = scene.point(point);
                match (
                    number.map(|number| &scene.points[number].motion),
                    number.and_then(|n| loaded.point_motions.get(n)?.clone()),
                ) {
                    (Some(PointMotion::Sinusoidal { period, sine, cosine, ramp }), _) => {
                        Path::Sinusoidal { origin: place.into(), offset: Sinusoid::new(*period, *sine, *cosine, *ramp) }
                    }
                    (_, Some(table)) => Path::Table(table),
                    _ => Path::Fixed(place.into()),
                }
            }
        }
    }

    /// Kinematics at a time.
    pub fn at(&self, time: f64) -> Kinematics {
        match self {
            Path::Fixed(position) => Kinematics::at_rest(*position),
            Path::Sinusoidal { origin, offset } => {
                let [x, velocity, acceleration] = offset.at(time);
                Kinematics { position: origin + x, velocity, acceleration }
            }
            Path::Table(table) => interpolate(table, time),
            Path::Polynomial { start, coefficients } => {
                let tau = time - start;
                let mut k = Kinematics::at_rest(Vector3::zeros());
                for coefficient in coefficients.iter().rev() {
                    k.acceleration = k.acceleration * tau + k.velocity * 2.0;
                    k.velocity = k.velocity * tau + k.position;
                    k.position = k.position * tau + coefficient;
                }
                k
            }
            Path::OnBody { body, at } => body.place(at, time),
        }
    }
}

impl Path {
    /// Whether the fairlead stays within `slight` [m] of a place from one time to another.
    pub fn rests(&self, from: f64, until: f64, place: &Vector3<f64>, slight: f64) -> bool {
        let still = match self {
            Path::Fixed(_) => true,
            Path::Sinusoidal { offset, .. } => offset.sine.norm() + offset.cosine.norm() == 0.0,
            Path::Table(table) => {
                let mut rows = rows_between(table, from, until);
                let first = *rows.start();
                rows.all(|row| table.velocities[row] == [0.0; 3] && table.positions[row] == table.positions[first])
            }
            Path::Polynomial { start, coefficients } => {
                let (span, powers) = ((from - start).abs().max((until - start).abs()), coefficients.iter().enumerate().skip(1));
                powers.map(|(power, c)| c.norm() * span.powi(power as i32)).sum::<f64>() <= slight
            }
            Path::OnBody { body, at } => body.rests(from, until, at.norm(), slight),
        };
        still && (self.at(until).position - place).norm() <= slight
    }

    /// Whether the fairlead's y stays exactly what it is given as, from one time to another.
    pub fn stays_at(&self, y: f64, from: f64, until: f64) -> bool {
        match self {
            Path::Fixed(position) => position.y == y,
            Path::Sinusoidal { origin, offset } => origin.y == y && offset.sine.y == 0.0 && offset.cosine.y == 0.0,
            Path::Table(table) => {
                rows_between(table, from, until).all(|row| table.positions[row][1] == y && table.velocities[row][1] == 0.0)
            }
            Path::Polynomial { coefficients, .. } => {
                coefficients.first().map_or(0.0, |c| c.y) == y && coefficients.iter().skip(1).all(|c| c.y == 0.0)
            }
            Path::OnBody { body, at } => body.stays_at(at, y, from, until),
        }
    }
}

/// The rows of a table on which its motion from one time to another depends.
fn rows_between(table: &Table, from: f64, until: f64) -> RangeInclusive<usize> {
    let first = table.times.partition_point(|t| *t <= from).saturating_sub(1);
    first..=table.times.partition_point(|t| *t < until).min(table.times.len() - 1)
}

/// Cubic Hermite interpolation of a table; before the first and after the last row the fairlead rests there.
fn interpolate(table: &Table, time: f64) -> Kinematics {
    let after = table.times.partition_point(|t| *t <= time);
    let position = |row: usize| Vector3::from(table.positions[row]);
    if after == 0 || after == table.times.len() {
        return Kinematics::at_rest(position(after.min(table.times.len() - 1)));
    }
    let row = after - 1;
    let h = table.times[after] - table.times[row];
    let shape = Shape::at((time - table.times[row]) / h).scaled(h);
    let ends = [position(row), table.velocities[row].into(), position(after), table.velocities[after].into()];
    let sum = |n: &[f64; 4]| (0..4).map(|k| ends[k] * n[k]).sum();
    Kinematics { position: sum(&shape.value), velocity: sum(&shape.slope), acceleration: sum(&shape.curvature) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table rests before its first row, between equal rows without velocity and after its last; a polynomial of degree 0 rests.
    #[test]
    fn a_path_knows_when_it_rests() {
        let table = Table {
            times: vec![1.0, 2.0, 3.0, 4.0],
            positions: vec![[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
            velocities: vec![[0.0; 3], [0.0; 3], [0.0; 3], [0.1, 0.0, 0.0]],
        };
        let (path, here) = (Path::Table(Arc::new(table)), Vector3::x());
        for (from, until, rests) in [(0.0, 0.5, true), (0.0, 1.5, true), (1.2, 2.0, true), (1.5, 2.1, false), (3.5, 4.0, false)] {
            let place = path.at(until).position;
            assert_eq!(path.rests(from, until, &place, 1e-9), rests, "{from} to {until}");
        }
        assert!(!path.rests(0.0, 0.5, &Vector3::zeros(), 1e-9), "it rests elsewhere");
        let polynomial = |c: f64| Path::Polynomial { start: 5.0, coefficients: vec![here, Vector3::y() * c] };
        assert!(polynomial(0.0).rests(5.0, 6.0, &here, 1e-9) && !polynomial(1e-8).rests(5.0, 6.0, &here, 1e-9));
    }

    /// Velocity and acceleration of every kind of path are the differences of its position (step 1e-4 s, error of order 1e-8).
    #[test]
    fn rates_are_those_of_the_position() {
        let table = Table {
            times: vec![0.0, 1.0, 3.0],
            positions: vec![[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [0.0, 1.0, 0.0]],
            velocities: vec![[0.0, 0.0, 0.0], [0.5, 0.1, 0.0], [0.0, 0.0, 0.0]],
        };
        let (sine, cosine) = (Vector3::new(5.0, 2.0, 1.0), Vector3::new(0.3, 0.0, 1.0));
        let paths = [
            Path::Sinusoidal { origin: Vector3::x(), offset: Sinusoid { omega: 0.9, sine, cosine, ramp: 20.0 } },
            Path::Sinusoidal { origin: Vector3::x(), offset: Sinusoid { omega: 0.9, sine, cosine, ramp: 0.0 } },
            Path::Table(Arc::new(table)),
            Path::Polynomial { start: 1.0, coefficients: vec![sine, cosine, sine, cosine] },
        ];
        let d = 1e-4;
        for path in paths {
            for time in [0.4, 2.3] {
                let (before, here, after) = (path.at(time - d), path.at(time), path.at(time + d));
                let velocity = (after.position - before.position) / (2.0 * d);
                let acceleration = (after.velocity - before.velocity) / (2.0 * d);
                assert!((velocity - here.velocity).norm() < 1e-6, "{path:?}");
                assert!((acceleration - here.acceleration).norm() < 1e-6, "{path:?}");
            }
        }
    }
}
