//! Ends that are clamped to bodies: cantilevers in closed form, at rest and in motion.

use moorline::scene::read::{self, Loaded};
use moorline::solve::part::Part;
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
