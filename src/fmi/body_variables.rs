//! The variables of a body or a free point in an FMU: names, value references, limits and descriptions.
//!
//! Each body has a block of value references of its own, in the order of the names, so that the order in the file does not matter.

use crate::scene::types::Scene;
use std::f64::consts::TAU;

/// First value reference of bodies, and of points; each has `BLOCK` of them.
pub const FIRST_BODY: u32 = 1_000_000_000;
/// See `FIRST_BODY`.
pub const FIRST_POINT: u32 = 1_500_000_000;
/// See `FIRST_BODY`.
pub const BLOCK: u32 = 100;

/// Three components each, in this order: what a master says of a driven body, and what a free one says of itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Position of the reference point [m].
    Position,
    /// Roll, pitch and yaw [rad].
    Attitude,
    /// Velocity of the reference point [m/s].
    Velocity,
    /// Angular velocity [rad/s].
    AngularVelocity,
}

/// A component of an input of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyInput {
    /// Of its motion.
    Motion(Part, usize),
    /// Of the force [N] (0) or moment [N·m] (1) applied to it.
    Applied(usize, usize),
}

/// A component of an output of a body or point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyOutput {
    /// Of the force of the lines [N].
    Force(usize),
    /// Of their moment about the reference point [N·m].
    Moment(usize),
    /// Work done by the lines on it since the start [J].
    Work,
    /// Of the motion of a free body.
    Motion(Part, usize),
    /// Of position (0) or velocity (1) of a free point.
    Point(usize, usize),
}

/// A choice of axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// `axes`: 1 z-up, 2 ned.
    Axes,
    /// `rates`: 1 global, 2 body.
    Rates,
    /// `loads`: 1 global, 2 body.
    Loads,
}

/// What a variable of a body is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// An input.
    Input(BodyInput),
    /// An output.
    Output(BodyOutput),
    /// A parameter.
    Choice(Choice),
}

/// A row of the table of a body's variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name behind that of the body.
    pub stem: String,
    /// Number in the block.
    pub offset: u32,
    /// What it is.
    pub role: Role,
    /// Limits.
    pub limits: [f64; 2],
    /// Attributes of its FMI type.
    pub kind: &'static str,
    /// Description.
    pub description: String,
}

/// Steepest pitch [rad].
pub const STEEPEST: f64 = 89.0 / 360.0 * TAU;

const AXES: [&str; 3] = ["x", "y", "z"];
const ANGLES: [&str; 3] = ["roll", "pitch", "yaw"];
const PARTS: [(Part, &str, &str); 4] = [
    (Part::Position, "position", "Position of the reference point"),
    (Part::Attitude, "attitude", "Attitude: rotation Rz(yaw) Ry(pitch) Rx(roll), body to global"),
    (Part::Velocity, "velocity", "Velocity of the reference point"),
    (Part::AngularVelocity, "angular_velocity", "Angular velocity"),
];

/// The variables of a body that is driven, or free.
pub fn of_body(free: bool) -> Vec<Row> {
    let mut rows = Vec::new();
    for (number, (part, stem, words)) in PARTS.into_iter().enumerate() {
        for axis in 0..3 {
            let name = if part == Part::Attitude { ANGLES[axis] } else { AXES[axis] };
            let (limits, kind) = match part {
                Part::Position => ([-1.0e8, 1.0e8], "declaredType=\"Position\""),
                Part::Attitude if axis == 1 => {
                    ([-STEEPEST, STEEPEST], "declaredType=\"Angle\" min=\"-1.55334303427495\" max=\"1.55334303427495\"")
                }
                Part::Attitude => ([-1.0e6, 1.0e6], "declaredType=\"Angle\" min=\"-1000000\" max=\"1000000\""),
                Part::Velocity => ([-1.0e4, 1.0e4], "declaredType=\"Velocity\""),
                Part::AngularVelocity => {
                    ([-1.0e3, 1.0e3], "quantity=\"AngularVelocity\" unit=\"rad/s\" min=\"-1000\" max=\"1000\"")
                }
            };
            let role =
                if free { Role::Output(BodyOutput::Motion(part, axis)) } else { Role::Input(BodyInput::Motion(part, axis)) };
            let description = format!("{words}, {name}");
            rows.push(Row {
                stem: format!("{stem}.{name}"),
                offset: (3 * number + axis) as u32,
                role,
                limits,
                kind,
                description,
            });
        }
    }
    let row = |stem: String, offset: usize, role, kind, description: String| Row {
        stem,
        offset: offset as u32,
        role,
        limits: [-1.0e15, 1.0e15],
        kind,
        description,
    };
    let moment = "quantity=\"Torque\" unit=\"N.m\" displayUnit=\"kN.m\"";
    if free {
        for (number, (stem, kind, words)) in [
            ("applied_force", "declaredType=\"Force\" min=\"-1e15\" max=\"1e15\"", "Force applied to the reference point"),
            (
                "applied_moment",
                "quantity=\"Torque\" unit=\"N.m\" displayUnit=\"kN.m\" min=\"-1e15\" max=\"1e15\"",
                "Moment applied",
            ),
        ]
        .into_iter()
        .enumerate()
        {
            for axis in 0..3 {
                let role = Role::Input(BodyInput::Applied(number, axis));
                rows.push(row(
                    format!("{stem}.{}", AXES[axis]),
                    30 + 3 * number + axis,
                    role,
                    kind,
                    format!("{words}, {}", AXES[axis]),
                ));
            }
        }
    } else {
        for axis in 0..3 {
            let words = format!("Force of the lines on the body, {}", AXES[axis]);
            rows.push(row(
                format!("force.{}", AXES[axis]),
                20 + axis,
                Role::Output(BodyOutput::Force(axis)),
                "declaredType=\"Force\"",
                words,
            ));
        }
        for axis in 0..3 {
            let words = format!("Moment of the lines about the reference point, {}", AXES[axis]);
            rows.push(row(format!("moment.{}", AXES[axis]), 23 + axis, Role::Output(BodyOutput::Moment(axis)), moment, words));
        }
        let kind = "quantity=\"Energy\" unit=\"J\" displayUnit=\"kJ\"";
        let words = "Work done by the lines on the body since the start".to_owned();
        rows.push(row("work".to_owned(), 26, Role::Output(BodyOutput::Work), kind, words));
    }
    for (number, (stem, choice, kind, words)) in [
        (
            "axes",
            Choice::Axes,
            "declaredType=\"Axes\"",
            "Axes in which the master speaks of the body: z-up as the scene (body axes forward, port, up), or ned (x north, y east, z down; forward, \
             starboard, down), x of both the same",
        ),
        ("rates", Choice::Rates, "declaredType=\"Frame\"", "Axes along which velocity and angular velocity come in or go out"),
        ("loads", Choice::Loads, "declaredType=\"Frame\"", "Axes along which force and moment go out or come in"),
    ]
    .into_iter()
    .enumerate()
    {
        rows.push(Row {
            stem: stem.to_owned(),
            offset: 40 + number as u32,
            role: Role::Choice(choice),
            limits: [1.0, 2.0],
            kind,
            description: words.to_owned(),
        });
    }
    rows
}

