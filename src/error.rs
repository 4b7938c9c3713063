//! Every failure of moorline as data (what, where, when, value, what is allowed), and the only file that words it.

use thiserror::Error;

/// How many known names a message lists.
const LISTED: usize = 24;

/// Why something could not be done. Its `Display` is the message for the user; `exit_code` the program's answer to the shell.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A file could not be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// What the operating system said.
        reason: String,
    },
    /// The text is not the JSON of a scene.
    #[error("{file}, line {line}, column {column}{}: {problem}", at_place(.place))]
    Json {
        /// The file.
        file: String,
        /// Line of the text, from 1.
        line: usize,
        /// Column of the text in characters, from 1.
        column: usize,
        /// Place in the scene, such as `lines[0].sections[1]`; may be empty.
        place: String,
        /// What is wrong there.
        problem: Box<Problem>,
    },
    /// A CABLE file cannot be read.
    #[error("{file}, line {line}, column {column}, {item}: {problem}")]
    Deck {
        /// The file.
        file: String,
        /// Line of the text, from 1.
        line: usize,
        /// Column of the text in characters, from 1.
        column: usize,
        /// What should stand there, by the name that the report gives it.
        item: String,
        /// What is wrong there.
        problem: Box<DeckProblem>,
    },
    /// A MoorDyn file cannot be read, or says what no scene can hold.
    #[error("{file}, line {line}, `{text}`: {problem}")]
    MoorDyn {
        /// The file.
        file: String,
        /// Line of the text, from 1.
        line: usize,
        /// The line as written, without its comment.
        text: String,
        /// What is wrong there.
        problem: Box<MoorDynProblem>,
    },
    /// A `--set` cannot be applied, or makes the scene unreadable.
    #[error("{file}, --set {setting}{}: {problem}", at_place(.place))]
    Set {
        /// The file whose scene was to be changed.
        file: String,
        /// What stands before the `=`, as typed.
        setting: String,
        /// Place inside the value given, where the value is a list or an object; may be empty.
        place: String,
        /// What is wrong.
        problem: Box<Problem>,
    },
    /// A value of the scene is not allowed.
    #[error("{file}, {place}: {value} is not allowed: {allowed}")]
    Value {
        /// The file.
        file: String,
        /// Place in the scene, such as `line_types.chain.ea`.
        place: String,
        /// The value found there.
        value: String,
        /// What is allowed, and what to change.
        allowed: String,
    },
    /// A line is too short for the distance of its ends.
    #[error(transparent)]
    Reach(Box<Reach>),
    /// No static equilibrium was found.
    #[error(transparent)]
    Statics(Box<Unbalanced>),
    /// A time step could not be taken; the line stands as it was before.
    #[error(transparent)]
    Step(Box<Stuck>),
    /// Lines that hang on free bodies and points have no equilibrium, or could not take a step.
    #[error(transparent)]
    Network(Box<Adrift>),
    /// The user stopped the run; what was written is complete up to this time.
    #[error("stopped by the user at t = {time} s; all rows written are complete")]
    Interrupted {
        /// Time reached [s].
        time: f64,
    },
    /// A run over many seeds of which one failed or was stopped; the others went on, unless the user stopped all.
    #[error("{done} of {of} seeds are done; seed {seed}: {error}")]
    Seed {
        /// How many seeds reached their end.
        done: usize,
        /// How many were asked for.
        of: usize,
        /// The first that did not.
        seed: u64,
        /// Why.
        error: Box<Error>,
    },
}

impl Error {
    /// Exit code of the command: 2 bad input, 3 no convergence, 130 stopped by the user.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::File { .. }
            | Error::Json { .. }
            | Error::Deck { .. }
            | Error::MoorDyn { .. }
            | Error::Set { .. }
            | Error::Value { .. }
            | Error::Reach(_) => 2,
            Error::Statics(_) | Error::Step(_) | Error::Network(_) => 3,
            Error::Interrupted { .. } => 130,
            Error::Seed { error, .. } => error.exit_code(),
        }
    }
}

