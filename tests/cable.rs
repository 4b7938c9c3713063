//! CABLE files (Ma & Webster 1994): read, written, turned into scenes and back, refused with line and column.

mod support;

use moorline::scene::cable::{Deck, Job, MotionKind, forced_motion, from_scene, reading, to_scene, turned, turned_back, writing};
use moorline::scene::read::{Loaded, load, parse};
use moorline::scene::types::{Motion, Scene, Stretch, Surface};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

const STATIC: &str = include_str!("../examples/cable-1994/static-with-bottom.dat");
const HANGING: &str = include_str!("../examples/cable-1994/static-without-bottom.dat");
const DYNAMIC: &str = include_str!("../examples/cable-1994/dynamic.dat");

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cable-1994")
}

fn deck(text: &str) -> Deck {
    reading::read(text, "deck.dat").unwrap_or_else(|error| panic!("{error}")).deck
}

fn loaded(text: &str, sets: &[&str]) -> Loaded {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    parse(text, "deck.dat", &directory(), &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// The message with which a text is refused; it must mean exit code 2.
fn message(text: &str, case: &str) -> String {
    match reading::read(text, "deck.dat") {
        Ok(_) => panic!("accepted: {case}"),
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{case}: {error}");
            error.to_string()
        }
    }
}

/// Replaces a passage of the dynamic example, which must stand there once.
fn edited(from: &str, to: &str) -> String {
    assert_eq!(DYNAMIC.matches(from).count(), 1, "{from:?} must stand once in the dynamic example");
    DYNAMIC.replacen(from, to, 1)
}

/// Source: every digit of the report's static print-out that can be read (nodes 1 to 4, data file of the repaired print-out), its
/// parameters, and the 40 elements of 30 m.
#[test]
fn the_static_example_has_every_legible_digit_of_the_print() {
    let deck = deck(STATIC);
    let node = |number: usize| deck.nodes[number - 1];
    assert_eq!((node(1).position, node(1).slope), ([0.00002, 0.0, 0.0], [0.89855, -0.44488, 0.0]));
    assert_eq!(node(1).lambda, 1.32931e6);
    assert_eq!(node(2).position, [27.1107, -13.02786, 0.0]);
    assert_eq!((node(3).lambda_before, node(3).lambda), (1.30715e6, 1.30015e6));
    assert_eq!((node(4).position, node(4).slope), ([82.22988, -37.10792, 0.0], [0.9283, -0.37867, 0.0]));
    assert_eq!((deck.nodes.len(), deck.elements.len(), deck.types.len(), deck.dimensions), (41, 40, 1, 3));
    assert!(deck.elements.iter().all(|element| element.length == 30.0 && element.kind == 0));
    let of = &deck.types[0];
    assert_eq!((of.young, of.area, of.cavity, of.inertia), (5.5109e10, [9.07292e-3; 3], [0.0; 3], [0.0; 3]));
    assert_eq!((of.outermost, of.mass, of.diameter, of.buoyancy), ([0.228; 3], [135.35; 3], [0.076; 3], [170.171; 3]));
    assert_eq!((deck.water_density, deck.inner_density, deck.gravity, deck.bottom), (1000.0, 0.0, 9.80665, -120.0));
    assert_eq!((deck.drag, deck.added_mass, deck.damping, deck.relaxation), (1.0, 3.8, 4.0e-4, 0.2));
    assert_eq!((deck.job, deck.wave_amplitude, deck.currents.len()), (Job::Statics, 0.0, 4));
    for (row, depth) in deck.currents.iter().zip([0.0, -40.0, -80.0, -120.0]) {
        assert_eq!(*row, (depth, [0.0; 3]));
    }
}

/// Source: the report's dynamic print-out: times, steps, and the forcing that its velocities prove (T = 15 s, 5.08 m along x and
/// 2.1 m along z, both in phase).
#[test]
fn the_dynamic_example_starts_from_the_static_one() {
    let (at_rest, moving) = (deck(STATIC), deck(DYNAMIC));
    assert_eq!(moving.nodes, at_rest.nodes);
    assert_eq!((moving.job, moving.snapshot_every, moving.iterations), (Job::Dynamics, 50, 1201));
    assert_eq!((moving.begin, moving.end, moving.step, moving.levels()), (0.0, 120.0, 0.1, 1201));
    let top = &moving.constraints[0];
    assert_eq!((top.node, top.stiffness, top.sine, top.cosine), (0, [1.0e11; 3], [5.08, 0.0, 2.1], [0.0; 3]));
    assert_eq!(top.frequency, 0.4188790205);
    assert!(deck(HANGING).bottom < -1000.0);
    assert!(
        deck(HANGING).nodes.iter().any(|node| node.position[1] < -120.0),
        "the line hangs below the bottom that is not there"
    );
}

/// The scene of the dynamic example is the built-in one: the same line, turned by the axes and with the report's law.
#[test]
fn the_scene_of_the_dynamic_example_is_the_built_in_one() {
    let scene = to_scene::meaning(&deck(DYNAMIC)).scene;
    let chain = &scene.line_types["chain"];
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-6 * b.abs(), "{a} {b}");
    close(chain.ea, 5.0e8);
    close(chain.weight_in_water(1000.0, 9.80665), 1157.1590775);
    close(scene.environment.seabed.stiffness.unwrap_or_default(), 5075.2591);
    assert_eq!((chain.mass, chain.diameter, chain.damping), (135.35, 0.076, 4.0e-4));
    assert_eq!((chain.drag.normal, chain.added_mass.normal, chain.outer_area), (1.0, 3.8, Some(9.07292e-3)));
    assert_eq!((scene.environment.depth, scene.environment.surface), (120.0, Surface::None));
    let line = &scene.lines[0];
    assert_eq!((line.fairlead, line.anchor), ([0.00002, 0.0, 0.0], [1183.97, 0.0, -120.0]));
    assert_eq!((line.sections.len(), line.sections[0].length, line.sections[0].elements), (1, 1200.0, Some(40)));
    assert_eq!(scene.motion, Motion::Sinusoidal { period: 15.0, sine: [5.08, -2.1, 0.0], cosine: [0.0; 3], ramp: None });
    assert_eq!((scene.run.duration, scene.run.output_step, scene.run.start), (120.0, 0.1, 0.0));
    assert_eq!(
        (scene.solver.stretch, scene.solver.hydrostatic_strain, scene.solver.fixed_step),
        (Some(Stretch::Report), true, None)
    );
    assert!(line.constraints.is_empty(), "both ends are pinned");
    assert_eq!(to_scene::meaning(&deck(STATIC)).scene.run.duration, 0.0, "JOB = 1 is statics only");
}

