//! To look at a line changes nothing, and to go back brings back everything: runs that are saved, put back, differentiated, read and taken
//! back at random are the same to the last bit as runs that nobody looked at. No tolerance: every number of the outputs of every step, and
//! every byte of the state at the end, is compared.

use moorline::fmi::instance::Instance;
use moorline::scene::motion_file::Table;
use moorline::scene::read::{self, Loaded};
use moorline::scene::types::Scheme;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use moorline::solve::snapshot::Snapshot;
use nalgebra::Vector3;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Numbers that look random and are the same every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % sides
    }

    fn pick<'a>(&mut self, sides: &[&'a str]) -> &'a str {
        sides[self.roll(sides.len())]
    }
}

/// Lengths of the master's steps [s].
const STEPS: [f64; 7] = [0.1, 0.1, 0.1, 0.03, 0.5, 0.011, 0.34];

/// A run: one line of a scene, its way and the times at which it is stopped.
struct Run {
    words: String,
    scene: Loaded,
    path: Path,
    times: Vec<f64>,
}

impl Run {
    fn line(&self) -> Simulation {
        let mut line = Simulation::on_path(&self.scene.scene, 0, Some(&self.path)).unwrap_or_else(|error| panic!("{error}"));
        line.sum_up_work();
        line.settle(self.path.at(self.times[0]).position, self.times[0]).unwrap_or_else(|error| panic!("{error}"));
        line
    }

    fn advance(&self, line: &mut Simulation, step: usize) -> String {
        line.advance(self.times[step + 1], &self.path).unwrap_or_else(|error| panic!("{}: {error}", self.words));
        format!("{:?} {:?}", line.outputs(), line.last_step())
    }

    /// What the steps of a run that nobody looks at end in, and the bytes of its last state.
    fn undisturbed(&self) -> (Vec<String>, Vec<u8>, Simulation) {
        let mut line = self.line();
        let seen = (0..self.times.len() - 1).map(|step| self.advance(&mut line, step)).collect();
        (seen, bytes(&line.snapshot()), line)
    }
}

fn bytes(state: &Snapshot) -> Vec<u8> {
    let mut bytes = Vec::new();
    state.to_bytes(&mut bytes);
    bytes
}

fn times(dice: &mut Dice, start: f64, count: usize) -> Vec<f64> {
    let steady = dice.roll(3) == 0;
    let mut times = vec![start];
    for _ in 0..count {
        times.push(times[times.len() - 1] + if steady { 0.1 } else { STEPS[dice.roll(STEPS.len())] });
    }
    times
}

