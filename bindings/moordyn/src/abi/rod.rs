//! `Rod.h`: a rod. It is stiff: its nodes lie evenly from end A, 0, to end B.

use super::system::id;
use super::{give, give_all, give_vector, on, rod, without_meaning};
use crate::failure::{Failure, Outcome};
use crate::registry::Handle;
use crate::rig::Held;
use crate::system::System;
use nalgebra::Vector3;
use std::ffi::{c_char, c_int, c_uint};

/// Its number in the file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodID(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetRodID", handle, rod, |system, r| id(&system.rig.rods[r], to))
}

/// -2 coupled, 0 free, 2 fixed, also to a body.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodType(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetRodType", handle, rod, |system, r| {
        give(
            to,
            match system.rig.rods[r].held {
                Held::Coupled(..) => -2,
                Held::Free(_) => 0,
                Held::Fixed | Held::OnBody(_) => 2,
            },
        )
    })
}

/// Force and moment about end A: of the lines, with its weight and buoyancy [N, N·m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodForce(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetRodForce", handle, rod, |system, r| {
        system.check_ready()?;
        let [f, m] = system.load_on(&system.rig.rods[r]);
        give_all(to, &[f.x, f.y, f.z, m.x, m.y, m.z])
    })
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodM(handle: Handle, _to: *mut f64) -> c_int {
    on("MoorDyn_GetRodM", handle, rod, without_meaning("masses of lines are spread along them here; no share of them is a rod's"))
}

/// Number of segments.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodN(handle: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_GetRodN", handle, rod, |system, r| give(n, system.rig.rods[r].segments as c_uint))
}

/// Number of nodes.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodNumberNodes(handle: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_GetRodNumberNodes", handle, rod, |system, r| give(n, system.rig.rods[r].segments as c_uint + 1))
}

/// Position and velocity of a node.
fn node(system: &System, r: usize, node: c_uint) -> Outcome<[Vector3<f64>; 2]> {
    let of = &system.rig.rods[r];
    if node as usize > of.segments {
        return Err(Failure::invalid(format!("node {node} of a rod with nodes 0 to {}", of.segments)));
    }
    let share = f64::from(node) / of.segments.max(1) as f64;
    Ok(system.motion(of).place(&(of.axis * share)))
}

/// Position of a node [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodNodePos(handle: Handle, number: c_uint, to: *mut f64) -> c_int {
    on("MoorDyn_GetRodNodePos", handle, rod, |system, r| give_vector(to, node(system, r, number)?[0]))
}

/// Velocity of a node [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRodNodeVel(handle: Handle, number: c_uint, to: *mut f64) -> c_int {
    on("MoorDyn_GetRodNodeVel", handle, rod, |system, r| give_vector(to, node(system, r, number)?[1]))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SaveRodVTK(handle: Handle, _path: *const c_char) -> c_int {
    on("MoorDyn_SaveRodVTK", handle, rod, without_meaning("no VTK files are written here"))
}
