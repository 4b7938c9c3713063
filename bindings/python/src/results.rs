//! A run, and its record as arrays.

use crate::failure::raised;
use crate::source::Source;
use moorline::error::Error;
use moorline::report::course::{Course, Follower, Row, Wanted};
use moorline::report::record::{LineRecord, Record};
use moorline::report::schedule::Schedule;
use moorline::report::{tables, vtk};
use moorline::solve::loads::BodyOutputs;
use moorline::solve::simulation::{NodeOutput, Outputs};
use nalgebra::Vector3;
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How often the interpreter is asked for Ctrl-C, and the progress told.
const LOOK: Duration = Duration::from_millis(50);

/// The name of an array, and what of a row stands in it.
type Column<Row, Value> = (&'static str, fn(&Row) -> Value);

/// What the interpreter has to say to a run.
struct Attended<'a> {
    progress: Option<&'a Py<PyAny>>,
    end: f64,
    last_row: usize,
    looked: Instant,
    /// The files for ParaView, where they are wanted.
    vtk: Option<vtk::Series>,
    /// What it raised.
    raised: Option<PyErr>,
}

impl Follower for Attended<'_> {
    fn row(&mut self, _: &Record, number: usize, row: &Row) -> Result<(), Error> {
        if number > 0 && number < self.last_row && self.looked.elapsed() < LOOK {
            return Ok(());
        }
        self.looked = Instant::now();
        let told = Python::attach(|py| {
            py.check_signals()?;
            self.progress.map_or(Ok(()), |progress| progress.call1(py, (row.time, self.end)).map(|_| ()))
        });
        told.map_err(|error| {
            self.raised = Some(error);
            Error::Interrupted { time: row.time }
        })
    }

    fn snapshot(&mut self, row: &Row) -> Result<(), Error> {
        self.vtk.as_mut().map_or(Ok(()), |vtk| vtk.snapshot(row))
    }

    fn end(&mut self, _: &Record, _: &Row) -> Result<(), Error> {
        Ok(())
    }
}

/// Runs a scene; its arrays, and the failure that ended it early if one did. `vtk`: the directory of files for ParaView.
#[pyfunction]
pub fn run<'py>(
    py: Python<'py>,
    source: &Source,
    progress: Option<Py<PyAny>>,
    vtk: Option<PathBuf>,
) -> PyResult<(Bound<'py, PyDict>, Option<Py<PyAny>>)> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    let schedule = Schedule::new(&loaded.scene.run);
    let mut record = Record::new(&loaded.scene, &loaded.file, loaded.warnings.clone(), schedule.snapshot_step());
    let pictures = vtk.map(|directory| vtk::Series::create(&directory, &loaded.scene)).transpose();
    let mut attended = Attended {
        progress: progress.as_ref(),
        end: loaded.scene.run.end(),
        last_row: schedule.rows() - 1,
        looked: Instant::now(),
        vtk: pictures.map_err(|error| raised(py, &error))?,
        raised: None,
    };
    let outcome = py.detach(|| {
        let started = Instant::now();
        let mut course = Course::new(&loaded)?;
        record.statics_seconds = started.elapsed().as_secs_f64();
        let wanted = Wanted { schedule: &schedule, text: false, walls: false, states: false, places: &[], stop: &|| false };
        course.run(&wanted, &mut record, &mut attended)
    });
    if let Some(error) = attended.raised {
        return Err(error);
    }
    record.ended_by = outcome.as_ref().err().cloned();
    let arrays = arrays(py, &record)?;
    Ok((arrays, outcome.err().map(|error| raised(py, &error).into_value(py).into_any())))
}

/// Numbers as an array of a shape.
pub fn shaped<'py>(py: Python<'py>, values: Vec<f64>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    values.into_pyarray(py).reshape(shape.to_vec())
}

fn arrays<'py>(py: Python<'py>, record: &Record) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("time", record.times.clone().into_pyarray(py))?;
    all.set_item("snapshot_time", record.snapshot_times.clone().into_pyarray(py))?;
    let lines = PyDict::new(py);
    for line in &record.lines {
        lines.set_item(&line.name, of_line(py, line)?)?;
    }
    all.set_item("lines", lines)?;
    let bodies = PyDict::new(py);
    for body in &record.bodies {
        let of = PyDict::new(py);
        let parts: [Column<BodyOutputs, Vector3<f64>>; 4] = [
            ("position", |row| row.pose.position),
            ("attitude", |row| row.pose.angles),
            ("force", |row| row.force),
            ("moment", |row| row.moment),
        ];
        for (name, part) in parts {
            of.set_item(name, vectors(py, body.rows.iter().map(part), &[body.rows.len(), 3])?)?;
        }
        bodies.set_item(&body.name, of)?;
    }
    all.set_item("bodies", bodies)?;
    let points = PyDict::new(py);
    for point in &record.points {
        points.set_item(&point.name, vectors(py, point.rows.iter().copied(), &[point.rows.len(), 3])?)?;
    }
    all.set_item("points", points)?;
    all.set_item("summary", tables::summary(record))?;
    Ok(all)
}

fn vectors<'py>(
    py: Python<'py>,
    rows: impl Iterator<Item = Vector3<f64>>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    shaped(py, rows.flat_map(<[f64; 3]>::from).collect(), shape)
}

fn of_line<'py>(py: Python<'py>, line: &LineRecord) -> PyResult<Bound<'py, PyDict>> {
    let of = PyDict::new(py);
    let rows = &line.rows;
    let numbers: [Column<Outputs, f64>; 6] = [
        ("tension", |row| row.tension),
        ("anchor_tension", |row| row.anchor_tension),
        ("tension_max", |row| row.tension_max),
        ("declination", |row| row.declination),
        ("azimuth", |row| row.azimuth),
        ("grounded_length", |row| row.grounded_length),
    ];
    for (name, number) in numbers {
        of.set_item(name, rows.iter().map(number).collect::<Vec<_>>().into_pyarray(py))?;
    }
    let triples: [Column<Outputs, Vector3<f64>>; 6] = [
        ("fairlead", |row| row.fairlead),
        ("force", |row| row.force),
        ("moment", |row| row.moment),
        ("anchor", |row| row.anchor),
        ("anchor_force", |row| row.anchor_force),
        ("anchor_moment", |row| row.anchor_moment),
    ];
    for (name, triple) in triples {
        of.set_item(name, vectors(py, rows.iter().map(triple), &[rows.len(), 3])?)?;
    }
    // The mesh of a line stays the same.
    let (shots, nodes) = (line.snapshots.len(), line.snapshots.first().map_or(0, Vec::len));
    let all = || line.snapshots.iter().flatten();
    of.set_item("s", line.snapshots.iter().take(1).flatten().map(|node| node.s).collect::<Vec<_>>().into_pyarray(py))?;
    let places: [Column<NodeOutput, Vector3<f64>>; 2] =
        [("node_position", |node| node.position), ("node_tangent", |node| node.tangent)];
    for (name, place) in places {
        of.set_item(name, vectors(py, all().map(place), &[shots, nodes, 3])?)?;
    }
    of.set_item("node_tension", shaped(py, all().map(|node| node.tension).collect(), &[shots, nodes])?)?;
    Ok(of)
}
