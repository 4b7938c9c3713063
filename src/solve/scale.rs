//! What an error of the tension is measured against.
//!
//! ```text
//! T_s = max(T, T_0),   T_0 = `solver.tension_scale`, or else 0.1 max(W, T_m),   ℓ = T_s/k
//! ```
//!
//! T static tension at the fairlead [N], W weight of the line in water (at least a tenth of that in air) with what hangs on it [N], T_m the largest
//! static tension at the places to which the motion takes the fairlead [N], k static stiffness of the fairlead [N/m]. For a line
//! that is never slack T_s is T. A slack line has an end tension next to nothing, of which a relative error means nothing to anybody.
//! ℓ [m] is the displacement of the fairlead that would change the tension by T_s: what makes an error of position one of tension.

use crate::rod::line::Line;
use crate::rod::state::State;
use crate::scene::types::{self, Scene};
use crate::solve::meshing::{self, SHARE};
use crate::solve::newton::{Newton, motion};

/// T_0/EA above which the tolerance of slopes is strict enough, inverted: it is on the built-in case, whose T_0/EA is 4e-4.
const STRICTNESS: f64 = 4.0e3;
/// Bounds of ℓ as shares of the line's length.
const LENGTHS: [f64; 2] = [1.0e-5, 0.02];
/// The upper bound of a slack line is larger by T_s/T, up to this factor.
const MOST_SLACK: f64 = 16.0;

/// The scale of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// T_0 [N].
    least: f64,
    /// T_0 where the scene does not set it [N].
    own: f64,
}

impl Scale {
    /// The scale of a line of a scene, discretised as `discrete`.
    pub fn of(scene: &Scene, line: &types::Line, discrete: &dyn Line) -> Scale {
        let weight = discrete.mesh().total_weight() + discrete.burden();
        let own = SHARE * weight.max(meshing::largest_tension(scene, line));
        Scale { least: scene.solver.tension_scale.unwrap_or(own), own }
    }

    /// T_s for a tension [N].
    pub fn tension(&self, now: f64) -> f64 {
        now.max(self.least)
    }

    /// How much less than the tolerance of slopes the iteration may leave, at most 1: slopes are strains, and EA times a strain is a tension,
    /// which must be little against T_0.
    pub fn strictness(&self, line: &dyn Line) -> f64 {
        let stiffest = line.mesh().sections.iter().map(|section| section.ea).fold(0.0, f64::max);
        (STRICTNESS * self.own / stiffest).clamp(1.0e-6, 1.0)
    }

    /// ℓ in a static state [m].
    pub fn length(&self, line: &dyn Line, newton: &mut Newton, state: &State) -> f64 {
        let [least, most] = LENGTHS.map(|share| share * line.mesh().length);
        let now = line.end_force(&motion(state)).norm();
        let tension = self.tension(now);
        let most = most * if tension > now { (tension / now).min(MOST_SLACK) } else { 1.0 };
        let stiffness = newton.fairlead_stiffness(line, state).map_or(0.0, |k| k.norm());
        if stiffness > 0.0 { (tension / stiffness).clamp(least, most) } else { most }
    }
}
