//! Lines that hang on free points and bodies, against closed forms and conservation laws.

use moorline::scene::motion_file::Table;
use moorline::scene::read::{self, Loaded};
use moorline::solve::fleet;
use moorline::solve::group::{EndOf, Group};
use moorline::solve::motion::{self, Ends};
use moorline::solve::partition;
use moorline::solve::snapshot::Snapshot;
use nalgebra::{Matrix3, Vector3};
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

fn load(scene: &Value) -> Loaded {
    read::parse(&scene.to_string(), "test", Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The only part of a scene that holds anything free.
fn group(loaded: &Loaded) -> Group {
    let parts = partition::parts(&loaded.scene);
    let part = parts.iter().find(|part| !part.is_alone()).expect("something free");
    let ends: Vec<Ends> = part.lines.iter().map(|index| Ends::of_scene(loaded, *index)).collect();
    Group::new(loaded, part, &ends).unwrap_or_else(|error| panic!("{error}"))
}

/// Puts a group in equilibrium at t = 0.
fn settled(scene: &Value) -> Group {
    let mut group = group(&load(scene));
    group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    group
}

/// Times at which a quantity passes zero upwards or downwards, by the straight line between samples.
fn crossings(times: &[f64], values: &[f64]) -> Vec<f64> {
    let pairs = times.windows(2).zip(values.windows(2));
    pairs.filter(|(_, x)| (x[0] < 0.0) != (x[1] < 0.0)).map(|(t, x)| t[0] + (t[1] - t[0]) * x[0] / (x[0] - x[1])).collect()
}

/// A heavy point on a stiff light string, held aside by a force: at rest where the string points along weight and force; let go, it swings
/// with the period of the finite amplitude, 4 √(l/g) K(sin ½α), K by the arithmetic–geometric mean.
#[test]
fn a_mass_on_a_line_swings_as_a_pendulum() {
    let (length, angle, g): (f64, f64, f64) = (10.0, 60.0_f64.to_radians(), 9.81);
    let scene = |pull: f64, tolerance: f64| {
        json!({
            "environment": {"depth": 100.0, "water_density": 0.0, "gravity": g, "surface": "none"},
            "line_types": {"string": {"ea": 1.0e7, "mass": 1.0e-3, "diameter": 0.001, "submerged_weight": 0.005}},
            "lines": [{"fairlead": [0, 0, -20], "anchor": {"point": "bob"}, "sections": [{"type": "string", "length": length, "elements": 2}]}],
            "points": [{"name": "bob", "position": [0, 0, -30], "mass": 1000.0, "force": [pull, 0, 0]}],
            "solver": {"tolerance": tolerance}
        })
    };
    let held = settled(&scene(1000.0 * g * angle.tan(), 1e-4));
    let place = held.point(0).position;
    let stretched = length * (1.0 + 1000.0 * g / angle.cos() / 1.0e7);
    assert!((place - Vector3::new(stretched * angle.sin(), 0.0, -20.0 - stretched * angle.cos())).norm() < 1e-4, "{place:?}");

    let mut start = held;
    start.pull(0, Vector3::zeros());
    let (mut times, mut places, mut energies) = (vec![0.0], vec![place.x], Vec::new());
    for k in 1..=2000 {
        let time = 0.01 * f64::from(k);
        start.advance(time).unwrap_or_else(|error| panic!("{error}"));
        let point = start.point(0);
        times.push(time);
        places.push(point.position.x);
        energies.push(0.5 * point.velocity.norm_squared() + g * point.position.z);
    }
    let (mut a, mut b): (f64, f64) = (1.0, (0.5 * angle).cos());
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = TAU * (stretched / g).sqrt() / a;
    let zeros = crossings(&times, &places);
    let found = 2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    println!("period {found} for {period}; energy {} to {}", energies[0], energies[energies.len() - 1]);
    assert!((found / period - 1.0).abs() < 1e-3, "period {found} s, not {period} s");
}

/// Three catenaries that meet at a heavy free point: the forces of the lines, each in closed form between its ends, balance the weight there. The
/// root is found here by Newton's method on Irvine's formulas.
#[test]
fn three_lines_at_a_free_point_are_three_catenaries() {
    let lines: [([f64; 3], f64); 3] = [([0.0, 0.0, 0.0], 60.0), ([-90.0, 20.0, -80.0], 110.0), ([70.0, -60.0, -70.0], 100.0)];
    let (ea, weight, heavy) = (5.0e7, 400.0, 30.0e3);
    let scene = json!({
        "environment": {"depth": 500.0, "water_density": 1025.0, "gravity": 9.81, "surface": "none"},
        "line_types": {"rope": {"ea": ea, "mass": 60.0, "diameter": 0.1, "submerged_weight": weight}},
        "lines": lines.iter().map(|(at, length)| json!({
            "fairlead": at, "anchor": {"point": "meeting"}, "sections": [{"type": "rope", "length": length, "elements": 60}]
        })).collect::<Vec<_>>(),
        "points": [{"name": "meeting", "position": [0, 0, -50], "force": [0, 0, -heavy]}],
    });
    let mut group = settled(&scene);
    let found = group.point(0).position;
    // Force of a line on the point: by the elastic catenary between the two ends.
    let pull = |at: &Vector3<f64>, point: &Vector3<f64>, length: f64| {
        let (dx, dy, h) = (at.x - point.x, at.y - point.y, at.z - point.z);
        let span = dx.hypot(dy);
        let (mut hor, mut ver) = (weight * length, 0.5 * weight * length * (h / length) - 0.5 * weight * length);
        for _ in 0..200 {
            let reach = |hor: f64, ver: f64| {
                let up = ver + weight * length;
                let asinh = (up / hor).asinh() - (ver / hor).asinh();
                let hyp = (1.0 + (up / hor).powi(2)).sqrt() - (1.0 + (ver / hor).powi(2)).sqrt();
                [hor * length / ea + hor / weight * asinh, length / ea * (ver + 0.5 * weight * length) + hor / weight * hyp]
            };
            let [x, z] = reach(hor, ver);
            let d = 1e-3;
            let ([xh, zh], [xv, zv]) = (reach(hor + d, ver), reach(hor, ver + d));
            let m = nalgebra::Matrix2::new((xh - x) / d, (xv - x) / d, (zh - z) / d, (zv - z) / d);
            let step = m.lu().solve(&nalgebra::Vector2::new(span - x, h - z)).expect("a step");
            let share = if hor + step.x > 0.2 * hor { 1.0 } else { 0.5 * hor / step.x.abs() };
            hor += share * step.x;
            ver += share * step.y;
            if step.norm() < 1e-9 {
                break;
            }
        }
        Vector3::new(hor * dx / span, hor * dy / span, ver)
    };
    let balance = |point: &Vector3<f64>| -> Vector3<f64> {
        lines.iter().map(|(at, length)| pull(&Vector3::from(*at), point, *length)).sum::<Vector3<f64>>() - Vector3::z() * heavy
    };
    let mut point = found;
    for _ in 0..20 {
        let d = 1e-4;
        let here = balance(&point);
        let columns = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (balance(&(point + axis * d)) - here) / d);
        let step = Matrix3::from_columns(&columns).lu().solve(&-here).expect("a step");
        point += step;
        if step.norm() < 1e-12 {
            break;
        }
    }
    println!("{found:?} {point:?}");
    assert!((found - point).norm() < 1e-6 * 100.0, "{found:?}, not {point:?}");
    for (number, (at, length)) in lines.iter().enumerate() {
        let (tension, exact) = (group.outputs(number).anchor_tension, pull(&Vector3::from(*at), &point, *length).norm());
        assert!((tension / exact - 1.0).abs() < 1e-6, "line {number}: {tension} N, not {exact} N");
    }
}

/// A buoy of one upright cylinder, moored by a line without weight or stiffness to speak of.
fn spar(position: [f64; 3], attitude: [f64; 3], mass: f64, centre: f64, inertia: [f64; 3], gravity: f64) -> Value {
    json!({
        "environment": {"depth": 200.0, "water_density": 1025.0, "gravity": gravity},
        "line_types": {"thread": {"ea": 10.0, "mass": 1.0e-3, "diameter": 0.001, "submerged_weight": 0.001}},
        "lines": [{"fairlead": {"body": "spar", "at": [0, 0, -30]}, "anchor": [0, 0, -200],
            "sections": [{"type": "thread", "length": 230.0, "elements": 4}]}],
        "bodies": [{"name": "spar", "position": position, "attitude_deg": attitude, "motion": {"kind": "free"}, "mass": mass,
            "centre_of_mass": [0, 0, centre], "inertia": inertia,
            "cylinders": [{"from": [0, 0, -30], "to": [0, 0, 10], "diameter": 6.0}]}],
        "solver": {"tolerance": 1e-3, "max_step": 0.1}
    })
}

/// Heave of a spar without added mass: T = 2π √(m/(ρ g A)); pitch: T = 2π √(I/(m g GM)) with I about the centre of mass, GM from the draught.
#[test]
fn a_spar_heaves_and_pitches_with_the_periods_of_the_closed_form() {
    let (g, rho, area) = (9.81, 1025.0, PI * 9.0);
    let draught = 30.0;
    let mass = rho * area * draught;
    let inertia = mass * 100.0;
    let mut group = settled(&spar([0.0, 0.0, 0.3], [0.0; 3], mass, -18.0, [inertia, inertia, mass], g));
    let rest = group.body(0);
    assert!(rest.reference.position.z.abs() < 1e-3, "it floats at {:?}", rest.reference.position);
    group.push(0, Vector3::z() * 0.3, Vector3::zeros());
    let (mut times, mut heave) = (Vec::new(), Vec::new());
    for k in 1..=600 {
        let time = 0.1 * f64::from(k);
        group.advance(time).unwrap_or_else(|error| panic!("{error}"));
        times.push(time);
        heave.push(group.body(0).reference.position.z - rest.reference.position.z);
    }
    let zeros = crossings(&times, &heave);
    let found = 2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    let period = TAU * (mass / (rho * g * area)).sqrt();
    println!("heave {found} for {period}");
    assert!((found / period - 1.0).abs() < 2e-3, "heave {found} s, not {period} s");

    group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    // About the centre of mass, so that heave stays out of it.
    let omega = Vector3::y() * 0.01;
    group.push(0, omega.cross(&Vector3::new(0.0, 0.0, 18.0)), omega);
    let (mut times, mut pitch) = (Vec::new(), Vec::new());
    for k in 1..=1200 {
        let time = 0.1 * f64::from(k);
        group.advance(time).unwrap_or_else(|error| panic!("{error}"));
        times.push(time);
        pitch.push(group.body(0).rotation[(0, 2)]);
    }
    let zeros = crossings(&times, &pitch);
    let found = 2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    // KB + BM - KG above the keel: draught/2 + I_w/V - 12.
    let gm = 15.0 + 0.25 * 9.0 / draught - 12.0;
    let period = TAU * (inertia / (mass * g * gm)).sqrt();
    println!("pitch {found} for {period}");
    assert!((found / period - 1.0).abs() < 2e-3, "pitch {found} s, not {period} s");
}

/// A cylinder whose centre of mass is above its centre of buoyancy and metacentre does not stand upright: statics finds a stable side, or says
/// that there is none.
#[test]
fn a_capsizing_cylinder_finds_its_stable_side() {
    let (g, rho, area) = (9.81, 1025.0, PI * 9.0);
    let mass = rho * area * 20.0;
    let mut scene = spar([0.0, 0.0, 0.0], [0.0; 3], mass, 0.0, [mass * 100.0, mass * 100.0, mass * 10.0], g);
    scene["lines"][0]["fairlead"]["at"] = json!([0, 0, 0]);
    let mut group = group(&load(&scene));
    let report = group.settle(0.0);
    let up = group.body(0).rotation[(2, 2)];
    assert!(report.is_ok() && up < 0.9, "it stands upright: {up}");
    // Stable: heave, roll and pitch of the whole are held (nothing holds the rest but a thread).
    let stiffness = group.stiffness().expect("a stiffness");
    assert!((2..5).all(|k| stiffness[(k, k)] > 0.0), "{stiffness}");
}

/// Euler's top: a free body far from anything spins about an axis that is none of its own. Energy and angular momentum are kept to the second
/// order of the step.
#[test]
fn a_free_top_keeps_energy_and_momentum_to_the_order_of_the_scheme() {
    let drift = |step: f64, scheme: &str| {
        let mut scene = spar([0.0, 0.0, -60.0], [0.0; 3], 1000.0, 0.0, [2000.0, 3000.0, 4000.0], 1.0e-9);
        scene["bodies"][0]["cylinders"] = json!([]);
        scene["lines"][0]["fairlead"]["at"] = json!([0, 0, 0]);
        scene["line_types"]["thread"] = json!({"ea": 1.0e-3, "mass": 1.0e-6, "diameter": 0.001, "submerged_weight": 0.0});
        scene["solver"] = json!({"fixed_step": step, "scheme": scheme, "tolerance": 1e-6});
        let mut group = group(&load(&scene));
        let inertia = Matrix3::from_diagonal(&Vector3::new(2000.0, 3000.0, 4000.0));
        group.push(0, Vector3::zeros(), Vector3::new(0.5, 1.0, 0.3));
        let of = |group: &Group| {
            let body = group.body(0);
            let momentum = body.rotation * inertia * body.rotation.transpose() * body.omega;
            (0.5 * momentum.dot(&body.omega), momentum)
        };
        let (energy, momentum) = of(&group);
        let mut worst = [0.0_f64; 2];
        for k in 1..=50 {
            group.advance(0.1 * f64::from(k)).unwrap_or_else(|error| panic!("{error}"));
            let (e, m) = of(&group);
            worst[0] = worst[0].max((e / energy - 1.0).abs());
            worst[1] = worst[1].max((m - momentum).norm() / momentum.norm());
        }
        worst
    };
    let mut schemes = [("adams-moulton", 2.0), ("esdirk3", 3.0), ("generalized-alpha", 2.0)];
    fleet::for_each(&mut schemes, |(scheme, order)| {
        let (coarse, fine) = (drift(0.05, scheme), drift(0.025, scheme));
        let orders = [(coarse[0] / fine[0]).log2(), (coarse[1] / fine[1]).log2()];
        println!("{scheme}: {coarse:?} {fine:?} orders {orders:?}");
        assert!(
            orders.iter().all(|found| *found > *order - 0.3) && fine.iter().all(|drift| *drift < 1e-2),
            "{scheme}: {orders:?}"
        );
    });
}

/// A load from a file on a body with a spring k and no damping: with F = F′ t up to t₁ and constant from there,
/// x = F′/k (t - sin ωt/ω), then the same minus that of a second ramp from t₁; and M in yaw alike. Steps of the solver are bounded by 0.05 s and its
/// tolerance of 1e-5, so within 1e-3 of the largest. A constant first row is the force of the equilibrium.
#[test]
fn a_load_from_a_file_moves_a_body_as_an_oscillator() {
    let directory = std::env::temp_dir().join(format!("moorline-load-{}", std::process::id()));
    std::fs::create_dir_all(&directory).expect("a directory");
    let (mass, inertia, until, pull, turn) = (2.0e5, 5.0e6, 4.0, 3.0e4, 2.0e5);
    let (k, yaw) = (1.5e5, 8.0e6);
    let stiffness: Vec<Vec<f64>> = (0..6)
        .map(|row| (0..6).map(|column| if row != column { 0.0 } else { [k, k, k, yaw, yaw, yaw][row] }).collect())
        .collect();
    let scene = json!({
        "environment": {"depth": 100.0}, "line_types": {"thread": {"ea": 10.0, "mass": 1.0e-3, "diameter": 0.001, "submerged_weight": 0.001}},
        "lines": [{"fairlead": {"body": "ship", "at": [0, 0, 0]}, "anchor": [0, 0, -100.0],
            "sections": [{"type": "thread", "length": 120.0, "elements": 4}]}],
        "bodies": [{"name": "ship", "motion": {"kind": "free"}, "mass": mass, "inertia": [inertia, inertia, inertia],
            "stiffness": stiffness, "load": "load.csv"}],
        "solver": {"tolerance": 1e-5, "max_step": 0.05}
    });
    let moved = |rows: &str| {
        std::fs::write(directory.join("load.csv"), rows).expect("a file");
        let loaded = read::parse(&scene.to_string(), "test", &directory, &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut group = group(&loaded);
        group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
        group
    };
    let ramp = |t: f64, rate: f64, k: f64, m: f64| {
        let omega = (k / m).sqrt();
        if t > 0.0 { rate / k * (t - (omega * t).sin() / omega) } else { 0.0 }
    };
    let mut moored = moved(&format!("t,fx,fy,fz,mx,my,mz\n0,0,0,0,0,0,0\n{until},{},0,0,0,0,{}\n", pull * until, turn * until));
    let (mut worst, mut largest) = ([0.0_f64; 2], [0.0_f64; 2]);
    for step in 1..=100 {
        let t = 0.1 * f64::from(step);
        moored.advance(t).unwrap_or_else(|error| panic!("{error}"));
        let body = moored.body(0);
        let found = [body.reference.position.x, moorline::algebra::rotation::angles(&body.rotation).z];
        for (part, (rate, stiff, heavy)) in [(pull, k, mass), (turn, yaw, inertia)].into_iter().enumerate() {
            let exact = ramp(t, rate, stiff, heavy) - ramp(t - until, rate, stiff, heavy);
            worst[part] = worst[part].max((found[part] - exact).abs());
            largest[part] = largest[part].max(exact.abs());
        }
    }
    println!("off by {worst:?} of {largest:?}");
    assert!(worst[0] < 1e-3 * largest[0] && worst[1] < 1e-3 * largest[1], "{worst:?} of {largest:?}");

    let moored = moved(&format!("0,{pull},0,0,0,0,{turn}\n9,0,0,0,0,0,0\n"));
    let body = moored.body(0);
    let (x, angle) = (body.reference.position.x, moorline::algebra::rotation::angles(&body.rotation).z);
    assert!((x * k / pull - 1.0).abs() < 1e-4 && (angle * yaw / turn - 1.0).abs() < 1e-4, "{x} m, {angle} rad");
    std::fs::remove_dir_all(&directory).expect("a directory");
}

/// A fairlead, a point on two chains, and a buoy under water on two more lines.
fn moored_buoy() -> Value {
    let chain = json!({"ea": 4e8, "mass": 110.0, "diameter": 0.07, "submerged_weight": 940.0, "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}});
    let line = |fairlead: Value, anchor: Value, length: f64| json!({"fairlead": fairlead, "anchor": anchor, "sections": [{"type": "chain", "length": length, "elements": 10}]});
    json!({
        "environment": {"depth": 150.0}, "line_types": {"chain": chain},
        "lines": [
            line(json!([40.0, 0.0, -2.0]), json!({"point": "joint"}), 75.0),
            line(json!({"point": "joint"}), json!([-250.0, 150.0, -150.0]), 320.0),
            line(json!({"point": "joint"}), json!([-250.0, -150.0, -150.0]), 320.0),
            line(json!({"point": "joint"}), json!({"body": "buoy", "at": [-2.0, 0, 0]}), 60.0),
            line(json!({"body": "buoy", "at": [2.0, 0, 0]}), json!([150.0, 10.0, -150.0]), 180.0),
        ],
        "points": [{"name": "joint", "position": [0, 0, -60], "mass": 3000.0, "volume": 40.0, "drag_area": 6.0, "added_mass": 8000.0}],
        "bodies": [{"name": "buoy", "position": [50.0, 2.0, -50.0], "motion": {"kind": "free"}, "mass": 4.0e4, "centre_of_mass": [0, 0, -0.5],
            "inertia": [8e4, 8e4, 8e4], "volume": 90.0, "centre_of_buoyancy": [0, 0, 0.3]}],
    })
}

/// What wakes a group, in words and in deed.
type Way<'a> = (&'a str, &'a dyn Fn(&mut Group));

/// Lines that meet, and what they hang on, take no steps and no iterations while nothing moves, however long; what they would do is less than the
/// hundredth of the tolerance that is promised; and they wake when an end is driven, a force applied to a body or changed on a point: then they do what
/// those do that never rested, also after a rollback. In waves and in a current that may change there is no rest.
#[test]
fn lines_that_meet_cost_nothing_at_rest_until_something_moves() {
    let scene = moored_buoy();
    let mut resting = settled(&scene);
    let tensions = |group: &mut Group| -> Vec<f64> { (0..5).map(|local| group.outputs(local).tension).collect() };
    let before = tensions(&mut resting);
    for row in 1..=10_000 {
        resting.advance(0.1 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
    }
    let counters = resting.counters();
    assert_eq!((counters.steps, counters.newton_iterations), (0, 0), "{counters:?}");
    assert_eq!((tensions(&mut resting), resting.time()), (before.clone(), 1000.0));

    // Every step is asked for: what the skip left out.
    let mut stepped_scene = scene.clone();
    stepped_scene["solver"] = json!({"fixed_step": 0.1});
    let mut stepped = settled(&stepped_scene);
    for row in 1..=200 {
        stepped.advance(0.1 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
        for (local, (now, before)) in tensions(&mut stepped).iter().zip(&before).enumerate() {
            assert!((now / before - 1.0).abs() <= 1e-5, "line {local}, row {row}: {before} N, {now} N");
        }
    }
    assert_eq!(stepped.counters().steps, 200);

    // Each way to wake it: after a rest of 64 s, and at once.
    let fairlead = [40.0, 0.0, -2.0];
    let shifted = |rest: f64| {
        let (times, to) = (vec![0.0, rest, rest + 5.0], [38.0, 1.0, -1.0]);
        motion::Path::Table(Arc::new(Table { times, positions: vec![fairlead, fairlead, to], velocities: vec![[0.0; 3]; 3] }))
    };
    let ways: [Way; 3] = [
        ("an end is driven", &|_| ()),
        ("a body is pulled at", &|group| group.apply(0, Vector3::new(2.0e4, 0.0, 0.0), Vector3::zeros())),
        ("a point is pulled at", &|group| group.pull(0, Vector3::new(0.0, 2.0e4, 0.0))),
    ];
    for (what, wake) in ways {
        let drives = what.contains("driven");
        let (mut at_once, mut rested) = (settled(&scene), settled(&scene));
        if drives {
            at_once.drive(0, EndOf::Fairlead, &shifted(0.0));
            rested.drive(0, EndOf::Fairlead, &shifted(64.0));
        }
        rested.advance(64.0).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(rested.counters().steps, 0, "{what}");
        let mut asleep = Snapshot::new(2);
        rested.save(&mut asleep);
        wake(&mut at_once);
        wake(&mut rested);
        let mut found = Vec::new();
        for row in 1..=40 {
            let time = 0.125 * f64::from(row);
            at_once.advance(time).unwrap_or_else(|error| panic!("{error}"));
            rested.advance(64.0 + time).unwrap_or_else(|error| panic!("{error}"));
            found.push(tensions(&mut rested));
            for (one, other) in found.last().into_iter().flatten().zip(tensions(&mut at_once)) {
                assert!((one / other - 1.0).abs() < 1e-8, "{what}, row {row}: {one} N, {other} N");
            }
        }
        let moved = found.last().into_iter().flatten().zip(&before).any(|(now, before)| (now / before - 1.0).abs() > 1e-3);
        assert!(moved && rested.counters().steps > 40, "{what}");
        assert!(rested.restore(&asleep), "{what}");
        for (row, expected) in (1..=40).zip(&found) {
            rested.advance(64.0 + 0.125 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(&tensions(&mut rested), expected, "{what}, row {row} after a rollback");
        }
    }

    let rows = json!({"rows": [[0, 0, 0, 0, 0], [20, 0, 0, 0, 0], [30, 0, 1, 0, 0]]});
    for (key, value) in [("waves", json!({"kind": "regular", "amplitude": 0.1, "period": 8.0})), ("current_over_time", rows)] {
        let mut moved = scene.clone();
        moved["environment"][key] = value;
        let mut group = settled(&moved);
        group.advance(2.0).unwrap_or_else(|error| panic!("{error}"));
        assert!(group.counters().steps > 0, "{key}");
    }
}
