//! The elements of a line, from the anchor to the fairlead.
//!
//! Where the axial or bending stiffness jumps between two sections, or something acts on a point of the line, the slope must be free
//! to jump too: there the mesh has two nodes at one position with a slope each, and between them a *joint*, an element without
//! length that carries no load.

use crate::rod::elasticity::{Elasticity, Pressures};
use crate::rod::properties::Properties;
use crate::scene::types::{Line, LineType, Scene};
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
    /// What the tension of each section depends on besides EA; empty: on nothing else.
    pub elasticities: Vec<Elasticity>,
    /// Joints, by element, at which something acts on the line.
    pub points: Vec<usize>,
    /// Joints, by element, between lines: nothing is joined there.
    pub gaps: Vec<usize>,
    /// No element pushes, whatever its bending stiffness: a line on the way to equilibrium, whose energy is convex.
    pub limp: bool,
}

/// A stretch of one material that is meshed by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its material.
    pub properties: Properties,
    /// Element lengths from the anchor side [m].
    pub lengths: Vec<f64>,
    /// Something acts where it meets the part before.
    pub after_point: bool,
}

impl Mesh {
    /// The mesh with given element lengths for each section, sections and elements counted from the anchor.
    pub fn new(sections: Vec<Properties>, lengths: &[Vec<f64>]) -> Mesh {
        let part =
            |(properties, lengths): (Properties, &Vec<f64>)| Part { properties, lengths: lengths.clone(), after_point: false };
        Mesh::of_parts(sections.into_iter().zip(lengths).map(part).collect())
    }

    /// Whether any element resists bending.
    pub fn bends(&self) -> bool {
        self.sections.iter().any(|section| section.folds || section.ei > 0.0)
    }

    /// Whether bights of it get a bending stiffness of their own.
    pub fn folds(&self) -> bool {
        self.sections.iter().any(|section| section.folds)
    }

    /// The same mesh whose bights get a bending stiffness of their own, or do not.
    pub fn with_folds(mut self, folds: bool) -> Mesh {
        self.sections.iter_mut().for_each(|section| section.folds = folds);
        self
    }

    /// Several lines side by side, and after them `nodes` nodes that belong to no line. Returns where each line's nodes begin.
    pub fn side_by_side(meshes: &[&Mesh], nodes: usize) -> (Mesh, Vec<usize>) {
        let mut all = Mesh::of_parts(Vec::new());
        let mut starts = Vec::new();
        let special = meshes.iter().any(|mesh| !mesh.elasticities.is_empty());
        for mesh in meshes {
            if !all.elements.is_empty() {
                all.add_gap();
            }
            let (first, section) = (all.elements.len(), all.sections.len());
            starts.push(first);
            let moved =
                |element: &Element| Element { start: all.length + element.start, section: section + element.section, ..*element };
            let elements: Vec<Element> = mesh.elements.iter().map(moved).collect();
            all.elements.extend(elements);
            all.points.extend(mesh.points.iter().map(|point| first + point));
            all.length += mesh.length;
            all.sections.extend_from_slice(&mesh.sections);
            if special {
                let given = mesh.elasticities.iter().cloned().chain(std::iter::repeat(Elasticity::default()));
                all.elasticities.extend(given.take(mesh.sections.len()));
            }
        }
        if meshes.is_empty() {
            // Bodies alone: a material that nothing is made of.
            let (diameter, stiffness) = (1.0, Some(1.0));
            all.sections.push(Properties { diameter, seabed_stiffness: stiffness, ..Properties::default() });
        }
        (0..nodes).for_each(|_| all.add_gap());
        (all, starts)
    }

    fn add_gap(&mut self) {
        let section = self.sections.len().saturating_sub(1);
        self.gaps.push(self.elements.len());
        self.elements.push(Element { start: self.length, length: 0.0, section });
    }

