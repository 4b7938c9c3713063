//! The driver of a MoorDyn file, as OpenFAST has one: the water, the time, and the table that moves what is coupled, or an offset of it.

use crate::algebra::rotation;
use crate::error::{Error, MoorDynProblem};
use crate::scene::bodies::BodyMotion;
use crate::scene::moordyn::coupled;
use crate::scene::moordyn::options::{Depth, Options};
use crate::scene::moordyn::sections::{Row, number};
use crate::scene::moordyn::to_scene::{Meaning, VESSEL};
use crate::scene::moordyn::words::Attachment;
use crate::scene::moordyn::{Deck, DeckBody};
use crate::scene::pose_file::PoseTable;
use crate::scene::text::{decode_leniently, read_bytes};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A larger file [bytes] is no driver.
const LARGEST: u64 = 16 << 20;
/// Angles of an offset are no larger than this [rad].
const TURNED: f64 = 1.5;
/// The word that tells a driver from other files.
const MARK: &str = "mdinputfile";

/// What a driver says, or a table of motions alone.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Driver {
    /// The MoorDyn file, as the driver names it; empty where there is only a table.
    pub deck: String,
    /// Gravity, density and depth, for a MoorDyn file that does not say them.
    pub water: Options,
    /// How long the run is [s].
    pub duration: Option<f64>,
    /// The table of motions.
    pub table: Option<PathBuf>,
    /// Offset of all that is coupled: along x, y, z [m], about x, y, z [rad].
    pub offset: [f64; 6],
    /// What is not used.
    pub warnings: Vec<String>,
}

/// Motions by the name of their bodies, and the path that stands for them in the scene.
pub type Motions = BTreeMap<String, (String, Arc<PoseTable>)>;

/// Whether a text is a driver.
pub fn is_driver(text: &str) -> bool {
    text.lines().any(|line| split(line).is_some_and(|(_, rest)| key(rest) == MARK))
}

/// The value that a line begins with, without quotes, and what follows it.
fn split(line: &str) -> Option<(&str, &str)> {
    let line = line.trim();
    match line.strip_prefix('"') {
        Some(quoted) => quoted.split_once('"'),
        None => line.split_once(char::is_whitespace),
    }
}

/// The word after a value.
fn key(rest: &str) -> String {
    rest.split_whitespace().next().unwrap_or_default().to_lowercase()
}

/// The driver in a file, or the table that the file is.
pub fn read_either(path: &Path) -> Result<Driver, Error> {
    let text = decode_leniently(read_bytes(path, 256 << 20, "a driver or a table of motions")?);
    if is_driver(&text) {
        return read(&text, &path.display().to_string(), path.parent().unwrap_or(Path::new("")));
    }
    Ok(Driver { table: Some(path.to_path_buf()), ..Driver::default() })
}

/// Reads the text of a driver; `file` is for messages, the table is looked for from `directory`.
pub fn read(text: &str, file: &str, directory: &Path) -> Result<Driver, Error> {
    let mut driver = Driver::default();
    let (mut mode, mut inputs, mut starts) = (0.0, None, false);
    for (index, line) in text.lines().enumerate() {
        let row = Row { number: index + 1, text: line.trim(), words: line.split_whitespace().collect() };
        if line.trim_start().starts_with("---") {
            starts = line.to_uppercase().contains("INITIAL POSITIONS");
            continue;
        }
        if starts {
            if row.words.first().is_some_and(|word| word.parse::<f64>().is_ok()) {
                driver.offset_of(&row, file)?;
                break;
            }
            continue;
        }
        let Some((value, rest)) = split(line) else { continue };
        let plain = |item| number(&row, file, item, value);
        let positive = |item| match plain(item)? {
            value if value > 0.0 => Ok(value),
            _ => Err(row.unreadable(file, item, value, "a number greater than 0")),
        };
        match key(rest).as_str() {
            MARK => driver.deck = value.to_string(),
            "gravity" => driver.water.gravity = plain("Gravity")?,
            "rhow" | "wtrdens" => driver.water.water_density = positive("rhoW")?,
            "wtrdpth" | "wtrdepth" => driver.water.depth = Some(Depth::Level(positive("WtrDpth")?)),
            "tmax" => driver.duration = Some(positive("TMax")?),
            "inputsmode" | "inputsmod" => mode = plain("InputsMode")?,
            "inputsfile" => inputs = Some((value.to_string(), row)),
            "numturbines" if plain("NumTurbines")? != 0.0 => {
                let reason = "mooring of a farm is not driven here; give each turbine a file and a driver of its own";
                return Err(row.cannot(file, "NumTurbines", reason));
            }
            "dtc" => driver.warnings.push(format!("{file}: dtC: of MoorDyn's own time stepping; not used")),
            _ => {}
        }
    }
    let last = || {
        let text = text.lines().last().unwrap_or_default();
        Row { number: text.lines().count(), text, words: Vec::new() }
    };
    if mode == 1.0 {
        let Some((name, row)) = inputs else {
            return Err(
                last().error(file, MoorDynProblem::NoSection { section: "MOORDYN with an InputsFile, which InputsMode 1 needs" })
            );
        };
        if name.is_empty() {
            return Err(row.unreadable(file, "InputsFile", &name, "the name of a table of motions, which InputsMode 1 needs"));
        }
        driver.table = Some(directory.join(name));
        if driver.offset != [0.0; 6] {
            driver
                .warnings
                .push(format!("{file}: initial positions: the table says where everything is from the beginning; not used"));
        }
    } else if mode != 0.0 {
        let reason = format!("{mode}: 0 leaves what is coupled where it is, 1 moves it by the table of InputsFile");
        return Err(last().cannot(file, "InputsMode", &reason));
    }
    Ok(driver)
}

