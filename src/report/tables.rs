//! The tables a run leaves behind: `timeseries.csv` and `nodes.csv`, written as the run goes, and `summary.json`.

use crate::error::Error;
use crate::report::record::{LineRecord, Record, Statistics};
use crate::report::statistics::{self, Figures, SectionDamage};
use crate::scene::types::Scheme;
use crate::solve::loads::BodyOutputs;
use crate::solve::simulation::{NodeOutput, Outputs};
use nalgebra::Vector3;
use serde::Serialize;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Columns of a line in `timeseries.csv`, after `time`.
const COLUMNS: [&str; 9] =
    ["fairlead_x", "fairlead_y", "fairlead_z", "tension", "force_x", "force_y", "force_z", "anchor_tension", "grounded_length"];

/// Columns of a body: position of its reference point [m], roll, pitch and yaw [rad], force [N] and moment [N·m] of the lines on it.
const BODY_COLUMNS: [&str; 12] =
    ["x", "y", "z", "roll", "pitch", "yaw", "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"];

/// Creates a file, or overwrites it; says which one where that fails.
pub fn create(path: &Path) -> Result<File, Error> {
    File::create(path).map_err(|error| unwritable(path, &error))
}

/// Writes a whole file; says which one where that fails.
pub fn write(path: &Path, text: &str) -> Result<(), Error> {
    std::fs::write(path, text).map_err(|error| unwritable(path, &error))
}

/// The error of a file that cannot be written.
pub fn unwritable(path: &Path, error: &impl std::fmt::Display) -> Error {
    Error::File { path: path.display().to_string(), reason: format!("cannot be written: {error}") }
}

/// A table on its way to a file. What is put goes out at once and whole, so that a run that is stopped leaves complete rows.
struct Table<W: Write> {
    to: W,
    path: PathBuf,
}

impl<W: Write> Table<W> {
    fn put(&mut self, text: &[u8]) -> Result<(), Error> {
        self.to.write_all(text).and_then(|()| self.to.flush()).map_err(|error| unwritable(&self.path, &error))
    }
}

/// The text of rows of cells, which are quoted where they must be.
fn text<T: AsRef<[u8]>, R: IntoIterator<Item = T>>(rows: impl Iterator<Item = R>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for cells in rows {
        // Rows of one length, in memory: this does not fail.
        let _ = writer.write_record(cells);
    }
    writer.into_inner().unwrap_or_default()
}

/// The shortest decimal number that reads back as the same float.
fn number(value: f64) -> String {
    format!("{:?}", value + 0.0)
}

/// `timeseries.csv`: one row per output time, each line's columns side by side.
pub struct TimeSeries<W: Write> {
    table: Table<W>,
}

impl<W: Write> TimeSeries<W> {
    /// Writes the header. The columns of several lines are prefixed `NAME.`, and so are those of bodies and free points; `path` is for messages.
    pub fn new(to: W, path: &Path, lines: &[&str], bodies: &[&str], points: &[&str]) -> Result<TimeSeries<W>, Error> {
        let mut table = Table { to, path: path.to_path_buf() };
        let prefix = |line: &str| if lines.len() == 1 { String::new() } else { format!("{line}.") };
        let columns = lines.iter().flat_map(|line| COLUMNS.map(|column| prefix(line) + column));
        let of_bodies = bodies.iter().flat_map(|body| BODY_COLUMNS.map(|column| format!("{body}.{column}")));
        let of_points = points.iter().flat_map(|point| ["x", "y", "z"].map(|column| format!("{point}.{column}")));
        let columns = columns.chain(of_bodies).chain(of_points);
        table.put(&text(std::iter::once(std::iter::once("time".to_string()).chain(columns))))?;
        Ok(TimeSeries { table })
    }

