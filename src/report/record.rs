//! What a run remembers: rows at the output times, snapshots of the nodes, counters, warnings. Plain data, no files.

use crate::algebra::sinusoid::Sinusoid;
use crate::error::Error;
use crate::report::rainflow::{Curve, Rainflow};
use crate::report::units::{ForceUnit, sim_time};
use crate::scene::bodies::{Body, BodyMotion, Point, PointMotion};
use crate::scene::types::{LineType, Motion, Scene};
use crate::sea::drawing;
use crate::solve::between::Place;
use crate::solve::loads::BodyOutputs;
use crate::solve::simulation::{Counters, NodeOutput, Outputs, StaticsReport};
use nalgebra::Vector3;
use serde::Serialize;
use std::collections::BTreeMap;

/// A run as far as it came.
#[derive(Debug, Clone)]
pub struct Record {
    /// The scene that was run.
    pub scene: Scene,
    /// Name of its file.
    pub file: String,
    /// The lines, in the order of the scene.
    pub lines: Vec<LineRecord>,
    /// The bodies, in the order of the scene.
    pub bodies: Vec<BodyRecord>,
    /// The free points, in the order of the scene.
    pub points: Vec<PointRecord>,
    /// Times of the rows [s].
    pub times: Vec<f64>,
    /// Times of the snapshots [s].
    pub snapshot_times: Vec<f64>,
    /// Interval of the snapshots [s]; the last state of a run is always one more.
    pub snapshot_step: f64,
    /// Wall time of meshing and static equilibrium, all lines [s].
    pub statics_seconds: f64,
    /// Wall time inside the time loop, all lines, no output [s]: that of all lines shared out to the threads, or of the slowest line if
    /// that is longer.
    pub solver_seconds: f64,
    /// The same, added up over the lines [s].
    pub line_seconds: f64,
    /// Time from which the statistics of a random sea and the damage count [s].
    pub statistics_from: f64,
    /// Warnings of the scene.
    pub scene_warnings: Vec<String>,
    /// Why the run ended early; `None` after a whole run.
    pub ended_by: Option<Error>,
}

/// One body of a run.
#[derive(Debug, Clone)]
pub struct BodyRecord {
    /// Its name.
    pub name: String,
    /// Whether a motion drives it.
    pub driven: bool,
    /// Pose and loads at the times of the rows.
    pub rows: Vec<BodyOutputs>,
}

/// One free point of a run.
#[derive(Debug, Clone)]
pub struct PointRecord {
    /// Its name.
    pub name: String,
    /// Positions at the times of the rows [m].
    pub rows: Vec<Vector3<f64>>,
}

/// One line of a run.
#[derive(Debug, Clone)]
pub struct LineRecord {
    /// Its name.
    pub name: String,
    /// Unstretched length [m].
    pub length: f64,
    /// Number of elements.
    pub elements: usize,
    /// How statics went; `None` where no equilibrium was found.
    pub statics: Option<StaticsReport>,
    /// Nodes in static equilibrium, or in the best state found.
    pub equilibrium: Vec<NodeOutput>,
    /// Outputs at the times of the rows.
    pub rows: Vec<Outputs>,
    /// Nodes at the times of the snapshots.
    pub snapshots: Vec<Vec<NodeOutput>>,
    /// At the times of the rows, places that somebody asked for.
    pub places: Vec<Vec<Place>>,
    /// Work done by the solver.
    pub counters: Counters,
    /// Cycles at both ends of every section whose type has a T–N curve.
    pub fatigue: Vec<SectionEnd>,
    /// Parts of the line with a breaking load, and what they had to bear.
    parts: Vec<Part>,
}

/// The cycles of the tension at an end of a section, counted row by row.
#[derive(Debug, Clone)]
pub struct SectionEnd {
    /// The section, counted from the fairlead.
    pub section: usize,
    /// Its line type.
    pub line_type: String,
    /// Where along the line [m from the fairlead].
    pub s: f64,
    /// The T–N curve of the type.
    pub curve: Curve,
    /// The cycles from `Record::statistics_from` on.
    pub rainflow: Rainflow,
}

/// A section that has a breaking load.
#[derive(Debug, Clone)]
struct Part {
    section: usize,
    line_type: String,
    from: f64,
    to: f64,
    breaking_load: f64,
    exceeded: Option<Overload>,
}

