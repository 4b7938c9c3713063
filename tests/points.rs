//! What acts at points of a line, against closed forms: clumps, buoys, point masses, springs, dampers, locks, moving references.
//! Numbers named "reference" come from tests/data/reference-cases.json; each tolerance is about three times the error measured when
//! the test was written.

mod support;

use moorline::rod::body::Body;
use moorline::rod::hold::Hold;
use moorline::rod::mesh::{Mesh, Part};
use moorline::rod::morison::Sea;
use moorline::rod::properties::Properties;
use moorline::rod::state::State;
use moorline::scene::read::parse;
use moorline::scene::types::Scheme;
use moorline::sea::clock::Clock;
use moorline::sea::current::Current;
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path;
use moorline::solve::newton::motion;
use moorline::solve::simulation::{NodeOutput, Simulation};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use support::*;

fn simulation(scene: &Value) -> (Simulation, Path) {
    let loaded = parse(&scene.to_string(), "test.json", std::path::Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&loaded.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    simulation.settle(loaded.scene.lines[0].fairlead.into(), 0.0).unwrap_or_else(|error| panic!("{error}"));
    (simulation, Path::of_scene(&loaded, 0))
}

fn settled(scene: &Value) -> Simulation {
    simulation(scene).0
}

/// Nodes at an arc length from the fairlead: two where something acts, with the tension on either side.
fn nodes_at(simulation: &Simulation, s: f64) -> Vec<NodeOutput> {
    simulation.nodes().into_iter().filter(|node| (node.s - s).abs() < 1e-6).collect()
}

/// A line from (0, 0, 0) to (distance, 0, -drop) of one material, free of the bed, with bodies on it.
fn hanging(length: f64, distance: f64, drop: f64, elements: Option<usize>, attachments: Value) -> Value {
    let mut section = json!({"type": "rope", "length": length});
    if let Some(elements) = elements {
        section["elements"] = json!(elements);
    }
    json!({
        "environment": {"depth": 5000.0, "surface": "none", "water_density": 1000.0, "gravity": 10.0},
        "line_types": {"rope": {"ea": 3.0e7, "mass": 90.0, "diameter": 0.1, "submerged_weight": 700.0}},
        "lines": [{"fairlead": [0, 0, 0], "anchor": [distance, 0, -drop], "sections": [section], "attachments": attachments}],
    })
}

/// Source: elastic catenary section by section (Irvine 1981) with a jump P of the vertical force at the clump: net weight 20 t · 10 -
/// 4 m³ · 1000 · 10 = 160 kN, half of the line's. The joint makes a clump as accurate as no clump.
#[test]
fn a_clump_weight_hangs_as_the_piecewise_catenary() {
    let body = json!([{"s": 180.0, "mass": 2.0e4, "volume": 4.0}]);
    let pieces =
        [Piece { length: 320.0, weight: 700.0, ea: 3.0e7 }, weight(1.6e5), Piece { length: 180.0, weight: 700.0, ea: 3.0e7 }];
    let exact = Hanging::spanning(&pieces, 400.0, 150.0);
    for (elements, allowed) in [(Some(20), 3e-6), (None, 1e-4)] {
        let line = settled(&hanging(500.0, 400.0, 150.0, elements, body.clone()));
        let outputs = line.outputs();
        assert_close("horizontal", outputs.force.x, exact.horizontal, allowed);
        assert_close("tension at the fairlead", outputs.tension, exact.tension(&pieces, 500.0), allowed);
        assert_close("tension at the anchor", outputs.anchor_tension, exact.tension(&pieces, 0.0), allowed);
        let clump = nodes_at(&line, 180.0);
        let upper = exact.horizontal.hypot(exact.vertical + 700.0 * 320.0 + 1.6e5);
        let lower = exact.horizontal.hypot(exact.vertical + 700.0 * 320.0);
        assert_eq!(clump.len(), 2, "a node on either side");
        assert_close("tension above the clump", clump[0].tension, upper, allowed);
        assert_close("tension below the clump", clump[1].tension, lower, allowed);
        assert_close("slope above", clump[0].tangent.x, exact.horizontal / upper, 10.0 * allowed);
        assert_close("slope below", clump[1].tangent.x, exact.horizontal / lower, 10.0 * allowed);
        let (x, z) = Hanging { ..exact }.end(&pieces[..1]);
        assert_small("place of the clump", (clump[0].position - Vector3::new(400.0 - x, 0.0, z - 150.0)).norm() / 500.0, allowed);
    }
}

/// Source: the same with a buoy whose net lift is 1.4 times the weight of the line: a lazy wave with the buoy above both ends, or (two
/// buoys of half the lift) an arch.
#[test]
fn buoys_lift_a_line_as_the_piecewise_catenary() {
    let rope = |length: f64| Piece { length, weight: 700.0, ea: 3.0e7 };
    let lift = 1.4 * 700.0 * 500.0;
    let one = [rope(250.0), weight(-lift), rope(250.0)];
    let two = [rope(200.0), weight(-0.5 * lift), rope(100.0), weight(-0.5 * lift), rope(200.0)];
    let body = |s: f64, lift: f64| json!({"s": s, "mass": 1000.0, "volume": (lift + 1.0e4) / 1.0e4});
    let cases = [(&one[..], json!([body(250.0, lift)])), (&two[..], json!([body(200.0, 0.5 * lift), body(300.0, 0.5 * lift)]))];
    for (pieces, attachments) in cases {
        for elements in [Some(24), None] {
            let exact = Hanging::spanning(pieces, 400.0, 50.0);
            let outputs = settled(&hanging(500.0, 400.0, 50.0, elements, attachments.clone())).outputs();
            assert_close("horizontal", outputs.force.x, exact.horizontal, 1e-4);
            assert_close("tension at the fairlead", outputs.tension, exact.tension(pieces, 500.0), 1e-4);
            assert_close("tension at the anchor", outputs.anchor_tension, exact.tension(pieces, 0.0), 1e-4);
        }
    }
}

/// Source: Newton's second law for a body on a prescribed path. Whatever holds a pinned end holds the bodies there: its force is that of the
/// line without them, and their net weight, inertia and drag. The work done on it is theirs, too: - W Δz - ½ (m + A) v² without drag.
#[test]
fn what_holds_a_pinned_end_holds_the_bodies_at_it() {
    let (mass, volume, added_mass) = (3.0e4, 5.0, 4.0e3);
    let weight = mass * 10.0 - volume * 1.0e4;
    let scene = |drag_area: f64, bodies: bool| {
        let body = |s: f64| json!({"s": s, "mass": mass, "volume": volume, "added_mass": added_mass, "drag_area": drag_area});
        let mut scene = hanging(500.0, 400.0, 150.0, Some(20), if bodies { json!([body(0.0), body(500.0)]) } else { json!([]) });
        scene["motion"] = json!({"kind": "sinusoidal", "period": 8.0, "sine": [1.0, 0.5, 2.0], "ramp": 4.0});
        scene["solver"] = json!({"fixed_step": 0.02});
        scene
    };
    for drag_area in [0.0, 30.0] {
        let ((mut bare, path), (mut laden, _)) = (simulation(&scene(drag_area, false)), simulation(&scene(drag_area, true)));
        [&mut bare, &mut laden].into_iter().for_each(Simulation::sum_up_work);
        for row in 0..=12 {
            let time = 0.5 * row as f64;
            for line in [&mut bare, &mut laden].into_iter().filter(|_| row > 0) {
                line.advance(time, &path).unwrap_or_else(|error| panic!("{error}"));
            }
            let (without, with, fairlead) = (bare.outputs(), laden.outputs(), path.at(time));
            let drag = fairlead.velocity * fairlead.velocity.norm() * (0.5 * 1000.0 * drag_area);
            let net = Vector3::z() * weight;
            let allowed = 1e-15 * with.tension;
            let body = net + drag + fairlead.acceleration * (mass + added_mass);
            assert_small("force", (with.force - without.force + body).norm() / allowed, 1.0);
            assert_small("force on the anchor", (with.anchor_force - without.anchor_force + net).norm() / allowed, 1.0);
            assert_eq!((with.tension, with.anchor_tension), (with.force.norm(), with.anchor_force.norm()));
            assert_small("tension along the line", (with.tension_max - without.tension_max) / allowed, 1.0);
            if drag_area == 0.0 {
                let energy = weight * (fairlead.position.z - path.at(0.0).position.z)
                    + 0.5 * (mass + added_mass) * (fairlead.velocity.norm_squared() - path.at(0.0).velocity.norm_squared());
                assert_small("work", (with.work - without.work + energy) / 1.0e6, 2e-5);
            }
        }
    }
}

/// Source: pendulum, released horizontally (reference f1): period 4 √(L/g) K(sin θ₀/2), tension at the bottom m g (3 - 2 cos θ₀). A line
/// of 10 g with 1 t at its end; EA = 1e8 N stretches by 1e-4 on average.
#[test]
fn a_weight_on_a_light_line_swings_as_a_pendulum() {
    let (length, mass) = (10.0, 1000.0);
    let mesh = uniform(Properties { damping: 0.01, ..material(1.0e8, 1.0e-3, 1.0e-3 * GRAVITY) }, length, 2);
    let last = mesh.nodes() - 1;
    let holding = Holding::none().hold(last, &[X, Y, Z]).body(point_mass(0, mass));
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.stretch(Vector3::new(length, 0.0, 0.0), Vector3::zeros());
    let (mut crossings, mut bottom, mut before) = (Vec::new(), Vec::new(), (0.0, length));
    let path = rig.held();
    rig.run(Scheme::AdamsMoulton, &path, 0.005, 6.0, |time, state, line| {
        let x = state.u.position(0).x;
        if before.1 * x <= 0.0 {
            crossings.push(before.0 + (time - before.0) * before.1 / (before.1 - x));
            bottom.push(line.end_force(&motion(state)).norm());
        }
        before = (time, x);
    });
    let period = reference("/f1_pendulum/period");
    assert_close("first quarter", crossings[0], 0.25 * period, 1e-3);
    assert_close("half a period", crossings[1] - crossings[0], 0.5 * period, 1e-3);
    let exact = reference("/f1_pendulum/bottom_tension_over_mg") * mass * GRAVITY;
    bottom.iter().for_each(|tension| assert_close("tension at the bottom", *tension, exact, 2e-3));
}

/// Source: hanging chain with an end mass (reference e): T = M g + m g z, Bessel functions J₀ and Y₀; mode shapes in both planes.
#[test]
fn a_chain_with_an_end_mass_has_the_frequencies_of_bessel() {
    let exact = references("/e_hanging_chain/omega_in_air_with_end_mass");
    let given = |name: &str| reference(&format!("/e_hanging_chain/given/{name}"));
    let (length, mass) = (given("L"), given("m_eff"));
    let mesh = uniform(material(1.0e11, mass, mass * GRAVITY), length, 24);
    let last = mesh.nodes() - 1;
    let holding = Holding::none().hold(last, &[X, Y, Z]).body(point_mass(0, given("end_mass_in_air_variant")));
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.stretch(Vector3::new(0.0, 0.0, -length), Vector3::zeros());
    rig.settle();
    let found = rig.frequencies();
    for (mode, exact) in exact.iter().enumerate() {
        assert_close("frequency", found[2 * mode], *exact, 1e-5);
        assert_close("frequency in the other plane", found[2 * mode + 1], *exact, 1e-5);
    }
}

/// Source: the elastic catenary between the ends as found, whose end force the springs must carry: k (r₀ - r) along each of three
/// skew axes.
#[test]
fn a_fairlead_on_springs_stands_where_they_carry_the_catenary() {
    let mut scene = hanging(500.0, 400.0, 250.0, Some(40), json!([]));
    let (axes, stiffness) = ([[1.0, 0.5, 0.2], [0.0, 1.0, 1.0]], [2.0e4, 9.0e4, 4.0e4]);
    scene["lines"][0]["constraints"] = json!([{"s": 0.0, "axes": axes, "stiffness": stiffness, "reference": [-3.0, 1.0, 2.0]}]);
    let outputs = settled(&scene).outputs();
    let chord = Vector3::new(400.0, 0.0, -250.0) - outputs.fairlead;
    let pieces = [Piece { length: 500.0, weight: 700.0, ea: 3.0e7 }];
    let exact = Hanging::spanning(&pieces, chord.x.hypot(chord.y), -chord.z);
    assert_close("horizontal", outputs.force.x.hypot(outputs.force.y), exact.horizontal, 1e-6);
    let carried = moorline::rod::hold::axes(&axes);
    let pull =
        carried.tr_mul(&Vector3::from(stiffness).component_mul(&(carried * (outputs.fairlead - Vector3::new(-3.0, 1.0, 2.0)))));
    assert_small("springs against the line", (pull - outputs.force).norm() / outputs.tension, 1e-6);
}

/// A mass at the end of a light line that lies along a rail in space; the rail's axis is the first of skew axes, the others are locked.
fn on_a_rail(hold: impl Fn(Hold) -> Hold, mass: f64) -> (Rig, Vector3<f64>) {
    let (length, ea) = (20.0, 2.0e5);
    let directions = [[0.6, 0.48, -0.64], [0.0, 0.0, 1.0]];
    let along = Vector3::from(directions[0]);
    let mesh = uniform(material(ea, 1.0e-4, 1.0e-4 * GRAVITY), length, 2);
    let last = mesh.nodes() - 1;
    let rail = Hold { locked: [false, true, true], ..hold_at(0, directions, along * length) };
    let holding = Holding::none().hold(last, &[X, Y, Z]).body(point_mass(0, mass)).by(hold(rail));
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.stretch(along * length, Vector3::zeros());
    rig.settle();
    (rig, along)
}

/// Source: a mass on a frictionless rail of direction a, held by the line: T = m g |a_z|, stretch T L/EA; and it oscillates along the
/// rail with ω² = EA/(L m), with a damper c as e^(-ct/2m) cos(√(ω² - (c/2m)²) t + …). It never leaves the rail.
#[test]
fn a_mass_locked_to_a_skew_rail_moves_along_it_alone() {
    let (mass, length, ea) = (500.0, 20.0, 2.0e5);
    for damping in [0.0, 300.0] {
        let damper = |hold: Hold| Hold { damping: Vector3::new(damping, 0.0, 0.0), ..hold };
        let (mut rig, along) = on_a_rail(damper, mass);
        let rest = rig.state.u.position(0);
        let tension = mass * GRAVITY * 0.64;
        // The line weighs 6e-6 of the tension.
        assert_close("tension", rig.fairlead_force().norm(), tension, 1e-5);
        assert_close("place on the rail", rest.dot(&along), length * (1.0 + tension / ea), 1e-6);
        rig.stretch(rest + along * 0.2, Vector3::zeros());
        let (mut worst, mut off) = (0.0_f64, 0.0_f64);
        let path = rig.held();
        let decay = 0.5 * damping / mass;
        let omega = (ea / (length * mass) - decay * decay).sqrt();
        rig.run(Scheme::AdamsMoulton, &path, 0.005, 3.0 * TAU / omega, |time, state, _| {
            let moved = state.u.position(0) - rest;
            let exact = 0.2 * (-decay * time).exp() * ((omega * time).cos() + decay / omega * (omega * time).sin());
            worst = worst.max((moved.dot(&along) - exact).abs());
            off = off.max((moved - along * moved.dot(&along)).norm());
        });
        assert_small("off the rail [m]", off, 1e-11);
        assert_small("along the rail [m]", worst, 2e-3);
    }
}

/// Source: base excitation. The mass on the rail also hangs on a spring k with a damper c to a reference that moves by a sin ωt + b cos
/// ωt: steady amplitude of |(k + iωc)(b - ia) / (k + EA/L - mω² + iωc)|, reached when the start has died away.
#[test]
fn a_moving_reference_drives_a_mass_as_base_excitation_does() {
    let (mass, length, ea, k, c, w) = (500.0, 20.0, 2.0e5, 6.0e3, 2.0e3, 4.0);
    let motion = moorline::algebra::sinusoid::Sinusoid {
        omega: w,
        sine: Vector3::new(0.03, 0.0, 0.0),
        cosine: Vector3::new(0.04, 0.0, 0.0),
        ramp: 2.0,
    };
    let drive = |hold: Hold| Hold {
        stiffness: Vector3::new(k, 0.0, 0.0),
        damping: Vector3::new(c, 0.0, 0.0),
        motion: Some(motion),
        ..hold
    };
    let (mut rig, along) = on_a_rail(drive, mass);
    let rest = rig.state.u.position(0).dot(&along);
    let mut largest = 0.0_f64;
    let path = rig.held();
    rig.run(Scheme::AdamsMoulton, &path, 0.005, 14.0, |time, state, _| {
        if time > 14.0 - TAU / w {
            largest = largest.max((state.u.position(0).dot(&along) - rest).abs());
        }
    });
    let stiffness = k + ea / length - mass * w * w;
    let exact = 0.05 * (k.hypot(w * c) / stiffness.hypot(w * c));
    assert_close("amplitude", largest, exact, 2e-3);
}

/// Source: the same line moved in another way. A fairlead that a constraint locks along skew axes and moves is the fairlead that the
/// scene moves; and the anchor, moved the opposite way, gives the same tension in a line without weight.
#[test]
fn a_locked_end_with_a_motion_of_its_own_is_a_driven_end() {
    let scene = |constraints: Value, motion: Value| {
        json!({
            "environment": {"depth": 150.0, "seabed": {"stiffness": 1.0e4}},
            "line_types": {"rope": {"ea": 3.0e7, "mass": 90.0, "diameter": 0.1, "damping": 1.0e-3, "drag": {"normal": 1.2}}},
            "lines": [{"fairlead": [0, 0, 0], "anchor": [400, 0, -150], "sections": [{"type": "rope", "length": 450, "elements": 20}],
                       "constraints": constraints}],
            "motion": motion,
            "solver": {"fixed_step": 0.05},
        })
    };
    let tensions = |scene: Value| {
        let (mut line, path) = simulation(&scene);
        (1..=100).map(|row| line.advance(0.1 * row as f64, &path).map(|()| line.outputs().tension)).collect::<Result<Vec<_>, _>>()
    };
    let (sine, cosine) = ([1.2, 0.3, -0.4], [0.1, 0.8, 0.5]);
    let axes = [[1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];
    let turn = moorline::rod::hold::axes(&axes);
    let [own_sine, own_cosine] = [sine, cosine].map(|x: [f64; 3]| (turn * Vector3::from(x)).as_slice().to_vec());
    let driven =
        tensions(scene(json!([]), json!({"kind": "sinusoidal", "period": 6, "sine": sine, "cosine": cosine, "ramp": 3})));
    let locked = json!([{"s": 0, "axes": axes, "locked": [true, true, true],
                         "motion": {"period": 6, "sine": own_sine, "cosine": own_cosine, "ramp": 3}}]);
    let locked = tensions(scene(locked, json!({"kind": "fixed"})));
    let (driven, locked) = (driven.expect("a run"), locked.expect("a run"));
    for (driven, locked) in driven.iter().zip(&locked) {
        assert_close("tension", *locked, *driven, 1e-7);
    }
}

/// A spring without a reference of its own holds the point where it is anyway, so nothing changes at rest.
#[test]
fn a_spring_about_the_equilibrium_leaves_it_alone() {
    let plain = settled(&hanging(500.0, 400.0, 150.0, Some(20), json!([{"s": 200.0, "mass": 1000.0}])));
    let mut scene = hanging(500.0, 400.0, 150.0, Some(20), json!([{"s": 200.0, "mass": 1000.0}]));
    scene["lines"][0]["constraints"] = json!([{"s": 200.0, "stiffness": [1e5, 1e5, 1e5], "locked": [false, true, false]}]);
    let held = settled(&scene);
    assert_close("tension", held.outputs().tension, plain.outputs().tension, 1e-6);
    assert_small("place", (nodes_at(&held, 200.0)[0].position - nodes_at(&plain, 200.0)[0].position).norm(), 1e-4);
}

/// Source: weights. An end that nothing holds hangs straight down: the tension at the top is the weight of all, at the bottom that of
/// the clump; a dead force pulls it sideways along the line of forces.
#[test]
fn a_released_end_hangs_under_its_weight() {
    let mut scene = hanging(100.0, 60.0, 70.0, Some(10), json!([{"s": 100.0, "mass": 3000.0, "volume": 1.0}]));
    scene["lines"][0]["constraints"] = json!([{"s": 100.0}]);
    let line = settled(&scene);
    let outputs = line.outputs();
    assert_close("tension at the top", outputs.tension, 700.0 * 100.0 + 2.0e4, 1e-6);
    assert_close("tension at the end", outputs.anchor_tension, 2.0e4, 1e-5);
    let nodes = line.nodes();
    let end = nodes.last().expect("nodes").position;
    assert_small("sideways", end.x.hypot(end.y) / 100.0, 1e-4);
    assert_close("depth", -end.z, 100.0 + (2.0e4 * 100.0 + 0.5 * 700.0 * 100.0 * 100.0) / 3.0e7, 1e-6);
    scene["lines"][0]["constraints"] = json!([{"s": 100.0, "force": [5.0e4, 0.0, 0.0]}]);
    let outputs = settled(&scene).outputs();
    assert_close("sideways force", outputs.force.x, 5.0e4, 1e-5);
    assert_close("downward force", -outputs.force.z, 700.0 * 100.0 + 2.0e4, 1e-6);
}

/// Source: Archimedes. A ball half as heavy as its water floats with its centre at the surface, but for the half per cent that the rope
/// below it weighs; a heavy one rests on the bed.
#[test]
fn a_ball_floats_half_wet_and_a_clump_rests_on_the_bed() {
    let scene = |body: Value| {
        json!({
            "environment": {"depth": 50.0, "water_density": 1000.0, "gravity": 10.0},
            "line_types": {"rope": {"ea": 1.0e6, "mass": 1.0, "diameter": 0.03, "submerged_weight": 1.0}},
            "lines": [{"fairlead": [0, 0, -30], "anchor": [60, 0, -50], "sections": [{"type": "rope", "length": 110, "elements": 22}],
                       "attachments": [body]}],
        })
    };
    let line = settled(&scene(json!({"s": 50.0, "mass": 2000.0, "volume": 4.0})));
    let ball = nodes_at(&line, 50.0)[0].position;
    let diameter = (6.0 * 4.0 / std::f64::consts::PI).cbrt();
    assert_small("height of the centre, of the diameter", ball.z / diameter, 5e-3);
    let line = settled(&scene(json!({"s": 50.0, "mass": 2000.0, "volume": 0.3})));
    let clump = nodes_at(&line, 50.0)[0].position;
    assert_small("height above the bed", clump.z + 50.0, 1e-3);
}

/// Source: equilibrium of forces at the end of a line without weight: drag ½ρSV² across, net weight down; Morison drag of a body.
#[test]
fn a_body_on_a_line_in_a_current_stands_at_the_angle_of_its_forces() {
    let drag = 0.5 * 1000.0 * 0.8 * 1.5 * 1.5;
    let scene = json!({
        "environment": {"depth": 500.0, "surface": "none", "water_density": 1000.0, "gravity": 10.0,
                        "current": [{"z": 0.0, "velocity": [0.0, 1.5, 0.0]}]},
        "line_types": {"rope": {"ea": 1.0e7, "mass": 0.001, "diameter": 0.001, "submerged_weight": 0.0}},
        "lines": [{"fairlead": [0, 0, 0], "anchor": [0, 0, -99], "sections": [{"type": "rope", "length": 100, "elements": 5}],
                   "attachments": [{"s": 100.0, "mass": 500.0, "volume": 0.4, "drag_area": 0.8, "added_mass": 200.0}],
                   "constraints": [{"s": 100.0}]}],
    });
    let outputs = settled(&scene).outputs();
    assert_close("drag", outputs.force.y, drag, 1e-6);
    assert_close("weight", -outputs.force.z, 1000.0, 1e-6);
}

/// Source: tensioned beam with pinned ends and a load P in the middle (Timoshenko): sag PL/4T (1 - tanh(u)/u), u = L/2 √(T/EI), here 40 %
/// less than that of a rope. The joint under the load hands the moment on; a hinge there would sag 25 % more.
#[test]
fn a_load_on_a_stiff_line_bends_it_as_a_tensioned_beam() {
    let (length, ei, tension, load) = (20.0, 2.0e5, 5.0e4, 10.0);
    let beam = Properties { ei, ..material(1.0e9, 1.0e-3, 0.0) };
    let part = |after_point| Part { properties: beam, lengths: vec![1.0; 10], after_point };
    let mesh = Mesh::of_parts(vec![part(false), part(true)]);
    let last = mesh.nodes() - 1;
    let holding = Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]).body(point_mass(11, load / GRAVITY));
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.stretch(Vector3::zeros(), Vector3::new(length * (1.0 + tension / 1.0e9), 0.0, 0.0));
    rig.settle();
    let u = 0.5 * length * f64::sqrt(tension / ei);
    let sag = load * length / (4.0 * tension) * (1.0 - u.tanh() / u);
    assert_close("sag", -rig.state.u.position(11).z, sag, 1e-3);
    assert_close("tension", rig.fairlead_force().x.abs(), tension, 1e-4);
}

