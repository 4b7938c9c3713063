//! `moorline check`: what a run of the scene would model, leave out and cost. Nothing is solved.

use crate::algebra::stokes::{self, Stokes};
use crate::cli::arguments::SceneArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::stop::Stop;
use crate::report::schedule::Schedule;
use crate::report::units::{count, sim_time, wall_time};
use crate::scene::read::Loaded;
use crate::scene::types::{Environment, Motion, Scene, Waves};
use crate::sea::drawing;
use crate::sea::figures::Figures;
use crate::sea::wave::Wave;
use crate::solve::motion::Ends;
use crate::solve::partition::{self, Together};
use crate::solve::simulation::{Decision, Simulation};
use std::fmt::Write;

/// Wall time of one element in one Newton iteration on one core of a common machine [s]. An order of magnitude, no promise.
const SECONDS_PER_ELEMENT_ITERATION: f64 = 5.0e-7;
/// Newton iterations of a usual time step.
const ITERATIONS_PER_STEP: f64 = 1.8;
/// Time steps of a usual run per second of simulated time, at the default tolerance; the error of a step goes with its cube.
const STEPS_PER_SECOND: f64 = 27.0;
/// The default of `solver.tolerance`.
const DEFAULT_TOLERANCE: f64 = 1.0e-3;

/// Prints the check; a bad scene has failed before this prints anything.
pub fn check(arguments: &SceneArguments) -> Result<(), Stop> {
    let loaded = arguments.load()?;
    let parts = partition::parts(&loaded.scene);
    let together = |index: usize| parts.iter().any(|part| part.lines.contains(&index) && !part.is_alone());
    // Lines that meet are solved in space.
    let line = |index| {
        let ends = Ends::of_scene(&loaded, index);
        Simulation::on_ends(&loaded.scene, index, Some(&ends).filter(|_| !together(index)))
    };
    let lines: Vec<Simulation> = (0..loaded.scene.lines.len()).map(line).collect::<Result<_, _>>()?;
    let mut text = header(&loaded);
    text += &seas(&loaded.scene);
    text += &coupling(&loaded.scene, &parts);
    for (line, simulation) in loaded.scene.lines.iter().zip(&lines) {
        let _ = writeln!(text, "\nLine \"{}\": {} m", on_terminal(&line.name), line.length());
        physics(&mut text, simulation);
        mesh(&mut text, simulation);
    }
    text += &cost(&loaded.scene, lines.iter().map(Simulation::elements).sum());
    for warning in &loaded.warnings {
        let _ = writeln!(text, "\nwarning: {}", on_terminal(warning));
    }
    Ok(console::print(&text)?)
}

fn header(loaded: &Loaded) -> String {
    let scene = &loaded.scene;
    let motion = match &scene.motion {
        Motion::Fixed => "fixed fairleads".to_string(),
        Motion::Sinusoidal { period, .. } => format!("fairleads in sinusoidal motion, period {period} s"),
        Motion::File { path } => format!("fairleads in motion after {}", on_terminal(path)),
    };
    let title = if scene.title.is_empty() { String::new() } else { format!("{}\n", on_terminal(&scene.title)) };
    format!("{title}{}: a good scene; {}, {motion}\n", on_terminal(&loaded.file), count(scene.lines.len(), "line"))
}

/// What each sea is, computed back from its components; nothing where it is calm.
fn seas(scene: &Scene) -> String {
    let Some(seas) = &scene.environment.waves else { return String::new() };
    let drawn = drawing::seas(&scene.environment);
    let several = drawn.len() > 1;
    let mut text = String::new();
    for (index, (given, drawn)) in seas.each().iter().zip(&drawn).enumerate() {
        let name = if several { format!("Sea {}", index + 1) } else { String::from("Sea") };
        text += &sea(&scene.environment, &name, &drawn.waves);
        if let Some((wave, _)) = &drawn.steady {
            text += &steady(given, wave, scene.environment.depth);
        }
        text += &record(given);
        if let Some(spreading) = given.spreading() {
            let s = spreading.exponent();
            let deviation = (2.0 / (1.0 + s)).sqrt().to_degrees();
            let _ = writeln!(
                text,
                "     spread over {} directions, s {s:.2}, standard deviation {deviation:.1} deg",
                spreading.directions
            );
        }
    }
    if several {
        let all: Vec<Wave> = drawn.into_iter().flat_map(|sea| sea.waves).collect();
        text += &sea(&scene.environment, "All seas", &all);
    }
    text
}

/// What a steady wave of the fifth order is.
fn steady(sea: &Waves, wave: &Stokes, depth: f64) -> String {
    let (Waves::Regular5th { height, period, .. }, length) = (sea, wave.length()) else { return String::new() };
    let crest: f64 = wave.elevations.iter().sum();
    format!(
        "\nSea: H {height:.3} m, T {period:.2} s, fifth order; {length:.1} m long, steepness H/L {:.4}, crest {crest:.3} m above still water; \
         it breaks at {:.2} m, and H L²/d³ is {:.3} of {}\n",
        height / length,
        stokes::highest(length, depth),
        height * length * length / depth.powi(3),
        stokes::LONGEST
    )
}

