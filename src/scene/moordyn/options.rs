//! The options of a MoorDyn file: which of them mean something for a scene, and which are of its own time stepping.

use crate::error::{Error, MoorDynProblem, nearest};
use crate::scene::moordyn::sections::{Row, Section, number};
use crate::scene::moordyn::waves;

/// What the options say.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// g [m/s²].
    pub gravity: f64,
    /// Density of the water [kg/m³].
    pub water_density: f64,
    /// Depth: a number [m], or a file.
    pub depth: Option<Depth>,
    /// Line of the text of the depth; 0: there is none.
    pub depth_row: usize,
    /// Stiffness of the bed per area, kBot [Pa/m].
    pub bed_stiffness: f64,
    /// Damping of the bed per area, cBot [Pa·s/m].
    pub bed_damping: f64,
    /// Coefficient of friction [-].
    pub friction: f64,
    /// Whether the file has currents beside it.
    pub currents: bool,
    /// Whether waves come from a calling program.
    pub outer_waves: bool,
    /// What files beside it say of the waves, and the line of the text.
    pub waves: Option<(waves::Kind, usize)>,
    /// Step with which a record of waves is sampled [s].
    pub wave_step: f64,
    /// Whether an equilibrium is looked for first: not where TmaxIC is 0.
    pub settled: bool,
    /// Interval of output [s]; 0: not given.
    pub output_step: f64,
    /// What is allowed but may not be meant.
    pub warnings: Vec<String>,
}

/// Depth of the water.
#[derive(Debug, Clone, PartialEq)]
pub enum Depth {
    /// The same everywhere [m].
    Level(f64),
    /// As a file says.
    File(String),
}

impl Default for Options {
    fn default() -> Options {
        Options {
            gravity: 9.80665,
            water_density: 1025.0,
            depth: None,
            depth_row: 0,
            bed_stiffness: 3.0e6,
            bed_damping: 3.0e5,
            friction: 0.0,
            currents: false,
            outer_waves: false,
            waves: None,
            wave_step: 0.25,
            settled: true,
            output_step: 0.0,
            warnings: Vec::new(),
        }
    }
}

/// Options that mean something here, in small letters.
const USED: [&str; 20] = [
    "g",
    "gravity",
    "rho",
    "rhow",
    "wtrdnsty",
    "wtrdpth",
    "seafloorfile",
    "kbot",
    "kb",
    "cbot",
    "cb",
    "frictioncoefficient",
    "mu_kt",
    "mu_ka",
    "currents",
    "wavekin",
    "waterkin",
    "dtout",
    "depth",
    "density",
];

/// Options of MoorDyn's time stepping, its way to an equilibrium and its files.
const OF_ITS_OWN: [&str; 30] = [
    "dtm",
    "dt",
    "cfl",
    "tscheme",
    "dtic",
    "icdt",
    "tmaxic",
    "ictmax",
    "cdscaleic",
    "icdfac",
    "threshic",
    "icthresh",
    "gendynamicic",
    "icgendynamic",
    "fileic",
    "icfile",
    "writelog",
    "writeunits",
    "disableoutput",
    "disableouttime",
    "outswitch",
    "unifycurrentgrid",
    "fricdamp",
    "cv",
    "statdynfricscale",
    "mc",
    "inertialf",
    "inertialf_rampt",
    "echo",
    "numsegs",
];

