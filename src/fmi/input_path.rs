//! The path of the fairlead between communication points.
//!
//! At a communication point t the master gives position x and velocity v; the FMU has to move the fairlead to t + h before it learns more.
//!     p(τ) = E(τ) + c₀ b₀(τ/B) + c₁ B b₁(τ/B),   B = max(h, 0.1 s),   τ = time - t
//! E  extrapolation [m]: starts at x with slope v; its curvature comes from the velocities sent so far (or, where a master never sends
//!    velocities, from the positions), by the polynomial through up to five of them, or from input derivatives where they are set;
//! c₀, c₁  where the last path ended minus E(0), E'(0) [m, m/s]: what the master corrected since;
//! b₀ = 1 - 3s² + 2s³, b₁ = s - 2s² + s³  cubic Hermite shapes, which fade the correction out over B without a jump in p or p'.
//!
//! High orders are exact on smooth motion and wild after a jump or on jitter, so the order is the one that would have foretold the last
//! values best from those before. All of it is linear in the inputs once order and nodes are chosen, which makes the path differentiable.

use crate::fmi::variables::Interpolation;
use crate::solve::motion::Path;
use nalgebra::Vector3;

/// Shortest time over which a correction is absorbed [s].
const SHORTEST_BLEND: f64 = 0.1;
/// Samples closer together than this are thinned out [s]: the memory must reach back over several long steps after many short ones.
const SHORTEST_SPACING: f64 = 0.05;
/// Samples kept.
pub const CAPACITY: usize = 32;
/// Most values (the present one included) that a polynomial of velocities goes through.
const VELOCITY_NODES: usize = 5;
/// The same for positions: differentiation costs one order.
const POSITION_NODES: usize = 6;
/// Past values by which an order is judged: how well those before foretold them.
const FORETOLD: usize = 3;
/// The share with which a miss of the present counts: a kink of the motion is forgotten sooner, jitter is judged by the past.
const PRESENT_VOICE: f64 = 0.5;
/// From here on it counts [m/s]. Where the present tells nothing new it does not choose, so that the path is linear in it: small changes of
/// the inputs, by which a master differentiates or iterates, change the path in proportion.
const NOTICEABLE: f64 = 1.0e-3;
/// Past values that this takes.
const SPACED_NODES: usize = POSITION_NODES + FORETOLD;
/// Largest error of foretelling the present, as a part of all that changed over the nodes, that counts as smooth.
const SMOOTH: f64 = 0.3;
/// Most coefficients of a segment: a polynomial of degree 5.
const TERMS: usize = 6;

/// What the master gives at a communication point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// `[0]` position [m], `[1]` velocity [m/s] of the fairlead, by axis.
    pub values: [[f64; 3]; 2],
    /// Time derivatives of order 1 and 2 of each value, where the master set them for the step to come: `[order - 1][value][axis]`.
    pub derivatives: [[[Option<f64>; 3]; 2]; 2],
}

impl Inputs {
    /// Velocity on an axis: the input derivative of the position where it is set, else the velocity input [m/s].
    fn velocity(&self, axis: usize) -> f64 {
        self.derivatives[0][0][axis].unwrap_or(self.values[1][axis])
    }

    /// Velocity and, as far as they are set, its first and second derivative on an axis.
    fn velocity_terms(&self, axis: usize) -> ([f64; 3], usize) {
        let acceleration = self.derivatives[0][1][axis].or(self.derivatives[1][0][axis]);
        match (acceleration, self.derivatives[1][1][axis]) {
            (Some(acceleration), Some(jerk)) => ([self.velocity(axis), acceleration, jerk], 3),
            (Some(acceleration), None) => ([self.velocity(axis), acceleration, 0.0], 2),
            (None, _) => ([self.velocity(axis), 0.0, 0.0], 1),
        }
    }

    /// Whether the master gives a velocity in any way; zeros count as not given.
    fn gives_velocity(&self) -> bool {
        (0..3).any(|axis| self.derivatives[0][0][axis].is_some() || self.values[1][axis] != 0.0)
    }

