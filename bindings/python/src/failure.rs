//! Failures of moorline as exceptions of Python, with place and value.

use moorline::error::Error;
use pyo3::prelude::*;

/// An exception of `moorline._errors` with a message.
pub fn exception(py: Python<'_>, class: &str, message: &str) -> PyResult<Py<PyAny>> {
    Ok(py.import("moorline._errors")?.getattr(class)?.call1((message,))?.unbind())
}

/// A refusal in words alone.
pub fn refused(py: Python<'_>, message: &str) -> PyErr {
    match exception(py, "InputError", message) {
        Ok(value) => PyErr::from_value(value.into_bound(py)),
        Err(error) => error,
    }
}

/// The exception of a failure.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    made(py, error).unwrap_or_else(|other| other)
}

fn made(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let class = if error.exit_code() == 2 { "InputError" } else { "ConvergenceError" };
    let exception = exception(py, class, &error.to_string())?.into_bound(py);
    let (file, place, value) = match error {
        Error::File { path, .. } => (Some(path), None, None),
        Error::Json { file, place, .. } => (Some(file), Some(place), None),
        Error::Deck { file, item, .. } => (Some(file), Some(item), None),
        Error::Set { file, setting, .. } => (Some(file), Some(setting), None),
        Error::Value { file, place, value, .. } => (Some(file), Some(place), Some(value)),
        _ => (None, None, None),
    };
    exception.setattr("file", file)?;
    exception.setattr("place", place.filter(|place| !place.is_empty()))?;
    exception.setattr("value", value)?;
    Ok(PyErr::from_value(exception))
}
