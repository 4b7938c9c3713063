//! Statics as motion without swing: backward Euler steps, each from rest.
//!
//! ```text
//! R(u + x, x/h, x/h²) = 0,   u ← u + x,   v ← 0
//! ```
//!
//! Inertia and drag hold a line that has no stiffness of its own yet (slack, weightless, drifting with a current), so that every
//! step has a solution near by; energy only falls, since what the line gains in speed is dropped after every step. h grows while
//! steps succeed, and a step of h = ∞ is Newton's method on statics.

use crate::rod::element::Weights;
use crate::rod::line::Line;
use crate::rod::state::State;
use crate::solve::newton::{Criteria, Newton};

/// h after a step that was solved, as a multiple of the one before.
const LONGER: f64 = 4.0;
/// The same after a step that was not.
const SHORTER: f64 = 0.125;
/// Shares of the first h between which h stays.
const RANGE: [f64; 2] = [1e-7, 1e7];

/// A line on its way to rest.
pub struct Relaxation {
    criteria: Criteria,
    first: f64,
    h: f64,
    trial: State,
}

impl Relaxation {
    /// Begins with steps of `h` [s].
    pub fn new(line: &dyn Line, h: f64) -> Relaxation {
        let mesh = line.mesh();
        let criteria = Criteria { tolerance: 1e-8, length: mesh.length, iterations: 12 };
        Relaxation { criteria, first: h, h, trial: State::new(mesh.nodes()) }
    }

    /// Tries a step; false once steps have become too short to go on.
    pub fn step(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State) -> bool {
        let weights = Weights { u: 1.0, v: 1.0 / self.h, a: 1.0 / (self.h * self.h) };
        self.trial.copy_from(state);
        newton.forget();
        let solved = newton.solve(line, &weights, &mut self.trial, &self.criteria).is_ok();
        // A search that ran out of iterations stopped where the energy was less, which is as good a place to start from.
        if solved || self.trial.u.numbers().all(|x| x.is_finite()) {
            state.u.copy_from(&self.trial.u);
        }
        self.h = (self.h * if solved { LONGER } else { SHORTER }).min(RANGE[1] * self.first);
        self.h > RANGE[0] * self.first
    }
}
