//! `Body.h`: a body. Angles [rad] are MoorDyn's: R = Rx Ry Rz.

use super::system::id;
use super::{body, give, give_all, give_vector, on, without_meaning};
use crate::failure::{Failure, Outcome};
use crate::registry::Handle;
use crate::rig::Held;
use crate::system::{Motion, System};
use moorline::algebra::rotation;
use nalgebra::Vector3;
use std::ffi::{c_char, c_int};

/// Its number in the file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyID(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetBodyID", handle, body, |system, b| id(&system.rig.bodies[b], to))
}

/// -1 coupled, 0 free, 1 fixed.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyType(handle: Handle, to: *mut c_int) -> c_int {
    on("MoorDyn_GetBodyType", handle, body, |system, b| {
        give(
            to,
            match system.rig.bodies[b].held {
                Held::Coupled(..) => -1,
                Held::Free(_) => 0,
                Held::Fixed | Held::OnBody(_) => 1,
            },
        )
    })
}

fn motion(system: &System, b: usize) -> Motion {
    system.motion(&system.rig.bodies[b])
}

/// Position and angles, and velocity and angular velocity.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyState(handle: Handle, r: *mut f64, rd: *mut f64) -> c_int {
    on("MoorDyn_GetBodyState", handle, body, |system, b| {
        if r.is_null() || rd.is_null() {
            return Err(Failure::invalid("a place for the results is NULL"));
        }
        let Motion { position, turn, velocity, omega } = motion(system, b);
        let six = |one: Vector3<f64>, other: Vector3<f64>| [one.x, one.y, one.z, other.x, other.y, other.z];
        give_all(r, &six(position, rotation::angles_xyz(&turn)))?;
        give_all(rd, &six(velocity, omega))
    })
}

fn look(function: &str, handle: Handle, to: *mut f64, at: fn(Motion) -> Vector3<f64>) -> c_int {
    on(function, handle, body, |system, b| -> Outcome { give_vector(to, at(motion(system, b))) })
}

/// Position [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyPos(handle: Handle, to: *mut f64) -> c_int {
    look("MoorDyn_GetBodyPos", handle, to, |motion| motion.position)
}

/// Angles [rad].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyAngle(handle: Handle, to: *mut f64) -> c_int {
    look("MoorDyn_GetBodyAngle", handle, to, |motion| rotation::angles_xyz(&motion.turn))
}

/// Velocity [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyVel(handle: Handle, to: *mut f64) -> c_int {
    look("MoorDyn_GetBodyVel", handle, to, |motion| motion.velocity)
}

/// Angular velocity [rad/s].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyAngVel(handle: Handle, to: *mut f64) -> c_int {
    look("MoorDyn_GetBodyAngVel", handle, to, |motion| motion.omega)
}

/// Force and moment about its reference point: of the lines, with its weight and buoyancy [N, N·m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyForce(handle: Handle, to: *mut f64) -> c_int {
    on("MoorDyn_GetBodyForce", handle, body, |system, b| {
        system.check_ready()?;
        let [f, m] = system.load_on(&system.rig.bodies[b]);
        give_all(to, &[f.x, f.y, f.z, m.x, m.y, m.z])
    })
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBodyM(handle: Handle, _to: *mut f64) -> c_int {
    on(
        "MoorDyn_GetBodyM",
        handle,
        body,
        without_meaning("masses of lines are spread along them here; no share of them is a body's"),
    )
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SaveBodyVTK(handle: Handle, _path: *const c_char) -> c_int {
    on("MoorDyn_SaveBodyVTK", handle, body, without_meaning("no VTK files are written here"))
}
