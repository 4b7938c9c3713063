//! Which lines move together: those that meet at free bodies and points. All others do not know of each other.

use crate::scene::bodies::Mount;
use crate::scene::types::Scene;

/// Lines that move together, and the free bodies and points that they hang on, by their numbers in the scene. One line without either
/// stands alone.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Together {
    /// Lines.
    pub lines: Vec<usize>,
    /// Free bodies.
    pub bodies: Vec<usize>,
    /// Free points.
    pub points: Vec<usize>,
    /// An end of a line is clamped to a body.
    pub clamped: bool,
}

impl Together {
    /// Whether it is a line between ends that are driven or fixed, and pinned.
    pub fn is_alone(&self) -> bool {
        self.bodies.is_empty() && self.points.is_empty() && !self.clamped
    }
}

/// The parts of a scene, in the order of their first lines; free bodies without a line come last.
pub fn parts(scene: &Scene) -> Vec<Together> {
    let free = |on: &Option<Mount>| -> Option<usize> {
        match on.as_ref().filter(|on| scene.is_on_free(Some(on)))? {
            Mount::Body { body, .. } => scene.body(body),
            Mount::Point { point } => scene.point(point).map(|point| scene.bodies.len() + point),
        }
    };
    // Numbers of parts, of lines and of what is free; joined where a line hangs on something.
    let (lines, others) = (scene.lines.len(), scene.bodies.len() + scene.points.len());
    let mut part: Vec<usize> = (0..lines + others).collect();
    for (index, line) in scene.lines.iter().enumerate() {
        for on in [free(&line.fairlead_on), free(&line.anchor_on)].into_iter().flatten() {
            let (one, other) = (part[index], part[lines + on]);
            let (to, from) = (one.min(other), one.max(other));
            part.iter_mut().filter(|part| **part == from).for_each(|part| *part = to);
        }
    }
    let mut found: Vec<(usize, Together)> = Vec::new();
    let mut of = |number: usize| match found.iter().position(|(own, _)| *own == number) {
        Some(place) => place,
        None => {
            found.push((number, Together::default()));
            found.len() - 1
        }
    };
    let places: Vec<usize> = (0..lines).map(|index| of(part[index])).collect();
    let bodies: Vec<(usize, usize)> =
        (0..scene.bodies.len()).filter(|body| scene.bodies[*body].is_free()).map(|body| (of(part[lines + body]), body)).collect();
    let points: Vec<(usize, usize)> = (0..scene.points.len())
        .filter(|point| scene.points[*point].is_free())
        .map(|point| (of(part[lines + scene.bodies.len() + point]), point))
        .collect();
    for (index, place) in places.into_iter().enumerate() {
        let (line, part) = (&scene.lines[index], &mut found[place].1);
        part.lines.push(index);
        part.clamped |= [&line.fairlead_on, &line.anchor_on].into_iter().flatten().any(|on| on.clamp().is_some());
    }
    bodies.into_iter().for_each(|(place, body)| found[place].1.bodies.push(body));
    points.into_iter().for_each(|(place, point)| found[place].1.points.push(point));
    found.into_iter().map(|(_, part)| part).collect()
}
