//! Where a run begins that is given the nodes of its line: in the equilibrium that they mean, or at the nodes as they stand.
//!
//! A file gives positions and slopes in a few decimals, and those of the 1994 program belong to other elements. Taken as they stand, a
//! line of stiff elements would start with a jolt. So where the nodes are at rest and equilibrium is near, the run starts from that.

use crate::error::Error;
use crate::scene::state::LineState;
use crate::solve::simulation::{Simulation, StaticsReport};
use nalgebra::Vector3;

/// Equilibrium is near where no node is farther from it than this share of the line's length.
const NEAR: f64 = 2.0e-4;

/// Where a run begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Departure {
    /// The nodes are those of an equilibrium.
    Equilibrium(StaticsReport),
    /// The nodes are at rest, but far from equilibrium: this node, counted from 1, by this distance [m]. The run begins from them.
    Unbalanced {
        /// The node that is farthest from where it would rest.
        node: usize,
        /// How far [m].
        distance: f64,
    },
    /// The nodes are at rest, and no equilibrium was found. The run begins from them.
    Unsettled,
    /// The nodes move. The run begins from them.
    Moving,
    /// The nodes are those of a shorter line. The run begins in equilibrium.
    Foreign(StaticsReport),
}

/// Begins from given nodes, with the fairlead at the place that its path has then. `exactly`: from the nodes as they stand even where
/// equilibrium is near, as a line of the file's own elements can.
pub fn depart(line: &mut Simulation, given: &LineState, fairlead: Vector3<f64>, exactly: bool) -> Result<Departure, Error> {
    let settled = given.at_rest().then(|| line.settle(fairlead, given.time));
    let (node, distance) = farthest(&line.line_state(), given);
    let is_near = distance <= NEAR * given.nodes.last().map_or(0.0, |last| last.s);
    let departure = match &settled {
        None => Departure::Moving,
        Some(Ok(report)) if is_near => Departure::Equilibrium(*report),
        Some(Ok(_)) => Departure::Unbalanced { node, distance },
        Some(Err(_)) => Departure::Unsettled,
    };
    if matches!(departure, Departure::Equilibrium(_)) && !exactly || line.start_from(given) {
        return Ok(departure);
    }
    settled.unwrap_or_else(|| line.settle(fairlead, given.time)).map(Departure::Foreign)
}

/// The node of the first state that is farthest from its like in the second, counted from 1, and the distance [m].
fn farthest(one: &LineState, other: &LineState) -> (usize, f64) {
    let distances = other.nodes.iter().enumerate().filter_map(|(number, node)| {
        let near = one.nodes.iter().find(|candidate| (candidate.s - node.s).abs() <= 1e-6 * node.s.max(1.0))?;
        Some((number + 1, (Vector3::from(near.position) - Vector3::from(node.position)).norm()))
    });
    distances.fold((0, 0.0), |far, at| if at.1 > far.1 { at } else { far })
}
