//! What a mooring has to say: on the terminal and in a file, each from a level on.

use crate::failure::{Failure, INVALID_OUTPUT_FILE, Outcome};
use std::ffi::c_int;
use std::fs::File;
use std::io::Write;

/// For those who look for a fault.
pub const DEBUG: c_int = 0;
/// What is done.
pub const MESSAGE: c_int = 1;
/// What is allowed and may not be meant.
pub const WARNING: c_int = 2;
/// What was not done.
pub const ERROR: c_int = 3;

/// Where messages go. The terminal is its standard error.
pub struct Log {
    terminal_from: c_int,
    file_from: c_int,
    file: Option<File>,
}

impl Default for Log {
    fn default() -> Log {
        Log { terminal_from: WARNING, file_from: MESSAGE, file: None }
    }
}

/// The word for a level.
fn word(level: c_int) -> &'static str {
    match level {
        ..=DEBUG => "debug",
        MESSAGE => "message",
        WARNING => "warning",
        _ => "error",
    }
}

impl Log {
    /// From which level on the terminal gets messages.
    pub fn set_terminal(&mut self, level: c_int) {
        self.terminal_from = level;
    }

    /// From which level on the file gets messages.
    pub fn set_level(&mut self, level: c_int) {
        self.file_from = level;
    }

    /// The file that gets messages, from now on; what it held is gone.
    pub fn set_file(&mut self, path: &str) -> Outcome {
        let file = File::create(path);
        let file = file.map_err(|error| Failure::new(INVALID_OUTPUT_FILE, format!("{path}: cannot be written: {error}")))?;
        self.file = Some(file);
        Ok(())
    }

    /// Tells something; a log that cannot be written stops nobody.
    pub fn tell(&mut self, level: c_int, text: &str) {
        if level >= self.terminal_from {
            let _ = writeln!(std::io::stderr(), "moorline: {}: {text}", word(level));
        }
        if let Some(file) = self.file.as_mut().filter(|_| level >= self.file_from) {
            let _ = writeln!(file, "{}: {text}", word(level));
        }
    }
}
