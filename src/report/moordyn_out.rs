//! The output file that a MoorDyn file asks for: its channels over time, a line of names, a line of units, a row for every output time.

use crate::report::record::Record;
use crate::scene::moordyn::outputs::Quantity;
use crate::scene::moordyn::words::{LineEnd, Side};
use crate::scene::moordyn::{Deck, DeckBody, DeckLine, deck_attitude};
use std::fmt::Write;

/// The text of the file; none: the deck asks for nothing.
pub fn text(record: &Record, deck: &Deck) -> Option<String> {
    let channels: Vec<_> =
        deck.outputs.iter().filter_map(|channel| Some((channel, column(record, deck, channel.quantity)?))).collect();
    if channels.is_empty() {
        return None;
    }
    let names = channels.iter().map(|(channel, _)| channel.name.as_str());
    let units = channels.iter().map(|(channel, _)| channel.quantity.unit());
    let joined = |words: &mut dyn Iterator<Item = &str>| words.collect::<Vec<_>>().join("\t");
    let mut text =
        joined(&mut std::iter::once("Time").chain(names)) + "\n" + &joined(&mut std::iter::once("(s)").chain(units)) + "\n";
    for (row, time) in record.times.iter().enumerate() {
        // Writing to a string does not fail.
        let _ = write!(text, "{time:.4}");
        for (_, values) in &channels {
            let _ = write!(text, "\t{:.8e}", values.get(row).copied().unwrap_or(f64::NAN));
        }
        text.push('\n');
    }
    Some(text)
}

/// The values of a channel at the output times; none: nothing of the run has its number.
fn column(record: &Record, deck: &Deck, quantity: Quantity) -> Option<Vec<f64>> {
    let line = |id: u32| record.lines.iter().find(|line| line.name == DeckLine::name_of(id));
    let body = |id: u32| record.bodies.iter().find(|body| body.name == DeckBody::name_of(id));
    match quantity {
        Quantity::Tension(id, Side::B) => Some(line(id)?.rows.iter().map(|row| row.tension).collect()),
        Quantity::Tension(id, Side::A) => Some(line(id)?.rows.iter().map(|row| row.anchor_tension).collect()),
        Quantity::EndOfLine(id, side, axis) => {
            let place = |row: &crate::solve::simulation::Outputs| match side {
                Side::A => row.anchor[axis],
                Side::B => row.fairlead[axis],
            };
            Some(line(id)?.rows.iter().map(place).collect())
        }
        Quantity::Point(id, axis) => {
            // A point is where the lines end that lead to it.
            let end = |line: &DeckLine| line.ends.iter().position(|end| *end == LineEnd::Point(id));
            let (of, end) = deck.lines.iter().find_map(|line| Some((line.id, end(line)?)))?;
            column(record, deck, Quantity::EndOfLine(of, if end == 0 { Side::A } else { Side::B }, axis))
        }
        Quantity::Body(id, axis) => Some(body(id)?.rows.iter().map(|row| row.pose.position[axis]).collect()),
        Quantity::Turn(id, axis) => {
            Some(body(id)?.rows.iter().map(|row| deck_attitude(row.pose.angles.map(f64::to_degrees).into())[axis]).collect())
        }
    }
}
