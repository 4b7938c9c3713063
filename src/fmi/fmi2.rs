//! The C interface of FMI 2.0 for co-simulation: 34 functions and their types. It translates and decides nothing.
//!
//! The only file with `unsafe`. What every block relies on is what the standard demands of a master: a component is NULL or came from
//! `fmi2Instantiate` and was not freed, it is used by one thread at a time, strings are NULL or end with a zero byte, and an array holds as
//! many elements as the call says. NULL itself is always checked. Handles of FMU states are never dereferenced.
//!
//! A panic never crosses: it is caught, told to the logger and returned as `fmi2Error`. It is not printed either: the first call puts a
//! panic hook in front of the present one that is silent for panics inside these functions and passes all others on. The shared library
//! has a Rust runtime of its own, so that a host written in Rust keeps its hook; a program that links this crate as a Rust library has no
//! reason to call these functions (`instance` is for it), and if it does, other panics still reach its hook.
#![allow(non_snake_case)]

use crate::fmi::instance::{Instance, WARNING};
use crate::fmi::own_place;
use crate::fmi::phase::StepStatus;
use crate::fmi::refusal::Refusal;
use crate::fmi::variables::Kind;
use std::cell::Cell;
use std::ffi::{CStr, CString, c_char, c_int, c_uint, c_void};
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

/// `fmi2Component`: an instance.
pub type Handle = *mut c_void;
/// `fmi2FMUstate`: the handle of a state.
pub type StateHandle = *mut c_void;
/// `fmi2ValueReference`.
pub type ValueReference = c_uint;
/// `fmi2Boolean`.
pub type Boolean = c_int;
/// `fmi2String`.
pub type Text = *const c_char;
/// `fmi2Status`.
pub type Status = c_int;

const OK: Status = 0;
const WARNED: Status = 1;
const DISCARD: Status = 2;
const ERROR: Status = 3;

const CO_SIMULATION: c_int = 1;
const DO_STEP_STATUS: c_int = 0;
const PENDING_STATUS: c_int = 1;
const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;

/// `fmi2CallbackLogger`.
pub type Logger = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, ...);

/// `fmi2CallbackFunctions`. The memory functions are not used (canNotUseMemoryManagementFunctions) and steps are synchronous.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct CallbackFunctions {
    /// Where messages go; never NULL.
    pub logger: Option<Logger>,
    /// Not used.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Not used.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Not used.
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    /// Given back to the logger.
    pub component_environment: *mut c_void,
}

/// What an `fmi2Component` points to.
struct Component {
    instance: Instance,
    log: Log,
}

/// The way to the master's log.
struct Log {
    logger: Option<Logger>,
    environment: *mut c_void,
    name: CString,
}

impl Log {
    /// `%` is doubled because masters use the message as a format of printf.
    fn tell(&self, status: Status, category: &str, text: &str) {
        let Some(logger) = self.logger else { return };
        let clean = text.replace('%', "%%").replace('\0', "?");
        let (Ok(category), Ok(message)) = (CString::new(category), CString::new(clean)) else { return };
        // SAFETY: the master's own function, with strings that live until it returns; no conversion in the message asks for arguments.
        unsafe { logger(self.environment, self.name.as_ptr(), status, category.as_ptr(), message.as_ptr()) }
    }

    /// The status of an outcome; a refusal goes to the log.
    fn status(&self, function: &str, outcome: Result<(), Refusal>) -> Status {
        let Err(refusal) = outcome else { return OK };
        let (status, category) = match &refusal {
            Refusal::Discarded { .. } | Refusal::NoStatus => (DISCARD, "logStatusDiscard"),
            Refusal::Panic(_) => (ERROR, "logStatusFatal"),
            _ => (ERROR, "logStatusError"),
        };
        let text = format!("{function}: {refusal}");
        if matches!(refusal, Refusal::Discarded { .. }) {
            // Masters show nothing of a Discard at their usual level.
            self.tell(WARNED, WARNING, &text);
        }
        self.tell(status, category, &text);
        status
    }
}

