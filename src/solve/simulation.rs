//! The facade: one mooring line through statics and time. The command, the report and the FMU see nothing else of the solver.

use crate::cable1994::line::Tensions;
use crate::cable1994::setup;
use crate::error::{Cause, Error, Stuck, Unbalanced, Zone};
use crate::rod::grading::Sample;
use crate::rod::line::{Line, Supports};
use crate::rod::mesh::{Element, Mesh};
pub use crate::rod::physics::Decision;
use crate::rod::physics::{self, Surroundings};
use crate::rod::state::{Field, State};
use crate::scene::state::{LineState, NodeState};
use crate::scene::types::{Scene, Scheme};
use crate::solve::controller::{self, Controller, Demands, Failure};
pub use crate::solve::counters::{Counters, LastStep, StaticsReport};
use crate::solve::line_state;
pub use crate::solve::linearised::Linearised;
use crate::solve::meshing;
use crate::solve::mixed::{Advance, Mixed, Velocity};
use crate::solve::motion::{Ends, Kinematics, Path};
use crate::solve::newton::{Criteria, Effort, Newton, Stall, motion};
use crate::solve::outputs;
pub use crate::solve::outputs::{NodeOutput, Outputs};
use crate::solve::plane;
use crate::solve::rest;
use crate::solve::scale::Scale;
use crate::solve::scheme::{Bench, Moment, Stages};
use crate::solve::snapshot::Snapshot;
use crate::solve::stability;
use crate::solve::stable::{self, Settled, Variant, WHOLE};
use crate::solve::start::{self, Bounds};
use crate::solve::statics::{self, Balance};
use nalgebra::Vector3;

mod derivative;
mod looking;
mod rollback;

/// One mooring line through statics and time.
pub struct Simulation {
    name: String,
    line: Box<dyn Line>,
    /// The line by the report's own method, where the scene asks for it; `line` then gives mesh, first guess and bed.
    mixed: Option<Mixed>,
    surroundings: Surroundings,
    supports: Supports,
    decisions: Vec<Decision>,
    bounds: Bounds,
    anchor: Vector3<f64>,
    newton: Newton,
    controller: Controller,
    tolerance: f64,
    scale: Scale,
    demands: Demands,
    moment: Moment,
    work: f64,
    /// Work done on what moves the anchor [J].
    anchor_work: f64,
    works: bool,
    fresh: bool,
    /// The state is known to be at rest.
    resting: bool,
    /// The scene lets the line stay in a plane, as long as its fairlead does.
    may_be_planar: bool,
    last: LastStep,
    /// The state before the last `advance`.
    before: Option<Snapshot>,
    /// Room for the forces of the nodes.
    forces: Vec<Vector3<f64>>,
}

/// Local error of the positions allowed in a step, as a share of tolerance × (tension / stiffness of the fairlead). Below a tolerance of
/// 1e-3 it shrinks with its power 0.8 besides, since the global error goes with about the local one to the power 2/3.
/// Calibrated on the built-in case, where it gives about half the tolerance in the end tension.
const ERROR_SHARE: f64 = 1.5e-2;
/// The finest step for the sake of the error, as a share of the longest.
const FINEST_SHARE: f64 = 4.0e-3;
/// Nor is a step made finer for that sake than this share of the time that an axial wave needs to cross an element.
const CROSSING_SHARE: f64 = 0.1;
/// Newton increments count as converged at this share of the tolerance.
const NEWTON_SHARE: f64 = 1.0e-2;
/// And at most at this share of the displacement at which friction breaks away.
const BREAKAWAY_SHARE: f64 = 0.05;
/// A line is at rest where no tension along it can change by more than this share of the tolerance times the end tension.
const REST_SHARE: f64 = 0.01;
/// A fairlead that stays within this share of the line's length of a place rests there: rounding.
const SLIGHT: f64 = 1.0e-14;
/// A mesh meets the tolerance in statics when halving all elements changes the end tension by less than this share of it.
const MESH_SHARE: f64 = 0.3;
/// Where bights are tighter than elements, the weight of a part of one is at their ends or is not: the same as a share of the
/// weight that hangs.
const BIGHT_SHARE: f64 = 8.0;
/// An end that carries less than this share of what hangs is one of a bight.
const SLACK_END: f64 = 0.2;
/// No mesh is refined beyond this many elements.
const MOST_ELEMENTS: usize = 300;
/// How far `cable-1994` may leave the path of its fairlead, as a share of the line's length: it prescribes the velocity and adds it up.
const MIXED_JUMP: f64 = 1.0e-4;

