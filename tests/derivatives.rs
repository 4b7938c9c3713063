//! Every tangent against central differences of what it is the tangent of.

mod support;

use moorline::algebra::block_tridiagonal::BlockTridiagonal;
use moorline::algebra::sinusoid::Sinusoid;
use moorline::rod::awash::Surface;
use moorline::rod::body::Body;
use moorline::rod::friction::Friction;
use moorline::rod::hold::{self, Hold};
use moorline::rod::line::{Line, Supports};
use moorline::rod::mesh::{Mesh, Part};
use moorline::rod::motion::Weights;
use moorline::rod::physics::{self, Surroundings};
use moorline::rod::properties::Properties;
use moorline::rod::seabed::{Plane, Resistance};
use moorline::rod::state::{COMPONENTS, Field, State};
use moorline::rod::touching::Ground;
use moorline::scene::read;
use moorline::scene::types::{CurrentPoint, Stretch};
use moorline::sea::current::Current;
use moorline::sea::wave::Wave;
use moorline::sea::waves::Waves;
use moorline::solve::motion::Path;
use moorline::solve::newton::{Newton, motion};
use moorline::solve::simulation::Simulation;
use nalgebra::Vector3;
use support::*;

/// A small random number generator (Knuth's MMIX constants), so that every run sees the same states.
struct Random(u64);

impl Random {
    /// Uniform in (-1, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.next(), self.next(), self.next())
    }

    /// Positions of size `place` and slopes of size `slope`; tied nodes share their position.
    fn field(&mut self, mesh: &Mesh, place: f64, slope: f64) -> Field {
        let mut field = Field::new(mesh.nodes());
        for node in 0..mesh.nodes() {
            let tied = node > 0 && mesh.elements[node - 1].is_joint();
            let position = if tied { field.position(node - 1) } else { self.vector() * place };
            field.set_position(node, &position);
            field.set_slope(node, &(self.vector() * slope));
        }
        field
    }
}

/// What the water is like.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sea {
    None,
    Still,
    Current,
    /// Waves 15 m long, on a current.
    Waves,
    /// Waves so long that they hardly change from place to place.
    LongWaves,
}

/// One combination of physics.
#[derive(Clone, Copy, Debug)]
struct Physics {
    stretch: Stretch,
    sea: Sea,
    bending: bool,
    bed: Option<Bed>,
    surface: bool,
    joint: bool,
    /// Mean stretch of the line.
    stretched: f64,
}

#[derive(Clone, Copy, Debug)]
struct Bed {
    damping: f64,
    tilt: f64,
    friction: f64,
}

const FLAT_DAMPED: Bed = Bed { damping: 100.0, tilt: 0.0, friction: 0.0 };

const BEDS: [Option<Bed>; 7] = [
    None,
    Some(FLAT_DAMPED),
    Some(Bed { damping: 0.0, tilt: 0.0, friction: 0.0 }),
    Some(Bed { damping: 0.0, tilt: 0.3, friction: 0.0 }),
    Some(Bed { damping: 200.0, tilt: 0.3, friction: 0.0 }),
    Some(Bed { damping: 0.0, tilt: 0.3, friction: 0.6 }),
    Some(Bed { damping: 150.0, tilt: 0.3, friction: 0.6 }),
];

/// All combinations without waves.
fn combinations() -> Vec<Physics> {
    combinations_in(&[Sea::None, Sea::Still, Sea::Current])
}

fn combinations_in(seas: &[Sea]) -> Vec<Physics> {
    let mut all = Vec::new();
    for stretch in [Stretch::Exact, Stretch::Report] {
        for &sea in seas {
            for bending in [false, true] {
                for bed in BEDS {
                    for surface in [false, true] {
                        for joint in [false, true] {
                            for stretched in [1.05, 0.9] {
                                all.push(Physics { stretch, sea, bending, bed, surface, joint, stretched });
                            }
                        }
                    }
                }
            }
        }
    }
    all
}

