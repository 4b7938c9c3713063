//! Ends that are clamped to bodies: cantilevers in closed form, at rest and in motion.

use moorline::scene::read::{self, Loaded};
use moorline::solve::group::Group;
use moorline::solve::motion::Ends;
use moorline::solve::part::Part;
use moorline::solve::partition;
use nalgebra::{Matrix3, Vector3};
use serde_json::{Value, json};
use std::path::Path;
use support::mooring::settled;

mod support;

const EI: f64 = 5.0e6;
const LENGTH: f64 = 10.0;
const MASS: f64 = 20.0;

/// A straight beam without weight along `along` from a wall, its far end on a point that is pulled.
fn cantilever(attitude: [f64; 3], pull: Vector3<f64>, stiffness: Value, elements: usize) -> Value {
    let wall = moorline::algebra::rotation::of_angles(&Vector3::from(attitude).map(f64::to_radians));
    let tip: [f64; 3] = (wall * Vector3::x() * LENGTH + Vector3::new(0.0, 0.0, -50.0)).into();
    json!({
        "environment": {"gravity": 1e-7, "water_density": 1e-3, "depth": 100.0, "surface": "none"},
        "line_types": {"beam": {"ea": 1e9, "ei": EI, "mass": MASS, "diameter": 0.1, "submerged_weight": 1e-6}},
        "bodies": [{"name": "wall", "position": [0, 0, -50], "attitude_deg": attitude}],
        "points": [{"name": "tip", "position": tip, "force": <[f64; 3]>::from(pull)}],
        "lines": [{"name": "beam", "fairlead": {"body": "wall", "at": [0, 0, 0], "direction": [2, 0, 0], "stiffness": stiffness},
            "anchor": {"point": "tip"}, "sections": [{"type": "beam", "length": LENGTH, "elements": elements}]}],
        "solver": {"tolerance": 1e-5}
    })
}

