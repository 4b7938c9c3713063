//! Writing a CABLE file as the 1994 program did, so that an output is an input. Columns and texts are those of its FORMAT statements;
//! where a constant does not fit its columns, it is written in the form that keeps most of it there.

use crate::scene::cable::columns::{fixed, rounded, scaled};
use crate::scene::cable::{Deck, DeckNode, ElementType, Job, MotionKind, NodeConstraint};
use crate::scene::types::Triple;
use std::fmt::Write;

/// The text of a CABLE file.
pub fn text(deck: &Deck) -> String {
    let mut out = Lines(String::new());
    out.line(&deck.title);
    out.texts(&["", "I. Global Constants", "", "a. Indexes", ""]);
    let job = if deck.job == Job::Statics { 1 } else { 2 };
    let motion = if deck.motion == MotionKind::Sinusoidal { 1 } else { 2 };
    for (number, phrase) in [
        (deck.nodes.len(), "NODE (# of nodes)"),
        (deck.types.len(), "NELTYP (# of different element types)"),
        (deck.dimensions, "NDIM (# of dimensions- 2 or 3)"),
        (job, "JOB (1 = static, 2 = dynamic)"),
        (deck.snapshot_every, "JSNAP (snapshot each JSNAP iterations)"),
        (motion, "JMOTN (1 = sin. motion, 2 = input forced motion)"),
        (deck.constraints.len(), "NCNSTR (# of constrained nodes)"),
    ] {
        out.line(&format!(" {number:>3}       {phrase}"));
    }
    out.texts(&["", "b. Parameters", ""]);
    let ten = |value: f64| fixed(value, 10, 5);
    let nine = |value: f64| fixed(value, 9, 5);
    out.line(&format!(
        "{}{}{:>5}            relaxation, damping const., # iterations",
        ten(deck.relaxation),
        ten(deck.damping),
        deck.iterations
    ));
    out.line(&format!(" {} {} {}       begin time, end time & time step", nine(deck.begin), nine(deck.end), nine(deck.step)));
    out.line(&format!("{}{}                 drag and added-mass coefficients", ten(deck.drag), ten(deck.added_mass)));
    out.line(&format!(
        "{}{}{}       mass density of water, fluid; gravity",
        ten(deck.water_density),
        ten(deck.inner_density),
        ten(deck.gravity)
    ));
    out.line(&format!("{}                           bottom depth", fixed(deck.bottom, 10, 2)));
    out.texts(&["", "", "II. Element and Nodal Information", "", "a. Physical Properties for Each Element Type", ""]);
    for (index, of) in deck.types.iter().enumerate() {
        element_type(&mut out, index + 1, of);
    }
    out.texts(&["b. Coordinates and Lambdas for Each Node"]);
    for (index, node) in deck.nodes.iter().enumerate() {
        self::node(&mut out, index + 1, node, deck.dimensions);
    }
    out.texts(&["", "c. Connections between Nodes", "  length  elmt type"]);
    for (index, element) in deck.elements.iter().enumerate() {
        let length = fixed(element.length, 7, 1);
        out.line(&format!(" {length} {:>7}       from node{:>3} to{:>3}", element.kind + 1, index + 1, index + 2));
    }
    out.texts(&["", "", "III. Nodal Constraints", ""]);
    for of in &deck.constraints {
        constraint(&mut out, of, deck.dimensions);
    }
    environment(&mut out, deck);
    out.0
}

/// A number as `1PE12.5`.
pub fn exponential(value: f64) -> String {
    scaled(value, 12, 5)
}

/// A file line by line, without blanks at the ends of lines.
struct Lines(String);

impl Lines {
    fn line(&mut self, text: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.0, "{}", text.trim_end());
    }

    fn texts(&mut self, texts: &[&str]) {
        texts.iter().for_each(|text| self.line(text));
    }
}

fn element_type(out: &mut Lines, number: usize, of: &ElementType) {
    let eleven = |value: f64| scaled(value, 11, 5);
    let name = of.name.as_ref().map_or(String::new(), |name| format!(": {name}"));
    out.line(&format!(" {}                             Young's mod; type{number:>3}{name}", eleven(of.young)));
    for ([first, middle, second], phrase) in [
        (of.inertia, "moment of inertia (I)"),
        (of.area, "cross-section area (Af)"),
        (of.cavity, "internal cavity area (Ai)"),
        (of.outermost, "dist. to outermost fiber"),
        (of.mass, "mass of the rod per unit length"),
        (of.diameter, "diameters for hydrodynamic forces"),
        (of.buoyancy, "total buoyancy/unit length"),
    ] {
        out.line(&format!(" {} {} {}     {phrase}", eleven(first), eleven(middle), eleven(second)));
    }
    out.line("");
}

