//! The command `moorline`.

use std::process::ExitCode;

fn main() -> ExitCode {
    moorline::cli::dispatch::main(std::env::args_os())
}
