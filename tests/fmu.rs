//! The FMU in the hands of masters: packed from the library of this build and driven from Python, through FMPy and through bare C calls.
//!
//! Each test runs one script of `tests/fmu/`. They need Python 3.9 or newer; a virtual environment with pinned packages is set up once
//! under `target/`.

use moorline::algebra::sinusoid::Sinusoid;
use moorline::fmi::pack::{Libraries, Naming, pack};
use moorline::scene::types::{Motion, Scene};
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use std::path::{Path as FilePath, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use support::python::{self, run};

mod support;

/// What the scripts import.
const PACKAGES: [&str; 4] = ["fmpy==0.3.32", "numpy<3", "libcosimpy==0.0.6", "pythonfmu==0.7.0"];

/// The built-in scene.
fn scene() -> Result<Scene, String> {
    serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).map_err(|error| error.to_string())
}

/// The built-in scene with a rope at the fairlead and a current: an FMU of this kind has the scene's names.
fn two_sections() -> Result<Scene, String> {
    let mut scene = serde_json::to_value(scene()?).map_err(|error| error.to_string())?;
    let mut rope = scene["line_types"]["chain"].clone();
    (rope["ea"], rope["mass"], rope["submerged_weight"]) = (2.0e8.into(), 60.0.into(), 300.0.into());
    scene["line_types"]["rope"] = rope;
    scene["lines"][0]["sections"] = serde_json::json!([{"type": "rope", "length": 300.0}, {"type": "chain", "length": 900.0}]);
    scene["environment"]["current"] =
        serde_json::json!([{"z": 0.0, "velocity": [0.5, 0.2, 0.0]}, {"z": -120.0, "velocity": [0.1, 0.0, 0.0]}]);
    serde_json::from_value(scene).map_err(|error| error.to_string())
}

/// Tension of the solver alone on the built-in motion, at the FMU's communication points, as CSV.
fn standalone() -> Result<String, String> {
    let scene = scene()?;
    let Motion::Sinusoidal { period, sine, cosine, ramp } = scene.motion else {
        return Err("the built-in motion is sinusoidal".into());
    };
    let origin = scene.lines[0].fairlead.into();
    let path = Path::Sinusoidal { origin, offset: Sinusoid::new(period, sine, cosine, ramp) };
    let mut simulation = Simulation::new(&scene, 0).map_err(|error| error.to_string())?;
    simulation.settle(origin, 0.0).map_err(|error| error.to_string())?;
    let mut text = String::from("time,tension\n");
    for step in 0..=1200 {
        let time = f64::from(step) * 0.1;
        if step > 0 {
            simulation.advance(time, &path).map_err(|error| error.to_string())?;
        }
        text += &format!("{time:.1},{:?}\n", simulation.outputs().tension);
    }
    Ok(text)
}

/// Python and the FMU of the built-in scene.
fn prepared() -> &'static Result<(PathBuf, PathBuf), String> {
    static PREPARED: OnceLock<Result<(PathBuf, PathBuf), String>> = OnceLock::new();
    PREPARED.get_or_init(|| {
        let folder = FilePath::new(env!("CARGO_TARGET_TMPDIR")).join("fmu");
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        let fmu = folder.join("moorline.fmu");
        std::fs::write(folder.join("standalone.csv"), standalone()?).map_err(|error| error.to_string())?;
        pack(&scene()?, "moorline", Naming::Structured, &Libraries::beside_program(), &fmu).map_err(|error| error.to_string())?;
        let other = folder.join("two-sections.fmu");
        pack(&two_sections()?, "two-sections", Naming::Structured, &Libraries::beside_program(), &other)
            .map_err(|error| error.to_string())?;
        let lines = serde_json::from_str(include_str!("../examples/two-lines.json")).map_err(|error| error.to_string())?;
        pack(&lines, "two-lines", Naming::Structured, &Libraries::beside_program(), &folder.join("two-lines.fmu"))
            .map_err(|error| error.to_string())?;
        Ok((python::environment("python", &PACKAGES)?, fmu))
    })
}

