//! A mooring line in a Rust master, through the `fmi` crate: a surge of 3 m with a period of 12 s, printed every ten seconds.

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common};
use fmi::traits::FmiImport;
use std::error::Error;
use std::f64::consts::TAU;

const STEP: f64 = 0.1;

/// Times [s] and tensions [N], from one run over 120 s.
fn run(path: &str) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    let import: Fmi2Import = fmi::import::from_path(path)?;
    let reference = |name: &str| {
        let variables = &import.model_description().model_variables.variables;
        let found = variables.iter().find(|variable| variable.name == name);
        found.map(|variable| variable.value_reference).ok_or_else(|| format!("{path} has no variable {name}"))
    };
    let inputs = [reference("fairlead.position.x")?, reference("fairlead.velocity.x")?];
    let tension = [reference("tension")?];
    let mut line = import.instantiate_cs("bow line", false, true)?;
    line.setup_experiment(None, 0.0, Some(120.0))?;
    line.enter_initialization_mode()?;
    line.exit_initialization_mode()?;
    let mut rows = Vec::new();
    for index in 0..1200 {
        let time = f64::from(index) * STEP;
        let (ease, slope) = if time < 24.0 {
            (0.5 - 0.5 * (TAU * time / 48.0).cos(), TAU / 96.0 * (TAU * time / 48.0).sin())
        } else {
            (1.0, 0.0)
        };
        let (sin, cos) = (TAU * time / 12.0).sin_cos();
        line.set_real(&inputs, &[3.0 * ease * sin, 3.0 * (ease * TAU / 12.0 * cos + slope * sin)])?;
        line.do_step(time, STEP, true)?;
        let mut value = [0.0];
        line.get_real(&tension, &mut value)?;
        rows.push((time + STEP, value[0]));
    }
    if line.set_real(&[4711], &[1.0]).is_ok() {
        return Err("an unknown value reference was accepted".into());
    }
    Ok(rows)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("give the path of an FMU, such as target/dist/moorline.fmu")?;
    for (time, tension) in run(&path)?.iter().skip(99).step_by(100) {
        println!("t = {time:5.1} s   tension {:9.1} kN", tension / 1000.0);
    }
    Ok(())
}
