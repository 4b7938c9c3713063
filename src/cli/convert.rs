//! `moorline convert`: JSON scene to CABLE file and back.

use crate::cli::arguments::{ConvertArguments, Stop};

/// Says that this version does not read or write CABLE files yet.
pub fn convert(_arguments: &ConvertArguments) -> Result<(), Stop> {
    Err(Stop::Usage("`moorline convert` comes with a later version; this one reads JSON scenes only".to_string()))
}
