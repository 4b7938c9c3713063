//! A scene as an FMU: the description rendered for the scene, the libraries that lie beside the program, and the scene itself.
//! Nothing is compiled. Beside the FMU goes the description of its port for the Open Simulation Platform.

use crate::error::Error;
use crate::fmi::body_variables::{self, Row};
use crate::fmi::own_place;
use crate::fmi::resource::{SCENE_FILE, guid};
use crate::fmi::variables::{Interface, Kind, MODEL_DESCRIPTION, MOST_LINES, Meaning, Variable};
use crate::scene::bodies::{BodyMotion, Mount, PointMotion};
use crate::scene::types::{Motion, Scene};
use crate::solve::partition;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Folder of a platform in an FMU, name of the library there, and names under which it may lie beside the program.
const PLATFORMS: [(&str, &str, &[&str]); 3] = [
    ("linux64", "moorline.so", &["libmoorline.so", "binaries/linux64/moorline.so"]),
    ("win64", "moorline.dll", &["moorline.dll", "binaries/win64/moorline.dll"]),
    ("darwin64", "moorline.dylib", &["libmoorline.dylib", "binaries/darwin64/moorline.dylib"]),
];

const DOCUMENTATION: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/modelDescription/documentation/index.html"));
const LICENSE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/modelDescription/documentation/licenses/license.txt"));
const PICTURE: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/modelDescription/model.png"));

/// Where the scene's variables begin in modelDescription.xml that a scene with names of its own replaces.
const REPLACEABLE: &str = "    <!-- The line and its surroundings";
/// What stands there instead.
const REPLACEMENT: &str = "    <!-- The quantities of the scene under its own names -->";

/// The FMU's library for each platform, as far as there is one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Libraries {
    /// Platform folder (`linux64`, `win64`, `darwin64`) → file.
    pub files: BTreeMap<&'static str, PathBuf>,
}

impl Libraries {
    /// The libraries that lie beside the running program or, as in cargo's folders, one above it or in `deps` beside it: there `cargo run`
    /// leaves what nobody asked for by name. Where this code is a library of another program, as in Python, also those beside that library.
    pub fn beside_program() -> Libraries {
        let mut libraries = Libraries::beside(&std::env::current_exe().unwrap_or_default());
        if let Some(folder) = own_place::library().as_deref().and_then(Path::parent) {
            libraries.add_from(folder);
        }
        libraries
    }

    /// The same beside any program.
    fn beside(program: &Path) -> Libraries {
        let folders = program.ancestors().skip(1).take(2);
        let mut libraries = Libraries::default();
        for folder in folders {
            // cargo leaves the library in `deps`, and some of its commands do not renew the one beside the program.
            libraries.add_newest(&[folder, &folder.join("deps")]);
        }
        libraries
    }

    /// Adds what lies in a folder and is not there yet.
    pub fn add_from(&mut self, folder: &Path) {
        self.add_newest(&[folder]);
    }

    /// Adds the newest of what lies in one of these folders and is not there yet.
    fn add_newest(&mut self, folders: &[&Path]) {
        for (platform, _, names) in PLATFORMS {
            let found = |folder: &&Path| names.iter().map(|name| folder.join(name)).find(|file| file.is_file());
            let written = |file: &PathBuf| file.metadata().and_then(|data| data.modified()).ok();
            // The first of those that are equally new.
            if let Some(file) = folders.iter().rev().filter_map(found).max_by_key(written) {
                self.files.entry(platform).or_insert(file);
            }
        }
    }
}

/// How the variables are named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Naming {
    /// With dots, as in `stern.fairlead.position.x`: FMI's structured naming convention.
    #[default]
    Structured,
    /// Letters, digits and underscores alone, as in `stern_fairlead_position_x`, for tools that make buses of dots.
    Flat,
}

impl Naming {
    /// A structured name by this convention.
    fn of(self, name: &str) -> String {
        match self {
            Naming::Structured => name.to_owned(),
            Naming::Flat => {
                let parts = name.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|part| !part.is_empty());
                parts.collect::<Vec<_>>().join("_")
            }
        }
    }
}

