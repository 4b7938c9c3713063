//! Waves against closed forms: Morison's force on a fixed segment, lines that pierce the surface, orders in time, state and FMU.

mod support;

use moorline::algebra::sinusoid::Sinusoid;
use moorline::fmi::instance::Instance;
use moorline::fmi::variables::Kind;
use moorline::rod::awash::Surface;
use moorline::rod::physics::Surroundings;
use moorline::rod::properties::Properties;
use moorline::rod::state::Field;
use moorline::scene::read;
use moorline::scene::types::{CurrentPoint, Scene, Scheme};
use moorline::sea::clock::Clock;
use moorline::sea::current::Current;
use moorline::sea::wave::{Wave, wave_number};
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path;
use moorline::solve::newton::motion;
use moorline::solve::simulation::{Outputs, Simulation};
use moorline::solve::snapshot::Snapshot;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::path::Path as FilePath;
use support::*;

const WAVE: Wave = Wave { amplitude: 3.0, omega: TAU / 9.0, direction: 0.44, phase: 0.3 };
const DEPTH: f64 = 40.0;

/// One regular wave by its textbook formulas, with the functions of the standard library.
struct Textbook {
    wave: Wave,
    depth: f64,
    k: f64,
}

impl Textbook {
    fn new(wave: Wave, depth: f64) -> Textbook {
        Textbook { wave, depth, k: wave_number(wave.omega, GRAVITY, depth) }
    }

    fn angle(&self, time: f64, at: &Vector3<f64>) -> f64 {
        let along = at.x * self.wave.direction.cos() + at.y * self.wave.direction.sin();
        self.k * along - self.wave.omega * time + self.wave.phase
    }

    fn elevation(&self, time: f64, at: &Vector3<f64>) -> f64 {
        self.wave.amplitude * self.angle(time, at).cos()
    }

    /// Velocity and acceleration, stretched after Wheeler.
    fn flow(&self, time: f64, at: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let (k, d, omega) = (self.k, self.depth, self.wave.omega);
        let above_bed = (at.z + d) * d / (d + self.elevation(time, at));
        let (sin, cos) = self.angle(time, at).sin_cos();
        let speed = self.wave.amplitude * omega / (k * d).sinh();
        let (level, upright) = (speed * (k * above_bed).cosh(), speed * (k * above_bed).sinh());
        let travel = Vector3::new(self.wave.direction.cos(), self.wave.direction.sin(), 0.0);
        let velocity = travel * (level * cos) + Vector3::z() * (upright * sin);
        (velocity, (travel * (level * sin) - Vector3::z() * (upright * cos)) * omega)
    }
}

/// A pipe with every coefficient, each of its own size.
fn pipe() -> Properties {
    Properties {
        weight: 700.0,
        diameter: 0.2,
        drag_normal: 120.0,
        drag_tangential: 30.0,
        added_normal: 150.0,
        added_tangential: 20.0,
        ..material(1.0e7, 100.0, 1500.0)
    }
}

/// Total force of the water [N] on a line at rest on a curve.
fn force_of_water(rig: &mut Rig, time: f64) -> Vector3<f64> {
    rig.state.clock = Clock { now: time, start: -1.0e4 };
    let mut residual = Field::new(rig.state.u.nodes());
    rig.line.residual(&motion(&rig.state), &mut residual);
    let total: Vector3<f64> = (0..residual.nodes()).map(|node| residual.position(node)).sum();
    let mesh = rig.line.mesh();
    Vector3::z() * (mesh.length * mesh.sections[0].weight_in_air) - total
}