    fn sample(&self, time: f64) -> Sample {
        Sample { time, position: self.values[0], velocity: [self.velocity(0), self.velocity(1), self.velocity(2)] }
    }
}

/// Position and velocity that the master gave at a past communication point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Position [m].
    pub position: [f64; 3],
    /// Velocity [m/s].
    pub velocity: [f64; 3],
}

/// Where the path stands and what it remembers. Part of the FMU state.
#[derive(Debug, Clone, PartialEq)]
pub struct InputPath {
    /// Past samples, oldest first, at most `CAPACITY`.
    pub samples: Vec<Sample>,
    /// Where the last segment ended [m].
    pub position: [f64; 3],
    /// With which velocity it ended [m/s].
    pub velocity: [f64; 3],
    /// Whether the master ever gave a velocity.
    pub velocity_given: bool,
}

/// What was decided for a step; given this, the path is linear in inputs and past.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    time: f64,
    step: f64,
    interpolation: Interpolation,
    position_only: bool,
    nodes: Nodes,
}

/// Indices of the samples that a polynomial goes through, newest first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Nodes {
    indices: [usize; SPACED_NODES],
    count: usize,
}

impl Nodes {
    fn push(&mut self, index: usize) {
        self.indices[self.count] = index;
        self.count += 1;
    }

    fn as_slice(&self) -> &[usize] {
        &self.indices[..self.count]
    }
}

/// The path of one step: a polynomial in τ = time - start, by power and axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    start: f64,
    coefficients: [[f64; 3]; TERMS],
}

impl Segment {
    /// As a path for the solver.
    pub fn path(&self) -> Path {
        let coefficients = self.coefficients.iter().map(|term| Vector3::from(*term)).collect();
        Path::Polynomial { start: self.start, coefficients }
    }

    /// As a path for the solver, in the place of the last one.
    pub fn write_to(&self, path: &mut Path) {
        match path {
            Path::Polynomial { start, coefficients } if coefficients.len() == TERMS => {
                *start = self.start;
                coefficients.iter_mut().zip(self.coefficients).for_each(|(to, term)| *to = term.into());
            }
            _ => *path = self.path(),
        }
    }

    /// Position [m] and velocity [m/s] at a time.
    pub fn at(&self, time: f64) -> ([f64; 3], [f64; 3]) {
        let tau = time - self.start;
        let (mut position, mut velocity) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            for term in self.coefficients.iter().rev() {
                velocity[axis] = velocity[axis] * tau + position[axis];
                position[axis] = position[axis] * tau + term[axis];
            }
        }
        (position, velocity)
    }
}

impl InputPath {
    /// A fairlead at rest, with no past.
    pub fn at_rest(position: [f64; 3]) -> InputPath {
        InputPath { samples: Vec::with_capacity(CAPACITY), position, velocity: [0.0; 3], velocity_given: false }
    }

    /// Becomes another path's memory; in the long run it allocates nothing.
    pub fn copy_from(&mut self, other: &InputPath) {
        let InputPath { samples, position, velocity, velocity_given } = other;
        self.samples.clone_from(samples);
        (self.position, self.velocity, self.velocity_given) = (*position, *velocity, *velocity_given);
    }

    /// Decides how to go from `time` over `step` [s]: from which past values, by which order.
    pub fn plan(&self, interpolation: Interpolation, time: f64, step: f64, inputs: &Inputs) -> Plan {
        let given = self.velocity_given || inputs.gives_velocity();
        let position_only = interpolation != Interpolation::Extrapolate && !given && self.moved(inputs);
        let mut plan = Plan { time, step, interpolation, position_only, nodes: Nodes::default() };
        let derivative_needed = interpolation == Interpolation::Delay && position_only;
        let extrapolates = matches!(interpolation, Interpolation::Auto | Interpolation::Extrapolate);
        if (extrapolates || derivative_needed) && !self.outdated_by(inputs) {
            plan.nodes = self.spaced_nodes(time, step);
            plan.nodes.count = self.smooth(plan.nodes.as_slice(), &inputs.sample(time), position_only);
        }
        plan
    }