/// Refuses names that become one when they are made ASCII, or flat.
fn check_names(interface: &Interface, naming: Naming, file: &str) -> Result<(), Error> {
    let mut names: Vec<String> = interface.variables().iter().map(|variable| naming.of(&variable.name)).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(pair) => Err(Error::Value {
            file: file.to_owned(),
            place: "names of lines, line types and the like".to_owned(),
            value: format!("two variables called {}", pair[0]),
            allowed: "names must differ in ASCII letters and digits: FMI knows no others, and they are transliterated".to_owned(),
        }),
    }
}

/// Writes the FMU of a checked scene to `out`, and `NAME_OspModelDescription.xml` into the same folder; returns the path of the latter.
///
/// `name` is the scene's: the FMU's modelName. Errors: a scene of too many lines, a fairlead that a constraint holds, no library, a file
/// that cannot be written.
pub fn pack(scene: &Scene, name: &str, naming: Naming, libraries: &Libraries, out: &Path) -> Result<PathBuf, Error> {
    if !(1..=MOST_LINES).contains(&scene.lines.len()) {
        return Err(Error::Value {
            file: name.to_owned(),
            place: "lines".to_owned(),
            value: format!("a scene of {} lines", scene.lines.len()),
            allowed: format!("an FMU holds 1 to {MOST_LINES} lines"),
        });
    }
    if let Some(index) = scene.lines.iter().position(|line| !line.is_pinned(0.0) && line.fairlead_on.is_none()) {
        return Err(Error::Value {
            file: name.to_owned(),
            place: format!("lines[{index}].constraints"),
            value: "a constraint at the fairlead".to_owned(),
            allowed:
                "an FMU's inputs move the fairlead, so it must be pinned: lock all three axes there, without a reference or a \
                      motion of its own, or take the constraint away"
                    .to_owned(),
        });
    }
    if libraries.files.is_empty() {
        let names = PLATFORMS.iter().map(|(_, _, names)| names[0]).collect::<Vec<_>>().join(", ");
        let program = std::env::current_exe().unwrap_or_default();
        let reason =
            format!("the FMU's library ({names}) does not lie beside the program; `cargo build --release` puts it there");
        return Err(Error::File { path: program.display().to_string(), reason });
    }
    if let Some(index) = scene.bodies.iter().position(|body| body.is_free() && body.load.is_some()) {
        return Err(Error::Value {
            file: out.display().to_string(),
            place: format!("bodies[{index}].load"),
            value: String::from("a file"),
            allowed: format!(
                "an FMU has its loads from the master, as `{}.applied_force` and `.applied_moment`; leave the file out",
                scene.bodies[index].name
            ),
        });
    }
    let scene = self_contained(scene);
    let interface = Interface::new(&scene);
    check_names(&interface, naming, name)?;
    let description = named(render(&scene, name, &timestamp()), naming);
    let mut files: Vec<(String, Vec<u8>)> = vec![
        ("modelDescription.xml".to_owned(), description.into_bytes()),
        ("model.png".to_owned(), PICTURE.to_vec()),
        ("documentation/index.html".to_owned(), documentation(&interface, naming).into_bytes()),
        ("documentation/licenses/license.txt".to_owned(), LICENSE.as_bytes().to_vec()),
        (format!("resources/{SCENE_FILE}"), serde_json::to_vec_pretty(&scene).map_err(|error| failure(out, &error))?),
    ];
    for (platform, library, _) in PLATFORMS {
        if let Some(file) = libraries.files.get(platform) {
            files.push((format!("binaries/{platform}/{library}"), fs::read(file).map_err(|error| failure(file, &error))?));
        }
    }
    write_archive(&files, out)?;
    let port = out.with_file_name(format!("{name}_OspModelDescription.xml"));
    fs::write(&port, named(osp_description(&interface), naming)).map_err(|error| failure(&port, &error))?;
    Ok(port)
}

fn failure(path: &Path, error: &dyn std::error::Error) -> Error {
    Error::File { path: path.display().to_string(), reason: error.to_string() }
}

/// Writes the archive completely or not at all: a master never finds half an FMU.
fn write_archive(files: &[(String, Vec<u8>)], out: &Path) -> Result<(), Error> {
    let unfinished = out.with_extension("fmu.part");
    let fail = |error: &dyn std::error::Error| failure(out, error);
    let mut archive = ZipWriter::new(File::create(&unfinished).map_err(|error| fail(&error))?);
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).unix_permissions(0o644);
    for (name, content) in files {
        archive.start_file(name.as_str(), options).map_err(|error| fail(&error))?;
        archive.write_all(content).map_err(|error| fail(&error))?;
    }
    archive.finish().map_err(|error| fail(&error))?;
    fs::rename(&unfinished, out).map_err(|error| fail(&error))
}