fn line_of(physics: &Physics) -> Box<dyn Line> {
    let water = if physics.sea == Sea::None { 0.0 } else { 1.0 };
    let rope = Properties {
        ei: if physics.bending { 50.0 } else { 0.0 },
        damping: 0.02,
        weight_in_air: 120.0,
        diameter: 0.3,
        drag_normal: 180.0 * water,
        drag_tangential: 25.0 * water,
        added_normal: 60.0 * water,
        added_tangential: 10.0 * water,
        seabed_stiffness: None,
        folds: false,
        ..material(2.0e4, 12.0, 70.0)
    };
    let other = Properties { ea: 7.0e4, mass: 20.0, weight: 150.0, weight_in_air: 190.0, ..rope };
    let mesh = if physics.joint {
        Mesh::new(vec![rope, other], &[vec![3.0, 4.0], vec![4.0, 3.0, 2.0]])
    } else {
        Mesh::new(vec![rope], &[vec![3.0, 4.0, 4.0, 3.0, 2.0]])
    };
    let row = |z: f64, velocity: [f64; 3]| CurrentPoint { z, velocity };
    let table = [row(-20.0, [0.3, -0.2, 0.0]), row(20.0, [1.3, 0.8, 0.1])];
    let around = Surroundings {
        stretch: physics.stretch,
        current: matches!(physics.sea, Sea::Current | Sea::Waves | Sea::LongWaves).then(|| Current::new(&table)),
        waves: match physics.sea {
            Sea::Waves => Some(Waves::new(&WAVES, 9.81, 30.0, 0.0)),
            Sea::LongWaves => Some(Waves::new(&LONG_WAVES, 9.81, 1.0e6, 0.0)),
            _ => None,
        },
        ground: physics.bed.map(|bed| {
            let normal = Vector3::new(-bed.tilt, 0.5 * bed.tilt, 1.0).normalize();
            let resistance = Resistance { stiffness: 900.0, damping: bed.damping, onset: 0.3, easing: 0.4 };
            let plane = Plane { normal, offset: -0.9 };
            let friction = (bed.friction > 0.0).then(|| Friction::new(bed.friction, &plane, &mesh));
            Ground { plane, resistance: vec![resistance; mesh.elements.len()], friction }
        }),
        surface: physics.surface.then(|| Surface::new(&mesh)),
        planar: false,
    };
    physics::build(mesh.clone(), around, Supports::default())
}

const WAVES: [Wave; 2] = [
    Wave { amplitude: 0.8, omega: 2.0, direction: 0.4, phase: 0.3 },
    Wave { amplitude: 0.3, omega: 3.1, direction: 2.0, phase: 1.0 },
];

/// 1.6e6 m long. At the time of the tests, 0.7 s after the start, they move the water at 2 m/s and hardly raise it.
const LONG_WAVES: [Wave; 2] = [
    Wave { amplitude: 2.0e2, omega: 6.2e-3, direction: 0.4, phase: 1.57 },
    Wave { amplitude: 3.0e2, omega: 6.3e-3, direction: 2.0, phase: -1.57 },
];

/// A random state of a line along x that waves up and down through z = 0; `noise` 1 is rough, 0 smooth.
fn state_of(line: &dyn Line, stretched: f64, noise: f64, random: &mut Random) -> State {
    let mesh = line.mesh();
    let mut state = State::new(mesh.nodes());
    state.clock.now = 0.7;
    state.u = random.field(mesh, 0.15 * noise, 0.1 * noise);
    state.v = random.field(mesh, noise, 0.3 * noise);
    state.a = random.field(mesh, 2.0 * noise, 0.5 * noise);
    let (velocity, acceleration) = (random.vector(), random.vector());
    for node in 0..mesh.nodes() {
        let s = mesh.node_arc_length(node);
        let (place, slope) = (Vector3::new(s, 0.0, 0.8 * (0.5 * s).sin()), Vector3::new(1.0, 0.0, 0.4 * (0.5 * s).cos()));
        state.u.set_position(node, &(state.u.position(node) + place * stretched));
        state.u.set_slope(node, &(state.u.slope(node) + slope * stretched));
        state.v.set_position(node, &(state.v.position(node) + velocity));
        state.a.set_position(node, &(state.a.position(node) + acceleration));
    }
    // Places to hold on to as if half of the line had just moved by up to some breakaway distances.
    state.holds = Field::new(line.holding_nodes());
    line.hold(&state.u, &state.v, &mut state.holds);
    for c in 0..if line.holding_nodes() > 0 { COMPONENTS } else { 0 } {
        state.holds.component_mut(c).iter_mut().for_each(|hold| *hold += 0.1 * random.next());
    }
    state
}

