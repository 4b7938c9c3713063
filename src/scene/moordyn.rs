//! A MoorDyn file: what it says, row by row, in the names and units of its manual, and the way to a scene.
//!
//! Axes are those of a scene: z up, still water at z = 0. A line runs from end A (the anchor in older files) to end B (the fairlead);
//! a scene counts from the fairlead.

pub mod beside;
pub mod coupled;
pub mod driver;
pub mod from_scene;
pub mod options;
pub mod outputs;
pub mod reading;
pub mod sections;
pub mod to_scene;
pub mod waves;
pub mod words;
pub mod writing;

use crate::algebra::rotation;
use crate::scene::types::Triple;
use nalgebra::Vector3;
use options::Options;
use outputs::{Channel, Quantity, Spot};
use words::{Attachment, LineEnd, Side};

/// A MoorDyn file. Every row keeps its line in the text, from 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// First line of the front matter that says something.
    pub title: String,
    /// LINE TYPES or LINE DICTIONARY.
    pub line_types: Vec<LineKind>,
    /// ROD TYPES or ROD DICTIONARY.
    pub rod_types: Vec<RodKind>,
    /// BODIES.
    pub bodies: Vec<DeckBody>,
    /// RODS.
    pub rods: Vec<DeckRod>,
    /// POINTS, CONNECTION PROPERTIES or NODE PROPERTIES.
    pub points: Vec<DeckPoint>,
    /// LINES.
    pub lines: Vec<DeckLine>,
    /// OPTIONS.
    pub options: Options,
    /// OUTPUTS.
    pub outputs: Vec<Channel>,
}

/// A kind of line.
#[derive(Debug, Clone, PartialEq)]
pub struct LineKind {
    /// Line of the text.
    pub row: usize,
    /// Name.
    pub name: String,
    /// Diameter of a cylinder of the same displacement [m].
    pub diameter: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// EA.
    pub stiffness: Stiffness,
    /// BA [N·s]; below zero: minus the share of the critical damping of a segment.
    pub damping: f64,
    /// EI [N·m²].
    pub ei: f64,
    /// Drag across [-].
    pub drag: f64,
    /// Added mass across [-].
    pub added_mass: f64,
    /// Drag along, on the skin [-].
    pub drag_along: f64,
    /// Added mass along [-].
    pub added_mass_along: f64,
}

/// Axial stiffness.
#[derive(Debug, Clone, PartialEq)]
pub enum Stiffness {
    /// EA [N].
    Linear(f64),
    /// Strain [-] and tension [N].
    Table(Vec<[f64; 2]>),
}

/// A kind of rod.
#[derive(Debug, Clone, PartialEq)]
pub struct RodKind {
    /// Line of the text.
    pub row: usize,
    /// Name.
    pub name: String,
    /// Diameter [m].
    pub diameter: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Drag across [-].
    pub drag: f64,
    /// Added mass across [-].
    pub added_mass: f64,
    /// Drag of an end [-].
    pub end_drag: f64,
    /// Added mass of an end [-].
    pub end_added_mass: f64,
}

/// A body.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckBody {
    /// Line of the text.
    pub row: usize,
    /// Its number.
    pub id: u32,
    /// What holds it.
    pub attachment: Attachment,
    /// Position of the reference point [m].
    pub position: Triple,
    /// Angles about x, y and z [deg], each about the axis that the ones before have turned: R = Rx Ry Rz.
    pub attitude: Triple,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass in body axes [m].
    pub centre: Triple,
    /// Inertia about the centre of mass [kg·m²].
    pub inertia: Triple,
    /// Displaced volume, at the centre of mass [m³].
    pub volume: f64,
    /// Drag coefficient times area, six ways [m², m⁵].
    pub drag_area: [f64; 6],
    /// Added-mass coefficients on the volume [-].
    pub added_mass: Triple,
}

/// A rod.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckRod {
    /// Line of the text.
    pub row: usize,
    /// Its number.
    pub id: u32,
    /// Index of its kind.
    pub kind: usize,
    /// What holds it.
    pub attachment: Attachment,
    /// End A [m].
    pub a: Triple,
    /// End B [m]; of a rod without segments it gives the direction alone.
    pub b: Triple,
    /// Number of segments; 0: a rod of no length.
    pub segments: usize,
}

/// A point.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckPoint {
    /// Line of the text.
    pub row: usize,
    /// Its number.
    pub id: u32,
    /// What holds it.
    pub attachment: Attachment,
    /// Position, in body axes where it is on a body [m].
    pub position: Triple,
    /// Mass [kg].
    pub mass: f64,
    /// Displaced volume [m³].
    pub volume: f64,
    /// Constant force [N].
    pub force: Triple,
    /// Drag coefficient times area [m²].
    pub drag_area: f64,
    /// Added-mass coefficient on the volume [-].
    pub added_mass: f64,
}

/// A line.
#[derive(Debug, Clone, PartialEq)]
pub struct DeckLine {
    /// Line of the text.
    pub row: usize,
    /// Its number.
    pub id: u32,
    /// Index of its kind.
    pub kind: usize,
    /// Ends A and B.
    pub ends: [LineEnd; 2],
    /// Unstretched length [m].
    pub length: f64,
    /// Number of segments.
    pub segments: usize,
}

