//! The walls of the house (docs/house.md): which layer may know which, where `unsafe` may stand, that nothing in the program gives up
//! with a panic, and that a file can be read in one sitting.

use std::path::{Path, PathBuf};

/// From the ground up: a layer imports from its own storey and those below it.
const STOREYS: [&[&str]; 9] =
    [&["error"], &["algebra"], &["scene"], &["sea"], &["rod"], &["cable1994"], &["solve"], &["report", "fmi"], &["cli"]];
/// The C functions of FMI, and what asks the loader of the system: the only places where `unsafe` is needed.
const C_INTERFACE: [&str; 2] = ["src/fmi/fmi2.rs", "src/fmi/own_place.rs"];
/// Lines of a file, tests not counted.
const ONE_SITTING: usize = 700;
/// Ways to give up that are for tests only; built so that this file would pass its own test.
const GIVING_UP: [&str; 6] = [".unwrap()", ".expect(", "panic!(", "todo!(", "unimplemented!(", "unreachable!("];

/// A source file without its tests and comments.
struct Source {
    name: String,
    /// Lines, numbered as in the file.
    lines: Vec<(usize, String)>,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    collect(&root.join("src"), &mut files);
    assert!(files.len() > 40, "only {} files found", files.len());
    files.sort();
    files
        .iter()
        .map(|path| {
            let text = std::fs::read_to_string(path).expect("a source file");
            let name = path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
            Source { name, lines: program(&text) }
        })
        .collect()
}

fn collect(directory: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(directory).expect("a directory") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// What is not test and not comment: an item under `#[cfg(test)]` ends where its braces close, or at its semicolon.
fn program(text: &str) -> Vec<(usize, String)> {
    let mut kept = Vec::new();
    let mut skipping: Option<i64> = None;
    for (number, line) in text.lines().enumerate() {
        let code = line.trim_start();
        if code.starts_with("//") {
            continue;
        }
        if code == "#[cfg(test)]" {
            skipping = Some(0);
            continue;
        }
        if let Some(depth) = &mut skipping {
            *depth += line.matches('{').count() as i64 - line.matches('}').count() as i64;
            if *depth <= 0 && (line.contains('}') || line.trim_end().ends_with(';')) {
                skipping = None;
            }
            continue;
        }
        kept.push((number + 1, line.to_string()));
    }
    kept
}

fn storey(layer: &str) -> Option<usize> {
    STOREYS.iter().position(|layers| layers.contains(&layer))
}

/// The layer a file belongs to; `lib.rs` and `main.rs` stand outside.
fn layer(name: &str) -> Option<&str> {
    let inside = name.strip_prefix("src/")?;
    let first = inside.split('/').next()?;
    match first.strip_suffix(".rs") {
        Some("lib" | "main") => None,
        Some(file) => Some(file),
        None => Some(first),
    }
}

/// Layers that a line of code names: after `crate::`, or each in `crate::{a::…, b::…}`.
fn named(line: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    line.split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split(',').map(|item| word(item.trim_start())).collect(),
            None => vec![word(rest)],
        })
        .collect()
}

/// Paths of the tree that begins with the line `src/` and ends with its block: two spaces for each folder, a word after each name.
fn paths(tree: &str) -> Vec<String> {
    let mut folders: Vec<&str> = Vec::new();
    let mut paths = Vec::new();
    for line in tree.lines().skip_while(|line| *line != "src/").take_while(|line| !line.starts_with("```")) {
        let name = line.split_whitespace().next().unwrap_or_default();
        folders.truncate((line.len() - line.trim_start().len()) / 2);
        match name.strip_suffix('/') {
            Some(folder) => folders.push(folder),
            None => paths.push(format!("{}/{name}", folders.join("/"))),
        }
    }
    paths
}

fn assert_none(faults: Vec<String>, rule: &str) {
    assert!(faults.is_empty(), "{rule}:\n  {}", faults.join("\n  "));
}

#[test]
fn no_layer_knows_one_above_it() {
    let mut faults = Vec::new();
    let mut imports = 0;
    for source in sources() {
        let Some(layer) = layer(&source.name) else { continue };
        let Some(home) = storey(layer) else { panic!("{} belongs to no layer", source.name) };
        for (number, line) in &source.lines {
            for used in named(line) {
                let Some(other) = storey(&used) else { continue };
                imports += 1;
                if other > home || other == home && used != layer {
                    faults.push(format!("{}:{number}: {layer} uses {used}", source.name));
                }
            }
        }
    }
    assert!(imports > 100, "only {imports} imports found");
    assert_none(faults, "a layer knows itself and what lies below it");
}

#[test]
fn unsafe_stands_in_the_c_interface_only() {
    let is_unsafe = |line: &str| line.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == "unsafe");
    let mut faults = Vec::new();
    for source in sources() {
        let found: Vec<_> = source.lines.iter().filter(|(_, line)| is_unsafe(line)).collect();
        if C_INTERFACE.contains(&source.name.as_str()) {
            assert!(!found.is_empty(), "a C interface without unsafe? The search finds nothing");
        } else {
            faults.extend(found.iter().map(|(number, _)| format!("{}:{number}", source.name)));
        }
    }
    assert_none(faults, "unsafe outside the C interface");
}

#[test]
fn the_program_does_not_give_up_with_a_panic() {
    let mut faults = Vec::new();
    for source in sources() {
        for (number, line) in &source.lines {
            if GIVING_UP.iter().any(|word| line.contains(word)) {
                faults.push(format!("{}:{number}: {}", source.name, line.trim()));
            }
        }
    }
    assert_none(faults, "failures are data (src/error.rs)");
}

#[test]
fn a_file_is_read_in_one_sitting() {
    let long = |source: &Source| source.lines.len() > ONE_SITTING;
    let faults = sources().iter().filter(|source| long(source)).map(|s| format!("{}: {} lines", s.name, s.lines.len())).collect();
    assert_none(faults, &format!("longer than {ONE_SITTING} lines without tests and comments"));
}

#[test]
fn every_file_says_what_it_is_and_the_tree_lists_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let tree = std::fs::read_to_string(root.join("docs/house.md")).expect("docs/house.md");
    let planned = paths(&tree);
    let mut faults = Vec::new();
    for source in sources() {
        let text = std::fs::read_to_string(root.join(&source.name)).expect("a source file");
        if !text.starts_with("//! ") {
            faults.push(format!("{} does not open with what it is", source.name));
        }
        if !planned.contains(&source.name) {
            faults.push(format!("{} is not in docs/house.md", source.name));
        }
    }
    for name in planned.iter().filter(|name| !root.join(name).exists()) {
        faults.push(format!("{name} is in docs/house.md only"));
    }
    assert_none(faults, "the house and its plan differ");
}

#[test]
fn tests_and_comments_are_left_out() {
    let text = "fn a() {}\n// unsafe\n#[cfg(test)]\nmod tests {\n    fn b() { x.unwrap() }\n}\nfn c() {}\n";
    let lines: Vec<String> = program(text).into_iter().map(|(_, line)| line).collect();
    assert_eq!(lines, ["fn a() {}", "fn c() {}"]);
    assert_eq!(named("use crate::{rod::line::Line, solve::newton};"), ["rod", "solve"]);
    assert_eq!(named("use crate::scene::types::Scene;"), ["scene"]);
}