/// The largest tension of a section beyond its breaking load.
#[derive(Debug, Clone, Copy)]
struct Overload {
    tension: f64,
    s: f64,
    time: f64,
    first_time: f64,
}

/// What the rows of one column amount to: extremes are those of the rows, mean and standard deviation give each row the same weight
/// (and divide by the number of rows), so that anyone can repeat them from `timeseries.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Statistics {
    /// Value of the first row: static equilibrium.
    pub initial: f64,
    /// Largest value.
    pub max: f64,
    /// Its time [s], the first one where several rows share it.
    pub max_time: f64,
    /// Smallest value.
    pub min: f64,
    /// Its time [s].
    pub min_time: f64,
    /// Mean of the rows.
    pub mean: f64,
    /// Standard deviation of the rows.
    pub std: f64,
}

impl Statistics {
    /// Statistics of (time, value) rows; `None` without rows.
    pub fn of(rows: impl Iterator<Item = (f64, f64)> + Clone) -> Option<Statistics> {
        let (first_time, initial) = rows.clone().next()?;
        let number = rows.clone().count() as f64;
        let mean = rows.clone().map(|(_, value)| value).sum::<f64>() / number;
        let variance = rows.clone().map(|(_, value)| (value - mean).powi(2)).sum::<f64>() / number;
        let mut statistics = Statistics {
            initial,
            max: initial,
            max_time: first_time,
            min: initial,
            min_time: first_time,
            mean,
            std: variance.sqrt(),
        };
        for (time, value) in rows {
            if value > statistics.max {
                (statistics.max, statistics.max_time) = (value, time);
            }
            if value < statistics.min {
                (statistics.min, statistics.min_time) = (value, time);
            }
        }
        Some(statistics)
    }
}

impl Record {
    /// An empty record of a scene read from `file`, with the warnings of reading it.
    pub fn new(scene: &Scene, file: &str, scene_warnings: Vec<String>, snapshot_step: f64) -> Record {
        Record {
            scene: scene.clone(),
            file: file.to_string(),
            lines: (0..scene.lines.len()).map(|index| LineRecord::new(scene, index)).collect(),
            bodies: scene.bodies.iter().map(BodyRecord::new).collect(),
            points: scene.points.iter().filter(|point| point.is_free()).map(PointRecord::new).collect(),
            times: Vec::new(),
            snapshot_times: Vec::new(),
            snapshot_step,
            statics_seconds: 0.0,
            solver_seconds: 0.0,
            line_seconds: 0.0,
            statistics_from: scene.run.start + transient(scene),
            scene_warnings,
            ended_by: None,
        }
    }

    /// Adds the places of lines that were asked for, of the row that was added last.
    pub fn add_places(&mut self, places: &[Vec<Place>]) {
        for (line, places) in self.lines.iter_mut().zip(places).filter(|(_, places)| !places.is_empty()) {
            line.places.push(places.clone());
        }
    }

    /// Adds a row: time [s], and each line's outputs and nodes then.
    pub fn add_row(&mut self, time: f64, outputs: &[Outputs], nodes: &[Vec<NodeOutput>]) {
        self.times.push(time);
        for ((line, outputs), nodes) in self.lines.iter_mut().zip(outputs).zip(nodes) {
            line.rows.push(*outputs);
            line.watch_breaking_loads(time, outputs.tension_max, nodes);
            if time >= self.statistics_from {
                line.count_cycles(outputs, nodes);
            }
        }
    }

    /// Adds the bodies and free points of a row.
    pub fn add_bodies(&mut self, bodies: &[BodyOutputs], points: &[Vector3<f64>]) {
        self.bodies.iter_mut().zip(bodies).for_each(|(body, row)| body.rows.push(*row));
        self.points.iter_mut().zip(points).for_each(|(point, row)| point.rows.push(*row));
    }

    /// Notes the work done for each line so far.
    pub fn count(&mut self, counters: &[Counters]) {
        self.lines.iter_mut().zip(counters).for_each(|(line, counters)| line.counters = *counters);
    }

    /// Adds a snapshot: time [s] and each line's nodes then.
    pub fn add_snapshot(&mut self, time: f64, nodes: &[Vec<NodeOutput>]) {
        self.snapshot_times.push(time);
        for (line, nodes) in self.lines.iter_mut().zip(nodes) {
            line.snapshots.push(nodes.clone());
        }
    }

