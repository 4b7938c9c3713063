//! Bad input and what is said about it; good input and what is understood.
//!
//! Each bad case gives the words without which its message would not help: the place, the value, what is allowed.

use moorline::error::Error;
use moorline::scene::read::{Loaded, built_in, load, parse, schema};
use moorline::scene::types::{Fatigue, Motion, Scene, Scheme, Seas, Stretch, Surface, Waves};
use moorline::scene::{check, motion_file};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const BUILT_IN: &str = include_str!("../examples/lindahl-sjoberg.json");

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

fn read(text: &str, sets: &[&str]) -> Result<Loaded, Error> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    parse(text, "harbour.json", &data(), &sets)
}

/// The message for bad input; it must mean exit code 2.
fn message(result: Result<Loaded, Error>, case: &str) -> String {
    match result {
        Ok(_) => panic!("accepted: {case}"),
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{case}: {error}");
            error.to_string()
        }
    }
}

fn assert_says(message: &str, words: &[&str], case: &str) {
    for word in words {
        assert!(message.contains(word), "\ncase:     {case}\nexpected: {word}\ngot:      {message}");
    }
}

/// Replaces one passage of the built-in scene, which must stand there once.
fn edited(from: &str, to: &str) -> String {
    assert_eq!(BUILT_IN.matches(from).count(), 1, "{from:?} must stand once in the built-in scene");
    BUILT_IN.replacen(from, to, 1)
}

