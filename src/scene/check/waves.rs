//! Rules on waves, and a warning of those that would break.

use crate::algebra::stokes::{self, Stokes};
use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
use crate::scene::elevation_file::{Fault, Record};
use crate::scene::types::{OchiHubblePart, Scene, Spreading, Stretching, Waves};

/// Most components of a sea.
const MOST_COMPONENTS: usize = 5000;
/// Most components of a record of an elevation.
const MOST_OF_A_RECORD: usize = 50_000;

/// Numbers of the right sign in every sea, one stretching for all, and a surface that stays above the bed.
pub fn waves(scene: &Scene, file: &str) -> Result<(), Error> {
    let Some(seas) = &scene.environment.waves else { return Ok(()) };
    if seas.each().is_empty() {
        let allowed = "a list holds at least one sea; leave `waves` out for a calm sea";
        return refuse(file, "environment.waves", "an empty list", allowed);
    }
    let (depth, shared) = (scene.environment.depth, seas.stretching());
    let mut all = 0.0;
    for (index, waves) in seas.each().iter().enumerate() {
        let place = seas.place(index);
        let (key, down) = sea(waves, &place, file)?;
        if let Waves::Regular5th { height, period, .. } = waves {
            steep(scene, *height, *period, &place, file)?;
            if seas.each().len() > 1 {
                let allowed = "a wave of the fifth order does not add to others; give it alone, or all waves by linear theory";
                return refuse(file, place, "\"regular-5th\" in a list of seas", allowed);
            }
        }
        if waves.stretching().is_some_and(|own| own != shared) {
            let allowed = format!(
                "the seas of a list make one surface and have one stretching, and another of them has \"{}\"",
                word(shared)
            );
            let found = format!("\"{}\"", word(waves.stretching().unwrap_or_default()));
            return refuse(file, format!("{place}.stretching"), found, allowed);
        }
        all += down;
        if !(all < depth) {
            let allowed = format!("waves so high would bare the seabed, which is {} m below still water", number(depth));
            let found = if all > down { "with the seas before it " } else { "" };
            return refuse(file, format!("{place}.{key}"), format!("{found}{} m", number(all)), allowed);
        }
    }
    Ok(())
}

/// A stretching as it is written in a scene.
fn word(stretching: Stretching) -> &'static str {
    match stretching {
        Stretching::Wheeler => "wheeler",
        Stretching::None => "none",
        Stretching::Vertical => "vertical",
        Stretching::Extrapolation => "extrapolation",
    }
}

