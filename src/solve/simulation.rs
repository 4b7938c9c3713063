//! The facade: one mooring line through statics and time. The command, the report and the FMU see nothing else of the solver.

use crate::cable1994::line::Tensions;
use crate::rod::clamp::Holder;
use crate::rod::line::{Line, Supports};
pub use crate::rod::physics::Decision;
use crate::rod::physics::Surroundings;
use crate::rod::pose::PosePath;
use crate::rod::state::State;
use crate::scene::state::{LineState, NodeState};
use crate::solve::controller::{self, Controller, Demands};
pub use crate::solve::counters::{Counters, LastStep, StaticsReport};
use crate::solve::line_state;
pub use crate::solve::linearised::Linearised;
use crate::solve::mixed::Mixed;
use crate::solve::newton::Newton;
pub use crate::solve::outputs::{NodeOutput, Outputs};
use crate::solve::scale::Scale;
use crate::solve::scheme::Moment;
use crate::solve::snapshot::Snapshot;
use crate::solve::start::Bounds;
use nalgebra::Vector3;
use std::sync::Arc;

mod building;
mod derivative;
mod equilibrium;
mod failing;
mod looking;
mod passage;
mod rollback;

/// A line is at rest where no tension along it can change by more than this share of the tolerance times the end tension.
pub(in crate::solve) const REST_SHARE: f64 = 0.01;
/// A fairlead that stays within this share of the line's length of a place rests there: rounding.
pub(in crate::solve) const SLIGHT: f64 = 1.0e-14;

/// One mooring line through statics and time.
pub struct Simulation {
    name: String,
    line: Box<dyn Line>,
    /// The line by the report's own method, where the scene asks for it; `line` then gives mesh, first guess and bed.
    mixed: Option<Mixed>,
    surroundings: Surroundings,
    supports: Supports,
    decisions: Vec<Decision>,
    bounds: Bounds,
    anchor: Vector3<f64>,
    newton: Newton,
    controller: Controller,
    tolerance: f64,
    scale: Scale,
    demands: Demands,
    moment: Moment,
    work: f64,
    /// Work done on what moves the anchor [J].
    anchor_work: f64,
    works: bool,
    fresh: bool,
    /// The state is known to be at rest.
    resting: bool,
    /// It is an equilibrium that was found between other ends.
    settled: bool,
    /// The scene lets the line stay in a plane, as long as its fairlead does.
    may_be_planar: bool,
    last: LastStep,
    /// The state before the last `advance`.
    before: Option<Snapshot>,
    /// Room for the forces of the nodes.
    forces: Vec<Vector3<f64>>,
}

impl Simulation {
    /// From now on the work done on the vessel is summed up over the steps; unasked it stays zero, since it costs an end force in
    /// every step.
    pub fn sum_up_work(&mut self) {
        self.works = true;
    }

    /// Lets the end at a node, if it is clamped, go with a body.
    pub(in crate::solve) fn clamp_to(&mut self, node: usize, body: &Arc<PosePath>) {
        self.line.clamp_to(node, body);
        let own = self.supports.clamps.iter_mut().filter(|clamp| clamp.node == node);
        own.for_each(|clamp| clamp.body = Holder::Driven(Arc::clone(body)));
    }

    /// The discrete line.
    pub(in crate::solve) fn line(&self) -> &dyn Line {
        self.line.as_ref()
    }

    /// What holds and loads it.
    pub(in crate::solve) fn supports(&self) -> &Supports {
        &self.supports
    }

    /// What its steps have to meet.
    pub(in crate::solve) fn demands(&self) -> &Demands {
        &self.demands
    }

    /// Its state now.
    pub(in crate::solve) fn state(&self) -> &State {
        &self.moment.state
    }

    /// Begins from given nodes instead of from equilibrium; false, and nothing changed, if a node of the mesh is not among them. The
    /// accelerations are those that fit; λ is taken over by `cable-1994` alone. Friction begins as on a line
    /// laid slack and pulled tight.
    pub fn start_from(&mut self, given: &LineState) -> bool {
        let mut moment = controller::at_rest(self.line.as_ref(), given.time, self.demands.max_step);
        let Some(tensions) = line_state::set(self.line.as_ref(), given, &mut moment.state) else { return false };
        let across = |node: &NodeState| [node.slope, node.velocity, node.slope_rate].iter().any(|rate| rate[1] != 0.0);
        if given.nodes.iter().any(|node| node.position[1] != self.anchor.y || across(node)) {
            self.leave_plane();
        }
        let State { u, v, holds, .. } = &mut moment.state;
        self.line.lay(u, holds);
        self.line.hold(u, v, holds);
        self.moment = moment;
        if let Some(mixed) = &mut self.mixed {
            mixed.restore(&Tensions { now: tensions.clone(), before: tensions });
        }
        self.begin_anew(None);
        true
    }
}
