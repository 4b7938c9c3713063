//! From a scene to a CABLE file, and what such a file cannot hold.

use crate::error::{DeckProblem, Error};
use crate::scene::cable::forced_motion::EASED;
use crate::scene::cable::to_scene::{RAMP_PERIODS, meaning};
use crate::scene::cable::{Deck, DeckElement, DeckNode, ElementType, Job, LOCK, MotionKind, NodeConstraint, turned_back};
use crate::scene::state::LineState;
use crate::scene::types::{Constraint, Line, LineType, Motion, Scene, Stretch, Surface, Triple, Waves};
use std::f64::consts::TAU;

/// A CABLE file made from a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// The file.
    pub deck: Deck,
    /// What the scene says and the file cannot hold, or says otherwise.
    pub losses: Vec<String>,
}

/// The CABLE file of a scene with one line, whose nodes are given. `file` is for messages.
pub fn deck(scene: &Scene, state: &LineState, file: &str) -> Result<Conversion, Error> {
    let line = match scene.lines.as_slice() {
        [line] => line,
        lines => {
            let reason = format!("it has one line, and the scene has {}; give each line a scene of its own", lines.len());
            return Err(cannot(file, "lines", reason));
        }
    };
    let losses = Losses::of(scene, line);
    let kinds: Vec<&String> = line.sections.iter().fold(Vec::new(), |mut kinds, section| {
        if !kinds.contains(&&section.line_type) {
            kinds.push(&section.line_type);
        }
        kinds
    });
    let types: Vec<(&String, &LineType)> =
        kinds.iter().filter_map(|name| scene.line_types.get(*name).map(|of| (*name, of))).collect();
    let planar = is_planar(scene, line, state);
    let (drag, added_mass, damping) =
        types.first().map_or((0.0, 0.0, 0.0), |(_, of)| (of.drag.normal, of.added_mass.normal, of.damping));
    let constraints = constraints(scene, line, state, file)?;
    let (wave_amplitude, wave_frequency, wave_direction) = match only_wave(scene) {
        Some(Waves::Regular { amplitude, period, direction_deg, .. }) => {
            (*amplitude, TAU / period, 0.0 - direction_deg.to_radians())
        }
        _ => (0.0, 0.0, 0.0),
    };
    let forced = matches!(scene.motion, Motion::File { .. });
    let deck = Deck {
        title: scene.title.lines().next().unwrap_or_default().to_string(),
        dimensions: if planar { 2 } else { 3 },
        job: if scene.run.duration > 0.0 { Job::Dynamics } else { Job::Statics },
        snapshot_every: 50,
        motion: if forced { MotionKind::Forced } else { MotionKind::Sinusoidal },
        relaxation: 0.2,
        damping,
        iterations: 200,
        begin: scene.run.start,
        end: scene.run.end(),
        step: scene.solver.uncontrolled_step().unwrap_or(scene.run.output_step),
        drag,
        added_mass,
        water_density: scene.environment.water_density,
        inner_density: types.iter().find_map(|(_, of)| of.inner_fluid.as_ref().map(|fluid| fluid.density)).unwrap_or(0.0),
        gravity: scene.environment.gravity,
        bottom: -scene.environment.depth,
        types: types.iter().map(|(name, of)| element_type(scene, name, of)).collect(),
        nodes: nodes(state),
        elements: elements(line, &kinds, state),
        constraints,
        currents: scene.environment.current.iter().map(|row| (row.z, turned_back(row.velocity))).collect(),
        wave_amplitude,
        wave_frequency,
        wave_direction,
    };
    Ok(Conversion { deck, losses: losses.0 })
}

