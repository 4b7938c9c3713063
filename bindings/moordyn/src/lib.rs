//! The C functions of MoorDyn, on moorline: a program that was compiled against MoorDyn's headers and links `-lmoordyn` runs on it.
//!
//! `README.md` says how to link it, what its numbers mean and what differs. `failure` is what a function returns, `registry` what a handle is,
//! `rig` what a file has and where it is found in the scene, `own` what a held thing weighs itself, `system` the mooring in the hands of such a
//! program, and `abi` the functions.
#![allow(non_snake_case)]
#![warn(missing_docs)]
#![deny(unsafe_op_in_unsafe_fn)]

#[allow(unsafe_code)]
pub mod abi;
pub mod failure;
pub mod log;
pub mod own;
pub mod registry;
pub mod rig;
pub mod system;
