//! What a thing that is held weighs and displaces by itself: a part of the force on it that no line brings.
//!
//! ```text
//! F = f + g (ρ V - m) ẑ + ½ ρ CdA |u - v| (u - v)      V of a rod: what is below still water
//! ```

use moorline::scene::moordyn::words::Attachment;
use moorline::scene::moordyn::{Deck, DeckBody, DeckPoint, DeckRod};
use moorline::scene::types::Environment;
use moorline::sea::current::Current;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_4;

/// Mass [kg] and volume [m³] at a place in the thing's axes [m].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lump {
    at: Vector3<f64>,
    mass: f64,
    volume: f64,
}

/// A cylinder of a mass [kg] and a section [m²] from one place to another in the thing's axes [m].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bar {
    from: Vector3<f64>,
    to: Vector3<f64>,
    mass: f64,
    area: f64,
}

/// What it is made of.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Own {
    lumps: Vec<Lump>,
    bars: Vec<Bar>,
    force: Vector3<f64>,
    drag_area: f64,
}

/// The water about it.
pub struct Water {
    gravity: f64,
    density: f64,
    current: Current,
}

impl Water {
    /// Of a scene, without waves.
    pub fn new(environment: &Environment) -> Water {
        let current = Current::new(&environment.current);
        Water { gravity: environment.gravity, density: environment.water_density, current }
    }

    /// Density [kg/m³].
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Gravity [m/s²].
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// Velocity at a height [m/s]; none above the water.
    pub fn velocity(&self, z: f64) -> Vector3<f64> {
        if z > 0.0 { Vector3::zeros() } else { self.current.velocity(z) }
    }
}

fn bar(deck: &Deck, rod: &DeckRod, origin: [f64; 3]) -> Option<Bar> {
    let kind = deck.rod_types.get(rod.kind).filter(|_| !rod.is_point())?;
    let (from, to) = (Vector3::from(rod.a) - Vector3::from(origin), Vector3::from(rod.b) - Vector3::from(origin));
    Some(Bar { from, to, mass: kind.mass * (to - from).norm(), area: FRAC_PI_4 * kind.diameter * kind.diameter })
}

impl Own {
    /// Of a body, with the points and rods on it.
    pub fn of_body(deck: &Deck, body: &DeckBody) -> Own {
        let on = Attachment::Body(body.id);
        let own = Lump { at: body.centre.into(), mass: body.mass, volume: body.volume };
        let points = deck.points.iter().filter(|point| point.attachment == on);
        let points = points.map(|point| Lump { at: point.position.into(), mass: point.mass, volume: point.volume });
        let rods = deck.rods.iter().filter(|rod| rod.attachment == on);
        Own {
            lumps: std::iter::once(own).chain(points).collect(),
            bars: rods.filter_map(|rod| bar(deck, rod, [0.0; 3])).collect(),
            ..Own::default()
        }
    }

    /// Of a rod, from its end A.
    pub fn of_rod(deck: &Deck, rod: &DeckRod) -> Own {
        Own { bars: bar(deck, rod, rod.a).into_iter().collect(), ..Own::default() }
    }

    /// Of a point.
    pub fn of_point(point: &DeckPoint) -> Own {
        let lump = Lump { at: Vector3::zeros(), mass: point.mass, volume: point.volume };
        Own { lumps: vec![lump], bars: Vec::new(), force: point.force.into(), drag_area: point.drag_area }
    }

    /// Whether it weighs or displaces anything.
    pub fn is_heavy(&self) -> bool {
        self.lumps.iter().any(|lump| lump.mass > 0.0 || lump.volume > 0.0)
            || self.bars.iter().any(|bar| bar.mass > 0.0 || bar.area > 0.0)
    }

    /// Force [N], and moment about its origin [N·m], where it is, as it is turned and moves [m/s].
    pub fn load(&self, origin: &Vector3<f64>, turn: &Matrix3<f64>, velocity: &Vector3<f64>, water: &Water) -> [Vector3<f64>; 2] {
        let past = water.velocity(origin.z) - velocity;
        let mut force = self.force;
        if origin.z <= 0.0 {
            force += past * (0.5 * water.density * self.drag_area * past.norm());
        }
        let mut moment = Vector3::zeros();
        let mut add = |at: Vector3<f64>, upwards: f64| {
            let own = Vector3::new(0.0, 0.0, upwards);
            force += own;
            moment += (turn * at).cross(&own);
        };
        for Lump { at, mass, volume } in &self.lumps {
            add(*at, water.gravity * (water.density * volume - mass));
        }
        for Bar { from, to, mass, area } in &self.bars {
            add((from + to) * 0.5, -water.gravity * mass);
            let height = |place: &Vector3<f64>| (origin + turn * place).z;
            let (low, high) = if height(from) <= height(to) { (from, to) } else { (to, from) };
            let (bottom, top) = (height(low), height(high));
            let wet = if top <= 0.0 { 1.0 } else { (-bottom / (top - bottom).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0) };
            let surface = low + (high - low) * wet;
            add((low + surface) * 0.5, water.gravity * water.density * area * (surface - low).norm());
        }
        [force, moment]
    }
}
