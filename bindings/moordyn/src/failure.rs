//! The numbers that the functions return, and why.

use moorline::error::Error;
use moorline::fmi::refusal::Refusal;
use std::ffi::c_int;

/// Numbers of `MoorDynAPI.h`.
pub const SUCCESS: c_int = 0;
/// A file that cannot be read.
pub const INVALID_INPUT_FILE: c_int = -1;
/// A file that cannot be written.
pub const INVALID_OUTPUT_FILE: c_int = -2;
/// A file that can be read and makes no sense.
pub const INVALID_INPUT: c_int = -3;
/// A number that is none.
pub const NAN_ERROR: c_int = -4;
/// What the older functions return where nothing has been initialised.
pub const MEM_ERROR: c_int = -5;
/// A value, a pointer or a call that is not allowed.
pub const INVALID_VALUE: c_int = -6;
/// What has no meaning here.
pub const NOT_IMPLEMENTED: c_int = -7;
/// All else: no equilibrium, no convergence, a fault of the program.
pub const UNHANDLED_ERROR: c_int = -255;

/// Why a function did not do what it was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// The number that the function returns.
    pub code: c_int,
    /// Why.
    pub reason: String,
}

/// What comes of a function.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// A failure with a number.
    pub fn new(code: c_int, reason: impl Into<String>) -> Failure {
        Failure { code, reason: reason.into() }
    }

    /// A value, a pointer or a call that is not allowed.
    pub fn invalid(reason: impl Into<String>) -> Failure {
        Failure::new(INVALID_VALUE, reason)
    }

    /// What has no meaning here.
    pub fn without_meaning(reason: impl Into<String>) -> Failure {
        Failure::new(NOT_IMPLEMENTED, reason)
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Failure {
        let code = match &refusal {
            Refusal::NotANumber { .. } => NAN_ERROR,
            Refusal::Serialized(_) => INVALID_INPUT,
            Refusal::Solver(_) | Refusal::Discarded { .. } | Refusal::Panic(_) | Refusal::Reach { .. } => UNHANDLED_ERROR,
            _ => INVALID_VALUE,
        };
        Failure::new(code, refusal.to_string())
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        let code = match &error {
            Error::File { .. } => INVALID_INPUT_FILE,
            error if error.exit_code() == 2 => INVALID_INPUT,
            _ => UNHANDLED_ERROR,
        };
        Failure::new(code, error.to_string())
    }
}
