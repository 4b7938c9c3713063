//! `moorline statics`: the equilibrium of every line, from which `run` starts.

use crate::cli::arguments::StaticsArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::offsets;
use crate::cli::stop::Stop;
use crate::error::Error;
use crate::report::record::touchdown;
use crate::report::units::{ForceUnit, count};
use crate::scene::bodies::Matrix;
use crate::scene::read::Loaded;
use crate::scene::types::{Scene, Triple};
use crate::solve::mooring::Mooring;
use crate::solve::simulation::{NodeOutput, Outputs};
use nalgebra::Vector3;
use serde::Serialize;
use std::fmt::Write;

/// All lines together: converged where every line is, iterations of all, the largest residual.
#[derive(Serialize)]
pub struct Equilibrium {
    converged: bool,
    iterations: usize,
    /// Largest unbalanced nodal force [N].
    residual: f64,
    lines: Vec<LineEquilibrium>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    bodies: Vec<BodyEquilibrium>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    points: Vec<PointEquilibrium>,
}

/// A body: where it is, and the force [N] and moment [N·m] of the lines on it about its reference point.
#[derive(Serialize)]
struct BodyEquilibrium {
    name: String,
    position: Triple,
    attitude_deg: Triple,
    force: Triple,
    moment: Triple,
    /// Of the mooring against the body, along global axes and about its reference point: minus the change of force and moment with its
    /// displacement [N/m, N, N·m]; all else that is free follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    stiffness: Option<Matrix>,
}

#[derive(Serialize)]
struct PointEquilibrium {
    name: String,
    position: Triple,
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
    if let Some(asked) = &arguments.offsets {
        return Ok(offsets::offsets(&loaded, asked, &arguments.output)?);
    }
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

/// The equilibrium of all parts, and the first failure to converge. Fails itself where a line cannot even be meshed.
pub fn solve(loaded: &Loaded) -> Result<(Equilibrium, Option<Error>), Error> {
    let mut equilibrium =
        Equilibrium { converged: true, iterations: 0, residual: 0.0, lines: Vec::new(), bodies: Vec::new(), points: Vec::new() };
    let mut failure = None;
    let (scene, start) = (&loaded.scene, loaded.scene.run.start);
    let (mut lines, mut poses, mut points) = (Vec::new(), Vec::new(), Vec::new());
    let mut mooring = Mooring::new(loaded)?;
    for part in &mut mooring.parts {
        let (converged, others, iterations, residual) = match part.settle(start) {
            Ok(report) => (report.converged, report.others, report.iterations, report.residual),
            Err(error) => {
                let reached = match &error {
                    Error::Statics(state) => (false, false, state.iterations, state.residual),
                    Error::Network(_) => (false, false, 0, 0.0),
                    _ => return Err(error),
                };
                failure.get_or_insert(error);
                reached
            }
        };
        equilibrium.converged &= converged;
        equilibrium.iterations += iterations;
        equilibrium.residual = equilibrium.residual.max(residual);
        for (local, index) in part.lines().to_vec().into_iter().enumerate() {
            let (outputs, nodes) = (part.outputs(local), part.nodes(local));
            let found = line_equilibrium(&scene.lines[index].name, converged, &outputs, &nodes);
            lines.push((index, outputs, LineEquilibrium { others, ..found }));
        }
        poses.extend(part.bodies());
        points.extend(part.points());
    }
    lines.sort_by_key(|(index, ..)| *index);
    let outputs: Vec<Outputs> = lines.iter().map(|(_, outputs, _)| *outputs).collect();
    equilibrium.lines = lines.into_iter().map(|(.., line)| line).collect();
    points.sort_by_key(|(index, _)| *index);
    let point = |(index, place): (usize, Vector3<f64>)| PointEquilibrium {
        name: scene.points[index].name.clone(),
        position: place.into(),
    };
    equilibrium.points = points.into_iter().map(point).collect();
    let bodies = mooring.bodies(start, &poses, &outputs);
    for (index, body) in bodies.iter().enumerate() {
        let stiffness = if failure.is_none() { mooring.stiffness(index, start) } else { None };
        equilibrium.bodies.push(BodyEquilibrium {
            name: scene.bodies[index].name.clone(),
            position: body.pose.position.into(),
            attitude_deg: body.pose.angles.map(f64::to_degrees).into(),
            force: body.force.into(),
            moment: body.moment.into(),
            stiffness,
        });
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
    for body in &equilibrium.bodies {
        body_table(&mut text, body);
    }
    for PointEquilibrium { name, position: [x, y, z] } in &equilibrium.points {
        let _ = writeln!(text, "Point \"{}\" at x = {x:.3} m, y = {y:.3} m, z = {z:.3} m\n", on_terminal(name));
    }
    for (index, line) in equilibrium.lines.iter().enumerate() {
        line_table(&mut text, line, touchdown(scene, index, line.grounded_length));
    }
    text
}

/// Adds a body's pose and loads to the text.
fn body_table(text: &mut String, body: &BodyEquilibrium) {
    let ([x, y, z], [roll, pitch, yaw]) = (body.position, body.attitude_deg);
    let _ = writeln!(
        text,
        "Body \"{}\" at x = {x:.3} m, y = {y:.3} m, z = {z:.3} m, roll {roll:.3}, pitch {pitch:.3}, yaw {yaw:.3} deg",
        on_terminal(&body.name)
    );
    let unit = ForceUnit::for_largest(body.force.iter().fold(0.0, |most: f64, force| most.max(force.abs())));
    let [fx, fy, fz] = body.force.map(|force| unit.number(force));
    let [mx, my, mz] = body.moment.map(|moment| unit.number(moment));
    let _ = writeln!(text, "  force of the lines  {fx:>13}{fy:>13}{fz:>13}  [{}]", unit.symbol);
    let _ = writeln!(text, "  moment              {mx:>13}{my:>13}{mz:>13}  [{} m]", unit.symbol);
    if let Some(stiffness) = &body.stiffness {
        let _ = writeln!(text, "  stiffness of the mooring [N/m, N, N m]");
        for row in stiffness {
            let numbers: String = row.iter().map(|k| format!("{k:>13.4e}")).collect();
            let _ = writeln!(text, "  {numbers}");
        }
    }
    let _ = writeln!(text);
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
