//! `moorline run`: statics, then dynamics in output steps, with every row on disk as soon as it is known.

use crate::cli::arguments::{RunArguments, Stop};
use crate::cli::console::{self, on_terminal};
use crate::cli::interrupt::Interrupt;
use crate::cli::pack::BUILT_IN;
use crate::cli::progress::Progress;
use crate::error::Error;
use crate::fmi::pack::{self, Libraries};
use crate::report::cable_files::CableFiles;
use crate::report::page;
use crate::report::record::Record;
use crate::report::schedule::Schedule;
use crate::report::tables::{self, Nodes, TimeSeries};
use crate::report::units::{count, sim_time, wall_time};
use crate::scene::cable::{Deck, Job};
use crate::scene::read::{self, Loaded};
use crate::scene::state::LineState;
use crate::scene::types::Scheme;
use crate::solve::departure::{self, Departure};
use crate::solve::motion;
use crate::solve::simulation::{NodeOutput, Outputs, Simulation};
use std::fmt::Write;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Runs a scene and leaves the results in the output directory, also of a run that fails or is stopped half way.
pub fn run(arguments: &RunArguments) -> Result<(), Stop> {
    let sets = &arguments.options.sets;
    let loaded = arguments.scene.as_deref().map_or_else(|| read::built_in(sets), |scene| read::load(scene, sets))?;
    let quiet = arguments.options.quiet;
    if !quiet {
        loaded.warnings.iter().for_each(|warning| console::warning(warning));
    }
    let schedule = Schedule::new(&loaded.scene.run);
    let mut record = Record::new(&loaded.scene, &loaded.file, loaded.warnings.clone(), schedule.snapshot_step());
    let started = Instant::now();
    let mut lines = MovingLines::new(&loaded)?;
    record.statics_seconds = started.elapsed().as_secs_f64();

    let files = Files::of(&arguments.options.output)?;
    let mut tables = Tables::create(&files, &record, &loaded, &arguments.options.output)?;
    let outcome = drive(&mut lines, &schedule, &mut record, &mut tables, quiet);
    lines.count(&mut record);
    record.ended_by = outcome.as_ref().err().cloned();
    tables::write(&files.summary, &tables::summary(&record))?;
    tables::write(&files.report, &page::html(&record))?;
    let built_in_done = arguments.scene.is_none() && outcome.is_ok();
    let fmu = if built_in_done { leave_fmu(&loaded, &arguments.options.output)? } else { String::new() };
    if !quiet {
        // Warnings of the scene were given before the run; what the run itself has to say comes after it.
        record.warnings().iter().skip(loaded.warnings.len()).for_each(|warning| console::warning(warning));
        console::print(&(printed_summary(&record, &files) + &fmu))?;
    }
    Ok(outcome?)
}

/// Puts the built-in case's FMU beside its results; what the summary says of it. A program that was installed without the FMU's library
/// has a note to give instead, not an error.
fn leave_fmu(loaded: &Loaded, directory: &Path) -> Result<String, Error> {
    let libraries = Libraries::beside_program();
    if libraries.files.is_empty() {
        return Ok("  no FMU: its library does not lie beside the program (`cargo build --release` puts it there)\n".to_owned());
    }
    let file = directory.join(BUILT_IN).with_extension("fmu");
    pack::pack(&loaded.scene, BUILT_IN, &libraries, &file)?;
    Ok(format!("  {}  this one goes into a co-simulation (FMI 2.0); its port for OSP lies beside it\n", file.display()))
}

/// From static equilibrium to the end of the schedule, or to the failure that ends the run earlier.
fn drive(
    lines: &mut MovingLines,
    schedule: &Schedule,
    record: &mut Record,
    tables: &mut Tables,
    quiet: bool,
) -> Result<(), Error> {
    let interrupt = Interrupt::watch();
    lines.settle(record)?;
    let mut nodes = lines.nodes();
    tables.row(record, schedule.time(0), &lines.outputs(), &nodes)?;
    tables.cable_row(lines)?;
    tables.snapshot(record, schedule.time(0), &nodes)?;

    let progress = Progress::new(schedule.rows(), record.scene.run.end(), quiet);
    let mut outcome = Ok(());
    for row in 1..schedule.rows() {
        let time = schedule.time(row);
        outcome = lines.advance(time, &interrupt, record);
        if outcome.is_err() {
            break;
        }
        let outputs = lines.outputs();
        nodes = lines.nodes();
        tables.row(record, time, &outputs, &nodes)?;
        tables.cable_row(lines)?;
        if row % schedule.rows_per_snapshot() == 0 {
            tables.snapshot(record, time, &nodes)?;
        }
        progress.show(row, time, &outputs);
    }
    // The last state that all lines share, wherever the run ended.
    if let Some(end) = record.end_time().filter(|end| record.snapshot_times.last() < Some(end)) {
        tables.snapshot(record, end, &nodes)?;
    }
    tables.cable_output(record, lines)?;
    outcome
}

