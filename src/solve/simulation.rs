//! The facade: one mooring line through statics and time. The command, the report and the FMU see nothing else of the solver.

use crate::error::Error;
use crate::scene::types::Scene;
use crate::solve::motion::Path;
use nalgebra::Vector3;

/// What a line tells about itself at one instant. Forces are those the line exerts on what holds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// Time [s].
    pub time: f64,
    /// Position of the fairlead [m].
    pub fairlead: Vector3<f64>,
    /// Force on the vessel [N].
    pub force: Vector3<f64>,
    /// Effective tension at the fairlead, |force| [N].
    pub tension: f64,
    /// Force on the anchor [N].
    pub anchor_force: Vector3<f64>,
    /// Effective tension at the anchor [N].
    pub anchor_tension: f64,
    /// Largest effective tension along the line [N].
    pub tension_max: f64,
    /// Angle of the force from straight down [rad].
    pub declination: f64,
    /// Direction of the force in plan, from x to y [rad].
    pub azimuth: f64,
    /// Unstretched length in contact with the bed [m].
    pub grounded_length: f64,
    /// Work done on the vessel since the start [J].
    pub work: f64,
}

/// A node of the line, counted from the fairlead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeOutput {
    /// Unstretched arc length from the fairlead [m].
    pub s: f64,
    /// Position [m].
    pub position: Vector3<f64>,
    /// Unit tangent from fairlead to anchor [-].
    pub tangent: Vector3<f64>,
    /// Effective tension, positive pulling [N].
    pub tension: f64,
}

/// How statics went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticsReport {
    /// Newton iterations, all attempts.
    pub iterations: usize,
    /// Largest unbalanced nodal force [N].
    pub residual: f64,
    /// Whether the residual is small enough to call it equilibrium.
    pub converged: bool,
}

/// Work done by the solver since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Accepted time steps.
    pub steps: usize,
    /// Rejected time steps.
    pub rejected_steps: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Factorisations of the tangent.
    pub factorisations: usize,
    /// Elements times evaluations.
    pub element_iterations: usize,
}

/// How the last `advance` went.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LastStep {
    /// Accepted time steps.
    pub substeps: usize,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Largest estimated relative error of a time step [-].
    pub error_estimate: f64,
}

/// The complete state of a simulation: restored, it goes on bit for bit as before.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {}

impl Snapshot {
    /// Appends the state as bytes.
    pub fn to_bytes(&self, _bytes: &mut Vec<u8>) {
        todo!()
    }

    /// The state that exactly these bytes hold; `None`: they hold none.
    pub fn from_bytes(_bytes: &[u8]) -> Option<Snapshot> {
        todo!()
    }
}

/// One mooring line through statics and time.
pub struct Simulation {}

impl Simulation {
    /// Line number `index` of a checked scene: meshes it and picks its physics.
    pub fn new(_scene: &Scene, _index: usize) -> Result<Simulation, Error> {
        todo!()
    }

    /// Puts the line in static equilibrium with its fairlead at a point, at rest, at a time.
    /// On `Err(Error::Statics)` the best state found stands, so that it can be looked at.
    pub fn settle(&mut self, _fairlead: Vector3<f64>, _time: f64) -> Result<StaticsReport, Error> {
        todo!()
    }

    /// Advances to a time with the fairlead on a path. On an error the state is the one before the call.
    pub fn advance(&mut self, _until: f64, _path: &Path) -> Result<(), Error> {
        todo!()
    }

    /// Outputs now.
    pub fn outputs(&self) -> Outputs {
        todo!()
    }

    /// Nodes now, from the fairlead.
    pub fn nodes(&self) -> Vec<NodeOutput> {
        todo!()
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        todo!()
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        todo!()
    }

    /// How the last `advance` went.
    pub fn last_step(&self) -> LastStep {
        todo!()
    }

    /// Time derivatives of the outputs now (of the time itself: 1).
    pub fn output_rates(&self) -> Outputs {
        todo!()
    }

    /// The state now.
    pub fn snapshot(&self) -> Snapshot {
        todo!()
    }

    /// Goes back to a state of this simulation, or of one made from the same scene.
    pub fn restore(&mut self, _snapshot: &Snapshot) {
        todo!()
    }

    /// Derivatives of all outputs at a time, one for each variation of the path on the way there from a state. The simulation stays
    /// as it is.
    pub fn differentiate(
        &mut self,
        _from: &Snapshot,
        _until: f64,
        _path: &Path,
        _directions: &[Path],
    ) -> Result<Vec<Outputs>, Error> {
        todo!()
    }
}
