//! Waves summed by cells (`sea/near.rs`) against sums of all components by textbook formulas, and whether answers depend on what was asked
//! before.

use moorline::algebra::triple::Triple;
use moorline::scene::read;
use moorline::sea::clock::Clock;
use moorline::sea::spectrum::Jonswap;
use moorline::sea::wave::{Wave, wave_number};
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use std::path::Path as FilePath;

const G: f64 = 9.80665;

/// Numbers in [0, 1), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn late(now: f64) -> Clock {
    Clock { now, start: -1.0e4 }
}

/// η and [u, v, w] and its local acceleration, all components, with the functions of the standard library.
fn textbook(waves: &[(f64, Wave)], depth: f64, time: f64, at: &Triple<f64>) -> (f64, [f64; 6]) {
    let angle =
        |k: f64, wave: &Wave| k * (at.x * wave.direction.cos() + at.y * wave.direction.sin()) - wave.omega * time + wave.phase;
    let elevation: f64 = waves.iter().map(|(k, wave)| wave.amplitude * angle(*k, wave).cos()).sum();
    let z = ((at.z + depth) * depth / (depth + elevation) - depth).clamp(-depth, 0.0);
    let mut sums = [0.0; 6];
    for (k, wave) in waves {
        let speed = wave.amplitude * wave.omega / (1.0 - (-2.0 * k * depth).exp());
        let (down, back) = ((k * z).exp(), (-k * (2.0 * depth + z)).exp());
        let (level, upright) = (speed * (down + back), speed * (down - back));
        let ((sin, cos), (sin_b, cos_b)) = (angle(*k, wave).sin_cos(), wave.direction.sin_cos());
        let of = [cos * cos_b, cos * sin_b, sin, sin * cos_b, sin * sin_b, -cos];
        for c in 0..6 {
            let height = if c % 3 == 2 { upright } else { level };
            sums[c] += of[c] * height * if c < 3 { 1.0 } else { wave.omega };
        }
    }
    (elevation, sums)
}

fn jonswap(hs: f64, tp: f64, seed: u64, count: usize) -> Vec<Wave> {
    Jonswap { hs, tp, gamma: 3.3 }.waves(seed, count, 0.6)
}

/// Elevation, velocity and acceleration anywhere and at any time in three hours within 1e-4 of their standard deviations at the surface,
/// in deep, finite and shallow water, for few and for many components. (Measured:
/// 1.3e-5. The program leaves out what is faint, of which the textbook sums know nothing.)
#[test]
fn sums_by_cells_are_those_of_all_components() {
    let mut random = Random(7);
    let mut worst = [0.0_f64; 3];
    for (hs, tp, depth, count) in
        [(4.0, 10.0, 120.0, 200), (8.0, 14.0, 400.0, 1000), (2.0, 6.0, 2000.0, 50), (3.0, 12.0, 25.0, 200), (0.1, 1.5, 3.0, 40)]
    {
        let waves = jonswap(hs, tp, 3, count);
        let sea = Waves::new(&waves, G, depth, 0.0);
        assert!(sea.by_cells(), "{count} components");
        let numbered: Vec<(f64, Wave)> = waves.iter().map(|wave| (wave_number(wave.omega, G, depth), *wave)).collect();
        let deviation =
            |power: i32| waves.iter().map(|wave| 0.5 * (wave.amplitude * wave.omega.powi(power)).powi(2)).sum::<f64>().sqrt();
        for n in 0..400 {
            let z = if n % 4 == 0 { hs * (random.next() - 0.5) } else { -depth * random.next().powi(3) };
            let at = Triple { x: 3000.0 * (random.next() - 0.5), y: 3000.0 * (random.next() - 0.5), z };
            let time = 10_800.0 * random.next();
            let (elevation, exact) = textbook(&numbered, depth, time, &at);
            let error = (sea.elevation(&late(time), at.x, at.y) - elevation).abs() / deviation(0);
            worst[0] = worst[0].max(error);
            let flow = sea.flow((), &late(time), &at);
            let found = flow.map_or([0.0; 6], |flow| {
                let (v, a) = (flow.velocity, flow.acceleration);
                [v.x, v.y, v.z, a.x, a.y, a.z]
            });
            for c in 0..6 {
                let error = (found[c] - exact[c]).abs() / deviation(if c < 3 { 1 } else { 2 });
                worst[1 + c / 3] = worst[1 + c / 3].max(error);
                assert!(error < 1e-4, "depth {depth}, {count} components, {at:?}, t = {time}: {c}: {} {}", found[c], exact[c]);
            }
        }
    }
    println!("largest errors of η, v and ∂v/∂t per standard deviation: {worst:?}");
    assert!(worst[0] < 2e-5, "{worst:?}");
}

