//! Reading a CABLE file: every line in its place as in 1994, or, where lines are missing or too many, every number in its order.
//!
//! Texts may be left out or be longer than they were. Empty columns are zeros, as in Fortran, and so are some empty lines; that
//! asks for two attempts: one that counts the lines before these, as the 1994 program did, and one that takes no line for a zero. A number without a decimal point is taken as
//! written, with a warning: the 1994 program put the point where its FORMAT said.

use crate::error::{DeckProblem, Error};
use crate::scene::cable::columns::{Columns, Cut, Found, cut, first_word, implied, number, repeated};
use crate::scene::cable::{Deck, DeckElement, DeckNode, ElementType, Job, LOCK, MotionKind, NodeConstraint};
use crate::scene::types::Triple;

/// A file as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// What it says.
    pub deck: Deck,
    /// What is allowed but may not be meant.
    pub warnings: Vec<String>,
    /// Where things stand that a later check may find fault with.
    pub spots: Vec<(Item, Spot)>,
}

/// A thing whose place in the file is remembered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// The time step.
    Times,
    /// The constants of water and gravity.
    Water,
    /// The bottom.
    Bottom,
    /// Element type, from 0.
    Type(usize),
    /// Node, from 0.
    Node(usize),
    /// Element, from 0.
    Element(usize),
    /// Entry of the constraints, from 0.
    Constraint(usize),
    /// Row of the currents, from 0.
    Current(usize),
    /// The waves.
    Waves,
}

/// Line and column, both from 1.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Spot {
    /// Line.
    pub line: usize,
    /// Column.
    pub column: usize,
}

/// No number of a file is larger.
const LARGEST: f64 = 1.0e15;
/// Most nodes and element types of a file.
const MOST: usize = 20_001;

/// Whether a text is a CABLE file rather than the JSON of a scene: it does not begin like JSON, or seven of its first lines, one
/// after the other, begin with the whole numbers of the indexes.
pub fn is_deck(text: &str) -> bool {
    let counts = |line: &str| first_word(line).is_some_and(|word| word.parse::<u32>().is_ok());
    let mut run = 0;
    let indexes = text.lines().take(30).any(|line| {
        run = if counts(line) { run + 1 } else { 0 };
        run == 7
    });
    indexes || !text.trim_start().starts_with(['{', '[', '"', '<', '/', '#'])
}

/// Reads the text of a CABLE file; `file` is for messages.
pub fn read(text: &str, file: &str) -> Result<Reading, Error> {
    let strict = Reader::new(text, file, false).deck();
    if strict.is_ok() {
        return strict;
    }
    let mut lenient = Reader::new(text, file, true).deck()?;
    let remark = "text and blank lines are not where the 1994 program counts on them; the numbers were read in their order";
    lenient.warnings.insert(0, format!("{file}: {remark}"));
    Ok(lenient)
}

/// A number and its place.
#[derive(Debug, Clone, Copy, Default)]
struct Number {
    value: f64,
    spot: Spot,
}

struct Reader<'a> {
    file: &'a str,
    lines: Vec<&'a str>,
    /// Lines already read.
    done: usize,
    lenient: bool,
    spots: Vec<(Item, Spot)>,
    /// First line whose columns are off, and how many there are.
    off: (usize, usize),
    /// First number without a decimal point, as a warning, and how many there are.
    pointless: (String, usize),
}

/// Whether a line may stand for a zero where it is blank.
#[derive(Clone, Copy, PartialEq)]
enum Blank {
    Zero,
    Fault,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, file: &'a str, lenient: bool) -> Reader<'a> {
        let lines = text.lines().collect();
        Reader { file, lines, done: 0, lenient, spots: Vec::new(), off: (0, 0), pointless: (String::new(), 0) }
    }

