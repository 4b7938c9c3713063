//! A current that changes in time, from a CSV file `t,z,u,v,w` in s, m and m/s or from such rows of a scene: velocities along x, y and z.
//!
//! Rows of one time stand together and make a profile; times do not fall. Every z stands once in a profile.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::error::Error;
use crate::scene::rows;
use crate::scene::text::{decode, read_bytes};
use std::path::Path;

/// A larger file [bytes] is no record of a current.
const LARGEST: u64 = 256 << 20;
/// No current is faster than this [m/s].
pub const FASTEST: f64 = 20.0;

/// What is wrong with rows: the row, from 0, what is there, and what is allowed.
pub type Fault = (usize, String, String);

/// Looks at rows of time [s], z [m] and velocity [m/s], or finds the first thing wrong.
pub fn check(rows: &[[f64; 5]]) -> Result<(), Fault> {
    let mut profile = 0;
    for (index, row) in rows.iter().enumerate() {
        if !row.iter().all(|number| number.abs() <= 1.0e15) {
            return Err((index, format!("{row:?}"), String::from("all five must be finite numbers t,z,u,v,w")));
        }
        let [time, z, u, v, w] = *row;
        let speed = u.hypot(v).hypot(w);
        if speed > FASTEST {
            let allowed = format!("a current flows at most {FASTEST} m/s; is a unit wrong?");
            return Err((index, format!("a velocity of {speed:.1} m/s"), allowed));
        }
        if index > 0 && !(time >= rows[index - 1][0]) {
            return Err((
                index,
                format!("t = {time}"),
                format!("times must not fall, and the row before has t = {}", rows[index - 1][0]),
            ));
        }
        if index > 0 && time > rows[index - 1][0] {
            profile = index;
        }
        if rows[profile..index].iter().any(|other| other[1] == z) {
            return Err((
                index,
                format!("z = {z}"),
                format!("it is there already at t = {time}; every z stands once in a profile"),
            ));
        }
    }
    Ok(())
}

/// Reads a file of a current. Errors name the file and the line.
pub fn read(path: &Path) -> Result<Vec<[f64; 5]>, Error> {
    let file = path.display().to_string();
    parse(&decode(read_bytes(path, LARGEST, "a file of a current")?, &file)?, &file)
}

/// Reads the text of a file of a current; `file` is for messages.
pub fn parse(text: &str, file: &str) -> Result<Vec<[f64; 5]>, Error> {
    let lines = rows::read_profiles(text, file, ["t", "z", "u", "v", "w"], "s, m and m/s", "a current over time")?;
    let rows: Vec<[f64; 5]> = lines.iter().map(|(_, row)| *row).collect();
    match check(&rows) {
        Ok(()) => Ok(rows),
        Err((row, found, allowed)) => rows::refuse(file, lines[row].0, found, allowed),
    }
}