impl Simulation {
    /// Line number `index` of a checked scene, for any motion of its fairlead: meshes it and picks its physics. Where the scene leaves
    /// the mesh to the program, it is refined until the static end tension meets the tolerance.
    pub fn new(scene: &Scene, index: usize) -> Result<Simulation, Error> {
        Simulation::on_ends(scene, index, None)
    }

    /// The same for a line whose fairlead will take a path, its anchor staying where it is.
    pub fn on_path(scene: &Scene, index: usize, path: Option<&Path>) -> Result<Simulation, Error> {
        let anchor = scene.lines.get(index).map_or(Vector3::zeros(), |line| line.anchor.into());
        let ends = path.map(|path| Ends::anchored(path.clone(), anchor));
        Simulation::on_ends(scene, index, ends.as_ref())
    }

    /// The same for a line whose ends will take paths: with what this lets be left out. On other paths it goes on with all that
    /// was left out.
    pub fn on_ends(scene: &Scene, index: usize, path: Option<&Ends>) -> Result<Simulation, Error> {
        let Some(line) = scene.lines.get(index) else {
            let (place, value) = (format!("lines[{index}]"), String::from("a line that is not there"));
            return Err(Error::Value {
                file: scene.title.clone(),
                place,
                value,
                allowed: format!("there are {}", scene.lines.len()),
            });
        };
        let (automatic, mut finer) = (meshing::is_automatic(line), 1.0);
        let mut shapes = if automatic { meshing::catenaries(scene, line) } else { Vec::new() };
        let make = |shapes: &[Vec<Sample>], finer: f64, folds: bool| {
            let mesh = meshing::mesh_of(scene, line, shapes, finer);
            let folds = folds && mesh.folds();
            Simulation::with_mesh(scene, index, path, mesh.with_folds(folds))
        };
        let mut simulation = make(&shapes, finer, true)?;
        // What stiffens the bights of a slack line may keep statics from its end.
        let folds = simulation.line.mesh().folds() && simulation.settle(line.fairlead.into(), 0.0).is_ok();
        if simulation.line.mesh().folds() && !folds {
            simulation = make(&shapes, finer, false)?;
        }
        if !automatic {
            return Ok(simulation);
        }
        // Catenaries are not the shapes of lines that bend or carry bodies.
        if simulation.pushes() || !(line.attachments.is_empty() && line.constraints.is_empty()) {
            let found = simulation.shapes(&meshing::fairlead_places(scene, line));
            if !found.is_empty() {
                shapes = found;
                simulation = make(&shapes, finer, folds)?;
            }
        }
        let tension =
            |simulation: &mut Simulation| simulation.settle(line.fairlead.into(), 0.0).ok().map(|_| simulation.outputs().tension);
        // Stiff elements in a tight bend lock a little: bights may need many.
        let (share, rounds) = if simulation.pushes() { (MESH_SHARE / 3.0, 7) } else { (MESH_SHARE, 3) };
        let allowed = |simulation: &Simulation, tension: f64| {
            let range = if simulation.line.mesh().folds() { simulation.range_of_tension() } else { 0.0 };
            // A flow may pull at what its weight alone would leave slack.
            let of_bights = if tension < SLACK_END * range { BIGHT_SHARE * range } else { 0.0 };
            scene.solver.tolerance * of_bights.max(share * simulation.scale.tension(tension))
        };
        for _ in 0..rounds {
            if simulation.elements() > MOST_ELEMENTS {
                break;
            }
            let mut halved = make(&shapes, 2.0 * finer, folds)?;
            match (tension(&mut simulation), tension(&mut halved)) {
                (Some(coarse), Some(fine)) if (coarse - fine).abs() > allowed(&simulation, fine) => {
                    finer *= 1.5;
                    simulation = make(&shapes, finer, folds)?;
                }
                (None, Some(_)) => simulation = halved,
                _ => break,
            }
        }
        Ok(simulation)
    }

