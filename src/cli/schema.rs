//! `moorline schema`: the JSON Schema of the scene.

use crate::cli::console;
use crate::cli::stop::Stop;
use crate::scene::read;

/// Prints the schema.
pub fn schema() -> Result<(), Stop> {
    Ok(console::print(&format!("{:#}\n", read::schema()))?)
}
