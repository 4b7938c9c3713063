//! The variables of the FMU and what each of them means.
//!
//! Names, value references and limits come from `modelDescription/modelDescription.xml` through `build.rs`; the meaning stands here, in
//! matches over every variable: parameter → field of the scene, input → component of the fairlead's motion, output → field of `Outputs`.

use crate::fmi::body_variables::{self, BodyInput, BodyOutput, Choice, Conventions, Role, Row, Said};
use crate::scene::types::{LineType, Scene, Scheme, Section};
use crate::solve::simulation::{LastStep, Outputs};
use serde_json::Value;

include!(concat!(env!("OUT_DIR"), "/variables.rs"));

/// The description of the interface as it stands for the built-in scene.
pub const MODEL_DESCRIPTION: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/modelDescription/modelDescription.xml"));

/// First value reference of the quantities that a packed scene exposes under its own names.
const FIRST_SCENE_REFERENCE: u32 = 1000;

/// Of several lines, line number n has the value references n·STRIDE + those of a single line.
pub const STRIDE: u32 = 1_000_000;

/// Most lines of an FMU.
pub const MOST_LINES: usize = 1000;

/// One row of the generated table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Definition {
    /// Name, such as `line.length`.
    pub name: &'static str,
    /// Value reference, unique over all types.
    pub reference: u32,
    /// What it is.
    pub meaning: Meaning,
    /// Its FMI type; an enumeration is an Integer.
    pub kind: Kind,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// Start value in the file; 0 where there is none.
    pub start: f64,
}

/// FMI type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// fmi2Real.
    Real,
    /// fmi2Integer; enumerations too.
    Integer,
}

/// What a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Set by the master at every communication point.
    Input(Input),
    /// Computed.
    Output(Output),
    /// Computed, about the solver.
    Local(Local),
    /// Set before or in initialization mode.
    Parameter(Parameter),
    /// Set by the master, of a body.
    BodyInput(BodyInput),
    /// Computed, of a body or point.
    BodyOutput(BodyOutput),
    /// A choice of axes of a body, set like a parameter.
    Choice(Choice),
    /// Number `.0` of the scene's own quantities (`Interface::places`), set like a parameter.
    Place(usize),
}

/// A variable of one FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name; of several lines, with the line's in front.
    pub name: String,
    /// Name in modelDescription.xml; empty for the scene's own quantities, and for those of bodies and points.
    pub stem: &'static str,
    /// Number of the line, body or point it belongs to; 0 for what all lines share.
    pub line: usize,
    /// Value reference.
    pub reference: u32,
    /// What it is.
    pub meaning: Meaning,
    /// Its FMI type.
    pub kind: Kind,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// Start value; 0 where it is computed.
    pub start: f64,
    /// Number among the parameters, in the order of the description; for all others 0.
    pub slot: usize,
}

impl Variable {
    /// Whether it is a parameter of the line and its surroundings, under whatever name.
    pub fn is_of_scene(&self) -> bool {
        match self.meaning {
            Meaning::Place(_) => true,
            Meaning::Parameter(parameter) => parameter.belongs_to_single_section(),
            _ => false,
        }
    }

    /// Whether it is set like a parameter.
    pub fn is_parameter(&self) -> bool {
        matches!(self.meaning, Meaning::Parameter(_) | Meaning::Place(_) | Meaning::Choice(_))
    }

    /// Whether it is an input, and whether it is an output.
    pub fn is_input(&self) -> bool {
        matches!(self.meaning, Meaning::Input(_) | Meaning::BodyInput(_))
    }

    /// Whether it is an output.
    pub fn is_output(&self) -> bool {
        matches!(self.meaning, Meaning::Output(_) | Meaning::BodyOutput(_))
    }
}

/// What moves the fairlead between communication points (`input.interpolation`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// Extrapolates what was sent so far; recognises a master that never sets velocities.
    #[default]
    Auto,
    /// As `Auto`, but takes velocities as they are given.
    Extrapolate,
    /// Moves with the last velocity.
    HoldVelocity,
    /// Interpolates one communication step late.
    Delay,
}

/// What the parameters describe: the scene, and how inputs are interpolated.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The scene.
    pub scene: Scene,
    /// The interpolation.
    pub interpolation: Interpolation,
    /// Cut-off of the filter of the positions [Hz]; 0: none.
    pub filter: f64,
}