    fn deck(mut self) -> Result<Reading, Error> {
        let title = self.lines.first().map_or(String::new(), |line| line.trim().to_string());
        self.done = 1;
        self.text();
        let nodes = self.count("NODE, the number of nodes", 2, MOST).map_err(neither)?;
        let types = self.count("NELTYP, the number of element types", 1, MOST)?;
        let dimensions = self.count("NDIM, the number of dimensions", 2, 3)?;
        let job = match self.count("JOB, 1 for statics and 2 for dynamics", 1, 2)? {
            1 => Job::Statics,
            _ => Job::Dynamics,
        };
        let snapshot_every = self.count("JSNAP, steps from snapshot to snapshot", 0, usize::MAX)?;
        let motion = match self.count("JMOTN, 1 for a sinusoidal and 2 for a given motion", 0, 2)? {
            2 => MotionKind::Forced,
            _ => MotionKind::Sinusoidal,
        };
        let constrained = self.count("NCNSTR, the number of constrained nodes", 0, nodes)?;
        self.text();
        let mut deck = self.parameters(title, dimensions, job, motion, snapshot_every)?;
        self.text();
        for index in 0..types {
            let of = self.element_type(index, types)?;
            deck.types.push(of);
            self.text();
        }
        for index in 0..nodes {
            self.text();
            let node = self.node(index, dimensions)?;
            deck.nodes.push(node);
        }
        self.text();
        for index in 0..nodes - 1 {
            let element = self.element(index, types)?;
            deck.elements.push(element);
        }
        for index in 0..constrained {
            let constraint = self.constraint(index, &deck)?;
            deck.constraints.push(constraint);
        }
        self.environment(&mut deck)?;
        Ok(self.finish(deck))
    }

    fn finish(self, deck: Deck) -> Reading {
        let mut warnings = Vec::new();
        let file = self.file;
        if let (line, count @ 1..) = self.off {
            let others = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
            warnings.push(format!("{file}, line {line}{others}: not in the columns of 1994; read word by word"));
        }
        if let (first, count @ 1..) = &self.pointless {
            let others = if *count > 1 { format!("; so are {} more", count - 1) } else { String::new() };
            warnings.push(format!("{file}, {first}{others}"));
        }
        Reading { deck, warnings, spots: self.spots }
    }

    fn parameters(
        &mut self,
        title: String,
        dimensions: usize,
        job: Job,
        motion: MotionKind,
        snapshot_every: usize,
    ) -> Result<Deck, Error> {
        let tens = |count| repeated(0, 0, 10, count);
        let relax = self.numbers(
            "RELAX, DAMP and ITER",
            &[tens(2), vec![Columns { before: 20, width: 5 }]].concat(),
            [5, 5, 0],
            Blank::Fault,
        )?;
        let damping = self.not_negative("DAMP", relax[1])?;
        let iterations = self.whole("ITER", relax[2])?;
        let times = self.numbers("TBGN, TEND and TSTEP", &repeated(0, 1, 9, 3), [5; 3], Blank::Zero)?;
        self.spots.push((Item::Times, times[2].spot));
        if job == Job::Dynamics {
            self.positive("TSTEP, the time step", times[2])?;
            if times[1].value < times[0].value {
                self.refuse("TEND, the end time", times[1], format!("it must not lie before TBGN = {} s", times[0].value))?;
            }
        }
        let coefficients = self.numbers("CD and CM", &tens(2), [5; 2], Blank::Zero)?;
        let drag = self.not_negative("CD", coefficients[0])?;
        let added_mass = self.not_negative("CM", coefficients[1])?;
        let water = self.numbers("RUF, RUI and G", &tens(3), [5; 3], Blank::Fault)?;
        self.spots.push((Item::Water, water[0].spot));
        let water_density = self.not_negative("RUF, the density of the water", water[0])?;
        let inner_density = self.not_negative("RUI, the density of the fluid inside", water[1])?;
        let gravity = self.positive("G, gravity", water[2])?;
        let [bottom] = self.numbers("BTMDPTH", &tens(1), [2], Blank::Fault)?;
        self.spots.push((Item::Bottom, bottom.spot));
        if bottom.value >= 0.0 {
            let allowed = "y of the bottom must lie below zero: y points up, and the water surface is y = 0".to_string();
            self.refuse("BTMDPTH, the bottom depth", bottom, allowed)?;
        }
        Ok(Deck {
            title,
            dimensions,
            job,
            snapshot_every,
            motion,
            relaxation: relax[0].value,
            damping,
            iterations,
            begin: times[0].value,
            end: times[1].value,
            step: times[2].value,
            drag,
            added_mass,
            water_density,
            inner_density,
            gravity,
            bottom: bottom.value,
            types: Vec::new(),
            nodes: Vec::new(),
            elements: Vec::new(),
            constraints: Vec::new(),
            currents: Vec::new(),
            wave_amplitude: 0.0,
            wave_frequency: 0.0,
            wave_direction: 0.0,
        })
    }

