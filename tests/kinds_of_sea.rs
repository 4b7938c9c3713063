//! Seas that meet, spread and are stretched, against closed forms; and what is said about those that cannot be.

use moorline::algebra::stokes::{Coefficients, Stokes, highest};
use moorline::algebra::triple::Triple;
use moorline::scene::read::{self, Loaded};
use moorline::scene::types::{Seas, Spreading, Stretching, Waves as Kind};
use moorline::scene::{current_file, elevation_file};
use moorline::sea::clock::Clock;
use moorline::sea::drawing::{Drawn, drawn, seas};
use moorline::sea::spreading::directions;
use moorline::sea::wave::{Wave, wave_number};
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path as Way;
use moorline::solve::simulation::Simulation;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};
use std::path::Path;

const G: f64 = 9.80665;
const EVERY: [Stretching; 4] = [Stretching::Wheeler, Stretching::None, Stretching::Vertical, Stretching::Extrapolation];
const SWELL: &str = r#"{"kind": "jonswap", "hs": 3, "tp": 14, "gamma": 6, "direction_deg": 20, "components": 60}"#;
const WIND_SEA: &str = r#"{"kind": "pierson-moskowitz", "hs": 2, "tp": 6, "direction_deg": 110, "components": 50}"#;
const REGULAR: &str = r#"{"kind": "regular", "amplitude": 0.5, "period": 8, "direction_deg": -50}"#;

/// The built-in scene with `environment.waves`.
fn scene(waves: Value) -> Result<Loaded, moorline::error::Error> {
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
    scene["environment"]["waves"] = waves;
    read::parse(&scene.to_string(), "sea.json", Path::new("."), &[])
}

fn waves_of(waves: Value) -> Waves {
    let loaded = scene(waves.clone()).unwrap_or_else(|error| panic!("{waves}: {error}"));
    Waves::of(&loaded.scene.environment).expect("a sea in motion")
}

/// The components of a sea alone.
fn alone(sea: Value) -> Drawn {
    let sea: Kind = serde_json::from_value(sea).expect("a sea");
    drawn(&sea, sea.seed().unwrap_or(0), G, 120.0)
}

/// The components of the seas of a list.
fn each(list: Value) -> Vec<Drawn> {
    seas(&scene(list).expect("a scene").scene.environment)
}

fn value(text: &str) -> Value {
    serde_json::from_str(text).expect(text)
}

fn late(now: f64) -> Clock {
    Clock { now, start: -1.0e4 }
}

/// Numbers in [0, 1), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// η, v and ∂v/∂t of linear theory under a stretching, all components, with cosh and sinh of the standard library.
fn textbook(waves: &[Wave], depth: f64, stretching: Stretching, time: f64, at: &Triple<f64>) -> (f64, [f64; 6]) {
    let number = |wave: &Wave| wave_number(wave.omega, G, depth);
    let angle =
        |k: f64, wave: &Wave| k * (at.x * wave.direction.cos() + at.y * wave.direction.sin()) - wave.omega * time + wave.phase;
    let elevation: f64 = waves.iter().map(|wave| wave.amplitude * angle(number(wave), wave).cos()).sum();
    let z = at.z.min(elevation);
    let mut sums = [0.0; 6];
    for wave in waves {
        let k = number(wave);
        let speed = wave.amplitude * wave.omega;
        // cosh k(z+d)/sinh kd and sinh k(z+d)/sinh kd.
        let down = |z: f64| (k * z).exp() / -(-2.0 * k * depth).exp_m1();
        let back = |z: f64| (-k * (2.0 * depth + z)).exp() / -(-2.0 * k * depth).exp_m1();
        let (c, d) = (|z: f64| down(z) + back(z), |z: f64| down(z) - back(z));
        let (level, upright) = match stretching {
            Stretching::Wheeler => {
                let z = (z + depth) * depth / (elevation + depth) - depth;
                (c(z), d(z))
            }
            Stretching::None if z > 0.0 => (0.0, 0.0),
            Stretching::Vertical if z > 0.0 => (c(0.0), 1.0),
            Stretching::Extrapolation if z > 0.0 => (c(0.0) + z * k, 1.0 + z * k * c(0.0)),
            _ => (c(z), d(z)),
        };
        let ((sin, cos), (sin_b, cos_b)) = (angle(k, wave).sin_cos(), wave.direction.sin_cos());
        let of = [cos * cos_b, cos * sin_b, sin, sin * cos_b, sin * sin_b, -cos];
        for c in 0..6 {
            sums[c] += of[c] * speed * if c % 3 == 2 { upright } else { level } * if c < 3 { 1.0 } else { wave.omega };
        }
    }
    (elevation, sums)
}

fn motion(sea: &Waves, time: f64, at: &Triple<f64>) -> [f64; 6] {
    sea.flow((), &late(time), at).map_or([0.0; 6], |flow| {
        let (v, a) = (flow.velocity, flow.acceleration);
        [v.x, v.y, v.z, a.x, a.y, a.z]
    })
}

/// Largest errors of elevation and motion at random places and times, per standard deviation at the surface. Places within a millimetre of
/// still water or the surface are left out: there `none` jumps.
fn worst(sea: &Waves, waves: &[Wave], depth: f64, stretching: Stretching, height: f64, lowest: f64) -> [f64; 3] {
    let deviation =
        |power: i32| waves.iter().map(|wave| 0.5 * (wave.amplitude * wave.omega.powi(power)).powi(2)).sum::<f64>().sqrt();
    let (mut random, mut worst) = (Random(11), [0.0_f64; 3]);
    for n in 0..600 {
        let z = if n % 2 == 0 { height * (random.next() - 0.3) } else { -lowest * random.next().powi(3) };
        let at = Triple { x: 2000.0 * (random.next() - 0.5), y: 2000.0 * (random.next() - 0.5), z };
        let time = 5000.0 * random.next();
        let (elevation, exact) = textbook(waves, depth, stretching, time, &at);
        if z.abs() < 1e-3 || elevation.abs() < 1e-3 {
            continue;
        }
        worst[0] = worst[0].max((sea.elevation(&late(time), at.x, at.y) - elevation).abs() / deviation(0));
        for (c, (found, exact)) in motion(sea, time, &at).into_iter().zip(exact).enumerate() {
            worst[1 + c / 3] = worst[1 + c / 3].max((found - exact).abs() / deviation(1 + c as i32 / 3));
        }
    }
    worst
}

