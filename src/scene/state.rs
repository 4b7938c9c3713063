//! The state of a line at its nodes as a file gives or takes it: position, slope, their rates, tension.

use crate::scene::types::Triple;

/// State of a line at one time, node by node from the fairlead.
#[derive(Debug, Clone, PartialEq)]
pub struct LineState {
    /// When [s].
    pub time: f64,
    /// At least two nodes, with rising s.
    pub nodes: Vec<NodeState>,
}

/// One node.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NodeState {
    /// Unstretched arc length from the fairlead [m].
    pub s: f64,
    /// Position [m].
    pub position: Triple,
    /// Its derivative with respect to s [-].
    pub slope: Triple,
    /// Velocity [m/s].
    pub velocity: Triple,
    /// Rate of the slope [1/s].
    pub slope_rate: Triple,
    /// Tension divided by the length of the slope [N].
    pub lambda: f64,
    /// The same in the middle of the element before this node [N]; 0 at the fairlead.
    pub lambda_before: f64,
}

impl LineState {
    /// Whether nothing moves.
    pub fn at_rest(&self) -> bool {
        self.nodes.iter().all(|node| node.velocity == [0.0; 3] && node.slope_rate == [0.0; 3])
    }
}