/// Edits of the built-in scene: passage, replacement, words of the message.
const BAD_EDITS: &[(&str, &str, &[&str])] = &[
    // Keys.
    (
        r#""gravity": 9"#,
        r#""gravty": 9"#,
        &["harbour.json, line 4, column 5, environment.gravty", "unknown key `gravty`", "did you mean `gravity`"],
    ),
    (
        r#""length": 1200.0"#,
        r#""lenght": 1200.0"#,
        &["line 22", "lines[0].sections[0].lenght", "did you mean `length`", "`elements`"],
    ),
    (r#""type": "chain", "#, "", &["lines[0].sections[0]", "`type` is missing"]),
    (r#""depth": 120.0,"#, "", &["line 3", "environment", "`depth` is missing"]),
    (r#""ea": 5.0e8, "#, "", &["line_types.chain", "`ea` is missing"]),
    (
        r#""name": "line","#,
        r#""name": "line", "colour": 1,"#,
        &["lines[0].colour", "unknown key `colour`", "known here: `name`, `fairlead`"],
    ),
    (r#""period": 15.0"#, r#""perid": 15.0"#, &["line 25", "motion.perid", "did you mean `period`"]),
    (r#""period": 15.0, "#, "", &["line 25", "motion", "`period` is missing"]),
    (r#""kind": "sinusoidal""#, r#""kind": "fixed""#, &["motion.period", "unknown key `period`"]),
    (r#""kind": "sinusoidal""#, r#""kind": "sinus""#, &["motion.kind", "\"sinus\"", "`sinusoidal`", "`file`"]),
    (
        r#""gravity": 9.80665,"#,
        "\"gravity\": 9.80665,\n\"gravity\": 9.81,",
        &["line 5, column 1", "environment.gravity", "stands twice", "first in line 4"],
    ),
    (r#""chain": {"#, r#""chain": {}, "chain": {"#, &["line 10", "line_types.chain", "stands twice"]),
    // Types.
    (r#""depth": 120.0"#, r#""depth": "120 m""#, &["line 6", "environment.depth", "\"120 m\"", "expected a number"]),
    (r#""depth": 120.0"#, r#""depth": null"#, &["environment.depth", "null", "expected a number"]),
    (r#"[5.08, 2.1, 0.0]"#, r#"[5.08, 2.1]"#, &["line 25", "motion.sine", "list of 2", "three values [x, y, z]"]),
    (r#"[5.08, 2.1, 0.0]"#, r#"[5.08, "up", 0.0]"#, &["motion.sine[1]", "\"up\"", "expected a number"]),
    (r#"[1183.97, 0.0, -120.0]"#, r#"[1183.97, 0.0, -120.0, 0.0]"#, &["lines[0].anchor", "three values"]),
    (
        r#"{"stiffness": 5075.2591}"#,
        r#"[5075.2591]"#,
        &["line 7", "environment.seabed", "found a list [ ], expected an object { }"],
    ),
    (r#""depth": 120.0,"#, r#""depth": 120.0, "surface": {"none": null},"#, &["environment.surface", "a name in quotes"]),
    (r#""length": 1200.0"#, r#""length": 1200.0, "elements": 2.5"#, &["lines[0].sections[0].elements", "2.5", "a whole number"]),
    (r#""length": 1200.0"#, r#""length": 1200.0, "elements": -3"#, &["lines[0].sections[0].elements", "-3", "a whole number"]),
    (
        r#""run": {"#,
        r#""solver": {"scheme": "adams-bashforth"}, "run": {"#,
        &["solver.scheme", "\"adams-bashforth\"", "`adams-moulton`"],
    ),
    // Text that is not JSON.
    (r#""gravity": 9.80665"#, r#""gravity": NaN"#, &["line 4", "environment.gravity", "NaN is not allowed", "finite"]),
    (r#""gravity": 9.80665"#, r#""gravity": -Infinity"#, &["line 4", "environment.gravity", "-Infinity is not allowed"]),
    ("5.0e8", "1e999", &["line 11", "line_types.chain.ea", "1e999 is not allowed", "finite"]),
    (r#""depth": 120.0,"#, r#""depth": 120.0, // deep"#, &["line 6", "not valid JSON", "no comments"]),
    (r#""output_step": 0.1}"#, r#""output_step": 0.1,}"#, &["line 26", "run", "trailing comma"]),
    (r#""depth": 120.0"#, r#""depth": .5"#, &["line 6", "environment.depth", "a number begins with a digit"]),
    (r#""depth": 120.0"#, r#""depth": 'deep'"#, &["line 6", "environment.depth", "double quotes"]),
    (r#""depth": 120.0"#, r#""depth": True"#, &["line 6", "environment.depth", "`True`"]),
    // Numbers.
    (r#""gravity": 9.80665"#, r#""gravity": 0"#, &["environment.gravity", ": 0 is not allowed", "greater than 0"]),
    ("1000.0", "-1000.0", &["environment.water_density", "-1000 is not allowed", "0 or greater"]),
    (r#""depth": 120.0"#, r#""depth": -120.0"#, &["environment.depth", "-120 is not allowed", "z = -depth"]),
    ("5075.2591", "0.0", &["environment.seabed.stiffness", ": 0 is not allowed", "leave it out"]),
    ("5075.2591}", r#"5075.2591, "damping": -1.0}"#, &["environment.seabed.damping", "-1", "0 or greater"]),
    ("5075.2591}", r#"5075.2591, "slope_deg": [0.0, 50.0]}"#, &["environment.seabed.slope_deg[1]", "50", "between -45 and 45"]),
    ("5.0e8", "-5.0e8", &["line_types.chain.ea", "-5e8", "greater than 0"]),
    ("5.0e8", "5.0e20", &["line_types.chain.ea", "5e20", "1e15"]),
    ("135.35", "0", &["line_types.chain.mass", ": 0 is not allowed"]),
    (r#""diameter": 0.076"#, r#""diameter": -0.076"#, &["line_types.chain.diameter", "-0.076", "greater than 0"]),
    (r#""damping": 4.0e-4"#, r#""damping": -4.0e-4"#, &["line_types.chain.damping", "-0.0004", "0 or greater"]),
    (r#""damping": 4.0e-4"#, r#""ei": -1.0"#, &["line_types.chain.ei", "-1", "0 or greater"]),
    (r#""damping": 4.0e-4"#, r#""breaking_load": 0.0"#, &["line_types.chain.breaking_load", ": 0 is not allowed"]),
    (
        r#""damping": 4.0e-4"#,
        r#""breaking_load": 6e6, "fatigue": {"m": 0.5, "k": 316}"#,
        &["line_types.chain.fatigue.m: 0.5 is not allowed", "between 1 and 20", "3 is usual for chain"],
    ),
    (
        r#""damping": 4.0e-4"#,
        r#""breaking_load": 6e6, "fatigue": {"m": 3, "k": 6e10}"#,
        &["line_types.chain.fatigue.k: 6e10 is not allowed", "between 0.001 and 1e7", "k = a·(area / breaking load)^m"],
    ),
    (
        r#""damping": 4.0e-4"#,
        r#""breaking_load": 6e6, "fatigue": {"m": 3, "k": -316}"#,
        &["line_types.chain.fatigue.k: -316 is not allowed"],
    ),
    (
        r#""damping": 4.0e-4"#,
        r#""fatigue": {"m": 3, "k": 316}"#,
        &["line_types.chain.breaking_load: nothing is not allowed", "give it [N]"],
    ),
    (r#""damping": 4.0e-4"#, r#""breaking_load": 6e6, "fatigue": {"m": 3}"#, &["line_types.chain.fatigue", "`k` is missing"]),
    (
        r#""duration": 120.0"#,
        r#""duration": 120.0, "transient": 120"#,
        &["run.transient: 120 s is not allowed", "less than run.duration, 120 s"],
    ),
    (r#""duration": 120.0"#, r#""duration": 120.0, "transient": -1"#, &["run.transient: -1 is not allowed", "0 or greater"]),
    (
        r#""damping": 4.0e-4"#,
        r#""buoyancy": 100.0"#,
        &["line_types.chain.submerged_weight", "buoyancy 100 together", "one of the two"],
    ),
    ("1157.1590775", "1400.0", &["line_types.chain.submerged_weight", "1400", "weight in air", "1327.3300775 N/m"]),
    (r#"{"normal": 1.0"#, r#"{"normal": -1.0"#, &["line_types.chain.drag.normal", "-1"]),
    (
        r#""normal": 3.8, "tangential": 0.0"#,
        r#""normal": 3.8, "tangential": -0.5"#,
        &["line_types.chain.added_mass.tangential", "-0.5"],
    ),
    (r#""length": 1200.0"#, r#""length": 0.0"#, &["lines[0].sections[0].length", ": 0 is not allowed"]),
    (
        r#""length": 1200.0"#,
        r#""length": 1200.0, "elements": 0"#,
        &["lines[0].sections[0].elements", "1 or more", "leave it out"],
    ),
    (r#""length": 1200.0"#, r#""length": 1200.0, "elements": 20001"#, &["lines[0].sections[0].elements", "20001", "20000"]),
    (r#""period": 15.0"#, r#""period": 0.0"#, &["motion.period", ": 0 is not allowed"]),
    (r#""ramp": 48.75"#, r#""ramp": -1.0"#, &["motion.ramp", "-1", "0 or greater"]),
    (r#""duration": 120.0"#, r#""duration": -120.0"#, &["run.duration", "-120"]),
    (r#""output_step": 0.1"#, r#""output_step": 0.0"#, &["run.output_step", ": 0 is not allowed"]),
    (r#""output_step": 0.1"#, r#""output_step": 1e-6"#, &["run.output_step", "1e-6", "1.2e8 rows", "5e7"]),
    (r#""run": {"#, r#""solver": {"tolerance": 0.5}, "run": {"#, &["solver.tolerance", "0.5", "between 1e-8 and 0.1"]),
    (r#""run": {"#, r#""solver": {"max_step": 0}, "run": {"#, &["solver.max_step", ": 0 is not allowed"]),
    (r#""run": {"#, r#""solver": {"fixed_step": -0.1}, "run": {"#, &["solver.fixed_step", "-0.1"]),
    // Names, lists and geometry.
    (r#""type": "chain""#, r#""type": "chian""#, &["lines[0].sections[0].type", "\"chian\"", "did you mean `chain`"]),
    (r#""name": "line""#, r#""name": "bow.port""#, &["lines[0].name", "\"bow.port\"", "no dot"]),
    (r#"[{"type": "chain", "length": 1200.0}]"#, "[]", &["lines[0].sections", "at least one section"]),
    (
        r#"[1183.97, 0.0, -120.0]"#,
        r#"[1183.97, 0.0, -130.0]"#,
        &["lines[0].anchor", "(1183.97, 0, -130)", "below the seabed", "z = -120 m"],
    ),
    (r#""fairlead": [0.0, 0.0, 0.0]"#, r#""fairlead": [0.0, 0.0, -120.1]"#, &["lines[0].fairlead", "-120.1", "below the seabed"]),
    (r#"[1183.97, 0.0, -120.0]"#, r#"[1e16, 0.0, -120.0]"#, &["lines[0].anchor", "1e16", "1e15"]),
    (r#"[5.08, 2.1, 0.0]"#, r#"[5.08, 2.1, 121.0]"#, &["motion", "121 m towards the seabed", "lines[0]", "120 m above"]),
    (
        r#""length": 1200.0"#,
        r#""length": 500.0"#,
        &[
            "lines[0] \"line\"",
            "500.0 m of line do not reach",
            "(1183.97, 0, -120)",
            "1190.0 m away",
            "138.0 %",
            "at least 96 m",
            "move the anchor",
        ],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "current": [{"z": 0, "velocity": [1,0,0]}, {"z": 0, "velocity": [0,0,0]}],"#,
        &["environment.current[1].z", "same z"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "current": [{"z": 0, "velocity": [1,0,0]}, {"z": -9, "velocity": [1,0,0]}, {"z": -5, "velocity": [0,0,0]}],"#,
        &["environment.current[2].z", "-5", "rise from row to row"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "jonswap", "hs": 4.0, "tp": 9.0, "gamma": 0.5},"#,
        &["environment.waves.gamma: 0.5 is not allowed", "between 1 and 20"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "jonswap", "hs": 4.0, "tp": 0.0},"#,
        &["environment.waves.tp: 0 is not allowed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "jonswap", "hs": 4.0, "tp": 9.0, "components": 0},"#,
        &["environment.waves.components: 0 is not allowed", "1 to 5000"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "components", "components": []},"#,
        &["environment.waves.components: 0 is not allowed", "1 to 5000"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "components", "components": [{"amplitude": 1, "period": 9}, {"amplitude": -1, "period": 9}]},"#,
        &["environment.waves.components[1].amplitude: -1 is not allowed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "regular", "amplitude": 2.0, "period": 10.0, "ramp": -1},"#,
        &["environment.waves.ramp: -1 is not allowed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "regular", "amplitude": 200, "period": 10.0},"#,
        &["environment.waves.amplitude: 200 m is not allowed", "bare the seabed", "120 m"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "jonswap", "hs": 4.0, "tp": 10.0, "cut_off": 0.09},"#,
        &["environment.waves.cut_off: 0.09 Hz is not allowed", "above the peak", "0.1000 Hz"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "pierson-moskowitz", "hs": -4.0, "tp": 9.0},"#,
        &["environment.waves.hs: -4 is not allowed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "pierson-moskowitz", "hs": 4.0, "tp": 9.0, "cut_off": -1},"#,
        &["environment.waves.cut_off: -1 Hz is not allowed", "0.1111 Hz"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "pierson-moskowitz", "hs": 130.0, "tp": 9.0},"#,
        &["environment.waves.hs: 130 m is not allowed", "bare the seabed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "ochi-hubble", "parts": [{"hs": 1, "tp": 15, "lambda": 3}, {"hs": 1, "tp": 7, "lambda": 0.2}]},"#,
        &["environment.waves.parts[1].lambda: 0.2 is not allowed", "between 1 and 20"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "ochi-hubble", "parts": [{"hs": 1, "tp": 15, "lambda": 3}, {"hs": 1, "tp": 5, "lambda": 1}], "cut_off": 0.15},"#,
        &["environment.waves.cut_off: 0.15 Hz", "0.2000 Hz"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "ochi-hubble", "parts": [{"hs": 1, "tp": 0, "lambda": 3}, {"hs": 1, "tp": 7, "lambda": 2}]},"#,
        &["environment.waves.parts[0].tp: 0 is not allowed"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0.05, 0], [0.1, 2], [0.09, 1]]},"#,
        &["environment.waves.spectrum[2]: f = 0.09 Hz is not allowed", "frequencies must rise", "f = 0.1 Hz"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0.05, 0], [0.1, -2], [0.2, 1]]},"#,
        &["environment.waves.spectrum[1]: S = -2 m²/Hz is not allowed", "0 or greater"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0, 1], [0.1, 2]]},"#,
        &["environment.waves.spectrum[0]: S = 1", "at f = 0 it must be 0"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[-0.1, 1], [0.1, 2]]},"#,
        &["environment.waves.spectrum[0]: f = -0.1 Hz", "0 or greater"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0.1, 1]]},"#,
        &["environment.waves.spectrum: a table of 1 rows", "at least 2 rows"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0.1, 0], [0.2, 0]]},"#,
        &["environment.waves.spectrum: a spectrum of zeros", "energy"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "table", "spectrum": [[0.05, 0], [0.1, 2], [0.2, 0]], "cut_off": 0.1},"#,
        &["environment.waves.cut_off: 0.1 Hz", "0.1000 Hz"],
    ),
    (
        r#""depth": 120.0,"#,
        r#""depth": 120.0, "waves": {"kind": "regular", "amplitud": 2.0, "period": 10.0},"#,
        &["line 6", "environment.waves.amplitud", "did you mean `amplitude`"],
    ),
    (
        r#""damping": 4.0e-4"#,
        r#""tension_strain": [[0, 0], [0.02, 1e6], [0.01, 2e6]]"#,
        &["line_types.chain.tension_strain[2]", "[0.01, 2000000]", "must rise"],
    ),
    (
        r#""damping": 4.0e-4"#,
        r#""inner_fluid": {"density": -800, "area": 0.01}"#,
        &["line_types.chain.inner_fluid.density", "-800", "must be 0 or greater"],
    ),
    (
        r#""name": "line","#,
        r#""attachments": [{"s": 1200.5}],"#,
        &["lines[0].attachments[0].s", "1200.5", "between 0 (fairlead) and 1200 m (anchor)"],
    ),
    (
        r#""name": "line","#,
        r#""attachments": [{"s": 5, "volume": -1}],"#,
        &["lines[0].attachments[0].volume", "-1", "0 or greater"],
    ),
    (r#""name": "line","#, r#""constraints": [{"s": -1}],"#, &["lines[0].constraints[0].s", "-1", "between 0 (fairlead)"]),
    (
        r#""name": "line","#,
        r#""constraints": [{"s": 8, "force": [0, 0, 1]}, {"s": 8.0}],"#,
        &["lines[0].constraints[1].s", "8", "constraints[0] is there already"],
    ),
    (
        r#""name": "line","#,
        r#""constraints": [{"s": 8, "axes": [[1, 1, 0], [-2, -2, 0]]}],"#,
        &["lines[0].constraints[0].axes", "[(1, 1, 0), (-2, -2, 0)]", "not parallel"],
    ),
    (
        r#""name": "line","#,
        r#""constraints": [{"s": 8, "stiffness": [0, -5, 0]}],"#,
        &["lines[0].constraints[0].stiffness[1]", "-5", "0 or greater, N/m"],
    ),
    (
        r#""name": "line","#,
        r#""constraints": [{"s": 8, "motion": {"period": 0}}],"#,
        &["lines[0].constraints[0].motion.period", "0", "greater than 0 s"],
    ),
    (
        r#""name": "line","#,
        r#""constraints": [{"s": 8, "locked": [true, false]}],"#,
        &["lines[0].constraints[0].locked", "three"],
    ),
    (r#""mass": 135.35,"#, r#""mass": 135.35, "outer_area": -1,"#, &["line_types.chain.outer_area", "-1 is not allowed", "m²"]),
    (r#""mass": 135.35,"#, r#""mass": 135.35, "seabed_stiffness": 0,"#, &["line_types.chain.seabed_stiffness", "Pa"]),
    (r#""duration": 120.0"#, r#""duration": 120.0, "start": 1e16"#, &["run.start", "1e16"]),
    (
        r#""run": {"#,
        r#""solver": {"scheme": "cable-1994", "stretch": "exact"}, "run": {"#,
        &["solver.stretch", "\"exact\"", "cable-1994 is built on the report's law"],
    ),
];

#[test]
fn every_bad_edit_of_the_built_in_scene_is_named_with_place_and_value() {
    for (from, to, words) in BAD_EDITS {
        let message = message(read(&edited(from, to), &[]), to);
        assert_says(&message, words, to);
        assert_says(&message, &["harbour.json, "], to);
    }
}

/// `--set` entries on the built-in scene, words of the message.
const BAD_SETS: &[(&[&str], &[&str])] = &[
    (&["motion.perid=3"], &["--set motion.perid", "unknown key `perid`", "did you mean `period`"]),
    (&["enviroment.depth=3"], &["--set enviroment.depth", "unknown key `enviroment`", "did you mean `environment`"]),
    (&["environment.depth=deep"], &["--set environment.depth", "\"deep\"", "expected a number"]),
    (&["environment.depth=NaN"], &["--set environment.depth", "\"NaN\"", "expected a number"]),
    (&["environment.depth=1e999"], &["--set environment.depth", "1e999", "expected a number"]),
    (&["environment.depth=null"], &["--set environment.depth", "`depth` is missing"]),
    (&["lines[1].fairlead[2]=1"], &["--set lines[1].fairlead[2]", "lines: 1 is not allowed", "1 entry, index 0"]),
    (
        &["lines.0.fairlead.3=1"],
        &["--set lines.0.fairlead.3", "lines[0].fairlead: 3 is not allowed", "3 entries, indices 0 to 2"],
    ),
    (&["lines.first.name=x"], &["--set lines.first.name", "first is not allowed", "index 0"]),
    (&["lines[-1].name=x"], &["lines: -1 is not allowed"]),
    (&["environment.current[0].z=1"], &["environment.current: 0 is not allowed", "the list is empty"]),
    (
        &["environment.depth.metres=1"],
        &["--set environment.depth.metres", "environment.depth is 120.0", "nothing can be set inside"],
    ),
    (&["environment.depth"], &["--set environment.depth", "place=value"]),
    (&["=5"], &["--set =5: ", "place=value"]),
    (&["lines=[{\"fairlead\": [0,0]}]"], &["--set lines, [0].fairlead", "list of 2"]),
    (&["lines=[]"], &["lines", "at least one line"]),
    (&["line_types={}"], &["line_types", "at least one line type"]),
    (&["motion.kind=file"], &["--set motion.kind", "`path` is missing"]),
    (&["motion.kind=file", "motion.path="], &["motion.path", "name a CSV file"]),
    (&["motion.kind=file", "motion.path=no-such.csv"], &["no-such.csv", "motion.path"]),
    (&["motion.kind=fixed", "motion.sine=[0,0,1]"], &["--set motion.sine", "unknown key `sine`", "known here: `kind`"]),
    (&["lines[0].sections[0].length=-5"], &["lines[0].sections[0].length", "-5 is not allowed"]),
    (
        &["line_types.chain.breaking_load=6e6", "lines[0].sections[0].length=1150"],
        &["1150.0 m of line do not reach", "3.5 % stretch", "\"chain\" breaks at 1.2 %", "Lengthen a section by at least 26 m"],
    ),
];

#[test]
fn every_bad_setting_is_named_as_it_was_typed() {
    for (sets, words) in BAD_SETS {
        let message = message(read(BUILT_IN, sets), &sets.join(" "));
        assert_says(&message, words, &sets.join(" "));
    }
}

#[test]
fn texts_that_are_no_scene_say_what_they_are() {
    let deep = format!("{{\"title\": {}", "[".repeat(1_000_000));
    let cases: &[(&str, &[&str])] = &[
        ("", &["harbour.json, line 1, column 1", "empty"]),
        ("\u{feff} \n ", &["empty"]),
        ("{", &["line 1", "ends too early"]),
        (&BUILT_IN[..BUILT_IN.len() / 2], &["line_types.chain", "ends too early"]),
        ("[1, 2]", &["found a list [ ], expected an object"]),
        ("\"scene\"", &["expected an object"]),
        ("{} {}", &["trailing characters"]),
        ("{}", &["is missing"]),
        ("# a comment\n{}", &["line 1", "no comments"]),
        ("  1 0 0 0\n 40 2\n", &["harbour.json, line 2, column 6, NELTYP", "the file ends here"]),
        ("lines:\n  - name: bow\n", &["harbour.json, line 2", "neither a scene, which is a JSON object", "nor a CABLE file"]),
        (&deep, &["title[0][0][0][0][0][0][0][0][0][0][0]…: ", "too deep"]),
    ];
    for (text, words) in cases {
        let case: String = text.chars().take(40).collect();
        assert_says(&message(read(text, &[]), &case), words, &case);
    }
}

#[test]
fn two_lines_of_one_name_and_a_file_for_two_lines_are_refused() {
    let line = r#"{"name": "a", "fairlead": [0,0,0], "anchor": [9,0,-9], "sections": [{"type": "chain", "length": 20}]}"#;
    let twice = format!("lines=[{line}, {line}]");
    assert_says(&message(read(BUILT_IN, &[&twice]), "twins"), &["lines[1].name", "\"a\"", "lines[0] has this name"], "twins");
    let both = format!("lines=[{line}, {}]", line.replace("\"a\"", "\"b\""));
    let moved = read(BUILT_IN, &[&both, "motion.kind=file", "motion.path=heave.csv"]);
    assert_says(&message(moved, "file"), &["motion.kind", "\"file\"", "the scene has 2 lines"], "file");
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let missing = data().join("no-such-scene.json");
    assert_says(&message(load(&missing, &[]), "missing"), &["no-such-scene.json", "No such file"], "missing");
    assert_says(&message(load(&data(), &[]), "directory"), &["tests/data", "directory, not a scene file"], "directory");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let latin = folder.join("latin1.json");
    std::fs::write(&latin, b"{\n \"title\": \"Sj\xf6berg\"}").expect("the test can write its file");
    assert_says(&message(load(&latin, &[]), "latin 1"), &["latin1.json, line 2, column 14", "not UTF-8"], "latin 1");
    let huge = folder.join("huge.json");
    let file = std::fs::File::create(&huge).expect("the test can write its file");
    file.set_len(17 << 20).expect("the test can write its file");
    assert_says(&message(load(&huge, &[]), "huge"), &["huge.json", "larger than 16 MB"], "huge");
}

/// Motion files: text, words of the message.
const BAD_MOTIONS: &[(&str, &[&str])] = &[
    ("", &["line 1", "a file without rows", "at least 2 rows"]),
    ("t,x,y,z\n0,0,0,0\n", &["line 2", "a file of 1 row", "at least 2 rows"]),
    ("0,0,0,0\n1,0,0\n", &["line 2", "3 columns", "t,x,y,z"]),
    ("0,0,0,0\n1,0,0,0,0,0,0\n", &["line 2", "7 columns", "the lines before have 4"]),
    ("0;0;0;0\n", &["line 1", "1 column", "commas"]),
    ("t,x,z,y\n0,0,0,0\n", &["line 1", "column 3 \"z\"", "this one is y"]),
    ("t,x,y,z\n\n# note\n0,0,0,0\n1,0,up,0\n", &["line 5", "y = \"up\"", "finite number"]),
    ("0,0,0,0\n1,0,0,NaN\n", &["line 2", "z = \"NaN\"", "finite"]),
    ("0,0,0,0\n1,0,0,1e999\n", &["line 2", "z = \"1e999\"", "finite"]),
    ("0,0,0,0\n1,0,0,0\n1,0,0,0.1\n", &["line 3", "t = 1", "times must rise"]),
    ("0,0,0,0\n0.1,0,0,0.2\n0.2,100,0,0\n", &["line 3", "100.000 m", "at most 100 m/s"]),
    ("0,0,0,0,0,0,200\n", &["line 1", "velocity of 200.0 m/s", "at most 100 m/s"]),
    ("0,0,0,-119\n1,0,0,-121\n", &["line 2", "z = -121", "below the seabed", "z = -120 m"]),
];

#[test]
fn every_bad_motion_file_is_named_with_its_line() {
    let environment = built_in(&[]).expect("the built-in scene is good").scene.environment;
    for (text, words) in BAD_MOTIONS {
        let error = motion_file::parse(text, "heave.csv", &environment).expect_err(text);
        assert_eq!(error.exit_code(), 2);
        assert_says(&error.to_string(), words, text);
        assert_says(&error.to_string(), &["heave.csv, "], text);
    }
}

#[test]
fn a_motion_file_is_read_relative_to_the_scene_with_or_without_velocities() {
    let loaded = read(BUILT_IN, &["motion.kind=file", "motion.path=heave.csv"]).expect("the motion file is good");
    let table = loaded.motion.expect("a motion of kind file has a table");
    assert_eq!(table.times, [0.0, 0.5, 1.0, 200.0]);
    assert_eq!(table.positions[2], [0.0, 0.0, 0.6]);
    // The parabola through (0, 0), (0.5, 0.4), (1, 0.6) has the slopes 1.0 and 0.6 at its first two points.
    assert!((table.velocities[0][2] - 1.0).abs() < 1e-12 && (table.velocities[1][2] - 0.6).abs() < 1e-12);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);

    let environment = loaded.scene.environment;
    let text = "\u{feff}Time,X,Y,Z,VX,VY,VZ\r\n0,0,0,0,1,2,3\r\n1,0,0,0,4,5,6\r\n";
    let table = motion_file::parse(text, "heave.csv", &environment).expect("velocities are allowed");
    assert_eq!(table.velocities, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
}

/// A body on a pinned end, and a motion of a fairlead that a constraint holds.
#[test]
fn what_acts_on_nothing_is_warned_of() {
    let warnings = |line: &str| {
        let text = edited(r#""name": "line","#, line);
        read(&text, &[]).unwrap_or_else(|error| panic!("{error}")).warnings.join("; ")
    };
    let body = warnings(r#""attachments": [{"s": 1200, "mass": 5}],"#);
    assert_says(&body, &["lines[0].attachments[0]", "pinned end"], "a body at the anchor");
    let released = warnings(r#""constraints": [{"s": 0, "stiffness": [1e6, 1e6, 1e6]}],"#);
    assert_says(&released, &["motion", "fairlead of lines[0]", "a motion of its own"], "a fairlead on springs");
    let locked = warnings(r#""constraints": [{"s": 0, "locked": [true, true, true]}],"#);
    assert_eq!(locked, "", "a fairlead locked without a motion of its own is a pinned one");
}

#[test]
fn what_is_allowed_but_odd_is_warned_of() {
    let odd = read(
        BUILT_IN,
        &[
            "motion.kind=file",
            "motion.path=heave.csv",
            "lines[0].fairlead=[0,40,0]",
            "run.duration=300",
            "line_types.rope={\"ea\":1e6,\"mass\":2,\"diameter\":0.1}",
        ],
    );
    let warnings = odd.expect("odd is not wrong").warnings.join("\n");
    assert_says(
        &warnings,
        &["line_types.rope", "no section", "heave.csv begins at (0, 0, 0), 40.0 m away", "t = 0 s to 200 s"],
        "warnings",
    );
}

/// Source: the scene file of the project's contract, key by key.
#[test]
fn the_built_in_scene_has_the_published_values() {
    let loaded = built_in(&[]).expect("the built-in scene is good");
    assert_eq!(loaded.file, "built-in scene");
    assert!(loaded.warnings.is_empty() && loaded.motion.is_none());
    let Scene { title, environment, line_types, lines, motion, run, solver, .. } = loaded.scene;
    assert_eq!(title, "Lindahl & Sjöberg (1983) as run by Ma & Webster (1994)");
    assert_eq!((environment.gravity, environment.water_density, environment.depth), (9.80665, 1000.0, 120.0));
    assert_eq!(environment.seabed.stiffness, Some(5075.2591));
    let chain = &line_types["chain"];
    assert_eq!((chain.ea, chain.mass, chain.submerged_weight, chain.diameter), (5.0e8, 135.35, Some(1157.1590775), 0.076));
    assert_eq!((chain.drag.normal, chain.drag.tangential, chain.damping), (1.0, 0.0, 4.0e-4));
    assert_eq!((chain.added_mass.normal, chain.added_mass.tangential), (3.8, 0.0));
    assert_eq!((lines.len(), lines[0].name.as_str(), lines[0].length()), (1, "line", 1200.0));
    assert_eq!((lines[0].fairlead, lines[0].anchor), ([0.0; 3], [1183.97, 0.0, -120.0]));
    assert_eq!(motion, Motion::Sinusoidal { period: 15.0, sine: [5.08, 2.1, 0.0], cosine: [0.0; 3], ramp: Some(48.75) });
    assert_eq!((run.duration, run.output_step), (120.0, 0.1));
    assert_eq!((solver.scheme, solver.fixed_step), (Scheme::AdamsMoulton, None));
}

/// Source: the defaults of the project's contract.
#[test]
fn the_smallest_scene_takes_every_default() {
    let text = r#"{"environment": {"depth": 50}, "line_types": {"a": {"ea": 1e8, "mass": 10, "diameter": 0.1}},
                   "lines": [{"fairlead": [0,0,0], "anchor": [60,0,-50], "sections": [{"type": "a", "length": 90}]},
                             {"fairlead": [0,0,0], "anchor": [0,60,-50], "sections": [{"type": "a", "length": 90}]}]}"#;
    let Scene { title, environment, line_types, lines, motion, run, solver, .. } = read(text, &[]).expect("it is complete").scene;
    assert_eq!((title.as_str(), environment.gravity, environment.water_density), ("", 9.80665, 1025.0));
    assert_eq!((environment.surface, environment.current.len(), environment.waves), (Surface::Pierced, 0, None));
    let seabed = &environment.seabed;
    assert_eq!((seabed.stiffness, seabed.damping, seabed.friction, seabed.slope_deg), (None, 0.0, 0.0, [0.0; 2]));
    let a = &line_types["a"];
    assert_eq!((a.submerged_weight, a.buoyancy, a.ei, a.damping, a.breaking_load), (None, None, 0.0, 0.0, None));
    assert_eq!((a.drag, a.added_mass), (Default::default(), Default::default()));
    assert_eq!((lines[0].name.as_str(), lines[1].name.as_str()), ("line1", "line2"));
    assert_eq!((lines[0].sections[0].elements, lines[0].attachments.len()), (None, 0));
    assert!(lines[0].constraints.is_empty());
    assert_eq!((motion, run.duration, run.output_step), (Motion::Fixed, 120.0, 0.1));
    assert_eq!((solver.scheme, solver.tolerance, solver.max_step, solver.fixed_step), (Scheme::AdamsMoulton, 1e-3, 0.5, None));
    assert_eq!((solver.stretch, solver.law(), solver.hydrostatic_strain), (None, Stretch::Exact, false));
}

/// Source: Michell (1893): in deep water a wave breaks at 0.142 of its length, 22.2 m for 10 s.
#[test]
fn waves_that_would_break_are_warned_of() {
    let warnings = |amplitude: f64| {
        let waves = format!(r#""depth": 120.0, "waves": {{"kind": "regular", "amplitude": {amplitude}, "period": 10.0}},"#);
        read(&edited(r#""depth": 120.0,"#, &waves), &[]).expect("a good scene").warnings
    };
    assert!(warnings(11.0).is_empty());
    assert_says(&warnings(12.0).join(""), &["environment.waves", "24 m high", "10 s", "break at 22.1"], "12 m");
    let steep = |waves: &str| {
        let waves = format!(r#""depth": 120.0, "waves": {waves},"#);
        read(&edited(r#""depth": 120.0,"#, &waves), &[]).expect("a good scene").warnings.join("")
    };
    let full_grown = r#"{"kind": "pierson-moskowitz", "hs": 23.0, "tp": 10.0}"#;
    assert_says(&steep(full_grown), &["environment.waves", "23 m high", "10 s", "break at 22.1"], full_grown);
    // 0.5 · 0.1 Hz · 1000 m²/Hz = 50 m²: 28.3 m high.
    let table = r#"{"kind": "table", "spectrum": [[0.05, 0], [0.1, 1000], [0.15, 0]]}"#;
    assert_says(&steep(table), &["environment.waves", "28.28", "10 s", "break at 22.1"], table);
}

#[test]
fn a_scene_with_every_supported_key_is_read_and_survives_writing() {
    let loaded = load(&data().join("all-keys.json"), &[]).expect("all keys are good");
    let scene = &loaded.scene;
    assert_eq!((scene.environment.seabed.slope_deg, scene.environment.surface), ([1.0, -2.0], Surface::None));
    let Some(Seas::One(Waves::Regular { amplitude, phase_deg, ramp, .. })) = &scene.environment.waves else { panic!("no waves") };
    assert_eq!((*amplitude, *phase_deg, *ramp), (2.0, 90.0, Some(15.0)));
    assert_eq!((scene.environment.current[1].z, scene.line_types["rope"].buoyancy), (-120.0, Some(170.171)));
    assert_eq!((scene.lines[0].sections[0].elements, scene.lines[1].name.as_str()), (Some(10), "line2"));
    let Some(Fatigue { m, k }) = scene.line_types["rope"].fatigue else { panic!("no T–N curve") };
    assert_eq!((m, k, scene.run.transient), (4.09, 231.0, Some(20.0)));
    assert_eq!(
        (scene.solver.scheme, scene.solver.law(), scene.solver.fixed_step),
        (Scheme::Esdirk3, Stretch::Report, Some(0.05))
    );
    let written = serde_json::to_string(scene).expect("a scene can be written");
    assert_eq!(read(&written, &[]).expect("what was written can be read").scene, *scene);
}

#[test]
fn geometry_at_the_edge_is_allowed() {
    let good: &[&[&str]] = &[
        &["lines[0].fairlead=[1183.97,0,-120]"],
        &["lines[0].sections[0].length=1150"],
        &["lines[0].sections[0].length=1150", "line_types.chain.breaking_load=1.8e7"],
        &["motion.sine=[0,0,120]"],
        &["motion.sine=[0,0,72]", "motion.cosine=[0,0,96]"],
        &["environment.seabed.slope_deg=[-45,45]", "lines[0].anchor=[10,10,-120]"],
        &["line_types.chain.submerged_weight=-300"],
        &["environment.water_density=0"],
        &["run.duration=0"],
        &["environment.depth=1e5", "lines[0].sections[0].length=2e5", "lines[0].anchor=[0,0,-100000]"],
    ];
    for sets in good {
        if let Err(error) = read(BUILT_IN, sets) {
            panic!("{sets:?}: {error}");
        }
    }
}

#[test]
fn a_scene_changed_by_program_is_checked_like_one_from_a_file() {
    let mut scene = built_in(&[]).expect("the built-in scene is good").scene;
    scene.line_types.get_mut("chain").expect("it has a chain").ea = f64::NAN;
    let error = check::check(&scene, "moorline.fmu").expect_err("NaN is no stiffness");
    assert_says(&error.to_string(), &["moorline.fmu, line_types.chain.ea", "NaN is not allowed"], "NaN");
}

#[test]
fn a_byte_order_mark_is_no_mistake() {
    assert!(read(&format!("\u{feff}{BUILT_IN}"), &[]).is_ok());
}

#[test]
fn settings_change_what_they_name() {
    let sets = [
        "lines.0.fairlead.2=1.5",
        "lines[0].sections[0].elements=40",
        "solver.scheme=esdirk3",
        "motion.kind=fixed",
        "title=A = B",
    ];
    let scene = read(BUILT_IN, &sets).expect("the settings are good").scene;
    assert_eq!((scene.lines[0].fairlead[2], scene.lines[0].sections[0].elements), (1.5, Some(40)));
    assert_eq!((scene.solver.scheme, scene.motion, scene.title.as_str()), (Scheme::Esdirk3, Motion::Fixed, "A = B"));
}

/// Follows `$ref` to the definition.
fn resolved<'a>(schema: &'a Value, root: &'a Value) -> &'a Value {
    match schema["$ref"].as_str().and_then(|path| root.pointer(path.trim_start_matches('#'))) {
        Some(definition) => definition,
        None => schema,
    }
}

/// Checks a value against the words of JSON Schema that the scene's schema uses for structure and limits.
fn validate(value: &Value, schema: &Value, root: &Value, place: &str) -> Result<(), String> {
    let schema = resolved(schema, root);
    if let Some(options) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
        let results: Vec<_> = options.iter().map(|option| validate(value, option, root, place)).collect();
        return if results.iter().any(Result::is_ok) { Ok(()) } else { Err(format!("{place}: none of {results:?}")) };
    }
    let fail = |why: &str| Err(format!("{place}: {value} {why}"));
    if schema["const"] != Value::Null && schema["const"] != *value {
        return fail("is another constant");
    }
    if schema["exclusiveMinimum"].as_f64().is_some_and(|limit| value.as_f64().is_some_and(|number| number <= limit)) {
        return fail("is too small");
    }
    if schema["minimum"].as_f64().is_some_and(|limit| value.as_f64().is_some_and(|number| number < limit)) {
        return fail("is too small");
    }
    if schema["maximum"].as_f64().is_some_and(|limit| value.as_f64().is_some_and(|number| number > limit)) {
        return fail("is too large");
    }
    if let Some(members) = value.as_object() {
        for required in schema["required"].as_array().into_iter().flatten() {
            if !members.contains_key(required.as_str().unwrap_or_default()) {
                return fail(&format!("lacks {required}"));
            }
        }
        for (key, member) in members {
            let place = format!("{place}.{key}");
            match (&schema["properties"][key], &schema["additionalProperties"]) {
                (Value::Null, Value::Object(_)) => validate(member, &schema["additionalProperties"], root, &place)?,
                (Value::Null, _) => return Err(format!("{place} is unknown")),
                (own, _) => validate(member, own, root, &place)?,
            }
        }
    }
    for (index, entry) in value.as_array().into_iter().flatten().enumerate() {
        validate(entry, &schema["items"], root, &format!("{place}[{index}]"))?;
    }
    Ok(())
}

#[test]
fn the_schema_accepts_what_the_reader_accepts_and_states_its_limits() {
    let schema = schema();
    for text in [BUILT_IN, include_str!("data/all-keys.json")] {
        let scene: Value = serde_json::from_str(text).expect("it is JSON");
        assert_eq!(validate(&scene, &schema, &schema, "scene"), Ok(()));
    }
    let bad = [
        json!({"environment": {"depth": 0.0}}),
        json!({"lines": [{"name": "a"}]}),
        json!({"solver": {"tolerance": 0.5}}),
        json!({"motion": {"kind": "sinusoidal", "perid": 1.0}}),
        json!({"run": {"output_step": -1.0}}),
        json!({"depth": 1.0}),
    ];
    for change in bad {
        let mut scene: Value = serde_json::from_str(BUILT_IN).expect("it is JSON");
        for (key, value) in change.as_object().into_iter().flatten() {
            scene[key] = value.clone();
        }
        assert!(validate(&scene, &schema, &schema, "scene").is_err(), "{change}");
    }
}

/// Every default that the reader takes stands in the schema, and every key has a text.
#[test]
fn the_schema_states_every_default_and_explains_every_key() {
    let schema = schema();
    let objects = schema["$defs"].as_object().expect("the schema has definitions");
    let mut keys = 0;
    for (name, object) in objects.iter().chain([(&"Scene".to_string(), &schema)]) {
        let variants = object["oneOf"].as_array().cloned().unwrap_or_else(|| vec![object.clone()]);
        for variant in &variants {
            let required: Vec<&str> = variant["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
            for (key, property) in variant["properties"].as_object().into_iter().flatten() {
                keys += 1;
                if key == "kind" {
                    continue;
                }
                assert!(property["description"].is_string(), "{name}.{key} has no description");
                let optional = property["type"].as_array().is_some_and(|types| types.contains(&json!("null")))
                    || property["anyOf"].is_array();
                let stated = property.get("default").is_some() || optional;
                assert!(
                    required.contains(&key.as_str()) != stated,
                    "{name}.{key} is neither required nor has it a default, or both"
                );
            }
        }
    }
    assert!(keys > 60, "only {keys} keys seen");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever a slip of the fingers does to a scene, it is read or refused with a reason.
    #[test]
    fn no_mutation_of_the_scene_makes_the_reader_panic(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<char>(), 0..6u8), 1..6)) {
        let mut text: Vec<char> = BUILT_IN.chars().collect();
        for (index, letter, action) in edits {
            if text.is_empty() {
                break;
            }
            let at = index.index(text.len());
            let structural = ['{', '}', '[', ']', '"', ',', ':', '-', '9', 'e', '\\', '.', 'N'];
            match action {
                0 => text[at] = letter,
                1 => { text.remove(at); }
                2 => text.insert(at, letter),
                3 => text[at] = structural[letter as usize % structural.len()],
                4 => text.insert(at, structural[letter as usize % structural.len()]),
                _ => text.truncate(at.max(1)),
            }
        }
        let text: String = text.into_iter().collect();
        if let Err(error) = read(&text, &[]) {
            prop_assert_eq!(error.exit_code(), 2);
            prop_assert!(error.to_string().len() > 20 && error.to_string().len() < 2000, "{}", error);
        }
    }

    #[test]
    fn no_setting_makes_the_reader_panic(place in "[a-z.\\[\\]\"0-2]{0,12}", root in 0..5usize, value in "[-0-9a-z{}\\[\\]\",.:]{0,8}") {
        let root = ["", "lines[0]", "motion", "environment.seabed", "line_types.chain"][root];
        if let Err(error) = read(BUILT_IN, &[&format!("{root}.{place}={value}"), &format!("{root}{place}={value}")]) {
            prop_assert!(error.to_string().len() > 20);
        }
    }
}