    /// Difference between the largest and the least tension along the line [N]: the weight of what hangs.
    fn range_of_tension(&self) -> f64 {
        let forces = outputs::node_forces(self.line.as_ref(), &self.moment.state);
        let tensions = forces.iter().map(|force| force.norm());
        let (least, most) =
            tensions.fold((f64::INFINITY, 0.0f64), |(least, most), tension| (least.min(tension), most.max(tension)));
        most - least
    }

    /// Whether any part of the line carries compression.
    fn pushes(&self) -> bool {
        self.line.mesh().sections.iter().any(|section| section.tension_floor() < 0.0)
    }

    /// Whether the line would stay where it is if it were at rest there: no small deviation grows. Friction and flow do not count.
    pub fn is_stable(&self) -> bool {
        let (mesh, state) = (self.line.mesh().clone(), &self.moment.state);
        let bare = physics::build(mesh, self.surroundings.bare(), self.supports.clone());
        let still = State { u: state.u.clone(), clock: state.clock, ..State::new(state.u.nodes()) };
        stability::is_stable(bare.as_ref(), &still, statics::unit_of_inertia(bare.as_ref()))
    }

    /// Shapes of the line at rest with its fairlead in several places, as far as they are found.
    fn shapes(&mut self, fairleads: &[Vector3<f64>]) -> Vec<Vec<Sample>> {
        let mut found = Vec::new();
        for fairlead in fairleads {
            if self.settle(*fairlead, 0.0).is_ok() {
                found.push(meshing::shape_of(self.line.as_ref(), &self.moment.state));
            }
        }
        found
    }

    /// Line number `index` of a checked scene on a given mesh.
    fn with_mesh(scene: &Scene, index: usize, path: Option<&Ends>, mesh: Mesh) -> Result<Simulation, Error> {
        let solver = &scene.solver;
        let is_mixed = solver.scheme == Scheme::Cable1994;
        let mesh = if is_mixed { mesh.without_joints().with_folds(false) } else { mesh };
        let supports = physics::supports(scene, &scene.lines[index], &mesh);
        let mixed = solver.uncontrolled_step().filter(|_| is_mixed).map(|step| {
            let line = setup::line(scene, &scene.lines[index], &mesh, supports.clone());
            (Mixed::new(line, step), setup::decisions(scene, &mesh, step))
        });
        let (mixed, report) = mixed.unzip();
        let mut surroundings = Surroundings::of(scene, &mesh);
        let plane = plane::decision(scene, &scene.lines[index], &surroundings, &supports, path);
        surroundings.planar = !plane.on;
        let held = Ends::anchored(Path::Fixed(scene.lines[index].fairlead.into()), scene.lines[index].anchor.into());
        let may_be_planar = !plane::decision(scene, &scene.lines[index], &surroundings, &supports, Some(&held)).on;
        let decisions = report.unwrap_or_else(|| {
            let mut decisions = physics::decisions(scene, &mesh, &supports);
            decisions.extend([plane, rest::decision(scene, &supports)]);
            decisions
        });
        let (nodes, length) = (mesh.nodes(), mesh.length);
        let crossing_time = |e: &Element| e.length * (mesh.sections[e.section].mass / mesh.sections[e.section].ea).sqrt();
        let crossing = mesh.elements.iter().filter(|e| !e.is_joint()).map(crossing_time).fold(f64::INFINITY, f64::min);
        let line = physics::build(mesh, surroundings.clone(), supports.clone());
        // A fixed step is asked for to compare: nothing but the step shall be seen in the result.
        let share = if solver.uncontrolled_step().is_some() { 1.0e-4 } else { NEWTON_SHARE };
        // Where friction holds the line, what the iteration leaves must be small against the way to breaking away.
        let holding = surroundings.breakaway().map_or(f64::INFINITY, |breakaway| BREAKAWAY_SHARE * breakaway / length);
        let tolerance = (share * solver.tolerance).clamp(1e-11, 1e-4).min(holding);
        // A stiff line that carries little: what the iteration leaves is a strain, and a strain is a force.
        let scale = Scale::of(scene, &scene.lines[index], line.as_ref());
        let tolerance = tolerance * scale.strictness(line.as_ref());
        let criteria = Criteria { tolerance, length, emphasis: 1.0, iterations: 12 };
        let mut simulation = Simulation {
            name: scene.lines[index].name.clone(),
            surroundings,
            supports,
            decisions,
            bounds: meshing::bounds(scene),
            anchor: scene.lines[index].anchor.into(),
            newton: Newton::new(line.as_ref()),
            controller: Controller::new(solver.scheme, nodes),
            tolerance: solver.tolerance,
            scale,
            demands: Demands {
                error: 0.0,
                finest_step: (FINEST_SHARE * solver.max_step).max(CROSSING_SHARE * crossing).min(solver.max_step),
                max_step: solver.max_step,
                fixed_step: solver.uncontrolled_step(),
                criteria,
            },
            moment: controller::at_rest(line.as_ref(), 0.0, solver.max_step),
            line,
            mixed,
            work: 0.0,
            anchor_work: 0.0,
            works: false,
            fresh: true,
            resting: false,
            may_be_planar,
            last: LastStep::default(),
            before: None,
            forces: Vec::new(),
        };
        simulation.find_references(scene.lines[index].fairlead.into())?;
        Ok(simulation)
    }

