//! Files beside a MoorDyn file: tables of strain and tension, a profile of the current, the depth on a grid.
//!
//! They are numbers in rows, after lines of words.

use crate::error::{Error, MoorDynProblem};
use crate::scene::moordyn::sections::Row;
use crate::scene::text::{decode_leniently, read_bytes};
use crate::scene::types::CurrentPoint;
use std::path::Path;

/// A file larger than this [bytes] is none.
const LARGEST: u64 = 16 << 20;
/// The current profile's file.
const CURRENT: &str = "current_profile.txt";
/// How far from a plane a depth may be, as a share of the depth.
const FLAT: f64 = 1.0e-6;

/// A bed that is a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Depth at x = y = 0 [m].
    pub depth: f64,
    /// Rise of the bed along x and y [deg].
    pub slope_deg: [f64; 2],
}

/// The rows of numbers of a file: its lines that begin with a number, each with its line in the text.
pub(super) struct Numbers {
    /// The file, for messages.
    pub(super) file: String,
    text: String,
}

impl Numbers {
    /// Reads a file beside the deck; where there is none, the file of that path from where the program runs, as MoorDyn takes it.
    pub(super) fn read(directory: &Path, name: &str, what: &str) -> Result<Numbers, Error> {
        let beside = directory.join(name);
        let path = if !beside.exists() && Path::new(name).exists() { Path::new(name) } else { &beside };
        let text = decode_leniently(read_bytes(path, LARGEST, what)?);
        Ok(Numbers { file: path.display().to_string(), text })
    }

    /// Rows of at least `least` numbers.
    pub(super) fn rows(&self, least: usize, columns: &'static str) -> Result<Vec<(Row<'_>, Vec<f64>)>, Error> {
        let mut rows = Vec::new();
        for (index, line) in self.text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            let words: Vec<&str> = line.split([' ', '\t', ',']).filter(|word| !word.trim().is_empty()).map(str::trim).collect();
            let row = Row { number: index + 1, text: line.trim(), words };
            if row.words.first().is_none_or(|word| word.parse::<f64>().is_err()) {
                // Words before the numbers are a heading; after them they are a fault.
                if rows.is_empty() || row.words.is_empty() || row.text.starts_with("---") {
                    continue;
                }
                return Err(row.unreadable(&self.file, columns, row.text, "a row of numbers"));
            }
            let numbers: Vec<f64> =
                row.words.iter().map_while(|word| word.parse().ok()).filter(|x: &f64| x.is_finite()).collect();
            if numbers.len() < least {
                return Err(row.error(&self.file, MoorDynProblem::TooFew { found: numbers.len(), needed: least, columns }));
            }
            rows.push((row, numbers));
        }
        Ok(rows)
    }

    /// The error for what is wrong with the whole.
    pub(super) fn fault(&self, reason: &str) -> Error {
        Error::File { path: self.file.clone(), reason: reason.into() }
    }
}

/// Strain [-] and tension [N] of a table of stiffness, from no strain on.
pub fn curve(directory: &Path, name: &str) -> Result<Vec<[f64; 2]>, Error> {
    let numbers = Numbers::read(directory, name, "a table of strain and tension")?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (row, values) in numbers.rows(2, "strain, tension")? {
        if points.last().is_some_and(|[strain, tension]| !(values[0] > *strain && values[1] >= *tension)) {
            return Err(row.unreadable(
                &numbers.file,
                "strain, tension",
                row.text,
                "a larger strain than in the row before, and no smaller tension",
            ));
        }
        points.push([values[0], values[1]]);
    }
    if points.first().is_some_and(|[strain, _]| *strain > 0.0) {
        points.insert(0, [0.0, 0.0]);
    }
    if points.len() < 2 {
        return Err(numbers.fault("a table of strain and tension needs 2 rows of numbers"));
    }
    Ok(points)
}

/// The current over the depth: z, and the velocity there along x, y and z.
pub fn current(directory: &Path) -> Result<Vec<CurrentPoint>, Error> {
    let numbers = Numbers::read(directory, CURRENT, "a profile of the current")?;
    let mut profile: Vec<CurrentPoint> = numbers
        .rows(4, "z, velocity along x, y, z")?
        .into_iter()
        .map(|(_, values)| CurrentPoint { z: values[0], velocity: [values[1], values[2], values[3]] })
        .collect();
    profile.sort_by(|one, other| other.z.total_cmp(&one.z));
    if profile.is_empty() {
        return Err(numbers.fault("there is no row of z and velocity"));
    }
    Ok(profile)
}

