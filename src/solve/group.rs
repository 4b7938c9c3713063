//! Lines that hang on free bodies and points, through statics and time together: one step for all, so that what joins them is solved for with them.

use crate::error::{Adrift, Error, Trouble};
use crate::rod::clamp::{Clamp, Holder};
use crate::rod::cylinder::{Load, Surround};
use crate::rod::line::Supports;
use crate::rod::mesh::Mesh;
use crate::rod::morison::Sea;
use crate::rod::physics::{self, Surroundings};
use crate::rod::pose::{BodyMotion, Kinematics};
use crate::rod::rigid::Rigid;
use crate::rod::state::{Field, State};
use crate::rod::system::{Link, Links, System};
use crate::scene::bodies::Mount;
use crate::scene::read::Loaded;
use crate::scene::types::{Attachment, Scene, Surface};
use crate::sea::clock::Clock;
use crate::sea::current::Current;
use crate::sea::waves::Waves;
use crate::solve::between::Place;
use crate::solve::controller::{self, Controller, Demands, Failure};
use crate::solve::motion::{Ends, Path};
use crate::solve::network::Network;
use crate::solve::newton::{Criteria, Newton};
use crate::solve::outputs;
use crate::solve::partition::Together;
use crate::solve::scheme::{Bench, Moment, Stages};
use crate::solve::simulation::{Counters, LastStep, NodeOutput, Outputs, Simulation};
use crate::solve::snapshot::Snapshot;
use nalgebra::{Matrix3, Vector3};

mod rest;
mod statics;
mod whole;

/// Outputs of the lines of a group, motions of its bodies and of its points.
type Everything = (Vec<Outputs>, Vec<Vec<Vector3<f64>>>, Vec<[Vector3<f64>; 2]>);

/// Which end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndOf {
    /// s = 0.
    Fairlead,
    /// s = L.
    Anchor,
}

/// Changes of what a group tells about itself.
#[derive(Debug, Clone)]
pub struct Differences {
    /// Of the outputs of its lines.
    pub lines: Vec<Outputs>,
    /// These outputs themselves.
    pub outputs: Vec<Outputs>,
    /// Position and angles of its bodies themselves.
    pub poses: Vec<[Vector3<f64>; 2]>,
    /// Of position, angles, velocity and angular velocity of its bodies.
    pub bodies: Vec<Vec<Vector3<f64>>>,
    /// Of position and velocity of its points.
    pub points: Vec<[Vector3<f64>; 2]>,
}

/// Lines, free bodies and free points that move together.
pub struct Group {
    together: Together,
    /// Each line alone: its mesh, its statics between given ends, and what it tells about itself.
    simulations: Vec<Simulation>,
    /// First node of each line.
    starts: Vec<usize>,
    network: Network,
    newton: Newton,
    controller: Controller,
    demands: Demands,
    moment: Moment,
    fresh: bool,
    /// The state is known to be at rest. Not a part of it: the same is found from it again.
    resting: bool,
    /// Nothing but its driven ends and what pulls at its bodies moves it.
    may_rest: bool,
    tolerance: f64,
    last: LastStep,
    /// Error allowed to each line [m].
    errors: Vec<f64>,
    /// Work done on what moves each driven end [J], and whether it is summed up.
    works: Vec<f64>,
    sums_work: bool,
    names: Vec<String>,
    /// Nodes of bodies, then of points.
    masters: Vec<usize>,
    /// Statics left an unstable equilibrium on the way here: there are others.
    others: bool,
    before: Option<Box<Snapshot>>,
}

/// Increments of bodies and points that are left of an iteration, as a share of the error of a step.
const LOOSE: f64 = 1.0e-2;
/// Largest share of the tolerance that an error of position may be of the reach of a body that no line holds.
const ALONE: f64 = 1.0e-2;

impl Group {
    /// The part `together` of a checked scene; `ends` are the paths of the ends of its lines, in their order, of which those on what is free
    /// do not count.
    pub fn new(loaded: &Loaded, together: &Together, ends: &[Ends]) -> Result<Group, Error> {
        let scene = &loaded.scene;
        let mut group = Group::on_meshes(scene, together, ends)?;
        for (number, body) in together.bodies.iter().enumerate() {
            group.network.bodies[number].in_time = loaded.body_loads.get(*body).cloned().flatten();
        }
        // Meshes are made for lines as the scene puts their ends; free ones come to rest elsewhere.
        let start = ends.first().map_or(0.0, |_| scene.run.start);
        if group.settle(start).is_ok() {
            let mut placed = scene.clone();
            group.place_in(&mut placed);
            let mut finer = Group::on_meshes(&placed, together, ends)?;
            finer.take_poses_of(scene, &group);
            group = finer;
        }
        Ok(group)
    }

