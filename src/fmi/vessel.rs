//! A driven body in the hands of a master: what it says of it, in which axes, and how the body goes from one communication point to the next.
//!
//! Positions and angles go by the rules of a fairlead (`input_path`), angles times an arm as arcs in metres. Inside, axes are those of the scene: z up, body
//! axes forward, port and up; a north-east-down master says y and z, pitch and yaw with the other sign, and that is all there is to it, because
//! a half turn about x takes one set of axes to the other.

use crate::algebra::rotation;
use crate::fmi::body_variables::{Conventions, Said};
use crate::fmi::filter::Filter;
use crate::fmi::input_path::{InputPath, Plan};
use crate::fmi::inputs::Inputs;
use crate::fmi::segment::Segment;
use crate::fmi::variables::Interpolation;
use crate::fmi::warnings::Told;
use crate::rod::pose::PosePath;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A body at the end of a step, and what the lines do to it, in the axes of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// Position [m].
    pub position: Vector3<f64>,
    /// Roll, pitch and yaw [rad].
    pub angles: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Angular velocity [rad/s].
    pub omega: Vector3<f64>,
    /// Force of the lines [N].
    pub force: Vector3<f64>,
    /// Their moment about the reference point [N·m].
    pub moment: Vector3<f64>,
    /// Work done on it [J].
    pub work: f64,
}

impl Reached {
    /// At the origin, without loads.
    pub fn nowhere() -> Reached {
        let zero = Vector3::zeros();
        Reached { position: zero, angles: zero, velocity: zero, omega: zero, force: zero, moment: zero, work: 0.0 }
    }
}

/// A body as the master sees it. Part of the FMU state.
#[derive(Debug, Clone, PartialEq)]
pub struct Vessel {
    /// Position and attitude, as given, at which the mooring was put in equilibrium; with the parameters it makes the lines what they are.
    pub origin: [[f64; 3]; 2],
    /// What was said last.
    pub said: Said,
    /// Where the paths of position and of angles stand.
    pub paths: [InputPath; 2],
    /// Where the filters of both stand.
    pub filters: [Filter; 2],
    /// The last angles [rad], wound on over whole turns.
    pub angles: [f64; 3],
    /// What the master has been warned of.
    pub told: Told,
    /// Where it is, and what the lines do to it.
    pub reached: Reached,
}

/// How a body goes to the next communication point.
#[derive(Clone)]
pub struct Voyage {
    /// Of position and of angles.
    pub plans: [Plan; 2],
    /// The same.
    pub segments: [Segment; 2],
    /// What they go by.
    pub inputs: [Inputs; 2],
    /// The filters then.
    pub filters: [Filter; 2],
    /// The angles then.
    pub angles: [f64; 3],
}

/// Farther than this [m], or by more than this [rad], nothing goes from one communication point to the next.
const FARTHEST: f64 = 100.0;
const LARGEST_TURN: f64 = TAU / 4.0;

/// Why a body cannot go where the master says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Impossible {
    /// It is that far away [m].
    Jump(f64),
    /// It is turned by so much [rad].
    Turn(f64),
}

impl Vessel {
    /// At rest where the start values have it.
    pub fn at_rest(said: Said) -> Vessel {
        Vessel {
            origin: [said.values[0], said.values[1]],
            said,
            paths: [InputPath::at_rest([0.0; 3]), InputPath::at_rest([0.0; 3])],
            filters: [Filter::at_rest([0.0; 3], 0.0); 2],
            angles: [0.0; 3],
            told: Told::default(),
            reached: Reached::nowhere(),
        }
    }

    /// Settles where the master has put it, at a time.
    pub fn settle(&mut self, conventions: &Conventions, arm: f64, time: f64) {
        self.origin = [self.said.values[0], self.said.values[1]];
        let [position, angles] = self.origin.map(|values| conventions.turned(values));
        let arcs = angles.map(|angle| angle * arm);
        self.angles = angles;
        self.paths = [InputPath::at_rest(position), InputPath::at_rest(arcs)];
        self.filters = [Filter::at_rest(position, time), Filter::at_rest(arcs, time)];
        self.reached = Reached { position: position.into(), angles: angles.into(), ..Reached::nowhere() };
    }

    /// Becomes another; in the long run it allocates nothing.
    pub fn copy_from(&mut self, other: &Vessel) {
        let Vessel { origin, said, paths, filters, angles, told, reached } = other;
        (self.origin, self.said, self.filters, self.angles, self.told, self.reached) =
            (*origin, *said, *filters, *angles, *told, *reached);
        self.paths.iter_mut().zip(paths).for_each(|(path, other)| path.copy_from(other));
    }

