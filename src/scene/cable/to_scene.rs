//! From a CABLE file to a scene and the state of its line.
//!
//! What the 1994 program implied is said: its law of extension and strain from pressure, water everywhere, a bed that carries the
//! line's weight D = DFEL above the bottom (stiffness w / D), no ramp on waves, a ramp of 3.25 periods on motions. Ends held fast
//! in all directions are the pinned fairlead and anchor of the scene; all else becomes a constraint.

use crate::scene::cable::reading::{Item, Reading, Spot, locks};
use crate::scene::cable::{Deck, ElementType, Job, MotionKind, NodeConstraint, forced_motion, mean, turned};
use crate::scene::state::{LineState, NodeState};
use crate::scene::types::{
    Constraint, CurrentPoint, Environment, InnerFluid, Line, LineType, Motion, NormalTangential, ReferenceMotion, Run, Scene,
    Seabed, Seas, Section, Solver, Stretch, Surface, Triple, Waves,
};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// What a CABLE file means.
#[derive(Debug, Clone, PartialEq)]
pub struct Meaning {
    /// The scene.
    pub scene: Scene,
    /// The nodes of the file.
    pub state: LineState,
    /// What a scene says otherwise.
    pub warnings: Vec<String>,
}

/// Ramp of a sinusoidal motion, in periods.
pub(super) const RAMP_PERIODS: f64 = 3.25;

/// The scene of a file and the state of its line.
pub fn meaning(deck: &Deck) -> Meaning {
    let mut warnings = Vec::new();
    let names = type_names(deck);
    let stiffness: Vec<Option<f64>> = deck.types.iter().map(|of| bed_stiffness(deck, of)).collect();
    let common = stiffness.first().copied().flatten().filter(|k| stiffness.iter().all(|other| *other == Some(*k)));
    let mut line_types = BTreeMap::new();
    for ((of, name), stiffness) in deck.types.iter().zip(&names).zip(&stiffness) {
        if let Some(property) = tapered(of) {
            warnings.push(format!("{property} of element type \"{name}\" varies along the element; its mean is taken"));
        }
        if stiffness.is_none() {
            warnings.push(format!(
                "element type \"{name}\" does not sink or has no DFEL, on which the report's bed is founded; the scene's default bed is taken"
            ));
        }
        line_types.insert(name.clone(), line_type(deck, of, stiffness.filter(|_| common.is_none())));
    }
    let (mut motion, constraints) = holds(deck, &mut warnings);
    if deck.motion == MotionKind::Forced && deck.job == Job::Dynamics {
        motion = Motion::File { path: forced_motion::NAME.to_string() };
    }
    let run = run(deck);
    let top = deck.nodes.first().map_or([0.0; 3], |node| turned(node.position));
    let offset = offset(&motion, run.start);
    let line = Line {
        name: String::from("line"),
        fairlead: std::array::from_fn(|k| top[k] - offset[k]),
        fairlead_on: None,
        anchor_on: None,
        anchor: deck.nodes.last().map_or([0.0; 3], |node| turned(node.position)),
        sections: sections(deck, &names),
        attachments: Vec::new(),
        constraints,
    };
    let state = state(deck, run.start);
    let environment = environment(deck, common);
    let solver = Solver { stretch: Some(Stretch::Report), hydrostatic_strain: true, ..Solver::default() };
    Meaning {
        scene: Scene {
            title: deck.title.clone(),
            environment,
            line_types,
            lines: vec![line],
            bodies: Vec::new(),
            points: Vec::new(),
            motion,
            run,
            solver,
        },
        state,
        warnings,
    }
}

