//! From text to a checked scene: JSON, a CABLE file or a MoorDyn file, `--set`, types, names, plausibility, motion file. Every way to fail names its
//! place.

mod place;
mod setting;

use crate::error::{Error, Problem};
use crate::scene::bodies::{BodyMotion, PointMotion};
use crate::scene::cable::{Deck, forced_motion, reading, to_scene};
use crate::scene::moordyn;
use crate::scene::moordyn::driver::{self, Driver, Motions};
use crate::scene::state::LineState;
use crate::scene::text::{char_start, decode, decode_leniently, line_and_column, read_bytes};
use crate::scene::types::{Motion, Scene, Scheme, Seas, Waves};
use crate::scene::{check, current_file, elevation_file, load_file, motion_file, pose_file};
use place::{Place, Step, shortened};
use serde_json::Value;
use setting::Applied;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The built-in scene.
const BUILT_IN: &str = include_str!("../../examples/lindahl-sjoberg.json");

/// A scene file larger than this [bytes] is none.
const LARGEST: u64 = 16 << 20;

/// A scene that has been read and checked, and what belongs to it.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scene; every line has a name.
    pub scene: Scene,
    /// Its file, for messages.
    pub file: String,
    /// Directory of the file; paths in the scene are relative to it.
    pub directory: PathBuf,
    /// The motion of kind `file`, else none.
    pub motion: Option<Arc<motion_file::Table>>,
    /// Motions of bodies from files, by body; none where it is of another kind.
    pub body_motions: Vec<Option<Arc<pose_file::PoseTable>>>,
    /// Loads on bodies from files, by body; none where there is no file.
    pub body_loads: Vec<Option<Arc<load_file::LoadTable>>>,
    /// Motions of points from files, by point.
    pub point_motions: Vec<Option<Arc<motion_file::Table>>>,
    /// The CABLE file that the scene was read from, else none.
    pub deck: Option<Arc<Deck>>,
    /// The state of the only line that the file gives, else none.
    pub state: Option<Arc<LineState>>,
    /// The MoorDyn file that the scene was read from, else none.
    pub moordyn: Option<Arc<moordyn::Deck>>,
    /// What is allowed but may not be meant.
    pub warnings: Vec<String>,
}

impl Loaded {
    /// A scene that no file was read for.
    pub fn of_scene(scene: Scene) -> Loaded {
        Loaded {
            scene,
            file: String::new(),
            directory: PathBuf::new(),
            motion: None,
            body_motions: Vec::new(),
            body_loads: Vec::new(),
            point_motions: Vec::new(),
            deck: None,
            state: None,
            moordyn: None,
            warnings: Vec::new(),
        }
    }
}

/// Reads and checks a scene file, changed by `--set` entries (`place=value`).
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, Error> {
    let (text, file) = text_of(path)?;
    parse(&text, &file, path.parent().unwrap_or(Path::new("")), sets)
}

/// Reads and checks a MoorDyn file whose coupled things move as the file `motion` says: the driver of it, or the table that a driver names.
pub fn load_moved(path: &Path, motion: &Path, sets: &[String]) -> Result<Loaded, Error> {
    let (text, file) = text_of(path)?;
    if driver::is_driver(&text) || !moordyn::sections::is_deck(&text) {
        return Err(Error::Value {
            file,
            place: String::from("--motion"),
            value: motion.display().to_string(),
            allowed: String::from(
                "it moves what is coupled in a MoorDyn file, and this is none; a scene says in `motion`, `bodies[0].motion`, … how things move",
            ),
        });
    }
    let driver = driver::read_either(motion)?;
    parse_moordyn(&text, &file, path.parent().unwrap_or(Path::new("")), sets, &driver)
}

/// The text of a scene file, and its name for messages.
fn text_of(path: &Path) -> Result<(String, String), Error> {
    let file = path.display().to_string();
    let text = String::from_utf8(read_bytes(path, LARGEST, "a scene file")?).or_else(|error| {
        // Headings of old MoorDyn files have signs of other encodings.
        let lenient = decode_leniently(error.as_bytes().to_vec());
        if moordyn::sections::is_deck(&lenient) { Ok(lenient) } else { decode(error.into_bytes(), &file) }
    })?;
    Ok((text, file))
}

