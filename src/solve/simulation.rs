//! The facade: one mooring line through statics and time. The command, the report and the FMU see nothing else of the solver.

use crate::error::{Cause, Error, Stuck, Unbalanced, Zone};
use crate::rod::line::{Line, Supports};
use crate::rod::mesh::{Element, Mesh};
pub use crate::rod::physics::Decision;
use crate::rod::physics::{self, Surroundings};
use crate::rod::state::{Field, State};
use crate::scene::types::Scene;
use crate::solve::controller::{self, Controller, Demands, Failure};
use crate::solve::meshing;
use crate::solve::motion::{Kinematics, Path};
use crate::solve::newton::{Criteria, Effort, Newton, Stall, motion};
use crate::solve::outputs;
pub use crate::solve::outputs::{NodeOutput, Outputs};
use crate::solve::scheme::{Bench, Moment, Stages};
use crate::solve::snapshot::Snapshot;
use crate::solve::start::{self, Bounds};
use crate::solve::statics::{self, Balance};
use crate::solve::tangent::{self, LinearStage};
use nalgebra::Vector3;

/// How statics went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticsReport {
    /// Newton iterations, all attempts.
    pub iterations: usize,
    /// Largest unbalanced nodal force [N].
    pub residual: f64,
    /// Whether the residual is small enough to call it equilibrium.
    pub converged: bool,
}

/// Work done by the solver since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Accepted time steps.
    pub steps: usize,
    /// Rejected time steps.
    pub rejected_steps: usize,
    /// Accepted steps of the finest length whose estimated error was above the tolerance.
    pub unresolved_steps: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Factorisations of the tangent.
    pub factorisations: usize,
    /// Elements times Newton iterations.
    pub element_iterations: usize,
}

/// The last `advance`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LastStep {
    /// Accepted time steps inside it.
    pub substeps: usize,
    /// Newton iterations inside it.
    pub newton_iterations: usize,
    /// Largest estimated error of a step over the allowed one [-].
    pub error_estimate: f64,
}

/// One mooring line through statics and time.
pub struct Simulation {
    name: String,
    line: Box<dyn Line>,
    surroundings: Surroundings,
    decisions: Vec<Decision>,
    bounds: Bounds,
    anchor: Vector3<f64>,
    newton: Newton,
    controller: Controller,
    tolerance: f64,
    demands: Demands,
    moment: Moment,
    work: f64,
    fresh: bool,
    last: LastStep,
}

/// Local error of the positions allowed in a step, as a share of tolerance × (tension / stiffness of the fairlead), at a tolerance
/// of 1e-3; in proportion to the tolerance to the power 3/2, since the global error goes with the local one to the power 2/3.
/// Calibrated on the built-in case, where it gives about half the tolerance in the end tension.
const ERROR_SHARE: f64 = 6.0e-3;
/// The finest step for the sake of the error, as a share of the longest.
const FINEST_SHARE: f64 = 4.0e-3;
/// Nor is a step made finer for that sake than this share of the time that an axial wave needs to cross an element.
const CROSSING_SHARE: f64 = 0.1;
/// Newton increments count as converged at this share of the tolerance.
const NEWTON_SHARE: f64 = 0.01;
/// A mesh meets the tolerance in statics when halving all elements changes the end tension by less than this share of it.
const MESH_SHARE: f64 = 0.3;

