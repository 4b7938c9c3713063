//! From a scene to mixed elements, and what the report's method models of it.

use crate::cable1994::element::Element;
use crate::cable1994::line::MixedLine;
use crate::rod::elasticity::Pressures;
use crate::rod::line::Supports;
use crate::rod::mesh::Mesh;
use crate::rod::physics::{self, Decision};
use crate::scene::types::{Line, LineType, Scene};
use crate::sea::current::Current;

/// The line of a scene on a mesh without joints: slope and λ of this element are continuous, also where the stiffness jumps.
pub fn line(scene: &Scene, line: &Line, mesh: &Mesh, supports: Supports) -> MixedLine {
    let (environment, ground) = (&scene.environment, physics::ground(&scene.environment, mesh));
    let strained = |line_type: &LineType| match scene.solver.hydrostatic_strain {
        true => Pressures::of(line_type, environment, line.fairlead[2]).outer,
        false => 0.0,
    };
    let types = line.sections.iter().rev().filter_map(|section| scene.line_types.get(&section.line_type));
    let pressures: Vec<f64> = types.map(strained).collect();
    let elements = mesh.elements.iter().zip(&ground.resistance).map(|(element, resistance)| Element {
        length: element.length,
        properties: mesh.sections[element.section],
        pressure: pressures.get(element.section).copied().unwrap_or(0.0),
        mat: Some((ground.plane, *resistance)),
    });
    let current = Current::new(&environment.current);
    MixedLine::new(elements.collect(), (!current.is_still()).then_some(current), supports)
}

/// What is in the step of a line and why.
pub fn decisions(scene: &Scene, mesh: &Mesh, step: f64) -> Vec<Decision> {
    let any = |f: fn(&crate::rod::properties::Properties) -> bool| mesh.sections.iter().any(f);
    let decide = |physics, on, yes: &str, no: &str| Decision { physics, on, reason: if on { yes } else { no }.to_string() };
    let method = format!("the 1994 report's mixed element, one linear solve per step of {step} s at most, no error control");
    let current = !Current::new(&scene.environment.current).is_still();
    vec![
        decide("cable-1994", true, &method, ""),
        decide("axial stretch", true, "the report's law, r'·r' = 1 + 2 T/EA; no slack: the line can push", ""),
        decide("axial damping", any(|p| p.damping > 0.0), "a line type has damping > 0, as the factor 1 - C/h", "damping is 0"),
        decide("hydrostatic strain", scene.solver.hydrostatic_strain, "solver.hydrostatic_strain is on", "it is off"),
        decide("bending", any(|p| p.ei > 0.0), "a line type has ei > 0", "ei is 0 everywhere: the line is flexible"),
        decide(
            "drag and added mass",
            any(|p| p.drag_normal + p.added_normal > 0.0),
            "across the line only",
            "coefficients are 0",
        ),
        decide("current", current, "the scene gives a profile", "the water stands still"),
        decide("seabed", true, "the report's spring mat, without damping and friction", ""),
        decide("water surface", false, "", "the report has water everywhere, also above z = 0"),
    ]
}