/// The scene without what lies in other files: the master moves the fairlead, so a motion from a file has no part in an FMU.
pub fn self_contained(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if let Motion::File { .. } = scene.motion {
        scene.motion = Motion::Fixed;
    }
    for body in &mut scene.bodies {
        if let BodyMotion::File { .. } = body.motion {
            body.motion = BodyMotion::Fixed;
        }
    }
    for point in &mut scene.points {
        if !point.is_free() {
            point.motion = PointMotion::Fixed;
        }
    }
    scene
}

/// modelDescription.xml for a scene: name, GUID, date, and the variables of its interface with their start values, each as in the file of
/// the built-in scene.
pub fn render(scene: &Scene, name: &str, date: &str) -> String {
    let interface = Interface::new(scene);
    let mut text = String::with_capacity(MODEL_DESCRIPTION.len());
    let lines = || MODEL_DESCRIPTION.lines();
    for line in lines().take_while(|line| !line.starts_with("    <!--")) {
        let line = match line {
            _ if line.starts_with("  modelName=\"") => with_attribute(line, "modelName", &escaped(name)),
            _ if line.starts_with("  version=\"") => with_attribute(line, "version", env!("CARGO_PKG_VERSION")),
            _ if line.starts_with("  guid=\"") => with_attribute(line, "guid", &guid(scene)),
            _ if line.starts_with("  generationDateAndTime=\"") => with_attribute(line, "generationDateAndTime", date),
            _ => line.to_owned(),
        };
        text.push_str(&(line + "\n"));
    }
    let remark = if interface.has_scene_names() { Some(REPLACEMENT) } else { lines().find(|line| line.starts_with(REPLACEABLE)) };
    let mut remark = remark.map(|remark| format!("{remark}\n"));
    for (index, variable) in (1..).zip(interface.variables()) {
        if variable.is_of_scene() {
            text.push_str(&remark.take().unwrap_or_default());
        }
        text.push_str(&format!("    <!-- {index} -->\n{}", description_of(variable, &interface)));
    }
    text.push_str("  </ModelVariables>\n\n");
    text.push_str(&model_structure(&interface));
    text.push_str("</fmiModelDescription>\n");
    text
}

/// The same description with its variables named by a convention.
fn named(description: String, naming: Naming) -> String {
    if naming == Naming::Structured {
        return description;
    }
    let flat = |line: &str, name: &str| match attribute(line, name) {
        Some(value) => with_attribute(line, name, &naming.of(&value.replace("&apos;", "'"))),
        None => line.to_owned(),
    };
    let lines = description.lines().map(|line| match line.trim_start() {
        start if start.starts_with("<ScalarVariable ") => flat(line, "name"),
        start if start.starts_with("<Variable ") => flat(line, "ref"),
        start if start.starts_with("variableNamingConvention=") => with_attribute(line, "variableNamingConvention", "flat"),
        _ => line.to_owned(),
    });
    lines.map(|line| line + "\n").collect()
}

/// The element of a variable: that of modelDescription.xml with its name, value reference and start value, or, for a quantity of the
/// scene, a new one.
fn description_of(variable: &Variable, interface: &Interface) -> String {
    let (name, reference, start) = (escaped(&variable.name), variable.reference.to_string(), variable.start.to_string());
    if let Meaning::Place(_) = variable.meaning {
        let kind = if variable.kind == Kind::Real { "Real" } else { "Integer" };
        return format!(
            "    <ScalarVariable name=\"{name}\" valueReference=\"{reference}\" causality=\"parameter\" variability=\"fixed\" \
             initial=\"exact\" description=\"{name} of the scene\">\n      <{kind} min=\"{}\" max=\"{}\" start=\"{start}\"/>\n    \
             </ScalarVariable>\n",
            variable.min, variable.max
        );
    }
    if let Some(row) = row_of(variable, interface.scene()) {
        return row.element(&name, variable.reference, variable.start);
    }
    let head = format!("    <ScalarVariable name=\"{}\"", variable.stem);
    let element = MODEL_DESCRIPTION.lines().skip_while(|line| !line.starts_with(&head)).take(3);
    let changed = element.map(|line| match line {
        _ if line.starts_with(&head) => with_attribute(&with_attribute(line, "name", &name), "valueReference", &reference),
        _ if attribute(line, "start").is_some() => with_attribute(line, "start", &start),
        _ => line.to_owned(),
    });
    changed.map(|line| line + "\n").collect()
}

