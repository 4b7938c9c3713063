//! Static equilibrium: R(u, 0, 0) = 0 with the ends prescribed.
//!
//! From the catenary guess, Newton's method on (K + μ M) δ = -R, where the geometric part of K uses the tension predicted to first
//! order from the last step (the path of a mixed method, without its unknowns), and μ falls with the residual. A line without
//! bending stiffness carries no compression, so its energy is convex and any start leads to an equilibrium; what may need
//! patience is a pile of slack line, whose equilibrium is not unique. A force in balance is one within 1e-6 of weight or end tension, or
//! within what rounding of the positions makes of it, where that is more (`rounding`).

use crate::rod::line::Line;
use crate::rod::motion::Weights;
use crate::rod::state::{Field, State};
use crate::solve::newton::{Newton, motion};
use crate::solve::relaxation::Relaxation;
use crate::solve::turn::{self, LONGEST_STEP};
use crate::solve::{rounding, search, start};

/// How an attempt ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Newton iterations done.
    pub iterations: usize,
    /// Largest unbalanced nodal force [N].
    pub residual: f64,
    /// Unbalanced force that counts as equilibrium [N].
    pub allowed: f64,
    /// Node of the largest unbalanced force.
    pub node: usize,
}

impl Balance {
    /// Whether this is equilibrium.
    pub fn converged(&self) -> bool {
        self.residual <= self.allowed
    }

    /// The same balance, judged by what is promised to the user instead of by what is aimed at.
    fn judged(self) -> Balance {
        Balance { allowed: self.allowed * (PROMISED / AIMED), ..self }
    }

    /// The same balance where `more` is allowed, if that is more [N].
    fn within(self, more: f64) -> Balance {
        Balance { allowed: self.allowed.max(more), ..self }
    }
}

/// Unbalanced force that is aimed at, relative to the line's weight or end tension.
const AIMED: f64 = 1.0e-7;
/// Unbalanced force that counts as equilibrium where no more is to be had.
const PROMISED: f64 = 1.0e-6;
/// Unbalanced force up to which a shape without tension is a better start than a taut one, relative like the others: that of a weightless
/// line whose end is awash or in air.
const LITTLE: f64 = 0.1;

/// Newton's method from a guess: enough for most lines. Leads into unstable equilibria as well.
pub fn approach(line: &dyn Line, newton: &mut Newton, state: &mut State) -> Balance {
    Walk::new(line).go(line, newton, state, &Attempt { iterations: 25, way: Way::Mixed, allowed: AIMED })
}

/// Goes down from a state that is out of balance, or out of an unstable equilibrium, in so many iterations.
pub fn descend(line: &dyn Line, newton: &mut Newton, state: &mut State, iterations: usize, promised: bool) -> Balance {
    let (mut walk, allowed) = (Walk::new(line), if promised { AIMED } else { 1e-4 });
    let mut balance = walk.balance(line, state, allowed);
    let mut done = 0;
    let searching = Way::Search { inertia: 1.0, downwards: true };
    for (way, share) in [(Way::Descend, 0.25), (searching, 0.25), (Way::Descend, 0.25), (searching, 0.25)] {
        if balance.converged() {
            break;
        }
        balance = walk.go(line, newton, state, &Attempt { iterations: (share * iterations as f64) as usize, way, allowed });
        done += balance.iterations;
    }
    let balance = Balance { iterations: done, ..balance };
    if promised { balance.judged().within(rounding(line, state)) } else { balance }
}

/// Brings `state` (ends in place) to equilibrium; v and a are zero on return. `soften` makes the same line with its EA limited [N].
pub fn settle(line: &dyn Line, soften: &dyn Fn(f64) -> Box<dyn Line>, newton: &mut Newton, state: &mut State) -> Balance {
    state.v.fill(0.0);
    state.a.fill(0.0);
    let mut start = state.u.clone();
    let direct = approach(line, newton, state);
    let mut walk = Walk::new(line);
    let mut iterations = direct.iterations;
    if direct.converged() {
        return direct;
    }
    let judged = direct.within(rounding(line, state));
    if judged.converged() {
        return judged;
    }
    let mut best = (direct, state.u.clone());
    if let Some(slackened) = start::slackened(line.mesh(), &start) {
        state.u.copy_from(&slackened);
        let slack = Balance { iterations, ..walk.balance(line, state, AIMED) };
        if slack.converged() {
            return slack;
        }
        if slack.residual < LITTLE / AIMED * slack.allowed {
            best = (slack, slackened.clone());
            start = slackened;
        }
    }
    for fallback in &FALLBACKS {
        if fallback.anew {
            state.u.copy_from(&start);
        }
        let reached = walk.climb(line, soften, newton, state, fallback, &mut iterations);
        let judged = reached.judged().within(rounding(line, state));
        if judged.converged() {
            return Balance { iterations, ..judged };
        }
        if reached.residual < best.0.residual {
            best = (reached, state.u.clone());
        }
    }
    state.u.copy_from(&best.1);
    Balance { iterations, ..best.0.judged() }
}

