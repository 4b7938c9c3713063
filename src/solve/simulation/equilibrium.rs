//! Statics of a line: from a first guess to an equilibrium that friction and the report's method have their part in.

use super::Simulation;
use crate::error::{Error, Unbalanced};
use crate::rod::line::Line;
use crate::rod::mesh::Mesh;
use crate::rod::physics::{self, Surroundings};
use crate::rod::state::{Field, State};
use crate::sea::clock::Clock;
use crate::solve::controller;
use crate::solve::counters::{LastStep, StaticsReport};
use crate::solve::newton::{Effort, Newton};
use crate::solve::stability;
use crate::solve::stable::{self, Settled, Variant, WHOLE};
use crate::solve::start;
use crate::solve::statics::{self, Balance};
use nalgebra::Vector3;

/// Local error of the positions allowed in a step, as a share of tolerance × (tension / stiffness of the fairlead). Below a tolerance of
/// 1e-3 it shrinks with its power 0.8 besides, since the global error goes with about the local one to the power 2/3.
/// Calibrated on the built-in case, where it gives about half the tolerance in the end tension.
const ERROR_SHARE: f64 = 1.5e-2;

/// Ends that have moved no farther than this share of the length leave a shape to go on from.
const NEARBY: f64 = 0.1;

impl Simulation {
    /// Puts the line in static equilibrium with its fairlead at a point, at rest, at a time.
    /// On `Err(Error::Statics)` the best state found stands, so that it can be looked at.
    pub fn settle(&mut self, fairlead: Vector3<f64>, time: f64) -> Result<StaticsReport, Error> {
        self.settle_between(fairlead, self.anchor, time)
    }

    /// The same with both ends at given points.
    pub fn settle_between(&mut self, fairlead: Vector3<f64>, anchor: Vector3<f64>, time: f64) -> Result<StaticsReport, Error> {
        self.anchor = anchor;
        if fairlead.y != self.anchor.y {
            self.leave_plane();
        }
        self.moment = controller::at_rest(self.line.as_ref(), time, self.demands.max_step);
        let (anchor, fairlead) = (self.start_of(0, self.anchor), self.start_of(self.line.last(), fairlead));
        start::guess(self.line.mesh(), &self.bounds, &anchor, &fairlead, &mut self.moment.state.u);
        self.line.place(0, &mut self.moment.state.u, time);
        self.leave_plane_if_out();
        let (settled, smooth) = self.balance();
        self.leave_plane_if_out();
        let mut balance = settled.balance;
        if let Some(mixed) = &mut self.mixed {
            balance = mixed.settle(self.line.as_ref(), &mut self.moment.state, balance);
        }
        self.begin_anew(smooth.as_deref());
        if balance.converged() && !settled.unstable {
            let Balance { iterations, residual, .. } = balance;
            return Ok(StaticsReport { iterations, residual, converged: true, others: settled.others });
        }
        Err(Error::Statics(Box::new(Unbalanced {
            line: self.name.clone(),
            iterations: balance.iterations,
            residual: balance.residual,
            allowed: balance.allowed,
            unstable: settled.unstable,
            s: self.arc_length(balance.node),
            zone: self.zone(balance.node),
        })))
    }

    /// Where an end is held, or else where the scene has it: the place from which statics starts.
    pub(super) fn start_of(&self, node: usize, pinned: Vector3<f64>) -> Vector3<f64> {
        self.supports.holds.iter().find(|hold| hold.node == node).and_then(|hold| hold.reference).unwrap_or(pinned)
    }

    /// The same from the shape that it has, its ends a little elsewhere: Newton's method first, and where that does not lead to a (stable) equilibrium, all else.
    pub(in crate::solve) fn resettle(
        &mut self,
        fairlead: Vector3<f64>,
        anchor: Vector3<f64>,
        time: f64,
    ) -> Result<StaticsReport, Error> {
        let last = self.line.last();
        let moves = [anchor - self.moment.state.u.position(0), fairlead - self.moment.state.u.position(last)];
        let length = self.line.mesh().length;
        let near = moves.iter().all(|way| way.norm() < NEARBY * length);
        if near && self.settled && self.mixed.is_none() && self.line.holding_nodes() == 0 && !self.line.is_planar() {
            let before = self.moment.state.u.clone();
            let state = &mut self.moment.state;
            for node in 0..=last {
                let share = self.line.mesh().node_arc_length(node) / length;
                let place = state.u.position(node) + moves[0] * (1.0 - share) + moves[1] * share;
                state.u.set_position(node, &place);
            }
            state.v.fill(0.0);
            state.a.fill(0.0);
            state.clock = Clock::at_rest(time);
            self.anchor = anchor;
            let balance = statics::approach(self.line.as_ref(), &mut self.newton, state);
            if balance.converged() && (!self.pushes() || self.is_stable()) {
                self.begin_anew(None);
                let Balance { iterations, residual, .. } = balance;
                return Ok(StaticsReport { iterations, residual, converged: true, others: false });
            }
            self.moment.state.u = before;
        }
        let report = self.settle_between(fairlead, anchor, time);
        self.settled = report.is_ok();
        report
    }

