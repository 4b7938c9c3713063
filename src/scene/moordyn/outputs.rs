//! The output channels of a MoorDyn file: what each of its names asks for.
//!
//! ```text
//! FAIRTEN1, LINE1TENB    tension at end B of line 1          ANCHTEN1, LINE1TENA   at end A
//! LINE1NAPX, LINE1NBPZ   position of end A, of end B         POINT2PX, CON2PX      position of a point
//! LINE1N5PX, L1N5T       position of node 5, tension there   POINT2FX, CON2FX      force of the lines on a point that is held
//! LINE1N5VX, LINE1NBAZ   velocity, acceleration              BODY1PX, BODY1RX      position and roll, pitch, yaw of a body
//! ```
//!
//! Node n of a line is the place at n/NumSegs of its length from end A, whatever the mesh here.

use crate::scene::moordyn::sections::Section;
use crate::scene::moordyn::words::Side;

/// A column of the output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Name as written.
    pub name: String,
    /// What it is.
    pub quantity: Quantity,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Tension [N] at end A of a line, or at end B.
    Tension(u32, Side),
    /// Position [m] along an axis of an end of a line.
    EndOfLine(u32, Side, usize),
    /// Something at a place of a line.
    OfLine(u32, Spot, Kind),
    /// Position [m] of a point along an axis.
    Point(u32, usize),
    /// Force of the lines on a point [N] along an axis.
    OnPoint(u32, usize),
    /// Position [m] of a body along an axis.
    Body(u32, usize),
    /// Roll, pitch or yaw [deg] of a body.
    Turn(u32, usize),
}

/// A place of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spot {
    /// An end.
    End(Side),
    /// A node, counted from end A.
    Node(u32),
}

/// What is asked for at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Position along an axis [m].
    Position(usize),
    /// Velocity [m/s].
    Velocity(usize),
    /// Acceleration [m/s²].
    Acceleration(usize),
    /// Tension [N].
    Tension,
}

impl Quantity {
    /// The unit of the column.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Tension(..) | Quantity::OnPoint(..) | Quantity::OfLine(.., Kind::Tension) => "(N)",
            Quantity::OfLine(.., Kind::Velocity(_)) => "(m/s)",
            Quantity::OfLine(.., Kind::Acceleration(_)) => "(m/s2)",
            Quantity::Turn(..) => "(deg)",
            _ => "(m)",
        }
    }
}

/// The channels of a section, and a warning of those that are not known.
pub fn read(section: Option<&Section>) -> (Vec<Channel>, Vec<String>) {
    let (mut channels, mut unknown): (Vec<Channel>, Vec<&str>) = (Vec::new(), Vec::new());
    for word in section.map(|section| section.rows.as_slice()).unwrap_or_default().iter().flat_map(|row| &row.words) {
        let word = word.trim_matches(['"', ',']);
        if word.is_empty() || word.eq_ignore_ascii_case("end") {
            continue;
        }
        match quantity(word) {
            Some(quantity) => channels.push(Channel { name: word.to_string(), quantity }),
            None => unknown.push(word),
        }
    }
    let warning = (!unknown.is_empty())
        .then(|| format!("OUTPUTS: {}: columns that are not written; see nodes.csv and timeseries.csv", unknown.join(", ")));
    (channels, warning.into_iter().collect())
}

/// What a name asks for; none: it is not known here.
fn quantity(name: &str) -> Option<Quantity> {
    let upper = name.to_uppercase();
    let digits = upper.find(|c: char| c.is_ascii_digit())?;
    let (object, tail) = upper.split_at(digits);
    let suffix = tail.trim_start_matches(|c: char| c.is_ascii_digit());
    let id: u32 = tail[..tail.len() - suffix.len()].parse().ok()?;
    let axis = |suffix: &str, first: char| {
        let mut signs = suffix.chars();
        let kind = signs.next().filter(|kind| *kind == first)?;
        let axis = ['X', 'Y', 'Z'].iter().position(|axis| suffix[kind.len_utf8()..] == axis.to_string())?;
        Some(axis)
    };
    match (object, suffix) {
        ("FAIRTEN", "") | ("LINE" | "L", "TENB" | "TB" | "NBT" | "NBTEN") => Some(Quantity::Tension(id, Side::B)),
        ("ANCHTEN", "") | ("LINE" | "L", "TENA" | "TA" | "NAT" | "NATEN") => Some(Quantity::Tension(id, Side::A)),
        ("LINE" | "L", suffix) => {
            let rest = suffix.strip_prefix('N')?;
            let (spot, rest) = match rest.chars().next()? {
                'A' => (Spot::End(Side::A), &rest[1..]),
                'B' => (Spot::End(Side::B), &rest[1..]),
                _ => {
                    let rest_of = rest.trim_start_matches(|c: char| c.is_ascii_digit());
                    (Spot::Node(rest[..rest.len() - rest_of.len()].parse().ok()?), rest_of)
                }
            };
            let kind = match rest {
                "T" | "TEN" => Kind::Tension,
                rest => axis(rest, 'P')
                    .map(Kind::Position)
                    .or_else(|| axis(rest, 'V').map(Kind::Velocity))
                    .or_else(|| axis(rest, 'A').map(Kind::Acceleration))?,
            };
            Some(match (spot, kind) {
                (Spot::End(side), Kind::Position(axis)) => Quantity::EndOfLine(id, side, axis),
                _ => Quantity::OfLine(id, spot, kind),
            })
        }
        ("POINT" | "P" | "CON" | "C", suffix) => axis(suffix, 'P')
            .map(|axis| Quantity::Point(id, axis))
            .or_else(|| axis(suffix, 'F').map(|axis| Quantity::OnPoint(id, axis))),
        ("BODY" | "B", suffix) => axis(suffix, 'P')
            .map(|axis| Quantity::Body(id, axis))
            .or_else(|| axis(suffix, 'R').map(|axis| Quantity::Turn(id, axis))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_channels_are_what_the_manual_says() {
        let known = [
            ("FairTen3", Quantity::Tension(3, Side::B)),
            ("anchten12", Quantity::Tension(12, Side::A)),
            ("LINE2TENA", Quantity::Tension(2, Side::A)),
            ("LINE1NAPZ", Quantity::EndOfLine(1, Side::A, 2)),
            ("L1NBpx", Quantity::EndOfLine(1, Side::B, 0)),
            ("Con2py", Quantity::Point(2, 1)),
            ("POINT10PZ", Quantity::Point(10, 2)),
            ("Con4Fz", Quantity::OnPoint(4, 2)),
            ("L1N10T", Quantity::OfLine(1, Spot::Node(10), Kind::Tension)),
            ("LINE3N19Py", Quantity::OfLine(3, Spot::Node(19), Kind::Position(1))),
            ("LINE1N0VX", Quantity::OfLine(1, Spot::Node(0), Kind::Velocity(0))),
            ("L2NBAZ", Quantity::OfLine(2, Spot::End(Side::B), Kind::Acceleration(2))),
            ("BODY1PX", Quantity::Body(1, 0)),
            ("Body2RZ", Quantity::Turn(2, 2)),
        ];
        for (name, expected) in known {
            assert_eq!(quantity(name), Some(expected), "{name}");
        }
        for name in [
            "FairTen",
            "LINE1N5",
            "L1N",
            "L1NéPX",
            "L1N99999999999T",
            "POINT1VX",
            "ROD1SUB",
            "BODY1RVX",
            "BODY1PXX",
            "END",
            "P1é",
        ] {
            assert_eq!(quantity(name), None, "{name}");
        }
    }
}
