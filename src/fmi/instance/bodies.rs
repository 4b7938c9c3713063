//! What lines do to the bodies of an instance, and how that changes in time and with the inputs.

use super::Instance;
use super::built::{Built, BuiltLine, Route, What};
use crate::algebra::rotation;
use crate::error::Error;
use crate::fmi::body_variables::{BodyInput, BodyOutput, Part, number_of};
use crate::fmi::inputs::Inputs;
use crate::fmi::refusal::Refusal;
use crate::fmi::segment::Segment;
use crate::fmi::snapshot::{End, Moment};
use crate::fmi::variables::{Meaning, Variable};
use crate::fmi::vessel::Reached;
use crate::fmi::vessel::pose_path;
use crate::rod::pose::PosePath;
use crate::solve::group::{Differences, EndOf, Group};
use crate::solve::loads;
use crate::solve::motion::Path;
use crate::solve::partition::Together;
use crate::solve::simulation::Outputs;
use nalgebra::Vector3;
use std::sync::Arc;

/// Direction of the inputs of everything: of fairleads given by coordinates, `[line][order][axis]`, and of bodies, `[body][part][axis]`; and of the
/// forces and moments applied to free ones.
#[derive(Debug, Clone)]
pub(super) struct Directions {
    pub lines: Vec<[[f64; 3]; 2]>,
    pub bodies: Vec<[[f64; 3]; 4]>,
    pub applied: Vec<[[f64; 3]; 2]>,
}

impl Directions {
    pub fn is_zero_for(&self, built: &Built, line: usize) -> bool {
        let own = self.lines[line] == [[0.0; 3]; 2];
        own && built.lines[line].mounts.iter().flatten().all(|(body, _)| self.bodies[*body] == [[0.0; 3]; 4])
    }

    /// The same without rates, which change no equilibrium.
    pub fn at_rest(mut self) -> Directions {
        self.lines.iter_mut().for_each(|orders| orders[1] = [0.0; 3]);
        self.bodies.iter_mut().for_each(|parts| (parts[2], parts[3]) = ([0.0; 3], [0.0; 3]));
        self
    }

    /// Whether they move no end of a line of a group and load none of its bodies.
    pub fn move_nothing_of(&self, built: &Built, group: usize) -> bool {
        let together = built.groups[group].together();
        together.lines.iter().all(|line| self.is_zero_for(built, *line))
            && together.bodies.iter().all(|body| self.applied[*body] == [[0.0; 3]; 2])
    }
}

/// Change of everything that outputs are made of.
pub(super) struct Changes {
    pub lines: Vec<Option<Outputs>>,
    /// Of a driven body: change of its position and rotation vector at the end; of a free one, of position, angles, velocity and angular velocity.
    pub bodies: Vec<Vec<Vector3<f64>>>,
    pub points: Vec<[Vector3<f64>; 2]>,
    /// The outputs of lines that change, and position and angles of all bodies, at the time of the change.
    pub outputs: Vec<Option<Outputs>>,
    pub poses: Vec<[Vector3<f64>; 2]>,
}

impl Changes {
    /// Takes over the changes of a group, the next one.
    fn take(&mut self, together: &Together, of: Differences) {
        for (number, line) in together.lines.iter().enumerate() {
            (self.lines[*line], self.outputs[*line]) = (Some(of.lines[number]), Some(of.outputs[number]));
        }
        for ((body, change), pose) in together.bodies.iter().zip(of.bodies).zip(of.poses) {
            (self.bodies[*body], self.poses[*body]) = (change, pose);
        }
        self.points.extend(of.points);
    }
}

