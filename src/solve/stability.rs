//! Whether an equilibrium is stable, and the way out of one that is not.
//!
//! ```text
//! stable:  ½ (K + Kᵀ) + ε M  is positive definite,   K = ∂R/∂u with what is prescribed taken out
//! ```
//!
//! M is the inertia of the line with the water moved along, so that -ε bounds the square of the rate [1/s] at which a small deviation
//! could grow: ε is so small that what rounding makes of a neutral direction (a bight may turn about a plumb line) does not count.
//! Positive definite is what block elimination leaves of every diagonal block (Sylvester's law of inertia; Cholesky's pivots are all
//! positive). Friction and drag do not count: the line asked is one without them.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::algebra::definite::is_positive_definite;
use crate::rod::line::Line;
use crate::rod::motion::Weights;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::solve::newton::{Newton, motion};
use crate::solve::turn;

/// ε as a share of weight / (mass · length).
const NEUTRAL: f64 = 1.0e-4;
/// How closely the rate of the least stable deviation is known.
const CLOSE: f64 = 1.3;
/// Steps of the inverse iteration that finds it.
const ITERATIONS: usize = 6;

/// Whether a line in equilibrium is stable; `unit` is weight / (mass · length) [1/s²].
pub fn is_stable(line: &dyn Line, state: &State, unit: f64) -> bool {
    holds(line, state, NEUTRAL * unit, &mut BlockTridiagonal::new(line.mesh().ties()))
}

/// The deviation that grows fastest from an equilibrium, with largest turn 1; none from a stable one.
pub fn way_out(line: &dyn Line, newton: &mut Newton, state: &State, unit: f64) -> Option<Field> {
    let matrix = &mut BlockTridiagonal::new(line.mesh().ties());
    let mut low = NEUTRAL * unit;
    if holds(line, state, low, matrix) {
        return None;
    }
    let mut high = 1.0e3 * low;
    while !holds(line, state, high, matrix) {
        (low, high) = (high, 1.0e2 * high);
        if !high.is_finite() {
            return None;
        }
    }
    while high > CLOSE * low {
        let middle = (low * high).sqrt();
        if holds(line, state, middle, matrix) { high = middle } else { low = middle }
    }
    newton.factor(line, &motion(state), &Weights { u: 1.0, v: 0.0, a: high }, None).ok()?;
    let mut x = Field::new(line.mesh().nodes());
    for c in 0..COMPONENTS {
        // Any start that is not across the deviation sought.
        x.component_mut(c).iter_mut().enumerate().for_each(|(node, x)| *x = ((7 * node + 3 * c) as f64).sin());
    }
    let mut force = Field::new(line.mesh().nodes());
    for _ in 0..ITERATIONS {
        newton.solve_linear(line, &mut x);
        let size = turn::largest(&x, line.mesh().length);
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        x.data_mut().iter_mut().for_each(|x| *x /= size);
        line.inertia(&motion(state), &x, &mut force);
        std::mem::swap(&mut x, &mut force);
    }
    newton.forget();
    Some(force)
}

/// Whether ½ (K + Kᵀ) + μ M is positive definite at a state at rest.
fn holds(line: &dyn Line, state: &State, mu: f64, matrix: &mut BlockTridiagonal<COMPONENTS>) -> bool {
    line.tangent(&motion(state), &Weights { u: 1.0, v: 0.0, a: mu }, None, matrix);
    line.fixed().iter().for_each(|&(node, component)| matrix.fix(node, component));
    is_positive_definite(matrix)
}