/// What is tried where Newton's method alone does not reach equilibrium: a softened line first, then stiffer ones, then the line itself.
struct Fallback {
    /// From the first guess, instead of from where the last attempt ended.
    anew: bool,
    /// EA of the first line, as a multiple of the line's weight.
    softest: f64,
    /// Ratio of EA between lines.
    ratio: f64,
    /// Iterations on each line, and on the last.
    iterations: [usize; 2],
    /// Unbalanced force that is good enough on the softened lines.
    allowed: f64,
    /// How.
    way: Way,
}

/// Relaxation of softened lines goes on to forces as small as the drag of a slow current, of which the shape of a slack line depends.
const FALLBACKS: [Fallback; 4] = [
    Fallback {
        anew: true,
        softest: 10.0,
        ratio: 10.0,
        iterations: [60, 400],
        allowed: 1e-3,
        way: Way::Search { inertia: 1.0, downwards: false },
    },
    Fallback { anew: false, softest: f64::INFINITY, ratio: 1.0, iterations: [0, 500], allowed: AIMED, way: Way::Relax },
    Fallback { anew: true, softest: 10.0, ratio: 4.0, iterations: [200, 500], allowed: 1e-6, way: Way::Relax },
    Fallback {
        anew: true,
        softest: 3.0,
        ratio: 3.0,
        iterations: [80, 600],
        allowed: 1e-3,
        way: Way::Search { inertia: 30.0, downwards: false },
    },
];
/// Largest μ for the sake of a positive definite matrix, as a multiple of weight / (mass · length).
const STIFFEST: f64 = 1.0e15;
/// First step of a relaxation, as a share of √(mass · length / weight).
const FIRST_STEP: f64 = 0.1;

/// How to walk to equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// Newton's method with the tension predicted to first order in the geometric stiffness; whole steps.
    Mixed,
    /// Newton's method with a search along each step.
    Search {
        /// First μ, as a multiple of weight / (mass · length).
        inertia: f64,
        /// μ is so large that the matrix is positive definite: every step goes down.
        downwards: bool,
    },
    /// Motion without swing.
    Relax,
    /// The same, never into an unstable equilibrium.
    Descend,
}

/// One walk to equilibrium.
struct Attempt {
    /// Iterations at most.
    iterations: usize,
    /// How.
    way: Way,
    /// Unbalanced force that is good enough, relative to weight or end tension.
    allowed: f64,
}

/// Memory of a walk.
struct Walk {
    residual: Field,
    tension: Vec<f64>,
    from: Field,
    step: Field,
}

impl Walk {
    fn new(line: &dyn Line) -> Walk {
        let field = || Field::new(line.mesh().nodes());
        Walk { residual: field(), tension: vec![0.0; 3 * line.mesh().elements.len()], from: field(), step: field() }
    }

    /// Settles a softened line, then stiffer ones, then the line itself.
    fn climb(
        &mut self,
        line: &dyn Line,
        soften: &dyn Fn(f64) -> Box<dyn Line>,
        newton: &mut Newton,
        state: &mut State,
        fallback: &Fallback,
        iterations: &mut usize,
    ) -> Balance {
        let (mesh, way) = (line.mesh(), fallback.way);
        let [on_each, on_last] = fallback.iterations;
        let stiffest = mesh.sections.iter().map(|section| section.ea).fold(0.0, f64::max);
        let mut limit = fallback.softest * mesh.total_weight().max(1e-6 * stiffest);
        while limit < stiffest {
            let attempt = Attempt { iterations: on_each, way, allowed: fallback.allowed };
            *iterations += self.go(soften(limit).as_ref(), newton, state, &attempt).iterations;
            limit *= fallback.ratio;
        }
        let balance = self.go(line, newton, state, &Attempt { iterations: on_last, way, allowed: AIMED });
        *iterations += balance.iterations;
        balance
    }

    fn go(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, attempt: &Attempt) -> Balance {
        match attempt.way {
            Way::Mixed => self.run(line, newton, state, attempt, 0.0),
            Way::Search { inertia, .. } => self.run(line, newton, state, attempt, inertia),
            Way::Relax | Way::Descend => self.relax(line, newton, state, attempt),
        }
    }

    /// Lets the line sink to rest; leaves it where it was nearest to equilibrium.
    fn relax(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, attempt: &Attempt) -> Balance {
        let mut balance = self.balance(line, state, attempt.allowed);
        let mut best = (balance, state.u.clone());
        let mut relaxation = Relaxation::new(line, state, FIRST_STEP / unit_of_inertia(line).sqrt(), attempt.way == Way::Descend);
        let mut iterations = 0;
        while !balance.converged() && iterations < attempt.iterations {
            iterations += 1;
            relaxation.step(line, newton, &self.residual, state);
            balance = self.balance(line, state, attempt.allowed);
            if !balance.residual.is_finite() {
                relaxation.undo(state);
                balance = self.balance(line, state, attempt.allowed);
            }
            if balance.residual < best.0.residual {
                best.0 = balance;
                best.1.copy_from(&state.u);
            }
        }
        state.u.copy_from(&best.1);
        Balance { iterations, ..best.0 }
    }

