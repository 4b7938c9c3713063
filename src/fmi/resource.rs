//! resources/scene.json: where the master unpacked it (a URI), how it is read, and the GUID that ties it to the model description.

use crate::fmi::refusal::Refusal;
use crate::fmi::variables::{MODEL_DESCRIPTION, MOST_LINES};
use crate::scene::types::Scene;
use std::fs;
use std::path::PathBuf;

/// Name of the scene's file in the folder `resources`.
pub const SCENE_FILE: &str = "scene.json";

/// The folders that a `fmuResourceLocation` may name, the likeliest first: a `file:` URI (percent-encoded or not; with one, two or three slashes; a
/// Windows drive, written `Z:` or `Z|`, or a network share), or, as some masters give it, a plain path.
pub fn folders(location: &str) -> Result<Vec<PathBuf>, Refusal> {
    let refuse = |reason: &str| Refusal::Resource { path: location.to_owned(), reason: reason.to_owned() };
    let plain = location.starts_with("\\\\");
    let Some((scheme, rest)) = location.split_once(':').filter(|(scheme, _)| scheme.len() > 1 && !plain) else {
        return Ok(vec![PathBuf::from(location)]);
    };
    if !scheme.eq_ignore_ascii_case("file") {
        return Err(refuse("fmuResourceLocation must be a file: URI"));
    }
    let decoded =
        percent_decoded(rest).ok_or_else(|| refuse("the percent-encoding of fmuResourceLocation is not valid UTF-8"))?;
    let mut folders = vec![path_of(&decoded)];
    // A path that holds %20 and was not encoded.
    if decoded != rest {
        folders.push(path_of(rest));
    }
    Ok(folders)
}

/// The path of a URI without its scheme.
fn path_of(rest: &str) -> PathBuf {
    let path = match rest.strip_prefix("//") {
        Some(after) if after.starts_with('/') => after.to_owned(),
        Some(after) => match after.strip_prefix("localhost/") {
            Some(local) => format!("/{local}"),
            None if has_drive(after) => after.to_owned(),
            None => format!("//{after}"),
        },
        None => rest.to_owned(),
    };
    match path.strip_prefix('/').unwrap_or(&path) {
        after if has_drive(after) => PathBuf::from(after.replacen('|', ":", 1)),
        _ => PathBuf::from(path),
    }
}

/// `C:` or, in old URIs, `C|` at the beginning.
fn has_drive(path: &str) -> bool {
    let bytes = path.as_bytes();
    bytes.first().is_some_and(u8::is_ascii_alphabetic) && matches!(bytes.get(1), Some(b':' | b'|'))
}

/// Text with every `%41` replaced by its byte; a `%` that no two hexadecimal digits follow stands for itself.
fn percent_decoded(text: &str) -> Option<String> {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut index = 0;
    while let Some(&byte) = bytes.get(index) {
        let digit = |offset: usize| bytes.get(index + offset).and_then(|digit| char::from(*digit).to_digit(16));
        match (byte, digit(1), digit(2)) {
            (b'%', Some(high), Some(low)) => {
                decoded.push((16 * high + low) as u8);
                index += 3;
            }
            _ => {
                decoded.push(byte);
                index += 1;
            }
        }
    }
    String::from_utf8(decoded).ok()
}

/// Reads the scene that was packed into the FMU: where the master says that its resources are, or else, if there is no scene, where the
/// library lies (`own`). Whether it is the FMU that the master read is told by the GUID.
pub fn read_scene(location: Option<&str>, own: Option<PathBuf>) -> Result<Scene, Refusal> {
    let said = location.filter(|location| !location.trim().is_empty()).map(folders).transpose()?.unwrap_or_default();
    let mut places: Vec<PathBuf> = said.into_iter().chain(own).map(|folder| folder.join(SCENE_FILE)).collect();
    if places.is_empty() {
        let (path, reason) = (
            String::from("fmuResourceLocation"),
            String::from("it is NULL or empty, and the library does not lie in an unpacked FMU"),
        );
        return Err(Refusal::Resource { path, reason });
    }
    let place = places.iter().position(|place| place.exists()).unwrap_or(0);
    let path = places.swap_remove(place);
    let refuse = |reason: String| Refusal::Resource { path: path.display().to_string(), reason };
    let text = fs::read_to_string(&path).map_err(|error| refuse(error.to_string()))?;
    let scene: Scene = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
    match scene.lines.len() {
        0 => Err(refuse("it holds no line".to_owned())),
        count if count > MOST_LINES => Err(refuse(format!("it holds {count} lines, an FMU at most {MOST_LINES}"))),
        _ => Ok(scene),
    }
}

/// The GUID of the FMU of a scene: a hash of the interface, the program's version and the scene.
pub fn guid(scene: &Scene) -> String {
    let scene = serde_json::to_string(scene).unwrap_or_default();
    let text = [env!("CARGO_PKG_VERSION"), MODEL_DESCRIPTION, &scene].join("\n");
    let hash = fingerprint(text.as_bytes());
    let hex = format!("{hash:032x}");
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

/// FNV-1a of 128 bits (Fowler, Noll, Vo): every change of one byte changes it.
pub fn fingerprint(bytes: &[u8]) -> u128 {
    const OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    bytes.iter().fold(OFFSET, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_form_of_a_resource_location_is_understood() {
        let table = [
            ("file:///tmp/a/resources", "/tmp/a/resources"),
            ("file:/tmp/a/resources", "/tmp/a/resources"),
            ("file://localhost/tmp/a/resources", "/tmp/a/resources"),
            ("FILE:///tmp/my%20fmu/%7Bguid%7D/100%25", "/tmp/my fmu/{guid}/100%"),
            ("file:///tmp/my fmu/{guid}/50% off", "/tmp/my fmu/{guid}/50% off"),
            ("file:///tmp/%C3%B8st", "/tmp/øst"),
            ("file:///C:/Users/a%20b/resources", "C:/Users/a b/resources"),
            ("file://C:/Users/resources", "C:/Users/resources"),
            ("file:///C%3A/Users/resources", "C:/Users/resources"),
            ("file://server/share/resources", "//server/share/resources"),
            ("/tmp/plain", "/tmp/plain"),
            ("C:\\plain\\windows", "C:\\plain\\windows"),
            ("file:///Z|/fmu/resources", "Z:/fmu/resources"),
            ("\\\\?\\Z:\\fmu\\resources", "\\\\?\\Z:\\fmu\\resources"),
        ];
        for (location, path) in table {
            assert_eq!(folders(location).unwrap()[0], Path::new(path), "{location}");
        }
    }

    #[test]
    fn other_schemes_and_broken_encodings_are_refused() {
        for (location, words) in [("https://example.org/resources", "file: URI"), ("file:///tmp/%FF", "UTF-8")] {
            let message = folders(location).map_err(|refusal| refusal.to_string());
            assert!(message.as_ref().is_err_and(|message| message.contains(words) && message.contains(location)), "{message:?}");
        }
    }

    /// Source: the published test vectors of FNV-1a, 128 bit.
    #[test]
    fn the_fingerprint_is_fnv_1a() {
        assert_eq!(fingerprint(b""), 0x6c62272e07bb014262b821756295c58d);
        assert_eq!(fingerprint(b"a"), 0xd228cb696f1a8caf78912b704e4a8964);
    }
}