/// Places and times in any order, forwards and back, more of them than there is room for: each answer has the bits of one that a fresh sea
/// gives.
#[test]
fn answers_do_not_depend_on_what_was_asked_before() {
    let sea = Waves::new(&jonswap(4.0, 9.0, 5, 60), G, 90.0, 0.0);
    let worn = sea.clone();
    let mut random = Random(1);
    let questions: Vec<(Triple<f64>, f64)> = (0..3000)
        .map(|n| {
            let at = Triple { x: 600.0 * random.next(), y: 0.0, z: -90.0 * random.next().powi(2) };
            (at, if n % 3 == 0 { 0.05 * f64::from(n) } else { 400.0 * random.next() })
        })
        .collect();
    let answer = |sea: &Waves, (at, time): &(Triple<f64>, f64)| {
        let flow = sea.flow((), &late(*time), at).expect("in motion");
        let (v, a) = (flow.velocity, flow.acceleration);
        [v.x, v.y, v.z, a.x, a.y, a.z, sea.elevation(&late(*time), at.x, at.y)].map(f64::to_bits)
    };
    let first: Vec<_> = questions.iter().map(|question| answer(&worn, question)).collect();
    for (n, question) in questions.iter().enumerate().rev() {
        assert_eq!(answer(&worn, question), first[n], "asked again, backwards: {question:?}");
    }
    for (n, question) in questions.iter().enumerate().step_by(50) {
        assert_eq!(answer(&sea.clone(), question), first[n], "asked of a fresh sea: {question:?}");
    }
}

/// A sea of components, and the same with one of a hundredth of a micrometre across it, which has them summed one by one.
fn scene(components: &[Wave], judge: bool) -> String {
    let mut list: Vec<String> = components
        .iter()
        .map(|wave| {
            let (period, phase) = (std::f64::consts::TAU / wave.omega, wave.phase.to_degrees());
            format!(r#"{{"amplitude": {}, "period": {period}, "direction_deg": 30, "phase_deg": {phase}}}"#, wave.amplitude)
        })
        .collect();
    if judge {
        list.push(String::from(r#"{"amplitude": 1e-8, "period": 10, "direction_deg": 100}"#));
    }
    let mut text: serde_json::Value =
        serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
    let waves = format!(r#"{{"kind": "components", "ramp": 5, "components": [{}]}}"#, list.join(","));
    text["environment"]["waves"] = serde_json::from_str(&waves).expect("waves");
    text["motion"]["ramp"] = 7.5.into();
    text.to_string()
}

fn settled(components: &[Wave], judge: bool) -> (Simulation, Path) {
    let scene = read::parse(&scene(components, judge), "sea.json", FilePath::new("."), &[]).expect("a scene").scene;
    let mut line = Simulation::new(&scene, 0).expect("a line");
    let fairlead = scene.lines[0].fairlead.into();
    line.settle(fairlead, 0.0).expect("an equilibrium");
    (line, Path::Fixed(fairlead))
}

/// The built-in line in a sea of H_s = 5 m: its tension is that with the components summed one by one, to a tenth of the tolerance (1e-3).
/// A state put back goes on with the same bits.
#[test]
fn a_line_feels_the_same_sea_and_a_state_put_back_the_same_bits() {
    let waves = jonswap(5.0, 10.0, 2, 40);
    let ((mut by_cells, path), (mut judge, _)) = (settled(&waves, false), settled(&waves, true));
    let (mut error, mut sum, mut saved): (f64, f64, _) = (0.0, 0.0, None);
    for n in 1..=200 {
        let time = 0.2 * f64::from(n);
        let tension = [&mut by_cells, &mut judge].map(|line| {
            line.advance(time, &path).expect("a step");
            line.outputs().tension
        });
        error += (tension[0] - tension[1]).powi(2);
        sum += tension[1].powi(2);
        if n == 100 {
            saved = Some(by_cells.snapshot());
        }
    }
    let error = (error / sum).sqrt();
    println!("error of the tension {error:.1e}");
    assert!(error > 0.0 && error < 1e-4, "{error}");
    let end = by_cells.outputs();
    assert!(by_cells.restore(&saved.expect("half way")));
    for n in 101..=200 {
        by_cells.advance(0.2 * f64::from(n), &path).expect("a step");
    }
    assert_eq!(by_cells.outputs(), end);
}
