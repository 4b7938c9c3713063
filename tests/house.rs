//! The walls of the house (docs/house.md): which layer may know which, that files do not import each other, where `unsafe` may stand,
//! that nothing in the program gives up with a panic, and that a file can be read in one sitting.

use std::collections::{BTreeMap, BTreeSet};
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

/// The module that a file is: `rod::line` for `src/rod/line.rs`, nothing for `src/lib.rs`.
fn module(name: &str) -> String {
    let path = name.trim_start_matches("src/").trim_end_matches(".rs").replace('/', "::");
    if path == "lib" { String::new() } else { path }
}

/// Words, `::` and single signs of code; texts and comments behind code are left out.
fn tokens(code: &str) -> Vec<String> {
    let signs: Vec<char> = code.chars().collect();
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let at = |place: usize| signs.get(place).copied().unwrap_or('\n');
    let (mut tokens, mut place) = (Vec::new(), 0);
    while place < signs.len() {
        let begin = place;
        if at(place) == 'r' && (at(place + 1) == '"' || at(place + 1) == '#' && "#\"".contains(at(place + 2))) {
            let fence = signs[place + 1..].iter().take_while(|c| **c == '#').count();
            let end: Vec<char> = std::iter::once('"').chain(std::iter::repeat_n('#', fence)).collect();
            place += fence + 2;
            while place < signs.len() && !signs[place..].starts_with(&end) {
                place += 1;
            }
            place += end.len();
        } else if is_word(at(place)) {
            while is_word(at(place)) {
                place += 1;
            }
            tokens.push(signs[begin..place].iter().collect());
        } else if at(place) == '"' || at(place) == '\'' && (at(place + 1) == '\\' || at(place + 2) == '\'') {
            place += 1;
            while place < signs.len() && at(place) != at(begin) {
                place += if at(place) == '\\' { 2 } else { 1 };
            }
            place += 1;
        } else if at(place) == '/' && at(place + 1) == '/' {
            while place < signs.len() && at(place) != '\n' {
                place += 1;
            }
        } else {
            place += if at(place) == ':' && at(place + 1) == ':' { 2 } else { 1 };
            if !at(begin).is_whitespace() {
                tokens.push(signs[begin..place].iter().collect());
            }
        }
    }
    tokens
}

/// A path as it is written, and the name that a `use` gives to what stands there.
type Named = (Vec<String>, String);

/// The paths of a `use` from a token on, behind those that a brace around it begins with; returns the token where it ends.
fn tree(tokens: &[String], mut place: usize, before: &[String], found: &mut Vec<Named>) -> usize {
    let mut path = before.to_vec();
    let mut name = None;
    while let Some(token) = tokens.get(place) {
        match token.as_str() {
            "{" => {
                while !matches!(tokens.get(place).map(String::as_str), None | Some("}" | ";")) {
                    place = tree(tokens, place + 1, &path, found);
                }
                return place + 1;
            }
            "}" | "," | ";" => break,
            "as" => {
                name = tokens.get(place + 1).cloned();
                place += 1;
            }
            "self" if !path.is_empty() => {}
            "::" | "*" => {}
            _ => path.push(token.clone()),
        }
        place += 1;
    }
    if path.len() > before.len() || tokens.get(place - 1).is_some_and(|token| token == "self" || token == "*") {
        let name = name.or_else(|| path.last().cloned()).unwrap_or_default();
        found.push((path, name));
    }
    place
}

/// All paths of a file: of its `use` statements, and those written out in its code. The place that a `pub(in …)` names is none.
fn written(tokens: &[String]) -> (Vec<Named>, Vec<Vec<String>>) {
    let (mut used, mut paths) = (Vec::new(), Vec::new());
    let is = |place: usize, token: &str| tokens.get(place).is_some_and(|found| found == token);
    let mut place = 0;
    while place < tokens.len() {
        if is(place, "use") {
            place = tree(tokens, place + 1, &[], &mut used);
            continue;
        }
        let begin = place;
        while is(place + 1, "::") && tokens[place].chars().all(|c| c.is_alphanumeric() || c == '_') {
            place += 2;
        }
        if place > begin && !(begin > 1 && is(begin - 1, "in") && is(begin - 2, "(")) {
            paths.push(tokens[begin..=place.min(tokens.len() - 1)].iter().step_by(2).cloned().collect());
        }
        place += 1;
    }
    (used, paths)
}

/// The files that a file imports, as modules.
fn imports(own: &str, code: &str, modules: &BTreeSet<String>) -> BTreeSet<String> {
    let (used, paths) = written(&tokens(code));
    // From the root of the crate on; none for what lies elsewhere.
    let rooted = |path: &[String]| -> Option<Vec<String>> {
        let mut base: Vec<&str> = own.split("::").filter(|name| !name.is_empty()).collect();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" | "moorline" => {
                base.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {}
            child if modules.contains(&[own, child].join("::")) => {}
            _ => return None,
        }
        while rest.first().is_some_and(|name| name == "super") {
            base.pop();
            rest = &rest[1..];
        }
        Some(base.into_iter().map(str::to_string).chain(rest.iter().cloned()).collect())
    };
    let known: BTreeMap<&str, Vec<String>> =
        used.iter().filter_map(|(path, name)| Some((name.as_str(), rooted(path)?))).collect();
    let through = |path: &[String]| {
        let renamed = known.get(path.first()?.as_str())?;
        Some(renamed.iter().chain(&path[1..]).cloned().collect::<Vec<_>>())
    };
    let file = |path: Vec<String>| (1..=path.len()).rev().map(|end| path[..end].join("::")).find(|name| modules.contains(name));
    let all = used.iter().map(|(path, _)| path).chain(&paths);
    let found = all.filter_map(|path| file(rooted(path).or_else(|| through(path))?));
    found.filter(|name| name != own).collect()
}

