//! `moorline statics`: the equilibrium of every line, from which `run` starts.

use crate::cli::arguments::StaticsArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::stop::Stop;
use crate::error::Error;
use crate::report::record::touchdown;
use crate::report::units::{ForceUnit, count};
use crate::scene::read::Loaded;
use crate::scene::types::{Scene, Triple};
use crate::solve::motion::Path;
use crate::solve::simulation::{NodeOutput, Outputs, Simulation};
use serde::Serialize;
use std::fmt::Write;

/// All lines together: converged where every line is, iterations of all, the largest residual.
#[derive(Serialize)]
struct Equilibrium {
    converged: bool,
    iterations: usize,
    /// Largest unbalanced nodal force [N].
    residual: f64,
    lines: Vec<LineEquilibrium>,
}

#[derive(Serialize)]
struct LineEquilibrium {
    name: String,
    converged: bool,
    /// Other equilibria are as good, by symmetry.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    others: bool,
    tension: f64,
    force: Triple,
    anchor_tension: f64,
    anchor_force: Triple,
    grounded_length: f64,
    nodes: Vec<Node>,
}

#[derive(Serialize)]
struct Node {
    s: f64,
    position: Triple,
    tangent: Triple,
    tension: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    wall_tension: Option<f64>,
}

/// Solves all lines and prints them, the best state found where one does not converge; then that is the error.
pub fn statics(arguments: &StaticsArguments) -> Result<(), Stop> {
    let loaded = arguments.scene.load()?;
    loaded.warnings.iter().for_each(|warning| console::warning(warning));
    let (equilibrium, failure) = solve(&loaded)?;
    let text = if arguments.json {
        // Numbers and strings only: there is nothing in them that JSON cannot hold.
        serde_json::to_string_pretty(&equilibrium).unwrap_or_default() + "\n"
    } else {
        tables(&loaded.scene, &equilibrium)
    };
    console::print(&text)?;
    failure.map_or(Ok(()), |error| Err(Stop::Failed(error)))
}

/// The equilibrium of all lines, and the first failure to converge. Fails itself where a line cannot even be meshed.
fn solve(loaded: &Loaded) -> Result<(Equilibrium, Option<Error>), Error> {
    let mut equilibrium = Equilibrium { converged: true, iterations: 0, residual: 0.0, lines: Vec::new() };
    let mut failure = None;
    for (index, line) in loaded.scene.lines.iter().enumerate() {
        let mut simulation = Simulation::new(&loaded.scene, index)?;
        let start = loaded.scene.run.start;
        let fairlead = Path::of_scene(loaded, index).at(start).position;
        let (converged, others, iterations, residual) = match simulation.settle(fairlead, start) {
            Ok(report) => (report.converged, report.others, report.iterations, report.residual),
            Err(error) => {
                let Error::Statics(state) = &error else { return Err(error) };
                let reached = (false, false, state.iterations, state.residual);
                failure.get_or_insert(error);
                reached
            }
        };
        equilibrium.converged &= converged;
        equilibrium.iterations += iterations;
        equilibrium.residual = equilibrium.residual.max(residual);
        let found = line_equilibrium(&line.name, converged, &simulation.outputs(), &simulation.nodes());
        equilibrium.lines.push(LineEquilibrium { others, ..found });
    }
    Ok((equilibrium, failure))
}

fn line_equilibrium(name: &str, converged: bool, outputs: &Outputs, nodes: &[NodeOutput]) -> LineEquilibrium {
    let node = |node: &NodeOutput| Node {
        s: node.s,
        position: node.position.into(),
        tangent: node.tangent.into(),
        tension: node.tension,
        wall_tension: node.wall_tension,
    };
    LineEquilibrium {
        name: name.to_string(),
        converged,
        others: false,
        tension: outputs.tension,
        force: outputs.force.into(),
        anchor_tension: outputs.anchor_tension,
        anchor_force: outputs.anchor_force.into(),
        grounded_length: outputs.grounded_length,
        nodes: nodes.iter().map(node).collect(),
    }
}

fn tables(scene: &Scene, equilibrium: &Equilibrium) -> String {
    let mut text = String::new();
    if !scene.title.is_empty() {
        let _ = writeln!(text, "{}", on_terminal(&scene.title));
    }
    let state = if equilibrium.converged { "Static equilibrium" } else { "NO EQUILIBRIUM; the best state found" };
    let _ = writeln!(
        text,
        "{state}: {}, largest unbalanced force {:.2e} N\n",
        count(equilibrium.iterations, "iteration"),
        equilibrium.residual
    );
    for (index, line) in equilibrium.lines.iter().enumerate() {
        line_table(&mut text, line, touchdown(scene, index, line.grounded_length));
    }
    text
}

/// Adds a line's end forces and nodes to the text.
fn line_table(text: &mut String, line: &LineEquilibrium, touchdown: Option<f64>) {
    let unit =
        ForceUnit::for_largest(line.nodes.iter().fold(line.tension.max(line.anchor_tension), |max, node| max.max(node.tension)));
    let remark = if line.converged { "" } else { "  (not converged)" };
    let _ = writeln!(text, "Line \"{}\"{remark}", on_terminal(&line.name));
    let _ = writeln!(text, "  {:<10}{:>13}{:>13}{:>13}{:>13}  [{}]", "", "tension", "force x", "force y", "force z", unit.symbol);
    for (end, tension, force) in [("fairlead", line.tension, line.force), ("anchor", line.anchor_tension, line.anchor_force)] {
        let [x, y, z] = force.map(|component| unit.number(component));
        let _ = writeln!(text, "  {end:<10}{:>13}{x:>13}{y:>13}{z:>13}", unit.number(tension));
    }
    let _ = match touchdown {
        Some(s) => writeln!(text, "  touchdown at s = {s:.3} m; {:.3} m on the bed", line.grounded_length),
        None => writeln!(text, "  {:.3} m on the bed", line.grounded_length),
    };
    if line.others {
        let _ = writeln!(text, "  other equilibria are as good: the line may lie to another side");
    }
    let force_heading = format!("tension [{}]", unit.symbol);
    let wall_heading = if line.nodes.iter().any(|node| node.wall_tension.is_some()) { "of the wall" } else { "" };
    let _ = writeln!(
        text,
        "\n  {:>5}{:>13}{:>13}{:>13}{:>13}{force_heading:>17}{wall_heading:>17}",
        "node", "s [m]", "x [m]", "y [m]", "z [m]"
    );
    for (index, node) in line.nodes.iter().enumerate() {
        let [x, y, z] = node.position;
        let tension = unit.number(node.tension);
        let wall = node.wall_tension.map_or(String::new(), |tension| format!("{:>17}", unit.number(tension)));
        let _ = writeln!(text, "  {index:>5}{:>13.3}{x:>13.3}{y:>13.3}{z:>13.3}{tension:>17}{wall}", node.s);
    }
    let _ = writeln!(text);
}