    fn on_meshes(scene: &Scene, together: &Together, ends: &[Ends]) -> Result<Group, Error> {
        let simulations: Vec<Simulation> =
            together.lines.iter().map(|index| Simulation::on_ends(scene, *index, None)).collect::<Result<_, _>>()?;
        let meshes: Vec<&Mesh> = simulations.iter().map(|simulation| simulation.line().mesh()).collect();
        let count = together.bodies.len() + together.points.len();
        let (mesh, starts) = Mesh::side_by_side(&meshes, count);
        let first_master = mesh.nodes() - count;
        let masters: Vec<usize> = (first_master..mesh.nodes()).collect();
        let number_of = |on: &Mount| -> Option<usize> {
            match on {
                Mount::Body { body, .. } => together.bodies.iter().position(|own| scene.bodies[*own].name == *body),
                Mount::Point { point } => {
                    let point = together.points.iter().position(|own| scene.points[*own].name == *point)?;
                    Some(together.bodies.len() + point)
                }
            }
        };
        let mut supports = Supports::default();
        let (mut links, mut arms, mut driven) = (Links { masters: masters.clone(), ..Links::default() }, Vec::new(), Vec::new());
        for (local, (simulation, start)) in simulations.iter().zip(&starts).enumerate() {
            let (own, line) = (simulation.supports(), &scene.lines[together.lines[local]]);
            let last = start + simulation.line().last();
            links.ranges.push((*start, last + 1));
            links.elements.push(simulation.elements());
            supports.fixed.extend(own.fixed.iter().map(|(node, component)| (start + node, *component)));
            supports.loads.extend(own.loads.iter().map(|(node, force)| (start + node, *force)));
            supports
                .bodies
                .extend(own.bodies.iter().map(|body| crate::rod::body::Body { node: start + body.node, ..body.clone() }));
            supports.holds.extend(own.holds.iter().map(|hold| crate::rod::hold::Hold {
                first: start + hold.first,
                node: start + hold.node,
                ..hold.clone()
            }));
            supports.clamps.extend(own.clamps.iter().map(|clamp| Clamp { node: start + clamp.node, ..clamp.clone() }));
            let mut slot = 0;
            for (node, on, path) in
                [(*start, &line.anchor_on, &ends[local].anchor), (last, &line.fairlead_on, &ends[local].fairlead)]
            {
                match on.as_ref().and_then(|on| Some((on, number_of(on)?))) {
                    Some((on, master)) => {
                        supports.fixed.retain(|(fixed, _)| *fixed != node);
                        links.links.push(Link { node, master, line: local, slot });
                        arms.push(if let Mount::Body { at, .. } = on { Some(Vector3::from(*at)) } else { None });
                        slot += 1;
                        if let Some(clamp) = supports.clamps.iter_mut().find(|clamp| clamp.node == node) {
                            clamp.body = Holder::Free { node: masters[master], frame: master };
                            links.clamped.push(Link { node, master, line: local, slot });
                            slot += 1;
                        }
                    }
                    None if supports.fixed.contains(&(node, 0)) => driven.push((node, path.clone())),
                    None => {}
                }
            }
        }
        let around = surround(scene);
        let bodies: Vec<Rigid> = together
            .bodies
            .iter()
            .enumerate()
            .map(|(number, body)| Rigid::new(&scene.bodies[*body], &scene.environment, around.clone(), masters[number], number))
            .collect();
        let mut pulls = Vec::new();
        for (number, point) in together.points.iter().enumerate() {
            let (point, node) = (&scene.points[*point], masters[together.bodies.len() + number]);
            let as_body = Attachment {
                s: 0.0,
                mass: point.mass,
                volume: point.volume,
                drag_area: point.drag_area,
                added_mass: point.added_mass,
            };
            supports.bodies.push(physics::body_of(&scene.environment, node, &as_body));
            pulls.push((node, point.force.into()));
        }
        let surroundings = Surroundings::of(scene, &mesh);
        let crossing =
            simulations.iter().map(|simulation| simulation.demands().finest_step).fold(scene.solver.max_step, f64::min);
        let shortest = simulations.iter().map(|simulation| simulation.line().mesh().length).fold(f64::INFINITY, f64::min);
        let reach = bodies.iter().map(Rigid::reach).fold(0.0, f64::max);
        let length = if shortest.is_finite() { shortest } else { reach.max(1.0) };
        let tolerance = simulations.iter().map(|simulation| simulation.demands().criteria.tolerance).fold(1.0e-5, f64::min);
        let lonely = simulations.is_empty();
        let held = !supports.holds.is_empty() || scene.environment.seabed.friction > 0.0;
        let moved_by_water = Waves::of(&scene.environment).is_some();
        links.timeless = !held && supports.clamps.is_empty() && !moved_by_water;
        let rod = physics::build(mesh, surroundings, supports);
        let slopes: Vec<usize> = masters[together.bodies.len()..].to_vec();
        let mut network = Network::new(rod, bodies, links, arms, driven, pulls, &slopes);
        if lonely {
            network.fixed.extend((0..6).map(|c| (0, c)));
        }
        network.clamp();
        let names = together
            .bodies
            .iter()
            .map(|body| format!("body \"{}\"", scene.bodies[*body].name))
            .chain(together.points.iter().map(|point| format!("point \"{}\"", scene.points[*point].name)))
            .collect();
        let (nodes, works, errors) = (network.nodes(), vec![0.0; network.driven.len()], vec![0.0; simulations.len()]);
        let newton = Newton::new(&network);
        let mut moment = controller::at_rest(&network, 0.0, scene.solver.max_step);
        moment.state.frames = vec![Matrix3::identity(); together.bodies.len()];
        let mut group = Group {
            together: together.clone(),
            simulations,
            starts,
            newton,
            controller: Controller::new(scene.solver.scheme, nodes),
            demands: Demands {
                error: ALONE * scene.solver.tolerance * length,
                finest_step: crossing,
                max_step: scene.solver.max_step,
                fixed_step: scene.solver.uncontrolled_step(),
                criteria: Criteria { tolerance, length, emphasis: 1.0, iterations: 12, loose: 0.0, enough: 0.0 },
            },
            moment,
            network,
            fresh: true,
            resting: false,
            may_rest: !lonely && !moved_by_water && !held,
            tolerance: scene.solver.tolerance,
            last: LastStep::default(),
            errors,
            works,
            sums_work: false,
            names,
            masters,
            others: false,
            before: None,
        };
        group.emphasise();
        group.put_as_in(scene);
        Ok(group)
    }

