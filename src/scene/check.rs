//! Plausibility of a scene: one rule, one function, one finding.
//!
//! What passes can be computed: every number is finite and of the right sign, every name means something, every line can reach.
//! Numbers beyond 1e15 in size, and positive ones below 1e-12, are taken for slips: products of them would leave the range of f64.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

mod bodies;
mod cable_1994;
mod finding;

use crate::error::{Error, Limit, Reach, among};
use crate::scene::check::finding::{
    distance, finite, in_type, not_negative, number, positive, refuse, sections, sinusoid, triple,
};
use crate::scene::motion_file::Table;
use crate::scene::types::{Line, LineType, Motion, NormalTangential, ReferenceMotion, Scene, Triple, Waves};

/// Most elements of a scene.
const MOST_ELEMENTS: usize = 20_000;
/// Most components of a sea.
const MOST_COMPONENTS: usize = 5000;
/// Most rows of `timeseries.csv`.
const MOST_ROWS: f64 = 5.0e7;
/// A motion file that begins farther than this from the scene's fairlead [m] may have other axes.
const FAR: f64 = 5.0;

/// A rule looks at the scene and finds one thing wrong, or nothing; the text is the file's name for the message.
type Rule = fn(&Scene, &str) -> Result<(), Error>;

/// All rules, in the order in which a reader would mend: numbers, names, geometry, then what is not there yet.
const RULES: [Rule; 36] = [
    gravity,
    water_density,
    depth,
    seabed,
    slope,
    current,
    waves,
    line_types_exist,
    line_type_names,
    line_type_numbers,
    tension_tables,
    inner_fluids,
    weight_given_once,
    weight_leaves_buoyancy,
    lines_exist,
    line_names,
    sections_exist,
    section_types,
    lengths,
    elements,
    attachments,
    constraints,
    bodies::names,
    bodies::bodies,
    bodies::points,
    bodies::ends,
    bodies::held,
    bodies::places_above_bed,
    ends_above_bed,
    motion_numbers,
    motion_above_bed,
    file_moves_one_line,
    run,
    solver,
    reach,
    cable_1994::cable_1994,
];

/// Checks a scene; `file` names it in the message. Returns warnings, or the first thing that is wrong.
pub fn check(scene: &Scene, file: &str) -> Result<Vec<String>, Error> {
    for rule in RULES {
        rule(scene, file)?;
    }
    Ok([unused_line_types(scene), breaking_waves(scene), without_effect(scene)].concat())
}

fn gravity(scene: &Scene, file: &str) -> Result<(), Error> {
    positive(file, "environment.gravity", scene.environment.gravity, "m/s²")
}

fn water_density(scene: &Scene, file: &str) -> Result<(), Error> {
    not_negative(file, "environment.water_density", scene.environment.water_density, "kg/m³")
}

fn depth(scene: &Scene, file: &str) -> Result<(), Error> {
    positive(file, "environment.depth", scene.environment.depth, "m: the seabed lies at z = -depth")
}

fn seabed(scene: &Scene, file: &str) -> Result<(), Error> {
    let seabed = &scene.environment.seabed;
    if let Some(stiffness) = seabed.stiffness {
        positive(file, "environment.seabed.stiffness", stiffness, "Pa; leave it out for the line's weight / diameter")?;
    }
    not_negative(file, "environment.seabed.damping", seabed.damping, "Pa·s")?;
    not_negative(file, "environment.seabed.friction", seabed.friction, "")
}

fn slope(scene: &Scene, file: &str) -> Result<(), Error> {
    for (axis, slope) in scene.environment.seabed.slope_deg.into_iter().enumerate() {
        if !(slope.abs() <= 45.0) {
            return refuse(
                file,
                format!("environment.seabed.slope_deg[{axis}]"),
                number(slope),
                "it must lie between -45 and 45 degrees",
            );
        }
    }
    Ok(())
}

/// Finite rows whose z rises all the way or falls all the way.
fn current(scene: &Scene, file: &str) -> Result<(), Error> {
    let rows = &scene.environment.current;
    for (index, row) in rows.iter().enumerate() {
        finite(file, &format!("environment.current[{index}].z"), &[row.z])?;
        finite(file, &format!("environment.current[{index}].velocity"), &row.velocity)?;
    }
    let rising = rows.len() < 2 || rows[1].z > rows[0].z;
    for (index, pair) in rows.windows(2).enumerate() {
        let place = format!("environment.current[{}].z", index + 1);
        if pair[0].z == pair[1].z {
            return refuse(file, place, number(pair[1].z), "the row before has the same z; give one velocity per height");
        }
        if (pair[1].z > pair[0].z) != rising {
            return refuse(file, place, number(pair[1].z), "z must rise from row to row, or fall from row to row");
        }
    }
    Ok(())
}