/// A list of one sea is that sea, to the bit; in a list of two the first is as alone, and the second, though its seed is the same, has other phases.
#[test]
fn a_list_of_one_sea_is_that_sea() {
    let (one, list) = (waves_of(value(SWELL)), waves_of(json!([value(SWELL)])));
    let at = Triple { x: 30.0, y: -12.0, z: -4.0 };
    for time in [0.3, 77.0, 5000.0] {
        assert_eq!(motion(&one, time, &at).map(f64::to_bits), motion(&list, time, &at).map(f64::to_bits));
        assert_eq!(one.elevation(&late(time), 1.0, 2.0).to_bits(), list.elevation(&late(time), 1.0, 2.0).to_bits());
    }
    assert_eq!((one.crest(), one.floor(), one.mean()), (list.crest(), list.floor(), list.mean()));
    let [first, second] = &each(json!([value(SWELL), value(SWELL)]))[..] else { panic!("two seas") };
    assert_eq!(*first, alone(value(SWELL)));
    assert!(first.waves.iter().zip(&second.waves).all(|(one, other)| one.phase != other.phase));
}

/// Swell and wind sea by cells, and a regular wave one by one: the motion is that of all components under the surface that all make
/// together, within 1e-4 of a standard deviation, and the rate of its velocity, where the cells' polynomials in time are least exact, within 3e-4
/// (measured: 5e-5, 1.2e-4), under every stretching; the crest is that of each sea, one on the other.
#[test]
fn seas_that_meet_add_up() {
    let depth = 120.0;
    for stretching in EVERY {
        let mut list = json!([value(SWELL), value(WIND_SEA), value(REGULAR)]);
        list[1]["stretching"] = serde_json::to_value(stretching).expect("a word");
        let sea = waves_of(list.clone());
        let all: Vec<Wave> = each(list).into_iter().flat_map(|sea| sea.waves).collect();
        assert_eq!((all.len(), sea.components()), (111, 111));
        assert!(!sea.by_cells());
        let [eta, v, a] = worst(&sea, &all, depth, stretching, 5.0, depth);
        println!("{stretching:?}: errors of η, v, ∂v/∂t: {eta:.1e}, {v:.1e}, {a:.1e}");
        assert!(eta < 1e-4 && v < 1e-4 && a < 3e-4, "{stretching:?}: {eta:e} {v:e} {a:e}");
    }
    let crest = |waves: &str| waves_of(value(waves)).crest();
    let together = waves_of(json!([value(SWELL), value(WIND_SEA), value(REGULAR)])).crest();
    assert!((together - crest(SWELL) - crest(WIND_SEA) - crest(REGULAR)).abs() < 1e-9);
}

/// Places and times in any order, forwards and back: the answer of directions that are summed by cells has the same bits, of a worn sea as of a
/// fresh one.
#[test]
fn what_was_asked_before_does_not_matter_where_seas_meet() {
    let sea = waves_of(json!([value(SWELL), value(WIND_SEA), value(REGULAR)]));
    let mut random = Random(3);
    let questions: Vec<(f64, Triple<f64>)> = (0..300)
        .map(|_| (300.0 * random.next(), Triple { x: 200.0 * random.next(), y: 100.0 * random.next(), z: -60.0 * random.next() }))
        .collect();
    let first: Vec<_> = questions.iter().map(|(time, at)| motion(&sea, *time, at).map(f64::to_bits)).collect();
    for ((time, at), first) in questions.iter().zip(&first).rev() {
        assert_eq!(motion(&sea, *time, at).map(f64::to_bits), *first);
        assert_eq!(motion(&sea.clone(), *time, at).map(f64::to_bits), *first);
    }
}

/// Source: linear theory carried to the surface as each stretching says, by cosh and sinh of the standard library: one wave and 30 in all
/// directions to what the series are good for as far down as nothing is left out, 60 by cells, and all at any depth, to 1e-4 of a standard deviation (4e-4 where
/// cells extrapolate; measured 1.8e-4), in deep and in shallow water.
#[test]
fn motions_are_those_of_every_stretching() {
    let cross = |count: usize| -> Vec<Wave> {
        let wave = |n: f64| Wave { amplitude: 0.2 + 0.01 * n, omega: 0.35 + 0.05 * n, direction: 0.7 * n, phase: 1.3 * n };
        (0..count).map(|n| wave(n as f64)).collect()
    };
    let long: Vec<Wave> = cross(60).into_iter().map(|wave| Wave { direction: 0.4, amplitude: 0.3, ..wave }).collect();
    for depth in [200.0, 25.0] {
        for stretching in EVERY {
            for (waves, allowed) in [(&cross(1), 1e-9), (&cross(30), 1e-8), (&long, 1e-4)] {
                let sea = Waves::new(waves, G, depth, 0.0).stretched(stretching);
                assert_eq!(sea.by_cells(), waves.len() == 60);
                let height = 4.0 * waves.iter().map(|wave| 0.5 * wave.amplitude.powi(2)).sum::<f64>().sqrt();
                // Of cells the slope at still water is less exact than the motion.
                let cells = if stretching == Stretching::Extrapolation { 4e-4 } else { 1e-4 };
                let allowed = if sea.by_cells() { cells } else { allowed };
                let errors = worst(&sea, waves, depth, stretching, height, height);
                println!("{stretching:?}, {} waves, {depth} m: {errors:?}", waves.len());
                assert!(errors.iter().all(|error| *error < allowed), "{stretching:?}, {} waves: {errors:?}", waves.len());
                let deep = worst(&sea, waves, depth, stretching, height, depth);
                assert!(deep.iter().all(|error| *error < cells), "{stretching:?}, {} waves, at any depth: {deep:?}", waves.len());
            }
        }
    }
}

