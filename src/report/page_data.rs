//! The numbers behind the page's plots, small enough to travel in it: integers of a quantum that no eye can tell from the value,
//! and of a long run only as many rows and snapshots as a screen can show.

use crate::report::record::{LineRecord, PointRecord, Record, Statistics, touchdown};
use crate::report::statistics_page;
use crate::report::units::ForceUnit;
use crate::scene::bodies::Mount;
use crate::solve::loads::BodyOutputs;
use crate::solve::simulation::{NodeOutput, Outputs};
use nalgebra::Vector3;
use serde::Serialize;

/// Most rows a page holds times the number of lines.
const ROWS: usize = 24_000;
/// Most nodes a page holds, over all lines and snapshots.
const NODES: usize = 45_000;
/// Quanta across the largest value of a kind: six digits for curves one can zoom into, five for shapes.
const CURVE_QUANTA: f64 = 1.0e6;
const SHAPE_QUANTA: f64 = 1.0e5;
/// Quanta across the components of a unit tangent.
const TANGENT_QUANTA: f64 = 1.0e4;

/// The data as JSON text.
pub struct PageData {
    /// The text; `<` in it is not escaped.
    pub text: String,
    /// How many rows it holds.
    pub rows: usize,
}

#[derive(Serialize)]
struct Data<'a> {
    unit: Unit,
    length_decimals: usize,
    length_quantum: f64,
    force_quantum: f64,
    tangent_quantum: f64,
    bed: Bed,
    time_decimals: usize,
    time: Vec<f64>,
    snapshot_times: Vec<f64>,
    lines: Vec<Line<'a>>,
    bodies: Vec<Body<'a>>,
    points: Vec<Point<'a>>,
    random: Vec<statistics_page::End>,
}

/// A body: its pose over time, the loads of the lines on it, and edges that show it, in its own axes.
#[derive(Serialize)]
struct Body<'a> {
    name: &'a str,
    /// x, y, z, roll, pitch, yaw.
    pose: Vec<Column>,
    /// Three of force, three of moment.
    loads: Vec<Column>,
    edges: Vec<[[f64; 3]; 2]>,
}

/// A free point: x, y, z over time.
#[derive(Serialize)]
struct Point<'a> {
    name: &'a str,
    place: Vec<Column>,
}

#[derive(Serialize)]
struct Unit {
    symbol: &'static str,
    newtons: f64,
    decimals: usize,
}

#[derive(Serialize)]
struct Bed {
    depth: f64,
    /// Rise per metre along x and y.
    slope: [f64; 2],
}

#[derive(Serialize)]
struct Line<'a> {
    name: &'a str,
    length: f64,
    fairlead: [f64; 3],
    anchor: [f64; 3],
    /// Of the tension at the fairlead.
    extremes: Option<Statistics>,
    rows: Rows,
    s: Vec<f64>,
    still: Shape,
    shapes: Vec<Shape>,
    touchdown: Vec<Option<f64>>,
}

#[derive(Serialize)]
struct Rows {
    tension: Column,
    anchor: Column,
    grounded: Column,
    x: Column,
    y: Column,
    z: Column,
}

/// Values as integers of a quantum; `null` for what is no number.
#[derive(Serialize)]
struct Column {
    q: f64,
    v: Vec<Option<i64>>,
}

/// A state: positions x0, y0, z0, x1, … in quanta of length, unit tangents likewise, tensions in quanta of force. Elements are long
/// and curved; without tangents they would be drawn with corners.
#[derive(Serialize)]
struct Shape {
    p: Vec<i64>,
    d: Vec<i64>,
    t: Vec<i64>,
}

