//! Reading a MoorDyn file, of version 1 or 2: rows into numbers and names. Columns count by their place, as in MoorDyn, not by their names;
//! names tell only the two orders apart in which rows of lines have been written.

use crate::error::{Error, MoorDynProblem};
use crate::scene::moordyn::beside;
use crate::scene::moordyn::options::{self, Options};
use crate::scene::moordyn::outputs;
use crate::scene::moordyn::sections::{self, Kind, Row, Section, Sections, number};
use crate::scene::moordyn::words::{self, Attachment, LineEnd};
use crate::scene::moordyn::{Deck, DeckBody, DeckLine, DeckPoint, DeckRod, LineKind, RodKind, Stiffness};
use crate::scene::types::Triple;
use std::path::Path;

/// Most segments of a line.
const MOST: usize = 20_000;

/// A file as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// What it says.
    pub deck: Deck,
    /// What is allowed but may not be meant.
    pub warnings: Vec<String>,
}

/// Reads the text of a MoorDyn file; `file` is for messages, files beside it are looked for in `directory`, and `start` has the options that the
/// file does not say.
pub fn read(text: &str, file: &str, directory: &Path, start: Options) -> Result<Reading, Error> {
    let sections = sections::cut(text, file)?;
    let reader = Reader { file, directory, sections: &sections };
    for kind in [Kind::Failure, Kind::Control, Kind::ExternalLoads, Kind::SyropeIc] {
        reader.has_no_rows(kind)?;
    }
    let mut warnings = reader.remarks();
    let line_types = reader.line_types(&mut warnings)?;
    let rod_types = reader.rod_types()?;
    let bodies = reader.bodies()?;
    let rods = reader.rods(&rod_types)?;
    let points = reader.points()?;
    let lines = reader.lines(&line_types)?;
    if lines.is_empty() {
        let last = text.lines().count();
        let text = text.lines().last().unwrap_or_default().trim().to_string();
        return Err(Error::MoorDyn {
            file: file.into(),
            line: last,
            text,
            problem: Box::new(MoorDynProblem::NoSection { section: "LINES with a line in it" }),
        });
    }
    let options = options::read(reader.section(Kind::Options), file, start)?;
    warnings.extend(options.warnings.iter().cloned());
    let (outputs, unknown) = outputs::read(reader.section(Kind::Outputs));
    warnings.extend(unknown);
    let deck = Deck { title: sections.title.clone(), line_types, rod_types, bodies, rods, points, lines, options, outputs };
    warnings.extend(deck.outputs.iter().filter_map(|channel| deck.cannot_write(channel)));
    Ok(Reading { deck, warnings })
}

struct Reader<'a> {
    file: &'a str,
    directory: &'a Path,
    sections: &'a Sections<'a>,
}

impl<'a> Reader<'a> {
    fn section(&self, kind: Kind) -> Option<&'a Section<'a>> {
        self.sections.all.iter().find(|section| section.kind == kind)
    }

