//! `moorline fit SCENE --change PLACE --until RESULT=VALUE`: the value of the scene that gives a static result that is wanted, such as a pretension.
//!
//! The range from a quarter to four times the present value (or as told) is searched in steps; where the result passes the wanted value the place is found by the
//! Illinois variant of the rule of false position. No such place, or more than one, is said.

use crate::cli::arguments::FitArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::stop::Stop;
use crate::error::{Error, among};
use crate::report::tables;
use crate::scene::read::{self, Loaded};
use crate::scene::types::Scene;
use crate::solve::fleet;
use crate::solve::mooring::{Equilibrium, Mooring};
use serde_json::Value;

/// Values tried in the range.
const TRIALS: usize = 49;
/// The result is met to this share of what is wanted.
const CLOSE: f64 = 1.0e-9;
/// Steps of the search at most.
const STEPS: usize = 60;

/// Finds the value, writes the scene, and says what it found.
pub fn fit(arguments: &FitArguments) -> Result<(), Stop> {
    let given = read::load(&arguments.scene, &arguments.sets)?;
    given.warnings.iter().for_each(|warning| console::warning(warning));
    let found = find(&given, &arguments.change, &arguments.until, arguments.range.as_deref())?;
    found.warning.iter().for_each(|warning| console::warning(warning));
    let output = arguments.output.clone().unwrap_or_else(|| arguments.scene.with_extension("fitted.json"));
    tables::write(&output, &(serde_json::to_string_pretty(&found.scene).unwrap_or_default() + "\n"))?;
    let text = format!(
        "{} = {:.9} (was {}) gives {} = {:.9e}\n  {}\n",
        on_terminal(&arguments.change),
        found.value,
        found.before,
        found.what,
        found.reached,
        on_terminal(&output.display().to_string())
    );
    Ok(console::print(&text)?)
}

/// What was found.
pub struct Found {
    /// The scene with it.
    pub scene: Scene,
    /// The value.
    pub value: f64,
    /// What it was.
    pub before: f64,
    /// Name of the result.
    pub what: String,
    /// The result with it.
    pub reached: f64,
    /// That other values would do as well, if they would.
    pub warning: Option<String>,
}

/// Finds the value at the place `change` for which `until` (`bow.tension=1.2e6`) holds, in a range (`700:800`) or from a quarter to four times
/// the present value. Errors name what cannot be read, reached or found.
pub fn find(given: &Loaded, change: &str, until: &str, range: Option<&str>) -> Result<Found, Error> {
    let refuse = |place: &str, value: &str, allowed: String| -> Error {
        Error::Value { file: given.file.clone(), place: place.to_owned(), value: value.to_owned(), allowed }
    };
    let form = "write it as bow.tension=1.2e6: a line, body or point, what of it, and the value wanted in SI units";
    let parted = until.split_once('=').and_then(|(what, value)| Some((what, value.trim().parse::<f64>().ok()?)));
    let (what, wanted) =
        parted.filter(|(_, value)| value.is_finite()).ok_or_else(|| refuse("--until", until, form.to_owned()))?;
    let pointer = pointer(change);
    let whole = serde_json::to_value(&given.scene).unwrap_or_default();
    let present = whole.pointer(&pointer).and_then(Value::as_f64).ok_or_else(|| {
        refuse("--change", change, "name a number of the scene, such as lines[0].sections[0].length".to_owned())
    })?;
    let (low, high) = match range {
        Some(range) => {
            let numbers: Vec<f64> = range.split(':').map_while(|number| number.trim().parse().ok()).collect();
            match numbers[..] {
                [low, high] if low < high => (low, high),
                _ => return Err(refuse("--range", range, "write it as 700:800, the smaller first".to_owned())),
            }
        }
        None if present == 0.0 => {
            return Err(refuse("--change", change, "its value is 0: say where to look with --range FROM:TO".to_owned()));
        }
        None => (0.25 * present.abs(), 4.0 * present.abs()),
    };
    let (low, high) = if range.is_none() && present < 0.0 { (-high, -low) } else { (low, high) };
    // In the whole scene, so that what the file leaves to defaults can be changed, too.
    let with = |value: f64| -> Result<Loaded, Error> {
        let mut changed = whole.clone();
        if let Some(place) = changed.pointer_mut(&pointer) {
            *place = Value::from(value);
        }
        read::parse(&changed.to_string(), &given.file, &given.directory, &[])
    };
    let solve = |value: f64| -> Result<f64, Error> {
        let loaded = with(value)?;
        let rest = Mooring::new(&loaded)?.equilibrium(loaded.scene.run.start)?;
        result(&loaded, &rest, what)
    };
    // What cannot be asked for is said before anything is searched.
    let first = solve(present);
    if let Err(error @ Error::Value { .. }) = &first {
        return Err(error.clone());
    }
    let mut values: Vec<f64> = (0..TRIALS).map(|k| low + (high - low) * k as f64 / (TRIALS - 1) as f64).collect();
    values.push(present);
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mut tried = values.clone();
    let found = fleet::for_each(&mut tried, |value| solve(*value).ok());
    let known: Vec<(f64, f64)> =
        values.iter().zip(&found).filter_map(|(value, result)| Some((*value, (*result)? - wanted))).collect();
    let passes: Vec<[(f64, f64); 2]> =
        known.windows(2).filter(|pair| (pair[0].1 < 0.0) != (pair[1].1 < 0.0)).map(|pair| [pair[0], pair[1]]).collect();
    let Some(nearest) = passes.iter().min_by(|a, b| (a[0].0 - present).abs().total_cmp(&(b[0].0 - present).abs())) else {
        let best = known.iter().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let near = best.map_or_else(
            || "there is no equilibrium for any".to_owned(),
            |(value, off)| format!("the nearest is {:.6e} at {value:.6}", off + wanted),
        );
        let allowed =
            format!("no value of {} from {low:.6} to {high:.6} gives it: {near}. Look elsewhere with --range FROM:TO", change);
        return Err(refuse("--until", until, allowed));
    };
    let warning = (passes.len() > 1).then(|| {
        let places: Vec<String> = passes.iter().map(|pair| format!("{:.4}", 0.5 * (pair[0].0 + pair[1].0))).collect();
        format!(
            "more than one value gives {until}: near {}; the one nearest to the present {present} is taken. Choose with --range FROM:TO",
            places.join(", ")
        )
    });
    let (value, reached) = false_position(*nearest, wanted.abs().max(f64::MIN_POSITIVE), &solve, wanted)?;
    let fitted = with(value)?;
    Ok(Found { scene: fitted.scene, value, before: present, what: what.to_owned(), reached, warning })
}