impl Driver {
    /// Takes the row of initial positions.
    fn offset_of(&mut self, row: &Row, file: &str) -> Result<(), Error> {
        let columns = "ref_X, ref_Y, surge, sway, heave, roll, pitch, yaw";
        if row.words.len() < 8 {
            return Err(row.error(file, MoorDynProblem::TooFew { found: row.words.len(), needed: 8, columns }));
        }
        for (at, value) in self.offset.iter_mut().enumerate() {
            *value = number(row, file, "initial position", row.words[at + 2])?;
            if at >= 3 && value.abs() > TURNED {
                return Err(row.unreadable(file, "initial position", row.words[at + 2], "an angle in rad, within ±1.5"));
            }
        }
        if [0, 1].iter().any(|at| row.words[*at].parse::<f64>().is_ok_and(|place| place != 0.0)) {
            self.warnings.push(format!("{file}: ref_X, ref_Y: of FAST.Farm; not used"));
        }
        Ok(())
    }

    /// Puts into a scene what the driver says; the motions of its bodies.
    pub fn drive(&self, meaning: &mut Meaning, deck: &Deck) -> Result<Motions, Error> {
        let scene = &mut meaning.scene;
        meaning.warnings.extend(self.warnings.iter().cloned());
        scene.run.duration = self.duration.unwrap_or(scene.run.duration);
        let Some(path) = &self.table else {
            self.offset(meaning, deck);
            return Ok(Motions::new());
        };
        coupled::move_alone(scene, deck);
        let (mut motions, name) = (Motions::new(), path.display().to_string());
        let mut end = f64::INFINITY;
        for (body, table) in coupled::motions(path, deck)? {
            end = table.times.last().copied().unwrap_or(end);
            let Some(own) = scene.bodies.iter_mut().find(|own| own.name == body) else { continue };
            let first = |way: usize| table.values[way].first().copied().unwrap_or_default();
            own.position = [first(0), first(1), first(2)];
            own.attitude_deg = [first(3), first(4), first(5)].map(f64::to_degrees);
            own.motion = BodyMotion::File { path: name.clone() };
            motions.insert(body, (name.clone(), Arc::new(table)));
        }
        if self.duration.is_none_or(|duration| duration > end) {
            scene.run.duration = end.max(0.0);
        }
        scene.place_ends();
        Ok(motions)
    }

    /// Shifts and turns what is coupled by the initial positions, as one: R' = R₀ R, p' = R₀ p + d.
    fn offset(&self, meaning: &mut Meaning, deck: &Deck) {
        if self.offset == [0.0; 6] {
            return;
        }
        let [x, y, z, roll, pitch, yaw] = self.offset;
        let turn = rotation::of_angles_xyz(&Vector3::new(roll, pitch, yaw));
        let names: Vec<String> = deck
            .bodies
            .iter()
            .filter(|body| body.attachment == Attachment::Coupled)
            .map(|body| DeckBody::name_of(body.id))
            .chain([VESSEL.to_string()])
            .collect();
        for body in meaning.scene.bodies.iter_mut().filter(|body| names.contains(&body.name)) {
            body.position = (turn * Vector3::from(body.position) + Vector3::new(x, y, z)).into();
            let attitude = turn * rotation::of_angles(&body.attitude());
            body.attitude_deg = rotation::angles(&attitude).map(f64::to_degrees).into();
        }
        meaning.scene.place_ends();
    }
}

/// The text of the MoorDyn file of a driver, and its path.
pub fn deck_text(driver: &Driver, directory: &Path) -> Result<(String, PathBuf), Error> {
    let path = directory.join(&driver.deck);
    Ok((decode_leniently(read_bytes(&path, LARGEST, "the MoorDyn file of a driver")?), path))
}