    fn rows(&self, kind: Kind) -> &'a [Row<'a>] {
        self.section(kind).map(|section| section.rows.as_slice()).unwrap_or_default()
    }

    /// Sections of what no scene has.
    fn has_no_rows(&self, kind: Kind) -> Result<(), Error> {
        let Some(row) = self.rows(kind).first() else { return Ok(()) };
        let reason = match kind {
            Kind::Failure => {
                "lines do not break here; leave the section out, and give the line type a `breaking_load` that warns"
            }
            Kind::Control => "lengths do not change while a scene runs; leave the section out",
            Kind::ExternalLoads => "give the body of a scene `force`, `damping` or `quadratic_damping`, the point `force`",
            _ => "the Syrope model of ropes is not there; give the line type a table of strain and tension",
        };
        Err(row.cannot(self.file, "this section", reason))
    }

    /// Headers that are not known and have rows, apart from what stands after the last.
    fn remarks(&self) -> Vec<String> {
        let known = self.sections.all.iter().rposition(|section| section.kind != Kind::Other).unwrap_or(0);
        let lost =
            self.sections.all[..known].iter().skip(1).filter(|section| section.kind == Kind::Other && !section.rows.is_empty());
        lost.map(|section| {
            format!("line {}, `{}`: no section is called so; its rows are left out", section.header.number, section.header.text)
        })
        .collect()
    }

    fn number(&self, row: &Row, item: &'static str, word: usize) -> Result<f64, Error> {
        number(row, self.file, item, row.words[word])
    }

    /// A number that must not be negative.
    fn size(&self, row: &Row, item: &'static str, word: usize) -> Result<f64, Error> {
        let value = self.number(row, item, word)?;
        if value >= 0.0 {
            Ok(value)
        } else {
            Err(row.unreadable(self.file, item, row.words[word], "a number that is not negative"))
        }
    }

    /// A number greater than zero.
    fn positive(&self, row: &Row, item: &'static str, word: usize) -> Result<f64, Error> {
        let value = self.number(row, item, word)?;
        if value > 0.0 { Ok(value) } else { Err(row.unreadable(self.file, item, row.words[word], "a number greater than 0")) }
    }

    fn triple(&self, row: &Row, items: [&'static str; 3], word: usize) -> Result<Triple, Error> {
        Ok([self.number(row, items[0], word)?, self.number(row, items[1], word + 1)?, self.number(row, items[2], word + 2)?])
    }

    fn whole(&self, row: &Row, item: &'static str, word: usize, least: usize) -> Result<usize, Error> {
        match row.words[word].parse::<usize>() {
            Ok(value) if (least..=MOST).contains(&value) => Ok(value),
            _ => Err(row.unreadable(
                self.file,
                item,
                row.words[word],
                if least == 0 { "a whole number from 0 to 20000" } else { "a whole number from 1 to 20000" },
            )),
        }
    }

    /// Numbers in one word, with bars between them.
    fn barred(
        &self,
        row: &Row,
        item: &'static str,
        word: usize,
        counts: &'static [usize],
        expected: &'static str,
    ) -> Result<Vec<f64>, Error> {
        let parts: Vec<f64> =
            row.words[word].split('|').map(|part| number(row, self.file, item, part)).collect::<Result<_, _>>()?;
        if counts.contains(&parts.len()) { Ok(parts) } else { Err(row.unreadable(self.file, item, row.words[word], expected)) }
    }

    fn needs(&self, row: &Row, needed: usize, columns: &'static str) -> Result<(), Error> {
        if row.words.len() >= needed {
            return Ok(());
        }
        Err(row.error(self.file, MoorDynProblem::TooFew { found: row.words.len(), needed, columns }))
    }

    fn id(&self, row: &Row, item: &'static str, taken: impl Iterator<Item = (u32, usize)>) -> Result<u32, Error> {
        let id = row.words[0].parse::<u32>().ok().filter(|id| *id > 0);
        let id = id.ok_or_else(|| row.unreadable(self.file, item, row.words[0], "a whole number greater than 0"))?;
        self.free(row, item, &id.to_string(), taken.into_iter().find(|(other, _)| *other == id).map(|(_, row)| row))?;
        Ok(id)
    }

    fn free(&self, row: &Row, item: &'static str, name: &str, first: Option<usize>) -> Result<(), Error> {
        match first {
            Some(first_line) => Err(row.error(self.file, MoorDynProblem::Taken { item, name: name.into(), first_line })),
            None => Ok(()),
        }
    }

    fn attachment(&self, row: &Row, item: &'static str, word: usize, known: &[&str]) -> Result<Attachment, Error> {
        words::attachment(row.words[word]).ok_or_else(|| {
            let known = known.iter().map(ToString::to_string).collect();
            row.error(self.file, MoorDynProblem::Unknown { item, name: row.words[word].to_string(), known })
        })
    }

    fn line_types(&self, warnings: &mut Vec<String>) -> Result<Vec<LineKind>, Error> {
        let section = self.section(Kind::LineTypes);
        let mut kinds: Vec<LineKind> = Vec::new();
        let mut swapped = false;
        for row in self.rows(Kind::LineTypes) {
            self.needs(row, 9, "name, diameter, mass per length, EA, BA, EI, Cd, Ca, CdAx, CaAx (version 1: without EI, then Can, Cat, Cdn, Cdt)")?;
            // Rows of version 1 have one value less and another order; a text may follow the values of both.
            let numbers = row.words.iter().skip(6).take_while(|word| word.parse::<f64>().is_ok()).count();
            let has_bending = section.is_some_and(|section| section.columns.iter().any(|name| name.eq_ignore_ascii_case("EI")));
            let first_version = numbers == 3 && row.words[5].parse::<f64>().is_ok() && !has_bending;
            if !first_version {
                self.needs(row, 10, "name, diameter, mass per length, EA, BA, EI, Cd, Ca, CdAx, CaAx")?;
            }
            let (name, at) = (row.words[0].to_string(), if first_version { [7, 5, 8, 6] } else { [6, 7, 8, 9] });
            self.free(row, "line type", &name, kinds.iter().find(|kind| kind.name == name).map(|kind| kind.row))?;
            if !first_version && row.words.get(10).is_some_and(|word| word.parse::<f64>().is_ok_and(|lift| lift != 0.0)) {
                return Err(row.cannot(
                    self.file,
                    "Cl",
                    "vortex-induced vibration is not modelled; set Cl to 0 to go without it",
                ));
            }
            swapped |= !first_version && section.is_some_and(|section| can_before_cd(&section.columns));
            kinds.push(LineKind {
                row: row.number,
                name,
                diameter: self.positive(row, "diameter", 1)?,
                mass: self.positive(row, "mass per length", 2)?,
                stiffness: self.stiffness(row)?,
                damping: self.damping(row)?,
                ei: if first_version { 0.0 } else { self.bending(row)? },
                drag: self.size(row, "Cd", at[0])?,
                added_mass: self.size(row, "Ca", at[1])?,
                drag_along: self.size(row, "CdAx", at[2])?,
                added_mass_along: self.size(row, "CaAx", at[3])?,
            });
        }
        if swapped {
            warnings.push(String::from(
                "LINE TYPES: the names of the columns have added mass before drag, but version 2 reads Cd, Ca, CdAx, CaAx by their place, \
                 and so do we",
            ));
        }
        Ok(kinds)
    }

    fn stiffness(&self, row: &Row) -> Result<Stiffness, Error> {
        let word = row.words[3];
        if word.to_uppercase().starts_with("SYROPE:") {
            let reason = "the Syrope model of ropes is not there; give a table of strain and tension";
            return Err(row.cannot(self.file, "EA", reason));
        }
        if word.contains('|') {
            let reason = "a static and a dynamic stiffness in one are not modelled; give one of them: the static one for mean offsets, the \
                          dynamic one for motions in waves";
            return Err(row.cannot(self.file, "EA", reason));
        }
        if looks_like_file(word) {
            return Ok(Stiffness::Table(beside::curve(self.directory, word)?));
        }
        Ok(Stiffness::Linear(self.positive(row, "EA", 3)?))
    }

    fn damping(&self, row: &Row) -> Result<f64, Error> {
        if row.words[4].contains('|') || looks_like_file(row.words[4]) {
            return Err(row.cannot(
                self.file,
                "BA",
                "damping is one number here: BA in N·s, or minus the share of the critical one",
            ));
        }
        self.number(row, "BA", 4)
    }

    fn bending(&self, row: &Row) -> Result<f64, Error> {
        if looks_like_file(row.words[5]) {
            return Err(row.cannot(self.file, "EI", "a table of bending stiffness is not modelled; give one number"));
        }
        self.size(row, "EI", 5)
    }

    fn rod_types(&self) -> Result<Vec<RodKind>, Error> {
        let mut kinds: Vec<RodKind> = Vec::new();
        for row in self.rows(Kind::RodTypes) {
            self.needs(row, 7, "name, diameter, mass per length, Cd, Ca, CdEnd, CaEnd")?;
            let name = row.words[0].to_string();
            self.free(row, "rod type", &name, kinds.iter().find(|kind| kind.name == name).map(|kind| kind.row))?;
            kinds.push(RodKind {
                row: row.number,
                name,
                diameter: self.positive(row, "diameter", 1)?,
                mass: self.size(row, "mass per length", 2)?,
                drag: self.size(row, "Cd", 3)?,
                added_mass: self.size(row, "Ca", 4)?,
                end_drag: self.size(row, "CdEnd", 5)?,
                end_added_mass: self.size(row, "CaEnd", 6)?,
            });
        }
        Ok(kinds)
    }

    fn bodies(&self) -> Result<Vec<DeckBody>, Error> {
        let mut bodies: Vec<DeckBody> = Vec::new();
        for row in self.rows(Kind::Bodies) {
            self.needs(row, 14, "number, attachment, X0, Y0, Z0, roll, pitch, yaw, mass, CG, I, volume, CdA, Ca")?;
            let three = "1 or 3 numbers with bars between them";
            let of_three = |parts: Vec<f64>| if parts.len() == 3 { [parts[0], parts[1], parts[2]] } else { [parts[0]; 3] };
            let centre = self.barred(row, "CG", 9, &[1, 3], three)?;
            let drag = self.barred(row, "CdA", 12, &[1, 2, 3, 6], "1, 2, 3 or 6 numbers with bars between them")?;
            bodies.push(DeckBody {
                row: row.number,
                id: self.id(row, "body", bodies.iter().map(|body| (body.id, body.row)))?,
                attachment: self.attachment(row, "attachment of a body", 1, &["Fixed", "Coupled", "Free"])?,
                position: self.triple(row, ["X0", "Y0", "Z0"], 2)?,
                attitude: self.triple(row, ["roll", "pitch", "yaw"], 5)?,
                mass: self.size(row, "mass", 8)?,
                centre: if centre.len() == 1 { [0.0, 0.0, centre[0]] } else { of_three(centre) },
                inertia: of_three(self.barred(row, "I", 10, &[1, 3], three)?),
                volume: self.size(row, "volume", 11)?,
                drag_area: std::array::from_fn(|way| match drag.len() {
                    2 => drag[way / 3],
                    count => drag[way % count],
                }),
                added_mass: of_three(self.barred(row, "Ca", 13, &[1, 3], three)?),
            });
        }
        Ok(bodies)
    }

    fn rods(&self, kinds: &[RodKind]) -> Result<Vec<DeckRod>, Error> {
        let mut rods: Vec<DeckRod> = Vec::new();
        for row in self.rows(Kind::Rods) {
            self.needs(row, 10, "number, rod type, attachment, Xa, Ya, Za, Xb, Yb, Zb, segments")?;
            let names: Vec<String> = kinds.iter().map(|kind| kind.name.clone()).collect();
            rods.push(DeckRod {
                row: row.number,
                id: self.id(row, "rod", rods.iter().map(|rod| (rod.id, rod.row)))?,
                kind: self.kind(row, "rod type", &names)?,
                attachment: self.attachment(row, "attachment of a rod", 2, &["Fixed", "Coupled", "Free", "Body1"])?,
                a: self.triple(row, ["Xa", "Ya", "Za"], 3)?,
                b: self.triple(row, ["Xb", "Yb", "Zb"], 6)?,
                segments: self.whole(row, "segments", 9, 0)?,
            });
        }
        Ok(rods)
    }

    /// The kind that the second word names.
    fn kind(&self, row: &Row, item: &'static str, names: &[String]) -> Result<usize, Error> {
        names.iter().position(|name| name == row.words[1]).ok_or_else(|| {
            row.error(self.file, MoorDynProblem::Unknown { item, name: row.words[1].to_string(), known: names.to_vec() })
        })
    }

    fn points(&self) -> Result<Vec<DeckPoint>, Error> {
        let mut points: Vec<DeckPoint> = Vec::new();
        for row in self.rows(Kind::Points) {
            self.needs(row, 9, "number, type, X, Y, Z, mass, volume, CdA, Ca (version 1 may have FX, FY, FZ before CdA)")?;
            // Rows with forces have three values more; a text may follow the values of both.
            let numbers = row.words.iter().skip(2).take_while(|word| word.parse::<f64>().is_ok()).count();
            let forces = numbers >= 10;
            let drag = if forces { 10 } else { 7 };
            points.push(DeckPoint {
                row: row.number,
                id: self.id(row, "point", points.iter().map(|point| (point.id, point.row)))?,
                attachment: self.attachment(
                    row,
                    "type of a point",
                    1,
                    &["Fixed", "Coupled", "Free", "Vessel", "Connect", "Body1"],
                )?,
                position: self.triple(row, ["X", "Y", "Z"], 2)?,
                mass: self.size(row, "mass", 5)?,
                volume: self.size(row, "volume", 6)?,
                force: if forces { self.triple(row, ["FX", "FY", "FZ"], 7)? } else { [0.0; 3] },
                drag_area: self.size(row, "CdA", drag)?,
                added_mass: self.size(row, "Ca", drag + 1)?,
            });
        }
        Ok(points)
    }

    fn lines(&self, kinds: &[LineKind]) -> Result<Vec<DeckLine>, Error> {
        let mut lines: Vec<DeckLine> = Vec::new();
        let columns = self.section(Kind::Lines).map(|section| section.columns.as_slice()).unwrap_or_default();
        let (end, length) = if length_comes_first(columns) { (4, 2) } else { (2, 4) };
        let names: Vec<String> = kinds.iter().map(|kind| kind.name.clone()).collect();
        for row in self.rows(Kind::Lines) {
            let columns = if end == 4 {
                "number, line type, unstretched length, segments, end at the anchor, end at the fairlead"
            } else {
                "number, line type, end A, end B, unstretched length, segments"
            };
            self.needs(row, 6, columns)?;
            lines.push(DeckLine {
                row: row.number,
                id: self.id(row, "line", lines.iter().map(|line| (line.id, line.row)))?,
                kind: self.kind(row, "line type", &names)?,
                ends: [self.line_end(row, end)?, self.line_end(row, end + 1)?],
                length: self.positive(row, "unstretched length", length)?,
                segments: self.whole(row, "segments", length + 1, 1)?,
            });
        }
        Ok(lines)
    }

    fn line_end(&self, row: &Row, word: usize) -> Result<LineEnd, Error> {
        let expected = "the number of a point, or an end of a rod such as R1A";
        words::line_end(row.words[word]).ok_or_else(|| row.unreadable(self.file, "end of the line", row.words[word], expected))
    }
}

/// Whether the columns of LINES have length and segments before the ends, as the first files had.
fn length_comes_first(columns: &[&str]) -> bool {
    columns.get(2).is_some_and(|name| {
        let name = name.to_lowercase();
        name.starts_with("unstr") || name.starts_with("len")
    })
}

/// Whether the columns of LINE TYPES are called in the order of version 1.
fn can_before_cd(columns: &[&str]) -> bool {
    let place = |of: &[&str]| columns.iter().position(|name| of.contains(&name.to_lowercase().as_str()));
    matches!((place(&["can"]), place(&["cdn"])), (Some(added_mass), Some(drag)) if added_mass < drag)
}

/// Whether a word where a number may stand is the name of a file.
fn looks_like_file(word: &str) -> bool {
    word.parse::<f64>().is_err() && word.contains('.') && word.contains(|c: char| c.is_alphabetic() && !"eEdD".contains(c))
}