/// Numbers of the right sign, and a surface that stays above the bed.
fn waves(scene: &Scene, file: &str) -> Result<(), Error> {
    let Some(waves) = &scene.environment.waves else { return Ok(()) };
    let at = |key: &str| format!("environment.waves.{key}");
    let one = |place: &str, amplitude: f64, period: f64, direction: f64, phase: f64| {
        not_negative(file, &at(&format!("{place}amplitude")), amplitude, "m")?;
        positive(file, &at(&format!("{place}period")), period, "s")?;
        finite(file, &at(&format!("{place}direction_deg")), &[direction])?;
        finite(file, &at(&format!("{place}phase_deg")), &[phase])
    };
    let count = |count: usize| match count {
        1..=MOST_COMPONENTS => Ok(()),
        _ => refuse(file, at("components"), count.to_string(), format!("a sea has 1 to {MOST_COMPONENTS} components")),
    };
    let (key, down, ramp) = match waves {
        Waves::Regular { amplitude, period, direction_deg, phase_deg, ramp } => {
            one("", *amplitude, *period, *direction_deg, *phase_deg)?;
            ("amplitude", *amplitude, ramp)
        }
        Waves::Jonswap { hs, tp, gamma, components, direction_deg, ramp, .. } => {
            not_negative(file, &at("hs"), *hs, "m")?;
            positive(file, &at("tp"), *tp, "s")?;
            finite(file, &at("direction_deg"), &[*direction_deg])?;
            count(*components)?;
            if !(1.0..=20.0).contains(gamma) {
                return refuse(
                    file,
                    at("gamma"),
                    number(*gamma),
                    "it must lie between 1 and 20; 3.3 is usual, 1 a full-grown sea",
                );
            }
            ("hs", *hs, ramp)
        }
        Waves::Components { components, ramp } => {
            count(components.len())?;
            for (index, c) in components.iter().enumerate() {
                one(&format!("components[{index}]."), c.amplitude, c.period, c.direction_deg, c.phase_deg)?;
            }
            ("components", components.iter().map(|c| c.amplitude).sum(), ramp)
        }
    };
    not_negative(file, &at("ramp"), ramp.unwrap_or(0.0), "s; 0 means none")?;
    let depth = scene.environment.depth;
    if !(down < depth) {
        let allowed = format!("waves so high would bare the seabed, which is {} m below still water", number(depth));
        return refuse(file, at(key), format!("{} m", number(down)), allowed);
    }
    Ok(())
}

fn line_types_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.line_types.is_empty() {
        return refuse(file, "line_types", "{ }", "a scene needs at least one line type with ea, mass and diameter");
    }
    Ok(())
}

fn line_type_names(scene: &Scene, file: &str) -> Result<(), Error> {
    match scene.line_types.keys().find(|name| name.trim().is_empty() || name.contains(char::is_control)) {
        Some(name) => refuse(file, "line_types", format!("{name:?}"), "a line type needs a name of printable characters"),
        None => Ok(()),
    }
}

fn line_type_numbers(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        let at = |key: &str| in_type(name, key);
        positive(file, &at("ea"), line_type.ea, "N")?;
        positive(file, &at("mass"), line_type.mass, "kg/m")?;
        positive(file, &at("diameter"), line_type.diameter, "m")?;
        if let Some(weight) = line_type.submerged_weight {
            finite(file, &at("submerged_weight"), &[weight])?;
        }
        if let Some(buoyancy) = line_type.buoyancy {
            not_negative(file, &at("buoyancy"), buoyancy, "N/m")?;
        }
        not_negative(file, &at("ei"), line_type.ei, "N·m²")?;
        not_negative(file, &at("damping"), line_type.damping, "s")?;
        for (key, NormalTangential { normal, tangential }) in [("drag", line_type.drag), ("added_mass", line_type.added_mass)] {
            not_negative(file, &at(&format!("{key}.normal")), normal, "")?;
            not_negative(file, &at(&format!("{key}.tangential")), tangential, "")?;
        }
        if let Some(area) = line_type.outer_area {
            not_negative(file, &at("outer_area"), area, "m²; leave it out for the displaced volume per length")?;
        }
        if let Some(stiffness) = line_type.seabed_stiffness {
            positive(file, &at("seabed_stiffness"), stiffness, "Pa; leave it out for environment.seabed.stiffness")?;
        }
        if let Some(load) = line_type.breaking_load {
            positive(file, &at("breaking_load"), load, "N")?;
        }
    }
    Ok(())
}

