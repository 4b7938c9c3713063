//! Waves summed by cells (`sea/near.rs`) against sums of all components by textbook formulas, and whether answers depend on what was asked
//! before.

use moorline::algebra::lanes::Lanes;
use moorline::algebra::real::{MOST_LANES, Real};
use moorline::algebra::triple::Triple;
use moorline::scene::read;
use moorline::scene::types::Stretching;
use moorline::sea::beside::{Beside, Place};
use moorline::sea::clock::Clock;
use moorline::sea::spectrum::Jonswap;
use moorline::sea::wave::{Wave, wave_number};
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use pulp::{Arch, Simd, WithSimd};
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

/// Elevation and velocity anywhere and at any time in three hours within 5e-5 of their standard deviations at the surface, accelerations within 3e-4,
/// in deep, finite and shallow water, for few and for many components. The series that
/// stand for the components leave out 3e-6 of the velocity, rms, and some ten times that of its rate. (Measured: 3e-5 in η, 3e-5 in v; the rate is held
/// to 3e-4.)
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
                assert!(
                    error < if c < 3 { 1e-4 } else { 3e-4 },
                    "depth {depth}, {count} components, {at:?}, t = {time}: {c}: {} {}",
                    found[c],
                    exact[c]
                );
            }
        }
    }
    println!("largest errors of η, v and ∂v/∂t per standard deviation: {worst:?}");
    assert!(worst[0] < 5e-5 && worst[1] < 5e-5, "{worst:?}");
}

/// Seas of all kinds at random: each stretching, depths from shallow to deep, one direction and several, with a handful of waves in a
/// direction of their own that are summed one by one beside the cells. Elevation, velocity and acceleration against the sum of all components, one by
/// one, within 1e-4, 2e-4 and 5e-4 of their standard deviations; rms a tenth of that. (The one-by-one sum leaves out what is faint at
/// a depth; measured: see what is printed.)
#[test]
fn seas_of_all_kinds_are_those_summed_one_by_one() {
    let mut random = Random(23);
    for stretching in [Stretching::Wheeler, Stretching::None, Stretching::Vertical, Stretching::Extrapolation] {
        for (hs, tp, depth, directions) in [(4.0, 10.0, 120.0, 1), (3.0, 7.0, 30.0, 3), (6.0, 12.0, 900.0, 2)] {
            let mut waves = Vec::new();
            for direction in 0..directions {
                let own = jonswap(hs / f64::from(directions).sqrt(), tp * (1.0 + 0.2 * random.next()), 5 + direction as u64, 60);
                waves.extend(own.into_iter().map(|wave| Wave { direction: 0.3 + f64::from(direction), ..wave }));
            }
            let few = jonswap(0.2 * hs, 0.8 * tp, 90, 4);
            waves.extend(few.into_iter().map(|wave| Wave { direction: -1.0, ..wave }));
            let cells = Waves::new(&waves, G, depth, 0.0).stretched(stretching);
            let judge = cells.clone().one_by_one();
            assert!(!cells.by_cells(), "the handful is summed one by one");
            let deviation =
                |power: i32| waves.iter().map(|wave| 0.5 * (wave.amplitude * wave.omega.powi(power)).powi(2)).sum::<f64>().sqrt();
            let (mut worst, mut squares, count) = ([0.0_f64; 3], [0.0_f64; 3], 600);
            for n in 0..count {
                let z = if n % 3 == 0 { 0.6 * hs * (random.next() - 0.7) } else { -depth * random.next().powi(3) };
                let at = Triple { x: 4000.0 * (random.next() - 0.5), y: 4000.0 * (random.next() - 0.5), z };
                let clock = late(10_800.0 * random.next());
                let numbers = |sea: &Waves| {
                    let flow = sea.flow((), &clock, &at).map_or([0.0; 6], |flow| {
                        let (v, a) = (flow.velocity, flow.acceleration);
                        [v.x, v.y, v.z, a.x, a.y, a.z]
                    });
                    (sea.elevation(&clock, at.x, at.y), flow)
                };
                let ((eta, found), (exact_eta, exact)) = (numbers(&cells), numbers(&judge));
                let mut count_in = |kind: usize, error: f64| {
                    let error = error.abs() / deviation(kind as i32);
                    worst[kind] = worst[kind].max(error);
                    squares[kind] += error * error;
                };
                count_in(0, eta - exact_eta);
                (0..6).for_each(|c| count_in(1 + c / 3, found[c] - exact[c]));
            }
            let rms = [0, 1, 2].map(|kind| (squares[kind] / f64::from(count) / if kind > 0 { 3.0 } else { 1.0 }).sqrt());
            println!("{stretching:?}, {depth} m, {directions} directions: largest {worst:?}, rms {rms:?}");
            assert!(worst[0] < 1e-4 && worst[1] < 2e-4 && worst[2] < 5e-4, "{stretching:?}, {depth} m: {worst:?}");
            assert!(rms[0] < 1e-5 && rms[1] < 2e-5 && rms[2] < 5e-5, "{stretching:?}, {depth} m: rms {rms:?}");
        }
    }
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

/// Points that wander, asked for side by side.
struct Wander<'a> {
    sea: &'a Waves,
    beside: &'a mut Beside,
    time: f64,
    places: &'a [[f64; MOST_LANES]; 3],
    wanted: [f64; MOST_LANES],
}