/// The derivative of steps already taken, with a body, springs and a moving lock on the line, against runs along paths that differ by
/// ± 1e-3 of the variation. An axial wave crosses the line in 0.9 s, so that both ends have felt it.
#[test]
fn derivatives_of_steps_are_the_differences_of_runs() {
    let mut scene = hanging(500.0, 400.0, 150.0, Some(12), json!([{"s": 150.0, "mass": 9000.0, "drag_area": 2.0}]));
    scene["lines"][0]["constraints"] = json!([
        {"s": 150.0, "axes": [[1, 1, 0], [0, 1, 1]], "locked": [true, false, false], "stiffness": [0, 3e4, 0],
         "motion": {"period": 4, "sine": [0.2, 0.1, 0], "ramp": 0}},
        {"s": 500.0, "stiffness": [1e5, 1e5, 1e5], "damping": [1e3, 0, 0]},
    ]);
    scene["solver"] = json!({"fixed_step": 0.05, "tolerance": 1e-6});
    let (mut line, _) = simulation(&scene);
    let path = |share: f64| {
        let (along, varied) = (Vector3::new(0.8, 0.1, -0.3), Vector3::new(-0.2, 0.7, 0.4));
        Path::Polynomial { start: 0.0, coefficients: vec![Vector3::zeros(), Vector3::zeros(), along + varied * share] }
    };
    let variation =
        Path::Polynomial { start: 0.0, coefficients: vec![Vector3::zeros(), Vector3::zeros(), Vector3::new(-0.2, 0.7, 0.4)] };
    let from = line.snapshot();
    let steps = line.linearise(2.0, &path(0.0)).unwrap_or_else(|error| panic!("{error}"));
    let found = line.derivative(&steps, &variation).unwrap_or_else(|error| panic!("{error}"));
    let mut run = |share: f64| {
        assert!(line.restore(&from));
        line.advance(2.0, &path(share)).unwrap_or_else(|error| panic!("{error}"));
        line.outputs()
    };
    let (after, before) = (run(1e-3), run(-1e-3));
    assert_close("tension", found.tension, (after.tension - before.tension) / 2e-3, 1e-3);
    assert_close("at the springs", found.anchor_force.x, (after.anchor_force.x - before.anchor_force.x) / 2e-3, 1e-3);
}