    /// Where the scene leaves the reference of a constraint open, it is where the node is in equilibrium without its springs and
    /// locks.
    fn find_references(&mut self, fairlead: Vector3<f64>) -> Result<(), Error> {
        if self.supports.holds.iter().all(|hold| hold.reference.is_some()) {
            return Ok(());
        }
        self.settle(fairlead, 0.0)?;
        for hold in &mut self.supports.holds {
            hold.reference.get_or_insert(self.moment.state.u.position(hold.node));
        }
        self.rebuild();
        Ok(())
    }

    /// Makes the line anew on its mesh, in surroundings or with supports that have changed.
    fn rebuild(&mut self) {
        self.line = physics::build(self.line.mesh().clone(), self.surroundings.clone(), self.supports.clone());
    }

    /// Where an end is held, or else where the scene has it: the place from which statics starts.
    fn start_of(&self, node: usize, pinned: Vector3<f64>) -> Vector3<f64> {
        self.supports.holds.iter().find(|hold| hold.node == node).and_then(|hold| hold.reference).unwrap_or(pinned)
    }

    /// From now on the work done on the vessel is summed up over the steps; unasked it stays zero, since it costs an end force in
    /// every step.
    pub fn sum_up_work(&mut self) {
        self.works = true;
    }

    /// Puts the line in static equilibrium with its fairlead at a point, at rest, at a time.
    /// On `Err(Error::Statics)` the best state found stands, so that it can be looked at.
    pub fn settle(&mut self, fairlead: Vector3<f64>, time: f64) -> Result<StaticsReport, Error> {
        self.settle_between(fairlead, self.anchor, time)
    }

    /// The same with both ends at given points.
    pub fn settle_between(&mut self, fairlead: Vector3<f64>, anchor: Vector3<f64>, time: f64) -> Result<StaticsReport, Error> {
        self.anchor = anchor;
        if fairlead.y != self.anchor.y {
            self.leave_plane();
        }
        self.moment = controller::at_rest(self.line.as_ref(), time, self.demands.max_step);
        let (anchor, fairlead) = (self.start_of(0, self.anchor), self.start_of(self.line.last(), fairlead));
        start::guess(self.line.mesh(), &self.bounds, &anchor, &fairlead, &mut self.moment.state.u);
        self.line.place(0, &mut self.moment.state.u, time);
        self.leave_plane_if_out();
        let (settled, smooth) = self.balance();
        self.leave_plane_if_out();
        let mut balance = settled.balance;
        if let Some(mixed) = &mut self.mixed {
            balance = mixed.settle(self.line.as_ref(), &mut self.moment.state, balance);
        }
        self.begin_anew(smooth.as_deref());
        if balance.converged() && !settled.unstable {
            let Balance { iterations, residual, .. } = balance;
            return Ok(StaticsReport { iterations, residual, converged: true, others: settled.others });
        }
        Err(Error::Statics(Box::new(Unbalanced {
            line: self.name.clone(),
            iterations: balance.iterations,
            residual: balance.residual,
            allowed: balance.allowed,
            unstable: settled.unstable,
            s: self.arc_length(balance.node),
            zone: self.zone(balance.node),
        })))
    }