/// Numbers of the right sign in the sea at a place; which key says how high it is, and how far the surface may fall [m].
fn sea(waves: &Waves, place: &str, file: &str) -> Result<(&'static str, f64), Error> {
    let at = |key: &str| format!("{place}.{key}");
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
        Waves::Regular { amplitude, period, direction_deg, phase_deg, ramp, .. } => {
            one("", *amplitude, *period, *direction_deg, *phase_deg)?;
            ("amplitude", *amplitude, ramp)
        }
        Waves::Regular5th { height, period, direction_deg, phase_deg, ramp } => {
            positive(file, &at("height"), *height, "m")?;
            positive(file, &at("period"), *period, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            finite(file, &at("phase_deg"), &[*phase_deg])?;
            ("height", 0.5 * *height, ramp)
        }
        Waves::Jonswap { hs, tp, gamma, components, direction_deg, cut_off, ramp, .. } => {
            not_negative(file, &at("hs"), *hs, "m")?;
            positive(file, &at("tp"), *tp, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            if !(1.0..=20.0).contains(gamma) {
                let allowed = "it must lie between 1 and 20; 3.3 is usual, 1 a full-grown sea";
                refuse(file, at("gamma"), number(*gamma), allowed)?;
            }
            above_the_peak(file, &at("cut_off"), *cut_off, tp.recip())?;
            ("hs", *hs, ramp)
        }
        Waves::PiersonMoskowitz { hs, tp, components, direction_deg, cut_off, ramp, .. } => {
            not_negative(file, &at("hs"), *hs, "m")?;
            positive(file, &at("tp"), *tp, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            above_the_peak(file, &at("cut_off"), *cut_off, tp.recip())?;
            ("hs", *hs, ramp)
        }
        Waves::OchiHubble { parts, components, direction_deg, cut_off, ramp, .. } => {
            for (index, part) in parts.iter().enumerate() {
                ochi_hubble(file, &at(&format!("parts[{index}].")), part)?;
            }
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            above_the_peak(file, &at("cut_off"), *cut_off, parts[0].tp.min(parts[1].tp).recip())?;
            ("parts", parts[0].hs.hypot(parts[1].hs), ramp)
        }
        Waves::Table { spectrum, components, direction_deg, cut_off, ramp, .. } => {
            table(file, &at("spectrum"), spectrum)?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            let (height, period) = waves.significant().unwrap_or_default();
            above_the_peak(file, &at("cut_off"), *cut_off, period.recip())?;
            ("spectrum", height, ramp)
        }
        Waves::Elevation { path, series, at: [x, y], direction_deg, cut_off, ramp, .. } => {
            finite(file, &at("at"), &[*x, *y])?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            if let Some(cut_off) = cut_off {
                positive(file, &at("cut_off"), *cut_off, "Hz")?;
            }
            let down = match (path, series) {
                (Some(_), None) => 0.0,
                (None, Some(series)) => elevation(series, *cut_off, &at("series"), &at("cut_off"), file)?,
                (None, None) => {
                    let allowed = "it must have `path`, a CSV file of rows t,eta, or `series`, a list of such rows";
                    return refuse(file, place, "an elevation without a record", allowed).map(|()| ("", 0.0));
                }
                (Some(_), Some(_)) => {
                    let allowed = "give `path` or `series`, not both";
                    return refuse(file, place, "an elevation with two records", allowed).map(|()| ("", 0.0));
                }
            };
            ("series", down, ramp)
        }
        Waves::Components { components, ramp, .. } => {
            count(components.len())?;
            for (index, c) in components.iter().enumerate() {
                one(&format!("components[{index}]."), c.amplitude, c.period, c.direction_deg, c.phase_deg)?;
            }
            ("components", components.iter().map(|c| c.amplitude).sum(), ramp)
        }
    };
    not_negative(file, &at("ramp"), ramp.unwrap_or(0.0), "s; 0 means none")?;
    waves.spreading().map_or(Ok(()), |spreading| spread(file, &at("spreading"), spreading))?;
    Ok((key, down))
}

/// Evenly spaced rows that rise in time, a cut-off above their peak, and not more components than can be summed; their height [m].
fn elevation(series: &[[f64; 2]], cut_off: Option<f64>, place: &str, cut: &str, file: &str) -> Result<f64, Error> {
    let record = match Record::new(series) {
        Ok(record) => record,
        Err(Fault { row, found, allowed }) => {
            let place = row.map_or(place.to_string(), |row| format!("{place}[{row}]"));
            return refuse(file, place, found, allowed).map(|()| 0.0);
        }
    };
    above_the_peak(file, cut, cut_off, record.peak)?;
    let count = record.up_to(record.cut_off(cut_off)).len();
    if count > MOST_OF_A_RECORD {
        let allowed = format!(
            "up to {:.4} Hz it has more than {MOST_OF_A_RECORD}; lower `cut_off` or cut the record",
            record.cut_off(cut_off)
        );
        refuse(file, place, format!("a record of {count} components"), allowed)?;
    }
    Ok(4.0 * record.variance(record.cut_off(cut_off)).sqrt())
}

/// Neither higher than a wave can stand nor longer than the fifth order holds for.
fn steep(scene: &Scene, height: f64, period: f64, place: &str, file: &str) -> Result<(), Error> {
    let (gravity, depth) = (scene.environment.gravity, scene.environment.depth);
    let metres = |value: f64| format!("{} m", number((100.0 * value).round() / 100.0));
    let Some(wave) = Stokes::new(height, period, gravity, depth) else {
        let allowed = format!("no wave of the fifth order of {} s is so high in {} of water", number(period), metres(depth));
        return refuse(file, format!("{place}.height"), metres(height), allowed);
    };
    let length = wave.length();
    let highest = stokes::highest(length, depth);
    if !(height <= highest) {
        let allowed =
            format!("a wave of this period is {} long here and breaks at {} (Fenton 1990)", metres(length), metres(highest));
        return refuse(file, format!("{place}.height"), metres(height), allowed);
    }
    let long = height * length * length / depth.powi(3);
    if !(long <= stokes::LONGEST) {
        let allowed = format!(
            "height × length² / depth³ is {} and the fifth order holds up to {} (Hedges 1995): the wave is too long for the depth",
            number((10.0 * long).round() / 10.0),
            stokes::LONGEST
        );
        return refuse(file, format!("{place}.period"), format!("{} s, {} long,", number(period), metres(length)), allowed);
    }
    Ok(())
}

/// Said once how much, and within what a spectrum of directions can be.
fn spread(file: &str, place: &str, spreading: &Spreading) -> Result<(), Error> {
    let Spreading { s, deviation_deg, directions } = spreading;
    match (s, deviation_deg) {
        (None, None) => {
            let allowed = "it must have `s`, the exponent of cos^2s(θ/2), or `deviation_deg`, the standard deviation";
            return refuse(file, place, "spreading without a measure", allowed);
        }
        (Some(_), Some(_)) => {
            let allowed = "`s` and `deviation_deg` say the same thing; leave one of them out";
            return refuse(file, place, "spreading with two measures", allowed);
        }
        (Some(s), None) if !(1.0..=1000.0).contains(s) => {
            let allowed = "it must lie between 1 and 1000; a wind sea has 5 to 15, a swell 25 to 75";
            return refuse(file, format!("{place}.s"), number(*s), allowed);
        }
        (None, Some(deviation)) if !(2.6..=57.0).contains(deviation) => {
            let allowed = "it must lie between 2.6 and 57 degrees; leave `spreading` out for a sea of one direction";
            return refuse(file, format!("{place}.deviation_deg"), number(*deviation), allowed);
        }
        _ => {}
    }
    if !(2..=100).contains(directions) {
        return refuse(file, format!("{place}.directions"), directions.to_string(), "a sea is spread over 2 to 100 directions");
    }
    Ok(())
}

/// A frequency [Hz] above which nothing is left, above that of the peak.
fn above_the_peak(file: &str, place: &str, cut_off: Option<f64>, peak: f64) -> Result<(), Error> {
    match cut_off {
        Some(cut_off) if !(cut_off > peak && cut_off.is_finite()) => refuse(
            file,
            place,
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
    let Some(seas) = &scene.environment.waves else { return Vec::new() };
    let of = |(index, sea): (usize, &Waves)| -> Vec<String> {
        let place = seas.place(index);
        match sea {
            Waves::Regular { amplitude, period, .. } => breaks(&place, *amplitude, *period).into_iter().collect(),
            Waves::Components { components, .. } => {
                let place = |index: usize| format!("{place}.components[{index}]");
                components.iter().enumerate().filter_map(|(index, c)| breaks(&place(index), c.amplitude, c.period)).collect()
            }
            sea => sea.significant().into_iter().filter_map(|(hs, tp)| breaks(&place, 0.5 * hs, tp)).collect(),
        }
    };
    seas.each().iter().enumerate().flat_map(of).collect()
}

/// Warning: the run begins before a record of the water does, or ends after it.
pub fn beyond_records(scene: &Scene) -> Vec<String> {
    let (start, end) = (scene.run.start, scene.run.end());
    let beyond = |place: &str, [first, last]: [f64; 2], then: &str| {
        (start < first || end > last).then(|| {
            let [first, last, start, end] = [first, last, start, end].map(number);
            format!("{place}: the record goes from t = {first} to {last} s and the run from {start} to {end} s; beyond it {then}")
        })
    };
    let seas = scene.environment.waves.as_ref();
    let of = |(index, sea): (usize, &Waves)| {
        let record = sea.record()?;
        let place = seas.map(|seas| seas.place(index)).unwrap_or_default();
        beyond(&place, [record.start, record.start + record.period], "the sea repeats itself")
    };
    let rows = scene.environment.current_over_time.as_ref().and_then(|current| current.rows.as_ref());
    let current = rows.and_then(|rows| {
        let [first, last] = [rows.first()?[0], rows.last()?[0]];
        // One profile is a steady current.
        (last > first)
            .then(|| beyond("environment.current_over_time", [first, last], "the current stays as it is there"))
            .flatten()
    });
    seas.into_iter().flat_map(|seas| seas.each().iter().enumerate().filter_map(of)).chain(current).collect()
}
