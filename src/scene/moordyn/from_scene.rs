//! From a scene to a MoorDyn file, and what such a file cannot hold.
//!
//! MoorDyn has one diameter, that of the displacement: D' = √(4 b / (π ρ g)) for a buoyancy b per length. Coefficients go with it, so that
//! the forces stay: Cd D = Cd' D', Ca D² = Ca' D'². Its bed is kBot' D' = k.
//!
//! Sections and attachments of a line become lines that meet at free points.

use crate::error::{Error, MoorDynProblem};
use crate::scene::bodies::{Body, BodyMotion, Inertia, Mount, PointMotion, Stiffness as Clamping};
use crate::scene::moordyn::options::{Depth, Options};
use crate::scene::moordyn::words::{Attachment, LineEnd, Side};
use crate::scene::moordyn::{Deck, DeckBody, DeckLine, DeckPoint, DeckRod, LineKind, RodKind, Stiffness, deck_attitude};
use crate::scene::types::{Environment, Line, Motion, Scene, Stretch, Surface, Triple};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// A MoorDyn file made from a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// The file.
    pub deck: Deck,
    /// Rise of the bed along x and y [deg], which stands in a file beside it.
    pub slope_deg: [f64; 2],
    /// Current over the depth, which stands in a file beside it: z, and the velocity there.
    pub current: Vec<(f64, Triple)>,
    /// What the scene says and the file cannot hold, or says otherwise.
    pub losses: Vec<String>,
}

/// Smallest diameter that is written [m].
const THINNEST: f64 = 1.0e-3;
/// Length of a segment where the scene gives no elements [m], and how many there are at least and at most.
const SEGMENT: (f64, usize, usize) = (5.0, 10, 100);

/// The MoorDyn file of a scene whose ends are placed; `file` is for messages.
pub fn deck(scene: &Scene, file: &str) -> Result<Conversion, Error> {
    let mut writer = Writer { scene, deck: empty(scene), first_point: 1, losses: Vec::new() };
    writer.refuse(file)?;
    writer.environment();
    writer.line_types();
    for index in 0..scene.bodies.len() {
        writer.body(index, file)?;
    }
    writer.first_point += writer.deck.points.len() as u32;
    for index in 0..scene.points.len() {
        writer.point(index);
    }
    for (index, line) in scene.lines.iter().enumerate() {
        writer.line(index, line);
    }
    writer.run();
    let environment = &scene.environment;
    Ok(Conversion {
        deck: writer.deck,
        slope_deg: environment.seabed.slope_deg,
        current: environment.current.iter().map(|row| (row.z, row.velocity)).collect(),
        losses: writer.losses,
    })
}

/// The error for a scene that a MoorDyn file cannot hold.
fn cannot(file: &str, place: String, reason: &str) -> Error {
    let problem = MoorDynProblem::CannotHold { item: String::from("a MoorDyn file cannot hold this"), reason: reason.into() };
    Error::Value { file: file.into(), place, value: String::from("what is there"), allowed: problem.to_string() }
}

fn empty(scene: &Scene) -> Deck {
    Deck {
        title: scene.title.lines().next().unwrap_or_default().to_string(),
        line_types: Vec::new(),
        rod_types: Vec::new(),
        bodies: Vec::new(),
        rods: Vec::new(),
        points: Vec::new(),
        lines: Vec::new(),
        options: Options::default(),
        outputs: Vec::new(),
    }
}

struct Writer<'a> {
    scene: &'a Scene,
    deck: Deck,
    /// Number of the point that is the first of the scene's: those that bodies need come before.
    first_point: u32,
    losses: Vec<String>,
}

