//! `Point.h`: a point.

use super::system::id;
use super::{give, give_vector, guarded, on, point, returned, without_meaning};
use crate::failure::{Failure, Outcome};
use crate::registry::{self, Handle, Item};
use crate::rig::Held;
use std::ffi::{c_char, c_int, c_uint};

/// Its number in the file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointID(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetPointID", handle, point, |system, p| id(&system.rig.points[p], to))
}

/// -1 coupled, 0 free, 1 fixed, also to a body.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointType(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetPointType", handle, point, |system, p| {
        give(
            to,
            match system.rig.points[p].held {
                Held::Coupled(..) => -1,
                Held::Free(_) => 0,
                Held::Fixed | Held::OnBody(_) => 1,
            },
        )
    })
}

/// Position [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointPos(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetPointPos", handle, point, |system, p| give_vector(to, system.motion(&system.rig.points[p]).position))
}

/// Velocity [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointVel(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetPointVel", handle, point, |system, p| give_vector(to, system.motion(&system.rig.points[p]).velocity))
}

/// Force of the lines on it, with its weight, buoyancy, drag and constant force [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointForce(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetPointForce", handle, point, |system, p| {
        system.check_ready()?;
        let [force, _] = system.load_on(&system.rig.points[p]);
        give_vector(to, force)
    })
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointM(handle: Handle, _to: *mut f64) -> c_int {
    on(
        "MoorDyn_GetPointM",
        handle,
        point,
        without_meaning("masses of lines are spread along them here; no share of them is a point's"),
    )
}

/// Number of ends of lines on it.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointNAttached(handle: Handle, to: *mut c_uint) -> c_int {
    on("MoorDyn_GetPointNAttached", handle, point, |system, p| give(to, system.rig.points[p].ends.len() as c_uint))
}

/// A line on it, counted from 0, and which of its ends: 0 end A, 1 end B.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPointAttached(handle: Handle, number: c_uint, to: *mut Handle, end: *mut c_int) -> c_int {
    let outcome = guarded(|| {
        let (shared, item) = registry::find(handle)?;
        let p = point(item).ok_or_else(|| Failure::invalid("the handle is of a thing of another kind"))?;
        let found: Outcome<(usize, bool)> = {
            let system = registry::locked(&shared);
            let ends = &system.rig.points[p].ends;
            let none =
                || Failure::invalid(format!("there is no line {number} on the point: they count from 0, and are {}", ends.len()));
            ends.get(number as usize).copied().ok_or_else(none)
        };
        let (line, b) = found?;
        if to.is_null() || end.is_null() {
            return Err(Failure::invalid("a place for the results is NULL"));
        }
        give(to, registry::handle_of(&shared, Item::Line(line)))?;
        give(end, c_int::from(b))
    });
    returned("MoorDyn_GetPointAttached", outcome)
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SavePointVTK(handle: Handle, _path: *const c_char) -> c_int {
    on("MoorDyn_SavePointVTK", handle, point, without_meaning("no VTK files are written here"))
}