    /// Writes the row of a time [s]: the `cells` of every line.
    pub fn row(&mut self, time: f64, lines: &[String]) -> Result<(), Error> {
        let mut row = number(time);
        lines.iter().for_each(|cells| row.extend([",", cells]));
        row.push('\n');
        self.table.put(row.as_bytes())
    }
}

/// The cells of a line in a row of `timeseries.csv`.
pub fn cells(line: &Outputs) -> String {
    let numbers = [
        line.fairlead.x,
        line.fairlead.y,
        line.fairlead.z,
        line.tension,
        line.force.x,
        line.force.y,
        line.force.z,
        line.anchor_tension,
        line.grounded_length,
    ];
    numbers.map(number).join(",")
}

/// The cells of a body in a row of `timeseries.csv`.
pub fn body_cells(body: &BodyOutputs) -> String {
    let numbers = [body.pose.position, body.pose.angles, body.force, body.moment];
    numbers.iter().flatten().map(|x| number(*x)).collect::<Vec<_>>().join(",")
}

/// The cells of a free point.
pub fn point_cells(place: &Vector3<f64>) -> String {
    place.iter().map(|x| number(*x)).collect::<Vec<_>>().join(",")
}

/// `nodes.csv`: the nodes of all lines at the snapshots, nodes counted from 0 at the fairlead.
pub struct Nodes<W: Write> {
    table: Table<W>,
}

impl<W: Write> Nodes<W> {
    /// Writes the header; `path` is for messages; `walls`: with a column for the tension of the wall.
    pub fn new(to: W, path: &Path, walls: bool) -> Result<Nodes<W>, Error> {
        let mut table = Table { to, path: path.to_path_buf() };
        let wall = walls.then_some("wall_tension");
        table.put(&text(std::iter::once(["time", "line", "node", "s", "x", "y", "z", "tension"].into_iter().chain(wall))))?;
        Ok(Nodes { table })
    }

    /// Writes a snapshot: the `node_rows` of every line.
    pub fn snapshot(&mut self, lines: &[Vec<u8>]) -> Result<(), Error> {
        self.table.put(&lines.concat())
    }
}

/// The rows of a line's nodes in `nodes.csv` at a time [s]; `walls` as in the header.
pub fn node_rows(time: f64, line: &str, nodes: &[NodeOutput], walls: bool) -> Vec<u8> {
    let time = number(time);
    text(nodes.iter().enumerate().map(|(index, node)| {
        let [s, x, y, z] = [node.s, node.position.x, node.position.y, node.position.z].map(number);
        let wall = walls.then(|| node.wall_tension.map_or(String::new(), number));
        [time.clone(), line.to_string(), index.to_string(), s, x, y, z, number(node.tension)].into_iter().chain(wall)
    }))
}

/// `summary.json`. Counters at the top are the sums over all lines; what belongs to one line stands under `lines`, in the order of
/// the scene. The tension at the top is there for a scene of one line only; of several, none is *the* tension.
#[derive(Serialize)]
struct Summary<'a> {
    program: &'static str,
    title: &'a str,
    scene: &'a str,
    /// Whether the run reached its duration.
    completed: bool,
    /// Why not.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    scheme: Scheme,
    tolerance: f64,
    duration: f64,
    /// Time of the last row [s].
    end_time: Option<f64>,
    rows: usize,
    snapshots: usize,
    snapshot_step: f64,
    #[serde(flatten)]
    work: Work,
    statics_seconds: f64,
    solver_seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    tension: Option<Statistics>,
    lines: Vec<LineSummary<'a>>,
    warnings: Vec<String>,
}

/// One line of the summary.
#[derive(Serialize)]
struct LineSummary<'a> {
    name: &'a str,
    #[serde(flatten)]
    work: Work,
    statics: Option<Statics>,
    /// At the fairlead [N].
    tension: Option<Statistics>,
    /// At the anchor [N].
    anchor_tension: Option<Statistics>,
    /// Unstretched, in contact with the bed [m].
    grounded_length: Option<Statistics>,
    /// In a random sea.
    #[serde(skip_serializing_if = "Option::is_none")]
    statistics: Option<LineStatistics>,
    /// Where there are T–N curves.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fatigue: Vec<SectionDamage>,
}

