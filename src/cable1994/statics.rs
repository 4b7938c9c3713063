//! Static equilibrium of the mixed element (eqs. 2.17 and 2.18) by Newton's method.
//!
//! ```text
//! K δu + B δλ = c,   (Bᵀ - ∂d/∂z) δu - η L/EA δλ = d
//! ```
//!
//! The report takes a fixed share (RELAX) of every such step, ITER times; here the share is the largest that reduces what is out of
//! balance, and both end in the same equilibrium. ∂d/∂z, the change of the water's pressure on the wall, has the sign of the
//! algebra, not the one in print (2.18b). d is summed over the elements that share a λ; in each of them alone it is not zero.

use crate::cable1994::line::{MixedLine, UNKNOWNS};
use crate::rod::state::State;
use nalgebra::Vector3;

/// How statics went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Iterations done.
    pub iterations: usize,
    /// Largest unbalanced force of a node [N], or more where a strain does not fit its tension.
    pub residual: f64,
    /// Node where it is.
    pub node: usize,
}

/// Iterations before giving up.
const ITERATIONS: usize = 60;
/// Largest change of a slope in one iteration [-].
const LONGEST_STEP: f64 = 0.4;
/// Strain that may be left between the shape and λ where the aim is met [-].
const UNFIT: f64 = 1.0e-10;
/// Halvings of a step.
const HALVINGS: usize = 8;

impl MixedLine {
    /// Brings a line at rest to equilibrium, from where its nodes and its λ are, to within a force `aimed` [N].
    pub fn settle(&mut self, state: &mut State, aimed: f64) -> Settled {
        let mut now = self.balance(state, aimed);
        let mut iterations = 0;
        while now.residual > aimed && iterations < ITERATIONS {
            iterations += 1;
            if self.system.solve().is_err() || !self.system.right.iter().all(|x| x.is_finite()) {
                break;
            }
            let change = self.system.right.clone();
            let turn = change.chunks(UNKNOWNS).flat_map(|x| &x[3..6]).fold(0.0, |largest: f64, x| largest.max(x.abs()));
            let mut share = (LONGEST_STEP / turn).min(1.0);
            self.walk(state, &change, share);
            let mut next = self.balance(state, aimed);
            for _ in 0..HALVINGS {
                if next.residual < now.residual {
                    break;
                }
                self.walk(state, &change, -0.5 * share);
                share *= 0.5;
                next = self.balance(state, aimed);
            }
            now = next;
        }
        self.tensions.before.clone_from(&self.tensions.now);
        Settled { iterations, ..now }
    }

    /// Sets up the system of a Newton step from here; its right-hand side is what is out of balance.
    fn balance(&mut self, state: &State, aimed: f64) -> Settled {
        self.system.clear();
        for e in 0..self.elements.len() {
            let terms = self.terms(e, state, 0.0, 0.0);
            self.scatter(e, &terms, state, 0.0);
        }
        self.load(1.0);
        for k in 0..self.supports.fixed.len() {
            let (node, c) = self.supports.fixed[k];
            self.system.prescribe(UNKNOWNS * node + c, 0.0);
        }
        let mut settled = Settled { iterations: 0, residual: 0.0, node: 0 };
        let last = self.nodes() - 1;
        for node in 0..=last {
            let element = &self.elements[node.min(last - 1)];
            let row = &self.system.right[UNKNOWNS * node..][..UNKNOWNS];
            let unfit = row[6].abs().max(row[7].abs()) / element.length;
            let worst = Vector3::from_column_slice(&row[..3]).norm().max(aimed * unfit / UNFIT);
            if !(worst <= settled.residual) {
                (settled.residual, settled.node) = (worst, node);
            }
        }
        settled
    }

    fn walk(&mut self, state: &mut State, change: &[f64], share: f64) {
        for (node, x) in change.chunks(UNKNOWNS).enumerate() {
            (0..6).for_each(|c| state.u.component_mut(c)[node] += share * x[c]);
            (0..2).for_each(|m| self.tensions.now[2 * node + m] += share * x[6 + m]);
        }
    }
}