impl Simulation {
    /// Line number `index` of a checked scene: meshes it and picks its physics. Where the scene leaves the mesh to the program, it
    /// is refined until the static end tension meets the tolerance.
    pub fn new(scene: &Scene, index: usize) -> Result<Simulation, Error> {
        let Some(line) = scene.lines.get(index) else {
            let (place, value) = (format!("lines[{index}]"), String::from("a line that is not there"));
            return Err(Error::Value {
                file: scene.title.clone(),
                place,
                value,
                allowed: format!("there are {}", scene.lines.len()),
            });
        };
        let mut finer = 1.0;
        let mut simulation = Simulation::with_mesh(scene, index, meshing::mesh_of(scene, line, finer));
        if !meshing::is_automatic(line) {
            return Ok(simulation);
        }
        let tension =
            |simulation: &mut Simulation| simulation.settle(line.fairlead.into(), 0.0).ok().map(|_| simulation.outputs().tension);
        let allowed = MESH_SHARE * scene.solver.tolerance;
        for _ in 0..3 {
            let mut halved = Simulation::with_mesh(scene, index, meshing::mesh_of(scene, line, 2.0 * finer));
            match (tension(&mut simulation), tension(&mut halved)) {
                (Some(coarse), Some(fine)) if (coarse - fine).abs() > allowed * fine => {
                    finer *= 1.5;
                    simulation = Simulation::with_mesh(scene, index, meshing::mesh_of(scene, line, finer));
                }
                (None, Some(_)) => simulation = halved,
                _ => break,
            }
        }
        Ok(simulation)
    }

    /// Line number `index` of a checked scene on a given mesh.
    fn with_mesh(scene: &Scene, index: usize, mesh: Mesh) -> Simulation {
        let (decisions, nodes, length) = (physics::decisions(scene, &mesh), mesh.nodes(), mesh.length);
        let crossing_time = |e: &Element| e.length * (mesh.sections[e.section].mass / mesh.sections[e.section].ea).sqrt();
        let crossing = mesh.elements.iter().filter(|e| !e.is_joint()).map(crossing_time).fold(f64::INFINITY, f64::min);
        let (surroundings, supports) = (Surroundings::of(scene, &mesh), Supports::pinned(&mesh));
        let line = physics::build(mesh, surroundings.clone(), supports);
        let solver = &scene.solver;
        // A fixed step is asked for to compare: nothing but the step shall be seen in the result.
        let share = if solver.fixed_step.is_some() { 0.01 * NEWTON_SHARE } else { NEWTON_SHARE };
        let criteria = Criteria { tolerance: (share * solver.tolerance).clamp(1e-11, 1e-4), length, iterations: 12 };
        Simulation {
            name: scene.lines[index].name.clone(),
            surroundings,
            decisions,
            bounds: meshing::bounds(scene),
            anchor: scene.lines[index].anchor.into(),
            newton: Newton::new(line.as_ref()),
            controller: Controller::new(solver.scheme, nodes),
            tolerance: solver.tolerance,
            demands: Demands {
                error: 0.0,
                finest_step: (FINEST_SHARE * solver.max_step).max(CROSSING_SHARE * crossing).min(solver.max_step),
                max_step: solver.max_step,
                fixed_step: solver.fixed_step,
                criteria,
            },
            moment: controller::at_rest(line.as_ref(), 0.0, solver.max_step),
            line,
            work: 0.0,
            fresh: true,
            last: LastStep::default(),
        }
    }

    /// Puts the line in static equilibrium with its fairlead at a point, at rest, at a time.
    /// On `Err(Error::Statics)` the best state found stands, so that it can be looked at.
    pub fn settle(&mut self, fairlead: Vector3<f64>, time: f64) -> Result<StaticsReport, Error> {
        self.moment = controller::at_rest(self.line.as_ref(), time, self.demands.max_step);
        start::guess(self.line.mesh(), &self.bounds, &self.anchor, &fairlead, &mut self.moment.state.u);
        let (balance, smooth) = self.balance();
        self.demands.error =
            ERROR_SHARE * (self.tolerance / 1.0e-3).sqrt() * self.tolerance * self.tension_length(smooth.as_ref());
        self.newton.forget();
        self.newton.effort = Effort::default();
        (self.work, self.fresh, self.last) = (0.0, true, LastStep::default());
        if balance.converged() {
            return Ok(StaticsReport { iterations: balance.iterations, residual: balance.residual, converged: true });
        }
        Err(Error::Statics(Box::new(Unbalanced {
            line: self.name.clone(),
            iterations: balance.iterations,
            residual: balance.residual,
            allowed: balance.allowed,
            s: self.arc_length(balance.node),
            zone: self.zone(balance.node),
        })))
    }