/// What is wrong at one place of a scene's text, or with a `--set`.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// The file holds nothing but white space.
    #[error("the file is empty; a scene is a JSON object and begins with {{")]
    Empty,
    /// The text is not UTF-8.
    #[error("the text is not UTF-8; save it with that encoding")]
    NotUtf8,
    /// The text breaks the rules of JSON.
    #[error("not valid JSON: {reason}")]
    Syntax {
        /// The rule that is broken.
        reason: String,
    },
    /// The text ends inside the scene.
    #[error("the text ends too early: a bracket, a quote or a value is missing; is the file cut off?")]
    Truncated,
    /// Too many brackets inside each other.
    #[error("brackets stand too deep inside each other; a scene needs at most 8 levels")]
    TooDeep,
    /// NaN, Infinity, or a number that no f64 can hold.
    #[error("{text} is not allowed: every number of a scene must be finite")]
    NotFinite {
        /// The number as written.
        text: String,
    },
    /// One key stands twice in one object.
    #[error("the key `{key}` stands twice, first in line {first_line}; keep one of them")]
    DuplicateKey {
        /// The key.
        key: String,
        /// Line of its first appearance, from 1.
        first_line: usize,
    },
    /// A key that nobody knows.
    #[error("unknown key `{key}`{}", among(.key, .known))]
    UnknownKey {
        /// The key.
        key: String,
        /// The keys that are known there.
        known: Vec<String>,
    },
    /// A key that must be there.
    #[error("the key `{key}` is missing; it has no default")]
    MissingKey {
        /// The key.
        key: String,
    },
    /// A word that is none of the words allowed there.
    #[error("\"{name}\" is not allowed{}", among(.name, .known))]
    UnknownName {
        /// The word.
        name: String,
        /// The words that are known there.
        known: Vec<String>,
    },
    /// A text where a number should be, and the like.
    #[error("found {found}, expected {expected}")]
    Type {
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// A `--set` without `=`, or whose place cannot be read.
    #[error("cannot be read; write it as place=value, such as lines[0].sections[0].length=1250")]
    Setting,
    /// An entry of a list that is not there.
    #[error("{place}: {index} is not allowed: {}", indices(*.length))]
    Index {
        /// The list.
        place: String,
        /// The index asked for.
        index: String,
        /// Number of entries of the list.
        length: usize,
    },
    /// A place inside something that has no inside.
    #[error("{place} is {found}, so nothing can be set inside it; set {place} itself")]
    Inside {
        /// What has no inside.
        place: String,
        /// Its value.
        found: String,
    },
}

/// What is wrong at one place of a CABLE file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DeckProblem {
    /// The text ends before it has said everything.
    #[error("the file ends here, before this; is it cut off?")]
    Ends,
    /// The text holds no count of nodes: it is something else.
    #[error(
        "this is neither a scene, which is a JSON object and begins with {{, nor a CABLE file, which has this count in its 7th line"
    )]
    Neither,
    /// Something else than a number.
    #[error("found {found}, expected {expected}")]
    Unreadable {
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// Not as many numbers as the line must have.
    #[error("the line has {found} of the {expected} numbers that it needs")]
    TooFew {
        /// How many stand there.
        found: usize,
        /// How many should.
        expected: usize,
    },
    /// NaN, Infinity, or a number beyond 1e15.
    #[error("{text} is not allowed: every number must be finite and not larger than 1e15")]
    NotFinite {
        /// The number as written.
        text: String,
    },
    /// Asterisks: the program that wrote the file had a number longer than its columns.
    #[error(
        "these asterisks stand for a number that was too long for its columns when the file was written; put the number there"
    )]
    Stars,
    /// A number that means nothing there.
    #[error("{value} is not allowed: {allowed}")]
    NotAllowed {
        /// The value.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// A scene that no CABLE file can say.
    #[error("a CABLE file cannot hold this: {reason}")]
    CannotHold {
        /// Why.
        reason: String,
    },
}