impl Deck {
    /// The lines that a free rod of no length makes one line of, by index: the one whose end B is on it, and the one that goes on from there with its
    /// end A. None where it does not join two so, on its two sides.
    pub fn joined(&self, rod: u32) -> Option<[usize; 2]> {
        self.rods.iter().find(|own| own.id == rod && own.is_point() && own.attachment == Attachment::Free)?;
        let on = |(index, line): (usize, &DeckLine)| {
            let own = line.ends.map(|end| match end {
                LineEnd::Rod(id, side) if id == rod => Some(side),
                _ => None,
            });
            [0, 1].into_iter().filter_map(move |end: usize| Some((index, end, own[end]?))).collect::<Vec<_>>()
        };
        let mut ends: Vec<(usize, usize, Side)> = self.lines.iter().enumerate().flat_map(on).collect();
        ends.sort_by_key(|(_, end, _)| std::cmp::Reverse(*end));
        match ends[..] {
            [(lower, 1, one), (upper, 0, other)] if lower != upper && one != other => Some([lower, upper]),
            _ => None,
        }
    }

    /// Where a line is that rods of no length may have made one with others: the number of the line of which the scene has the name, and the arc
    /// length of that from its fairlead to the own end B [m]. None where they go round in a ring.
    pub fn stretch(&self, id: u32) -> Option<(u32, f64)> {
        let mut own = self.lines.iter().position(|line| line.id == id)?;
        let mut before = 0.0;
        for _ in 0..=self.lines.len() {
            let LineEnd::Rod(rod, _) = self.lines[own].ends[1] else { return Some((self.lines[own].id, before)) };
            let Some([_, next]) = self.joined(rod) else { return Some((self.lines[own].id, before)) };
            own = next;
            before += self.lines[own].length;
        }
        None
    }

    /// Why a column that is asked for will be missing; none: it will be there.
    fn cannot_write(&self, channel: &Channel) -> Option<String> {
        let why = |reason: &str| Some(format!("OUTPUTS: {}: not written: {reason}", channel.name));
        let line = |id: u32| self.lines.iter().find(|line| line.id == id);
        let leads_to = |id: u32| self.lines.iter().any(|line| line.ends.contains(&LineEnd::Point(id)));
        match channel.quantity {
            Quantity::Tension(id, _) | Quantity::EndOfLine(id, ..) | Quantity::OfLine(id, ..) if line(id).is_none() => {
                why("there is no such line")
            }
            Quantity::OfLine(id, Spot::Node(node), _) if line(id).is_some_and(|line| node as usize > line.segments) => {
                why("the line has fewer nodes; they count from 0 at end A to NumSegs")
            }
            Quantity::Point(id, _) | Quantity::OnPoint(id, _) if !leads_to(id) => why("no line leads to such a point"),
            Quantity::OnPoint(id, _)
                if self.points.iter().any(|point| point.id == id && point.attachment == Attachment::Free) =>
            {
                why("on a free point the forces are in balance; see the tensions of its lines")
            }
            Quantity::Body(id, _) | Quantity::Turn(id, _) if !self.bodies.iter().any(|body| body.id == id) => {
                why("there is no such body")
            }
            _ => None,
        }
    }
}

impl DeckLine {
    /// Name of a line in the scene.
    pub fn name_of(id: u32) -> String {
        format!("line{id}")
    }
}

impl DeckBody {
    /// Name of a body in the scene.
    pub fn name_of(id: u32) -> String {
        format!("body{id}")
    }
}

impl DeckPoint {
    /// Name of a free point in the scene.
    pub fn name_of(id: u32) -> String {
        format!("point{id}")
    }
}

impl DeckRod {
    /// Name in the scene of the body that a rod is.
    pub fn name_of(id: u32) -> String {
        format!("rod{id}")
    }

    /// Whether it has no length.
    pub fn is_point(&self) -> bool {
        self.segments == 0 || self.a == self.b
    }
}

/// Roll, pitch and yaw of a scene [deg], R = Rz Ry Rx, of the angles of a file. Of one angle alone both are the same.
pub fn scene_attitude(angles: Triple) -> Triple {
    turned(angles, |radians| rotation::angles(&rotation::of_angles_xyz(radians)))
}

/// The angles of a file [deg] of roll, pitch and yaw of a scene.
pub fn deck_attitude(angles: Triple) -> Triple {
    turned(angles, |radians| rotation::angles_xyz(&rotation::of_angles(radians)))
}

fn turned(angles: Triple, by: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Triple {
    if angles.iter().filter(|angle| **angle != 0.0).count() < 2 {
        return angles;
    }
    by(&Vector3::from(angles).map(f64::to_radians)).map(f64::to_degrees).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn about x takes y to z, and the next about z, which is now where -y was, takes x there: R = Rx Rz. Roll, pitch and yaw of the same.
    #[test]
    fn angles_of_a_file_turn_about_turned_axes() {
        let r = rotation::of_angles(&Vector3::from(scene_attitude([90.0, 0.0, 30.0])).map(f64::to_radians));
        let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
        assert!((r * Vector3::x() - Vector3::new(cosine, 0.0, sine)).norm() < 1e-12, "{r}");
        assert_eq!(scene_attitude([0.0, 12.3, 0.0]), [0.0, 12.3, 0.0]);
        let back = deck_attitude(scene_attitude([20.0, -35.0, 70.0]));
        assert!(back.iter().zip([20.0, -35.0, 70.0]).all(|(found, wanted)| (found - wanted).abs() < 1e-9), "{back:?}");
    }
}