    /// Finds the equilibrium without friction, and from there, if there is friction, that of the line as it is laid and the places of the
    /// bed that hold it there; returns the line without friction, too.
    fn balance(&mut self) -> (Balance, Box<dyn Line>) {
        let (surroundings, rough) = (&self.surroundings, self.line.holding_nodes() > 0);
        let build = |limit: f64, laid: bool| {
            let mut mesh = self.line.mesh().clone();
            mesh.sections.iter_mut().for_each(|section| section.ea = section.ea.min(limit));
            let (surroundings, supports) =
                (if laid { surroundings.laid(&mesh) } else { surroundings.without_friction() }, Supports::pinned(&mesh));
            physics::build(mesh, surroundings, supports)
        };
        let (smooth, state, newton) = (build(f64::INFINITY, false), &mut self.moment.state, &mut self.newton);
        let mut balance = statics::settle(smooth.as_ref(), &|limit| build(limit, false), newton, state);
        if rough && balance.converged() {
            let (laid, before) = (build(f64::INFINITY, true), balance.iterations);
            laid.lay(&state.u, &mut state.holds);
            balance = statics::settle(laid.as_ref(), &|limit| build(limit, true), newton, state);
            balance.iterations += before;
            laid.hold(&state.u, &state.v, &mut state.holds);
        }
        (balance, smooth)
    }

    /// Displacement of the fairlead that would double the end tension [m]: what makes an error of position an error of tension.
    fn tension_length(&mut self, line: &dyn Line) -> f64 {
        let length = line.mesh().length;
        let tension = line.end_force(&motion(&self.moment.state)).norm();
        let stiffness = self.newton.fairlead_stiffness(line, &self.moment.state).map_or(0.0, |k| k.norm());
        if stiffness > 0.0 { (tension / stiffness).clamp(1e-5 * length, 0.02 * length) } else { 0.02 * length }
    }