/// The file with which a run can go on: the one that was run, if the scene still says the same, else that of the scene; with the nodes
/// of a state.
pub fn output(scene: &Scene, base: &Deck, state: &LineState, file: &str) -> Result<Deck, Error> {
    let own = meaning(base).scene;
    let same = own.environment == scene.environment
        && own.line_types == scene.line_types
        && own.lines == scene.lines
        && own.motion == scene.motion
        && state.nodes.len() == base.nodes.len();
    if !same {
        return Ok(Deck { snapshot_every: base.snapshot_every, ..deck(scene, state, file)?.deck });
    }
    let mut output = Deck { nodes: nodes(state), ..base.clone() };
    if own.run != scene.run {
        (output.begin, output.end, output.step) = (scene.run.start, scene.run.end(), scene.run.output_step);
        output.job = if scene.run.duration > 0.0 { Job::Dynamics } else { Job::Statics };
    }
    Ok(output)
}

/// The nodes of a state in the axes of a file.
pub fn nodes(state: &LineState) -> Vec<DeckNode> {
    let node = |node: &crate::scene::state::NodeState| DeckNode {
        position: turned_back(node.position),
        slope: turned_back(node.slope),
        velocity: turned_back(node.velocity),
        slope_rate: turned_back(node.slope_rate),
        lambda_before: node.lambda_before,
        lambda: node.lambda,
    };
    state.nodes.iter().map(node).collect()
}

fn cannot(file: &str, item: &str, reason: String) -> Error {
    let problem = DeckProblem::CannotHold { reason };
    Error::Deck { file: file.into(), line: 1, column: 1, item: item.into(), problem: problem.into() }
}

/// The only sea of a scene, where there is one.
fn only_wave(scene: &Scene) -> Option<&Waves> {
    scene.environment.waves.as_ref()?.alone()
}

/// Whether all that a scene says of its line lies in the plane y = 0.
fn is_planar(scene: &Scene, line: &Line, state: &LineState) -> bool {
    let flat = |v: &Triple| v[1] == 0.0;
    let motion = match &scene.motion {
        Motion::Fixed => true,
        Motion::Sinusoidal { sine, cosine, .. } => flat(sine) && flat(cosine),
        Motion::File { .. } => false,
    };
    let waves = match only_wave(scene) {
        Some(Waves::Regular { direction_deg, .. }) => *direction_deg == 0.0,
        _ => scene.environment.waves.is_none(),
    };
    let environment = &scene.environment;
    let nodes = state.nodes.iter().all(|node| {
        [node.position, node.velocity].iter().all(|v| v[1].abs() < 1e-9 * line.length())
            && [node.slope, node.slope_rate].iter().all(|v| v[1].abs() < 1e-9)
    });
    nodes
        && motion
        && waves
        && flat(&line.fairlead)
        && flat(&line.anchor)
        && environment.current.iter().all(|row| flat(&row.velocity))
        && environment.seabed.slope_deg[1] == 0.0
        && line.constraints.is_empty()
}

fn element_type(scene: &Scene, name: &str, of: &LineType) -> ElementType {
    let environment = &scene.environment;
    let (rho, g) = (environment.water_density, environment.gravity);
    let buoyancy = of.buoyancy_per_length(rho, g);
    let (inner, cavity) = of.inner_fluid.as_ref().map_or((0.0, 0.0), |fluid| (fluid.density * fluid.area, fluid.area));
    let displaced = if rho > 0.0 { buoyancy / (rho * g) } else { 0.0 };
    let solid = std::f64::consts::FRAC_PI_4 * of.diameter * of.diameter;
    // The columns keep six digits: Young's modulus makes up for what the areas lose.
    let six = |x: f64| format!("{x:.5e}").parse().unwrap_or(x);
    let cavity = six(cavity);
    let area: f64 =
        six([of.outer_area.unwrap_or(displaced), solid].into_iter().find(|area| *area > cavity).unwrap_or(1.1 * cavity));
    let young = of.ea / (area - cavity);
    let weight = (of.mass + inner) * g - buoyancy;
    let stiffness = of.seabed_stiffness.or(environment.seabed.stiffness);
    let outermost = stiffness.filter(|_| weight > 0.0).map_or(of.diameter, |stiffness| weight / stiffness);
    let name: String = name.chars().filter(|c| !c.is_control()).collect();
    ElementType {
        name: Some(name),
        young,
        inertia: [of.ei / young; 3],
        area: [area; 3],
        cavity: [cavity; 3],
        outermost: [outermost; 3],
        mass: [of.mass; 3],
        diameter: [of.diameter; 3],
        buoyancy: [buoyancy; 3],
    }
}

