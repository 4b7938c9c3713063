//! Rules on waves, and a warning of those that would break.

use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
use crate::scene::types::{OchiHubblePart, Scene, Waves};

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
        Waves::Jonswap { hs, tp, gamma, components, direction_deg, cut_off, ramp, .. } => {
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
            above_the_peak(file, *cut_off, tp.recip())?;
            ("hs", *hs, ramp)
        }
        Waves::PiersonMoskowitz { hs, tp, components, direction_deg, cut_off, ramp, .. } => {
            not_negative(file, &at("hs"), *hs, "m")?;
            positive(file, &at("tp"), *tp, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            above_the_peak(file, *cut_off, tp.recip())?;
            ("hs", *hs, ramp)
        }
        Waves::OchiHubble { parts, components, direction_deg, cut_off, ramp, .. } => {
            for (index, part) in parts.iter().enumerate() {
                ochi_hubble(file, &at(&format!("parts[{index}].")), part)?;
            }
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            above_the_peak(file, *cut_off, parts[0].tp.min(parts[1].tp).recip())?;
            ("parts", parts[0].hs.hypot(parts[1].hs), ramp)
        }
        Waves::Table { spectrum, components, direction_deg, cut_off, ramp, .. } => {
            table(file, &at("spectrum"), spectrum)?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            let (height, period) = waves.significant().unwrap_or_default();
            above_the_peak(file, *cut_off, period.recip())?;
            ("spectrum", height, ramp)
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

/// A frequency [Hz] above which nothing is left, above that of the peak.
fn above_the_peak(file: &str, cut_off: Option<f64>, peak: f64) -> Result<(), Error> {
    match cut_off {
        Some(cut_off) if !(cut_off > peak && cut_off.is_finite()) => refuse(
            file,
            "environment.waves.cut_off",
            format!("{} Hz", number(cut_off)),
            format!(
                "it must lie above the peak of the spectrum, which is at {:.4} Hz, or most of the sea would be left out",
                peak
            ),
        ),
        _ => Ok(()),
    }
}

/// One part of an Ochi–Hubble sea; `place` ends with a dot.
fn ochi_hubble(file: &str, place: &str, part: &OchiHubblePart) -> Result<(), Error> {
    not_negative(file, &format!("{place}hs"), part.hs, "m")?;
    positive(file, &format!("{place}tp"), part.tp, "s")?;
    if !(1.0..=20.0).contains(&part.lambda) {
        let allowed = "it must lie between 1 and 20; 1 is a full-grown sea, 3 to 9 a swell";
        return refuse(file, format!("{place}lambda"), number(part.lambda), allowed);
    }
    Ok(())
}

/// Frequencies that rise, densities that are not negative, and some energy.
fn table(file: &str, place: &str, rows: &[[f64; 2]]) -> Result<(), Error> {
    if rows.len() < 2 {
        return refuse(
            file,
            place,
            format!("a table of {} rows", rows.len()),
            "a spectrum has at least 2 rows [f in Hz, S in m²/Hz]",
        );
    }
    for (index, [frequency, density]) in rows.iter().enumerate() {
        let at = format!("{place}[{index}]");
        finite(file, &at, &[*frequency, *density])?;
        if !(*frequency >= 0.0) {
            return refuse(file, at, format!("f = {} Hz", number(*frequency)), "a frequency is 0 or greater");
        }
        if !(*density >= 0.0) {
            return refuse(file, at, format!("S = {} m²/Hz", number(*density)), "a spectral density is 0 or greater");
        }
        if *frequency == 0.0 && *density > 0.0 {
            return refuse(
                file,
                at,
                format!("S = {} m²/Hz", number(*density)),
                "at f = 0 it must be 0: no wave has that frequency",
            );
        }
        if index > 0 && !(*frequency > rows[index - 1][0]) {
            let allowed = format!("frequencies must rise, and the row before has f = {} Hz", number(rows[index - 1][0]));
            return refuse(file, at, format!("f = {} Hz", number(*frequency)), allowed);
        }
    }
    if rows.iter().all(|row| row[1] == 0.0) {
        return refuse(file, place, "a spectrum of zeros", "it must hold some energy; leave `waves` out for a calm sea");
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
        Some(sea) => {
            let given = sea.significant().into_iter();
            given.filter_map(|(hs, tp)| breaks("environment.waves", 0.5 * hs, tp)).collect()
        }
        None => Vec::new(),
    }
}
