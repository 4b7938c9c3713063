//! Python's way to moorline: scenes in, NumPy arrays out. What a user calls stands in `python/moorline`; here is what it is made of.
//!
//! Whoever computes lets go of the interpreter meanwhile. Every failure of moorline becomes a `moorline.Error` with its place.

mod failure;
mod mooring;
mod results;
mod source;

use failure::raised;
use moorline::cli::{dispatch, fit as fitting, offsets as aside, statics as rest};
use moorline::fmi::pack::{self as packing, Libraries, Naming};
use moorline::scene::read;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use source::Source;
use std::ffi::OsString;
use std::path::PathBuf;

/// The scene as it is understood, with its defaults, as JSON; and the warnings.
#[pyfunction]
fn check(py: Python<'_>, source: &Source) -> PyResult<(String, Vec<String>)> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    Ok((serde_json::to_string(&loaded.scene).unwrap_or_default(), loaded.warnings))
}

/// The equilibrium as the JSON of `moorline statics --json`, the warnings, and the failure if it is none.
#[pyfunction]
fn statics(py: Python<'_>, source: &Source) -> PyResult<(String, Vec<String>, Option<Py<PyAny>>)> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    let (equilibrium, failure) = py.detach(|| rest::solve(&loaded)).map_err(|error| raised(py, &error))?;
    let failure = failure.map(|error| raised(py, &error).into_value(py).into_any());
    Ok((serde_json::to_string(&equilibrium).unwrap_or_default(), loaded.warnings, failure))
}

/// Loads of the lines on a body at offsets from its equilibrium, as arrays; and why some are not reached.
#[pyfunction]
fn offsets<'py>(
    py: Python<'py>,
    source: &Source,
    body: &str,
    way: &str,
    values: Vec<f64>,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    let bodies: Vec<String> = loaded.scene.bodies.iter().map(|body| body.name.clone()).collect();
    let unknown = |place: &str, value: &str, known: &[String]| {
        let allowed = format!("there is nothing of that name{}", moorline::error::among(value, known));
        let (file, place, value) = (loaded.file.clone(), place.to_owned(), format!("\"{value}\""));
        raised(py, &moorline::error::Error::Value { file, place, value, allowed })
    };
    let number = loaded.scene.body(body).ok_or_else(|| unknown("body", body, &bodies))?;
    let ways = aside::WAYS.map(String::from);
    let axis = ways.iter().position(|known| known == way).ok_or_else(|| unknown("way", way, &ways))?;
    let range = aside::Range { body: number, way: axis, offsets: values };
    let (curve, lost) = py.detach(|| aside::curve(&loaded, &range)).map_err(|error| raised(py, &error))?;
    let rows = &curve.rows;
    let of = PyDict::new(py);
    of.set_item("offset", rows.iter().map(|row| row.0).collect::<Vec<_>>().into_pyarray(py))?;
    for (part, name) in ["force", "moment"].into_iter().enumerate() {
        let values = rows.iter().flat_map(|row| <[f64; 3]>::from(row.1[part])).collect();
        of.set_item(name, results::shaped(py, values, &[rows.len(), 3])?)?;
    }
    let tension = rows.iter().flat_map(|row| row.2.iter().copied()).collect();
    of.set_item("tension", results::shaped(py, tension, &[rows.len(), curve.lines.len()])?)?;
    of.set_item("lines", curve.lines)?;
    Ok((of, lost))
}

/// The scene that has a wanted static result as JSON, the value, what it was, the result reached, and a warning where others would do.
#[pyfunction]
fn fit(
    py: Python<'_>,
    source: &Source,
    change: &str,
    until: &str,
    range: Option<&str>,
) -> PyResult<(String, f64, f64, f64, Option<String>)> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    let found = py.detach(|| fitting::find(&loaded, change, until, range)).map_err(|error| raised(py, &error))?;
    let scene = serde_json::to_string(&found.scene).unwrap_or_default();
    Ok((scene, found.value, found.before, found.reached, found.warning))
}

/// Writes the FMU of a scene; the path of its OSP description beside it.
#[pyfunction]
fn pack(py: Python<'_>, source: &Source, name: &str, flat: bool, out: PathBuf) -> PyResult<PathBuf> {
    let loaded = source.load().map_err(|error| raised(py, &error))?;
    let naming = if flat { Naming::Flat } else { Naming::Structured };
    let packed = py.detach(|| packing::pack(&loaded.scene, name, naming, &Libraries::beside_program(), &out));
    packed.map_err(|error| raised(py, &error))
}

/// The JSON Schema of a scene.
#[pyfunction]
fn schema() -> String {
    read::schema().to_string()
}

/// The command `moorline` with its arguments, the first of them its name; its exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| dispatch::answer(arguments.into_iter()))
}

#[pymodule]
fn _moorline(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Source>()?;
    module.add_class::<mooring::Core>()?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(statics, module)?)?;
    module.add_function(wrap_pyfunction!(results::run, module)?)?;
    module.add_function(wrap_pyfunction!(offsets, module)?)?;
    module.add_function(wrap_pyfunction!(fit, module)?)?;
    module.add_function(wrap_pyfunction!(pack, module)?)?;
    module.add_function(wrap_pyfunction!(schema, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)
}
