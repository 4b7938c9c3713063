//! From the scene to the types of the element loop: the only place that names combinations.
//!
//! A ladder of small functions: each decides one thing from the scene and hands a type on. What a scene does not need is not
//! compiled into its loop.

use crate::rod::bending::{Bending, Flexible, Stiff};
use crate::rod::friction::Friction;
use crate::rod::line::{Line, Rod, Supports};
use crate::rod::mesh::Mesh;
use crate::rod::morison::{NoWater, Still, Water};
use crate::rod::seabed::{Plane, Resistance};
use crate::rod::stretch::{Exact, Report, Stretch};
use crate::rod::touching::{Ground, Surface};
use crate::scene::types::{self, Environment, Scene};
use crate::sea::current::Current;

/// Surroundings of a line, decided once.
#[derive(Debug, Clone)]
pub struct Surroundings {
    /// Law of extension.
    pub stretch: types::Stretch,
    /// The current; still water is none.
    pub current: Option<Current>,
    /// The bed.
    pub ground: Option<Ground>,
    /// The water surface, where it is pierced.
    pub surface: Option<Surface>,
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
            stretch: scene.solver.stretch,
            current: (!current.is_still()).then_some(current),
            ground: Some(ground(&scene.environment, mesh)),
            surface: (scene.environment.surface == types::Surface::Pierced).then(|| Surface::new(mesh)),
        }
    }
}

impl Surroundings {
    /// The same without friction.
    pub fn without_friction(&self) -> Surroundings {
        Surroundings { ground: self.ground.clone().map(|ground| Ground { friction: None, ..ground }), ..self.clone() }
    }

    /// The same with the friction of statics on a mesh.
    pub fn laid(&self, mesh: &Mesh) -> Surroundings {
        let laid = |ground: Ground| Ground { friction: ground.friction.map(|friction| friction.laid(mesh)), ..ground };
        Surroundings { ground: self.ground.clone().map(laid), ..self.clone() }
    }
}

/// The line of a mesh with the physics that it needs.
pub fn build(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    match surroundings.stretch {
        types::Stretch::Exact => with_bending::<Exact>(mesh, surroundings, supports),
        types::Stretch::Report => with_bending::<Report>(mesh, surroundings, supports),
    }
}

fn with_bending<S: Stretch>(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    if mesh.sections.iter().any(|section| section.ei > 0.0) {
        with_water::<S, Stiff>(mesh, surroundings, supports)
    } else {
        with_water::<S, Flexible>(mesh, surroundings, supports)
    }
}

fn with_water<S: Stretch, B: Bending>(mesh: Mesh, surroundings: Surroundings, supports: Supports) -> Box<dyn Line> {
    if !feels_water(&mesh) {
        finish::<S, NoWater, B>(mesh, NoWater, surroundings, supports)
    } else if let Some(current) = surroundings.current.clone() {
        finish::<S, Current, B>(mesh, current, surroundings, supports)
    } else {
        finish::<S, Still, B>(mesh, Still, surroundings, supports)
    }
}

fn finish<S: Stretch, W: Water, B: Bending>(mesh: Mesh, water: W, around: Surroundings, supports: Supports) -> Box<dyn Line> {
    Box::new(Rod::<S, W, B>::new(mesh, water, around.ground, around.surface, supports))
}

/// Whether any section has drag or added mass.
fn feels_water(mesh: &Mesh) -> bool {
    mesh.sections.iter().any(|p| [p.drag_normal, p.drag_tangential, p.added_normal, p.added_tangential].iter().any(|c| *c > 0.0))
}

/// The bed of an environment against every element of a mesh.
pub fn ground(environment: &Environment, mesh: &Mesh) -> Ground {
    let plane = Plane::of(environment);
    let resistance = (0..mesh.elements.len()).map(|e| {
        let properties = mesh.properties_of(e);
        let stiffness = environment.seabed.stiffness.unwrap_or(properties.sinking_weight() / properties.diameter);
        let onset = properties.weight.max(0.0) * plane.normal.z / stiffness;
        Resistance { stiffness, damping: environment.seabed.damping, onset, easing: onset.max(0.1 * properties.diameter) }
    });
    let resistance = resistance.collect();
    let coefficient = environment.seabed.friction;
    Ground { plane, resistance, friction: (coefficient > 0.0).then(|| Friction::new(coefficient, &plane, mesh)) }
}

/// What is in the step of a line and why.
pub fn decisions(scene: &Scene, mesh: &Mesh) -> Vec<Decision> {
    let decide = |physics, on, yes: &str, no: &str| Decision { physics, on, reason: if on { yes } else { no }.to_string() };
    let any = |f: fn(&crate::rod::mesh::Properties) -> bool| mesh.sections.iter().any(f);
    let pierced = scene.environment.surface == types::Surface::Pierced;
    vec![
        decide("axial stretch", true, "always", ""),
        decide("axial damping", any(|p| p.damping > 0.0), "a line type has damping > 0", "damping is 0"),
        decide("bending", any(|p| p.ei > 0.0), "a line type has ei > 0", "ei is 0 everywhere: the line is flexible"),
        decide("drag and added mass", feels_water(mesh), "a line type has coefficients > 0", "all coefficients are 0"),
        decide(
            "current",
            !Current::new(&scene.environment.current).is_still(),
            "the scene gives a profile",
            "the water stands still",
        ),
        decide("seabed", true, "elements that touch it pay for it, others only for a look at their height", ""),
        decide("seabed damping", scene.environment.seabed.damping > 0.0, "seabed.damping > 0", "seabed.damping is 0"),
        decide(
            "seabed friction",
            scene.environment.seabed.friction > 0.0,
            "seabed.friction > 0: elements that touch pay for it",
            "seabed.friction is 0",
        ),
        decide("water surface", pierced, "surface is pierced: elements that rise above it pay for it", "surface is none"),
    ]
}