fn residual(line: &dyn Line, state: &State) -> Field {
    let mut out = Field::new(line.mesh().nodes());
    line.residual(&motion(state), &mut out);
    out
}

/// Error of the tangent in a random direction against a central difference with step `d`, relative to their size (of order 1e3 N, but
/// zero by velocity for a dry slack line; hence the 1 N).
fn error(line: &dyn Line, state: &State, weights: &Weights, random: &mut Random, d: f64) -> f64 {
    error_along(line, state, weights, &random.field(line.mesh(), 1.0, 1.0), d)
}

fn error_along(line: &dyn Line, state: &State, weights: &Weights, direction: &Field, d: f64) -> f64 {
    let mut matrix = BlockTridiagonal::new(line.mesh().ties());
    line.tangent(&motion(state), weights, None, &mut matrix);
    let product = times(&matrix, direction);
    let moved = |sign: f64| {
        let mut moved = state.clone();
        moved.u.add(sign * d * weights.u, direction);
        moved.v.add(sign * d * weights.v, direction);
        moved.a.add(sign * d * weights.a, direction);
        residual(line, &moved)
    };
    let mut difference = moved(1.0);
    difference.add(-1.0, &moved(-1.0));
    let size = |field: &Field| field.data().iter().map(|x| x * x).sum::<f64>().sqrt();
    difference.data_mut().iter_mut().for_each(|x| *x /= 2.0 * d);
    let scale = size(&difference);
    difference.add(-1.0, &product);
    size(&difference) / scale.max(1.0)
}

const BY: [(&str, Weights); 4] = [
    ("position", Weights { u: 1.0, v: 0.0, a: 0.0 }),
    ("velocity", Weights { u: 0.0, v: 1.0, a: 0.0 }),
    ("acceleration", Weights { u: 0.0, v: 0.0, a: 1.0 }),
    ("all", Weights { u: 0.3, v: 0.7, a: 1.1 }),
];

/// The worst error over random states of every combination of physics that is asked for.
fn worst(asked: impl Fn(&Physics) -> bool, noise: f64, lift: f64, flat: bool) -> (f64, String) {
    worst_of(combinations().into_iter().filter(asked), &BY, noise, lift, flat)
}

fn worst_of(all: impl Iterator<Item = Physics>, by: &[(&str, Weights)], noise: f64, lift: f64, flat: bool) -> (f64, String) {
    let mut random = Random(7);
    let mut worst = (0.0, String::new());
    for physics in all {
        let line = line_of(&physics);
        for _ in 0..4 {
            let mut state = state_of(line.as_ref(), physics.stretched, noise, &mut random);
            for node in 0..line.mesh().nodes() {
                let (mut place, mut slope) = (state.u.position(node), state.u.slope(node));
                if flat {
                    (place.z, slope.z) = (0.04 * random.next(), 0.02 * random.next());
                }
                place.z += lift;
                state.u.set_position(node, &place);
                state.u.set_slope(node, &slope);
            }
            for (what, weights) in by {
                let error = error(line.as_ref(), &state, weights, &mut random, 1e-6);
                if !(error <= worst.0) {
                    worst = (error, format!("{what} {physics:?}"));
                }
            }
        }
    }
    println!("{:.2e} {}", worst.0, worst.1);
    worst
}