/// The data of a run; forces will be shown in `unit`.
pub fn json(record: &Record, unit: ForceUnit) -> PageData {
    let rows = rows_to_show(record);
    let snapshots = snapshots_to_show(record);
    let slope = record.scene.environment.seabed.slope_deg.map(|angle| angle.to_radians().tan());
    let extent = extent(record);
    let quanta = Quanta {
        length: quantum(extent, SHAPE_QUANTA),
        force: quantum(largest(all_nodes(record).map(|node| node.tension)), SHAPE_QUANTA),
    };
    let data = Data {
        unit: Unit { symbol: unit.symbol, newtons: unit.newtons, decimals: unit.decimals },
        length_decimals: if extent < 10.0 { 4 } else { 2 },
        length_quantum: quanta.length,
        force_quantum: quanta.force,
        tangent_quantum: 1.0 / TANGENT_QUANTA,
        bed: Bed { depth: record.scene.environment.depth, slope },
        time_decimals: decimals(record.scene.run.output_step),
        time: rows.iter().map(|row| rounded(record.times[*row])).collect(),
        snapshot_times: snapshots.iter().map(|snapshot| rounded(record.snapshot_times[*snapshot])).collect(),
        lines: (0..record.lines.len()).map(|index| line(record, index, &rows, &snapshots, &quanta)).collect(),
        bodies: (0..record.bodies.len()).map(|index| body(record, index, &rows)).collect(),
        points: record.points.iter().map(|of| point(of, &rows)).collect(),
        random: statistics_page::data(record),
    };
    // Numbers and strings only: there is nothing in them that JSON cannot hold.
    PageData { text: serde_json::to_string(&data).unwrap_or_default(), rows: rows.len() }
}

struct Quanta {
    length: f64,
    force: f64,
}

fn line<'a>(record: &'a Record, index: usize, rows: &[usize], snapshots: &[usize], quanta: &Quanta) -> Line<'a> {
    let line = &record.lines[index];
    let column = |output: fn(&Outputs) -> f64| column(rows.iter().map(|row| output(&line.rows[*row])).collect());
    Line {
        name: &line.name,
        length: line.length,
        fairlead: record.scene.lines[index].fairlead,
        anchor: record.scene.lines[index].anchor,
        extremes: line.statistics(|row| row.tension),
        rows: Rows {
            tension: column(|row| row.tension),
            anchor: column(|row| row.anchor_tension),
            grounded: column(|row| row.grounded_length),
            x: column(|row| row.fairlead.x),
            y: column(|row| row.fairlead.y),
            z: column(|row| row.fairlead.z),
        },
        s: line.equilibrium.iter().map(|node| rounded(node.s)).collect(),
        still: shape(&line.equilibrium, quanta),
        shapes: snapshots.iter().map(|snapshot| shape(&line.snapshots[*snapshot], quanta)).collect(),
        touchdown: touchdowns(record, index, snapshots),
    }
}

fn body<'a>(record: &'a Record, index: usize, rows: &[usize]) -> Body<'a> {
    let of = &record.bodies[index];
    let column =
        |value: &dyn Fn(&BodyOutputs) -> f64| column(rows.iter().filter_map(|row| of.rows.get(*row)).map(value).collect());
    let three = |value: fn(&BodyOutputs) -> &Vector3<f64>| (0..3).map(move |axis| (value, axis));
    let columns = |values: [fn(&BodyOutputs) -> &Vector3<f64>; 2]| -> Vec<Column> {
        values.into_iter().flat_map(three).map(|(value, axis)| column(&move |row| value(row)[axis])).collect()
    };
    Body {
        name: &of.name,
        pose: columns([|row| &row.pose.position, |row| &row.pose.angles]),
        loads: columns([|row| &row.force, |row| &row.moment]),
        edges: edges(record, index),
    }
}

fn point<'a>(of: &'a PointRecord, rows: &[usize]) -> Point<'a> {
    let place = |axis: usize| column(rows.iter().filter_map(|row| of.rows.get(*row)).map(|place| place[axis]).collect());
    Point { name: &of.name, place: (0..3).map(place).collect() }
}

/// Sides of a circle that is drawn.
const SIDES: usize = 12;

/// What is drawn of a body: its cylinders, or else the places that lines hang on, joined around and with the reference point.
fn edges(record: &Record, index: usize) -> Vec<[[f64; 3]; 2]> {
    let body = &record.scene.bodies[index];
    let mut edges = Vec::new();
    for cylinder in &body.cylinders {
        let (from, to) = (Vector3::from(cylinder.from), Vector3::from(cylinder.to));
        let axis = (to - from).normalize();
        let aside = if axis.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
        let first = axis.cross(&aside).normalize();
        let second = axis.cross(&first);
        let rim = |end: &Vector3<f64>, k: usize| -> [f64; 3] {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / SIDES as f64).sin_cos();
            (end + (first * cos + second * sin) * (0.5 * cylinder.diameter)).into()
        };
        for k in 0..SIDES {
            edges.push([rim(&from, k), rim(&from, k + 1)]);
            edges.push([rim(&to, k), rim(&to, k + 1)]);
            if k % 3 == 0 {
                edges.push([rim(&from, k), rim(&to, k)]);
            }
        }
    }
    let on = |mount: &Option<Mount>| match mount {
        Some(Mount::Body { body: name, at, .. }) if *name == body.name => Some(*at),
        _ => None,
    };
    let mut places: Vec<[f64; 3]> =
        record.scene.lines.iter().flat_map(|line| [on(&line.fairlead_on), on(&line.anchor_on)]).flatten().collect();
    places.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    places.dedup();
    if edges.is_empty() {
        for (number, place) in places.iter().enumerate() {
            edges.push([[0.0; 3], *place]);
            edges.push([*place, places[(number + 1) % places.len()]]);
        }
    }
    edges
}

