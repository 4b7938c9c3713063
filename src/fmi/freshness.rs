//! Whether an input was set anew, or is held by a master that steps the line more often than the vessel.
//!
//! An input that is equal to the last one, to the bit, while the fairlead moves is stale: the vessel has not been computed since. How long a value may be
//! held is learnt from how long values were held before: up to 1.5 times the longest of the last eight times, or
//! for ten steps as long as nothing is known. A value that is held for longer is meant: the fairlead stands still. So a fairlead that comes
//! to rest is seen to be at rest within two of the vessel's steps, at once where its velocity is zero.

/// Times remembered between values that were set anew.
const REMEMBERED: usize = 8;
/// A value is stale for this many of the longest of these times.
const PATIENCE: f64 = 1.5;
/// Steps for which a value is stale as long as no such time is known.
const FIRST_STEPS: f64 = 10.5;
/// A rest no longer than this many of the longest of these times was one of them.
const LONGER: f64 = 4.0;

/// Times between values are alike where the shortest is this share of the longest.
const REGULAR: f64 = 0.95;

/// When a value was last set anew, and how long it was held before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Age {
    /// When it was set [s].
    pub since: f64,
    /// Times between values [s], the newest first; 0: none.
    pub intervals: [f64; REMEMBERED],
    /// It is meant to be what it is, for as long as it does not change.
    pub meant: bool,
}

impl Age {
    /// Of a value that is set for the first time.
    pub fn new(time: f64) -> Age {
        Age { since: time, intervals: [0.0; REMEMBERED], meant: false }
    }

    fn longest(&self) -> f64 {
        self.intervals.iter().copied().fold(0.0, f64::max)
    }

    /// Whether a value that has not changed up to a time is meant; `step`: length of the step there [s].
    pub fn is_meant(&self, time: f64, step: f64) -> bool {
        let patience = match self.longest() {
            0.0 => FIRST_STEPS * step,
            longest => PATIENCE * longest,
        };
        self.meant || time - self.since > patience
    }

    /// Whether a time is before the one at which a new value is expected.
    pub fn is_early(&self, time: f64) -> bool {
        !self.meant && time - self.since < REGULAR * self.intervals[0]
    }

    /// Whether values were held for times that differ: more than a master's clock may be off.
    pub fn is_irregular(&self) -> bool {
        let known = self.intervals.iter().copied().filter(|interval| *interval > 0.0);
        known.fold(f64::INFINITY, f64::min) < REGULAR * self.longest()
    }

    /// How long the last value was held, if a new one is set now [s]; 0 after a rest.
    pub fn held_last(&self, time: f64) -> f64 {
        if self.meant { 0.0 } else { (time - self.since).min(self.longest()) }
    }

    /// The value was set anew at a time.
    pub fn renew(&mut self, time: f64) {
        let held = time - self.since;
        if held > 0.0 && (!self.meant || held <= LONGER * self.longest()) {
            self.intervals.rotate_right(1);
            self.intervals[0] = held;
        }
        (self.since, self.meant) = (time, false);
    }
}

/// The pace of a vessel whose points are not all points of the line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pace {
    /// Time of its last values [s].
    pub last: f64,
    /// Times between its values [s], the newest first; 0: none.
    pub intervals: [f64; REMEMBERED],
    /// Values since the last step that had none, counted down from as many as are remembered.
    pub slower: u32,
}

impl Pace {
    /// Whether the line was stepped without new values of late.
    pub fn is_slower(&self) -> bool {
        self.slower > 0
    }

    /// Whether it is hardly known.
    pub fn is_new(&self) -> bool {
        self.intervals[2] == 0.0
    }

    /// The line is stepped without new values.
    pub fn wait(&mut self) {
        self.slower = REMEMBERED as u32;
    }

    /// When its next values are due [s].
    pub fn next(&self) -> f64 {
        let count = self.intervals.iter().filter(|interval| **interval > 0.0).count().max(1);
        self.last + self.intervals.iter().sum::<f64>() / count as f64
    }

    /// It had values at a time.
    pub fn go(&mut self, time: f64) {
        if time > self.last {
            self.intervals.rotate_right(1);
            self.intervals[0] = time - self.last;
        }
        self.last = time;
        self.slower = self.slower.saturating_sub(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patience_is_learnt_and_a_rest_is_not_mistaken_for_it() {
        let mut age = Age::new(0.0);
        assert!(!age.is_meant(1.0, 0.1) && age.is_meant(1.1, 0.1));
        for k in 1..5 {
            age.renew(0.1 * f64::from(k));
        }
        assert!(!age.is_meant(0.54, 0.02) && age.is_meant(0.56, 0.02));
        age.meant = true;
        age.renew(30.0);
        assert!(!age.is_meant(30.14, 0.02) && age.is_meant(30.16, 0.02));
        // The vessel's step becomes longer: learnt, too.
        age.meant = true;
        age.renew(30.3);
        assert!(!age.is_meant(30.7, 0.02));
    }
}
