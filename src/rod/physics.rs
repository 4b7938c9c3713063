//! From the scene to the types of the element loop: the only place that names combinations.
//!
//! A ladder of small functions: each decides one thing from the scene and hands a type on. What a scene does not need is not
//! compiled into its loop.

use crate::algebra::dimension::{Dimension, Planar, Spatial};
use crate::algebra::sinusoid::Sinusoid;
use crate::rod::awash::Surface;
use crate::rod::bending::{Bending, Flexible, Stiff};
use crate::rod::body::Body;
use crate::rod::clamp::{Clamp, Holder};
use crate::rod::elasticity::{Hooke, Tabulated};
use crate::rod::friction::Friction;
use crate::rod::hold::{self, Hold};
use crate::rod::joint;
use crate::rod::line::{Line, Rod, Supports};
use crate::rod::mesh::Mesh;
use crate::rod::morison::{NoWater, Sea, Still, Water};
use crate::rod::pose::PosePath;
use crate::rod::seabed::{Plane, Resistance};
use crate::rod::stretch::{Exact, Report, Stretch};
use crate::rod::touching::Ground;
use crate::scene::bodies::Stiffness;
use crate::scene::types::{self, Environment, Scene};
use crate::sea::current::Current;
use crate::sea::waves::Waves;
use nalgebra::Vector3;
use std::sync::Arc;

/// Surroundings of a line, decided once.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// Law of extension.
    pub stretch: types::Stretch,
    /// The current; still water is none.
    pub current: Option<Current>,
    /// The waves.
    pub waves: Option<Waves>,
    /// The bed.
    pub ground: Option<Ground>,
    /// The water surface, where it is pierced.
    pub surface: Option<Surface>,
    /// The line stays in a plane of constant y, and so do all forces on it. In waves this is not made use of.
    pub planar: bool,
}

/// One decision and its reason, for `check`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decision {
    /// The physics.
    pub physics: &'static str,
    /// Whether it is in the step.
    pub on: bool,
    /// Why.
    pub reason: String,
}

impl Surroundings {
    /// The surroundings of a mesh in a scene.
    pub fn of(scene: &Scene, mesh: &Mesh) -> Surroundings {
        let current = Current::new(&scene.environment.current);
        Surroundings {
            stretch: scene.solver.law(),
            current: (!current.is_still()).then_some(current),
            waves: Waves::of(&scene.environment).map(|waves| waves.good_to(scene.solver.tolerance)),
            ground: Some(ground(&scene.environment, mesh)),
            surface: (scene.environment.surface == types::Surface::Pierced).then(|| Surface::new(mesh)),
            planar: false,
        }
    }
}

impl Surroundings {
    /// The same without friction.
    pub fn without_friction(&self) -> Surroundings {
        Surroundings { ground: self.ground.clone().map(|ground| Ground { friction: None, ..ground }), ..self.clone() }
    }

    /// The same in space, without friction and flow: what has an energy.
    pub fn bare(&self) -> Surroundings {
        Surroundings { current: None, waves: None, planar: false, ..self.without_friction() }
    }

    /// Displacement at which friction breaks away [m], where there is any.
    pub fn breakaway(&self) -> Option<f64> {
        Some(self.ground.as_ref()?.friction.as_ref()?.breakaway())
    }

    /// The same with the friction of statics on a mesh.
    pub fn laid(&self, mesh: &Mesh) -> Surroundings {
        let laid = |ground: Ground| Ground { friction: ground.friction.map(|friction| friction.laid(mesh)), ..ground };
        Surroundings { ground: self.ground.clone().map(laid), ..self.clone() }
    }
}