/// Elements between the nodes of a state; each is of the section in which its middle lies.
fn elements(line: &Line, kinds: &[&String], state: &LineState) -> Vec<DeckElement> {
    let kind_at = |s: f64| {
        let mut end = 0.0;
        let section = line.sections.iter().find(|section| {
            end += section.length;
            s < end
        });
        let name = section.or(line.sections.last()).map(|section| &section.line_type);
        kinds.iter().position(|kind| Some(*kind) == name).unwrap_or(0)
    };
    // Arc lengths are sums: their differences are rounded back to the lengths that were meant.
    let length = |from: f64, to: f64| (((to - from) * 1e9).round() / 1e9).max(1e-9);
    let element = |pair: &[crate::scene::state::NodeState]| DeckElement {
        length: length(pair[0].s, pair[1].s),
        kind: kind_at(0.5 * (pair[0].s + pair[1].s)),
    };
    state.nodes.windows(2).map(element).collect()
}

/// Pinned ends, and the constraints and masses of the scene at the nodes where they stand.
fn constraints(scene: &Scene, line: &Line, state: &LineState, file: &str) -> Result<Vec<NodeConstraint>, Error> {
    let last = state.nodes.len() - 1;
    let length = line.length();
    let is_at = |s: f64, of: f64| (s - of).abs() <= 1e-6 * length;
    let mut all: Vec<NodeConstraint> = Vec::new();
    for (node, s) in [(0, 0.0), (last, length)] {
        if line.constraints.iter().any(|constraint| is_at(constraint.s, s)) {
            continue;
        }
        let mut pinned = loose(node, turned_back(state.nodes[node].position));
        pinned.stiffness = [10.0 * LOCK; 3];
        if let (0, Motion::Sinusoidal { period, sine, cosine, .. }) = (node, &scene.motion) {
            (pinned.frequency, pinned.sine, pinned.cosine) = (TAU / period, turned_back(*sine), turned_back(*cosine));
        }
        all.push(pinned);
    }
    for (number, constraint) in line.constraints.iter().enumerate() {
        let place = format!("lines[0].constraints[{number}].s");
        let node = node_at(state, constraint.s, length).ok_or_else(|| no_node(file, &place, constraint.s))?;
        let position = state.nodes[node].position;
        all.push(of_constraint(constraint, node, constraint.reference.unwrap_or(position)));
    }
    let (rho, g) = (scene.environment.water_density, scene.environment.gravity);
    for (number, body) in line.attachments.iter().enumerate() {
        let place = format!("lines[0].attachments[{number}].s");
        let node = node_at(state, body.s, length).ok_or_else(|| no_node(file, &place, body.s))?;
        if !all.iter().any(|of| of.node == node) {
            all.push(loose(node, turned_back(state.nodes[node].position)));
        }
        if let Some(of) = all.iter_mut().find(|of| of.node == node) {
            of.mass += body.mass;
            of.force[1] += rho * g * body.volume;
        }
    }
    all.sort_by_key(|of| of.node);
    Ok(all)
}

fn node_at(state: &LineState, s: f64, length: f64) -> Option<usize> {
    state.nodes.iter().position(|node| (node.s - s).abs() <= 1e-6 * length)
}

fn no_node(file: &str, place: &str, s: f64) -> Error {
    cannot(
        file,
        place,
        format!("constraints act at nodes, and there is none at s = {s} m; choose sections and elements that have one"),
    )
}

fn loose(node: usize, reference: Triple) -> NodeConstraint {
    NodeConstraint {
        node,
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        reference,
        stiffness: [0.0; 3],
        damping: [0.0; 3],
        force: [0.0; 3],
        mass: 0.0,
        frequency: 0.0,
        sine: [0.0; 3],
        cosine: [0.0; 3],
    }
}