impl WithSimd for Wander<'_> {
    type Output = [[f64; MOST_LANES]; 7];

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Self::Output {
        let Wander { sea, beside, time, places: [x, y, z], wanted } = self;
        let mut rows = [[0.0; MOST_LANES]; 7];
        for first in (0..MOST_LANES).step_by(V::F64_LANES) {
            let place = Place { clock: late(time), at: Triple::load(cpu, [x, y, z], first) };
            let wanted = Lanes::load(cpu, &wanted, first);
            let motions = beside.motions(cpu, sea, MOST_LANES + first, &place, wanted);
            rows.iter_mut().zip(motions).for_each(|(row, of)| of.store(row, first));
            beside.elevation(cpu, sea, MOST_LANES + first, &place, wanted).store(&mut rows[6], first);
        }
        rows
    }
}

/// What points keep is what they would be told if they asked: eight that wander through cells, layers and slots, slowly, in leaps and back in time, under
/// the surface, above it and below all waves, some of them not looked at for a while; in seas by cells, by components, of two directions with a
/// swell, and of one wave. To 1e-9 of the largest: the same polynomials, summed in another order. And whatever they kept before, the bits are those of points that
/// have just begun.
#[test]
fn points_that_keep_the_sea_are_told_the_same() {
    let turned = |waves: Vec<Wave>, direction: f64| waves.into_iter().map(move |wave| Wave { direction, ..wave });
    let wind = jonswap(3.0, 8.0, 5, 60);
    let crossing: Vec<Wave> = turned(wind.clone(), 0.4)
        .chain(turned(jonswap(2.0, 13.0, 6, 50), -1.1))
        .chain([Wave { amplitude: 0.5, omega: 0.5, direction: 2.0, phase: 1.0 }])
        .collect();
    let single = vec![Wave { amplitude: 2.0, omega: 0.6, direction: 0.3, phase: 0.5 }];
    let seas = [
        Waves::new(&wind, G, 90.0, 0.0),
        Waves::new(&wind, G, 30.0, 0.0).stretched(Stretching::Vertical),
        Waves::new(&wind, G, 90.0, 0.0).stretched(Stretching::None),
        Waves::new(&crossing, G, 200.0, 0.0),
        Waves::new(&jonswap(4.0, 10.0, 8, 400), G, 100.0, 0.0),
        Waves::new(&single, G, 50.0, 0.0),
    ];
    let processor = Arch::new();
    let mut random = Random(11);
    for (number, sea) in seas.iter().enumerate() {
        let mut worn = Beside::new(sea, 2 * MOST_LANES, 0).expect("keeps the sea");
        let mut places: [[f64; MOST_LANES]; 3] = [
            [0.0; MOST_LANES].map(|_| 800.0 * random.next()),
            [0.0; MOST_LANES],
            [0.0; MOST_LANES].map(|_| -60.0 * random.next()),
        ];
        let (mut time, mut worst) = (20.0, 0.0_f64);
        for n in 0..600 {
            let leap = if n % 97 == 0 { 40.0 } else { 0.3 };
            places.iter_mut().flatten().for_each(|x| *x += leap * (random.next() - 0.5));
            places[2].iter_mut().for_each(|z| *z = z.clamp(-90.0, 4.0));
            time += if n % 50 == 0 { -7.0 } else { 0.4 * random.next() };
            let wanted = [0.0; MOST_LANES].map(|_: f64| if n % 5 == 0 && random.next() < 0.5 { 0.0 } else { 1.0 });
            let found = processor.dispatch(Wander { sea, beside: &mut worn, time, places: &places, wanted });
            let mut fresh = Beside::new(sea, 2 * MOST_LANES, 0).expect("keeps the sea");
            let begun = processor.dispatch(Wander { sea: &sea.clone(), beside: &mut fresh, time, places: &places, wanted });
            for lane in (0..MOST_LANES).filter(|lane| wanted[*lane] > 0.0) {
                let [x, y, z] = places.map(|row| row[lane]);
                let flow = sea.flow((), &late(time), &Triple { x, y, z });
                let (v, a) =
                    flow.map_or(([0.0; 3], [0.0; 3]), |flow| (flow.velocity.components(()), flow.acceleration.components(())));
                // What reaches no deeper than the floor is asked for no deeper either.
                let deep = z <= sea.floor();
                let all = [v[0], v[1], v[2], a[0], a[1], a[2], sea.elevation(&late(time), x, y)];
                for (c, exact) in all.iter().enumerate().filter(|(c, _)| !deep || *c == 6) {
                    worst = worst.max((found[c][lane] - exact).abs());
                    assert_eq!(found[c][lane].to_bits(), begun[c][lane].to_bits(), "sea {number}, step {n}, lane {lane}, {c}");
                }
            }
        }
        assert!(worst < 1e-9 * 4.0, "sea {number}: {worst:e}");
    }
    let spread: Vec<Wave> = (0..10).flat_map(|n| turned(wind.clone(), 0.1 * f64::from(n))).collect();
    assert!(Beside::new(&Waves::new(&spread, G, 90.0, 0.0), 8, 0).is_none(), "with many directions points ask for themselves");
}

/// A sea of components, and the same with each turned by a millionth of a degree from the one before, which has them summed one by one.
fn scene(components: &[Wave], judge: bool) -> String {
    let turn = if judge { 1e-6 } else { 0.0 };
    let list: Vec<String> = components
        .iter()
        .enumerate()
        .map(|(n, wave)| {
            let (period, phase) = (std::f64::consts::TAU / wave.omega, wave.phase.to_degrees());
            let (amplitude, direction) = (wave.amplitude, 30.0 + turn * n as f64);
            format!(r#"{{"amplitude": {amplitude}, "period": {period}, "direction_deg": {direction}, "phase_deg": {phase}}}"#)
        })
        .collect();
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
    // Not as small as rounding: cells against cells would be.
    assert!(error > 1e-8 && error < 1e-4, "{error}");
    let end = by_cells.outputs();
    assert!(by_cells.restore(&saved.expect("half way")));
    for n in 101..=200 {
        by_cells.advance(0.2 * f64::from(n), &path).expect("a step");
    }
    assert_eq!(by_cells.outputs(), end);
}
