//! From a MoorDyn file to a scene, and what the scene does otherwise.
//!
//! ```text
//! damping     τ = BA / EA;  BA below zero: BA = -BA (L/N) √(EA m), of each line with its own L/N; of a table EA = last tension / strain
//! bed         stiffness kBot D, damping cBot D per length
//! body        drag d = ½ ρ CdA six ways, added mass ρ V Ca, volume V at the centre of mass
//! point       added mass ρ V Ca
//! ```
//!
//! Coupled points and rods are places of one body, `vessel`, that a motion or a co-simulation drives; a coupled body is a body of its own.
//! What is fixed is coordinates.

use crate::error::{Error, MoorDynProblem};
use crate::scene::bodies::{
    Body, BodyMotion, Clamp, Cylinder, EndCoefficients, Inertia, Mount, Point, PointMotion, Stiffness as Clamping,
};
use crate::scene::moordyn::beside::{self, Plane};
use crate::scene::moordyn::options::Depth;
use crate::scene::moordyn::reading::Reading;
use crate::scene::moordyn::waves;
use crate::scene::moordyn::words::{Attachment, LineEnd, Side};
use crate::scene::moordyn::{Deck, DeckBody, DeckLine, DeckPoint, DeckRod, LineKind, Stiffness, scene_attitude};
use crate::scene::types::{
    Environment, Line, LineType, Motion, NormalTangential, Run, Scene, Seabed, Seas, Section, Solver, Surface, Triple,
};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the body that coupled points and rods are places of.
pub const VESSEL: &str = "vessel";
/// Gravity of a scene without any [m/s²].
const WEIGHTLESS: f64 = 1.0e-9;
/// Lines whose damping differs by less than this share have one line type.
const SAME: f64 = 1.0e-9;

/// What a MoorDyn file means.
#[derive(Debug, Clone, PartialEq)]
pub struct Meaning {
    /// The scene.
    pub scene: Scene,
    /// Where in the file stands what a place of the scene is made of: the beginning of a place, and the line.
    pub spots: Vec<(String, usize)>,
    /// What the scene does otherwise.
    pub warnings: Vec<String>,
}

/// The scene of a file. Files that it names are looked for in `directory`.
pub fn meaning(reading: &Reading, text: &str, file: &str, directory: &Path) -> Result<Meaning, Error> {
    let deck = &reading.deck;
    let lines: Vec<&str> = text.lines().collect();
    let mut making = Making {
        deck,
        file,
        lines,
        warnings: reading.warnings.clone(),
        spots: Vec::new(),
        bodies: Vec::new(),
        points: Vec::new(),
    };
    let environment = making.environment(directory)?;
    making.refuse_what_turns_about_an_end()?;
    let (line_types, kinds) = making.line_types();
    let mut scene_lines = Vec::new();
    for (line, kind) in deck.lines.iter().zip(&kinds) {
        scene_lines.push(making.line(line, kind)?);
    }
    let (scene_lines, rows) = making.join(scene_lines)?;
    making.spots.extend(rows.into_iter().enumerate().map(|(index, row)| (format!("lines[{index}]"), row)));
    making.without_lines();
    let step = deck.options.output_step;
    let run = Run { output_step: if step > 0.0 { step } else { Run::default().output_step }, ..Run::default() };
    let scene = Scene {
        title: deck.title.clone(),
        environment,
        line_types,
        lines: scene_lines,
        bodies: making.bodies,
        points: making.points,
        motion: Motion::Fixed,
        run,
        solver: Solver::default(),
    };
    Ok(Meaning { scene, spots: making.spots, warnings: making.warnings })
}

/// The scene while it is made.
struct Making<'a> {
    deck: &'a Deck,
    file: &'a str,
    lines: Vec<&'a str>,
    warnings: Vec<String>,
    spots: Vec<(String, usize)>,
    bodies: Vec<Body>,
    points: Vec<Point>,
}