/// The line of a mesh with the physics that it needs.
pub fn build(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    let special = mesh.is_special();
    if surroundings.planar && surroundings.waves.is_none() {
        return in_plane(mesh, surroundings, supports);
    }
    // Lines with tables or pressures are few: they carry the terms of bending whether they need them or not.
    match (surroundings.stretch, special) {
        (types::Stretch::Exact, false) => with_bending::<Exact<Hooke>>(mesh, surroundings, supports),
        (types::Stretch::Report, false) => with_bending::<Report<Hooke>>(mesh, surroundings, supports),
        (types::Stretch::Exact, true) => with_water::<Exact<Tabulated>, Stiff>(mesh, surroundings, supports),
        (types::Stretch::Report, true) => with_water::<Report<Tabulated>, Stiff>(mesh, surroundings, supports),
    }
}

fn in_plane(mesh: Mesh, around: Surroundings, supports: Supports) -> Box<dyn Line> {
    let flow = around.current.clone().unwrap_or_default();
    let stiff = mesh.bends();
    // What is rarer than Hooke's law by engineering strain carries terms of bending and of a current whether it needs them or not.
    match (around.stretch, mesh.is_special(), around.current.is_some(), stiff) {
        (types::Stretch::Exact, false, false, false) => {
            finish::<Exact<Hooke>, Still, Flexible, Planar>(mesh, Still, around, supports)
        }
        (types::Stretch::Exact, false, false, true) => {
            finish::<Exact<Hooke>, Still, Stiff, Planar>(mesh, Still, around, supports)
        }
        (types::Stretch::Exact, false, true, false) => {
            finish::<Exact<Hooke>, Current, Flexible, Planar>(mesh, flow, around, supports)
        }
        (types::Stretch::Exact, false, true, true) => {
            finish::<Exact<Hooke>, Current, Stiff, Planar>(mesh, flow, around, supports)
        }
        (types::Stretch::Report, false, ..) => finish::<Report<Hooke>, Current, Stiff, Planar>(mesh, flow, around, supports),
        (types::Stretch::Exact, true, ..) => finish::<Exact<Tabulated>, Current, Stiff, Planar>(mesh, flow, around, supports),
        (types::Stretch::Report, true, ..) => finish::<Report<Tabulated>, Current, Stiff, Planar>(mesh, flow, around, supports),
    }
}

fn with_bending<S: Stretch>(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    if mesh.bends() {
        with_water::<S, Stiff>(mesh, surroundings, supports)
    } else {
        with_water::<S, Flexible>(mesh, surroundings, supports)
    }
}

fn with_water<S: Stretch, B: Bending>(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    if let Some(waves) = surroundings.waves.clone() {
        let current = surroundings.current.clone().unwrap_or_default();
        finish::<S, Sea, B, Spatial>(mesh, Sea { waves, current }, surroundings, supports)
    } else if !feels_water(&mesh, &supports) {
        finish::<S, NoWater, B, Spatial>(mesh, NoWater, surroundings, supports)
    } else if let Some(current) = surroundings.current.clone() {
        finish::<S, Current, B, Spatial>(mesh, current, surroundings, supports)
    } else {
        finish::<S, Still, B, Spatial>(mesh, Still, surroundings, supports)
    }
}

fn finish<S: Stretch, W: Water, B: Bending, D: Dimension>(
    mesh: Mesh,
    water: W,
    around: Surroundings,
    supports: Supports,
) -> Box<dyn Line> {
    Box::new(Rod::<S, W, B, D>::new(mesh, water, around.ground, around.surface, supports))
}

/// Whether any section or body has drag or added mass.
fn feels_water(mesh: &Mesh, supports: &Supports) -> bool {
    mesh.sections.iter().any(|p| [p.drag_normal, p.drag_tangential, p.added_normal, p.added_tangential].iter().any(|c| *c > 0.0))
        || supports.bodies.iter().any(|body| body.drag > 0.0 || body.added_mass > 0.0)
}

