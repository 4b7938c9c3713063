//! The mesh of a line of a scene: as given, or chosen to meet the tolerance.

use crate::algebra::shape::Shape;
use crate::rod::catenary::Catenary;
use crate::rod::grading::{self, Rules, Sample};
use crate::rod::line as discrete;
use crate::rod::mesh::{Mesh, Part};
use crate::rod::physics;
use crate::rod::properties::Properties;
use crate::rod::state::State;
use crate::scene::types::{Line, Motion, SAME_PLACE, Scene, Surface};
use crate::sea::waves::Waves;
use crate::solve::outputs;
use crate::solve::start::{Bounds, Frame};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Inertia and drag move the touchdown farther than the fairlead's motion would at rest: the motion counts this many times.
const DYNAMIC: f64 = 1.6;
/// Shortest element as a share of the length of a bight.
const BEND: f64 = 0.3;
/// A snap that is less than this share of what the line carries anyway needs no mesh of its own.
const SNAP: f64 = 0.2;
/// A line is slack where its fairlead carries less than this share of what hangs, or of the tension that counts (`scale`).
const SLACK: f64 = 0.1;
/// Share of what a line weighs, or carries elsewhere on the way of its fairlead, below which errors of tension are not pursued.
pub const SHARE: f64 = 0.1;
/// Samples per element of a shape on which a grading is based.
const PER_ELEMENT: usize = 4;
/// Samples along the line on which the grading is based.
const SAMPLES: usize = 400;

/// The mesh of a line of a scene, `finer` times finer than the tolerance asks where the mesh is left to the program; it is then graded
/// by shapes that the line takes. Where something acts on the line, a section is cut; an element count given for it is shared out among
/// its parts.
pub fn mesh_of(scene: &Scene, line: &Line, shapes: &[Vec<Sample>], finer: f64) -> Mesh {
    let sections = Mesh::properties(scene, line);
    let given: Vec<(f64, Option<usize>)> = line.sections.iter().rev().map(|section| (section.length, section.elements)).collect();
    let stations = if given.iter().any(|(_, elements)| elements.is_none()) {
        grading::stations(&rules(scene, line, finer), shapes)
    } else {
        Vec::new()
    };
    let points = points(line);
    let near = |s: f64, at: f64| (s - at).abs() <= SAME_PLACE * line.length();
    let mut start = 0.0;
    let mut parts = Vec::new();
    let (of_sections, mut elasticities) = (Mesh::elasticities(scene, line), Vec::new());
    for (number, ((length, elements), properties)) in given.iter().zip(sections).enumerate() {
        let end = start + length;
        let inside = points.iter().copied().filter(|s| *s > start && *s < end && !near(*s, start) && !near(*s, end));
        let cuts: Vec<f64> = [start].into_iter().chain(inside).chain([end]).collect();
        let counts = elements.map(|count| shared_out(count, &cuts));
        for (part, ends) in cuts.windows(2).enumerate() {
            let (from, to) = (ends[0], ends[1]);
            let lengths = match &counts {
                Some(counts) => vec![(to - from) / counts[part] as f64; counts[part]],
                None => grading::divide(&stations, from, to, if given.len() == 1 && cuts.len() == 2 { 4 } else { 2 }),
            };
            elasticities.extend(of_sections.get(number).cloned());
            parts.push(Part { properties, lengths, after_point: points.iter().any(|s| near(*s, from)) });
        }
        start = end;
    }
    Mesh { elasticities, ..Mesh::of_parts(parts) }.with_folds(is_slack(scene, line))
}

/// Arc lengths from the anchor at which something acts on a line between its ends, rising.
fn points(line: &Line) -> Vec<f64> {
    let length = line.length();
    let given = line.attachments.iter().map(|body| body.s).chain(line.constraints.iter().map(|constraint| constraint.s));
    let mut points: Vec<f64> = given.map(|s| length - s).collect();
    points.retain(|s| line.end_at(length - s).is_none());
    points.sort_by(f64::total_cmp);
    points.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE * length);
    points
}

/// Shares a number of elements out among the parts between cuts in proportion to their lengths, at least one each.
fn shared_out(count: usize, cuts: &[f64]) -> Vec<usize> {
    let parts = cuts.len() - 1;
    let (count, length) = (count.max(parts), cuts[parts] - cuts[0]);
    let mut given = 0;
    let share = |part: usize| {
        let goal = ((cuts[part + 1] - cuts[0]) / length * count as f64).round() as usize;
        let upto = goal.clamp(given + 1, count - (parts - 1 - part));
        upto - std::mem::replace(&mut given, upto)
    };
    (0..parts).map(share).collect()
}

/// Whether the program chooses any part of the mesh.
pub fn is_automatic(line: &Line) -> bool {
    line.sections.iter().any(|section| section.elements.is_none())
}

