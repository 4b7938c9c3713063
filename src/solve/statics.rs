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
}

/// Largest change of a slope in one iteration [-].
const LONGEST_STEP: f64 = 0.4;
/// Unbalanced force that counts as equilibrium, relative to the line's weight or end tension.
const BALANCED: f64 = 1.0e-7;

/// Brings `state` (ends in place) to equilibrium; v and a are zero on return.
pub fn settle(line: &dyn Line, newton: &mut Newton, state: &mut State) -> Balance {
    state.v.fill(0.0);
    state.a.fill(0.0);
    let start = state.u.clone();
    let mut best = (f64::INFINITY, state.u.clone());
    let mut iterations = 0;
    let mut last = None;
    for attempt in ATTEMPTS {
        let mut walk = Walk::new(line, state.u.clone());
        let balance = walk.run(line, newton, state, &attempt);
        iterations += balance.iterations;
        let balance = Balance { iterations, ..balance };
        if balance.converged() {
            return balance;
        }
        if balance.residual / balance.allowed < best.0 {
            best = (balance.residual / balance.allowed, state.u.clone());
            last = Some(balance);
        }
        state.u.copy_from(&start);
    }
    state.u.copy_from(&best.1);
    last.map_or(Balance { iterations, residual: f64::INFINITY, allowed: 0.0, node: 0 }, |balance| Balance {
        iterations,
        ..balance
    })
}

/// One way to walk to equilibrium.
struct Attempt {
    /// Iterations at most.
    iterations: usize,
    /// First μ, as a multiple of (weight / (mass · length)).
    inertia: f64,
    /// Use the predicted tension in the geometric stiffness.
    mixed: bool,
}

const ATTEMPTS: [Attempt; 4] = [
    Attempt { iterations: 40, inertia: 0.0, mixed: true },
    Attempt { iterations: 150, inertia: 10.0, mixed: true },
    Attempt { iterations: 300, inertia: 100.0, mixed: false },
    Attempt { iterations: 600, inertia: 1.0e4, mixed: true },
];

/// Memory of one attempt.
struct Walk {
    residual: Field,
    tension: Vec<f64>,
    previous: Field,
}

impl Walk {
    fn new(line: &dyn Line, u: Field) -> Walk {
        let mut tension = vec![0.0; 3 * line.mesh().elements.len()];
        let zero = Field::new(u.nodes());
        line.tensions(&u, &zero, &mut tension);
        Walk { residual: zero, tension, previous: u }
    }

    fn run(&mut self, line: &dyn Line, newton: &mut Newton, state: &mut State, attempt: &Attempt) -> Balance {
        let mesh = line.mesh();
        let mass: f64 = mesh.elements.iter().map(|e| e.length * mesh.sections[e.section].mass).sum();
        let weight = mesh.total_weight().max(1e-3 * mass);
        let unit = weight / (mass * mesh.length);
        let mut mu = attempt.inertia * unit;
        let mut balance = self.balance(line, state, 0);
        let mut calm = 0;
        for iteration in 1..=attempt.iterations {
            if balance.converged() {
                return balance;
            }
            let weights = Weights { u: 1.0, v: 0.0, a: mu };
            let geometric = attempt.mixed.then_some(&self.tension[..]);
            if newton.factor(line, &motion(state), &weights, geometric).is_err() {
                mu = (10.0 * mu).max(unit);
                balance.iterations = iteration;
                continue;
            }
            let mut step = self.residual.clone();
            newton.solve_linear(line, &mut step);
            let turn = largest_slope(&step, mesh.length);
            if !turn.is_finite() {
                mu = (10.0 * mu).max(unit);
                balance.iterations = iteration;
                continue;
            }
            let scale = -(LONGEST_STEP / turn).min(1.0);
            step.data_mut().iter_mut().for_each(|x| *x *= scale);
            line.linear_tensions(&state.u, &step, &mut self.tension);
            self.previous.copy_from(&state.u);
            state.u.add(1.0, &step);
            let before = balance.residual;
            balance = self.balance(line, state, iteration);
            if !balance.residual.is_finite() {
                state.u.copy_from(&self.previous);
                balance = self.balance(line, state, iteration);
                mu = (10.0 * mu).max(unit);
                continue;
            }
            // Fall with the residual; after a limited or worsening step rise again.
            calm = if scale > -1.0 { 0 } else { calm + 1 };
            let factor =
                if calm == 0 { 2.0 } else { (balance.residual / before).clamp(0.1, 2.0).min(if calm > 3 { 0.5 } else { 2.0 }) };
            mu = if attempt.inertia > 0.0 { mu * factor } else { mu * 0.1 };
        }
        balance
    }

    /// The unbalanced force at a state; leaves the residual in place.
    fn balance(&mut self, line: &dyn Line, state: &State, iterations: usize) -> Balance {
        line.residual(&motion(state), &mut self.residual);
        let end_tension = [0, line.last()].map(|node| self.residual.position(node).norm()).into_iter().fold(0.0, f64::max);
        for &(node, component) in line.fixed() {
            self.residual.component_mut(component)[node] = 0.0;
        }
        let (residual, node) = largest_force(line, &self.residual);
        let allowed = BALANCED * line.mesh().total_weight().max(end_tension).max(f64::MIN_POSITIVE);
        Balance { iterations, residual, allowed, node }
    }
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
