//! Handles: numbers in the shape of pointers, never dereferenced and never given twice. One that was closed, or never was one, is found out.

use crate::failure::{Failure, Outcome};
use crate::system::System;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock};

/// What a program holds in its hands.
pub type Handle = *mut c_void;

/// What a handle is of, with its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Item {
    /// The mooring itself.
    System,
    /// A line.
    Line(usize),
    /// A point.
    Point(usize),
    /// A body.
    Body(usize),
    /// A rod.
    Rod(usize),
    /// The water.
    Waves,
    /// The bed.
    Seafloor,
}

/// A mooring that several threads may hold.
type Shared = Arc<Mutex<System>>;

#[derive(Default)]
struct Register {
    /// The last handle given.
    last: usize,
    entries: BTreeMap<usize, (Shared, Item)>,
    handles: BTreeMap<(usize, Item), usize>,
}

static REGISTER: RwLock<Option<Register>> = RwLock::new(None);
/// Handles are multiples of this, as addresses of objects are.
const APART: usize = 16;

fn poisoned<T>(error: PoisonError<T>) -> T {
    error.into_inner()
}

/// Where a mooring lies, which tells it from others.
fn place(system: &Shared) -> usize {
    Arc::as_ptr(system).addr()
}

/// Takes in a mooring; its handle.
pub fn enter(system: System) -> Handle {
    let counts = [system.rig.lines.len(), system.rig.points.len(), system.rig.bodies.len(), system.rig.rods.len()];
    let kinds: [fn(usize) -> Item; 4] = [Item::Line, Item::Point, Item::Body, Item::Rod];
    let parts = kinds.into_iter().zip(counts).flat_map(|(kind, count)| (0..count).map(kind));
    let items = [Item::System, Item::Waves, Item::Seafloor].into_iter().chain(parts);
    let shared = Arc::new(Mutex::new(system));
    let mut register = REGISTER.write().unwrap_or_else(poisoned);
    let register = register.get_or_insert_default();
    let first = register.last + APART;
    for item in items {
        register.last += APART;
        register.entries.insert(register.last, (Arc::clone(&shared), item));
        register.handles.insert((place(&shared), item), register.last);
    }
    std::ptr::without_provenance_mut(first)
}

/// The mooring and the thing behind a handle.
pub fn find(handle: Handle) -> Outcome<(Shared, Item)> {
    if handle.is_null() {
        return Err(Failure::invalid("the handle is NULL"));
    }
    let register = REGISTER.read().unwrap_or_else(poisoned);
    let entry = register.as_ref().and_then(|register| register.entries.get(&handle.addr()));
    entry.cloned().ok_or_else(|| Failure::invalid("the handle is of nothing that was created, or that was closed"))
}

/// The handle of a part of a mooring.
pub fn handle_of(system: &Shared, item: Item) -> Handle {
    let register = REGISTER.read().unwrap_or_else(poisoned);
    let found = register.as_ref().and_then(|register| register.handles.get(&(place(system), item)));
    found.map_or(std::ptr::null_mut(), |handle| std::ptr::without_provenance_mut(*handle))
}

/// Lets go of a mooring and of all its parts.
pub fn leave(system: &Shared) {
    let mut register = REGISTER.write().unwrap_or_else(poisoned);
    if let Some(register) = register.as_mut() {
        register.entries.retain(|_, (other, _)| !Arc::ptr_eq(other, system));
        register.handles.retain(|(other, _), _| *other != place(system));
    }
}

/// The mooring itself, for one thread at a time.
pub fn locked(system: &Shared) -> MutexGuard<'_, System> {
    system.lock().unwrap_or_else(poisoned)
}