impl Making<'_> {
    /// The error for a problem of a row.
    fn error(&self, row: usize, problem: MoorDynProblem) -> Error {
        let text =
            row.checked_sub(1).and_then(|index| self.lines.get(index)).map_or("", |line| line.split('#').next().unwrap_or(""));
        Error::MoorDyn { file: self.file.into(), line: row, text: text.trim().into(), problem: problem.into() }
    }

    fn cannot(&self, row: usize, item: &str, reason: &str) -> Error {
        self.error(row, MoorDynProblem::CannotHold { item: item.into(), reason: reason.into() })
    }

    fn environment(&mut self, directory: &Path) -> Result<Environment, Error> {
        let options = &self.deck.options;
        let mut bed = match &options.depth {
            Some(Depth::File(name)) => beside::bed(directory, name)?,
            Some(Depth::Level(depth)) => Plane { depth: *depth, slope_deg: [0.0; 2] },
            None => Plane { depth: 0.0, slope_deg: [0.0; 2] },
        };
        if options.depth_row > 0 {
            self.spots.push((String::from("environment.depth"), options.depth_row));
        }
        self.deepen(&mut bed);
        if bed.depth <= 0.0 {
            let row = self.lines.len();
            return Err(self.error(row, MoorDynProblem::NoSection { section: "OPTIONS with the depth of the water, WtrDpth" }));
        }
        let mut gravity = options.gravity;
        if gravity == 0.0 {
            self.warnings.push(format!("g = 0: a scene has some gravity, {WEIGHTLESS} m/s² is taken"));
            gravity = WEIGHTLESS;
        }
        Ok(Environment {
            gravity,
            water_density: options.water_density,
            depth: bed.depth,
            seabed: Seabed {
                stiffness: None,
                damping: options.bed_damping * self.diameter_of_bed(),
                friction: options.friction,
                slope_deg: bed.slope_deg,
            },
            current: if options.currents { beside::current(directory)? } else { Vec::new() },
            current_over_time: None,
            waves: self.waves(directory)?,
            surface: Surface::Pierced,
        })
    }

    /// The waves of the files beside this one.
    fn waves(&mut self, directory: &Path) -> Result<Option<Seas>, Error> {
        let Some((kind, row)) = self.deck.options.waves else { return Ok(None) };
        self.spots.push((String::from("environment.waves"), row));
        Ok(Some(waves::read(kind, directory, self.deck.options.wave_step)?.into()))
    }

    /// A level bed lies at least as deep as the lowest point, as in MoorDyn.
    fn deepen(&mut self, bed: &mut Plane) {
        let outside = |point: &&DeckPoint| !matches!(point.attachment, Attachment::Body(_));
        let lowest = self.deck.points.iter().filter(outside).min_by(|one, other| one.position[2].total_cmp(&other.position[2]));
        let Some(lowest) = lowest.filter(|lowest| bed.slope_deg == [0.0; 2] && lowest.position[2] < -bed.depth) else { return };
        bed.depth = -lowest.position[2];
        self.warnings
            .push(format!("line {}: the depth is {} m, that of point {}, which lies deepest", lowest.row, bed.depth, lowest.id));
    }

    /// The diameter with which the damping of the bed is taken [m]: a scene has one for all lines.
    fn diameter_of_bed(&mut self) -> f64 {
        let used = self.deck.lines.iter().map(|line| self.deck.line_types[line.kind].diameter);
        let (least, largest) = used.fold((f64::INFINITY, 0.0_f64), |(least, largest), d| (least.min(d), largest.max(d)));
        if self.deck.options.bed_damping > 0.0 && largest > least {
            self.warnings.push(format!("cBot: damping of the bed is one for all lines here, that of the diameter {largest} m"));
        }
        largest
    }

    fn refuse_what_turns_about_an_end(&self) -> Result<(), Error> {
        let bodies = self.deck.bodies.iter().map(|body| (body.attachment, body.row, "body"));
        let rods = self.deck.rods.iter().map(|rod| (rod.attachment, rod.row, "rod"));
        let points = self.deck.points.iter().map(|point| (point.attachment, point.row, "point"));
        for (attachment, row, what) in bodies.chain(rods).chain(points) {
            let reason = match attachment {
                Attachment::Pinned | Attachment::BodyPinned(_) | Attachment::CoupledPinned => {
                    "a hinge is not modelled: let it be fixed, coupled, part of a body or free"
                }
                Attachment::Turbine(_) => {
                    "places of turbines are in a file of FAST.Farm; write Coupled, and the place in global axes"
                }
                Attachment::Body(_) if what == "body" => {
                    "a body is not part of another body; put its mass and volume into that one"
                }
                _ => continue,
            };
            return Err(self.cannot(row, &format!("attachment of the {what}"), reason));
        }
        Ok(())
    }

    /// Line types by name, and the name of each line's. Lines of one kind whose damping differs have line types of their own.
    fn line_types(&mut self) -> (BTreeMap<String, LineType>, Vec<String>) {
        let mut types: BTreeMap<String, LineType> = BTreeMap::new();
        let mut names = Vec::new();
        for line in &self.deck.lines {
            let kind = &self.deck.line_types[line.kind];
            let of = self.line_type(kind, line);
            let same = |other: &LineType| (other.damping - of.damping).abs() <= SAME * of.damping;
            let name = match types.get(&kind.name) {
                Some(other) if !same(other) => {
                    let split =
                        types.iter().find(|(name, other)| name.starts_with(&format!("{} (line", kind.name)) && same(other));
                    split.map_or_else(|| format!("{} (line {})", kind.name, line.id), |(name, _)| name.clone())
                }
                _ => kind.name.clone(),
            };
            self.spots.push((format!("line_types.{name}."), kind.row));
            types.entry(name.clone()).or_insert(of);
            names.push(name);
        }
        (types, names)
    }

    fn line_type(&self, kind: &LineKind, line: &DeckLine) -> LineType {
        let (ea, table) = match &kind.stiffness {
            Stiffness::Linear(ea) => (*ea, None),
            Stiffness::Table(points) => {
                let [strain, tension] = points.last().copied().unwrap_or([1.0, 1.0]);
                (tension / strain, Some(points.clone()))
            }
        };
        let segment = line.length / line.segments as f64;
        let damping = if kind.damping < 0.0 { -kind.damping * segment * (ea * kind.mass).sqrt() } else { kind.damping };
        LineType {
            ea,
            mass: kind.mass,
            diameter: kind.diameter,
            submerged_weight: None,
            buoyancy: None,
            ei: kind.ei,
            drag: NormalTangential { normal: kind.drag, tangential: kind.drag_along },
            added_mass: NormalTangential { normal: kind.added_mass, tangential: kind.added_mass_along },
            damping: damping / ea,
            tension_strain: table,
            breaking_load: None,
            fatigue: None,
            inner_fluid: None,
            outer_area: None,
            seabed_stiffness: (self.deck.options.bed_stiffness > 0.0).then_some(self.deck.options.bed_stiffness * kind.diameter),
        }
    }

    fn line(&mut self, line: &DeckLine, kind: &str) -> Result<Line, Error> {
        if line.ends[0] == line.ends[1] {
            return Err(self.cannot(line.row, "ends of the line", "both are on one place; a line joins two"));
        }
        let bends = self.deck.line_types[line.kind].ei > 0.0;
        let [(anchor, anchor_on), (fairlead, fairlead_on)] = [self.end(line, 0, bends)?, self.end(line, 1, bends)?];
        Ok(Line {
            name: DeckLine::name_of(line.id),
            fairlead,
            fairlead_on,
            anchor,
            anchor_on,
            sections: vec![Section { line_type: kind.to_string(), length: line.length, elements: None }],
            attachments: Vec::new(),
            constraints: Vec::new(),
        })
    }

    /// Makes one line of lines that a free rod of no length joins, with a section for each: the bending moment goes on there as the direction does. What
    /// is left, each with its row.
    fn join(&mut self, lines: Vec<Line>) -> Result<(Vec<Line>, Vec<usize>), Error> {
        let deck = self.deck;
        let mut all: Vec<Option<Line>> = lines.into_iter().map(Some).collect();
        for rod in &deck.rods {
            let Some([lower, upper]) = deck.joined(rod.id) else { continue };
            if deck.stretch(deck.lines[lower].id).is_none() {
                return Err(self.cannot(
                    rod.row,
                    "a free rod of no length",
                    "its lines go round in a ring; let one of them end at a point",
                ));
            }
            // The upper one may have gone into another already.
            let whole = deck.stretch(deck.lines[upper].id).and_then(|(id, _)| deck.lines.iter().position(|line| line.id == id));
            let into = if all[upper].is_some() { Some(upper) } else { whole };
            let Some(under) = all[lower].take() else { continue };
            let name = whole.map_or_else(String::new, |whole| DeckLine::name_of(deck.lines[whole].id));
            let Some(into) = into.and_then(|into| all[into].as_mut()) else { continue };
            into.sections.extend(under.sections);
            (into.anchor, into.anchor_on) = (under.anchor, under.anchor_on);
            self.warnings.push(format!(
                "line {}: rod {} has no length: {} goes on as a section of {name}",
                rod.row,
                rod.id,
                DeckLine::name_of(deck.lines[lower].id)
            ));
        }
        Ok(all.into_iter().zip(&deck.lines).filter_map(|(line, own)| Some((line?, own.row))).unzip())
    }

    /// Coordinates of an end, or what it hangs on.
    fn end(&mut self, line: &DeckLine, end: usize, bends: bool) -> Result<(Triple, Option<Mount>), Error> {
        match line.ends[end] {
            LineEnd::Point(id) => {
                let deck = self.deck;
                let Some(point) = deck.points.iter().find(|point| point.id == id) else {
                    let ids = deck.points.iter().map(|point| point.id.to_string()).collect();
                    return Err(self.error(
                        line.row,
                        MoorDynProblem::Unknown { item: "end of the line", name: format!("point {id}"), known: ids },
                    ));
                };
                self.end_at_point(point)
            }
            LineEnd::Rod(id, rod_end) => {
                let deck = self.deck;
                let Some(rod) = deck.rods.iter().find(|rod| rod.id == id) else {
                    let ids = deck.rods.iter().map(|rod| format!("R{}", rod.id)).collect();
                    return Err(self.error(
                        line.row,
                        MoorDynProblem::Unknown { item: "end of the line", name: format!("rod {id}"), known: ids },
                    ));
                };
                self.end_at_rod(rod, rod_end, bends)
            }
        }
    }

    fn end_at_point(&mut self, point: &DeckPoint) -> Result<(Triple, Option<Mount>), Error> {
        match point.attachment {
            Attachment::Fixed => Ok((point.position, None)),
            Attachment::Coupled => {
                self.vessel();
                Ok(on_body(VESSEL, point.position, None))
            }
            Attachment::Body(id) => self.place_of_body(id, point.position, None, point.row),
            _ => {
                let name = DeckPoint::name_of(point.id);
                if !self.points.iter().any(|own| own.name == name) {
                    self.spots.push((format!("points[{}]", self.points.len()), point.row));
                    self.points.push(Point {
                        name: name.clone(),
                        position: point.position,
                        mass: point.mass,
                        volume: point.volume,
                        drag_area: point.drag_area,
                        added_mass: point.added_mass * self.deck.options.water_density * point.volume,
                        force: point.force,
                        motion: PointMotion::Free,
                    });
                }
                Ok(([0.0; 3], Some(Mount::Point { point: name })))
            }
        }
    }

    /// An end of a rod. A line that bends leaves it along the rod.
    fn end_at_rod(&mut self, rod: &DeckRod, end: Side, bends: bool) -> Result<(Triple, Option<Mount>), Error> {
        let axis: Triple = std::array::from_fn(|k| rod.b[k] - rod.a[k]);
        let (at, direction) = match end {
            Side::A => (rod.a, axis.map(|x| 0.0 - x)),
            Side::B if rod.is_point() => (rod.a, axis),
            Side::B => (rod.b, axis),
        };
        let clamp = (bends && axis != [0.0; 3]).then_some(Clamp { direction, stiffness: Clamping::default() });
        match rod.attachment {
            Attachment::Fixed if clamp.is_none() => Ok((at, None)),
            Attachment::Fixed => {
                let name = DeckRod::name_of(rod.id);
                self.plain_body(&name, rod.row);
                Ok(on_body(&name, at, clamp))
            }
            Attachment::Coupled => {
                self.vessel();
                Ok(on_body(VESSEL, at, clamp))
            }
            Attachment::Body(id) => self.place_of_body(id, at, clamp, rod.row),
            // Its lines become one.
            _ if self.deck.joined(rod.id).is_some() => Ok((at, None)),
            _ if rod.is_point() => Err(self.cannot(
                rod.row,
                "a free rod of no length",
                "it joins two lines, end B of one on its one side and end A of the other on its other; let other lines meet at a free point",
            )),
            _ => {
                let name = DeckRod::name_of(rod.id);
                if !self.bodies.iter().any(|body| body.name == name) {
                    self.spots.push((format!("bodies[{}]", self.bodies.len()), rod.row));
                    let cylinder = Cylinder { from: [0.0; 3], to: axis, ..self.cylinder(rod) };
                    let body = Body { position: rod.a, motion: BodyMotion::Free, cylinders: vec![cylinder], ..Body::plain(&name) };
                    self.bodies.push(body);
                }
                Ok(on_body(&name, std::array::from_fn(|k| at[k] - rod.a[k]), clamp))
            }
        }
    }

    /// A place of a body of the file.
    fn place_of_body(&mut self, id: u32, at: Triple, clamp: Option<Clamp>, row: usize) -> Result<(Triple, Option<Mount>), Error> {
        let deck = self.deck;
        let Some(body) = deck.bodies.iter().find(|body| body.id == id) else {
            let known = deck.bodies.iter().map(|body| format!("Body{}", body.id)).collect();
            return Err(self.error(row, MoorDynProblem::Unknown { item: "attachment", name: format!("body {id}"), known }));
        };
        let name = DeckBody::name_of(id);
        if !self.bodies.iter().any(|own| own.name == name) {
            self.spots.push((format!("bodies[{}]", self.bodies.len()), body.row));
            let own = self.body(body, &name)?;
            self.bodies.push(own);
        }
        if let (Attachment::Fixed, None, Some(own)) =
            (body.attachment, &clamp, self.bodies.iter().position(|own| own.name == name))
        {
            let place = self.bodies[own].place(&at).into();
            return Ok((place, None));
        }
        Ok(on_body(&name, at, clamp))
    }

    fn body(&mut self, body: &DeckBody, name: &str) -> Result<Body, Error> {
        let pose = Body { position: body.position, attitude_deg: scene_attitude(body.attitude), ..Body::plain(name) };
        if body.attachment != Attachment::Free {
            return Ok(pose);
        }
        let water = self.deck.options.water_density;
        let mut heap = Heap::default();
        heap.add(body.mass, body.centre, Matrix3::from_diagonal(&Vector3::from(body.inertia)));
        let mut wet = (body.volume, Vector3::from(body.centre) * body.volume);
        let mut added = [body.volume; 3];
        for (axis, added) in added.iter_mut().enumerate() {
            *added *= body.added_mass[axis] * water;
        }
        for point in self.deck.points.iter().filter(|point| point.attachment == Attachment::Body(body.id)) {
            if point.drag_area > 0.0 || point.added_mass * point.volume > 0.0 || point.force != [0.0; 3] {
                let reason = "drag, added mass and force of a point on a body are not modelled; give them to the body";
                return Err(self.cannot(point.row, "CdA, Ca, FX, FY, FZ", reason));
            }
            heap.add(point.mass, point.position, Matrix3::zeros());
            wet = (wet.0 + point.volume, wet.1 + Vector3::from(point.position) * point.volume);
        }
        let rods = self.deck.rods.iter().filter(|rod| rod.attachment == Attachment::Body(body.id) && !rod.is_point());
        let six = |diagonal: [f64; 3]| {
            let at = |row: usize, column: usize| if row == column && row < 3 { diagonal[row] } else { 0.0 };
            std::array::from_fn(|row| std::array::from_fn(|column| at(row, column)))
        };
        let drag = body.drag_area.map(|area| 0.5 * water * area);
        if drag.iter().any(|drag| *drag > 0.0) && self.deck.options.currents {
            self.warnings
                .push(format!("line {}: CdA of the body acts against its own motion; the current does not push it", body.row));
        }
        Ok(Body {
            motion: BodyMotion::Free,
            mass: heap.mass,
            centre_of_mass: heap.centre().into(),
            inertia: Some(heap.inertia()),
            cylinders: rods.map(|rod| self.cylinder(rod)).collect(),
            volume: wet.0,
            centre_of_buoyancy: if wet.0 > 0.0 { (wet.1 / wet.0).into() } else { [0.0; 3] },
            added_mass: (added != [0.0; 3]).then(|| six(added)),
            quadratic_damping: (drag != [0.0; 6]).then_some(drag),
            ..pose
        })
    }

    /// The cylinder that a rod is, in the axes in which its ends are given.
    fn cylinder(&self, rod: &DeckRod) -> Cylinder {
        let kind = &self.deck.rod_types[rod.kind];
        let length = (Vector3::from(rod.b) - Vector3::from(rod.a)).norm();
        Cylinder {
            from: rod.a,
            to: rod.b,
            diameter: kind.diameter,
            mass: kind.mass * length,
            drag: EndCoefficients { normal: kind.drag, tangential: 0.0, end: kind.end_drag },
            added_mass: EndCoefficients { normal: kind.added_mass, tangential: 0.0, end: kind.end_added_mass },
        }
    }

    fn vessel(&mut self) {
        if !self.bodies.iter().any(|body| body.name == VESSEL) {
            self.bodies.push(Body::plain(VESSEL));
        }
    }

    fn plain_body(&mut self, name: &str, row: usize) {
        if !self.bodies.iter().any(|body| body.name == name) {
            self.spots.push((format!("bodies[{}]", self.bodies.len()), row));
            self.bodies.push(Body::plain(name));
        }
    }

    /// Names what no line leads to, and loads that nothing here feels.
    fn without_lines(&mut self) {
        let named =
            |name: String| self.bodies.iter().any(|body| body.name == name) || self.points.iter().any(|point| point.name == name);
        let bodies = self.deck.bodies.iter().map(|body| (DeckBody::name_of(body.id), body.row, body.attachment));
        let points = self.deck.points.iter().map(|point| (DeckPoint::name_of(point.id), point.row, point.attachment));
        let rods = self.deck.rods.iter().filter(|rod| self.deck.joined(rod.id).is_none());
        let rods = rods.map(|rod| (DeckRod::name_of(rod.id), rod.row, rod.attachment));
        let lonely: Vec<String> = bodies
            .chain(points)
            .chain(rods)
            .filter(|(name, _, attachment)| *attachment == Attachment::Free && !named(name.clone()))
            .map(|(name, row, _)| format!("line {row}: no line leads to {name}, so it is left out"))
            .collect();
        self.warnings.extend(lonely);
        let held = |point: &&DeckPoint| {
            matches!(point.attachment, Attachment::Fixed | Attachment::Coupled) && (point.mass > 0.0 || point.volume > 0.0)
        };
        if let Some(point) = self.deck.points.iter().find(held) {
            self.warnings.push(format!(
                "line {}: mass and volume of a point that is held load what holds it, and no line; they are left out",
                point.row
            ));
        }
    }
}