/// Change of the path of a fairlead given by coordinates, along a direction of its inputs.
fn fairlead_variation(end: &End, line: &BuiltLine, cutoff: f64, direction: [[f64; 3]; 2]) -> Option<Segment> {
    let Route { plan, inputs, filter, .. } = line.route.as_ref()?;
    let direction = if cutoff > 0.0 {
        // The filter is linear.
        let values = [std::array::from_fn(|axis| end.inputs.values[0][axis] + direction[0][axis]), [0.0; 3]];
        let moved = end.filter.after(cutoff, plan.time(), &Inputs { values, ..Inputs::default() });
        [
            std::array::from_fn(|axis| moved.position[axis] - filter.position[axis]),
            std::array::from_fn(|axis| moved.velocity[axis] - filter.velocity[axis]),
        ]
    } else {
        direction
    };
    Some(end.path.variation(plan, inputs, direction))
}

/// Displacement [m] by which a group is moved to and fro to differentiate its steps,
const SHARE: f64 = 1.0e-2;
/// and at most to differentiate equilibria, as a share of its shortest line: a short one is stiff.
const SLIGHT: f64 = 1.0e-5;
/// Force that counts as a displacement of one metre [N].
const FORCE: f64 = 1.0e5;

/// What is differentiated.
#[derive(Debug, Clone, Copy)]
enum When {
    /// A step up to a time [s].
    Step(f64),
    /// Equilibrium at a time [s].
    Rest(f64),
}

/// The path of a body and that of its variation, where it varies.
type Varied = Option<(Arc<PosePath>, Arc<PosePath>)>;

impl Built {
    /// Differences of what a group tells about itself after a step or in equilibrium, along directions.
    fn group_differences(
        &mut self,
        number: usize,
        when: When,
        directions: &Directions,
        paths: &[Varied],
        moment: &Moment,
    ) -> Result<Differences, Error> {
        let Built { lines, groups, vessels, conventions, filter, .. } = self;
        let group = &mut groups[number];
        let members: Vec<usize> = group.together().lines.clone();
        // An equilibrium is found more closely than a step is solved.
        let (most, least_arm) = match when {
            When::Step(_) => (SHARE, 0.0),
            When::Rest(_) => {
                let shortest = members.iter().map(|index| lines[*index].limits.length).fold(f64::INFINITY, f64::min);
                // Turning a clamp bends the line at once.
                (SHARE.min(SLIGHT * shortest), if group.together().clamped { shortest } else { 0.0 })
            }
        };
        let mut size = f64::MIN_POSITIVE;
        for index in &members {
            directions.lines[*index].iter().flatten().for_each(|x| size = size.max(x.abs()));
        }
        for (of, vessel) in directions.bodies.iter().zip(vessels.iter()) {
            for (part, values) in of.iter().enumerate() {
                let scale = if part % 2 == 1 { vessel.arm.max(least_arm) } else { 1.0 };
                values.iter().for_each(|x| size = size.max(x.abs() * scale));
            }
        }
        directions.applied.iter().flatten().flatten().for_each(|x| size = size.max(x.abs() / FORCE));
        let variations: Vec<Option<Segment>> = members
            .iter()
            .map(|index| fairlead_variation(&moment.ends[*index], &lines[*index], *filter, directions.lines[*index]))
            .collect();
        let drive = |group: &mut Group, share: f64| {
            for (local, index) in members.iter().enumerate() {
                let line = &lines[*index];
                let on = |end: usize| -> Option<Path> {
                    let (body, at) = line.mounts[end].as_ref()?;
                    let base = Arc::clone(&vessels[*body].path);
                    let body = match &paths[*body] {
                        Some((_, by)) if share != 0.0 => Arc::new(PosePath::Moved { of: base, by: Arc::clone(by), share }),
                        _ => base,
                    };
                    Some(Path::OnBody { body, at: *at })
                };
                let moved = variations[local].as_ref().zip(line.route.as_ref()).map(|(variation, route)| {
                    let mut segment = route.segment.clone();
                    for (term, change) in segment.coefficients.iter_mut().zip(&variation.coefficients) {
                        term.iter_mut().zip(change).for_each(|(x, change)| *x += share * change);
                    }
                    segment.path()
                });
                let aside = match (when, &line.ends.fairlead) {
                    (When::Rest(_), Path::Fixed(place)) => {
                        Some(Path::Fixed(place + Vector3::from(directions.lines[*index][0]) * share))
                    }
                    _ => None,
                };
                let fairlead = moved.or(aside).or_else(|| on(0)).unwrap_or_else(|| line.ends.fairlead.clone());
                group.drive(local, EndOf::Fairlead, &fairlead);
                group.drive(local, EndOf::Anchor, &on(1).unwrap_or_else(|| line.ends.anchor.clone()));
            }
            for (index, vessel) in vessels.iter().enumerate() {
                if let Some((_, own)) = vessel.member.filter(|(of, _)| *of == number) {
                    let mut applied = moment.vessels[index].said.applied;
                    for (values, change) in applied.iter_mut().zip(&directions.applied[index]) {
                        values.iter_mut().zip(change).for_each(|(x, change)| *x += share * change);
                    }
                    let turn =
                        if conventions[index].body_loads { group.body(own).rotation } else { nalgebra::Matrix3::identity() };
                    let [force, torque] = applied.map(|values| turn * Vector3::from(conventions[index].turned(values)));
                    group.apply(own, force, torque);
                }
            }
        };
        let share = most / size;
        match when {
            When::Step(until) => group.derivative(until, share, drive),
            When::Rest(time) => group.static_derivative(time, share, drive),
        }
    }
}