fn of_constraint(of: &Constraint, node: usize, reference: Triple) -> NodeConstraint {
    let unit = |a: Triple| {
        let size = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
        a.map(|x| x / size)
    };
    let dot = |a: &Triple, b: &Triple| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let first = unit(of.axes[0]);
    let shadow = dot(&of.axes[1], &first);
    let second = unit(std::array::from_fn(|k| of.axes[1][k] - shadow * first[k]));
    let third: Triple = std::array::from_fn(|k| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        first[a] * second[b] - first[b] * second[a]
    });
    // The file gives amplitudes along its global axes.
    let global =
        |along: &Triple| turned_back(std::array::from_fn(|k| along[0] * first[k] + along[1] * second[k] + along[2] * third[k]));
    let (frequency, sine, cosine) = match &of.motion {
        Some(motion) => (TAU / motion.period, global(&motion.sine), global(&motion.cosine)),
        None => (0.0, [0.0; 3], [0.0; 3]),
    };
    NodeConstraint {
        node,
        axes: [turned_back(first), turned_back(second)],
        reference: turned_back(reference),
        stiffness: std::array::from_fn(|k| if of.locked[k] { 10.0 * LOCK } else { of.stiffness[k] }),
        damping: of.damping,
        force: turned_back(of.force),
        mass: of.mass,
        frequency,
        sine,
        cosine,
    }
}

/// What a file cannot hold, as sentences that begin with the place of the scene.
struct Losses(Vec<String>);

impl Losses {
    fn of(scene: &Scene, line: &Line) -> Losses {
        let mut losses = Losses(Vec::new());
        losses.environment(scene);
        losses.line_types(scene, line);
        losses.line(line);
        losses.motion(scene);
        losses.solver(scene);
        losses
    }

    fn add(&mut self, lost: bool, text: impl FnOnce() -> String) {
        if lost {
            self.0.push(text());
        }
    }

    fn environment(&mut self, scene: &Scene) {
        let environment = &scene.environment;
        let seabed = &environment.seabed;
        self.add(seabed.damping != 0.0, || format!("environment.seabed.damping: {} Pa·s becomes 0", seabed.damping));
        self.add(seabed.friction != 0.0, || format!("environment.seabed.friction: {} becomes 0", seabed.friction));
        self.add(seabed.slope_deg != [0.0; 2], || format!("environment.seabed.slope_deg: {:?} becomes level", seabed.slope_deg));
        self.add(environment.surface == Surface::Pierced, || {
            String::from("environment.surface: a line above the water keeps its buoyancy and drag there (\"none\")")
        });
        self.add(environment.current_over_time.is_some(), || {
            String::from("environment.current_over_time: a file holds a current that does not change; there is none in it")
        });
        match only_wave(scene) {
            Some(Waves::Regular { phase_deg, ramp, .. }) => {
                self.add(*phase_deg != 0.0, || format!("environment.waves.phase_deg: {phase_deg} becomes 0"));
                self.add(*ramp != Some(0.0), || String::from("environment.waves.ramp: the wave is there from the start"));
            }
            _ => self.add(environment.waves.is_some(), || {
                String::from("environment.waves: only one regular wave can be held; there are none in the file")
            }),
        }
    }