fn on_body(name: &str, at: Triple, clamp: Option<Clamp>) -> (Triple, Option<Mount>) {
    ([0.0; 3], Some(Mount::Body { body: name.to_string(), at, clamp }))
}

/// Masses put together: their sum, first and second moments about the origin.
#[derive(Default)]
struct Heap {
    mass: f64,
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

impl Heap {
    /// Adds a mass at a place with the inertia about it.
    fn add(&mut self, mass: f64, at: Triple, inertia: Matrix3<f64>) {
        let at = Vector3::from(at);
        self.mass += mass;
        self.first += at * mass;
        self.second += inertia + (Matrix3::identity() * at.norm_squared() - at * at.transpose()) * mass;
    }

    fn centre(&self) -> Vector3<f64> {
        if self.mass > 0.0 { self.first / self.mass } else { Vector3::zeros() }
    }

    /// About the centre.
    fn inertia(&self) -> Inertia {
        let c = self.centre();
        let about = self.second - (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * self.mass;
        let off = [about[(0, 1)], about[(0, 2)], about[(1, 2)]];
        if off.iter().all(|x| x.abs() <= 1.0e-12 * about.amax()) {
            return Inertia::Principal(about.diagonal().into());
        }
        let half = |row: usize, column: usize| 0.5 * (about[(row, column)] + about[(column, row)]);
        Inertia::Full(std::array::from_fn(|row| std::array::from_fn(|column| half(row, column))))
    }
}