    fn element_type(&mut self, index: usize, types: usize) -> Result<ElementType, Error> {
        let of = format!("of element type {} of {types}", index + 1);
        let [young] = self.numbers(&format!("EEL, Young's modulus {of}"), &repeated(0, 1, 11, 1), [5], Blank::Fault)?;
        self.spots.push((Item::Type(index), young.spot));
        let name = self.name_in_phrase(young.spot.line);
        let young = self.positive(&format!("EEL, Young's modulus {of}"), young)?;
        let inertia = self.three("MOI, moment of inertia", &of, Least::Zero)?;
        let area = self.three("AFEL, cross-section area", &of, Least::MoreThanZero)?;
        let cavity = self.three("AIEL, internal cavity area", &of, Least::Zero)?;
        let cavity_line = self.done;
        let outermost = self.three("DFEL, distance to the outermost fibre", &of, Least::Zero)?;
        let mass = self.three("MEL, mass per length", &of, Least::MoreThanZero)?;
        let diameter = self.three("DEL, diameter for hydrodynamic forces", &of, Least::MoreThanZero)?;
        let buoyancy = self.three("BUOYEL, buoyancy per length", &of, Least::Zero)?;
        if let Some(k) = (0..3).find(|k| cavity[*k] >= area[*k]) {
            let at = Number { value: cavity[k], spot: Spot { line: cavity_line, column: 2 + 12 * k } };
            self.refuse(
                &format!("AIEL, internal cavity area {of}"),
                at,
                format!("it must be less than AFEL = {:e} m²", area[k]),
            )?;
        }
        Ok(ElementType { name, young, inertia, area, cavity, outermost, mass, diameter, buoyancy })
    }

    /// A property at both ends and in the middle of an element.
    fn three(&mut self, what: &str, of: &str, least: Least) -> Result<Triple, Error> {
        let what = format!("{what} {of}");
        let three: [Number; 3] = self.numbers(&what, &repeated(0, 1, 11, 3), [5; 3], Blank::Zero)?;
        for number in three {
            match least {
                Least::Zero => self.not_negative(&what, number)?,
                Least::MoreThanZero => self.positive(&what, number)?,
            };
        }
        Ok(three.map(|number| number.value))
    }

    /// The name in the phrase of a type's first line: `… type 1: NAME`.
    fn name_in_phrase(&self, line: usize) -> Option<String> {
        let (_, phrase) = self.lines.get(line.checked_sub(1)?)?.split_once("type")?;
        let (number, name) = phrase.split_once(": ")?;
        number.trim().parse::<usize>().ok()?;
        let name: String = name.trim().chars().filter(|c| !c.is_control()).collect();
        (!name.is_empty()).then_some(name)
    }

    fn node(&mut self, index: usize, dimensions: usize) -> Result<DeckNode, Error> {
        let number = index + 1;
        let position = self.vector(&format!("R, position of node {number}"), 11, 5, dimensions, Blank::Fault)?;
        self.spots.push((Item::Node(index), Spot { line: self.done, column: 1 }));
        let slope = self.vector(&format!("RPRM, slope at node {number}"), 11, 5, dimensions, Blank::Fault)?;
        let velocity = self.vector(&format!("RDOT, velocity of node {number}"), 11, 5, dimensions, Blank::Zero)?;
        let slope_rate = self.vector(&format!("RPMDT, rate of the slope at node {number}"), 11, 5, dimensions, Blank::Zero)?;
        let lambda = self.numbers(&format!("LAMBDA at node {number}"), &repeated(0, 0, 12, 2), [5; 2], Blank::Zero)?;
        let [lambda_before, lambda] = lambda.map(|number| number.value);
        Ok(DeckNode { position, slope, velocity, slope_rate, lambda_before, lambda })
    }

    fn element(&mut self, index: usize, types: usize) -> Result<DeckElement, Error> {
        let what = format!("LNTHEL and JELTYP of the element from node {} to {}", index + 1, index + 2);
        let [length, kind] =
            self.numbers(&what, &[Columns { before: 1, width: 7 }, Columns { before: 9, width: 7 }], [1, 0], Blank::Fault)?;
        self.spots.push((Item::Element(index), length.spot));
        self.positive(&what, length)?;
        let kind_number = self.whole(&what, kind)?;
        if !(1..=types).contains(&kind_number) {
            self.refuse(&what, kind, format!("the element type must be one of 1 to {types}"))?;
        }
        Ok(DeckElement { length: length.value, kind: kind_number - 1 })
    }

