//! Every failure of moorline as data (what, where, when, value, what is allowed), and the only file that words it.

use thiserror::Error;

/// Why something could not be done. Its `Display` is the message for the user; `exit_code` the program's answer to the shell.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A file could not be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the operating system said.
        reason: String,
    },
    /// The text is not the JSON of a scene.
    #[error("{file}, line {line}, column {column}{}: {message}", at_place(.place))]
    Json {
        /// The file.
        file: String,
        /// Line of the text, from 1.
        line: usize,
        /// Column of the text, from 1.
        column: usize,
        /// Place in the scene, such as `lines[0].sections[1]`; may be empty.
        place: String,
        /// What is wrong.
        message: String,
    },
    /// A value of the scene is not allowed.
    #[error("{file}, {place}: {value} is not allowed: {allowed}")]
    Value {
        /// The file.
        file: String,
        /// Place in the scene, such as `line_types.chain.ea`.
        place: String,
        /// The value found there.
        value: String,
        /// What is allowed, and what to change.
        allowed: String,
    },
    /// The scene asks for something that this version does not model.
    #[error("{file}, {place}: {feature} cannot be modelled by this version of moorline; remove it to run the scene without")]
    Unsupported {
        /// The file.
        file: String,
        /// Place in the scene.
        place: String,
        /// What was asked for.
        feature: String,
    },
    /// No static equilibrium was found.
    #[error(
        "line \"{line}\": no static equilibrium after {iterations} iterations: near s = {s:.6} m ({zone}) a force of {residual:.3e} N is \
         not balanced (allowed: {allowed:.3e} N). {remedy}"
    )]
    Statics {
        /// Name of the line.
        line: String,
        /// Newton iterations done.
        iterations: usize,
        /// Largest unbalanced nodal force [N].
        residual: f64,
        /// Unbalanced force that counts as equilibrium [N].
        allowed: f64,
        /// Arc length of the largest unbalanced force [m from the fairlead].
        s: f64,
        /// What is there: fairlead, anchor, touchdown, suspended, grounded.
        zone: String,
        /// What to try.
        remedy: String,
    },
    /// A time step could not be taken; the line stands as it was at `last_good_time`.
    #[error(
        "line \"{line}\", t = {time:.6} s, near s = {s:.6} m ({zone}): {cause} even with a step of {step:.1e} s. {remedy} \
         The line stands as it was at t = {last_good_time:.6} s."
    )]
    Step {
        /// Name of the line.
        line: String,
        /// Time of the attempt [s].
        time: f64,
        /// Where on the line [m from the fairlead].
        s: f64,
        /// What is there.
        zone: String,
        /// What failed.
        cause: String,
        /// Smallest step tried [s].
        step: f64,
        /// What to change.
        remedy: String,
        /// Time of the last good state [s].
        last_good_time: f64,
    },
    /// The user stopped the run; what was written is complete up to this time.
    #[error("stopped by the user at t = {time} s; all rows written are complete")]
    Interrupted {
        /// Time reached [s].
        time: f64,
    },
}

impl Error {
    /// Exit code of the command: 2 bad input, 3 no convergence, 130 stopped by the user.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::File { .. } | Error::Json { .. } | Error::Value { .. } | Error::Unsupported { .. } => 2,
            Error::Statics { .. } | Error::Step { .. } => 3,
            Error::Interrupted { .. } => 130,
        }
    }
}

fn at_place(place: &str) -> String {
    if place.is_empty() { String::new() } else { format!(", {place}") }
}