/// A place in the settings that a parameter reads and writes.
enum Field<'a> {
    Real(&'a mut f64),
    Elements(&'a mut Option<usize>),
    Scheme(&'a mut Scheme),
    Interpolation(&'a mut Interpolation),
}

impl Parameter {
    /// The parameter of which this is another name.
    fn twin(self) -> Option<Parameter> {
        match self {
            Parameter::SolverSchemeIndex => Some(Parameter::SolverScheme),
            Parameter::InputInterpolationIndex => Some(Parameter::InputInterpolation),
            _ => None,
        }
    }

    /// The field of the settings that this parameter is, of line number `line` where each has its own.
    /// `None`: there is no such line.
    fn field(self, settings: &mut Settings, line: usize) -> Option<Field<'_>> {
        use Field::{Elements, Interpolation, Real};
        let Settings { scene, interpolation, filter } = settings;
        Some(match self {
            Parameter::SolverScheme | Parameter::SolverSchemeIndex => Field::Scheme(&mut scene.solver.scheme),
            Parameter::SolverTolerance => Real(&mut scene.solver.tolerance),
            Parameter::SolverMaxStep => Real(&mut scene.solver.max_step),
            Parameter::InputInterpolation | Parameter::InputInterpolationIndex => Interpolation(interpolation),
            Parameter::InputFilter => Real(filter),
            Parameter::LineLength => Real(&mut section(scene, line)?.length),
            Parameter::LineElements => Elements(&mut section(scene, line)?.elements),
            Parameter::LineEa => Real(&mut line_type(scene, line)?.ea),
            Parameter::LineEi => Real(&mut line_type(scene, line)?.ei),
            Parameter::LineMass => Real(&mut line_type(scene, line)?.mass),
            Parameter::LineSubmergedWeight => Real(line_type(scene, line)?.submerged_weight.get_or_insert(0.0)),
            Parameter::LineDiameter => Real(&mut line_type(scene, line)?.diameter),
            Parameter::LineDragNormal => Real(&mut line_type(scene, line)?.drag.normal),
            Parameter::LineDragTangential => Real(&mut line_type(scene, line)?.drag.tangential),
            Parameter::LineAddedMassNormal => Real(&mut line_type(scene, line)?.added_mass.normal),
            Parameter::LineAddedMassTangential => Real(&mut line_type(scene, line)?.added_mass.tangential),
            Parameter::LineDamping => Real(&mut line_type(scene, line)?.damping),
            Parameter::AnchorPositionX => Real(&mut scene.lines.get_mut(line)?.anchor[0]),
            Parameter::AnchorPositionY => Real(&mut scene.lines.get_mut(line)?.anchor[1]),
            Parameter::AnchorPositionZ => Real(&mut scene.lines.get_mut(line)?.anchor[2]),
            Parameter::WaterDepth => Real(&mut scene.environment.depth),
            Parameter::WaterDensity => Real(&mut scene.environment.water_density),
            Parameter::SeabedStiffness => Real(scene.environment.seabed.stiffness.get_or_insert(0.0)),
            Parameter::SeabedDamping => Real(&mut scene.environment.seabed.damping),
            Parameter::SeabedFriction => Real(&mut scene.environment.seabed.friction),
            Parameter::Gravity => Real(&mut scene.environment.gravity),
        })
    }

    /// The place of that field in the scene, as error messages name it.
    fn place(self, scene: &Scene, line: usize) -> String {
        let section = scene.lines.get(line).and_then(|line| line.sections.first());
        let of_section = |key: &str| format!("lines[{line}].sections[0].{key}");
        let of_type = |key: &str| format!("line_types.{}.{key}", section.map_or("", |section| &section.line_type));
        match self {
            Parameter::SolverScheme | Parameter::SolverSchemeIndex => "solver.scheme".to_owned(),
            Parameter::SolverTolerance => "solver.tolerance".to_owned(),
            Parameter::SolverMaxStep => "solver.max_step".to_owned(),
            Parameter::InputInterpolation | Parameter::InputInterpolationIndex => "input.interpolation".to_owned(),
            Parameter::InputFilter => "input.filter".to_owned(),
            Parameter::LineLength => of_section("length"),
            Parameter::LineElements => of_section("elements"),
            Parameter::LineEa => of_type("ea"),
            Parameter::LineEi => of_type("ei"),
            Parameter::LineMass => of_type("mass"),
            Parameter::LineSubmergedWeight => of_type("submerged_weight"),
            Parameter::LineDiameter => of_type("diameter"),
            Parameter::LineDragNormal => of_type("drag.normal"),
            Parameter::LineDragTangential => of_type("drag.tangential"),
            Parameter::LineAddedMassNormal => of_type("added_mass.normal"),
            Parameter::LineAddedMassTangential => of_type("added_mass.tangential"),
            Parameter::LineDamping => of_type("damping"),
            Parameter::WaterDepth => "environment.depth".to_owned(),
            Parameter::WaterDensity => "environment.water_density".to_owned(),
            Parameter::SeabedStiffness => "environment.seabed.stiffness".to_owned(),
            Parameter::SeabedDamping => "environment.seabed.damping".to_owned(),
            Parameter::SeabedFriction => "environment.seabed.friction".to_owned(),
            Parameter::Gravity => "environment.gravity".to_owned(),
            Parameter::AnchorPositionX | Parameter::AnchorPositionY | Parameter::AnchorPositionZ => {
                format!("lines[{line}].anchor")
            }
        }
    }

    /// Whether each line has its own; all others are shared.
    fn belongs_to_line(self) -> bool {
        match self {
            Parameter::SolverScheme
            | Parameter::SolverSchemeIndex
            | Parameter::InputInterpolationIndex
            | Parameter::InputFilter
            | Parameter::SolverTolerance
            | Parameter::SolverMaxStep
            | Parameter::InputInterpolation
            | Parameter::WaterDepth
            | Parameter::WaterDensity
            | Parameter::SeabedStiffness
            | Parameter::SeabedDamping
            | Parameter::SeabedFriction
            | Parameter::Gravity => false,
            Parameter::LineLength
            | Parameter::LineElements
            | Parameter::LineEa
            | Parameter::LineEi
            | Parameter::LineMass
            | Parameter::LineSubmergedWeight
            | Parameter::LineDiameter
            | Parameter::LineDragNormal
            | Parameter::LineDragTangential
            | Parameter::LineAddedMassNormal
            | Parameter::LineAddedMassTangential
            | Parameter::LineDamping
            | Parameter::AnchorPositionX
            | Parameter::AnchorPositionY
            | Parameter::AnchorPositionZ => true,
        }
    }
}

impl Meaning {
    /// Whether each line has its own; all others are shared.
    fn belongs_to_line(self) -> bool {
        match self {
            Meaning::Input(_) | Meaning::Output(_) | Meaning::Local(_) => true,
            Meaning::Parameter(parameter) => parameter.belongs_to_line(),
            Meaning::Place(_) | Meaning::BodyInput(_) | Meaning::BodyOutput(_) | Meaning::Choice(_) => false,
        }
    }
}

fn section(scene: &mut Scene, line: usize) -> Option<&mut Section> {
    scene.lines.get_mut(line)?.sections.first_mut()
}

fn line_type(scene: &mut Scene, line: usize) -> Option<&mut LineType> {
    let name = &scene.lines.get(line)?.sections.first()?.line_type;
    scene.line_types.get_mut(name)
}

impl Field<'_> {
    fn read(&self) -> f64 {
        match self {
            Field::Real(value) => **value,
            Field::Elements(elements) => elements.unwrap_or(0) as f64,
            Field::Scheme(scheme) => match scheme {
                Scheme::AdamsMoulton => 1.0,
                Scheme::Esdirk3 => 2.0,
                Scheme::GeneralizedAlpha => 3.0,
                Scheme::Cable1994 => 4.0,
            },
            Field::Interpolation(interpolation) => match interpolation {
                Interpolation::Auto => 1.0,
                Interpolation::Extrapolate => 2.0,
                Interpolation::HoldVelocity => 3.0,
                Interpolation::Delay => 4.0,
            },
        }
    }

    /// Writes a value that the limits of the description allow.
    fn write(self, value: f64) {
        match self {
            Field::Real(field) => *field = value,
            Field::Elements(elements) => *elements = if value >= 1.0 { Some(value as usize) } else { None },
            Field::Scheme(scheme) => {
                *scheme = match value as u8 {
                    2 => Scheme::Esdirk3,
                    3 => Scheme::GeneralizedAlpha,
                    4 => Scheme::Cable1994,
                    _ => Scheme::AdamsMoulton,
                }
            }
            Field::Interpolation(interpolation) => {
                *interpolation = match value as u8 {
                    2 => Interpolation::Extrapolate,
                    3 => Interpolation::HoldVelocity,
                    4 => Interpolation::Delay,
                    _ => Interpolation::Auto,
                }
            }
        }
    }
}

/// Which component of the fairlead's motion an input is: 0 position, 1 velocity; and the axis.
impl Input {
    /// (order of the time derivative, axis).
    pub fn component(self) -> (usize, usize) {
        match self {
            Input::FairleadPositionX => (0, 0),
            Input::FairleadPositionY => (0, 1),
            Input::FairleadPositionZ => (0, 2),
            Input::FairleadVelocityX => (1, 0),
            Input::FairleadVelocityY => (1, 1),
            Input::FairleadVelocityZ => (1, 2),
        }
    }
}

impl Output {
    /// The field of `Outputs` that this output is; of their rates and derivatives alike.
    pub fn of(self, outputs: &Outputs) -> f64 {
        match self {
            Output::Tension => outputs.tension,
            Output::ForceX => outputs.force.x,
            Output::ForceY => outputs.force.y,
            Output::ForceZ => outputs.force.z,
            Output::AnchorTension => outputs.anchor_tension,
            Output::AnchorForceX => outputs.anchor_force.x,
            Output::AnchorForceY => outputs.anchor_force.y,
            Output::AnchorForceZ => outputs.anchor_force.z,
            Output::TensionMax => outputs.tension_max,
            Output::Declination => outputs.declination,
            Output::Azimuth => outputs.azimuth,
            Output::GroundedLength => outputs.grounded_length,
            Output::Work => outputs.work,
        }
    }
}

impl Local {
    /// The field of `LastStep` that this variable is.
    pub fn of(self, last: &LastStep) -> f64 {
        match self {
            Local::SolverSubsteps => last.substeps as f64,
            Local::SolverNewtonIterations => last.newton_iterations as f64,
            Local::SolverErrorEstimate => last.error_estimate,
        }
    }
}

/// The variables of the FMU of one scene.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The scene with its weights and seabed stiffness made explicit where they are parameters.
    settings: Settings,
    /// All variables, by rising value reference.
    variables: Vec<Variable>,
    /// JSON pointers of the quantities exposed under the scene's own names.
    places: Vec<String>,
    /// Number of parameters.
    parameters: usize,
}

