//! What rules find with: places in a scene, numbers of the right sign and size, and the refusal that names them.

use crate::error::Error;
use crate::scene::types::{Scene, Section, Triple};

/// Largest size of any number.
const LARGEST: f64 = 1.0e15;
/// Smallest number that counts as positive.
const SMALLEST: f64 = 1.0e-12;
/// All sections with their places.
pub fn sections(scene: &Scene) -> impl Iterator<Item = (String, &Section)> {
    scene.lines.iter().enumerate().flat_map(|(line, of)| {
        of.sections.iter().enumerate().map(move |(section, it)| (format!("lines[{line}].sections[{section}]"), it))
    })
}

/// The place of a key of a line type.
pub fn in_type(name: &str, key: &str) -> String {
    format!("line_types.{name}.{key}")
}

/// Greater than 0; `unit` ends the message and may go on with a remedy.
pub fn positive(file: &str, place: &str, value: f64, unit: &str) -> Result<(), Error> {
    if !(value > 0.0) {
        return refuse(file, place, number(value), format!("it must be greater than 0 {unit}").trim_end());
    }
    if !(SMALLEST..=LARGEST).contains(&value) {
        return refuse(file, place, number(value), format!("it must lie between {SMALLEST:e} and {LARGEST:e} {unit}").trim_end());
    }
    Ok(())
}

/// 0 or greater; `unit` ends the message.
pub fn not_negative(file: &str, place: &str, value: f64, unit: &str) -> Result<(), Error> {
    if !(value >= 0.0) {
        return refuse(file, place, number(value), format!("it must be 0 or greater, {unit}").trim_end_matches([',', ' ']));
    }
    finite(file, place, &[value])
}

/// Finite, all of them, and of a size that can be reckoned with.
pub fn finite(file: &str, place: &str, values: &[f64]) -> Result<(), Error> {
    match values.iter().find(|value| !(value.abs() <= LARGEST)) {
        Some(value) => refuse(file, place, number(*value), format!("it must be finite and at most {LARGEST:e} in size")),
        None => Ok(()),
    }
}

/// The refusal of a value at a place; `allowed` says what would do.
pub fn refuse(file: &str, place: impl Into<String>, value: impl Into<String>, allowed: impl Into<String>) -> Result<(), Error> {
    Err(Error::Value { file: file.into(), place: place.into(), value: value.into(), allowed: allowed.into() })
}

/// A number as a user would write it, without the last digits that come from rounding.
pub fn number(value: f64) -> String {
    let value = format!("{value:.11e}").parse().unwrap_or(value);
    if value == 0.0 || (1.0e-4..1.0e7).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

/// A place as a user would write it.
pub fn triple(at: Triple) -> String {
    format!("({}, {}, {})", number(at[0]), number(at[1]), number(at[2]))
}

/// From one place to another [m].
pub fn distance(from: Triple, to: Triple) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1]).hypot(to[2] - from[2])
}

/// A sinusoidal motion: its period, the amplitudes of its two parts and its ramp.
pub fn sinusoid(file: &str, place: &str, period: f64, parts: [&Triple; 2], ramp: Option<f64>) -> Result<(), Error> {
    positive(file, &format!("{place}.period"), period, "s")?;
    finite(file, &format!("{place}.sine"), parts[0])?;
    finite(file, &format!("{place}.cosine"), parts[1])?;
    not_negative(file, &format!("{place}.ramp"), ramp.unwrap_or(0.0), "s; 0 means none")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_a_user_would() {
        assert_eq!(number(-130.0), "-130");
        assert_eq!(number(5.0e8), "5e8");
        assert_eq!(number(1327.3300774999998), "1327.3300775");
        assert_eq!(number(f64::NAN), "NaN");
    }
}