/// The built-in line in a sea of its own: scheme, control of steps, friction, bending, current, waves, bodies, constraints, and a motion that
/// stays in the plane or not, is gentle or snaps.
fn random_run(number: usize) -> Run {
    let dice = &mut Dice(977 * number as u64 + 13);
    let scheme = dice.pick(&["adams-moulton", "esdirk3", "generalized-alpha", "cable-1994"]);
    let mut sets = vec![format!("solver.scheme={scheme}"), String::from("lines[0].sections[0].elements=16")];
    let current = r#"environment.current=[{"z": 0, "velocity": [0.8, 0, 0]}, {"z": -120, "velocity": [0.1, 0, 0]}]"#;
    let motions = ["motion.sine=[5, 0, 2]", "motion.sine=[0.5, 0, 0]", "motion.sine=[3, 1, 2]", "motion.sine=[9, 0, 4]"];
    sets.push(dice.pick(&motions).into());
    sets.push(dice.pick(&["motion.ramp=2", "motion.ramp=8"]).into());
    sets.push(dice.pick(&["motion.period=9.4", "motion.period=6"]).into());
    if scheme == "cable-1994" {
        sets.extend(["solver.fixed_step=0.1".into(), "environment.surface=none".into()]);
    } else {
        sets.push(dice.pick(&["solver.tolerance=1e-2", "solver.tolerance=1e-3", "solver.tolerance=1e-4"]).into());
        let mut perhaps = |one_in: usize, set: &str| {
            if dice.roll(one_in) == 0 {
                sets.push(set.into());
            }
        };
        perhaps(3, "solver.fixed_step=0.07");
        perhaps(2, "environment.seabed.friction=0.7");
        perhaps(3, "line_types.chain.ei=1e6");
        perhaps(3, current);
        perhaps(4, r#"environment.waves={"kind": "regular", "amplitude": 1.5, "period": 8, "direction_deg": 20}"#);
        perhaps(3, r#"lines[0].attachments=[{"s": 300, "mass": 2000, "volume": 1.0, "drag_area": 1.0, "added_mass": 500}]"#);
        perhaps(5, r#"lines[0].constraints=[{"s": 600, "stiffness": [2e3, 2e3, 0], "damping": [10, 10, 0]}]"#);
        perhaps(5, "solver.stretch=report");
    }
    let scene = read::built_in(&sets).unwrap_or_else(|error| panic!("{sets:?}: {error}"));
    let mut path = Path::of_scene(&scene, 0);
    if dice.roll(4) == 0 {
        // At rest, on the way, and at rest again: steps that are left out.
        let place = path.at(0.0).position;
        let rows = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (4.0, 1.5), (4.5, 1.5), (90.0, 1.5)];
        let (times, positions): (Vec<f64>, Vec<[f64; 3]>) =
            rows.iter().map(|(time, x)| (*time, [place.x + x, place.y, place.z])).unzip();
        let velocities = vec![[0.0; 3]; times.len()];
        path = Path::Table(Arc::new(Table { times, positions, velocities }));
    }
    Run { words: format!("{number} {sets:?}"), scene, path, times: times(dice, 0.0, 36) }
}

/// A scene of the examples, or the one with every key.
fn of_file(file: &str, sets: &[&str], count: usize) -> Run {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file);
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let scene = read::load(&path, &sets).unwrap_or_else(|error| panic!("{file}: {error}"));
    let (path, start) = (Path::of_scene(&scene, 0), scene.scene.run.start);
    Run { words: format!("{file} {sets:?}"), scene, path, times: times(&mut Dice(5), start, count) }
}

/// What was done besides the steps.
#[derive(Debug, Default)]
struct Done {
    saved: usize,
    restored: usize,
    moved: usize,
    linearised: usize,
    failed: usize,
}

/// Goes through a run with looks of all kinds between its steps, and finds every step as it was without.
fn look_around(run: &Run, dice: &mut Dice, done: &mut Done) {
    let (undisturbed, end, used) = run.undisturbed();
    // Where the line goes on through bytes: one that was elsewhere, and one that is as it was made.
    let mut others = [used, Simulation::on_path(&run.scene.scene, 0, Some(&run.path)).unwrap_or_else(|error| panic!("{error}"))];
    let mut line = run.line();
    let mut kept: Vec<(usize, Snapshot)> = Vec::new();
    let (mut step, mut left) = (0, 12);
    while step < undisturbed.len() {
        for _ in 0..2 {
            match dice.roll(8) {
                0 => {
                    kept.push((step, line.snapshot()));
                    done.saved += 1;
                }
                1 if !kept.is_empty() => {
                    let slot = dice.roll(kept.len());
                    kept[slot].0 = step;
                    line.save(&mut kept[slot].1);
                }
                2 if !kept.is_empty() && left > 0 => {
                    let slot = dice.roll(kept.len());
                    assert!(line.restore(&kept[slot].1), "{}", run.words);
                    (step, left) = (kept[slot].0, left - 1);
                    done.restored += 1;
                }
                3 => {
                    let state = Snapshot::from_bytes(&bytes(&line.snapshot())).expect("a state");
                    let other = &mut others[dice.roll(2)];
                    assert!(other.restore(&state), "{}", run.words);
                    other.sum_up_work();
                    std::mem::swap(&mut line, other);
                    done.moved += 1;
                }
                4 => {
                    let rates = line.output_rates();
                    assert!(rates.tension.is_finite() && line.observe() == line.outputs());
                    assert!(!line.nodes().is_empty() && !line.line_state().nodes.is_empty() && !line.mesh().is_empty());
                }
                5 if dice.roll(2) == 0 => {
                    let until = run.times[step] + STEPS[dice.roll(STEPS.len())];
                    if let Ok(steps) = line.linearise(until, &run.path) {
                        let coefficients = vec![Vector3::zeros(), Vector3::new(1.0, 0.5, 0.0)];
                        let aside = Path::Polynomial { start: run.times[step], coefficients };
                        line.derivative(&steps, &aside).unwrap_or_else(|error| panic!("{}: {error}", run.words));
                        done.linearised += 1;
                    }
                }
                6 if dice.roll(2) == 0 => {
                    // Far away and back within the step: it fails, or it is taken back.
                    let (start, h) = (run.times[step], 0.1);
                    let at = run.path.at(start);
                    let far =
                        [Vector3::new(500.0, 0.0, 0.0), Vector3::new(30.0, 20.0, 0.0), Vector3::new(3.0, 0.0, 0.0)][dice.roll(3)];
                    let coefficients = vec![at.position, far * (4.0 / h), far * (-4.0 / (h * h))];
                    if line.advance(start + h, &Path::Polynomial { start, coefficients }).is_ok() {
                        line.undo();
                    }
                    done.failed += 1;
                }
                _ => {}
            }
        }
        let seen = run.advance(&mut line, step);
        assert_eq!(seen, undisturbed[step], "{}: at {} s", run.words, run.times[step + 1]);
        step += 1;
    }
    assert!(bytes(&line.snapshot()) == end, "{}: the states at the end differ", run.words);
}

#[test]
fn random_scenes_go_on_as_if_nobody_had_looked() {
    let mut done = Done::default();
    let mut planar = 0;
    for number in 0..80 {
        let run = random_run(number);
        planar +=
            usize::from(run.line().decisions().iter().any(|decision| decision.physics == "third dimension" && !decision.on));
        look_around(&run, &mut Dice(number as u64), &mut done);
    }
    println!("{done:?}, {planar} in a plane");
    let Done { saved, restored, moved, linearised, failed } = done;
    assert!(
        [saved, restored, moved, linearised, failed].into_iter().all(|count| count > 80) && planar > 8,
        "{planar} in a plane"
    );
}

#[test]
fn lines_of_all_kinds_go_on_as_if_nobody_had_looked() {
    let runs = [
        of_file("examples/lindahl-sjoberg.json", &[], 120),
        of_file("examples/snapping-chain.json", &[], 60),
        of_file("examples/riser-with-bending.json", &[], 40),
        of_file("examples/lazy-wave.json", &["motion.kind=sinusoidal", "motion.period=9", "motion.sine=[2, 0, 1]"], 30),
        of_file("examples/wire-under-waves.json", &[], 40),
        of_file("examples/moored-buoy.json", &[], 60),
        of_file("tests/data/all-keys.json", &[], 30),
        of_file("tests/data/all-keys.json", &["solver.fixed_step=null", "solver.scheme=adams-moulton"], 30),
    ];
    let mut done = Done::default();
    for (number, run) in runs.iter().enumerate() {
        look_around(run, &mut Dice(100 + number as u64), &mut done);
    }
    println!("{done:?}");
}

/// The state knows the schemes apart by nothing but what they keep: each of them is among the random scenes.
#[test]
fn every_scheme_is_looked_at() {
    for scheme in [Scheme::AdamsMoulton, Scheme::Esdirk3, Scheme::GeneralizedAlpha, Scheme::Cable1994] {
        assert!((0..80).any(|number| random_run(number).scene.scene.solver.scheme == scheme), "{scheme:?}");
    }
}

/// A state of a line in its plane brings a line that has left it back there, and is refused by one that cannot be in a plane.
#[test]
fn a_state_says_whether_the_line_is_in_its_plane() {
    let run = of_file("examples/lindahl-sjoberg.json", &["motion.sine=[2, 0, 1]"], 20);
    let mut line = run.line();
    run.advance(&mut line, 0);
    let state = line.snapshot();
    let free = Simulation::new(&run.scene.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    assert!(free.fits(&state), "the same line, without a word on its way");
    let across = r#"environment.current=[{"z": 0, "velocity": [0, 0.5, 0]}]"#;
    let other = of_file("examples/lindahl-sjoberg.json", &["motion.sine=[2, 0, 1]", across], 1).line();
    assert!(!other.fits(&state) && line.fits(&other.snapshot()));
}

/// Bars, for the built-in line in the FMU: 2 µs to take a state and to go back to it, 50 µs to write it. Measured: 0.12 µs, 0.17 µs, 11 µs.
/// The fastest of many rounds counts, so that what else the machine does is left out.
#[test]
#[cfg_attr(debug_assertions, ignore = "times are those of a release build")]
fn to_look_takes_next_to_no_time() {
    let scene = read::built_in(&[]).unwrap_or_else(|error| panic!("{error}")).scene;
    let mut instance = Instance::of_scene(&scene, false);
    instance.setup_experiment(None, 0.0, None).expect("an experiment");
    instance.enter_initialization().expect("initialization");
    instance.exit_initialization().expect("statics");
    for step in 0..50 {
        instance.do_step(0.1 * f64::from(step), 0.1).expect("a step");
    }
    let handle = instance.get_state(0).expect("a state");
    let mut fastest = [f64::INFINITY; 3];
    for _ in 0..50 {
        let mut time = |number: usize, act: &mut dyn FnMut()| {
            let begin = Instant::now();
            (0..100).for_each(|_| act());
            fastest[number] = fastest[number].min(begin.elapsed().as_secs_f64() * 1.0e4);
        };
        time(0, &mut || assert_eq!(instance.get_state(handle).expect("a state"), handle));
        time(1, &mut || instance.set_state(handle).expect("a return"));
        time(2, &mut || assert!(!instance.serialized(handle).expect("bytes").is_empty()));
    }
    println!("to take a state {:.2} us, to go back {:.2} us, to write it {:.1} us", fastest[0], fastest[1], fastest[2]);
    assert!(fastest[0] < 2.0 && fastest[1] < 2.0 && fastest[2] < 50.0, "{fastest:?} us");
}