impl Interface {
    /// The interface of a scene. Lines of one section without attachments, in still water, have the parameters `line.…`, `anchor.…`,
    /// `water.…`, `seabed.…`; any other scene exposes its quantities under its own names. Of several lines, each has its variables with
    /// its name in front.
    pub fn new(scene: &Scene) -> Interface {
        let scene_names = uses_scene_names(scene);
        let mut settings = Settings { scene: scene.clone(), interpolation: Interpolation::default(), filter: 0.0 };
        if !scene_names {
            make_explicit(&mut settings.scene);
        }
        let mut interface = Interface { settings, variables: Vec::new(), places: Vec::new(), parameters: 0 };
        for line in 0..scene.lines.len().min(MOST_LINES) {
            for definition in DEFINITIONS.iter().filter(|definition| line == 0 || definition.meaning.belongs_to_line()) {
                interface.add_definition(definition, line, scene_names);
            }
            if line == 0 && scene_names {
                interface.add_places();
            }
        }
        interface.add_bodies(scene);
        interface
    }

    /// The variables of bodies and free points, by rising value reference.
    fn add_bodies(&mut self, scene: &Scene) {
        let mut blocks: Vec<(u32, usize, String, Vec<Row>)> = Vec::new();
        for (index, body) in scene.bodies.iter().enumerate() {
            let rows = body_variables::of_body(body.is_free());
            blocks.push((body_variables::block_of_body(scene, index), index, identifier(&body.name), rows));
        }
        for (index, point) in scene.points.iter().enumerate().filter(|(_, point)| point.is_free()) {
            blocks.push((
                body_variables::block_of_point(scene, index),
                index,
                identifier(&point.name),
                body_variables::of_point(),
            ));
        }
        blocks.sort_by_key(|(first, ..)| *first);
        for (first, index, name, rows) in blocks {
            for row in rows {
                let (meaning, start) = match row.role {
                    Role::Input(input) => (Meaning::BodyInput(input), said_first(scene, index, input)),
                    Role::Output(output) => (Meaning::BodyOutput(output), 0.0),
                    Role::Choice(choice) => (Meaning::Choice(choice), 1.0),
                };
                let kind = if row.is_choice() { Kind::Integer } else { Kind::Real };
                let slot = if row.is_choice() { self.parameters } else { 0 };
                self.parameters += usize::from(row.is_choice());
                self.variables.push(Variable {
                    name: format!("{name}.{}", row.stem),
                    stem: "",
                    line: index,
                    reference: first + row.offset,
                    meaning,
                    kind,
                    min: row.limits[0],
                    max: row.limits[1],
                    start,
                    slot,
                });
            }
        }
    }

