//! Whether a line stays in one vertical plane, so that nothing across it needs to be solved for.
//!
//! The plane is one of constant y. That all stays in it follows from the scene and the motion of the fairlead; a line that is not as
//! promised later on, goes on in space.

use crate::rod::line::Supports;
use crate::rod::physics::{Decision, Surroundings};
use crate::rod::seabed::Plane;
use crate::scene::types::{self, Scene, Scheme};
use crate::sea::current::Current;
use crate::solve::motion::Ends;

/// Whether a line whose ends take paths (none: any) is solved in a plane, and why.
pub fn decision(scene: &Scene, line: &types::Line, around: &Surroundings, supports: &Supports, ends: Option<&Ends>) -> Decision {
    let [y, fairlead] = [line.anchor[1], line.fairlead[1]];
    let across = |current: &Current| current.flows_across();
    let obstacle = if scene.solver.scheme == Scheme::Cable1994 {
        Some("cable-1994 is solved in space")
    } else if y != fairlead {
        Some("anchor and fairlead differ in y")
    } else if ends.is_none_or(|ends| !ends.fairlead.stays_at(y, f64::NEG_INFINITY, f64::INFINITY)) {
        Some("the fairlead may move across the plane of the line")
    } else if ends.is_none_or(|ends| !ends.anchor.stays_at(y, f64::NEG_INFINITY, f64::INFINITY)) {
        Some("the anchor may move across the plane of the line")
    } else if around.current.as_ref().is_some_and(across) {
        Some("the current flows across")
    } else if Plane::of(&scene.environment).normal.y != 0.0 {
        Some("the bed slopes across")
    } else if !(supports.holds.is_empty() && supports.clamps.is_empty()) {
        Some("constraints and clamped ends are solved in space")
    } else if around.waves.is_some() {
        Some("waves are solved in space")
    } else {
        None
    };
    let reason = obstacle.unwrap_or("line, motion and flow stay in a plane of constant y");
    Decision { physics: "third dimension", on: obstacle.is_some(), reason: reason.to_string() }
}
