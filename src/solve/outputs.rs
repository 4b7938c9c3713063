//! What a line tells about itself at one instant.

use crate::rod::line::Line;
use crate::rod::state::State;
use crate::solve::newton::motion;
use nalgebra::Vector3;

/// What a line tells about itself at one instant. Forces are those on what holds an end: of the line, and where the end is pinned, of the
/// clumps and buoys at it. (Where a constraint releases the end, it holds line and bodies alike, and the force is the line's on both.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// Time [s].
    pub time: f64,
    /// Position of the fairlead [m].
    pub fairlead: Vector3<f64>,
    /// Force on the vessel [N].
    pub force: Vector3<f64>,
    /// |force| [N]: the effective tension at the fairlead, unless a body is there.
    pub tension: f64,
    /// Moment on the vessel [N·m]; zero unless the fairlead is clamped.
    pub moment: Vector3<f64>,
    /// Position of the anchor [m].
    pub anchor: Vector3<f64>,
    /// Force on the anchor [N].
    pub anchor_force: Vector3<f64>,
    /// Moment on the anchor [N·m]; zero unless it is clamped.
    pub anchor_moment: Vector3<f64>,
    /// |anchor_force| [N], as `tension`.
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

impl Outputs {
    /// Place of an end [m], force on what holds it [N], and the moment on that [N·m].
    pub fn of_end(&self, anchor: bool) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
        if anchor { (self.anchor, self.anchor_force, self.anchor_moment) } else { (self.fairlead, self.force, self.moment) }
    }
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
    /// Tension of the wall [N], where the pressures on it are known: T - p_o A_o + p_i A_i.
    pub wall_tension: Option<f64>,
}

/// Outputs of a state. End forces and node tensions are consistent nodal reactions, not stiffness times strain: 10 to 40 times
/// more accurate on the same mesh. `forces` is room for those of the nodes.
pub fn outputs(line: &dyn Line, state: &State, time: f64, work: f64, forces: &mut Vec<Vector3<f64>>) -> Outputs {
    forces.clear();
    forces.resize(line.last() + 1, Vector3::zeros());
    line.node_forces(&motion(state), forces);
    from_forces(line, state, forces, time, work)
}

/// Force that the fairlead side exerts on the anchor side at every node [N].
pub fn node_forces(line: &dyn Line, state: &State) -> Vec<Vector3<f64>> {
    let mut forces = vec![Vector3::zeros(); line.last() + 1];
    line.node_forces(&motion(state), &mut forces);
    forces
}

/// Force on what holds the anchor [N].
pub fn anchor_force(line: &dyn Line, state: &State) -> Vector3<f64> {
    node_forces(line, state)[0] - line.held_bodies(0, &motion(state))
}

/// Outputs of a state with given forces at the nodes [N], as `Line::node_forces` gives them.
pub fn from_forces(line: &dyn Line, state: &State, forces: &[Vector3<f64>], time: f64, work: f64) -> Outputs {
    let last = line.last();
    let at = motion(state);
    let (force, anchor_force) = (-forces[last] - line.held_bodies(last, &at), forces[0] - line.held_bodies(0, &at));
    Outputs {
        time,
        fairlead: state.u.position(last),
        force,
        tension: force.norm(),
        moment: line.end_moment(last, &at),
        anchor_moment: line.end_moment(0, &at),
        anchor: state.u.position(0),
        anchor_force,
        anchor_tension: anchor_force.norm(),
        tension_max: forces.iter().map(Vector3::norm).fold(0.0, f64::max),
        declination: force.x.hypot(force.y).atan2(-force.z),
        azimuth: if force.x == 0.0 && force.y == 0.0 { 0.0 } else { force.y.atan2(force.x) },
        grounded_length: line.grounded_length(&state.u),
        work,
    }
}

