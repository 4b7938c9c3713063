//! Seas that meet, spread and are stretched, against closed forms; and what is said about those that cannot be.

use moorline::algebra::triple::Triple;
use moorline::scene::read::{self, Loaded};
use moorline::scene::types::{Seas, Spreading, Stretching, Waves as Kind};
use moorline::sea::clock::Clock;
use moorline::sea::drawing::{drawn, seas};
use moorline::sea::spreading::directions;
use moorline::sea::wave::{Wave, wave_number};
use moorline::sea::waves::Waves;
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
    let angle = |k: f64, wave: &Wave| {
        k * (at.x * wave.direction.cos() + at.y * wave.direction.sin()) - wave.omega * time + wave.phase
    };
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
fn worst(sea: &Waves, waves: &[Wave], depth: f64, stretching: Stretching, height: f64) -> [f64; 3] {
    let deviation = |power: i32| waves.iter().map(|wave| 0.5 * (wave.amplitude * wave.omega.powi(power)).powi(2)).sum::<f64>().sqrt();
    let (mut random, mut worst) = (Random(11), [0.0_f64; 3]);
    for n in 0..600 {
        let z = if n % 2 == 0 { height * (random.next() - 0.3) } else { -depth * random.next().powi(3) };
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
    let twice: Seas = serde_json::from_value(json!([value(SWELL), value(SWELL)])).expect("two seas");
    let [first, second] = &seas(&twice)[..] else { panic!("two seas") };
    assert_eq!(*first, drawn(&serde_json::from_str::<Kind>(SWELL).expect("a sea")));
    assert!(first.waves.iter().zip(&second.waves).all(|(one, other)| one.phase != other.phase));
}

/// Swell and wind sea by cells, and a regular wave one by one: the motion is that of all components under the surface that all make
/// together, within 1e-4 of a standard deviation (measured: 4e-5), under every stretching; the crest is that of each sea, one on the other.
#[test]
fn seas_that_meet_add_up() {
    let depth = 120.0;
    for stretching in EVERY {
        let mut list = json!([value(SWELL), value(WIND_SEA), value(REGULAR)]);
        list[1]["stretching"] = serde_json::to_value(stretching).expect("a word");
        let sea = waves_of(list.clone());
        let all: Vec<Wave> =
            seas(&serde_json::from_value(list).expect("seas")).into_iter().flat_map(|sea| sea.waves).collect();
        assert_eq!((all.len(), sea.components()), (111, 111));
        assert!(!sea.by_cells());
        let [eta, v, a] = worst(&sea, &all, depth, stretching, 5.0);
        println!("{stretching:?}: errors of η, v, ∂v/∂t: {eta:.1e}, {v:.1e}, {a:.1e}");
        assert!(eta < 1e-4 && v < 1e-4 && a < 1e-4, "{stretching:?}: {eta:e} {v:e} {a:e}");
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
/// directions to what the series are good for, 60 by cells to 1e-4 of a standard deviation (measured: 2e-5), in deep and in shallow water.
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
                let errors = worst(&sea, waves, depth, stretching, height);
                println!("{stretching:?}, {} waves, {depth} m: {errors:.1e?}", waves.len());
                assert!(errors.iter().all(|error| *error < allowed), "{stretching:?}, {} waves: {errors:.1e?}", waves.len());
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
        for (z, exact) in [(a, at_crest), (2.0 * a, at_crest), (0.5 * a, half), (0.0, still), (-10.0, still * 0.0 + {
            if stretching == Stretching::Wheeler { shift(-10.0) } else { (-10.0 * k).exp() }
        })] {
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
        drawn(&serde_json::from_value(sea).expect("a sea")).waves
    };
    let long_crested = drawn(&serde_json::from_value(plain.clone()).expect("a sea")).waves;
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
    let all = drawn(&serde_json::from_value(sea).expect("a sea")).waves;
    let errors = worst(&waves, &all, 120.0, Stretching::Wheeler, 5.0);
    println!("{errors:.1e?}");
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
        (json!([{"kind": "jonswap", "hs": 3, "tp": 9, "cut_off": 0.05}]), &["environment.waves[0].cut_off: 0.05 Hz", "above the peak"]),
        (spread(json!({})), &["environment.waves.spreading: spreading without a measure", "`s`", "`deviation_deg`"]),
        (spread(json!({"s": 3, "deviation_deg": 20})), &["environment.waves.spreading", "leave one of them out"]),
        (spread(json!({"s": 0.5})), &["environment.waves.spreading.s: 0.5 is not allowed", "between 1 and 1000"]),
        (spread(json!({"deviation_deg": 90})), &["environment.waves.spreading.deviation_deg: 90", "between 2.6 and 57"]),
        (spread(json!({"s": 3, "directions": 1})), &["environment.waves.spreading.directions: 1", "2 to 100"]),
        (spread(json!({"s": 3, "power": 1})), &["environment.waves", "power", "unknown key"]),
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

/// A seed for all: `set_seed` reaches every random sea of a list and leaves others alone; a scene survives writing.
#[test]
fn a_list_is_written_as_it_was_read() {
    let list = json!([value(SWELL), value(REGULAR), {"kind": "jonswap", "hs": 1, "tp": 5, "spreading": {"s": 4}, "stretching": "none"}]);
    let loaded = scene(list).expect("a scene").scene;
    let written = serde_json::to_string(&loaded).expect("a scene can be written");
    assert_eq!(read::parse(&written, "sea.json", Path::new("."), &[]).expect("as written").scene, loaded);
    let mut seas = loaded.environment.waves.expect("seas");
    assert!(seas.set_seed(42));
    assert_eq!(seas.each().iter().map(Kind::seed).collect::<Vec<_>>(), [Some(42), None, Some(42)]);
    assert!(!Seas::from(seas.each()[1].clone()).set_seed(1));
}
