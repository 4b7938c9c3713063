//! What a MoorDyn file has, thing by thing in its own order, and where each of them is found in the scene.
//!
//! In a scene of a MoorDyn file coupled points and rods are places of one vessel. A calling program moves each by itself, so here each becomes a
//! body of its own, with the degrees of freedom in MoorDyn's order: coupled bodies, coupled rods, coupled points.

use crate::failure::Outcome;
use crate::own::Own;
use moorline::algebra::rotation;
use moorline::fmi::pack::self_contained;
use moorline::scene::moordyn::coupled::move_alone;
use moorline::scene::moordyn::options::Depth;
use moorline::scene::moordyn::words::{Attachment, LineEnd};
use moorline::scene::moordyn::{Deck, DeckBody, DeckLine, DeckPoint, DeckRod, Stiffness};
use moorline::scene::read::Loaded;
use moorline::scene::types::Scene;
use nalgebra::{Matrix3, Vector3};

/// What holds a body, rod or point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// Nothing moves it.
    Fixed,
    /// The calling program moves it: its first degree of freedom, and its body of the scene; none where no line hangs on it.
    Coupled(usize, Option<usize>),
    /// It is part of a body of the file, by index.
    OnBody(usize),
    /// Forces move it: its body or point of the scene; none where no line holds it, and it is left out.
    Free(Option<usize>),
}

/// A body, rod or point.
#[derive(Debug, Clone)]
pub struct Thing {
    /// Its number in the file.
    pub id: u32,
    /// What holds it.
    pub held: Held,
    /// Whether it can turn: bodies and rods do, points do not.
    pub turns: bool,
    /// Where the file puts it [m]; of a rod its end A; of what is on a body, in the body's axes.
    pub position: Vector3<f64>,
    /// How it is turned there; of points and rods not at all.
    pub turn: Matrix3<f64>,
    /// Of a rod, from end A to end B as the file has it [m]; else zero.
    pub axis: Vector3<f64>,
    /// Number of segments of a rod; else 0.
    pub segments: usize,
    /// Ends of lines on it: line by index, and whether it is its end B.
    pub ends: Vec<(usize, bool)>,
    /// What it weighs itself, and displaces, where it is held.
    pub own: Own,
}

/// A line.
#[derive(Debug, Clone)]
pub struct Line {
    /// Its number in the file.
    pub id: u32,
    /// Number of segments.
    pub segments: usize,
    /// Unstretched length [m].
    pub length: f64,
    /// EA [N]; none: it follows a table.
    pub ea: Option<f64>,
    /// Whether it resists bending.
    pub bends: bool,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Displacement per length [m²].
    pub area: f64,
    /// Added-mass coefficients, across and along [-].
    pub added_mass: [f64; 2],
}

/// What the file has.
pub struct Rig {
    /// Its scene, in which each coupled thing is a body of its own.
    pub scene: Scene,
    /// BODIES.
    pub bodies: Vec<Thing>,
    /// RODS.
    pub rods: Vec<Thing>,
    /// POINTS.
    pub points: Vec<Thing>,
    /// LINES.
    pub lines: Vec<Line>,
    /// Degrees of freedom that the calling program moves.
    pub freedoms: usize,
    /// Whether the file says that waves come from the calling program.
    pub outer_waves: bool,
    /// Whether the file asks for an equilibrium first.
    pub settled: bool,
    /// Whether the depth comes from a file.
    pub bed_of_file: bool,
    /// What the forces on coupled things leave out.
    pub warnings: Vec<String>,
}

