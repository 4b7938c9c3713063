//! Every tangent against central differences of what it is the tangent of.

mod support;

use moorline::algebra::block_tridiagonal::BlockTridiagonal;
use moorline::rod::element::{Motion, Weights};
use moorline::rod::line::{Line, Supports};
use moorline::rod::mesh::{Mesh, Properties};
use moorline::rod::physics::{self, Surroundings};
use moorline::rod::seabed::{Plane, Resistance};
use moorline::rod::state::{Field, State};
use moorline::rod::touching::{Ground, Surface};
use moorline::scene::read;
use moorline::scene::types::{CurrentPoint, Stretch};
use moorline::sea::current::Current;
use moorline::solve::motion::Path;
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
}

const BEDS: [Option<Bed>; 4] = [
    None,
    Some(Bed { damping: 0.0, tilt: 0.0 }),
    Some(Bed { damping: 0.0, tilt: 0.3 }),
    Some(Bed { damping: 200.0, tilt: 0.3 }),
];

/// All combinations.
fn combinations() -> Vec<Physics> {
    let mut all = Vec::new();
    for stretch in [Stretch::Exact, Stretch::Report] {
        for sea in [Sea::None, Sea::Still, Sea::Current] {
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
        current: (physics.sea == Sea::Current).then(|| Current::new(&table)),
        ground: physics.bed.map(|bed| {
            let normal = Vector3::new(-bed.tilt, 0.5 * bed.tilt, 1.0).normalize();
            let resistance = Resistance { stiffness: 900.0, damping: bed.damping, onset: 0.3, easing: 0.4 };
            Ground { plane: Plane { normal, offset: -0.9 }, resistance: vec![resistance; mesh.elements.len()] }
        }),
        surface: physics.surface.then(|| Surface::new(&mesh)),
    };
    physics::build(mesh.clone(), around, Supports::default())
}

/// A random state of a line along x that waves up and down through z = 0.
fn state_of(line: &dyn Line, stretched: f64, random: &mut Random) -> State {
    let mesh = line.mesh();
    let mut state = State::new(mesh.nodes());
    state.u = random.field(mesh, 0.15, 0.1);
    state.v = random.field(mesh, 1.0, 0.3);
    state.a = random.field(mesh, 2.0, 0.5);
    for node in 0..mesh.nodes() {
        let s = mesh.node_arc_length(node);
        let (place, slope) = (Vector3::new(s, 0.0, 0.8 * (0.5 * s).sin()), Vector3::new(1.0, 0.0, 0.4 * (0.5 * s).cos()));
        state.u.set_position(node, &(state.u.position(node) + place * stretched));
        state.u.set_slope(node, &(state.u.slope(node) + slope * stretched));
    }
    state
}

fn residual(line: &dyn Line, state: &State) -> Field {
    let mut out = Field::new(line.mesh().nodes());
    line.residual(&Motion { u: &state.u, v: &state.v, a: &state.a }, &mut out);
    out
}

/// Relative error of the tangent in a random direction against a central difference with step `d`.
fn error(line: &dyn Line, state: &State, weights: &Weights, random: &mut Random, d: f64) -> f64 {
    let direction = random.field(line.mesh(), 1.0, 1.0);
    let mut matrix = BlockTridiagonal::new(line.mesh().ties());
    line.tangent(&Motion { u: &state.u, v: &state.v, a: &state.a }, weights, None, &mut matrix);
    let product = times(&matrix, &direction);
    let moved = |sign: f64| {
        let mut moved = state.clone();
        moved.u.add(sign * d * weights.u, &direction);
        moved.v.add(sign * d * weights.v, &direction);
        moved.a.add(sign * d * weights.a, &direction);
        residual(line, &moved)
    };
    let mut difference = moved(1.0);
    difference.add(-1.0, &moved(-1.0));
    let size = |field: &Field| field.data().iter().map(|x| x * x).sum::<f64>().sqrt();
    difference.data_mut().iter_mut().for_each(|x| *x /= 2.0 * d);
    let scale = size(&difference);
    difference.add(-1.0, &product);
    size(&difference) / scale.max(1e-6)
}

const BY: [(&str, Weights); 4] = [
    ("position", Weights { u: 1.0, v: 0.0, a: 0.0 }),
    ("velocity", Weights { u: 0.0, v: 1.0, a: 0.0 }),
    ("acceleration", Weights { u: 0.0, v: 0.0, a: 1.0 }),
    ("all", Weights { u: 0.3, v: 0.7, a: 1.1 }),
];

/// Central differences of the residual for every combination of physics (384), four weightings and several random states each.
#[test]
fn tangent_is_the_change_of_the_residual_in_every_combination_of_physics() {
    let mut random = Random(7);
    let mut worst = vec![(0.0, String::new()); 8];
    for physics in combinations() {
        let line = line_of(&physics);
        for _ in 0..4 {
            let state = state_of(line.as_ref(), physics.stretched, &mut random);
            for (what, weights) in BY {
                let error = error(line.as_ref(), &state, &weights, &mut random, 1e-6);
                let slot = usize::from(physics.surface) + 2 * physics.bed.map_or(0, |bed| if bed.damping > 0.0 { 2 } else { 1 });
                if !(error <= worst[slot].0) {
                    worst[slot] = (error, format!("{what} {physics:?}"));
                }
            }
        }
    }
    for (error, what) in &worst {
        println!("DBG {error:.2e} {what}");
    }
    assert!(worst.iter().all(|w| w.0 < 1e-5));
}
