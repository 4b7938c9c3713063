//! Steps already taken, in the form in which they can be differentiated along any change of their path.

use crate::rod::line::Line;
use crate::rod::state::State;
use crate::solve::controller::Leg;
use crate::solve::motion::Path;
use crate::solve::snapshot::Snapshot;
use crate::solve::tangent::LinearStage;

/// Steps already taken and linearised: what `derivative` goes along, as often as wanted.
pub struct Linearised {
    /// When they begin [s].
    pub(super) time: f64,
    /// Length of the step before the first [s].
    pub(super) history: f64,
    /// The line began with the path then.
    pub(super) fresh: bool,
    /// The steps.
    pub(super) legs: Vec<Leg>,
    /// The states between them.
    pub(super) states: Vec<State>,
    /// Their stages.
    pub(super) stages: Vec<LinearStage>,
    /// The line in space, where the steps are those of a line in a plane: changes may lead across it.
    pub(super) spatial: Option<Box<dyn Line>>,
    /// Where they begin and how they go, where they are repeated.
    pub(super) repeated: Option<Repeated>,
}

/// Where steps of `cable-1994` begin, until when and along which path: they are repeated, not linearised.
pub(super) type Repeated = (Snapshot, f64, Path);

impl Linearised {
    /// Steps that are repeated: linearising would take longer.
    pub(super) fn repeated(from: &Snapshot, until: f64, path: &Path) -> Linearised {
        Linearised {
            time: from.moment.state.clock.now,
            history: 0.0,
            fresh: false,
            legs: Vec::new(),
            states: Vec::new(),
            stages: Vec::new(),
            spatial: None,
            repeated: Some((from.clone(), until, path.clone())),
        }
    }
}