/// The tensions of a line in a random sea, in a stretch of time [s].
#[derive(Serialize)]
struct LineStatistics {
    from: f64,
    to: f64,
    tension: Figures,
    anchor_tension: Figures,
}

#[derive(Serialize)]
struct Work {
    elements: usize,
    steps: usize,
    rejected_steps: usize,
    newton_iterations: usize,
    factorisations: usize,
    element_iterations: usize,
}

#[derive(Serialize)]
struct Statics {
    converged: bool,
    iterations: usize,
    /// Largest unbalanced nodal force [N].
    residual: f64,
}

/// The text of `summary.json`.
pub fn summary(record: &Record) -> String {
    let statistics = statistics::of(record);
    let of_line = |index: usize| {
        let of = statistics.as_ref()?;
        let [tension, anchor_tension] = of.lines[index].each_ref().map(|end| end.figures.clone());
        Some(LineStatistics { from: of.from, to: of.to, tension, anchor_tension })
    };
    let lines: Vec<LineSummary> =
        record.lines.iter().enumerate().map(|(index, line)| line_summary(record, line, of_line(index))).collect();
    let summary = Summary {
        program: concat!("moorline ", env!("CARGO_PKG_VERSION")),
        title: &record.scene.title,
        scene: &record.file,
        completed: record.ended_by.is_none(),
        error: record.ended_by.as_ref().map(|error| error.to_string()),
        scheme: record.scene.solver.scheme,
        tolerance: record.scene.solver.tolerance,
        duration: record.scene.run.duration,
        end_time: record.end_time(),
        rows: record.times.len(),
        snapshots: record.snapshot_times.len(),
        snapshot_step: record.snapshot_step,
        work: work(record.elements(), record.counters()),
        statics_seconds: record.statics_seconds,
        solver_seconds: record.solver_seconds,
        tension: if lines.len() == 1 { lines[0].tension } else { None },
        lines,
        warnings: record.warnings(),
    };
    // Plain structs of numbers and strings: there is nothing in them that JSON cannot hold.
    serde_json::to_string_pretty(&summary).unwrap_or_default() + "\n"
}

fn line_summary<'a>(record: &Record, line: &'a LineRecord, statistics: Option<LineStatistics>) -> LineSummary<'a> {
    let statics = |report: crate::solve::simulation::StaticsReport| Statics {
        converged: report.converged,
        iterations: report.iterations,
        residual: report.residual,
    };
    LineSummary {
        name: &line.name,
        work: work(line.elements, line.counters),
        statics: line.statics.map(statics),
        tension: line.statistics(|row| row.tension),
        anchor_tension: line.statistics(|row| row.anchor_tension),
        grounded_length: line.statistics(|row| row.grounded_length),
        statistics,
        fatigue: statistics::damage(record, line),
    }
}

/// The text of `spectra.csv`: the spectra of the tensions [N²/Hz] over the frequency [Hz]; `None` where there are none.
pub fn spectra(record: &Record) -> Option<String> {
    let statistics = statistics::of(record)?;
    let spectra: Option<Vec<_>> = statistics.lines.iter().flatten().map(|end| end.spectrum.as_ref()).collect();
    let spectra = spectra.filter(|spectra| !spectra.is_empty())?;
    let prefix = |line: &LineRecord| if record.lines.len() == 1 { String::new() } else { format!("{}.", line.name) };
    let columns = record.lines.iter().flat_map(|line| ["tension", "anchor_tension"].map(|column| prefix(line) + column));
    let header: Vec<String> = std::iter::once("frequency".to_owned()).chain(columns).collect();
    let row = |k: usize| -> Vec<String> {
        let densities = spectra.iter().map(|spectrum| number(spectrum.density[k]));
        std::iter::once(number(k as f64 * spectra[0].step)).chain(densities).collect()
    };
    let rows = (0..spectra[0].density.len()).map(row);
    String::from_utf8(text(std::iter::once(header).chain(rows))).ok()
}

