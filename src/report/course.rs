//! A scene on its way through the rows of a run: its parts move for themselves, their rows are gathered, and somebody follows.

use crate::error::Error;
use crate::report::record::Record;
use crate::report::schedule::Schedule;
use crate::report::tables;
use crate::scene::cable::Job;
use crate::scene::read::Loaded;
use crate::scene::state::LineState;
use crate::scene::types::Scheme;
use crate::solve::between::Place;
use crate::solve::departure::{self, Departure};
use crate::solve::fleet;
use crate::solve::loads::{BodyOutputs, Pose};
use crate::solve::mooring::Hung;
use crate::solve::part::Part;
use crate::solve::partition::{self, Together};
use crate::solve::simulation::{Counters, NodeOutput, Outputs};
use nalgebra::Vector3;
use std::sync::Arc;
use std::time::Instant;

/// Who follows a run: writes its tables, shows its progress. An error ends the run.
pub trait Follower {
    /// A row, numbered from 0; it is not in the record yet.
    fn row(&mut self, record: &Record, number: usize, row: &Row) -> Result<(), Error>;
    /// The row is one of which all nodes are kept.
    fn snapshot(&mut self, row: &Row) -> Result<(), Error>;
    /// The last row that all lines share, wherever the run ended.
    fn end(&mut self, record: &Record, row: &Row) -> Result<(), Error>;
}

/// What is wanted of every line.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// When there are rows.
    pub schedule: &'a Schedule,
    /// The rows as text.
    pub text: bool,
    /// The tension of the wall in the text.
    pub walls: bool,
    /// The state for the files of 1994.
    pub states: bool,
    /// What it is like at these arc lengths from the fairlead [m], line by line; none of any line where this is empty.
    pub places: &'a [Vec<f64>],
    /// Whether the user has asked to stop; looked at before every row of every part, on any thread.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// A part of the mooring on its way.
struct MovingPart {
    part: Part,
    names: Vec<String>,
    /// Wall time inside the time loop [s].
    seconds: f64,
    /// Time at which it stands, if it could go no further [s].
    stuck_at: Option<f64>,
}

/// A line at an output time, with its part of the tables.
struct Sample {
    index: usize,
    outputs: Outputs,
    nodes: Vec<NodeOutput>,
    counters: Counters,
    cells: String,
    /// Where a snapshot is due.
    node_rows: Option<Vec<u8>>,
    state: Option<LineState>,
    places: Vec<Place>,
}

/// A part at an output time.
struct PartSample {
    lines: Vec<Sample>,
    bodies: Vec<(usize, Pose)>,
    points: Vec<(usize, Vector3<f64>)>,
}

impl MovingPart {
    /// Advances to a row, unless the user stops the run before.
    fn go(&mut self, row: usize, wanted: &Wanted) -> Result<PartSample, Error> {
        if (wanted.stop)() {
            return Err(Error::Interrupted { time: wanted.schedule.time(row - 1) });
        }
        let started = Instant::now();
        let outcome = self.part.advance(wanted.schedule.time(row));
        self.seconds += started.elapsed().as_secs_f64();
        if outcome.is_err() {
            self.stuck_at = Some(wanted.schedule.time(row - 1));
        }
        outcome.map(|()| self.sample(row, wanted))
    }

    fn sample(&mut self, row: usize, wanted: &Wanted) -> PartSample {
        let due = row.is_multiple_of(wanted.schedule.rows_per_snapshot());
        let indices = self.part.lines().to_vec();
        let mut line = |(local, index): (usize, usize)| {
            let (outputs, nodes) = (self.part.outputs(local), self.part.nodes(local));
            let time = wanted.schedule.time(row);
            let wanted_places = wanted.places.get(index).map_or(&[][..], Vec::as_slice);
            Sample {
                index,
                outputs,
                counters: self.part.counters(local),
                cells: if wanted.text { tables::cells(&outputs) } else { String::new() },
                node_rows: (wanted.text && due).then(|| tables::node_rows(time, &self.names[local], &nodes, wanted.walls)),
                nodes,
                state: wanted.states.then(|| self.part.line(local).line_state()),
                places: if wanted_places.is_empty() { Vec::new() } else { self.part.places(local, wanted_places) },
            }
        };
        let lines = indices.into_iter().enumerate().map(&mut line).collect();
        PartSample { lines, bodies: self.part.bodies(), points: self.part.points() }
    }
}