    /// What was said, in the axes of the scene: position and velocity, angles and their rates as arcs; and the angles, wound on.
    fn understood(&self, said: &Said, conventions: &Conventions, arm: f64) -> ([Inputs; 2], [f64; 3]) {
        let [position, given, velocity, omega] = said.values.map(|values| conventions.turned(values));
        let wound = |axis: usize| given[axis] + ((self.angles[axis] - given[axis]) / TAU).round() * TAU;
        let angles = [wound(0), given[1], wound(2)];
        let q = Vector3::from(angles);
        let (mut v, mut w) = (Vector3::from(velocity), Vector3::from(omega));
        if conventions.body_rates {
            let turn = rotation::of_angles(&q);
            (v, w) = (turn * v, turn * w);
        }
        let rates = rotation::omega_to_rates(&q, &w);
        let set = |order: usize, part: usize, scale: f64| -> [Option<f64>; 3] {
            let sign = conventions.turned([scale; 3]);
            std::array::from_fn(|axis| said.derivatives[order][part][axis].map(|value| value * sign[axis]))
        };
        let inputs = |values: [f64; 3], rates: [f64; 3], part: usize, scale: f64| Inputs {
            values: [values.map(|x| x * scale), rates.map(|x| x * scale)],
            derivatives: [[set(0, part, scale), [None; 3]], [set(1, part, scale), [None; 3]]],
        };
        ([inputs(position, v.into(), 0, 1.0), inputs(angles, rates.into(), 1, arm)], angles)
    }

    /// Decides how to go from `time` over `step` [s].
    pub fn plan(
        &self,
        interpolation: Interpolation,
        cutoff: f64,
        conventions: &Conventions,
        arm: f64,
        time: f64,
        step: f64,
    ) -> Result<Voyage, Impossible> {
        let (given, angles) = self.understood(&self.said, conventions, arm);
        let away = |part: usize| {
            (0..3).map(|axis| (given[part].values[0][axis] - self.paths[part].position[axis]).powi(2)).sum::<f64>().sqrt()
        };
        if !(away(0) <= FARTHEST) {
            return Err(Impossible::Jump(away(0)));
        }
        let before = rotation::of_angles(&(Vector3::from(self.paths[1].position) / arm));
        let now = rotation::of_angles(&Vector3::from(angles));
        let turn = crate::rod::rigid::rotation_vector(&(now * before.transpose())).norm();
        if !(turn <= LARGEST_TURN) {
            return Err(Impossible::Turn(turn));
        }
        let mut filters = self.filters;
        let mut inputs = given;
        if cutoff > 0.0 {
            for part in 0..2 {
                filters[part] = filters[part].after(cutoff, time, &given[part]);
                inputs[part] = filters[part].inputs();
            }
        }
        let plan = |part: usize| self.paths[part].plan(interpolation, time, step, &inputs[part]);
        let plans = [plan(0), plan(1)];
        let segments = [0, 1].map(|part: usize| self.paths[part].segment(&plans[part], &inputs[part]));
        Ok(Voyage { plans, segments, inputs, filters, angles })
    }

    /// Remembers a voyage up to `reached` [s].
    pub fn advance(&mut self, voyage: &Voyage, reached: f64) {
        for part in 0..2 {
            self.paths[part].advance(&voyage.plans[part], &voyage.inputs[part], &voyage.segments[part], reached);
        }
        (self.filters, self.angles) = (voyage.filters, voyage.angles);
    }

    /// How far the inputs lie from where the last path ended [m].
    pub fn missed(&self, voyage: &Voyage) -> f64 {
        (0..2).map(|part: usize| self.paths[part].missed(&voyage.plans[part], &voyage.inputs[part])).fold(0.0, f64::max)
    }

    /// Change of the path per change of position, attitude, velocity and angular velocity, as the master says them.
    pub fn variation(
        &self,
        voyage: &Voyage,
        conventions: &Conventions,
        arm: f64,
        cutoff: f64,
        direction: &[[f64; 3]; 4],
    ) -> [Segment; 2] {
        let size = direction.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
        let share = 1.0e-4 / size;
        let moved = |by: f64| {
            let mut said = self.said;
            for (values, change) in said.values.iter_mut().zip(direction) {
                values.iter_mut().zip(change).for_each(|(value, change)| *value += by * change);
            }
            let (inputs, _) = self.understood(&said, conventions, arm);
            if cutoff > 0.0 {
                [0, 1].map(|part: usize| self.filters[part].after(cutoff, voyage.plans[part].time(), &inputs[part]).inputs())
            } else {
                inputs
            }
        };
        let (after, before) = (moved(share), moved(-share));
        [0, 1].map(|part: usize| {
            let change = [0, 1].map(|order: usize| {
                std::array::from_fn(|axis| (after[part].values[order][axis] - before[part].values[order][axis]) * (0.5 / share))
            });
            self.paths[part].variation(&voyage.plans[part], &voyage.inputs[part], change)
        })
    }
}

/// The path of a body from those of its position and of its arcs.
pub fn pose_path(segments: &[Segment; 2], arm: f64) -> PosePath {
    let terms = |segment: &Segment, scale: f64| segment.coefficients.iter().map(|term| Vector3::from(*term) * scale).collect();
    PosePath::Polynomial { start: segments[0].start, position: terms(&segments[0], 1.0), angles: terms(&segments[1], 1.0 / arm) }
}
