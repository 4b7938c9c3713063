//! A line's state at its nodes as files give and take it, and the state of the solver.

use crate::algebra::shape::Shape;
use crate::rod::line::Line;
use crate::rod::state::{Field, State};
use crate::scene::state::{LineState, NodeState};
use crate::scene::types::{Stretch, Triple};
use nalgebra::Vector3;

/// λ at the nodes and in the middle of the element that follows, two numbers per node from the anchor [N].
pub fn tensions(line: &dyn Line, law: Stretch, state: &State, forces: &[Vector3<f64>]) -> Vec<f64> {
    let last = line.last();
    let mut at_points = vec![0.0; 3 * last];
    line.tensions(&state.u, &state.v, &mut at_points);
    let mut tensions = Vec::with_capacity(2 * (last + 1));
    for (node, force) in forces.iter().enumerate() {
        let slope = state.u.slope(node);
        tensions.push(force.dot(&slope) / slope.norm_squared().max(f64::MIN_POSITIVE));
        let stretched = match law {
            Stretch::Exact if node < last => middle_slope(line, &state.u, node).norm().max(f64::MIN_POSITIVE),
            _ => 1.0,
        };
        tensions.push(at_points.get(3 * node + 1).map_or(0.0, |tension| tension / stretched));
    }
    tensions
}

fn middle_slope(line: &dyn Line, u: &Field, e: usize) -> Vector3<f64> {
    let length = line.mesh().elements[e].length.max(f64::MIN_POSITIVE);
    (u.position(e + 1) - u.position(e)) * (1.5 / length) - (u.slope(e) + u.slope(e + 1)) * 0.25
}

/// The nodes of a state, from the fairlead; of a joint the one nearer to the fairlead.
pub fn of(line: &dyn Line, state: &State, tensions: &[f64]) -> LineState {
    let (mesh, last) = (line.mesh(), line.last());
    let kept = |node: &usize| *node == last || !mesh.elements[*node].is_joint();
    let node_state = |node: usize| NodeState {
        s: mesh.length - mesh.node_arc_length(node),
        position: state.u.position(node).into(),
        slope: (-state.u.slope(node)).into(),
        velocity: state.v.position(node).into(),
        slope_rate: (-state.v.slope(node)).into(),
        lambda: tensions[2 * node],
        lambda_before: if node == last { 0.0 } else { tensions[2 * node + 1] },
    };
    LineState { time: state.clock.now, nodes: (0..=last).rev().filter(kept).map(node_state).collect() }
}

/// Sets positions, slopes and their rates; returns λ as `tensions` has it, or none, and nothing changed, if the line is longer than what
/// is given.
pub fn set(line: &dyn Line, given: &LineState, state: &mut State) -> Option<Vec<f64>> {
    let mesh = line.mesh();
    let at = |node: usize| between(given, mesh.length - mesh.node_arc_length(node), 1e-6 * mesh.length);
    let nodes = (0..=line.last()).map(at).collect::<Option<Vec<NodeState>>>()?;
    let mut tensions = Vec::with_capacity(2 * nodes.len());
    for (node, from) in nodes.iter().enumerate() {
        state.u.set_position(node, &from.position.into());
        state.u.set_slope(node, &-Vector3::from(from.slope));
        state.v.set_position(node, &from.velocity.into());
        state.v.set_slope(node, &-Vector3::from(from.slope_rate));
        tensions.extend([from.lambda, if node == line.last() { 0.0 } else { from.lambda_before }]);
    }
    Some(tensions)
}

/// The given node at s, if one is there within `near` [m], else a place on the cubics through those on either side.
fn between(given: &LineState, s: f64, near: f64) -> Option<NodeState> {
    let after = given.nodes.partition_point(|node| node.s < s - near);
    let next = given.nodes.get(after)?;
    if next.s <= s + near {
        return Some(*next);
    }
    let before = given.nodes.get(after.checked_sub(1)?)?;
    let length = next.s - before.s;
    let x = (s - before.s) / length;
    let shape = Shape::at(x).scaled(length);
    let cubic = |weights: &[f64; 4], ends: [Triple; 4]| -> Triple {
        std::array::from_fn(|axis| weights.iter().zip(&ends).map(|(weight, end)| weight * end[axis]).sum())
    };
    let places = [before.position, before.slope, next.position, next.slope];
    let rates = [before.velocity, before.slope_rate, next.velocity, next.slope_rate];
    Some(NodeState {
        s,
        position: cubic(&shape.value, places),
        slope: cubic(&shape.slope, places),
        velocity: cubic(&shape.value, rates),
        slope_rate: cubic(&shape.slope, rates),
        lambda: before.lambda + x * (next.lambda - before.lambda),
        lambda_before: next.lambda_before,
    })
}
