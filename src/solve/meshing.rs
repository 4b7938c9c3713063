//! The mesh of a line of a scene: as given, or chosen to meet the tolerance.

use crate::rod::catenary::Catenary;
use crate::rod::grading::{self, Rules, Sample, Station};
use crate::rod::mesh::{Mesh, Properties};
use crate::rod::physics;
use crate::scene::types::{Line, Motion, Scene, Surface};
use crate::sea::waves::Waves;
use crate::solve::start::{Bounds, Frame};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Inertia and drag move the touchdown farther than the fairlead's motion would at rest: the motion counts this many times.
const DYNAMIC: f64 = 1.6;
/// Samples along the line on which the grading is based.
const SAMPLES: usize = 400;

/// The mesh of line `index` of a scene, `finer` times finer than the tolerance asks where the mesh is left to the program.
pub fn mesh_of(scene: &Scene, line: &Line, finer: f64) -> Mesh {
    let sections = Mesh::properties(scene, line);
    let given: Vec<(f64, Option<usize>)> = line.sections.iter().rev().map(|section| (section.length, section.elements)).collect();
    let stations = if given.iter().any(|(_, elements)| elements.is_none()) {
        wanted(scene, line, &sections, &given, finer)
    } else {
        Vec::new()
    };
    let mut start = 0.0;
    let mut lengths = Vec::new();
    for (length, elements) in &given {
        let end = start + length;
        lengths.push(match elements {
            Some(count) => vec![length / *count as f64; *count],
            None => grading::divide(&stations, start, end, if given.len() == 1 { 4 } else { 2 }),
        });
        start = end;
    }
    Mesh { elasticities: Mesh::elasticities(scene, line), ..Mesh::new(sections, &lengths) }
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

fn wanted(scene: &Scene, line: &Line, sections: &[Properties], given: &[(f64, Option<usize>)], finer: f64) -> Vec<Station> {
    let lengths: Vec<Vec<f64>> = given.iter().map(|(length, _)| vec![*length]).collect();
    let whole = Mesh::new(sections.to_vec(), &lengths);
    let anchor = Vector3::from(line.anchor);
    let places = fairlead_places(&scene.motion, &Vector3::from(line.fairlead));
    let positions: Vec<Vec<Sample>> = places.iter().map(|fairlead| samples(&whole, &bounds(scene), &anchor, fairlead)).collect();
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
    let drop = places.iter().map(|fairlead| (fairlead.z - anchor.z).abs()).fold(0.0, f64::max);
    let sea = Waves::of(&scene.environment).map(|waves| waves.mean());
    let rules = Rules {
        length: whole.length,
        refinement: finer * (1.0e-3 / scene.solver.tolerance).powf(0.39),
        stiffness: stiffness.max(f64::MIN_POSITIVE),
        mass: mean(&|p| p.mass + p.added_normal),
        ei: mean(&|p| p.ei),
        period: match (&scene.motion, sea) {
            (Motion::Sinusoidal { period, .. }, None) => *period,
            (Motion::Sinusoidal { period, .. }, Some((omega, _))) => period.min(TAU / omega),
            (_, Some((omega, _))) => TAU / omega,
            _ => 0.0,
        },
        wave_number: sea.map_or(0.0, |(_, k)| k),
        shortest: (whole.length / 400.0).max(0.02 * drop).min(whole.length / 20.0) / finer,
    };
    grading::stations(&rules, &positions)
}

/// Places of the fairlead, at rest, that bound what its motion does to the line.
fn fairlead_places(motion: &Motion, fairlead: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let mut places = vec![*fairlead];
    if let Motion::Sinusoidal { sine, cosine, .. } = motion {
        let (sine, cosine) = (Vector3::from(*sine), Vector3::from(*cosine));
        for k in 0..8 {
            let (s, c) = (k as f64 * std::f64::consts::FRAC_PI_4).sin_cos();
            places.push(fairlead + (sine * s + cosine * c) * DYNAMIC);
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