    /// Advances to a time with the fairlead on a path. On an error the state is the one before the call.
    pub fn advance(&mut self, until: f64, path: &Path) -> Result<(), Error> {
        let before = (self.moment.clone(), self.work, self.fresh);
        self.check_path(until, path)?;
        let effort = self.newton.effort;
        let steps = self.controller.tally.steps;
        self.controller.tally.error = 0.0;
        let outcome = self.begin(path).and_then(|()| self.run(until, path));
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
                let stuck = self.stuck(&failure, path, before.0.time);
                (self.moment, self.work, self.fresh) = before;
                self.newton.forget();
                Err(Error::Step(Box::new(stuck)))
            }
        }
    }

    fn run(&mut self, until: f64, path: &Path) -> Result<(), Failure> {
        let line = self.line.as_ref();
        let mut force = line.end_force(&motion(&self.moment.state));
        let mut place = self.moment.state.u.position(line.last());
        let work = &mut self.work;
        let criteria = self.demands.criteria;
        let mut bench = Bench { line, newton: &mut self.newton, path, criteria, stages: Stages::Solve };
        self.controller.advance(&mut bench, &self.demands, &mut self.moment, until, |moment, _| {
            let (force_now, place_now) = (line.end_force(&motion(&moment.state)), moment.state.u.position(line.last()));
            *work += 0.5 * (force + force_now).dot(&(place_now - place));
            (force, place) = (force_now, place_now);
        })
    }

    /// Before the first step after statics: the fairlead takes up the velocity and acceleration of its path, the line those that fit.
    fn begin(&mut self, path: &Path) -> Result<(), Failure> {
        if !std::mem::take(&mut self.fresh) {
            return Ok(());
        }
        let (time, criteria) = (self.moment.time, self.demands.criteria);
        let mut bench = Bench { line: self.line.as_ref(), newton: &mut self.newton, path, criteria, stages: Stages::Solve };
        begin(&mut bench, &mut self.moment).map_err(|stall| Failure { time, step: 0.0, stall: Some(stall) })
    }

    fn check_path(&self, until: f64, path: &Path) -> Result<(), Error> {
        let (time, length) = (self.moment.time, self.line.mesh().length);
        let fairlead = self.moment.state.u.position(self.line.last());
        let (from, to) = (path.at(time), path.at(until));
        let jump = (from.position - fairlead).norm();
        let reach = (to.position - self.anchor).norm();
        let cause = if !(is_finite(&from) && is_finite(&to) && until.is_finite()) {
            Cause::BadMotion
        } else if jump > 1e-6 * length {
            Cause::Jump { distance: jump }
        } else if reach > 2.0 * length {
            Cause::OutOfReach { distance: reach, length }
        } else {
            return Ok(());
        };
        Err(Error::Step(Box::new(Stuck {
            line: self.name.clone(),
            time: until,
            s: 0.0,
            zone: Zone::Fairlead,
            cause,
            fairlead_speed: to.velocity.norm(),
            last_good_time: self.moment.time,
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
            cause: match failure.stall {
                None => Cause::TooInaccurate { step },
                Some(Stall::NotFinite { .. }) => Cause::NotFinite { step },
                Some(_) => Cause::NoSolution { step },
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

    /// The complete state. The factor of the tangent is not part of it: it is dropped here and in `restore`, so that what follows
    /// is the same to the bit after both.
    pub fn snapshot(&mut self) -> Snapshot {
        self.newton.forget();
        let (moment, error) = (self.moment.clone(), self.demands.error);
        Snapshot { moment, work: self.work, fresh: self.fresh, error, last: self.last }
    }

    /// Puts back a state of this line; false, and nothing changed, if it belongs to a line with another number of nodes.
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        let holds = &snapshot.moment.state.holds;
        if snapshot.nodes() != self.line.mesh().nodes() || holds.nodes() != self.line.holding_nodes() {
            return false;
        }
        self.newton.forget();
        self.moment.clone_from(&snapshot.moment);
        self.demands.error = snapshot.error;
        (self.work, self.fresh, self.last) = (snapshot.work, snapshot.fresh, snapshot.last);
        true
    }

    /// Rates of the outputs in time, from the motion of the line now and the change of its acceleration over the last step.
    pub fn output_rates(&self) -> Outputs {
        let (state, moment) = (&self.moment.state, &self.moment);
        let mut jerk = Field::new(state.a.nodes());
        if moment.last_step > 0.0 {
            jerk.set_sum(&state.a, -1.0, &moment.earlier);
            jerk.data_mut().iter_mut().for_each(|x| *x /= moment.last_step);
        }
        let rate =
            State { u: state.v.clone(), v: state.a.clone(), a: jerk, holds: tangent::hold_rate(self.line.as_ref(), state) };
        let mut rates = outputs::along(self.line.as_ref(), state, &rate, 1.0e-4);
        let velocity = state.v.position(self.line.last());
        (rates.time, rates.work) = (1.0, self.line.end_force(&motion(state)).dot(&velocity));
        rates
    }

    /// Derivatives of all outputs at a time, one for each variation of the path on the way there from a state: the steps are taken
    /// once and then differentiated. The simulation stays as it is.
    pub fn differentiate(
        &mut self,
        from: &Snapshot,
        until: f64,
        path: &Path,
        directions: &[Path],
    ) -> Result<Vec<Outputs>, Error> {
        let now = self.snapshot();
        let tally = (self.controller.tally, self.newton.effort);
        if !self.restore(from) {
            return Ok(Vec::new());
        }
        let outcome = self.differentiate_from_here(until, path, directions);
        let stuck = outcome.map_err(|failure| Error::Step(Box::new(self.stuck(&failure, path, from.moment.time))));
        self.restore(&now);
        (self.controller.tally, self.newton.effort) = tally;
        stuck
    }

    fn differentiate_from_here(&mut self, until: f64, path: &Path, directions: &[Path]) -> Result<Vec<Outputs>, Failure> {
        let (time, line, criteria) = (self.moment.time, self.line.as_ref(), self.demands.criteria);
        let failed = |stall| Failure { time, step: 0.0, stall: Some(stall) };
        let mut stages = Vec::new();
        let mut legs = Vec::new();
        let mut bench = Bench { line, newton: &mut self.newton, path, criteria, stages: Stages::Record(&mut stages) };
        let fresh = std::mem::take(&mut self.fresh);
        if fresh {
            begin(&mut bench, &mut self.moment).map_err(failed)?;
        }
        let mut states = vec![self.moment.state.clone()];
        let history = self.moment.last_step;
        self.controller.advance(&mut bench, &self.demands, &mut self.moment, until, |moment, leg| {
            states.push(moment.state.clone());
            legs.push(*leg);
        })?;
        let linear = stages.iter().map(|stage| LinearStage::new(line, stage)).collect::<Result<Vec<_>, _>>().map_err(failed)?;
        let mut derivatives = Vec::new();
        for direction in directions {
            let stages = Stages::Linear(linear.iter());
            let mut bench = Bench { line, newton: &mut self.newton, path: direction, criteria, stages };
            let mut change = controller::at_rest(line, time, 0.0);
            if fresh {
                begin(&mut bench, &mut change).map_err(failed)?;
            }
            change.last_step = history;
            let mut work = 0.0;
            let mut before = outputs::end_along(line, &states[0], &change.state);
            self.controller
                .repeat(&mut bench, &legs, &mut change, |change, number| {
                    tangent::hold(line, &states[number + 1], &states[number].holds, &mut change.state);
                    let now = outputs::end_along(line, &states[number + 1], &change.state);
                    work += 0.5 * ((before.force_change + now.force_change).dot(&(now.place - before.place)));
                    work += 0.5 * ((before.force + now.force).dot(&(now.place_change - before.place_change)));
                    before = now;
                })
                .map_err(failed)?;
            derivatives.push(Outputs { work, ..outputs::along(line, &self.moment.state, &change.state, 1.0e-4) });
        }
        Ok(derivatives)
    }

    /// Outputs now.
    pub fn outputs(&self) -> Outputs {
        outputs::outputs(self.line.as_ref(), &self.moment.state, self.moment.time, self.work)
    }

    /// Nodes now, from the fairlead.
    pub fn nodes(&self) -> Vec<NodeOutput> {
        outputs::nodes(self.line.as_ref(), &self.moment.state)
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.line.mesh().element_count()
    }

    /// Runs of elements of nearly one length, from the fairlead: from and to which arc length [m], and how many.
    pub fn mesh(&self) -> Vec<(f64, f64, usize)> {
        let mesh = self.line.mesh();
        let mut runs: Vec<(f64, f64, usize)> = Vec::new();
        for element in mesh.elements.iter().rev().filter(|element| !element.is_joint()) {
            let (from, to) = (mesh.length - element.start - element.length, mesh.length - element.start);
            match runs.last_mut() {
                Some(run) if (element.length * run.2 as f64 / (run.1 - run.0) - 1.0).abs() < 0.1 => {
                    (run.1, run.2) = (to, run.2 + 1)
                }
                _ => runs.push((from, to, 1)),
            }
        }
        runs
    }

    /// Which physics is in the step and why.
    pub fn decisions(&self) -> &[Decision] {
        &self.decisions
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        let (tally, effort) = (&self.controller.tally, &self.newton.effort);
        Counters {
            steps: tally.steps,
            rejected_steps: tally.rejected,
            unresolved_steps: tally.unresolved,
            newton_iterations: effort.iterations,
            factorisations: effort.factorisations,
            element_iterations: effort.iterations * self.elements(),
        }
    }

    /// The last `advance`.
    pub fn last_step(&self) -> LastStep {
        self.last
    }
}

/// The fairlead takes up the velocity and acceleration of its path, the line the accelerations that fit.
fn begin(bench: &mut Bench, moment: &mut Moment) -> Result<(), Stall> {
    let now = bench.path.at(moment.time);
    bench.prescribe(&mut moment.state, &now);
    bench.accelerate(&mut moment.state)
}

fn is_finite(k: &Kinematics) -> bool {
    [k.position, k.velocity, k.acceleration].iter().all(|v| v.iter().all(|x| x.is_finite()))
}