impl Instance {
    /// Where bodies are and what the lines do to them, at a time that has been reached.
    pub(super) fn reach(&mut self, time: f64) {
        let Some(built) = &mut self.built else { return };
        let outputs: Vec<Outputs> = self.moment.ends.iter().map(|end| end.outputs).collect();
        let works: Vec<[f64; 2]> = (0..built.lines.len()).map(|line| built.works(line)).collect();
        for (index, vessel) in self.moment.vessels.iter_mut().enumerate() {
            let of = &built.vessels[index];
            let motion = match of.member {
                Some((group, number)) => built.groups[group].body(number),
                None => of.path.at(time),
            };
            let angles = match of.member {
                Some(_) => rotation::angles(&motion.rotation),
                None => of.path.pose(time)[1],
            };
            let (force, moment) = loads::on(&motion.reference.position, &of.hung, &outputs);
            let work = of.hung.iter().map(|(line, anchor)| works[*line][usize::from(*anchor)]).sum();
            vessel.reached = Reached {
                position: motion.reference.position,
                angles,
                velocity: motion.reference.velocity,
                omega: motion.omega,
                force,
                moment,
                work,
            };
        }
        self.moment.points.clear();
        for group in &built.groups {
            for number in 0..group.together().points.len() {
                let point = group.point(number);
                self.moment.points.push((group.together().points[number], [point.position, point.velocity]));
            }
        }
    }

    /// Value of an output of a body or point, in the axes of the master.
    pub(super) fn body_output(&self, variable: &Variable, output: BodyOutput) -> f64 {
        if let BodyOutput::Point(order, axis) = output {
            let point = self.moment.points.iter().find(|(point, _)| *point == variable.line);
            return point.map_or(0.0, |(_, motion)| motion[order][axis]);
        }
        let conventions = self.interface.conventions(&self.moment.parameters)[variable.line];
        let reached = &self.moment.vessels[variable.line].reached;
        let turn = rotation::of_angles(&reached.angles);
        let along = |x: Vector3<f64>, body: bool| conventions.turned(if body { turn.tr_mul(&x) } else { x }.into());
        match output {
            BodyOutput::Force(axis) => along(reached.force, conventions.body_loads)[axis],
            BodyOutput::Moment(axis) => along(reached.moment, conventions.body_loads)[axis],
            BodyOutput::Work => reached.work,
            BodyOutput::Motion(Part::Position, axis) => along(reached.position, false)[axis],
            BodyOutput::Motion(Part::Attitude, axis) => along(reached.angles, false)[axis],
            BodyOutput::Motion(Part::Velocity, axis) => along(reached.velocity, conventions.body_rates)[axis],
            BodyOutput::Motion(Part::AngularVelocity, axis) => along(reached.omega, conventions.body_rates)[axis],
            BodyOutput::Point(..) => 0.0,
        }
    }