/// Right stays right: the turn from the file's axes to the scene's is a rotation, and undone by its inverse.
#[test]
fn the_axes_turn_without_a_mirror() {
    let [x, y, z] = [turned([1.0, 0.0, 0.0]), turned([0.0, 1.0, 0.0]), turned([0.0, 0.0, 1.0])];
    assert_eq!(y, [0.0, 0.0, 1.0], "y up is z up");
    assert_eq!([x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]], z);
    assert_eq!(turned_back(turned([1.0, 2.0, 3.0])), [1.0, 2.0, 3.0]);
}

/// The output of 1994 is an input, character for character.
#[test]
fn what_is_written_is_what_was_read() {
    for text in [STATIC, HANGING, DYNAMIC] {
        assert_eq!(writing::text(&deck(text)), text);
    }
}

/// A file with all four categories in use: two types, one hollow and stiff, an oblique spring, a mass, currents, waves.
fn full(dimensions: usize) -> Deck {
    let mut deck = deck(DYNAMIC);
    let flat = |v: [f64; 3]| if dimensions == 2 { [v[0], v[1], 0.0] } else { v };
    deck.dimensions = dimensions;
    deck.inner_density = 800.0;
    deck.begin = 2.5;
    deck.types.push(deck.types[0].clone());
    deck.types[1].name = Some("pipe: steel".into());
    deck.types[1].cavity = [1.0e-3; 3];
    deck.types[1].inertia = [2.5e-6; 3];
    deck.types[1].mass = [70.0, 72.0, 74.0];
    deck.elements.iter_mut().skip(20).for_each(|element| element.kind = 1);
    deck.elements[3].length = 12.3457;
    for (k, node) in deck.nodes.iter_mut().enumerate() {
        node.velocity = flat([k as f64 / 100.0, -0.5, 0.25]);
        node.slope_rate = flat([0.001, 0.0, -(k as f64) / 2000.0]);
    }
    let mut middle = deck.constraints[0].clone();
    middle.node = 10;
    middle.axes = if dimensions == 2 { [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]] } else { [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0]] };
    middle.stiffness = flat([2000.0, 0.0, 1.0e11]);
    middle.damping = flat([30.0, 0.5, 0.0]);
    middle.force = flat([10.0, -2.5e4, 3.0]);
    middle.mass = 500.0;
    (middle.sine, middle.cosine, middle.frequency) = ([0.0; 3], [0.0; 3], 0.0);
    deck.constraints.insert(1, middle);
    deck.constraints.iter_mut().for_each(|of| of.stiffness = flat(of.stiffness));
    deck.constraints[0].sine = flat(deck.constraints[0].sine);
    deck.constraints[0].cosine = flat([0.0, 0.125, -0.5]);
    deck.currents = vec![(0.0, flat([1.0, 0.0, 0.5])), (-50.0, flat([0.25, 0.0, -0.125]))];
    (deck.wave_amplitude, deck.wave_frequency, deck.wave_direction) = (1.5, 0.7, if dimensions == 2 { 0.0 } else { 0.5 });
    deck
}

#[test]
fn files_in_two_and_three_dimensions_with_everything_in_them_survive_writing() {
    for dimensions in [2, 3] {
        let deck = full(dimensions);
        let text = writing::text(&deck);
        assert_eq!(self::deck(&text), deck, "{text}");
    }
}