    fn constraint(&mut self, index: usize, deck: &Deck) -> Result<NodeConstraint, Error> {
        let (nodes, dimensions) = (deck.nodes.len(), deck.dimensions);
        let node = self.counted_in_text("NODEC, the number of a constrained node", 8)?;
        self.spots.push((Item::Constraint(index), node.spot));
        let number = node.value as usize;
        if !(1..=nodes).contains(&number) {
            self.refuse("NODEC, a constrained node", node, format!("the nodes have the numbers 1 to {nodes}"))?;
        }
        if deck.constraints.iter().any(|other| other.node + 1 == number) {
            self.refuse("NODEC, a constrained node", node, "it stands here a second time".into())?;
        }
        self.text();
        let (mut axes, mut reference) = ([[0.0; 3]; 2], [0.0; 3]);
        let first_row = self.done + 1;
        for axis in 0..dimensions {
            let what = format!("REFCOS and REFPOS along {} of node {number}", ["x", "y", "z"][axis]);
            let row = self.cosines(&what, dimensions)?;
            (axes[0][axis], axes[1][axis], reference[axis]) = (row[0], row[1], row[2]);
        }
        if dimensions == 2 {
            axes[1] = [-axes[0][1], axes[0][0], 0.0];
            self.skip_text_row();
        }
        self.span(&axes, number, first_row)?;
        let stiffness = self.vector_at(&format!("SPGCONT, springs at node {number}"), &repeated(0, 0, 12, dimensions), 5)?;
        let damping_columns: Vec<Columns> = (0..dimensions).map(|k| Columns { before: 2 + 12 * k, width: 10 }).collect();
        let damping = self.vector_at(&format!("DMPCONT, dampers at node {number}"), &damping_columns, 5)?;
        let force = self.vector_at(&format!("FINITL, initial force at node {number}"), &repeated(0, 0, 12, dimensions), 5)?;
        let what = format!("CMASS, mass at node {number}");
        let [mass] = self.numbers(&what, &[Columns { before: 2, width: 10 }], [5], Blank::Zero)?;
        let mass = self.not_negative(&what, mass)?;
        self.text_lines(3)?;
        let what = format!("FREQ, motion frequency at node {number}");
        let [frequency] = self.numbers(&what, &[Columns { before: 0, width: 15 }], [10], Blank::Zero)?;
        self.text_lines(2)?;
        let (mut sine, mut cosine) = ([0.0; 3], [0.0; 3]);
        for axis in 0..dimensions {
            let what = format!("DISAMP, motion along {} of node {number}", ["x", "y", "z"][axis]);
            let [in_phase, out_of_phase] = self.numbers(&what, &repeated(0, 1, 9, 2), [3; 2], Blank::Zero)?;
            (sine[axis], cosine[axis]) = (in_phase.value, out_of_phase.value);
        }
        if dimensions == 2 {
            self.skip_text_row();
        }
        let moves = sine.iter().chain(&cosine).any(|amplitude| *amplitude != 0.0);
        if moves && deck.motion == MotionKind::Sinusoidal {
            self.positive(&what, frequency)?;
        }
        Ok(NodeConstraint {
            node: number - 1,
            axes,
            reference,
            stiffness,
            damping,
            force,
            mass,
            frequency: frequency.value,
            sine,
            cosine,
        })
    }

    /// Direction cosines of the primary and first perpendicular axis (in 2-D of the primary one), and the reference position. The
    /// second perpendicular axis, where it is written, follows from these two.
    fn cosines(&mut self, what: &str, dimensions: usize) -> Result<[f64; 3], Error> {
        let at = |before, width| Columns { before, width };
        let line = self.line(what, Blank::Zero)?;
        let blocks: Vec<Columns> = vec![at(4, 8), at(16, 8), at(28, 8), at(40, 10)];
        let whole = match cut(line, &blocks) {
            Cut::InColumns(found) => found,
            Cut::Words(words) => {
                self.note_off();
                let numbers: Vec<Found> = words.into_iter().take_while(|word| number(&word.text).is_some()).collect();
                let zero = || Found { text: String::new(), column: 1 };
                match (dimensions, numbers.as_slice()) {
                    (2, [primary, position]) => vec![primary.clone(), zero(), zero(), position.clone()],
                    (_, [primary, first, position]) => vec![primary.clone(), first.clone(), zero(), position.clone()],
                    (_, [_, _, _, _]) => numbers,
                    _ => return Err(self.missing(what, line, numbers.len(), dimensions + 1)),
                }
            }
        };
        let mut row = [0.0; 3];
        for (value, column) in row.iter_mut().zip([0, 1, 3]) {
            *value = self.value(what, &whole[column], if column == 3 { 3 } else { 5 })?.value;
        }
        Ok(row)
    }

