//! The water that a stage keeps (`rod/flows.rs`) against water that is asked for in every iteration.

mod support;

use moorline::algebra::block_tridiagonal::BlockTridiagonal;
use moorline::rod::awash::Surface;
use moorline::rod::motion::{Asking, Motion, Weights};
use moorline::rod::physics::Surroundings;
use moorline::rod::properties::Properties;
use moorline::rod::state::{Field, State};
use moorline::rod::system::System;
use moorline::scene::types::Scheme;
use moorline::sea::clock::Clock;
use moorline::sea::spectrum::Jonswap;
use moorline::sea::waves::Waves;
use moorline::solve::controller::{self, Controller, Demands};
use moorline::solve::motion::Path;
use moorline::solve::newton::{Criteria, Newton, motion};
use moorline::solve::scheme::{Bench, Moment, Stages};
use nalgebra::Vector3;
use std::sync::Arc;
use support::*;

const DEPTH: f64 = 60.0;

fn sea() -> Waves {
    Waves::new(&Jonswap { hs: 5.0, tp: 8.0, gamma: 3.3 }.waves(3, 60, 0.5), GRAVITY, DEPTH, 2.0)
}

fn rope() -> Properties {
    Properties {
        weight: 150.0,
        diameter: 0.12,
        drag_normal: 75.0,
        drag_tangential: 3.0,
        added_normal: 12.0,
        ..material(2.0e6, 30.0, 260.0)
    }
}

/// A rope from the bed to above the surface, in the sea, held at both ends.
fn rig() -> Rig {
    let mesh = uniform(rope(), 100.0, 11);
    let around = Surroundings { waves: Some(sea()), surface: Some(Surface::new(&mesh)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(0, &[X, Y, Z]).hold(11, &[X, Y, Z]));
    rig.hang(Vector3::new(0.0, 0.0, -DEPTH), Vector3::new(75.0, 5.0, 1.0));
    rig
}

/// A line that forgets its stages: the water is asked for in every iteration.
struct Forgetful<'a>(&'a dyn System);

impl System for Forgetful<'_> {
    fn nodes(&self) -> usize {
        self.0.nodes()
    }
    fn ties(&self) -> Vec<bool> {
        self.0.ties()
    }
    fn fixed(&self) -> &[(usize, usize)] {
        self.0.fixed()
    }
    fn is_planar(&self) -> bool {
        self.0.is_planar()
    }
    fn place(&self, order: usize, field: &mut Field, time: f64) {
        self.0.place(order, field, time);
    }
    fn residual(&self, at: &Motion, out: &mut Field) {
        self.0.residual(&Motion { asking: Asking::Alone, ..*at }, out);
    }
    fn residual_of(&self, at: &Motion, runs: &[(usize, usize)], out: &mut Field) {
        self.0.residual_of(&Motion { asking: Asking::Alone, ..*at }, runs, out);
    }
    fn tangent(&self, at: &Motion, weights: &Weights, geometric: Option<&[f64]>, matrix: &mut BlockTridiagonal<6>) {
        self.0.tangent(at, weights, geometric, matrix);
    }
    fn tangent_of(
        &self,
        at: &Motion,
        weights: &Weights,
        geometric: Option<&[f64]>,
        runs: &[(usize, usize)],
        matrix: &mut BlockTridiagonal<6>,
    ) {
        self.0.tangent_of(at, weights, geometric, runs, matrix);
    }
    fn inertia(&self, at: &Motion, x: &Field, out: &mut Field) {
        self.0.inertia(at, x, out);
    }
    fn holding_nodes(&self) -> usize {
        self.0.holding_nodes()
    }
    fn hold(&self, u: &Field, v: &Field, holds: &mut Field) {
        self.0.hold(u, v, holds);
    }
}

/// The forces of a state, asked for in a way.
fn forces(rig: &Rig, state: &State, asking: Asking) -> Field {
    let mut out = Field::new(state.u.nodes());
    rig.line.residual(&Motion { asking, ..motion(state) }, &mut out);
    out
}

/// Largest difference of forces on nodes [N].
fn apart(one: &Field, other: &Field) -> f64 {
    (0..one.nodes()).map(|node| (one.position(node) - other.position(node)).norm()).fold(0.0, f64::max)
}

