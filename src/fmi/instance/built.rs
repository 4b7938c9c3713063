//! The mooring that an instance moves: lines, groups of lines that meet, and the bodies that the master drives.

use crate::error::Error;
use crate::fmi::body_variables::{Conventions, Said};
use crate::fmi::filter::Filter;
use crate::fmi::input_path::Plan;
use crate::fmi::inputs::Inputs;
use crate::fmi::segment::Segment;
use crate::fmi::variables::Interpolation;
use crate::fmi::vessel::{Vessel, Voyage, pose_path};
use crate::fmi::warnings::Limits;
use crate::rod::pose::PosePath;
use crate::scene::bodies::Mount;
use crate::scene::read::Loaded;
use crate::scene::types::Scene;
use crate::solve::between::Place;
use crate::solve::group::{EndOf, Group};
use crate::solve::loads;
use crate::solve::motion::{Ends, Path};
use crate::solve::partition;
use crate::solve::simulation::{LastStep, Linearised, Outputs, Simulation, StaticsReport};
use crate::solve::snapshot::Snapshot;
use nalgebra::Vector3;
use std::sync::Arc;

/// The lines and what they were made from.
pub(super) struct Built {
    pub lines: Vec<BuiltLine>,
    pub groups: Vec<Group>,
    pub vessels: Vec<BuiltVessel>,
    pub conventions: Vec<Conventions>,
    pub parameters: Vec<f64>,
    pub tolerance: Option<f64>,
    pub interpolation: Interpolation,
    /// Cut-off of the filter of the positions [Hz]; 0: none.
    pub filter: f64,
}

/// One line, how it goes to the next communication point, and the last step that was differentiated.
pub(super) struct BuiltLine {
    pub what: What,
    pub origin: [f64; 3],
    /// What fairlead and anchor hang on that the master drives: body and place in its axes.
    pub mounts: [Option<(usize, Vector3<f64>)>; 2],
    pub route: Option<Route>,
    pub ends: Ends,
    pub limits: Limits,
    pub linearised: Option<(f64, Vec<Segment>, Linearised)>,
}

/// Where a line is computed.
pub(super) enum What {
    /// By itself.
    Own(Box<Simulation>),
    /// In a group.
    Member {
        /// Number of the group.
        group: usize,
        /// Number in it.
        local: usize,
    },
}

/// How a fairlead goes to the next communication point.
#[derive(Clone)]
pub(super) struct Route {
    pub plan: Plan,
    pub segment: Segment,
    /// What it goes by: the inputs, or what the filter makes of them.
    pub inputs: Inputs,
    pub filter: Filter,
}

/// A body of the scene.
pub(super) struct BuiltVessel {
    /// It moves by itself.
    pub free: bool,
    /// Of a free one, its group and number there.
    pub member: Option<(usize, usize)>,
    /// Where its farthest fairlead is from its reference point [m]: what turns angles into arcs.
    pub arm: f64,
    pub hung: Vec<(usize, bool)>,
    pub origin: [[f64; 3]; 2],
    pub voyage: Option<Voyage>,
    pub path: Arc<PosePath>,
}

/// Shortest arm [m].
const SHORTEST_ARM: f64 = 1.0;

impl Built {
    /// The mooring of a scene, its driven ends where the scene has them.
    pub fn new(scene: &Scene, vessels: &[Vessel], settings: Built) -> Result<Built, Error> {
        let loaded = Loaded::of_scene(scene.clone());
        let mut built = settings;
        for (index, body) in scene.bodies.iter().enumerate() {
            let hung = loads::hanging(scene, index);
            let arm =
                scene.lines.iter().flat_map(|line| [&line.fairlead_on, &line.anchor_on]).fold(SHORTEST_ARM, |arm, on| match on {
                    Some(Mount::Body { body: name, at, .. }) if *name == body.name => arm.max(Vector3::from(*at).norm()),
                    _ => arm,
                });
            let path = Arc::new(PosePath::Fixed { position: body.position.into(), angles: body.attitude() });
            let origin = vessels[index].origin;
            built.vessels.push(BuiltVessel { free: body.is_free(), member: None, arm, hung, origin, voyage: None, path });
        }
        let mut lines: Vec<Option<BuiltLine>> = scene.lines.iter().map(|_| None).collect();
        for together in partition::parts(scene) {
            let ends: Vec<Ends> = together.lines.iter().map(|index| built.ends_of(scene, &loaded, *index)).collect();
            let group = built.groups.len();
            if together.is_alone() {
                for (index, ends) in together.lines.iter().zip(ends) {
                    let mut simulation = Box::new(Simulation::new(scene, *index)?);
                    simulation.sum_up_work();
                    let limits = limits(scene, *index, &simulation);
                    lines[*index] = Some(BuiltLine::new(scene, *index, What::Own(simulation), ends, limits));
                }
                continue;
            }
            let mut made = Group::new(&loaded, &together, &ends)?;
            made.sum_up_work();
            for (local, (index, ends)) in together.lines.iter().zip(ends).enumerate() {
                let limits = limits(scene, *index, made.line(local));
                lines[*index] = Some(BuiltLine::new(scene, *index, What::Member { group, local }, ends, limits));
            }
            for (number, body) in together.bodies.iter().enumerate() {
                built.vessels[*body].member = Some((group, number));
            }
            built.groups.push(made);
        }
        built.lines = lines.into_iter().flatten().collect();
        Ok(built)
    }