    /// Two axes must be directions, and different ones.
    fn span(&self, axes: &[Triple; 2], node: usize, line: usize) -> Result<(), Error> {
        let size = |a: &Triple| (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
        let [a, b] = axes;
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        if size(&cross) > 1.0e-4 * size(a) * size(b) {
            return Ok(());
        }
        let value = format!("{a:?} and {b:?}");
        let allowed = "the primary and the first perpendicular axis must be two directions that are not parallel".to_string();
        let problem = DeckProblem::NotAllowed { value, allowed };
        Err(self.error(&format!("REFCOS of node {node}"), Spot { line, column: 5 }, problem))
    }

    fn environment(&mut self, deck: &mut Deck) -> Result<(), Error> {
        let dimensions = deck.dimensions;
        let rows = self.counted_in_text("NVC, the number of depths with a current", 14)?.value as usize;
        self.text();
        for index in 0..rows {
            let what = format!("VC, depth and current {} of {rows}", index + 1);
            let mut row = [Number::default(); 4];
            let columns = repeated(0, 0, 10, 1 + dimensions);
            let line = self.line(&what, Blank::Zero)?;
            self.fill(&mut row[..=dimensions], &what, line, &columns, &[4; 4][..=dimensions])?;
            self.spots.push((Item::Current(index), row[0].spot));
            if deck.currents.iter().any(|(y, _)| *y == row[0].value) {
                self.refuse(&what, row[0], "a row before has the same depth; give one velocity for each".into())?;
            }
            deck.currents.push((row[0].value, [row[1].value, row[2].value, row[3].value]));
        }
        self.text_lines(3)?;
        let [amplitude, frequency] =
            self.numbers("AW and SIGMAW, amplitude and frequency of the wave", &repeated(0, 0, 10, 2), [6, 5], Blank::Zero)?;
        self.spots.push((Item::Waves, amplitude.spot));
        let [direction] = self.numbers("DIRW, direction of the wave", &repeated(0, 0, 10, 1), [7], Blank::Zero)?;
        deck.wave_amplitude = self.not_negative("AW, amplitude of the wave", amplitude)?;
        if deck.wave_amplitude > 0.0 {
            self.positive("SIGMAW, frequency of the wave", frequency)?;
        }
        (deck.wave_frequency, deck.wave_direction) = (frequency.value, direction.value);
        Ok(())
    }
}

/// What a number must be.
#[derive(Clone, Copy)]
enum Least {
    Zero,
    MoreThanZero,
}

/// Lines and numbers.
impl<'a> Reader<'a> {
    /// Passes over lines that say nothing, up to a line that does.
    fn text(&mut self) {
        while self.lines.get(self.done).is_some_and(|line| says_nothing(line)) {
            self.done += 1;
        }
    }

    /// Passes over as many lines of text as in 1994: the line of numbers behind them may be empty.
    fn text_lines(&mut self, count: usize) -> Result<(), Error> {
        if self.lenient {
            self.text();
            return Ok(());
        }
        for _ in 0..count {
            let line = self.lines.get(self.done).copied().unwrap_or_default();
            if let Some(word) = first_word(line).filter(|word| number(word).is_some()) {
                let problem = DeckProblem::Unreadable { found: word, expected: "a text or an empty line".into() };
                return Err(self.error("a line of text", Spot { line: self.done + 1, column: 1 }, problem));
            }
            self.done += 1;
        }
        Ok(())
    }

    /// In 2-D the rows along z are empty, or hold their phrase only.
    fn skip_text_row(&mut self) {
        if self.lines.get(self.done).is_some_and(|line| says_nothing(line)) {
            self.done += 1;
        }
    }