/// What is wrong at one line of a MoorDyn file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MoorDynProblem {
    /// One section stands twice.
    #[error("this section stands twice, first in line {first_line}; MoorDyn reads the first alone. Keep one of them")]
    Twice {
        /// Line of the first header, from 1.
        first_line: usize,
    },
    /// A row of numbers where the units of the columns should be.
    #[error("expected the units of the columns in brackets: MoorDyn skips this line, and the row would be lost")]
    NoUnits,
    /// A section that must be there is not; the line is the last of the file.
    #[error("the file ends here without a section {section}")]
    NoSection {
        /// Words of its header.
        section: &'static str,
    },
    /// A row with too few values.
    #[error("the row has {found} of the {needed} values that it needs: {columns}")]
    TooFew {
        /// How many stand there.
        found: usize,
        /// How many should.
        needed: usize,
        /// What they are.
        columns: &'static str,
    },
    /// Something else than what is expected.
    #[error("{item}: found {found}, expected {expected}")]
    Unreadable {
        /// The column or option.
        item: &'static str,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: &'static str,
    },
    /// A name or number that nothing has.
    #[error("{item}: there is no `{name}`{}", among(.name, .known))]
    Unknown {
        /// The column.
        item: &'static str,
        /// What is not there.
        name: String,
        /// What is there.
        known: Vec<String>,
    },
    /// A number or name that another row has already.
    #[error("{item}: {name} stands twice, first in line {first_line}")]
    Taken {
        /// The column.
        item: &'static str,
        /// The number or name.
        name: String,
        /// Line of the first, from 1.
        first_line: usize,
    },
    /// What no scene can hold.
    #[error("{item}: {reason}")]
    CannotHold {
        /// The column, option or section.
        item: String,
        /// Why, and what would do.
        reason: String,
    },
}

/// A line too short for the distance of its ends.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{file}, {place} \"{line}\": {length:.1} m of line do not reach from fairlead {} to anchor {}, {distance:.1} m away, without \
     {:.1} % stretch; {limit}. Lengthen a section by at least {lengthen} m, or move the anchor closer.",
    point(.fairlead), point(.anchor), .stretch * 100.0
)]
pub struct Reach {
    /// The file.
    pub file: String,
    /// Place in the scene, such as `lines[0]`.
    pub place: String,
    /// Name of the line.
    pub line: String,
    /// Unstretched length [m].
    pub length: f64,
    /// Position of the fairlead [m].
    pub fairlead: [f64; 3],
    /// Position of the anchor [m].
    pub anchor: [f64; 3],
    /// Distance of the two [m].
    pub distance: f64,
    /// Mean strain needed to reach [-].
    pub stretch: f64,
    /// Which limit that passes.
    pub limit: Limit,
    /// Length that is missing [m], rounded up.
    pub lengthen: f64,
}

/// What a stretched line cannot take.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Limit {
    /// It breaks.
    #[error("\"{line_type}\" breaks at {:.1} %", .strain * 100.0)]
    Breaks {
        /// The line type.
        line_type: String,
        /// Mean strain of the line when it breaks [-].
        strain: f64,
    },
    /// It would be pulled to more than twice its length.
    #[error("more than 100 % is not modelled")]
    Doubles,
}

/// No static equilibrium was found.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "line \"{line}\": no {stable}static equilibrium after {iterations} iterations: near s = {s:.1} m ({zone}) a force of {residual:.3e} N is \
     not balanced (allowed: {allowed:.1e} N){buckles}. Check length, weight and ends of the line; a coarser or finer mesh (`elements`), a \
     little bending stiffness (`ei`) or a stiffness `ea` closer to the real one may help.",
    stable = if *unstable { "stable " } else { "" },
    buckles = if *unstable { ", but the line would buckle from there" } else { "" }
)]
pub struct Unbalanced {
    /// Name of the line.
    pub line: String,
    /// Newton iterations done.
    pub iterations: usize,
    /// Largest unbalanced nodal force [N].
    pub residual: f64,
    /// Unbalanced force that counts as equilibrium [N].
    pub allowed: f64,
    /// In balance, but not stable: the least disturbance would make it buckle.
    pub unstable: bool,
    /// Arc length of the largest unbalanced force [m from the fairlead].
    pub s: f64,
    /// What is there.
    pub zone: Zone,
}