/// Change of the outputs for a change of the state, by a central difference of the output functions with a step of ± `step` times
/// the change, of which `seconds` is the change of time. Time and work are zero.
pub fn along(line: &dyn Line, state: &State, change: &State, seconds: f64, step: f64) -> Outputs {
    let mut forces = Vec::new();
    let mut moved = |factor: f64| {
        let mut moved = state.clone();
        moved.u.add(factor, &change.u);
        moved.v.add(factor, &change.v);
        moved.a.add(factor, &change.a);
        moved.holds.add(factor, &change.holds);
        moved.clock.now += factor * seconds;
        outputs(line, &moved, 0.0, 0.0, &mut forces)
    };
    difference(&moved(step), &moved(-step), 0.5 / step)
}

/// The difference of two outputs times a factor; time and work are zero.
pub fn difference(after: &Outputs, before: &Outputs, per: f64) -> Outputs {
    let turn = after.azimuth - before.azimuth;
    Outputs {
        time: 0.0,
        fairlead: (after.fairlead - before.fairlead) * per,
        force: (after.force - before.force) * per,
        tension: (after.tension - before.tension) * per,
        moment: (after.moment - before.moment) * per,
        anchor_moment: (after.anchor_moment - before.anchor_moment) * per,
        anchor: (after.anchor - before.anchor) * per,
        anchor_force: (after.anchor_force - before.anchor_force) * per,
        anchor_tension: (after.anchor_tension - before.anchor_tension) * per,
        tension_max: (after.tension_max - before.tension_max) * per,
        declination: (after.declination - before.declination) * per,
        azimuth: turn.sin().atan2(turn.cos()) * per,
        grounded_length: (after.grounded_length - before.grounded_length) * per,
        work: 0.0,
    }
}

/// Force and place of the fairlead, and their changes for a change of the state.
pub struct EndChange {
    /// Force on what holds it [N].
    pub force: Vector3<f64>,
    /// Position [m].
    pub place: Vector3<f64>,
    /// Change of the force [N].
    pub force_change: Vector3<f64>,
    /// Change of the position [m].
    pub place_change: Vector3<f64>,
}

/// The fairlead along a change of the state.
pub fn end_along(line: &dyn Line, state: &State, change: &State) -> EndChange {
    let step = 1.0e-4;
    let force = |factor: f64| {
        let mut moved = state.clone();
        moved.u.add(factor, &change.u);
        moved.v.add(factor, &change.v);
        moved.a.add(factor, &change.a);
        moved.holds.add(factor, &change.holds);
        line.end_force(&motion(&moved))
    };
    EndChange {
        force: line.end_force(&motion(state)),
        place: state.u.position(line.last()),
        force_change: (force(step) - force(-step)) * (0.5 / step),
        place_change: change.u.position(line.last()),
    }
}

/// Nodes of a state, from the fairlead. Of the two nodes of a joint one is left out, unless something acts there: then slope and
/// tension jump, and both stand at one place.
pub fn nodes(line: &dyn Line, state: &State) -> Vec<NodeOutput> {
    nodes_from_forces(line, state, &node_forces(line, state))
}

/// The same with given forces at the nodes [N].
pub fn nodes_from_forces(line: &dyn Line, state: &State, forces: &[Vector3<f64>]) -> Vec<NodeOutput> {
    let mesh = line.mesh();
    let last = line.last();
    let kept = |node: &usize| *node == last || !mesh.elements[*node].is_joint() || mesh.points.contains(node);
    let node_output = |node: usize| {
        let p = state.u.slope(node);
        let tangent = if p.norm() > 0.0 { -p.normalize() } else { Vector3::zeros() };
        let tension = forces[node].norm().copysign(-forces[node].dot(&tangent));
        let position = state.u.position(node);
        // At the end of a section the section below counts.
        let pressures = mesh.elasticity_of(node.min(last - 1)).pressures;
        let wall_tension = pressures.map(|pressures| tension - pressures.force(position.z));
        NodeOutput { s: mesh.length - mesh.node_arc_length(node), position, tangent, tension, wall_tension }
    };
    (0..=last).rev().filter(kept).map(node_output).collect()
}
