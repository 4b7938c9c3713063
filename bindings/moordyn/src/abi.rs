//! The C functions: they translate and decide nothing.
//!
//! What every `unsafe` block relies on is what MoorDyn's headers ask of a program: a text is NULL or ends with a zero byte, and an array is NULL
//! or as long as its parameter says. NULL is always checked. Handles are numbers that are looked up, never dereferenced.
//!
//! A panic never crosses: it is caught, told to the log and returned as the number of all that is not foreseen.

pub mod body;
pub mod environment;
pub mod line;
pub mod older;
pub mod point;
pub mod rod;
pub mod system;

use crate::failure::{Failure, Outcome, SUCCESS, UNHANDLED_ERROR};
use crate::log;
use crate::registry::{self, Handle, Item};
use crate::system::System;
use nalgebra::{Matrix3, Vector3};
use std::ffi::{CStr, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a function returns for an outcome; a failure is told on the terminal.
fn returned(function: &str, outcome: Outcome) -> c_int {
    match outcome {
        Ok(()) => SUCCESS,
        Err(failure) => {
            log::Log::default().tell(log::ERROR, &format!("{function}: {}", failure.reason));
            failure.code
        }
    }
}

/// Runs a body; a panic in it is a failure.
fn guarded<T>(body: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(Failure::new(UNHANDLED_ERROR, format!("a fault of the program: {text}")))
    })
}

/// Runs a body on the mooring behind a handle of a kind; what it refuses stands in the mooring's log.
fn on(
    function: &str,
    handle: Handle,
    kind: fn(Item) -> Option<usize>,
    body: impl FnOnce(&mut System, usize) -> Outcome,
) -> c_int {
    let found = guarded(|| {
        let (shared, item) = registry::find(handle)?;
        let index = kind(item).ok_or_else(|| Failure::invalid("the handle is of a thing of another kind"))?;
        Ok((shared, index))
    });
    let (shared, index) = match found {
        Ok(found) => found,
        Err(failure) => return returned(function, Err(failure)),
    };
    let mut system = registry::locked(&shared);
    match guarded(|| body(&mut system, index)) {
        Ok(()) => SUCCESS,
        Err(failure) => {
            if failure.code == UNHANDLED_ERROR && failure.reason.starts_with("a fault of the program") {
                system.fail();
            }
            system.log.tell(log::ERROR, &format!("{function}: {}", failure.reason));
            failure.code
        }
    }
}

/// Kinds of handles.
fn whole(item: Item) -> Option<usize> {
    (item == Item::System).then_some(0)
}

/// See `whole`.
fn line(item: Item) -> Option<usize> {
    if let Item::Line(index) = item { Some(index) } else { None }
}

/// See `whole`.
fn point(item: Item) -> Option<usize> {
    if let Item::Point(index) = item { Some(index) } else { None }
}

/// See `whole`.
fn body(item: Item) -> Option<usize> {
    if let Item::Body(index) = item { Some(index) } else { None }
}

/// See `whole`.
fn rod(item: Item) -> Option<usize> {
    if let Item::Rod(index) = item { Some(index) } else { None }
}

/// A text of the program.
fn text<'a>(from: *const c_char) -> Outcome<&'a str> {
    if from.is_null() {
        return Err(Failure::invalid("the text is NULL"));
    }
    // SAFETY: not NULL, so it ends with a zero byte (see the head of the file) and lives as long as the call, in which it is used.
    let text = unsafe { CStr::from_ptr(from) };
    text.to_str().map_err(|_| Failure::invalid("the text is not UTF-8"))
}

/// Numbers of the program.
fn numbers<'a>(what: &str, from: *const f64, count: usize) -> Outcome<&'a [f64]> {
    if count == 0 {
        return Ok(&[]);
    }
    if from.is_null() {
        return Err(Failure::invalid(format!("{what} is NULL, but has {count} components")));
    }
    // SAFETY: not NULL, so it holds as many numbers as its parameter says (see the head of the file), for the time of the call.
    Ok(unsafe { std::slice::from_raw_parts(from, count) })
}

/// One of several values of the program.
fn taken<T: Copy>(what: &str, from: *const T, index: usize) -> Outcome<T> {
    if from.is_null() {
        return Err(Failure::invalid(format!("{what} is NULL")));
    }
    // SAFETY: not NULL, so it holds as many values as its parameter says (see the head of the file), of which the caller asks for one.
    Ok(unsafe { from.add(index).read_unaligned() })
}

/// Gives a value to the program.
fn give<T>(to: *mut T, value: T) -> Outcome {
    if to.is_null() {
        return Err(Failure::invalid("the place for the result is NULL"));
    }
    // SAFETY: not NULL, so it is a place for one such value (see the head of the file); whether it is aligned is not relied on.
    unsafe { to.write_unaligned(value) };
    Ok(())
}

/// Gives values to the program, in a place for as many.
fn give_all<T: Copy>(to: *mut T, values: &[T]) -> Outcome {
    if values.is_empty() {
        return Ok(());
    }
    if to.is_null() {
        return Err(Failure::invalid(format!("the place for {} results is NULL", values.len())));
    }
    for (index, value) in values.iter().enumerate() {
        // SAFETY: not NULL, so it is a place for all of them (see the head of the file), one after the other.
        unsafe { to.add(index).write_unaligned(*value) };
    }
    Ok(())
}

/// Gives a vector.
fn give_vector(to: *mut f64, vector: Vector3<f64>) -> Outcome {
    give_all(to, vector.as_slice())
}

/// Gives a symmetric matrix, row by row.
fn give_matrix(to: *mut f64, matrix: Matrix3<f64>) -> Outcome {
    give_all(to, matrix.as_slice())
}

/// What a function without a meaning here says.
fn without_meaning(reason: &'static str) -> impl FnOnce(&mut System, usize) -> Outcome {
    move |_, _| Err(Failure::without_meaning(reason))
}
