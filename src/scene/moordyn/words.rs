//! The words of MoorDyn files: what holds a body, rod or point, and what an end of a line is on.
//!
//! Words have grown over the years; all spellings that its versions take are taken, in capitals or not.

/// What holds a body, rod or point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attachment {
    /// Nothing moves it.
    Fixed,
    /// The calling program moves it.
    Coupled,
    /// The calling program moves it, and it turns as it likes.
    CoupledPinned,
    /// It turns about an end that is fixed.
    Pinned,
    /// Forces move it.
    Free,
    /// It is part of a body.
    Body(u32),
    /// It turns about an end that is part of a body.
    BodyPinned(u32),
    /// It is part of a turbine of FAST.Farm.
    Turbine(u32),
}

/// What an end of a line is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineEnd {
    /// A point.
    Point(u32),
    /// End A of a rod, or end B.
    Rod(u32, Side),
}

/// An end of a line or rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// End A, of a line the anchor.
    A,
    /// End B, of a line the fairlead.
    B,
}

/// The word of an attachment; none: it is not known.
pub fn attachment(word: &str) -> Option<Attachment> {
    let (letters, number, rest) = parts(word)?;
    Some(match (letters.as_str(), number, rest.as_str()) {
        ("FIXED" | "FIX" | "ANCHOR", None, "") => Attachment::Fixed,
        ("VESSEL" | "VES" | "COUPLED" | "CPLD" | "FAIRLEAD", None, "") => Attachment::Coupled,
        ("VESSELPINNED" | "VESPIN" | "COUPLEDPINNED" | "CPLDPIN", None, "") => Attachment::CoupledPinned,
        ("PINNED" | "PIN", _, "") => Attachment::Pinned,
        ("FREE" | "CONNECT" | "CON" | "CONNECTION" | "POINT", None, "") => Attachment::Free,
        ("BODY", Some(id), "") => Attachment::Body(id),
        ("BODY", Some(id), "PINNED" | "PIN") => Attachment::BodyPinned(id),
        ("TURBINE" | "T", Some(id), "") => Attachment::Turbine(id),
        _ => return None,
    })
}

/// The word of an end of a line; none: it is not known.
pub fn line_end(word: &str) -> Option<LineEnd> {
    let (letters, number, rest) = parts(word)?;
    match (letters.as_str(), number?, rest.as_str()) {
        ("" | "P" | "POINT" | "C" | "CON", id, "") => Some(LineEnd::Point(id)),
        ("R" | "ROD", id, "A") => Some(LineEnd::Rod(id, Side::A)),
        ("R" | "ROD", id, "B") => Some(LineEnd::Rod(id, Side::B)),
        _ => None,
    }
}

/// Letters, a number and letters again, in capitals; none where anything else stands in the word.
fn parts(word: &str) -> Option<(String, Option<u32>, String)> {
    let upper = word.to_uppercase();
    let digits = upper.find(|c: char| c.is_ascii_digit()).unwrap_or(upper.len());
    let (letters, tail) = upper.split_at(digits);
    let rest = tail.trim_start_matches(|c: char| c.is_ascii_digit());
    let number = &tail[..tail.len() - rest.len()];
    let plain = |text: &str| text.chars().all(|c| c.is_ascii_alphabetic());
    if !plain(letters) || !plain(rest) {
        return None;
    }
    let number = if number.is_empty() { None } else { Some(number.parse().ok()?) };
    Some((letters.to_string(), number, rest.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_means_what_the_manual_says() {
        for word in ["Fixed", "fix", "ANCHOR"] {
            assert_eq!(attachment(word), Some(Attachment::Fixed), "{word}");
        }
        for word in ["Vessel", "VES", "coupled", "Cpld", "fairlead"] {
            assert_eq!(attachment(word), Some(Attachment::Coupled), "{word}");
        }
        for word in ["Free", "Connect", "con", "POINT"] {
            assert_eq!(attachment(word), Some(Attachment::Free), "{word}");
        }
        assert_eq!(attachment("body12"), Some(Attachment::Body(12)));
        assert_eq!(attachment("Body1Pinned"), Some(Attachment::BodyPinned(1)));
        assert_eq!(attachment("Turbine3"), Some(Attachment::Turbine(3)));
        for word in ["", "Body", "Fixed1", "moored", "Body1x", "12", "-"] {
            assert_eq!(attachment(word), None, "{word}");
        }
    }

    #[test]
    fn ends_of_lines_are_points_and_ends_of_rods() {
        for word in ["7", "P7", "point7", "c7", "Con7"] {
            assert_eq!(line_end(word), Some(LineEnd::Point(7)), "{word}");
        }
        assert_eq!(line_end("R2A"), Some(LineEnd::Rod(2, Side::A)));
        assert_eq!(line_end("rod2b"), Some(LineEnd::Rod(2, Side::B)));
        for word in ["R2", "R2C", "chain", "1.5", "-1", ""] {
            assert_eq!(line_end(word), None, "{word}");
        }
    }
}