fn damped(physics: &Physics) -> bool {
    physics.bed.is_some_and(|bed| bed.damping > 0.0)
}

/// Central differences of the residual, step 1e-6, for every combination of stretch law, water, bending, bed (flat, sloping, with elements
/// partly on it), joint, taut and slack; rough random states. The cut of an element at the bed is exact, so its tangent is.
/// Measured 5e-8, which is rounding.
#[test]
fn tangent_is_the_change_of_the_residual() {
    let (error, what) = worst(|physics| !physics.surface && !damped(physics), 1.0, 0.0, false);
    assert!(error < 2e-7, "{error:.2e} {what}");
}

/// The same for a line awash over its whole length (|z| < d/2) and for one out of the water. Measured 2.2e-8.
#[test]
fn tangent_of_a_line_awash_is_the_change_of_the_residual() {
    for lift in [0.0, 5.0] {
        let (error, what) = worst(|physics| physics.surface && physics.bed.is_none(), 1.0, lift, true);
        assert!(error < 2e-7, "{error:.2e} {what}");
    }
}

/// The same for a damped flat bed (no tilt: the line is all in it), less deep and deeper than the damper takes to come in.
/// Measured 1.5e-8.
#[test]
fn tangent_of_a_damped_bed_is_the_change_of_the_residual() {
    let bed = |physics: &Physics| physics.bed.is_some_and(|bed| bed.damping == FLAT_DAMPED.damping && bed.tilt == 0.0);
    for lift in [-0.7, -1.2] {
        let (error, what) = worst(|physics| bed(physics) && !physics.surface, 0.1, lift, true);
        assert!(error < 2e-7, "{error:.2e} {what}");
    }
}

/// Where an element is partly awash, or partly on a damped bed, the Gauss points of the cut part move with the cut, which the tangent
/// leaves out: it is then good enough for Newton's method, not exact. Measured 0.1 in
/// slack lines, of which the cut parts are nearly the only stiffness, and 5e-3 in taut ones.
#[test]
fn tangent_of_elements_cut_by_the_surface_or_a_damped_bed_is_near_the_change_of_the_residual() {
    let (error, what) = worst(|physics| physics.surface || damped(physics), 0.1, 0.0, false);
    assert!(error < 0.3, "{error:.2e} {what}");
    let (error, what) = worst(|physics| (physics.surface || damped(physics)) && physics.stretched > 1.0, 0.1, 0.0, false);
    assert!(error < 0.015, "{error:.2e} {what}");
}

/// In waves the tangent by velocity and acceleration is exact, too, their own acceleration included. By position it leaves out that
/// waves change from place to place: nearly exact in waves 1.6e6 m long, and in waves as long as the line, which are the shortest that
/// its mesh resolves, good enough for Newton's method: measured 0.3 of the tangent of slack lines, which have hardly another, and 0.04 of that of
/// taut ones; a step has inertia besides.
#[test]
fn tangent_in_waves_is_the_change_of_the_residual_but_for_their_change_from_place_to_place() {
    let open = |physics: &Physics| !physics.surface && !damped(physics);
    let asked = |sea: Sea| combinations_in(&[sea]).into_iter().filter(open);
    let (error, what) = worst_of(asked(Sea::Waves), &BY[1..3], 1.0, -2.0, false);
    assert!(error < 2e-7, "{error:.2e} {what}");
    let (error, what) = worst_of(asked(Sea::LongWaves), &BY, 1.0, -2.0, false);
    assert!(error < 1e-4, "{error:.2e} {what}");
    let taut = asked(Sea::Waves).filter(|physics| physics.stretched > 1.0);
    let (error, what) = worst_of(taut, &BY, 1.0, -2.0, false);
    assert!(error < 0.05, "{error:.2e} {what}");
}

