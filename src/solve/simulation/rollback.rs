//! The complete state of a line: to save it is a look, that changes nothing; to put it back brings back all that the next step depends on,
//! to the last bit.

use super::Simulation;
use crate::solve::newton::Newton;
use crate::solve::snapshot::Snapshot;

impl Simulation {
    /// The complete state. A run goes on from here as if it had not been asked for.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::new(self.line.mesh().nodes());
        self.save(&mut snapshot);
        snapshot
    }

    /// The complete state, as `snapshot`, into one that is there already.
    pub fn save(&self, snapshot: &mut Snapshot) {
        if !self.fits(snapshot) {
            *snapshot = Snapshot::new(self.line.mesh().nodes());
        }
        snapshot.moment.copy_from(&self.moment);
        snapshot.memory.clone_from(self.newton.memory());
        snapshot.error = self.demands.error;
        if let Some(mixed) = &self.mixed {
            snapshot.tensions.clone_from(mixed.tensions());
        }
        (snapshot.planar, snapshot.resting) = (self.line.is_planar(), self.resting);
        (snapshot.work, snapshot.fresh, snapshot.last) = (self.work, self.fresh, self.last);
        snapshot.anchor_work = self.anchor_work;
    }

    /// Puts back a state of this line, after which all goes on as it went on from there; false, and nothing changed, if it belongs to a
    /// line with another number of nodes, or to one in a plane that this one is not held in.
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        if !self.fits(snapshot) {
            return false;
        }
        self.solve_in_plane(snapshot.planar);
        self.moment.copy_from(&snapshot.moment);
        self.newton.recall(&snapshot.memory);
        if let Some(mixed) = &mut self.mixed {
            mixed.restore(&snapshot.tensions);
        }
        self.demands.error = snapshot.error;
        self.anchor_work = snapshot.anchor_work;
        (self.work, self.fresh, self.resting, self.last) = (snapshot.work, snapshot.fresh, snapshot.resting, snapshot.last);
        true
    }

    /// Whether a state is one of this line: it has as many nodes, and is in a plane only if that can be.
    pub fn fits(&self, snapshot: &Snapshot) -> bool {
        let tensions = self.mixed.as_ref().map_or(snapshot.tensions.now.is_empty(), |mixed| mixed.fits(&snapshot.tensions));
        let holds = snapshot.moment.state.holds.nodes() == self.line.holding_nodes();
        let plane = !snapshot.planar || self.may_be_planar;
        snapshot.nodes() == self.line.mesh().nodes() && tensions && holds && plane
    }

    /// Takes the last `advance` back.
    pub fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.restore(&before);
            self.before = Some(before);
        }
    }

    /// Remembers the state before an `advance`.
    pub(super) fn mark(&mut self) {
        let mut before = self.before.take().unwrap_or_else(|| Snapshot::new(self.line.mesh().nodes()));
        self.save(&mut before);
        self.before = Some(before);
    }

    /// Goes on in space from a plane that the line is about to leave.
    pub(super) fn leave_plane(&mut self) {
        self.solve_in_plane(false);
    }

    fn solve_in_plane(&mut self, planar: bool) {
        if self.line.is_planar() != planar {
            self.surroundings.planar = planar;
            self.rebuild();
            let effort = self.newton.effort;
            self.newton = Newton::new(self.line.as_ref());
            self.newton.effort = effort;
        }
    }
}