    fn line_types(&mut self, scene: &Scene, line: &Line) {
        let used: Vec<(&String, &LineType)> =
            scene.line_types.iter().filter(|(name, _)| line.sections.iter().any(|section| section.line_type == **name)).collect();
        let first = line.sections.first().and_then(|section| scene.line_types.get(&section.line_type));
        for (name, of) in &used {
            let at = |key: &str| format!("line_types.{name}.{key}");
            self.add(of.drag.tangential != 0.0, || format!("{}: {} becomes 0", at("drag.tangential"), of.drag.tangential));
            self.add(of.added_mass.tangential != 0.0, || {
                format!("{}: {} becomes 0", at("added_mass.tangential"), of.added_mass.tangential)
            });
            self.add(of.tension_strain.is_some(), || format!("{}: the table is replaced by `ea`", at("tension_strain")));
            let pressed = of.inner_fluid.as_ref().is_some_and(|fluid| fluid.pressure != 0.0);
            self.add(pressed, || {
                format!("{}: the fluid inside has the pressure of the water outside", at("inner_fluid.pressure"))
            });
            self.add(of.breaking_load.is_some(), || format!("{}: it is left out", at("breaking_load")));
            self.add(of.fatigue.is_some(), || format!("{}: it is left out", at("fatigue")));
            for (key, own, other) in [
                ("drag.normal", of.drag.normal, first.map(|first| first.drag.normal)),
                ("added_mass.normal", of.added_mass.normal, first.map(|first| first.added_mass.normal)),
                ("damping", of.damping, first.map(|first| first.damping)),
            ] {
                let other = other.unwrap_or(own);
                self.add(own != other, || {
                    format!("{}: {own} becomes {other}, as of the first section; there is one for all", at(key))
                });
            }
            self.add(of.outer_area.is_none() && scene.solver.hydrostatic_strain, || {
                format!("{}: the displaced volume per length is written in its place", at("outer_area"))
            });
        }
        let densities = || used.iter().filter_map(|(_, of)| of.inner_fluid.as_ref().map(|fluid| fluid.density));
        self.add(densities().any(|density| Some(density) != densities().next()), || {
            String::from("line_types.*.inner_fluid.density: there is one for all, that of the first")
        });
        let unused = scene.line_types.len() - used.len();
        self.add(unused > 0, || format!("line_types: {unused} that no section uses are left out"));
    }

    fn line(&mut self, line: &Line) {
        self.add(line.sections.iter().any(|section| section.elements.is_none()), || {
            String::from("lines[0].sections: the mesh that the program chose is written down, element by element")
        });
        for (number, body) in line.attachments.iter().enumerate() {
            self.0.push(format!(
                "lines[0].attachments[{number}]: becomes a mass with its weight and a dead force for its buoyancy; drag {} m² and added \
                 mass {} kg are lost, and so is its rest on the bed",
                body.drag_area, body.added_mass
            ));
        }
        for (number, constraint) in line.constraints.iter().enumerate() {
            let at = |key: &str| format!("lines[0].constraints[{number}].{key}");
            self.add(constraint.added_mass != 0.0, || format!("{}: {} kg becomes 0", at("added_mass"), constraint.added_mass));
            if let Some(motion) = &constraint.motion {
                self.ramp(&at("motion"), motion.period, motion.ramp);
            }
        }
    }

    fn ramp(&mut self, place: &str, period: f64, ramp: Option<f64>) {
        let fixed = RAMP_PERIODS * period;
        self.add(ramp.is_some_and(|ramp| (ramp - fixed).abs() > 1e-9 * fixed), || {
            format!("{place}.ramp: {} s becomes {fixed} s, 3.25 periods", ramp.unwrap_or_default())
        });
    }

    fn motion(&mut self, scene: &Scene) {
        match &scene.motion {
            Motion::Sinusoidal { period, ramp, .. } => self.ramp("motion", *period, *ramp),
            Motion::File { path } => self.0.push(format!(
                "motion.path: {path} becomes the velocities of `forcedmotion`, one for every step; the 1994 program and moorline ease \
                 in those before t = {EASED:.1} s"
            )),
            Motion::Fixed => {}
        }
    }

    fn solver(&mut self, scene: &Scene) {
        let solver = &scene.solver;
        self.add(solver.law() == Stretch::Exact, || String::from("solver.stretch: becomes the report's law, r'·r' = 1 + 2 T/EA"));
        self.add(!solver.hydrostatic_strain, || {
            String::from("solver.hydrostatic_strain: becomes true; the pressure of the water shortens the line a little")
        });
        self.add(true, || String::from("solver: scheme, tolerance and steps are not held; TSTEP is the output step"));
    }
}