/// What holds and loads a line of a scene: pins at its ends unless a constraint releases them, constraints, and bodies.
pub fn supports(scene: &Scene, line: &types::Line, mesh: &Mesh) -> Supports {
    let last = mesh.nodes() - 1;
    let place = |s: f64| mesh.nodes_at(mesh.length - s);
    let mut supports = Supports::default();
    for body in &line.attachments {
        supports.bodies.push(body_of(&scene.environment, place(body.s).1, body));
    }
    for constraint in &line.constraints {
        let (first, node) = place(constraint.s);
        if constraint.mass > 0.0 || constraint.added_mass > 0.0 {
            let (s, mass, added_mass) = (constraint.s, constraint.mass, constraint.added_mass);
            let body = types::Attachment { s, mass, volume: 0.0, drag_area: 0.0, added_mass };
            supports.bodies.push(body_of(&scene.environment, node, &body));
        }
        let end = line.end_at(constraint.s);
        if end.is_none() || !constraint.is_pin() {
            let motion = constraint.motion.as_ref();
            supports.holds.push(Hold {
                first,
                node,
                axes: hold::axes(&constraint.axes),
                reference: constraint.reference.or(end).map(Into::into),
                motion: motion.map(|motion| Sinusoid::new(motion.period, motion.sine, motion.cosine, motion.ramp)),
                stiffness: constraint.stiffness.into(),
                damping: constraint.damping.into(),
                locked: constraint.locked,
                force: constraint.force.into(),
            });
        }
    }
    for (on, node, sign) in [(&line.anchor_on, 0, 1.0), (&line.fairlead_on, last, -1.0)] {
        let Some((clamp, number)) = on.as_ref().and_then(|on| Some((on.clamp()?, scene.body(on.name())?))) else { continue };
        let body = &scene.bodies[number];
        let element = if node == 0 { 0 } else { mesh.elements.len() - 1 };
        let stiffness = match clamp.stiffness {
            Stiffness::Of(stiffness) => stiffness,
            Stiffness::Rigid(_) => joint::STIFFER * mesh.properties_of(element).ei / mesh.elements[element].length,
        };
        supports.clamps.push(Clamp {
            node,
            stiffness,
            direction: Vector3::from(clamp.direction).normalize() * sign,
            body: Holder::Driven(Arc::new(PosePath::Fixed { position: body.position.into(), angles: body.attitude() })),
        });
    }
    let released = |node: usize| supports.holds.iter().any(|hold| hold.node == node);
    supports.fixed =
        [0, last].into_iter().filter(|node| !released(*node)).flat_map(|node| (0..3).map(move |c| (node, c))).collect();
    supports
}

/// Density of steel [kg/m³]: a body counts as no smaller than a sphere of steel of its mass.
const STEEL: f64 = 7850.0;
/// Smallest diameter of a body [m].
const SMALLEST_BODY: f64 = 0.1;

/// The body on a node of what an attachment says.
pub fn body_of(environment: &Environment, node: usize, body: &types::Attachment) -> Body {
    let (rho, g) = (environment.water_density, environment.gravity);
    let volume = body.volume.max(body.mass / STEEL);
    let diameter = (6.0 / std::f64::consts::PI * volume).cbrt().max(SMALLEST_BODY);
    let (weight, buoyancy) = (body.mass * g, rho * g * body.volume);
    let sinking = if weight > buoyancy { weight - buoyancy } else { weight };
    let stiffness = (environment.seabed.stiffness.unwrap_or(0.0) * diameter).max(sinking / (0.1 * diameter));
    let plane = Plane::of(environment);
    let onset = (weight - buoyancy).max(0.0) * plane.normal.z / stiffness.max(f64::MIN_POSITIVE);
    let damping = environment.seabed.damping * diameter;
    let resistance = Resistance { stiffness, damping, onset, easing: onset.max(0.1 * diameter) };
    Body {
        node,
        mass: body.mass,
        added_mass: body.added_mass,
        weight,
        buoyancy,
        drag: 0.5 * rho * body.drag_area,
        diameter: (environment.surface == types::Surface::Pierced).then_some(diameter),
        bed: (stiffness > 0.0).then_some((plane, resistance)),
    }
}