/// The built-in scene (Lindahl & Sjöberg 1983 as run by Ma & Webster 1994), changed by `--set` entries.
pub fn built_in(sets: &[String]) -> Result<Loaded, Error> {
    parse(BUILT_IN, "built-in scene", Path::new("."), sets)
}

/// Reads and checks the text of a scene, changed by `--set` entries. `file` is for messages; paths in the scene are
/// relative to `directory`.
pub fn parse(text: &str, file: &str, directory: &Path, sets: &[String]) -> Result<Loaded, Error> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if driver::is_driver(text) {
        let driver = driver::read(text, file, directory)?;
        let (text, path) = driver::deck_text(&driver, directory)?;
        return parse_moordyn(&text, &path.display().to_string(), path.parent().unwrap_or(Path::new("")), sets, &driver);
    }
    if moordyn::sections::is_deck(text) {
        return parse_moordyn(text, file, directory, sets, &Driver::default());
    }
    if !text.trim().is_empty() && reading::is_deck(text) {
        return parse_deck(text, file, directory, sets);
    }
    let mut value = json(text, file)?;
    let applied = setting::apply(&mut value, sets, file)?;
    let scene = typed(&value, &Source { text, file, applied: &applied })?;
    let warnings = check::check(&scene, file)?;
    let mut loaded = Loaded {
        scene,
        file: file.to_string(),
        directory: directory.to_path_buf(),
        motion: None,
        body_motions: Vec::new(),
        body_loads: Vec::new(),
        point_motions: Vec::new(),
        deck: None,
        state: None,
        moordyn: None,
        warnings,
    };
    read_motion(&mut loaded, &Motions::new())?;
    Ok(loaded)
}

/// Reads and checks a CABLE file, changed by `--set` entries that speak of its scene.
fn parse_deck(text: &str, file: &str, directory: &Path, sets: &[String]) -> Result<Loaded, Error> {
    let reading = reading::read(text, file)?;
    let meaning = to_scene::meaning(&reading.deck);
    let mut value = serde_json::to_value(&meaning.scene).unwrap_or_default();
    let applied = setting::apply(&mut value, sets, file)?;
    let mut scene = typed(&value, &Source { text: "", file, applied: &applied })?;
    if scene.solver.scheme == Scheme::Cable1994 && reading.deck.step > 0.0 {
        scene.solver.fixed_step.get_or_insert(reading.deck.step);
    }
    let placed = |error| if sets.is_empty() { in_the_deck(error, &reading) } else { error };
    let mut warnings = reading.warnings.clone();
    warnings.extend(meaning.warnings.iter().map(|warning| format!("{file}: {warning}")));
    warnings.extend(check::check(&scene, file).map_err(placed)?);
    let (deck, state) = (Some(Arc::new(reading.deck)), Some(Arc::new(meaning.state)));
    let mut loaded = Loaded {
        scene,
        file: file.to_string(),
        directory: directory.to_path_buf(),
        motion: None,
        body_motions: Vec::new(),
        body_loads: Vec::new(),
        point_motions: Vec::new(),
        deck,
        state,
        moordyn: None,
        warnings,
    };
    read_motion(&mut loaded, &Motions::new())?;
    Ok(loaded)
}

/// Reads and checks a MoorDyn file with its driver, changed by `--set` entries that speak of its scene.
fn parse_moordyn(text: &str, file: &str, directory: &Path, sets: &[String], driver: &Driver) -> Result<Loaded, Error> {
    let reading = moordyn::reading::read(text, file, directory, driver.water.clone())?;
    let mut meaning = moordyn::to_scene::meaning(&reading, text, file, directory)?;
    let motions = driver.drive(&mut meaning, &reading.deck)?;
    let mut value = serde_json::to_value(&meaning.scene).unwrap_or_default();
    let applied = setting::apply(&mut value, sets, file)?;
    let scene = typed(&value, &Source { text: "", file, applied: &applied })?;
    let placed = |error| if sets.is_empty() { in_the_rows(error, &meaning.spots) } else { error };
    let mut warnings: Vec<String> = meaning.warnings.iter().map(|warning| format!("{file}: {warning}")).collect();
    warnings.extend(check::check(&scene, file).map_err(placed)?);
    let mut loaded = Loaded { file: file.into(), directory: directory.into(), warnings, ..Loaded::of_scene(scene) };
    loaded.moordyn = Some(Arc::new(reading.deck));
    read_motion(&mut loaded, &motions)?;
    Ok(loaded)
}

