//! The same moorings in other programs: what they find is what we find.

use std::path::Path;
use std::process::Command;

mod support;
use support::python;

/// What the scripts import.
const PACKAGES: [&str; 3] = ["moorpy==1.3.0", "moordyn==2.7.2", "numpy<3"];

/// Restoring force and moment, tensions and stiffness of a semi-submersible on three lines: within 1e-4 of MoorPy's, which is quasi-static as well.
#[test]
fn offsets_and_stiffness_are_those_of_moorpy() -> Result<(), String> {
    let interpreter = python::environment("peers", &PACKAGES)?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (scene, results) = (root.join("examples/semi-submersible.json"), Path::new(env!("CARGO_TARGET_TMPDIR")).join("offsets"));
    let program = || {
        let mut program = Command::new(env!("CARGO_BIN_EXE_moorline"));
        program.arg("statics").arg(&scene);
        program
    };
    python::run(program().args(["--offsets", "platform.x=-20:20:1", "-o"]).arg(&results), "offsets")?;
    let statics = program().arg("--json").output().map_err(|error| error.to_string())?;
    let file = results.join("statics.json");
    std::fs::write(&file, statics.stdout).map_err(|error| error.to_string())?;
    let script = root.join("tests/peers/moorpy_offsets.py");
    python::run(Command::new(interpreter).arg(script).args([&scene, &results.join("offsets.csv"), &file]), "MoorPy")
}

/// Six lines and three floats: nearer to MoorDyn's finer mesh than its coarser one is.
#[test]
fn floats_of_a_wave_energy_device_move_as_those_of_moordyn() -> Result<(), String> {
    let interpreter = python::environment("peers", &PACKAGES)?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/moordyn_floats.py");
    python::run(Command::new(interpreter).arg(script).env("MOORLINE", env!("CARGO_BIN_EXE_moorline")), "MoorDyn")
}