/// Circles among files that import each other, each as the files on its way: one at least where there is any.
fn circles(imports: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    fn go(
        file: &str,
        imports: &BTreeMap<String, BTreeSet<String>>,
        way: &mut Vec<String>,
        circles: &mut Vec<Vec<String>>,
        seen: &mut BTreeSet<String>,
    ) {
        if let Some(begin) = way.iter().position(|before| before == file) {
            circles.push(way[begin..].to_vec());
        } else if seen.insert(file.to_string()) {
            way.push(file.to_string());
            imports.get(file).into_iter().flatten().for_each(|next| go(next, imports, way, circles, seen));
            way.pop();
        }
    }
    let (mut found, mut seen) = (Vec::new(), BTreeSet::new());
    imports.keys().for_each(|file| go(file, imports, &mut Vec::new(), &mut found, &mut seen));
    found
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

/// Not even through a third file: what two files want of each other is a file of its own, below both.
#[test]
fn no_files_import_each_other() {
    let sources = sources();
    let modules: BTreeSet<String> = sources.iter().map(|source| module(&source.name)).filter(|name| !name.is_empty()).collect();
    let code = |source: &Source| source.lines.iter().map(|(_, line)| format!("{line}\n")).collect::<String>();
    let of = |source: &Source| (module(&source.name), imports(&module(&source.name), &code(source), &modules));
    let all: BTreeMap<String, BTreeSet<String>> = sources.iter().map(of).collect();
    let count: usize = all.values().map(BTreeSet::len).sum();
    assert!(count > 400, "only {count} imports found");
    let file = |name: &String| format!("src/{}.rs", name.replace("::", "/"));
    let told = |circle: &Vec<String>| circle.iter().chain(&circle[..1]).map(file).collect::<Vec<_>>().join(" -> ");
    assert_none(circles(&all).iter().map(told).collect(), "files import each other");
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

#[test]
fn imports_are_found_however_they_are_written() {
    let files = ["a", "a::b", "a::b::c", "a::d", "e::f", "e::g", "e::h", "e::i"];
    let modules: BTreeSet<String> = files.map(String::from).into();
    let of = |own: &str, code: &str| imports(own, code, &modules).into_iter().collect::<Vec<_>>();
    // Lists in lists, over several lines, with other names, of everything; the longest file of a path counts.
    let lists =
        "use crate::{\n    a::b::{self, c::{x, y}},\n    e::{f::z as w, g},\n};\npub(crate) use crate::a::d::*;\nuse std::fmt;\n";
    assert_eq!(of("e::h", lists), ["a::b", "a::b::c", "a::d", "e::f", "e::g"]);
    // Relative ones, and a child without a prefix.
    assert_eq!(
        of("a::b", "use self::c::x;\nuse super::d::{y, z};\nfn f() { super::super::e::f::g() }"),
        ["a::b::c", "a::d", "e::f"]
    );
    assert_eq!(of("a::b", "mod c;\npub use c::X;"), ["a::b::c"]);
    assert_eq!(of("a::b::c", "use super::X;"), ["a::b"]);
    assert_eq!(of("a::b", "mod c;\nmod e;\nfn f() { std::f::e(X::new()) }"), Vec::<String>::new());
    // Paths in code, also through a name that a use gives.
    assert_eq!(of("e::h", "fn f() { let x = crate::a::d::X { y: 1 }; crate::e::g::h::<f64>() }"), ["a::d", "e::g"]);
    assert_eq!(of("e::h", "use crate::{a, e as other};\nfn f() { a::d::f(other::i::g()) }"), ["a", "a::d", "e::i"]);
    // What is in a text or a comment, what only says who may see, and the file itself.
    let none = "fn f<'a>() -> char { '\"' } // crate::a::b\nconst T: &str = \"crate::a::b \\\" crate::a\";\nconst R: &str = r#\"\" crate::a \"#;\n";
    assert_eq!(of("e::h", none), Vec::<String>::new());
    assert_eq!(of("a::b", "pub(in crate::a) fn f() { crate::a::b::g(); self::g() }"), Vec::<String>::new());
    assert_eq!([module("src/a/b.rs"), module("src/lib.rs")], ["a::b", ""]);
}

#[test]
fn a_circle_is_found_through_a_third_file() {
    let files = |pairs: &[(&str, &str)]| {
        let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in pairs {
            imports.entry(from.to_string()).or_default().insert(to.to_string());
        }
        circles(&imports)
    };
    assert_eq!(files(&[("a", "b"), ("b", "c"), ("c", "a")]), [["a", "b", "c"]]);
    assert_eq!(files(&[("a", "b"), ("b", "c"), ("c", "d"), ("d", "c")]), [["c", "d"]]);
    assert!(files(&[("a", "b"), ("a", "c"), ("b", "d"), ("c", "d")]).is_empty());
}
