//! Rules on waves, and a warning of those that would break.

use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
use crate::scene::types::{Scene, Waves};

/// Most components of a sea.
const MOST_COMPONENTS: usize = 5000;

/// Numbers of the right sign, and a surface that stays above the bed.
pub fn waves(scene: &Scene, file: &str) -> Result<(), Error> {
    let Some(waves) = &scene.environment.waves else { return Ok(()) };
    let at = |key: &str| format!("environment.waves.{key}");
    let one = |place: &str, amplitude: f64, period: f64, direction: f64, phase: f64| {
        not_negative(file, &at(&format!("{place}amplitude")), amplitude, "m")?;
        positive(file, &at(&format!("{place}period")), period, "s")?;
        finite(file, &at(&format!("{place}direction_deg")), &[direction])?;
        finite(file, &at(&format!("{place}phase_deg")), &[phase])
    };
    let count = |count: usize| match count {
        1..=MOST_COMPONENTS => Ok(()),
        _ => refuse(file, at("components"), count.to_string(), format!("a sea has 1 to {MOST_COMPONENTS} components")),
    };
    let (key, down, ramp) = match waves {
        Waves::Regular { amplitude, period, direction_deg, phase_deg, ramp } => {
            one("", *amplitude, *period, *direction_deg, *phase_deg)?;
            ("amplitude", *amplitude, ramp)
        }
        Waves::Jonswap { hs, tp, gamma, components, direction_deg, ramp, .. } => {
            not_negative(file, &at("hs"), *hs, "m")?;
            positive(file, &at("tp"), *tp, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            if !(1.0..=20.0).contains(gamma) {
                return refuse(
                    file,
                    at("gamma"),
                    number(*gamma),
                    "it must lie between 1 and 20; 3.3 is usual, 1 a full-grown sea",
                );
            }
            ("hs", *hs, ramp)
        }
        Waves::Components { components, ramp } => {
            count(components.len())?;
            for (index, c) in components.iter().enumerate() {
                one(&format!("components[{index}]."), c.amplitude, c.period, c.direction_deg, c.phase_deg)?;
            }
            ("components", components.iter().map(|c| c.amplitude).sum(), ramp)
        }
    };
    not_negative(file, &at("ramp"), ramp.unwrap_or(0.0), "s; 0 means none")?;
    let depth = scene.environment.depth;
    if !(down < depth) {
        let allowed = format!("waves so high would bare the seabed, which is {} m below still water", number(depth));
        return refuse(file, at(key), format!("{} m", number(down)), allowed);
    }
    Ok(())
}

/// Warning: waves higher than any can stand, 0.142 of the length in deep water (Michell 1893) or 0.78 of the depth.
pub fn breaking_waves(scene: &Scene) -> Vec<String> {
    let breaks = |place: &str, amplitude: f64, period: f64| {
        let length = scene.environment.gravity * period * period / std::f64::consts::TAU;
        let highest = (0.142 * length).min(0.78 * scene.environment.depth);
        (2.0 * amplitude > highest).then(|| {
            let (height, period, highest) = (number(2.0 * amplitude), number(period), number((100.0 * highest).round() / 100.0));
            format!(
                "{place}: a wave {height} m high of {period} s would break at {highest} m; linear theory does not hold for it"
            )
        })
    };
    match &scene.environment.waves {
        Some(Waves::Regular { amplitude, period, .. }) => breaks("environment.waves", *amplitude, *period).into_iter().collect(),
        Some(Waves::Components { components, .. }) => {
            let place = |index: usize| format!("environment.waves.components[{index}]");
            components.iter().enumerate().filter_map(|(index, c)| breaks(&place(index), c.amplitude, c.period)).collect()
        }
        Some(Waves::Jonswap { hs, tp, .. }) => breaks("environment.waves", 0.5 * hs, *tp).into_iter().collect(),
        None => Vec::new(),
    }
}