/// Bodies (dry, awash, wet; on a damped bed; in a current) and holds with skew axes and a moving reference, at the two nodes of a joint
/// and at an end: the change of the residual, central differences of 1e-6 along directions that the locks allow. Locked parts of the
/// residual are zero, and an increment that the tangent gives has no locked part. Measured 2e-7, which is rounding.
#[test]
fn tangent_of_bodies_and_holds_is_the_change_of_the_residual() {
    let mut random = Random(11);
    let rope = Properties { damping: 0.02, ..material(2.0e4, 12.0, 70.0) };
    let part = |lengths: &[f64], after_point| Part { properties: rope, lengths: lengths.to_vec(), after_point };
    let row = |z: f64, velocity: [f64; 3]| CurrentPoint { z, velocity };
    let plane = Plane { normal: Vector3::new(-0.2, 0.1, 1.0).normalize(), offset: -0.9 };
    let mut worst: f64 = 0.0;
    for case in 0..300 {
        let mesh = Mesh::of_parts(vec![part(&[3.0, 4.0], false), part(&[4.0, 3.0, 2.0], true)]);
        let last = mesh.nodes() - 1;
        let body = |node: usize, lift: f64| Body {
            node,
            mass: 30.0,
            added_mass: 20.0,
            weight: 300.0,
            buoyancy: 500.0,
            drag: 250.0,
            diameter: (case % 3 > 0).then_some(0.6 + lift),
            bed: Some((plane, Resistance { stiffness: 2000.0, damping: 150.0, onset: 0.1, easing: 0.5 })),
        };
        let hold = |first: usize, node: usize, locked: [bool; 3], random: &mut Random| Hold {
            first,
            node,
            axes: hold::axes(&[random.vector().into(), random.vector().into()]),
            reference: Some(random.vector()),
            motion: Some(Sinusoid { omega: 0.9, sine: random.vector(), cosine: random.vector(), ramp: 10.0 }),
            stiffness: Vector3::new(900.0, 50.0, 0.0),
            damping: Vector3::new(0.0, 30.0, 700.0),
            locked,
            force: random.vector() * 100.0,
        };
        let locked = [[false; 3], [true, false, false], [false, true, true], [true; 3]][case % 4];
        let holds = vec![hold(2, 3, locked, &mut random), hold(last, last, [false, false, case % 2 == 0], &mut random)];
        let supports = Supports { bodies: vec![body(3, 0.0), body(last, 0.5)], holds: holds.clone(), ..Supports::default() };
        let current = Some(Current::new(&[row(-20.0, [0.3, -0.2, 0.0]), row(20.0, [1.3, 0.8, 0.1])]));
        let line = physics::build(mesh, Surroundings { current, ..nothing() }, supports);
        let mut state = state_of(line.as_ref(), 1.05, 1.0, &mut random);
        state.clock.now = 4.0;
        for (order, field) in [&mut state.u, &mut state.v, &mut state.a].into_iter().enumerate() {
            line.place(order, field, state.clock.now);
        }
        for hold in holds.iter().filter(|hold| hold.locks()) {
            let along =
                |x: Vector3<f64>| (0..3).filter(|axis| hold.locked[*axis]).map(|axis| (hold.axes * x)[axis].abs()).sum::<f64>();
            assert_small("locked residual", along(residual(line.as_ref(), &state).position(hold.node)), 1e-9);
        }
        for (what, weights) in BY {
            let mut direction = random.field(line.mesh(), 1.0, 1.0);
            let still: Vec<Hold> =
                holds.iter().map(|hold| Hold { reference: Some(Vector3::zeros()), motion: None, ..hold.clone() }).collect();
            still.iter().filter(|hold| hold.locks()).for_each(|hold| hold.place(0, &mut direction, 0.0));
            let error = error_along(line.as_ref(), &state, &weights, &direction, 1e-6);
            assert!(error < 6e-7, "case {case}, by {what}: {error:.2e}");
            worst = worst.max(error);
        }
        let mut newton = Newton::new(line.as_ref());
        let at = motion(&state);
        newton.factor(line.as_ref(), &at, &Weights { u: 1.0, v: 0.0, a: 50.0 }, None).expect("regular");
        let mut step = residual(line.as_ref(), &state);
        newton.solve_linear(line.as_ref(), &mut step);
        for hold in holds.iter().filter(|hold| hold.locks()) {
            let along = hold.axes * step.position(hold.node);
            (0..3).filter(|axis| hold.locked[*axis]).for_each(|axis| assert_small("locked part of a step", along[axis], 1e-12));
        }
    }
    println!("worst {worst:.1e}");
}

