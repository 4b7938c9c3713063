//! 200 random scenes over the whole range of lines: length 10–3000 m, mass 0.05–500 kg/m, EA 1e3–1e10 N, sinking, weightless and
//! floating, from far too long to stretched, fairlead under, at and above the water, with and without current, motion up to 8 % of
//! the length. Nothing may panic, hang or give a number that is not finite; what fails must say where and why.
use moorline::error::Error;
use moorline::scene::check;
use moorline::scene::read::Loaded;
use moorline::scene::types::*;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// A small generator, so that the scenes are the same everywhere (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Random {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        (0..5).for_each(|_| {
            random.share();
        });
        random
    }

    fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Evenly distributed in the logarithm.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn triple(&mut self, size: f64) -> Triple {
        [(); 3].map(|()| size * self.between(-1.0, 1.0))
    }
}

fn line_type(random: &mut Random) -> LineType {
    let mass = random.magnitude(0.05, 500.0);
    let kind = random.share();
    let in_air = mass * 9.80665;
    let weight = match kind {
        k if k < 0.1 => 0.0,
        k if k < 0.25 => -in_air * random.between(0.05, 0.9),
        _ => in_air * random.between(0.05, 0.87),
    };
    LineType {
        ea: random.magnitude(1.0e3, 1.0e10),
        mass,
        diameter: (mass / random.between(900.0, 7850.0) * 4.0 / std::f64::consts::PI).sqrt(),
        submerged_weight: Some(weight),
        buoyancy: None,
        ei: 0.0,
        drag: NormalTangential { normal: random.between(0.0, 2.5), tangential: random.between(0.0, 0.3) },
        added_mass: NormalTangential { normal: random.between(0.0, 2.0), tangential: 0.0 },
        damping: if random.share() < 0.5 { 0.0 } else { random.magnitude(1.0e-4, 1.0e-2) },
        tension_strain: None,
        breaking_load: None,
        inner_fluid: None,
        outer_area: None,
        seabed_stiffness: None,
    }
}

fn scene(seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let length = random.magnitude(10.0, 3000.0);
    let depth = length * random.between(0.05, 0.9);
    let chord = length * random.between(0.05, 1.02);
    let drop = if random.share() < 0.8 { depth } else { depth * random.between(0.1, 1.0) };
    let fairlead_z = if random.share() < 0.7 { 0.0 } else { random.between(-0.5, 0.05) * drop };
    let span = (chord * chord - (drop + fairlead_z).powi(2)).max(0.0).sqrt();
    let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
    let current = |random: &mut Random| {
        let velocity = random.triple(1.5);
        let row = |z, share: f64| CurrentPoint { z, velocity: [velocity[0] * share, velocity[1] * share, 0.0] };
        vec![row(0.0, 1.0), row(-depth, 0.2)]
    };
    let amplitude = length * random.magnitude(1.0e-3, 0.08);
    Scene {
        title: format!("random {seed}"),
        environment: Environment {
            gravity: 9.80665,
            water_density: 1025.0,
            depth,
            seabed: Seabed::default(),
            current: if random.share() < 0.4 { current(&mut random) } else { Vec::new() },
            waves: None,
            surface: if random.share() < 0.8 { Surface::Pierced } else { Surface::None },
        },
        line_types: BTreeMap::from([("rope".to_string(), line_type(&mut random))]),
        lines: vec![Line {
            name: "line".to_string(),
            fairlead: [0.0, 0.0, fairlead_z],
            anchor: [span * cos, span * sin, -drop],
            sections: vec![Section { line_type: "rope".to_string(), length, elements: Some(random.between(5.0, 41.0) as usize) }],
            attachments: Vec::new(),
            constraints: Vec::new(),
        }],
        motion: Motion::Sinusoidal {
            period: random.magnitude(4.0, 20.0),
            sine: random.triple(amplitude),
            cosine: [0.0; 3],
            ramp: None,
        },
        run: Run { duration: 2.0, start: 0.0, output_step: random.magnitude(0.05, 0.5) },
        solver: Solver::default(),
    }
}

#[derive(Default)]
struct Tally {
    scenes: usize,
    settled: usize,
    stepped: usize,
    stuck: Vec<String>,
    slowest: Duration,
}

/// Statics, then two seconds of motion from a fairlead that sets off from rest.
fn play(seed: u64, tally: &mut Tally) {
    let scene = scene(seed);
    if check::check(&scene, "random").is_err() {
        return;
    }
    tally.scenes += 1;
    let begin = Instant::now();
    let mut simulation = Simulation::new(&scene, 0).expect("a checked scene");
    let settled = simulation.settle(scene.lines[0].fairlead.into(), 0.0);
    assert!(simulation.outputs().tension.is_finite(), "scene {seed}");
    match settled {
        Err(Error::Statics(_)) => return,
        Err(other) => panic!("scene {seed}: {other}"),
        Ok(report) => assert!(report.converged && report.residual.is_finite(), "scene {seed}"),
    }
    tally.settled += 1;
    let (run, motion) = (scene.run.clone(), None);
    let loaded =
        Loaded { scene, file: "random".into(), directory: ".".into(), motion, deck: None, state: None, warnings: Vec::new() };
    let path = Path::of_scene(&loaded, 0);
    let rows = (run.duration / run.output_step).ceil() as usize;
    for row in 1..=rows {
        match simulation.advance(row as f64 * run.output_step, &path) {
            Ok(()) => {}
            Err(error @ Error::Step(_)) => {
                tally.stuck.push(format!("scene {seed}: {error}"));
                return;
            }
            Err(other) => panic!("scene {seed}: {other}"),
        }
        let outputs = simulation.outputs();
        assert!(outputs.tension.is_finite() && outputs.work.is_finite(), "scene {seed}");
        assert!(simulation.nodes().iter().all(|node| node.position.iter().all(|x| x.is_finite())), "scene {seed}");
    }
    tally.stepped += 1;
    tally.slowest = tally.slowest.max(begin.elapsed());
}

/// Measured: 193 of 200 settle (96.5 %); every one that settles runs. The limits leave a margin of a few scenes for other machines.
#[test]
fn random_lines_settle_and_move_or_say_why_not() {
    let halves = [0, 1].map(|half| {
        std::thread::spawn(move || {
            let mut tally = Tally::default();
            (0..200).filter(|seed| seed % 2 == half).for_each(|seed| play(seed, &mut tally));
            tally
        })
    });
    let tallies = halves.map(|half| half.join().expect("no scene panics"));
    let sum = |f: fn(&Tally) -> usize| tallies.iter().map(f).sum::<usize>();
    let (scenes, settled, stepped) = (sum(|t| t.scenes), sum(|t| t.settled), sum(|t| t.stepped));
    let stuck: Vec<&String> = tallies.iter().flat_map(|t| &t.stuck).collect();
    let slowest = tallies.iter().map(|t| t.slowest).max().unwrap_or_default();
    println!("{scenes} scenes, {settled} settled, {stepped} ran, slowest {slowest:.1?}; stuck: {stuck:#?}");
    assert!(scenes >= 190, "the generator makes scenes that the check refuses: {scenes}");
    assert!(settled * 100 >= scenes * 92, "{settled} of {scenes} settled");
    assert!(stuck.len() <= 1, "{stuck:#?}");
}
