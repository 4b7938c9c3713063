//! Tension–strain tables and the pressure on the wall of a pipe, against closed forms and quadrature.

mod support;

use moorline::algebra::block_tridiagonal::BlockTridiagonal;
use moorline::rod::elasticity::{Elasticity, Pressures};
use moorline::rod::line::Supports;
use moorline::rod::mesh::Mesh;
use moorline::rod::motion::Weights;
use moorline::rod::physics::{self, Surroundings};
use moorline::rod::state::State;
use moorline::scene::read;
use moorline::scene::types::Stretch;
use moorline::solve::newton::motion;
use moorline::solve::simulation::{NodeOutput, Simulation};
use nalgebra::{SVector, Vector3};
use std::path::Path;
use support::{assert_close, material};

/// A line of a scene in equilibrium.
fn settled(scene: &str) -> (Simulation, Vec<NodeOutput>) {
    let loaded = read::parse(scene, "test", Path::new("."), &[]).expect("a scene");
    let mut simulation = Simulation::new(&loaded.scene, 0).expect("a line");
    simulation.settle(loaded.scene.lines[0].fairlead.into(), 0.0).expect("equilibrium");
    let nodes = simulation.nodes();
    (simulation, nodes)
}

/// Strain at a tension, for the table of the next test: 2e6 N up to 1 %, 4e6 N up to 3 %, 8e6 N beyond.
fn strain(tension: f64) -> f64 {
    match tension {
        t if t < 2.0e4 => t / 2.0e6,
        t if t < 1.0e5 => 0.01 + (t - 2.0e4) / 4.0e6,
        t => 0.03 + (t - 1.0e5) / 8.0e6,
    }
}

/// A rope that hangs straight down between two points: T grows by the weight, and the strains of the table add up to the distance.
/// The last point of the table is passed, so its slope goes on. Quadrature with a million points, bisection to rounding; what is left
/// is the mesh, which cannot kink where the table does: measured 1e-7.
#[test]
fn strains_of_a_table_add_up_to_the_distance() {
    let (length, distance, weight) = (400.0, 412.0, 250.0);
    let (_, nodes) = settled(&format!(
        r#"{{"environment": {{"depth": 1000, "surface": "none"}},
            "line_types": {{"rope": {{"ea": 2e6, "mass": 50, "submerged_weight": {weight}, "diameter": 0.1,
                "tension_strain": [[0, 0], [0.01, 2e4], [0.03, 1e5], [0.04, 1.8e5]]}}}},
            "lines": [{{"name": "a", "fairlead": [0, 0, 0], "anchor": [0, 0, -{distance}],
                "sections": [{{"type": "rope", "length": {length}, "elements": 80}}]}}]}}"#
    ));
    let stretched = |bottom: f64| {
        let points = 1_000_000;
        let ds = length / points as f64;
        (0..points).map(|k| (1.0 + strain(bottom + weight * (k as f64 + 0.5) * ds)) * ds).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, 1.0e6);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if stretched(middle) < distance { low = middle } else { high = middle }
    }
    assert!(low < 2.0e4 * 3.0 && low + weight * length > 1.0e5, "two slopes of the table are in use: {low}");
    assert_close("tension at the anchor", nodes[nodes.len() - 1].tension, low, 1e-6);
    assert_close("tension at the fairlead", nodes[0].tension, low + weight * length, 1e-6);
}