/// Velocity and acceleration of every kind of fairlead path, by central differences of ± 1e-4 s of position and velocity.
#[test]
fn paths_have_the_rates_of_their_position() {
    let mut random = Random(3);
    let mut vector = || random.vector();
    let paths = [
        Path::Fixed(vector()),
        Path::Sinusoidal { origin: vector(), offset: Sinusoid { omega: 0.42, sine: vector(), cosine: vector(), ramp: 48.75 } },
        Path::Sinusoidal { origin: vector(), offset: Sinusoid { omega: 2.0, sine: vector(), cosine: vector(), ramp: 0.0 } },
        Path::Polynomial { start: 3.0, coefficients: vec![vector(), vector(), vector() * 0.1, vector() * 0.01] },
    ];
    let d = 1e-4;
    for path in paths {
        for time in [0.5, 7.0, 48.0, 60.0] {
            let (before, now, after) = (path.at(time - d), path.at(time), path.at(time + d));
            let velocity = (after.position - before.position) / (2.0 * d);
            let acceleration = (after.velocity - before.velocity) / (2.0 * d);
            assert!((velocity - now.velocity).norm() < 3e-7 * (1.0 + now.velocity.norm()), "{path:?} {time}");
            assert!((acceleration - now.acceleration).norm() < 3e-7 * (1.0 + now.acceleration.norm()), "{path:?} {time}");
        }
    }
}

/// Rates of the outputs of the built-in case at full swing against differences of the outputs over ± 0.02 s, the run being made with a
/// tolerance of 1e-5. Measured: 4e-4 of the rate of the
/// tension, 8e-5 of the others; the rate of the acceleration is a difference over the last step.
#[test]
fn output_rates_are_the_change_of_the_outputs() {
    let loaded =
        read::built_in(&["solver.tolerance=1e-5".to_string(), "solver.max_step=0.01".to_string()]).expect("the built-in scene");
    let mut simulation = Simulation::new(&loaded.scene, 0).expect("the built-in line");
    simulation.sum_up_work();
    let path = Path::of_scene(&loaded, 0);
    simulation.settle(Vector3::zeros(), 0.0).expect("equilibrium");
    let d = 0.02;
    for time in [20.0, 35.0] {
        simulation.advance(time - d, &path).expect("a run");
        let before = simulation.outputs();
        simulation.advance(time, &path).expect("a run");
        let rates = simulation.output_rates();
        simulation.advance(time + d, &path).expect("a run");
        let after = simulation.outputs();
        let per = 0.5 / d;
        for (what, found, exact, allowed) in [
            ("tension", rates.tension, (after.tension - before.tension) * per, 1.2e-3),
            ("force", rates.force.x, (after.force.x - before.force.x) * per, 1.2e-3),
            ("anchor tension", rates.anchor_tension, (after.anchor_tension - before.anchor_tension) * per, 3e-4),
            ("declination", rates.declination, (after.declination - before.declination) * per, 3e-4),
            ("azimuth", rates.azimuth, (after.azimuth - before.azimuth) * per, 3e-4),
            ("work", rates.work, (after.work - before.work) * per, 3e-5),
        ] {
            assert_close(&format!("{what} at {time} s"), found, exact, allowed);
        }
        assert!((rates.fairlead - path.at(time).velocity).norm() < 1e-6);
    }
}
