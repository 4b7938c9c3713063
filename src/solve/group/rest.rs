//! Whether lines that meet, and what they hang on, are at rest, so that steps may be left out as long as nobody moves an end or pulls at a body.

use super::Group;
use crate::solve::motion::Path;
use crate::solve::rest;
use crate::solve::simulation::{REST_SHARE, SLIGHT};
use nalgebra::Vector3;

impl Group {
    /// Whether nothing would happen before `until`. Depends on the state, the paths and the loads alone, so that it is the same after a rollback.
    pub(super) fn rests(&mut self, until: f64) -> bool {
        let still = self.may_rest
            && self.demands.fixed_step.is_none()
            && self.network.bodies.iter().all(|body| body.in_time.is_none())
            && self.network.driven.iter().all(|(node, path)| self.stays(*node, path, until));
        if still && !self.resting {
            self.resting = self.is_calm();
        }
        self.resting &= still;
        self.resting
    }

    /// Whether a driven end stays where it is, and its direction too if it is clamped.
    fn stays(&self, node: usize, path: &Path, until: f64) -> bool {
        let (state, length) = (&self.moment.state, self.simulations[self.line_of(node)].line().mesh().length);
        let (now, slight, at) = (state.clock.now, SLIGHT * length, state.u.position(node));
        let turns = match path {
            Path::OnBody { body, .. } if self.together.clamped => !body.rests(now, until, length, slight),
            _ => false,
        };
        let moves = [&state.v, &state.a].iter().any(|rate| rate.position(node) != Vector3::zeros());
        !turns && (self.fresh || !moves) && path.rests(now, until, &at, slight)
    }

    /// Whether no tension of its lines can change by more than a share of the tolerance.
    fn is_calm(&mut self) -> bool {
        let mut enough = f64::INFINITY;
        for local in 0..self.simulations.len() {
            let outputs = self.outputs(local);
            let allowed = REST_SHARE * self.tolerance * outputs.tension.max(outputs.anchor_tension);
            enough = enough.min(rest::enough(self.simulations[local].line(), allowed));
        }
        rest::is_near(&self.network, &mut self.newton, &self.moment.state, enough)
    }
}
