//! `MoorDyn2.h`: the mooring.

use super::{give, give_all, guarded, numbers, on, returned, taken, text, whole, without_meaning};
use crate::failure::{Failure, Outcome};
use crate::registry::{self, Handle, Item};
use crate::rig::Thing;
use crate::system::System;
use std::ffi::{c_char, c_float, c_int, c_uint};

/// The file that is read where none is named.
const DEFAULT: &str = "Mooring/lines.txt";

/// Creates a mooring; NULL where that is not possible.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Create(path: *const c_char) -> Handle {
    let created = guarded(|| {
        let path = if path.is_null() { DEFAULT } else { text(path)? };
        System::new(path)
    });
    match created {
        Ok(system) => registry::enter(system),
        Err(failure) => {
            returned("MoorDyn_Create", Err(failure));
            std::ptr::null_mut()
        }
    }
}

/// Number of degrees of freedom that the program moves.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_NCoupledDOF(system: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_NCoupledDOF", system, whole, |system, _| give(n, system.rig.freedoms as c_uint))
}

/// From which level on the terminal gets messages.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetVerbosity(system: Handle, level: c_int) -> c_int {
    on("MoorDyn_SetVerbosity", system, whole, |system, _| {
        system.log.set_terminal(level);
        Ok(())
    })
}

/// The file that gets messages.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLogFile(system: Handle, path: *const c_char) -> c_int {
    on("MoorDyn_SetLogFile", system, whole, |system, _| system.log.set_file(text(path)?))
}

/// From which level on the file gets messages.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetLogLevel(system: Handle, level: c_int) -> c_int {
    on("MoorDyn_SetLogLevel", system, whole, |system, _| {
        system.log.set_level(level);
        Ok(())
    })
}

/// Tells something to the log.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Log(system: Handle, level: c_int, message: *const c_char) -> c_int {
    on("MoorDyn_Log", system, whole, |system, _| {
        system.log.tell(level, text(message)?.trim_end());
        Ok(())
    })
}

fn initialise(function: &str, system: Handle, x: *const f64, xd: *const f64, settled: bool) -> c_int {
    on(function, system, whole, |system, _| {
        let n = system.rig.freedoms;
        // Velocities may be left out: then everything is at rest.
        let rest = vec![0.0; n];
        let velocities = if xd.is_null() { &rest[..] } else { numbers("xd", xd, n)? };
        system.initialise(numbers("x", x, n)?, velocities, settled)
    })
}

/// Puts the mooring in equilibrium.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Init(system: Handle, x: *const f64, xd: *const f64) -> c_int {
    initialise("MoorDyn_Init", system, x, xd, true)
}

/// Puts the lines in equilibrium, and lets free bodies and points go where the file has them.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Init_NoIC(system: Handle, x: *const f64, xd: *const f64) -> c_int {
    initialise("MoorDyn_Init_NoIC", system, x, xd, false)
}

/// Goes on by a step.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Step(system: Handle, x: *const f64, xd: *const f64, f: *mut f64, t: *mut f64, dt: *mut f64) -> c_int {
    on("MoorDyn_Step", system, whole, |system, _| {
        let n = system.rig.freedoms;
        let time = numbers("t", t, 1)?[0];
        let step = numbers("dt", dt, 1)?[0];
        if n > 0 && f.is_null() {
            return Err(Failure::invalid("f is NULL, but takes the forces"));
        }
        // Without a step forces alone are asked for.
        if step > 0.0 || !step.is_finite() {
            let reached = system.step(numbers("x", x, n)?, numbers("xd", xd, n)?, time, step)?;
            give(t, reached)?;
        }
        give_all(f, &system.forces()?)
    })
}

/// Lets go of the mooring; its handle and those of its parts are of nothing from then on.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Close(system: Handle) -> c_int {
    let outcome = guarded(|| {
        let (shared, item) = registry::find(system)?;
        whole(item).ok_or_else(|| Failure::invalid("the handle is of a part of a mooring"))?;
        registry::leave(&shared);
        Ok(())
    });
    returned("MoorDyn_Close", outcome)
}

/// The handle of a part; NULL where there is none.
fn part(function: &str, system: Handle, find: impl FnOnce(&System) -> Outcome<Item>) -> Handle {
    let found = guarded(|| {
        let (shared, item) = registry::find(system)?;
        whole(item).ok_or_else(|| Failure::invalid("the handle is of a part of a mooring"))?;
        let item = find(&registry::locked(&shared))?;
        Ok(registry::handle_of(&shared, item))
    });
    found.unwrap_or_else(|failure| {
        returned(function, Err(failure));
        std::ptr::null_mut()
    })
}