/// All lines of a scene with their fairlead paths. They do not know of each other; they meet at the output times.
struct MovingLines {
    lines: Vec<(Simulation, motion::Path)>,
    /// The state that a CABLE file gives the first line.
    given: Option<Arc<LineState>>,
}

impl MovingLines {
    fn new(loaded: &Loaded) -> Result<MovingLines, Error> {
        let line = |index| {
            let path = motion::Path::of_scene(loaded, index);
            Ok((Simulation::on_path(&loaded.scene, index, Some(&path))?, path))
        };
        let lines = (0..loaded.scene.lines.len()).map(line).collect::<Result<_, Error>>()?;
        let dynamics = loaded.deck.as_ref().is_some_and(|deck| deck.job == Job::Dynamics);
        Ok(MovingLines { lines, given: loaded.state.clone().filter(|_| dynamics) })
    }

    /// Finds the equilibrium of all lines, or begins where a CABLE file says. Of a line that has no equilibrium, the best state found is
    /// recorded.
    fn settle(&mut self, record: &mut Record) -> Result<(), Error> {
        let begin = record.scene.run.start;
        let mut given = self.given.take();
        for ((simulation, path), line) in self.lines.iter_mut().zip(&mut record.lines) {
            let started = Instant::now();
            let fairlead = path.at(begin).position;
            let departure = match given.take() {
                Some(given) => departure::depart(simulation, &given, fairlead, record.scene.solver.scheme == Scheme::Cable1994),
                None => simulation.settle(fairlead, begin).map(Departure::Equilibrium),
            };
            record.statics_seconds += started.elapsed().as_secs_f64();
            line.equilibrium = simulation.nodes();
            let departure = departure?;
            if let Departure::Equilibrium(report) | Departure::Foreign(report) = departure {
                line.statics = Some(report);
            }
            record.scene_warnings.extend(remark(&departure).map(|remark| format!("{}: {remark}", record.file)));
        }
        Ok(())
    }

    /// The state of the first line.
    fn line_state(&self) -> Option<LineState> {
        self.lines.first().map(|(simulation, _)| simulation.line_state())
    }

    /// Advances all lines to an output time, unless the user stops the run before.
    fn advance(&mut self, until: f64, interrupt: &Interrupt, record: &mut Record) -> Result<(), Error> {
        for (simulation, path) in &mut self.lines {
            if interrupt.came() {
                return Err(Error::Interrupted { time: record.end_time().unwrap_or(0.0) });
            }
            let started = Instant::now();
            let outcome = simulation.advance(until, path);
            record.solver_seconds += started.elapsed().as_secs_f64();
            outcome?;
        }
        Ok(())
    }

    fn outputs(&self) -> Vec<Outputs> {
        self.lines.iter().map(|(simulation, _)| simulation.outputs()).collect()
    }

    fn nodes(&self) -> Vec<Vec<NodeOutput>> {
        self.lines.iter().map(|(simulation, _)| simulation.nodes()).collect()
    }

    /// Notes the work done by the solver.
    fn count(&self, record: &mut Record) {
        for ((simulation, _), line) in self.lines.iter().zip(&mut record.lines) {
            line.elements = simulation.elements();
            line.counters = simulation.counters();
        }
    }
}

/// What a user should know of the nodes from which a run began.
fn remark(departure: &Departure) -> Option<String> {
    match departure {
        Departure::Equilibrium(_) | Departure::Moving => None,
        Departure::Unbalanced { node, distance } => Some(format!(
            "the nodes are not in equilibrium: node {node} would rest {distance:.2} m away; the run began from them as they stand"
        )),
        Departure::Unsettled => {
            Some("the nodes are not in equilibrium, and none was found; the run began from them as they stand".to_string())
        }
        Departure::Foreign(_) => Some("the line is longer than the nodes say; the run began in equilibrium".to_string()),
    }
}

/// Where the results go.
struct Files {
    time_series: PathBuf,
    nodes: PathBuf,
    summary: PathBuf,
    report: PathBuf,
}

impl Files {
    /// Makes the directory. A summary and report of an earlier run go, lest they stand beside the rows of this one.
    fn of(directory: &Path) -> Result<Files, Error> {
        std::fs::create_dir_all(directory).map_err(|error| Error::File {
            path: directory.display().to_string(),
            reason: format!("the output directory cannot be made: {error}. Choose another with -o DIR."),
        })?;
        let files = Files {
            time_series: directory.join("timeseries.csv"),
            nodes: directory.join("nodes.csv"),
            summary: directory.join("summary.json"),
            report: directory.join("report.html"),
        };
        for old in [&files.summary, &files.report] {
            // Where this fails, writing the new file says why.
            let _ = std::fs::remove_file(old);
        }
        Ok(files)
    }
}

/// The tables that grow with the run, in step with the record.
struct Tables {
    time_series: TimeSeries<File>,
    nodes: Nodes<File>,
    /// The files of 1994, where a CABLE file is run.
    cable: Option<(CableFiles, Arc<Deck>)>,
}

