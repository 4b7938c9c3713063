//! `moorline run`: statics, then dynamics in output steps, with every row on disk as soon as it is known.

use crate::cli::arguments::RunArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::interrupt::Interrupt;
use crate::cli::pack::BUILT_IN;
use crate::cli::progress::Progress;
use crate::cli::stop::Stop;
use crate::error::Error;
use crate::fmi::pack::{self, Libraries, Naming};
use crate::report::cable_files::CableFiles;
use crate::report::moordyn_out;
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
use crate::solve::fleet;
use crate::solve::loads::{BodyOutputs, Pose};
use crate::solve::mooring::Hung;
use crate::solve::part::Part;
use crate::solve::partition::{self, Together};
use crate::solve::simulation::{Counters, NodeOutput, Outputs};
use nalgebra::Vector3;
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
    let mut parts = MovingParts::new(&loaded)?;
    record.statics_seconds = started.elapsed().as_secs_f64();
    for part in &parts.parts {
        let lines = part.part.lines().iter().enumerate();
        lines.for_each(|(local, index)| record.lines[*index].elements = part.part.line(local).elements());
    }

    let files = Files::of(&arguments.options.output)?;
    let mut tables = Tables::create(&files, &record, &loaded, &arguments.options.output)?;
    let outcome = drive(&mut parts, &schedule, &mut record, &mut tables, quiet);
    record.ended_by = outcome.as_ref().err().cloned();
    tables::write(&files.summary, &tables::summary(&record))?;
    tables::write(&files.report, &page::html(&record))?;
    if let Some(text) = loaded.moordyn.as_ref().and_then(|deck| moordyn_out::text(&record, deck)) {
        let stem = Path::new(&loaded.file).file_stem().unwrap_or_default().to_string_lossy();
        tables::write(&arguments.options.output.join(format!("{stem}.out")), &text)?;
    }
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
    pack::pack(&loaded.scene, BUILT_IN, Naming::Structured, &libraries, &file)?;
    Ok(format!("  {}  this one goes into a co-simulation (FMI 2.0); its port for OSP lies beside it\n", file.display()))
}

/// From static equilibrium to the end of the schedule, or to the failure that ends the run earlier.
fn drive(
    parts: &mut MovingParts,
    schedule: &Schedule,
    record: &mut Record,
    tables: &mut Tables,
    quiet: bool,
) -> Result<(), Error> {
    let interrupt = Interrupt::watch();
    parts.settle(record)?;
    let wanted = Wanted { schedule, walls: tables.walls, states: tables.cable.is_some() };
    let start = parts.parts.iter_mut().map(|part| part.sample(0, &wanted)).collect();
    let MovingParts { parts: moving, hung, .. } = &mut *parts;
    let mut now = Row::of(schedule.time(0), start, hung);
    tables.row(record, &now)?;

    let progress = Progress::new(schedule.rows(), record.scene.run.end(), quiet);
    let gather = |row: usize, samples: Vec<PartSample>| {
        now = Row::of(schedule.time(row), samples, hung);
        tables.row(record, &now)?;
        progress.show(row, now.time, &now.outputs);
        Ok(())
    };
    let outcome = fleet::through_rows(moving, 1..schedule.rows(), |part, row| part.go(row, &wanted, &interrupt), gather);
    parts.account(record);
    // The last state that all lines share, wherever the run ended.
    if record.snapshot_times.last() < Some(&now.time) {
        let names = record.lines.iter().map(|line| line.name.as_str());
        now.node_rows =
            names.zip(&now.nodes).map(|(name, nodes)| tables::node_rows(now.time, name, nodes, tables.walls)).collect();
        tables.snapshot(record, &now)?;
    }
    tables.cable_output(record, &now)?;
    outcome
}

/// A part of the mooring on its way.
struct MovingPart {
    part: Part,
    names: Vec<String>,
    /// Wall time inside the time loop [s].
    seconds: f64,
    /// Time at which it stands, if it could go no further [s].
    stuck_at: Option<f64>,
}

/// What is wanted of every line.
struct Wanted<'a> {
    schedule: &'a Schedule,
    /// The tension of the wall.
    walls: bool,
    /// The state for the files of 1994.
    states: bool,
}

/// A line at an output time, with its part of the tables.
struct Sample {
    index: usize,
    outputs: Outputs,
    nodes: Vec<NodeOutput>,
    counters: Counters,
    cells: String,
    /// Where a snapshot is due.
    node_rows: Option<Vec<u8>>,
    state: Option<LineState>,
}

