//! Writing a MoorDyn file, version 2, and the files beside it: tables of strain and tension, the current, a sloping bed.

use crate::scene::moordyn::from_scene::Conversion;
use crate::scene::moordyn::options::Depth;
use crate::scene::moordyn::words::{Attachment, LineEnd, Side};
use crate::scene::moordyn::{LineKind, Stiffness};
use crate::scene::types::Triple;
use std::fmt::Write;

/// How far the grid of a sloping bed reaches from the origin [m].
const FAR: f64 = 1.0e4;

/// A deck's texts: its own, and those of files beside it by their names.
#[derive(Debug, Clone, PartialEq)]
pub struct Texts {
    /// The deck.
    pub deck: String,
    /// Name and text of the files beside it.
    pub beside: Vec<(String, String)>,
}

/// The texts of a deck whose own file is called `stem` without its ending.
pub fn texts(conversion: &Conversion, stem: &str) -> Texts {
    let deck = &conversion.deck;
    let mut beside = Vec::new();
    let title = if deck.title.is_empty() { "A mooring" } else { deck.title.as_str() };
    let mut text =
        format!("--------------------- MoorDyn Input File ------------------------------------\n{}\n", title.replace('#', " "));
    table(
        &mut text,
        "LINE TYPES",
        "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
        "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
        deck.line_types.iter().map(|kind| line_type(kind, stem, &mut beside)).collect(),
    );
    table(&mut text, "ROD TYPES", "TypeName Diam Mass/m Cd Ca CdEnd CaEnd", "(name) (m) (kg/m) (-) (-) (-) (-)", {
        let row = |kind: &super::RodKind| {
            let numbers = [kind.diameter, kind.mass, kind.drag, kind.added_mass, kind.end_drag, kind.end_added_mass];
            joined(&kind.name, &numbers)
        };
        deck.rod_types.iter().map(row).collect()
    });
    table(
        &mut text,
        "BODIES",
        "ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca",
        "(#) (word) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)",
        {
            let row = |body: &super::DeckBody| {
                let pose: Vec<f64> = body.position.iter().chain(&body.attitude).copied().collect();
                let head = joined(&format!("{} {}", body.id, word(body.attachment)), &pose);
                let parts = [
                    barred(&body.centre),
                    together(&body.inertia),
                    number(body.volume),
                    together(&body.drag_area),
                    together(&body.added_mass),
                ];
                format!("{head} {} {}", number(body.mass), parts.join(" "))
            };
            deck.bodies.iter().map(row).collect()
        },
    );
    table(
        &mut text,
        "RODS",
        "ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs",
        "(#) (name) (word/ID) (m) (m) (m) (m) (m) (m) (-) (-)",
        {
            let row = |rod: &super::DeckRod| {
                let ends: Vec<f64> = rod.a.iter().chain(&rod.b).copied().collect();
                let head = format!("{} {} {}", rod.id, deck.rod_types[rod.kind].name, word(rod.attachment));
                format!("{} {} -", joined(&head, &ends), rod.segments)
            };
            deck.rods.iter().map(row).collect()
        },
    );
    // Constant forces on points have columns of their own, which are left out where there are none.
    let forces = deck.points.iter().any(|point| point.force != [0.0; 3]);
    let (names, units) = match forces {
        true => ("ID Attachment X Y Z Mass Volume FX FY FZ CdA Ca", "(#) (word/ID) (m) (m) (m) (kg) (m^3) (N) (N) (N) (m^2) (-)"),
        false => ("ID Attachment X Y Z Mass Volume CdA Ca", "(#) (word/ID) (m) (m) (m) (kg) (m^3) (m^2) (-)"),
    };
    table(&mut text, "POINTS", names, units, {
        let row = |point: &super::DeckPoint| {
            let mut numbers = point.position.to_vec();
            numbers.extend([point.mass, point.volume]);
            numbers.extend(point.force.iter().filter(|_| forces));
            numbers.extend([point.drag_area, point.added_mass]);
            joined(&format!("{} {}", point.id, word(point.attachment)), &numbers)
        };
        deck.points.iter().map(row).collect()
    });
    table(&mut text, "LINES", "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs", "(#) (name) (ID) (ID) (m) (-) (-)", {
        let row = |line: &super::DeckLine| {
            let [a, b] = line.ends.map(end);
            format!("{} {} {a} {b} {} {} p", line.id, deck.line_types[line.kind].name, number(line.length), line.segments)
        };
        deck.lines.iter().map(row).collect()
    });
    options(&mut text, conversion, stem, &mut beside);
    text += "---------------------- OUTPUTS ----------------------------------------------\n";
    for line in &deck.lines {
        // Writing to a string does not fail.
        let _ = writeln!(text, "FAIRTEN{0}\nANCHTEN{0}", line.id);
    }
    text += "------------------------- need this line ------------------------------------\n";
    Texts { deck: text, beside }
}

