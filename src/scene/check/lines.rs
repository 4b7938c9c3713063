//! Rules on lines: their names, sections, elements and ends.

use crate::error::{Error, among};
use crate::scene::check::finding::{finite, number, positive, refuse, sections, triple};
use crate::scene::types::Scene;

/// Most elements of a scene.
const MOST_ELEMENTS: usize = 20_000;

pub fn lines_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.lines.is_empty() {
        return refuse(file, "lines", "[ ]", "a scene needs at least one line with fairlead, anchor and sections");
    }
    Ok(())
}

/// Names become column prefixes of `timeseries.csv` and parts of FMU variables.
pub fn line_names(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        let place = format!("lines[{index}].name");
        let unfit = |c: char| ".,;\"'`".contains(c) || c.is_control();
        if line.name.trim().is_empty() || line.name.contains(unfit) {
            return refuse(
                file,
                place,
                format!("{:?}", line.name),
                "a name needs a letter, and no dot, comma, semicolon, quote or control character",
            );
        }
        if let Some(twin) = scene.lines[..index].iter().position(|other| other.name == line.name) {
            return refuse(
                file,
                place,
                format!("{:?}", line.name),
                format!("lines[{twin}] has this name; every line needs its own"),
            );
        }
    }
    Ok(())
}

pub fn sections_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    match scene.lines.iter().position(|line| line.sections.is_empty()) {
        Some(index) => {
            refuse(file, format!("lines[{index}].sections"), "[ ]", "a line needs at least one section with type and length")
        }
        None => Ok(()),
    }
}

pub fn section_types(scene: &Scene, file: &str) -> Result<(), Error> {
    let known: Vec<String> = scene.line_types.keys().cloned().collect();
    for (place, line_type) in sections(scene).map(|(place, section)| (place, &section.line_type)) {
        if !scene.line_types.contains_key(line_type) {
            let allowed = format!("it must be one of line_types{}", among(line_type, &known));
            return refuse(file, format!("{place}.type"), format!("{line_type:?}"), allowed);
        }
    }
    Ok(())
}

pub fn lengths(scene: &Scene, file: &str) -> Result<(), Error> {
    sections(scene).try_for_each(|(place, section)| positive(file, &format!("{place}.length"), section.length, "m"))
}

pub fn elements(scene: &Scene, file: &str) -> Result<(), Error> {
    let mut total: usize = 0;
    for (place, section) in sections(scene) {
        let place = format!("{place}.elements");
        let count = section.elements.unwrap_or(1);
        total = total.saturating_add(count);
        if count == 0 {
            return refuse(file, place, "0", "it must be 1 or more; leave it out to let the program choose");
        }
        if total > MOST_ELEMENTS {
            return refuse(
                file,
                place,
                count.to_string(),
                format!("a scene can have {MOST_ELEMENTS} elements in all, and this makes {total}"),
            );
        }
    }
    Ok(())
}

pub fn ends_above_bed(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (end, at) in [("fairlead", line.fairlead), ("anchor", line.anchor)] {
            let place = format!("lines[{index}].{end}");
            finite(file, &place, &at)?;
            if scene.environment.is_below_bed(at) {
                let bed = number(scene.environment.bed_height(at[0], at[1]));
                return refuse(
                    file,
                    place,
                    triple(at),
                    format!("it lies below the seabed, which is at z = {bed} m there (environment.depth)"),
                );
            }
        }
    }
    Ok(())
}