impl Rig {
    /// The rig of a file that has been read.
    pub fn new(loaded: &Loaded, deck: &Deck) -> Outcome<Rig> {
        let mut scene = self_contained(&loaded.scene);
        move_alone(&mut scene, deck);
        moorline::scene::check::check(&scene, &loaded.file)?;
        let mut freedoms = 0;
        let mut held = |attachment: Attachment, name: &str, width: usize| match attachment {
            Attachment::Coupled => {
                freedoms += width;
                Held::Coupled(freedoms - width, scene.body(name))
            }
            Attachment::Body(id) => deck.bodies.iter().position(|body| body.id == id).map_or(Held::Fixed, Held::OnBody),
            Attachment::Free if width == 3 => Held::Free(scene.point(name)),
            Attachment::Free => Held::Free(scene.body(name)),
            _ => Held::Fixed,
        };
        let still = |id, held| Thing {
            id,
            held,
            turns: true,
            position: Vector3::zeros(),
            turn: Matrix3::identity(),
            axis: Vector3::zeros(),
            segments: 0,
            ends: Vec::new(),
            own: Own::default(),
        };
        let bodies: Vec<Thing> = deck
            .bodies
            .iter()
            .map(|body| Thing {
                position: body.position.into(),
                turn: rotation::of_angles_xyz(&Vector3::from(body.attitude).map(f64::to_radians)),
                own: Own::of_body(deck, body),
                ..still(body.id, held(body.attachment, &DeckBody::name_of(body.id), 6))
            })
            .collect();
        let rods: Vec<Thing> = deck
            .rods
            .iter()
            .map(|rod| Thing {
                position: rod.a.into(),
                axis: if rod.is_point() { Vector3::zeros() } else { Vector3::from(rod.b) - Vector3::from(rod.a) },
                segments: rod.segments,
                ends: ends(deck, |end| matches!(end, LineEnd::Rod(id, _) if id == rod.id)),
                own: Own::of_rod(deck, rod),
                ..still(rod.id, held(rod.attachment, &DeckRod::name_of(rod.id), 6))
            })
            .collect();
        let points: Vec<Thing> = deck
            .points
            .iter()
            .map(|point| Thing {
                turns: false,
                position: point.position.into(),
                ends: ends(deck, |end| end == LineEnd::Point(point.id)),
                own: Own::of_point(point),
                ..still(point.id, held(point.attachment, &DeckPoint::name_of(point.id), 3))
            })
            .collect();
        let mut rig = Rig {
            bodies,
            rods,
            points,
            lines: lines(deck),
            freedoms,
            outer_waves: deck.options.outer_waves,
            settled: deck.options.settled,
            bed_of_file: matches!(deck.options.depth, Some(Depth::File(_))),
            scene,
            warnings: Vec::new(),
        };
        rig.gather_on_bodies();
        rig.warn_of_what_is_left_out();
        Ok(rig)
    }

    /// Bodies have the ends of lines that are on their points and rods.
    fn gather_on_bodies(&mut self) {
        for thing in self.points.iter().chain(&self.rods) {
            if let Held::OnBody(body) = thing.held {
                self.bodies[body].ends.extend(&thing.ends);
            }
        }
    }

    fn warn_of_what_is_left_out(&mut self) {
        let things = [("body", &self.bodies), ("rod", &self.rods)];
        for (what, things) in things {
            for thing in things.iter().filter(|thing| matches!(thing.held, Held::Coupled(..)) && thing.own.is_heavy()) {
                self.warnings.push(format!(
                    "the force on coupled {what} {} holds its weight and buoyancy, not its inertia, added mass and drag: these are for the \
                     program that moves it",
                    thing.id
                ));
            }
        }
    }

    /// What the calling program moves, by rising degree of freedom: the thing, its first one, and its body of the scene.
    pub fn driven(&self) -> impl Iterator<Item = (&Thing, usize, Option<usize>)> {
        self.bodies.iter().chain(&self.rods).chain(&self.points).filter_map(|thing| match thing.held {
            Held::Coupled(first, body) => Some((thing, first, body)),
            _ => None,
        })
    }
}

/// The ends of lines that are on something.
fn ends(deck: &Deck, on: impl Fn(LineEnd) -> bool) -> Vec<(usize, bool)> {
    let of = |(index, line): (usize, &DeckLine)| {
        let own = line.ends.map(&on);
        [false, true].into_iter().zip(own).filter(|(_, own)| *own).map(move |(b, _)| (index, b)).collect::<Vec<_>>()
    };
    deck.lines.iter().enumerate().flat_map(of).collect()
}

fn lines(deck: &Deck) -> Vec<Line> {
    let line = |line: &DeckLine| {
        let kind = &deck.line_types[line.kind];
        Line {
            id: line.id,
            segments: line.segments,
            length: line.length,
            ea: match kind.stiffness {
                Stiffness::Linear(ea) => Some(ea),
                Stiffness::Table(_) => None,
            },
            bends: kind.ei > 0.0,
            mass: kind.mass,
            area: std::f64::consts::FRAC_PI_4 * kind.diameter * kind.diameter,
            added_mass: [kind.added_mass, kind.added_mass_along],
        }
    };
    deck.lines.iter().map(line).collect()
}