/// The surroundings that bound the first guess.
pub fn bounds(scene: &Scene) -> Bounds {
    Bounds {
        bed: Some(crate::rod::seabed::Plane::of(&scene.environment)),
        surface: scene.environment.surface == Surface::Pierced,
    }
}

/// A line of a scene as it is made, before it is meshed: one element per section.
fn whole(scene: &Scene, line: &Line) -> Mesh {
    let lengths: Vec<Vec<f64>> = line.sections.iter().rev().map(|section| vec![section.length]).collect();
    Mesh::new(Mesh::properties(scene, line), &lengths)
}

/// Shapes of a line of a scene with its fairlead in several places, as catenaries of its mean weight.
pub fn catenaries(scene: &Scene, line: &Line) -> Vec<Vec<Sample>> {
    let (whole, anchor) = (whole(scene, line), Vector3::from(line.anchor));
    fairlead_places(scene, line).iter().map(|fairlead| samples(&whole, &bounds(scene), &anchor, fairlead)).collect()
}

/// The shape of a line in equilibrium; at a joint at which something acts both sides of the kink are there.
pub fn shape_of(line: &dyn discrete::Line, state: &State) -> Vec<Sample> {
    let (mesh, u) = (line.mesh(), &state.u);
    let forces = outputs::node_forces(line, state);
    let mut shape = Vec::new();
    for (e, element) in mesh.elements.iter().enumerate().filter(|(_, element)| !element.is_joint()) {
        let carried = line.touching_length(u, e) > 0.5 * element.length;
        for k in 0..=PER_ELEMENT {
            let x = k as f64 / PER_ELEMENT as f64;
            let n = Shape::at(x).scaled(element.length);
            let at = |n: &[f64; 4]| u.position(e) * n[0] + u.slope(e) * n[1] + u.position(e + 1) * n[2] + u.slope(e + 1) * n[3];
            let (slope, height) = (at(&n.slope), at(&n.value).z);
            let tension = (1.0 - x) * forces[e].norm() + x * forces[e + 1].norm();
            shape.push(Sample { s: element.start + x * element.length, tension, slope, height, carried });
        }
    }
    shape
}

fn rules(scene: &Scene, line: &Line, finer: f64) -> Rules {
    let whole = whole(scene, line);
    let places = fairlead_places(scene, line);
    let mean = |f: &dyn Fn(&Properties) -> f64| {
        whole.elements.iter().map(|e| e.length * f(&whole.sections[e.section])).sum::<f64>() / whole.length
    };
    let floats = mean(&|p| p.weight) < 0.0;
    let ground = physics::ground(&scene.environment, &whole);
    let stiffness = if floats {
        mean(&|p| (p.weight_in_air - p.weight) / p.diameter)
    } else {
        ground.resistance.iter().map(|r| r.stiffness).fold(f64::INFINITY, f64::min)
    };
    let speed = fairlead_speed(&scene.motion_of(line));
    // What a snap adds, and what the line carries on the way of its fairlead without any.
    let (snap, carried) = (speed * mean(&|p| (p.ea * p.mass).sqrt()), largest_tension(scene, line));
    let (anchor, falls) = (Vector3::from(line.anchor), mean(&|p| fall_speed(p)));
    let slackens = places.iter().any(|fairlead| (fairlead - anchor).norm() < whole.length);
    let drop = places.iter().map(|fairlead| (fairlead.z - line.anchor[2]).abs()).fold(0.0, f64::max);
    let sea = Waves::of(&scene.environment).filter(|waves| waves.components() > 0).map(|waves| waves.mean());
    // A slack line with bending stiffness hangs in a bight of about this length, (EI/w)^⅓.
    let (ei, weight) = (mean(&|p| p.ei), mean(&|p| p.weight.abs().max(0.01 * p.weight_in_air)));
    let bend = if ei > 0.0 { (BEND * (ei / weight).cbrt()).max(whole.length / 4000.0) } else { f64::INFINITY };
    Rules {
        length: whole.length,
        refinement: finer * (1.0e-3 / scene.solver.tolerance).powf(0.39),
        stiffness: stiffness.max(f64::MIN_POSITIVE),
        mass: mean(&|p| p.mass + p.added_normal),
        ei: mean(&|p| p.ei),
        period: match (&scene.motion_of(line), sea) {
            (Motion::Sinusoidal { period, .. }, None) => *period,
            (Motion::Sinusoidal { period, .. }, Some((omega, _))) => period.min(TAU / omega),
            (_, Some((omega, _))) => TAU / omega,
            _ => 0.0,
        },
        wave_number: sea.map_or(0.0, |(_, k)| k),
        snaps: slackens && speed > falls && snap > SNAP * carried && carried > SHARE * whole.total_weight(),
        slack: is_slack(scene, line),
        shortest: (whole.length / 400.0).max(0.02 * drop).min(whole.length / 20.0).min(bend) / finer,
    }
}

