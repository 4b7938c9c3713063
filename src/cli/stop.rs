//! Why a command ended without doing its work.

use crate::error::Error;

/// Why a command ended without doing its work.
#[derive(Debug)]
pub enum Stop {
    /// The calculation or a file failed.
    Failed(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Stop {
        Stop::Failed(error)
    }
}