    /// The mesh of parts, counted from the anchor.
    pub fn of_parts(parts: Vec<Part>) -> Mesh {
        let mut mesh = Mesh {
            elements: Vec::new(),
            sections: Vec::new(),
            length: 0.0,
            elasticities: Vec::new(),
            points: Vec::new(),
            gaps: Vec::new(),
            limp: false,
        };
        for (section, Part { properties, lengths, after_point }) in parts.into_iter().enumerate() {
            let kink = mesh.sections.last().is_some_and(|before| before.joins_with_a_kink(&properties));
            if section > 0 && (after_point || kink) {
                if after_point {
                    mesh.points.push(mesh.elements.len());
                }
                mesh.elements.push(Element { start: mesh.length, length: 0.0, section });
            }
            for length in lengths {
                mesh.elements.push(Element { start: mesh.length, length, section });
                mesh.length += length;
            }
            mesh.sections.push(properties);
        }
        mesh
    }

    /// Properties of the sections of a line of a scene, from the anchor. Sections of unknown type have been refused by the check.
    pub fn properties(scene: &Scene, line: &Line) -> Vec<Properties> {
        let types: &BTreeMap<String, LineType> = &scene.line_types;
        let of = |name: &String| types.get(name).map(|line_type| Properties::of(line_type, &scene.environment));
        line.sections.iter().rev().filter_map(|section| of(&section.line_type)).collect()
    }

    /// What the tensions of the sections of a line depend on besides EA, from the anchor; empty if on nothing else.
    pub fn elasticities(scene: &Scene, line: &Line) -> Vec<Elasticity> {
        let strained = scene.solver.hydrostatic_strain;
        let of = |line_type: &LineType| Elasticity {
            table: line_type.tension_strain.clone(),
            pressures: (strained || line_type.inner_fluid.is_some())
                .then(|| Pressures::of(line_type, &scene.environment, line.fairlead[2])),
            strained,
        };
        let types = line.sections.iter().rev().filter_map(|section| scene.line_types.get(&section.line_type));
        let all: Vec<Elasticity> = types.map(of).collect();
        if all.iter().any(|elasticity| *elasticity != Elasticity::default()) { all } else { Vec::new() }
    }

    /// Whether the tension of any section is more than EA times strain.
    pub fn is_special(&self) -> bool {
        self.elasticities.iter().any(Elasticity::is_special)
    }

    /// What the tension of an element depends on besides EA.
    pub fn elasticity_of(&self, element: usize) -> &Elasticity {
        const NONE: &Elasticity = &Elasticity { table: None, pressures: None, strained: false };
        self.elasticities.get(self.elements[element].section).unwrap_or(NONE)
    }

    /// The same elements with one slope at every node.
    pub fn without_joints(mut self) -> Mesh {
        self.elements.retain(|element| !element.is_joint());
        self
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

    /// The nodes nearest to an arc length from the anchor: one, or the two beside a joint, as first and last.
    pub fn nodes_at(&self, s: f64) -> (usize, usize) {
        let away = |node: usize| (self.node_arc_length(node) - s).abs();
        let nearest = (1..self.nodes()).fold(0, |best, node| if away(node) < away(best) { node } else { best });
        let tied = self.elements.get(nearest).is_some_and(Element::is_joint);
        (nearest, nearest + usize::from(tied))
    }

    /// Properties of an element.
    pub fn properties_of(&self, element: usize) -> &Properties {
        &self.sections[self.elements[element].section]
    }

    /// For each pair of neighbouring nodes: do they share their position?
    pub fn ties(&self) -> Vec<bool> {
        self.elements.iter().enumerate().map(|(e, element)| element.is_joint() && !self.gaps.contains(&e)).collect()
    }

    /// Weight of the whole line [N] that forces are measured against: in water, every section by its absolute value, and at least
    /// a tenth of that in air, so that a line that hardly sinks has a measure too.
    pub fn total_weight(&self) -> f64 {
        let per_length = |p: &Properties| p.weight.abs().max(0.1 * p.weight_in_air);
        self.elements.iter().map(|element| element.length * per_length(&self.sections[element.section])).sum()
    }
}