    /// Whether the position ever changed.
    fn moved(&self, inputs: &Inputs) -> bool {
        self.samples.iter().any(|sample| sample.position != inputs.values[0])
    }

    /// Whether the samples lack the velocities that the master gives from now on: then they are no past to extrapolate from.
    fn outdated_by(&self, inputs: &Inputs) -> bool {
        !self.velocity_given && inputs.gives_velocity() && self.moved(inputs) && {
            let first = self.samples.first().map(|sample| sample.position);
            self.samples.iter().any(|sample| Some(sample.position) != first)
        }
    }

    /// Samples far enough apart to extrapolate over `step`, newest first: a polynomial through close values says nothing far away.
    fn spaced_nodes(&self, time: f64, step: f64) -> Nodes {
        let gap = (0.5 * step).max(0.5 * SHORTEST_SPACING) * (1.0 - 1e-6);
        let mut last = time;
        let mut nodes = Nodes::default();
        for (index, sample) in self.samples.iter().enumerate().rev() {
            if nodes.count < SPACED_NODES && last - sample.time >= gap {
                last = sample.time;
                nodes.push(index);
            }
        }
        nodes
    }

    /// How many of the nodes extrapolate best: of the polynomials through m values the one that came closest to foretelling the present and
    /// the last three past values from those before, as long as it did not miss the present by far; then m - 1 past values and the present
    /// one foretell the future. Not simply all of them: a polynomial through five values makes a jitter 31 times larger, and a vessel that
    /// answers to the line's force sends it back.
    ///
    /// What the polynomial through values 1 … m misses of value 0 is f[t₀, …, tₘ]·Π(t₀ - tⱼ), with the divided difference f[…].
    fn smooth(&self, nodes: &[usize], now: &Sample, position_only: bool) -> usize {
        let most = if position_only { POSITION_NODES } else { VELOCITY_NODES };
        let value = |sample: &Sample| Vector3::from(if position_only { sample.position } else { sample.velocity });
        let mut times = [0.0; SPACED_NODES + 1];
        let mut differences = [value(now); SPACED_NODES + 1];
        for (number, &index) in (1..).zip(nodes) {
            times[number] = self.samples[index].time - now.time;
            differences[number] = value(&self.samples[index]);
        }
        let noticeable = if position_only { -NOTICEABLE * times[1] } else { NOTICEABLE };
        let count = nodes.len() + 1;
        let values = differences;
        let (mut changed, mut best, mut least) = (0.0, 0, f64::INFINITY);
        for order in 1..count.min(most + 1) {
            for first in 0..count - order {
                let slope = (differences[first] - differences[first + 1]) / (times[first] - times[first + order]);
                differences[first] = slope;
            }
            let missed = |first: usize| {
                let distances = times[first + 1..=first + order].iter().map(|time| times[first] - time);
                differences[first].norm() * distances.product::<f64>()
            };
            changed += (values[order - 1] - values[order]).norm();
            if 1 + order >= count {
                break;
            }
            let past = (1..=FORETOLD).take_while(|first| first + order < count).map(missed);
            let present = Some(missed(0)).filter(|miss| *miss > noticeable).map_or(0.0, |miss| PRESENT_VOICE * miss);
            let worst = past.fold(present, f64::max);
            if worst < least && (order == 1 || missed(0) <= SMOOTH * changed) {
                (best, least) = (order - 1, worst);
            }
        }
        best
    }

    /// The path that a plan makes of the inputs.
    pub fn segment(&self, plan: &Plan, inputs: &Inputs) -> Segment {
        build(plan, inputs, &self.samples, (self.position, self.velocity))
    }