    /// The paths of the ends of a line at rest.
    fn ends_of(&self, scene: &Scene, loaded: &Loaded, index: usize) -> Ends {
        let mut ends = Ends::of_scene(loaded, index);
        let line = &scene.lines[index];
        let place = |on: &Option<Mount>, at: [f64; 3], path: &mut Path| match on {
            Some(Mount::Body { body, at, .. }) => {
                if let Some(body) = scene.body(body) {
                    *path = Path::OnBody { body: Arc::clone(&self.vessels[body].path), at: Vector3::from(*at) };
                }
            }
            Some(Mount::Point { .. }) => {}
            None => *path = Path::Fixed(at.into()),
        };
        place(&line.fairlead_on, line.fairlead, &mut ends.fairlead);
        place(&line.anchor_on, line.anchor, &mut ends.anchor);
        ends
    }

    /// Puts everything in equilibrium at a time; or, with what is free where a scene has it, to be let go there, the lines alone.
    pub fn settle(&mut self, time: f64, said: &[Said], held: Option<&Scene>) -> Result<Vec<StaticsReport>, Error> {
        self.apply(said);
        let of_groups = self
            .groups
            .iter_mut()
            .map(|group| match held {
                Some(scene) => group.hold(time, scene),
                None => group.settle(time),
            })
            .collect::<Result<Vec<_>, Error>>()?;
        let line = |line: &mut BuiltLine| match &mut line.what {
            What::Own(simulation) => {
                simulation.settle_between(line.ends.fairlead.at(time).position, line.ends.anchor.at(time).position, time)
            }
            What::Member { group, .. } => Ok(of_groups[*group]),
        };
        self.lines.iter_mut().map(line).collect()
    }

    /// Takes over the forces applied to free bodies.
    pub fn apply(&mut self, said: &[Said]) {
        for (index, vessel) in self.vessels.iter().enumerate() {
            if let Some((group, number)) = vessel.member {
                let [force, moment] = said[index].applied.map(|values| Vector3::from(self.conventions[index].turned(values)));
                let turn = if self.conventions[index].body_loads {
                    self.groups[group].body(number).rotation
                } else {
                    nalgebra::Matrix3::identity()
                };
                self.groups[group].apply(number, turn * force, turn * moment);
            }
        }
    }

    /// Puts the paths of all that is driven in place.
    pub fn set_out(&mut self) {
        for vessel in &mut self.vessels {
            if let Some(voyage) = &vessel.voyage {
                vessel.path = Arc::new(pose_path(&voyage.segments, vessel.arm));
            }
        }
        for line in &mut self.lines {
            if let Some(route) = &line.route {
                route.segment.write_to(&mut line.ends.fairlead);
            }
            let [fairlead, anchor] = &line.mounts;
            for (mount, path) in [(fairlead, &mut line.ends.fairlead), (anchor, &mut line.ends.anchor)] {
                if let Some((body, at)) = mount {
                    *path = Path::OnBody { body: Arc::clone(&self.vessels[*body].path), at: *at };
                }
            }
            if let What::Member { group, local } = line.what {
                self.groups[group].drive(local, EndOf::Fairlead, &line.ends.fairlead);
                self.groups[group].drive(local, EndOf::Anchor, &line.ends.anchor);
            }
        }
    }