impl Tables {
    fn create(files: &Files, record: &Record, loaded: &Loaded, directory: &Path) -> Result<Tables, Error> {
        let names: Vec<&str> = record.lines.iter().map(|line| line.name.as_str()).collect();
        let scene = &record.scene;
        let walls = scene.solver.hydrostatic_strain || scene.line_types.values().any(|line_type| line_type.inner_fluid.is_some());
        Ok(Tables {
            time_series: TimeSeries::new(tables::create(&files.time_series)?, &files.time_series, &names)?,
            nodes: Nodes::new(tables::create(&files.nodes)?, &files.nodes, walls)?,
            cable: loaded.deck.clone().map(|deck| Ok((CableFiles::create(directory, &deck)?, deck))).transpose()?,
        })
    }

    /// A row of the files of 1994.
    fn cable_row(&mut self, lines: &MovingLines) -> Result<(), Error> {
        let Some((files, _)) = &mut self.cable else { return Ok(()) };
        lines.line_state().map_or(Ok(()), |state| files.row(&state))
    }

    /// The output of 1994.
    fn cable_output(&self, record: &Record, lines: &MovingLines) -> Result<(), Error> {
        let Some((files, deck)) = &self.cable else { return Ok(()) };
        lines.line_state().map_or(Ok(()), |state| files.finish(&record.scene, deck, &state))
    }

    fn row(&mut self, record: &mut Record, time: f64, outputs: &[Outputs], nodes: &[Vec<NodeOutput>]) -> Result<(), Error> {
        self.time_series.row(time, outputs)?;
        record.add_row(time, outputs, nodes);
        Ok(())
    }

    fn snapshot(&mut self, record: &mut Record, time: f64, nodes: &[Vec<NodeOutput>]) -> Result<(), Error> {
        let names = record.lines.iter().map(|line| line.name.as_str());
        self.nodes.snapshot(time, names.zip(nodes.iter().map(Vec::as_slice)))?;
        record.add_snapshot(time, nodes);
        Ok(())
    }
}

/// What a run prints when it is over.
fn printed_summary(record: &Record, files: &Files) -> String {
    let mut text = String::new();
    if !record.scene.title.is_empty() {
        let _ = writeln!(text, "{}", on_terminal(&record.scene.title));
    }
    let scheme = serde_json::to_value(record.scene.solver.scheme).ok();
    let _ = writeln!(
        text,
        "{}: {}, {}, {}, tolerance {}\n",
        on_terminal(&record.file),
        count(record.lines.len(), "line"),
        count(record.elements(), "element"),
        scheme.as_ref().and_then(|name| name.as_str()).unwrap_or_default(),
        record.scene.solver.tolerance,
    );
    tension_table(&mut text, record);
    work(&mut text, record);
    let rows = count(record.times.len(), "row");
    let snapshots = count(record.snapshot_times.len(), "snapshot");
    let _ = writeln!(text, "  {}  {rows}, every {} s", files.time_series.display(), sim_time(record.scene.run.output_step));
    let _ = writeln!(text, "  {}  {snapshots}, every {} s", files.nodes.display(), sim_time(record.snapshot_step));
    let _ = writeln!(text, "  {}", files.summary.display());
    let _ = writeln!(text, "  {}  open this one in a browser", files.report.display());
    text
}

/// Static tension at the fairleads, largest and smallest with their times.
fn tension_table(text: &mut String, record: &Record) {
    if record.times.is_empty() {
        return;
    }
    let unit = record.force_unit();
    let names: Vec<String> = record.lines.iter().map(|line| on_terminal(&line.name)).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max("fairlead".len());
    let heading = format!("  {:<width$}{:>14}{:>14}{:>12}{:>14}{:>12}", "fairlead", "static", "max", "at", "min", "at");
    let _ = writeln!(text, "{heading}");
    for (line, name) in record.lines.iter().zip(&names) {
        let Some(tension) = line.statistics(|row| row.tension) else { continue };
        let _ = writeln!(
            text,
            "  {name:<width$}{:>14}{:>14}{:>12}{:>14}{:>12}",
            unit.show(tension.initial),
            unit.show(tension.max),
            sim_time(tension.max_time) + " s",
            unit.show(tension.min),
            sim_time(tension.min_time) + " s",
        );
    }
    let _ = writeln!(text);
}

/// What the run cost.
fn work(text: &mut String, record: &Record) {
    let counters = record.counters();
    let _ = writeln!(
        text,
        "  {} ({} rejected), {}",
        count(counters.steps, "step"),
        counters.rejected_steps,
        count(counters.newton_iterations, "Newton iteration"),
    );
    let speed = record.times_real_time().map_or(String::new(), |factor| format!(", {factor:.0} times real time"));
    let _ =
        writeln!(text, "  statics {}, dynamics {}{speed}\n", wall_time(record.statics_seconds), wall_time(record.solver_seconds));
}
