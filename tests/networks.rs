//! Random moorings: bridles, shared anchors, rows of buoys and floating buoys on light and heavy lines, taut and slack, in currents and waves, on
//! smooth and rough beds, with a ship that moves in all six ways. Each must find an equilibrium in which every point is balanced by lines that hang
//! as each would alone, and go through ten seconds of motion; what fails must say where and why, and is counted.
//!
//! `cargo test --release --test networks` plays a part of them, with `-- --ignored --nocapture` 300.

use moorline::scene::read::{self, Loaded};
use moorline::solve::mooring::Mooring;
use moorline::solve::part::Part;
use moorline::solve::simulation::{Outputs, Simulation};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;
use support::GRAVITY;
use support::mooring::settle;
use support::random::Random;

mod support;

const DENSITY: f64 = 1025.0;

/// What is made of lines, points and bodies.
#[derive(Default)]
struct Made {
    lines: Vec<Value>,
    points: Vec<Value>,
    bodies: Vec<Value>,
}

/// An end of a line and where it is.
type End = (Value, [f64; 3]);

impl Made {
    fn line(&mut self, random: &mut Random, fairlead: &End, anchor: &End) {
        let distance = (Vector3::from(fairlead.1) - Vector3::from(anchor.1)).norm();
        let slack = if random.share() < 0.5 { random.between(1.0005, 1.02) } else { random.between(1.02, 1.3) };
        let kind = if random.share() < 0.5 { "a" } else { "b" };
        self.lines.push(json!({"name": format!("line {}", self.lines.len()), "fairlead": fairlead.0, "anchor": anchor.0,
            "sections": [{"type": kind, "length": distance * slack}]}));
    }

    fn point(&mut self, random: &mut Random, position: [f64; 3]) -> End {
        let name = format!("point {}", self.points.len());
        let mass = random.magnitude(10.0, 2.0e4);
        let volume = if random.share() < 0.5 { 0.0 } else { mass / DENSITY * random.between(0.2, 3.0) };
        self.points.push(json!({"name": name, "position": position, "mass": mass, "volume": volume,
            "drag_area": random.between(0.0, 8.0), "added_mass": mass * random.share()}));
        (json!({"point": name}), position)
    }
}

fn on_ship(at: [f64; 3]) -> End {
    (json!({"body": "ship", "at": at}), at)
}

fn kind_of_line(random: &mut Random) -> Value {
    let diameter = random.between(0.03, 0.15);
    let mass = 6000.0 * diameter * diameter * random.between(0.5, 4.0);
    // Steel in water, or next to weightless.
    let share = if random.share() < 0.8 { random.between(0.3, 0.87) } else { 0.05 };
    let damping = [0.0, 0.001, 0.01][(3.0 * random.share()) as usize];
    json!({"ea": random.magnitude(1e7, 1e9), "mass": mass, "diameter": diameter, "submerged_weight": share * mass * GRAVITY,
        "drag": {"normal": 1.2, "tangential": 0.05}, "added_mass": {"normal": 1.0}, "damping": damping})
}

/// A buoy of one cylinder that floats with room to spare, held by legs.
fn buoy(made: &mut Made, random: &mut Random, depth: f64) {
    let (diameter, height) = (random.between(2.0, 12.0), random.between(1.0, 8.0));
    let mass = DENSITY * std::f64::consts::PI / 4.0 * diameter * diameter * height * random.between(0.2, 0.5);
    let across = mass * (diameter * diameter / 16.0 + height * height / 12.0);
    made.bodies.push(json!({"name": "buoy", "position": [150.0, 0, 0], "motion": {"kind": "free"}, "mass": mass,
        "centre_of_mass": [0, 0, -0.3 * height * random.share()], "inertia": [across, across, mass * diameter * diameter / 8.0],
        "cylinders": [{"from": [0, 0, -0.5 * height], "to": [0, 0, 0.5 * height], "diameter": diameter,
            "drag": {"normal": 1, "end": 1}, "added_mass": {"normal": 0.8, "end": 0.6}}]}));
    let legs = 2 + (3.0 * random.share()) as usize;
    for leg in 0..legs {
        let (sin, cos) = (std::f64::consts::TAU * leg as f64 / legs as f64).sin_cos();
        let at = [0.5 * diameter * cos, 0.5 * diameter * sin, -0.5 * height];
        let far = depth * random.between(0.5, 3.0);
        let anchor = [150.0 + far * cos, far * sin, -depth];
        made.line(random, &(json!({"body": "buoy", "at": at}), [150.0 + at[0], at[1], at[2]]), &(json!(anchor), anchor));
    }
    if random.share() < 0.6 {
        let at = [-0.5 * diameter, 0.0, 0.5];
        made.line(random, &on_ship([20.0, 0.0, 3.0]), &(json!({"body": "buoy", "at": at}), [150.0 + at[0], 0.0, 0.5]));
    }
}