    /// The change of that path per change of position and velocity inputs (`direction`), all else held.
    pub fn variation(&self, plan: &Plan, inputs: &Inputs, direction: [[f64; 3]; 2]) -> Segment {
        let held = inputs.derivatives.map(|order| order.map(|value| value.map(|set| set.map(|_| 0.0))));
        let direction = Inputs { values: direction, derivatives: held };
        let past: Vec<Sample> =
            self.samples.iter().map(|sample| Sample { time: sample.time, position: [0.0; 3], velocity: [0.0; 3] }).collect();
        build(plan, &direction, &past, ([0.0; 3], [0.0; 3]))
    }

    /// Remembers the inputs of a step that went along a segment up to `reached`.
    pub fn advance(&mut self, plan: &Plan, inputs: &Inputs, segment: &Segment, reached: f64) {
        if self.outdated_by(inputs) {
            self.samples.clear();
        }
        self.velocity_given |= inputs.gives_velocity();
        let spacing = self.samples.last().map_or(f64::INFINITY, |last| plan.time - last.time);
        if spacing >= SHORTEST_SPACING * (1.0 - 1e-6) {
            if self.samples.len() == CAPACITY {
                self.samples.remove(0);
            }
            self.samples.push(inputs.sample(plan.time));
        }
        (self.position, self.velocity) = segment.at(reached);
    }
}

/// The segment of a plan, axis by axis.
fn build(plan: &Plan, inputs: &Inputs, samples: &[Sample], ended: ([f64; 3], [f64; 3])) -> Segment {
    let mut coefficients = [[0.0; 3]; TERMS];
    for axis in 0..3 {
        let target = extrapolation(plan, inputs, samples, axis);
        let ended = (ended.0[axis], ended.1[axis]);
        let terms = match plan.interpolation {
            Interpolation::Delay => hermite(ended, (target[0], target[1]), plan.step),
            Interpolation::Auto | Interpolation::Extrapolate | Interpolation::HoldVelocity => {
                let correction = (ended.0 - target[0], ended.1 - target[1]);
                let fading = hermite(correction, (0.0, 0.0), plan.step.max(SHORTEST_BLEND));
                std::array::from_fn(|power| target[power] + fading[power])
            }
        };
        for (power, term) in terms.iter().enumerate() {
            coefficients[power][axis] = *term;
        }
    }
    Segment { start: plan.time, coefficients }
}

/// E(τ) on one axis, by power.
fn extrapolation(plan: &Plan, inputs: &Inputs, samples: &[Sample], axis: usize) -> [f64; TERMS] {
    let position = inputs.values[0][axis];
    if plan.position_only {
        let past = plan.nodes.as_slice().iter().map(|&index| (samples[index].time - plan.time, samples[index].position[axis]));
        return through_present(&[position], past);
    }
    let (terms, known) = inputs.velocity_terms(axis);
    let past = plan.nodes.as_slice().iter().map(|&index| (samples[index].time - plan.time, samples[index].velocity[axis]));
    let velocity = through_present(&terms[..known], past.take(VELOCITY_NODES - known));
    let mut integral = [position, 0.0, 0.0, 0.0, 0.0, 0.0];
    for power in 1..TERMS {
        integral[power] = velocity[power - 1] / power as f64;
    }
    integral
}

/// The polynomial with given value and derivatives at τ = 0 and given values before.
fn through_present(present: &[f64], past: impl Iterator<Item = (f64, f64)>) -> [f64; TERMS] {
    let (mut times, mut values) = ([0.0; TERMS], [0.0; TERMS]);
    let mut count = present.len();
    values[..count].copy_from_slice(present);
    for ((time, value), (time_slot, value_slot)) in past.zip(times[count..].iter_mut().zip(&mut values[count..])) {
        (*time_slot, *value_slot) = (time, value);
        count += 1;
    }
    interpolate(&times[..count], &values[..count])
}