/// An error of the check with the line of the MoorDyn file.
fn in_the_rows(error: Error, spots: &[(String, usize)]) -> Error {
    let at = |place: String| match spots.iter().find(|(of, _)| place.starts_with(of)) {
        Some((_, line)) => format!("line {line}, {place}"),
        None => place,
    };
    match error {
        Error::Value { file, place, value, allowed } => Error::Value { file, place: at(place), value, allowed },
        Error::Reach(mut reach) => {
            reach.place = at(reach.place);
            Error::Reach(reach)
        }
        other => other,
    }
}

/// An error of the check with line and column of the CABLE file.
fn in_the_deck(error: Error, reading: &reading::Reading) -> Error {
    let at = |place: String| match to_scene::spot(reading, &place) {
        Some(spot) => format!("line {}, column {}, {place}", spot.line, spot.column),
        None => place,
    };
    match error {
        Error::Value { file, place, value, allowed } => Error::Value { file, place: at(place), value, allowed },
        other => other,
    }
}

/// A scene of the right types, with names.
fn typed(value: &Value, source: &Source) -> Result<Scene, Error> {
    let mut scene: Scene = serde_path_to_error::deserialize(value).map_err(|error| {
        let place = from_path(error.path());
        let (place, problem) = in_words(&error.inner().to_string(), place);
        source.error(place, problem)
    })?;
    if let Some((place, problem)) = other_shape(value, &scene) {
        return Err(source.error(place, problem));
    }
    name_lines(&mut scene);
    scene.place_ends();
    Ok(scene)
}

/// Reads the files of motions and loads that a checked scene names, but for motions that are there. What the water does comes into the scene
/// itself.
fn read_motion(loaded: &mut Loaded, motions: &Motions) -> Result<(), Error> {
    let directory = &loaded.directory;
    let records = loaded.scene.environment.waves.as_mut().map_or(&mut [][..], Seas::each_mut);
    let mut records_read = false;
    for sea in records {
        if let Waves::Elevation { path, series, .. } = sea
            && let Some(path) = path.take()
        {
            *series = Some(elevation_file::read(&directory.join(path))?);
            records_read = true;
        }
    }
    if records_read {
        let warnings = check::check(&loaded.scene, &loaded.file)?;
        let new: Vec<String> = warnings.into_iter().filter(|warning| !loaded.warnings.contains(warning)).collect();
        loaded.warnings.extend(new);
    }
    if let Some(current) = &mut loaded.scene.environment.current_over_time
        && let Some(path) = current.path.take()
    {
        current.rows = Some(current_file::read(&directory.join(path))?);
    }
    loaded.warnings.extend(check::beyond_records(&loaded.scene));
    for body in &loaded.scene.bodies {
        let load = body.load.as_ref().map(|path| load_file::read(&loaded.directory.join(path)).map(Arc::new));
        loaded.body_loads.push(load.transpose()?);
        let BodyMotion::File { path } = &body.motion else {
            loaded.body_motions.push(None);
            continue;
        };
        let table = match motions.get(&body.name) {
            Some((own, table)) if own == path => Arc::clone(table),
            _ => Arc::new(pose_file::read(&loaded.directory.join(path))?),
        };
        loaded.body_motions.push(Some(table));
    }
    for point in &loaded.scene.points {
        let PointMotion::File { path } = &point.motion else {
            loaded.point_motions.push(None);
            continue;
        };
        let table = motion_file::read(&loaded.directory.join(path), &loaded.scene.environment)?;
        loaded.point_motions.push(Some(Arc::new(table)));
    }
    let Motion::File { path } = &loaded.scene.motion else { return Ok(()) };
    let place = loaded.directory.join(path);
    let table = match &loaded.deck {
        Some(deck) if path == forced_motion::NAME => forced_motion::read(&place, deck, &loaded.scene.environment)?,
        _ => motion_file::read(&place, &loaded.scene.environment)?,
    };
    loaded.warnings.extend(check::motion_table(&loaded.scene, &table, path));
    loaded.motion = Some(Arc::new(table));
    Ok(())
}