/// A table begins at [0, 0] and rises, in strain and in tension.
fn tension_tables(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        let Some(table) = &line_type.tension_strain else { continue };
        let place = |point: usize| format!("{}[{point}]", in_type(name, "tension_strain"));
        let shown = |point: &[f64; 2]| format!("[{}, {}]", number(point[0]), number(point[1]));
        if table.len() < 2 {
            let place = in_type(name, "tension_strain");
            return refuse(
                file,
                place,
                format!("{} points", table.len()),
                "give two or more, [strain, tension in N], from [0, 0] on",
            );
        }
        if table[0] != [0.0, 0.0] {
            return refuse(file, place(0), shown(&table[0]), "the first point is [0, 0]: no tension without strain");
        }
        for (point, pair) in table.windows(2).enumerate() {
            finite(file, &place(point + 1), &pair[1])?;
            if !(pair[1][0] > pair[0][0] && pair[1][1] > pair[0][1]) {
                let allowed = format!("strain and tension must rise from point to point; the one before is {}", shown(&pair[0]));
                return refuse(file, place(point + 1), shown(&pair[1]), allowed);
            }
        }
    }
    Ok(())
}

fn inner_fluids(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        if let Some(fluid) = &line_type.inner_fluid {
            not_negative(file, &in_type(name, "inner_fluid.density"), fluid.density, "kg/m³")?;
            not_negative(file, &in_type(name, "inner_fluid.area"), fluid.area, "m²")?;
            finite(file, &in_type(name, "inner_fluid.pressure"), &[fluid.pressure])?;
        }
    }
    Ok(())
}

fn weight_given_once(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        if let (Some(weight), Some(buoyancy)) = (line_type.submerged_weight, line_type.buoyancy) {
            let both = format!("submerged_weight {} and buoyancy {} together", number(weight), number(buoyancy));
            return refuse(
                file,
                in_type(name, "submerged_weight"),
                both,
                "give one of the two, or neither for the buoyancy of `diameter`",
            );
        }
    }
    Ok(())
}

/// Heavier in water than in air is a slip; rounding of a line weighed without buoyancy is not.
fn weight_leaves_buoyancy(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        let in_air = line_type.mass * scene.environment.gravity;
        let weight = line_type.submerged_weight.unwrap_or(0.0);
        if weight > in_air * (1.0 + 1.0e-9) {
            let allowed = format!("it must not exceed the weight in air, mass·gravity = {} N/m", number(in_air));
            return refuse(file, in_type(name, "submerged_weight"), number(weight), allowed);
        }
    }
    Ok(())
}

fn lines_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.lines.is_empty() {
        return refuse(file, "lines", "[ ]", "a scene needs at least one line with fairlead, anchor and sections");
    }
    Ok(())
}

/// Names become column prefixes of `timeseries.csv` and parts of FMU variables.
fn line_names(scene: &Scene, file: &str) -> Result<(), Error> {
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

fn sections_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    match scene.lines.iter().position(|line| line.sections.is_empty()) {
        Some(index) => {
            refuse(file, format!("lines[{index}].sections"), "[ ]", "a line needs at least one section with type and length")
        }
        None => Ok(()),
    }
}

fn section_types(scene: &Scene, file: &str) -> Result<(), Error> {
    let known: Vec<String> = scene.line_types.keys().cloned().collect();
    for (place, line_type) in sections(scene).map(|(place, section)| (place, &section.line_type)) {
        if !scene.line_types.contains_key(line_type) {
            let allowed = format!("it must be one of line_types{}", among(line_type, &known));
            return refuse(file, format!("{place}.type"), format!("{line_type:?}"), allowed);
        }
    }
    Ok(())
}

fn lengths(scene: &Scene, file: &str) -> Result<(), Error> {
    sections(scene).try_for_each(|(place, section)| positive(file, &format!("{place}.length"), section.length, "m"))
}