    /// Time of the last row [s]; `None` before the first.
    pub fn end_time(&self) -> Option<f64> {
        self.times.last().copied()
    }

    /// Number of elements of all lines.
    pub fn elements(&self) -> usize {
        self.lines.iter().map(|line| line.elements).sum()
    }

    /// Work done by the solver for all lines.
    pub fn counters(&self) -> Counters {
        self.lines.iter().fold(Counters::default(), |sum, line| Counters {
            steps: sum.steps + line.counters.steps,
            rejected_steps: sum.rejected_steps + line.counters.rejected_steps,
            unresolved_steps: sum.unresolved_steps + line.counters.unresolved_steps,
            pushing_steps: sum.pushing_steps + line.counters.pushing_steps,
            newton_iterations: sum.newton_iterations + line.counters.newton_iterations,
            factorisations: sum.factorisations + line.counters.factorisations,
            element_iterations: sum.element_iterations + line.counters.element_iterations,
        })
    }

    /// Simulated seconds per second of solver time; `None` where nothing was simulated.
    pub fn times_real_time(&self) -> Option<f64> {
        let simulated = self.end_time()?;
        (simulated > 0.0 && self.solver_seconds > 0.0).then(|| simulated / self.solver_seconds)
    }

    /// The unit for all forces of this run.
    pub fn force_unit(&self) -> ForceUnit {
        let rows = self.lines.iter().flat_map(|line| line.rows.iter().map(|row| row.tension.max(row.anchor_tension)));
        let statics = self.lines.iter().flat_map(|line| line.equilibrium.iter().map(|node| node.tension.abs()));
        ForceUnit::for_largest(rows.chain(statics).fold(0.0, f64::max))
    }

    /// All warnings: those of the scene, then breaking loads exceeded, then steps whose error was above the tolerance or whose line pushed.
    pub fn warnings(&self) -> Vec<String> {
        let overloads = self.lines.iter().flat_map(|line| line.parts.iter().filter_map(|part| part.warning(&line.name)));
        let unresolved = self.lines.iter().filter_map(LineRecord::unresolved);
        let pushing = self.lines.iter().filter_map(LineRecord::pushing);
        self.scene_warnings.iter().cloned().chain(overloads).chain(unresolved).chain(pushing).collect()
    }
}

impl BodyRecord {
    fn new(body: &Body) -> BodyRecord {
        BodyRecord { name: body.name.clone(), driven: !body.is_free(), rows: Vec::new() }
    }
}

impl PointRecord {
    fn new(point: &Point) -> PointRecord {
        PointRecord { name: point.name.clone(), rows: Vec::new() }
    }
}

impl LineRecord {
    fn new(scene: &Scene, index: usize) -> LineRecord {
        let line = &scene.lines[index];
        LineRecord {
            name: line.name.clone(),
            length: line.length(),
            elements: 0,
            statics: None,
            equilibrium: Vec::new(),
            rows: Vec::new(),
            snapshots: Vec::new(),
            places: Vec::new(),
            counters: Counters::default(),
            fatigue: ends_with_curve(scene, index),
            parts: parts_with_breaking_load(scene, index, &scene.line_types),
        }
    }

    /// Says so where the tolerance was not met.
    fn unresolved(&self) -> Option<String> {
        let Counters { steps, unresolved_steps, .. } = self.counters;
        (unresolved_steps > 0).then(|| {
            format!(
                "line \"{}\": {unresolved_steps} of {steps} steps did not meet the tolerance: the line snaps or rings faster than the \
                 finest step resolves. Read peaks as statistics; more axial damping or a smaller solver.max_step resolves more.",
                self.name
            )
        })
    }

    /// Says so where the scheme `cable-1994` left the ground of its equations.
    fn pushing(&self) -> Option<String> {
        let Counters { steps, pushing_steps, .. } = self.counters;
        (pushing_steps > 0).then(|| {
            format!(
                "line \"{}\": in {pushing_steps} of {steps} steps a part of the line pushed: the scheme cable-1994 knows no slack line, \
                 and its result means nothing there. Use adams-moulton.",
                self.name
            )
        })
    }