/// From a file to its scene and back all that both can say is the same: to the six digits of `1PE11.5`.
#[test]
fn file_to_scene_to_file_keeps_what_a_scene_can_hold() {
    for dimensions in [2, 3] {
        let before = full(dimensions);
        let meaning = to_scene::meaning(&before);
        let file = from_scene::deck(&meaning.scene, &meaning.state, "scene.json").unwrap_or_else(|error| panic!("{error}")).deck;
        let after = deck(&writing::text(&file));
        assert_eq!(after.nodes, before.nodes);
        assert_eq!(after.elements, before.elements);
        assert_eq!(after.currents, before.currents);
        assert_eq!((after.job, after.begin, after.end, after.step), (before.job, before.begin, before.end, before.step));
        assert_eq!((after.drag, after.added_mass, after.damping), (before.drag, before.added_mass, before.damping));
        assert_eq!((after.water_density, after.inner_density, after.gravity), (1000.0, 800.0, 9.80665));
        assert_eq!((after.wave_amplitude, after.wave_frequency), (before.wave_amplitude, before.wave_frequency));
        assert!((after.wave_direction - before.wave_direction).abs() < 1e-6);
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-5 * b.abs(), "{a} {b}");
        for (after, before) in after.types.iter().zip(&before.types) {
            assert_eq!((after.area, after.cavity, after.diameter), (before.area, before.cavity, before.diameter));
            assert_eq!(after.name, before.name);
            close(after.young, before.young);
            for (a, b) in [(after.mass, before.mass), (after.outermost, before.outermost), (after.inertia, before.inertia)] {
                close(a[0], b[1]);
            }
        }
        // In 2-D the scene holds the spring's node in the plane by its geometry alone; the file comes back with a third dimension.
        for (after, before) in after.constraints.iter().zip(&before.constraints) {
            assert_eq!(after.node, before.node);
            assert_eq!((after.sine, after.cosine, after.frequency), (before.sine, before.cosine, before.frequency));
            assert_eq!((after.force, after.mass), if before.node == 10 { (before.force, before.mass) } else { ([0.0; 3], 0.0) });
            let (locked, springs) = (after.stiffness.map(reading::locks), before.stiffness.map(reading::locks));
            assert!((0..dimensions).all(|k| locked[k] == springs[k]), "{after:?}");
        }
    }
}

