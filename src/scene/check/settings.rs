//! Rules on how long and how a scene is run.

use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
use crate::scene::types::Scene;

/// Most rows of `timeseries.csv`.
const MOST_ROWS: f64 = 5.0e7;

pub fn run(scene: &Scene, file: &str) -> Result<(), Error> {
    let run = &scene.run;
    not_negative(file, "run.duration", run.duration, "s")?;
    finite(file, "run.start", &[run.start])?;
    positive(file, "run.output_step", run.output_step, "s")?;
    if let Some(transient) = run.transient {
        not_negative(file, "run.transient", transient, "s")?;
        if !(transient < run.duration) {
            let allowed =
                format!("it must be less than run.duration, {} s, or no time is left for statistics", number(run.duration));
            return refuse(file, "run.transient", format!("{} s", number(transient)), allowed);
        }
    }
    let rows = run.duration / run.output_step;
    if !(rows <= MOST_ROWS) {
        let allowed = format!("{} s of run would make {rows:.1e} rows, and {MOST_ROWS:.0e} are the limit", number(run.duration));
        return refuse(file, "run.output_step", number(run.output_step), allowed);
    }
    Ok(())
}

pub fn solver(scene: &Scene, file: &str) -> Result<(), Error> {
    let solver = &scene.solver;
    if let Some(scale) = solver.tension_scale.filter(|scale| !(*scale >= 0.0 && scale.is_finite())) {
        return refuse(file, "solver.tension_scale", number(scale), "it must be zero or positive");
    }
    if !(1.0e-8..=0.1).contains(&solver.tolerance) {
        return refuse(file, "solver.tolerance", number(solver.tolerance), "it must lie between 1e-8 and 0.1");
    }
    positive(file, "solver.max_step", solver.max_step, "s")?;
    solver.fixed_step.map_or(Ok(()), |step| positive(file, "solver.fixed_step", step, "s; leave it out for step control"))
}
