//! Which command answers what was typed, and the exit code of its outcome. One file per command stands beside this one.

use crate::cli::arguments::{Arguments, Command, RunArguments};
use crate::cli::stop::Stop;
use crate::cli::{check, console, convert, fit, pack, run, schema, seeds, statics};
use clap::Parser;
use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the command line and turns its outcome into the exit code.
pub fn main(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    ExitCode::from(answer(arguments))
}

/// One run, or one for each seed.
fn run_or_seeds(arguments: &RunArguments) -> Result<(), Stop> {
    arguments.options.seeds.as_deref().map_or_else(|| run::run(arguments), |seeds| seeds::run(arguments, seeds))
}

/// The same for a program in another language: the exit code as a number.
pub fn answer(arguments: impl Iterator<Item = OsString>) -> u8 {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(answer) => return console::usage(&answer),
    };
    let outcome = match arguments.command {
        None => run_or_seeds(&RunArguments { scene: None, options: arguments.run }),
        Some(Command::Run(arguments)) => run_or_seeds(&arguments),
        Some(Command::Statics(arguments)) => statics::statics(&arguments),
        Some(Command::Fit(arguments)) => fit::fit(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        Some(Command::Schema) => schema::schema(),
        Some(Command::Pack(arguments)) => pack::pack(&arguments),
        Some(Command::Convert(arguments)) => convert::convert(&arguments),
    };
    match outcome {
        Ok(()) => 0,
        Err(Stop::Failed(error)) => {
            console::error(&error.to_string());
            error.exit_code()
        }
    }
}