fn elements(scene: &Scene, file: &str) -> Result<(), Error> {
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

fn attachments(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, body) in line.attachments.iter().enumerate() {
            let at = |key: &str| format!("lines[{index}].attachments[{number}].{key}");
            on_the_line(file, &at("s"), body.s, line)?;
            not_negative(file, &at("mass"), body.mass, "kg")?;
            not_negative(file, &at("volume"), body.volume, "m³")?;
            not_negative(file, &at("drag_area"), body.drag_area, "m²")?;
            not_negative(file, &at("added_mass"), body.added_mass, "kg")?;
        }
    }
    Ok(())
}

fn constraints(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, constraint) in line.constraints.iter().enumerate() {
            let at = |key: &str| format!("lines[{index}].constraints[{number}].{key}");
            on_the_line(file, &at("s"), constraint.s, line)?;
            if let Some(twin) = line.constraints[..number].iter().position(|other| other.s == constraint.s) {
                let allowed = format!("constraints[{twin}] is there already; say all that holds one point in one constraint");
                return refuse(file, at("s"), finding::number(constraint.s), allowed);
            }
            two_directions(file, &at("axes"), &constraint.axes)?;
            finite(file, &at("reference"), &constraint.reference.unwrap_or_default())?;
            for axis in 0..3 {
                not_negative(file, &at(&format!("stiffness[{axis}]")), constraint.stiffness[axis], "N/m")?;
                not_negative(file, &at(&format!("damping[{axis}]")), constraint.damping[axis], "N·s/m")?;
            }
            finite(file, &at("force"), &constraint.force)?;
            not_negative(file, &at("mass"), constraint.mass, "kg")?;
            not_negative(file, &at("added_mass"), constraint.added_mass, "kg")?;
            if let Some(ReferenceMotion { period, sine, cosine, ramp }) = &constraint.motion {
                sinusoid(file, &at("motion"), *period, [sine, cosine], *ramp)?;
            }
        }
    }
    Ok(())
}

fn on_the_line(file: &str, place: &str, s: f64, line: &Line) -> Result<(), Error> {
    let length = line.length();
    if (0.0..=length * (1.0 + 1.0e-9)).contains(&s) {
        return Ok(());
    }
    let allowed = format!("it must lie on the line, between 0 (fairlead) and {} m (anchor)", number(length));
    refuse(file, place, number(s), allowed)
}

/// Two directions span axes when neither vanishes and they are not parallel (within a ten-thousandth of a radian).
fn two_directions(file: &str, place: &str, axes: &[Triple; 2]) -> Result<(), Error> {
    let [first, second] = axes;
    finite(file, place, first)?;
    finite(file, place, second)?;
    let size = |a: &Triple| distance([0.0; 3], *a);
    let cross = [0, 1, 2].map(|c| first[(c + 1) % 3] * second[(c + 2) % 3] - first[(c + 2) % 3] * second[(c + 1) % 3]);
    if !(size(&cross) > 1.0e-4 * size(first) * size(second)) {
        let value = format!("[{}, {}]", triple(*first), triple(*second));
        return refuse(file, place, value, "give two directions of some length that are not parallel");
    }
    Ok(())
}