/// Source: Morison's equation with Froude & Krylov's force, f = ρA a + C_m ρA_d a_n + ½ρdC_d |q_n| q_n and so along the line, ρA = b/g
/// of the buoyancy b. The force on a fixed segment over a whole period, in amplitude and phase: along a crest (10 m, on which the wave is one and the
/// same), and short (a millimetre) in any direction; alone and on a current
/// that falls off with depth, of which the waves take no notice. To rounding, and what the series are good for.
#[test]
fn force_on_a_fixed_segment_is_morisons() {
    let book = Textbook::new(WAVE, DEPTH);
    let p = pipe();
    let displaced = (p.weight_in_air - p.weight) / GRAVITY;
    let (crest, any) = (Vector3::new(-WAVE.direction.sin(), WAVE.direction.cos(), 0.0), Vector3::new(2.0, -1.0, 1.5).normalize());
    let centre = Vector3::new(7.0, -3.0, -8.0);
    for (t, length) in [(crest, 10.0), (any, 1e-3)] {
        for stream in [None, Some(Vector3::new(0.6, -0.2, 0.0))] {
            let row = |z: f64, velocity: Vector3<f64>| CurrentPoint { z, velocity: velocity.into() };
            let current = stream.map(|v: Vector3<f64>| Current::new(&[row(0.0, v * 1.4), row(-20.0, v * 0.4)]));
            let waves = Some(Waves::new(&[WAVE], GRAVITY, DEPTH, 0.0));
            let mesh = uniform(p, length, 2);
            let around = Surroundings { current, waves, surface: Some(Surface::new(&mesh)), ..nothing() };
            let mut rig = Rig::new(mesh, around, Holding::none());
            rig.stretch(centre - t * (0.5 * length), centre + t * (0.5 * length));
            let mut largest = 0.0f64;
            for step in 0..36 {
                let time = 9.0 * f64::from(step) / 36.0;
                let (velocity, a) = book.flow(time, &centre);
                let q = velocity + stream.unwrap_or_default();
                let across = |x: &Vector3<f64>| x - t * t.dot(x);
                let qn = across(&q);
                let drag = qn * (p.drag_normal * qn.norm()) + t * (p.drag_tangential * t.dot(&q).abs() * t.dot(&q));
                let inertia = a * displaced + across(&a) * p.added_normal + t * (p.added_tangential * t.dot(&a));
                let exact = (drag + inertia + Vector3::z() * (p.weight_in_air - p.weight)) * length;
                let error = (force_of_water(&mut rig, time) - exact).norm() / exact.norm();
                largest = largest.max(error);
            }
            assert_small("force, relative", largest, 1e-8);
        }
    }
}