/// Source: Airy in deep water and Froude & Krylov: a body at rest at depth z feels (A + ρΩ) a ω² e^(kz) at the least and most; without
/// drag. Its weight is steady. The stretching to the surface adds a share of the order k a = 1e-3.
#[test]
fn a_body_at_rest_in_waves_feels_their_acceleration() {
    let (amplitude, period, z) = (0.01, 6.0, -10.0);
    let scene = json!({
        "environment": {"depth": 400.0, "gravity": 9.81, "water_density": 1000.0,
                        "waves": {"kind": "regular", "amplitude": amplitude, "period": period, "ramp": 0.0}},
        "line_types": {"a": {"ea": 1e7, "mass": 1.0, "diameter": 0.01}},
        "lines": [{"fairlead": [0, 0, 0], "anchor": [0, 0, -100], "sections": [{"type": "a", "length": 100, "elements": 2}]}],
    });
    let loaded = parse(&scene.to_string(), "test.json", std::path::Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let waves = Waves::of(&loaded.scene.environment).expect("the scene has waves");
    let sea = Sea { waves, current: Current::default() };
    let (added_mass, volume) = (700.0, 2.0);
    let body = Body { added_mass, buoyancy: volume * 9.81e3, diameter: Some(1.5), ..point_mass(0, 3000.0) };
    let mut state = State::new(2);
    state.u.set_position(0, &Vector3::new(0.0, 0.0, z));
    let omega = TAU / period;
    let exact = (added_mass + 1000.0 * volume) * amplitude * omega * omega * (omega * omega / 9.81 * z).exp();
    let mut largest = Vector3::<f64>::zeros();
    for step in 0..600 {
        state.clock = Clock { now: 0.01 * step as f64, start: -100.0 };
        let mut force = body.force(&sea, &motion(&state));
        force.z -= body.net_weight();
        largest = largest.sup(&force.abs());
    }
    assert_close("surge", largest.x, exact, 2e-3);
    assert_close("heave", largest.z, exact, 2e-3);
}

/// A bed that nothing touches changes nothing: clumps and buoys that are thrown up and down far above it move to the bit as over one without
/// dampers, also where they rise faster than weight over damping, 0.1 to 1.7 m/s here. (The damper fades in with the penetration; faded "in" by a negative one it once pushed up whatever rose.)
#[test]
fn a_damped_bed_far_below_is_not_felt() {
    for (mass, volume, heave) in [(20.0e3, 4.0, 3.0), (500.0, 0.06, 6.0), (900.0, 2.5, 3.0), (1500.0, 0.4, 1.0)] {
        let run = |damping: f64| {
            let mut scene = hanging(160.0, 90.0, 60.0, Some(12), json!([{"s": 70.0, "mass": mass, "volume": volume}]));
            scene["environment"]["seabed"] = json!({"damping": damping});
            scene["environment"]["depth"] = json!(200.0);
            scene["motion"] = json!({"kind": "sinusoidal", "period": 6, "sine": [0, 0, heave], "ramp": 3});
            let (mut line, path) = simulation(&scene);
            let row = |row: usize| line.advance(0.25 * row as f64, &path).map(|()| line.outputs().tension.to_bits());
            (1..=40).map(row).collect::<Result<Vec<_>, _>>().unwrap_or_else(|error| panic!("{mass} kg: {error}"))
        };
        assert_eq!(run(4.8e4), run(0.0), "{mass} kg, {volume} m³");
    }
}