/// All lines, bodies and free points at an output time.
#[derive(Default)]
pub struct Row {
    /// The time [s].
    pub time: f64,
    /// Outputs of the lines.
    pub outputs: Vec<Outputs>,
    /// Their nodes.
    pub nodes: Vec<Vec<NodeOutput>>,
    /// Work done for them so far.
    pub counters: Vec<Counters>,
    /// Their cells in `timeseries.csv`, those of bodies and points after them; where text is wanted.
    pub cells: Vec<String>,
    /// Their rows in `nodes.csv`, where text is wanted and a snapshot is due.
    pub node_rows: Vec<Vec<u8>>,
    /// Of the first line, where a CABLE file is run.
    pub state: Option<LineState>,
    /// Places of the lines that were asked for.
    pub places: Vec<Vec<Place>>,
    /// The bodies.
    pub bodies: Vec<BodyOutputs>,
    /// The free points [m].
    pub points: Vec<Vector3<f64>>,
}

impl Row {
    fn of(time: f64, parts: Vec<PartSample>, hung: &Hung, text: bool) -> Row {
        let mut row = Row { time, ..Row::default() };
        let (mut lines, mut poses, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for part in parts {
            lines.extend(part.lines);
            poses.extend(part.bodies);
            points.extend(part.points);
        }
        lines.sort_by_key(|line| line.index);
        for line in lines {
            row.outputs.push(line.outputs);
            row.nodes.push(line.nodes);
            row.counters.push(line.counters);
            row.cells.push(line.cells);
            row.node_rows.extend(line.node_rows);
            row.state = row.state.or(line.state);
            row.places.push(line.places);
        }
        row.bodies = hung.bodies(time, &poses, &row.outputs);
        points.sort_by_key(|(index, _)| *index);
        row.points = points.into_iter().map(|(_, place)| place).collect();
        if text {
            row.cells.extend(row.bodies.iter().map(tables::body_cells));
            row.cells.extend(row.points.iter().map(tables::point_cells));
        }
        row
    }
}

/// All parts of a scene. They do not know of each other; their rows are gathered at the output times.
pub struct Course {
    parts: Vec<MovingPart>,
    hung: Hung,
    /// The state that a CABLE file gives the first line.
    given: Option<Arc<LineState>>,
}

impl Course {
    /// The parts of a scene, meshed.
    pub fn new(loaded: &Loaded) -> Result<Course, Error> {
        let part = |together: &mut Together| {
            let part = Part::of_scene(loaded, together)?;
            let names = part.lines().iter().map(|index| loaded.scene.lines[*index].name.clone()).collect();
            Ok(MovingPart { part, names, seconds: 0.0, stuck_at: None })
        };
        let mut parts = partition::parts(&loaded.scene);
        let parts = fleet::for_each(&mut parts, part).into_iter().collect::<Result<_, Error>>()?;
        let dynamics = loaded.deck.as_ref().is_some_and(|deck| deck.job == Job::Dynamics);
        Ok(Course { parts, hung: Hung::new(loaded), given: loaded.state.clone().filter(|_| dynamics) })
    }

