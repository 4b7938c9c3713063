//! Static equilibrium: R(u, 0, 0) = 0 with the ends prescribed.
//!
//! From the catenary guess, Newton's method on (K + μ M) δ = -R, where the geometric part of K uses the tension predicted to first
//! order from the last step (the path of a mixed method, without its unknowns), and μ falls with the residual. A line without
//! bending stiffness carries no compression, so its energy is convex and any start leads to an equilibrium; what may need
//! patience is a pile of slack line, whose equilibrium is not unique.

use crate::rod::element::Weights;
use crate::rod::line::Line;
use crate::rod::state::{COMPONENTS, Field, State};
use crate::solve::newton::{Newton, motion};
use crate::solve::relaxation::Relaxation;
use crate::solve::search;

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
}

/// Largest change of a slope in one iteration [-].
const LONGEST_STEP: f64 = 0.4;
/// Unbalanced force that is aimed at, relative to the line's weight or end tension.
const AIMED: f64 = 1.0e-7;
/// Unbalanced force that counts as equilibrium where no more is to be had.
const PROMISED: f64 = 1.0e-6;

/// Brings `state` (ends in place) to equilibrium; v and a are zero on return. `soften` makes the same line with its EA limited [N].
pub fn settle(line: &dyn Line, soften: &dyn Fn(f64) -> Box<dyn Line>, newton: &mut Newton, state: &mut State) -> Balance {
    state.v.fill(0.0);
    state.a.fill(0.0);
    let start = state.u.clone();
    let mut walk = Walk::new(line);
    let direct = walk.run(line, newton, state, &Attempt { iterations: 25, inertia: 0.0, mixed: true, allowed: AIMED });
    if direct.converged() {
        return direct;
    }
    let mut best = (direct, state.u.clone());
    let mut iterations = direct.iterations;
    for fallback in FALLBACKS {
        let reached = match &fallback {
            Fallback::Relax => {
                state.u.copy_from(&best.1);
                walk.relax(line, newton, state, &mut iterations)
            }
            Fallback::Climb(ladder) => {
                state.u.copy_from(&start);
                walk.climb(line, soften, newton, state, ladder, &mut iterations)
            }
        };
        if reached.judged().converged() {
            return Balance { iterations, ..reached.judged() };
        }
        if reached.residual < best.0.residual {
            best = (reached, state.u.clone());
        }
    }
    state.u.copy_from(&best.1);
    Balance { iterations, ..best.0.judged() }
}

/// Ways to stiffen a softened line step by step.
struct Ladder {
    /// EA of the first line, as a multiple of the line's weight.
    softest: f64,
    /// Ratio of EA between lines.
    ratio: f64,
    /// Iterations on each line, and on the last.
    iterations: [usize; 2],
    /// First μ on each line, as a multiple of weight / (mass · length).
    inertia: f64,
}

/// What is tried where Newton's method alone does not reach equilibrium.
enum Fallback {
    /// Motion without swing, from the best state so far.
    Relax,
    /// A softened line first.
    Climb(Ladder),
}

const FALLBACKS: [Fallback; 3] = [
    Fallback::Climb(Ladder { softest: 10.0, ratio: 10.0, iterations: [60, 400], inertia: 1.0 }),
    Fallback::Relax,
    Fallback::Climb(Ladder { softest: 3.0, ratio: 3.0, iterations: [80, 600], inertia: 30.0 }),
];
/// Newton iterations of a relaxation.
const RELAXING: usize = 600;
/// First step of a relaxation, as a share of √(mass · length / weight).
const FIRST_STEP: f64 = 0.1;

