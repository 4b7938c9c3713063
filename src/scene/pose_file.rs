//! A body's motion from a CSV file: `t,x,y,z,roll,pitch,yaw` in s, m and deg; absolute poses, z up.
//!
//! Between the rows the pose is a cubic spline of its six numbers, so C2; outside them the body rests. Angles may wind on; a jump of about a turn from row to row is taken for the same angle.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::algebra::spline;
use crate::error::Error;
use crate::scene::rows;
use crate::scene::text::{decode, read_bytes};
use std::path::Path;

/// Columns of a file.
const COLUMNS: [&str; 7] = ["t", "x", "y", "z", "roll", "pitch", "yaw"];
/// A larger file [bytes] is no motion of a body.
const LARGEST: u64 = 256 << 20;
/// No body is faster than this [m/s].
const FASTEST: f64 = 100.0;
/// Nor turns farther than this from row to row [deg].
const FARTHEST_TURN: f64 = 90.0;
/// Nor pitches beyond this [deg], where roll and yaw lose their meaning.
const STEEPEST: f64 = 89.0;

/// Times and poses of a motion: at least two rows, all numbers finite.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseTable {
    /// Times [s], rising.
    pub times: Vec<f64>,
    /// x, y, z [m], roll, pitch, yaw [rad], unwrapped.
    pub values: [Vec<f64>; 6],
    /// Their second derivatives at the rows.
    pub curvatures: [Vec<f64>; 6],
}

/// Reads a motion file. Errors name the file and the line.
pub fn read(path: &Path) -> Result<PoseTable, Error> {
    let file = path.display().to_string();
    parse(&decode(read_bytes(path, LARGEST, "a motion file")?, &file)?, &file)
}

/// Reads the text of a motion file; `file` is for messages.
pub fn parse(text: &str, file: &str) -> Result<PoseTable, Error> {
    table(rows::read(text, file, COLUMNS, "s, m and deg", "a motion")?, file)
}

/// The motion of rows t, x, y, z, roll, pitch, yaw in s, m and deg, at least two, each with its line in the file.
pub(super) fn table(rows: Vec<rows::Row<7>>, file: &str) -> Result<PoseTable, Error> {
    let (mut times, mut values): (Vec<f64>, [Vec<f64>; 6]) = (Vec::new(), Default::default());
    for (number, row) in rows {
        let refuse = |value: String, allowed: &str| rows::refuse(file, number, value, allowed);
        if !(row[5].abs() <= STEEPEST) {
            return refuse(format!("pitch = {} deg", row[5]), "it must lie within ±89 deg, where roll and yaw are defined");
        }
        if let Some(before) = times.last() {
            let moved = (0..3).map(|axis| (row[axis + 1] - values[axis][times.len() - 1]).powi(2)).sum::<f64>().sqrt();
            if !(moved / (row[0] - before) <= FASTEST) {
                return refuse(format!("a move of {moved:.3} m"), "a body moves at most 100 m/s; is a unit or a sign wrong?");
            }
        }
        for axis in 0..6 {
            let mut value = if axis < 3 { row[axis + 1] } else { row[axis + 1].to_radians() };
            if let (3.., Some(last)) = (axis, values[axis].last()) {
                value -= ((value - last) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
                let turn = (value - last).to_degrees();
                if !(turn.abs() <= FARTHEST_TURN) {
                    let (name, allowed) = (COLUMNS[axis + 1], "a body turns at most 90 deg from row to row; give more rows");
                    return refuse(format!("a turn in {name} of {turn:.1} deg"), allowed);
                }
            }
            values[axis].push(value);
        }
        times.push(row[0]);
    }
    let curvatures = std::array::from_fn(|axis| spline::curvatures(&times, &values[axis]));
    Ok(PoseTable { times, values, curvatures })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_and_angles_unwound() {
        let table = parse("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,170\n1,1,0,0,0,0,-170 # on\n2,2,0,0,0,0,-150\n", "a.csv")
            .expect("a table");
        assert_eq!(table.times, [0.0, 1.0, 2.0]);
        assert!((table.values[5][2].to_degrees() - 210.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("0,0,0,0,0,0\n", "7 columns"),
            ("0,0,0,0,0,0,0\n", "2 rows"),
            ("0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n", "times must rise"),
            ("0,0,0,0,0,0,0\n1,0,0,0,0,95,0\n", "±89"),
            ("0,0,0,0,0,0,0\n1,0,0,0,120,0,0\n", "turn in roll"),
            ("0,0,0,0,0,0,0\n1,500,0,0,0,0,0\n", "100 m/s"),
            ("t,x,y,z,yaw,pitch,roll\n", "in this order"),
            ("0,0,0,nan,0,0,0\n", "finite"),
        ] {
            let error = parse(text, "a.csv").expect_err(text).to_string();
            assert!(error.contains("a.csv, line") && error.contains(words), "{error}");
        }
    }
}