    /// Rate of an output of a body or point in time.
    pub(super) fn body_rate(&mut self, body: usize, output: BodyOutput) -> f64 {
        let time = self.moment.clock;
        let conventions = self.interface.conventions(&self.moment.parameters).get(body).copied().unwrap_or_default();
        let Some(built) = &mut self.built else { return 0.0 };
        if let BodyOutput::Point(order, axis) = output {
            for group in &built.groups {
                if let Some(number) = group.together().points.iter().position(|point| *point == body) {
                    let point = group.point(number);
                    return [point.velocity, point.acceleration][order][axis];
                }
            }
            return 0.0;
        }
        let of = &built.vessels[body];
        let motion = match of.member {
            Some((group, number)) => built.groups[group].body(number),
            None => of.path.at(time),
        };
        let reached = &self.moment.vessels[body].reached;
        let (mut force, mut moment, mut work) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for (line, anchor) in built.vessels[body].hung.clone() {
            let (now, rate) = (self.moment.ends[line].outputs, built.output_rates(line));
            let ((place, pull, own), (velocity, change, own_change)) = (now.of_end(anchor), rate.of_end(anchor));
            force += change;
            moment +=
                (velocity - motion.reference.velocity).cross(&pull) + (place - reached.position).cross(&change) + own_change;
            work += pull.dot(&velocity) + own.dot(&motion.omega);
        }
        let turn = motion.rotation;
        let along = |rate: Vector3<f64>, of: Vector3<f64>, body: bool| {
            conventions.turned(if body { turn.tr_mul(&(rate - motion.omega.cross(&of))) } else { rate }.into())
        };
        let angles = || rotation::omega_to_rates(&reached.angles, &motion.omega);
        match output {
            BodyOutput::Force(axis) => along(force, reached.force, conventions.body_loads)[axis],
            BodyOutput::Moment(axis) => along(moment, reached.moment, conventions.body_loads)[axis],
            BodyOutput::Work => work,
            BodyOutput::Motion(Part::Position, axis) => along(motion.reference.velocity, Vector3::zeros(), false)[axis],
            BodyOutput::Motion(Part::Attitude, axis) => along(angles(), Vector3::zeros(), false)[axis],
            BodyOutput::Motion(Part::Velocity, axis) => {
                along(motion.reference.acceleration, motion.reference.velocity, conventions.body_rates)[axis]
            }
            BodyOutput::Motion(Part::AngularVelocity, axis) => along(motion.alpha, motion.omega, conventions.body_rates)[axis],
            BodyOutput::Point(..) => 0.0,
        }
    }

