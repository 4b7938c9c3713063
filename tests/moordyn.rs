//! MoorDyn files: every spelling means the same scene, statics agree with closed forms and with MoorPy, and what is wrong is refused by its
//! line.

mod support;

use moorline::scene::bodies::{Inertia, Mount};
use moorline::scene::read::{Loaded, load, parse};
use moorline::sea::clock::Clock;
use moorline::sea::waves::Waves;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use support::mooring::settled;
use support::{GRAVITY, assert_close, program};

const SECOND: &str = include_str!("data/moordyn/spread-v2.txt");
const FIRST: &str = include_str!("data/moordyn/spread-v1.txt");

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/moordyn")
}

fn read(text: &str) -> Loaded {
    parse(text, "deck.txt", &directory(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn deck(name: &str) -> Loaded {
    load(&directory().join(name), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The message with which a text is refused; it must mean exit code 2.
fn message(text: &str) -> String {
    match parse(text, "deck.txt", &directory(), &[]) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{error}");
            error.to_string()
        }
    }
}

/// The second version's barge with one passage replaced, which must stand there once.
fn edited(from: &str, to: &str) -> String {
    assert_eq!(SECOND.matches(from).count(), 1, "{from:?} must stand once in the deck");
    SECOND.replacen(from, to, 1)
}

fn without_title(loaded: &Loaded) -> Value {
    let mut value = serde_json::to_value(&loaded.scene).expect("a scene is JSON");
    value["title"] = json!("");
    value
}

/// Version 1 with tabs, comments, counts of rows, texts after rows, ends after lengths and old words is the scene of version 2.
#[test]
fn both_versions_say_the_same_scene() {
    assert_eq!(without_title(&read(FIRST)), without_title(&read(SECOND)));
    for text in [SECOND.replace('\n', "\r\n"), format!("\u{feff}{SECOND}"), SECOND.trim_end().to_string(), SECOND.to_uppercase()]
    {
        let mut value = without_title(&read(&text));
        let text = value.to_string().replace("CHAIN", "chain").replace("WIRE", "wire");
        value = text.parse().expect("JSON");
        assert_eq!(value, without_title(&read(SECOND)));
    }
    // Signs of an older encoding in the units do no harm.
    let latin: Vec<u8> = SECOND.replace("(m^3)", "(m\u{b3})").chars().map(|c| c as u8).collect();
    let place = program::directory("latin").join("deck.txt");
    std::fs::write(&place, latin).expect("written");
    let loaded = load(&place, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(without_title(&loaded), without_title(&read(SECOND)));
}

/// Every number of the deck where docs/moordyn-files.md puts it.
#[test]
fn numbers_are_where_the_manual_of_the_format_puts_them() {
    let scene = read(SECOND).scene;
    assert_eq!(scene.title, "Spread mooring of a barge in 90 m of water");
    let chain = &scene.line_types["chain"];
    assert_eq!((chain.diameter, chain.mass, chain.ea, chain.ei), (0.16, 180.0, 7.5e8, 0.0));
    assert_eq!((chain.drag.normal, chain.drag.tangential), (1.4, 0.4));
    assert_eq!((chain.added_mass.normal, chain.added_mass.tangential), (1.0, 0.5));
    assert_eq!((chain.submerged_weight, chain.buoyancy), (None, None), "the displacement is that of the diameter");
    assert_close("bed under the chain", chain.seabed_stiffness.expect("a bed"), 3.0e6 * 0.16, 1e-14);
    assert_close("damping of the bed", scene.environment.seabed.damping, 3.0e5 * 0.16, 1e-14);
    // A negative BA is a share of 2 sqrt(k m) of a segment, halves of both: zeta l sqrt(EA m) for a segment of length l.
    assert_close("of line 1", chain.damping, 0.8 * (279.0 / 28.0) * (7.5e8_f64 * 180.0).sqrt() / 7.5e8, 1e-12);
    let other = &scene.line_types["chain (line 3)"];
    assert_close("of line 3", other.damping, 0.8 * (431.0 / 43.0) * (7.5e8_f64 * 180.0).sqrt() / 7.5e8, 1e-12);
    assert_close("given", scene.line_types["wire"].damping, 2.0e5 / 4.1e8, 1e-14);
    let kinds: Vec<&str> = scene.lines.iter().map(|line| line.sections[0].line_type.as_str()).collect();
    assert_eq!(kinds, ["chain", "wire", "chain (line 3)", "chain (line 3)"]);
    assert_eq!(scene.lines[1].fairlead_on, Some(Mount::Body { body: "vessel".into(), at: [20.0, 0.0, -5.0], clamp: None }));
    assert_eq!(scene.lines[1].anchor_on, Some(Mount::Point { point: "point7".into() }));
    assert_eq!((scene.lines[0].anchor, &scene.lines[0].anchor_on), ([420.0, 0.0, -90.0], &None));
    let knot = &scene.points[0];
    assert_eq!((knot.position, knot.mass, knot.volume, knot.drag_area), ([150.0, 0.0, -60.0], 1500.0, 0.4, 0.8));
    assert_close("added mass of the point", knot.added_mass, 0.6 * 1025.0 * 0.4, 1e-14);
    assert_eq!((scene.environment.depth, scene.environment.gravity, scene.run.output_step), (90.0, 9.80665, 0.25));
}

/// A body has its own mass, that of points on it and the cylinders of its rods; a coupled one is a pose alone.
#[test]
fn a_body_is_put_together_from_points_and_rods() {
    let loaded = deck("buoy.txt");
    let scene = &loaded.scene;
    let buoy = &scene.bodies[scene.body("body1").expect("the buoy")];
    assert_eq!(buoy.mass, 14200.0);
    let centre = [1.5 * 200.0 / 14200.0, 0.0, (2.0 * 200.0 - 8.5 * 14000.0) / 14200.0];
    for (found, expected) in buoy.centre_of_mass.iter().zip(centre) {
        assert!((found - expected).abs() < 1e-12, "{:?}", buoy.centre_of_mass);
    }
    // Two masses m, M at a distance have m M/(m + M) d² about their centre, across the line that joins them.
    let reduced = 14000.0 * 200.0 / 14200.0;
    let Some(Inertia::Full(inertia)) = &buoy.inertia else { panic!("{:?}", buoy.inertia) };
    assert_close("Ixx", inertia[0][0], 1.2e4 + reduced * 10.5 * 10.5, 1e-12);
    assert_close("Iyy", inertia[1][1], 1.2e4 + reduced * (10.5 * 10.5 + 1.5 * 1.5), 1e-12);
    assert_close("Izz", inertia[2][2], 6.0e3 + reduced * 1.5 * 1.5, 1e-12);
    assert_close("Ixz", inertia[0][2], -reduced * 10.5 * 1.5, 1e-12);
    let hull = &buoy.cylinders[0];
    assert_eq!((hull.from, hull.to, hull.diameter, hull.mass), ([0.0, 0.0, -9.0], [0.0, 0.0, 3.0], 3.0, 28800.0));
    assert_eq!((hull.drag.normal, hull.drag.end, hull.added_mass.normal, hull.added_mass.end), (0.8, 1.1, 1.0, 0.6));
    let half = 0.5 * 1025.0;
    assert_eq!(buoy.quadratic_damping, Some([half, half, half, half * 20.0, half * 20.0, half * 20.0]));
    let ship = &scene.bodies[scene.body("body2").expect("the ship")];
    assert_eq!((ship.position, ship.attitude_deg, ship.mass), ([70.0, 0.0, 0.0], [0.0, 0.0, 180.0], 0.0));
    assert_eq!(scene.lines[3].anchor, [50.0, ship.place(&[20.0, 0.0, 5.0]).y, 5.0], "the ship looks at the buoy");
    assert_eq!(scene.environment.current.len(), 3);
    assert_eq!((scene.environment.current[0].z, scene.environment.current[0].velocity), (0.0, [0.4, 0.05, 0.0]));
    assert_eq!(scene.environment.seabed.friction, 0.3);
    let hawser = &scene.line_types["hawser"];
    assert_eq!(hawser.tension_strain.as_deref(), Some([[0.0, 0.0], [0.02, 1.0e4], [0.06, 6.0e4], [0.15, 3.0e5]].as_slice()));
    assert_eq!((hawser.ea, hawser.damping), (2.0e6, 1.0e4 / 2.0e6), "EA of a table is that of its last row");
}

/// What the buoy weighs and the lines pull is what it displaces.
#[test]
fn the_buoy_floats_where_its_weight_and_its_lines_let_it() {
    let loaded = deck("buoy.txt");
    let (mooring, outputs) = settled(&loaded);
    let bodies: Vec<_> = mooring.parts.iter().flat_map(|part| part.bodies()).collect();
    let (_, pose) = bodies.iter().find(|(body, _)| loaded.scene.bodies[*body].is_free()).expect("the buoy");
    let pull: f64 = outputs[..3].iter().map(|line| line.force.z).sum::<f64>() + outputs[3].force.z;
    let weight = (14200.0 + 28800.0) * GRAVITY;
    // The axis leans by pitch and roll; the wet length is along it.
    let lean = pose.angles[0].cos() * pose.angles[1].cos();
    let wet = 9.0 - pose.position.z / lean;
    let buoyancy = 1025.0 * GRAVITY * std::f64::consts::FRAC_PI_4 * 9.0 * wet;
    assert_close("buoyancy", buoyancy, weight - pull, 1e-3);
}

/// Source: MoorPy 1.3 on the same file (tests/peers/moordyn_decks.py). Its chain lies on a hard bed, ours and MoorDyn's sinks 3 mm into
/// springs of kBot: 0.02 % of the tension.
#[test]
fn the_spread_has_the_tensions_of_moorpy() {
    let (_, outputs) = settled(&read(SECOND));
    let tensions = [(130910.68, 120397.53), (152229.29, 135464.90), (738680.18, 605936.24), (738680.18, 605936.24)];
    for (number, (line, (fairlead, anchor))) in outputs.iter().zip(tensions).enumerate() {
        assert_close(&format!("line {} fairlead", number + 1), line.tension, fairlead, 5e-4);
        assert_close(&format!("line {} anchor", number + 1), line.anchor_tension, anchor, 5e-4);
    }
}

/// Source: a beam with weight w per length and P at its end: wall moment w L²/2 + P L, deflection w L⁴/8EI + P L³/3EI; by 0.03 % less where
/// it bends down by 2.3 % of its length.
#[test]
fn a_line_leaves_a_fixed_rod_along_it() {
    let loaded = deck("cantilever.txt");
    let (mooring, outputs) = settled(&loaded);
    let (weight, end, length) = (15.4 * GRAVITY, 5.0 * GRAVITY, 4.0_f64);
    let moment = weight * length.powi(2) / 2.0 + end * length;
    let stiffness = 6.4e4;
    let deflection = weight * length.powi(4) / (8.0 * stiffness) + end * length.powi(3) / (3.0 * stiffness);
    let (_, tip) = mooring.parts[0].points()[0];
    assert_close("deflection", 20.0 - tip.z, deflection, 2e-3);
    assert_close("force on the wall", -outputs[0].anchor_force.z, weight * length + end, 1e-6);
    assert!(moment > 1.4e3);
}

/// The weight of a chain that hangs free is all the tension at its top.
#[test]
fn a_chain_that_hangs_free_carries_its_weight() {
    let text = "hanging\n--- LINE TYPES ---\nname d m EA BA EI Cd Ca CdAx CaAx\n(-) (m)\nchain 0.05 50 1e8 -1 0 1 1 0 0\n--- POINTS ---\nid\n(#)\n\
                1 Fixed 0 0 -5 0 0 0 0\n2 Free 1 0 -55 0 0 0 0\n--- LINES ---\nid\n(#)\n1 chain 2 1 50 10 -\n--- OPTIONS ---\n200 WtrDpth\n";
    let (_, outputs) = settled(&read(text));
    let weight = 50.0 * (50.0 - 1025.0 * std::f64::consts::FRAC_PI_4 * 0.05 * 0.05) * GRAVITY;
    assert_close("tension at the top", outputs[0].tension, weight, 1e-6);
}

/// What is wrong is said with file, line, the line itself and what is expected.
#[test]
fn every_fault_is_named_with_its_line_and_what_is_expected() {
    let faults: &[(&str, &str, &[&str])] = &[
        (
            "1     chain      1        7        279.0     28       p",
            "1 chain 1 7 279.0",
            &["line 21", "5 of the 6 values", "segments"],
        ),
        ("431.0     43       pt", "431.0     0       pt", &["line 23", "segments", "\"0\"", "whole number from 1"]),
        ("431.0     43       pt", "long     43       pt", &["line 23", "unstretched length", "\"long\"", "a number"]),
        ("431.0     43       pt", "-431.0     43       pt", &["line 23", "greater than 0"]),
        ("3     chain      3        4", "3     chian      3        4", &["line 23", "line type", "did you mean `chain`"]),
        ("3     chain      3        4", "3     chain      3        9", &["line 23", "`point 9`", "`7`"]),
        ("3     chain      3        4", "3     chain      3        R1A", &["line 23", "there is no `rod 1`"]),
        ("3     chain      3        4", "3     chain      3        x", &["line 23", "end of the line", "R1A"]),
        ("3     chain      3        4", "3     chain      3        3", &["line 23", "both are on one place"]),
        ("3     chain      3        4", "2     chain      3        4", &["line 23", "line: 2 stands twice, first in line 22"]),
        ("4.1e8      2.0e5", "4.1e8", &["line 7", "9 of the 10 values", "CaAx"]),
        ("4.1e8      2.0e5", "4.1e8|5e8   2.0e5", &["line 7", "EA", "static and a dynamic"]),
        ("4.1e8      2.0e5", "rope.txt   2.0e5", &["rope.txt"]),
        ("4.1e8      2.0e5", "soft   2.0e5", &["line 7", "EA", "\"soft\""]),
        ("wire       0.08", "wire       0", &["line 7", "diameter", "greater than 0"]),
        ("wire       0.08", "chain       0.08", &["line 7", "chain stands twice, first in line 6"]),
        ("1.2    1.0    0.05    0.0\n", "1.2    1.0    0.05    0.0 0.7\n", &["line 7", "Cl", "vortex"]),
        ("420.0   0.0     -90.0", "420.0   O.0     -90.0", &["line 11", "Y", "\"O.0\"", "a number"]),
        ("1500.0 0.4     0.8    0.6", "1500.0 0.4", &["line 17", "7 of the 9 values"]),
        ("1500.0 0.4     0.8", "-1500.0 0.4     0.8", &["line 17", "mass", "not negative"]),
        ("7     Free ", "7     Fre ", &["line 17", "`Fre`", "did you mean `Free`"]),
        ("7     Free ", "7     Pinned ", &["line 17", "a hinge is not modelled"]),
        ("7     Free ", "7     Pinned1 ", &["line 17", "a hinge is not modelled"]),
        ("7     Free ", "7     Turbine2 ", &["line 17", "FAST.Farm"]),
        ("7     Free ", "7     Body1 ", &["line 17", "there is no `body 1`"]),
        ("7     Free ", "0     Free ", &["line 17", "point", "whole number greater than 0"]),
        ("90      WtrDpth", "deep.txt      WtrDpth", &["deep.txt"]),
        ("90      WtrDpth", "90      WtrDpht", &["line 30", "option", "did you mean `wtrdpth`"]),
        ("90      WtrDpth    water depth (m)", "90", &["line 30", "1 of the 2 values"]),
        ("90      WtrDpth", "nan      kBot", &["line 30", "kBot", "finite"]),
        ("90      WtrDpth", "4      WaveKin", &["line 30", "WaveKin", "2, 3 and 7 are files"]),
        ("90      WtrDpth", "7      WaveKin", &["wave_frequencies.txt"]),
        ("90      WtrDpth", "3      WaveKin", &["wave_elevation.txt"]),
        ("90      WtrDpth", "0      dtWave", &["line 30", "dtWave", "greater than 0"]),
        ("90      WtrDpth", "3      Currents", &["line 30", "Currents", "profile"]),
        ("90      WtrDpth", "0.4      MU_KT", &["line 30", "MU_KT, MU_KA"]),
        ("(#)   (word/ID)   (m)     (m)     (m)     (kg)   (m^3)   (m^2)  (-)\n", "", &["line 10", "units of the columns"]),
        ("---------------------- LINES ---", "---------------------- POINTS ---", &["line 18", "stands twice, first in line 8"]),
        ("---------------------- LINES ---", "---------------------- ROPES ---", &["without a section LINES"]),
        (
            "---------------------- OUTPUTS",
            "---- FAILURE ----\na\n(b)\n1 5 1 0 1e6\n---------------------- OUTPUTS",
            &["line 38", "breaking_load"],
        ),
    ];
    for (from, to, parts) in faults {
        let message = message(&edited(from, to));
        println!("{message}");
        assert!(message.starts_with("deck.txt") || message.contains(parts[0]), "{from} -> {to}: {message}");
        for part in *parts {
            assert!(message.contains(part), "{from} -> {to}: {message:?} has no {part:?}");
        }
    }
}

/// What changes nothing that matters is a warning.
#[test]
fn what_is_left_out_is_told() {
    let warnings = read(SECOND).warnings.join("\n");
    for part in ["dtM, TmaxIC, threshIC: of MoorDyn's own time stepping", "cBot: damping of the bed is one for all lines here"] {
        assert!(warnings.contains(part), "{part}: {warnings}");
    }
    let told = |from: &str, to: &str, part: &str| {
        let warnings = read(&edited(from, to)).warnings.join("\n");
        assert!(warnings.contains(part), "{part}: {warnings}");
    };
    told("90      WtrDpth", "80      WtrDpth", "line 11: the depth is 90 m, that of point 1");
    told("90      WtrDpth", "90      WtrDpth\n1 WaveKin", "WaveKin 1 takes waves from a calling program");
    told("90      WtrDpth", "90      WtrDpth\n7 colour", "line 31: colour is no option that is known");
    told("ANCHTEN3", "ANCHTEN3 ROD1SUB", "OUTPUTS: ROD1SUB: columns that are not written");
    for (channel, why) in [
        ("LINE9TENA", "there is no such line"),
        ("L1N29T", "count from 0 at end A to NumSegs"),
        ("Con9Fx", "no line leads to such a point"),
        ("POINT7FZ", "the forces are in balance"),
        ("BODY2PX", "there is no such body"),
    ] {
        told("ANCHTEN3", &format!("ANCHTEN3 {channel}"), &format!("OUTPUTS: {channel}: not written: "));
        told("ANCHTEN3", &format!("ANCHTEN3 {channel}"), why);
    }
    told("7     Free ", "8     Free 0 0 -10 1 0 0 0\n7     Free ", "no line leads to point8");
    told("Cd     Ca     CdAx    CaAx", "Can   Cat   Cdn   Cdt", "version 2 reads Cd, Ca, CdAx, CaAx by their place");
    told("420.0   0.0     -90.0   0 ", "420.0   0.0     -90.0   5 ", "line 11: mass and volume of a point that is held");
}

/// A bed that a grid describes as a plane is a plane, in both forms of the file; another one is refused by how far it is off.
#[test]
fn a_grid_of_depths_that_is_a_plane_is_a_slope() {
    let place = program::directory("grids");
    let deck = |grid: &str, option: &str| {
        std::fs::write(place.join("bed.txt"), grid).expect("written");
        let text = edited("90      WtrDpth", option).replace("-90.0", "-70.0");
        parse(&text, "deck.txt", &place, &[])
    };
    // z = -90 + 0.02 x.
    let old = "----- MoorDyn Bathymetry Input File ----\nnGridX 2\nnGridY 2\n -1000 500\n-400 110 80\n400 110 80\n";
    let new = "2 2\n-1000 500\n-400 400\n-1000 -400 -110\n-1000 400 -110\n500 -400 -80\n500 400 -80\n";
    for (grid, option) in [(old, "\"bed.txt\" WtrDpth"), (new, "bed.txt SeafloorFile")] {
        let scene = deck(grid, option).unwrap_or_else(|error| panic!("{error}")).scene;
        assert_close("depth", scene.environment.depth, 90.0, 1e-12);
        assert_close("slope", scene.environment.seabed.slope_deg[0].to_radians().tan(), 0.02, 1e-12);
        assert!(scene.environment.seabed.slope_deg[1].abs() < 1e-12);
    }
    let refused = deck(&new.replace("500 400 -80", "500 400 -70"), "bed.txt SeafloorFile").expect_err("a hill").to_string();
    assert!(refused.contains("2.500 m off a plane"), "{refused}");
}

/// The commands take a deck where they take a scene.
#[test]
fn every_command_takes_a_deck() {
    let place = program::directory("commands");
    for name in ["spread-v2.txt", "buoy.txt", "rope.dat", "current_profile.txt"] {
        std::fs::copy(directory().join(name), place.join(name)).expect("copied");
    }
    let done = |arguments: &[&str]| {
        let output = program::moorline(&place, arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    for name in ["spread-v2.txt", "buoy.txt"] {
        done(&["check", name]);
        done(&["run", name, "-o", "out", "--set", "run.duration=1.0"]);
        let rows = program::read(&place.join("out/timeseries.csv"));
        assert!(rows.lines().next().is_some_and(|names| names.contains("line1.tension")), "{rows}");
        assert!(rows.lines().last().is_some_and(|row| row.starts_with("1,") || row.starts_with("1.0")), "{rows}");
        if name == "spread-v2.txt" {
            // The channels of the deck, by its names, are the columns of timeseries.csv.
            let out = program::read(&place.join("out/spread-v2.out"));
            let cells = |text: &str, part: char| text.split(part).map(str::to_owned).collect::<Vec<_>>();
            let lines: Vec<&str> = out.lines().collect();
            assert_eq!(cells(lines[0], '\t'), ["Time", "FAIRTEN1", "FAIRTEN2", "ANCHTEN3"]);
            assert_eq!(cells(lines[1], '\t'), ["(s)", "(N)", "(N)", "(N)"]);
            assert_eq!(lines.len() - 2, rows.lines().count() - 1);
            let names = cells(rows.lines().next().unwrap_or_default(), ',');
            for (column, name) in [(1, "line1.tension"), (2, "line2.tension"), (3, "line3.anchor_tension")] {
                let at = names.iter().position(|own| own == name).expect("a column");
                let own: f64 = cells(rows.lines().last().unwrap_or_default(), ',')[at].parse().expect("a number");
                let found: f64 = cells(lines[lines.len() - 1], '\t')[column].parse().expect("a number");
                assert_close(name, found, own, 1e-7);
            }
        }
        // The JSON scene says what the deck says.
        done(&["convert", name, "scene.json"]);
        let (own, converted) = (load(&place.join(name), &[]), load(&place.join("scene.json"), &[]));
        let scene = |loaded: Result<Loaded, _>| loaded.unwrap_or_else(|error: moorline::error::Error| panic!("{error}")).scene;
        assert_eq!(scene(own), scene(converted));
        let json: Value = serde_json::from_str(&done(&["statics", name, "--json"])).expect("JSON");
        assert_eq!(json["converged"], json!(true));
    }
}

/// Nodes and points by the names that OpenFAST's decks use. Source: in a catenary the tension falls by the weight in water times the height,
/// T = T_B - w (z_B - z) (measured: 1.4e-4, the sag of the line between nodes under its own stretch); velocities are the change of positions
/// (central differences over 0.25 s, 1 %); a held point feels what the end of its line pulls with.
#[test]
fn nodes_and_points_have_columns() {
    let place = program::directory("channels");
    let moving = r#"bodies[0].motion={"kind":"sinusoidal","period":20,"ramp":10,"sine":[1.0,0,0.5,0,0,0]}"#;
    let asked = [
        "LINE4N0T",
        "L4N43T",
        "FAIRTEN4",
        "L4N38T",
        "L4N38PZ",
        "LINE4NBPZ",
        "LINE4N38VZ",
        "Con6Fx",
        "CON6FY",
        "POINT6FZ",
        "L4N43PX",
        "ANCHTEN4",
    ];
    std::fs::write(place.join("deck.txt"), edited("ANCHTEN3", &asked.join(" "))).expect("written");
    let output = program::moorline(&place, &["run", "deck.txt", "-o", "out", "--set", "run.duration=20", "--set", moving]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let out = program::read(&place.join("out/deck.out"));
    let rows: Vec<Vec<f64>> =
        out.lines().skip(2).map(|row| row.split('\t').map(|x| x.parse().expect("a number")).collect()).collect();
    let names: Vec<&str> = out.lines().next().unwrap_or_default().split('\t').collect();
    let column = |name: &str| names.iter().position(|own| *own == name).unwrap_or_else(|| panic!("no {name} in {names:?}"));
    let at = |row: usize, name: &str| rows[row][column(name)];
    let weight = (180.0 - 1025.0 * std::f64::consts::PI / 4.0 * 0.16 * 0.16) * GRAVITY;
    let fallen = at(0, "FAIRTEN4") - weight * (at(0, "LINE4NBPZ") - at(0, "L4N38PZ"));
    assert_close("tension of a node", at(0, "L4N38T"), fallen, 5e-4);
    assert_close("an end is a node", at(0, "L4N43T"), at(0, "FAIRTEN4"), 1e-6);
    assert_close("the other end", at(0, "LINE4N0T"), at(0, "ANCHTEN4"), 1e-6);
    assert_close("its place", at(0, "L4N43PX"), -18.0, 1e-9);
    for row in [0, 40, 79] {
        let pull = ["Con6Fx", "CON6FY", "POINT6FZ"].map(|name| at(row, name).powi(2)).iter().sum::<f64>().sqrt();
        assert_close("pull on the point", pull, at(row, "FAIRTEN4"), 1e-6);
    }
    let fastest = rows.iter().map(|row| row[column("LINE4N38VZ")].abs()).fold(0.0, f64::max);
    assert!(fastest > 0.05, "{fastest}");
    for row in 1..80 {
        let change = (at(row + 1, "L4N38PZ") - at(row - 1, "L4N38PZ")) / 0.5;
        assert!((change - at(row, "LINE4N38VZ")).abs() < 0.01 * fastest, "row {row}: {change}");
    }
}

/// A driver for the spread, with the lines that a test changes.
fn driver(change: &[(&str, &str)]) -> String {
    let mut text = String::from(
        "MoorDyn driver input file\nof the spread\nFALSE  Echo - echo the input\n\
         ---------------------- ENVIRONMENTAL CONDITIONS ---\n9.5 Gravity - (m/s^2)\n1010.0 rhoW - (kg/m^3)\n95.0 WtrDpth - (m)\n\
         ---------------------- MOORDYN ---\n\"deck of it.txt\" MDInputFile - (quoted string)\n\"driver\" OutRootName - x\n\
         30 TMax - (s)\n0.0125 dtC - (s)\n1 InputsMode - (switch)\n\"ptfm.dat\" InputsFile - (quoted string)\n0 NumTurbines - (-)\n\
         ---------------------- Initial Positions ---\nref_X ref_Y surge_init sway_init heave_init roll_init pitch_init yaw_init\n\
         (m) (m) (m) (m) (m) (rad) (rad) (rad) [followed by MAX(1,NumTurbines) rows of data]\n0 0 0 0 0 0 0 0\n\
         END of driver input file\n",
    );
    for (from, to) in change {
        assert_eq!(text.matches(from).count(), 1, "{from:?} must stand once in the driver");
        text = text.replacen(from, to, 1);
    }
    text
}

/// Rows of a table: the time, and what moves at it.
fn table(heading: &str, step: f64, rows: usize, of: impl Fn(f64) -> Vec<f64>) -> String {
    let row = |n: usize| {
        let time = n as f64 * step;
        std::iter::once(time).chain(of(time)).map(|x| format!("{x:.9e}")).collect::<Vec<_>>().join(" ")
    };
    std::iter::once(heading.to_string()).chain((0..rows).map(row)).collect::<Vec<_>>().join("\n")
}

/// One motion, as a sine of the vessel in the scene and as the table of a driver that samples it every quarter of a second, three columns for
/// each coupled point, is the same to the error of the spline between rows, (ωh)⁴/384 of the amplitude, 2e-6 m, more in the last interval.
/// Measured: 1.9e-3 of a tension's range, at the last row. A coupled body with the columns of OpenFAST,
/// angles in rad, goes the same way as a scene's pitch in deg.
#[test]
fn a_table_of_a_driver_moves_as_a_sine_does() {
    let place = program::directory("driven");
    let (period, ramp, surge, heave) = (9.0, 9.0, 1.5, 0.8);
    let eased = |time: f64| {
        let xi = (time / ramp).min(1.0);
        xi * xi * (3.0 - 2.0 * xi) * (std::f64::consts::TAU / period * time).sin()
    };
    let points = [[20.0, 0.0, -5.0], [-18.0, 8.0, -5.0], [-18.0, -8.0, -5.0]];
    let moved = |time: f64| points.iter().flat_map(|p| [p[0] + surge * eased(time), p[1], p[2] + heave * eased(time)]).collect();
    std::fs::write(place.join("deck of it.txt"), SECOND).expect("written");
    std::fs::write(place.join("ptfm.dat"), table("# Time(s) P2\nTime x y z\n(s) (m) (m) (m)", 0.25, 121, moved))
        .expect("written");
    std::fs::write(place.join("md_driver.inp"), driver(&[])).expect("written");
    let on_body = SECOND
        .replace(
            "---------------------- POINTS",
            "-------- BODIES ---\nID\n(#)\n1 Coupled 0 0 0 0 0 0 0 0 0 0 0 0\n---------------------- POINTS",
        )
        .replace(" Coupled     ", " Body1     ");
    std::fs::write(place.join("body.txt"), &on_body).expect("written");
    let pitching = |time: f64| vec![surge * eased(time), 0.0, 0.0, 0.0, 3.0_f64.to_radians() * eased(time), 0.0];
    std::fs::write(place.join("body.dat"), table("#", 0.25, 121, pitching)).expect("written");
    let tensions = |arguments: &[&str]| -> Vec<Vec<f64>> {
        let output = program::moorline(&place, &[&["run", "-o", "out"], arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let rows = program::read(&place.join("out/timeseries.csv"));
        let names: Vec<&str> = rows.lines().next().unwrap_or_default().split(',').collect();
        let columns: Vec<usize> = (0..names.len()).filter(|at| names[*at].ends_with("tension") || *at == 0).collect();
        let row = |row: &str| {
            let cells: Vec<&str> = row.split(',').collect();
            columns.iter().map(|at| cells[*at].parse().expect("a number")).collect()
        };
        rows.lines().skip(1).map(row).collect()
    };
    let sine =
        |name: &str, six: [f64; 6]| format!(r#"{name}={{"kind":"sinusoidal","period":{period},"ramp":{ramp},"sine":{six:?}}}"#);
    let surging = sine("bodies[0].motion", [surge, 0.0, heave, 0.0, 0.0, 0.0]);
    let pitching = sine("bodies[0].motion", [surge, 0.0, 0.0, 0.0, 3.0, 0.0]);
    for (what, driven, own) in [
        ("driver", vec!["md_driver.inp"], vec!["deck of it.txt", "--set", "run.duration=30", "--set", &surging]),
        (
            "table",
            vec!["deck of it.txt", "--motion", "ptfm.dat"],
            vec!["deck of it.txt", "--set", "run.duration=30", "--set", &surging],
        ),
        ("body", vec!["body.txt", "--motion", "body.dat"], vec!["body.txt", "--set", "run.duration=30", "--set", &pitching]),
    ] {
        let (driven, own) = (tensions(&driven), tensions(&own));
        assert_eq!(driven.len(), 121, "{what}: every 0.25 s, for 30 s");
        for column in 1..own[0].len() {
            let values = || own.iter().map(|row| row[column]);
            let range = values().fold(0.0, f64::max) - values().fold(f64::INFINITY, f64::min);
            let off = driven.iter().zip(&own).map(|(one, other)| (one[column] - other[column]).abs()).fold(0.0, f64::max);
            println!("{what}, column {column}: range {range:.0} N, off {:.1e} of it", off / range);
            assert!(range > 1.0e4 && off < 4.0e-3 * range, "{what}, column {column}: {off} N of {range} N");
        }
    }
}

/// What a driver says of the water counts where the MoorDyn file says nothing; initial positions shift and turn what is coupled as one body,
/// p' = Rx Ry Rz p + d, and several angles of a table turn as those of a MoorDyn file do.
#[test]
fn a_driver_says_water_time_and_where_things_begin() {
    let place = program::directory("drivers");
    let silent = edited("90      WtrDpth    water depth (m)\n", "").replace("9.80665 g          gravity (m/s^2)\n", "");
    std::fs::write(place.join("deck of it.txt"), &silent).expect("written");
    let still = [
        ("1 InputsMode", "0 InputsMode"),
        ("(rad) (rad) (rad) [followed by MAX(1,NumTurbines) rows of data]\n0 0 0 0 0 0 0 0", "(rad)\n0 0 5 1 -0.5 0.1 0.2 0.3"),
    ];
    let read = |text: &str| parse(text, "md_driver.inp", &place, &[]).unwrap_or_else(|error| panic!("{error}"));
    let loaded = read(&driver(&still));
    let environment = &loaded.scene.environment;
    // The file itself says the density.
    assert_eq!((environment.gravity, environment.water_density, environment.depth), (9.5, 1025.0, 95.0));
    assert_eq!(loaded.scene.run.duration, 30.0);
    let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), 0.1)
        * nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), 0.2)
        * nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), 0.3);
    let expected = turn * nalgebra::Vector3::new(-18.0, 8.0, -5.0) + nalgebra::Vector3::new(5.0, 1.0, -0.5);
    let off = (nalgebra::Vector3::from(loaded.scene.lines[2].fairlead) - expected).norm();
    assert!(off < 1e-12, "{off}");

    let on_body = silent
        .replace(
            "---------------------- POINTS",
            "-------- BODIES ---\nID\n(#)\n1 Coupled 0 0 0 0 0 0 0 0 0 0 0 0\n---------------------- POINTS",
        )
        .replace(" Coupled     ", " Body1     ");
    std::fs::write(place.join("deck of it.txt"), on_body).expect("written");
    std::fs::write(place.join("ptfm.dat"), table("", 10.0, 3, |_| vec![5.0, 1.0, -0.5, 0.1, 0.2, 0.3])).expect("written");
    let loaded = read(&driver(&[]));
    assert_eq!(loaded.scene.run.duration, 20.0, "the table ends before TMax");
    let off = (nalgebra::Vector3::from(loaded.scene.lines[2].fairlead) - expected).norm();
    assert!(off < 1e-9, "{off}");
}

/// What is wrong with a driver or its table is said with file, line and what is expected.
#[test]
fn faults_of_drivers_and_tables_are_named() {
    let place = program::directory("bad-drivers");
    std::fs::write(place.join("deck of it.txt"), SECOND).expect("written");
    let refused = |text: &str| match parse(text, "md_driver.inp", &place, &[]) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{error}");
            error.to_string()
        }
    };
    let nine = |_: f64| vec![0.0; 9];
    for (found, to, parts) in [
        ("1 InputsMode", "2 InputsMode", vec!["md_driver.inp", "InputsMode", "0 leaves", "1 moves"]),
        ("1 InputsMode", "on InputsMode", vec!["line 13", "InputsMode", "\"on\"", "a number"]),
        ("\"ptfm.dat\"", "\"\"", vec!["line 14", "InputsFile", "InputsMode 1 needs"]),
        ("\"ptfm.dat\"", "\"none.dat\"", vec!["none.dat"]),
        ("\"deck of it.txt\"", "\"none.txt\"", vec!["none.txt"]),
        ("0 NumTurbines", "3 NumTurbines", vec!["line 15", "NumTurbines", "a driver of its own"]),
        ("30 TMax", "-30 TMax", vec!["line 11", "TMax", "greater than 0"]),
        ("\n0 0 0 0 0 0 0 0", "\n0 0 0 0 0 0 20 0", vec!["line 19", "rad"]),
        ("\n0 0 0 0 0 0 0 0", "\n0 0 0 0", vec!["line 19", "4 of the 8", "surge"]),
    ] {
        std::fs::write(place.join("ptfm.dat"), table("", 1.0, 3, nine)).expect("written");
        let message = refused(&driver(&[(found, to)]));
        println!("{message}");
        parts.iter().for_each(|part| assert!(message.contains(part), "{to}: {message:?} has no {part:?}"));
    }
    let good = table("# Time x", 1.0, 3, |t| vec![t; 9]);
    for (found, to, parts) in [
        (
            "2.000000000e0 2.000000000e0 ",
            "2.000000000e0 ",
            vec!["ptfm.dat", "line 4", "a row of 9 columns", "time, x, y, z of point 2", "point 6"],
        ),
        ("2.000000000e0 2.000000000e0 ", "2.000000000e0 x ", vec!["line 4", "column 2 \"x\"", "finite number"]),
        ("2.000000000e0 2.000000000e0 ", "2.000000000e0 nan ", vec!["line 4", "column 2 \"nan\"", "finite number"]),
        ("2.000000000e0 2.000000000e0 ", "0.5 2.0 ", vec!["line 4", "t = 0.5", "times must rise"]),
        ("2.000000000e0 2.000000000e0 ", "2.000000000e0 900 ", vec!["line 4", "100 m/s"]),
        ("2.000000000e0 2.000000000e0 ", "# ", vec!["ptfm.dat"]),
    ] {
        let text = good.replacen(found, to, 1);
        let text = if to == "# " { text.lines().take(2).collect::<Vec<_>>().join("\n") } else { text };
        std::fs::write(place.join("ptfm.dat"), text).expect("written");
        let message = refused(&driver(&[]));
        println!("{message}");
        parts.iter().for_each(|part| assert!(message.contains(part), "{to}: {message:?} has no {part:?}"));
    }
    std::fs::write(place.join("ptfm.dat"), good).expect("written");
    std::fs::write(place.join("deck of it.txt"), SECOND.replace(" Coupled ", " Fixed ")).expect("written");
    let message = refused(&driver(&[]));
    assert!(message.contains("ptfm.dat") && message.contains("nothing in the MoorDyn file is coupled"), "{message}");
    for arguments in [&["run", "--motion", "ptfm.dat"][..], &["run", "md_driver.inp", "--motion", "ptfm.dat"]] {
        std::fs::write(place.join("md_driver.inp"), driver(&[])).expect("written");
        let output = program::moorline(&place, arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains("--motion"), "{output:?}");
    }
}

/// The wave number that goes with a frequency by linear theory, by bisection: k of ω² = g k tanh(k d).
fn number_of_wave(omega: f64, depth: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..200 {
        let k = 0.5 * (low + high);
        if GRAVITY * k * (k * depth).tanh() < omega * omega { low = k } else { high = k }
    }
    0.5 * (low + high)
}

/// Elevation, and velocity and acceleration along x, y and z at a place after Wheeler, of rows of frequency, complex amplitude and direction. `sine`: as
/// WaveKin 7 has them, η = |A| sin(ω t - k·x + arg A), else as WaveKin 2, with the cosine. Airy's formulas, from a textbook.
fn airy(rows: &[[f64; 4]], sine: bool, depth: f64, [x, y, z]: [f64; 3], time: f64) -> (f64, [f64; 6]) {
    let phase = |[omega, real, imaginary, beta]: &[f64; 4], k: f64| {
        let shift = if sine { 0.0 } else { std::f64::consts::FRAC_PI_2 };
        omega * time - k * (x * beta.cos() + y * beta.sin()) + imaginary.atan2(*real) + shift
    };
    let surface: f64 = rows.iter().map(|row| row[1].hypot(row[2]) * phase(row, number_of_wave(row[0], depth)).sin()).sum();
    let above = (z + depth) * depth / (depth + surface);
    let mut flow = [0.0; 6];
    for row in rows {
        let (omega, size, k) = (row[0], row[1].hypot(row[2]), number_of_wave(row[0], depth));
        let (sine, cosine) = phase(row, k).sin_cos();
        let level = size * omega * (k * above).cosh() / (k * depth).sinh();
        let upright = size * omega * (k * above).sinh() / (k * depth).sinh();
        for (axis, along) in [row[3].cos(), row[3].sin()].into_iter().enumerate() {
            flow[axis] += level * sine * along;
            flow[3 + axis] += level * omega * cosine * along;
        }
        flow[2] += upright * cosine;
        flow[5] -= upright * omega * sine;
    }
    (surface, flow)
}

/// The waves of files beside a deck are those of the same sum, made apart from the solver, at nodes of a line: WaveKin 7 as they stand, also two of one
/// frequency, WaveKin 2 put on even frequencies, which the rows of the test need not be, WaveKin 3 through the samples of the record.
#[test]
fn waves_of_files_beside_a_deck_are_their_sum() {
    let place = program::directory("waves");
    let sea = |kind: &str, name: &str, text: &str| {
        std::fs::write(place.join(name), text).expect("written");
        let deck = edited("90      WtrDpth", &format!("{kind} WaveKin\n0.5 dtWave\n90      WtrDpth"));
        let at_once = [String::from("environment.waves.ramp=0")];
        let loaded = parse(&deck, "deck.txt", &place, &at_once).unwrap_or_else(|error| panic!("{error}"));
        Waves::of(&loaded.scene.environment).expect("waves").one_by_one()
    };
    let (nodes, late) = ([[12.0, -7.0, -4.0], [-150.0, 40.0, -30.0], [-290.0, 200.0, -80.0]], 1.0e3);
    let same = |waves: &Waves, rows: &[[f64; 4]], sine: bool| {
        for step in 0..40 {
            let time = late + 0.37 * f64::from(step);
            for node in nodes {
                let (surface, flow) = airy(rows, sine, 90.0, node, time);
                let clock = Clock { now: time, start: 0.0 };
                assert!((waves.elevation(&clock, node[0], node[1]) - surface).abs() < 1e-9, "η at {node:?}, {time}");
                let found = waves.motions(&clock, 1, &node.map(|x| [x; 8]));
                for (way, expected) in flow.iter().enumerate() {
                    assert!(
                        (found[way][0] - expected).abs() < 1e-8,
                        "way {way} at {node:?}, {time}: {} {expected}",
                        found[way][0]
                    );
                }
            }
        }
    };
    let text = "0.0 0.0 0.0\n0.35 1.0 0.0 0.0\n0.8 -0.2 0.6 -1.1\n0.8 0.1 0.3 2.0\n";
    let rows = [[0.35, 1.0, 0.0, 0.0], [0.8, -0.2, 0.6, -1.1], [0.8, 0.1, 0.3, 2.0]];
    same(&sea("7", "wave_frequencies.txt", text), &rows, true);

    // Least difference 0.2: 0.2, 0.4, 0.6, 0.8, 1.0, the third and fourth of them between rows.
    let text = "0.0 0.0 0.0\n0.2 0.5 0.1 0.3\n0.4 0.9 -0.3 0.3\n1.0 0.3 0.3 0.9\n";
    let rows = [[0.2, 0.5, 0.1, 0.3], [0.4, 0.9, -0.3, 0.3], [0.6, 0.7, -0.1, 0.5], [0.8, 0.5, 0.1, 0.7], [1.0, 0.3, 0.3, 0.9]];
    same(&sea("2", "wave_frequencies.txt", text), &rows, false);

    // A record of whole periods, given every 0.25 s, sampled every 0.5 s: 2 sin(2π t/10) comes back as it was.
    let record =
        |n: i32| format!("{:.2} {:.12}", 0.25 * f64::from(n), 2.0 * (std::f64::consts::TAU * 0.025 * f64::from(n)).sin());
    let text = (0..=160).map(record).collect::<Vec<_>>().join("\n");
    let omega = std::f64::consts::TAU / 10.0;
    same(&sea("3", "wave_elevation.txt", &text), &[[omega, 2.0, 0.0, 0.0]], true);
}

/// Two lines that a free rod of no length joins are one: a cable in three parts hangs and moves as the same cable in one, whatever the order of
/// the rods; what the file asks for by the numbers of its parts is found there, and at a joint both sides have one place and one tension.
#[test]
fn rods_of_no_length_make_one_line() {
    let place = program::directory("joints");
    let head = "a cable in parts\n---- LINE TYPES ----\nn d m EA BA EI Cd Ca CdAx CaAx\n(-) (m)\n\
                cable 0.1 30 2e7 -0.8 4e4 1 1 0.1 0\n";
    let rods = |first: u32, second: u32| {
        format!(
            "---- ROD TYPES ----\nn d m Cd Ca CdEnd CaEnd\n(-) (m)\nconn 0.1 30 1 1 1 1\n---- RODS ----\nID\n(#)\n\
             {first} conn Free 30 0 -40 30 0 -40 0\n{second} conn Free 10 0 -30 10 0 -30 0\n"
        )
    };
    let points = "---- POINTS ----\nID type X\n(#) (-) (m)\n1 Fixed 60 0 -60 0 0 0 0\n2 Coupled 0 0 -5 0 0 0 0\n";
    let tail =
        |outputs: &str| format!("---- OPTIONS ----\n100 WtrDpth\n0.5 dtOut\n---- OUTPUTS ----\n{outputs}\n---- end ----\n");
    // Line 3 is the lowest; its numbers do not rise with the height.
    let parts = |rods: &str, asked: &str| {
        format!(
            "{head}{rods}{points}---- LINES ----\nID\n(#)\n1 cable R4B 2 30 6\n2 cable R7B R4A 25 5\n3 cable 1 R7A 35 7\n{}",
            tail(asked)
        )
    };
    let whole = format!(
        "{head}{points}---- LINES ----\nID\n(#)\n1 cable 1 2 90 18\n{}",
        tail("FairTen1 AnchTen1 L1N7PX L1N7PZ L1N12T Con1FX")
    );
    let asked = "FairTen1 AnchTen3 L3N7PX L2N0PZ L1N0T Con1FX FairTen3 AnchTen2 L2NAPX L3N3PX";
    let columns = |name: &str, text: &str| -> Vec<Vec<f64>> {
        std::fs::write(place.join(name), text).expect("written");
        let moving = r#"bodies[0].motion={"kind":"sinusoidal","period":8,"ramp":8,"sine":[1.0,0,1.0,0,0,0]}"#;
        let output = program::moorline(&place, &["run", name, "-o", "out", "--set", "run.duration=12", "--set", moving]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let out = program::read(&place.join("out").join(Path::new(name).with_extension("out")));
        out.lines().skip(2).map(|row| row.split('\t').map(|x| x.parse().expect("a number")).collect()).collect()
    };
    let one = columns("whole.txt", &whole);
    for (name, rods) in [("up.txt", rods(7, 4)), ("down.txt", rods(4, 7).replace("30 0 -40", "9 0 -9"))] {
        let several = columns(name, &parts(&rods, asked));
        assert_eq!(several.len(), one.len());
        for (row, own) in several.iter().zip(&one) {
            for column in 1..=6 {
                let allowed = if matches!(column, 3 | 4) { 1e-3 } else { 2e-3 * own[1] };
                assert!((row[column] - own[column]).abs() < allowed, "{name}, column {column}: {row:?} {own:?}");
            }
            assert!((row[7] - row[8]).abs() < 1e-6 * row[7], "one tension at the joint: {row:?}");
            assert!((row[9] - row[3]).abs() < 1e-9, "one place of the joint: {row:?}");
            assert!(row[10] > row[3] && row[10] < 60.0, "a node of the lowest part: {row:?}");
        }
    }
    let loaded = parse(&parts(&rods(7, 4), asked), "deck.txt", &place, &[]).unwrap_or_else(|error| panic!("{error}"));
    let lengths: Vec<f64> = loaded.scene.lines[0].sections.iter().map(|section| section.length).collect();
    assert_eq!((loaded.scene.lines.len(), lengths), (1, vec![30.0, 25.0, 35.0]));
    assert!(
        loaded.warnings.iter().any(|warning| warning.contains("line3 goes on as a section of line1")),
        "{:?}",
        loaded.warnings
    );
    // Two ends on one side, and lines in a ring, are refused.
    let refused = |changes: &[(&str, &str)]| {
        message(&changes.iter().fold(parts(&rods(7, 4), asked), |text, (from, to)| text.replace(from, to)))
    };
    assert!(refused(&[("R7B R4A", "R7A R4A")]).contains("joins two lines"));
    let ring = refused(&[("1 cable R4B 2", "1 cable R4B R7A"), ("3 cable 1 R7A", "3 cable 1 2")]);
    assert!(ring.contains("go round in a ring"), "{ring}");
}

/// What is wrong with a file of waves is said with its name, line and what is expected.
#[test]
fn faults_of_files_of_waves_are_named() {
    let place = program::directory("bad-waves");
    let refused = |kind: &str, text: &str| {
        let name = if kind == "3" { "wave_elevation.txt" } else { "wave_frequencies.txt" };
        std::fs::write(place.join(name), text).expect("written");
        let deck = edited("90      WtrDpth", &format!("{kind} WaveKin\n90      WtrDpth"));
        let error = parse(&deck, "deck.txt", &place, &[]).expect_err(text);
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(error.to_string().contains(name), "{error}");
        error.to_string()
    };
    for (kind, text, part) in [
        ("7", "0.1 1 0\n0.2 1 0\n", "line 1"),
        ("7", "0 0 0\n0.2 1\n", "2 of the 3 values"),
        ("7", "0 0 0\n0.2 one 0\n", "1 of the 3 values"),
        ("7", "0 0 0\n0.2 1 0 90\n", "direction in rad"),
        ("7", "0 1 0\n0.2 1 0\n", "no amplitude at frequency 0"),
        ("7", "0 0 0\n", "needs 2 rows"),
        ("7", "0 0 0\n0.4 0 0\n", "no row has an amplitude"),
        ("2", "0 0 0\n0.4 1 0\n0.4 1 0\n", "a larger frequency"),
        ("3", "0 0\n1 1\n1 2\n", "a later time"),
        ("3", "0 0\n1 1\n", "at least 16 rows"),
        ("3", "time eta\n", "no row of time and elevation"),
    ] {
        let message = refused(kind, text);
        println!("{message}");
        assert!(message.contains(part), "{text:?}: {message:?} has no {part:?}");
    }
}

/// What `convert` writes is the scene again: statics of examples of every kind are the same, to the difference of their meshes and of a bed
/// that is one for all lines.
#[test]
fn a_scene_and_its_deck_have_the_same_tensions() {
    let place = program::directory("written");
    let examples = [
        ("calm-buoy", 1e-4),
        ("calm-line", 1e-4),
        ("clump-weight", 1e-4),
        ("crowfoot", 1e-4),
        ("lazy-wave", 1e-4),
        ("lindahl-sjoberg", 1e-4),
        ("riser-with-bending", 1e-4),
        ("semi-submersible", 1e-4),
        ("spread-moored-ship", 1e-4),
        ("taut-polyester", 1e-4),
        ("two-lines-in-current", 1e-4),
        ("wave-energy-floats", 1e-4),
    ];
    for (name, tolerance) in examples {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(format!("{name}.json"));
        let own = load(&scene, &[]).unwrap_or_else(|error| panic!("{error}"));
        let deck = place.join(format!("{name}.txt"));
        let output = program::moorline(&place, &["convert", &scene.display().to_string(), &deck.display().to_string()]);
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let written = load(&deck, &[]).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (tops, found) = (settled(&own).1, settled(&written).1);
        // Pieces of a line follow each other from its fairlead; the first of each has its tension.
        let whole = own.scene.lines.len() == written.scene.lines.len();
        let lines = &written.scene.lines;
        let goes_on = |index: usize| {
            index > 0 && lines[index].fairlead_on.is_some() && lines[index - 1].anchor_on == lines[index].fairlead_on
        };
        let mut first = found.iter().enumerate().filter(|(index, _)| whole || !goes_on(*index));
        for line in &tops {
            let (_, other) = first.next().unwrap_or_else(|| panic!("{name}: a line is lost"));
            assert_close(name, other.tension, line.tension, tolerance);
        }
    }
}

/// A deck of the buoy, with its table, current and products of inertia apart, means the same scene as the deck that it came from; a slope goes
/// into a grid and back.
#[test]
fn a_deck_is_written_as_it_is_read() {
    let place = program::directory("again");
    for name in ["buoy.txt", "rope.dat", "current_profile.txt"] {
        std::fs::copy(directory().join(name), place.join(name)).expect("copied");
    }
    let convert = |from: &str, to: &str| {
        let output = program::moorline(&place, &["convert", from, to]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let told = convert("buoy.txt", "again.txt");
    assert!(told.contains("products of inertia") && told.contains("again.hawser.dat is beside it"), "{told}");
    let (one, other) = (load(&place.join("buoy.txt"), &[]), load(&place.join("again.txt"), &[]));
    let scene = |loaded: Result<Loaded, moorline::error::Error>| {
        let mut scene = loaded.unwrap_or_else(|error| panic!("{error}")).scene;
        scene.line_types.values_mut().for_each(|of| of.damping = (of.damping * 1e12).round());
        scene.environment.seabed.damping = scene.environment.seabed.damping.round();
        for body in &mut scene.bodies {
            body.inertia =
                body.inertia.as_ref().map(|inertia| Inertia::Principal(inertia.matrix().diagonal().map(|x| x.round()).into()));
            body.quadratic_damping = body.quadratic_damping.map(|drag| drag.map(f64::round));
        }
        scene
    };
    assert_eq!(scene(one), scene(other));

    let sloping = edited("90      WtrDpth", "90      WtrDpth").replace("-90.0", "-70.0");
    let mut value = without_title(&parse(&sloping, "deck.txt", &place, &[]).unwrap_or_else(|error| panic!("{error}")));
    value["environment"]["seabed"]["slope_deg"] = json!([1.0, -0.5]);
    std::fs::write(place.join("slope.json"), value.to_string()).expect("written");
    convert("slope.json", "slope.txt");
    let bed = load(&place.join("slope.txt"), &[]).unwrap_or_else(|error| panic!("{error}")).scene.environment;
    assert_close("depth", bed.depth, 90.0, 1e-9);
    assert_close("slope along x", bed.seabed.slope_deg[0], 1.0, 1e-9);
    assert_close("slope along y", bed.seabed.slope_deg[1], -0.5, 1e-9);

    // What cannot be held is refused by its place.
    let output =
        program::moorline(&place, &["convert", concat!(env!("CARGO_MANIFEST_DIR"), "/examples/moored-buoy.json"), "no.txt"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(told.contains("lines[0].constraints") && told.contains("a MoorDyn file cannot hold this"), "{told}");
}