/// Source: orbital motion under the crest of a deep-water wave, a ω e^(kz′): at the crest itself a ω (wheeler, vertical), a ω (1 + k a) (extrapolation)
/// and 0 (none); at half the crest's height the same but a ω (1 + k a/2); at still water a ω e^(-ka) (wheeler: z′ = -a in deep water), else a ω; above the
/// crest as at it. 1e-9.
#[test]
fn the_crest_moves_as_fast_as_each_stretching_says() {
    let wave = Wave { amplitude: 3.0, omega: 0.9, direction: 0.0, phase: 0.0 };
    let (depth, a) = (2000.0, wave.amplitude);
    let (speed, k) = (a * wave.omega, wave.omega.powi(2) / G);
    let shift = |z: f64| (k * ((z + depth) * depth / (depth + a) - depth)).exp();
    for (stretching, at_crest, half, still) in [
        (Stretching::Wheeler, 1.0, shift(0.5 * a), shift(0.0)),
        (Stretching::None, 0.0, 0.0, 1.0),
        (Stretching::Vertical, 1.0, 1.0, 1.0),
        (Stretching::Extrapolation, 1.0 + k * a, 1.0 + 0.5 * k * a, 1.0),
    ] {
        let sea = Waves::new(&[wave], G, depth, 0.0).stretched(stretching);
        let below = if stretching == Stretching::Wheeler { shift(-10.0) } else { (-10.0 * k).exp() };
        for (z, exact) in [(a, at_crest), (2.0 * a, at_crest), (0.5 * a, half), (0.0, still), (-10.0, below)] {
            let found = motion(&sea, 0.0, &Triple { x: 0.0, y: 0.0, z })[0] / speed;
            assert!((found - exact).abs() < 1e-9, "{stretching:?} at {z}: {found} {exact}");
        }
    }
}

/// Source: D ∝ cos^2s(θ/2) has mean cos θ = s/(s+1), exact by construction (1e-12), and mean cos 2θ = s(s-1)/((s+1)(s+2)), which M directions meet within
/// 0.7/M; s = 1 has ∫ D = (θ + sin θ)/2π, whose medians they are but for one factor (1e-5: the cells of the integral).
#[test]
fn directions_have_the_moments_of_their_distribution() {
    for s in [1.0, 2.0, 5.0, 10.0, 50.0, 1000.0] {
        for count in [2, 5, 9, 20, 100] {
            let angles = directions(s, count);
            assert_eq!(angles.len(), count);
            assert!(angles.windows(2).all(|pair| pair[1] > pair[0]) && angles.iter().all(|angle| angle.abs() <= PI));
            let mean = |n: f64| angles.iter().map(|angle| (n * angle).cos()).sum::<f64>() / count as f64;
            assert!((mean(1.0) - s / (s + 1.0)).abs() < 1e-12, "s = {s}, {count}: {}", mean(1.0));
            let second = s * (s - 1.0) / ((s + 1.0) * (s + 2.0));
            assert!(count == 2 || (mean(2.0) - second).abs() < 0.7 / count as f64, "s = {s}, {count}: {} {second}", mean(2.0));
            let sine = angles.iter().map(|angle| angle.sin()).sum::<f64>();
            assert!(sine.abs() < 1e-12, "to both sides alike");
        }
    }
    let angles = directions(1.0, 9);
    let median = |n: usize| {
        let (mut low, mut high) = (0.0, PI);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if (middle + middle.sin()) / TAU < (n as f64) / 9.0 { low = middle } else { high = middle }
        }
        low
    };
    let factors: Vec<f64> = (1..5).map(|n| angles[4 + n] / median(n)).collect();
    assert!(factors.iter().all(|factor| (factor / factors[0] - 1.0).abs() < 1e-5), "{factors:?}");
}

/// Spreading turns components and changes nothing else: amplitudes, frequencies and phases keep their bits, and so the energy is kept; the mean
/// cos and sin of the directions about the heading are those of the distribution within a component in each (1/N); long and short waves are spread
/// alike (each half of the spectrum within 2 %). A standard deviation means s = 2/σ² - 1.
#[test]
fn spreading_keeps_the_energy_and_turns_long_and_short_waves_alike() {
    let plain = json!({"kind": "jonswap", "hs": 5, "tp": 11, "seed": 7, "direction_deg": 40, "components": 900});
    let of = |spreading: Value| {
        let mut sea = plain.clone();
        sea["spreading"] = spreading;
        alone(sea).waves
    };
    let long_crested = alone(plain.clone()).waves;
    let spread = of(json!({"s": 8}));
    for (one, other) in long_crested.iter().zip(&spread) {
        assert_eq!(Wave { direction: 0.0, ..*one }, Wave { direction: 0.0, ..*other });
    }
    let energy: f64 = spread.iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum();
    assert!((energy / (25.0 / 16.0) - 1.0).abs() < 1e-12);
    let heading = 40.0_f64.to_radians();
    let mean = |waves: &[Wave], f: fn(f64) -> f64| {
        waves.iter().map(|wave| f(wave.direction - heading)).sum::<f64>() / waves.len() as f64
    };
    for (waves, allowed) in [(&spread[..], 1.0 / 900.0), (&spread[..450], 0.02), (&spread[450..], 0.02)] {
        assert!((mean(waves, f64::cos) - 8.0 / 9.0).abs() < allowed && mean(waves, f64::sin).abs() < allowed);
    }
    let distinct = |waves: &[Wave]| {
        let mut directions: Vec<u64> = waves.iter().map(|wave| wave.direction.to_bits()).collect();
        directions.sort_unstable();
        directions.dedup();
        directions.len()
    };
    assert_eq!((distinct(&long_crested), distinct(&spread), distinct(&of(json!({"s": 8, "directions": 30})))), (1, 9, 30));
    assert_eq!(of(json!({"deviation_deg": 27.0092648925})).len(), 900);
    let deviation = |s: f64| (2.0 / (1.0 + s)).sqrt().to_degrees();
    let given = Spreading { s: None, deviation_deg: Some(deviation(8.0)), directions: 9 };
    assert!((given.exponent() - 8.0).abs() < 1e-12, "{}", given.exponent());
    assert_eq!(of(json!({"s": 8})), spread, "the same for the same seed");
}

/// 900 components in nine directions are summed by cells, and the motion is that of all of them (1e-4 of a standard deviation).
#[test]
fn directions_of_a_spread_sea_are_summed_by_cells() {
    let sea = json!({"kind": "jonswap", "hs": 5, "tp": 11, "components": 900, "spreading": {"deviation_deg": 25}});
    let waves = waves_of(sea.clone());
    assert!(waves.by_cells() && waves.components() == 900);
    let all = alone(sea).waves;
    let errors = worst(&waves, &all, 120.0, Stretching::Wheeler, 5.0, 120.0);
    println!("{errors:?}");
    assert!(errors.iter().all(|error| *error < 1e-4), "{errors:?}");
}

