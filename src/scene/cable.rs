//! A CABLE file (Ma & Webster 1994): what it says, in its own axes, and the way to the scene's axes.
//!
//! In the file y points up and z to the right of someone who looks along +x with y up; in the scene z points up. The way between
//! the two is a quarter turn about x, so that what is right stays right:
//!
//! ```text
//! scene (x, y, z) = (x, -z, y) of the file
//! ```
//!
//! The limits of 1994 (50 nodes, 10 types) are gone; the columns are those of the program's FORMAT statements, repaired
//! (`columns.rs`).

mod columns;
pub mod forced_motion;
pub mod from_scene;
pub mod reading;
pub mod to_scene;
pub mod writing;

use crate::scene::types::Triple;

/// Springs of at least this [N/m] hold their direction fast.
pub const LOCK: f64 = 1.0e10;

/// What the job of a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Job {
    /// JOB = 1.
    Statics,
    /// JOB = 2.
    Dynamics,
}

/// How the first node moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// JMOTN = 1: as the sinusoids of the constraints say.
    Sinusoidal,
    /// JMOTN = 2: as a file of velocities says.
    Forced,
}

/// A CABLE file, in its own axes (y up) and units (taken as SI).
#[derive(Debug, Clone, PartialEq)]
pub struct Deck {
    /// First line.
    pub title: String,
    /// NDIM: 2 or 3.
    pub dimensions: usize,
    /// JOB.
    pub job: Job,
    /// JSNAP: every how many iterations or steps the file `snapshot` gets one; 0: never.
    pub snapshot_every: usize,
    /// JMOTN.
    pub motion: MotionKind,
    /// RELAX, the share of each step that the 1994 statics takes.
    pub relaxation: f64,
    /// DAMP, the time constant of axial damping [s].
    pub damping: f64,
    /// ITER, iterations of the 1994 statics.
    pub iterations: usize,
    /// TBGN [s].
    pub begin: f64,
    /// TEND [s].
    pub end: f64,
    /// TSTEP [s].
    pub step: f64,
    /// CD [-].
    pub drag: f64,
    /// CM, the added-mass coefficient [-].
    pub added_mass: f64,
    /// RUF [kg/m³].
    pub water_density: f64,
    /// RUI [kg/m³].
    pub inner_density: f64,
    /// G [m/s²].
    pub gravity: f64,
    /// BTMDPTH, y of the bottom [m], below zero.
    pub bottom: f64,
    /// Element types.
    pub types: Vec<ElementType>,
    /// Nodes from the top end.
    pub nodes: Vec<DeckNode>,
    /// Elements from the top end, one fewer than nodes.
    pub elements: Vec<DeckElement>,
    /// Constrained nodes.
    pub constraints: Vec<NodeConstraint>,
    /// Currents: y [m] and the velocity there [m/s].
    pub currents: Vec<(f64, Triple)>,
    /// AW [m]; 0: no waves.
    pub wave_amplitude: f64,
    /// SIGMAW [rad/s].
    pub wave_frequency: f64,
    /// DIRW, direction of travel from x towards z [rad].
    pub wave_direction: f64,
}

/// One element type; a triple is the values at the first end, the middle and the second end of an element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementType {
    /// Name, where the text phrase of its first line has one.
    pub name: Option<String>,
    /// EEL, Young's modulus [Pa].
    pub young: f64,
    /// MOI, moment of inertia [m⁴].
    pub inertia: Triple,
    /// AFEL, area within the outer surface [m²].
    pub area: Triple,
    /// AIEL, area of the cavity [m²].
    pub cavity: Triple,
    /// DFEL, distance to the outermost fibre [m]: the report's bed begins that high above the bottom.
    pub outermost: Triple,
    /// MEL, mass per length [kg/m].
    pub mass: Triple,
    /// DEL, diameter for hydrodynamic forces [m].
    pub diameter: Triple,
    /// BUOYEL, buoyancy per length [N/m].
    pub buoyancy: Triple,
}

/// One node.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DeckNode {
    /// R [m].
    pub position: Triple,
    /// RPRM, slope with respect to arc length from the top end [-].
    pub slope: Triple,
    /// RDOT [m/s].
    pub velocity: Triple,
    /// RPMDT [1/s].
    pub slope_rate: Triple,
    /// LAMBDA in the middle of the element before this node [N]; 0 for the first node.
    pub lambda_before: f64,
    /// LAMBDA at the node [N].
    pub lambda: f64,
}

/// One element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeckElement {
    /// LNTHEL, unstretched length [m].
    pub length: f64,
    /// JELTYP, counted from 0.
    pub kind: usize,
}

/// What holds or loads one node.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeConstraint {
    /// NODEC, counted from 0.
    pub node: usize,
    /// REFCOS of the primary and the first perpendicular axis.
    pub axes: [Triple; 2],
    /// REFPOS [m].
    pub reference: Triple,
    /// SPGCONT along the axes [N/m].
    pub stiffness: Triple,
    /// DMPCONT along the axes [N·s/m].
    pub damping: Triple,
    /// FINITL along x, y, z [N].
    pub force: Triple,
    /// CMASS [kg].
    pub mass: f64,
    /// FREQ [rad/s].
    pub frequency: f64,
    /// DISAMP in phase, sin(FREQ t), along x, y, z [m].
    pub sine: Triple,
    /// DISAMP out of phase, cos(FREQ t), along x, y, z [m].
    pub cosine: Triple,
}

/// A vector of the file in the scene's axes.
pub fn turned([x, y, z]: Triple) -> Triple {
    [x, 0.0 - z, y]
}

/// A vector of the scene in the file's axes.
pub fn turned_back([x, y, z]: Triple) -> Triple {
    [x, z, 0.0 - y]
}

/// Mean over an element of what is a parabola through three values: ends and middle.
pub fn mean([first, middle, second]: Triple) -> f64 {
    if first == middle && middle == second { first } else { (first + 4.0 * middle + second) / 6.0 }
}

impl Deck {
    /// Arc length of every node from the top end [m].
    pub fn arc_lengths(&self) -> Vec<f64> {
        let mut s = 0.0;
        let ends = self.elements.iter().map(|element| {
            s += element.length;
            s
        });
        std::iter::once(0.0).chain(ends).collect()
    }

    /// Number of time levels at which the 1994 program asks for velocities of the forced motion.
    pub fn levels(&self) -> usize {
        ((self.end - self.begin) / self.step * (1.0 + 1e-12) + 1e-9).max(0.0) as usize + 1
    }
}
