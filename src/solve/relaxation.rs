//! Statics as motion without swing: linearised steps of backward Euler, each from rest (pseudo-transient continuation, Kelley & Keyes 1998).
//!
//! ```text
//! (∂R/∂u + 1/h ∂R/∂v + 1/h² ∂R/∂a) x = -R(u, 0, 0),   u ← u + x
//! ```
//!
//! Inertia and drag hold a line that has no stiffness of its own yet (slack, weightless, drifting with a current), so that it moves
//! as a real line would, only without swing. The geometric part of the stiffness uses the tension predicted to first order from the
//! last step, as in the direct attempt of statics: a stiff line then turns by a tenth in one step, where a search along the step
//! would stop at the first stretch. h is governed by how far the line turns, and a step of h = ∞ is Newton's method.

use crate::rod::line::Line;
use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::solve::newton::{Newton, motion};
use crate::solve::turn::{self, LONGEST_STEP};

/// Turn per step that h is chosen for [-].
const TURN: f64 = 0.1;
/// Bounds of the ratio of h to the one before.
const CHANGE: [f64; 2] = [0.25, 1.3];
/// The same after a step that could not be made.
const SHORTER: f64 = 0.1;

/// Shortening of a step whose matrix is not positive definite, and how often before it is taken as it is.
const SOFTER: f64 = 0.4;
const SHORTENINGS: usize = 40;

/// A line on its way to rest.
pub struct Relaxation {
    h: f64,
    /// Steps are so short that their matrix is positive definite: they lead down from an unstable equilibrium instead of into it.
    downwards: bool,
    tension: Vec<f64>,
    step: Field,
    from: Field,
}

impl Relaxation {
    /// Begins from a state with a step of `h` [s]; `downwards`: to a stable equilibrium alone, where the line has an energy.
    pub fn new(line: &dyn Line, state: &State, h: f64, downwards: bool) -> Relaxation {
        let nodes = line.mesh().nodes();
        let mut tension = vec![0.0; 3 * line.mesh().elements.len()];
        line.tensions(&state.u, &state.v, &mut tension);
        Relaxation { h, downwards, tension, step: Field::new(nodes), from: Field::new(nodes) }
    }

    /// Makes a step from a state whose residual is given.
    pub fn step(&mut self, line: &dyn Line, newton: &mut Newton, residual: &Field, state: &mut State) {
        let weights = |h: f64| Weights { u: 1.0, v: 1.0 / h, a: 1.0 / (h * h) };
        if self.downwards {
            let across = turn::across(&state.u, line.mesh().length);
            let mut shortenings = 0;
            while shortenings < SHORTENINGS
                && !newton.is_definite(line, &motion(state), &weights(self.h), Some(&self.tension), across)
            {
                self.h *= SOFTER;
                shortenings += 1;
            }
        }
        let weights = weights(self.h);
        let factored = newton.factor(line, &motion(state), &weights, Some(&self.tension)).is_ok();
        self.from.copy_from(&state.u);
        self.step.copy_from(residual);
        newton.solve_linear(line, &mut self.step);
        let turn = turn::largest(&self.step, line.mesh().length);
        if !factored || !turn.is_finite() {
            self.h *= SHORTER;
            return;
        }
        let scale = -(LONGEST_STEP / turn).min(1.0);
        self.step.data_mut().iter_mut().for_each(|x| *x *= scale);
        line.linear_tensions(&state.u, &self.step, &mut self.tension);
        state.u.set_sum([(1.0, &self.from), (1.0, &self.step)]);
        self.h *= (TURN / turn).clamp(CHANGE[0], CHANGE[1]);
    }

    /// Takes the last step back.
    pub fn undo(&mut self, state: &mut State) {
        state.u.copy_from(&self.from);
        self.h *= SHORTER;
    }
}
