//! A fairlead's motion from a CSV file: `t,x,y,z` or `t,x,y,z,vx,vy,vz` in s, m and m/s; absolute positions, z up.
//!
//! A first line with these names is allowed, and so are empty lines and comments after `#`. Between the rows the path is the cubic
//! Hermite of positions and velocities, so C1. Where no velocities are given, they are those of the parabola through three
//! neighbouring rows, exact for constant acceleration and of second order else, for any spacing:
//!     vᵢ = (h₁ d₀ + h₀ d₁)/(h₀ + h₁),   h₀ = tᵢ − tᵢ₋₁,  h₁ = tᵢ₊₁ − tᵢ,  d₀ = (xᵢ − xᵢ₋₁)/h₀,  d₁ = (xᵢ₊₁ − xᵢ)/h₁
//! in the middle, ((2h₀ + h₁) d₀ − h₀ d₁)/(h₀ + h₁) at the first row, mirrored at the last; two rows give the straight line.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::error::Error;
use crate::scene::text::{decode, read_bytes};
use crate::scene::types::{Environment, Triple};
use std::path::Path;

/// Columns of a file.
const COLUMNS: [&str; 7] = ["t", "x", "y", "z", "vx", "vy", "vz"];
/// No fairlead is faster than this [m/s].
const FASTEST: f64 = 100.0;
/// A larger file [bytes] is no motion of a fairlead.
const LARGEST: u64 = 256 << 20;

/// Times, positions and velocities of a measured or computed motion: at least two rows, all numbers finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Times [s], rising.
    pub times: Vec<f64>,
    /// Positions [m].
    pub positions: Vec<Triple>,
    /// Velocities [m/s].
    pub velocities: Vec<Triple>,
}

/// Reads a motion file and checks it against the bed of its scene. Errors name the file and the line.
pub fn read(path: &Path, environment: &Environment) -> Result<Table, Error> {
    let file = path.display().to_string();
    let bytes = read_bytes(path, LARGEST, "a motion file").map_err(|error| match error {
        Error::File { path, reason } => {
            Error::File { path, reason: format!("{reason} (the scene's motion.path names this file)") }
        }
        other => other,
    })?;
    parse(&decode(bytes, &file)?, &file, environment)
}

/// Reads the text of a motion file; `file` is for messages.
pub fn parse(text: &str, file: &str, environment: &Environment) -> Result<Table, Error> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows: Vec<Row> = Vec::new();
    let mut header_allowed = true;
    let mut columns = None;
    for (index, line) in text.lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default().trim();
        if content.is_empty() {
            continue;
        }
        let at = At { file, line: index + 1 };
        let fields: Vec<&str> = content.split(',').map(|field| field.trim().trim_matches('"').trim()).collect();
        let is_header = std::mem::take(&mut header_allowed)
            && fields[0].starts_with(char::is_alphabetic)
            && fields[0].parse::<f64>().is_err();
        at.columns(&fields, *columns.get_or_insert(fields.len()))?;
        if is_header {
            at.header(&fields)?;
            continue;
        }
        let row = at.row(&fields)?;
        at.follows(&row, rows.last())?;
        if environment.is_below_bed(row.position) {
            let bed = environment.bed_height(row.position[0], row.position[1]);
            at.refuse(format!("z = {}", row.position[2]), format!("it lies below the seabed, which is at z = {bed} m there"))?;
        }
        rows.push(row);
    }
    if rows.len() < 2 {
        let at = At { file, line: text.lines().count().max(1) };
        at.refuse(
            String::from(if rows.is_empty() { "a file without rows" } else { "a file of 1 row" }),
            "a motion needs at least 2 rows t,x,y,z[,vx,vy,vz]".into(),
        )?;
    }
    let times: Vec<f64> = rows.iter().map(|row| row.time).collect();
    let positions: Vec<Triple> = rows.iter().map(|row| row.position).collect();
    let given: Option<Vec<Triple>> = rows.iter().map(|row| row.velocity).collect();
    let velocities = given.unwrap_or_else(|| differences(&times, &positions));
    Ok(Table { times, positions, velocities })
}

/// One row of the file.
struct Row {
    time: f64,
    position: Triple,
    velocity: Option<Triple>,
}

/// A line of the file, for messages.
struct At<'a> {
    file: &'a str,
    line: usize,
}