/// What of a record of an elevation is used.
fn record(sea: &Waves) -> String {
    let (Some(record), Waves::Elevation { at: [x, y], cut_off, .. }) = (sea.record(), sea) else { return String::new() };
    let left_out = 1.0 - record.variance(record.cut_off(*cut_off)) / record.variance(f64::INFINITY);
    format!(
        "     from a record at ({x}, {y}) of {} steps of {:.6} s, which comes again after {:.6} s; its mean of {:.4} m is left out, and {:.2} % \
         of its energy, above {:.4} Hz\n",
        (record.period / record.step).round(),
        record.step,
        record.period,
        record.mean,
        100.0 * left_out,
        record.cut_off(*cut_off)
    )
}

/// What components make.
fn sea(environment: &Environment, name: &str, waves: &[Wave]) -> String {
    let Some(sea) = Figures::of(waves, environment.gravity, environment.depth) else { return String::new() };
    let Figures { height, period, band: [low, high], length, steepness, steepest } = sea;
    let (symbol, of) = if waves.len() == 1 { (["H", "T"], "a wave") } else { (["Hs", "Tp"], "a sea") };
    let [h, t] = symbol;
    let band = if waves.len() == 1 { String::new() } else { format!(", components from {low:.4} to {high:.4} Hz (cut-off)") };
    let mut text = format!(
        "\n{name}: {h} {height:.3} m, {t} {period:.2} s{band}; a wave of {t} is {length:.1} m long, steepness {h}/L {steepness:.4}\n"
    );
    if sea.breaks() {
        let _ = writeln!(
            text,
            "warning: {of} of this period breaks beyond a steepness of {steepest:.4}, that is {:.2} m; linear theory does not hold for it",
            steepest * length
        );
    }
    text
}

/// What is solved together, and why; nothing where all lines hang on coordinates.
fn coupling(scene: &Scene, parts: &[Together]) -> String {
    let mut text = String::new();
    if scene.bodies.is_empty() && scene.points.is_empty() {
        return text;
    }
    text.push('\n');
    let names =
        |names: Vec<&String>| names.iter().map(|name| format!("\"{}\"", on_terminal(name))).collect::<Vec<_>>().join(", ");
    for part in parts.iter().filter(|part| !part.is_alone()) {
        let lines = names(part.lines.iter().map(|line| &scene.lines[*line].name).collect());
        let bodies = part.bodies.iter().map(|body| &scene.bodies[*body].name);
        let free = names(bodies.chain(part.points.iter().map(|point| &scene.points[*point].name)).collect());
        let why = if free.is_empty() {
            String::from("an end is clamped to a driven body, whose turns bend it")
        } else {
            format!("they meet at what is free, {free}, and are solved for with it")
        };
        let _ = writeln!(text, "  together  {lines}: {why}");
    }
    let alone: Vec<&String> = parts
        .iter()
        .filter(|part| part.is_alone())
        .flat_map(|part| part.lines.iter().map(|line| &scene.lines[*line].name))
        .collect();
    if !alone.is_empty() {
        let _ = writeln!(text, "  apart     {}: each between ends that are fixed or driven, with steps of its own", names(alone));
    }
    let driven: Vec<&String> = scene.bodies.iter().filter(|body| !body.is_free()).map(|body| &body.name).collect();
    if !driven.is_empty() {
        let _ = writeln!(text, "  driven    {}: exact kinematics, nothing to solve for; inputs of an FMU", names(driven));
    }
    text
}

/// What is modelled, and what is skipped and why.
fn physics(text: &mut String, simulation: &Simulation) {
    let decisions = simulation.decisions();
    let width = decisions.iter().map(|decision| decision.physics.chars().count()).max().unwrap_or(0);
    for Decision { physics, on, reason } in decisions {
        let _ = writeln!(text, "  {} {physics:<width$}  {reason}", if *on { "on  " } else { "skip" });
    }
}

fn mesh(text: &mut String, simulation: &Simulation) {
    let _ = writeln!(text, "  mesh: {}", count(simulation.elements(), "element"));
    for (from, to, elements) in simulation.mesh() {
        let each = (to - from) / elements.max(1) as f64;
        let _ = writeln!(text, "    s = {from:>10.3} to {to:>10.3} m: {elements:>5} of {each:.3} m");
    }
}

/// The work of a run: steps that land on every output time, and that are as many as the tolerance usually asks.
fn cost(scene: &Scene, elements: usize) -> String {
    let schedule = Schedule::new(&scene.run);
    let steps_per_row = |longest: f64| (scene.run.output_step / longest * (1.0 - 1.0e-9)).ceil().max(1.0);
    let rows = (schedule.rows() - 1) as f64;
    let usual = match scene.solver.uncontrolled_step() {
        Some(step) => steps_per_row(step),
        None => {
            let asked = STEPS_PER_SECOND * (DEFAULT_TOLERANCE / scene.solver.tolerance).cbrt() * scene.run.output_step;
            steps_per_row(scene.solver.max_step).max(asked)
        }
    };
    let steps = rows * usual;
    let seconds = steps * ITERATIONS_PER_STEP * elements as f64 * SECONDS_PER_ELEMENT_ITERATION;
    format!(
        "\nCost: {} rows to t = {} s, some {steps:.0} steps of {}; about {} of solver time, more where the line snaps.\n",
        schedule.rows(),
        sim_time(scene.run.end()),
        count(elements, "element"),
        wall_time(seconds),
    )
}