/// Newton's divided differences, as coefficients by power. Nodes that are equal to the first stand first and carry derivatives of rising
/// order instead of values. At most `TERMS` nodes.
fn interpolate(nodes: &[f64], values: &[f64]) -> [f64; TERMS] {
    let count = nodes.len();
    let repeated = nodes.iter().take_while(|node| **node == nodes[0]).count();
    let mut differences = [0.0; TERMS];
    for (index, difference) in differences[..count].iter_mut().enumerate() {
        *difference = if index < repeated { values[0] } else { values[index] };
    }
    let mut factorial = 1.0;
    for level in 1..count {
        factorial *= level as f64;
        for index in (level..count).rev() {
            differences[index] = if index < repeated {
                values[level] / factorial
            } else {
                (differences[index] - differences[index - 1]) / (nodes[index] - nodes[index - level])
            };
        }
    }
    let mut terms = [0.0; TERMS];
    for index in (0..count).rev() {
        for power in (1..TERMS).rev() {
            terms[power] = terms[power - 1] - nodes[index] * terms[power];
        }
        terms[0] = differences[index] - nodes[index] * terms[0];
    }
    terms
}

/// The cubic from one (value, slope) to another over `length`.
fn hermite(from: (f64, f64), to: (f64, f64), length: f64) -> [f64; TERMS] {
    let chord = (to.0 - from.0) / length;
    [from.0, from.1, (3.0 * chord - 2.0 * from.1 - to.1) / length, (from.1 + to.1 - 2.0 * chord) / (length * length), 0.0, 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Position, velocity, acceleration and jerk of a motion on the first axis.
    type Motion = dyn Fn(f64) -> [f64; 4];

    /// The built-in case's surge: 5.08 m, 15 s.
    fn surge(t: f64) -> [f64; 4] {
        let w = TAU / 15.0;
        let (sin, cos) = (w * t).sin_cos();
        [5.08 * sin, 5.08 * w * cos, -5.08 * w * w * sin, -5.08 * w * w * w * cos]
    }

    /// What a master sends.
    #[derive(Clone, Copy, PartialEq)]
    enum Sends {
        Positions,
        Velocities,
        Derivatives,
    }

    fn inputs(motion: &Motion, t: f64, sends: Sends) -> Inputs {
        let [x, v, a, _] = motion(t);
        let mut inputs = Inputs { values: [[x, 0.0, 7.0], [0.0; 3]], ..Inputs::default() };
        if sends != Sends::Positions {
            inputs.values[1][0] = v;
        }
        if sends == Sends::Derivatives {
            inputs.derivatives[0][0][0] = Some(v);
            inputs.derivatives[1][0][0] = Some(a);
        }
        inputs
    }

    /// Drives a path by a motion with the given steps; calls `look(time, segment)` ten times per step.
    fn drive(
        interpolation: Interpolation,
        motion: &Motion,
        sends: Sends,
        steps: impl Iterator<Item = f64>,
        mut look: impl FnMut(f64, &Segment),
    ) -> InputPath {
        let mut path = InputPath::at_rest([motion(0.0)[0], 0.0, 7.0]);
        let mut time = 0.0;
        for step in steps {
            let inputs = inputs(motion, time, sends);
            let plan = path.plan(interpolation, time, step, &inputs);
            let segment = path.segment(&plan, &inputs);
            for part in 0..=10 {
                look(time + step * f64::from(part) / 10.0, &segment);
            }
            path.advance(&plan, &inputs, &segment, time + step);
            time += step;
        }
        path
    }

    /// Largest error of position and of velocity after 15 s, as parts of their amplitudes.
    fn errors(interpolation: Interpolation, sends: Sends, step: f64) -> (f64, f64) {
        let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
        let steps = (0..(60.0 / step) as usize).map(|_| step);
        drive(interpolation, &surge, sends, steps, |time, segment| {
            if time > 15.0 {
                let ([x, v, ..], (p, q)) = (surge(time), segment.at(time));
                position = position.max((p[0] - x).abs() / 5.08);
                velocity = velocity.max((q[0] - v).abs() / (5.08 * TAU / 15.0));
            }
        });
        (position, velocity)
    }

    /// Random steps from 0.01 to 0.5 s, always the same ones.
    fn random_steps(count: usize) -> impl Iterator<Item = f64> {
        let mut seed = 1_u64;
        (0..count).map(move |_| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            0.01 + 0.49 * (seed >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    /// An error of velocity acts on the tension through the line's wave impedance, 0.26 MN s/m: 0.1 % of 1.4 MN are 0.0026 of the velocity's
    /// amplitude, 0.3 % are 0.008.
    #[test]
    fn follows_a_sinusoid_as_closely_as_the_tension_needs() {
        let table = [
            (Sends::Velocities, 0.1, 1e-4),
            (Sends::Velocities, 0.5, 4e-3),
            (Sends::Positions, 0.1, 1e-4),
            (Sends::Positions, 0.5, 6e-3),
            (Sends::Derivatives, 0.1, 1e-4),
            (Sends::Derivatives, 0.5, 4e-3),
        ];
        for (sends, step, allowed) in table {
            let (position, velocity) = errors(Interpolation::Auto, sends, step);
            assert!(velocity < allowed && position < allowed, "step {step}: position {position:e}, velocity {velocity:e}");
        }
    }

    #[test]
    fn follows_a_sinusoid_in_random_steps() {
        for (sends, allowed) in [(Sends::Velocities, 4e-3), (Sends::Positions, 0.01)] {
            let mut worst = 0.0_f64;
            drive(Interpolation::Auto, &surge, sends, random_steps(300), |time, segment| {
                if time > 15.0 {
                    worst = worst.max((segment.at(time).1[0] - surge(time)[1]).abs());
                }
            });
            assert!(worst < allowed, "velocity off by {worst} m/s");
        }
    }

    /// A mass that a line brakes by its wave impedance, Z h/m = 0.15, swings with what drives it. A polynomial through five velocities,
    /// which makes an alternating error 31 times larger, would blow up (31·0.15 > 2).
    #[test]
    fn a_vessel_that_answers_to_the_force_is_not_shaken() {
        let (step, gain) = (0.2, 0.15);
        let (mut path, mut state) = (InputPath::at_rest([0.0; 3]), [0.0; 2]);
        let mut fastest = 0.0_f64;
        for number in 0..1000 {
            let time = f64::from(number) * step;
            let inputs = Inputs { values: [[state[0], 0.0, 0.0], [state[1], 0.0, 0.0]], ..Inputs::default() };
            let plan = path.plan(Interpolation::Auto, time, step, &inputs);
            let segment = path.segment(&plan, &inputs);
            path.advance(&plan, &inputs, &segment, time + step);
            let change = step * (TAU / 12.0 * time).sin() - gain * path.velocity[0];
            state = [state[0] + step * (state[1] + 0.5 * change), state[1] + change];
            if number > 500 {
                fastest = fastest.max(state[1].abs());
            }
        }
        let exact = 1.0 / (gain / step).hypot(TAU / 12.0);
        assert!(fastest < 1.2 * exact, "{fastest} m/s instead of {exact} m/s");
    }

    #[test]
    fn is_continuous_in_position_and_velocity_whatever_the_master_does() {
        let jumpy = |t: f64| [(10.0 * t).floor().rem_euclid(3.0), (7.0 * t).floor().rem_euclid(4.0) - 1.5, 0.0, 0.0];
        let modes = [Interpolation::Auto, Interpolation::Extrapolate, Interpolation::HoldVelocity, Interpolation::Delay];
        for interpolation in modes {
            for sends in [Sends::Velocities, Sends::Positions, Sends::Derivatives] {
                for motion in [&surge as &Motion, &jumpy] {
                    let mut last: Option<(f64, Segment)> = None;
                    drive(interpolation, motion, sends, random_steps(200), |time, segment| {
                        if let Some((before, previous)) = last.take()
                            && previous.start != segment.start
                        {
                            let (was, is) = (previous.at(before), segment.at(time));
                            assert!((was.0[0] - is.0[0]).abs() < 1e-9 * (1.0 + was.0[0].abs()), "position jumps at {time}");
                            assert!((was.1[0] - is.1[0]).abs() < 1e-9 * (1.0 + was.1[0].abs()), "velocity jumps at {time}");
                        }
                        last = Some((time, segment.clone()));
                    });
                }
            }
        }
    }

    #[test]
    fn a_fairlead_at_rest_stays_exactly_where_it_is() {
        for interpolation in [Interpolation::Auto, Interpolation::Extrapolate, Interpolation::HoldVelocity, Interpolation::Delay]
        {
            drive(interpolation, &|_| [3.0, 0.0, 0.0, 0.0], Sends::Velocities, random_steps(50), |time, segment| {
                assert_eq!(segment.at(time), ([3.0, 0.0, 7.0], [0.0; 3]));
            });
        }
    }

    /// The cubic that takes up 1 m/s and the 0.05 m that were missed peaks at 2.04 m/s; a polynomial through the jump would reach 5 m/s.
    #[test]
    fn a_jump_of_the_velocity_is_not_extrapolated() {
        let motion = |t: f64| if t < 0.95 { [0.0; 4] } else { [t - 0.95, 1.0, 0.0, 0.0] };
        let mut fastest = 0.0_f64;
        drive(Interpolation::Auto, &motion, Sends::Velocities, (0..30).map(|_| 0.1), |time, segment| {
            fastest = fastest.max(segment.at(time).1[0]);
        });
        assert!(fastest < 2.05, "overshoots to {fastest} m/s after a jump to 1 m/s");
    }

    #[test]
    fn a_jump_of_the_position_is_absorbed_over_the_blending_time_and_no_more() {
        let motion = |t: f64| if t < 0.995 { [0.0; 4] } else { [1.0, 0.0, 0.0, 0.0] };
        for step in [0.001, 0.01, 0.1, 0.5] {
            let (mut highest, mut fastest) = (0.0_f64, 0.0_f64);
            let end = drive(
                Interpolation::Auto,
                &motion,
                Sends::Positions,
                (0..(3.0 / step) as usize).map(|_| step),
                |time, segment| {
                    highest = highest.max(segment.at(time).0[0]);
                    fastest = fastest.max(segment.at(time).1[0]);
                },
            );
            assert!(highest < 1.2, "step {step}: overshoots to {highest} m");
            assert!(fastest < 1.2 * 1.5 / SHORTEST_BLEND, "step {step}: {fastest} m/s to absorb 1 m");
            assert!((end.position[0] - 1.0).abs() < 1e-3, "step {step}: ends at {}", end.position[0]);
        }
    }

    #[test]
    fn an_initial_velocity_is_taken_up_over_the_blending_time() {
        let motion = |t: f64| [2.0 * t, 2.0, 0.0, 0.0];
        for (step, steps) in [(0.1, 1), (0.5, 1), (0.01, 200)] {
            let mut hardest = 0.0_f64;
            let mut last = 0.0;
            let path = drive(Interpolation::Auto, &motion, Sends::Velocities, (0..steps).map(|_| step), |time, segment| {
                let dt = 1e-6;
                hardest = hardest.max(((segment.at(time + dt).1[0] - segment.at(time).1[0]) / dt).abs());
                last = time;
            });
            assert!(hardest < 1.01 * 4.0 * 2.0 / SHORTEST_BLEND, "step {step}: {hardest} m/s²");
            assert!((path.velocity[0] - 2.0).abs() < 1e-3 && (path.position[0] - 2.0 * last).abs() < 2e-3, "{path:?}");
        }
    }

    #[test]
    fn zeros_for_velocities_are_recognised_and_a_late_velocity_ends_that() {
        let mut path = drive(Interpolation::Auto, &surge, Sends::Positions, (0..100).map(|_| 0.1), |_, _| ());
        let silent = inputs(&surge, 10.0, Sends::Positions);
        assert!(path.plan(Interpolation::Auto, 10.0, 0.1, &silent).position_only);
        assert!(!path.plan(Interpolation::Extrapolate, 10.0, 0.1, &silent).position_only);
        let speaking = inputs(&surge, 10.0, Sends::Velocities);
        let plan = path.plan(Interpolation::Auto, 10.0, 0.1, &speaking);
        assert!(!plan.position_only && plan.nodes.count == 0, "velocities that were never sent are extrapolated from: {plan:?}");
        let segment = path.segment(&plan, &speaking);
        path.advance(&plan, &speaking, &segment, 10.1);
        assert!(path.velocity_given && path.samples.len() == 1);
    }

    #[test]
    fn delay_goes_through_every_point_one_step_late() {
        let mut last = 0.0;
        drive(Interpolation::Delay, &surge, Sends::Velocities, (0..100).map(|_| 0.3), |time, segment| {
            if (time - segment.start - 0.3).abs() < 1e-9 {
                assert!((segment.at(time).0[0] - surge(time - 0.3)[0]).abs() < 1e-9);
                assert!((segment.at(time).1[0] - surge(time - 0.3)[1]).abs() < 1e-9);
                last = time;
            }
        });
        assert!(last > 29.0);
    }

    #[test]
    fn input_derivatives_bend_the_path() {
        let path = InputPath::at_rest([0.0; 3]);
        let mut inputs = Inputs::default();
        inputs.derivatives[1][0][2] = Some(4.0);
        for interpolation in [Interpolation::Auto, Interpolation::Extrapolate, Interpolation::HoldVelocity] {
            let plan = path.plan(interpolation, 0.0, 0.5, &inputs);
            let (position, velocity) = path.segment(&plan, &inputs).at(0.5);
            assert!((position[2] - 0.5).abs() < 1e-12 && (velocity[2] - 2.0).abs() < 1e-12);
        }
        let plan = path.plan(Interpolation::Delay, 0.0, 0.5, &inputs);
        assert_eq!(path.segment(&plan, &inputs).at(0.5).0, [0.0; 3]);
    }

    #[test]
    fn the_variation_is_the_difference_of_two_paths() {
        for interpolation in [Interpolation::Auto, Interpolation::HoldVelocity, Interpolation::Delay] {
            for sends in [Sends::Velocities, Sends::Positions, Sends::Derivatives] {
                let path = drive(interpolation, &surge, sends, (0..50).map(|_| 0.2), |_, _| ());
                let now = inputs(&surge, 10.0, sends);
                let plan = path.plan(interpolation, 10.0, 0.2, &now);
                let mut other = now;
                other.values[0][0] += 0.5;
                let variation = path.variation(&plan, &now, [[0.5, 0.0, 0.0], [0.0; 3]]);
                for time in [10.0, 10.07, 10.2] {
                    let (a, b) = (path.segment(&plan, &now).at(time), path.segment(&plan, &other).at(time));
                    assert!((b.0[0] - a.0[0] - variation.at(time).0[0]).abs() < 1e-12);
                    assert!((b.1[0] - a.1[0] - variation.at(time).1[0]).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn a_copy_of_the_memory_gives_the_same_path_bit_for_bit() {
        let mut path = drive(Interpolation::Auto, &surge, Sends::Velocities, random_steps(40), |_, _| ());
        let mut copy = path.clone();
        let now = inputs(&surge, 20.0, Sends::Velocities);
        for path in [&mut path, &mut copy] {
            let plan = path.plan(Interpolation::Auto, 20.0, 0.3, &now);
            let segment = path.segment(&plan, &now);
            path.advance(&plan, &now, &segment, 20.3);
        }
        assert_eq!(path, copy);
    }
}