fn load(scene: &Value) -> Loaded {
    read::parse(&scene.to_string(), "test", Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A load P across the end of a cantilever: P L³/3EI, and moment P L at the wall; a clamp that gives way adds P L²/k. The clamp of "clamped" gives way
/// as much as a ten-thousandth of an element, and terms of the square of the slope are 1e-4: within 5e-4.
#[test]
fn a_cantilever_bends_as_the_closed_form() {
    let pull = 300.0;
    for (stiffness, softer) in [(json!("clamped"), 0.0), (json!(2e6), 1.0 / 2e6)] {
        let loaded = load(&cantilever([0.0; 3], Vector3::z() * pull, stiffness, 8));
        let (_, outputs) = settled(&loaded);
        let deflection = outputs[0].anchor.z + 50.0;
        let exact = pull * LENGTH.powi(3) / (3.0 * EI) + pull * LENGTH * LENGTH * softer;
        assert!((deflection / exact - 1.0).abs() < 5e-4, "{deflection} m, not {exact} m");
        let moment = outputs[0].moment;
        assert!((moment.y / (-pull * LENGTH) - 1.0).abs() < 5e-4, "{moment:?}");
        assert!((outputs[0].force.z / pull - 1.0).abs() < 1e-4, "{:?}", outputs[0].force);
    }
}

/// Large deflections of a cantilever, Bisshopp & Drucker (1945): deflection and reach over the length for P L²/EI of 1, 2 and 10; their table has
/// three to four digits, so 1e-3. The same on a wall that is turned, with the load turned along: equal to 1e-6.
#[test]
fn a_cantilever_bends_far_as_the_elastica() {
    for (load_, deflection, reach) in [(1.0, 0.3017, 0.9436), (2.0, 0.4935, 0.8394), (10.0, 0.8106, 0.4450)] {
        let pull = load_ * EI / (LENGTH * LENGTH);
        let mut first: Option<Vector3<f64>> = None;
        for attitude in [[0.0; 3], [20.0, -35.0, 110.0]] {
            let wall = moorline::algebra::rotation::of_angles(&Vector3::from(attitude).map(f64::to_radians));
            let loaded = load(&cantilever(attitude, wall * Vector3::z() * pull, json!("clamped"), 16));
            let (mooring, outputs) = settled(&loaded);
            let tip: Vector3<f64> = wall.tr_mul(&(outputs[0].anchor - Vector3::new(0.0, 0.0, -50.0))) / LENGTH;
            assert!((tip.z - deflection).abs() < 1e-3 && (tip.x - reach).abs() < 1e-3, "{tip:?} for {deflection}, {reach}");
            let moment = wall.tr_mul(&outputs[0].moment);
            assert!((moment.y + pull * tip.x * LENGTH).abs() < 1e-3 * pull * LENGTH, "{moment:?}");
            let on_wall = mooring.bodies(0.0, &[], &outputs)[0];
            assert!((wall.tr_mul(&on_wall.moment) - moment).norm() < 1e-9 * moment.norm(), "the body has it, too");
            match first {
                None => first = Some(tip),
                Some(before) => assert!((tip - before).norm() < 1e-6, "{tip:?} and {before:?}"),
            }
        }
    }
}

/// Turning the wall of a beam that is pinned at its far end takes 3 EI/L; the far end feels the pair of forces 3 EI/L².
#[test]
fn a_beam_resists_the_turn_of_its_wall() {
    let mut scene = cantilever([0.0; 3], Vector3::zeros(), json!("clamped"), 8);
    scene["points"][0] = json!({"name": "tip", "position": [LENGTH, 0, -50], "motion": {"kind": "fixed"}});
    // A little weight, which bends it by 2 mm: without any there is nothing but rounding to be in balance.
    scene["line_types"]["beam"]["submerged_weight"] = json!(10.0);
    scene["environment"]["gravity"] = json!(1.0);
    let (mut mooring, _) = settled(&load(&scene));
    let stiffness = mooring.stiffness(0, 0.0).expect("a stiffness");
    for axis in [4, 5] {
        let exact = 3.0 * EI / LENGTH;
        assert!((stiffness[axis][axis] / exact - 1.0).abs() < 1e-3, "{} N·m, not {exact} N·m", stiffness[axis][axis]);
    }
    assert!((stiffness[2][4].abs() / (3.0 * EI / (LENGTH * LENGTH)) - 1.0).abs() < 1e-3, "{}", stiffness[2][4]);
}

/// A wall that pitches at half the first natural frequency, θ = Θ sin Ωt: the beam swings as EI w⁗ = m Ω² w, w(0) = 0, w′(0) = θ, w″(L) = w‴(L) = 0,
/// eased in over many periods so that little else swings: amplitudes of the end and of the moment at the wall within 1 %.
#[test]
fn a_cantilever_on_a_pitching_wall_swings_as_the_beam_equation() {
    let first = 3.516 / (LENGTH * LENGTH) * (EI / MASS).sqrt();
    let (omega, angle) = (0.5 * first, 0.5_f64);
    let period = std::f64::consts::TAU / omega;
    let mut scene = cantilever([0.0; 3], Vector3::zeros(), json!("clamped"), 8);
    scene["bodies"][0]["motion"] =
        json!({"kind": "sinusoidal", "period": period, "sine": [0, 0, 0, 0, angle, 0], "ramp": 20.0 * period});
    scene["points"][0]["mass"] = json!(1e-3);
    scene["solver"] = json!({"tolerance": 1e-4, "max_step": period / 50.0});
    let (mut mooring, _) = settled(&load(&scene));
    let b = (MASS * omega * omega / EI).powf(0.25);
    let (s, c, sh, ch) = ((b * LENGTH).sin(), (b * LENGTH).cos(), (b * LENGTH).sinh(), (b * LENGTH).cosh());
    // w = A (cos bx - cosh bx) + B sin bx + C sinh bx, b (B + C) = Θ.
    let system = Matrix3::new(-(c + ch), -s, sh, s - sh, -c, ch, 0.0, b, b);
    let amplitudes = system.try_inverse().expect("regular") * Vector3::new(0.0, 0.0, angle.to_radians());
    let end = amplitudes.x * (c - ch) + amplitudes.y * s + amplitudes.z * sh;
    let moment = EI * b * b * 2.0 * amplitudes.x;
    let (mut swing, mut turn) = (0.0_f64, 0.0_f64);
    let Part::Group(_) = &mooring.parts[0] else { panic!("a clamped line turns with its body") };
    for row in 1..=1250 {
        let time = period / 50.0 * f64::from(row);
        mooring.parts[0].advance(time).unwrap_or_else(|error| panic!("{error}"));
        let outputs = mooring.parts[0].outputs(0);
        if time > 21.0 * period {
            swing = swing.max((outputs.anchor.z + 50.0).abs());
            turn = turn.max(outputs.moment.y.abs());
        }
    }
    println!("{swing} m for {end}, {turn} N·m for {moment}");
    assert!((swing / end.abs() - 1.0).abs() < 1e-2 && (turn / moment.abs() - 1.0).abs() < 1e-2);
}

/// A beam from a wall to a free body of mass M and moments of inertia J at its tip; its own mass is a thousandth.
fn tip_body(mass: f64, inertia: f64, moment: f64) -> Value {
    let mut scene = cantilever([0.0; 3], Vector3::zeros(), json!("clamped"), 8);
    scene["points"] = json!([]);
    (scene["line_types"]["beam"]["mass"], scene["line_types"]["beam"]["submerged_weight"]) = (json!(1e-4 * mass), json!(1e-9));
    let tip = json!({"name": "tip", "position": [LENGTH, 0, -50], "motion": {"kind": "free"}, "mass": mass,
        "inertia": [inertia, inertia, inertia], "moment": [0, moment, 0]});
    scene["bodies"] = json!([scene["bodies"][0], tip]);
    scene["lines"][0]["anchor"] = json!({"body": "tip", "at": [0, 0, 0], "direction": [-1, 0, 0]});
    scene
}

/// A force P or a moment M on a body that is clamped to the tip of a cantilever: it sinks by P L³/3EI + M L²/2EI and turns by P L²/2EI + M L/EI; the
/// wall has P L + M. To 5e-4 as above (terms of the square of 0.02). Lines have no torsion, and a moment that keeps its axis while the body turns holds
/// nothing upright: a spring in roll does.
#[test]
fn a_free_body_at_the_tip_turns_the_beam() {
    let roll: Vec<Vec<f64>> =
        (0..6).map(|row| (0..6).map(|column| if row == 3 && column == 3 { 1e4 } else { 0.0 }).collect()).collect();
    for (force, moment) in [(0.02 * EI / (LENGTH * LENGTH), 0.0), (0.0, 0.02 * EI / LENGTH)] {
        let mut scene = tip_body(2000.0, 500.0, moment);
        scene["bodies"][1]["force"] = json!([0, 0, -force]);
        scene["bodies"][1]["stiffness"] = json!(roll);
        let (mooring, outputs) = settled(&load(&scene));
        let Part::Group(group) = &mooring.parts[0] else { panic!("a group") };
        let at = group.body(0);
        let turn = moorline::algebra::rotation::angles(&at.rotation).y;
        let sink = -(at.reference.position.z + 50.0);
        let of_turn = (force * LENGTH * LENGTH / 2.0 + moment * LENGTH) / EI;
        let of_sink = (force * LENGTH.powi(3) / 3.0 + moment * LENGTH * LENGTH / 2.0) / EI;
        assert!(
            (turn / of_turn - 1.0).abs() < 5e-4 && (sink / of_sink - 1.0).abs() < 5e-4,
            "{turn} {sink}, not {of_turn} {of_sink}"
        );
        let (wall, tip) = (outputs[0].moment.y, outputs[0].anchor_moment.y);
        assert!((wall.abs() / (force * LENGTH + moment) - 1.0).abs() < 5e-4, "{wall}");
        assert!((tip + moment).abs() < 5e-4 * wall.abs(), "{tip} on the body, which bears {moment}");
    }
}

/// The same body let go in its first mode of bending: K = EI/L³ [12, -6L; -6L, 4L²] against (M, J), period from the zeros of its sinking. A quarter
/// of the beam's mass swings along, 2.5e-4 of M: within 1e-3.
#[test]
fn a_free_body_at_the_tip_swings_with_the_period_of_its_beam() {
    let (mass, inertia) = (2000.0, 8000.0);
    let mut scene = tip_body(mass, inertia, 0.0);
    let (a, b, c) = (12.0 * EI / LENGTH.powi(3), -6.0 * EI / LENGTH.powi(2), 4.0 * EI / LENGTH);
    let (trace, product) = (a / mass + c / inertia, (a * c - b * b) / (mass * inertia));
    let square = 0.5 * (trace - (trace * trace - 4.0 * product).sqrt());
    let period = std::f64::consts::TAU / square.sqrt();
    // Slope per deflection of the mode; pitch is minus the slope.
    let slope = -(a - square * mass) / b;
    scene["solver"] = json!({"tolerance": 1e-5, "max_step": period / 400.0});
    let (mut mooring, _) = settled(&load(&scene));
    let Part::Group(group) = &mut mooring.parts[0] else { panic!("a group") };
    let speed = 0.02;
    group.push(0, Vector3::z() * speed, -Vector3::y() * speed * slope);
    let (mut zeros, mut before) = (Vec::new(), (0.0, 0.0));
    for row in 1..=1300 {
        let time = period / 400.0 * f64::from(row);
        group.advance(time).unwrap_or_else(|error| panic!("{error}"));
        let now = group.body(0).reference.position.z + 50.0;
        if row > 1 && now * before.1 < 0.0 {
            zeros.push(before.0 + (time - before.0) * before.1 / (before.1 - now));
        }
        before = (time, now);
    }
    let found = 2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    println!("{found} s, not {period} s");
    assert!(zeros.len() >= 6 && (found / period - 1.0).abs() < 1e-3, "{found} s, not {period} s");
}

/// Two free bodies on the ends of a beam and nothing else, thrown and spun: momentum and its moment stay what they are, to the tolerance.
#[test]
fn two_free_bodies_on_a_beam_keep_their_momentum() {
    let (mass, inertia) = (2000.0, 8000.0);
    let mut scene = tip_body(mass, inertia, 0.0);
    scene["bodies"][0] = scene["bodies"][1].clone();
    scene["bodies"][0]["name"] = json!("wall");
    scene["bodies"][0]["position"] = json!([0, 0, -50]);
    scene["solver"] = json!({"tolerance": 1e-5, "max_step": 0.01});
    let loaded = load(&scene);
    let part = partition::parts(&loaded.scene).remove(0);
    let mut group = Group::new(&loaded, &part, &[Ends::of_scene(&loaded, 0)]).unwrap_or_else(|error| panic!("{error}"));
    // Nothing weighs anything, so that nothing is out of balance that anybody could measure.
    let _ = group.settle(0.0);
    group.push(0, Vector3::new(0.3, 0.0, 0.2), Vector3::new(0.0, 0.05, 0.02));
    group.push(1, Vector3::new(0.3, 0.1, -0.1), Vector3::new(0.1, -0.05, 0.0));
    let of = |group: &mut Group| {
        let (mut momentum, mut turning) = group.line_momentum(0);
        for number in 0..2 {
            let at = group.body(number);
            let way = at.reference.velocity * mass;
            momentum += way;
            turning += at.reference.position.cross(&way) + at.omega * inertia;
        }
        (momentum, turning)
    };
    group.advance(0.01).unwrap_or_else(|error| panic!("{error}"));
    let (momentum, turning) = of(&mut group);
    let mut worst = [0.0_f64; 2];
    for row in 2..=500 {
        group.advance(0.01 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
        let (p, l) = of(&mut group);
        worst = [worst[0].max((p - momentum).norm() / momentum.norm()), worst[1].max((l - turning).norm() / turning.norm())];
    }
    println!("momentum to {:.1e}, its moment to {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 1e-5 && worst[1] < 1e-4, "{worst:?}");
}