    /// Statistics of one output over the rows, such as `|row| row.tension`; `None` without rows.
    pub fn statistics(&self, output: impl Fn(&Outputs) -> f64 + Clone) -> Option<Statistics> {
        Statistics::of(self.rows.iter().map(move |row| (row.time, output(row))))
    }

    /// The tension at the fairlead and at the anchor is that of the line's force on what holds it, as in `timeseries.csv`.
    fn count_cycles(&mut self, outputs: &Outputs, nodes: &[NodeOutput]) {
        let near = 1.0e-6 * self.length;
        for end in &mut self.fatigue {
            let inside = || nodes.get(nodes.partition_point(|node| node.s < end.s - near)).map(|node| node.tension);
            let tension = match end.s {
                s if s <= near => Some(outputs.tension),
                s if s >= self.length - near => Some(outputs.anchor_tension),
                _ => inside(),
            };
            tension.into_iter().for_each(|tension| end.rainflow.push(tension));
        }
    }

    fn watch_breaking_loads(&mut self, time: f64, tension_max: f64, nodes: &[NodeOutput]) {
        for part in self.parts.iter_mut().filter(|part| tension_max > part.breaking_load) {
            let here = part.from..=part.to;
            nodes.iter().filter(|node| here.contains(&node.s)).for_each(|node| part.bear(time, node));
        }
    }
}

/// Time for which a run is not yet what it will be [s]: as given, or the longer of the ramps of waves and motion.
fn transient(scene: &Scene) -> f64 {
    let waves = drawing::seas(&scene.environment).iter().map(|sea| sea.ramp).fold(0.0, f64::max);
    let eased = |period: f64, ramp: Option<f64>| Sinusoid::new(period, [0.0; 3], [0.0; 3], ramp).ramp;
    let motion = match &scene.motion {
        Motion::Sinusoidal { period, ramp, .. } => eased(*period, *ramp),
        Motion::Fixed | Motion::File { .. } => 0.0,
    };
    let bodies = scene.bodies.iter().map(|body| match &body.motion {
        BodyMotion::Sinusoidal { period, ramp, .. } => eased(*period, *ramp),
        _ => 0.0,
    });
    let points = scene.points.iter().map(|point| match &point.motion {
        PointMotion::Sinusoidal { period, ramp, .. } => eased(*period, *ramp),
        _ => 0.0,
    });
    scene.run.transient.unwrap_or(bodies.chain(points).fold(waves.max(motion), f64::max))
}

/// Both ends of every section whose type has a T–N curve.
fn ends_with_curve(scene: &Scene, index: usize) -> Vec<SectionEnd> {
    let mut ends = Vec::new();
    let mut from = 0.0;
    for (section, given) in scene.lines[index].sections.iter().enumerate() {
        let to = from + given.length;
        if let Some(line_type) = scene.line_types.get(&given.line_type)
            && let (Some(fatigue), Some(breaking_load)) = (line_type.fatigue, line_type.breaking_load)
        {
            let curve = Curve { m: fatigue.m, k: fatigue.k, breaking_load };
            let line_type = &given.line_type;
            ends.extend([from, to].map(|s| SectionEnd {
                section,
                line_type: line_type.clone(),
                s,
                curve,
                rainflow: Rainflow::default(),
            }));
        }
        from = to;
    }
    ends
}

fn parts_with_breaking_load(scene: &Scene, index: usize, line_types: &BTreeMap<String, LineType>) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut from = 0.0;
    for (section, given) in scene.lines[index].sections.iter().enumerate() {
        let to = from + given.length;
        if let Some(breaking_load) = line_types.get(&given.line_type).and_then(|line_type| line_type.breaking_load) {
            let rounding = 1.0e-9 * to;
            parts.push(Part {
                section,
                line_type: given.line_type.clone(),
                from: from - rounding,
                to: to + rounding,
                breaking_load,
                exceeded: None,
            });
        }
        from = to;
    }
    parts
}

impl Part {
    fn bear(&mut self, time: f64, node: &NodeOutput) {
        let worst = self.exceeded.map_or(self.breaking_load, |overload| overload.tension);
        if node.tension > worst {
            let first_time = self.exceeded.map_or(time, |overload| overload.first_time);
            self.exceeded = Some(Overload { tension: node.tension, s: node.s, time, first_time });
        }
    }