/// The first question of a stage finds what is asked alone, whatever was kept; a later one keeps the water as long as the line is within a
/// thousandth of the mean wave's number, with an error of the forces that is as small, and asks again beyond. What is asked alone in between
/// changes nothing.
#[test]
fn a_stage_keeps_the_water_near_where_it_was_asked() {
    let mut rig = rig();
    let reach = 1.0e-3 / sea().mean().1;
    for (time, by) in [(10.0, 0.1), (13.7, 0.9), (15.2, 1.5), (20.0, 40.0)] {
        rig.state.clock = Clock { now: time, start: 0.0 };
        let start = rig.state.clone();
        // No wave at all lies between questions of different times: they differ by hundreds of newtons.
        let first = forces(&rig, &start, Asking::First);
        assert!(apart(&first, &forces(&rig, &start, Asking::Alone)) < 1e-6);
        let mut moved = start.clone();
        (1..11).for_each(|node| moved.u.set_position(node, &(start.u.position(node) + Vector3::new(by * reach, 0.0, 0.0))));
        let exact = forces(&rig, &moved, Asking::Alone);
        let kept = forces(&rig, &moved, Asking::Again);
        let error = apart(&kept, &exact);
        println!("moved by {:.4} m: {error:.2e} N of {:.2e} N", by * reach, apart(&first, &exact));
        if by < 1.0 {
            assert!(error > 1e-6 && error < 5.0, "kept: {error} N");
        } else if by > 20.0 {
            assert!(error < 1e-6, "asked again everywhere: {error} N");
        }
        assert!(apart(&forces(&rig, &moved, Asking::First), &exact) < 1e-6, "{error} N");
    }
}

/// Tension every 0.05 s with the fairlead jerked about by up to 4 m/s, for 5 s, before differences of any kind have grown to its size; steps of 0.025 s, because
/// steps that are chosen would differ by a decision now and then.
fn tensions(scheme: Scheme, forgetful: bool) -> Vec<f64> {
    let rig = rig();
    let start = rig.state.u.position(rig.last());
    let (times, positions): (Vec<f64>, Vec<Vector3<f64>>) = (0..=300)
        .map(|n| {
            let time = 0.05 * f64::from(n);
            let eased = (time / 3.0).min(1.0).powi(2);
            let off = Vector3::new(2.0 * (1.9 * time).sin(), 0.5 * (1.1 * time).sin(), 0.5 * (1.5 * time).sin());
            (time, start + off * eased)
        })
        .unzip();
    let table = moorline::scene::motion_file::Table {
        velocities: spline_velocities(&times, &positions),
        positions: positions.iter().map(|at| [at.x, at.y, at.z]).collect(),
        times,
    };
    let path = Path::Table(Arc::new(table));
    let line = rig.line.as_ref();
    let wrapped = Forgetful(line);
    let used: &dyn System = if forgetful { &wrapped } else { line };
    let criteria =
        Criteria { tolerance: 1.0e-7, length: line.mesh().length, emphasis: 1.0, iterations: 10, loose: 0.0, enough: 0.0 };
    let demands = Demands { error: 1.0e-3, finest_step: 1.0e-6, max_step: 0.025, fixed_step: Some(0.025), criteria };
    let mut newton = Newton::new(used);
    let mut bench =
        Bench { line: used, newton: &mut newton, path: &path, anchor: None, criteria, allowed: 1.0e-3, stages: Stages::Solve };
    let mut moment: Moment = controller::at_rest(used, 0.0, 0.01);
    moment.state = rig.state.clone();
    bench.prescribe(&mut moment.state, Clock::at_rest(0.0));
    bench.accelerate(&mut moment.state).expect("a regular mass matrix");
    let mut controller = Controller::new(scheme, line.mesh().nodes());
    (1..=100)
        .map(|n| {
            controller
                .advance(&mut bench, &demands, &mut moment, 0.05 * f64::from(n), |_, _| {})
                .unwrap_or_else(|failure| panic!("no step: {failure:?}"));
            line.end_force(&motion(&moment.state)).norm()
        })
        .collect()
}

fn spline_velocities(times: &[f64], positions: &[Vector3<f64>]) -> Vec<[f64; 3]> {
    let last = times.len() - 1;
    let slope = |n: usize| {
        let (a, b) = (n.saturating_sub(1), (n + 1).min(last));
        let v = (positions[b] - positions[a]) / (times[b] - times[a]);
        [v.x, v.y, v.z]
    };
    (0..=last).map(slope).collect()
}

/// The tension of a rope that is jerked about in the sea: with the water kept in a stage as with the water asked for in every iteration, to a
/// tenth of the usual tolerance of 1e-3, rms (measured: 1e-7); by schemes of one stage and of three.
#[test]
fn a_rope_that_is_jerked_feels_the_same_with_the_water_kept() {
    for scheme in [Scheme::AdamsMoulton, Scheme::Esdirk3] {
        let [kept, exact] = [false, true].map(|forgetful| tensions(scheme, forgetful));
        let error: f64 = kept.iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum();
        let (largest, mean) = (exact.iter().copied().fold(0.0, f64::max), exact.iter().sum::<f64>() / exact.len() as f64);
        let least = exact.iter().copied().fold(f64::INFINITY, f64::min);
        let error = (error / exact.iter().map(|f| f * f).sum::<f64>()).sqrt();
        println!("{scheme:?}: tension {least:.0} to {largest:.0} N, mean {mean:.0} N; error {error:.1e}");
        assert!(largest > 1.5 * mean && least < 0.5 * mean, "it is jerked");
        assert!(error > 0.0 && error < 1e-4, "{error}");
    }
}