/// Arc lengths of the touchdown at the snapshots, from the rows of the same times.
fn touchdowns(record: &Record, index: usize, snapshots: &[usize]) -> Vec<Option<f64>> {
    let at = |snapshot: &usize| {
        let row = record.times.partition_point(|time| *time < record.snapshot_times[*snapshot]);
        let outputs = record.lines[index].rows.get(row)?;
        touchdown(&record.scene, index, outputs.grounded_length).map(rounded)
    };
    snapshots.iter().map(at).collect()
}

fn shape(nodes: &[NodeOutput], quanta: &Quanta) -> Shape {
    let length = |value: f64| (value / quanta.length).round() as i64;
    let tangent = |value: f64| (value * TANGENT_QUANTA).round() as i64;
    Shape {
        p: nodes.iter().flat_map(|node| [node.position.x, node.position.y, node.position.z].map(length)).collect(),
        d: nodes.iter().flat_map(|node| [node.tangent.x, node.tangent.y, node.tangent.z].map(tangent)).collect(),
        t: nodes.iter().map(|node| (node.tension / quanta.force).round() as i64).collect(),
    }
}

fn column(values: Vec<f64>) -> Column {
    let q = quantum(largest(values.iter().copied()), CURVE_QUANTA);
    Column { q, v: values.iter().map(|value| value.is_finite().then(|| (value / q).round() as i64)).collect() }
}

/// The power of ten of which the largest value is `quanta` to ten times `quanta`.
fn quantum(largest: f64, quanta: f64) -> f64 {
    if largest > 0.0 { 10.0_f64.powi((largest / quanta).log10().floor() as i32) } else { 1.0 }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).filter(|value| value.is_finite()).fold(0.0, f64::max)
}

fn all_nodes(record: &Record) -> impl Iterator<Item = &NodeOutput> {
    record.lines.iter().flat_map(|line| line.snapshots.iter().flatten().chain(&line.equilibrium))
}

/// Largest coordinate of any node [m].
fn extent(record: &Record) -> f64 {
    largest(all_nodes(record).flat_map(|node| [node.position.x, node.position.y, node.position.z]))
}

/// To a microsecond or micrometre, so that no digits are spent on rounding errors.
fn rounded(value: f64) -> f64 {
    (value * 1.0e6).round() / 1.0e6
}

/// Decimals that tell neighbouring output times apart, one to four.
fn decimals(output_step: f64) -> usize {
    (-output_step.log10().floor()).clamp(1.0, 4.0) as usize
}

