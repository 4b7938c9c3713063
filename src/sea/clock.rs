//! The time of a state, and the time from which waves are eased in.

/// When a state is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clock {
    /// Time [s].
    pub now: f64,
    /// Time of the static equilibrium from which the line was set in motion [s]: the sea is calm until then.
    pub start: f64,
}

impl Clock {
    /// The moment of statics at a time.
    pub fn at_rest(now: f64) -> Clock {
        Clock { now, start: now }
    }
}