/// The index of a number that counts from 1.
fn index(number: c_uint, count: usize, what: &str) -> Outcome<usize> {
    match (number as usize).checked_sub(1).filter(|index| *index < count) {
        Some(index) => Ok(index),
        None => Err(Failure::invalid(format!("there is no {what} {number}: they count from 1 to {count}"))),
    }
}

/// The water.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetWaves(system: Handle) -> Handle {
    part("MoorDyn_GetWaves", system, |_| Ok(Item::Waves))
}

/// The bed; NULL where the depth is one number, as MoorDyn has it.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetSeafloor(system: Handle) -> Handle {
    let level = guarded(|| {
        let (shared, _) = registry::find(system)?;
        let from_file = registry::locked(&shared).rig.bed_of_file;
        Ok(!from_file)
    });
    if level == Ok(true) {
        return std::ptr::null_mut();
    }
    part("MoorDyn_GetSeafloor", system, |_| Ok(Item::Seafloor))
}

fn count(function: &str, system: Handle, n: *mut c_uint, of: impl FnOnce(&System) -> usize) -> c_int {
    on(function, system, whole, |system, _| give(n, of(system) as c_uint))
}

/// Number of bodies.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetNumberBodies(system: Handle, n: *mut c_uint) -> c_int {
    count("MoorDyn_GetNumberBodies", system, n, |system| system.rig.bodies.len())
}

/// A body, counted from 1.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetBody(system: Handle, number: c_uint) -> Handle {
    part("MoorDyn_GetBody", system, |system| index(number, system.rig.bodies.len(), "body").map(Item::Body))
}

/// Number of rods.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetNumberRods(system: Handle, n: *mut c_uint) -> c_int {
    count("MoorDyn_GetNumberRods", system, n, |system| system.rig.rods.len())
}

/// A rod, counted from 1.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetRod(system: Handle, number: c_uint) -> Handle {
    part("MoorDyn_GetRod", system, |system| index(number, system.rig.rods.len(), "rod").map(Item::Rod))
}

/// Number of points.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetNumberPoints(system: Handle, n: *mut c_uint) -> c_int {
    count("MoorDyn_GetNumberPoints", system, n, |system| system.rig.points.len())
}

/// A point, counted from 1.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetPoint(system: Handle, number: c_uint) -> Handle {
    part("MoorDyn_GetPoint", system, |system| index(number, system.rig.points.len(), "point").map(Item::Point))
}

/// Number of lines.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetNumberLines(system: Handle, n: *mut c_uint) -> c_int {
    count("MoorDyn_GetNumberLines", system, n, |system| system.rig.lines.len())
}

/// A line, counted from 1.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetLine(system: Handle, number: c_uint) -> Handle {
    part("MoorDyn_GetLine", system, |system| index(number, system.rig.lines.len(), "line").map(Item::Line))
}

/// Horizontal and vertical forces of the first lines at end B, the fairlead, and end A, the anchor.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetFASTtens(
    system: Handle,
    count: *const c_int,
    fairlead_across: *mut c_float,
    fairlead_up: *mut c_float,
    anchor_across: *mut c_float,
    anchor_up: *mut c_float,
) -> c_int {
    on("MoorDyn_GetFASTtens", system, whole, |system, _| {
        let asked = taken("numLines", count, 0)?;
        let lines = system.rig.lines.len();
        let asked = usize::try_from(asked).ok().filter(|asked| *asked <= lines);
        let asked = asked.ok_or_else(|| Failure::invalid(format!("numLines must be from 0 to {lines}, the number of lines")))?;
        let mut columns = [const { Vec::new() }; 4];
        for line in 0..asked {
            let of = system.outputs(line)?;
            for (end, force) in [of.force, of.anchor_force].into_iter().enumerate() {
                columns[2 * end].push(force.x.hypot(force.y) as c_float);
                columns[2 * end + 1].push(force.z as c_float);
            }
        }
        let places = [fairlead_across, fairlead_up, anchor_across, anchor_up];
        if asked > 0 && places.iter().any(|place| place.is_null()) {
            return Err(Failure::invalid("a place for the results is NULL"));
        }
        places.into_iter().zip(&columns).try_for_each(|(place, column)| give_all(place, column))
    })
}