    /// Iterates bodies and points as closely as the error of a step asks.
    fn emphasise(&mut self) {
        let Criteria { tolerance, length, .. } = self.demands.criteria;
        self.demands.criteria.emphasis = (tolerance * length / (LOOSE * self.demands.error)).max(1.0);
    }

    /// Puts free bodies and points where a scene has them.
    fn put_as_in(&mut self, scene: &Scene) {
        let state = &mut self.moment.state;
        for (number, body) in self.together.bodies.iter().enumerate() {
            let body = &scene.bodies[*body];
            state.u.set_position(self.masters[number], &body.position.into());
            state.u.set_slope(self.masters[number], &Vector3::zeros());
            state.frames[number] = crate::algebra::rotation::of_angles(&body.attitude());
        }
        for (number, point) in self.together.points.iter().enumerate() {
            state.u.set_position(self.masters[self.together.bodies.len() + number], &scene.points[*point].position.into());
        }
    }

    /// Tells a scene where its free bodies and points are.
    pub fn place_in(&self, scene: &mut Scene) {
        for number in 0..self.together.bodies.len() {
            let motion = self.body(number);
            let body = &mut scene.bodies[self.together.bodies[number]];
            body.position = motion.reference.position.into();
            body.attitude_deg = crate::algebra::rotation::angles(&motion.rotation).map(f64::to_degrees).into();
        }
        for number in 0..self.together.points.len() {
            scene.points[self.together.points[number]].position = self.point(number).position.into();
        }
        scene.place_ends();
    }

    /// Poses of the scene as it is written, from which stiffnesses count, and of another group as a place to start from.
    fn take_poses_of(&mut self, scene: &Scene, other: &Group) {
        let around = surround(scene);
        for (number, body) in self.together.bodies.iter().enumerate() {
            let rigid = &mut self.network.bodies[number];
            *rigid = Rigid::new(&scene.bodies[*body], &scene.environment, around.clone(), rigid.node, rigid.frame);
            rigid.in_time.clone_from(&other.network.bodies[number].in_time);
        }
        self.others = other.others;
        self.moment.state.frames.clone_from(&other.moment.state.frames);
        for (own, others) in self.masters.iter().zip(&other.masters) {
            self.moment.state.u.set_position(*own, &other.moment.state.u.position(*others));
            self.moment.state.u.set_slope(*own, &other.moment.state.u.slope(*others));
        }
    }

    /// Lines, bodies and points, by their numbers in the scene.
    pub fn together(&self) -> &Together {
        &self.together
    }

