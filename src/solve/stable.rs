//! Statics of a line that can push: an equilibrium is an answer only if it is stable.
//!
//! Bending stiffness carries compression, so the energy is not convex: a straight column in balance is an equilibrium like a bight, and
//! Newton's method goes to the nearest. Where what it finds is unstable, or nothing is found, the line first settles without compression,
//! which is a convex problem and has one answer; what is bunched up in it bows out (`bow`), and from there the line goes down in steps
//! whose matrix is positive definite (`relaxation`). An unstable equilibrium met on the way is left along the deviation that grows fastest, to either
//! side (`stability`).

use crate::rod::line::Line;
use crate::rod::state::{Field, State};
use crate::solve::newton::Newton;
use crate::solve::statics::{self, Balance};
use crate::solve::{bow, stability};

/// A line of the same mesh with other properties.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// EA is no more than this [N].
    pub limit: f64,
    /// No element pushes.
    pub limp: bool,
    /// Without friction and flow.
    pub bare: bool,
}

/// The line as it is.
pub const WHOLE: Variant = Variant { limit: f64::INFINITY, limp: false, bare: false };

/// Equilibria left at most.
const DEPARTURES: usize = 8;
/// Turn of the step out of an unstable equilibrium [-].
const PUSH: f64 = 0.1;
/// Iterations of a descent.
const ITERATIONS: usize = 600;
/// EA of the line that bows out first, as a multiple of weight, and the ratio to the next.
const SOFTEST: f64 = 1.0e3;
const RATIO: f64 = 100.0;

/// How statics ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// The balance; never `converged` where the equilibrium is unstable.
    pub balance: Balance,
    /// An unstable equilibrium was left to one side: there is a stable one to the other side, too.
    pub others: bool,
    /// In equilibrium, but not a stable one.
    pub unstable: bool,
}

/// Brings `state` (ends in place) to a stable equilibrium of `line`, the first of what `make` makes.
pub fn settle(line: &dyn Line, make: &dyn Fn(Variant) -> Box<dyn Line>, newton: &mut Newton, state: &mut State) -> Settled {
    let bare = make(Variant { bare: true, ..WHOLE });
    let unit = statics::unit_of_inertia(line);
    state.v.fill(0.0);
    state.a.fill(0.0);
    let start = state.u.clone();
    let mut balance = statics::approach(line, newton, state);
    let mut iterations = balance.iterations;
    let mut others = false;
    if balance.converged() {
        if stability::is_stable(bare.as_ref(), state, unit) {
            return Settled { balance, others, unstable: false };
        }
        others = true;
    }
    state.u.copy_from(&start);
    let limp = make(Variant { limp: true, ..WHOLE });
    iterations +=
        statics::settle(limp.as_ref(), &|limit| make(Variant { limit, limp: true, bare: false }), newton, state).iterations;
    others |= bow::out(line.mesh(), &mut state.u);
    let stiffest = line.mesh().sections.iter().map(|section| section.ea).fold(0.0, f64::max);
    let mut limit = SOFTEST * line.mesh().total_weight();
    while limit < stiffest {
        iterations +=
            statics::descend(make(Variant { limit, ..WHOLE }).as_ref(), newton, state, ITERATIONS / 3, false).iterations;
        limit *= RATIO;
    }
    balance = statics::descend(line, newton, state, ITERATIONS, true);
    iterations += balance.iterations;
    for _ in 0..DEPARTURES {
        if !balance.converged() {
            break;
        }
        let Some(way) = stability::way_out(bare.as_ref(), newton, state, unit) else {
            return Settled { balance: Balance { iterations, ..balance }, others, unstable: false };
        };
        others = true;
        balance = leave(line, newton, state, &way);
        iterations += balance.iterations;
    }
    let unstable = balance.converged();
    Settled { balance: Balance { iterations, ..balance }, others, unstable }
}

/// Goes down from an unstable equilibrium, to the one side or, where that leads nowhere, to the other.
fn leave(line: &dyn Line, newton: &mut Newton, state: &mut State, way: &Field) -> Balance {
    let from = state.u.clone();
    let mut iterations = 0;
    let mut first = None;
    for push in [PUSH, -PUSH] {
        state.u.set_sum([(1.0, &from), (push, way)]);
        let balance = statics::descend(line, newton, state, ITERATIONS, true);
        iterations += balance.iterations;
        let balance = Balance { iterations, ..balance };
        if balance.converged() {
            return balance;
        }
        first.get_or_insert(balance);
    }
    Balance { iterations, ..first.unwrap_or_else(|| statics::descend(line, newton, state, 0, true)) }
}