/// Where in the file stands what a place of its scene is made of.
pub fn spot(reading: &Reading, place: &str) -> Option<Spot> {
    let deck = &reading.deck;
    let rest = |head: &str| place.strip_prefix(head);
    let index = |text: &str| text.split(']').next().and_then(|number| number.parse::<usize>().ok());
    let item = if rest("environment.depth").or(rest("environment.seabed")).is_some() {
        Item::Bottom
    } else if rest("environment.current").is_some() {
        Item::Current(0)
    } else if rest("environment.waves").is_some() {
        Item::Waves
    } else if rest("environment").is_some() {
        Item::Water
    } else if let Some(of) = rest("line_types.") {
        Item::Type(type_names(deck).iter().position(|name| of.starts_with(&format!("{name}.")))?)
    } else if rest("lines[0].fairlead").is_some() {
        Item::Node(0)
    } else if rest("lines[0].anchor").is_some() {
        Item::Node(deck.nodes.len() - 1)
    } else if let Some(number) = rest("lines[0].sections[").and_then(index) {
        Item::Element(runs(deck).iter().take(number).map(|run| run.2).sum())
    } else if rest("lines[0].constraints").or(rest("motion")).is_some() {
        Item::Constraint(0)
    } else if rest("run").is_some() {
        Item::Times
    } else {
        return None;
    };
    reading.spots.iter().find(|(of, _)| *of == item).map(|(_, spot)| *spot)
}

/// The state of the line that a file's nodes describe.
fn state(deck: &Deck, time: f64) -> LineState {
    let node = |(node, s): (&super::DeckNode, f64)| NodeState {
        s,
        position: turned(node.position),
        slope: turned(node.slope),
        velocity: turned(node.velocity),
        slope_rate: turned(node.slope_rate),
        lambda: node.lambda,
        lambda_before: node.lambda_before,
    };
    LineState { time, nodes: deck.nodes.iter().zip(deck.arc_lengths()).map(node).collect() }
}

/// A name for every element type: its own, or `type1`, `type2`, …
fn type_names(deck: &Deck) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, of) in deck.types.iter().enumerate() {
        let own = of.name.clone().filter(|name| !names.contains(name));
        names.push(own.unwrap_or_else(|| format!("type{}", index + 1)));
    }
    names
}

/// The first property that is not the same at both ends and in the middle.
fn tapered(of: &ElementType) -> Option<&'static str> {
    let properties = [
        ("MOI", of.inertia),
        ("AFEL", of.area),
        ("AIEL", of.cavity),
        ("DFEL", of.outermost),
        ("MEL", of.mass),
        ("DEL", of.diameter),
        ("BUOYEL", of.buoyancy),
    ];
    properties.into_iter().find(|(_, [first, middle, second])| first != middle || middle != second).map(|(name, _)| name)
}

/// The report's bed under a type [Pa]: net weight over the distance at which it begins to carry.
fn bed_stiffness(deck: &Deck, of: &ElementType) -> Option<f64> {
    let mass = mean(of.mass) + deck.inner_density * mean(of.cavity);
    let stiffness = (mass * deck.gravity - mean(of.buoyancy)) / mean(of.outermost);
    (stiffness > 0.0 && stiffness.is_finite()).then_some(stiffness)
}

fn line_type(deck: &Deck, of: &ElementType, seabed_stiffness: Option<f64>) -> LineType {
    let (area, cavity) = (mean(of.area), mean(of.cavity));
    LineType {
        ea: of.young * (area - cavity),
        mass: mean(of.mass),
        diameter: mean(of.diameter),
        submerged_weight: None,
        buoyancy: Some(mean(of.buoyancy)),
        ei: of.young * mean(of.inertia),
        drag: NormalTangential { normal: deck.drag, tangential: 0.0 },
        added_mass: NormalTangential { normal: deck.added_mass, tangential: 0.0 },
        damping: deck.damping,
        tension_strain: None,
        breaking_load: None,
        fatigue: None,
        inner_fluid: (cavity > 0.0).then_some(InnerFluid { density: deck.inner_density, area: cavity, pressure: 0.0 }),
        outer_area: Some(area),
        seabed_stiffness,
    }
}

