//! The elements of a line, from the anchor to the fairlead.
//!
//! Where the axial or bending stiffness jumps between two sections, the slope must be free to jump too: there the mesh has two
//! nodes at one position with a slope each, and between them a *joint*, an element without length that carries no load.

use crate::scene::types::{Environment, Line, LineType, Scene};
use std::collections::BTreeMap;

/// One element, or a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// Arc length of its anchor-side end, from the anchor [m].
    pub start: f64,
    /// Unstretched length [m]; zero for a joint.
    pub length: f64,
    /// Index of its section, counted from the anchor.
    pub section: usize,
}

impl Element {
    /// Whether it only joins two slopes at one position.
    pub fn is_joint(&self) -> bool {
        self.length == 0.0
    }
}

/// The elements of a line and the properties of its sections.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Elements from the anchor to the fairlead; element i lies between node i and node i + 1.
    pub elements: Vec<Element>,
    /// Properties of each section, counted from the anchor.
    pub sections: Vec<Properties>,
    /// Unstretched length [m].
    pub length: f64,
}

/// What an element is made of, per unstretched length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Properties {
    /// EA [N].
    pub ea: f64,
    /// EI [N·m²].
    pub ei: f64,
    /// Kelvin–Voigt time constant [s].
    pub damping: f64,
    /// Mass [kg/m].
    pub mass: f64,
    /// Weight in air [N/m].
    pub weight_in_air: f64,
    /// Weight in water [N/m].
    pub weight: f64,
    /// Diameter [m].
    pub diameter: f64,
    /// ½ ρ d Cn [kg/m²].
    pub drag_normal: f64,
    /// ½ ρ π d Ct [kg/m²].
    pub drag_tangential: f64,
    /// ρ (π/4) d² Cmn [kg/m].
    pub added_normal: f64,
    /// ρ (π/4) d² Cmt [kg/m].
    pub added_tangential: f64,
}

impl Properties {
    /// Properties of a line type in an environment.
    pub fn of(line_type: &LineType, environment: &Environment) -> Properties {
        let (rho, g, d) = (environment.water_density, environment.gravity, line_type.diameter);
        let area = std::f64::consts::FRAC_PI_4 * d * d;
        Properties {
            ea: line_type.ea,
            ei: line_type.ei,
            damping: line_type.damping,
            mass: line_type.mass,
            weight_in_air: line_type.mass * g,
            weight: line_type.weight_in_water(rho, g),
            diameter: d,
            drag_normal: 0.5 * rho * d * line_type.drag.normal,
            drag_tangential: 0.5 * rho * std::f64::consts::PI * d * line_type.drag.tangential,
            added_normal: rho * area * line_type.added_mass.normal,
            added_tangential: rho * area * line_type.added_mass.tangential,
        }
    }

    /// Least tension [N]: a line without bending stiffness carries no compression.
    pub fn tension_floor(&self) -> f64 {
        if self.ei > 0.0 { f64::NEG_INFINITY } else { 0.0 }
    }

    /// Weight that the bed carries [N/m]: in water, or in air of what does not sink.
    pub fn sinking_weight(&self) -> f64 {
        if self.weight > 0.0 { self.weight } else { self.weight_in_air }
    }

    /// Weight in air [N/m] of a line that can go slack, else zero.
    pub fn slack_weight(&self) -> f64 {
        if self.ei > 0.0 { 0.0 } else { self.weight_in_air }
    }

    /// Whether the slope may jump between this and a neighbouring section.
    fn joins_with_a_kink(&self, other: &Properties) -> bool {
        self.ea != other.ea || self.damping != other.damping || (self.ei > 0.0) != (other.ei > 0.0)
    }
}

impl Mesh {
    /// The mesh with given element lengths for each section, sections and elements counted from the anchor.
    pub fn new(sections: Vec<Properties>, lengths: &[Vec<f64>]) -> Mesh {
        let mut elements = Vec::new();
        let mut start = 0.0;
        for (section, lengths) in lengths.iter().enumerate() {
            if section > 0 && sections[section - 1].joins_with_a_kink(&sections[section]) {
                elements.push(Element { start, length: 0.0, section });
            }
            for &length in lengths {
                elements.push(Element { start, length, section });
                start += length;
            }
        }
        Mesh { elements, sections, length: start }
    }

    /// Properties of the sections of a line of a scene, from the anchor. Sections of unknown type have been refused by the check.
    pub fn properties(scene: &Scene, line: &Line) -> Vec<Properties> {
        let types: &BTreeMap<String, LineType> = &scene.line_types;
        let of = |name: &String| types.get(name).map(|line_type| Properties::of(line_type, &scene.environment));
        line.sections.iter().rev().filter_map(|section| of(&section.line_type)).collect()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.elements.len() + 1
    }

    /// Number of elements, joints not counted.
    pub fn element_count(&self) -> usize {
        self.elements.iter().filter(|element| !element.is_joint()).count()
    }

    /// Arc length of a node from the anchor [m].
    pub fn node_arc_length(&self, node: usize) -> f64 {
        self.elements.get(node).map_or(self.length, |element| element.start)
    }

    /// Properties of an element.
    pub fn properties_of(&self, element: usize) -> &Properties {
        &self.sections[self.elements[element].section]
    }

    /// For each pair of neighbouring nodes: do they share their position?
    pub fn ties(&self) -> Vec<bool> {
        self.elements.iter().map(Element::is_joint).collect()
    }

    /// Weight of the whole line [N] that forces are measured against: in water, every section by its absolute value, and at least
    /// a tenth of that in air, so that a line that hardly sinks has a measure too.
    pub fn total_weight(&self) -> f64 {
        let per_length = |p: &Properties| p.weight.abs().max(0.1 * p.weight_in_air);
        self.elements.iter().map(|element| element.length * per_length(&self.sections[element.section])).sum()
    }
}