/// The bed on a grid, where that is a plane.
pub fn bed(directory: &Path, name: &str) -> Result<Plane, Error> {
    let numbers = Numbers::read(directory, name, "a grid of depths")?;
    let places = grid(&numbers)?;
    let plane = through(&places).ok_or_else(|| numbers.fault("its places lie on one line: a plane needs a grid"))?;
    let off = places.iter().map(|([x, y], z)| (plane[0] + plane[1] * x + plane[2] * y - z).abs()).fold(0.0, f64::max);
    if !(off <= FLAT * plane[0].abs().max(1.0)) {
        return Err(numbers.fault(&format!(
            "the bed is up to {off:.3} m off a plane; a scene has a plane bed (`environment.depth`, `environment.seabed.slope_deg`)"
        )));
    }
    Ok(Plane { depth: -plane[0], slope_deg: [plane[1].atan().to_degrees(), plane[2].atan().to_degrees()] })
}

/// Places x, y and the height of the bed there, of either form of the file.
fn grid(numbers: &Numbers) -> Result<Vec<([f64; 2], f64)>, Error> {
    let old = numbers.text.lines().find_map(|line| {
        let mut words = line.split_whitespace();
        (words.next()?.eq_ignore_ascii_case("nGridX")).then(|| words.next()?.parse::<usize>().ok()).flatten()
    });
    // Rows of the second form are told by their lengths, so that its words in front do not matter.
    let after: String = match old {
        Some(_) => numbers.text.lines().filter(|line| !line.to_lowercase().contains("ngrid")).collect::<Vec<_>>().join("\n"),
        None => numbers.text.clone(),
    };
    let cut = Numbers { file: numbers.file.clone(), text: after };
    let rows = cut.rows(1, "x, y, depth")?;
    let values: Vec<&[f64]> = rows.iter().map(|(_, values)| values.as_slice()).collect();
    match (old, values.as_slice()) {
        (Some(columns), [xs, rest @ ..]) => {
            let mut places = Vec::new();
            for row in rest.iter().filter(|row| row.len() > columns) {
                places.extend((0..columns.min(xs.len())).map(|k| ([xs[k], row[0]], -row[k + 1])));
            }
            Ok(places)
        }
        (None, [_, _, _, rest @ ..]) => {
            let rows = rest.iter().filter(|row| row.len() >= 3);
            // Heights of the bed, which lie below the water; where none does, they are depths.
            let sign = if rows.clone().all(|row| row[2] >= 0.0) { -1.0 } else { 1.0 };
            Ok(rows.map(|row| ([row[0], row[1]], sign * row[2])).collect())
        }
        _ => Err(numbers.fault("this is no grid of depths")),
    }
}

/// The plane z = c + a x + b y nearest to places: c, a, b; none where they do not span one.
fn through(places: &[([f64; 2], f64)]) -> Option<[f64; 3]> {
    let count = places.len() as f64;
    let sum = places.iter().fold([0.0; 3], |sum, ([x, y], z)| [sum[0] + x, sum[1] + y, sum[2] + z]);
    let [x, y, z] = sum.map(|sum| sum / count);
    let (mut xx, mut xy, mut yy, mut xz, mut yz) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for ([px, py], pz) in places {
        let (dx, dy, dz) = (px - x, py - y, pz - z);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
        xz += dx * dz;
        yz += dy * dz;
    }
    let determinant = xx * yy - xy * xy;
    if !(determinant > 1.0e-9 * xx * yy) {
        return None;
    }
    let (a, b) = ((xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant);
    Some([z - a * x - b * y, a, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_goes_through_places_of_a_plane() {
        let places: Vec<([f64; 2], f64)> = [[0.0, 0.0], [100.0, 0.0], [0.0, 50.0], [100.0, 50.0]]
            .iter()
            .map(|[x, y]| ([*x, *y], -80.0 + 0.1 * x - 0.02 * y))
            .collect();
        let plane = through(&places).unwrap_or_default();
        for (found, expected) in plane.iter().zip([-80.0, 0.1, -0.02]) {
            assert!((found - expected).abs() < 1e-12, "{plane:?}");
        }
        assert_eq!(through(&places[..2]), None);
    }
}