fn environment(deck: &Deck, stiffness: Option<f64>) -> Environment {
    let mut current: Vec<CurrentPoint> =
        deck.currents.iter().map(|(y, velocity)| CurrentPoint { z: *y, velocity: turned(*velocity) }).collect();
    current.sort_by(|a, b| b.z.total_cmp(&a.z));
    let waves = (deck.wave_amplitude > 0.0).then(|| Waves::Regular {
        amplitude: deck.wave_amplitude,
        period: period(deck.wave_frequency, 8),
        // The file turns from x towards z, which lies at -y of the scene.
        direction_deg: 0.0 - deck.wave_direction.to_degrees(),
        phase_deg: 0.0,
        ramp: Some(0.0),
        stretching: None,
    });
    Environment {
        gravity: deck.gravity,
        water_density: deck.water_density,
        depth: -deck.bottom,
        seabed: Seabed { stiffness, ..Seabed::default() },
        current,
        current_over_time: None,
        waves: waves.map(Seas::One),
        surface: Surface::None,
    }
}

fn run(deck: &Deck) -> Run {
    let step = if deck.step > 0.0 { deck.step } else { Run::default().output_step };
    match deck.job {
        Job::Statics => Run { duration: 0.0, start: 0.0, output_step: step, transient: None },
        Job::Dynamics => Run { duration: deck.end - deck.begin, start: deck.begin, output_step: step, transient: None },
    }
}

/// Runs of elements of one type and length: type, length of an element, how many.
fn runs(deck: &Deck) -> Vec<(usize, f64, usize)> {
    let mut runs: Vec<(usize, f64, usize)> = Vec::new();
    for element in &deck.elements {
        match runs.last_mut() {
            Some((kind, length, count)) if *kind == element.kind && *length == element.length => *count += 1,
            _ => runs.push((element.kind, element.length, 1)),
        }
    }
    runs
}

fn sections(deck: &Deck, names: &[String]) -> Vec<Section> {
    let section = |(kind, length, count): (usize, f64, usize)| Section {
        line_type: names.get(kind).cloned().unwrap_or_default(),
        length: length * count as f64,
        elements: Some(count),
    };
    runs(deck).into_iter().map(section).collect()
}

/// The period of an angular frequency [s]: the shortest decimal number whose frequency is the same in the decimals that its columns can
/// hold.
fn period(frequency: f64, decimals: i32) -> f64 {
    let exact = TAU / frequency;
    let same = |period: &f64| (TAU / period - frequency).abs() < 0.51 * 10f64.powi(-decimals);
    let short = (1..15).filter_map(|digits| format!("{exact:.digits$e}").parse::<f64>().ok());
    short.into_iter().find(same).unwrap_or(exact)
}

/// Offset of the fairlead that the motion has at a time.
fn offset(motion: &Motion, time: f64) -> Triple {
    let Motion::Sinusoidal { period, sine, cosine, .. } = motion else { return [0.0; 3] };
    let xi = (time / (RAMP_PERIODS * period)).clamp(0.0, 1.0);
    let (sin, cos) = (TAU / period * time).sin_cos();
    std::array::from_fn(|k| xi * xi * (3.0 - 2.0 * xi) * (sine[k] * sin + cosine[k] * cos))
}

