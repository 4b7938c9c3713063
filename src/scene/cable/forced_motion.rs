//! The file `forcedmotion`: velocities of the first node at every time step, as the 1994 program read them.
//!
//! One number a line, NDIM lines for each time level from TBGN to TEND; NDIM numbers a line are read as well. What comes before
//! t = 10 π s is eased in by 10 ξ³ - 15 ξ⁴ + 6 ξ⁵, ξ = t / (10 π), as in 1994. The path is the integral of the velocities by the
//! trapezoidal rule, from where the file has the first node.

use crate::error::{DeckProblem, Error};
use crate::scene::cable::columns::number;
use crate::scene::cable::{Deck, turned};
use crate::scene::motion_file::Table;
use crate::scene::text::{decode, read_bytes};
use crate::scene::types::{Environment, Triple};
use std::f64::consts::PI;
use std::path::Path;

/// Name of the file, which lies beside the CABLE file.
pub const NAME: &str = "forcedmotion";
/// The velocities of earlier times are eased in [s].
pub const EASED: f64 = 10.0 * PI;
/// A larger file [bytes] is none.
const LARGEST: u64 = 256 << 20;

/// Reads the velocities that a CABLE file asks for.
pub fn read(path: &Path, deck: &Deck, environment: &Environment) -> Result<Table, Error> {
    let file = path.display().to_string();
    let bytes = read_bytes(path, LARGEST, "a file of velocities").map_err(|error| match error {
        Error::File { path, reason } => Error::File { path, reason: format!("{reason} (JMOTN = 2 asks for this file)") },
        other => other,
    })?;
    let table = parse(&decode(bytes, &file)?, &file, deck)?;
    let below = table.positions.iter().zip(&table.times).find(|(position, _)| environment.is_below_bed(**position));
    below.map_or(Ok(()), |(position, time)| {
        let allowed = format!("the velocities lead it below the seabed, which is at z = {} m", -environment.depth);
        Err(Error::Value { file, place: format!("t = {time} s"), value: format!("a fairlead at z = {} m", position[2]), allowed })
    })?;
    Ok(table)
}

/// The path of the fairlead, in the axes of the scene, from the text of a file of velocities.
pub fn parse(text: &str, file: &str, deck: &Deck) -> Result<Table, Error> {
    let levels = deck.levels();
    let refuse = |line: usize, column: usize, problem: DeckProblem| {
        Err(Error::Deck {
            file: file.into(),
            line,
            column,
            item: format!("velocities of node 1 at {levels} times"),
            problem: problem.into(),
        })
    };
    let mut values: Vec<f64> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split([' ', '\t', ',', ';']).filter(|word| !word.trim().is_empty()).collect();
        if !matches!(words.len(), 0 | 1) && words.len() != deck.dimensions {
            return refuse(index + 1, 1, DeckProblem::TooFew { found: words.len(), expected: deck.dimensions });
        }
        for word in words {
            match number(word.trim()) {
                // 1e15 is the limit of every number of a scene.
                Some((value, _)) if value.abs() <= 1.0e15 => values.push(value),
                _ => {
                    let column = line.find(word).map_or(1, |at| line[..at].chars().count() + 1);
                    return refuse(
                        index + 1,
                        column,
                        DeckProblem::Unreadable { found: format!("`{word}`"), expected: "a velocity".into() },
                    );
                }
            }
        }
    }
    if values.len() < levels * deck.dimensions {
        return refuse(text.lines().count().max(1), 1, DeckProblem::Ends);
    }
    Ok(integrated(&values, deck, levels))
}

fn integrated(values: &[f64], deck: &Deck, levels: usize) -> Table {
    let mut table = Table { times: Vec::new(), positions: Vec::new(), velocities: Vec::new() };
    let mut position = deck.nodes.first().map_or([0.0; 3], |node| turned(node.position));
    let mut before: Option<Triple> = None;
    for (level, given) in values.chunks_exact(deck.dimensions).take(levels.max(2)).enumerate() {
        let time = deck.begin + level as f64 * deck.step;
        let mut velocity = [0.0; 3];
        velocity[..deck.dimensions].copy_from_slice(given);
        let velocity = turned(velocity).map(|v| v * eased(time));
        if let Some(before) = before {
            position = std::array::from_fn(|k| position[k] + 0.5 * deck.step * (before[k] + velocity[k]));
        }
        before = Some(velocity);
        table.times.push(time);
        table.positions.push(position);
        table.velocities.push(velocity);
    }
    table
}

fn eased(time: f64) -> f64 {
    let xi = (time / EASED).clamp(0.0, 1.0);
    xi * xi * xi * (10.0 - 15.0 * xi + 6.0 * xi * xi)
}