fn scene(seed: u64) -> Value {
    let mut random = Random::new(seed);
    let random = &mut random;
    let depth = random.between(50.0, 300.0);
    let types = json!({"a": kind_of_line(random), "b": kind_of_line(random)});
    let mut made = Made::default();
    let ramp = [0.0, 10.0, 30.0][(3.0 * random.share()) as usize];
    let sine: Vec<f64> = [2.0, 1.0, 1.5, 3.0, 3.0, 2.0].iter().map(|most| most * random.share()).collect();
    made.bodies.push(json!({"name": "ship", "motion": {"kind": "sinusoidal", "period": random.between(6.0, 15.0), "sine": sine, "ramp": ramp}}));
    let hang = [random.between(-20.0, 20.0), random.between(-5.0, 5.0), -random.between(1.0, 8.0)];
    match (4.0 * random.share()) as usize {
        0 => {
            let at = [random.between(-30.0, 30.0), random.between(-30.0, 30.0), -depth * random.between(0.2, 0.7)];
            let point = made.point(random, at);
            made.line(random, &on_ship(hang), &point);
            for _ in 0..1 + (3.0 * random.share()) as usize {
                let (sin, cos) = (std::f64::consts::TAU * random.share()).sin_cos();
                let far = depth * random.between(0.5, 3.0);
                let anchor = [far * cos, far * sin, -depth];
                made.line(random, &point, &(json!(anchor), anchor));
            }
        }
        1 => {
            let at = [60.0, 0.0, -depth * random.between(0.2, 0.6)];
            let point = made.point(random, at);
            made.line(random, &on_ship([20.0, 8.0, -3.0]), &point);
            made.line(random, &on_ship([20.0, -8.0, -3.0]), &point);
            let anchor = [60.0 + depth * random.between(1.0, 4.0), random.between(-20.0, 20.0), -depth];
            made.line(random, &point, &(json!(anchor), anchor));
        }
        2 => {
            let mut last = on_ship(hang);
            for number in 0..1 + (3.0 * random.share()) as usize {
                let at = [hang[0] + 60.0 * (number + 1) as f64, random.between(-10.0, 10.0), -depth * random.between(0.2, 0.8)];
                let point = made.point(random, at);
                made.line(random, &last, &point);
                last = point;
            }
            let anchor = [last.1[0] + depth * random.between(0.5, 2.0), 0.0, -depth];
            made.line(random, &last, &(json!(anchor), anchor));
        }
        _ => buoy(&mut made, random, depth),
    }
    let mut environment = json!({"depth": depth});
    if random.share() < 0.3 {
        environment["current"] = json!([{"z": 0, "velocity": [random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0]}]);
    }
    if random.share() < 0.2 {
        environment["waves"] =
            json!({"kind": "regular", "amplitude": random.between(0.3, 2.0), "period": random.between(6.0, 12.0)});
    }
    if random.share() < 0.2 {
        environment["seabed"] = json!({"friction": random.between(0.1, 1.0)});
    }
    json!({"environment": environment, "line_types": types, "lines": made.lines, "points": made.points, "bodies": made.bodies})
}