/// The text of `rainflow.csv`: the cycles at both ends of every section that has a T–N curve; `None` where there are none.
pub fn cycles(record: &Record) -> Option<String> {
    let ends: Vec<_> = record.lines.iter().flat_map(|line| line.fatigue.iter().map(move |end| (line, end))).collect();
    let header = ["line", "section", "s", "range", "mean", "count"].map(str::to_owned);
    let rows = ends.iter().flat_map(|(line, end)| {
        let cycle = |of: crate::report::rainflow::Cycle| {
            let [s, range, mean, count] = [end.s, of.range, of.mean, of.count].map(number);
            [line.name.clone(), end.section.to_string(), s, range, mean, count]
        };
        end.rainflow.cycles().into_iter().map(cycle)
    });
    (!ends.is_empty()).then(|| String::from_utf8(text(std::iter::once(header).chain(rows))).ok())?
}

fn work(elements: usize, counters: crate::solve::simulation::Counters) -> Work {
    Work {
        elements,
        steps: counters.steps,
        rejected_steps: counters.rejected_steps,
        newton_iterations: counters.newton_iterations,
        factorisations: counters.factorisations,
        element_iterations: counters.element_iterations,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    fn outputs(tension: f64) -> Outputs {
        Outputs {
            fairlead: Vector3::new(1.0, -0.0, 1.0e-9),
            anchor_tension: 1.0 / 3.0,
            moment: Vector3::zeros(),
            anchor_moment: Vector3::zeros(),
            grounded_length: 689.0,
            ..sample::outputs(0.3, tension)
        }
    }

    fn written(lines: &[&str], rows: &[&[Outputs]]) -> String {
        let mut bytes = Vec::new();
        {
            let mut table = TimeSeries::new(&mut bytes, Path::new("timeseries.csv"), lines, &[], &[]).expect("header");
            rows.iter().for_each(|row| table.row(0.3, &row.iter().map(cells).collect::<Vec<_>>()).expect("row"));
        }
        String::from_utf8(bytes).expect("text")
    }

    #[test]
    fn one_line_has_bare_columns_and_every_digit() {
        let text = written(&["line"], &[&[outputs(1_329_610.052_123)]]);
        let mut lines = text.lines();
        assert_eq!(
            lines.next(),
            Some("time,fairlead_x,fairlead_y,fairlead_z,tension,force_x,force_y,force_z,anchor_tension,grounded_length")
        );
        assert_eq!(lines.next(), Some("0.3,1.0,0.0,1e-9,1329610.052123,1329610.052123,0.0,0.0,0.3333333333333333,689.0"));
    }

    #[test]
    fn several_lines_are_prefixed_and_odd_names_stay_one_cell() {
        let text = written(&["bow", "a,b"], &[&[outputs(1.0), outputs(2.0)]]);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = reader.headers().expect("header").clone();
        assert_eq!(header.len(), 19);
        assert_eq!((&header[4], &header[13]), ("bow.tension", "a,b.tension"));
        let row = reader.records().next().expect("a row").expect("a row of the same length");
        assert_eq!((&row[4], &row[13]), ("1.0", "2.0"));
    }

    #[test]
    fn every_row_is_on_its_way_before_the_next_is_begun() {
        let mut bytes = Vec::new();
        let mut table = TimeSeries::new(&mut bytes, Path::new("timeseries.csv"), &["line"], &[], &[]).expect("header");
        table.row(0.3, &[cells(&outputs(1.0))]).expect("row");
        // Forgotten, the table cannot write on its way out: what is there was there before.
        std::mem::forget(table);
        assert_eq!(bytes.iter().filter(|byte| **byte == b'\n').count(), 2);
    }
}