/// The place between two at which the result is the wanted one.
fn false_position(
    [mut a, mut b]: [(f64, f64); 2],
    size: f64,
    solve: &dyn Fn(f64) -> Result<f64, Error>,
    wanted: f64,
) -> Result<(f64, f64), Error> {
    let mut best = if a.1.abs() < b.1.abs() { a } else { b };
    for _ in 0..STEPS {
        if best.1.abs() <= CLOSE * size || (b.0 - a.0).abs() <= 1.0e-14 * (a.0.abs() + b.0.abs()) {
            break;
        }
        let middle = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let here = (middle, solve(middle)? - wanted);
        if here.1.abs() < best.1.abs() {
            best = here;
        }
        if (here.1 < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = here;
    }
    Ok((best.0, best.1 + wanted))
}

/// `lines[0].sections[0].length` as a JSON pointer.
fn pointer(place: &str) -> String {
    place.split(['.', '[', ']']).filter(|part| !part.is_empty()).map(|part| format!("/{part}")).collect()
}

/// A static result by its name.
fn result(loaded: &Loaded, rest: &Equilibrium, what: &str) -> Result<f64, Error> {
    let scene = &loaded.scene;
    let refuse = |allowed: String| Error::Value {
        file: loaded.file.clone(),
        place: "--until".to_owned(),
        value: format!("\"{what}\""),
        allowed,
    };
    let (name, of) = match what.rsplit_once('.') {
        Some(parts) => parts,
        None if scene.lines.len() == 1 => (scene.lines[0].name.as_str(), what),
        None => return Err(refuse("name a line, body or point before it, such as bow.tension".to_owned())),
    };
    let results: Vec<(&str, f64)> = if let Some(line) = scene.lines.iter().position(|line| line.name == name) {
        let outputs = &rest.outputs[line];
        vec![
            ("tension", outputs.tension),
            ("anchor_tension", outputs.anchor_tension),
            ("tension_max", outputs.tension_max),
            ("grounded_length", outputs.grounded_length),
            ("declination", outputs.declination),
            ("force_x", outputs.force.x),
            ("force_y", outputs.force.y),
            ("force_z", outputs.force.z),
        ]
    } else if let Some(body) = scene.body(name) {
        let body = &rest.bodies[body];
        let of = |names: [&'static str; 3], vector: &nalgebra::Vector3<f64>| {
            [(names[0], vector.x), (names[1], vector.y), (names[2], vector.z)]
        };
        [
            of(["x", "y", "z"], &body.pose.position),
            of(["roll", "pitch", "yaw"], &body.pose.angles),
            of(["force_x", "force_y", "force_z"], &body.force),
            of(["moment_x", "moment_y", "moment_z"], &body.moment),
        ]
        .concat()
    } else if let Some((_, place)) = scene.point(name).and_then(|point| rest.points.iter().find(|(own, _)| *own == point)) {
        vec![("x", place.x), ("y", place.y), ("z", place.z)]
    } else {
        let known: Vec<String> = scene
            .lines
            .iter()
            .map(|line| line.name.clone())
            .chain(scene.bodies.iter().map(|body| body.name.clone()))
            .chain(scene.points.iter().map(|point| point.name.clone()))
            .collect();
        return Err(refuse(format!("there is nothing of that name{}", among(name, &known))));
    };
    let known: Vec<String> = results.iter().map(|(name, _)| (*name).to_owned()).collect();
    let found = results.iter().find(|(name, _)| *name == of).map(|(_, value)| *value);
    found.ok_or_else(|| refuse(format!("\"{name}\" has no such result{}", among(of, &known))))
}
