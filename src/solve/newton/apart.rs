//! A stage of a network: lines that are done are left as they are while others go on.
//!
//! ```text
//! f ← f - (A_ee x_e + A_ef x_f)
//! ```
//!
//! x the displacement of the last iteration, f forces of a line that is done on its ends; inside it nothing is out of balance by the matrix that
//! was factored. Which lines are done says `open_lines`.

use super::{Criteria, FAINT, Newton, SLOW, Stall, motion};
use crate::rod::motion::{Asking, Motion, Weights};
use crate::rod::state::State;
use crate::rod::system::System;
use crate::solve::open_lines::{Left, OpenLines, Sizes};

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
                    self.grow_old(iteration == 0, unsure, contraction);
                    return Ok(());
                }
                Left::Masters => {}
                Left::Lines if contraction > 2.0 && new_factor => break,
                Left::Lines if contraction > SLOW => {
                    self.factor(line, &motion(trial), weights, None)?;
                    new_factor = true;
                }
                Left::Lines => {}
            }
        }
        Err(Stall::Diverging { node: self.size(weights.u, criteria.length).1 })
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