/// A scene that a file can hold comes back as it was.
#[test]
fn scene_to_file_to_scene_keeps_everything_it_promises() {
    let meaning = to_scene::meaning(&deck(DYNAMIC));
    let mut scene = meaning.scene;
    scene.title = "A line that a file can hold".into();
    scene.environment.current =
        serde_json::from_str(r#"[{"z": 0.0, "velocity": [0.5, 0.25, 0.0]}, {"z": -60.0, "velocity": [0.125, 0.0, 0.0]}]"#)
            .unwrap();
    scene.environment.waves =
        Some(serde_json::from_str(r#"{"kind": "regular", "amplitude": 1, "period": 10, "ramp": 0}"#).unwrap());
    scene.motion = Motion::Sinusoidal { period: 12.0, sine: [1.0, 0.5, -0.25], cosine: [0.0, 0.0, 0.125], ramp: None };
    let written = from_scene::deck(&scene, &meaning.state, "scene.json").unwrap_or_else(|error| panic!("{error}"));
    let read = reading::read(&writing::text(&written.deck), "scene.dat").unwrap_or_else(|error| panic!("{error}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let mut back = to_scene::meaning(&read.deck).scene;
    let (ea, before) = (back.line_types["chain"].ea, scene.line_types["chain"].ea);
    assert!((ea - before).abs() <= 5e-6 * before);
    for (name, of) in &scene.line_types {
        if let Some(back) = back.line_types.get_mut(name) {
            back.ea = of.ea;
        }
    }
    let (bed, before) =
        (back.environment.seabed.stiffness.unwrap_or_default(), scene.environment.seabed.stiffness.unwrap_or_default());
    assert!((bed - before).abs() <= 5e-6 * before);
    back.environment.seabed = scene.environment.seabed.clone();
    let json = |scene: &Scene| serde_json::to_string_pretty(scene).unwrap();
    assert_eq!(json(&back), json(&scene));
    assert_eq!(written.losses.len(), 1, "only the solver's own settings are lost: {:?}", written.losses);
}

/// What a file cannot hold is said, place by place.
#[test]
fn what_a_file_cannot_hold_is_said() {
    let meaning = to_scene::meaning(&deck(DYNAMIC));
    let mut scene = moorline::scene::read::built_in(&[]).unwrap_or_else(|error| panic!("{error}")).scene;
    scene.environment.seabed.friction = 0.5;
    scene.environment.seabed.slope_deg = [1.0, 0.0];
    scene.line_types.get_mut("chain").unwrap().drag.tangential = 0.01;
    scene.motion = Motion::Sinusoidal { period: 10.0, sine: [1.0, 0.0, 0.0], cosine: [0.0; 3], ramp: Some(5.0) };
    let losses =
        from_scene::deck(&scene, &meaning.state, "scene.json").unwrap_or_else(|error| panic!("{error}")).losses.join("\n");
    for place in [
        "environment.seabed.friction: 0.5",
        "environment.seabed.slope_deg",
        "environment.surface",
        "line_types.chain.drag.tangential: 0.01",
        "motion.ramp: 5 s becomes 32.5 s",
        "solver.stretch",
        "solver.hydrostatic_strain",
        "lines[0].sections",
    ] {
        assert!(losses.contains(place), "{place} is missing in\n{losses}");
    }
    scene.lines.push(scene.lines[0].clone());
    let error = from_scene::deck(&scene, &meaning.state, "scene.json").map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("the scene has 2"), "{error}");
}

/// Texts left out, words for columns, other exponents: the same file.
#[test]
fn columns_and_texts_may_be_off() {
    let original = deck(DYNAMIC);
    let number = |line: &str| line.trim_start().starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let phrases = |line: &str, keep: fn(&str) -> bool| {
        let words: Vec<&str> = line.split_whitespace().take_while(|word| keep(word)).collect();
        words.join(" ")
    };
    let is_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    // Blank texts, no phrases, the columns kept.
    let bare: String = DYNAMIC
        .lines()
        .map(|line| match line {
            line if line.starts_with("Node No.") => format!("        {}\n", &line[8..]),
            line if line.starts_with("a. Currents") => format!("{}{}\n", " ".repeat(14), &line[14..17]),
            line if number(line) => {
                format!("{}\n", line.split(|c: char| c.is_alphabetic() && c != 'E').next().unwrap_or_default())
            }
            _ => "\n".to_string(),
        })
        .collect();
    let mut read = deck(&bare);
    read.title.clone_from(&original.title);
    read.types[0].name.clone_from(&original.types[0].name);
    assert_eq!(read, original);
    // Words instead of columns, no blank lines.
    let words: String = DYNAMIC
        .lines()
        .filter(|line| !line.trim().is_empty())
        .map(|line| if number(line) { phrases(line, is_number) + "\n" } else { format!("{line}\n") })
        .collect();
    let reading = reading::read(&words, "deck.dat").unwrap_or_else(|error| panic!("{error}"));
    let mut read = reading.deck;
    read.types[0].name.clone_from(&original.types[0].name);
    assert_eq!(read, original);
    assert!(reading.warnings.iter().any(|warning| warning.contains("not in the columns of 1994")), "{:?}", reading.warnings);
    // Exponents of other Fortrans.
    for exponent in ["D+10", "d10", "+10"] {
        assert_eq!(deck(&edited("5.51090E+10", &format!("{:<11}", format!("5.51090{exponent}")))), original, "{exponent}");
    }
    // Line ends of other systems.
    assert_eq!(deck(&DYNAMIC.replace('\n', "\r\n")), original);
}

/// A zero of the motion may be an empty line, as the 1994 program took it, where the lines are counted as it counted.
#[test]
fn empty_lines_and_columns_are_zeros() {
    let frequency = "   0.0000000000            motion frequency (rad/sec)\n";
    assert_eq!(deck(&edited(frequency, "\n")), deck(DYNAMIC));
    let wave = "  0.000000   0.00000       wave amplitude and frequency (rad/sec)\n 0.0000000                 wave direction relative to x axis\n";
    assert_eq!(deck(&edited(wave, "\n\n")), deck(DYNAMIC));
    let rows = DYNAMIC.replace("     0.00000     0.00000     0.00000       x-dot, y-dot and z-dot", "");
    assert_eq!(deck(&rows), deck(DYNAMIC));
}

/// The 1994 program put a point where none was written; here the number is taken as it stands, and that is said.
#[test]
fn a_number_without_a_point_is_taken_as_written_with_a_warning() {
    let reading = reading::read(
        &edited("   -120.00                           bottom", "      -120                           bottom"),
        "deck.dat",
    );
    let reading = reading.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reading.deck.bottom, -120.0);
    let warning = reading.warnings.join("\n");
    assert!(warning.contains("line 21, column 7: -120 has no decimal point") && warning.contains("-1.2"), "{warning}");
}

/// Edits of the dynamic example, and words of the message.
const BAD: &[(&str, &str, &[&str])] = &[
    ("  41       NODE", "   0       NODE", &["line 7, column 4, NODE", "0 is not allowed", "2 to"]),
    ("  41       NODE", "  4l       NODE", &["line 7, column 3, NODE", "`4l`", "expected a number"]),
    ("  41       NODE", "  -3       NODE", &["line 7", "-3 is not allowed"]),
    ("  41       NODE", "  40       NODE", &["deck.dat, line "]),
    ("  41       NODE", "  42       NODE", &["deck.dat, line 287", "node 42"]),
    ("  41       NODE", " 4.5       NODE", &["line 7", "4.5 is not allowed", "whole number"]),
    ("   1       NELTYP", "   0       NELTYP", &["line 8", "NELTYP", "0 is not allowed"]),
    ("   3       NDIM", "   4       NDIM", &["line 9", "NDIM", "2 to 3"]),
    ("   2       JOB", "   7       JOB", &["line 10", "JOB", "1 to 2"]),
    ("   2       NCNSTR", "  99       NCNSTR", &["line 13", "NCNSTR", "0 to 41"]),
    ("   0.20000   0.00040", "   0.20000  -0.00040", &["line 17, column 13", "DAMP", "must not be negative"]),
    ("   0.00000 120.00000   0.10000", "   0.00000 120.00000   0.00000", &["line 18, column 24", "TSTEP", "greater than zero"]),
    ("   0.00000 120.00000   0.10000", " 130.00000 120.00000   0.10000", &["line 18", "TEND", "TBGN = 130 s"]),
    ("   9.80665", "   9.8O665", &["line 20, column 24, RUF, RUI and G", "`9.8O665`"]),
    ("   -120.00   ", "      0.00   ", &["line 21, column 7, BTMDPTH", "0 is not allowed", "below zero"]),
    ("   -120.00   ", "       NaN   ", &["line 21, column 8, BTMDPTH", "NaN", "finite"]),
    ("   -120.00   ", "    120.00   ", &["line 21", "120 is not allowed", "y points up"]),
    ("   -120.00   ", "  1.0E+300   ", &["line 21", "1e15"]),
    (" 5.51090E+10", " 0.00000E+00", &["line 28", "EEL, Young's modulus of element type 1 of 1", "greater than zero"]),
    (" 5.51090E+10", " ***********", &["line 28, column 2", "asterisks", "too long"]),
    (" 9.07292E-03 9.07292E-03", " 9.07292E-03 0.00000E+00", &["line 30, column 14", "AFEL", "greater than zero"]),
    (
        " 1.35350E+02 1.35350E+02 1.35350E+02",
        " 1.35350E+02 1.3535OE+02 1.35350E+02",
        &["line 33, column 14", "MEL", "`1.3535OE+02`"],
    ),
    ("    27.11070   -13.02786", "    27.11.70   -13.02786", &["R, position of node 2", "`27.11.70`", "line 45, column 5"]),
    (" 1.32174E+06 1.31435E+06 ", " 1.32174E+06         Inf ", &["LAMBDA at node 2", "Inf", "finite"]),
    ("Node No. 41", "Node No. 42", &["NODEC", "42 is not allowed", "1 to 41"]),
    ("Node No. 41", "Node No.  1", &["NODEC", "second time"]),
    ("   0.4188790205 ", "   0.0000000000 ", &["FREQ, motion frequency at node 1", "greater than zero"]),
    ("  -80.0000    0.0000    0.0000", "  -40.0000    0.0000    0.0000", &["VC", "same depth"]),
    ("a. Currents at  4", "a. Currents at  5", &["VC, depth and current 5 of 5", "deck.dat, line "]),
    ("  0.000000   0.00000       wave", "  1.000000   0.00000       wave", &["SIGMAW", "greater than zero"]),
];

#[test]
fn every_bad_file_is_refused_with_line_and_column() {
    for (from, to, words) in BAD {
        let message = message(&edited(from, to), to);
        for word in words.iter().chain(&["deck.dat, line ", ", column "]) {
            assert!(message.contains(word), "\ncase:     {to}\nexpected: {word}\ngot:      {message}");
        }
    }
    let first = DYNAMIC.replacen("   30.0       1       from node  1", "   -1.0       1       from node  1", 1);
    assert!(message(&first, "length").contains("LNTHEL and JELTYP of the element from node 1 to 2: -1 is not allowed"));
    let first = DYNAMIC.replacen("   30.0       1       from node  1", "   30.0       2       from node  1", 1);
    assert!(message(&first, "type").contains("2 is not allowed: the element type must be one of 1 to 1"));
    let axes = DYNAMIC.replacen(
        "     1.00000     0.00000     0.00000         0.000    x",
        "     0.00000     0.00000     0.00000         0.000    x",
        1,
    );
    assert!(message(&axes, "axes").contains("REFCOS of node 1"), "{}", message(&axes, "axes"));
}

/// A file cut short at any line is refused where it ends; the last line alone can be spared of its phrase.
#[test]
fn a_file_cut_short_is_refused_where_it_ends() {
    let lines: Vec<&str> = DYNAMIC.lines().collect();
    for kept in 1..lines.len() {
        let text = lines[..kept].join("\n");
        let message = message(&text, &format!("{kept} lines"));
        assert!(message.contains("the file ends here") || message.contains("neither a scene"), "{kept}: {message}");
        let (line, _) = message.split_once("line ").and_then(|(_, rest)| rest.split_once(',')).expect("a line");
        assert!(line.parse::<usize>().is_ok_and(|line| line <= kept), "{kept}: {message}");
    }
}

/// The limits of 1994 are gone: 10 000 nodes and 12 types.
#[test]
fn ten_thousand_nodes_and_twelve_types_are_read() {
    let mut large = deck(STATIC);
    let (node, of) = (large.nodes[20], large.types[0].clone());
    large.nodes =
        (0..10_000).map(|k| moorline::scene::cable::DeckNode { position: [k as f64 / 10.0, -50.0, 0.0], ..node }).collect();
    large.types = vec![of; 12];
    large.types.iter_mut().for_each(|of| of.name = None);
    large.elements = (0..9_999).map(|k| moorline::scene::cable::DeckElement { kind: k % 12, length: 0.1 }).collect();
    large.constraints[1].node = 9_999;
    let text = writing::text(&large);
    assert_eq!(deck(&text), large);
    let loaded = loaded(&text, &[]);
    assert_eq!((loaded.scene.line_types.len(), loaded.scene.lines[0].sections.len()), (12, 9_999));
    assert_eq!(loaded.state.map(|state| state.nodes.len()), Some(10_000));
}

/// What is wrong with the scene of a file is said with the line of the file.
#[test]
fn the_check_of_a_scene_names_the_line_of_the_file() {
    // A bottom above the anchor.
    let text = edited("   -120.00   ", "   -100.00   ");
    let error = parse(&text, "deck.dat", &directory(), &[]).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("deck.dat, line 279, column 1, lines[0].anchor"), "{error}");
}

#[test]
fn a_file_is_known_by_its_content_and_sets_speak_of_its_scene() {
    let loaded = loaded(DYNAMIC, &["environment.depth=130", "run.duration=5"]);
    assert_eq!((loaded.scene.environment.depth, loaded.scene.run.duration), (130.0, 5.0));
    assert!(loaded.deck.is_some() && loaded.state.is_some());
    let titled = DYNAMIC.replacen("Dynamic analysis", "{Dynamic analysis", 1);
    assert!(reading::is_deck(&titled), "a title may begin like JSON");
    assert!(!reading::is_deck(include_str!("../examples/lindahl-sjoberg.json")));
    let error = load(Path::new("no-such.dat"), &[]).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("no-such.dat"), "{error}");
}

/// Held fast in all directions an end is pinned; else it becomes a constraint, along the same axes.
#[test]
fn ends_that_are_not_held_fast_become_constraints() {
    let mut free = deck(STATIC);
    free.constraints[1].stiffness = [1.0e4, 1.0e11, 0.0];
    free.constraints[1].reference = [1200.0, -110.0, 3.0];
    free.constraints[1].force = [0.0, 5.0, 1.0];
    let scene = to_scene::meaning(&free).scene;
    let [of] = scene.lines[0].constraints.as_slice() else { panic!("{:?}", scene.lines[0].constraints) };
    assert_eq!((of.s, of.axes), (1200.0, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]));
    assert_eq!((of.stiffness, of.locked), ([1.0e4, 0.0, 0.0], [false, true, false]));
    // Where it is locked the node stays where it is; where a spring pulls, the reference counts. Forces are global.
    assert_eq!((of.reference, of.force), (Some([1200.0, -3.0, -120.0]), [0.0, -1.0, 5.0]));
    free.constraints.remove(1);
    let scene = to_scene::meaning(&free).scene;
    assert_eq!(
        (scene.lines[0].constraints[0].s, scene.lines[0].constraints[0].locked),
        (1200.0, [false; 3]),
        "nothing holds the anchor"
    );
}

