//! Text of a file that a user names: how much of it is read, and where in it something stands.

use crate::error::{Error, Problem};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The bytes of a file; `what` says what the file should be. Larger files than `largest` bytes are refused.
pub fn read_bytes(path: &Path, largest: u64, what: &str) -> Result<Vec<u8>, Error> {
    let failed = |reason: String| Error::File { path: path.display().to_string(), reason };
    let file = File::open(path).map_err(|error| failed(error.to_string()))?;
    if file.metadata().is_ok_and(|metadata| metadata.is_dir()) {
        return Err(failed(format!("this is a directory, not {what}")));
    }
    let mut bytes = Vec::new();
    file.take(largest + 1).read_to_end(&mut bytes).map_err(|error| failed(error.to_string()))?;
    if bytes.len() as u64 > largest {
        return Err(failed(format!("larger than {} MB: this is not {what}", largest >> 20)));
    }
    Ok(bytes)
}

/// The text of a file, which must be UTF-8.
pub fn decode(bytes: Vec<u8>, file: &str) -> Result<String, Error> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let start = String::from_utf8_lossy(&error.as_bytes()[..valid]);
        let (line, column) = line_and_column(&start, start.len());
        Error::Json { file: file.into(), line, column, place: String::new(), problem: Problem::NotUtf8.into() }
    })
}

/// The text of a file that may be of an older encoding than UTF-8: what is not UTF-8 becomes a replacement character, as of signs in
/// headings and comments, where it does no harm.
pub fn decode_leniently(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}

/// The byte at or before `offset` with which a character of the text begins.
pub fn char_start(text: &str, offset: usize) -> usize {
    (0..=offset.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// Line and column, both from 1, of a byte of the text; the column counts characters.
pub fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..char_start(text, offset)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