fn ends_above_bed(scene: &Scene, file: &str) -> Result<(), Error> {
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

fn motion_numbers(scene: &Scene, file: &str) -> Result<(), Error> {
    match &scene.motion {
        Motion::Fixed => Ok(()),
        Motion::Sinusoidal { period, sine, cosine, ramp } => sinusoid(file, "motion", *period, [sine, cosine], *ramp),
        Motion::File { path } if path.trim().is_empty() => {
            refuse(file, "motion.path", "\"\"", "name a CSV file with the columns t,x,y,z[,vx,vy,vz]")
        }
        Motion::File { .. } => Ok(()),
    }
}

/// A sinusoidal motion reaches, normal to the bed's plane, the root of the squares of its sine and cosine parts.
fn motion_above_bed(scene: &Scene, file: &str) -> Result<(), Error> {
    let Motion::Sinusoidal { sine, cosine, .. } = &scene.motion else { return Ok(()) };
    let environment = &scene.environment;
    let level = environment.bed_height(0.0, 0.0);
    let rise = |offset: &Triple| offset[2] - (environment.bed_height(offset[0], offset[1]) - level);
    let dip = rise(sine).hypot(rise(cosine));
    for (index, line) in scene.lines.iter().enumerate().filter(|(_, line)| line.fairlead_on.is_none()) {
        let [x, y, z] = line.fairlead;
        if environment.is_below_bed([x, y, z - dip]) {
            let clearance = number(z - environment.bed_height(x, y));
            let value = format!("an amplitude of {} m towards the seabed", number(dip));
            return refuse(
                file,
                "motion",
                value,
                format!("the fairlead of lines[{index}] is {clearance} m above the seabed and would dip below it"),
            );
        }
    }
    Ok(())
}

fn file_moves_one_line(scene: &Scene, file: &str) -> Result<(), Error> {
    let moved = scene.lines.iter().filter(|line| line.fairlead_on.is_none()).count();
    if matches!(scene.motion, Motion::File { .. }) && moved > 1 {
        let allowed = format!("its absolute positions belong to one fairlead, and the scene has {moved} lines");
        return refuse(file, "motion.kind", "\"file\"", allowed);
    }
    Ok(())
}

fn run(scene: &Scene, file: &str) -> Result<(), Error> {
    let run = &scene.run;
    not_negative(file, "run.duration", run.duration, "s")?;
    finite(file, "run.start", &[run.start])?;
    positive(file, "run.output_step", run.output_step, "s")?;
    let rows = run.duration / run.output_step;
    if !(rows <= MOST_ROWS) {
        let allowed = format!("{} s of run would make {rows:.1e} rows, and {MOST_ROWS:.0e} are the limit", number(run.duration));
        return refuse(file, "run.output_step", number(run.output_step), allowed);
    }
    Ok(())
}

fn solver(scene: &Scene, file: &str) -> Result<(), Error> {
    let solver = &scene.solver;
    if let Some(scale) = solver.tension_scale.filter(|scale| !(*scale >= 0.0 && scale.is_finite())) {
        return refuse(file, "solver.tension_scale", number(scale), "it must be zero or positive");
    }
    if !(1.0e-8..=0.1).contains(&solver.tolerance) {
        return refuse(file, "solver.tolerance", number(solver.tolerance), "it must lie between 1e-8 and 0.1");
    }
    positive(file, "solver.max_step", solver.max_step, "s")?;
    solver.fixed_step.map_or(Ok(()), |step| positive(file, "solver.fixed_step", step, "s; leave it out for step control"))
}

/// A line may be shorter than the distance of its ends: it stretches, but neither to twice its length nor beyond a breaking load. An
/// end that a constraint holds comes nearer by itself.
fn reach(scene: &Scene, file: &str) -> Result<(), Error> {
    let held = |line: &Line| {
        let free = scene.is_on_free(line.fairlead_on.as_ref()) || scene.is_on_free(line.anchor_on.as_ref());
        line.is_pinned(0.0) && line.is_pinned(line.length()) && !free
    };
    for (index, line) in scene.lines.iter().enumerate().filter(|(_, line)| held(line)) {
        let (length, distance) = (line.length(), distance(line.fairlead, line.anchor));
        let stretch = distance / length - 1.0;
        let limit = weakest(scene, line)
            .filter(|limit| matches!(limit, Limit::Breaks { strain, .. } if *strain <= 1.0))
            .unwrap_or(Limit::Doubles);
        let allowed = match &limit {
            Limit::Breaks { strain, .. } => *strain,
            Limit::Doubles => 1.0,
        };
        if !(stretch <= allowed * (1.0 + 1.0e-9)) {
            return Err(Error::Reach(Box::new(Reach {
                file: file.into(),
                place: format!("lines[{index}]"),
                line: line.name.clone(),
                length,
                fairlead: line.fairlead,
                anchor: line.anchor,
                distance,
                stretch,
                limit,
                lengthen: rounded_up(distance / (1.0 + allowed) - length),
            })));
        }
    }
    Ok(())
}

/// The line type that breaks first when a line is pulled, and the mean strain of the line at that tension.
/// Sections in a row carry one tension T and stretch by T Σ(length/EA); weight is left aside.
fn weakest(scene: &Scene, line: &Line) -> Option<Limit> {
    let used: Vec<(&String, &LineType, f64)> = line
        .sections
        .iter()
        .filter_map(|section| Some((&section.line_type, scene.line_types.get(&section.line_type)?, section.length)))
        .collect();
    let compliance: f64 = used.iter().map(|(_, line_type, length)| length / line_type.ea).sum();
    let loads = used.iter().filter_map(|(name, line_type, _)| Some((name, line_type.breaking_load?)));
    let (name, load) = loads.min_by(|one, other| one.1.total_cmp(&other.1))?;
    Some(Limit::Breaks { line_type: (*name).clone(), strain: load * compliance / line.length() })
}

/// Warning: a line type that no section names.
fn unused_line_types(scene: &Scene) -> Vec<String> {
    let used = |name: &String| sections(scene).any(|(_, section)| section.line_type == *name);
    let unused = scene.line_types.keys().filter(|name| !used(name));
    unused.map(|name| format!("line_types.{name} is used by no section")).collect()
}

/// Warning: waves higher than any can stand, 0.142 of the length in deep water (Michell 1893) or 0.78 of the depth.
fn breaking_waves(scene: &Scene) -> Vec<String> {
    let breaks = |place: &str, amplitude: f64, period: f64| {
        let length = scene.environment.gravity * period * period / std::f64::consts::TAU;
        let highest = (0.142 * length).min(0.78 * scene.environment.depth);
        (2.0 * amplitude > highest).then(|| {
            let (height, period, highest) = (number(2.0 * amplitude), number(period), number((100.0 * highest).round() / 100.0));
            format!(
                "{place}: a wave {height} m high of {period} s would break at {highest} m; linear theory does not hold for it"
            )
        })
    };
    match &scene.environment.waves {
        Some(Waves::Regular { amplitude, period, .. }) => breaks("environment.waves", *amplitude, *period).into_iter().collect(),
        Some(Waves::Components { components, .. }) => {
            let place = |index: usize| format!("environment.waves.components[{index}]");
            components.iter().enumerate().filter_map(|(index, c)| breaks(&place(index), c.amplitude, c.period)).collect()
        }
        Some(Waves::Jonswap { hs, tp, .. }) => breaks("environment.waves", 0.5 * hs, *tp).into_iter().collect(),
        None => Vec::new(),
    }
}

/// Warnings: bodies and forces that load a support instead of the line, and a motion that nothing follows.
fn without_effect(scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, line) in scene.lines.iter().enumerate() {
        for (number, body) in line.attachments.iter().enumerate() {
            if line.end_at(body.s).is_some() && line.is_pinned(body.s) {
                let place = format!("lines[{index}].attachments[{number}]");
                warnings.push(format!("{place} sits on a pinned end: it loads what holds the line, and nothing else changes"));
            }
        }
        if scene.motion != Motion::Fixed && !line.is_pinned(0.0) && line.fairlead_on.is_none() {
            let line = format!("lines[{index}]");
            warnings.push(format!(
                "motion does not move the fairlead of {line}, which a constraint holds; give that constraint a motion of its own"
            ));
        }
    }
    warnings
}

