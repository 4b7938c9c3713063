//! The trapezoidal Adams–Moulton step, converged.
//!
//! ```text
//! v₁ = v₀ + h/2 (a₀ + a₁),   u₁ = u₀ + h/2 (v₀ + v₁),   R(u₁, v₁, a₁, t₁) = 0
//! ```
//!
//! Second order, no numerical damping. Local error of u: h²/12 (a₁ - a₀), filtered by the stage matrix.

use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::solve::newton::Stall;
use crate::solve::scheme::{Bench, Moment, Scheme, predict};

/// The scheme and its working space.
pub struct AdamsMoulton {
    error: Field,
    scratch: Field,
}

impl AdamsMoulton {
    /// Room for `nodes` nodes.
    pub fn new(nodes: usize) -> AdamsMoulton {
        AdamsMoulton { error: Field::new(nodes), scratch: Field::new(nodes) }
    }
}

impl Scheme for AdamsMoulton {
    fn step(&mut self, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<f64, Stall> {
        let start = &from.state;
        let weights = Weights { u: 0.25 * h * h, v: 0.5 * h, a: 1.0 };
        predict(from, h, &mut next.a);
        next.v.set_sum([(1.0, &start.v), (0.5 * h, &start.a), (0.5 * h, &next.a)]);
        next.u.set_sum([(1.0, &start.u), (0.5 * h, &start.v), (0.5 * h, &next.v)]);
        bench.prescribe(next, from.clock_after(h));
        bench.solve(&weights, next)?;

        let share = h * h / 12.0;
        self.error.set_sum([(share, &next.a), (-share, &start.a)]);
        bench.filter(next, &mut self.error, &mut self.scratch);
        Ok(bench.line.error_size(&self.error))
    }

    fn error_order(&self) -> f64 {
        3.0
    }
}
