//! Where on the line, and of what kind, a failure is.

use super::Simulation;
use crate::error::{Cause, Error, Stuck, Zone};
use crate::solve::controller::Failure;
use crate::solve::motion::Path;
use crate::solve::newton::Stall;

impl Simulation {
    pub(super) fn stuck(&self, failure: &Failure, path: &Path, last_good_time: f64) -> Stuck {
        let step = failure.step;
        let node = failure.stall.map_or(self.line.last(), |stall| stall.node());
        Stuck {
            line: self.name.clone(),
            time: failure.time,
            s: self.arc_length(node),
            zone: self.zone(node),
            cause: match (failure.stall, &self.mixed) {
                (None, Some(mixed)) => Cause::StepTooShort { step, shortest: mixed.shortest_step() },
                (Some(_), Some(_)) => Cause::Diverged { step },
                (None, None) => Cause::TooInaccurate { step },
                (Some(Stall::NotFinite { .. }), None) => Cause::NotFinite { step },
                (Some(_), None) => Cause::NoSolution { step },
            },
            fairlead_speed: path.at(failure.time).velocity.norm(),
            last_good_time,
        }
    }

    /// Arc length of a node from the fairlead [m].
    pub(super) fn arc_length(&self, node: usize) -> f64 {
        self.line.mesh().length - self.line.mesh().node_arc_length(node)
    }

    /// Part of the line at a node.
    pub(super) fn zone(&self, node: usize) -> Zone {
        let near =
            |e: usize| self.line.touching_length(&self.moment.state.u, e) / self.line.mesh().elements[e].length.max(1e-300);
        let last = self.line.last();
        let (below, above) = (near(node.saturating_sub(1).min(last - 1)), near(node.min(last - 1)));
        match node {
            _ if node == last => Zone::Fairlead,
            0 => Zone::Anchor,
            _ if below > 0.999 && above > 0.999 => Zone::Grounded,
            _ if below > 0.0 || above > 0.0 => Zone::Touchdown,
            _ => Zone::Suspended,
        }
    }

    /// Which error a failure at one of its nodes is.
    pub(in crate::solve) fn failed(&self, failure: &Failure, fairlead: &Path, last_good_time: f64) -> Error {
        Error::Step(Box::new(self.stuck(failure, fairlead, last_good_time)))
    }

    /// Which error a path of an end that cannot be is.
    pub(in crate::solve) fn refused(&self, cause: Cause, time: f64, fairlead_speed: f64, at_anchor: bool) -> Error {
        let (s, zone) = if at_anchor { (self.line.mesh().length, Zone::Anchor) } else { (0.0, Zone::Fairlead) };
        let last_good_time = self.moment.state.clock.now;
        Error::Step(Box::new(Stuck { line: self.name.clone(), time, s, zone, cause, fairlead_speed, last_good_time }))
    }
}
