//! The built-in case (Lindahl & Sjöberg 1983 as run by Ma & Webster 1994) against numbers from outside the program.
//!
//! tests/data/lindahl_sjoberg_tension.csv: end tension every 0.1 s from an independent implementation on 160 elements, fourth order in
//! time with steps of 0.0125 s; two schemes and two meshes of it agree to 1.5e-4 of the maximum.

use moorline::scene::read::{Loaded, built_in};
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use nalgebra::Vector3;

const STEP: f64 = 0.1;
const STEPS: usize = 1200;

fn scene(sets: &[&str]) -> Loaded {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    built_in(&sets).unwrap_or_else(|error| panic!("{error}"))
}

/// End tension at 0, 0.1, … 120 s, and the number of elements.
fn run(sets: &[&str]) -> (Vec<f64>, usize) {
    let loaded = scene(sets);
    let mut simulation = Simulation::new(&loaded.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    let path = Path::of_scene(&loaded, 0);
    simulation.settle(Vector3::zeros(), 0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut tensions = vec![simulation.outputs().tension];
    for k in 1..=STEPS {
        simulation.advance(k as f64 * STEP, &path).unwrap_or_else(|error| panic!("{error}"));
        tensions.push(simulation.outputs().tension);
    }
    (tensions, simulation.elements())
}

fn published() -> Vec<f64> {
    let rows: Vec<f64> = include_str!("data/lindahl_sjoberg_tension.csv")
        .lines()
        .skip(1)
        .map(|row| row.split_once(',').and_then(|(_, tension)| tension.trim().parse().ok()).unwrap_or(f64::NAN))
        .collect();
    assert_eq!(rows.len(), STEPS + 1);
    rows
}

/// rms error over rms, and largest error over largest, from 60 to 120 s.
fn errors(found: &[f64], exact: &[f64]) -> (f64, f64) {
    let (found, exact) = (&found[600..], &exact[600..]);
    let squares = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
    let error = |k: usize| found[k] - exact[k];
    let rms = squares(&mut (0..found.len()).map(error)) / squares(&mut exact.iter().copied());
    let largest = (0..found.len()).map(|k| error(k).abs()).fold(0.0, f64::max) / exact.iter().copied().fold(0.0, f64::max);
    (rms, largest)
}

/// The promise of the issue: rms ≤ 0.1 %, largest ≤ 0.2 %.
#[track_caller]
fn assert_good(what: &str, found: &[f64], exact: &[f64]) {
    let (rms, largest) = errors(found, exact);
    println!("{what}: rms {:.4} %, largest {:.4} %", 100.0 * rms, 100.0 * largest);
    assert!(rms <= 1e-3 && largest <= 2e-3, "{what}: rms {:.4} %, largest {:.4} %", 100.0 * rms, 100.0 * largest);
}

/// Source: the table. Every scheme at the default tolerance, on the mesh that the program chooses. The promise is 0.1 % rms and 0.2 % at
/// most; measured 0.061 and 0.103 % (adams-moulton), 0.054 and 0.090 % (esdirk3), 0.050 and 0.085 % (generalized-alpha).
#[test]
fn built_in_case_has_the_published_tension_with_every_scheme() {
    let exact = published();
    for scheme in ["adams-moulton", "esdirk3", "generalized-alpha"] {
        let (found, elements) = run(&[&format!("solver.scheme={scheme}")]);
        assert_good(&format!("{scheme}, {elements} elements"), &found, &exact);
        assert!((found[0] / 1_329_610.0 - 1.0).abs() < 1e-4, "{scheme}: static tension {}", found[0]);
    }
}

/// Source: the table's maximum over the last cycle (2 109 070.6 N, with the exact law), measured 1.3e-4; and with the law of the report, its
/// anchor at 1183.99198 m, the maximum of two other programs, 2.1186e6 N, which are good to 0.3 %; measured 2.4e-4.
#[test]
fn built_in_case_has_the_published_maximum() {
    let report = ["solver.stretch=report", "lines[0].anchor=[1183.99198,0,-120]"];
    for (sets, exact, allowed) in [(&[][..], 2_109_070.6, 4e-4), (&report[..], 2.1186e6, 3e-3)] {
        let maximum = run(sets).0[1050..].iter().copied().fold(0.0, f64::max);
        println!("maximum {maximum:.1} for {exact:.1}");
        assert!((maximum / exact - 1.0).abs() < allowed, "{maximum} for {exact}");
    }
}

/// Not published: our own `esdirk3` on 160 equal elements with fixed steps of 0.0125 s stands for the truth, another scheme on another mesh
/// than the default one, its equations solved to 1e-7. On the published case it agrees with the table to 2.9e-6 rms and 4.3e-6 at most
/// (asserted), so it may.
#[test]
fn vertical_motion_and_a_longer_period_are_as_accurate_as_the_published_case() {
    let fine =
        ["solver.scheme=esdirk3", "solver.fixed_step=0.0125", "solver.tolerance=1e-7", "lines[0].sections[0].elements=160"];
    let (reference, _) = run(&fine);
    let (rms, largest) = errors(&reference, &published());
    println!("the reference itself: rms {:.5} %, largest {:.5} %", 100.0 * rms, 100.0 * largest);
    assert!(rms < 9e-6 && largest < 1.3e-5, "{rms} {largest}");
    for motion in ["motion.sine=[5.08,0,2.1]", "motion.period=20"] {
        let sets: &[&str] = if motion.contains("period") { &[motion, "motion.ramp=65"] } else { &[motion] };
        let (exact, _) = run(&[&fine[..], sets].concat());
        let (found, elements) = run(sets);
        assert_good(&format!("{motion}, {elements} elements"), &found, &exact);
    }
}

/// The same scene gives the same numbers to the last bit.
#[test]
fn rerun_is_identical_to_the_bit() {
    let bits = || run(&[]).0.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(), bits());
}