    /// In which axes the master speaks of each body.
    pub fn conventions(&self, values: &[f64]) -> Vec<Conventions> {
        let mut conventions = vec![Conventions::default(); self.settings.scene.bodies.len()];
        for variable in &self.variables {
            let Meaning::Choice(choice) = variable.meaning else { continue };
            let second = values.get(variable.slot).is_some_and(|value| *value == 2.0);
            let of = &mut conventions[variable.line];
            match choice {
                Choice::Axes => of.ned = second,
                Choice::Rates => of.body_rates = second,
                Choice::Loads => of.body_loads = second,
            }
        }
        conventions
    }

    /// What a master says of each body before it says anything.
    pub fn said_first(&self) -> Vec<Said> {
        let mut said = vec![Said::default(); self.settings.scene.bodies.len()];
        for variable in &self.variables {
            if let Meaning::BodyInput(BodyInput::Motion(part, axis)) = variable.meaning {
                said[variable.line].values[body_variables::number_of(part)][axis] = variable.start;
            }
        }
        said
    }

    fn add_definition(&mut self, definition: &Definition, line: usize, scene_names: bool) {
        let mut start = definition.start;
        let mut slot = 0;
        let hung = self.settings.scene.lines.get(line).is_some_and(|line| line.fairlead_on.is_some());
        if hung && matches!(definition.meaning, Meaning::Input(_)) {
            return;
        }
        match definition.meaning {
            Meaning::Parameter(parameter) => {
                if scene_names && parameter.belongs_to_single_section() {
                    return;
                }
                if let Some(field) = parameter.field(&mut self.settings, line) {
                    start = field.read();
                }
                // The same choice by another name is the same value.
                let twin = parameter
                    .twin()
                    .and_then(|twin| self.variables.iter().find(|other| other.meaning == Meaning::Parameter(twin)));
                slot = twin.map_or(self.parameters, |twin| twin.slot);
                self.parameters += usize::from(twin.is_none());
            }
            Meaning::Input(input) => {
                if let ((0, axis), Some(line)) = (input.component(), self.settings.scene.lines.get(line)) {
                    start = line.fairlead[axis];
                }
            }
            _ => {}
        }
        let Definition { name: stem, reference, meaning, kind, min, max, .. } = *definition;
        let prefix = if meaning.belongs_to_line() { self.prefix(line) } else { String::new() };
        let (name, reference) = (prefix + stem, line as u32 * STRIDE + reference);
        self.variables.push(Variable { name, stem, line, reference, meaning, kind, min, max, start, slot });
    }