/// The variables of a free point.
pub fn of_point() -> Vec<Row> {
    let mut rows = Vec::new();
    for (number, (stem, kind, words)) in [
        ("position", "declaredType=\"Position\"", "Position of the point"),
        ("velocity", "declaredType=\"Velocity\"", "Velocity of the point"),
    ]
    .into_iter()
    .enumerate()
    {
        for axis in 0..3 {
            rows.push(Row {
                stem: format!("{stem}.{}", AXES[axis]),
                offset: (3 * number + axis) as u32,
                role: Role::Output(BodyOutput::Point(number, axis)),
                limits: [-1.0e15, 1.0e15],
                kind,
                description: format!("{words}, {}", AXES[axis]),
            });
        }
    }
    rows
}

impl Row {
    /// Whether it is an integer; an enumeration is one.
    pub fn is_choice(&self) -> bool {
        matches!(self.role, Role::Choice(_))
    }

    /// Its element of modelDescription.xml.
    pub fn element(&self, name: &str, reference: u32, start: f64) -> String {
        let attributes = match self.role {
            Role::Input(_) => "causality=\"input\" variability=\"continuous\"",
            Role::Output(_) => "causality=\"output\" variability=\"continuous\" initial=\"calculated\"",
            Role::Choice(_) => "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
        };
        let (tag, start) = match self.role {
            Role::Input(_) => ("Real", format!(" start=\"{start}\"")),
            Role::Output(_) => ("Real", String::new()),
            Role::Choice(_) => ("Enumeration", format!(" start=\"{start}\"")),
        };
        format!(
            "    <ScalarVariable name=\"{name}\" valueReference=\"{reference}\" {attributes} description=\"{}\">\n      <{tag} {}{start}/>\n    \
             </ScalarVariable>\n",
            self.description, self.kind
        )
    }
}

/// First value reference of a body of a scene: by the rank of its name.
pub fn block_of_body(scene: &Scene, body: usize) -> u32 {
    let name = &scene.bodies[body].name;
    FIRST_BODY + BLOCK * scene.bodies.iter().filter(|other| other.name < *name).count() as u32
}

/// First value reference of a point.
pub fn block_of_point(scene: &Scene, point: usize) -> u32 {
    let name = &scene.points[point].name;
    FIRST_POINT + BLOCK * scene.points.iter().filter(|other| other.name < *name).count() as u32
}

/// In which axes a master speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Conventions {
    /// North, east, down.
    pub ned: bool,
    /// Velocities along the axes of the body.
    pub body_rates: bool,
    /// Force and moment along the axes of the body.
    pub body_loads: bool,
}

impl Conventions {
    /// A vector from the master's axes to the scene's, or back.
    pub fn turned(&self, x: [f64; 3]) -> [f64; 3] {
        if self.ned { [x[0], -x[1], -x[2]] } else { x }
    }
}

/// What a master says of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Said {
    /// Position, attitude, velocity and angular velocity, as given.
    pub values: [[f64; 3]; 4],
    /// Time derivatives of order 1 and 2 of position and attitude, where they are set for the step to come: `[order - 1][part][axis]`.
    pub derivatives: [[[Option<f64>; 3]; 2]; 2],
    /// Force and moment applied to a free body, as given.
    pub applied: [[f64; 3]; 2],
}

/// Number of a part among what is said.
pub fn number_of(part: Part) -> usize {
    match part {
        Part::Position => 0,
        Part::Attitude => 1,
        Part::Velocity => 2,
        Part::AngularVelocity => 3,
    }
}