/// Runs a script of `tests/fmu/` on the FMU.
fn script(name: &str) {
    let (interpreter, fmu) = prepared().as_ref().unwrap_or_else(|message| panic!("{message}"));
    let file = FilePath::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmu").join(name);
    let mut command = Command::new(interpreter);
    command.args(["-X", "faulthandler"]).arg(file).arg(fmu).env("PYTHONDONTWRITEBYTECODE", "1");
    if let Err(message) = run(&mut command, name) {
        panic!("{message}");
    }
}

#[test]
fn fmpy_finds_nothing_to_complain_about() {
    script("validate.py");
}

#[test]
fn every_illegal_call_is_refused_with_a_reason() {
    script("abuse.py");
}

#[test]
fn a_state_goes_back_bit_for_bit_and_into_another_process() {
    script("states.py");
}

#[test]
fn many_instances_in_many_threads_do_not_disturb_each_other_nor_leak() {
    script("many.py");
}

#[test]
fn tension_follows_the_published_case_for_every_kind_of_master() {
    script("published.py");
}

#[test]
fn derivatives_agree_with_differences_taken_by_rollback() {
    script("derivatives.py");
}

#[test]
fn a_scene_of_two_sections_has_its_own_names() {
    script("sections.py");
}

#[test]
fn two_lines_in_one_fmu_are_what_each_is_alone() {
    script("lines.py");
}

/// A script on the FMU of an example and the time series of its run, in a folder of its own.
fn moored(example: &str, script: &str, sets: &[&str]) {
    let (interpreter, fmu) = prepared().as_ref().unwrap_or_else(|message| panic!("{message}"));
    let folder = fmu.with_file_name(script.replace('/', "-"));
    let scene = FilePath::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(example).with_extension("json");
    let program = || Command::new(env!("CARGO_BIN_EXE_moorline"));
    let packed = folder.join(example).with_extension("fmu");
    let done = |command: &mut Command| run(command, script).unwrap_or_else(|message| panic!("{message}"));
    let mut running = program();
    running.arg("run").arg(&scene).args(["--quiet", "--output"]).arg(&folder);
    for set in sets {
        running.args(["--set", set]);
    }
    done(&mut running);
    done(program().arg("pack").arg(&scene).arg("--output").arg(&packed));
    let file = FilePath::new(env!("CARGO_MANIFEST_DIR")).join(script);
    let mut command = Command::new(interpreter);
    command.args(["-X", "faulthandler"]).arg(file).arg(&packed).env("PYTHONDONTWRITEBYTECODE", "1");
    if script.starts_with("tests") {
        command.arg(folder.join("timeseries.csv"));
    }
    done(&mut command);
}

#[test]
fn a_vessel_in_one_fmu_gives_its_pose_and_gets_force_and_moment() {
    moored("semi-submersible", "tests/fmu/vessel.py", &[]);
}

#[test]
fn a_buoy_and_a_ship_in_one_fmu_go_as_in_the_run() {
    moored("calm-buoy", "tests/fmu/network.py", &[]);
}

#[test]
fn a_ship_in_fmpy_is_moored_without_a_line_of_kinematics() {
    moored("spread-moored-ship", "examples/moored_ship.py", &["run.duration=0"]);
}

#[test]
fn a_ship_and_its_mooring_are_one_fmu_each_in_libcosim_and_in_ssp() {
    moored("spread-moored-ship", "tests/fmu/ship.py", &["run.duration=0"]);
}

#[test]
fn a_moored_ship_in_one_fmu_goes_through_what_a_line_goes_through() {
    moored("spread-moored-ship", "tests/fmu/moored.py", &["run.duration=0"]);
}

#[test]
fn a_vessel_with_a_clamped_riser_feels_its_moment() {
    moored("clamped-riser", "tests/fmu/clamped.py", &[]);
}

#[test]
fn held_inputs_warnings_and_clocks_are_understood() {
    script("multirate.py");
    script("told.py");
    script("clocks.py");
}

#[test]
fn the_ssp_example_is_valid_and_runs() {
    script("ssp.py");
}

#[test]
fn the_fmpy_example_runs() {
    script("example.py");
}

#[test]
fn a_vessel_on_two_lines_is_stable_in_libcosim() {
    script("osp.py");
}
