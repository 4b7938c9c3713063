//! `moorline pack`: a scene as an FMU.

use crate::cli::arguments::{PackArguments, Stop};

/// Says that this version does not write FMUs yet.
pub fn pack(_arguments: &PackArguments) -> Result<(), Stop> {
    Err(Stop::Usage("`moorline pack` comes with a later version; this one does not write FMUs yet".to_string()))
}