/// Reads the options; `start` has those that the file does not say.
pub fn read(section: Option<&Section>, file: &str, start: Options) -> Result<Options, Error> {
    let mut options = start;
    let mut ignored: Vec<&str> = Vec::new();
    let (mut across, mut along) = (None, None);
    for row in section.map(|section| section.rows.as_slice()).unwrap_or_default() {
        let [value, key, ..] = row.words[..] else {
            return Err(row.error(file, MoorDynProblem::TooFew { found: 1, needed: 2, columns: "value, name of the option" }));
        };
        let value = value.trim_matches('"');
        let lower = key.to_lowercase();
        let plain = |item| number(row, file, item, value);
        let positive = |item| plain(item).and_then(|value| not_negative(row, file, item, value));
        match lower.as_str() {
            "g" | "gravity" => options.gravity = positive("g")?,
            "rho" | "rhow" | "wtrdnsty" | "density" => options.water_density = positive("WtrDnsty")?,
            "wtrdpth" | "depth" if value.parse::<f64>().is_ok() => {
                (options.depth, options.depth_row) = (Some(Depth::Level(positive("WtrDpth")?)), row.number);
            }
            "wtrdpth" | "depth" | "seafloorfile" => {
                (options.depth, options.depth_row) = (Some(Depth::File(value.to_string())), row.number);
            }
            "kbot" | "kb" => options.bed_stiffness = positive("kBot")?,
            "cbot" | "cb" => options.bed_damping = positive("cBot")?,
            "frictioncoefficient" => options.friction = positive("FrictionCoefficient")?,
            "mu_kt" => across = Some((positive("MU_KT")?, row)),
            "mu_ka" => along = Some((positive("MU_KA")?, row)),
            "dtout" => options.output_step = positive("dtOut")?,
            "wavekin" => wave_kind(&mut options, plain("WaveKin")?, row, file)?,
            "dtwave" => match plain("dtWave")? {
                step if step > 0.0 => options.wave_step = step,
                _ => return Err(row.unreadable(file, "dtWave", value, "a number greater than 0")),
            },
            "currents" => currents(&mut options, plain("Currents")?, row, file)?,
            "waterkin" if value.is_empty() || value == "0" => {}
            "waterkin" => return Err(row.cannot(file, "WaterKin", NO_WATER_FILE)),
            "tmaxic" | "ictmax" if plain("TmaxIC").is_ok_and(|most| most == 0.0) => {
                options.settled = false;
                ignored.push(key);
            }
            known if OF_ITS_OWN.contains(&known) => ignored.push(key),
            _ => options.unknown(row, key, &lower, file)?,
        }
    }
    if let Some((row, value)) = one_friction(across, along) {
        options.friction = value.ok_or_else(|| row.cannot(file, "MU_KT, MU_KA", TWO_FRICTIONS))?;
    }
    if !ignored.is_empty() {
        ignored.dedup();
        let which = ignored.join(", ");
        options.warnings.push(format!("{which}: of MoorDyn's own time stepping, initial state or files; not used"));
    }
    Ok(options)
}

const NO_WATER_FILE: &str = "this file of waves and currents is not read; write currents and waves into a scene, see `moorline convert` and \
                             `environment` of `moorline schema`";
const TWO_FRICTIONS: &str = "friction is the same along and across a line here; give both the same value";

/// The one coefficient of friction that both directions have; a row and none where they differ.
fn one_friction<'a>(across: Option<(f64, &'a Row<'a>)>, along: Option<(f64, &'a Row<'a>)>) -> Option<(&'a Row<'a>, Option<f64>)> {
    let (value, row) = across.or(along)?;
    let other = along.or(across).map_or(0.0, |(other, _)| other);
    let alone = across.is_none() != along.is_none();
    Some((row, (value == 0.0 || (value == other && !alone)).then_some(value)))
}

/// WaveKin: 1 is waves from a calling program, which is not there; 2, 3 and 7 are files.
fn wave_kind(options: &mut Options, kind: f64, row: &Row, file: &str) -> Result<(), Error> {
    match kind {
        0.0 => Ok(()),
        2.0 | 3.0 | 7.0 => {
            let kind = match kind {
                2.0 => waves::Kind::EvenSpectrum,
                3.0 => waves::Kind::Record,
                _ => waves::Kind::Components,
            };
            options.waves = Some((kind, row.number));
            Ok(())
        }
        1.0 => {
            options.outer_waves = true;
            options.warnings.push(format!(
                "line {}: WaveKin 1 takes waves from a calling program; there is none here, and no waves",
                row.number
            ));
            Ok(())
        }
        _ => Err(row.cannot(
            file,
            "WaveKin",
            "0 is none, 1 a calling program's; 2, 3 and 7 are files beside this one; MoorDyn has no others either",
        )),
    }
}

/// Currents: 0 none, 1 a profile in `current_profile.txt`.
fn currents(options: &mut Options, kind: f64, row: &Row, file: &str) -> Result<(), Error> {
    match kind {
        0.0 => options.currents = false,
        1.0 => options.currents = true,
        _ => {
            return Err(row.cannot(
                file,
                "Currents",
                "a current that changes in time or from place to place is not modelled; 1 is a profile over the depth, 0 none",
            ));
        }
    }
    Ok(())
}

fn not_negative(row: &Row, file: &str, item: &'static str, value: f64) -> Result<f64, Error> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(row.error(file, MoorDynProblem::Unreadable { item, found: value.to_string(), expected: "a number that is not negative" }))
}

impl Options {
    /// An option that nobody knows: refused where it is a known one with a slip, else named and left out.
    fn unknown(&mut self, row: &Row, key: &str, lower: &str, file: &str) -> Result<(), Error> {
        let known: Vec<String> = USED.iter().chain(&OF_ITS_OWN).filter(|word| word.len() > 3).map(ToString::to_string).collect();
        if nearest(lower, &known).is_some() {
            return Err(row.error(file, MoorDynProblem::Unknown { item: "option", name: key.to_string(), known }));
        }
        self.warnings.push(format!("line {}: {key} is no option that is known; it is left out", row.number));
        Ok(())
    }
}