    /// The next line of numbers.
    fn line(&mut self, what: &str, blank: Blank) -> Result<&'a str, Error> {
        let Some(line) = self.lines.get(self.done).copied() else {
            let line = self.lines.len().max(1);
            let column = self.lines.last().map_or(0, |line| line.chars().count()) + 1;
            return Err(self.error(what, Spot { line, column }, DeckProblem::Ends));
        };
        self.done += 1;
        if line.trim().is_empty() && blank == Blank::Fault {
            let problem = DeckProblem::Unreadable { found: "an empty line".into(), expected: "a number".into() };
            return Err(self.error(what, Spot { line: self.done, column: 1 }, problem));
        }
        Ok(line)
    }

    /// The numbers of the next line; `decimals` are those of its FORMAT.
    fn numbers<const N: usize>(
        &mut self,
        what: &str,
        columns: &[Columns],
        decimals: [i32; N],
        blank: Blank,
    ) -> Result<[Number; N], Error> {
        let line = self.line(what, blank)?;
        let mut numbers = [Number::default(); N];
        self.fill(&mut numbers, what, line, columns, &decimals)?;
        Ok(numbers)
    }

    fn fill(
        &mut self,
        numbers: &mut [Number],
        what: &str,
        line: &str,
        columns: &[Columns],
        decimals: &[i32],
    ) -> Result<(), Error> {
        let found = match cut(line, columns) {
            Cut::InColumns(found) => found,
            Cut::Words(words) => {
                if let Some(bad) = words.iter().find(|word| number(&word.text).is_none()) {
                    self.value(what, bad, 0)?;
                }
                if words.len() < columns.len() {
                    return Err(self.missing(what, line, words.len(), columns.len()));
                }
                self.note_off();
                words
            }
        };
        for ((number, found), decimals) in numbers.iter_mut().zip(&found).zip(decimals) {
            *number = self.value(what, found, *decimals)?;
        }
        Ok(())
    }

    fn vector(&mut self, what: &str, width: usize, decimals: i32, dimensions: usize, blank: Blank) -> Result<Triple, Error> {
        let line = self.line(what, blank)?;
        let mut numbers = [Number::default(); 3];
        self.fill(&mut numbers[..dimensions], what, line, &repeated(0, 1, width, dimensions), &[decimals; 3])?;
        Ok(numbers.map(|number| number.value))
    }

    fn vector_at(&mut self, what: &str, columns: &[Columns], decimals: i32) -> Result<Triple, Error> {
        let line = self.line(what, Blank::Zero)?;
        let mut numbers = [Number::default(); 3];
        self.fill(&mut numbers[..columns.len()], what, line, columns, &[decimals; 3])?;
        Ok(numbers.map(|number| number.value))
    }

    /// A whole number of the indexes.
    fn count(&mut self, what: &str, least: usize, most: usize) -> Result<usize, Error> {
        let [number] = self.numbers(what, &[Columns { before: 1, width: 3 }], [0], Blank::Fault)?;
        let count = self.whole(what, number)?;
        if !(least..=most).contains(&count) {
            let allowed =
                if most == usize::MAX { format!("it must be {least} or more") } else { format!("it must be {least} to {most}") };
            self.refuse(what, number, allowed)?;
        }
        Ok(count)
    }

    /// A whole number inside a line of text, at its column or wherever the first digits stand.
    fn counted_in_text(&mut self, what: &str, before: usize) -> Result<Number, Error> {
        while self.lines.get(self.done).is_some_and(|line| !line.contains(|c: char| c.is_ascii_digit())) {
            self.done += 1;
        }
        let line = self.line(what, Blank::Fault)?;
        let characters: Vec<char> = line.chars().collect();
        let digits = |from: usize| characters[from..].iter().take_while(|c| c.is_ascii_digit()).collect::<String>();
        let start = |from: usize| characters.iter().enumerate().skip(from).find(|(_, c)| c.is_ascii_digit()).map(|(at, _)| at);
        let in_columns = start(before).filter(|at| at - before < 3 && (*at == 0 || !characters[at - 1].is_ascii_digit()));
        let Some(at) = in_columns.or_else(|| start(0)) else {
            let problem =
                DeckProblem::Unreadable { found: format!("`{}`", line.trim()), expected: "a whole number in it".into() };
            return Err(self.error(what, Spot { line: self.done, column: before + 1 }, problem));
        };
        let number = Found { text: digits(at), column: at + 1 };
        let number = self.value(what, &number, 0)?;
        self.whole(what, number)?;
        Ok(number)
    }