/// The bed of an environment against every element of a mesh.
pub fn ground(environment: &Environment, mesh: &Mesh) -> Ground {
    let plane = Plane::of(environment);
    let resistance = (0..mesh.elements.len()).map(|e| {
        let properties = mesh.properties_of(e);
        let given = properties.seabed_stiffness.or(environment.seabed.stiffness);
        let stiffness = given.unwrap_or(properties.sinking_weight() / properties.diameter);
        let onset = properties.weight.max(0.0) * plane.normal.z / stiffness;
        Resistance { stiffness, damping: environment.seabed.damping, onset, easing: onset.max(0.1 * properties.diameter) }
    });
    let resistance = resistance.collect();
    let coefficient = environment.seabed.friction;
    Ground { plane, resistance, friction: (coefficient > 0.0).then(|| Friction::new(coefficient, &plane, mesh)) }
}

/// What is in the step of a line and why.
pub fn decisions(scene: &Scene, mesh: &Mesh, supports: &Supports) -> Vec<Decision> {
    let decide = |physics, on, yes: &str, no: &str| Decision { physics, on, reason: if on { yes } else { no }.to_string() };
    let any = |f: fn(&crate::rod::properties::Properties) -> bool| mesh.sections.iter().any(f);
    let pierced = scene.environment.surface == types::Surface::Pierced;
    vec![
        decide("axial stretch", true, "always", ""),
        decide(
            "tension–strain tables",
            scene.line_types.values().any(|line_type| line_type.tension_strain.is_some()),
            "a line type has a table",
            "Hooke's law with ea",
        ),
        decide(
            "strain from pressure",
            scene.solver.hydrostatic_strain,
            "solver.hydrostatic_strain is true",
            "strain follows from effective tension",
        ),
        decide("axial damping", any(|p| p.damping > 0.0), "a line type has damping > 0", "damping is 0"),
        decide(
            "bending",
            mesh.bends(),
            if mesh.folds() {
                "ei is 0, but the line is slack: its bights get what the mesh can show of them"
            } else {
                "a line type has ei > 0"
            },
            "ei is 0 everywhere: the line is flexible",
        ),
        decide(
            "drag and added mass",
            feels_water(mesh, supports),
            "a line type or body has coefficients > 0",
            "all coefficients are 0",
        ),
        decide(
            "current",
            !Current::new(&scene.environment.current).is_still(),
            "the scene gives a profile",
            "the water stands still",
        ),
        decide(
            "current over time",
            scene.environment.current_over_time.is_some(),
            "the scene gives profiles: as in waves, lines are solved in space and never rest",
            "the scene gives none",
        ),
        match Waves::of(&scene.environment) {
            Some(waves) if waves.components() > 0 => {
                let kind = if waves.components() == 1 { "1 component" } else { "components" };
                let count = if waves.components() == 1 { String::new() } else { format!("{} ", waves.components()) };
                let reach = match waves.floor() {
                    floor if floor > -scene.environment.depth => format!("skipped on what lies below z = {floor:.0} m"),
                    _ => "they reach down to the bed".to_string(),
                };
                Decision { physics: "waves", on: true, reason: format!("{count}{kind}; {reach}") }
            }
            _ => decide("waves", false, "", "the scene gives none"),
        },
        decide("seabed", true, "elements that touch it pay for it, others only for a look at their height", ""),
        decide("seabed damping", scene.environment.seabed.damping > 0.0, "seabed.damping > 0", "seabed.damping is 0"),
        decide(
            "seabed friction",
            scene.environment.seabed.friction > 0.0,
            "seabed.friction > 0: elements that touch pay for it",
            "seabed.friction is 0",
        ),
        decide("water surface", pierced, "surface is pierced: elements that rise above it pay for it", "surface is none"),
        decide(
            "bodies on the line",
            !supports.bodies.is_empty(),
            "the line has attachments or constraints with mass",
            "nothing is attached",
        ),
        decide("constraints", !supports.holds.is_empty(), "the line has constraints", "the ends are pinned, the rest is free"),
    ]
}