/// The row of the table that a variable of a body or point comes from.
fn row_of(variable: &Variable, scene: &Scene) -> Option<Row> {
    let (rows, first) = match variable.meaning {
        Meaning::BodyOutput(body_variables::BodyOutput::Point(..)) => {
            (body_variables::of_point(), body_variables::block_of_point(scene, variable.line))
        }
        Meaning::BodyInput(_) | Meaning::BodyOutput(_) | Meaning::Choice(_) => {
            let free = scene.bodies.get(variable.line)?.is_free();
            (body_variables::of_body(free), body_variables::block_of_body(scene, variable.line))
        }
        _ => return None,
    };
    rows.into_iter().find(|row| first + row.offset == variable.reference)
}

/// Where the documentation names the variables.
const VARIABLES: &str = "<!-- variables -->";

/// The page of the FMU, with all its variables.
fn documentation(interface: &Interface, naming: Naming) -> String {
    let mut rows = String::from(
        "<table>\n<tr><th>name</th><th>reference</th><th>causality</th><th>unit</th><th>start</th><th>meaning</th></tr>\n",
    );
    for variable in interface.variables() {
        let element = description_of(variable, interface);
        let of = |name: &str| element.lines().find_map(|line| attribute(line, name)).unwrap_or_default().to_owned();
        let unit = match of("declaredType").as_str() {
            "Position" => "m".to_owned(),
            "Velocity" => "m/s".to_owned(),
            "Force" => "N".to_owned(),
            "Angle" => "rad".to_owned(),
            _ => of("unit"),
        };
        rows.push_str(&format!(
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td>{unit}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(&naming.of(&variable.name)),
            variable.reference,
            of("causality"),
            of("start"),
            of("description")
        ));
    }
    DOCUMENTATION.replace(VARIABLES, &(rows + "</table>"))
}

/// Which output depends on which input: those of what drives its own line, or the lines that hang on its body.
fn model_structure(interface: &Interface) -> String {
    let scene = interface.scene();
    let variables = || (1..).zip(interface.variables());
    let outputs = || variables().filter(|(_, variable)| variable.is_output());
    // Of each line, the lines that move with it, and the bodies that drive or are these.
    let mut together: Vec<(Vec<usize>, Vec<usize>)> = vec![(Vec::new(), Vec::new()); scene.lines.len()];
    for part in partition::parts(scene) {
        let on = |mount: &Option<Mount>| match mount {
            Some(Mount::Body { body, .. }) => scene.body(body),
            _ => None,
        };
        let ends = |index: &usize| [on(&scene.lines[*index].fairlead_on), on(&scene.lines[*index].anchor_on)];
        let mut bodies: Vec<usize> = part.lines.iter().flat_map(ends).flatten().collect();
        bodies.sort_unstable();
        bodies.dedup();
        part.lines.iter().for_each(|line| together[*line] = (part.lines.clone(), bodies.clone()));
    }
    let inputs_of = |lines: &[usize], bodies: &[usize]| -> String {
        let own = |variable: &Variable| match variable.meaning {
            Meaning::Input(_) => lines.contains(&variable.line),
            Meaning::BodyInput(_) => bodies.contains(&variable.line),
            _ => false,
        };
        let inputs = variables().filter(|(_, variable)| own(variable));
        inputs.map(|(index, _): (usize, _)| index.to_string()).collect::<Vec<_>>().join(" ")
    };
    let of_lines: Vec<String> = together.iter().map(|(lines, bodies)| inputs_of(lines, bodies)).collect();
    let of_things = |hung: &dyn Fn(&Option<Mount>) -> bool, own: Option<usize>| {
        let hanging = scene.lines.iter().enumerate().filter(|(_, line)| hung(&line.fairlead_on) || hung(&line.anchor_on));
        let (mut lines, mut bodies) = (Vec::new(), own.into_iter().collect::<Vec<usize>>());
        for (index, _) in hanging {
            lines.extend(&together[index].0);
            bodies.extend(&together[index].1);
        }
        inputs_of(&lines, &bodies)
    };
    let of_bodies: Vec<String> = scene
        .bodies
        .iter()
        .enumerate()
        .map(|(index, body)| {
            of_things(&|on| matches!(on, Some(Mount::Body { body: name, .. }) if *name == body.name), Some(index))
        })
        .collect();
    let of_points: Vec<String> = scene
        .points
        .iter()
        .map(|point| of_things(&|on| matches!(on, Some(Mount::Point { point: name }) if *name == point.name), None))
        .collect();
    let mut text = String::from("  <ModelStructure>\n    <Outputs>\n");
    for (index, output) in outputs() {
        let inputs = match output.meaning {
            Meaning::BodyOutput(body_variables::BodyOutput::Point(..)) => &of_points[output.line],
            Meaning::BodyOutput(_) => &of_bodies[output.line],
            _ => &of_lines[output.line],
        };
        text.push_str(&format!("      <Unknown index=\"{index}\" dependencies=\"{inputs}\"/>\n"));
    }
    text.push_str("    </Outputs>\n    <InitialUnknowns>\n");
    outputs().for_each(|(index, _)| text.push_str(&format!("      <Unknown index=\"{index}\"/>\n")));
    text + "    </InitialUnknowns>\n  </ModelStructure>\n"
}