/// All rows of a short run. Of a long one, of each stretch of rows those in which a line's tension is largest or smallest at either
/// end, so that every peak stays.
fn rows_to_show(record: &Record) -> Vec<usize> {
    let rows = record.times.len();
    let allowed = ROWS / record.lines.len().max(1);
    if rows <= allowed {
        return (0..rows).collect();
    }
    let kept_per_stretch = 4 * record.lines.len();
    let stretch = (rows * kept_per_stretch).div_ceil(allowed).max(kept_per_stretch + 1);
    let mut kept = vec![0, rows - 1];
    for from in (0..rows).step_by(stretch) {
        let here = from..(from + stretch).min(rows);
        kept.extend(record.lines.iter().flat_map(|line| extremes(line, here.clone())));
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

/// The rows of a stretch with the extremes of a line's end tensions.
fn extremes(line: &LineRecord, rows: std::ops::Range<usize>) -> Vec<usize> {
    let outputs: [fn(&Outputs) -> f64; 2] = [|row| row.tension, |row| row.anchor_tension];
    let found = outputs.iter().flat_map(|output| {
        let compare = |a: &usize, b: &usize| output(&line.rows[*a]).total_cmp(&output(&line.rows[*b]));
        [rows.clone().min_by(compare), rows.clone().max_by(compare)]
    });
    found.flatten().collect()
}

/// All snapshots, or of many nodes every so many of them, and the last.
fn snapshots_to_show(record: &Record) -> Vec<usize> {
    let snapshots = record.snapshot_times.len();
    let nodes: usize = record.lines.iter().map(|line| line.equilibrium.len()).sum();
    let every = (snapshots * nodes).div_ceil(NODES).max(1);
    let mut shown: Vec<usize> = (0..snapshots).step_by(every).collect();
    if snapshots > 0 && shown.last() != Some(&(snapshots - 1)) {
        shown.push(snapshots - 1);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;
    use crate::scene::types::Scene;

    fn record(rows: usize) -> Record {
        let scene: Scene = serde_json::from_str(include_str!("../../examples/lindahl-sjoberg.json")).expect("the built-in scene");
        let mut record = Record::new(&scene, "scene.json", Vec::new(), 0.4);
        let nodes = vec![(0..41).map(|k| sample::node(30.0 * k as f64, 1.0e6 + k as f64)).collect::<Vec<_>>()];
        record.lines[0].equilibrium = nodes[0].clone();
        for row in 0..rows {
            let time = 0.1 * row as f64;
            let tension = if row == rows / 3 { 9.87e6 } else { 1.0e6 + (row % 150) as f64 };
            let outputs = Outputs { grounded_length: 689.0, ..sample::outputs(time, tension) };
            record.add_row(time, &[outputs], &nodes);
            if row % rows.div_ceil(300) == 0 {
                record.add_snapshot(time, &nodes);
            }
        }
        record
    }

    #[test]
    fn values_come_back_to_six_digits() {
        let column = column(vec![1_329_610.052, -7.0, f64::NAN]);
        assert!((column.v[0].expect("a number") as f64 * column.q - 1_329_610.052).abs() < 0.5);
        assert_eq!(column.v[2], None);
    }

    #[test]
    fn a_storm_of_three_hours_keeps_its_peak_and_stays_small() {
        let record = record(108_001);
        let data = json(&record, record.force_unit());
        assert!(data.rows < ROWS && data.rows > ROWS / 4, "{} rows", data.rows);
        assert!(data.text.contains("9870000"), "the peak");
        assert!(data.text.len() < 3_000_000, "{} bytes", data.text.len());
    }

    /// With statistics, too: three hours of a random sea in rows 0.1 s apart.
    #[test]
    fn the_statistics_of_a_storm_stay_small() {
        let mut storm = record(108_001);
        storm.scene.environment.waves =
            serde_json::from_str(r#"{"kind": "jonswap", "hs": 5.0, "tp": 10.0}"#).expect("waves of this test");
        let waves = |row: usize| 2.0e5 * (0.06 * row as f64).sin() * (1.0 + 0.5 * (0.0071 * row as f64).sin());
        storm.lines[0].rows.iter_mut().enumerate().for_each(|(number, row)| row.tension += waves(number));
        let data = json(&storm, storm.force_unit());
        let value: serde_json::Value = serde_json::from_str(&data.text).expect("JSON");
        let of = &value["random"][0];
        let length = |key: &str| of[key].as_array().expect("a list").len();
        assert!((1..=301).contains(&length("density")) && (1..=400).contains(&length("maxima")), "{of}");
        assert_eq!(length("maxima"), length("exceedance"));
        let event = of["event"][1].as_array().expect("tensions");
        assert!(event.len() <= 301 && event.iter().any(|value| value.as_f64() > Some(9.5e6)), "the worst event: {event:?}");
        assert!(data.text.len() < 3_100_000, "{} bytes", data.text.len());
    }

    #[test]
    fn a_short_run_is_shown_whole() {
        let record = record(1201);
        let data = json(&record, record.force_unit());
        assert_eq!(data.rows, 1201);
        let value: serde_json::Value = serde_json::from_str(&data.text).expect("JSON");
        assert_eq!(value["snapshot_times"].as_array().expect("times").len(), record.snapshot_times.len());
        assert_eq!(value["lines"][0]["touchdown"][0], 511.0);
    }
}
