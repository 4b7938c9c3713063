//! The command `moorline`.

use std::process::ExitCode;

fn main() -> ExitCode {
    moorline::cli::arguments::main(std::env::args_os())
}