impl At<'_> {
    fn refuse(&self, value: String, allowed: String) -> Result<(), Error> {
        Err(Error::Value { file: self.file.into(), place: format!("line {}", self.line), value, allowed })
    }

    /// Four columns or seven, in all lines alike.
    fn columns(&self, fields: &[&str], expected: usize) -> Result<(), Error> {
        let hint = if fields.len() == 1 && fields[0].contains([';', '\t', ' ']) { "; commas stand between them" } else { "" };
        let count = match fields.len() {
            1 => String::from("a line of 1 column"),
            count => format!("a line of {count} columns"),
        };
        if fields.len() != 4 && fields.len() != 7 {
            return self.refuse(count, format!("it must be 4 columns t,x,y,z or 7 columns t,x,y,z,vx,vy,vz{hint}"));
        }
        if fields.len() != expected {
            return self.refuse(count, format!("the lines before have {expected}"));
        }
        Ok(())
    }

    fn header(&self, fields: &[&str]) -> Result<(), Error> {
        let known = |(field, name): (&&str, &&str)| {
            field.eq_ignore_ascii_case(name) || (*name == "t" && field.eq_ignore_ascii_case("time"))
        };
        match fields.iter().zip(&COLUMNS).position(|pair| !known(pair)) {
            Some(wrong) => self.refuse(
                format!("column {} \"{}\"", wrong + 1, fields[wrong]),
                format!("the columns must be t,x,y,z or t,x,y,z,vx,vy,vz in this order; this one is {}", COLUMNS[wrong]),
            ),
            None => Ok(()),
        }
    }

    fn row(&self, fields: &[&str]) -> Result<Row, Error> {
        let mut values = [0.0; 7];
        for ((value, field), name) in values.iter_mut().zip(fields).zip(COLUMNS) {
            match field.parse::<f64>() {
                // 1e15 is the limit of every number of a scene.
                Ok(number) if number.abs() <= 1.0e15 => *value = number,
                _ => self.refuse(format!("{name} = \"{field}\""), "it must be a finite number".into())?,
            }
        }
        let [time, x, y, z, vx, vy, vz] = values;
        Ok(Row { time, position: [x, y, z], velocity: (fields.len() == 7).then_some([vx, vy, vz]) })
    }

    /// Times rise, and nothing is faster than a fairlead can be.
    fn follows(&self, row: &Row, before: Option<&Row>) -> Result<(), Error> {
        if let Some(velocity) = row.velocity {
            let speed = size(velocity);
            if speed > FASTEST {
                return self.refuse(format!("a velocity of {speed:.1} m/s"), format!("a fairlead moves at most {FASTEST} m/s"));
            }
        }
        let Some(before) = before else { return Ok(()) };
        let step = row.time - before.time;
        if !(step > 0.0) {
            return self
                .refuse(format!("t = {}", row.time), format!("times must rise, and the row before has t = {}", before.time));
        }
        let moved = size(std::array::from_fn(|axis| row.position[axis] - before.position[axis]));
        if !(moved / step <= FASTEST) {
            let value = format!("a move of {moved:.3} m in {step} s, {:.1} m/s,", moved / step);
            return self.refuse(value, format!("a fairlead moves at most {FASTEST} m/s; is a unit or a sign wrong?"));
        }
        Ok(())
    }
}

fn size(vector: Triple) -> f64 {
    vector[0].hypot(vector[1]).hypot(vector[2])
}

/// Velocities of the parabola through each row and its neighbours; the formulas stand on top of this file.
fn differences(times: &[f64], positions: &[Triple]) -> Vec<Triple> {
    let slope = |i: usize| -> Triple {
        std::array::from_fn(|axis| (positions[i + 1][axis] - positions[i][axis]) / (times[i + 1] - times[i]))
    };
    let last = times.len() - 1;
    let at_row = |i: usize| -> Triple {
        if last == 1 {
            return slope(0);
        }
        // The parabola through rows k, k+1, k+2, and where row i stands in it.
        let k = i.saturating_sub(1).min(last - 2);
        let (h0, h1) = (times[k + 1] - times[k], times[k + 2] - times[k + 1]);
        let (d0, d1) = (slope(k), slope(k + 1));
        let (w0, w1) = match i - k {
            0 => (2.0 * h0 + h1, -h0),
            1 => (h1, h0),
            _ => (-h1, 2.0 * h1 + h0),
        };
        std::array::from_fn(|axis| (w0 * d0[axis] + w1 * d1[axis]) / (h0 + h1))
    };
    (0..=last).map(at_row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: d/dt of x = 3 - 2t + 0.5t². The formula is exact for parabolas, so rounding is all that remains.
    #[test]
    fn velocities_of_constant_acceleration_are_exact_at_any_spacing() {
        let times = [0.0, 0.3, 1.0, 1.1, 4.0];
        let positions = times.map(|t: f64| [3.0 - 2.0 * t + 0.5 * t * t, 0.0, -t]);
        for (t, velocity) in times.iter().zip(differences(&times, &positions)) {
            assert!(
                (velocity[0] - (t - 2.0)).abs() < 1e-12 && velocity[1] == 0.0 && (velocity[2] + 1.0).abs() < 1e-12,
                "{t}: {velocity:?}"
            );
        }
    }

    /// Source: order 2 of the three-point formula on sin t at uneven spacing, ends included; 2.0 ± 0.2 for the largest error.
    #[test]
    fn velocities_of_a_sine_converge_with_order_two() {
        let error = |count: usize| -> f64 {
            let times: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).map(|u| 6.0 * (u + 0.3 * u * u)).collect();
            let positions: Vec<Triple> = times.iter().map(|t| [t.sin(), 0.0, 0.0]).collect();
            differences(&times, &positions).iter().zip(&times).map(|(v, t)| (v[0] - t.cos()).abs()).fold(0.0, f64::max)
        };
        let order = (error(100) / error(200)).log2();
        assert!((order - 2.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn two_rows_are_a_straight_line() {
        assert_eq!(differences(&[0.0, 2.0], &[[0.0; 3], [1.0, 0.0, -4.0]]), vec![[0.5, 0.0, -2.0]; 2]);
    }
}