/// A part at an output time.
struct PartSample {
    lines: Vec<Sample>,
    bodies: Vec<(usize, Pose)>,
    points: Vec<(usize, Vector3<f64>)>,
}

impl MovingPart {
    /// Advances to a row, unless the user stops the run before.
    fn go(&mut self, row: usize, wanted: &Wanted, interrupt: &Interrupt) -> Result<PartSample, Error> {
        if interrupt.came() {
            return Err(Error::Interrupted { time: wanted.schedule.time(row - 1) });
        }
        let started = Instant::now();
        let outcome = self.part.advance(wanted.schedule.time(row));
        self.seconds += started.elapsed().as_secs_f64();
        if outcome.is_err() {
            self.stuck_at = Some(wanted.schedule.time(row - 1));
        }
        outcome.map(|()| self.sample(row, wanted))
    }

    fn sample(&mut self, row: usize, wanted: &Wanted) -> PartSample {
        let due = row.is_multiple_of(wanted.schedule.rows_per_snapshot());
        let indices = self.part.lines().to_vec();
        let mut line = |(local, index): (usize, usize)| {
            let (outputs, nodes) = (self.part.outputs(local), self.part.nodes(local));
            let time = wanted.schedule.time(row);
            Sample {
                index,
                outputs,
                counters: self.part.counters(local),
                cells: tables::cells(&outputs),
                node_rows: due.then(|| tables::node_rows(time, &self.names[local], &nodes, wanted.walls)),
                nodes,
                state: wanted.states.then(|| self.part.line(local).line_state()),
            }
        };
        let lines = indices.into_iter().enumerate().map(&mut line).collect();
        PartSample { lines, bodies: self.part.bodies(), points: self.part.points() }
    }
}

/// All lines, bodies and free points at an output time.
#[derive(Default)]
struct Row {
    time: f64,
    outputs: Vec<Outputs>,
    nodes: Vec<Vec<NodeOutput>>,
    counters: Vec<Counters>,
    cells: Vec<String>,
    /// Empty where no snapshot is due.
    node_rows: Vec<Vec<u8>>,
    /// Of the first line, where a CABLE file is run.
    state: Option<LineState>,
    bodies: Vec<BodyOutputs>,
    points: Vec<Vector3<f64>>,
}

impl Row {
    fn of(time: f64, parts: Vec<PartSample>, hung: &Hung) -> Row {
        let mut row = Row { time, ..Row::default() };
        let (mut lines, mut poses, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for part in parts {
            lines.extend(part.lines);
            poses.extend(part.bodies);
            points.extend(part.points);
        }
        lines.sort_by_key(|line| line.index);
        for line in lines {
            row.outputs.push(line.outputs);
            row.nodes.push(line.nodes);
            row.counters.push(line.counters);
            row.cells.push(line.cells);
            row.node_rows.extend(line.node_rows);
            row.state = row.state.or(line.state);
        }
        row.bodies = hung.bodies(time, &poses, &row.outputs);
        points.sort_by_key(|(index, _)| *index);
        row.points = points.into_iter().map(|(_, place)| place).collect();
        row.cells.extend(row.bodies.iter().map(tables::body_cells));
        row.cells.extend(row.points.iter().map(tables::point_cells));
        row
    }
}

/// All parts of a scene. They do not know of each other; their rows are gathered at the output times.
struct MovingParts {
    parts: Vec<MovingPart>,
    hung: Hung,
    /// The state that a CABLE file gives the first line.
    given: Option<Arc<LineState>>,
}

impl MovingParts {
    fn new(loaded: &Loaded) -> Result<MovingParts, Error> {
        let part = |together: &mut Together| {
            let part = Part::of_scene(loaded, together)?;
            let names = part.lines().iter().map(|index| loaded.scene.lines[*index].name.clone()).collect();
            Ok(MovingPart { part, names, seconds: 0.0, stuck_at: None })
        };
        let mut parts = partition::parts(&loaded.scene);
        let parts = fleet::for_each(&mut parts, part).into_iter().collect::<Result<_, Error>>()?;
        let dynamics = loaded.deck.as_ref().is_some_and(|deck| deck.job == Job::Dynamics);
        Ok(MovingParts { parts, hung: Hung::new(loaded), given: loaded.state.clone().filter(|_| dynamics) })
    }

