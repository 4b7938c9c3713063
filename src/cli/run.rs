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
use crate::report::course::{Course, Follower, Row, Wanted};
use crate::report::moordyn_out;
use crate::report::page;
use crate::report::record::Record;
use crate::report::schedule::Schedule;
use crate::report::statistics;
use crate::report::tables::{self, Nodes, TimeSeries};
use crate::report::units::{count, sim_time, wall_time};
use crate::report::vtk;
use crate::scene::cable::Deck;
use crate::scene::read::Loaded;
use std::fmt::Write;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Directory of the files for ParaView, in that of the results.
const PICTURES: &str = "vtk";

/// Runs a scene and leaves the results in the output directory, also of a run that fails or is stopped half way.
pub fn run(arguments: &RunArguments) -> Result<(), Stop> {
    let loaded = arguments.load()?;
    let quiet = arguments.options.quiet;
    if !quiet {
        loaded.warnings.iter().for_each(|warning| console::warning(warning));
    }
    let interrupt = Interrupt::watch();
    let progress = Progress::new(Schedule::new(&loaded.scene.run).rows(), loaded.scene.run.end(), quiet);
    let (record, files) =
        into_directory(&loaded, &arguments.options.output, arguments.options.vtk, progress, &|| interrupt.came())?;
    let built_in_done = arguments.scene.is_none() && record.ended_by.is_none();
    let fmu = if built_in_done { leave_fmu(&loaded, &arguments.options.output)? } else { String::new() };
    if !quiet {
        // Warnings of the scene were given before the run; what the run itself has to say comes after it.
        record.warnings().iter().skip(loaded.warnings.len()).for_each(|warning| console::warning(warning));
        let paraview = if arguments.options.vtk {
            format!("  {}  this one in ParaView\n", arguments.options.output.join(PICTURES).join(vtk::LINES).display())
        } else {
            String::new()
        };
        console::print(&(printed_summary(&record, &files) + &paraview + &fmu))?;
    }
    record.ended_by.map_or(Ok(()), |error| Err(error.into()))
}

/// Runs a scene and leaves the results in a directory, files for ParaView among them where `vtk`. The record says how far the run came; an error here is one before its first row, or
/// of a file that cannot be written.
pub fn into_directory(
    loaded: &Loaded,
    directory: &Path,
    vtk: bool,
    progress: Progress,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<(Record, Files), Error> {
    let schedule = Schedule::new(&loaded.scene.run);
    let mut record = Record::new(&loaded.scene, &loaded.file, loaded.warnings.clone(), schedule.snapshot_step());
    let started = Instant::now();
    let mut course = Course::new(loaded)?;
    record.statics_seconds = started.elapsed().as_secs_f64();

    let files = Files::of(directory)?;
    let mut tables = Tables::create(&files, &record, loaded, directory, progress)?;
    tables.vtk = vtk.then(|| vtk::Series::create(&directory.join(PICTURES), &loaded.scene)).transpose()?;
    let places = loaded.moordyn.as_ref().map_or_else(Vec::new, |deck| moordyn_out::places(deck, &loaded.scene));
    let (walls, states) = (tables.walls, tables.cable.is_some());
    let wanted = Wanted { schedule: &schedule, text: true, walls, states, places: &places, stop };
    let outcome = course.run(&wanted, &mut record, &mut tables);
    drop(tables);
    record.ended_by = outcome.err();
    tables::write(&files.summary, &tables::summary(&record))?;
    tables::write(&files.report, &page::html(&record))?;
    for (file, text) in [(&files.spectra, tables::spectra(&record)), (&files.rainflow, tables::cycles(&record))] {
        text.map_or(Ok(()), |text| tables::write(file, &text))?;
    }
    if let Some(text) = loaded.moordyn.as_ref().and_then(|deck| moordyn_out::text(&record, deck)) {
        let stem = Path::new(&loaded.file).file_stem().unwrap_or_default().to_string_lossy();
        tables::write(&directory.join(format!("{stem}.out")), &text)?;
    }
    Ok((record, files))
}

/// Makes a directory for results.
pub fn made(directory: &Path) -> Result<&Path, Error> {
    std::fs::create_dir_all(directory).map_err(|error| Error::File {
        path: directory.display().to_string(),
        reason: format!("the output directory cannot be made: {error}. Choose another with -o DIR."),
    })?;
    Ok(directory)
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

/// Where the results go.
pub struct Files {
    time_series: PathBuf,
    nodes: PathBuf,
    summary: PathBuf,
    report: PathBuf,
    /// Where there are statistics of a random sea.
    spectra: PathBuf,
    /// Where there are T–N curves.
    rainflow: PathBuf,
}

impl Files {
    /// Makes the directory. A summary and report of an earlier run go, lest they stand beside the rows of this one.
    fn of(directory: &Path) -> Result<Files, Error> {
        made(directory)?;
        let files = Files {
            time_series: directory.join("timeseries.csv"),
            nodes: directory.join("nodes.csv"),
            summary: directory.join("summary.json"),
            report: directory.join("report.html"),
            spectra: directory.join("spectra.csv"),
            rainflow: directory.join("rainflow.csv"),
        };
        for old in [&files.summary, &files.report, &files.spectra, &files.rainflow] {
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
    /// The files for ParaView, where they are wanted.
    vtk: Option<vtk::Series>,
    progress: Progress,
}

impl Tables {
    fn create(files: &Files, record: &Record, loaded: &Loaded, directory: &Path, progress: Progress) -> Result<Tables, Error> {
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
            vtk: None,
            progress,
        })
    }
}

impl Follower for Tables {
    fn row(&mut self, _: &Record, number: usize, row: &Row) -> Result<(), Error> {
        self.time_series.row(row.time, &row.cells)?;
        if let (Some((files, _)), Some(state)) = (&mut self.cable, &row.state) {
            files.row(state)?;
        }
        self.progress.show(number, row.time, &row.outputs);
        Ok(())
    }

    fn snapshot(&mut self, row: &Row) -> Result<(), Error> {
        self.vtk.as_mut().map_or(Ok(()), |vtk| vtk.snapshot(row))?;
        self.nodes.snapshot(&row.node_rows)
    }

    fn end(&mut self, record: &Record, row: &Row) -> Result<(), Error> {
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
    random_sea(&mut text, record);
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

/// What the tensions at the fairleads amount to in a random sea.
fn random_sea(text: &mut String, record: &Record) {
    let Some(statistics) = statistics::of(record) else { return };
    let unit = record.force_unit();
    let names: Vec<String> = record.lines.iter().map(|line| on_terminal(&line.name)).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max("fairlead".len());
    let of_three = "most probable of 3 h";
    let _ = writeln!(text, "  {:<width$}{:>14}{:>14}{:>12}{of_three:>24}  90 %", "fairlead", "mean", "std", "skewness");
    for ([of, _], name) in statistics.lines.iter().zip(&names) {
        let figures = &of.figures;
        let [mean, std] = [figures.mean, figures.std].map(|value| unit.show(value));
        let _ = write!(text, "  {name:<width$}{mean:>14}{std:>14}{:>12.2}", figures.skewness);
        let _ = match (figures.extreme.most_probable_maximum, figures.extreme.interval_90) {
            (Some(value), Some([low, high])) => {
                writeln!(text, "{:>24}  {} to {}", unit.show(value), unit.number(low), unit.show(high))
            }
            _ => writeln!(text, "{:>24}", figures.extreme.method),
        };
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