thread_local! {
    /// Whether this thread is inside one of our functions. It has no destructor, so that the library can be unloaded.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Runs a body and turns a panic into a refusal, without printing it.
fn guarded<T>(body: impl FnOnce() -> Result<T, Refusal>) -> Result<T, Refusal> {
    static HOOK: Once = Once::new();
    let was_inside = INSIDE.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(|| {
        HOOK.call_once(|| {
            let previous = panic::take_hook();
            panic::set_hook(Box::new(move |info| {
                if !INSIDE.get() {
                    previous(info)
                }
            }));
        });
        body()
    }));
    INSIDE.set(was_inside);
    result.unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(Refusal::Panic(text.to_owned()))
    })
}

/// Runs a body on the instance behind a component.
fn with(component: Handle, function: &str, body: impl FnOnce(&mut Instance) -> Result<(), Refusal>) -> Status {
    // SAFETY: NULL or a live component used by this thread alone (see the head of the file).
    let Some(component) = (unsafe { component.cast::<Component>().as_mut() }) else { return ERROR };
    let Component { instance, log } = component;
    let outcome = guarded(|| body(instance));
    if let Err(Refusal::Panic(_)) = outcome {
        instance.fail();
    }
    for message in instance.take_messages() {
        let status = if message.category == WARNING { WARNED } else { OK };
        log.tell(status, message.category, &message.text);
    }
    log.status(function, outcome)
}

/// A master's array.
///
/// # Safety
/// NULL or `count` elements that nobody changes while the slice lives.
unsafe fn array<'a, T>(pointer: *const T, count: usize, argument: &'static str) -> Result<&'a [T], Refusal> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(Refusal::Null { argument }),
        // SAFETY: the caller's promise.
        _ => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// A master's array to write to.
///
/// # Safety
/// NULL or `count` elements that nobody else uses while the slice lives.
unsafe fn array_mut<'a, T>(pointer: *mut T, count: usize, argument: &'static str) -> Result<&'a mut [T], Refusal> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(Refusal::Null { argument }),
        // SAFETY: the caller's promise.
        _ => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// A place for one result.
///
/// # Safety
/// NULL or valid and used by nobody else while the reference lives.
unsafe fn place<'a, T>(pointer: *mut T, argument: &'static str) -> Result<&'a mut T, Refusal> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_mut() }.ok_or(Refusal::Null { argument })
}

/// A master's string.
///
/// # Safety
/// NULL or ending with a zero byte, unchanged while the result lives.
unsafe fn text<'a>(pointer: Text, argument: &'static str) -> Result<&'a str, Refusal> {
    if pointer.is_null() {
        return Err(Refusal::Null { argument });
    }
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(pointer) }.to_str().map_err(|_| Refusal::Text { argument })
}

/// Platform of the types: the default ones.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

/// Version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

/// Turns logging on or off, by category.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: Handle,
    loggingOn: Boolean,
    nCategories: usize,
    categories: *const Text,
) -> Status {
    with(c, "fmi2SetDebugLogging", |instance| {
        // SAFETY: an array of the master's strings.
        let categories = unsafe { array(categories, nCategories, "categories") }?;
        // SAFETY: each a string of the master's.
        let categories = categories.iter().map(|category| unsafe { text(*category, "category") });
        instance.set_debug_logging(loggingOn != 0, &categories.collect::<Result<Vec<_>, _>>()?)
    })
}

/// Makes an instance; NULL (and a message) if that is not possible.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: Text,
    fmuType: c_int,
    fmuGUID: Text,
    fmuResourceLocation: Text,
    functions: *const CallbackFunctions,
    _visible: Boolean,
    loggingOn: Boolean,
) -> Handle {
    // SAFETY: NULL or the master's callbacks, which are copied.
    let callbacks = unsafe { functions.as_ref() }.copied();
    let logger = callbacks.and_then(|callbacks| callbacks.logger);
    let environment = callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.component_environment);
    // SAFETY: a string of the master's.
    let name = unsafe { text(instanceName, "instanceName") };
    let log = Log { logger, environment, name: CString::new(*name.as_ref().unwrap_or(&"moorline")).unwrap_or_default() };
    // The standard wants a logger; without one nobody would be told why a call was refused. The memory functions are not used, and masters
    // leave them out.
    if logger.is_none() {
        return std::ptr::null_mut();
    }
    let instance = guarded(|| {
        if name?.is_empty() {
            return Err(Refusal::Instantiate("instanceName is empty".to_owned()));
        }
        if fmuType != CO_SIMULATION {
            return Err(Refusal::Instantiate(format!(
                "fmuType {fmuType} is not fmi2CoSimulation (1), the only type of this FMU"
            )));
        }
        // SAFETY: strings of the master's.
        let guid = unsafe { text(fmuGUID, "fmuGUID")? };
        let location = if fmuResourceLocation.is_null() {
            None
        } else {
            // SAFETY: likewise.
            Some(unsafe { text(fmuResourceLocation, "fmuResourceLocation")? })
        };
        Instance::new(guid, location, own_place::resources(), loggingOn != 0)
    });
    match instance {
        Ok(instance) => Box::into_raw(Box::new(Component { instance, log })).cast(),
        Err(refusal) => {
            log.status("fmi2Instantiate", Err(refusal));
            std::ptr::null_mut()
        }
    }
}

