//! The generalised-alpha step (Chung & Hulbert 1993) with spectral radius ρ = 0.6 at infinite frequency.
//!
//! ```text
//! R((1-α_f) u₁ + α_f u₀, (1-α_f) v₁ + α_f v₀, (1-α_m) a₁ + α_m a₀, t₁ - α_f h) = 0
//! u₁ = u₀ + h v₀ + h² [(½-β) a₀ + β a₁],   v₁ = v₀ + h [(1-γ) a₀ + γ a₁]
//! α_m = (2ρ-1)/(ρ+1), α_f = ρ/(ρ+1), γ = ½ - α_m + α_f, β = ¼ (1 - α_m + α_f)²
//! ```
//!
//! The fairlead is exact at the ends of the step. Between them its position and velocity are blended as every other unknown, else the
//! mismatch, of the order h², would strain the last element; its acceleration is that of the instant of the equation, t₁ - α_f h: blended
//! exact accelerations would fall on t₁ - α_m h, which costs an order. Local error of u: h² (β - 1/6) (a₁ - a₀) (Zienkiewicz & Xie 1991), filtered by the stage matrix.

use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::solve::newton::Stall;
use crate::solve::scheme::{Bench, Moment, Scheme, predict};

const RHO: f64 = 0.6;
const ALPHA_M: f64 = (2.0 * RHO - 1.0) / (RHO + 1.0);
const ALPHA_F: f64 = RHO / (RHO + 1.0);
const GAMMA: f64 = 0.5 - ALPHA_M + ALPHA_F;
const BETA: f64 = 0.25 * (1.0 - ALPHA_M + ALPHA_F) * (1.0 - ALPHA_M + ALPHA_F);

/// The scheme and its working space.
pub struct GeneralizedAlpha {
    between: State,
    error: Field,
    scratch: Field,
}

impl GeneralizedAlpha {
    /// Room for `nodes` nodes.
    pub fn new(nodes: usize) -> GeneralizedAlpha {
        GeneralizedAlpha { between: State::new(nodes), error: Field::new(nodes), scratch: Field::new(nodes) }
    }
}

/// to = (1 - alpha)·end + alpha·start.
fn blend(to: &mut Field, alpha: f64, end: &Field, start: &Field) {
    to.set_sum([(1.0 - alpha, end), (alpha, start)]);
}

impl Scheme for GeneralizedAlpha {
    fn step(&mut self, bench: &mut Bench, from: &Moment, h: f64, next: &mut State) -> Result<f64, Stall> {
        let start = &from.state;
        predict(from, h, &mut next.a);
        let finish = |next: &mut State| {
            let square = h * h;
            next.v.set_sum([(1.0, &start.v), (h * (1.0 - GAMMA), &start.a), (h * GAMMA, &next.a)]);
            next.u.set_sum([(1.0, &start.u), (h, &start.v), (square * (0.5 - BETA), &start.a), (square * BETA, &next.a)]);
        };
        finish(next);
        bench.prescribe(next, from.clock_after(h));
        blend(&mut self.between.u, ALPHA_F, &next.u, &start.u);
        blend(&mut self.between.v, ALPHA_F, &next.v, &start.v);
        blend(&mut self.between.a, ALPHA_M, &next.a, &start.a);
        self.between.holds.copy_from(&next.holds);
        self.between.frames.clone_from(&next.frames);
        self.between.clock = from.clock_after((1.0 - ALPHA_F) * h);
        bench.prescribe_order(2, &mut self.between.a, self.between.clock);
        bench.line.follow(&mut self.between);
        let weights = Weights { u: (1.0 - ALPHA_F) * BETA * h * h, v: (1.0 - ALPHA_F) * GAMMA * h, a: 1.0 - ALPHA_M };
        bench.solve(&weights, &mut self.between)?;

        let whole = 1.0 / (1.0 - ALPHA_M);
        next.a.set_sum([(whole, &self.between.a), (-ALPHA_M * whole, &start.a)]);
        finish(next);
        bench.prescribe(next, from.clock_after(h));
        let share = h * h * (BETA - 1.0 / 6.0);
        self.error.set_sum([(share, &next.a), (-share, &start.a)]);
        bench.filter(next, &mut self.error, &mut self.scratch);
        Ok(bench.line.error_size(&self.error))
    }

    fn error_order(&self) -> f64 {
        3.0
    }
}