/// Speed at which a level line sinks (or rises) freely, where drag carries its weight [m/s]: a fairlead that is faster leaves the line behind,
/// which goes slack and snaps.
fn fall_speed(p: &Properties) -> f64 {
    (p.weight.abs() / p.drag_normal.max(f64::MIN_POSITIVE)).sqrt()
}

/// Largest speed of a sinusoidal motion [m/s].
fn fairlead_speed(motion: &Motion) -> f64 {
    match motion {
        Motion::Sinusoidal { period, sine, cosine, .. } => {
            let (a, b) = (Vector3::from(*sine), Vector3::from(*cosine));
            // Half the major axis of the ellipse that a sin + b cos goes along.
            let (sum, skew) = (0.5 * (a.dot(&a) + b.dot(&b)), 0.5 * (a.dot(&a) - b.dot(&b)));
            TAU / period * (sum + skew.hypot(a.dot(&b))).sqrt()
        }
        _ => 0.0,
    }
}

/// Whether a flexible line is slack: next to nothing is at its fairlead, as its catenary there says. Its length goes into bights.
pub fn is_slack(scene: &Scene, line: &Line) -> bool {
    let (whole, anchor, fairlead) = (whole(scene, line), Vector3::from(line.anchor), Vector3::from(line.fairlead));
    let bare = line.attachments.is_empty() && line.constraints.is_empty();
    if whole.bends() || !bare {
        return false;
    }
    let frame = Frame::new(&whole, &bounds(scene), &anchor, &fairlead);
    let hanging = frame.span.weight * (frame.span.fairlead_height - frame.span.anchor_height).abs().min(whole.length);
    let counts = SHARE * whole.total_weight().max(largest_tension(scene, line));
    frame.tension(whole.length).0 < SLACK * hanging.max(counts)
}

/// Places of the fairlead, at rest, that bound what its motion does to the line.
pub fn fairlead_places(scene: &Scene, line: &Line) -> Vec<Vector3<f64>> {
    places(scene, line, DYNAMIC)
}

/// Largest tension at the fairlead of the catenaries of a line's mean weight on the way of its fairlead [N].
pub fn largest_tension(scene: &Scene, line: &Line) -> f64 {
    let (whole, anchor) = (whole(scene, line), Vector3::from(line.anchor));
    let tension = |place: &Vector3<f64>| Frame::new(&whole, &bounds(scene), &anchor, place).tension(whole.length).0;
    places(scene, line, 1.0).iter().map(tension).fold(0.0, f64::max)
}

/// The fairlead of the scene, and places on its way, `farther` times as far out.
fn places(scene: &Scene, line: &Line, farther: f64) -> Vec<Vector3<f64>> {
    let fairlead = Vector3::from(line.fairlead);
    let mut places = vec![fairlead];
    if !line.is_pinned(0.0) {
        return places;
    }
    if let Motion::Sinusoidal { sine, cosine, .. } = &scene.motion_of(line) {
        let (sine, cosine) = (Vector3::from(*sine), Vector3::from(*cosine));
        for k in 0..8 {
            let (s, c) = (k as f64 * std::f64::consts::FRAC_PI_4).sin_cos();
            places.push(fairlead + (sine * s + cosine * c) * farther);
        }
    }
    places
}

fn samples(mesh: &Mesh, bounds: &Bounds, anchor: &Vector3<f64>, fairlead: &Vector3<f64>) -> Vec<Sample> {
    let frame = Frame::new(mesh, bounds, anchor, fairlead);
    (0..=SAMPLES)
        .map(|k| {
            let s = mesh.length * k as f64 / SAMPLES as f64;
            let (tension, carried) = frame.tension(s);
            let (place, slope) = frame.at(s);
            Sample { s, tension, slope, height: place.z, carried }
        })
        .collect()
}

impl Frame {
    /// Tension at s from the anchor [N], and whether the bed (or the surface) carries the line there.
    fn tension(&self, s: f64) -> (f64, bool) {
        let w = self.span.weight;
        // A pile is not without tension in motion: count on a fiftieth of the weight of a leg.
        let slack = 0.02 * w * self.span.fairlead_height.min(self.span.length);
        match self.shape {
            Catenary::Hanging { horizontal, at_anchor } => (horizontal.max(slack).hypot(at_anchor + w * s), false),
            Catenary::Lying { horizontal, at_anchor, at_fairlead } => {
                let (s_a, s_f) = (at_anchor / w, self.span.length - at_fairlead / w);
                let lifted = (s_a - s).max(s - s_f);
                (horizontal.max(slack).hypot(w * lifted.max(0.0)), lifted <= 0.0)
            }
            Catenary::Piled => {
                let s_f = self.span.length - self.span.fairlead_height;
                let lifted = (self.span.anchor_height - s).max(s - s_f);
                (slack.hypot(w * lifted.max(0.0)), lifted <= 0.0)
            }
        }
    }
}
