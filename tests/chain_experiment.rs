//! Lindahl's chain experiment of 1985, as published by Bergdahl, Palm, Eskilsson & Lindahl (2016), J. Mar. Sci. Eng. 4(1):5,
//! doi:10.3390/jmse4010005: mean of the cycle maxima of the upper-end tension of a 33 m chain whose fairlead goes round in a circle.

use moorline::scene::read;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;

/// Period [s], radius [m] and measured maximum [N].
const MEASURED: [(f64, f64, f64); 6] =
    [(1.25, 0.075, 42.5), (1.5, 0.15, 59.0), (2.0, 0.2, 62.3), (2.5, 0.125, 42.5), (3.0, 0.1, 33.1), (3.5, 0.075, 27.8)];

/// Mean maximum of cycles 6 to 8 (the motion is eased in over 3.25).
fn mean_maximum(period: f64, radius: f64) -> f64 {
    let sets =
        [format!("motion.period={period}"), format!("motion.sine=[{radius},0,0]"), format!("motion.cosine=[0,0,{radius}]")];
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/chain_experiment.json");
    let loaded = read::load(std::path::Path::new(file), &sets).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&loaded.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    simulation.settle(loaded.scene.lines[0].fairlead.into(), 0.0).unwrap_or_else(|error| panic!("{error}"));
    let path = Path::of_scene(&loaded, 0);
    let rows = (period / 0.005).round() as usize;
    let mut maxima = [0.0f64; 8];
    for k in 1..=8 * rows {
        simulation.advance(period * k as f64 / rows as f64, &path).unwrap_or_else(|error| panic!("{error}"));
        let cycle = &mut maxima[(k - 1) / rows];
        *cycle = cycle.max(simulation.outputs().tension);
    }
    maxima[5..].iter().sum::<f64>() / 3.0
}

/// Source: the measurements above; nothing is adjusted, all coefficients are those of the publication. Allowed are 5 % in the mean and 10 %
/// in any condition; measured here 4.7 % and 8.0 %. The slow conditions come out 8 % too high, as they do in the published program (35.57
/// and 29.87 N): there the tension is nearly static, so the geometry of the experiment must have been a little different.
#[test]
fn maxima_of_the_chain_experiment_are_those_measured() {
    let mut sum = 0.0;
    for (period, radius, measured) in MEASURED {
        let found = mean_maximum(period, radius);
        let error = (found / measured - 1.0).abs();
        println!("{period} s, {radius} m: {found:.2} N for {measured} N, {:.1} %", 100.0 * error);
        assert!(error <= 0.1, "{period} s, {radius} m: {found:.2} N for {measured} N");
        sum += error / MEASURED.len() as f64;
    }
    assert!(sum <= 0.05, "mean error {:.2} %", 100.0 * sum);
}