#[test]
fn what_seas_cannot_be_is_named_with_its_place() {
    let spread = |spreading: Value| json!({"kind": "jonswap", "hs": 3, "tp": 10, "spreading": spreading});
    for (waves, words) in [
        (json!([]), &["environment.waves: an empty list", "at least one sea"][..]),
        (json!([value(SWELL), {"kind": "jonswap", "hs": 3, "tp": 0}]), &["environment.waves[1].tp: 0 is not allowed"]),
        (json!([value(SWELL), {"kind": "jonswap", "hs": 3, "tp": 5, "wind": 3}]), &["environment.waves[1].wind", "unknown key"]),
        (json!([value(SWELL), 3]), &["environment.waves[1]", "an object"]),
        (json!([value(SWELL), [1, 2]]), &["environment.waves[1]"]),
        (json!(3), &["environment.waves", "an object { } or a list of them"]),
        (
            json!([{"kind": "jonswap", "hs": 70, "tp": 18}, {"kind": "regular", "amplitude": 60, "period": 20}]),
            &["environment.waves[1].amplitude: with the seas before it 130 m", "bare the seabed", "120 m"],
        ),
        (
            json!([{"kind": "regular", "amplitude": 1, "period": 9, "stretching": "vertical"}, {"kind": "regular", "amplitude": 1, "period": 7, "stretching": "none"}]),
            &["environment.waves[1].stretching: \"none\"", "one stretching", "\"vertical\""],
        ),
        (
            json!({"kind": "regular", "amplitude": 1, "period": 9, "stretching": "wheler"}),
            &["environment.waves", "wheler", "`wheeler`", "`extrapolation`"],
        ),
        (
            json!([{"kind": "jonswap", "hs": 3, "tp": 9, "cut_off": 0.05}]),
            &["environment.waves[0].cut_off: 0.05 Hz", "above the peak"],
        ),
        (spread(json!({})), &["environment.waves.spreading: spreading without a measure", "`s`", "`deviation_deg`"]),
        (spread(json!({"s": 3, "deviation_deg": 20})), &["environment.waves.spreading", "leave one of them out"]),
        (spread(json!({"s": 0.5})), &["environment.waves.spreading.s: 0.5 is not allowed", "between 1 and 1000"]),
        (spread(json!({"deviation_deg": 90})), &["environment.waves.spreading.deviation_deg: 90", "between 2.6 and 57"]),
        (spread(json!({"s": 3, "directions": 1})), &["environment.waves.spreading.directions: 1", "2 to 100"]),
        (spread(json!({"s": 3, "power": 1})), &["environment.waves", "power", "unknown key"]),
        (elevation(record(15, |_| 1.0)), &["environment.waves.series: a record of 15 rows", "at least 16 rows"]),
        (elevation(record(40, |_| 1.0)), &["environment.waves.series: a record without waves", "some energy"]),
        (elevation(record(40, |t| if t == 3.0 { 1.0e16 } else { t.sin() })), &["environment.waves.series[6]", "finite"]),
        (
            elevation(record(40, f64::sin).into_iter().enumerate().filter(|(n, _)| *n != 20).map(|(_, row)| row).collect()),
            &["environment.waves.series[20]: t = 10.5", "a gap after t = 9.5", "0.5"],
        ),
        (
            elevation(record(40, f64::sin).into_iter().map(|[t, eta]| [if t == 5.0 { 4.0 } else { t }, eta]).collect()),
            &["environment.waves.series[10]: t = 4", "times must rise", "4.5"],
        ),
        (
            elevation(record(40, f64::sin).into_iter().map(|[t, eta]| [if t == 5.0 { 5.2 } else { t }, eta]).collect()),
            &["environment.waves.series[10]: t = 5.2", "evenly"],
        ),
        (
            json!({"kind": "elevation", "series": record(400, |t| (TAU * 0.1 * t).cos()), "cut_off": 0.05}),
            &["environment.waves.cut_off: 0.05 Hz", "above the peak", "0.1000 Hz"],
        ),
        (json!({"kind": "elevation"}), &["environment.waves: an elevation without a record", "`path`", "`series`"]),
        (
            json!({"kind": "elevation", "path": "a.csv", "series": [[0, 1]]}),
            &["environment.waves: an elevation with two records", "not both"],
        ),
        (json!({"kind": "elevation", "path": "no-such-file.csv"}), &["no-such-file.csv"]),
        (json!({"kind": "elevation", "file": "a.csv"}), &["environment.waves", "file", "unknown key"]),
        (
            json!({"kind": "regular-5th", "height": 40, "period": 10}),
            &["environment.waves.height: 40 m is not allowed", "breaks at", "long here"],
        ),
        (
            json!({"kind": "regular-5th", "height": 20, "period": 60}),
            &["environment.waves.period: 60 s", "length² / depth³", "up to 40", "too long for the depth"],
        ),
        (
            json!({"kind": "regular-5th", "height": 0, "period": 10}),
            &["environment.waves.height: 0 is not allowed", "greater than 0"],
        ),
        (json!({"kind": "regular-5th", "height": 4, "period": 10, "stretching": "none"}), &["stretching", "unknown key"]),
        (
            json!([{"kind": "regular-5th", "height": 4, "period": 10}, value(SWELL)]),
            &["environment.waves[0]: \"regular-5th\" in a list", "give it alone"],
        ),
        (
            json!({"kind": "regular", "amplitude": 1, "period": 9, "spreading": {"s": 3}}),
            &["environment.waves.spreading", "unknown key"],
        ),
    ] {
        let error = match scene(waves.clone()) {
            Ok(_) => panic!("accepted: {waves}"),
            Err(error) => error,
        };
        assert_eq!(error.exit_code(), 2);
        for word in words {
            assert!(error.to_string().contains(word), "\ncase:     {waves}\nexpected: {word}\ngot:      {error}");
        }
    }
    let warnings = scene(json!([value(SWELL), {"kind": "jonswap", "hs": 9, "tp": 6}])).expect("a scene").warnings;
    assert!(warnings.join("").contains("environment.waves[1]: a wave 9 m high of 6 s would break"), "{warnings:?}");
}