impl Writer<'_> {
    fn lose(&mut self, lost: bool, text: impl FnOnce() -> String) {
        if lost {
            self.losses.push(text());
        }
    }

    fn refuse(&self, file: &str) -> Result<(), Error> {
        match self.scene.lines.iter().position(|line| !line.constraints.is_empty()) {
            Some(index) => Err(cannot(file, format!("lines[{index}].constraints"), "springs, dampers and locks along the line")),
            None => Ok(()),
        }
    }

    fn environment(&mut self) {
        let Environment { gravity, water_density, depth, seabed, current, current_over_time, waves, surface } =
            &self.scene.environment;
        let options = &mut self.deck.options;
        (options.gravity, options.water_density, options.depth) = (*gravity, *water_density, Some(Depth::Level(*depth)));
        (options.friction, options.currents) = (seabed.friction, !current.is_empty());
        self.lose(current_over_time.is_some(), || {
            String::from("environment.current_over_time: a file holds a current that does not change; there is none in it")
        });
        self.lose(waves.is_some(), || {
            String::from("environment.waves: MoorDyn takes waves from a calling program or files; there are none")
        });
        self.lose(*surface == Surface::None, || {
            String::from("environment.surface: a line above the water has no buoyancy and drag there")
        });
        self.lose(seabed.friction > 0.0, || {
            String::from("environment.seabed.friction: in MoorDyn it is a drag with an upper limit, and a line at rest has none")
        });
    }

    fn line_types(&mut self) {
        let environment = &self.scene.environment;
        let (rho, gravity) = (environment.water_density, environment.gravity);
        let mut beds: Vec<f64> = Vec::new();
        let mut dampings: Vec<f64> = Vec::new();
        for (name, of) in &self.scene.line_types {
            let buoyancy = of.buoyancy_per_length(rho, gravity);
            let displaced = if rho > 0.0 { (4.0 * buoyancy.max(0.0) / (PI * rho * gravity)).sqrt() } else { of.diameter };
            self.lose(displaced < THINNEST, || {
                format!("line_types.{name}: a line without buoyancy gets a diameter of {THINNEST} m")
            });
            // The scene's own where it is that of the displacement.
            let thick = displaced.max(THINNEST);
            let own = (thick - of.diameter).abs() <= 1.0e-12 * thick;
            let (diameter, ratio) = if own { (of.diameter, 1.0) } else { (thick, of.diameter / thick) };
            let fluid = of.inner_fluid.as_ref().map_or(0.0, |fluid| fluid.density * fluid.area);
            let weight = of.weight_in_water(rho, gravity);
            let bed = of.seabed_stiffness.or(environment.seabed.stiffness);
            let bed = bed.unwrap_or(if weight > 0.0 { weight } else { of.mass * gravity } / of.diameter);
            beds.push(bed / diameter);
            dampings.push(environment.seabed.damping / diameter);
            self.deck.line_types.push(LineKind {
                row: 0,
                name: one_word(name),
                diameter,
                mass: of.mass + fluid,
                stiffness: of.tension_strain.clone().map_or(Stiffness::Linear(of.ea), Stiffness::Table),
                damping: of.damping * of.ea,
                ei: of.ei,
                drag: of.drag.normal * ratio,
                added_mass: of.added_mass.normal * ratio * ratio,
                drag_along: of.drag.tangential * ratio,
                added_mass_along: of.added_mass.tangential * ratio * ratio,
            });
            self.lose(of.breaking_load.is_some(), || format!("line_types.{name}.breaking_load: it is left out"));
            self.lose(of.fatigue.is_some(), || format!("line_types.{name}.fatigue: it is left out"));
            let pressed = of.inner_fluid.as_ref().is_some_and(|fluid| fluid.pressure != 0.0);
            self.lose(pressed, || format!("line_types.{name}.inner_fluid.pressure: it is left out"));
        }
        let options = &mut self.deck.options;
        options.bed_stiffness = beds.iter().copied().fold(0.0, f64::max);
        // As it is read: that of the thickest line type.
        options.bed_damping = dampings.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let differ = |values: &[f64]| values.iter().any(|value| (value - values[0]).abs() > 1.0e-9 * values[0]);
        self.lose(differ(&beds), || {
            String::from(
                "environment.seabed.stiffness: MoorDyn has one kBot, times the diameter; it is that of the line type with the stiffest bed",
            )
        });
        self.lose(differ(&dampings), || {
            String::from(
                "environment.seabed.damping: MoorDyn has one cBot, times the diameter; it is that of the thickest line type",
            )
        });
    }

    fn body(&mut self, index: usize, file: &str) -> Result<(), Error> {
        let body = &self.scene.bodies[index];
        let id = index as u32 + 1;
        let at = |key: &str| format!("bodies[{index}].{key}");
        let moving = |motion: &BodyMotion| matches!(motion, BodyMotion::Sinusoidal { .. } | BodyMotion::File { .. });
        self.lose(moving(&body.motion), || format!("{}: a calling program moves a coupled body", at("motion")));
        if body.is_free() && body.stiffness.is_some() {
            return Err(cannot(file, at("stiffness"), "a body floats by its volume and rods there"));
        }
        let mut row = DeckBody {
            row: 0,
            id,
            attachment: if body.is_free() { Attachment::Free } else { Attachment::Coupled },
            position: body.position,
            attitude: deck_attitude(body.attitude_deg),
            mass: 0.0,
            centre: [0.0; 3],
            inertia: [0.0; 3],
            volume: 0.0,
            drag_area: [0.0; 6],
            added_mass: [0.0; 3],
        };
        if body.is_free() {
            self.free_body(body, &mut row, &at);
        }
        self.deck.bodies.push(row);
        Ok(())
    }

    fn free_body(&mut self, body: &Body, row: &mut DeckBody, at: &impl Fn(&str) -> String) {
        let water = self.scene.environment.water_density;
        (row.mass, row.centre) = (body.mass, body.centre_of_mass);
        let inertia = body.inertia.as_ref().map_or_else(nalgebra::Matrix3::zeros, Inertia::matrix);
        row.inertia = inertia.diagonal().into();
        let off = (inertia - nalgebra::Matrix3::from_diagonal(&inertia.diagonal())).amax();
        self.lose(off > 0.0, || format!("{}: products of inertia up to {off} kg·m² are left out", at("inertia")));
        if body.volume > 0.0 && body.centre_of_buoyancy != body.centre_of_mass {
            self.place(Attachment::Body(row.id), body.centre_of_buoyancy, |point| point.volume = body.volume);
        } else {
            row.volume = body.volume;
        }
        if let Some(added) = &body.added_mass {
            let held = row.volume > 0.0 && (0..6).all(|i| (0..6).all(|j| added[i][j] == 0.0 || (i == j && i < 3)));
            if held {
                row.added_mass = std::array::from_fn(|axis| added[axis][axis] / (water * row.volume));
            }
            self.lose(!held, || format!("{}: it is left out; MoorDyn has three coefficients on the volume", at("added_mass")));
        }
        if let Some(drag) = body.quadratic_damping.filter(|_| water > 0.0) {
            row.drag_area = drag.map(|drag| drag / (0.5 * water));
        }
        let lost = [
            ("damping", body.damping.is_some()),
            ("force", body.force != [0.0; 3]),
            ("moment", body.moment != [0.0; 3]),
            ("load", body.load.is_some()),
        ];
        lost.into_iter().filter(|(_, lost)| *lost).for_each(|(key, _)| self.losses.push(format!("{}: it is left out", at(key))));
        for (number, cylinder) in body.cylinders.iter().enumerate() {
            let place = format!("cylinders[{number}]");
            let along = cylinder.drag.tangential != 0.0 || cylinder.added_mass.tangential != 0.0;
            self.lose(along, || format!("{}: drag and added mass along it are left out; its ends have theirs", at(&place)));
            let length = (Vector3::from(cylinder.to) - Vector3::from(cylinder.from)).norm();
            self.deck.rod_types.push(RodKind {
                row: 0,
                name: format!("body{}cylinder{}", row.id, number + 1),
                diameter: cylinder.diameter,
                mass: cylinder.mass / length,
                drag: cylinder.drag.normal,
                added_mass: cylinder.added_mass.normal,
                end_drag: cylinder.drag.end,
                end_added_mass: cylinder.added_mass.end,
            });
            let segments = (length / cylinder.diameter).ceil().clamp(8.0, 40.0) as usize;
            self.rod(self.deck.rod_types.len() - 1, Attachment::Body(row.id), [cylinder.from, cylinder.to], segments);
        }
    }

    fn rod(&mut self, kind: usize, attachment: Attachment, [a, b]: [Triple; 2], segments: usize) -> u32 {
        let id = self.deck.rods.len() as u32 + 1;
        self.deck.rods.push(DeckRod { row: 0, id, kind, attachment, a, b, segments });
        id
    }

    /// A point, with what else it has; its number.
    fn place(&mut self, attachment: Attachment, position: Triple, with: impl FnOnce(&mut DeckPoint)) -> u32 {
        let id = self.deck.points.len() as u32 + 1;
        let none = DeckPoint {
            row: 0,
            id,
            attachment,
            position,
            mass: 0.0,
            volume: 0.0,
            force: [0.0; 3],
            drag_area: 0.0,
            added_mass: 0.0,
        };
        let mut point = none;
        with(&mut point);
        self.deck.points.push(point);
        id
    }

    /// A free point's load: mass, volume, drag and added mass, which MoorDyn has on the volume.
    fn load(&mut self, place: &str, of: [f64; 4], force: Triple, point: u32) {
        let [mass, volume, drag_area, added_mass] = of;
        let displaced = self.scene.environment.water_density * volume;
        if let Some(own) = self.deck.points.iter_mut().find(|own| own.id == point) {
            (own.mass, own.volume, own.drag_area, own.force) =
                (own.mass + mass, own.volume + volume, own.drag_area + drag_area, force);
            if displaced > 0.0 {
                own.added_mass = added_mass / displaced;
            }
        }
        self.lose(added_mass > 0.0 && displaced == 0.0, || {
            format!("{place}.added_mass: it is left out; MoorDyn has it on the volume")
        });
    }

    /// Free points and driven ones of the scene: their numbers follow those of points that bodies needed.
    fn point(&mut self, index: usize) {
        let point = &self.scene.points[index];
        let (attachment, moving) = match point.motion {
            PointMotion::Fixed => (Attachment::Fixed, false),
            PointMotion::Free => (Attachment::Free, false),
            _ => (Attachment::Coupled, true),
        };
        self.lose(moving, || format!("points[{index}].motion: a calling program moves a coupled point"));
        let id = self.place(attachment, point.position, |_| {});
        if attachment == Attachment::Free {
            let of = [point.mass, point.volume, point.drag_area, point.added_mass];
            self.load(&format!("points[{index}]"), of, point.force, id);
        }
    }

    /// What an end of a line is on.
    fn end(&mut self, index: usize, at: Triple, on: Option<&Mount>, fairlead: bool) -> LineEnd {
        match on {
            None => {
                let driven = fairlead && self.scene.motion != Motion::Fixed;
                let attachment = if driven { Attachment::Coupled } else { Attachment::Fixed };
                LineEnd::Point(self.place(attachment, at, |_| {}))
            }
            Some(Mount::Point { point }) => {
                let number = self.scene.point(point).unwrap_or_default();
                LineEnd::Point(self.first_point + number as u32)
            }
            Some(Mount::Body { body, at, clamp }) => {
                let id = self.scene.body(body).unwrap_or_default() as u32 + 1;
                let Some(clamp) = clamp else { return LineEnd::Point(self.place(Attachment::Body(id), *at, |_| {})) };
                self.lose(clamp.stiffness != Clamping::default(), || {
                    format!("lines[{index}]: a clamp that gives way becomes a stiff one")
                });
                let kind = self.deck.rod_types.iter().position(|kind| kind.name == "clamp").unwrap_or_else(|| {
                    self.deck.rod_types.push(RodKind {
                        row: 0,
                        name: String::from("clamp"),
                        diameter: 0.1,
                        mass: 0.0,
                        drag: 0.0,
                        added_mass: 0.0,
                        end_drag: 0.0,
                        end_added_mass: 0.0,
                    });
                    self.deck.rod_types.len() - 1
                });
                let tip = std::array::from_fn(|k| at[k] + clamp.direction[k]);
                LineEnd::Rod(self.rod(kind, Attachment::Body(id), [*at, tip], 0), Side::B)
            }
        }
    }

    fn line(&mut self, index: usize, line: &Line) {
        let top = self.end(index, line.fairlead, line.fairlead_on.as_ref(), true);
        let bottom = self.end(index, line.anchor, line.anchor_on.as_ref(), false);
        let pieces = pieces(line);
        let names: Vec<&String> = self.scene.line_types.keys().collect();
        let mut upper = top;
        for (number, piece) in pieces.iter().enumerate() {
            let lower = if number + 1 == pieces.len() {
                bottom
            } else {
                let share = piece.end / line.length();
                let at = std::array::from_fn(|k| line.fairlead[k] + share * (line.anchor[k] - line.fairlead[k]));
                let point = self.place(Attachment::Free, at, |_| {});
                for (own, body) in line.attachments.iter().enumerate().filter(|(_, body)| same(body.s, piece.end, line)) {
                    let of = [body.mass, body.volume, body.drag_area, body.added_mass];
                    self.load(&format!("lines[{index}].attachments[{own}]"), of, [0.0; 3], point);
                }
                LineEnd::Point(point)
            };
            let id = self.deck.lines.len() as u32 + 1;
            let kind = names.iter().position(|name| **name == piece.kind).unwrap_or_default();
            let ends = [lower, upper];
            self.deck.lines.push(DeckLine { row: 0, id, kind, ends, length: piece.length, segments: piece.segments });
            upper = lower;
        }
        let first = self.deck.lines.len() + 1 - pieces.len();
        self.lose(pieces.len() > 1, || {
            format!("lines[{index}]: its sections are lines of their own, {} of them, from line {first}", pieces.len())
        });
        self.lose(line.attachments.iter().any(|body| line.end_at(body.s).is_some()), || {
            format!("lines[{index}].attachments: what sits on an end loads what holds it; it is left out")
        });
    }

    fn run(&mut self) {
        let scene = self.scene;
        self.deck.options.output_step = scene.run.output_step;
        self.lose(scene.motion != Motion::Fixed, || {
            String::from("motion: fairleads are coupled points; a calling program moves them")
        });
        self.lose(scene.solver.law() == Stretch::Report, || String::from("solver.stretch: becomes T = EA (|r'| - 1)"));
        self.lose(scene.solver.hydrostatic_strain, || String::from("solver.hydrostatic_strain: it is left out"));
        self.lose(true, || String::from("solver, run.duration: not held; NumSegs is `elements`, or one segment every 5 m"));
    }
}