    /// Advances everything or, where a part fails, nothing.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
        let mut failed = None;
        let mut done = 0;
        for line in &mut self.lines {
            if let What::Own(simulation) = &mut line.what
                && let Err(error) = simulation.advance_ends(until, &line.ends)
            {
                failed = Some(error);
                break;
            }
            done += 1;
        }
        let mut groups = 0;
        if failed.is_none() {
            for group in &mut self.groups {
                if let Err(error) = group.advance(until) {
                    failed = Some(error);
                    break;
                }
                groups += 1;
            }
        }
        let Some(error) = failed else { return Ok(()) };
        for line in &mut self.lines[..done] {
            if let What::Own(simulation) = &mut line.what {
                simulation.undo();
            }
        }
        self.groups[..groups].iter_mut().for_each(Group::undo);
        Err(error)
    }

    /// Outputs of a line now.
    pub fn outputs(&mut self, index: usize) -> Outputs {
        let [work, _] = self.works(index);
        match &mut self.lines[index].what {
            // Its work is among its outputs.
            What::Own(simulation) => simulation.observe(),
            What::Member { group, local } => Outputs { work, ..self.groups[*group].outputs(*local) },
        }
    }

    /// What a line is like now at arc lengths from its fairlead [m].
    pub fn places(&mut self, index: usize, at: &[f64]) -> Vec<Place> {
        match &mut self.lines[index].what {
            What::Own(simulation) => simulation.places(at),
            What::Member { group, local } => self.groups[*group].places(*local, at),
        }
    }

    /// Work on what drives the ends of a line, fairlead and anchor [J].
    pub fn works(&self, index: usize) -> [f64; 2] {
        match &self.lines[index].what {
            What::Own(simulation) => [simulation.work(), simulation.anchor_work()],
            What::Member { group, local } => [EndOf::Fairlead, EndOf::Anchor].map(|end| self.groups[*group].work(*local, end)),
        }
    }

    /// How the solver did in the last step of a line.
    pub fn last_step(&self, index: usize) -> LastStep {
        match &self.lines[index].what {
            What::Own(simulation) => simulation.last_step(),
            What::Member { group, .. } => self.groups[*group].last_step(),
        }
    }

    /// Rates of the outputs of a line in time.
    pub fn output_rates(&mut self, index: usize) -> Outputs {
        match &mut self.lines[index].what {
            What::Own(simulation) => simulation.output_rates(),
            What::Member { group, local } => self.groups[*group].output_rates(*local),
        }
    }

    /// How many states there are to save.
    pub fn states(&self) -> usize {
        self.lines.iter().filter(|line| matches!(line.what, What::Own(_))).count() + self.groups.len()
    }

    /// Saves the state of everything.
    pub fn save(&self, snapshots: &mut Vec<Snapshot>) {
        snapshots.resize_with(self.states(), || Snapshot::new(2));
        let mut into = snapshots.iter_mut();
        for line in &self.lines {
            if let (What::Own(simulation), Some(snapshot)) = (&line.what, if line.is_own() { into.next() } else { None }) {
                simulation.save(snapshot);
            }
        }
        self.groups.iter().zip(into).for_each(|(group, snapshot)| group.save(snapshot));
    }

    /// Whether states are those of this mooring.
    pub fn fits(&self, snapshots: &[Snapshot]) -> bool {
        let own =
            self.lines.iter().filter_map(|line| if let What::Own(simulation) = &line.what { Some(simulation) } else { None });
        let mut from = snapshots.iter();
        snapshots.len() == self.states() && own.zip(from.by_ref()).all(|(simulation, snapshot)| simulation.fits(snapshot)) && {
            let groups = &snapshots[snapshots.len() - self.groups.len()..];
            self.groups.iter().zip(groups).all(|(group, snapshot)| group.fits(snapshot))
        }
    }

    /// Puts states back that fit.
    pub fn restore(&mut self, snapshots: &[Snapshot]) {
        let mut from = snapshots.iter();
        for line in &mut self.lines {
            if let What::Own(simulation) = &mut line.what
                && let Some(snapshot) = from.next()
            {
                simulation.restore(snapshot);
            }
            line.linearised = None;
        }
        self.groups.iter_mut().zip(from).for_each(|(group, snapshot)| {
            group.restore(snapshot);
        });
    }
}

impl BuiltLine {
    fn new(scene: &Scene, index: usize, what: What, ends: Ends, limits: Limits) -> BuiltLine {
        let line = &scene.lines[index];
        let mount = |on: &Option<Mount>| match on {
            Some(Mount::Body { body, at, .. }) => {
                scene.body(body).filter(|body| !scene.bodies[*body].is_free()).map(|body| (body, (*at).into()))
            }
            _ => None,
        };
        let mounts = [mount(&line.fairlead_on), mount(&line.anchor_on)];
        BuiltLine { what, origin: line.fairlead, mounts, route: None, ends, limits, linearised: None }
    }

    /// Whether it is computed by itself.
    pub fn is_own(&self) -> bool {
        matches!(self.what, What::Own(_))
    }

    /// What its linearisation belongs to: the segments of all that drives it.
    pub fn segments(&self, vessels: &[BuiltVessel]) -> Vec<Segment> {
        let own = self.route.iter().map(|route| route.segment.clone());
        let voyages = self.mounts.iter().flatten().filter_map(|(body, _)| vessels[*body].voyage.as_ref());
        own.chain(voyages.flat_map(|voyage| voyage.segments.clone())).collect()
    }
}

/// What a line bears, and what it carries now.
fn limits(scene: &Scene, index: usize, simulation: &Simulation) -> Limits {
    let sections = scene.lines.get(index).map_or(&[][..], |line| &line.sections);
    let loads = sections.iter().filter_map(|section| scene.line_types.get(&section.line_type)?.breaking_load);
    let length = sections.iter().map(|section| section.length).sum();
    let outputs = simulation.outputs();
    Limits {
        breaking_load: loads.fold(f64::INFINITY, f64::min),
        length,
        tension: outputs.tension,
        grounded: outputs.grounded_length,
    }
}
