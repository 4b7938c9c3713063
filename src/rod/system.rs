//! What a time step needs of what moves: the seam between the discrete line, or a network of lines, bodies and points, and the schemes.

use crate::algebra::block_tridiagonal::BlockTridiagonal;
use crate::rod::motion::{Motion, Weights};
use crate::rod::state::{Field, State};
use nalgebra::{Matrix3, Matrix3x6};

/// Nodes of six unknowns each, their residual and its tangent.
pub trait System: Send + Sync {
    /// Number of nodes.
    fn nodes(&self) -> usize;
    /// For each pair of neighbouring nodes: do they share their position?
    fn ties(&self) -> Vec<bool>;
    /// Number of the last node; of a line, its fairlead.
    fn last(&self) -> usize {
        self.nodes() - 1
    }
    /// Unknowns that are prescribed, as (node, component).
    fn fixed(&self) -> &[(usize, usize)];
    /// Whether it knows motion in the x–z plane alone.
    fn is_planar(&self) -> bool;
    /// Sets positions (order 0), velocities (1) or accelerations (2) of nodes that are moved from outside, or along locked axes, to what they are
    /// at a time.
    fn place(&self, order: usize, field: &mut Field, time: f64);
    /// Residual R [N, N·m]: the force to be applied from outside for this motion. At tied nodes it stands at the second.
    fn residual(&self, at: &Motion, out: &mut Field);
    /// The same of some of its lines alone: those between the nodes of each of `runs`, from its first to the one before its end, which lie at least
    /// `MOST_LANES` nodes apart; what stands at the nodes of other lines says nothing.
    fn residual_of(&self, at: &Motion, runs: &[(usize, usize)], out: &mut Field);
    /// c_u ∂R/∂u + c_v ∂R/∂v + c_a ∂R/∂a. `geometric`, where given, is the tension of the geometric part at each Gauss point [N].
    fn tangent(&self, at: &Motion, weights: &Weights, geometric: Option<&[f64]>, matrix: &mut BlockTridiagonal<6>);
    /// Adds the same of some of its lines alone, those between the nodes of each of `runs`, and of bodies and points; what is added at the nodes of
    /// other lines says nothing.
    fn tangent_of(
        &self,
        at: &Motion,
        weights: &Weights,
        geometric: Option<&[f64]>,
        runs: &[(usize, usize)],
        matrix: &mut BlockTridiagonal<6>,
    );
    /// M x: the inertia (and of the water moved with it) for accelerations x, everything else at rest [N, N·m].
    fn inertia(&self, at: &Motion, x: &Field, out: &mut Field);
    /// Nodes of the field of places to which lines hold on by friction; 0 without friction.
    fn holding_nodes(&self) -> usize;
    /// Moves the places of the bed to which lines hold on after a step to these positions and velocities.
    fn hold(&self, u: &Field, v: &Field, holds: &mut Field);
    /// The nodes that hang on bodies and points; none: every node is free or fixed.
    fn links(&self) -> Option<&Links> {
        None
    }
    /// Takes the forces on nodes that hang on bodies and points to these, by the levers of now.
    fn gather(&self, _: &Motion, _: &mut Field) {}
    /// Moves the nodes that hang on bodies and points with these.
    fn follow(&self, _: &mut State) {}
    /// Lets the rotation vectors of free bodies count from where they are.
    fn recentre(&self, _: &mut State) {}
    /// Displacement of a free body or point, by its number among `Links::masters`, in an increment, turns at the reach of the body: what these do is
    /// the sum of what is left of their accelerations, step by step, so that they must be iterated closer than what a line does.
    fn loose(&self, _: &Field, _: usize) -> f64 {
        0.0
    }
    /// Size of an error of the positions [m], each line's by its own scale as a share of the finest one.
    fn error_size(&self, error: &Field) -> f64 {
        error.largest_position(0, error.nodes())
    }
    /// Displacement of each hanging node, then turn of each direction to which an end is clamped, per unit of its master's six unknowns.
    fn levers(&self, _: &Motion, _: &mut [Matrix3x6<f64>]) {}
    /// Change of the moment on the slope of each end that is clamped to a free body with the direction of the clamp [N·m].
    fn crossed(&self, _: &Motion, _: usize) -> Matrix3<f64> {
        Matrix3::zeros()
    }
}

/// A node whose position is that of a place of a body, or of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// The node, an end of a line.
    pub node: usize,
    /// The node of its body or point: number among `Links::masters`.
    pub master: usize,
    /// The line, as number of its range.
    pub line: usize,
    /// Number among all that hangs of that line, ends and directions.
    pub slot: usize,
}

/// Which nodes hang on which.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Links {
    /// Hanging nodes.
    pub links: Vec<Link>,
    /// Ends whose direction is clamped to a free body: the node, and the body as master.
    pub clamped: Vec<Link>,
    /// Nodes of bodies and points.
    pub masters: Vec<usize>,
    /// First node of each line and the one behind its last.
    pub ranges: Vec<(usize, usize)>,
    /// Elements of each line.
    pub elements: Vec<usize>,
    /// The tangent of a line depends on where it is and how it moves alone, not on the time: no waves, nothing that moves it between its ends.
    pub timeless: bool,
}

impl Links {
    /// All that hangs, numbered: ends, then directions.
    pub fn hanging(&self) -> impl Iterator<Item = (usize, &Link)> {
        self.links.iter().chain(&self.clamped).enumerate()
    }
}