/// Source: the file's velocities, trapezoidal rule, quintic over 10π s; after that they count in full.
#[test]
fn forced_motion_is_the_integral_of_its_velocities() {
    let mut deck = deck(DYNAMIC);
    deck.motion = MotionKind::Forced;
    (deck.begin, deck.end, deck.step) = (40.0, 41.0, 0.5);
    let column = "1.0\n0.5\n0.25\n2.0\n0.0\n0.0\n1.0D0\n0.0\n-1.0\n";
    let rows = "1.0 0.5 0.25\n2.0, 0.0, 0.0\n\n1.0D0 0.0 -1.0\n9 9 9\n";
    for text in [column, rows] {
        let table = forced_motion::parse(text, "forcedmotion", &deck).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(table.times, [40.0, 40.5, 41.0]);
        assert_eq!(table.velocities, [[1.0, -0.25, 0.5], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        for (position, expected) in
            table.positions.iter().zip([[0.00002, 0.0, 0.0], [0.75002, -0.0625, 0.125], [1.50002, 0.1875, 0.125]])
        {
            (0..3).for_each(|k| assert!((position[k] - expected[k]).abs() < 1e-12, "{position:?}"));
        }
    }
    (deck.begin, deck.end) = (5.0 * std::f64::consts::PI, 5.0 * std::f64::consts::PI + 1.0);
    let table = forced_motion::parse(column, "forcedmotion", &deck).unwrap_or_else(|error| panic!("{error}"));
    assert!((table.velocities[0][0] - 0.5).abs() < 1e-12, "half way through the quintic is one half");
    for (text, words) in [
        ("1.0\n0.5\n", ["line 2", "the file ends here", "3 times"]),
        ("1.0\nx5\n", ["line 2, column 1", "`x5`", "a velocity"]),
        ("1.0 2.0\n", ["line 1", "2 of the 3 numbers", "column 1"]),
    ] {
        let error = forced_motion::parse(text, "forcedmotion", &deck).map(|_| ()).unwrap_err().to_string();
        words.iter().for_each(|word| assert!(error.contains(word), "{word}: {error}"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

    /// Whatever happens to a file, it is read or refused.
    #[test]
    fn no_mutation_of_a_file_makes_the_reader_panic(at in 0..DYNAMIC.len(), length in 0usize..200, with in "[ -~\n\té*]{0,12}") {
        let end = (at + length).min(DYNAMIC.len());
        let text = format!("{}{with}{}", &DYNAMIC[..at], &DYNAMIC[end..]);
        if let Err(error) = parse(&text, "deck.dat", &directory(), &[]) {
            prop_assert_eq!(error.exit_code(), 2, "{}", error);
            prop_assert!(!error.to_string().is_empty());
        }
    }

    /// Every number that fits its columns comes back from them.
    #[test]
    fn written_numbers_are_read_back(mantissa in -9.999f64..9.999, power in -3i32..6) {
        let value = mantissa * 10f64.powi(power);
        let mut deck = deck(STATIC);
        deck.currents[1].1[0] = value;
        deck.elements[2].length = value.abs().max(0.1);
        deck.types[0].mass = [value.abs().max(0.1); 3];
        let read = self::deck(&writing::text(&deck));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs();
        // Ten columns hold a sign, a digit, a point, three more digits and an exponent of four columns.
        prop_assert!((read.currents[1].1[0] - value).abs() <= 5e-4 * value.abs(), "{} {}", read.currents[1].1[0], value);
        prop_assert!(close(read.elements[2].length, value.abs().max(0.1)) || value.abs() < 1.0);
        prop_assert!(close(read.types[0].mass[0], value.abs().max(0.1)));
    }
}

/// The program itself, in an empty directory of its own.
mod program {
    use super::support::program::{directory, moorline, read};
    use super::{DYNAMIC, STATIC, deck};
    use moorline::scene::cable::{Deck, Job, writing};
    use std::path::Path;

    fn done(directory: &Path, arguments: &[&str]) -> (String, String) {
        let output = moorline(directory, arguments);
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        assert_eq!(output.status.code(), Some(0), "{err}");
        (out, err)
    }

    fn write(directory: &Path, name: &str, text: &str) {
        std::fs::write(directory.join(name), text).expect("a file for the test");
    }

    /// Rows of a table of numbers, without its header.
    fn rows(text: &str) -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split(',').map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>();
        text.lines().filter_map(numbers).collect()
    }

    /// Source: the report's static print-out: every digit that can be read comes out of the run of its file.
    #[test]
    fn the_run_of_the_static_file_prints_the_legible_digits_of_the_report() {
        let here = directory("static");
        write(&here, "static.dat", STATIC);
        let (_, warnings) = done(&here, &["run", "static.dat", "-o", "out", "--set", "solver.scheme=cable-1994"]);
        assert_eq!(warnings, "");
        let output = deck(&read(&here.join("out/output.dat")));
        let node = |number: usize| output.nodes[number - 1];
        assert_eq!((node(1).slope[..2].to_vec(), node(1).lambda), (vec![0.89855, -0.44488], 1.32931e6));
        assert_eq!(node(2).position[..2], [27.1107, -13.02786]);
        assert_eq!((node(3).lambda_before, node(3).lambda), (1.30715e6, 1.30015e6));
        assert_eq!((node(4).position[0], node(4).slope[..2].to_vec()), (82.22988, vec![0.9283, -0.37867]));
        // The print has -37.10792 here; the same equations solved again give -37.107925.
        assert!((node(4).position[1] + 37.10792).abs() < 1.1e-5, "{:?}", node(4).position);
        assert_eq!(rows(&read(&here.join("out/timeseries.csv"))).len(), 1, "JOB = 1 is statics only");
        // An output is an input, and changes no more.
        done(&here, &["run", "out/output.dat", "-o", "again", "--quiet", "--set", "solver.scheme=cable-1994"]);
        assert_eq!(read(&here.join("again/output.dat")), read(&here.join("out/output.dat")));
    }

    #[test]
    fn the_run_of_a_dynamic_file_leaves_the_files_of_1994() {
        let here = directory("dynamic");
        let short = Deck { end: 2.0, snapshot_every: 10, ..deck(DYNAMIC) };
        write(&here, "deck.dat", &writing::text(&short));
        let (_, warnings) = done(&here, &["run", "deck.dat", "-o", "out", "--set", "solver.scheme=cable-1994"]);
        assert!(!warnings.contains("equilibrium"), "{warnings}");
        let time_series = read(&here.join("out/timeseries"));
        assert_eq!(time_series.lines().count(), 21);
        let last = time_series.lines().last().unwrap_or_default();
        assert_eq!((last.len(), &last[..8]), (8 + 7 * 12, "   2.000"), "F8.3 and seven times 1PE12.5");
        let number = |k: usize| last[8 + 12 * k..20 + 12 * k].trim().parse::<f64>().expect("a number");
        let table = rows(&read(&here.join("out/timeseries.csv")));
        let [time, x, y, z, tension] = [0, 1, 2, 3, 4].map(|k| table[20][k]);
        assert_eq!(time, 2.0);
        assert!((number(0) - x).abs() < 1e-6 && (number(1) - z).abs() < 1e-6 && (number(2) + y).abs() < 1e-6, "{last}");
        let slope = number(3).hypot(number(4)).hypot(number(5));
        assert!((number(6) * slope / tension - 1.0).abs() < 1e-5, "λ times the length of the slope is the tension: {last}");
        let snapshots = read(&here.join("out/snapshot"));
        for step in ["#    0  (time =      0.000 s)", "#   10  (time =      1.000 s)", "#   20  (time =      2.000 s)"] {
            assert!(snapshots.contains(&format!(" Snapshot at Iteration {step}")), "{step} is missing in\n{snapshots}");
        }
        let output = deck(&read(&here.join("out/output.dat")));
        assert_eq!(Deck { nodes: Vec::new(), ..output.clone() }, Deck { nodes: Vec::new(), ..short.clone() });
        assert!((output.nodes[0].position[0] - x).abs() < 1e-5 && (output.nodes[0].position[2] + y).abs() < 1e-5);
        assert!(output.nodes[0].velocity[0] != 0.0 && output.nodes[40].position == short.nodes[40].position);
        for file in ["summary.json", "nodes.csv", "report.html"] {
            assert!(here.join("out").join(file).is_file(), "{file}");
        }
    }

    /// A run that goes on from an output follows the run that was not interrupted: for the report's scheme to what the five decimals
    /// of the state are worth, EA times 1e-5 in tension; for the default one, which has no tension of its own, to what the jolt of
    /// these decimals leaves after a second.
    #[test]
    fn a_run_goes_on_from_its_output() {
        for (scheme, allowed) in [("cable-1994", 0.005), ("adams-moulton", 0.005)] {
            let here = directory(&format!("restart-{scheme}"));
            let whole = Deck { end: 4.0, ..deck(DYNAMIC) };
            let set = format!("solver.scheme={scheme}");
            let sets = ["--quiet", "--set", &set];
            let run = |file: &str, to: &str| {
                done(&here, &[&["run", file, "-o", to][..], &sets[..]].concat());
                let summary = read(&here.join(to).join("summary.json"));
                assert!(!summary.contains("equilibrium"), "nodes of the static example are in equilibrium: {summary}");
                rows(&read(&here.join(to).join("timeseries.csv")))
            };
            write(&here, "whole.dat", &writing::text(&whole));
            write(&here, "first.dat", &writing::text(&Deck { end: 2.0, ..whole.clone() }));
            let (whole, first) = (run("whole.dat", "whole"), run("first.dat", "first"));
            assert_eq!(whole[..21], first[..]);
            let output = deck(&read(&here.join("first/output.dat")));
            write(&here, "second.dat", &writing::text(&Deck { begin: 2.0, end: 4.0, ..output }));
            let second = run("second.dat", "second");
            assert_eq!(second.len(), 21);
            for (one, other) in whole[20..].iter().zip(&second) {
                assert!((one[0] - other[0]).abs() < 1e-9, "times: {} {}", one[0], other[0]);
                assert!((1..4).all(|k| (one[k] - other[k]).abs() < 2e-5), "the fairlead at t = {}", one[0]);
                let error = (other[4] / one[4] - 1.0).abs();
                println!("{scheme} t = {} tension {} error {error:.5}", one[0], one[4]);
                assert!(error < allowed || (one[0] < 3.0 && error < 0.05), "{scheme} at t = {}: {error}", one[0]);
            }
        }
    }

    /// Nodes far from equilibrium are a start as good as any, but not a silent one.
    #[test]
    fn nodes_that_are_not_in_equilibrium_are_warned_of() {
        let here = directory("displaced");
        let mut displaced = Deck { end: 0.2, ..deck(DYNAMIC) };
        displaced.nodes[14].position[1] += 3.0;
        write(&here, "deck.dat", &writing::text(&displaced));
        let (_, warnings) = done(&here, &["run", "deck.dat", "-o", "out", "--set", "solver.scheme=cable-1994"]);
        assert!(warnings.contains("not in equilibrium: node 15 would rest 3.0"), "{warnings}");
        let first = read(&here.join("out/nodes.csv")).lines().nth(15).unwrap_or_default().to_string();
        let z: f64 = first.split(',').nth(6).and_then(|cell| cell.parse().ok()).expect("z of node 15");
        assert!((z - displaced.nodes[14].position[1]).abs() < 1e-9, "the run begins from the nodes: {first}");
    }

    #[test]
    fn convert_goes_both_ways_and_says_what_is_lost() {
        let here = directory("convert");
        let scene = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lindahl-sjoberg.json"))
            .expect("the built-in scene");
        write(&here, "scene.json", &scene.replace("1200.0}", "1200.0, \"elements\": 40}"));
        let (said, _) = done(&here, &["convert", "scene.json", "scene.dat"]);
        for word in ["scene.dat", "environment.surface", "solver.stretch", "solver.hydrostatic_strain"] {
            assert!(said.contains(word), "{word} is missing in\n{said}");
        }
        let converted = deck(&read(&here.join("scene.dat")));
        assert_eq!((converted.job, converted.nodes.len(), converted.bottom), (Job::Dynamics, 41, -120.0));
        assert!(
            (converted.nodes[0].lambda / 1.33e6 - 1.0).abs() < 0.01,
            "its nodes are in equilibrium: {}",
            converted.nodes[0].lambda
        );
        let lowest = converted.nodes.iter().map(|node| node.position[1]).fold(0.0, f64::min);
        assert!((lowest + 120.0).abs() < 0.1, "it lies on the bed: {lowest}");
        write(&here, "deck.dat", DYNAMIC);
        let output = moorline(&here, &["convert", "scene.json", "no/such/directory/scene.dat"]);
        assert_eq!(output.status.code(), Some(2));
        let three = scene.replace("\"lines\": [", "\"lines\": [{\"fairlead\": [0,0,0], \"anchor\": [100,0,-120], \"sections\": [{\"type\": \"chain\", \"length\": 200}]},");
        write(&here, "two.json", &three);
        let output = moorline(&here, &["convert", "two.json", "two.dat"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains("the scene has 2"));
    }
}
