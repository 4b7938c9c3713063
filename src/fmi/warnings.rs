//! What a master should be told though the step was done: each once per line and run, with time, value and what to do.
//!
//! Which have been told is part of the FMU's state: a run that goes back is told what is new to it, and no more.

use crate::fmi::input_path::InputPath;
use crate::solve::simulation::Outputs;

/// What there is to warn of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The fairlead begins far from where the scene has it.
    FarStart,
    /// The fairlead jumps.
    Jump,
    /// More tension than the line bears.
    Breaking,
    /// The fairlead carries next to nothing.
    Slack,
    /// A line that lay on the bed pulls its anchor up.
    Lifted,
    /// The shortest steps left a larger error than was asked for.
    Unresolved,
    /// The velocities are not those of the positions.
    Misfit,
}

/// What has been told, a bit for each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Told(pub u32);

impl Told {
    /// Whether it is new to the master; it is told now.
    fn first(&mut self, kind: Kind) -> bool {
        let bit = 1 << kind as u32;
        let new = self.0 & bit == 0;
        self.0 |= bit;
        new
    }
}

/// What is known of a line that does not change in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Least breaking load of its sections [N]; infinite where none is given.
    pub breaking_load: f64,
    /// Its length [m].
    pub length: f64,
    /// Tension at the fairlead in equilibrium [N].
    pub tension: f64,
    /// Length on the bed in equilibrium [m].
    pub grounded: f64,
}

/// A fairlead that begins farther from the scene's than this share of the line's length is far.
const FAR: f64 = 0.05;
/// Inputs that differ from where the path ended by more than this share of the line's length in one step jump.
const JUMP: f64 = 0.005;
/// Share of its tension in equilibrium below which a line is slack.
const SLACK: f64 = 0.01;

/// Share of its length that lies on the bed in equilibrium where a line is not meant to lift its anchor.
const LYING: f64 = 0.02;
/// Slope at the anchor above which it does: half a degree.
const UPLIFT: f64 = 0.009;

/// A fairlead that begins away from where the scene has it [m].
pub fn of_start(told: &mut Told, distance: f64, length: f64) -> Option<String> {
    (distance > FAR * length && told.first(Kind::FarStart)).then(|| {
        format!(
            "the fairlead begins {distance:.1} m from where the scene has it, {:.0} % of the line's length: is `fairlead.position` set \
             before initialization, in metres, in the frame of the anchor?",
            100.0 * distance / length
        )
    })
}

/// The inputs of a step from `time` lie `distance` [m] from where the path ended.
pub fn of_jump(told: &mut Told, time: f64, step: f64, distance: f64, length: f64) -> Option<String> {
    (distance > JUMP * length && told.first(Kind::Jump)).then(|| {
        format!(
            "t = {time:.4} s: the fairlead is given {distance:.2} m from where its path had led it, in a step of {step:.4} s; the line takes that \
             up as a motion of some {:.1} m/s. Send velocities, or take shorter steps",
            distance / step.max(0.1)
        )
    })
}

/// After a step to `time`: `outputs` there, and whether the shortest steps missed the tolerance.
pub fn of_step(told: &mut Told, time: f64, outputs: &Outputs, limits: &Limits, unresolved: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    let Limits { breaking_load, tension, grounded, .. } = *limits;
    if outputs.tension_max > breaking_load && told.first(Kind::Breaking) {
        warnings.push(format!(
            "t = {time:.4} s: the line carries {:.1} kN, more than its breaking load of {:.1} kN; it is computed on as if it held",
            outputs.tension_max / 1e3,
            breaking_load / 1e3
        ));
    }
    if outputs.tension < SLACK * tension && told.first(Kind::Slack) {
        warnings.push(format!(
            "t = {time:.4} s: the line goes slack: {:.2} kN at the fairlead, of {:.1} kN in equilibrium; expect a snap, and take \
             communication steps that see it",
            outputs.tension / 1e3,
            tension / 1e3
        ));
    }
    let up = outputs.anchor_force.z / outputs.anchor_force.norm().max(f64::MIN_POSITIVE);
    if grounded > LYING * limits.length && up > UPLIFT && told.first(Kind::Lifted) {
        warnings.push(format!(
            "t = {time:.4} s: the line lifts its anchor: it pulls up with {:.1} kN, {:.1} degrees from the bed on which {grounded:.1} m of it lay in \
             equilibrium; the anchor is computed as if it held",
            outputs.anchor_force.z / 1e3,
            up.min(1.0).asin().to_degrees()
        ));
    }
    if unresolved && told.first(Kind::Unresolved) {
        warnings.push(format!(
            "t = {time:.4} s: the motion is rougher than the shortest steps resolve to `solver.tolerance`; give a smoother motion, or a larger \
             tolerance"
        ));
    }
    warnings
}

/// Velocities that are not those of the positions.
pub fn of_inputs(told: &mut Told, time: f64, path: &InputPath) -> Option<String> {
    let axes = path.axes.as_ref()?;
    let worst =
        (0..3).filter(|axis| axes[*axis].fit.misfit).max_by(|a, b| axes[*a].fit.share().total_cmp(&axes[*b].fit.share()))?;
    told.first(Kind::Misfit).then(|| {
        format!(
            "t = {time:.4} s: the velocities on axis {} are not those of the positions: over the last samples they lead {:.0} % of the way \
             elsewhere. Is it the same point, frame, unit, and the whole motion? The positions alone are used from now on",
            ["x", "y", "z"][worst],
            100.0 * axes[worst].fit.share()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_told_once() {
        let mut told = Told::default();
        assert!(of_start(&mut told, 70.0, 1200.0).is_some_and(|text| text.contains("70.0 m")));
        assert!(of_start(&mut told, 70.0, 1200.0).is_none());
        assert!(of_jump(&mut told, 1.0, 0.1, 5.0, 1200.0).is_none());
        assert!(of_jump(&mut told, 1.0, 0.1, 7.0, 1200.0).is_some_and(|text| text.contains("70.0 m/s")));
        assert!(of_jump(&mut told, 2.0, 0.1, 8.0, 1200.0).is_none());
    }

    #[test]
    fn what_a_line_cannot_bear_is_told_with_its_values() {
        let mut told = Told::default();
        let mut outputs = crate::fmi::snapshot::End::at_rest(crate::fmi::inputs::Inputs::default()).outputs;
        (outputs.tension, outputs.tension_max) = (2.0e6, 2.5e6);
        let limits = Limits { breaking_load: 2.4e6, length: 1200.0, tension: 1.0e6, grounded: 0.0 };
        let words = of_step(&mut told, 3.0, &outputs, &limits, true);
        assert!(words.len() == 2 && words[0].contains("2500.0 kN") && words[0].contains("2400.0 kN"), "{words:?}");
        assert!(of_step(&mut told, 4.0, &outputs, &limits, true).is_empty());
    }
}
