//! Whether a line is at rest, so that steps may be left out as long as its fairlead stays where it is.
//!
//! ```text
//! E = ½ v·M v + ½ r·K⁻¹ r,   r = R(u, 0, 0),   |δT| ≤ √(2 E EA/ℓ)
//! ```
//!
//! E [J] is the energy by which the line differs from equilibrium, to second order: M its inertia with the water moved along, K its
//! static tangent, r the force out of balance. With the ends held it never grows, since the water only takes energy. Even if all of
//! it went into stretching one element of length ℓ, its tension would change by no more than δT [N]. The same holds for lines that meet, with
//! what they hang on.

use crate::rod::line::{Line, Supports};
use crate::rod::motion::Weights;
use crate::rod::physics::Decision;
use crate::rod::state::{Field, State};
use crate::rod::system::System;
use crate::scene::types::Scene;
use crate::solve::newton::{Newton, motion};

/// Whether no tension of the line can change by more than `allowed` [N] while its ends are held. A line without stiffness of its own (a
/// heap of slack line) is not known to be at rest. Drops the factor of the tangent, except where the line obviously moves.
pub fn rests(line: &dyn Line, newton: &mut Newton, state: &State, allowed: f64) -> bool {
    is_near(line, newton, state, enough(line, allowed))
}

/// Twice the energy [J] that changes no tension of a line by more than `allowed` [N].
pub fn enough(line: &dyn Line, allowed: f64) -> f64 {
    let mesh = line.mesh();
    let stiffness = |e: usize| mesh.properties_of(e).ea / mesh.elements[e].length;
    let stiffest = (0..mesh.elements.len()).filter(|e| !mesh.elements[*e].is_joint()).map(stiffness).fold(0.0, f64::max);
    allowed * allowed / stiffest
}

/// Whether a line, or a network, differs from equilibrium by no more than `enough` of twice the energy [J]. Drops the factor of the tangent, except
/// where it obviously moves.
pub fn is_near(system: &dyn System, newton: &mut Newton, state: &State, enough: f64) -> bool {
    let mut force = Field::new(system.nodes());
    system.inertia(&motion(state), &state.v, &mut force);
    let moving = force.dot(&state.v);
    if !(moving <= enough) {
        return false;
    }
    let mut still = State { clock: state.clock, frames: state.frames.clone(), ..State::new(system.nodes()) };
    still.u.copy_from(&state.u);
    system.residual(&motion(&still), &mut force);
    system.gather(&motion(&still), &mut force);
    system.fixed().iter().for_each(|&(node, component)| force.component_mut(component)[node] = 0.0);
    let mut change = force.clone();
    let factored = newton.factor(system, &motion(&still), &Weights { u: 1.0, v: 0.0, a: 0.0 }, None).is_ok();
    newton.solve_linear(system, &mut change);
    newton.forget();
    let stretched = force.dot(&change);
    factored && stretched >= 0.0 && moving + stretched <= enough
}

/// Whether steps are taken of a line at rest.
pub fn decision(scene: &Scene, supports: &Supports) -> Decision {
    let (on, reason) = if scene.solver.uncontrolled_step().is_some() {
        (true, "solver.fixed_step asks for every step")
    } else if scene.environment.current_over_time.is_some() {
        (true, "a current that changes keeps the line in motion")
    } else if scene.environment.waves.is_some() {
        (true, "waves keep the line in motion")
    } else if !supports.holds.is_empty() {
        (true, "constraints may move the line")
    } else {
        (false, "no steps while the fairlead stays and no tension can change by a hundredth of the tolerance")
    };
    Decision { physics: "steps at rest", on, reason: reason.to_string() }
}