const NO_STEPS: &str = "the solver chooses its own steps, by the accuracy of the tensions";

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_BreakLine(system: Handle, _point: Handle, _line: Handle) -> c_int {
    on("MoorDyn_BreakLine", system, whole, without_meaning("lines do not break off in the middle of a run"))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetDt(system: Handle, _dt: *mut f64) -> c_int {
    on("MoorDyn_GetDt", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetDt(system: Handle, _dt: f64) -> c_int {
    on("MoorDyn_SetDt", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetCFL(system: Handle, _cfl: *mut f64) -> c_int {
    on("MoorDyn_GetCFL", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetCFL(system: Handle, _cfl: f64) -> c_int {
    on("MoorDyn_SetCFL", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetTimeScheme(system: Handle, _name: *mut c_char, _length: *mut usize) -> c_int {
    on("MoorDyn_GetTimeScheme", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetTimeScheme(system: Handle, _name: *const c_char) -> c_int {
    on("MoorDyn_SetTimeScheme", system, whole, without_meaning(NO_STEPS))
}

/// Has no meaning here.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SaveVTK(system: Handle, _path: *const c_char) -> c_int {
    on("MoorDyn_SaveVTK", system, whole, without_meaning("no VTK files are written here"))
}

/// Writes the state to a file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Save(system: Handle, path: *const c_char) -> c_int {
    on("MoorDyn_Save", system, whole, |system, _| system.save(text(path)?))
}

/// Goes back to the state of a file.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Load(system: Handle, path: *const c_char) -> c_int {
    on("MoorDyn_Load", system, whole, |system, _| system.load(text(path)?))
}

/// As `MoorDyn_Save`.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SaveState(system: Handle, path: *const c_char) -> c_int {
    on("MoorDyn_SaveState", system, whole, |system, _| system.save(text(path)?))
}

/// As `MoorDyn_Load`.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_LoadState(system: Handle, path: *const c_char) -> c_int {
    on("MoorDyn_LoadState", system, whole, |system, _| system.load(text(path)?))
}

/// The state: how many bytes it has, and where there is a place for them, these.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Serialize(system: Handle, size: *mut usize, data: *mut u64) -> c_int {
    on("MoorDyn_Serialize", system, whole, |system, _| {
        let state = system.state()?;
        if !size.is_null() {
            give(size, state.len() * size_of::<u64>())?;
        }
        if data.is_null() { Ok(()) } else { give_all(data, &state) }
    })
}

/// Goes back to a state.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_Deserialize(system: Handle, data: *const u64) -> c_int {
    on("MoorDyn_Deserialize", system, whole, |system, _| {
        // What `MoorDyn_Serialize` gave is longer than two numbers, and says how long it is.
        let read = |index: usize| taken("the state", data, index);
        let length = System::length_of_state([read(0)?, read(1)?]);
        let length = length.ok_or_else(|| Failure::invalid("this is no state of a mooring"))?;
        let state = (0..length).map(read).collect::<Outcome<Vec<u64>>>()?;
        system.restore(&state)
    })
}

/// How many places of the water there are for which the program gives motions: none, as waves of a program are not taken.
fn outer_waves(system: &System) -> Outcome {
    if !system.rig.outer_waves {
        return Ok(());
    }
    Err(Failure::without_meaning(
        "WaveKin 1: waves of a calling program are not taken; lines feel still water and the current alone",
    ))
}

/// No place of the water waits for motions; where the file says that some do, this is a failure.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_ExternalWaveKinInit(system: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_ExternalWaveKinInit", system, whole, |system, _| {
        if !n.is_null() {
            give(n, 0)?;
        }
        outer_waves(system)
    })
}

/// As `MoorDyn_ExternalWaveKinInit`.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_ExternalWaveKinGetN(system: Handle, n: *mut c_uint) -> c_int {
    on("MoorDyn_ExternalWaveKinGetN", system, whole, |system, _| {
        give(n, 0)?;
        outer_waves(system)
    })
}

/// As `MoorDyn_ExternalWaveKinInit`.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_ExternalWaveKinGetCoordinates(system: Handle, _r: *mut f64) -> c_int {
    on("MoorDyn_ExternalWaveKinGetCoordinates", system, whole, |system, _| outer_waves(system))
}

/// As `MoorDyn_ExternalWaveKinInit`.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_ExternalWaveKinSet(system: Handle, _u: *const f64, _ud: *const f64, _t: f64) -> c_int {
    on("MoorDyn_ExternalWaveKinSet", system, whole, |system, _| outer_waves(system))
}

/// The older name.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_GetWaveKinCoordinates(system: Handle, r: *mut f64) -> c_int {
    MoorDyn_ExternalWaveKinGetCoordinates(system, r)
}

/// The older name.
#[unsafe(no_mangle)]
pub extern "C" fn MoorDyn_SetWaveKin(system: Handle, u: *const f64, ud: *const f64, t: f64) -> c_int {
    MoorDyn_ExternalWaveKinSet(system, u, ud, t)
}

/// The number of a thing in its file.
pub(super) fn id(thing: &Thing, to: *mut c_int) -> Outcome {
    give(to, thing.id as c_int)
}
