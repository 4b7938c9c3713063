//! `MoorDyn.h`: the functions of version 1, on one mooring that the process has.

use super::line::{MoorDyn_GetLineFairTen, MoorDyn_GetLineNodePos};
use super::point::{MoorDyn_GetPointForce, MoorDyn_GetPointPos};
use super::system::{
    MoorDyn_Close, MoorDyn_Create, MoorDyn_ExternalWaveKinGetCoordinates, MoorDyn_ExternalWaveKinInit,
    MoorDyn_ExternalWaveKinSet, MoorDyn_GetFASTtens, MoorDyn_GetLine, MoorDyn_GetPoint, MoorDyn_Init, MoorDyn_Step,
};
use crate::failure::{INVALID_VALUE, MEM_ERROR, SUCCESS, UNHANDLED_ERROR};
use crate::registry::Handle;
use std::ffi::{c_char, c_float, c_int, c_uint};
use std::sync::Mutex;

/// The handle of the mooring; 0: none.
static ONLY: Mutex<usize> = Mutex::new(0);

fn only() -> Option<Handle> {
    let address = *ONLY.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    (address != 0).then(|| std::ptr::without_provenance_mut(address))
}

fn set_only(handle: Option<Handle>) {
    *ONLY.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = handle.map_or(0, |handle| handle.addr());
}

/// Creates and initialises the mooring; one that was there before is closed.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDynInit(x: *const f64, xd: *const f64, path: *const c_char) -> c_int {
    let handle = MoorDyn_Create(path);
    if handle.is_null() {
        return UNHANDLED_ERROR;
    }
    let done = MoorDyn_Init(handle, x, xd);
    if done != SUCCESS {
        MoorDyn_Close(handle);
        return done;
    }
    if let Some(before) = only() {
        MoorDyn_Close(before);
    }
    set_only(Some(handle));
    SUCCESS
}

/// Goes on by a step.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDynStep(x: *const f64, xd: *const f64, f: *mut f64, t: *mut f64, dt: *mut f64) -> c_int {
    only().map_or(INVALID_VALUE, |handle| MoorDyn_Step(handle, x, xd, f, t, dt))
}

/// Lets go of it.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDynClose() -> c_int {
    let Some(handle) = only() else { return INVALID_VALUE };
    set_only(None);
    MoorDyn_Close(handle)
}

/// Number of places for which the program gives motions of the water.
#[unsafe(no_mangle)]
pub extern "C" fn externalWaveKinInit() -> c_int {
    let mut n: c_uint = 0;
    if let Some(handle) = only() {
        MoorDyn_ExternalWaveKinInit(handle, &raw mut n);
    }
    n as c_int
}

/// These places.
#[unsafe(no_mangle)]
pub extern "C" fn getWaveKinCoordinates(r: *mut f64) {
    if let Some(handle) = only() {
        MoorDyn_ExternalWaveKinGetCoordinates(handle, r);
    }
}

/// The motions.
#[unsafe(no_mangle)]
pub extern "C" fn setWaveKin(u: *const f64, ud: *const f64, t: f64) {
    if let Some(handle) = only() {
        MoorDyn_ExternalWaveKinSet(handle, u, ud, t);
    }
}

/// Tension at the fairlead of a line [N]; -1 where there is none.
#[unsafe(no_mangle)]
pub extern "C" fn GetFairTen(number: c_int) -> f64 {
    let mut tension = -1.0;
    if let Some(handle) = only() {
        MoorDyn_GetLineFairTen(MoorDyn_GetLine(handle, number as c_uint), &raw mut tension);
    }
    tension
}

/// As `MoorDyn_GetFASTtens`.
#[unsafe(no_mangle)]
pub extern "C" fn GetFASTtens(
    count: *mut c_int,
    fairlead_across: *mut c_float,
    fairlead_up: *mut c_float,
    anchor_across: *mut c_float,
    anchor_up: *mut c_float,
) -> c_int {
    only().map_or(MEM_ERROR, |handle| MoorDyn_GetFASTtens(handle, count, fairlead_across, fairlead_up, anchor_across, anchor_up))
}

/// As `MoorDyn_GetPointPos`.
#[unsafe(no_mangle)]
pub extern "C" fn GetPointPos(number: c_int, to: *mut f64) -> c_int {
    only().map_or(MEM_ERROR, |handle| MoorDyn_GetPointPos(MoorDyn_GetPoint(handle, number as c_uint), to))
}

/// As `MoorDyn_GetPointForce`.
#[unsafe(no_mangle)]
pub extern "C" fn GetPointForce(number: c_int, to: *mut f64) -> c_int {
    only().map_or(MEM_ERROR, |handle| MoorDyn_GetPointForce(MoorDyn_GetPoint(handle, number as c_uint), to))
}

/// As `MoorDyn_GetLineNodePos`.
#[unsafe(no_mangle)]
pub extern "C" fn GetNodePos(line: c_int, node: c_int, to: *mut f64) -> c_int {
    only().map_or(MEM_ERROR, |handle| MoorDyn_GetLineNodePos(MoorDyn_GetLine(handle, line as c_uint), node as c_uint, to))
}

/// Nothing: what there is to write is asked for by functions.
#[unsafe(no_mangle)]
pub extern "C" fn AllOutput(_t: f64, _dt: f64) {}

/// Nothing: no console is opened.
#[unsafe(no_mangle)]
pub extern "C" fn SetDisableConsole(_disable: c_int) {}
