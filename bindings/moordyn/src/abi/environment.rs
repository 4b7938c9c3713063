//! `Waves.h` and `Seafloor.h`: the water and the bed.

use super::{give, give_vector, guarded, on};
use crate::failure::{Failure, NAN_ERROR, Outcome};
use crate::registry::{Handle, Item};
use crate::system::System;
use moorline::sea::wave::wave_number;
use nalgebra::Vector3;
use std::ffi::c_int;

fn waves(item: Item) -> Option<usize> {
    (item == Item::Waves).then_some(0)
}

fn seafloor(item: Item) -> Option<usize> {
    (item == Item::Seafloor).then_some(0)
}

fn finite(values: &[f64]) -> Outcome {
    if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(Failure::new(NAN_ERROR, "a coordinate is no number")) }
}

/// The water at a place: the current, in still water. The bed of a file is the mooring's own.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetWavesKin(
    handle: Handle,
    x: f64,
    y: f64,
    z: f64,
    velocity: *mut f64,
    acceleration: *mut f64,
    elevation: *mut f64,
    pressure: *mut f64,
    _seafloor: Handle,
) -> c_int {
    on("MoorDyn_GetWavesKin", handle, waves, |system, _| {
        finite(&[x, y, z])?;
        if [velocity, acceleration, elevation, pressure].iter().any(|place| place.is_null()) {
            return Err(Failure::invalid("a place for the results is NULL"));
        }
        give_vector(velocity, system.water_velocity(z))?;
        give_vector(acceleration, Vector3::zeros())?;
        give(elevation, 0.0)?;
        give(pressure, 0.0)
    })
}

/// Wave number of a frequency [rad/s] by linear theory [1/m]; 0 where there is none.
#[unsafe(no_mangle)]
pub extern "C" fn WaveNumber(omega: f64, gravity: f64, depth: f64) -> f64 {
    let sensible = omega > 0.0 && gravity > 0.0 && depth > 0.0 && [omega, gravity, depth].iter().all(|x| x.is_finite());
    let number = guarded(|| Ok(wave_number(omega, gravity, depth)));
    number.ok().filter(|number| sensible && number.is_finite()).unwrap_or(0.0)
}

/// Height of the bed at a place [m], below zero under water.
fn bed(system: &System, x: f64, y: f64) -> f64 {
    let environment = &system.rig.scene.environment;
    let [along_x, along_y] = environment.seabed.slope_deg.map(|slope| slope.to_radians().tan());
    -environment.depth + x * along_x + y * along_y
}

/// Height of the bed at a place [m].
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetDepthAt(handle: Handle, x: f64, y: f64, depth: *mut f64) -> c_int {
    on("MoorDyn_GetDepthAt", handle, seafloor, |system, _| {
        finite(&[x, y])?;
        give(depth, bed(system, x, y))
    })
}

/// Height of the bed at the origin [m]: it is a plane.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetAverageDepth(handle: Handle, depth: *mut f64) -> c_int {
    on("MoorDyn_GetAverageDepth", handle, seafloor, |system, _| give(depth, bed(system, 0.0, 0.0)))
}

/// Has no meaning here unless the bed is level: a plane ends nowhere.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetMinDepth(handle: Handle, depth: *mut f64) -> c_int {
    on("MoorDyn_GetMinDepth", handle, seafloor, |system, _| {
        if system.rig.scene.environment.seabed.slope_deg == [0.0; 2] {
            return give(depth, bed(system, 0.0, 0.0));
        }
        Err(Failure::without_meaning("the bed is a plane that ends nowhere, so that it is least deep nowhere"))
    })
}