    /// A heap of slack line is coiled, and what can push may bow out: neither stays in its plane.
    fn leave_plane_if_out(&mut self) {
        if self.line.is_planar() && !is_in_plane(&self.moment.state.u, self.anchor.y) {
            self.leave_plane();
        }
    }

    /// Finds the equilibrium without friction, and from there, if there is friction, that of the line as it is laid and the places of the
    /// bed that hold it there; returns the line without friction, too.
    fn balance(&mut self) -> (Settled, Option<Box<dyn Line>>) {
        let (mesh, supports) = (self.line.mesh(), &self.supports);
        let make = |variant: Variant, surroundings: Surroundings| {
            let mut made = Mesh { limp: variant.limp, ..mesh.clone() };
            for (number, section) in made.sections.iter_mut().enumerate().filter(|(_, section)| section.ea > variant.limit) {
                if let Some(elasticity) = made.elasticities.get_mut(number) {
                    *elasticity = elasticity.scaled(variant.limit / section.ea);
                }
                section.ea = variant.limit;
            }
            physics::build(made, if variant.bare { surroundings.bare() } else { surroundings }, supports.clone())
        };
        let pushes = self.pushes();
        let (line, newton, state) = (self.line.as_ref(), &mut self.newton, &mut self.moment.state);
        let rough = line.holding_nodes() > 0;
        let smooth = rough.then(|| make(WHOLE, self.surroundings.without_friction()));
        let without = self.surroundings.without_friction();
        let free = smooth.as_deref().unwrap_or(line);
        let mut settled = if pushes {
            // A line may buckle out of its plane.
            let spatial = Surroundings { planar: false, ..without };
            let line = make(WHOLE, spatial.clone());
            let effort = newton.effort;
            let mut in_space = Newton::new(line.as_ref());
            let settled = stable::settle(line.as_ref(), &|variant| make(variant, spatial.clone()), &mut in_space, state);
            newton.effort = effort;
            settled
        } else {
            let soften = |limit| make(Variant { limit, ..WHOLE }, without.clone());
            Settled { balance: statics::settle(free, &soften, newton, state), others: false, unstable: false }
        };
        if rough && settled.balance.converged() {
            let around = self.surroundings.laid(mesh);
            let laid = make(WHOLE, around.clone());
            laid.lay(&state.u, &mut state.holds);
            let before = settled.balance.iterations;
            settled.balance =
                statics::settle(laid.as_ref(), &|limit| make(Variant { limit, ..WHOLE }, around.clone()), newton, state);
            settled.balance.iterations += before;
            laid.hold(&state.u, &state.v, &mut state.holds);
        }
        (settled, smooth)
    }

    /// What a new beginning resets, and the error of a step that is allowed from here; `smooth` is the line without friction, if it
    /// has any.
    fn begin_anew(&mut self, smooth: Option<&dyn Line>) {
        let line = smooth.unwrap_or(self.line.as_ref());
        let length = self.scale.length(line, &mut self.newton, &self.moment.state);
        self.demands.error = ERROR_SHARE * (self.tolerance / 1.0e-3).powf(0.8).min(1.0) * self.tolerance * length;
        self.newton.forget();
        self.newton.effort = Effort::default();
        (self.work, self.anchor_work, self.fresh, self.resting, self.last) = (0.0, 0.0, true, false, LastStep::default());
    }