/// JSON Schema of a scene, from the types that read it.
pub fn schema() -> Value {
    schemars::schema_for!(Scene).to_value()
}

/// JSON text as a tree.
fn json(text: &str, file: &str) -> Result<Value, Error> {
    let start = text.trim_start();
    let at = |offset: usize, place: Place, problem: Problem| {
        let (line, column) = line_and_column(text, offset);
        Error::Json { file: file.into(), line, column, place: place.to_string(), problem: problem.into() }
    };
    if start.is_empty() {
        return Err(at(text.len(), Place::default(), Problem::Empty));
    }
    let value: Value = serde_json::from_str(text).map_err(|error| {
        let line_start = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
        let offset = (line_start + error.column().saturating_sub(1)).min(text.len());
        at(offset, place::place_at(text, offset), syntax(&error, text, offset))
    })?;
    if !value.is_object() {
        let found = plain_found(if value.is_array() { "sequence" } else { "a text" });
        return Err(at(text.len() - start.len(), Place::default(), Problem::Type { found, expected: plain_expected("a map") }));
    }
    match place::duplicate_key(text) {
        None => Ok(value),
        Some(twice) => {
            let key = twice.place.0.last().map(|step| Place(vec![step.clone()]).to_string()).unwrap_or_default();
            let first_line = line_and_column(text, twice.first).0;
            Err(at(twice.second, twice.place, Problem::DuplicateKey { key, first_line }))
        }
    }
}

/// What breaks the rules of JSON at a byte of the text.
fn syntax(error: &serde_json::Error, text: &str, offset: usize) -> Problem {
    let offset = char_start(text, offset);
    let ends = |c: char| c.is_whitespace() || "{}[],:\"".contains(c);
    let start = text[..offset].rfind(ends).map_or(0, |found| found + text[found..].chars().next().map_or(1, char::len_utf8));
    let word = text[start..].split(ends).next().unwrap_or_default();
    let bare = word.trim_start_matches(['-', '+']).to_lowercase();
    let reason = error.to_string();
    let reason = reason.split(" at line ").next().unwrap_or_default();
    if ["nan", "inf", "infinity"].contains(&bare.as_str()) || reason == "number out of range" {
        return Problem::NotFinite { text: shortened(word) };
    }
    if reason == "recursion limit exceeded" {
        return Problem::TooDeep;
    }
    if error.is_eof() {
        return Problem::Truncated;
    }
    let hint = match word.chars().next() {
        Some('#' | '/') => "; JSON knows no comments",
        Some('\'') => "; words stand in double quotes",
        Some('.' | '+') => "; a number begins with a digit or a minus sign",
        Some(_) => &format!(", found `{}`", shortened(word)),
        None => "",
    };
    Problem::Syntax { reason: format!("{reason}{hint}") }
}

/// Where a scene came from: its text and what `--set` made of it.
struct Source<'a> {
    text: &'a str,
    file: &'a str,
    applied: &'a [Applied],
}

impl Source<'_> {
    /// The error for a problem at a place: it names the `--set` that caused it, else line and column of the text.
    fn error(&self, place: Place, problem: Problem) -> Error {
        let concerned = match &problem {
            Problem::MissingKey { key } => place.member(key),
            _ => place.clone(),
        };
        let offset = place::locate(self.text, &place);
        let mut latest = self.applied.iter().rev();
        let cause = latest.clone().find(|set| set.place.holds(&concerned));
        let cause = cause.or_else(|| latest.find(|set| offset.is_none() && !place.0.is_empty() && place.holds(&set.place)));
        if let Some(set) = cause {
            let within = place.inside(&set.place);
            return Error::Set {
                file: self.file.into(),
                setting: set.typed.clone(),
                place: within.to_string(),
                problem: problem.into(),
            };
        }
        let start = self.text.len() - self.text.trim_start().len();
        let (line, column) = line_and_column(self.text, offset.unwrap_or(start));
        Error::Json { file: self.file.into(), line, column, place: place.to_string(), problem: problem.into() }
    }
}