/// One way to walk to equilibrium.
struct Attempt {
    /// Iterations at most.
    iterations: usize,
    /// First μ, as a multiple of weight / (mass · length); 0: none unless the tangent is singular.
    inertia: f64,
    /// Use the tension predicted to first order in the geometric stiffness, and take whole steps; else search along each step.
    mixed: bool,
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
        ladder: &Ladder,
        iterations: &mut usize,
    ) -> Balance {
        let mesh = line.mesh();
        let [on_each, on_last] = ladder.iterations;
        let stiffest = mesh.sections.iter().map(|section| section.ea).fold(0.0, f64::max);
        let mut limit = ladder.softest * mesh.total_weight().max(1e-6 * stiffest);
        while limit < stiffest {
            let soft = soften(limit);
            let attempt = Attempt { iterations: on_each, inertia: ladder.inertia, mixed: false, allowed: 1e-3 };
            *iterations += self.run(soft.as_ref(), newton, state, &attempt).iterations;
            limit *= ladder.ratio;
        }
        let attempt = Attempt { iterations: on_last, inertia: ladder.inertia, mixed: false, allowed: AIMED };
        let balance = self.run(line, newton, state, &attempt);
        *iterations += balance.iterations;
        balance
    }

    /// Lets the line sink to rest.
    fn relax(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, iterations: &mut usize) -> Balance {
        let attempt = Attempt { iterations: 0, inertia: 0.0, mixed: false, allowed: AIMED };
        let mut relaxation = Relaxation::new(line, FIRST_STEP / unit_of_inertia(line).sqrt());
        let mut balance = self.balance(line, state, &attempt);
        let before = newton.effort.iterations;
        let spent = |newton: &Newton| newton.effort.iterations - before;
        while !balance.converged() && spent(newton) < RELAXING && relaxation.step(line, newton, state) {
            balance = self.balance(line, state, &attempt);
        }
        *iterations += spent(newton);
        balance
    }

    fn run(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, attempt: &Attempt) -> Balance {
        let mesh = line.mesh();
        let unit = unit_of_inertia(line);
        let mut mu = attempt.inertia * unit;
        line.tensions(&state.u, &state.v, &mut self.tension);
        let mut balance = self.balance(line, state, attempt);
        for iteration in 1..=attempt.iterations {
            if balance.converged() {
                break;
            }
            let weights = Weights { u: 1.0, v: 0.0, a: mu };
            let geometric = attempt.mixed.then_some(&self.tension[..]);
            let factored = newton.factor(line, &motion(state), &weights, geometric).is_ok();
            self.step.copy_from(&self.residual);
            newton.solve_linear(line, &mut self.step);
            let turn = largest_slope(&self.step, mesh.length);
            let mut length = 0.0;
            if factored && turn.is_finite() {
                let scale = -(LONGEST_STEP / turn).min(1.0);
                self.step.data_mut().iter_mut().for_each(|x| *x *= scale);
                line.linear_tensions(&state.u, &self.step, &mut self.tension);
                self.from.copy_from(&state.u);
                length =
                    if attempt.mixed { self.move_by(1.0, line, state).map_or(0.0, |_| 1.0) } else { self.search(line, state) };
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
            balance = Balance { iterations: iteration, ..self.balance(line, state, attempt) };
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

    /// The unbalanced force at a state; leaves the residual in place.
    fn balance(&mut self, line: &dyn Line, state: &State, attempt: &Attempt) -> Balance {
        self.evaluate(line, state);
        let end_tension = line.end_force(&motion(state)).norm();
        let (residual, node) = largest_force(line, &self.residual);
        let allowed = attempt.allowed * (line.mesh().total_weight() + line.burden()).max(end_tension).max(f64::MIN_POSITIVE);
        Balance { iterations: 0, residual, allowed, node }
    }
}

/// Unit of μ: weight / (mass · length) [1/s²].
fn unit_of_inertia(line: &dyn Line) -> f64 {
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

fn largest_slope(step: &Field, length: f64) -> f64 {
    let mut largest: f64 = 0.0;
    for c in 0..COMPONENTS {
        let scale = if c < 3 { 2.0 / length } else { 1.0 };
        for x in step.component(c) {
            let size = (x * scale).abs();
            if !(size <= largest) {
                largest = size;
            }
        }
    }
    largest
}
