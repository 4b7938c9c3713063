//! The sections of a MoorDyn file: headers of dashes, and the rows under them without comments, names and units of columns.

use crate::error::{Error, MoorDynProblem};

/// No number of a file is larger.
const LARGEST: f64 = 1.0e15;

/// What a section holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Kinds of lines.
    LineTypes,
    /// Kinds of rods.
    RodTypes,
    /// Bodies.
    Bodies,
    /// Rods.
    Rods,
    /// Points.
    Points,
    /// Lines.
    Lines,
    /// Breaking of lines, which MoorDyn-F has.
    Failure,
    /// Winches, which MoorDyn-F has.
    Control,
    /// Loads, which MoorDyn-F has.
    ExternalLoads,
    /// The past of ropes by the Syrope model.
    SyropeIc,
    /// Options.
    Options,
    /// Output channels.
    Outputs,
    /// The last header, or one that is not known.
    Other,
}

/// Words of headers. The first that a header has counts.
const HEADERS: [(&str, Kind); 27] = [
    ("LINE DICTIONARY", Kind::LineTypes),
    ("LINE TYPES", Kind::LineTypes),
    ("ROD DICTIONARY", Kind::RodTypes),
    ("ROD TYPES", Kind::RodTypes),
    ("BODIES", Kind::Bodies),
    ("BODY LIST", Kind::Bodies),
    ("BODY PROPERTIES", Kind::Bodies),
    ("RODS", Kind::Rods),
    ("ROD LIST", Kind::Rods),
    ("ROD PROPERTIES", Kind::Rods),
    ("POINTS", Kind::Points),
    ("POINT LIST", Kind::Points),
    ("POINT PROPERTIES", Kind::Points),
    ("CONNECTIONS", Kind::Points),
    ("CONNECTION PROPERTIES", Kind::Points),
    ("NODE PROPERTIES", Kind::Points),
    ("SYROPE IC", Kind::SyropeIc),
    ("FAILURE", Kind::Failure),
    ("CONTROL", Kind::Control),
    ("EXTERNAL LOADS", Kind::ExternalLoads),
    ("LINES", Kind::Lines),
    ("LINE LIST", Kind::Lines),
    ("LINE PROPERTIES", Kind::Lines),
    ("SOLVER OPTIONS", Kind::Options),
    ("OPTIONS", Kind::Options),
    ("OUTPUTS", Kind::Outputs),
    ("OUTPUT", Kind::Outputs),
];

/// A row of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<'a> {
    /// Line of the text, from 1.
    pub number: usize,
    /// The line without its comment.
    pub text: &'a str,
    /// Its words.
    pub words: Vec<&'a str>,
}

/// A section.
#[derive(Debug, Clone, PartialEq)]
pub struct Section<'a> {
    /// What it holds.
    pub kind: Kind,
    /// Its header.
    pub header: Row<'a>,
    /// Names of the columns; empty where there are none.
    pub columns: Vec<&'a str>,
    /// Units of the columns; empty where there are none.
    pub units: Vec<&'a str>,
    /// Its rows.
    pub rows: Vec<Row<'a>>,
}

/// A file in its sections.
#[derive(Debug, Clone, PartialEq)]
pub struct Sections<'a> {
    /// First line of the front matter that says something.
    pub title: String,
    /// Sections in their order.
    pub all: Vec<Section<'a>>,
}

/// A number of a row; `item` names what it is.
pub fn number(row: &Row, file: &str, item: &'static str, word: &str) -> Result<f64, Error> {
    // Fortran writes exponents with a D.
    let value = word.parse::<f64>().or_else(|_| word.replace(['d', 'D'], "e").parse::<f64>());
    match value {
        Ok(value) if value.abs() <= LARGEST => Ok(value),
        Ok(_) => Err(row.unreadable(file, item, word, "a finite number of at most 1e15 in size")),
        Err(_) => Err(row.unreadable(file, item, word, "a number")),
    }
}