/// The motion of the fairlead and the constraints of all nodes that are not pinned ends.
fn holds(deck: &Deck, warnings: &mut Vec<String>) -> (Motion, Vec<Constraint>) {
    let (mut motion, mut constraints) = (Motion::Fixed, Vec::new());
    let s = deck.arc_lengths();
    let last = deck.nodes.len() - 1;
    for end in [0, last] {
        if !deck.constraints.iter().any(|of| of.node == end) {
            constraints.push(free(s[end], deck.dimensions == 2));
        }
    }
    let driven = deck.motion == MotionKind::Forced;
    if driven && deck.constraints.iter().any(|of| largest(&[of.sine, of.cosine]) > 0.0) {
        warnings.push(String::from(
            "DISAMP is not used with JMOTN = 2: the first node moves as its velocities say, no other node moves",
        ));
    }
    for of in &deck.constraints {
        let frame = Frame::new(of);
        let none = ([0.0; 3], [0.0; 3]);
        let (sine, cosine) = if driven { none } else { (frame.along(of.sine), frame.along(of.cosine)) };
        let moves = |k: usize| sine[k].abs().max(cosine[k].abs()) > 1e-9 * largest(&[of.sine, of.cosine]);
        let (top, end) = (of.node == 0, of.node == 0 || of.node == last);
        let lateral = |k: usize| k == 2 && deck.dimensions == 2;
        let locked = [0, 1, 2].map(|k| (end && lateral(k)) || locks(of.stiffness[k]) || moves(k) || (top && driven));
        let moving = largest(&[sine, cosine]) > 0.0;
        let pinned = end && locked == [true; 3] && (top || !moving);
        if pinned && top && moving {
            motion = Motion::Sinusoidal {
                period: period(of.frequency, 10),
                sine: turned(of.sine),
                cosine: turned(of.cosine),
                ramp: None,
            };
        }
        if pinned {
            if of.mass > 0.0 || of.force != [0.0; 3] {
                warnings.push(format!("mass and force at node {} change nothing: it is held fast", of.node + 1));
            }
            continue;
        }
        constraints.push(Constraint {
            s: s[of.node],
            axes: of.axes.map(turned),
            reference: Some(turned(frame.reference(of, locked, deck.nodes[of.node].position))),
            stiffness: std::array::from_fn(|k| if locked[k] { 0.0 } else { of.stiffness[k] }),
            damping: of.damping,
            locked,
            force: turned(of.force),
            mass: of.mass,
            added_mass: 0.0,
            motion: moving.then(|| ReferenceMotion { period: period(of.frequency, 10), sine, cosine, ramp: None }),
        });
    }
    constraints.sort_by(|a, b| a.s.total_cmp(&b.s));
    (motion, constraints)
}

/// An end that nothing holds; in 2-D nothing but its plane.
fn free(s: f64, planar: bool) -> Constraint {
    Constraint {
        s,
        axes: [turned([1.0, 0.0, 0.0]), turned([0.0, 1.0, 0.0])],
        reference: None,
        stiffness: [0.0; 3],
        damping: [0.0; 3],
        locked: [false, false, planar],
        force: [0.0; 3],
        mass: 0.0,
        added_mass: 0.0,
        motion: None,
    }
}

fn largest(vectors: &[Triple]) -> f64 {
    vectors.iter().flatten().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// The orthonormal axes of a constraint, in the axes of the file.
struct Frame([Triple; 3]);

impl Frame {
    fn new(of: &NodeConstraint) -> Frame {
        let unit = |a: Triple| a.map(|x| x / dot(a, a).sqrt());
        let first = unit(of.axes[0]);
        let shadow = dot(of.axes[1], first);
        let second = unit(std::array::from_fn(|k| of.axes[1][k] - shadow * first[k]));
        let third = std::array::from_fn(|k| {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            first[a] * second[b] - first[b] * second[a]
        });
        Frame([first, second, third])
    }

    fn along(&self, vector: Triple) -> Triple {
        self.0.map(|axis| dot(axis, vector))
    }

    /// Where the node is held along locked axes, and where springs pull it along the others.
    fn reference(&self, of: &NodeConstraint, locked: [bool; 3], position: Triple) -> Triple {
        let (held, pulled) = (self.along(position), self.along(of.reference));
        let along: Triple = std::array::from_fn(|k| if locked[k] { held[k] } else { pulled[k] });
        std::array::from_fn(|axis| (0..3).map(|k| along[k] * self.0[k][axis]).sum())
    }
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