/// Rows of a record every half second.
fn record(count: usize, eta: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..count).map(|n| 0.5 * n as f64).map(|t| [t, eta(t)]).collect()
}

fn elevation(series: Vec<[f64; 2]>) -> Value {
    json!({"kind": "elevation", "series": series})
}

/// A record of a made-up sea with a mean of 0.4 m, read from a file, comes back at its place at all its times, less the mean, but for what the cut-off leaves
/// out: to 1e-6 m where it leaves out nothing (what the series of sine and cosine are good for, 256 of them), summed by cells to 3e-5 m; elsewhere the sea is another. The cut-off leaves
/// out what the energy of the record above it says. Read, the scene holds the rows themselves, as an FMU must.
#[test]
fn an_elevation_comes_back_at_its_place() {
    let mut random = Random(5);
    let lines: Vec<[f64; 3]> = (1..90).map(|n| [0.02 * f64::from(n), 0.3 * random.next(), TAU * random.next()]).collect();
    let eta = |t: f64| {
        0.4 + lines.iter().map(|[f, a, phase]| a * (TAU * f * t + phase).cos() * (-(f - 0.1).abs() * 9.0).exp()).sum::<f64>()
    };
    let rows: Vec<[f64; 2]> = (0..512).map(|n| 100.0 + 0.4 * f64::from(n)).map(|t| [t, eta(t)]).collect();
    let text: String = rows.iter().map(|[t, eta]| format!("{t},{eta}\n")).collect();
    let folder = std::env::temp_dir().join(format!("moorline-elevation-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("gauge.csv"), format!("t,eta\n{text}")).expect("a file");
    let given = json!({"kind": "elevation", "path": "gauge.csv", "at": [40, -25], "direction_deg": 35, "cut_off": 10, "ramp": 0});
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
    scene["environment"]["waves"] = given.clone();
    let loaded = read::parse(&scene.to_string(), "sea.json", &folder, &[]).expect("a scene");
    std::fs::remove_dir_all(&folder).expect("the folder goes");
    let sea = Waves::of(&loaded.scene.environment).expect("a sea in motion");
    let mean = rows.iter().map(|row| row[1]).sum::<f64>() / 512.0;
    let (mut worst, mut by_cells, mut elsewhere) = (0.0_f64, 0.0_f64, 0.0_f64);
    let judge = sea.clone().one_by_one();
    for [t, eta] in &rows {
        by_cells = by_cells.max((sea.elevation(&late(*t), 40.0, -25.0) + mean - eta).abs());
        worst = worst.max((judge.elevation(&late(t + 512.0 * 0.4), 40.0, -25.0) + mean - eta).abs());
        elsewhere = elsewhere.max((sea.elevation(&late(*t), 0.0, 0.0) + mean - eta).abs());
    }
    println!("largest error {worst:.1e} m, by cells {by_cells:.1e} m; elsewhere {elsewhere:.1e} m");
    assert!(worst < 1e-6 && by_cells < 3e-5 && elsewhere > 0.1);
    let Some(Kind::Elevation { path: None, series: Some(series), .. }) =
        loaded.scene.environment.waves.as_ref().and_then(Seas::alone)
    else {
        panic!("the rows are not in the scene")
    };
    assert_eq!(*series, rows);
    let again = serde_json::to_string(&loaded.scene).expect("a scene can be written");
    assert_eq!(read::parse(&again, "sea.json", Path::new("."), &[]).expect("as written").scene, loaded.scene);
    // What a cut-off leaves out, by the sums of Fourier.
    let cut = |cut_off: f64| {
        let mut sea = elevation(rows.clone());
        sea["cut_off"] = json!(cut_off);
        let waves = alone(sea).waves;
        assert!(waves.iter().all(|wave| wave.omega <= TAU * cut_off * 1.000001));
        waves.iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum::<f64>()
    };
    let fourier = |k: usize| {
        let sums = [f64::cos, f64::sin]
            .map(|f| rows.iter().enumerate().map(|(n, row)| row[1] * f(TAU * (k * n % 512) as f64 / 512.0)).sum::<f64>() / 256.0);
        0.5 * (sums[0].powi(2) + sums[1].powi(2))
    };
    let exact: f64 = (1..=61).map(fourier).sum();
    assert!((cut(61.2 / (512.0 * 0.4)) / exact - 1.0).abs() < 1e-9, "{} {exact}", cut(61.2 / (512.0 * 0.4)));
    // Five times the peak unless said otherwise.
    assert_eq!(
        alone(elevation(record(400, |t| (TAU * 0.1 * t).cos()))).waves.iter().filter(|wave| wave.amplitude > 1e-9).count(),
        1
    );
}

/// Lines of a file are named: a gap, a word that is no number, a time that falls, too few columns.
#[test]
fn what_is_wrong_with_a_file_of_water_is_named_with_its_line() {
    let rows = |edit: &dyn Fn(usize) -> Option<String>| -> String {
        let row = |n: usize| edit(n).unwrap_or_else(|| format!("{},{}", 0.5 * n as f64, (n as f64).sin()));
        (0..30).map(|n| row(n) + "\n").collect()
    };
    for (edit, words) in [
        (
            &(|n: usize| (n == 7).then(|| String::from("3.5,NaN"))) as &dyn Fn(usize) -> Option<String>,
            &["line 8", "eta = \"NaN\"", "finite"][..],
        ),
        (&|n: usize| (n == 7).then(|| String::from("2.5,0")), &["line 8", "t = 2.5", "times must rise"]),
        (&|n: usize| (n >= 7).then(|| format!("{},0.1", 0.5 * n as f64 + 2.0)), &["line 8", "t = 5.5", "a gap after t = 3"]),
        (&|n: usize| (n == 7).then(|| String::from("3.5,0,0")), &["line 8", "2 columns t,eta"]),
    ] {
        let error = elevation_file::parse(&rows(edit), "gauge.csv").expect_err("a bad file").to_string();
        assert!(error.contains("gauge.csv"), "{error}");
        assert!(words.iter().all(|word| error.contains(word)), "{words:?}: {error}");
    }
    for (text, words) in [
        ("t,z,u,v,w\n0,0,1,0,0\n0,0,1,0,0\n", &["line 3", "z = 0", "already"][..]),
        ("5,0,1,0,0\n4,0,1,0,0\n", &["line 2", "t = 4", "times must not fall", "t = 5"]),
        ("5,0,1,0,0\n6,0,30,0,0\n", &["line 2", "30.0 m/s", "at most 20 m/s"]),
        ("t,z,u,v\n5,0,1,0\n", &["line 1", "5 columns t,z,u,v,w"]),
        ("5,0,1,inf,0\n6,0,3,0,0\n", &["line 1", "finite"]),
    ] {
        let error = current_file::parse(text, "tide.csv").expect_err("a bad file").to_string();
        assert!(error.contains("tide.csv") && words.iter().all(|word| error.contains(word)), "{words:?}: {error}");
    }
}

fn with_current(current: Value) -> Result<Loaded, moorline::error::Error> {
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
    for (key, value) in current.as_object().into_iter().flatten() {
        scene["environment"][key] = value.clone();
    }
    read::parse(&scene.to_string(), "sea.json", Path::new("."), &[])
}

/// The water moves as the rows say, with or without waves, and at rest as at the start; with waves on it the motions add up, to rounding.
#[test]
fn a_current_over_time_moves_the_water() {
    let rows = json!([[0, 0, 1, 0, 0], [0, -100, 0, 1, 0], [100, 0, -1, 0, 0], [100, -100, 0, -1, 0]]);
    let still = with_current(json!({"current_over_time": {"rows": rows}})).expect("a scene").scene.environment;
    let wavy =
        with_current(json!({"current_over_time": {"rows": rows}, "waves": value(REGULAR)})).expect("a scene").scene.environment;
    let (stream, both, waves) =
        (Waves::of(&still).expect("a current"), Waves::of(&wavy).expect("both"), waves_of(value(REGULAR)));
    assert_eq!(stream.components(), 0);
    let at = Triple { x: 3.0, y: 2.0, z: -25.0 };
    let found = motion(&stream, 75.0, &at);
    for (found, exact) in found.iter().zip([-0.375, -0.125, 0.0, -0.015, -0.005, 0.0]) {
        assert!((found - exact).abs() < 1e-14, "{found} {exact}");
    }
    for ((both, stream), waves) in motion(&both, 75.0, &at).iter().zip(found).zip(motion(&waves, 75.0, &at)) {
        assert!((both - stream - waves).abs() < 1e-14);
    }
    assert_eq!(stream.elevation(&late(75.0), 3.0, 2.0), 0.0);
    let flow = both.flow((), &Clock::at_rest(0.0), &at).expect("the current of the start");
    assert!((flow.velocity.x - 0.75).abs() < 1e-14 && (flow.velocity.y - 0.25).abs() < 1e-14);
}

/// A line in a current that does not change hangs in it as in the same steady current, at rest and 5 s into a run (1e-6 of the tension); one that doubles in
/// the meantime pulls harder.
#[test]
fn a_line_in_a_current_over_time_hangs_as_in_a_steady_one() {
    let profile = |time: f64, factor: f64| json!([[time, 0, 0.8 * factor, 0.6 * factor, 0], [time, -120, 0.2 * factor, 0, 0]]);
    let rows = |factor: f64| {
        let (first, last) = (profile(0.0, 1.0), profile(5.0, factor));
        json!({"rows": [first[0], first[1], last[0], last[1]]})
    };
    let steady = json!([{"z": 0, "velocity": [0.8, 0.6, 0]}, {"z": -120, "velocity": [0.2, 0, 0]}]);
    let tensions = |current: Value| {
        let mut current = current;
        current["depth"] = json!(120);
        let scene = with_current(current).expect("a scene").scene;
        let mut line = Simulation::new(&scene, 0).expect("a line");
        let fairlead = scene.lines[0].fairlead.into();
        line.settle(fairlead, 0.0).expect("an equilibrium");
        let rest = line.outputs().tension;
        for n in 1..=10 {
            line.advance(0.5 * f64::from(n), &Way::Fixed(fairlead)).expect("a step");
        }
        [rest, line.outputs().tension]
    };
    let [exact, same, growing] =
        [json!({"current": steady}), json!({"current_over_time": rows(1.0)}), json!({"current_over_time": rows(2.0)})]
            .map(tensions);
    println!("{exact:?} {same:?} {growing:?}");
    for n in 0..2 {
        assert!((same[n] / exact[n] - 1.0).abs() < 1e-6, "{n}: {same:?} {exact:?}");
    }
    assert!((growing[0] / exact[0] - 1.0).abs() < 1e-6 && (growing[1] / exact[1] - 1.0).abs() > 1e-4, "{growing:?}");
}

#[test]
fn what_a_current_over_time_cannot_be_is_named_with_its_place() {
    for (current, words) in [
        (json!({"current_over_time": {}}), &["environment.current_over_time: a current without rows", "`path`", "`rows`"][..]),
        (json!({"current_over_time": {"rows": []}}), &["environment.current_over_time.rows: an empty list"]),
        (json!({"current_over_time": {"path": "a.csv", "rows": [[0, 0, 0, 0, 0]]}}), &["not both"]),
        (json!({"current_over_time": {"rows": [[0, 0, 1, 0]]}}), &["environment.current_over_time.rows[0]"]),
        (
            json!({"current_over_time": {"rows": [[1, 0, 1, 0, 0], [0, 0, 1, 0, 0]]}}),
            &["environment.current_over_time.rows[1]: t = 0", "must not fall"],
        ),
        (
            json!({"current_over_time": {"rows": [[0, 0, 1, 0, 0]]}, "current": [{"z": 0, "velocity": [1, 0, 0]}]}),
            &["environment.current_over_time: a current beside a current"],
        ),
        (
            json!({"current_over_time": {"rows": [[0, 0, 1, 0, 0]], "every": 3}}),
            &["environment.current_over_time.every", "unknown key"],
        ),
    ] {
        let error = match with_current(current.clone()) {
            Ok(_) => panic!("accepted: {current}"),
            Err(error) => error.to_string(),
        };
        assert!(words.iter().all(|word| error.contains(word)), "{current}: {words:?}: {error}");
    }
}

/// The scheme of 1994 knows steady currents alone, and says so rather than leave the change out.
#[test]
fn the_scheme_of_1994_refuses_a_current_over_time() {
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
    scene["environment"]["current_over_time"] = json!({"rows": [[0, 0, 1, 0, 0]]});
    let sets = ["solver.scheme=cable-1994", "solver.fixed_step=0.05", "environment.surface=none"].map(String::from);
    let error = read::parse(&scene.to_string(), "sea.json", Path::new("."), &sets).expect_err("refused").to_string();
    assert!(error.contains("environment.current_over_time: a current that changes"), "{error}");
}

/// A run longer than a record of the water is warned of, one within it is not; a record of steep waves breaks as other seas do.
#[test]
fn a_run_beyond_a_record_is_warned_of() {
    let warnings = |duration: f64, environment: Value| {
        let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the example");
        scene["run"]["duration"] = json!(duration);
        for (key, value) in environment.as_object().into_iter().flatten() {
            scene["environment"][key] = value.clone();
        }
        read::parse(&scene.to_string(), "sea.json", Path::new("."), &[]).expect("a scene").warnings.join("\n")
    };
    let sea = |height: f64| json!({"waves": [value(REGULAR), elevation(record(400, |t| 0.5 * height * (TAU * 0.1 * t).cos()))]});
    let tide = json!({"current_over_time": {"rows": [[0, 0, 0.1, 0, 0], [100, 0, 0.2, 0, 0]]}});
    assert_eq!((warnings(200.0, sea(2.0)).as_str(), warnings(100.0, tide.clone()).as_str()), ("", ""));
    let beyond = warnings(201.0, sea(2.0));
    assert!(
        beyond.contains("environment.waves[1]: the record goes from t = 0 to 200 s") && beyond.contains("repeats itself"),
        "{beyond}"
    );
    let beyond = warnings(101.0, tide);
    assert!(beyond.contains("environment.current_over_time") && beyond.contains("stays as it is there"), "{beyond}");
    assert!(warnings(100.0, json!({"current_over_time": {"rows": [[0, 0, 0.1, 0, 0]]}})).is_empty());
    // 4 √(15²/2) = 42.4 m of 10 s.
    assert!(warnings(100.0, sea(30.0)).contains("environment.waves[1]: a wave 42.4"), "{}", warnings(100.0, sea(30.0)));
}

/// The period of a wave of the fifth order of a number k and a steepness ε = kH/2.
fn period(k: f64, e: f64, depth: f64) -> f64 {
    let [c0, c2, c4] = Coefficients::new(k * depth).c;
    TAU / ((G * k).sqrt() * (c0 + e * e * (c2 + e * e * c4)))
}

/// Source: Fenton (1985), table 2, for a length of 25/3 depths; six decimals.
#[test]
fn coefficients_of_the_fifth_order_are_fentons() {
    let Coefficients { a, b, c } = Coefficients::new(0.24 * PI);
    for (found, exact) in [
        (a[0][0], 1.208490),
        (a[1][1], 0.799840),
        (a[2][0], -9.105340),
        (a[2][2], 0.368275),
        (a[3][1], -12.196150),
        (a[3][3], 0.058723),
        (a[4][0], 108.467921),
        (a[4][2], -6.941756),
        (a[4][4], -0.074979),
        (b[1][1], 2.502414),
        (b[2][0], -5.731666),
        (b[3][1], -32.407508),
        (b[3][3], 14.033758),
        (b[4][2], -103.445042),
        (b[4][4], 37.200027),
        (c[0], 0.798448),
        (c[1], 1.940215),
        (c[2], -12.970403),
    ] {
        assert!((found - exact).abs() < 1.0e-6, "{found} {exact}");
    }
    // Deep water: (1 + ε²/2 + ε⁴/8)² g/k = c², and 0.141063 of the length is the highest wave.
    let deep = Coefficients::new(50.0);
    assert!((deep.c[1] - 0.5).abs() < 1e-15 && (deep.c[2] - 0.125).abs() < 1e-15);
    assert!((highest(10.0, 1.0e5) - 1.41063).abs() < 1e-3);
    // A published solution of fifth order, H/d = 0.3 and L/d = 8 (T √(g/d) = 8.5184): the harmonics of its surface, times k.
    let (depth, k) = (10.0, TAU / 80.0);
    let wave = Stokes::new(3.0, period(k, 1.5 * k, depth), G, depth).expect("a wave");
    assert!((period(k, 1.5 * k, depth) * (G / depth).sqrt() - 8.5184).abs() < 1e-4);
    for (found, exact) in wave.elevations.iter().zip([1.1085623e-1, 2.7030818e-2, 6.3316832e-3, 2.1243859e-3, 6.2180771e-4]) {
        assert!((found * k / exact - 1.0).abs() < 1e-6, "{} {exact}", found * k);
    }
}

/// The water that lies on the surface stays there, and its pressure is that of the air: what is left of both conditions falls with the sixth power of the
/// steepness (6 ± 0.15 by halving), in shallow, middling and deep water, the motion asked of the sea itself at the surface that it says it has.
#[test]
fn the_surface_of_a_steep_wave_is_one_to_the_fifth_order() {
    for (kd, e) in [(0.8, 0.05), (1.5, 0.1), (6.0, 0.1)] {
        let k = 0.05;
        let depth = kd / k;
        let residual = |e: f64| {
            let period = period(k, e, depth);
            let wave = Stokes::new(2.0 * e / k, period, G, depth).expect("a wave");
            assert!((wave.number / k - 1.0).abs() < 1e-12, "{} {k}", wave.number);
            let sea = Waves::steady(&wave, [0.3, 0.0], G, depth, 0.0);
            let celerity = wave.omega / wave.number;
            let (cos, sin) = (0.3_f64.cos(), 0.3_f64.sin());
            let mut heads = Vec::new();
            let mut through = 0.0_f64;
            for n in 0..48 {
                let along = TAU / k * f64::from(n) / 48.0;
                let at = |along: f64| sea.elevation(&late(0.0), along * cos, along * sin);
                let z = at(along);
                let slope = wave.elevations.iter().enumerate().map(|(j, a)| {
                    let j = (j + 1) as f64;
                    -j * k * a * (j * k * along).sin()
                });
                let slope = slope.sum::<f64>();
                let [vx, vy, w, ..] = motion(&sea, 0.0, &Triple { x: along * cos, y: along * sin, z });
                let u = vx * cos + vy * sin;
                assert!((vy * cos - vx * sin).abs() < 1e-9, "nothing moves along the crest");
                through = through.max((w - (u - celerity) * slope).abs() / celerity);
                heads.push((0.5 * ((u - celerity).powi(2) + w * w) + G * z) / celerity.powi(2));
            }
            let mean = heads.iter().sum::<f64>() / 48.0;
            [through, heads.iter().map(|head| (head - mean).abs()).fold(0.0, f64::max)]
        };
        let (coarse, fine) = (residual(e), residual(0.5 * e));
        let order = [0, 1].map(|n| (coarse[n] / fine[n]).log2());
        println!("kd = {kd}: {coarse:?} {fine:?}, order {order:.2?}");
        assert!(order.iter().all(|order| (order - 6.0).abs() < 0.15), "kd = {kd}: {order:?}");
    }
}

/// A low wave of the fifth order is the regular one (second order in steepness: ε = 2e-5 of the motion, 3e-5 allowed); a steep one is as high as asked,
/// its crest higher than its trough is deep, and the water moves as the local acceleration says (central differences).
#[test]
fn a_low_wave_of_the_fifth_order_is_a_regular_one() {
    let low =
        waves_of(json!({"kind": "regular-5th", "height": 1e-3, "period": 10, "direction_deg": 25, "phase_deg": 70, "ramp": 0}));
    let linear =
        waves_of(json!({"kind": "regular", "amplitude": 5e-4, "period": 10, "direction_deg": 25, "phase_deg": 70, "ramp": 0}));
    let (mut random, speed) = (Random(2), 5e-4 * TAU / 10.0);
    for _ in 0..100 {
        let at = Triple { x: 300.0 * random.next(), y: 300.0 * random.next(), z: -110.0 * random.next() };
        let time = 50.0 * random.next();
        for (c, (one, other)) in motion(&low, time, &at).into_iter().zip(motion(&linear, time, &at)).enumerate() {
            assert!((one - other).abs() < 3e-5 * speed * if c < 3 { 1.0 } else { TAU / 10.0 }, "{one} {other}");
        }
        assert!((low.elevation(&late(time), at.x, at.y) - linear.elevation(&late(time), at.x, at.y)).abs() < 3e-5 * 5e-4);
    }
    let steep = waves_of(json!({"kind": "regular-5th", "height": 15, "period": 11, "ramp": 0}));
    let heights: Vec<f64> = (0..1100).map(|n| steep.elevation(&late(0.01 * f64::from(n)), 0.0, 0.0)).collect();
    let (crest, trough) = (heights.iter().copied().fold(f64::MIN, f64::max), heights.iter().copied().fold(f64::MAX, f64::min));
    assert!((crest - trough - 15.0).abs() < 1e-3 && crest > 8.0 && crest <= steep.crest(), "{crest} {trough}");
    let (at, d) = (Triple { x: 5.0, y: 0.0, z: -9.0 }, 1e-4);
    let [before, here, after] = [-d, 0.0, d].map(|shift| motion(&steep, 4.0 + shift, &at));
    for c in 0..3 {
        assert!(((after[c] - before[c]) / (2.0 * d) - here[3 + c]).abs() < 1e-5);
    }
}

/// A seed for all: `set_seed` reaches every random sea of a list and leaves others alone; a scene survives writing.
#[test]
fn a_list_is_written_as_it_was_read() {
    let list =
        json!([value(SWELL), value(REGULAR), {"kind": "jonswap", "hs": 1, "tp": 5, "spreading": {"s": 4}, "stretching": "none"}]);
    let loaded = scene(list).expect("a scene").scene;
    let written = serde_json::to_string(&loaded).expect("a scene can be written");
    assert_eq!(read::parse(&written, "sea.json", Path::new("."), &[]).expect("as written").scene, loaded);
    let mut seas = loaded.environment.waves.expect("seas");
    assert!(seas.set_seed(42));
    assert_eq!(seas.each().iter().map(Kind::seed).collect::<Vec<_>>(), [Some(42), None, Some(42)]);
    assert!(!Seas::from(seas.each()[1].clone()).set_seed(1));
}

/// `moorline check` tells of each sea what it is: heights and periods of a list and of all together, how it is spread, what of a record is used, how steep a wave
/// of the fifth order is and where it breaks.
#[test]
fn check_tells_of_each_sea() {
    let check = |waves: Value| {
        let program = std::process::Command::new(env!("CARGO_BIN_EXE_moorline"))
            .args(["check", "examples/lindahl-sjoberg.json", "--set", &format!("environment.waves={waves}")])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("the program");
        assert!(program.status.success(), "{}", String::from_utf8_lossy(&program.stderr));
        String::from_utf8(program.stdout).expect("text")
    };
    let list = json!([value(REGULAR), {"kind": "jonswap", "hs": 3, "tp": 10, "spreading": {"s": 8, "directions": 5}}]);
    let spread_so = "spread over 5 directions, s 8.00, standard deviation 27.0 deg";
    // √(3² + 8·0.5²) = 3.317 m.
    for (waves, words) in [
        (list, &["Sea 1: H 1.000 m, T 8.00 s", "Sea 2: Hs 3.000 m", spread_so, "All seas: Hs 3.3"][..]),
        (
            elevation(record(400, |t| 0.5 + (TAU * 0.1 * t).cos() + 0.1 * (TAU * 0.8 * t).cos())),
            &[
                "Sea: H",
                "record at (0, 0) of 400 steps of 0.500000 s",
                "after 200.000000 s",
                "mean of 0.5000 m",
                "0.99 % of its energy, above 0.5000 Hz",
            ],
        ),
        (
            json!({"kind": "regular-5th", "height": 10, "period": 10}),
            &["Sea: H 10.000 m, T 10.00 s, fifth order", "m long, steepness H/L 0.06", "breaks at 2"],
        ),
    ] {
        let text = check(waves.clone());
        for word in words {
            assert!(text.contains(word), "\nexpected: {word}\ngot:      {text}");
        }
    }
}