    fn warning(&self, line: &str) -> Option<String> {
        let overload = self.exceeded?;
        let unit = ForceUnit::for_largest(overload.tension);
        Some(format!(
            "line \"{line}\", sections[{}] \"{}\": the tension reaches {} at t = {} s, s = {:.4} m; its breaking load, {}, is exceeded \
             first at t = {} s. The line is kept whole.",
            self.section,
            self.line_type,
            unit.show(overload.tension),
            sim_time(overload.time),
            overload.s.max(0.0),
            unit.show(self.breaking_load),
            sim_time(overload.first_time),
        ))
    }
}

/// Arc length of the touchdown [m from the fairlead], where the line ends at its anchor on the bed; `None` where it does not.
/// `grounded_length` [m] is unstretched and taken to reach from the touchdown to the anchor.
pub fn touchdown(scene: &Scene, line: usize, grounded_length: f64) -> Option<f64> {
    let given = &scene.lines[line];
    let [x, y, z] = given.anchor;
    let height = z - bed_height(scene, x, y);
    let anchor_on_bed = height <= 1.0e-3 * scene.environment.depth;
    (anchor_on_bed && grounded_length > 0.0).then(|| (given.length() - grounded_length).max(0.0))
}

/// Height of the seabed at (x, y) [m], up from still water.
pub fn bed_height(scene: &Scene, x: f64, y: f64) -> f64 {
    let [along_x, along_y] = scene.environment.seabed.slope_deg;
    -scene.environment.depth + x * along_x.to_radians().tan() + y * along_y.to_radians().tan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{node, outputs};

    fn scene() -> Scene {
        serde_json::from_value(serde_json::json!({
            "environment": {"depth": 100.0, "seabed": {"slope_deg": [45.0, 0.0]}},
            "line_types": {
                "chain": {"ea": 1.0e8, "mass": 100.0, "diameter": 0.1, "breaking_load": 2.0e6},
                "rope": {"ea": 1.0e8, "mass": 10.0, "diameter": 0.1, "breaking_load": 9.0e6}
            },
            "lines": [{
                "name": "bow", "fairlead": [0.0, 0.0, 0.0], "anchor": [40.0, 0.0, -60.0],
                "sections": [{"type": "rope", "length": 50.0}, {"type": "chain", "length": 30.0}]
            }]
        }))
        .expect("a scene of this test")
    }

    #[test]
    fn statistics_are_those_of_the_rows() {
        let statistics = Statistics::of([(0.0, 2.0), (1.0, 4.0), (2.0, -6.0), (3.0, 4.0)].into_iter()).expect("rows");
        assert_eq!((statistics.initial, statistics.mean), (2.0, 1.0));
        assert_eq!((statistics.max, statistics.max_time), (4.0, 1.0));
        assert_eq!((statistics.min, statistics.min_time), (-6.0, 2.0));
        assert!((statistics.std - 17.0_f64.sqrt()).abs() < 1.0e-12);
        assert!(Statistics::of(std::iter::empty()).is_none());
    }

    #[test]
    fn a_breaking_load_warns_once_with_the_largest_tension_of_its_own_section() {
        let mut record = Record::new(&scene(), "bow.json", vec!["a warning of the scene".to_string()], 1.0);
        for (time, tension) in [(0.0, 1.5e6), (1.0, 2.2e6), (2.0, 3.0e6), (3.0, 2.5e6)] {
            record.add_row(time, &[outputs(time, tension)], &[vec![node(0.0, 8.9e6), node(50.0, tension), node(80.0, 1.0e6)]]);
        }
        let warnings = record.warnings();
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        for words in
            ["line \"bow\"", "sections[1] \"chain\"", "3000.0 kN at t = 2 s", "s = 50.0000 m", "2000.0 kN", "first at t = 1 s"]
        {
            assert!(warnings[1].contains(words), "{words} is missing: {}", warnings[1]);
        }
    }

    #[test]
    fn touchdown_needs_an_anchor_on_the_bed() {
        let mut scene = scene();
        assert_eq!(bed_height(&scene, 40.0, 7.0).round(), -60.0);
        assert_eq!(touchdown(&scene, 0, 20.0), Some(60.0));
        assert_eq!(touchdown(&scene, 0, 0.0), None);
        scene.lines[0].anchor[2] = -50.0;
        assert_eq!(touchdown(&scene, 0, 20.0), None);
    }
}
