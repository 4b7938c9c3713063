//! Rules on bodies and constraints at points of a line, and warnings of what has no effect there.

use crate::error::Error;
use crate::scene::check::finding::{self, distance, finite, not_negative, number, refuse, sinusoid, triple};
use crate::scene::types::{Line, Motion, ReferenceMotion, Scene, Triple};

pub fn attachments(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, body) in line.attachments.iter().enumerate() {
            let at = |key: &str| format!("lines[{index}].attachments[{number}].{key}");
            on_the_line(file, &at("s"), body.s, line)?;
            not_negative(file, &at("mass"), body.mass, "kg")?;
            not_negative(file, &at("volume"), body.volume, "m³")?;
            not_negative(file, &at("drag_area"), body.drag_area, "m²")?;
            not_negative(file, &at("added_mass"), body.added_mass, "kg")?;
        }
    }
    Ok(())
}

pub fn constraints(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, constraint) in line.constraints.iter().enumerate() {
            let at = |key: &str| format!("lines[{index}].constraints[{number}].{key}");
            on_the_line(file, &at("s"), constraint.s, line)?;
            if let Some(twin) = line.constraints[..number].iter().position(|other| other.s == constraint.s) {
                let allowed = format!("constraints[{twin}] is there already; say all that holds one point in one constraint");
                return refuse(file, at("s"), finding::number(constraint.s), allowed);
            }
            two_directions(file, &at("axes"), &constraint.axes)?;
            finite(file, &at("reference"), &constraint.reference.unwrap_or_default())?;
            for axis in 0..3 {
                not_negative(file, &at(&format!("stiffness[{axis}]")), constraint.stiffness[axis], "N/m")?;
                not_negative(file, &at(&format!("damping[{axis}]")), constraint.damping[axis], "N·s/m")?;
            }
            finite(file, &at("force"), &constraint.force)?;
            not_negative(file, &at("mass"), constraint.mass, "kg")?;
            not_negative(file, &at("added_mass"), constraint.added_mass, "kg")?;
            if let Some(ReferenceMotion { period, sine, cosine, ramp }) = &constraint.motion {
                sinusoid(file, &at("motion"), *period, [sine, cosine], *ramp)?;
            }
        }
    }
    Ok(())
}

fn on_the_line(file: &str, place: &str, s: f64, line: &Line) -> Result<(), Error> {
    let length = line.length();
    if (0.0..=length * (1.0 + 1.0e-9)).contains(&s) {
        return Ok(());
    }
    let allowed = format!("it must lie on the line, between 0 (fairlead) and {} m (anchor)", number(length));
    refuse(file, place, number(s), allowed)
}

/// Two directions span axes when neither vanishes and they are not parallel (within a ten-thousandth of a radian).
fn two_directions(file: &str, place: &str, axes: &[Triple; 2]) -> Result<(), Error> {
    let [first, second] = axes;
    finite(file, place, first)?;
    finite(file, place, second)?;
    let size = |a: &Triple| distance([0.0; 3], *a);
    let cross = [0, 1, 2].map(|c| first[(c + 1) % 3] * second[(c + 2) % 3] - first[(c + 2) % 3] * second[(c + 1) % 3]);
    if !(size(&cross) > 1.0e-4 * size(first) * size(second)) {
        let value = format!("[{}, {}]", triple(*first), triple(*second));
        return refuse(file, place, value, "give two directions of some length that are not parallel");
    }
    Ok(())
}

/// Warnings: bodies and forces that load a support instead of the line, and a motion that nothing follows.
pub fn without_effect(scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, body) in line.attachments.iter().enumerate() {
            if line.end_at(body.s).is_some() && line.is_pinned(body.s) {
                let place = format!("lines[{index}].attachments[{number}]");
                warnings.push(format!("{place} sits on a pinned end: it loads what holds the line, and nothing else changes"));
            }
        }
        if scene.motion != Motion::Fixed && !line.is_pinned(0.0) && line.fairlead_on.is_none() {
            let line = format!("lines[{index}]");
            warnings.push(format!(
                "motion does not move the fairlead of {line}, which a constraint holds; give that constraint a motion of its own"
            ));
        }
    }
    warnings
}
