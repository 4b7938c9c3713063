//! Force and moment on a body over time from a CSV file: `t,fx,fy,fz,mx,my,mz` in s, N and N·m, along global axes, on its reference point.
//!
//! Between the rows they are linear in time; before the first and after the last they stay as there.

use crate::error::Error;
use crate::scene::rows;
use crate::scene::text::{decode, read_bytes};
use nalgebra::Vector3;
use std::path::Path;

/// Columns of a file.
const COLUMNS: [&str; 7] = ["t", "fx", "fy", "fz", "mx", "my", "mz"];
/// A larger file [bytes] is no table of loads.
const LARGEST: u64 = 256 << 20;

/// Times and loads: at least two rows, all numbers finite.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadTable {
    /// Times [s], rising.
    pub times: Vec<f64>,
    /// Force [N] and moment [N·m] at them.
    pub loads: Vec<[Vector3<f64>; 2]>,
}

impl LoadTable {
    /// Force [N] and moment [N·m] at a time [s].
    pub fn at(&self, time: f64) -> [Vector3<f64>; 2] {
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 || after == self.times.len() {
            return self.loads[after.min(self.times.len() - 1)];
        }
        let (from, to) = (self.times[after - 1], self.times[after]);
        let share = (time - from) / (to - from);
        [0, 1].map(|part: usize| self.loads[after - 1][part] * (1.0 - share) + self.loads[after][part] * share)
    }
}

/// Reads a file of loads. Errors name the file and the line.
pub fn read(path: &Path) -> Result<LoadTable, Error> {
    let file = path.display().to_string();
    parse(&decode(read_bytes(path, LARGEST, "a file of loads")?, &file)?, &file)
}

/// Reads the text of a file of loads; `file` is for messages.
pub fn parse(text: &str, file: &str) -> Result<LoadTable, Error> {
    let rows = rows::read(text, file, COLUMNS, "s, N and N·m", "a load over time")?;
    let load = |row: &[f64; 7]| [Vector3::new(row[1], row[2], row[3]), Vector3::new(row[4], row[5], row[6])];
    Ok(LoadTable { times: rows.iter().map(|(_, row)| row[0]).collect(), loads: rows.iter().map(|(_, row)| load(row)).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_are_linear_between_rows_and_stay_outside() {
        let table = parse("t,fx,fy,fz,mx,my,mz\n1,10,0,0,0,0,4\n3,30,0,0,0,0,0\n", "a.csv").expect("a table");
        for (time, fx, mz) in [(0.0, 10.0, 4.0), (1.0, 10.0, 4.0), (1.5, 15.0, 3.0), (3.0, 30.0, 0.0), (9.0, 30.0, 0.0)] {
            let [force, moment] = table.at(time);
            assert!((force.x - fx).abs() < 1e-12 && (moment.z - mz).abs() < 1e-12, "{time}");
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("0,0,0,0,0,0\n", "7 columns"),
            ("0,0,0,0,0,0,0\n", "2 rows"),
            ("0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n", "times must rise"),
            ("t,fx,fy,fz,mx,mz,my\n", "in this order"),
            ("0,0,0,inf,0,0,0\n", "finite"),
        ] {
            let error = parse(text, "a.csv").expect_err(text).to_string();
            assert!(error.contains("a.csv, line") && error.contains(words), "{error}");
        }
    }
}
