//! What a calling program moves of a MoorDyn file: each thing a body of the scene of its own, and the table of a driver that moves them.
//!
//! A row of the table is a time [s], then x, y, z [m] and three angles [rad] of each coupled body and rod, then x, y, z of each coupled point, in
//! the order of the file; positions are absolute, angles turn as those of the file do, R = Rx Ry Rz.

use crate::error::Error;
use crate::scene::bodies::{Body, Mount};
use crate::scene::moordyn::to_scene::VESSEL;
use crate::scene::moordyn::words::{Attachment, LineEnd};
use crate::scene::moordyn::{Deck, DeckBody, DeckPoint, DeckRod, scene_attitude};
use crate::scene::pose_file::{self, PoseTable};
use crate::scene::rows::refuse;
use crate::scene::text::{decode_leniently, read_bytes};
use crate::scene::types::{Scene, Triple};
use std::path::Path;

/// A larger file [bytes] is no motion.
const LARGEST: u64 = 256 << 20;
/// Signs after which a line is a comment.
const COMMENTS: [char; 3] = ['#', '!', '%'];

/// Something coupled, and its columns.
struct Thing {
    /// Its body in a scene where each coupled thing has one.
    body: String,
    /// Its words in messages.
    label: String,
    /// How many columns it has.
    columns: usize,
}

/// Gives each coupled point and rod a body of its own, which nothing is turned about: a rod's axes are global ones where the file has it.
pub fn move_alone(scene: &mut Scene, deck: &Deck) {
    for (line, own) in scene.lines.iter_mut().zip(&deck.lines) {
        for (mount, end) in [&mut line.anchor_on, &mut line.fairlead_on].into_iter().zip(own.ends) {
            let Some(Mount::Body { body, at, .. }) = mount else { continue };
            if body != VESSEL {
                continue;
            }
            let (name, origin) = match end {
                LineEnd::Point(id) => (DeckPoint::name_of(id), *at),
                LineEnd::Rod(id, _) => (DeckRod::name_of(id), deck.rods.iter().find(|rod| rod.id == id).map_or(*at, |rod| rod.a)),
            };
            *at = std::array::from_fn(|axis| at[axis] - origin[axis]);
            body.clone_from(&name);
            if !scene.bodies.iter().any(|body| body.name == name) {
                scene.bodies.push(Body { position: origin, ..Body::plain(&name) });
            }
        }
    }
    scene.bodies.retain(|body| body.name != VESSEL);
    scene.place_ends();
}

/// What is coupled, in the order of its columns.
fn things(deck: &Deck) -> Vec<Thing> {
    let thing = |body, label, columns| Thing { body, label, columns };
    let bodies = deck.bodies.iter().filter(|body| body.attachment == Attachment::Coupled);
    let rods = deck.rods.iter().filter(|rod| rod.attachment == Attachment::Coupled);
    let points = deck.points.iter().filter(|point| point.attachment == Attachment::Coupled);
    let bodies = bodies.map(|body| thing(DeckBody::name_of(body.id), format!("body {}", body.id), 6));
    let rods = rods.map(|rod| thing(DeckRod::name_of(rod.id), format!("rod {}", rod.id), 6));
    let points = points.map(|point| thing(DeckPoint::name_of(point.id), format!("point {}", point.id), 3));
    bodies.chain(rods).chain(points).collect()
}

/// The motions that the table in a file says, each with the name of its body; of things that a line hangs on or not.
pub fn motions(path: &Path, deck: &Deck) -> Result<Vec<(String, PoseTable)>, Error> {
    let file = path.display().to_string();
    let text = decode_leniently(read_bytes(path, LARGEST, "a table of motions")?);
    motions_of(&text, &file, deck)
}

/// The same of a text; `file` is for messages.
fn motions_of(text: &str, file: &str, deck: &Deck) -> Result<Vec<(String, PoseTable)>, Error> {
    let things = things(deck);
    let held = |id: u32| deck.lines.iter().flat_map(|line| line.ends).any(|end| matches!(end, LineEnd::Rod(own, _) if own == id));
    if things.is_empty() {
        return refuse(file, 1, "a table of motions", "nothing in the MoorDyn file is coupled, so that nothing is moved by one");
    }
    if let Some(rod) = deck.rods.iter().find(|rod| rod.attachment == Attachment::Coupled && held(rod.id)) {
        let allowed = "what the angles of a coupled rod are counted from differs among MoorDyn's versions; let the rod be part of a coupled body";
        return refuse(file, 1, format!("columns of rod {}", rod.id), allowed);
    }
    let rows = numbers(text, file, &things)?;
    let mut first = 1;
    let mut motions = Vec::new();
    for thing in things {
        let pose = |(line, row): &(usize, Vec<f64>)| {
            let own = &row[first..first + thing.columns];
            let angles: Triple = std::array::from_fn(|axis| own.get(axis + 3).map_or(0.0, |angle| angle.to_degrees()));
            let [roll, pitch, yaw] = scene_attitude(angles);
            (*line, [row[0], own[0], own[1], own[2], roll, pitch, yaw])
        };
        motions.push((thing.body, pose_file::table(rows.iter().map(pose).collect(), file)?));
        first += thing.columns;
    }
    Ok(motions)
}

/// The rows of numbers, each with its line; words before the first of them are a heading.
fn numbers(text: &str, file: &str, things: &[Thing]) -> Result<Vec<(usize, Vec<f64>)>, Error> {
    let needed = 1 + things.iter().map(|thing| thing.columns).sum::<usize>();
    let columns = || {
        let of = |thing: &Thing| {
            let names = if thing.columns == 3 { "x, y, z" } else { "x, y, z, roll, pitch, yaw" };
            format!("{names} of {}", thing.label)
        };
        let all: Vec<String> = things.iter().map(of).collect();
        format!("{needed} columns are needed: time, {} (s, m, rad)", all.join(", "))
    };
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let content = line.split(COMMENTS).next().unwrap_or_default();
        let words: Vec<&str> = content.split([' ', '\t', ',', '\r']).filter(|word| !word.is_empty()).collect();
        let (Some(word), number) = (words.first(), index + 1) else { continue };
        if rows.is_empty() && word.parse::<f64>().is_err() {
            continue;
        }
        let mut row = Vec::with_capacity(words.len());
        for (column, word) in words.iter().enumerate() {
            match word.parse::<f64>() {
                Ok(value) if value.abs() <= 1.0e15 => row.push(value),
                _ => return refuse(file, number, format!("column {} \"{word}\"", column + 1), "it must be a finite number"),
            }
        }
        if row.len() != needed {
            return refuse(file, number, format!("a row of {} columns", row.len()), columns());
        }
        if let Some((_, before)) = rows.last().filter(|(_, before)| row[0] <= before[0]) {
            let allowed = format!("times must rise, and the row before has t = {}", before[0]);
            return refuse(file, number, format!("t = {}", row[0]), allowed);
        }
        rows.push((number, row));
    }
    if rows.len() < 2 {
        let found = format!("a file of {} rows", rows.len());
        return refuse(file, text.lines().count().max(1), found, format!("a motion has at least 2 rows; {}", columns()));
    }
    Ok(rows)
}