    /// Change of an output of a body or point with what it is made of, in the axes of the master.
    pub(super) fn body_change(&self, body: usize, output: BodyOutput, changes: &Changes) -> f64 {
        if let BodyOutput::Point(order, axis) = output {
            let number = self.moment.points.iter().position(|(point, _)| *point == body);
            return number.and_then(|number| changes.points.get(number)).map_or(0.0, |change| change[order][axis]);
        }
        let Some(built) = &self.built else { return 0.0 };
        let conventions = built.conventions[body];
        let (reached, of) = (&self.moment.vessels[body].reached, &changes.bodies[body]);
        let [position, angles] = changes.poses[body];
        let (mut force, mut moment, mut work) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        let (mut whole, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for (line, anchor) in &built.vessels[body].hung {
            let now = changes.outputs[*line].unwrap_or(self.moment.ends[*line].outputs);
            let (place, pull, own) = now.of_end(*anchor);
            whole += pull;
            torque += (place - position).cross(&pull) + own;
            let Some(change) = &changes.lines[*line] else { continue };
            let (moved, changed, own_changed) = change.of_end(*anchor);
            force += changed;
            moment += (moved - of[0]).cross(&pull) + (place - position).cross(&changed) + own_changed;
            work += if *anchor { 0.0 } else { change.work };
        }
        let turn = rotation::of_angles(&angles);
        let turned = match built.vessels[body].member {
            Some(_) => rotation::rates_to_omega(&angles) * of[1],
            None => of[1],
        };
        let along = |change: Vector3<f64>, of: Vector3<f64>, body: bool| {
            conventions.turned(if body { turn.tr_mul(&(change - turned.cross(&of))) } else { change }.into())
        };
        let free = |number: usize| of.get(number).copied().unwrap_or_else(Vector3::zeros);
        match output {
            BodyOutput::Force(axis) => along(force, whole, conventions.body_loads)[axis],
            BodyOutput::Moment(axis) => along(moment, torque, conventions.body_loads)[axis],
            BodyOutput::Work => work,
            BodyOutput::Motion(Part::Position, axis) => along(free(0), Vector3::zeros(), false)[axis],
            BodyOutput::Motion(Part::Attitude, axis) => along(free(1), Vector3::zeros(), false)[axis],
            BodyOutput::Motion(Part::Velocity, axis) => along(free(2), reached.velocity, conventions.body_rates)[axis],
            BodyOutput::Motion(Part::AngularVelocity, axis) => along(free(3), reached.omega, conventions.body_rates)[axis],
            BodyOutput::Point(..) => 0.0,
        }
    }

    /// Adds a seed of a known input to the directions.
    pub(super) fn add_direction(variable: &Variable, seed: f64, directions: &mut Directions) -> Result<(), Refusal> {
        match variable.meaning {
            Meaning::Input(input) => {
                let (order, axis) = input.component();
                directions.lines[variable.line][order][axis] += seed;
            }
            Meaning::BodyInput(BodyInput::Motion(part, axis)) => directions.bodies[variable.line][number_of(part)][axis] += seed,
            Meaning::BodyInput(BodyInput::Applied(part, axis)) => directions.applied[variable.line][part][axis] += seed,
            _ => {
                let (role, allowed) = ("a known", "knowns are position and velocity of fairleads, and the inputs of bodies");
                return Err(Refusal::Direction { name: variable.name.clone(), role, allowed });
            }
        }
        Ok(())
    }

    /// Changes of outputs in equilibrium along directions of the poses and of the forces applied to free bodies; rates change nothing there.
    pub(super) fn static_changes(&mut self, directions: &Directions) -> Result<Changes, Refusal> {
        let built = self.built.as_mut().ok_or(Refusal::UnknownState)?;
        let time = self.moment.clock;
        let (mut paths, mut of_bodies): (Vec<Varied>, Vec<_>) = (Vec::new(), Vec::new());
        for (index, of) in built.vessels.iter().enumerate() {
            let [position, angles, ..] =
                directions.bodies[index].map(|values| Vector3::from(built.conventions[index].turned(values)));
            let q = of.path.pose(time)[1];
            of_bodies.push(vec![position, rotation::rates_to_omega(&q) * angles]);
            paths.push(Some((Arc::clone(&of.path), Arc::new(PosePath::Fixed { position, angles }))));
        }
        let mut lines = vec![None; built.lines.len()];
        for index in 0..built.lines.len() {
            let line = &mut built.lines[index];
            let ends = [line.ends.fairlead.at(time).position, line.ends.anchor.at(time).position];
            let moved = |end: usize, own: Vector3<f64>| match &line.mounts[end] {
                Some((body, at)) => {
                    let motion = built.vessels[*body].path.at(time);
                    of_bodies[*body][0] + of_bodies[*body][1].cross(&(motion.rotation * at))
                }
                None => own,
            };
            let ways = [moved(0, Vector3::from(directions.lines[index][0])), moved(1, Vector3::zeros())];
            if let What::Own(simulation) = &mut line.what
                && ways.iter().any(|way| *way != Vector3::zeros())
            {
                lines[index] = Some(simulation.static_derivative_ends(ends, ways).map_err(Refusal::Solver)?);
            }
        }
        let poses = built.vessels.iter().map(|of| of.path.pose(time)).collect();
        let outputs = vec![None; lines.len()];
        let mut changes = Changes { lines, bodies: of_bodies, points: Vec::new(), outputs, poses };
        for group in 0..built.groups.len() {
            if directions.move_nothing_of(built, group) {
                let points = built.groups[group].together().points.len();
                changes.points.resize(changes.points.len() + points, [Vector3::zeros(); 2]);
                continue;
            }
            let differences = built.group_differences(group, When::Rest(time), directions, &paths, &self.moment);
            changes.take(built.groups[group].together(), differences.map_err(Refusal::Solver)?);
        }
        Ok(changes)
    }

    /// Changes at a time along directions of the inputs now.
    pub(super) fn changes(&mut self, until: f64, directions: &Directions) -> Result<Changes, Refusal> {
        let built = self.built.as_mut().ok_or(Refusal::UnknownState)?;
        let cutoff = built.filter;
        // Paths of the changes of bodies.
        let mut paths: Vec<Varied> = Vec::new();
        let mut of_bodies = Vec::new();
        for (index, of) in built.vessels.iter().enumerate() {
            let (path, change) = match &of.voyage {
                Some(voyage) if directions.bodies[index] != [[0.0; 3]; 4] => {
                    let vessel = &self.moment.vessels[index];
                    let by = vessel.variation(voyage, &built.conventions[index], of.arm, cutoff, &directions.bodies[index]);
                    let by = Arc::new(pose_path(&by, of.arm));
                    let ([position, angles], [_, q]) = (by.pose(until), of.path.pose(until));
                    let variation = Arc::new(PosePath::Variation { of: Arc::clone(&of.path), by: Arc::clone(&by) });
                    (Some((variation, by)), vec![position, rotation::rates_to_omega(&q) * angles])
                }
                _ => (None, vec![Vector3::zeros(); 2]),
            };
            paths.push(path);
            of_bodies.push(change);
        }
        let mut lines = vec![None; built.lines.len()];
        let mut outputs = vec![None; built.lines.len()];
        let poses: Vec<[Vector3<f64>; 2]> = built.vessels.iter().map(|of| of.path.pose(until)).collect();
        for index in 0..built.lines.len() {
            if directions.is_zero_for(built, index) || !built.lines[index].is_own() {
                continue;
            }
            let fairlead = fairlead_variation(&self.moment.ends[index], &built.lines[index], cutoff, directions.lines[index]);
            let fairlead = fairlead.map(|segment| segment.path());
            let segments = built.lines[index].segments(&built.vessels);
            let line = &mut built.lines[index];
            let on = |end: usize| -> Option<Path> {
                let (body, at) = line.mounts[end].as_ref()?;
                Some(match &paths[*body] {
                    Some((variation, _)) => Path::OnBody { body: Arc::clone(variation), at: *at },
                    None => Path::Fixed(Vector3::zeros()),
                })
            };
            let still = Path::Fixed(Vector3::zeros());
            let variation = fairlead.or_else(|| on(0)).unwrap_or(still);
            let anchor = on(1);
            let What::Own(simulation) = &mut line.what else { continue };
            let kept = line.linearised.take().filter(|(end, along, _)| *end == until && *along == segments);
            let kept = match kept {
                Some(kept) => kept,
                None => (until, segments, simulation.linearise_ends(until, &line.ends).map_err(Refusal::Solver)?),
            };
            let (_, _, steps) = line.linearised.insert(kept);
            lines[index] = Some(simulation.derivative_ends(steps, &variation, anchor.as_ref()).map_err(Refusal::Solver)?);
            outputs[index] = simulation.outputs_at_end(steps);
        }
        let mut changes = Changes { lines, bodies: of_bodies, points: Vec::new(), outputs, poses };
        for group in 0..built.groups.len() {
            let differences = built.group_differences(group, When::Step(until), directions, &paths, &self.moment);
            changes.take(built.groups[group].together(), differences.map_err(Refusal::Solver)?);
        }
        Ok(changes)
    }
}
