//! Waves of a MoorDyn file: what the files beside it say that WaveKin asks for, as components or as a record of the surface.
//!
//! ```text
//! WaveKin 7   η = Σ |A| sin(ω t - k·x + arg A), one component for each row ω, Re A, Im A, direction [rad]
//! WaveKin 2   η = Σ |A| cos(ω t - k·x + arg A), A linear between the rows, at multiples of the least difference of their ω
//! WaveKin 3   η at x = y = 0 over time, linear between the rows, sampled every dtWave an even number of times; towards +x
//! ```

use crate::error::{Error, MoorDynProblem};
use crate::scene::elevation_file::{Fault, Record};
use crate::scene::moordyn::beside::Numbers;
use crate::scene::moordyn::sections::Row;
use crate::scene::types::{WaveComponent, Waves};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

const FREQUENCIES: &str = "wave_frequencies.txt";
const ELEVATION: &str = "wave_elevation.txt";
/// Columns of a spectrum.
const OF_SPECTRUM: &str = "frequency (rad/s), real part, imaginary part of the amplitude (m), direction (rad)";
/// Most components of a scene.
const MOST: usize = 5000;
/// Most samples of a record.
const MOST_SAMPLES: f64 = 4.0e6;

/// What WaveKin asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// 2: a spectrum, put on even frequencies.
    EvenSpectrum,
    /// 3: a record of the surface.
    Record,
    /// 7: components.
    Components,
}

/// Frequency [rad/s], real and imaginary part of the amplitude [m] and direction of travel [rad].
type Component = [f64; 4];

/// The waves of the files in a directory; `step`: dtWave [s].
pub fn read(kind: Kind, directory: &Path, step: f64) -> Result<Waves, Error> {
    match kind {
        Kind::Record => record(directory, step),
        Kind::Components => components(&spectrum(directory, false)?, FRAC_PI_2, directory),
        Kind::EvenSpectrum => components(&even(&spectrum(directory, true)?), 0.0, directory),
    }
}

/// The rows of a spectrum, the first of them at rest; `rising`: no two have one frequency.
fn spectrum(directory: &Path, rising: bool) -> Result<Vec<Component>, Error> {
    let numbers = Numbers::read(directory, FREQUENCIES, "a spectrum of waves")?;
    let mut rows: Vec<Component> = Vec::new();
    for (row, values) in numbers.rows(3, OF_SPECTRUM)? {
        let direction = values.get(3).copied().unwrap_or(0.0);
        let wrong = |expected| row.unreadable(&numbers.file, OF_SPECTRUM, row.text, expected);
        match rows.last() {
            None if values[0] != 0.0 => return Err(wrong("a first row of frequency 0, as MoorDyn has it")),
            None if values[1] != 0.0 || values[2] != 0.0 => {
                return Err(wrong("no amplitude at frequency 0: that is another depth, not a wave"));
            }
            None => {}
            Some(before) if values[0] < 0.0 || (rising && values[0] <= before[0]) => {
                return Err(wrong("a larger frequency than in the row before"));
            }
            Some(_) if values[0] == 0.0 => return Err(wrong("a frequency greater than 0 after the first row")),
            Some(_) => {}
        }
        if direction.abs() > TAU {
            return Err(wrong("a direction in rad, within ±2π"));
        }
        rows.push([values[0], values[1], values[2], direction]);
    }
    if rows.len() < 2 {
        return Err(numbers.fault("a spectrum of waves needs 2 rows: one of frequency 0, and one of a wave"));
    }
    Ok(rows)
}

/// The spectrum at multiples of the least difference of frequencies.
fn even(rows: &[Component]) -> Vec<Component> {
    let least = rows.windows(2).map(|pair| pair[1][0] - pair[0][0]).fold(f64::INFINITY, f64::min);
    let count = ((rows[rows.len() - 1][0] / least + 1.0e-9).floor() as usize).min(MOST + 1);
    let at = |number: usize| {
        let frequency = number as f64 * least;
        let upper = rows.partition_point(|row| row[0] < frequency * (1.0 - 1.0e-12)).clamp(1, rows.len() - 1);
        let (low, high) = (&rows[upper - 1], &rows[upper]);
        let share = (frequency - low[0]) / (high[0] - low[0]);
        let between = |column: usize| low[column] + share * (high[column] - low[column]);
        [frequency, between(1), between(2), between(3)]
    };
    (0..=count).map(at).collect()
}

