//! `Line.h`: a line. Nodes count from end A, 0 to the number of segments of the file; they are places of the line, not those of its elements.

use super::{give, give_matrix, give_vector, line, on, without_meaning};
use crate::failure::{Failure, Outcome};
use crate::registry::Handle;
use crate::system::System;
use nalgebra::Vector3;
use std::ffi::{c_char, c_int, c_uint};

/// Its number in the file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineID(handle: Handle, id: *mut c_int) -> c_int {
    on("MoorDyn_GetLineID", handle, line, |system, l| give(id, system.rig.lines[l].id as c_int))
}

/// Number of segments.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineN(handle: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_GetLineN", handle, line, |system, l| give(n, system.rig.lines[l].segments as c_uint))
}

/// Number of nodes.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNumberNodes(handle: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_GetLineNumberNodes", handle, line, |system, l| give(n, system.rig.lines[l].segments as c_uint + 1))
}

/// Unstretched length [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineUnstretchedLength(handle: Handle, length: *mut f64) -> c_int {
    on("MoorDyn_GetLineUnstretchedLength", handle, line, |system, l| give(length, system.rig.lines[l].length))
}

const ONE_LENGTH: &str = "a line keeps its length: nothing is wound in or out";

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLineUnstretchedLength(handle: Handle, _length: f64) -> c_int {
    on("MoorDyn_SetLineUnstretchedLength", handle, line, without_meaning(ONE_LENGTH))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLineUnstretchedLengthVel(handle: Handle, _rate: f64) -> c_int {
    on("MoorDyn_SetLineUnstretchedLengthVel", handle, line, without_meaning(ONE_LENGTH))
}

/// Whether EA is one number.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_IsLineConstantEA(handle: Handle, b: *mut c_int) -> c_int {
    on("MoorDyn_IsLineConstantEA", handle, line, |system, l| give(b, c_int::from(system.rig.lines[l].ea.is_some())))
}

/// EA [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineConstantEA(handle: Handle, ea: *mut f64) -> c_int {
    on("MoorDyn_GetLineConstantEA", handle, line, |system, l| {
        let known = system.rig.lines[l].ea;
        give(ea, known.ok_or_else(|| Failure::invalid("EA follows a table; it is not one number"))?)
    })
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLineConstantEA(handle: Handle, _ea: f64) -> c_int {
    on("MoorDyn_SetLineConstantEA", handle, line, without_meaning("EA is that of the file for the whole run"))
}

/// Pressure never bends a line here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_IsLinePressBend(handle: Handle, b: *mut c_int) -> c_int {
    on("MoorDyn_IsLinePressBend", handle, line, |_, _| give(b, 0))
}

/// Off is what it is; on has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLinePressBend(handle: Handle, b: c_int) -> c_int {
    on("MoorDyn_SetLinePressBend", handle, line, |_, _| {
        if b == 0 { Ok(()) } else { Err(Failure::without_meaning("pressure in a line does not bend it here")) }
    })
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLinePressInt(handle: Handle, _p: *const f64) -> c_int {
    on("MoorDyn_SetLinePressInt", handle, line, without_meaning("pressure in a line does not bend it here"))
}

type Look = fn(&mut System, usize, usize) -> Outcome<Vector3<f64>>;

fn of_node(function: &str, handle: Handle, node: c_uint, to: *mut f64, look: Look) -> c_int {
    on(function, handle, line, |system, l| give_vector(to, look(system, l, node as usize)?))
}

/// Position of a node [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodePos(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    of_node("MoorDyn_GetLineNodePos", handle, node, to, |system, l, node| Ok(system.node(l, node)?.position))
}

/// Velocity of a node [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeVel(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    of_node("MoorDyn_GetLineNodeVel", handle, node, to, |system, l, node| Ok(system.node(l, node)?.velocity))
}

/// Net force on a node [N]: of an end, that on what holds it.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeForce(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    of_node("MoorDyn_GetLineNodeForce", handle, node, to, System::node_force)
}

/// Tension at a node, in the direction from end A to end B [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeTen(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    of_node("MoorDyn_GetLineNodeTen", handle, node, to, |system, l, node| Ok(system.node(l, node)?.force))
}

/// Weight and buoyancy of the lump of a node [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeWeight(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    of_node("MoorDyn_GetLineNodeWeight", handle, node, to, System::node_weight)
}

const NO_LUMPS: &str = "loads are spread along elements here; there is no share of them that is a node's";

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeBendStiff(handle: Handle, _node: c_uint, _to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeBendStiff", handle, line, without_meaning(NO_LUMPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeDrag(handle: Handle, _node: c_uint, _to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeDrag", handle, line, without_meaning(NO_LUMPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeFroudeKrilov(handle: Handle, _node: c_uint, _to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeFroudeKrilov", handle, line, without_meaning(NO_LUMPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeSeabedForce(handle: Handle, _node: c_uint, _to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeSeabedForce", handle, line, without_meaning(NO_LUMPS))
}

/// Curvature at a node [1/m]; 0 of a line that does not resist bending, as MoorDyn has it.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeCurv(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeCurv", handle, line, |system, l| {
        let curvature = system.node(l, node as usize)?.curvature;
        give(to, if system.rig.lines[l].bends { curvature } else { 0.0 })
    })
}

/// Mass of the lump of a node with the water that moves with it [kg].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineNodeM(handle: Handle, node: c_uint, to: *mut f64) -> c_int {
    on("MoorDyn_GetLineNodeM", handle, line, |system, l| give_matrix(to, system.node_mass(l, node as usize)?))
}

/// Tension at end B, the fairlead [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineFairTen(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetLineFairTen", handle, line, |system, l| give(to, system.outputs(l)?.tension))
}

/// Largest tension along the line [N].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLineMaxTen(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetLineMaxTen", handle, line, |system, l| give(to, system.outputs(l)?.tension_max))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SaveLineVTK(handle: Handle, _path: *const c_char) -> c_int {
    on("MoorDyn_SaveLineVTK", handle, line, without_meaning("no VTK files are written here"))
}