/// A time step could not be taken.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "line \"{line}\", t = {time:.4} s, near s = {s:.1} m ({zone}): {cause}. The fairlead moves at {fairlead_speed:.3} m/s there. \
     The line stands as it was at t = {last_good_time:.4} s."
)]
pub struct Stuck {
    /// Name of the line.
    pub line: String,
    /// Time of the attempt [s].
    pub time: f64,
    /// Where on the line [m from the fairlead].
    pub s: f64,
    /// What is there.
    pub zone: Zone,
    /// What failed.
    pub cause: Cause,
    /// Speed of the fairlead at that time [m/s].
    pub fairlead_speed: f64,
    /// Time of the last good state [s].
    pub last_good_time: f64,
}

/// A free body or point that cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{what}, t = {time:.4} s: {trouble}")]
pub struct Adrift {
    /// What it is: `point "delta"`.
    pub what: String,
    /// Time of the attempt [s].
    pub time: f64,
    /// What is wrong.
    pub trouble: Trouble,
}

/// What is wrong with a free body or point.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Trouble {
    /// No equilibrium was found.
    #[error(
        "no static equilibrium after {iterations} iterations: a force of {residual:.3e} N is not balanced (allowed: {allowed:.1e} N). Check \
         weights, buoyancies and lengths of lines there, and give a position nearer to the equilibrium"
    )]
    Unbalanced {
        /// Iterations done.
        iterations: usize,
        /// Force out of balance [N].
        residual: f64,
        /// What counts as balanced [N].
        allowed: f64,
    },
    /// In balance, but the least disturbance would make it leave.
    #[error(
        "its equilibrium is not stable, and none beside it was found; ballast it lower, or hold it by lines from several sides"
    )]
    Unstable,
    /// A time step could not be taken.
    #[error(
        "no step of {step:.0e} s can be taken; it stands as it was at t = {last_good_time:.4} s. Look for a mass or inertia that is very small \
         for the lines on it, or a jump in the motion"
    )]
    Stuck {
        /// Smallest step tried [s].
        step: f64,
        /// Time of the last good state [s].
        last_good_time: f64,
    },
}

/// Part of a line, in a naval architect's words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Zone {
    /// The upper end.
    #[error("fairlead")]
    Fairlead,
    /// The lower end.
    #[error("anchor")]
    Anchor,
    /// Where the line lands on the bed.
    #[error("touchdown")]
    Touchdown,
    /// On the bed.
    #[error("on the bed")]
    Grounded,
    /// Between bed and surface.
    #[error("suspended")]
    Suspended,
}