/// A stretch of a line of one kind, without anything on it.
struct Piece<'a> {
    kind: &'a str,
    /// Where it ends [m from the fairlead].
    end: f64,
    length: f64,
    segments: usize,
}

/// The stretches of a line, from the fairlead.
fn pieces(line: &Line) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut begin = 0.0;
    for section in &line.sections {
        let (start, stop) = (begin, begin + section.length);
        let mut cuts: Vec<f64> = line.attachments.iter().map(|body| body.s).collect();
        cuts.retain(|s| *s > start && *s < stop && !same(*s, start, line) && !same(*s, stop, line));
        cuts.push(stop);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|one, other| same(*one, *other, line));
        for end in cuts {
            let length = if begin == start && end == stop { section.length } else { end - begin };
            let share = length / section.length;
            let (size, least, most) = SEGMENT;
            let segments = match section.elements {
                Some(elements) => ((elements as f64 * share).round() as usize).max(1),
                None => ((length / size).ceil() as usize).clamp(least, most),
            };
            pieces.push(Piece { kind: &section.line_type, end, length, segments });
            begin = end;
        }
        begin = stop;
    }
    pieces
}

fn same(one: f64, other: f64, line: &Line) -> bool {
    (one - other).abs() <= 1.0e-9 * line.length()
}

/// A name without blanks, as MoorDyn parts words by them, and without signs that mean something there.
fn one_word(name: &str) -> String {
    name.chars().map(|c| if c.is_whitespace() || "#|!".contains(c) { '_' } else { c }).collect()
}
