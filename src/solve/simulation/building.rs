//! Building a line from its scene: its mesh, refined until statics meets the tolerance, its physics, and the errors allowed.

use super::Simulation;
use crate::cable1994::setup;
use crate::error::Error;
use crate::rod::grading::Sample;
use crate::rod::mesh::{Element, Mesh};
use crate::rod::physics::{self, Surroundings};
use crate::scene::types::{Scene, Scheme};
use crate::solve::controller::{self, Controller, Demands};
use crate::solve::counters::LastStep;
use crate::solve::meshing;
use crate::solve::mixed::Mixed;
use crate::solve::motion::{Ends, Path};
use crate::solve::newton::{Criteria, Newton};
use crate::solve::outputs;
use crate::solve::plane;
use crate::solve::rest;
use crate::solve::scale::Scale;
use nalgebra::Vector3;

/// The finest step for the sake of the error, as a share of the longest.
const FINEST_SHARE: f64 = 4.0e-3;
/// Nor is a step made finer for that sake than this share of the time that an axial wave needs to cross an element.
const CROSSING_SHARE: f64 = 0.1;
/// Newton increments count as converged at this share of the tolerance.
const NEWTON_SHARE: f64 = 1.0e-2;
/// And at most at this share of the displacement at which friction breaks away.
const BREAKAWAY_SHARE: f64 = 0.05;
/// A mesh meets the tolerance in statics when halving all elements changes the end tension by less than this share of it.
const MESH_SHARE: f64 = 0.3;
/// Where bights are tighter than elements, the weight of a part of one is at their ends or is not: the same as a share of the
/// weight that hangs.
const BIGHT_SHARE: f64 = 8.0;
/// An end that carries less than this share of what hangs is one of a bight.
const SLACK_END: f64 = 0.2;
/// No mesh is refined beyond this many elements.
const MOST_ELEMENTS: usize = 300;

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
    pub(super) fn pushes(&self) -> bool {
        self.line.mesh().sections.iter().any(|section| section.tension_floor() < 0.0)
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
        let loose = tolerance;
        let tolerance = tolerance * scale.strictness(line.as_ref());
        let stiffest = line.mesh().sections.iter().map(|section| section.ea).fold(0.0, f64::max);
        let enough = rest::enough(line.as_ref(), stiffest * tolerance);
        let criteria = Criteria { tolerance, length, emphasis: 1.0, iterations: 12, loose, enough };
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
            settled: false,
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
    pub(super) fn rebuild(&mut self) {
        self.line = physics::build(self.line.mesh().clone(), self.surroundings.clone(), self.supports.clone());
    }
}
