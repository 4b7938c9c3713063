//! The motion at which forces are asked for, and the weights of their tangent.

use crate::rod::state::Field;
use crate::sea::clock::Clock;
use nalgebra::Matrix3;

/// What a question about forces has to do with the one before.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Asking {
    /// Nothing: the water is asked for its motion where the line is, and what a stage keeps of it stays as it is.
    #[default]
    Alone,
    /// It is the first of a stage.
    First,
    /// It is of the same stage, and of the same time.
    Again,
}

/// The motion at which forces are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// When.
    pub clock: Clock,
    /// Positions and slopes.
    pub u: &'a Field,
    /// Their rates.
    pub v: &'a Field,
    /// Their second rates.
    pub a: &'a Field,
    /// Places of the bed to which the line holds on by friction.
    pub holds: &'a Field,
    /// Rotations from which the rotation vectors of free bodies count.
    pub frames: &'a [Matrix3<f64>],
    /// What the question has to do with the one before.
    pub asking: Asking,
}

/// Weights of the tangent: c_u ∂R/∂u + c_v ∂R/∂v + c_a ∂R/∂a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// c_u.
    pub u: f64,
    /// c_v.
    pub v: f64,
    /// c_a.
    pub a: f64,
}
