//! The output file that a MoorDyn file asks for: its channels over time, a line of names, a line of units, a row for every output time.

use crate::report::record::Record;
use crate::scene::moordyn::outputs::{Kind, Quantity, Spot};
use crate::scene::moordyn::words::{Attachment, LineEnd, Side};
use crate::scene::moordyn::{Deck, DeckBody, DeckLine, DeckPoint, deck_attitude};
use crate::scene::types::Scene;
use crate::solve::between::Place;
use std::fmt::Write;

/// Arc lengths from the fairlead [m] of the nodes that a deck asks for, line by line of its scene.
pub fn places(deck: &Deck, scene: &Scene) -> Vec<Vec<f64>> {
    let mut places = vec![Vec::new(); scene.lines.len()];
    for channel in &deck.outputs {
        let Quantity::OfLine(id, spot, _) = channel.quantity else { continue };
        push(&mut places, deck, scene, id, spot);
    }
    // Ends of lines that are inside a line of the scene.
    for line in deck.lines.iter().filter(|line| is_joined(deck, line)) {
        [Side::A, Side::B].into_iter().for_each(|side| push(&mut places, deck, scene, line.id, Spot::End(side)));
    }
    for places in &mut places {
        places.sort_by(f64::total_cmp);
        places.dedup();
    }
    places
}

fn push(places: &mut [Vec<f64>], deck: &Deck, scene: &Scene, id: u32, spot: Spot) {
    if let Some((of, s)) = place(deck, id, spot)
        && let Some(index) = scene.lines.iter().position(|line| line.name == DeckLine::name_of(of))
    {
        places[index].push(s);
    }
}

/// Whether a rod of no length makes a line one with others.
fn is_joined(deck: &Deck, line: &DeckLine) -> bool {
    line.ends.iter().any(|end| matches!(end, LineEnd::Rod(rod, _) if deck.joined(*rod).is_some()))
}

/// Where a node of a line is: the number of the line of the scene, and the arc length there [m]; none: the line has no such node.
fn place(deck: &Deck, id: u32, spot: Spot) -> Option<(u32, f64)> {
    let (of, before) = deck.stretch(id)?;
    let DeckLine { segments, length, .. } = *deck.lines.iter().find(|line| line.id == id)?;
    let own = match spot {
        Spot::End(Side::A) => length,
        Spot::End(Side::B) => 0.0,
        Spot::Node(node) if node as usize <= segments => length * (1.0 - f64::from(node) / segments.max(1) as f64),
        Spot::Node(_) => return None,
    };
    Some((of, before + own))
}

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
    // Inside a line of the scene an end is a node.
    let inside = |id: u32| deck.lines.iter().any(|line| line.id == id && is_joined(deck, line));
    match quantity {
        Quantity::Tension(id, side) if inside(id) => column(record, deck, Quantity::OfLine(id, Spot::End(side), Kind::Tension)),
        Quantity::EndOfLine(id, side, axis) if inside(id) => {
            column(record, deck, Quantity::OfLine(id, Spot::End(side), Kind::Position(axis)))
        }
        Quantity::Tension(id, Side::B) => Some(line(id)?.rows.iter().map(|row| row.tension).collect()),
        Quantity::Tension(id, Side::A) => Some(line(id)?.rows.iter().map(|row| row.anchor_tension).collect()),
        Quantity::EndOfLine(id, side, axis) => {
            let place = |row: &crate::solve::simulation::Outputs| match side {
                Side::A => row.anchor[axis],
                Side::B => row.fairlead[axis],
            };
            Some(line(id)?.rows.iter().map(place).collect())
        }
        Quantity::OfLine(id, spot, kind) => {
            let (of, s) = place(deck, id, spot)?;
            let line = line(of)?;
            let index = line.places.first()?.iter().position(|place| place.s == s)?;
            let value = |place: &Place| match kind {
                Kind::Position(axis) => place.position[axis],
                Kind::Velocity(axis) => place.velocity[axis],
                Kind::Acceleration(axis) => place.acceleration[axis],
                Kind::Tension => place.force.norm(),
            };
            Some(line.places.iter().map(|places| value(&places[index])).collect())
        }
        Quantity::OnPoint(id, axis) => {
            // What is free has its own weight and inertia in balance with its lines: there is nothing to write.
            let held = |point: &&DeckPoint| point.id == id && point.attachment != Attachment::Free;
            deck.points.iter().find(held)?;
            let ends = deck.lines.iter().flat_map(|line| {
                line.ends.iter().enumerate().filter(|(_, end)| **end == LineEnd::Point(id)).map(|(end, _)| (line.id, end))
            });
            let mut sum = vec![0.0; record.times.len()];
            for (of, end) in ends {
                for (sum, row) in sum.iter_mut().zip(&line(deck.stretch(of)?.0)?.rows) {
                    *sum += if end == 0 { row.anchor_force[axis] } else { row.force[axis] };
                }
            }
            Some(sum)
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