/// Source: the same, as harbour engineers know it: under the crest the wave pushes by drag alone, a quarter of a period later by inertia alone,
/// against its travel, and the mean over a period is nil. Deep water, a cylinder along the crest, wave so low that stretching does not matter (k a = 5e-5).
#[test]
fn drag_and_inertia_are_a_quarter_apart() {
    let wave = Wave { amplitude: 1.0e-3, omega: 0.7, direction: 0.0, phase: 0.0 };
    let (k, depth, z) = (0.7 * 0.7 / GRAVITY, 500.0, -5.0);
    let p = pipe();
    let mesh = uniform(p, 10.0, 2);
    let around = Surroundings { waves: Some(Waves::new(&[wave], GRAVITY, depth, 0.0)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none());
    rig.stretch(Vector3::new(0.0, -5.0, z), Vector3::new(0.0, 5.0, z));
    let decay = (k * z).exp();
    let speed = wave.amplitude * wave.omega * decay;
    let mass = (p.weight_in_air - p.weight) / GRAVITY + p.added_normal;
    let quarter = 0.25 * TAU / wave.omega;
    assert_close("drag", force_of_water(&mut rig, 0.0).x, 10.0 * p.drag_normal * speed * speed, 1e-3);
    assert_close("inertia", force_of_water(&mut rig, quarter).x, -10.0 * mass * speed * wave.omega, 1e-3);
    let mean = (0..24).map(|n| force_of_water(&mut rig, quarter * f64::from(n) / 6.0).x).sum::<f64>() / 24.0;
    assert_small("mean force, of the inertia", mean / (10.0 * mass * speed * wave.omega), 1e-3);
}

/// Source: a rod held upright through the surface of a long wave has b (η - z₁) of buoyancy, z₁ its lower end, and Froude & Krylov's b/g ∫ a_z dz,
/// which in closed form is -b/g a ω² cos θ (d + η)/d [cosh k(z′+d)]/(k sinh kd). Elements of 2.5 m, one of them cut: 3 Gauss points on each wet part.
#[test]
fn a_rod_through_the_surface_floats_by_its_wet_length() {
    let wave = Wave { amplitude: 3.0, omega: TAU / 14.0, direction: 0.0, phase: 1.0 };
    let (depth, bottom, top) = (60.0, -20.0, 5.0);
    let book = Textbook::new(wave, depth);
    let p = Properties { weight: 700.0, diameter: 0.2, ..material(1.0e7, 100.0, 1500.0) };
    let buoyancy = p.weight_in_air - p.weight;
    let mesh = uniform(p, top - bottom, 10);
    let waves = Some(Waves::new(&[wave], GRAVITY, depth, 0.0));
    let around = Surroundings { waves, surface: Some(Surface::new(&mesh)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none());
    rig.stretch(Vector3::z() * bottom, Vector3::z() * top);
    for step in 0..28 {
        let time = 0.5 * f64::from(step);
        let eta = book.elevation(time, &Vector3::zeros());
        let stretch = (depth + eta) / depth;
        let profile = |z: f64| (book.k * (z + depth) / stretch).cosh() / (book.k * (book.k * depth).sinh());
        let rate = -wave.amplitude * wave.omega.powi(2) * book.angle(time, &Vector3::zeros()).cos();
        let exact = buoyancy * (eta - bottom + rate * stretch * (profile(eta) - profile(bottom)) / GRAVITY);
        assert_close(&format!("t = {time}"), force_of_water(&mut rig, time).z, exact, 1e-5);
    }
}

/// Source: a level line at half the amplitude above still water is wet where cos θ > ½, a third of the wave length. The wave is so long
/// (k a = 6e-4) that its pressure does not matter. Forty elements on the length: the cubic of the surface is good to 4e-7 of the amplitude.
#[test]
fn a_line_along_a_wave_is_wet_where_the_wave_stands_above_it() {
    let wave = Wave { amplitude: 1.0, omega: 0.0785, direction: 0.0, phase: 0.0 };
    let k = wave_number(wave.omega, GRAVITY, 1.0e5);
    let p = Properties { weight: 700.0, diameter: 0.01, ..material(1.0e7, 100.0, 1500.0) };
    let mesh = uniform(p, TAU / k, 40);
    let waves = Some(Waves::new(&[wave], GRAVITY, 1.0e5, 0.0));
    let around = Surroundings { waves, surface: Some(Surface::new(&mesh)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none());
    for (height, share) in [(0.5, 1.0 / 3.0), (0.0, 0.5), (-0.5, 2.0 / 3.0)] {
        rig.stretch(Vector3::new(0.0, 0.0, height), Vector3::new(TAU / k, 0.0, height));
        for time in [0.0, 17.0, 40.0] {
            assert_close("wet share", force_of_water(&mut rig, time).z / (800.0 * TAU / k), share, 1.5e-3);
        }
    }
}

/// A line that hangs under water, in waves that rise for 20 s.
fn in_waves(scheme: Scheme, step: f64) -> Field {
    let properties = Properties {
        damping: 0.05,
        drag_normal: 25.0,
        added_normal: 6.0,
        drag_tangential: 2.0,
        weight: 100.0,
        ..material(2.0e6, 20.0, 150.0)
    };
    let mesh = uniform(properties, 110.0, 8);
    let last = mesh.nodes() - 1;
    let seas = [WAVE, Wave { amplitude: 1.0, omega: 1.1, direction: 2.0, phase: 0.0 }];
    let around = Surroundings { waves: Some(Waves::new(&seas, GRAVITY, 200.0, 20.0)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    rig.hang(Vector3::new(0.0, 0.0, -70.0), Vector3::new(80.0, 0.0, -10.0));
    let path = rig.held();
    assert_eq!(rig.run(scheme, &path, step, 6.4, |_, _, _| ()), 0, "a step was cut");
    rig.state.u
}

/// Source: the theory of each scheme: the waves reach every stage at its own time. Mean order of the places over two halvings of the step,
/// against another scheme at a much smaller one.
#[test]
fn schemes_keep_their_order_in_waves() {
    let distance =
        |a: &Field, b: &Field| (0..a.nodes()).map(|node| (a.position(node) - b.position(node)).norm()).fold(0.0, f64::max);
    for (scheme, other, longest, wanted) in [
        (Scheme::AdamsMoulton, Scheme::Esdirk3, 0.1, 1.8),
        (Scheme::GeneralizedAlpha, Scheme::Esdirk3, 0.1, 1.8),
        (Scheme::Esdirk3, Scheme::AdamsMoulton, 0.2, 2.3),
    ] {
        let exact = in_waves(other, longest / 64.0);
        let errors = [1.0, 2.0, 4.0].map(|finer| distance(&in_waves(scheme, longest / finer), &exact));
        let order = (errors[0] / errors[2]).log2() / 2.0;
        println!("{scheme:?}: order {order:.2}, errors {errors:?}");
        assert!(order > wanted, "{scheme:?}: order {order}, errors {errors:?}");
    }
}

/// A chain from the surface to the bed in a random sea.
fn random_sea(sets: &[&str]) -> Scene {
    let text = r#"{"environment": {"depth": 60, "waves": {"kind": "jonswap", "hs": 3, "tp": 7, "components": 40, "seed": 4}},
        "line_types": {"rope": {"ea": 1e7, "mass": 20, "diameter": 0.12, "drag": {"normal": 1.2, "tangential": 0.02},
                                "added_mass": {"normal": 1.0}, "damping": 0.01}},
        "lines": [{"fairlead": [0,0,1], "anchor": [90,20,-60], "sections": [{"type": "rope", "length": 120, "elements": 12}]}],
        "run": {"duration": 20}}"#;
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    read::parse(text, "sea.json", FilePath::new("."), &sets).unwrap_or_else(|error| panic!("{error}")).scene
}

fn settled(scene: &Scene, time: f64) -> Simulation {
    let mut line = Simulation::new(scene, 0).unwrap_or_else(|error| panic!("{error}"));
    line.settle(scene.lines[0].fairlead.into(), time).unwrap_or_else(|error| panic!("{error}"));
    line
}

fn advanced(line: &mut Simulation, scene: &Scene, until: f64) -> Outputs {
    line.advance(until, &Path::Fixed(scene.lines[0].fairlead.into())).unwrap_or_else(|error| panic!("{error}"));
    line.outputs()
}

/// Statics is that of calm water, at whatever time; then the sea comes.
#[test]
fn the_line_starts_in_a_calm() {
    let (calm, sea) = (random_sea(&["environment.waves.hs=0"]), random_sea(&[]));
    let (still, at_sea) = (settled(&calm, 0.0).outputs(), settled(&sea, 250.0).outputs());
    assert_close("tension at rest", at_sea.tension, still.tension, 1e-9);
    let (mut calm_line, mut line) = (settled(&calm, 250.0), settled(&sea, 250.0));
    let (still, moved) = (advanced(&mut calm_line, &calm, 270.0), advanced(&mut line, &sea, 270.0));
    assert_small("change of the tension in still water, relative", still.tension / at_sea.tension - 1.0, 1e-6);
    let swing = (moved.tension / at_sea.tension - 1.0).abs();
    assert!(swing > 1e-3, "the sea moves nothing: {swing:.1e}");
}

/// What lies deeper than the waves reach is the same with and without them: 1e-8, a hundredth of what a stage is solved to.
#[test]
fn a_line_below_the_waves_does_not_feel_them() {
    let deep = ["environment.depth=400", "lines[0].fairlead=[0,0,-300]", "lines[0].anchor=[90,20,-361]"];
    let run = |height: &str| {
        let scene = random_sea(&[&deep[..], &[height]].concat());
        let mut line = settled(&scene, 0.0);
        let path = Path::Sinusoidal {
            origin: scene.lines[0].fairlead.into(),
            offset: Sinusoid { omega: 0.9, sine: Vector3::new(1.0, 0.5, 0.3), cosine: Vector3::zeros(), ramp: 5.0 },
        };
        line.advance(8.0, &path).unwrap_or_else(|error| panic!("{error}"));
        line.outputs()
    };
    let (waves, calm) = (run("environment.waves.hs=1"), run("environment.waves.hs=0"));
    assert_close("tension", waves.tension, calm.tension, 1e-8);
    assert_close("tension at the anchor", waves.anchor_tension, calm.anchor_tension, 1e-8);
}

/// State saved in mid-sea, as bytes, and put back into another instance: what follows is the same to the bit.
#[test]
fn a_sea_goes_on_after_a_rollback_as_before() {
    let scene = random_sea(&[]);
    let mut line = settled(&scene, 30.0);
    advanced(&mut line, &scene, 41.3);
    let mut bytes = Vec::new();
    line.snapshot().to_bytes(&mut bytes);
    let first = advanced(&mut line, &scene, 47.0);
    let mut other = settled(&scene, 0.0);
    advanced(&mut other, &scene, 3.0);
    assert!(other.restore(&Snapshot::from_bytes(&bytes).expect("whole")));
    assert_eq!(advanced(&mut other, &scene, 47.0), first);
    assert!(line.restore(&Snapshot::from_bytes(&bytes).expect("whole")));
    assert_eq!(advanced(&mut line, &scene, 47.0), first);
}

/// The FMU lives in the time of its master: begun at 100 s, with a fairlead at rest, it does what the solver alone does from there.
#[test]
fn the_fmu_meets_the_waves_of_its_communication_time() {
    let scene = random_sea(&[]);
    let mut fmu = Instance::of_scene(&scene, false);
    fmu.setup_experiment(None, 100.0, None).expect("an experiment");
    fmu.enter_initialization().expect("initialization");
    fmu.exit_initialization().expect("equilibrium");
    let mut line = settled(&scene, 100.0);
    let tension = 10;
    for step in 1..=150 {
        let until = 100.0 + 0.1 * f64::from(step);
        fmu.do_step(100.0 + 0.1 * f64::from(step - 1), 0.1).expect("a step");
        let alone = advanced(&mut line, &scene, until).tension;
        let mut value = [0.0];
        fmu.get(Kind::Real, &[tension], &mut value).expect("the tension");
        assert!((value[0] / alone - 1.0).abs() < 1e-6, "t = {until}: {} {alone}", value[0]);
    }
}

/// Source: none: a sea of one direction and its mirror image about the line's plane give mirrored forces.
#[test]
fn a_sea_and_its_mirror_image_give_mirrored_forces() {
    let force = |direction: f64| {
        let set = format!("environment.waves.direction_deg={direction}");
        let scene = random_sea(&[&set, "lines[0].anchor=[90,0,-60]"]);
        advanced(&mut settled(&scene, 0.0), &scene, 9.0).force
    };
    let (left, right) = (force(35.0), force(-35.0));
    assert!(left.y.abs() > 1.0, "no force across: {left}");
    assert!((left.x - right.x).abs() < 1e-4 * left.x.abs() && (left.y + right.y).abs() < 1e-4 * left.norm(), "{left} {right}");
}

#[test]
fn a_mesh_is_fine_where_the_waves_are() {
    let scene = random_sea(&["lines[0].sections[0].elements=null", "environment.waves.tp=4"]);
    let calm = random_sea(&["lines[0].sections[0].elements=null", "environment.waves.hs=0"]);
    let first = |scene: &Scene| settled(scene, 0.0).mesh().first().map(|(from, to, count)| (to - from) / *count as f64);
    let (in_sea, in_calm) = (first(&scene).expect("a mesh"), first(&calm).expect("a mesh"));
    let k = wave_number(TAU / 4.0, GRAVITY, 60.0);
    assert!(in_sea * k < PI && in_sea < in_calm, "{in_sea} {in_calm}");
}