    fn whole(&self, what: &str, number: Number) -> Result<usize, Error> {
        if number.value >= 0.0 && number.value.fract() == 0.0 {
            return Ok(number.value as usize);
        }
        self.refuse(what, number, "it must be a whole number, not negative".into())?;
        Ok(0)
    }

    fn value(&mut self, what: &str, found: &Found, decimals: i32) -> Result<Number, Error> {
        let spot = Spot { line: self.done, column: found.column };
        if found.text.is_empty() {
            return Ok(Number { value: 0.0, spot });
        }
        let lower = found.text.to_lowercase();
        let word = lower.trim_start_matches(['+', '-']);
        let problem = match number(&found.text) {
            Some((value, point)) if value.abs() <= LARGEST => {
                if !point && decimals > 0 && value != 0.0 {
                    self.note_pointless(spot, &found.text, implied(value, decimals));
                }
                return Ok(Number { value, spot });
            }
            Some(_) => DeckProblem::NotFinite { text: found.text.clone() },
            None if word.starts_with("nan") || word.starts_with("inf") => DeckProblem::NotFinite { text: found.text.clone() },
            None if found.text.starts_with("**") => DeckProblem::Stars,
            None => DeckProblem::Unreadable {
                found: format!("`{}`", found.text.chars().take(40).collect::<String>()),
                expected: "a number".into(),
            },
        };
        Err(self.error(what, spot, problem))
    }

    fn positive(&self, what: &str, number: Number) -> Result<f64, Error> {
        if number.value <= 0.0 {
            self.refuse(what, number, "it must be greater than zero".into())?;
        }
        Ok(number.value)
    }

    fn not_negative(&self, what: &str, number: Number) -> Result<f64, Error> {
        if number.value < 0.0 {
            self.refuse(what, number, "it must not be negative".into())?;
        }
        Ok(number.value)
    }

    fn refuse(&self, what: &str, number: Number, allowed: String) -> Result<(), Error> {
        Err(self.error(what, number.spot, DeckProblem::NotAllowed { value: format!("{}", number.value), allowed }))
    }

    fn missing(&self, what: &str, line: &str, found: usize, expected: usize) -> Error {
        let last = self.done == self.lines.len();
        let problem = if last { DeckProblem::Ends } else { DeckProblem::TooFew { found, expected } };
        self.error(what, Spot { line: self.done, column: line.trim_end().chars().count() + 1 }, problem)
    }

    fn error(&self, what: &str, Spot { line, column }: Spot, problem: DeckProblem) -> Error {
        Error::Deck { file: self.file.into(), line, column, item: what.into(), problem: problem.into() }
    }

    fn note_off(&mut self) {
        if self.off.1 == 0 {
            self.off.0 = self.done;
        }
        self.off.1 += 1;
    }

    fn note_pointless(&mut self, spot: Spot, text: &str, implied: f64) {
        if self.pointless.1 == 0 {
            self.pointless.0 = format!(
                "line {}, column {}: {text} has no decimal point and is taken as written; the 1994 program would take it for {implied}",
                spot.line, spot.column
            );
        }
        self.pointless.1 += 1;
    }
}

/// Whether a line has no numbers to give: it is blank, or its first word is a word.
fn says_nothing(line: &str) -> bool {
    first_word(line).is_none_or(|word| {
        let letters = word.starts_with(|c: char| c.is_alphabetic()) && !word.contains(|c: char| c.is_ascii_digit());
        letters && !["nan", "inf", "infinity"].contains(&word.to_lowercase().as_str())
    })
}

/// Where a text ends before it has given a number of nodes, or has no digit in its place, it is no CABLE file at all.
fn neither(error: Error) -> Error {
    let elsewhere = |problem: &DeckProblem| match problem {
        DeckProblem::Unreadable { found, .. } => !found.contains(|c: char| c.is_ascii_digit()),
        problem => *problem == DeckProblem::Ends,
    };
    match error {
        Error::Deck { file, line, column, item, problem } if elsewhere(&problem) => {
            Error::Deck { file, line, column, item, problem: DeckProblem::Neither.into() }
        }
        other => other,
    }
}

/// Whether springs hold the direction of an axis fast.
pub fn locks(stiffness: f64) -> bool {
    stiffness >= LOCK
}
