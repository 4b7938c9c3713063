//! `moorline pack`: a scene as an FMU. Needs no compiler: the libraries lie beside the program.

use crate::cli::arguments::PackArguments;
use crate::cli::stop::Stop;
use crate::fmi::pack::{self, Libraries, Naming};
use crate::scene::read;

/// Name of the FMU's model where there is no scene file to take it from.
pub const BUILT_IN: &str = "moorline";

/// Writes the FMU, and its OSP description beside it.
pub fn pack(arguments: &PackArguments) -> Result<(), Stop> {
    let (loaded, name) = match &arguments.scene {
        Some(path) => {
            let stem = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
            (read::load(path, &arguments.sets)?, stem.into_owned())
        }
        None => (read::built_in(&arguments.sets)?, BUILT_IN.to_string()),
    };
    let naming = if arguments.flat_names { Naming::Flat } else { Naming::Structured };
    pack::pack(&loaded.scene, &name, naming, &Libraries::beside_program(), &arguments.output)?;
    Ok(())
}
