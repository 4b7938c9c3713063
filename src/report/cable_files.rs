//! The files of the 1994 program that the run of a CABLE file leaves: `timeseries`, `snapshot` and the output, which is an input.
//!
//! ```text
//! timeseries   t, x, y, z, x', y', z' of the first node, λ there          F8.3, 7(1PE12.5)
//! snapshot     every JSNAP steps: node, tension λ, x, y, z, x', y', z'     I4, F12.2, 6 F11.5
//! ```
//!
//! Axes are those of the file, y up; in 2-D without z. Tension is λ, force over the length of the slope, as in 1994.

use crate::error::Error;
use crate::report::tables;
use crate::scene::cable::{Deck, from_scene, writing};
use crate::scene::state::LineState;
use crate::scene::types::Scene;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The three files of a run.
pub struct CableFiles {
    output: PathBuf,
    snapshot: Sink,
    time_series: Sink,
    dimensions: usize,
    every: usize,
    rows: usize,
}

/// A file that is written piece by piece.
struct Sink {
    file: File,
    path: PathBuf,
}

impl Sink {
    fn create(path: PathBuf) -> Result<Sink, Error> {
        Ok(Sink { file: tables::create(&path)?, path })
    }

    fn put(&mut self, text: &str) -> Result<(), Error> {
        self.file.write_all(text.as_bytes()).map_err(|error| tables::unwritable(&self.path, &error))
    }
}

impl CableFiles {
    /// Makes the files of a CABLE file's run in a directory. The output of an earlier run goes.
    pub fn create(directory: &Path, deck: &Deck) -> Result<CableFiles, Error> {
        let output = directory.join("output.dat");
        // Where this fails, writing the new file says why.
        let _ = std::fs::remove_file(&output);
        Ok(CableFiles {
            output,
            snapshot: Sink::create(directory.join("snapshot"))?,
            time_series: Sink::create(directory.join("timeseries"))?,
            dimensions: deck.dimensions,
            every: deck.snapshot_every,
            rows: 0,
        })
    }

    /// Writes what belongs to an output time.
    pub fn row(&mut self, state: &LineState) -> Result<(), Error> {
        self.time_series.put(&time_series_row(state, self.dimensions))?;
        if self.every > 0 && self.rows.is_multiple_of(self.every) {
            self.snapshot.put(&snapshot(self.rows, state, self.dimensions))?;
        }
        self.rows += 1;
        Ok(())
    }

    /// Writes the output: the file that was run, or what the scene has been made of it, with the nodes where they are now.
    pub fn finish(&self, scene: &Scene, deck: &Deck, state: &LineState) -> Result<(), Error> {
        let path = self.output.display().to_string();
        tables::write(&self.output, &writing::text(&from_scene::output(scene, deck, state, &path)?))
    }
}

/// A row of `timeseries`.
fn time_series_row(state: &LineState, dimensions: usize) -> String {
    let mut text = format!("{:8.3}", state.time);
    if let Some(top) = from_scene::nodes(state).first() {
        let numbers = top.position[..dimensions].iter().chain(&top.slope[..dimensions]).chain([&top.lambda]);
        numbers.for_each(|x| text += &writing::exponential(*x));
    }
    text + "\n"
}

/// One snapshot.
fn snapshot(step: usize, state: &LineState, dimensions: usize) -> String {
    let mut text = format!("\n\n Snapshot at Iteration # {step:4}  (time = {:10.3} s)\n Coordinates:\n\n", state.time);
    text += match dimensions {
        2 => " node    Tension         x           y           x'          y'\n",
        _ => " node    Tension         x           y           z           x'          y'          z'\n",
    };
    for (index, node) in from_scene::nodes(state).iter().enumerate() {
        // Writing to a string does not fail.
        let _ = write!(text, " {:4} {:12.2}", index + 1, node.lambda);
        let numbers = node.position[..dimensions].iter().chain(&node.slope[..dimensions]);
        numbers.for_each(|x| {
            let _ = write!(text, " {:11.5}", x + 0.0);
        });
        text += "\n";
    }
    text
}
