//! Whether a line reaches from end to end without breaking.

use crate::error::{Error, Limit, Reach};
use crate::scene::check::finding::distance;
use crate::scene::types::{Line, LineType, Scene};

/// A line may be shorter than the distance of its ends: it stretches, but neither to twice its length nor beyond a breaking load. An
/// end that a constraint holds comes nearer by itself.
pub fn reach(scene: &Scene, file: &str) -> Result<(), Error> {
    let held = |line: &Line| {
        let free = scene.is_on_free(line.fairlead_on.as_ref()) || scene.is_on_free(line.anchor_on.as_ref());
        line.is_pinned(0.0) && line.is_pinned(line.length()) && !free
    };
    for (index, line) in scene.lines.iter().enumerate().filter(|(_, line)| held(line)) {
        let (length, distance) = (line.length(), distance(line.fairlead, line.anchor));
        let stretch = distance / length - 1.0;
        let limit = weakest(scene, line)
            .filter(|limit| matches!(limit, Limit::Breaks { strain, .. } if *strain <= 1.0))
            .unwrap_or(Limit::Doubles);
        let allowed = match &limit {
            Limit::Breaks { strain, .. } => *strain,
            Limit::Doubles => 1.0,
        };
        if !(stretch <= allowed * (1.0 + 1.0e-9)) {
            return Err(Error::Reach(Box::new(Reach {
                file: file.into(),
                place: format!("lines[{index}]"),
                line: line.name.clone(),
                length,
                fairlead: line.fairlead,
                anchor: line.anchor,
                distance,
                stretch,
                limit,
                lengthen: rounded_up(distance / (1.0 + allowed) - length),
            })));
        }
    }
    Ok(())
}

/// The line type that breaks first when a line is pulled, and the mean strain of the line at that tension.
/// Sections in a row carry one tension T and stretch by T Σ(length/EA); weight is left aside.
fn weakest(scene: &Scene, line: &Line) -> Option<Limit> {
    let used: Vec<(&String, &LineType, f64)> = line
        .sections
        .iter()
        .filter_map(|section| Some((&section.line_type, scene.line_types.get(&section.line_type)?, section.length)))
        .collect();
    let compliance: f64 = used.iter().map(|(_, line_type, length)| length / line_type.ea).sum();
    let loads = used.iter().filter_map(|(name, line_type, _)| Some((name, line_type.breaking_load?)));
    let (name, load) = loads.min_by(|one, other| one.1.total_cmp(&other.1))?;
    Some(Limit::Breaks { line_type: (*name).clone(), strain: load * compliance / line.length() })
}

/// Rounded up to two digits, and to whole metres from 10 m on.
fn rounded_up(length: f64) -> f64 {
    let step = 10f64.powf((length.log10().floor() - 1.0).clamp(-6.0, 0.0));
    // Dividing by the whole number 1/step keeps 0.1 from becoming 0.1000…01.
    let per_step = (1.0 / step).round();
    (length * per_step).ceil() / per_step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_length_is_rounded_up_never_down() {
        assert_eq!(rounded_up(46.2), 47.0);
        assert_eq!(rounded_up(1234.5), 1235.0);
        assert_eq!(rounded_up(0.1234), 0.13);
        assert_eq!(rounded_up(3.0), 3.0);
    }
}
