//! A stage of a network: lines that are done are left as they are while others go on.
//!
//! ```text
//! f ← f - (A_ee x_e + A_ef x_f)
//! ```
//!
//! x the displacement of the last iteration, f forces of a line that is done on its ends; inside it nothing is out of balance by the matrix that
//! was factored. Which lines are done says `open_lines`.

use super::{AGEING, Criteria, FAINT, Newton, SLOW, Stall, motion};
use crate::algebra::block_tridiagonal::Singular;
use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::state::State;
use crate::rod::system::System;
use crate::solve::open_lines::{Left, OpenLines, Sizes};

/// Relative difference of c_u up to which a tangent is that of the same stage.
const SAME: f64 = 1.0e-6;

impl Newton {
    /// `iterate` for a network.
    pub(super) fn iterate_apart(
        &mut self,
        open: &mut OpenLines,
        line: &dyn System,
        weights: &Weights,
        trial: &mut State,
        criteria: &Criteria,
    ) -> Result<(), Stall> {
        self.memory.rates.resize(open.parts(), 1.0);
        let unsure = self.prepare(line, weights, trial)?;
        open.begin();
        let mut last = f64::INFINITY;
        let mut new_factor = self.memory.weights() == Some(weights) && self.memory.rate == 1.0;
        for iteration in 0..criteria.iterations {
            self.find_increment_apart(open, line, trial, if iteration == 0 { Asking::First } else { Asking::Again });
            let size = self.retreat(line, weights, trial, criteria)?;
            let contraction = self.contracted(size, last);
            last = size;
            let sizes = Sizes {
                c_u: weights.u.abs(),
                length: criteria.length,
                emphasis: criteria.emphasis,
                tolerance: criteria.tolerance,
            };
            match open.judge(line, &self.increment, &sizes, &mut self.memory.rates) {
                Left::Nothing if iteration == 0 && unsure && size > FAINT * criteria.tolerance => open.reopen(),
                Left::Nothing => {
                    if open.may_differ() {
                        open.grow_old(AGEING, &mut self.memory.rates);
                    }
                    self.grow_old(iteration == 0, unsure, contraction);
                    return Ok(());
                }
                Left::Masters => {}
                Left::Lines if contraction > 2.0 && new_factor => break,
                Left::Lines if contraction > SLOW => {
                    if new_factor || !self.renew(open, line, weights, trial)? {
                        self.factor(line, &motion(trial), weights, None)?;
                    }
                    new_factor = true;
                }
                Left::Lines => {}
            }
        }
        Err(Stall::Diverging { node: self.size(weights.u, criteria.length).1 })
    }

    /// Renews the factor for bodies and points and for the lines alone that are not done; false, and nothing changed, where all are to be factored. What it is made
    /// from is then one motion, put together from those at which each line was factored.
    fn renew(&mut self, open: &OpenLines, line: &dyn System, weights: &Weights, trial: &State) -> Result<bool, Stall> {
        let lines = open.lines();
        let near = |kept: &Weights| (kept.u / weights.u - 1.0).abs() < SAME && kept.a == weights.a;
        let few = open.may_differ() && 2 * lines.len() <= open.count();
        let Some(old) = self.memory.origin.take_if(|origin| few && self.at_hand && near(&origin.weights)) else {
            return Ok(false);
        };
        self.at_hand = false;
        let parts = || lines.iter().copied().chain(open.masters().iter().map(|node| (*node, node + 1)));
        let origin = self.shelf.renewed(&old, &motion(trial), parts());
        self.shelf.put(Some(old));
        parts().for_each(|(first, end)| self.matrix.clear_between(first, end));
        let at = motion(&origin.state);
        line.tangent_of(&at, &origin.weights, None, &lines, &mut self.matrix);
        (self.effort.factorisations, self.effort.partial) = (self.effort.factorisations + 1, self.effort.partial + 1);
        self.unknowns
            .factor(line, &at, origin.weights.u, &mut self.matrix, Some(&lines))
            .map_err(|Singular { index }| Stall::Singular { node: index })?;
        self.memory.origin = Some(origin);
        self.at_hand = true;
        Ok(true)
    }

    /// `find_increment` with the elements alone that are looked at.
    fn find_increment_apart(&mut self, open: &mut OpenLines, line: &dyn System, trial: &State, asking: Asking) {
        self.effort.iterations += 1;
        self.effort.spared += open.spared();
        let x = &mut self.increment;
        line.residual_of(&Motion { asking, ..motion(trial) }, open.runs(), x);
        open.take_over(x);
        line.gather(&motion(trial), x);
        self.unknowns.solve_runs(line, x, open.runs());
        self.unknowns.relax(x, open.forces_mut());
    }
}
