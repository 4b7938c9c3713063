//! From one time to another: pick a step, try it, accept or shrink, land on the end exactly, give up honestly.

use crate::rod::state::{Field, State};
use crate::scene::types;
use crate::solve::esdirk::{Esdirk, TR_BDF2};
use crate::solve::newton::{Criteria, Stall};
use crate::solve::scheme::{self, Bench, Moment, Scheme};

/// What a run demands of its steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demands {
    /// Local error of the positions allowed in a step of one second [m]; shorter steps are allowed their share.
    pub error_rate: f64,
    /// Longest step [s].
    pub max_step: f64,
    /// Step without control [s].
    pub fixed_step: Option<f64>,
    /// When a stage is solved.
    pub criteria: Criteria,
}

/// Work of the controller.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected steps.
    pub rejected: usize,
    /// Steps taken by the L-stable method instead of the chosen one.
    pub guarded: usize,
    /// Largest estimated error of an accepted step over the allowed one.
    pub error: f64,
}

/// A step could not be taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Failure {
    /// Time of the attempt [s].
    pub time: f64,
    /// Smallest step tried [s].
    pub step: f64,
    /// What the stage solver said last; none: the error stayed too large.
    pub stall: Option<Stall>,
}

/// Halvings of a step before giving up.
const HALVINGS: i32 = 24;

/// Takes steps of one scheme, with an L-stable one where it fails.
pub struct Controller {
    scheme: Box<dyn Scheme>,
    guard: Esdirk,
    next: State,
    /// Work done so far.
    pub tally: Tally,
}

impl Controller {
    /// A controller for a scheme and a number of nodes.
    pub fn new(name: types::Scheme, nodes: usize) -> Controller {
        Controller {
            scheme: scheme::of(name, nodes),
            guard: Esdirk::new(&TR_BDF2, nodes),
            next: State::new(nodes),
            tally: Tally::default(),
        }
    }

    /// Advances `moment` to `until`, calling `accepted` after each step. On a failure `moment` stands at the last accepted step.
    pub fn advance(
        &mut self,
        bench: &mut Bench,
        demands: &Demands,
        moment: &mut Moment,
        until: f64,
        mut accepted: impl FnMut(&Moment),
    ) -> Result<(), Failure> {
        let smallest = demands.fixed_step.unwrap_or(demands.max_step).min(until - moment.time) * 0.5f64.powi(HALVINGS);
        let mut trouble = 0;
        while until - moment.time > 1e-12 * until.abs().max(1.0) {
            let remaining = until - moment.time;
            let wanted = match demands.fixed_step {
                Some(step) if trouble == 0 => step,
                _ => moment.step.min(demands.max_step),
            };
            let count = (remaining / wanted - 1e-6).ceil().max(1.0);
            let h = remaining / count;
            let outcome = if trouble >= 3 {
                self.guard.step(bench, moment, h, &mut self.next)
            } else {
                self.scheme.step(bench, moment, h, &mut self.next)
            };
            let verdict = match outcome {
                Ok(error) => Ok(error / (demands.error_rate * h)),
                Err(stall) => Err(Some(stall)),
            };
            let controlled = demands.fixed_step.is_none();
            match verdict {
                Ok(ratio) if ratio <= 1.2 || !controlled && ratio.is_finite() => {
                    self.tally.steps += 1;
                    self.tally.guarded += usize::from(trouble >= 3);
                    self.tally.error = self.tally.error.max(ratio);
                    trouble = if trouble > 3 { trouble - 1 } else { 0 };
                    self.accept(moment, h, if count == 1.0 { until } else { moment.time + h });
                    moment.step = next_step(h, ratio, self.scheme.error_order() - 1.0).min(demands.max_step);
                    accepted(moment);
                }
                verdict => {
                    self.tally.rejected += 1;
                    let stall = verdict.err().flatten();
                    if stall.is_some() {
                        trouble += 1;
                        moment.last_step = 0.0;
                        bench.newton.forget();
                    }
                    let shrink =
                        verdict.map_or(0.5, |ratio| (0.9 * ratio.powf(-1.0 / (self.scheme.error_order() - 1.0))).clamp(0.2, 0.9));
                    moment.step = h * if shrink.is_finite() { shrink } else { 0.2 };
                    if moment.step < smallest {
                        return Err(Failure { time: moment.time + h, step: h, stall });
                    }
                }
            }
        }
        moment.time = until;
        Ok(())
    }

    fn accept(&mut self, moment: &mut Moment, h: f64, time: f64) {
        std::mem::swap(&mut moment.earlier, &mut moment.state.a);
        std::mem::swap(&mut moment.state.a, &mut self.next.a);
        std::mem::swap(&mut moment.state.u, &mut self.next.u);
        std::mem::swap(&mut moment.state.v, &mut self.next.v);
        moment.last_step = h;
        moment.time = time;
    }
}

/// The step after one of length h whose error was `ratio` of the allowed one. Small changes are not worth a new factor.
fn next_step(h: f64, ratio: f64, order: f64) -> f64 {
    let factor = (0.9 * ratio.max(1e-9).powf(-1.0 / order)).min(2.0);
    if factor > 0.85 && factor < 1.25 { h } else { h * factor.max(0.5) }
}

/// A moment at rest.
pub fn at_rest(nodes: usize, time: f64, step: f64) -> Moment {
    Moment { time, state: State::new(nodes), earlier: Field::new(nodes), last_step: 0.0, step }
}