    /// From static equilibrium to the end of the schedule, or to the failure that ends the run earlier. The record holds what came before it.
    pub fn run(&mut self, wanted: &Wanted, record: &mut Record, follower: &mut dyn Follower) -> Result<(), Error> {
        for part in &self.parts {
            let lines = part.part.lines().iter().enumerate();
            lines.for_each(|(local, index)| record.lines[*index].elements = part.part.line(local).elements());
        }
        self.settle(record)?;
        let schedule = wanted.schedule;
        let start = self.parts.iter_mut().map(|part| part.sample(0, wanted)).collect();
        let Course { parts, hung, .. } = &mut *self;
        let mut now = Row::of(schedule.time(0), start, hung, wanted.text);
        let mut take = |number: usize, row: &Row| {
            follower.row(record, number, row)?;
            record.add_row(row.time, &row.outputs, &row.nodes);
            record.add_bodies(&row.bodies, &row.points);
            record.add_places(&row.places);
            record.count(&row.counters);
            if number.is_multiple_of(schedule.rows_per_snapshot()) {
                follower.snapshot(row)?;
                record.add_snapshot(row.time, &row.nodes);
            }
            Ok(())
        };
        take(0, &now)?;
        let gather = |number: usize, samples: Vec<PartSample>| {
            now = Row::of(schedule.time(number), samples, hung, wanted.text);
            take(number, &now)
        };
        let outcome = fleet::through_rows(parts, 1..schedule.rows(), |part, row| part.go(row, wanted), gather);
        self.account(record);
        if record.snapshot_times.last() < Some(&now.time) {
            let names = record.lines.iter().map(|line| line.name.as_str());
            let nodes = names.zip(&now.nodes).filter(|_| wanted.text);
            now.node_rows = nodes.map(|(name, nodes)| tables::node_rows(now.time, name, nodes, wanted.walls)).collect();
            follower.snapshot(&now)?;
            record.add_snapshot(now.time, &now.nodes);
        }
        follower.end(record, &now)?;
        outcome
    }

    /// Finds the equilibrium of all parts, or begins where a CABLE file says. Of a line that has no equilibrium, the best state found is
    /// recorded.
    fn settle(&mut self, record: &mut Record) -> Result<(), Error> {
        let begin = record.scene.run.start;
        let exactly = record.scene.solver.scheme == Scheme::Cable1994;
        let started = Instant::now();
        let mut given = self.given.take();
        let mut beginnings: Vec<_> = self.parts.iter_mut().map(|part| (part, given.take())).collect();
        let departures = fleet::for_each(&mut beginnings, |(part, given)| match (&mut part.part, given) {
            (Part::Alone { simulation, ends, .. }, Some(given)) => {
                departure::depart(simulation, given, ends.fairlead.at(begin).position, exactly)
            }
            (part, _) => part.settle(begin).map(Departure::Equilibrium),
        });
        record.statics_seconds += started.elapsed().as_secs_f64();
        for (part, departure) in self.parts.iter_mut().zip(departures) {
            for (local, index) in part.part.lines().to_vec().into_iter().enumerate() {
                record.lines[index].equilibrium = part.part.nodes(local);
            }
            let departure = departure?;
            if let Departure::Equilibrium(report) | Departure::Foreign(report) = departure {
                part.part.lines().iter().for_each(|index| record.lines[*index].statics = Some(report));
            }
            record.scene_warnings.extend(remark(&departure).map(|remark| format!("{}: {remark}", record.file)));
        }
        Ok(())
    }

    /// Notes the time spent, and the work of a part in the step that ended the run.
    fn account(&self, record: &mut Record) {
        let seconds = self.parts.iter().map(|part| part.seconds);
        record.line_seconds = seconds.clone().sum();
        record.solver_seconds =
            (record.line_seconds / fleet::threads(self.parts.len()).max(1) as f64).max(seconds.fold(0.0, f64::max));
        let end = record.end_time();
        for part in self.parts.iter().filter(|part| part.stuck_at.is_some() && part.stuck_at == end) {
            for (local, index) in part.part.lines().iter().enumerate() {
                record.lines[*index].counters = part.part.counters(local);
            }
        }
    }
}

/// What a user should know of the nodes from which a run began.
fn remark(departure: &Departure) -> Option<String> {
    match departure {
        Departure::Equilibrium(_) | Departure::Moving => None,
        Departure::Unbalanced { node, distance } => Some(format!(
            "the nodes are not in equilibrium: node {node} would rest {distance:.2} m away; the run began from them as they stand"
        )),
        Departure::Unsettled => {
            Some("the nodes are not in equilibrium, and none was found; the run began from them as they stand".to_string())
        }
        Departure::Foreign(_) => Some("the line is longer than the nodes say; the run began in equilibrium".to_string()),
    }
}