/// Frees an instance and all it handed out; NULL is nothing to free.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: Handle) {
    if !c.is_null() {
        // SAFETY: made by `Box::into_raw` in fmi2Instantiate, and the master does not use it again.
        let component = unsafe { Box::from_raw(c.cast::<Component>()) };
        let _ = guarded(|| {
            drop(component);
            Ok(())
        });
    }
}

/// Start, stop and tolerance.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: Handle,
    toleranceDefined: Boolean,
    tolerance: f64,
    startTime: f64,
    stopTimeDefined: Boolean,
    stopTime: f64,
) -> Status {
    with(c, "fmi2SetupExperiment", |instance| {
        let tolerance = (toleranceDefined != 0).then_some(tolerance);
        instance.setup_experiment(tolerance, startTime, (stopTimeDefined != 0).then_some(stopTime))
    })
}

/// Enters initialization mode.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: Handle) -> Status {
    with(c, "fmi2EnterInitializationMode", Instance::enter_initialization)
}

/// Puts the line in equilibrium and leaves initialization mode.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: Handle) -> Status {
    with(c, "fmi2ExitInitializationMode", Instance::exit_initialization)
}

/// Ends the simulation.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: Handle) -> Status {
    with(c, "fmi2Terminate", Instance::terminate)
}

/// Back to the state after instantiation.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: Handle) -> Status {
    with(c, "fmi2Reset", |instance| {
        instance.reset();
        Ok(())
    })
}

/// Reads Real variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Handle, vr: *const ValueReference, nvr: usize, value: *mut f64) -> Status {
    with(c, "fmi2GetReal", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, values) = unsafe { (array(vr, nvr, "vr")?, array_mut(value, nvr, "value")?) };
        instance.get(Kind::Real, references, values)
    })
}

/// Reads Integer and Enumeration variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(c: Handle, vr: *const ValueReference, nvr: usize, value: *mut c_int) -> Status {
    with(c, "fmi2GetInteger", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, values) = unsafe { (array(vr, nvr, "vr")?, array_mut(value, nvr, "value")?) };
        let mut numbers = vec![0.0; nvr];
        instance.get(Kind::Integer, references, &mut numbers)?;
        values.iter_mut().zip(numbers).for_each(|(value, number)| *value = number as c_int);
        Ok(())
    })
}

/// There are no Boolean variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(c: Handle, vr: *const ValueReference, nvr: usize, _value: *mut Boolean) -> Status {
    // SAFETY: the master's array.
    with(c, "fmi2GetBoolean", |_| none(unsafe { array(vr, nvr, "vr") }?, "Boolean"))
}

/// There are no String variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(c: Handle, vr: *const ValueReference, nvr: usize, _value: *mut Text) -> Status {
    // SAFETY: the master's array.
    with(c, "fmi2GetString", |_| none(unsafe { array(vr, nvr, "vr") }?, "String"))
}

/// Sets Real variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(c: Handle, vr: *const ValueReference, nvr: usize, value: *const f64) -> Status {
    with(c, "fmi2SetReal", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, values) = unsafe { (array(vr, nvr, "vr")?, array(value, nvr, "value")?) };
        instance.set(Kind::Real, references, values)
    })
}

/// Sets Integer and Enumeration variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(c: Handle, vr: *const ValueReference, nvr: usize, value: *const c_int) -> Status {
    with(c, "fmi2SetInteger", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, values) = unsafe { (array(vr, nvr, "vr")?, array(value, nvr, "value")?) };
        instance.set(Kind::Integer, references, &values.iter().map(|value| f64::from(*value)).collect::<Vec<_>>())
    })
}

