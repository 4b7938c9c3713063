//! `moorline convert`: JSON scene to CABLE or MoorDyn file and back, with a word on what the other format cannot hold.

use crate::cli::arguments::ConvertArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::stop::Stop;
use crate::error::Error;
use crate::report::tables;
use crate::scene::bodies::BodyMotion;
use crate::scene::cable::{Deck, Job, MotionKind, forced_motion, from_scene, turned_back, writing};
use crate::scene::moordyn;
use crate::scene::motion_file::Table;
use crate::scene::pose_file::PoseTable;
use crate::scene::read::{self, Loaded};
use crate::scene::types::{Motion, Scene};
use crate::solve::motion::Path as Fairlead;
use crate::solve::simulation::Simulation;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Converts in the direction that the input asks for.
pub fn convert(arguments: &ConvertArguments) -> Result<(), Stop> {
    let loaded = read::load(&arguments.input, &[])?;
    loaded.warnings.iter().for_each(|warning| console::warning(warning));
    let text = arguments.output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("txt"));
    let losses = match (loaded.deck.clone(), &loaded.moordyn) {
        (Some(deck), _) => to_scene(loaded, &deck, &arguments.output)?,
        (None, _) if text => to_moordyn(&loaded, &arguments.output)?,
        (None, Some(_)) => of_moordyn(&loaded, &arguments.output)?,
        (None, None) => to_deck(&loaded, &arguments.output)?,
    };
    let mut text = format!("{}\n", on_terminal(&arguments.output.display().to_string()));
    for loss in losses {
        let _ = writeln!(text, "  {}", on_terminal(&loss));
    }
    Ok(console::print(&text)?)
}

/// Writes the scene of a CABLE file; what a scene cannot hold.
fn to_scene(loaded: Loaded, deck: &Deck, output: &Path) -> Result<Vec<String>, Error> {
    let mut losses = Vec::new();
    let mut scene = loaded.scene;
    if let Some(table) = &loaded.motion {
        let path = output.with_extension("motion.csv");
        tables::write(&path, &motion_table(table))?;
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        losses.push(format!("{}: is written as positions into {name}", forced_motion::NAME));
        scene.motion = Motion::File { path: name };
    }
    losses.push(match deck.job {
        Job::Statics => "R, RPRM, LAMBDA of the inner nodes: a scene finds its equilibrium itself".to_string(),
        Job::Dynamics => {
            "R, RPRM, RDOT, RPMDT, LAMBDA: the state at the nodes; a scene begins at rest, in equilibrium".to_string()
        }
    });
    losses.push("RELAX, ITER, JSNAP: of no use in a scene".to_string());
    if deck.job == Job::Statics {
        losses.push("TBGN, TEND: a scene of statics has run.duration 0".to_string());
    }
    write_scene(&scene, output)?;
    Ok(losses)
}

fn write_scene(scene: &Scene, output: &Path) -> Result<(), Error> {
    // Plain data of numbers and strings: there is nothing in it that JSON cannot hold.
    tables::write(output, &(serde_json::to_string_pretty(scene).unwrap_or_default() + "\n"))
}

/// Writes the scene of a MoorDyn file; what a scene has no need of.
fn of_moordyn(loaded: &Loaded, output: &Path) -> Result<Vec<String>, Error> {
    let mut losses = vec![
        String::from("NumSegs: the program chooses elements itself; `elements` of a section gives their number"),
        String::from("kinds of lines, points and rods that no line needs are left out"),
    ];
    let mut scene = loaded.scene.clone();
    for (body, table) in scene.bodies.iter_mut().zip(&loaded.body_motions) {
        let Some(table) = table else { continue };
        let path = output.with_extension(format!("{}.csv", body.name));
        tables::write(&path, &pose_table(table))?;
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        losses.push(format!("the motion of {} is in {name}", body.name));
        body.motion = BodyMotion::File { path: name };
    }
    write_scene(&scene, output)?;
    Ok(losses)
}

/// The text of a file of poses.
fn pose_table(table: &PoseTable) -> String {
    let mut text = String::from("t,x,y,z,roll,pitch,yaw\n");
    for (row, time) in table.times.iter().enumerate() {
        let way = |way: usize| if way < 3 { table.values[way][row] } else { table.values[way][row].to_degrees() };
        let cells: Vec<String> = std::iter::once(*time).chain((0..6).map(way)).map(|x| format!("{:?}", x + 0.0)).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// Writes the MoorDyn file of a scene and the files beside it; what such a file cannot hold.
fn to_moordyn(loaded: &Loaded, output: &Path) -> Result<Vec<String>, Error> {
    let conversion = moordyn::from_scene::deck(&loaded.scene, &loaded.file)?;
    let stem = output.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().replace(char::is_whitespace, "_"));
    let texts = moordyn::writing::texts(&conversion, &stem);
    tables::write(output, &texts.deck)?;
    let mut losses = conversion.losses;
    for (name, text) in &texts.beside {
        let path = output.parent().map_or_else(PathBuf::new, Path::to_path_buf).join(name);
        tables::write(&path, text)?;
        losses.push(format!("{} is beside it", path.display()));
    }
    Ok(losses)
}

/// The text of a motion file.
fn motion_table(table: &Table) -> String {
    let mut text = String::from("t,x,y,z,vx,vy,vz\n");
    for ((time, position), velocity) in table.times.iter().zip(&table.positions).zip(&table.velocities) {
        let cells: Vec<String> =
            std::iter::once(time).chain(position).chain(velocity).map(|x| format!("{:?}", x + 0.0)).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// Writes the CABLE file of a scene, with its nodes in equilibrium; what such a file cannot hold.
fn to_deck(loaded: &Loaded, output: &Path) -> Result<Vec<String>, Error> {
    let scene = &loaded.scene;
    let mut state = crate::scene::state::LineState { time: scene.run.start, nodes: Vec::new() };
    if scene.lines.len() == 1 {
        let mut simulation = Simulation::new(scene, 0)?;
        simulation.settle(Fairlead::of_scene(loaded, 0).at(scene.run.start).position, scene.run.start)?;
        state = simulation.line_state();
    }
    let conversion = from_scene::deck(scene, &state, &loaded.file)?;
    tables::write(output, &writing::text(&conversion.deck))?;
    let mut losses = conversion.losses;
    if conversion.deck.motion == MotionKind::Forced {
        let path = output.parent().map_or_else(PathBuf::new, Path::to_path_buf).join(forced_motion::NAME);
        tables::write(&path, &velocities(loaded, &conversion.deck))?;
        losses.push(format!("the velocities are in {}", path.display()));
    }
    Ok(losses)
}

/// The velocities of the fairlead at the steps of a file, one number a line.
fn velocities(loaded: &Loaded, deck: &Deck) -> String {
    let path = Fairlead::of_scene(loaded, 0);
    let mut text = String::new();
    for level in 0..deck.levels() {
        let velocity = turned_back(path.at(deck.begin + level as f64 * deck.step).velocity.into());
        velocity.iter().take(deck.dimensions).for_each(|v| text += &format!("{}\n", writing::exponential(*v)));
    }
    text
}
