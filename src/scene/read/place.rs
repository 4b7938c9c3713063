//! Places in a scene (`lines[0].sections[1].type`) and where they stand in its text.
//!
//! serde knows the place of a wrong value but not its line once `--set` has been at work; this scan of the text finds it.
//! It also sees what serde_json lets pass: a key that stands twice in one object.

use crate::scene::text::char_start;
use std::collections::HashMap;
use std::fmt;
use std::ops::ControlFlow;

/// Steps of a place that a message shows; no place of a scene has more.
const SHOWN: usize = 12;

/// One step from an object or a list to what it holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Into an object.
    Key(String),
    /// Into a list, from 0.
    Index(usize),
}

/// A place in the scene, as steps from its root.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Place(pub Vec<Step>);

impl Place {
    /// The place of the member `key` of the object here.
    pub fn member(&self, key: &str) -> Place {
        self.with(Step::Key(key.to_string()))
    }

    /// The place one step further in.
    pub fn with(&self, step: Step) -> Place {
        let mut steps = self.0.clone();
        steps.push(step);
        Place(steps)
    }

    /// Whether `other` is this place or lies inside it.
    pub fn holds(&self, other: &Place) -> bool {
        other.0.starts_with(&self.0)
    }

    /// The way from the place `outer` to this one, which lies inside it.
    pub fn inside(&self, outer: &Place) -> Place {
        Place(self.0.get(outer.0.len()..).unwrap_or_default().to_vec())
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, step) in self.0.iter().enumerate() {
            if number == SHOWN {
                return f.write_str("…");
            }
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Key(key)
                    if key.is_empty() || key.contains(['.', '[', ']', '"', '\\']) || key.contains(char::is_control) =>
                {
                    write!(f, "[{:?}]", shortened(key))?
                }
                Step::Key(key) if number == 0 => f.write_str(&shortened(key))?,
                Step::Key(key) => write!(f, ".{}", shortened(key))?,
            }
        }
        Ok(())
    }
}

/// A text for use in a message: its first 60 characters.
pub fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// Byte where the member or list entry at `place` begins in the text.
pub fn locate(text: &str, place: &Place) -> Option<usize> {
    let mut found = None;
    scan(text, |entry| {
        if entry.path == place.0 {
            found = Some(entry.offset);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    found
}

/// The place in which a byte of the text lies; the text behind it is not looked at and may be anything.
pub fn place_at(text: &str, offset: usize) -> Place {
    Place(scan(&text[..char_start(text, offset)], |_| ControlFlow::Continue(())))
}

/// A key that stands twice in one object.
pub struct Duplicate {
    /// The place.
    pub place: Place,
    /// Byte of its first appearance.
    pub first: usize,
    /// Byte of its second appearance.
    pub second: usize,
}

/// The first key that stands twice in one object of the text.
pub fn duplicate_key(text: &str) -> Option<Duplicate> {
    let mut found = None;
    scan(text, |entry| match entry.earlier {
        Some(first) => {
            found = Some(Duplicate { place: Place(entry.path.to_vec()), first, second: entry.offset });
            ControlFlow::Break(())
        }
        None => ControlFlow::Continue(()),
    });
    found
}

/// A member of an object or an entry of a list, met by the scan.
struct Entry<'a> {
    path: &'a [Step],
    offset: usize,
    /// Where the same key of the same object stood before.
    earlier: Option<usize>,
}

/// What the scan is inside of.
enum Frame {
    Object(HashMap<String, usize>),
    List(usize),
}

/// Walks over JSON text and shows every member and entry to `visit`; returns the path at which it stopped.
/// It takes text that is not JSON as it comes, and keeps its own stack: depth costs no recursion.
/// Inside a value the path has one step per frame; between values one less.
fn scan(text: &str, mut visit: impl FnMut(Entry) -> ControlFlow<()>) -> Vec<Step> {
    let bytes = text.as_bytes();
    let mut frames: Vec<Frame> = Vec::new();
    let mut path: Vec<Step> = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let (start, byte) = (at, bytes[at]);
        at = match byte {
            b'"' => string_end(bytes, at),
            b'{' | b'}' | b'[' | b']' | b',' | b':' | b' ' | b'\t' | b'\r' | b'\n' => at + 1,
            _ => at + bytes[at..].iter().take_while(|byte| !b"{}[],:\" \t\r\n".contains(byte)).count(),
        };
        match byte {
            b'}' | b']' => {
                frames.pop();
                path.truncate(frames.len());
                continue;
            }
            b',' => {
                path.truncate(frames.len().saturating_sub(1));
                continue;
            }
            b':' | b' ' | b'\t' | b'\r' | b'\n' => continue,
            _ => {}
        }
        let between = path.len() < frames.len();
        let earlier = match frames.last_mut() {
            Some(Frame::List(next)) if between => {
                path.push(Step::Index(*next));
                *next += 1;
                Some(None)
            }
            Some(Frame::Object(seen)) if between && byte == b'"' => {
                let key = serde_json::from_str(&text[start..at]).unwrap_or_else(|_| text[start..at].to_string());
                path.push(Step::Key(key.clone()));
                Some(seen.insert(key, start))
            }
            _ => None,
        };
        if earlier.is_some_and(|earlier| visit(Entry { path: &path, offset: start, earlier }).is_break()) {
            break;
        }
        match byte {
            b'{' => frames.push(Frame::Object(HashMap::new())),
            b'[' => frames.push(Frame::List(0)),
            _ => {}
        }
    }
    path
}

/// The byte behind the string that begins at `start`, or the end of the text.
fn string_end(bytes: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::text::line_and_column;

    const TEXT: &str = "{\n \"ä\": [1, {\"b]\": \"x,}\"}],\n \"c.d\": 2}";

    #[test]
    fn places_are_found_in_the_text_and_text_in_places() {
        let entry = Place(vec![Step::Key("ä".into()), Step::Index(1), Step::Key("b]".into())]);
        let offset = locate(TEXT, &entry).unwrap_or_default();
        assert_eq!(&TEXT[offset..offset + 4], "\"b]\"");
        assert_eq!(line_and_column(TEXT, offset), (2, 12));
        assert_eq!(place_at(TEXT, offset + 7), entry);
        assert_eq!(entry.to_string(), "ä[1][\"b]\"]");
        assert_eq!(locate(TEXT, &Place(vec![Step::Key("e".into())])), None);
    }

    #[test]
    fn a_key_is_a_duplicate_only_within_its_own_object() {
        assert!(duplicate_key(r#"{"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]}"#).is_none());
        let text = r#"{"a": 1, "b": [{"x": 1, "\u0078": 2}]}"#;
        let found = duplicate_key(text).map(|duplicate| (duplicate.place.to_string(), duplicate.first, duplicate.second));
        assert_eq!(found, Some(("b[0].x".to_string(), 16, 24)));
    }

    #[test]
    fn the_scan_survives_text_that_is_not_json() {
        for text in ["", "}}]],,,::", "{\"a", "{\"a\\", "[[[[,,]", "{{{[\"\"\"", "\"\\"] {
            place_at(text, 99);
            assert!(duplicate_key(text).is_none());
        }
        place_at(&"[{\"a\":".repeat(200_000), usize::MAX);
    }
}