    /// Sets the path of a driven end of one of its lines.
    pub fn drive(&mut self, local: usize, end: EndOf, path: &Path) {
        let node = self.node_of(local, end);
        if let Some((_, own)) = self.network.driven.iter_mut().find(|(driven, _)| *driven == node) {
            own.clone_from(path);
        }
        if self.together.clamped {
            self.network.clamp();
        }
    }

    /// Sets the force [N] and moment [N·m] that the master applies to a free body.
    pub fn apply(&mut self, number: usize, force: Vector3<f64>, moment: Vector3<f64>) {
        if let Some(body) = self.network.bodies.get_mut(number) {
            self.resting &= body.applied == Load { force, moment };
            body.applied = Load { force, moment };
        }
    }

    /// Advances to a time with its driven ends on their paths. On an error the state is the one before the call.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
        let begin = self.moment.state.clock.now;
        self.check_paths(until)?;
        self.mark();
        if self.rests(until) {
            (self.moment.state.clock.now, self.last) = (until, LastStep::default());
            return Ok(());
        }
        let (effort, steps) = (self.newton.effort, self.controller.tally.steps);
        self.controller.tally.error = 0.0;
        match self.begin().and_then(|()| self.run(until)) {
            Ok(()) => {
                self.last = LastStep {
                    substeps: self.controller.tally.steps - steps,
                    newton_iterations: self.newton.effort.iterations - effort.iterations,
                    error_estimate: self.controller.tally.error,
                };
                Ok(())
            }
            Err(failure) => {
                let error = self.failed(&failure, begin);
                self.undo();
                Err(error)
            }
        }
    }

    fn begin(&mut self) -> Result<(), Failure> {
        if !std::mem::take(&mut self.fresh) {
            return Ok(());
        }
        let now = self.moment.state.clock;
        let (mut bench, moment) = self.bench();
        bench.prescribe(&mut moment.state, now);
        bench.accelerate(&mut moment.state).map_err(|stall| Failure { time: now.now, step: 0.0, stall: Some(stall) })
    }

    fn run(&mut self, until: f64) -> Result<(), Failure> {
        let demands = self.demands;
        let nowhere = Path::Fixed(Vector3::zeros());
        let mut bench = Bench {
            line: &self.network,
            newton: &mut self.newton,
            path: &nowhere,
            anchor: None,
            criteria: demands.criteria,
            allowed: demands.error,
            stages: Stages::Solve,
        };
        let network = &self.network;
        if !self.sums_work {
            return self.controller.advance(&mut bench, &demands, &mut self.moment, until, |_, _| {});
        }
        let (mut room, works) = (Field::new(network.nodes()), &mut self.works);
        // Force on what drives each end, place, and the power of the moment where the end is clamped.
        let mut ends = |moment: &Moment| -> Vec<(Vector3<f64>, Vector3<f64>, f64)> {
            let at = crate::solve::newton::motion(&moment.state);
            network.rod.residual(&at, &mut room);
            let end = |(node, path): &(usize, Path)| {
                (-room.position(*node), moment.state.u.position(*node), network.clamp_power(*node, path, &at))
            };
            network.driven.iter().map(end).collect()
        };
        let mut before = ends(&self.moment);
        self.controller.advance(&mut bench, &demands, &mut self.moment, until, |moment, leg| {
            let now = ends(moment);
            for ((work, before), now) in works.iter_mut().zip(&before).zip(&now) {
                *work += 0.5 * ((before.0 + now.0).dot(&(now.1 - before.1)) + (before.2 + now.2) * leg.h);
            }
            before = now;
        })
    }

    /// From now on the work done on what drives its ends is summed up.
    pub fn sum_up_work(&mut self) {
        self.sums_work = true;
    }

    /// Work done on what drives an end of one of its lines [J]; zero for one that hangs on what is free.
    pub fn work(&self, local: usize, end: EndOf) -> f64 {
        let node = self.node_of(local, end);
        let number = self.network.driven.iter().position(|(driven, _)| *driven == node);
        number.map_or(0.0, |number| self.works[number])
    }

    fn node_of(&self, local: usize, end: EndOf) -> usize {
        self.starts[local] + if end == EndOf::Anchor { 0 } else { self.simulations[local].line().last() }
    }

    /// Rates of the outputs of one of its lines in time.
    pub fn output_rates(&mut self, local: usize) -> Outputs {
        self.shown(local).output_rates()
    }

    /// Change of the outputs of its lines, and of its bodies and points, at a time per share of changed paths, by a central difference of steps
    /// repeated; `drive` puts the driven ends and the applied forces of the share in place. Stays as it is.
    pub fn derivative(&mut self, until: f64, share: f64, drive: impl FnMut(&mut Group, f64)) -> Result<Differences, Error> {
        self.differences(share, drive, |group| group.advance(until))
    }

    /// The same in equilibrium at a time.
    pub fn static_derivative(&mut self, time: f64, share: f64, drive: impl FnMut(&mut Group, f64)) -> Result<Differences, Error> {
        self.differences(share, drive, |group| group.settle(time).map(drop))
    }

    fn differences(
        &mut self,
        share: f64,
        mut drive: impl FnMut(&mut Group, f64),
        go: impl Fn(&mut Group) -> Result<(), Error>,
    ) -> Result<Differences, Error> {
        let mut now = Snapshot::new(self.network.nodes());
        self.save(&mut now);
        let (tally, effort, before, others) = (self.controller.tally, self.newton.effort, self.before.take(), self.others);
        let mut at = |group: &mut Group, share: f64| {
            drive(group, share);
            let outcome = go(group).map(|()| group.all());
            group.restore(&now);
            outcome
        };
        let after = at(self, share);
        let ends = after.and_then(|after| Ok((after, at(self, -share)?)));
        // Whatever failed: driven as before.
        let here = at(self, 0.0);
        (self.controller.tally, self.newton.effort, self.before, self.others) = (tally, effort, before, others);
        let ((after, before), here) = (ends?, here?);
        let per = 0.5 / share;
        Ok(Differences {
            outputs: here.0,
            poses: here.1.iter().map(|body| [body[0], body[1]]).collect(),
            lines: after.0.iter().zip(&before.0).map(|(a, b)| outputs::difference(a, b, per)).collect(),
            bodies: after.1.iter().zip(&before.1).map(|(a, b)| a.iter().zip(b).map(|(x, y)| (x - y) * per).collect()).collect(),
            points: after.2.iter().zip(&before.2).map(|(a, b)| [0, 1].map(|order: usize| (a[order] - b[order]) * per)).collect(),
        })
    }

    /// Outputs of lines; position, angles, velocity and angular velocity of bodies; position and velocity of points.
    fn all(&mut self) -> Everything {
        let lines = (0..self.simulations.len()).map(|local| self.outputs(local)).collect();
        let body = |number: usize| {
            let motion = self.body(number);
            let angles = crate::algebra::rotation::angles(&motion.rotation);
            vec![motion.reference.position, angles, motion.reference.velocity, motion.omega]
        };
        let bodies = (0..self.together.bodies.len()).map(body).collect();
        let points = (0..self.together.points.len()).map(|number| {
            let point = self.point(number);
            [point.position, point.velocity]
        });
        (lines, bodies, points.collect())
    }

    fn bench(&mut self) -> (Bench<'_>, &mut Moment) {
        static NOWHERE: Path = Path::Fixed(Vector3::new(0.0, 0.0, 0.0));
        let bench = Bench {
            line: &self.network,
            newton: &mut self.newton,
            path: &NOWHERE,
            anchor: None,
            criteria: self.demands.criteria,
            allowed: self.demands.error,
            stages: Stages::Solve,
        };
        (bench, &mut self.moment)
    }

    /// Driven ends begin where they are, with numbers.
    fn check_paths(&self, until: f64) -> Result<(), Error> {
        let (time, state) = (self.moment.state.clock.now, &self.moment.state);
        for (node, path) in &self.network.driven {
            let (from, to) = (path.at(time), path.at(until));
            let finite = |k: &Kinematics| [k.position, k.velocity, k.acceleration].iter().flatten().all(|x| x.is_finite());
            let jump = (from.position - state.u.position(*node)).norm();
            let local = self.line_of(*node);
            let length = self.simulations[local].line().mesh().length;
            if !(finite(&from) && finite(&to) && until.is_finite()) || jump > 1e-6 * length {
                let cause = if finite(&from) && finite(&to) {
                    crate::error::Cause::Jump { distance: jump }
                } else {
                    crate::error::Cause::BadMotion
                };
                return Err(self.simulations[local].refused(cause, until, to.velocity.norm(), *node == self.starts[local]));
            }
        }
        Ok(())
    }

    fn line_of(&self, node: usize) -> usize {
        self.starts.partition_point(|start| *start <= node).saturating_sub(1)
    }

    fn failed(&mut self, failure: &Failure, last_good_time: f64) -> Error {
        let node = failure.stall.map_or(0, |stall| stall.node());
        if let Some(number) = self.masters.iter().position(|master| *master == node) {
            let trouble = Trouble::Stuck { step: failure.step, last_good_time };
            return Error::Network(Box::new(Adrift { what: self.names[number].clone(), time: failure.time, trouble }));
        }
        if self.simulations.is_empty() {
            let trouble = Trouble::Stuck { step: failure.step, last_good_time };
            return Error::Network(Box::new(Adrift { what: self.names.concat(), time: failure.time, trouble }));
        }
        let local = self.line_of(node);
        let start = self.starts[local];
        let here = Failure { stall: failure.stall.map(|stall| stall.moved_back(start)), ..*failure };
        let moment = self.moment.clone();
        self.simulations[local].show(&moment, start, [0.0; 2]);
        self.simulations[local].failed(&here, &Path::Fixed(Vector3::zeros()), last_good_time)
    }

    /// Lets the lines be seen as they are now.
    fn shown(&mut self, local: usize) -> &mut Simulation {
        self.simulations[local].show(&self.moment, self.starts[local], [0.0; 2]);
        &mut self.simulations[local]
    }

    /// Outputs of one of its lines now.
    pub fn outputs(&mut self, local: usize) -> Outputs {
        self.shown(local).observe()
    }

    /// Nodes of one of its lines now, from the fairlead.
    pub fn nodes(&mut self, local: usize) -> Vec<NodeOutput> {
        self.shown(local).nodes()
    }

    /// What one of its lines is like now at arc lengths from its fairlead [m].
    pub fn places(&mut self, local: usize, at: &[f64]) -> Vec<Place> {
        self.shown(local).places(at)
    }

    /// One of its lines, to be asked about mesh and physics.
    pub fn line(&self, local: usize) -> &Simulation {
        &self.simulations[local]
    }

    /// Motion of one of its bodies now.
    pub fn body(&self, number: usize) -> BodyMotion {
        let motion = self.network.bodies[number].motion(&crate::solve::newton::motion(&self.moment.state));
        let (position, velocity, acceleration) = (motion.position, motion.velocity, motion.acceleration);
        BodyMotion {
            reference: Kinematics { position, velocity, acceleration },
            rotation: motion.rotation,
            omega: motion.omega,
            alpha: motion.alpha,
        }
    }

    /// Motion of one of its points now.
    pub fn point(&self, number: usize) -> Kinematics {
        let (node, state) = (self.masters[self.together.bodies.len() + number], &self.moment.state);
        Kinematics { position: state.u.position(node), velocity: state.v.position(node), acceleration: state.a.position(node) }
    }

    /// Gives one of its bodies a velocity [m/s] and an angular velocity [rad/s]; the next step begins from there.
    pub fn push(&mut self, number: usize, velocity: Vector3<f64>, omega: Vector3<f64>) {
        let node = self.masters[number];
        self.moment.state.v.set_position(node, &velocity);
        self.moment.state.v.set_slope(node, &omega);
        self.network.follow(&mut self.moment.state);
        (self.fresh, self.resting) = (true, false);
    }

    /// Puts one of its bodies into a pose, its lines as they are but for the ends that hang on it; the next step begins from there.
    pub fn pose(&mut self, number: usize, position: Vector3<f64>, rotation: Matrix3<f64>) {
        let node = self.masters[number];
        self.moment.state.u.set_position(node, &position);
        self.moment.state.u.set_slope(node, &Vector3::zeros());
        self.moment.state.frames[number] = rotation;
        self.network.follow(&mut self.moment.state);
        (self.fresh, self.resting) = (true, false);
    }

    /// Sets the constant force on one of its points [N]; the next step begins with it.
    pub fn pull(&mut self, number: usize, force: Vector3<f64>) {
        if let Some((_, own)) = self.network.pulls.get_mut(number) {
            *own = force;
        }
        (self.fresh, self.resting) = (true, false);
    }

    /// Momentum of one of its lines [kg·m/s] and its moment about the origin [kg·m²/s], by the shapes of its elements; the water apart.
    pub fn line_momentum(&mut self, local: usize) -> (Vector3<f64>, Vector3<f64>) {
        let simulation = self.shown(local);
        let (mesh, state) = (simulation.line().mesh(), simulation.state());
        let (mut momentum, mut turning) = (Vector3::zeros(), Vector3::zeros());
        for (e, element) in mesh.elements.iter().enumerate().filter(|(_, element)| !element.is_joint()) {
            for crate::algebra::shape::GaussPoint { x, weight } in crate::algebra::shape::GAUSS3 {
                let n = crate::algebra::shape::Shape::at(x).scaled(element.length).value;
                let at = |field: &Field| {
                    field.position(e) * n[0] + field.slope(e) * n[1] + field.position(e + 1) * n[2] + field.slope(e + 1) * n[3]
                };
                let part = at(&state.v) * (weight * element.length * mesh.properties_of(e).mass);
                momentum += part;
                turning += at(&state.u).cross(&part);
            }
        }
        (momentum, turning)
    }

    /// Time now [s].
    pub fn time(&self) -> f64 {
        self.moment.state.clock.now
    }

    /// The last `advance`.
    pub fn last_step(&self) -> LastStep {
        self.last
    }

    /// Work done by the solver, all lines together.
    pub fn counters(&self) -> Counters {
        let (tally, effort) = (&self.controller.tally, &self.newton.effort);
        Counters {
            steps: tally.steps,
            rejected_steps: tally.rejected,
            unresolved_steps: tally.unresolved,
            pushing_steps: 0,
            newton_iterations: effort.iterations,
            factorisations: effort.factorisations,
            element_iterations: effort.iterations * self.elements() - effort.spared,
        }
    }

    /// Elements of all its lines.
    pub fn elements(&self) -> usize {
        self.simulations.iter().map(Simulation::elements).sum()
    }

    /// The complete state.
    pub fn save(&self, snapshot: &mut Snapshot) {
        let lists = [&self.works[..], &self.errors];
        snapshot.keep(&self.moment, self.newton.memory(), lists, self.demands.error, self.fresh, self.last);
    }

    /// Puts back a state of this group; false, and nothing changed, if it is not one.
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        if !self.fits(snapshot) {
            return false;
        }
        let lists = [&mut self.works[..], &mut self.errors];
        let (error, fresh, last) = snapshot.bring_back(&mut self.moment, &mut self.newton, lists);
        (self.demands.error, self.fresh, self.last, self.resting) = (error, fresh, last, false);
        self.emphasise();
        self.network.allow(&self.errors, error);
        true
    }

    /// Whether a state is one of this group.
    pub fn fits(&self, snapshot: &Snapshot) -> bool {
        snapshot.nodes() == self.network.nodes()
            && snapshot.bodies() == self.together.bodies.len()
            && snapshot.driven_and_lines() == self.works.len() + self.errors.len()
            && snapshot.holding_nodes() == self.network.holding_nodes()
            && snapshot.fits_parts(self.errors.len() + self.masters.len())
    }

    /// Takes the last `advance` back.
    pub fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.restore(&before);
            self.before = Some(before);
        }
    }

    fn mark(&mut self) {
        let mut before = self.before.take().unwrap_or_else(|| Box::new(Snapshot::new(self.network.nodes())));
        self.save(&mut before);
        self.before = Some(before);
    }
}