/// The row of a vector: as many components as dimensions, and what is missing of three as blanks.
fn row(vector: Triple, dimensions: usize, gap: &str, write: impl Fn(f64) -> String, blank: &str) -> String {
    (0..3).map(|k| if k < dimensions { format!("{gap}{}", write(vector[k])) } else { format!("{gap}{blank}") }).collect()
}

fn node(out: &mut Lines, number: usize, node: &DeckNode, dimensions: usize) {
    let row = |vector| row(vector, dimensions, " ", |x| rounded(x, 11, 5), "           ");
    let phrases = match dimensions {
        2 => ["x and y position at node #", "x' and y' slopes", "x-dot and y-dot", "x'-dot and y'-dot"],
        _ => ["x, y and z position at node #", "x', y' and z' slopes", "x-dot, y-dot and z-dot", "x'-dot, y'-dot and z'-dot"],
    };
    out.line("");
    out.line(&format!("{}       {}{number:>3}", row(node.position), phrases[0]));
    out.line(&format!("{}       {}", row(node.slope), phrases[1]));
    out.line(&format!("{}       {}", row(node.velocity), phrases[2]));
    out.line(&format!("{}       {}", row(node.slope_rate), phrases[3]));
    let [before, at] = [node.lambda_before, node.lambda].map(|lambda| scaled(lambda, 12, 5));
    out.line(&format!("{before}{at}                   lambda at prev. ctr. and at node"));
}

fn constraint(out: &mut Lines, of: &NodeConstraint, dimensions: usize) {
    let number = of.node + 1;
    out.line(&format!("Node No.{number:>3}"));
    out.texts(&["", "a. Linear Constraints", "        direction cosines", "  reference   1st perp.   2nd perp.     position"]);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(dimensions) {
        let cosines = match dimensions {
            2 => [Some(of.axes[0][axis]), Some(of.axes[1][axis]), None],
            _ => [Some(of.axes[0][axis]), Some(of.axes[1][axis]), Some(perpendicular(&of.axes)[axis])],
        };
        let cosines: String =
            cosines.iter().map(|cosine| cosine.map_or(" ".repeat(12), |cosine| format!("{}    ", cosine_text(cosine)))).collect();
        out.line(&format!("    {cosines}{}    {name} direction", fixed(of.reference[axis], 10, 3)));
    }
    if dimensions == 2 {
        out.line(&format!("{}z direction", " ".repeat(54)));
    }
    let twelve = |vector| row(vector, dimensions, "", |x| scaled(x, 12, 5), &" ".repeat(12));
    out.line(&format!("{}                spring constant", twelve(of.stiffness)));
    let damping = row(of.damping, dimensions, "  ", |x| fixed(x, 10, 5), &" ".repeat(10));
    out.line(&format!("{damping}                  damping constant"));
    out.line(&format!("{}                initial force", twelve(of.force)));
    out.line(&format!("  {}                                          concentrated mass", fixed(of.mass, 10, 5)));
    out.texts(&["", &format!("b. Motion of Reference Point at Node{number:>3}"), ""]);
    out.line(&format!("{}            motion frequency (rad/sec)", fixed(of.frequency, 15, 10)));
    out.texts(&["", "  In-phase  out-phase"]);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(dimensions) {
        let [sine, cosine] = [of.sine[axis], of.cosine[axis]].map(|amplitude| fixed(amplitude, 9, 3));
        out.line(&format!(" {sine} {cosine}       {name} displacement amplitude"));
    }
    if dimensions == 2 {
        out.line(&format!("{}z displacement amplitude", " ".repeat(27)));
    }
    out.line("");
}

/// `F8.5` of a cosine, which has the room of a sign, a digit, the point and five more.
fn cosine_text(cosine: f64) -> String {
    rounded(cosine, 8, 5)
}

fn perpendicular([a, b]: &[Triple; 2]) -> Triple {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn environment(out: &mut Lines, deck: &Deck) {
    out.texts(&["", "IV. Environmental Data", "", &format!("a. Currents at{:>3} depths", deck.currents.len()), ""]);
    out.line("     depth     x-vel     y-vel     z-vel");
    for (y, velocity) in &deck.currents {
        let components: String = velocity.iter().take(deck.dimensions).map(|v| fixed(*v, 10, 4)).collect();
        out.line(&format!("{}{components}", fixed(*y, 10, 4)));
    }
    out.texts(&["", "b. Waves", ""]);
    out.line(&format!(
        "{}{}       wave amplitude and frequency (rad/sec)",
        fixed(deck.wave_amplitude, 10, 6),
        fixed(deck.wave_frequency, 10, 5)
    ));
    out.line(&format!("{}                 wave direction relative to x axis", fixed(deck.wave_direction, 10, 7)));
}
