//! From one time to another: pick a step, try it, accept or shrink, land on the end exactly, give up honestly.

use crate::rod::state::{Field, State};
use crate::rod::system::System;
use crate::scene::types;
use crate::sea::clock::Clock;
use crate::solve::esdirk::{Esdirk, TR_BDF2};
use crate::solve::newton::{Criteria, Stall};
use crate::solve::scheme::{Bench, Moment, Scheme, Stages};
use crate::solve::schemes;

/// What a run demands of its steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demands {
    /// Local error of the positions allowed in a step [m].
    pub error: f64,
    /// The step is not shortened below this for the sake of the error alone [s].
    pub finest_step: f64,
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
    /// Steps of the finest length whose error was still above the allowed one: the motion is rougher than time can resolve.
    pub unresolved: usize,
    /// Steps of `cable-1994` with a part of the line pushing.
    pub pushing: usize,
    /// Largest estimated error of an accepted step over the allowed one.
    pub error: f64,
}

/// A step that was accepted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Its length [s].
    pub h: f64,
    /// Taken by the L-stable method.
    pub guarded: bool,
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

/// After a step whose error was more than allowed by a scheme that is not L-stable, this many are taken by one that is: what rings there
/// dies away.
const GUARDED_STEPS: u32 = 256;
/// Error of a step over the allowed one that is still accepted.
const ACCEPTED: f64 = 1.5;
/// Steps below this many of the finest are short for what they end at, not for their error: a stage of theirs is solved by one increment.
const WATCHED: f64 = 8.0;
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
            scheme: schemes::of(name, nodes),
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
        mut accepted: impl FnMut(&Moment, &Leg),
    ) -> Result<(), Failure> {
        let smallest = demands.fixed_step.unwrap_or(demands.max_step).min(until - moment.state.clock.now) * 0.5f64.powi(HALVINGS);
        let controlled = demands.fixed_step.is_none();
        let mut halved = false;
        let mut first = true;
        while until - moment.state.clock.now > 1e-12 * until.abs().max(1.0) {
            let remaining = until - moment.state.clock.now;
            let wanted = demands.fixed_step.filter(|_| !halved).unwrap_or(moment.step.min(demands.max_step));
            let count = (remaining / wanted - 1e-6).ceil().max(1.0);
            let h = remaining / count;
            // The way to the next output time rarely divides into the steps of the last one. A factor for nearly the same step would be
            // kept, but converges more slowly than it did; judged by what it did, the iteration would end too soon.
            if first && (h - moment.tried).abs() > 1e-6 * h {
                bench.newton.forget();
            }
            (moment.tried, first) = (h, false);
            bench.newton.watched = controlled && h < WATCHED * demands.finest_step;
            let guarded = moment.guard > 0;
            let recorded = if let Stages::Record(kept) = &bench.stages { kept.len() } else { 0 };
            let scheme: &mut dyn Scheme = if guarded { &mut self.guard } else { self.scheme.as_mut() };
            let order = scheme.error_order();
            let guard = if scheme.is_l_stable() && !guarded { 0 } else { GUARDED_STEPS };
            self.next.holds.copy_from(&moment.state.holds);
            self.next.frames.clone_from(&moment.state.frames);
            let outcome = scheme.step(bench, moment, h, &mut self.next).map(|error| error / demands.error);
            let resolved = |ratio: f64| ratio <= ACCEPTED || (!controlled || h <= demands.finest_step) && ratio.is_finite();
            match outcome {
                Ok(ratio) if resolved(ratio) => {
                    self.tally.steps += 1;
                    self.tally.guarded += usize::from(guarded);
                    let rough = controlled && ratio > ACCEPTED;
                    self.tally.unresolved += usize::from(rough);
                    self.tally.error = self.tally.error.max(ratio);
                    self.accept(moment, h, if count == 1.0 { until } else { moment.state.clock.now + h });
                    let State { u, v, holds, .. } = &mut moment.state;
                    bench.line.hold(u, v, holds);
                    bench.line.recentre(&mut moment.state);
                    moment.guard = if controlled && ratio > 1.0 { guard } else { moment.guard.saturating_sub(1) };
                    moment.step = next_step(h, ratio, order).max(demands.finest_step.min(h)).min(demands.max_step);
                    halved = false;
                    accepted(moment, &Leg { h, guarded });
                }
                Ok(ratio) if ratio.is_finite() => {
                    bench.forget_stages(recorded);
                    self.tally.rejected += 1;
                    moment.guard = guard;
                    moment.step = (h * (0.9 * ratio.powf(-1.0 / order)).clamp(0.2, 0.9)).max(0.9 * demands.finest_step);
                }
                failed => {
                    bench.forget_stages(recorded);
                    self.tally.rejected += 1;
                    moment.guard = GUARDED_STEPS;
                    moment.last_step = 0.0;
                    moment.step = 0.5 * h;
                    halved = true;
                    bench.newton.forget();
                    if moment.step < smallest {
                        return Err(Failure { time: moment.state.clock.now + h, step: h, stall: failed.err() });
                    }
                }
            }
        }
        moment.state.clock.now = until;
        Ok(())
    }

    /// Repeats accepted steps on changes of the state, with the linearised stages that `bench` holds.
    pub fn repeat(
        &mut self,
        bench: &mut Bench,
        legs: &[Leg],
        change: &mut Moment,
        mut accepted: impl FnMut(&mut Moment, usize),
    ) -> Result<(), Stall> {
        for (number, leg) in legs.iter().enumerate() {
            let scheme: &mut dyn Scheme = if leg.guarded { &mut self.guard } else { self.scheme.as_mut() };
            self.next.holds.copy_from(&change.state.holds);
            scheme.step(bench, change, leg.h, &mut self.next)?;
            let time = change.state.clock.now + leg.h;
            self.accept(change, leg.h, time);
            accepted(change, number);
        }
        Ok(())
    }

    fn accept(&mut self, moment: &mut Moment, h: f64, time: f64) {
        std::mem::swap(&mut moment.earlier, &mut moment.state.a);
        std::mem::swap(&mut moment.state.a, &mut self.next.a);
        std::mem::swap(&mut moment.state.u, &mut self.next.u);
        std::mem::swap(&mut moment.state.v, &mut self.next.v);
        moment.last_step = h;
        moment.state.clock.now = time;
    }
}

/// The step after one of length h whose error was `ratio` of the allowed one. Small changes are not worth a new factor.
fn next_step(h: f64, ratio: f64, order: f64) -> f64 {
    let factor = (0.9 * ratio.max(1e-9).powf(-1.0 / order)).min(2.0);
    if factor > 0.85 && factor < 1.25 { h } else { h * factor.max(0.5) }
}

/// A moment of a line, all zero and at rest.
pub fn at_rest(line: &dyn System, time: f64, step: f64) -> Moment {
    let nodes = line.nodes();
    let state = State { clock: Clock::at_rest(time), holds: Field::new(line.holding_nodes()), ..State::new(nodes) };
    Moment { state, earlier: Field::new(nodes), last_step: 0.0, step, tried: 0.0, guard: 0 }
}