    /// Finds the equilibrium of all parts, or begins where a CABLE file says. Of a line that has no equilibrium, the best state found is
    /// recorded.
    fn settle(&mut self, record: &mut Record) -> Result<(), Error> {
        let begin = record.scene.run.start;
        let exactly = record.scene.solver.scheme == Scheme::Cable1994;
        let started = Instant::now();
        let mut given = self.given.take();
        let mut beginnings: Vec<_> = self.parts.iter_mut().map(|part| (part, given.take())).collect();
        let departures = fleet::for_each(&mut beginnings, |(part, given)| match (&mut part.part, given) {
            (Part::Alone { simulation, ends, .. }, Some(given)) => {
                departure::depart(simulation, given, ends.fairlead.at(begin).position, exactly)
            }
            (part, _) => part.settle(begin).map(Departure::Equilibrium),
        });
        record.statics_seconds += started.elapsed().as_secs_f64();
        for (part, departure) in self.parts.iter_mut().zip(departures) {
            for (local, index) in part.part.lines().to_vec().into_iter().enumerate() {
                record.lines[index].equilibrium = part.part.nodes(local);
            }
            let departure = departure?;
            if let Departure::Equilibrium(report) | Departure::Foreign(report) = departure {
                part.part.lines().iter().for_each(|index| record.lines[*index].statics = Some(report));
            }
            record.scene_warnings.extend(remark(&departure).map(|remark| format!("{}: {remark}", record.file)));
        }
        Ok(())
    }

    /// Notes the time spent, and the work of a part in the step that ended the run.
    fn account(&self, record: &mut Record) {
        let seconds = self.parts.iter().map(|part| part.seconds);
        record.line_seconds = seconds.clone().sum();
        record.solver_seconds =
            (record.line_seconds / fleet::threads(self.parts.len()).max(1) as f64).max(seconds.fold(0.0, f64::max));
        let end = record.end_time();
        for part in self.parts.iter().filter(|part| part.stuck_at.is_some() && part.stuck_at == end) {
            for (local, index) in part.part.lines().iter().enumerate() {
                record.lines[*index].counters = part.part.counters(local);
            }
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
    /// Whether the nodes have a tension of the wall.
    walls: bool,
    /// The files of 1994, where a CABLE file is run.
    cable: Option<(CableFiles, Arc<Deck>)>,
}

impl Tables {
    fn create(files: &Files, record: &Record, loaded: &Loaded, directory: &Path) -> Result<Tables, Error> {
        let names: Vec<&str> = record.lines.iter().map(|line| line.name.as_str()).collect();
        let bodies: Vec<&str> = record.bodies.iter().map(|body| body.name.as_str()).collect();
        let points: Vec<&str> = record.points.iter().map(|point| point.name.as_str()).collect();
        let scene = &record.scene;
        let walls = scene.solver.hydrostatic_strain || scene.line_types.values().any(|line_type| line_type.inner_fluid.is_some());
        Ok(Tables {
            time_series: TimeSeries::new(tables::create(&files.time_series)?, &files.time_series, &names, &bodies, &points)?,
            nodes: Nodes::new(tables::create(&files.nodes)?, &files.nodes, walls)?,
            walls,
            cable: loaded.deck.clone().map(|deck| Ok((CableFiles::create(directory, &deck)?, deck))).transpose()?,
        })
    }

    /// A row of every table, and a snapshot where one is due.
    fn row(&mut self, record: &mut Record, row: &Row) -> Result<(), Error> {
        self.time_series.row(row.time, &row.cells)?;
        record.add_row(row.time, &row.outputs, &row.nodes);
        record.add_bodies(&row.bodies, &row.points);
        record.count(&row.counters);
        if let (Some((files, _)), Some(state)) = (&mut self.cable, &row.state) {
            files.row(state)?;
        }
        if row.node_rows.is_empty() { Ok(()) } else { self.snapshot(record, row) }
    }

    fn snapshot(&mut self, record: &mut Record, row: &Row) -> Result<(), Error> {
        self.nodes.snapshot(&row.node_rows)?;
        record.add_snapshot(row.time, &row.nodes);
        Ok(())
    }

    /// The output of 1994.
    fn cable_output(&self, record: &Record, row: &Row) -> Result<(), Error> {
        let (Some((files, deck)), Some(state)) = (&self.cable, &row.state) else { return Ok(()) };
        files.finish(&record.scene, deck, state)
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
