//! A scene as Python gives it: a file, or text with the folder that its paths are relative to; and changes to it.

use moorline::error::Error;
use moorline::scene::read::{self, Loaded};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Where a scene comes from.
#[pyclass(frozen)]
pub struct Source {
    /// A scene file or CABLE file; without text, and without this, the built-in scene.
    path: Option<PathBuf>,
    /// The JSON of a scene.
    text: Option<String>,
    /// The folder that paths in the text are relative to.
    directory: PathBuf,
    /// `place=value`.
    sets: Vec<String>,
}

#[pymethods]
impl Source {
    #[new]
    fn new(path: Option<PathBuf>, text: Option<String>, directory: PathBuf, sets: Vec<String>) -> Source {
        Source { path, text, directory, sets }
    }
}

impl Source {
    /// Reads and checks it.
    pub fn load(&self) -> Result<Loaded, Error> {
        match (&self.text, &self.path) {
            (Some(text), _) => read::parse(text, "scene", &self.directory, &self.sets),
            (None, Some(path)) => read::load(path, &self.sets),
            (None, None) => read::built_in(&self.sets),
        }
    }
}