    /// What stands in front of the names of a line's variables: nothing where there is one line alone.
    pub fn prefix(&self, line: usize) -> String {
        match &self.settings.scene.lines[..] {
            lines if lines.len() > 1 => lines.get(line).map_or_else(String::new, |line| identifier(&line.name) + "."),
            _ => String::new(),
        }
    }

    /// What stands in front of the names of a body's variables.
    pub fn body_prefix(&self, body: usize) -> String {
        self.settings.scene.bodies.get(body).map_or_else(String::new, |body| identifier(&body.name) + ".")
    }

    /// Number of lines.
    pub fn lines(&self) -> usize {
        self.settings.scene.lines.len()
    }

    /// Every number of the scene but those that have a variable already (fairlead, solver) and those that only a run uses.
    fn add_places(&mut self) {
        let Ok(scene) = serde_json::to_value(&self.settings.scene) else { return };
        for part in ["environment", "line_types", "lines", "bodies", "points"] {
            if let Some(value) = scene.get(part) {
                self.add_numbers(value, part.to_owned(), format!("/{part}"));
            }
        }
    }

    fn add_numbers(&mut self, value: &Value, name: String, pointer: String) {
        match value {
            Value::Number(number) => {
                let kind = if number.is_f64() { Kind::Real } else { Kind::Integer };
                let reference = FIRST_SCENE_REFERENCE + self.places.len() as u32;
                let meaning = Meaning::Place(self.places.len());
                let (min, max) = if kind == Kind::Real { (-1e15, 1e15) } else { (0.0, i32::MAX as f64) };
                let start = number.as_f64().unwrap_or(0.0);
                let (stem, line, slot) = ("", 0, self.parameters);
                self.variables.push(Variable { name, stem, line, reference, meaning, kind, min, max, start, slot });
                self.parameters += 1;
                self.places.push(pointer);
            }
            Value::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.add_numbers(item, format!("{name}[{index}]"), format!("{pointer}/{index}"));
                }
            }
            Value::Object(entries) => {
                for (key, item) in entries.iter().filter(|(key, _)| !INPUTS.contains(&key.as_str())) {
                    let token = key.replace('~', "~0").replace('/', "~1");
                    self.add_numbers(item, format!("{name}.{}", identifier(key)), format!("{pointer}/{token}"));
                }
            }
            Value::Null | Value::Bool(_) | Value::String(_) => {}
        }
    }

    /// All variables, by rising value reference.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The variable of a value reference.
    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        let index = self.variables.binary_search_by_key(&reference, |variable| variable.reference).ok()?;
        self.variables.get(index)
    }

    /// The scene of the start values.
    pub fn scene(&self) -> &Scene {
        &self.settings.scene
    }

    /// Whether quantities go under the scene's own names.
    pub fn has_scene_names(&self) -> bool {
        !self.places.is_empty()
    }

    /// Start values of all parameters, by slot.
    pub fn start_values(&self) -> Vec<f64> {
        let mut values = vec![0.0; self.parameters];
        for variable in &self.variables {
            if variable.is_parameter() {
                values[variable.slot] = variable.start;
            }
        }
        values
    }

    /// The settings that values of the parameters describe, by slot. `Err` names a value that the scene cannot take.
    pub fn settings(&self, values: &[f64]) -> Result<Settings, String> {
        let mut settings = self.settings.clone();
        let mut tree = Value::Null;
        for (variable, value) in self.variables.iter().filter_map(|variable| Some((variable, *values.get(variable.slot)?))) {
            match variable.meaning {
                Meaning::Parameter(parameter) => {
                    if let Some(field) = parameter.field(&mut settings, variable.line) {
                        field.write(value);
                    }
                }
                Meaning::Place(place) if value != variable.start => {
                    if tree.is_null() {
                        tree = serde_json::to_value(&settings.scene).map_err(|error| error.to_string())?;
                    }
                    if let Some(number) = self.places.get(place).and_then(|pointer| tree.pointer_mut(pointer)) {
                        *number = if variable.kind == Kind::Integer { Value::from(value as u64) } else { Value::from(value) };
                    }
                }
                _ => {}
            }
        }
        if !tree.is_null() {
            let solver = settings.scene.solver.clone();
            settings.scene = serde_json::from_value(tree).map_err(|error| error.to_string())?;
            settings.scene.solver = solver;
        }
        settings.scene.place_ends();
        Ok(settings)
    }

    /// The variable that a place of the scene (as in `Error::Value`) speaks of; the place itself where none does.
    pub fn variable_at(&self, place: &str) -> String {
        let speaks_of = |own: &str| place.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
        if let Some(line) = (0..self.lines()).find(|line| speaks_of(&format!("lines[{line}].fairlead"))) {
            return self.prefix(line) + "fairlead.position";
        }
        let mut named = self.parameters_with_places();
        let name = named.find(|(_, own)| speaks_of(own)).map_or(place, |(variable, _)| variable.name.as_str());
        name.strip_suffix(".x").unwrap_or(name).to_owned()
    }

    /// A message of the layers below with places of the scene replaced by the variables that stand for them.
    pub fn in_own_words(&self, text: String) -> String {
        self.parameters_with_places().fold(text, |text, (variable, place)| text.replace(&place, &variable.name))
    }

    /// The parameters with a name of their own, and the places of the scene that they are.
    fn parameters_with_places(&self) -> impl Iterator<Item = (&Variable, String)> {
        self.variables.iter().filter_map(|variable| match variable.meaning {
            Meaning::Parameter(parameter) => Some((variable, parameter.place(&self.settings.scene, variable.line))),
            _ => None,
        })
    }
}