/// Components of a scene, cos(k·x - ω t + phase), `lag` [rad] behind those of the rows.
fn components(rows: &[Component], lag: f64, directory: &Path) -> Result<Waves, Error> {
    let waves = rows.iter().filter(|[frequency, real, imaginary, _]| *frequency > 0.0 && real.hypot(*imaginary) > 0.0);
    let component = |[frequency, real, imaginary, direction]: &Component| WaveComponent {
        amplitude: real.hypot(*imaginary),
        period: TAU / frequency,
        direction_deg: direction.to_degrees(),
        phase_deg: (lag - imaginary.atan2(*real)).to_degrees(),
    };
    let components: Vec<WaveComponent> = waves.map(component).collect();
    let fault = |reason: String| Error::File { path: directory.join(FREQUENCIES).display().to_string(), reason };
    match components.len() {
        0 => Err(fault(String::from("no row has an amplitude; set WaveKin to 0 for a calm sea"))),
        count if count > MOST => Err(fault(format!(
            "{count} components; a scene has at most {MOST}, and linear interpolation adds some where rows are uneven"
        ))),
        _ => Ok(Waves::Components { components, ramp: None, stretching: None }),
    }
}

/// The record of the surface, sampled.
fn record(directory: &Path, step: f64) -> Result<Waves, Error> {
    let numbers = Numbers::read(directory, ELEVATION, "a record of the surface")?;
    let read = numbers.rows(2, "time (s), elevation (m)")?;
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for (row, values) in &read {
        if rows.last().is_some_and(|before: &[f64; 2]| values[0] <= before[0]) {
            return Err(row.unreadable(&numbers.file, "time", row.words[0], "a later time than in the row before"));
        }
        rows.push([values[0], values[1]]);
    }
    let (Some(last), true) = (rows.last(), step > 0.0) else {
        return Err(numbers.fault("there is no row of time and elevation"));
    };
    let count = (last[0] / step + 1.0e-9).floor() + 1.0;
    if !(count <= MOST_SAMPLES) {
        let found = format!("{count:.0} samples of dtWave {step} s; {MOST_SAMPLES:.0} is the limit, set a larger dtWave");
        return Err(numbers.fault(&found));
    }
    let at = |time: f64| {
        let upper = rows.partition_point(|row| row[0] < time).min(rows.len() - 1);
        let (low, high) = (rows[upper.saturating_sub(1)], rows[upper]);
        if high[0] <= time || upper == 0 { high[1] } else { low[1] + (time - low[0]) / (high[0] - low[0]) * (high[1] - low[1]) }
    };
    let samples = count.max(0.0) as usize / 2 * 2;
    let series: Vec<[f64; 2]> = (0..samples).map(|n| n as f64 * step).map(|time| [time, at(time)]).collect();
    match Record::new(&series) {
        Ok(_) => {}
        Err(Fault { row: Some(number), found, allowed }) => {
            let spot = &read[number.min(read.len() - 1)].0;
            return Err(at_row(spot, &numbers.file, &found, &allowed));
        }
        Err(Fault { row: None, found, allowed }) => {
            return Err(numbers.fault(&format!("{found} every {step} s (dtWave): {allowed}")));
        }
    }
    Ok(Waves::Elevation {
        path: None,
        series: Some(series),
        at: [0.0; 2],
        direction_deg: 0.0,
        cut_off: None,
        ramp: None,
        stretching: None,
    })
}

fn at_row(row: &Row, file: &str, found: &str, allowed: &str) -> Error {
    row.error(file, MoorDynProblem::CannotHold { item: found.into(), reason: allowed.into() })
}