/// Whether a text is a MoorDyn file: a header of its says that lines, points, bodies or rods follow.
pub fn is_deck(text: &str) -> bool {
    let holds = |line: &str| {
        matches!(header(line), Some(Kind::LineTypes | Kind::RodTypes | Kind::Bodies | Kind::Rods | Kind::Points | Kind::Lines))
    };
    !text.trim_start().starts_with(['{', '[']) && text.lines().any(holds)
}

/// What a header announces; none: the line is no header.
fn header(line: &str) -> Option<Kind> {
    let line = line.trim_start();
    if !line.starts_with("---") {
        return None;
    }
    let upper = line.to_uppercase();
    Some(HEADERS.iter().find(|(words, _)| upper.contains(words)).map_or(Kind::Other, |(_, kind)| *kind))
}

/// Cuts a text into its sections.
pub fn cut<'a>(text: &'a str, file: &str) -> Result<Sections<'a>, Error> {
    let mut title = String::new();
    let mut all: Vec<Section<'a>> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let row = Row { number: index + 1, text: line.trim(), words: line.split_whitespace().collect() };
        if row.words.is_empty() || row.text.starts_with('!') {
            continue;
        }
        if let Some(kind) = header(line) {
            all.push(Section { kind, header: row, columns: Vec::new(), units: Vec::new(), rows: Vec::new() });
            continue;
        }
        match all.last_mut() {
            Some(section) if section.kind != Kind::Other => section.rows.push(row),
            _ if title.is_empty() && !row.words.get(1).is_some_and(|word| word.eq_ignore_ascii_case("echo")) => {
                title = row.text.to_string();
            }
            _ => {}
        }
    }
    for (index, section) in all.iter().enumerate() {
        let first = all[..index].iter().find(|other| other.kind == section.kind && section.kind != Kind::Other);
        if let Some(first) = first {
            return Err(section.header.error(file, MoorDynProblem::Twice { first_line: first.header.number }));
        }
    }
    all.iter_mut().try_for_each(|section| section.take_labels(file))?;
    Ok(Sections { title, all })
}

impl Section<'_> {
    /// Takes names and units of columns, and a count of rows where old files have one, out of the rows of a table.
    fn take_labels(&mut self, file: &str) -> Result<(), Error> {
        if matches!(self.kind, Kind::Options | Kind::Outputs | Kind::Other) {
            return Ok(());
        }
        let is_number = |word: &&str| word.parse::<f64>().is_ok();
        let counts = |row: &Row| is_number(&row.words[0]) && row.words.get(1).is_some_and(|word| word.starts_with('N'));
        if self.rows.first().is_some_and(counts) {
            self.rows.remove(0);
        }
        if !self.rows.is_empty() {
            self.columns = self.rows.remove(0).words;
        }
        if let Some(units) = self.rows.first() {
            let numbers = units.words.iter().filter(|word| is_number(word)).count();
            if !units.text.contains(['(', '[']) && numbers >= 3 {
                return Err(units.error(file, MoorDynProblem::NoUnits));
            }
            self.units = self.rows.remove(0).words;
        }
        Ok(())
    }
}

impl Row<'_> {
    /// The error for a problem of this row.
    pub fn error(&self, file: &str, problem: MoorDynProblem) -> Error {
        Error::MoorDyn { file: file.into(), line: self.number, text: self.text.into(), problem: problem.into() }
    }

    /// Something else stands here than what is expected.
    pub fn unreadable(&self, file: &str, item: &'static str, found: &str, expected: &'static str) -> Error {
        self.error(file, MoorDynProblem::Unreadable { item, found: format!("\"{found}\""), expected })
    }

    /// What no scene can hold.
    pub fn cannot(&self, file: &str, item: &str, reason: &str) -> Error {
        self.error(file, MoorDynProblem::CannotHold { item: item.into(), reason: reason.into() })
    }
}