/// There are no Boolean variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(c: Handle, vr: *const ValueReference, nvr: usize, _value: *const Boolean) -> Status {
    // SAFETY: the master's array.
    with(c, "fmi2SetBoolean", |_| none(unsafe { array(vr, nvr, "vr") }?, "Boolean"))
}

/// There are no String variables.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(c: Handle, vr: *const ValueReference, nvr: usize, _value: *const Text) -> Status {
    // SAFETY: the master's array.
    with(c, "fmi2SetString", |_| none(unsafe { array(vr, nvr, "vr") }?, "String"))
}

/// No reference is one of a type of which there are no variables.
fn none(references: &[ValueReference], kind: &'static str) -> Result<(), Refusal> {
    references.first().map_or(Ok(()), |reference| Err(Refusal::UnknownReference { reference: *reference, kind }))
}

/// Takes the state; a handle that is not NULL is used again.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Handle, FMUstate: *mut StateHandle) -> Status {
    with(c, "fmi2GetFMUstate", |instance| {
        // SAFETY: a handle of the master's.
        let handle = unsafe { place(FMUstate, "FMUstate") }?;
        *handle = std::ptr::without_provenance_mut(instance.get_state(handle.addr())?);
        Ok(())
    })
}

/// Goes back to a state.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: Handle, FMUstate: StateHandle) -> Status {
    with(c, "fmi2SetFMUstate", |instance| {
        if FMUstate.is_null() { Err(Refusal::Null { argument: "FMUstate" }) } else { instance.set_state(FMUstate.addr()) }
    })
}

/// Frees a state and makes its handle NULL; a handle that is NULL is nothing to free.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Handle, FMUstate: *mut StateHandle) -> Status {
    with(c, "fmi2FreeFMUstate", |instance| {
        // SAFETY: NULL or a handle of the master's.
        let Some(handle) = (unsafe { FMUstate.as_mut() }).filter(|handle| !handle.is_null()) else { return Ok(()) };
        instance.free_state(handle.addr())?;
        *handle = std::ptr::null_mut();
        Ok(())
    })
}

/// Bytes that a serialized state needs.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Handle, FMUstate: StateHandle, size: *mut usize) -> Status {
    with(c, "fmi2SerializedFMUstateSize", |instance| {
        // SAFETY: a number of the master's.
        *unsafe { place(size, "size") }? = instance.serialized(FMUstate.addr())?.len();
        Ok(())
    })
}

/// Writes a state as bytes.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: Handle,
    FMUstate: StateHandle,
    serializedState: *mut u8,
    size: usize,
) -> Status {
    with(c, "fmi2SerializeFMUstate", |instance| {
        let bytes = instance.serialized(FMUstate.addr())?;
        // SAFETY: the master's buffer of `size` bytes.
        let buffer = unsafe { array_mut(serializedState, size, "serializedState") }?;
        let needed = bytes.len();
        buffer.get_mut(..needed).ok_or(Refusal::Buffer { given: size, needed })?.copy_from_slice(&bytes);
        Ok(())
    })
}

/// Reads a state from bytes, under a new handle.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: Handle,
    serializedState: *const u8,
    size: usize,
    FMUstate: *mut StateHandle,
) -> Status {
    with(c, "fmi2DeSerializeFMUstate", |instance| {
        // SAFETY: the master's buffer of `size` bytes, and a handle of the master's.
        let (bytes, handle) = unsafe { (array(serializedState, size, "serializedState")?, place(FMUstate, "FMUstate")?) };
        *handle = std::ptr::without_provenance_mut(instance.deserialize(bytes)?);
        Ok(())
    })
}