/// A steel pipe full of oil under 100 bar (reference: 2 MN in the wall at the top): held straight by its ends, which are as far apart
/// as the pressures, without Poisson's ratio, stretch it. So stiff against bending that it stays straight under the compression (a real pipe
/// of this wall would buckle over its lowest 300 m). Effective and wall tension at both ends and the weight with contents are
/// closed forms with the pressures on the pipe as it was made; that it hangs up to 0.083 m deeper is 28 N at both ends of the effective
/// tension, and 47 N more in the wall below.
#[test]
fn pressures_strain_a_pipe_and_effective_and_wall_tension_differ_by_them() {
    let (outer, inner) = (std::f64::consts::FRAC_PI_4 * 0.25, std::f64::consts::FRAC_PI_4 * 0.2025);
    let steel = outer - inner;
    let elongation = 0.0830061243215;
    let (simulation, nodes) = settled(&format!(
        r#"{{"environment": {{"depth": 2000, "water_density": 1025, "surface": "none"}},
            "line_types": {{"pipe": {{"ea": {ea}, "ei": 2e11, "mass": {mass}, "diameter": 0.5,
                "inner_fluid": {{"density": 900, "area": {inner}, "pressure": 1e7}}}}}},
            "lines": [{{"name": "pipe", "fairlead": [0, 0, 0], "anchor": [0, 0, {bottom}],
                "sections": [{{"type": "pipe", "length": 500, "elements": 20}}]}}],
            "solver": {{"hydrostatic_strain": true}}}}"#,
        ea = 207.0e9 * steel,
        mass = 7850.0 * steel,
        bottom = -(500.0 + elongation),
    ));
    let (top, bottom) = (&nodes[0], &nodes[nodes.len() - 1]);
    assert_close("T_e at the top", top.tension, 409568.71912, 1e-4);
    assert_close("T_w at the top", top.wall_tension.expect("pressures"), 2.0e6, 2e-5);
    assert_close("T_e at the bottom", bottom.tension, -741417.570486, 5e-5);
    assert_close("T_w at the bottom", bottom.wall_tension.expect("pressures"), 564035.089127, 1e-4);
    assert_close("weight with contents", simulation.outputs().force.norm() - bottom.tension, 2301.97257921 * 500.0, 1e-9);
}

/// The tangent of a table's law is the change of the residual: central differences of 1e-6, off the kinks of the table. The change of
/// pressure with height is left out of the tangent: it is ρ g A_o against EA per length, here 3e-9.
#[test]
fn tangent_of_a_table_is_the_change_of_the_residual() {
    for stretch in [Stretch::Exact, Stretch::Report] {
        let table = Some(vec![[0.0, 0.0], [0.05, 2.0e6], [0.2, 2.0e7], [0.5, 4.0e7]]);
        let pressures = Some(Pressures { outer: 100.0, inner: 20.0, inner_at_zero: 5.0 });
        let elasticities = vec![Elasticity { table, pressures, strained: true }];
        let mesh = Mesh { elasticities, ..Mesh::new(vec![material(4.0e7, 10.0, 50.0)], &[vec![10.0; 3]]) };
        let around = Surroundings { stretch, current: None, waves: None, ground: None, surface: None, planar: false };
        let line = physics::build(mesh, around, Supports::default());
        let mut state = State::new(4);
        for node in 0..4 {
            let s = 10.0 * node as f64;
            state.u.set_position(node, &Vector3::new(1.1 * s, 0.01 * s * s, 0.05 * s));
            state.u.set_slope(node, &Vector3::new(1.1 + 0.02 * node as f64, 0.02 * s, 0.05));
            state.v.set_slope(node, &Vector3::new(0.1, 0.2, -0.1));
        }
        let residual = |state: &State| {
            let mut out = state.u.clone();
            line.residual(&motion(state), &mut out);
            out
        };
        let at = motion(&state);
        let mut matrix = BlockTridiagonal::new(line.mesh().ties());
        line.tangent(&at, &Weights { u: 1.0, v: 0.0, a: 0.0 }, None, &mut matrix);
        let x: Vec<SVector<f64, 6>> = (0..4).map(|node| SVector::from_fn(|c, _| ((node * 7 + c * 3) % 5) as f64 - 2.0)).collect();
        let mut product = x.clone();
        matrix.multiply(&x, &mut product);
        let moved = |sign: f64| {
            let mut moved = state.clone();
            for (node, x) in x.iter().enumerate() {
                (0..6).for_each(|c| moved.u.component_mut(c)[node] += sign * 1e-6 * x[c]);
            }
            residual(&moved)
        };
        let (after, before) = (moved(1.0), moved(-1.0));
        let (mut error, mut size): (f64, f64) = (0.0, 0.0);
        for node in 0..4 {
            for c in 0..6 {
                let change = (after.component(c)[node] - before.component(c)[node]) / 2e-6;
                (error, size) = (error.max((change - product[node][c]).abs()), size.max(change.abs()));
            }
        }
        assert!(error < 1e-6 * size, "{stretch:?}: {error:.2e} of {size:.2e}");
    }
}