impl Parameter {
    /// Whether the parameter speaks of *the* line, which a scene of several sections does not have.
    fn belongs_to_single_section(self) -> bool {
        !matches!(
            self,
            Parameter::SolverScheme
                | Parameter::SolverSchemeIndex
                | Parameter::SolverTolerance
                | Parameter::SolverMaxStep
                | Parameter::InputInterpolation
                | Parameter::InputInterpolationIndex
                | Parameter::InputFilter
        )
    }
}

/// Whether a scene's quantities go under its own names: several sections, free bodies, points, attachments, waves or current, or lines that leave the stiffness
/// of the bed to defaults that differ.
fn uses_scene_names(scene: &Scene) -> bool {
    let plain =
        scene.lines.iter().all(|line| line.sections.len() == 1 && line.attachments.is_empty() && line.constraints.is_empty());
    let mut types = scene.lines.iter().filter_map(|line| scene.line_types.get(&line.sections.first()?.line_type));
    let first = types.next().map(|line_type| bed_stiffness(scene, line_type));
    let one_bed = scene.environment.seabed.stiffness.is_some() || types.all(|other| Some(bed_stiffness(scene, other)) == first);
    let meets = !scene.points.is_empty() || scene.lines.iter().any(|line| line.anchor_on.is_some());
    let free = scene.bodies.iter().any(crate::scene::bodies::Body::is_free);
    !plain
        || meets
        || free
        || !one_bed
        || scene.environment.waves.is_some()
        || scene.environment.current_over_time.is_some()
        || !scene.environment.current.is_empty()
}

