//! First guess of statics: the elastic catenary of the line's mean weight and stiffness, laid on the bed or floating at the surface.

use crate::algebra::shape::SHAPES3;
use crate::rod::catenary::{Catenary, Span};
use crate::rod::ends::Ends;
use crate::rod::mesh::Mesh;
use crate::rod::properties::Properties;
use crate::rod::seabed::Plane;
use crate::rod::state::Field;
use nalgebra::Vector3;

/// What the guess needs to know about the surroundings.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The bed.
    pub bed: Option<Plane>,
    /// Whether a floating line stops at z = 0.
    pub surface: bool,
}

/// A vertical plane, or the same upside down, in which the catenary is solved, and the way back to space.
pub struct Frame {
    /// The line in the plane.
    pub span: Span,
    /// Its shape.
    pub shape: Catenary,
    anchor: Vector3<f64>,
    forward: Vector3<f64>,
    sideways: Vector3<f64>,
    /// +1 for a line that sinks, -1 for one that floats.
    up: f64,
    bed: Option<Plane>,
}

/// Fills positions and slopes of a line between two points.
pub fn guess(mesh: &Mesh, bounds: &Bounds, anchor: &Vector3<f64>, fairlead: &Vector3<f64>, u: &mut Field) {
    let frame = Frame::new(mesh, bounds, anchor, fairlead);
    let last = mesh.nodes() - 1;
    for node in 0..=last {
        let (position, slope) = frame.at(mesh.node_arc_length(node));
        u.set_position(node, &position);
        u.set_slope(node, &slope);
    }
    u.set_position(0, anchor);
    u.set_position(last, fairlead);
}

/// Weight in water below which a line counts as weightless, as a share of its weight in air.
const WEIGHTLESS: f64 = 1.0e-9;
/// Largest stretch |r′| of a line made slack.
const SLACK: f64 = 1.0 - 1.0e-6;

/// A shape near `u` in which a weightless line that is too long is nowhere stretched; none for other lines. Where nothing else pulls at the
/// line, every such shape is in equilibrium. What elements make of a catenary is stretched here and there, so it is drawn
/// towards the chord until it is not; |r′| is convex, so a share θ of the way is enough:
///
/// ```text
/// |r′| ≤ (1 - θ) max |r′_u| + θ |chord|/L = 1
/// ```
pub fn slackened(mesh: &Mesh, u: &Field) -> Option<Field> {
    let slack = |p: &Properties| p.weight.abs() < WEIGHTLESS * p.weight_in_air && p.tension_floor() == 0.0;
    let anchor = u.position(0);
    let chord = (u.position(mesh.nodes() - 1) - anchor) / mesh.length;
    let least = chord.norm();
    if !mesh.sections.iter().all(slack) || !(least < SLACK) {
        return None;
    }
    let mut stretch: f64 = SLACK;
    for (e, element) in mesh.elements.iter().enumerate().filter(|(_, element)| !element.is_joint()) {
        let ends = Ends::gather(u, e, element.length);
        for shape in &SHAPES3 {
            stretch = stretch.max(Vector3::from(ends.combine(&shape.slope)).norm() / element.length);
        }
    }
    let share = (stretch - SLACK) / (stretch - least);
    let mut slackened = u.clone();
    for node in 0..mesh.nodes() {
        let straight = anchor + chord * mesh.node_arc_length(node);
        slackened.set_position(node, &u.position(node).lerp(&straight, share));
        slackened.set_slope(node, &u.slope(node).lerp(&chord, share));
    }
    Some(slackened)
}

impl Frame {
    /// The plane through two points, and the catenary in it.
    pub fn new(mesh: &Mesh, bounds: &Bounds, anchor: &Vector3<f64>, fairlead: &Vector3<f64>) -> Frame {
        let chord = fairlead - anchor;
        let distance = chord.x.hypot(chord.y);
        let forward = if distance > 1e-9 * mesh.length { Vector3::new(chord.x, chord.y, 0.0) / distance } else { Vector3::x() };
        let compliance: f64 = mesh.elements.iter().map(|e| e.length / mesh.sections[e.section].ea).sum();
        let ea = mesh.length / compliance;
        let weight = mesh.elements.iter().map(|e| e.length * mesh.sections[e.section].weight).sum::<f64>() / mesh.length;
        // A weightless line takes the shape of a very light one; a stretched one that of one light against its tension.
        let strain = (chord.norm() / mesh.length - 1.0).max(0.0);
        let least = (1e-6 * strain + 1e-9) * ea / mesh.length;
        let up = if weight < -least { -1.0 } else { 1.0 };
        let far = 10.0 * mesh.length;
        let height = |point: &Vector3<f64>| match (up > 0.0, bounds.bed) {
            (true, Some(bed)) => (point.z - bed.level(point.x, point.y)).max(0.0),
            (false, _) if bounds.surface => (-point.z).max(0.0),
            _ => far + up * (point.z - anchor.z),
        };
        let span = Span {
            distance,
            anchor_height: height(anchor),
            fairlead_height: height(fairlead),
            length: mesh.length,
            weight: weight.abs().max(least),
            ea,
        };
        let (shape, bed) = (span.solve(), bounds.bed.filter(|_| up > 0.0));
        Frame { span, shape, anchor: *anchor, forward, sideways: Vector3::new(-forward.y, forward.x, 0.0), up, bed }
    }

    /// Position and slope at arc length s from the anchor. Heights above a sloping bed become heights by shearing.
    pub fn at(&self, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (place, slope) = self.span.at(&self.shape, s);
        let mut position = self.anchor + self.forward * place.x + self.sideways * place.z;
        let mut direction = self.forward * slope.x + self.sideways * slope.z;
        position.z += self.up * (place.y - self.span.anchor_height);
        direction.z = self.up * slope.y;
        if let Some(bed) = self.bed {
            let rise = |point: &Vector3<f64>| bed.level(point.x, point.y);
            position.z += rise(&position) - rise(&self.anchor);
            direction.z += rise(&direction) - rise(&Vector3::zeros());
            direction *= slope.norm() / direction.norm().max(f64::MIN_POSITIVE);
        }
        (position, direction)
    }
}