    /// A heap of slack line is coiled, and what can push may bow out: neither stays in its plane.
    pub(super) fn leave_plane_if_out(&mut self) {
        if self.line.is_planar() && !is_in_plane(&self.moment.state.u, self.anchor.y) {
            self.leave_plane();
        }
    }

    /// Finds the equilibrium without friction, and from there, if there is friction, that of the line as it is laid and the places of the
    /// bed that hold it there; returns the line without friction, too.
    fn balance(&mut self) -> (Settled, Option<Box<dyn Line>>) {
        let (mesh, supports) = (self.line.mesh(), &self.supports);
        let make = |variant: Variant, surroundings: Surroundings| {
            let mut made = Mesh { limp: variant.limp, ..mesh.clone() };
            for (number, section) in made.sections.iter_mut().enumerate().filter(|(_, section)| section.ea > variant.limit) {
                if let Some(elasticity) = made.elasticities.get_mut(number) {
                    *elasticity = elasticity.scaled(variant.limit / section.ea);
                }
                section.ea = variant.limit;
            }
            physics::build(made, if variant.bare { surroundings.bare() } else { surroundings }, supports.clone())
        };
        let pushes = self.pushes();
        let (line, newton, state) = (self.line.as_ref(), &mut self.newton, &mut self.moment.state);
        let rough = line.holding_nodes() > 0;
        let smooth = rough.then(|| make(WHOLE, self.surroundings.without_friction()));
        let without = self.surroundings.without_friction();
        let free = smooth.as_deref().unwrap_or(line);
        let mut settled = if pushes {
            // A line may buckle out of its plane.
            let spatial = Surroundings { planar: false, ..without };
            let line = make(WHOLE, spatial.clone());
            let effort = newton.effort;
            let mut in_space = Newton::new(line.as_ref());
            let settled = stable::settle(line.as_ref(), &|variant| make(variant, spatial.clone()), &mut in_space, state);
            newton.effort = effort;
            settled
        } else {
            let soften = |limit| make(Variant { limit, ..WHOLE }, without.clone());
            Settled { balance: statics::settle(free, &soften, newton, state), others: false, unstable: false }
        };
        if rough && settled.balance.converged() {
            let around = self.surroundings.laid(mesh);
            let laid = make(WHOLE, around.clone());
            laid.lay(&state.u, &mut state.holds);
            let before = settled.balance.iterations;
            settled.balance =
                statics::settle(laid.as_ref(), &|limit| make(Variant { limit, ..WHOLE }, around.clone()), newton, state);
            settled.balance.iterations += before;
            laid.hold(&state.u, &state.v, &mut state.holds);
        }
        (settled, smooth)
    }

    /// What a new beginning resets, and the error of a step that is allowed from here; `smooth` is the line without friction, if it
    /// has any.
    pub(super) fn begin_anew(&mut self, smooth: Option<&dyn Line>) {
        let line = smooth.unwrap_or(self.line.as_ref());
        let length = self.scale.length(line, &mut self.newton, &self.moment.state);
        self.demands.error = ERROR_SHARE * (self.tolerance / 1.0e-3).powf(0.8).min(1.0) * self.tolerance * length;
        self.newton.forget();
        self.newton.effort = Effort::default();
        (self.work, self.anchor_work, self.fresh, self.resting, self.last) = (0.0, 0.0, true, false, LastStep::default());
    }

    /// Whether the line would stay where it is if it were at rest there: no small deviation grows. Friction and flow do not count.
    pub fn is_stable(&self) -> bool {
        let (mesh, state) = (self.line.mesh().clone(), &self.moment.state);
        let bare = physics::build(mesh, self.surroundings.bare(), self.supports.clone());
        let still = State { u: state.u.clone(), clock: state.clock, ..State::new(state.u.nodes()) };
        stability::is_stable(bare.as_ref(), &still, statics::unit_of_inertia(bare.as_ref()))
    }
}

/// Whether a line lies in the plane of a y.
fn is_in_plane(u: &Field, y: f64) -> bool {
    u.component(1).iter().all(|place| *place == y) && u.component(4).iter().all(|slope| *slope == 0.0)
}