    /// Advances to a time with the fairlead on a path. On an error the state is the one before the call. A line at rest whose
    /// fairlead stays where it is takes no steps.
    pub fn advance(&mut self, until: f64, path: &Path) -> Result<(), Error> {
        self.go(until, path, None)
    }

    /// The same with both ends on paths.
    pub fn advance_ends(&mut self, until: f64, ends: &Ends) -> Result<(), Error> {
        self.go(until, &ends.fairlead, moving(&ends.anchor))
    }

    fn go(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Error> {
        self.check_path(until, path, anchor)?;
        let begin = self.moment.state.clock.now;
        self.mark();
        let leaves = |path: &Path| !path.stays_at(self.anchor.y, begin, until);
        if self.line.is_planar() && (leaves(path) || anchor.is_some_and(leaves)) {
            self.leave_plane();
        }
        if self.rests(until, path, anchor) {
            (self.moment.state.clock.now, self.last) = (until, LastStep::default());
            return Ok(());
        }
        let effort = self.newton.effort;
        let steps = self.controller.tally.steps;
        self.controller.tally.error = 0.0;
        let outcome = if self.mixed.is_some() {
            self.run_mixed(until, &|time| path.at(time).velocity)
        } else {
            self.begin(path, anchor).and_then(|()| self.run(until, path, anchor))
        };
        match outcome {
            Ok(()) => {
                self.last = LastStep {
                    substeps: self.controller.tally.steps - steps,
                    newton_iterations: self.newton.effort.iterations - effort.iterations,
                    error_estimate: self.controller.tally.error,
                };
                Ok(())
            }
            Err(failure) => {
                let stuck = self.stuck(&failure, path, begin);
                self.undo();
                Err(Error::Step(Box::new(stuck)))
            }
        }
    }

    /// Whether nothing would happen before `until`. Depends on the state and the path alone, so that it is the same after a rollback.
    fn rests(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> bool {
        let (line, state) = (self.line.as_ref(), &self.moment.state);
        let (last, slight) = (line.last(), SLIGHT * line.mesh().length);
        let still = self.demands.fixed_step.is_none()
            && self.surroundings.waves.is_none()
            && self.supports.holds.is_empty()
            && state.holds.nodes() == 0
            && (self.fresh || state.v.position(last) == Vector3::zeros() && state.a.position(last) == Vector3::zeros())
            && path.rests(state.clock.now, until, &state.u.position(last), slight)
            && anchor.is_none_or(|anchor| anchor.rests(state.clock.now, until, &state.u.position(0), slight));
        if still && !self.resting {
            let allowed = REST_SHARE * self.tolerance * line.end_force(&motion(state)).norm();
            self.resting = rest::rests(line, &mut self.newton, state, allowed);
        }
        self.resting &= still;
        self.resting
    }

    fn run(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Failure> {
        let line = self.line.as_ref();
        let end = |moment: &Moment| (line.end_force(&motion(&moment.state)), moment.state.u.position(line.last()));
        let mut before = self.works.then(|| end(&self.moment));
        let work = &mut self.work;
        let (criteria, allowed) = (self.demands.criteria, self.demands.error);
        let mut bench = Bench { line, newton: &mut self.newton, path, anchor, criteria, allowed, stages: Stages::Solve };
        let anchor_end = |moment: &Moment| (outputs::anchor_force(line, &moment.state), moment.state.u.position(0));
        let mut anchor_before = anchor.filter(|_| self.works).map(|_| anchor_end(&self.moment));
        let anchor_work = &mut self.anchor_work;
        self.controller.advance(&mut bench, &self.demands, &mut self.moment, until, |moment, _| {
            if let Some((force, place)) = &mut anchor_before {
                let (force_now, place_now) = anchor_end(moment);
                *anchor_work += 0.5 * (*force + force_now).dot(&(place_now - *place));
                (*force, *place) = (force_now, place_now);
            }
            if let Some((force, place)) = &mut before {
                let (force_now, place_now) = end(moment);
                *work += 0.5 * (*force + force_now).dot(&(place_now - *place));
                (*force, *place) = (force_now, place_now);
            }
        })
    }

    /// The same by the report's own method.
    fn run_mixed(&mut self, until: f64, velocity: Velocity) -> Result<(), Failure> {
        let Some(mixed) = &mut self.mixed else { return Ok(()) };
        let Advance { steps, pushing, work } = mixed.advance(&mut self.moment, until, velocity)?;
        self.fresh = false;
        self.work += work;
        self.controller.tally.steps += steps;
        self.controller.tally.pushing += pushing;
        self.newton.effort.iterations += steps;
        self.newton.effort.factorisations += steps;
        Ok(())
    }

    /// Before the first step after statics: the fairlead takes up the velocity and acceleration of its path, the line those that fit.
    fn begin(&mut self, path: &Path, anchor: Option<&Path>) -> Result<(), Failure> {
        if !std::mem::take(&mut self.fresh) {
            return Ok(());
        }
        let (time, criteria) = (self.moment.state.clock.now, self.demands.criteria);
        let mut bench = Bench {
            line: self.line.as_ref(),
            newton: &mut self.newton,
            path,
            anchor,
            criteria,
            allowed: self.demands.error,
            stages: Stages::Solve,
        };
        begin(&mut bench, &mut self.moment).map_err(|stall| Failure { time, step: 0.0, stall: Some(stall) })
    }

    fn check_path(&self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Error> {
        let (time, length) = (self.moment.state.clock.now, self.line.mesh().length);
        let (from, to) = (path.at(time), path.at(until));
        let held = Kinematics::at_rest(self.anchor);
        let (anchor_from, anchor_to) = anchor.map_or((held, held), |anchor| (anchor.at(time), anchor.at(until)));
        let jump = |end: &Kinematics, node: usize| (end.position - self.moment.state.u.position(node)).norm();
        let (last, allowed) = (self.line.last(), self.mixed.as_ref().map_or(1e-6, |_| MIXED_JUMP) * length);
        let reach = (to.position - anchor_to.position).norm();
        let (zone, cause) = if !([&from, &to].into_iter().all(is_finite) && until.is_finite()) {
            (Zone::Fairlead, Cause::BadMotion)
        } else if ![&anchor_from, &anchor_to].into_iter().all(is_finite) {
            (Zone::Anchor, Cause::BadMotion)
        } else if self.line.is_pinned(last) && jump(&from, last) > allowed {
            (Zone::Fairlead, Cause::Jump { distance: jump(&from, last) })
        } else if anchor.is_some() && self.line.is_pinned(0) && jump(&anchor_from, 0) > allowed {
            (Zone::Anchor, Cause::Jump { distance: jump(&anchor_from, 0) })
        } else if self.line.is_pinned(last) && reach > 2.0 * length {
            (Zone::Fairlead, Cause::OutOfReach { distance: reach, length })
        } else {
            return Ok(());
        };
        Err(Error::Step(Box::new(Stuck {
            line: self.name.clone(),
            time: until,
            s: if zone == Zone::Anchor { length } else { 0.0 },
            zone,
            cause,
            fairlead_speed: to.velocity.norm(),
            last_good_time: self.moment.state.clock.now,
        })))
    }

    fn stuck(&self, failure: &Failure, path: &Path, last_good_time: f64) -> Stuck {
        let step = failure.step;
        let node = failure.stall.map_or(self.line.last(), |stall| stall.node());
        Stuck {
            line: self.name.clone(),
            time: failure.time,
            s: self.arc_length(node),
            zone: self.zone(node),
            cause: match (failure.stall, &self.mixed) {
                (None, Some(mixed)) => Cause::StepTooShort { step, shortest: mixed.shortest_step() },
                (Some(_), Some(_)) => Cause::Diverged { step },
                (None, None) => Cause::TooInaccurate { step },
                (Some(Stall::NotFinite { .. }), None) => Cause::NotFinite { step },
                (Some(_), None) => Cause::NoSolution { step },
            },
            fairlead_speed: path.at(failure.time).velocity.norm(),
            last_good_time,
        }
    }

    /// Arc length of a node from the fairlead [m].
    fn arc_length(&self, node: usize) -> f64 {
        self.line.mesh().length - self.line.mesh().node_arc_length(node)
    }

    /// Part of the line at a node.
    fn zone(&self, node: usize) -> Zone {
        let near =
            |e: usize| self.line.touching_length(&self.moment.state.u, e) / self.line.mesh().elements[e].length.max(1e-300);
        let last = self.line.last();
        let (below, above) = (near(node.saturating_sub(1).min(last - 1)), near(node.min(last - 1)));
        match node {
            _ if node == last => Zone::Fairlead,
            0 => Zone::Anchor,
            _ if below > 0.999 && above > 0.999 => Zone::Grounded,
            _ if below > 0.0 || above > 0.0 => Zone::Touchdown,
            _ => Zone::Suspended,
        }
    }

    /// The discrete line.
    pub(in crate::solve) fn line(&self) -> &dyn Line {
        self.line.as_ref()
    }

    /// What holds and loads it.
    pub(in crate::solve) fn supports(&self) -> &Supports {
        &self.supports
    }

    /// What its steps have to meet.
    pub(in crate::solve) fn demands(&self) -> &Demands {
        &self.demands
    }

    /// Its state now.
    pub(in crate::solve) fn state(&self) -> &State {
        &self.moment.state
    }

    /// Which error a path of an end that cannot be is.
    pub(in crate::solve) fn refused(&self, cause: Cause, time: f64, fairlead_speed: f64, at_anchor: bool) -> Error {
        let (s, zone) = if at_anchor { (self.line.mesh().length, Zone::Anchor) } else { (0.0, Zone::Fairlead) };
        let last_good_time = self.moment.state.clock.now;
        Error::Step(Box::new(Stuck { line: self.name.clone(), time, s, zone, cause, fairlead_speed, last_good_time }))
    }

    /// Which error a failure at one of its nodes is.
    pub(in crate::solve) fn failed(&self, failure: &Failure, fairlead: &Path, last_good_time: f64) -> Error {
        Error::Step(Box::new(self.stuck(failure, fairlead, last_good_time)))
    }

    /// Begins from given nodes instead of from equilibrium; false, and nothing changed, if a node of the mesh is not among them. The
    /// accelerations are those that fit; λ is taken over by `cable-1994` alone. Friction begins as on a line
    /// laid slack and pulled tight.
    pub fn start_from(&mut self, given: &LineState) -> bool {
        let mut moment = controller::at_rest(self.line.as_ref(), given.time, self.demands.max_step);
        let Some(tensions) = line_state::set(self.line.as_ref(), given, &mut moment.state) else { return false };
        let across = |node: &NodeState| [node.slope, node.velocity, node.slope_rate].iter().any(|rate| rate[1] != 0.0);
        if given.nodes.iter().any(|node| node.position[1] != self.anchor.y || across(node)) {
            self.leave_plane();
        }
        let State { u, v, holds, .. } = &mut moment.state;
        self.line.lay(u, holds);
        self.line.hold(u, v, holds);
        self.moment = moment;
        if let Some(mixed) = &mut self.mixed {
            mixed.restore(&Tensions { now: tensions.clone(), before: tensions });
        }
        self.begin_anew(None);
        true
    }
}

/// The fairlead takes up the velocity and acceleration of its path, the line the accelerations that fit.
fn begin(bench: &mut Bench, moment: &mut Moment) -> Result<(), Stall> {
    let now = moment.state.clock;
    bench.prescribe(&mut moment.state, now);
    bench.accelerate(&mut moment.state)
}

/// The path of an anchor that may move.
fn moving(anchor: &Path) -> Option<&Path> {
    Some(anchor).filter(|path| !matches!(path, Path::Fixed(_)))
}

fn is_finite(k: &Kinematics) -> bool {
    [k.position, k.velocity, k.acceleration].iter().all(|v| v.iter().all(|x| x.is_finite()))
}

/// Whether a line lies in the plane of a y.
fn is_in_plane(u: &Field, y: f64) -> bool {
    u.component(1).iter().all(|place| *place == y) && u.component(4).iter().all(|slope| *slope == 0.0)
}
