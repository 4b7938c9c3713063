//! A planar scene solved in its plane gives what it gives in space.

use moorline::scene::read::{self, Loaded};
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use nalgebra::Vector3;

/// The built-in line with its fairlead in surge and heave, or in what else `sets` say.
fn scene(sets: &[&str]) -> Loaded {
    let heave = ["motion.sine=[5.08, 0, 2.1]", "motion.ramp=5", "solver.tolerance=1e-6", "solver.fixed_step=0.05"];
    let sets: Vec<String> = heave.iter().chain(sets).map(|set| set.to_string()).collect();
    read::built_in(&sets).unwrap_or_else(|error| panic!("{error}"))
}

fn is_planar(line: &Simulation) -> bool {
    line.decisions().iter().any(|decision| decision.physics == "third dimension" && !decision.on)
}

/// The line of a scene, solved in its plane and in space, at rest.
fn both(scene: &Loaded, path: &Path) -> [Simulation; 2] {
    let known = Simulation::on_path(&scene.scene, 0, Some(path)).unwrap_or_else(|error| panic!("{error}"));
    let unknown = Simulation::new(&scene.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    assert!(is_planar(&known) && !is_planar(&unknown));
    [known, unknown].map(|mut line| {
        line.settle(path.at(0.0).position, 0.0).unwrap_or_else(|error| panic!("{error}"));
        line
    })
}

/// Advances both to `until` and returns the largest difference of their forces, over the tension.
fn difference(lines: &mut [Simulation; 2], path: &Path, from: f64, until: f64) -> f64 {
    let mut worst: f64 = 0.0;
    for row in 1..=((until - from) / 0.1).round() as u32 {
        for line in lines.iter_mut() {
            line.advance(from + 0.1 * f64::from(row), path).unwrap_or_else(|error| panic!("{error}"));
        }
        let [one, other] = [lines[0].outputs(), lines[1].outputs()];
        let apart = (one.force - other.force).norm().max((one.anchor_force - other.anchor_force).norm());
        worst = worst.max(apart / other.tension);
    }
    worst
}

/// The same equations with the same steps; what is left out is exactly zero. Iterations end at 1e-10 of the line's length and slopes, which is
/// 1e-8 of the tension: it differs by how rounding ends them.
#[test]
fn a_planar_line_has_the_forces_that_it_has_in_space() {
    let current = r#"environment.current=[{"z": 0, "velocity": [0.8, 0, 0]}, {"z": -120, "velocity": [0.1, 0, 0]}]"#;
    let stiff = "line_types.chain.ei=1e6";
    let rough = "environment.seabed.friction=0.4";
    let (report, pressures) = ("solver.stretch=report", "solver.hydrostatic_strain=true");
    for sets in [
        &[][..],
        &[current],
        &[stiff],
        &[current, stiff],
        &[rough],
        &[report],
        &[report, pressures],
        &[current, pressures, stiff],
    ] {
        let scene = scene(sets);
        let path = Path::of_scene(&scene, 0);
        let apart = difference(&mut both(&scene, &path), &path, 0.0, 20.0);
        println!("{sets:?}: {apart:.1e}");
        assert!(apart < 1e-7, "{sets:?}: {apart:.1e}");
    }
}

/// The fairlead is pulled across the plane after all: the line goes on in space, as one that knew nothing of a plane.
#[test]
fn a_planar_line_can_leave_its_plane() {
    let scene = scene(&[]);
    let path = Path::of_scene(&scene, 0);
    let mut lines = both(&scene, &path);
    difference(&mut lines, &path, 0.0, 5.0);
    let at = path.at(5.0);
    let aside = Vector3::new(0.0, 1.0, 0.0);
    let coefficients = vec![at.position, at.velocity, 0.5 * (at.acceleration + aside)];
    let path = Path::Polynomial { start: 5.0, coefficients };
    let apart = difference(&mut lines, &path, 5.0, 7.0);
    assert!(apart < 1e-6, "{apart:.1e}");
    assert!(lines[0].outputs().force.y < -1e3, "no force across: {:?}", lines[0].outputs().force);
}

/// What goes across the plane is seen: each alone puts the line into space.
#[test]
fn what_goes_across_the_plane_is_seen() {
    for across in [
        "motion.sine=[5.08, 1e-9, 2.1]",
        "motion.cosine=[0, 0.1, 0]",
        r#"environment.current=[{"z": 0, "velocity": [0.8, 0.1, 0]}]"#,
        "environment.seabed.slope_deg=[0, 1]",
        "lines.0.anchor=[1183.97, 1, -120]",
        r#"environment.waves={"kind": "regular", "amplitude": 1, "period": 8}"#,
    ] {
        let scene = scene(&[across]);
        let path = Path::of_scene(&scene, 0);
        let line = Simulation::on_path(&scene.scene, 0, Some(&path)).unwrap_or_else(|error| panic!("{error}"));
        assert!(!is_planar(&line), "{across}");
    }
}