/// The value of an attribute in a line of XML.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = line.split_once(&format!("{name}=\""))?;
    rest.split_once('"').map(|(value, _)| value)
}

/// A line of XML with another value of an attribute.
fn with_attribute(line: &str, name: &str, value: &str) -> String {
    let opening = format!("{name}=\"");
    let Some((before, rest)) = line.split_once(&opening) else { return line.to_owned() };
    let after = rest.split_once('"').map_or("", |(_, after)| after);
    format!("{before}{opening}{value}\"{after}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The port of each fairlead: a pair of force and velocity, which one connection of a system structure joins to a vessel's.
fn osp_description(interface: &Interface) -> String {
    let mut groups = String::new();
    let scene = interface.scene();
    for line in (0..interface.lines()).filter(|line| scene.lines[*line].fairlead_on.is_none()) {
        let prefix = escaped(&interface.prefix(line));
        let variables = |indent: usize, stem: &str| -> String {
            ["x", "y", "z"].map(|axis| format!("{:indent$}<Variable ref=\"{prefix}{stem}.{axis}\"/>\n", "")).concat()
        };
        groups += &format!(
            "    <LinearMechanicalPort name=\"{prefix}fairlead\">\n      <Force name=\"{prefix}fairlead force\">\n{}      </Force>\n      \
             <LinearVelocity name=\"{prefix}fairlead velocity\">\n{}      </LinearVelocity>\n    </LinearMechanicalPort>\n    \
             <Generic name=\"{prefix}fairlead position\">\n{}    </Generic>\n",
            variables(8, "force"),
            variables(8, "fairlead.velocity"),
            variables(6, "fairlead.position"),
        );
    }
    for index in (0..scene.bodies.len()).filter(|index| !scene.bodies[*index].is_free()) {
        let name = escaped(&interface.body_prefix(index));
        let variables = |indent: usize, stem: &str, axes: [&str; 3]| -> String {
            axes.map(|axis| format!("{:indent$}<Variable ref=\"{name}{stem}.{axis}\"/>\n", "")).concat()
        };
        let (axes, angles) = (["x", "y", "z"], ["roll", "pitch", "yaw"]);
        groups += &format!(
            "    <LinearMechanicalPort name=\"{name}linear\">\n      <Force name=\"{name}force\">\n{}      </Force>\n      \
             <LinearVelocity name=\"{name}velocity\">\n{}      </LinearVelocity>\n    </LinearMechanicalPort>\n    \
             <AngularMechanicalPort name=\"{name}angular\">\n      <Torque name=\"{name}moment\">\n{}      </Torque>\n      \
             <AngularVelocity name=\"{name}angular velocity\">\n{}      </AngularVelocity>\n    </AngularMechanicalPort>\n    \
             <Generic name=\"{name}position\">\n{}    </Generic>\n    <Generic name=\"{name}attitude\">\n{}    </Generic>\n",
            variables(8, "force", axes),
            variables(8, "velocity", axes),
            variables(8, "moment", axes),
            variables(8, "angular_velocity", axes),
            variables(6, "position", axes),
            variables(6, "attitude", angles),
        );
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <OspModelDescription xmlns=\"http://opensimulationplatform.com/MSMI/OSPModelDescription\" version=\"1.0\">\n  \
         <VariableGroups>\n{groups}  </VariableGroups>\n</OspModelDescription>\n"
    )
}

/// Now, as XML wants it: 2026-11-22T14:05:00Z.
fn timestamp() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |elapsed| elapsed.as_secs());
    let (mut year, mut day) = (1970, seconds / 86400);
    let days_of =
        |year: u64| if year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)) { 366 } else { 365 };
    while day >= days_of(year) {
        day -= days_of(year);
        year += 1;
    }
    let mut month = 0;
    let lengths = [31, days_of(year) - 337, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    while let Some(length) = lengths.get(month).filter(|length| day >= **length) {
        day -= length;
        month += 1;
    }
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year}-{:02}-{:02}T{hour:02}:{minute:02}:{second:02}Z", month + 1, day + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn built_in() -> Scene {
        let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lindahl-sjoberg.json"));
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn packing_the_built_in_scene_gives_the_description_back_byte_for_byte() {
        let scene = built_in();
        let packed = render(&scene, "moorline", "2026-01-01T00:00:00Z");
        assert_eq!(packed.replace(&guid(&scene), "{00000000-0000-0000-0000-000000000000}"), MODEL_DESCRIPTION);
    }

    #[test]
    fn another_scene_brings_its_name_and_start_values() {
        let mut scene = built_in();
        scene.lines[0].sections[0].length = 1250.0;
        scene.lines[0].sections[0].elements = Some(40);
        scene.lines[0].fairlead = [1.5, 0.0, -3.25];
        let text = render(&scene, "bow <1>", "2026-01-01T00:00:00Z");
        for words in ["modelName=\"bow &lt;1&gt;\"", "start=\"1250\"", "start=\"40\"", "start=\"1.5\"", "start=\"-3.25\""] {
            assert!(text.contains(words), "{words} is missing");
        }
        assert!(!text.contains("start=\"1200\"") && !text.contains(&guid(&built_in())));
    }

    #[test]
    fn a_line_of_two_sections_has_its_quantities_under_their_own_names() {
        let mut scene = built_in();
        let section = scene.lines[0].sections[0].clone();
        scene.lines[0].sections.push(section);
        let text = render(&scene, "two", "2026-01-01T00:00:00Z");
        for name in
            ["environment.depth", "line_types.chain.ea", "lines[0].sections[1].length", "lines[0].anchor[2]", "solver.scheme"]
        {
            assert!(text.contains(&format!("name=\"{name}\"")), "{name} is missing");
        }
        assert!(!text.contains("line.length\"") && !text.contains("lines[0].fairlead"));
        assert!(text.ends_with("</fmiModelDescription>\n") && text.contains("  <ModelStructure>"));
    }

    #[test]
    fn of_several_lines_each_has_its_variables_under_its_name() {
        let mut scene = built_in();
        scene.lines[0].name = "bow".into();
        scene.lines.push(scene.lines[0].clone());
        scene.lines[1].name = "stern line".into();
        scene.lines[1].sections[0].length = 1250.0;
        let text = render(&scene, "two", "2026-01-01T00:00:00Z");
        for words in [
            "name=\"bow.tension\" valueReference=\"10\"",
            "name=\"'stern line'.tension\" valueReference=\"1000010\"",
            "name=\"'stern line'.solver.substeps\" valueReference=\"1000030\"",
            "name=\"'stern line'.line.ea\" valueReference=\"1000046\"",
            "name=\"'stern line'.anchor.position.x\" valueReference=\"1000056\"",
            "name=\"solver.scheme\" valueReference=\"40\"",
            "name=\"water.depth\" valueReference=\"59\"",
            "start=\"1250\"",
        ] {
            assert_eq!(text.matches(words).count(), 1, "{words}");
        }
        let references: Vec<u32> = text.lines().filter_map(|line| attribute(line, "valueReference")?.parse().ok()).collect();
        assert!(references.is_sorted_by(|a, b| a < b), "value references do not rise: {references:?}");
        let (first, second) = text.split_once("dependencies=\"1 2 3 4 5 6\"").unwrap();
        assert!(first.contains("<Outputs>") && second.contains("dependencies=\"51 52 53 54 55 56\""));
        assert!(osp_description(&Interface::new(&scene)).contains("<Variable ref=\"'stern line'.force.x\"/>"));
    }

    /// `cargo run` in an empty folder leaves the program in `target/release` and its library in `target/release/deps`; `cargo test` renews the
    /// latter alone, where `cargo build` had made both one.
    #[test]
    fn the_library_is_found_where_cargo_run_leaves_it() {
        let folder = std::env::temp_dir().join(format!("moorline-pack-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("deps")).unwrap();
        assert!(Libraries::beside(&folder.join("moorline")).files.is_empty());
        let [inner, outer] = ["deps/libmoorline.so", "libmoorline.so"].map(|name| folder.join(name));
        let found = || Libraries::beside(&folder.join("moorline")).files.into_values().collect::<Vec<_>>();
        std::fs::write(&inner, b"").unwrap();
        assert_eq!(found(), std::slice::from_ref(&inner));
        std::fs::hard_link(&inner, &outer).unwrap();
        assert_eq!(found(), std::slice::from_ref(&outer));
        std::fs::remove_file(&inner).unwrap();
        std::fs::write(&inner, b"").unwrap();
        let later = std::time::SystemTime::now() + std::time::Duration::from_secs(10);
        std::fs::File::options().write(true).open(&inner).unwrap().set_modified(later).unwrap();
        assert_eq!(found(), [inner]);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    /// FMI's structured names are ASCII; what tools make buses of is left out of flat ones; names that meet are refused.
    #[test]
    fn names_are_what_every_tool_takes() {
        let mut scene = built_in();
        scene.lines.push(scene.lines[0].clone());
        scene.lines[0].name = "R4 Ø84".to_owned();
        scene.lines[1].name = "係留索".to_owned();
        let text = render(&scene, "two", "2026-01-01T00:00:00Z");
        let names: Vec<&str> =
            text.lines().filter(|line| line.contains("<ScalarVariable")).filter_map(|line| attribute(line, "name")).collect();
        assert!(names.iter().all(|name| name.is_ascii()) && names.contains(&"'R4 O84'.tension"), "{names:?}");
        let flat = named(text, Naming::Flat);
        assert!(flat.contains("name=\"R4_O84_fairlead_position_x\"") && flat.contains("variableNamingConvention=\"flat\""));
        assert!(named(osp_description(&Interface::new(&scene)), Naming::Flat).contains("ref=\"R4_O84_force_x\""));
        assert!(check_names(&Interface::new(&scene), Naming::Flat, "two").is_ok());
        scene.lines[1].name = "R4 O84".to_owned();
        let error = check_names(&Interface::new(&scene), Naming::Structured, "two").unwrap_err().to_string();
        assert!(error.contains("R4 O84") && error.contains("ASCII"), "{error}");
    }

    #[test]
    fn a_fairlead_that_inputs_cannot_move_is_refused() {
        let mut scene = built_in();
        let springs = serde_json::json!({"s": 0.0, "stiffness": [1.0e6, 1.0e6, 1.0e6]});
        scene.lines[0].constraints.push(serde_json::from_value(springs).unwrap());
        let error =
            pack(&scene, "winch", Naming::Structured, &Libraries::default(), Path::new("winch.fmu")).unwrap_err().to_string();
        assert!(error.contains("lines[0].constraints") && error.contains("pinned"), "{error}");
    }

    #[test]
    fn without_a_library_the_message_says_where_it_must_lie() {
        let error = pack(&built_in(), "moorline", Naming::Structured, &Libraries::default(), Path::new("moorline.fmu"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("libmoorline.so") && error.contains("cargo build --release"), "{error}");
    }

    #[test]
    fn the_timestamp_is_a_date_of_this_century() {
        let now = timestamp();
        assert!(now.len() == 20 && now.starts_with("20") && now.ends_with('Z'), "{now}");
    }
}