/// A section with its rows in columns; nothing where there are none.
fn table(text: &mut String, title: &str, names: &str, units: &str, rows: Vec<String>) {
    if rows.is_empty() {
        return;
    }
    let all: Vec<Vec<&str>> =
        [names, units].into_iter().chain(rows.iter().map(String::as_str)).map(|row| row.split(' ').collect()).collect();
    let columns = all.iter().map(Vec::len).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns)
        .map(|column| all.iter().filter_map(|row| row.get(column)).map(|word| word.chars().count()).max().unwrap_or(0))
        .collect();
    let _ = writeln!(text, "{:-<78}", format!("---------------------- {title} "));
    for row in &all {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(word, width)| format!("{word:<width$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
}

fn line_type(kind: &LineKind, stem: &str, beside: &mut Vec<(String, String)>) -> String {
    let stiffness = match &kind.stiffness {
        Stiffness::Linear(ea) => number(*ea),
        Stiffness::Table(points) => {
            let name = format!("{stem}.{}.dat", kind.name);
            let mut text = format!("---- {} ----\nStrain Tension\n(-) (N)\n", kind.name);
            let rows: Vec<String> =
                points.iter().map(|[strain, tension]| format!("{} {}", number(*strain), number(*tension))).collect();
            text += &rows.join("\n");
            beside.push((name.clone(), text));
            name
        }
    };
    let rest = [kind.damping, kind.ei, kind.drag, kind.added_mass, kind.drag_along, kind.added_mass_along];
    joined(&format!("{} {} {} {stiffness}", kind.name, number(kind.diameter), number(kind.mass)), &rest)
}

fn options(text: &mut String, conversion: &Conversion, stem: &str, beside: &mut Vec<(String, String)>) {
    let options = &conversion.deck.options;
    let depth = match options.depth {
        Some(Depth::Level(depth)) => depth,
        _ => 0.0,
    };
    let mut rows = vec![
        (number(options.gravity), "g", "gravity (m/s^2)"),
        (number(options.water_density), "WtrDnsty", "water density (kg/m^3)"),
        (number(depth), "WtrDpth", "water depth (m)"),
        (number(options.bed_stiffness), "kBot", "bottom stiffness (Pa/m)"),
        (number(options.bed_damping), "cBot", "bottom damping (Pa-s/m)"),
        (number(options.friction), "FrictionCoefficient", "bottom friction (-)"),
        (number(options.output_step), "dtOut", "time between outputs (s)"),
        (String::from("0.5"), "CFL", "Courant number that sets the time step (-)"),
        (String::from("600"), "TmaxIC", "longest time for the initial state (s)"),
        (String::from("1.0"), "dtIC", "time between looks at the initial state (s)"),
        (String::from("1e-4"), "threshIC", "threshold of the initial state (-)"),
    ];
    if options.currents {
        rows.push((String::from("1"), "Currents", "the profile is in current_profile.txt"));
        beside.push((String::from("current_profile.txt"), profile(&conversion.current)));
    }
    if conversion.slope_deg != [0.0; 2] {
        let name = format!("{stem}.seafloor.txt");
        beside.push((name.clone(), grid(depth, conversion.slope_deg)));
        rows.push((name, "SeafloorFile", "the sloping bed on a grid"));
    }
    *text += "---------------------- OPTIONS ----------------------------------------------\n";
    let width = rows.iter().map(|(value, ..)| value.chars().count()).max().unwrap_or(0);
    for (value, key, what) in rows {
        let _ = writeln!(text, "{value:<width$}  {key:<20} {what}");
    }
}

fn profile(current: &[(f64, Triple)]) -> String {
    let mut rows = current.to_vec();
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut text = String::from("---- current ----\nover the depth\nz (m), ux (m/s), uy (m/s), uz (m/s)\n");
    let rows: Vec<String> = rows.iter().map(|(z, velocity)| joined(&number(*z), velocity)).collect();
    text += &rows.join("\n");
    text
}

/// A plane bed at four places.
fn grid(depth: f64, slope_deg: [f64; 2]) -> String {
    let [a, b] = slope_deg.map(|slope| slope.to_radians().tan());
    let mut text = format!("2 2\n{0} {FAR}\n{0} {FAR}", -FAR);
    for x in [-FAR, FAR] {
        for y in [-FAR, FAR] {
            let _ = write!(text, "\n{x} {y} {}", number(-depth + a * x + b * y));
        }
    }
    text
}

fn word(attachment: Attachment) -> String {
    match attachment {
        Attachment::Fixed => String::from("Fixed"),
        Attachment::Coupled => String::from("Coupled"),
        Attachment::CoupledPinned => String::from("CoupledPinned"),
        Attachment::Pinned => String::from("Pinned"),
        Attachment::Free => String::from("Free"),
        Attachment::Body(id) => format!("Body{id}"),
        Attachment::BodyPinned(id) => format!("Body{id}Pinned"),
        Attachment::Turbine(id) => format!("Turbine{id}"),
    }
}

fn end(of: LineEnd) -> String {
    match of {
        LineEnd::Point(id) => id.to_string(),
        LineEnd::Rod(id, Side::A) => format!("R{id}A"),
        LineEnd::Rod(id, Side::B) => format!("R{id}B"),
    }
}

fn joined(head: &str, numbers: &[f64]) -> String {
    numbers.iter().fold(head.to_string(), |text, value| text + " " + &number(*value))
}

/// Numbers with bars between them; one for all where they are the same.
fn together(numbers: &[f64]) -> String {
    match numbers {
        [first, rest @ ..] if rest.iter().all(|value| value == first) => number(*first),
        _ => barred(numbers),
    }
}

fn barred(numbers: &[f64]) -> String {
    numbers.iter().map(|value| number(*value)).collect::<Vec<_>>().join("|")
}

/// The shortest text that is read as the same number.
fn number(value: f64) -> String {
    let value = value + 0.0;
    if value == 0.0 || (1.0e-4..1.0e7).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}