/// Why a time step could not be taken.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Cause {
    /// The nonlinear iteration fails.
    #[error(
        "no solution even with a step of {step:.0e} s; look for a jump in the motion, a mesh too coarse there or an extreme stiffness"
    )]
    NoSolution {
        /// Smallest step tried [s].
        step: f64,
    },
    /// The error estimate stays too large.
    #[error(
        "the error stays above the tolerance even with a step of {step:.0e} s; look for a jump in the motion, or loosen solver.tolerance"
    )]
    TooInaccurate {
        /// Smallest step tried [s].
        step: f64,
    },
    /// A number is not finite.
    #[error("a force is not finite even with a step of {step:.0e} s; look for a jump in the motion or an extreme property")]
    NotFinite {
        /// Smallest step tried [s].
        step: f64,
    },
    /// The path does not begin where the fairlead is.
    #[error("the fairlead is asked to jump by {distance:.3} m; its motion must be continuous")]
    Jump {
        /// Length of the jump [m].
        distance: f64,
    },
    /// The fairlead is farther from the anchor than the line can stretch.
    #[error("the fairlead is {distance:.1} m from the anchor, more than twice the {length:.1} m of line")]
    OutOfReach {
        /// Distance [m].
        distance: f64,
        /// Unstretched length [m].
        length: f64,
    },
    /// A step of `cable-1994` that its damping makes unstable.
    #[error(
        "a step of {step:.1e} s is too short for the scheme cable-1994: its damping amplifies errors in steps of {shortest:.1e} s and less, \
         twice the largest `damping`; use longer steps (solver.fixed_step, run.output_step), less damping or another scheme"
    )]
    StepTooShort {
        /// The step [s].
        step: f64,
        /// Twice the largest time constant [s].
        shortest: f64,
    },
    /// `cable-1994` has left every bound.
    #[error(
        "the scheme cable-1994, which solves each step once and controls no error, has diverged with steps of {step} s; shorten \
         solver.fixed_step, or use adams-moulton"
    )]
    Diverged {
        /// The step [s].
        step: f64,
    },
    /// The motion holds a number that is not finite.
    #[error("the motion of the fairlead is not finite")]
    BadMotion,
}

/// The known name that looks most like `name`, if one looks like it at all.
pub fn nearest<'a>(name: &str, known: &'a [String]) -> Option<&'a String> {
    let allowed = (name.chars().count() + 1) / 3;
    let ranked = known.iter().map(|candidate| (edits(name, candidate), candidate));
    ranked.filter(|(distance, _)| *distance <= allowed).min_by_key(|(distance, _)| *distance).map(|(_, candidate)| candidate)
}

/// Number of letters to insert, delete, replace or swap with their neighbour to make one word of the other, case aside.
fn edits(one: &str, other: &str) -> usize {
    let one: Vec<char> = one.to_lowercase().chars().take(64).collect();
    let other: Vec<char> = other.to_lowercase().chars().take(64).collect();
    let mut before = vec![0; other.len() + 1];
    let mut last: Vec<usize> = (0..=other.len()).collect();
    for i in 1..=one.len() {
        let mut row = vec![i];
        for j in 1..=other.len() {
            let differs = usize::from(one[i - 1] != other[j - 1]);
            let mut least = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + differs);
            if i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1] {
                least = least.min(before[j - 2] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[other.len()]
}

/// The tail of a message about an unknown name: the likely one, and all that are known.
pub fn among(name: &str, known: &[String]) -> String {
    let quoted: Vec<String> = known.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = if known.len() > LISTED { format!(" and {} more", known.len() - LISTED) } else { String::new() };
    match (nearest(name, known), known.len()) {
        (_, 0) => String::from("; nothing is known here"),
        (Some(near), 1) => format!("; did you mean `{near}`?"),
        (Some(near), _) => format!("; did you mean `{near}`? Known here: {}{more}", quoted.join(", ")),
        (None, _) => format!("; known here: {}{more}", quoted.join(", ")),
    }
}

fn indices(length: usize) -> String {
    match length {
        0 => String::from("the list is empty; set the whole list as JSON"),
        1 => String::from("the list has 1 entry, index 0"),
        _ => format!("the list has {length} entries, indices 0 to {}", length - 1),
    }
}

fn point(at: &[f64; 3]) -> String {
    format!("({}, {}, {})", at[0], at[1], at[2])
}

fn at_place(place: &str) -> String {
    if place.is_empty() { String::new() } else { format!(", {place}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_found_and_far_ones_are_not_offered() {
        let known = ["period", "sine", "cosine", "ramp"].map(String::from);
        assert_eq!(nearest("perid", &known).map(String::as_str), Some("period"));
        assert_eq!(nearest("Sien", &known).map(String::as_str), Some("sine"));
        assert_eq!(nearest("wavelength", &known), None);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("ab", "ba"), 1);
    }
}
