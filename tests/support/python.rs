//! Python for the tests that other programs take part in.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs a command; its output is the message where it fails.
pub fn run(command: &mut Command, purpose: &str) -> Result<(), String> {
    let output = command.output().map_err(|error| format!("{purpose}: {command:?}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Err(format!("{purpose}: {command:?} ended with {}\n{out}\n{err}", output.status))
}

/// The Python of the virtual environment `name` among the files of the tests, which holds `packages`. Tests that run at once may ask
/// for the same one: the first makes it, the others wait for it.
pub fn environment(name: &str, packages: &[&str]) -> Result<PathBuf, String> {
    let environment = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let python = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let lock = File::create(environment.with_extension("lock")).map_err(|error| error.to_string())?;
    lock.lock().map_err(|error| error.to_string())?;
    let finished = environment.join("packages.txt");
    if std::fs::read_to_string(&finished).is_ok_and(|found| found == packages.join("\n")) {
        return Ok(python);
    }
    let names = ["python3", "python"];
    let found =
        names.iter().find(|name| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()));
    let Some(system) = found else {
        return Err("some tests need Python 3.9 or newer on the PATH, as `python3` or `python`: install it and try again".into());
    };
    run(
        Command::new(system).args(["-m", "venv"]).arg(&environment),
        "making a virtual environment (Debian: install python3-venv)",
    )?;
    run(
        Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages),
        "installing the Python packages of the tests",
    )?;
    std::fs::write(&finished, packages.join("\n")).map_err(|error| error.to_string())?;
    Ok(python)
}