/// The place that serde was at.
fn from_path(path: &serde_path_to_error::Path) -> Place {
    use serde_path_to_error::Segment;
    let steps = path.iter().filter_map(|segment| match segment {
        Segment::Seq { index } => Some(Step::Index(*index)),
        Segment::Map { key } => Some(Step::Key(key.clone())),
        Segment::Enum { .. } | Segment::Unknown => None,
    });
    Place(steps.collect())
}

/// What serde's message says, as data, and the place it is about: of an unknown key the key's own.
fn in_words(message: &str, place: Place) -> (Place, Problem) {
    let (found, expected) = message.rsplit_once(", expected ").unwrap_or((message, ""));
    let quoted = |text: &str| found.strip_prefix(text).map(|rest| rest.trim_matches('`').to_string());
    let known = || expected.split('`').skip(1).step_by(2).map(String::from).collect::<Vec<String>>();
    if let Some(key) = message.strip_prefix("missing field ") {
        return (place, Problem::MissingKey { key: key.trim_matches('`').to_string() });
    }
    if let Some(key) = quoted("unknown field `") {
        let own = if place.0.last() == Some(&Step::Key(key.clone())) { place } else { place.member(&key) };
        return (own, Problem::UnknownKey { key: shortened(&key), known: known() });
    }
    if let Some(name) = quoted("unknown variant `") {
        return (place, Problem::UnknownName { name: shortened(&name), known: known() });
    }
    let found =
        found.trim_start_matches("invalid type: ").trim_start_matches("invalid value: ").trim_start_matches("invalid length ");
    (place, Problem::Type { found: shortened(&plain_found(found)), expected: plain_expected(expected) })
}

/// What serde found, in plain words.
fn plain_found(found: &str) -> String {
    match found {
        "map" => String::from("an object { }"),
        "sequence" => String::from("a list [ ]"),
        count if count.parse::<usize>().is_ok() => format!("a list of {count}"),
        _ => found
            .trim_start_matches("integer ")
            .trim_start_matches("floating point ")
            .trim_start_matches("boolean ")
            .replace('`', ""),
    }
}

/// What serde expected, in plain words.
fn plain_expected(expected: &str) -> String {
    let plain = match expected {
        "f64" => "a number",
        "usize" | "u64" => "a whole number, not negative and without a decimal point",
        "a string" => "a text in quotes",
        "a boolean" => "true or false",
        "a sequence" => "a list [ ]",
        "a map" => "an object { }",
        "string or map" => "a name in quotes",
        "an array of length 3" | "fewer elements in array" => "three values [x, y, z]",
        "an array of length 2" => "two numbers",
        other if other.starts_with("struct ") || other.contains("tagged enum") => "an object { }",
        other => other,
    };
    plain.to_string()
}

/// Where the scene stands otherwise than it was written: serde takes a list of values for an object, and an object for a name.
fn other_shape(written: &Value, scene: &Scene) -> Option<(Place, Problem)> {
    let read = serde_json::to_value(scene).ok()?;
    let mut pairs = vec![(Place::default(), written, &read)];
    while let Some((place, written, read)) = pairs.pop() {
        match (written, read) {
            (Value::Object(members), Value::Object(others)) => {
                let both = members.iter().filter_map(|(key, member)| Some((place.member(key), member, others.get(key)?)));
                pairs.extend(both);
            }
            (Value::Array(entries), Value::Array(others)) => {
                let both = entries.iter().zip(others).enumerate();
                pairs.extend(both.map(|(index, (entry, other))| (place.with(Step::Index(index)), entry, other)));
            }
            (Value::Array(_), Value::Object(_)) => {
                return Some((place, Problem::Type { found: plain_found("sequence"), expected: plain_expected("a map") }));
            }
            (Value::Object(_), Value::String(_)) => {
                return Some((place, Problem::Type { found: plain_found("map"), expected: plain_expected("string or map") }));
            }
            _ => {}
        }
    }
    None
}

/// Names the lines that have no name `line1`, `line2`, … by their position.
fn name_lines(scene: &mut Scene) {
    for (number, line) in scene.lines.iter_mut().enumerate() {
        if line.name.is_empty() {
            line.name = format!("line{}", number + 1);
        }
    }
}
