//! The elevation of the sea at a place over time, from a CSV file `t,eta` in s and m or from rows of a scene: what it is made of.
//!
//! The rows are evenly spaced; their mean is not part of the waves. As a sum of cosines the record comes back after its end.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

use crate::algebra::fourier::{self, Cosine};
use crate::error::Error;
use crate::scene::rows;
use crate::scene::text::{decode, read_bytes};
use std::path::Path;

/// A larger file [bytes] is no record of waves.
const LARGEST: u64 = 256 << 20;
/// Fewer rows tell nothing of a sea.
const FEWEST: usize = 16;
/// Times may differ from even ones by this share of the step, for what rounding makes of them in a file.
const UNEVEN: f64 = 0.1;
/// A step longer than this many is a gap.
const GAP: f64 = 1.5;
/// Share of the frequency about which energy is looked at to find the peak.
const SMOOTHED: f64 = 0.06;
/// Frequencies are used up to this multiple of the peak's unless the scene says otherwise.
const BAND: f64 = 5.0;

/// What a record is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// First time [s].
    pub start: f64,
    /// Step of time [s].
    pub step: f64,
    /// Time after which it comes again [s].
    pub period: f64,
    /// Mean elevation, which is no part of the waves [m].
    pub mean: f64,
    /// Frequency of most energy [Hz].
    pub peak: f64,
    /// Cosines in rising frequency, from the start.
    pub cosines: Vec<Cosine>,
}

/// What is wrong with rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The row, from 0; none where it is the whole.
    pub row: Option<usize>,
    /// What is there.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

impl Record {
    /// The record of rows of time [s] and elevation [m].
    pub fn new(rows: &[[f64; 2]]) -> Result<Record, Fault> {
        let fault = |row: Option<usize>, found: String, allowed: &str| Err(Fault { row, found, allowed: allowed.into() });
        if rows.len() < FEWEST {
            return fault(None, format!("a record of {} rows", rows.len()), "a record of waves has at least 16 rows t,eta");
        }
        if let Some(row) = rows.iter().position(|row| !row.iter().all(|number| number.abs() <= 1.0e15)) {
            return fault(Some(row), format!("{:?}", rows[row]), "both must be finite numbers");
        }
        if let Some(row) = rows.windows(2).position(|pair| !(pair[1][0] > pair[0][0])) {
            let allowed = format!("times must rise, and the row before has t = {}", rows[row][0]);
            return fault(Some(row + 1), format!("t = {}", rows[row + 1][0]), &allowed);
        }
        let steps: Vec<f64> = rows.windows(2).map(|pair| pair[1][0] - pair[0][0]).collect();
        let usual = *steps.clone().select_nth_unstable_by(steps.len() / 2, f64::total_cmp).1;
        if let Some(row) = steps.iter().position(|step| *step > GAP * usual) {
            let allowed =
                format!("a gap after t = {}: rows lie {usual:.6} s apart; fill it, or cut the record there", rows[row][0]);
            return fault(Some(row + 1), format!("t = {}", rows[row + 1][0]), &allowed);
        }
        let start = rows[0][0];
        let step = (rows[rows.len() - 1][0] - start) / (rows.len() - 1) as f64;
        let even = |(n, row): (usize, &[f64; 2])| (row[0] - start - n as f64 * step).abs() <= UNEVEN * step;
        if let Some(row) = rows.iter().enumerate().position(|row| !even(row)) {
            let allowed = format!("rows must lie evenly in time, here {step:.6} s apart; resample the record");
            return fault(Some(row), format!("t = {}", rows[row][0]), &allowed);
        }
        let elevations: Vec<f64> = rows.iter().map(|row| row[1]).collect();
        let (mean, cosines) = fourier::cosines(&elevations, step);
        let peak = fourier::peak(&cosines, SMOOTHED);
        let record = Record { start, step, period: rows.len() as f64 * step, mean, peak, cosines };
        if !(record.variance(f64::INFINITY) > 1.0e-24) {
            return fault(
                None,
                String::from("a record without waves"),
                "it must hold some energy; leave `waves` out for a calm sea",
            );
        }
        Ok(record)
    }

    /// Variance of what lies up to a frequency [Hz], m².
    pub fn variance(&self, cut_off: f64) -> f64 {
        self.up_to(cut_off).iter().map(|of| 0.5 * of.amplitude * of.amplitude).sum()
    }

    /// The cosines up to a frequency [Hz].
    pub fn up_to(&self, cut_off: f64) -> &[Cosine] {
        &self.cosines[..self.cosines.partition_point(|of| of.frequency <= cut_off * (1.0 + 1.0e-12))]
    }

    /// The frequency up to which cosines are used: that of the scene, or five times that of the peak [Hz].
    pub fn cut_off(&self, given: Option<f64>) -> f64 {
        given.unwrap_or(BAND * self.peak)
    }
}

/// Reads a file of an elevation. Errors name the file and the line.
pub fn read(path: &Path) -> Result<Vec<[f64; 2]>, Error> {
    let file = path.display().to_string();
    parse(&decode(read_bytes(path, LARGEST, "a file of the elevation of the sea")?, &file)?, &file)
}

/// Reads the text of a file of an elevation; `file` is for messages.
pub fn parse(text: &str, file: &str) -> Result<Vec<[f64; 2]>, Error> {
    let lines = rows::read(text, file, ["t", "eta"], "s and m", "the elevation of a sea")?;
    let rows: Vec<[f64; 2]> = lines.iter().map(|(_, row)| *row).collect();
    match Record::new(&rows) {
        Ok(_) => Ok(rows),
        Err(Fault { row, found, allowed }) => {
            rows::refuse(file, row.map_or(text.lines().count().max(1), |row| lines[row].0), found, allowed)
        }
    }
}