    /// Newton's method with inertia μ, which rises where steps fail.
    fn run(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, attempt: &Attempt, inertia: f64) -> Balance {
        let mesh = line.mesh();
        let mixed = attempt.way == Way::Mixed;
        let downwards = matches!(attempt.way, Way::Search { downwards: true, .. });
        let unit = unit_of_inertia(line);
        let mut mu = inertia * unit;
        line.tensions(&state.u, &state.v, &mut self.tension);
        let mut balance = self.balance(line, state, attempt.allowed);
        for iteration in 1..=attempt.iterations {
            if balance.converged() {
                break;
            }
            let across = turn::across(&state.u, mesh.length);
            let weights = |mu: f64| Weights { u: 1.0, v: 0.0, a: mu };
            while downwards && mu < STIFFEST * unit && !newton.is_definite(line, &motion(state), &weights(mu), None, across) {
                mu = (4.0 * mu).max(1e-3 * unit);
            }
            let weights = weights(mu);
            let geometric = mixed.then_some(&self.tension[..]);
            let factored = newton.factor(line, &motion(state), &weights, geometric).is_ok();
            self.step.copy_from(&self.residual);
            newton.solve_linear(line, &mut self.step);
            let turn = turn::largest(&self.step, mesh.length);
            let mut length = 0.0;
            if factored && turn.is_finite() {
                let scale = -(LONGEST_STEP / turn).min(1.0);
                self.step.data_mut().iter_mut().for_each(|x| *x *= scale);
                line.linear_tensions(&state.u, &self.step, &mut self.tension);
                self.from.copy_from(&state.u);
                length = if mixed { self.move_by(1.0, line, state).map_or(0.0, |_| 1.0) } else { self.search(line, state) };
                if length == 0.0 {
                    state.u.copy_from(&self.from);
                }
                mu *= if length < 0.3 {
                    4.0
                } else if length == 1.0 && scale == -1.0 {
                    0.1
                } else {
                    1.0
                };
            }
            if length == 0.0 {
                mu = (10.0 * mu).max(1e-3 * unit);
            }
            balance = Balance { iterations: iteration, ..self.balance(line, state, attempt.allowed) };
        }
        balance
    }

    /// Moves to `from` + length·step and returns R·step there: the slope of the energy along the step, where there is an energy.
    fn move_by(&mut self, length: f64, line: &dyn Line, state: &mut State) -> Option<f64> {
        state.u.set_sum([(1.0, &self.from), (length, &self.step)]);
        self.evaluate(line, state);
        let slope = self.residual.dot(&self.step);
        slope.is_finite().then_some(slope)
    }

    /// Searches along the step for a place where the energy no longer falls; returns the share of the step taken.
    fn search(&mut self, line: &dyn Line, state: &mut State) -> f64 {
        search::share(|share| self.move_by(share, line, state).unwrap_or(f64::NAN))
    }

    fn evaluate(&mut self, line: &dyn Line, state: &State) {
        line.residual(&motion(state), &mut self.residual);
        for &(node, component) in line.fixed() {
            self.residual.component_mut(component)[node] = 0.0;
        }
    }

    /// The unbalanced force at a state, and what of it is allowed, as a share of weight or end tension; leaves the residual in place.
    fn balance(&mut self, line: &dyn Line, state: &State, share: f64) -> Balance {
        self.evaluate(line, state);
        let end_tension = line.end_force(&motion(state)).norm();
        let (residual, node) = largest_force(line, &self.residual);
        let allowed = share * (line.mesh().total_weight() + line.burden()).max(end_tension).max(f64::MIN_POSITIVE);
        Balance { iterations: 0, residual, allowed, node }
    }
}

/// Force out of balance that is no more than rounding [N].
fn rounding(line: &dyn Line, state: &State) -> f64 {
    largest_force(line, &rounding::bound(line, state)).0
}

/// Unit of μ: weight / (mass · length) [1/s²].
pub fn unit_of_inertia(line: &dyn Line) -> f64 {
    let mesh = line.mesh();
    let mass: f64 = mesh.elements.iter().map(|e| e.length * mesh.sections[e.section].mass).sum();
    mesh.total_weight().max(mass) / (mass * mesh.length)
}

/// Largest unbalanced force; moments on slopes count as forces at the length of the element beside them.
fn largest_force(line: &dyn Line, residual: &Field) -> (f64, usize) {
    let elements = &line.mesh().elements;
    let mut largest = (0.0, 0);
    for node in 0..residual.nodes() {
        let beside = |e: Option<usize>| e.and_then(|e| elements.get(e)).map_or(0.0, |e| e.length);
        let length = beside(node.checked_sub(1)).max(beside(Some(node)));
        let size = residual.position(node).norm().max(residual.slope(node).norm() / length);
        if !(size <= largest.0) {
            largest = (size, node);
            if size.is_nan() {
                break;
            }
        }
    }
    largest
}