/// Warnings about a motion file named `path`: it begins elsewhere than the fairlead, or does not cover the run.
pub fn motion_table(scene: &Scene, table: &Table, path: &str) -> Vec<String> {
    let mut warnings = Vec::new();
    let (Some(line), Some(first), Some(start), Some(end)) =
        (scene.lines.first(), table.positions.first(), table.times.first(), table.times.last())
    else {
        return warnings;
    };
    let away = distance(line.fairlead, *first);
    if away > FAR {
        warnings.push(format!(
            "{path} begins at {}, {away:.1} m away from the fairlead of lines[0], {}: are they positions with z up, in metres?",
            triple(*first),
            triple(line.fairlead)
        ));
    }
    if *start > scene.run.start || *end < scene.run.end() {
        let [start, end, from, to] = [*start, *end, scene.run.start, scene.run.end()].map(number);
        warnings
            .push(format!("{path} covers t = {start} s to {end} s of a run from {from} to {to} s; the fairlead rests outside"));
    }
    warnings
}

/// Rounded up to two digits, and to whole metres from 10 m on.
fn rounded_up(length: f64) -> f64 {
    let step = 10f64.powf((length.log10().floor() - 1.0).clamp(-6.0, 0.0));
    // Dividing by the whole number 1/step keeps 0.1 from becoming 0.1000…01.
    let per_step = (1.0 / step).round();
    (length * per_step).ceil() / per_step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_length_is_rounded_up_never_down() {
        assert_eq!(rounded_up(46.2), 47.0);
        assert_eq!(rounded_up(1234.5), 1235.0);
        assert_eq!(rounded_up(0.1234), 0.13);
        assert_eq!(rounded_up(3.0), 3.0);
    }
}