/// Change of outputs at the end of the next step along a direction of the inputs.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: Handle,
    vUnknown_ref: *const ValueReference,
    nUnknown: usize,
    vKnown_ref: *const ValueReference,
    nKnown: usize,
    dvKnown: *const f64,
    dvUnknown: *mut f64,
) -> Status {
    with(c, "fmi2GetDirectionalDerivative", |instance| {
        // SAFETY: the master's arrays of nUnknown and nKnown elements.
        let (unknowns, result) =
            unsafe { (array(vUnknown_ref, nUnknown, "vUnknown_ref")?, array_mut(dvUnknown, nUnknown, "dvUnknown")?) };
        // SAFETY: as above.
        let (knowns, seeds) = unsafe { (array(vKnown_ref, nKnown, "vKnown_ref")?, array(dvKnown, nKnown, "dvKnown")?) };
        let changes = instance.directional_derivative(unknowns, knowns, seeds)?;
        result.iter_mut().zip(changes).for_each(|(value, change)| *value = change);
        Ok(())
    })
}

/// Sets time derivatives of inputs for the next step.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: Handle,
    vr: *const ValueReference,
    nvr: usize,
    order: *const c_int,
    value: *const f64,
) -> Status {
    with(c, "fmi2SetRealInputDerivatives", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, orders, values) =
            unsafe { (array(vr, nvr, "vr")?, array(order, nvr, "order")?, array(value, nvr, "value")?) };
        instance.set_input_derivatives(references, orders, values)
    })
}

/// Reads time derivatives of outputs.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: Handle,
    vr: *const ValueReference,
    nvr: usize,
    order: *const c_int,
    value: *mut f64,
) -> Status {
    with(c, "fmi2GetRealOutputDerivatives", |instance| {
        // SAFETY: the master's arrays of nvr elements.
        let (references, orders, values) =
            unsafe { (array(vr, nvr, "vr")?, array(order, nvr, "order")?, array_mut(value, nvr, "value")?) };
        instance.output_derivatives(references, orders, values)
    })
}

/// Advances by a step.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: Handle,
    currentCommunicationPoint: f64,
    communicationStepSize: f64,
    _noSetFMUStatePriorToCurrentPoint: Boolean,
) -> Status {
    with(c, "fmi2DoStep", |instance| instance.do_step(currentCommunicationPoint, communicationStepSize))
}

/// Steps are synchronous: there is never one to cancel.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: Handle) -> Status {
    with(c, "fmi2CancelStep", |_| Err(Refusal::NothingToCancel))
}

/// How the last step ended (`fmi2DoStepStatus`).
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: Handle, s: c_int, value: *mut Status) -> Status {
    with(c, "fmi2GetStatus", |instance| {
        only(s, Some(DO_STEP_STATUS))?;
        // SAFETY: a status of the master's.
        *unsafe { place(value, "value") }? = match instance.step_status()? {
            StepStatus::Done => OK,
            StepStatus::Discarded => DISCARD,
            StepStatus::Failed => ERROR,
        };
        Ok(())
    })
}

/// The time up to which the line was computed (`fmi2LastSuccessfulTime`).
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Handle, s: c_int, value: *mut f64) -> Status {
    with(c, "fmi2GetRealStatus", |instance| {
        only(s, Some(LAST_SUCCESSFUL_TIME))?;
        // SAFETY: a number of the master's.
        *unsafe { place(value, "value") }? = instance.last_successful_time()?;
        Ok(())
    })
}

/// There is no status of this type.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: Handle, s: c_int, _value: *mut c_int) -> Status {
    with(c, "fmi2GetIntegerStatus", |_| only(s, None))
}

/// Whether the FMU wants to end the simulation (`fmi2Terminated`): never.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Handle, s: c_int, value: *mut Boolean) -> Status {
    with(c, "fmi2GetBooleanStatus", |instance| {
        only(s, Some(TERMINATED))?;
        instance.step_status()?;
        // SAFETY: a Boolean of the master's.
        *unsafe { place(value, "value") }? = 0;
        Ok(())
    })
}

/// There is no pending step that would have something to tell.
///
/// # Safety
/// As the standard demands: see the head of the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(c: Handle, s: c_int, _value: *mut Text) -> Status {
    with(c, "fmi2GetStringStatus", |_| only(s, None))
}

/// Whether a kind of status is the one that there is.
fn only(kind: c_int, available: Option<c_int>) -> Result<(), Refusal> {
    match kind {
        _ if Some(kind) == available => Ok(()),
        DO_STEP_STATUS | PENDING_STATUS | LAST_SUCCESSFUL_TIME | TERMINATED => Err(Refusal::NoStatus),
        _ => Err(Refusal::StatusKind(kind)),
    }
}
