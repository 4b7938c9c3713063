//! Equilibrium of a network by Newton's method on all of it at once: lines, bodies and points in one step.
//!
//! The geometric part of the tangent has the tension predicted to first order from the last step, as in the statics of a line: a stiff line that is
//! moved across stretches by the square of the way, and a method that looks at the stretched line next has lost its direction. Enough for most
//! networks, and a start for the rest; whether what it finds is an equilibrium, and a stable one, is seen by settling each line there.

use super::Group;
use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::rod::system::System;
use crate::solve::newton::motion;
use crate::solve::turn::{self, LONGEST_STEP};

/// Iterations at most.
const ITERATIONS: usize = 40;
/// Step of the unknowns that is next to nothing [-].
const LITTLE: f64 = 1.0e-9;

impl Group {
    /// Goes from a state to one in which nothing moves any more; none where that leads nowhere.
    pub(super) fn approach(&mut self, from: &State) -> Option<State> {
        let mut state = from.clone();
        let mut tension = vec![0.0; 3 * self.network.rod.mesh().elements.len()];
        self.network.rod.tensions(&state.u, &state.v, &mut tension);
        let mut step = Field::new(self.network.nodes());
        let length = self.demands.criteria.length;
        for _ in 0..ITERATIONS {
            let weights = Weights { u: 1.0, v: 0.0, a: 0.0 };
            self.newton.factor(&self.network, &motion(&state), &weights, Some(&tension)).ok()?;
            self.network.gathered(&motion(&state), &mut step);
            self.newton.solve_linear(&self.network, &mut step);
            let turn = turn::largest(&step, length);
            if !turn.is_finite() {
                return None;
            }
            let scale = -(LONGEST_STEP / turn).min(1.0).min(self.sensible(&self.of_masters(&step), 1.0));
            step.data_mut().iter_mut().for_each(|x| *x *= scale);
            self.network.rod.linear_tensions(&state.u, &step, &mut tension);
            state.u.add(1.0, &step);
            self.network.follow(&mut state);
            self.network.recentre(&mut state);
            if turn < LITTLE {
                return Some(state);
            }
        }
        None
    }
}