fn surround(scene: &Scene) -> Surround {
    let environment = &scene.environment;
    let waves = Waves::of(environment).map(|waves| waves.good_to(scene.solver.tolerance));
    let current = Current::new(&environment.current);
    let flows = waves.is_some() || !current.is_still();
    let sea = flows
        .then(|| Sea { waves: waves.unwrap_or_else(|| Waves::new(&[], environment.gravity, environment.depth, 0.0)), current });
    Surround {
        sea,
        surface: environment.surface == Surface::Pierced,
        density: environment.water_density,
        gravity: environment.gravity,
    }
}

/// Moments of what lines do not hold: nothing moves.
pub(in crate::solve) fn still(network: &Network, time: f64, frames: &[Matrix3<f64>]) -> State {
    let holds = Field::new(network.holding_nodes());
    State { clock: Clock::at_rest(time), holds, frames: frames.to_vec(), ..State::new(network.nodes()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::motion::Weights;
    use crate::scene::read;
    use crate::solve::newton::motion;
    use crate::solve::partition;

    /// Five points in a row, each held to the bed and joined to the next, the first to a ship that moves.
    fn row_of_points() -> Loaded {
        let (mut lines, mut points) = (Vec::new(), Vec::new());
        for k in 0..5 {
            let x = -200.0 * f64::from(k);
            points.push(format!(
                r#"{{"name": "p{k}", "position": [{x}, 0, -40], "mass": 3000.0, "volume": 25.0, "drag_area": 6.0}}"#
            ));
            let from =
                if k == 0 { r#"{"body": "ship", "at": [0, 0, 0]}"#.to_owned() } else { format!(r#"{{"point": "p{}"}}"#, k - 1) };
            let line = |name: &str, from: &str, to: &str, length: f64| {
                format!(
                    r#"{{"name": "{name}{k}", "fairlead": {from}, "anchor": {to}, "sections": [{{"type": "rope", "length": {length}, "elements": 10}}]}}"#
                )
            };
            let point = format!(r#"{{"point": "p{k}"}}"#);
            lines.push(line("leg", &point, &format!("[{x}, 60, -150]"), 124.0));
            lines.push(line("span", &from, &point, if k == 0 { 212.0 } else { 206.0 }));
        }
        let text = format!(
            r#"{{"environment": {{"depth": 150}}, "lines": [{}], "points": [{}],
            "line_types": {{"rope": {{"ea": 2e8, "mass": 30, "diameter": 0.14, "submerged_weight": 140, "drag": {{"normal": 1.2}}, "added_mass": {{"normal": 1.0}}}}}},
            "bodies": [{{"name": "ship", "position": [200, 0, -10], "motion": {{"kind": "sinusoidal", "period": 12, "sine": [2, 1, 0.7, 0, 0, 0], "ramp": 12}}}}]}}"#,
            lines.join(","),
            points.join(",")
        );
        read::parse(&text, "test", std::path::Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same at rest.
    fn row_of_lines() -> Group {
        let loaded = row_of_points();
        let together = &partition::parts(&loaded.scene)[0];
        let ends: Vec<Ends> = together.lines.iter().map(|index| Ends::of_scene(&loaded, *index)).collect();
        let mut group = Group::new(&loaded, together, &ends).unwrap();
        group.settle(0.0).unwrap();
        group
    }

    /// What Newton's method would still change at the end of steps, by a tangent made there, of every line over its tolerance and of every point over its own;
    /// and the effort.
    fn left(look_at_all: bool) -> (Vec<f64>, Vec<f64>, crate::solve::newton::Effort) {
        let mut group = row_of_lines();
        if look_at_all {
            group.newton.look_at_all();
        }
        let (mut newton, mut change) = (Newton::new(&group.network), Field::new(group.network.nodes()));
        let (mut of_lines, mut of_points) = (vec![0.0_f64; 10], vec![0.0_f64; 5]);
        for row in 1..=300 {
            group.advance(0.1 * f64::from(row)).unwrap();
            let (h, state) = (group.moment.last_step, &group.moment.state);
            let weights = Weights { u: 0.25 * h * h, v: 0.5 * h, a: 1.0 };
            newton.factor(&group.network, &motion(state), &weights, None).unwrap();
            group.network.gathered(&motion(state), &mut change);
            newton.solve_linear(&group.network, &mut change);
            let Criteria { tolerance, length, emphasis, .. } = group.demands.criteria;
            for (most, (first, end)) in of_lines.iter_mut().zip(&group.network.links.ranges) {
                *most = most.max(change.largest_entry(*first, *end, [weights.u / length, weights.u]) / tolerance);
            }
            for (number, most) in of_points.iter_mut().enumerate() {
                *most = most.max(group.network.loose(&change, number) * weights.u / length * emphasis / tolerance);
            }
        }
        (of_lines, of_points, group.newton.effort)
    }

    /// A state that was taken while lines had been factored at different times brings back the same bits, wherever the run has been since: what is
    /// made again is the same factor.
    #[test]
    fn a_state_between_partial_factors_brings_back_the_same_bits() {
        let (mut group, step) = (row_of_lines(), 0.1);
        let (mut kept, mut mixed) = (Snapshot::new(group.network.nodes()), 0);
        for row in 1..=300 {
            let at = f64::from(row) * step;
            let partial = group.newton.effort.partial;
            group.advance(at).unwrap();
            if group.newton.effort.partial > partial {
                mixed += 1;
                group.save(&mut kept);
                let mut ends = Vec::new();
                for elsewhere in [false, true] {
                    if elsewhere {
                        group.newton.forget();
                    }
                    group.restore(&kept);
                    (1..=3).for_each(|k| group.advance(at + step * f64::from(k)).unwrap());
                    ends.push((group.moment.clone(), group.newton.memory().rates.clone()));
                }
                assert!(ends[0] == ends[1], "row {row}");
                group.restore(&kept);
            }
        }
        assert!(mixed > 10, "{mixed} {:?}", group.newton.effort);
    }

    /// Lines that are done early leave little more than lines that are looked at until all are done, and one in ten elements is spared: every line, and every
    /// point, is as far from the solution of its stage as it is then, within a factor of two, or within five times its tolerance. Some of them are judged
    /// by factors that are older than those of others: where these were trusted to contract as they once did, a line would leave 126 times its tolerance.
    #[test]
    fn lines_that_are_done_early_leave_no_more_than_others() {
        let ((lines, points, effort), (all_lines, all_points, all)) = (left(false), left(true));
        println!("{lines:.2?} {points:.2?} {effort:?}\n{all_lines:.2?} {all_points:.2?} {all:?}");
        for (early, late) in lines.iter().zip(&all_lines).chain(points.iter().zip(&all_points)) {
            assert!(*early < (2.0 * late).max(5.0), "left: {lines:.2?} {points:.2?}, else {all_lines:.2?} {all_points:.2?}");
        }
        assert!(all.spared == 0 && 10 * effort.spared > effort.iterations * 100 / 2, "{effort:?} {all:?}");
        assert!(2 * effort.partial > effort.factorisations && all.partial == 0, "{effort:?} {all:?}");
    }
}
