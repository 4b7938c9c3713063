//! A part of a mooring that moves for itself: a line between ends that are fixed or driven, or lines that meet at free bodies and points.

use crate::error::Error;
use crate::scene::read::Loaded;
use crate::solve::between::Place;
use crate::solve::group::Group;
use crate::solve::loads::Pose;
use crate::solve::motion::Ends;
use crate::solve::partition::Together;
use crate::solve::simulation::{Counters, Decision, NodeOutput, Outputs, Simulation, StaticsReport};
use nalgebra::Vector3;

/// The part.
pub enum Part {
    /// A line that nothing is joined with.
    Alone {
        /// Its number in the scene.
        index: [usize; 1],
        /// The line.
        simulation: Box<Simulation>,
        /// The paths of its ends.
        ends: Box<Ends>,
    },
    /// Lines that meet.
    Group(Box<Group>),
}

impl Part {
    /// A part of a scene, its driven ends on their paths.
    pub fn of_scene(loaded: &Loaded, together: &Together) -> Result<Part, Error> {
        let ends: Vec<Ends> = together.lines.iter().map(|index| Ends::of_scene(loaded, *index)).collect();
        match (together.is_alone(), &together.lines[..]) {
            (true, [index]) => {
                let ends = Box::new(ends.into_iter().next().unwrap_or_else(|| Ends::of_scene(loaded, *index)));
                let simulation = Box::new(Simulation::on_ends(&loaded.scene, *index, Some(&ends))?);
                Ok(Part::Alone { index: [*index], simulation, ends })
            }
            _ => Ok(Part::Group(Box::new(Group::new(loaded, together, &ends)?))),
        }
    }

    /// Numbers of its lines in the scene.
    pub fn lines(&self) -> &[usize] {
        match self {
            Part::Alone { index, .. } => index,
            Part::Group(group) => &group.together().lines,
        }
    }

    /// Puts it in equilibrium at a time.
    pub fn settle(&mut self, time: f64) -> Result<StaticsReport, Error> {
        match self {
            Part::Alone { simulation, ends, .. } => {
                simulation.settle_between(ends.fairlead.at(time).position, ends.anchor.at(time).position, time)
            }
            Part::Group(group) => group.settle(time),
        }
    }

    /// Advances to a time. On an error it stands as before.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
        match self {
            Part::Alone { simulation, ends, .. } => simulation.advance_ends(until, ends),
            Part::Group(group) => group.advance(until),
        }
    }

    /// Outputs of one of its lines now.
    pub fn outputs(&mut self, local: usize) -> Outputs {
        match self {
            Part::Alone { simulation, .. } => simulation.observe(),
            Part::Group(group) => group.outputs(local),
        }
    }

    /// Nodes of one of its lines now, from the fairlead.
    pub fn nodes(&mut self, local: usize) -> Vec<NodeOutput> {
        match self {
            Part::Alone { simulation, .. } => simulation.nodes(),
            Part::Group(group) => group.nodes(local),
        }
    }

    /// What one of its lines is like now at arc lengths from its fairlead [m].
    pub fn places(&mut self, local: usize, at: &[f64]) -> Vec<Place> {
        match self {
            Part::Alone { simulation, .. } => simulation.places(at),
            Part::Group(group) => group.places(local, at),
        }
    }

    /// One of its lines, to be asked about mesh and physics.
    pub fn line(&self, local: usize) -> &Simulation {
        match self {
            Part::Alone { simulation, .. } => simulation,
            Part::Group(group) => group.line(local),
        }
    }

    /// Work done so far for one of its lines; of lines that meet, all of it counts for the first.
    pub fn counters(&self, local: usize) -> Counters {
        match self {
            Part::Alone { simulation, .. } => simulation.counters(),
            Part::Group(group) if local == 0 => group.counters(),
            Part::Group(_) => Counters::default(),
        }
    }

    /// Which physics is in the step of one of its lines and why.
    pub fn decisions(&self, local: usize) -> &[Decision] {
        self.line(local).decisions()
    }

    /// Poses of its free bodies now, with their numbers in the scene.
    pub fn bodies(&self) -> Vec<(usize, Pose)> {
        let Part::Group(group) = self else { return Vec::new() };
        let numbers = group.together().bodies.iter().enumerate();
        numbers.map(|(number, body)| (*body, Pose::of(&group.body(number)))).collect()
    }

    /// Positions of its free points now [m], with their numbers in the scene.
    pub fn points(&self) -> Vec<(usize, Vector3<f64>)> {
        let Part::Group(group) = self else { return Vec::new() };
        let numbers = group.together().points.iter().enumerate();
        numbers.map(|(number, point)| (*point, group.point(number).position)).collect()
    }
}