/// Keys of the scene whose numbers are inputs.
const INPUTS: [&str; 3] = ["fairlead", "position", "attitude_deg"];

/// Start value of an input of a body: its pose in the scene.
fn said_first(scene: &Scene, body: usize, input: BodyInput) -> f64 {
    match input {
        BodyInput::Motion(body_variables::Part::Position, axis) => scene.bodies[body].position[axis],
        BodyInput::Motion(body_variables::Part::Attitude, axis) => scene.bodies[body].attitude_deg[axis].to_radians(),
        BodyInput::Motion(..) | BodyInput::Applied(..) => 0.0,
    }
}

/// The stiffness of the bed under a line, where the scene gives none [Pa].
fn bed_stiffness(scene: &Scene, line_type: &LineType) -> f64 {
    let weight = line_type.weight_in_water(scene.environment.water_density, scene.environment.gravity);
    let sinking = if weight > 0.0 { weight } else { line_type.mass * scene.environment.gravity };
    sinking / line_type.diameter
}

/// Writes down what the scene leaves to defaults that depend on other quantities, and gives each of several lines a type of its own, so
/// that every parameter has a value of its own.
fn make_explicit(scene: &mut Scene) {
    let (density, gravity) = (scene.environment.water_density, scene.environment.gravity);
    if let Some(line_type) = line_type(scene, 0).map(|line_type| line_type.clone()) {
        let stiffness = bed_stiffness(scene, &line_type);
        scene.environment.seabed.stiffness.get_or_insert(stiffness);
    }
    let several = scene.lines.len() > 1;
    let shared = scene.line_types.clone();
    if several {
        scene.line_types.clear();
    }
    for line in &mut scene.lines {
        let Some(section) = line.sections.first_mut() else { continue };
        let Some(mut line_type) = shared.get(&section.line_type).cloned() else { continue };
        line_type.submerged_weight = Some(line_type.weight_in_water(density, gravity));
        line_type.buoyancy = None;
        if several {
            section.line_type.clone_from(&line.name);
        }
        scene.line_types.insert(section.line_type.clone(), line_type);
    }
}

/// A key of the scene as a part of a structured FMI name, which the standard wants in ASCII: as it is, transliterated (`Ø` is `O`), and quoted where it
/// is no identifier.
fn identifier(key: &str) -> String {
    let key = &deunicode::deunicode(key);
    let plain = key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !key.starts_with(|c: char| c.is_ascii_digit());
    if plain && !key.is_empty() {
        return key.to_owned();
    }
    format!("'{}'", key.replace('\\', "\\\\").replace('\'', "\\'"))
}
