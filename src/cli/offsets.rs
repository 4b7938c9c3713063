//! `moorline statics --offsets BODY.x=FROM:TO:STEP`: what the mooring does to a body that is held aside: force, moment and tensions over the offset.

use crate::cli::console::{self, on_terminal};
use crate::error::{Error, among};
use crate::report::offsets::{self, Curve};
use crate::report::tables;
use crate::scene::read::Loaded;
use crate::solve::fleet;
use crate::solve::mooring::{Equilibrium, Mooring};
use std::path::Path;

/// The six ways.
pub const WAYS: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];
/// Most offsets.
const MOST: usize = 10_000;

/// Offsets of a body.
pub struct Range {
    /// Its number in the scene.
    pub body: usize,
    /// Which way, by its number among `WAYS`.
    pub way: usize,
    /// The offsets [m] or [deg].
    pub offsets: Vec<f64>,
}

/// Writes `offsets.csv` and `offsets.html` into a directory.
pub fn offsets(loaded: &Loaded, asked: &str, output: &Path) -> Result<(), Error> {
    let (curve, lost) = curve(loaded, &read(loaded, asked)?)?;
    lost.iter().for_each(|text| console::warning(text));
    if curve.rows.is_empty() {
        return refuse(loaded, asked, "the mooring reaches no offset of this range");
    }
    std::fs::create_dir_all(output)
        .map_err(|error| Error::File { path: output.display().to_string(), reason: format!("cannot be made: {error}") })?;
    let (table, page) = (output.join("offsets.csv"), output.join("offsets.html"));
    tables::write(&table, &offsets::csv(&curve))?;
    tables::write(&page, &offsets::html(&curve))?;
    let lines = [
        format!("{} offsets of \"{}\" in {}\n", curve.rows.len(), on_terminal(&curve.body), curve.way),
        format!("  {}\n  {}  open this one in a browser\n", table.display(), page.display()),
    ];
    console::print(&lines.concat())
}

/// The curve of a range, of the offsets that the mooring reaches, and why it does not reach the others.
pub fn curve(loaded: &Loaded, range: &Range) -> Result<(Curve, Vec<String>), Error> {
    let start = loaded.scene.run.start;
    let mut mooring = Mooring::new(loaded)?;
    let rest = mooring.equilibrium(start)?;
    let mut base = loaded.scene.clone();
    mooring.place_in(&mut base);
    let pose = rest.bodies[range.body].pose;
    let held = |offset: &mut f64| -> Result<Equilibrium, Error> {
        let (mut position, mut angles) = (pose.position, pose.angles);
        if range.way < 3 {
            position[range.way] += *offset;
        } else {
            angles[range.way - 3] += offset.to_radians();
        }
        let scene = base.with_body_held(range.body, position.into(), angles.map(f64::to_degrees).into());
        Mooring::new(&Loaded::of_scene(scene))?.equilibrium(start)
    };
    let mut wanted = range.offsets.clone();
    let found = fleet::for_each(&mut wanted, held);
    let mut curve = Curve {
        title: loaded.scene.title.clone(),
        body: loaded.scene.bodies[range.body].name.clone(),
        way: WAYS[range.way],
        unit: if range.way < 3 { "m" } else { "deg" },
        lines: loaded.scene.lines.iter().map(|line| line.name.clone()).collect(),
        rows: Vec::new(),
    };
    let mut lost = Vec::new();
    for (offset, found) in range.offsets.iter().zip(found) {
        match found {
            Ok(rest) => {
                let body = &rest.bodies[range.body];
                let tensions = rest.outputs.iter().map(|outputs| outputs.tension).collect();
                curve.rows.push((*offset, [body.force, body.moment], tensions));
            }
            Err(error) => lost.push(format!("{} = {offset}: {error}", WAYS[range.way])),
        }
    }
    Ok((curve, lost))
}

fn refuse<T>(loaded: &Loaded, asked: &str, allowed: &str) -> Result<T, Error> {
    let (file, place) = (loaded.file.clone(), "--offsets".to_owned());
    Err(Error::Value { file, place, value: format!("\"{asked}\""), allowed: allowed.to_owned() })
}

/// Reads `BODY.WAY=FROM:TO:STEP`.
fn read(loaded: &Loaded, asked: &str) -> Result<Range, Error> {
    const FORM: &str = "write it as vessel.x=-20:20:1: a body, one of x, y, z, roll, pitch, yaw, from, to and step in m or deg";
    let Some(((name, way), numbers)) =
        asked.split_once('=').and_then(|(place, numbers)| Some((place.rsplit_once('.')?, numbers)))
    else {
        return refuse(loaded, asked, FORM);
    };
    let known: Vec<String> = loaded.scene.bodies.iter().map(|body| body.name.clone()).collect();
    let Some(body) = loaded.scene.body(name) else {
        return refuse(loaded, asked, &format!("there is no body of that name{}", among(name, &known)));
    };
    let Some(way) = WAYS.iter().position(|known| *known == way) else { return refuse(loaded, asked, FORM) };
    let numbers: Vec<f64> = numbers.split(':').map_while(|number| number.trim().parse().ok()).collect();
    let [from, to, step] = numbers[..] else { return refuse(loaded, asked, FORM) };
    let count = (to - from) / step;
    if !(step > 0.0 && count >= 0.0 && count < MOST as f64) {
        return refuse(loaded, asked, "the step is positive and leads from the first offset to the last in at most 10000 steps");
    }
    let count = (count + 1.0e-9).floor() as usize;
    Ok(Range { body, way, offsets: (0..=count).map(|k| from + step * k as f64).collect() })
}