/// Every line pulls as it does alone between the ends where it was found, to 3e-3 (meshes differ, within three times the tolerance) of its tension
/// or, where it is slack, of a thousandth of its weight; every point that is under water and off the bed is in balance, to 1e-4 of what pulls at it.
fn hangs_in_balance(loaded: &Loaded, mooring: &Mooring, outputs: &[Outputs]) {
    let scene = &loaded.scene;
    // Meshes are chosen for ends where a scene puts them.
    let mut placed = scene.clone();
    mooring.place_in(&mut placed);
    for (index, found) in outputs.iter().enumerate() {
        let mut alone = Simulation::on_ends(&placed, index, None).unwrap_or_else(|error| panic!("{error}"));
        alone.settle_between(found.fairlead, found.anchor, 0.0).unwrap_or_else(|error| panic!("{error}"));
        let own = alone.outputs();
        let off = (own.force - found.force).norm().max((own.anchor_force - found.anchor_force).norm());
        let weight: f64 =
            placed.lines[index].sections.iter().map(|s| s.length * placed.line_types[&s.line_type].mass * GRAVITY).sum();
        let size = own.tension.max(own.anchor_tension).max(1e-3 * weight);
        assert!(off < 3e-3 * size, "line {index} alone pulls with {:?}, here with {:?}, off by {off} N", own.force, found.force);
    }
    let flows = !scene.environment.current.is_empty();
    let Some(group) = mooring.parts.iter().find_map(|part| if let Part::Group(group) = part { Some(group) } else { None }) else {
        panic!("something is free")
    };
    for (number, point) in scene.points.iter().enumerate() {
        let at = group.point(number).position;
        let radius = (0.75 * point.volume / std::f64::consts::PI).cbrt();
        if at.z > -radius || at.z < radius - scene.environment.depth + 1.0 || flows {
            continue;
        }
        let mut sum = Vector3::z() * (GRAVITY * (DENSITY * point.volume - point.mass));
        let mut size = sum.norm();
        for (line, found) in scene.lines.iter().zip(outputs) {
            for (on, force) in [(&line.fairlead_on, found.force), (&line.anchor_on, found.anchor_force)] {
                if on.as_ref().is_some_and(|on| on.name() == point.name) {
                    sum += force;
                    size = size.max(force.norm());
                }
            }
        }
        assert!(sum.norm() < 1e-4 * size, "{} is out of balance by {} N of {size} N", point.name, sum.norm());
    }
}

/// What came of a scene: nothing to say, or what was refused.
fn play(seed: u64) -> Option<String> {
    let text = scene(seed).to_string();
    let loaded = read::parse(&text, "random", Path::new("."), &[]).unwrap_or_else(|error| panic!("{seed}: {error}\n{text}"));
    let began = Instant::now();
    let settled = Mooring::new(&loaded).and_then(|mut mooring| {
        let outputs = settle(&mut mooring, loaded.scene.lines.len())?;
        Ok((mooring, outputs))
    });
    let (mut mooring, outputs) = match settled {
        Ok(settled) => settled,
        Err(error) => return Some(format!("{seed}: {error}")),
    };
    hangs_in_balance(&loaded, &mooring, &outputs);
    let statics = began.elapsed();
    for part in &mut mooring.parts {
        for row in 1..=20 {
            if let Err(error) = part.advance(0.5 * f64::from(row)) {
                return Some(format!("{seed}: {error}"));
            }
            for local in 0..part.lines().len() {
                let outputs = part.outputs(local);
                assert!(outputs.tension.is_finite() && outputs.anchor_tension.is_finite(), "{seed}: {outputs:?}");
            }
        }
    }
    println!("{seed}: statics {statics:.1?}, all {:.1?}", began.elapsed());
    None
}

fn most_are_answered(seeds: std::ops::Range<u64>, share: f64) {
    let count = seeds.end - seeds.start;
    let refused: Vec<String> = seeds.filter_map(play).collect();
    refused.iter().for_each(|text| println!("{text}"));
    assert!(refused.len() as f64 <= share * count as f64, "{} of {count} refused:\n{}", refused.len(), refused.join("\n"));
}

#[test]
fn random_moorings_are_in_balance_and_move() {
    most_are_answered(0..24, 0.05);
}

#[test]
#[ignore = "minutes"]
fn three_hundred_random_moorings_are_in_balance_and_move() {
    most_are_answered(0..300, 0.03);
}
