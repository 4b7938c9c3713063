//! Bodies and points, and what lines hang on.

use crate::error::{Error, among};
use crate::scene::bodies::{Body, BodyMotion, Clamp, Matrix, Mount, Point, PointMotion, Stiffness};
use crate::scene::check::finding::{distance, finite, not_negative, number, positive, refuse, sinusoid, triple};
use crate::scene::types::{Scene, Scheme, Triple};
use nalgebra::SymmetricEigen;

/// Largest pitch of a pose [deg]: beyond it roll and yaw lose their meaning.
const STEEPEST: f64 = 89.0;
/// Gravity below which nothing falls that is not held [m/s²].
const WEIGHTLESS: f64 = 1.0e-6;
/// Most lines, bodies and points together that a scene may have of each.
const MOST: usize = 1000;

/// Every name is said once, and can be written into a table.
pub(super) fn names(scene: &Scene, file: &str) -> Result<(), Error> {
    let lines = scene.lines.iter().enumerate().map(|(index, line)| (format!("lines[{index}].name"), &line.name));
    let bodies = scene.bodies.iter().enumerate().map(|(index, body)| (format!("bodies[{index}].name"), &body.name));
    let points = scene.points.iter().enumerate().map(|(index, point)| (format!("points[{index}].name"), &point.name));
    let all: Vec<(String, &String)> = lines.chain(bodies).chain(points).collect();
    for (number, (place, name)) in all.iter().enumerate().skip(scene.lines.len()) {
        if name.trim().is_empty() || name.contains(char::is_control) {
            return refuse(file, place.as_str(), format!("{name:?}"), "it needs a name of printable characters");
        }
        if let Some((twin, _)) = all[..number].iter().find(|(_, other)| other == name) {
            return refuse(
                file,
                place.as_str(),
                format!("{name:?}"),
                format!("{twin} is called so already; lines, bodies and points share their names"),
            );
        }
    }
    if scene.bodies.len().max(scene.points.len()) > MOST {
        return refuse(
            file,
            "bodies",
            scene.bodies.len().to_string(),
            format!("a scene has at most {MOST} bodies and {MOST} points"),
        );
    }
    Ok(())
}

/// Poses, masses and motions of bodies.
pub(super) fn bodies(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, body) in scene.bodies.iter().enumerate() {
        let at = |key: &str| format!("bodies[{index}].{key}");
        finite(file, &at("position"), &body.position)?;
        finite(file, &at("attitude_deg"), &body.attitude_deg)?;
        if !(body.attitude_deg[1].abs() <= STEEPEST) {
            return refuse(
                file,
                at("attitude_deg[1]"),
                number(body.attitude_deg[1]),
                "a pitch lies within ±89 deg, where roll and yaw are defined",
            );
        }
        not_negative(file, &at("mass"), body.mass, "kg")?;
        not_negative(file, &at("volume"), body.volume, "m³")?;
        for (key, triple) in [
            ("centre_of_mass", &body.centre_of_mass),
            ("centre_of_buoyancy", &body.centre_of_buoyancy),
            ("force", &body.force),
            ("moment", &body.moment),
        ] {
            finite(file, &at(key), triple)?;
        }
        for (key, matrix) in [("added_mass", &body.added_mass), ("damping", &body.damping), ("stiffness", &body.stiffness)] {
            six_by_six(file, &at(key), matrix.as_ref(), key != "stiffness")?;
        }
        for (axis, value) in body.quadratic_damping.iter().flatten().enumerate() {
            not_negative(file, &at(&format!("quadratic_damping[{axis}]")), *value, "")?;
        }
        if let Some(path) = &body.load
            && path.trim().is_empty()
        {
            return refuse(file, at("load"), "\"\"", "it names a CSV file of loads, t,fx,fy,fz,mx,my,mz");
        }
        cylinders(body, file, &at)?;
        motion_of_body(body, file, &at)?;
        if body.is_free() {
            mass(body, file, &at)?;
        }
    }
    Ok(())
}

fn six_by_six(file: &str, place: &str, matrix: Option<&Matrix>, dissipates: bool) -> Result<(), Error> {
    let Some(matrix) = matrix else { return Ok(()) };
    matrix.iter().try_for_each(|row| finite(file, place, row))?;
    let symmetric = nalgebra::Matrix6::from_fn(|row, column| 0.5 * (matrix[row][column] + matrix[column][row]));
    let eigenvalues = SymmetricEigen::new(symmetric).eigenvalues;
    if dissipates && !(eigenvalues.min() >= -1.0e-9 * eigenvalues.amax()) {
        return refuse(
            file,
            place,
            "a matrix with a negative direction",
            "moving any way must cost energy: it must be positive semidefinite",
        );
    }
    Ok(())
}

fn cylinders(body: &Body, file: &str, at: &impl Fn(&str) -> String) -> Result<(), Error> {
    for (number, cylinder) in body.cylinders.iter().enumerate() {
        let at = |key: &str| at(&format!("cylinders[{number}].{key}"));
        finite(file, &at("from"), &cylinder.from)?;
        finite(file, &at("to"), &cylinder.to)?;
        positive(file, &at("diameter"), cylinder.diameter, "m")?;
        not_negative(file, &at("mass"), cylinder.mass, "kg")?;
        let length = distance(cylinder.from, cylinder.to);
        if !(length > 1.0e-6 * cylinder.diameter) {
            return refuse(file, at("to"), triple(cylinder.to), "a cylinder has some length: its ends must differ");
        }
        for (key, of) in [("drag", &cylinder.drag), ("added_mass", &cylinder.added_mass)] {
            for (name, value) in [("normal", of.normal), ("tangential", of.tangential), ("end", of.end)] {
                not_negative(file, &at(&format!("{key}.{name}")), value, "")?;
            }
        }
    }
    Ok(())
}

fn motion_of_body(body: &Body, file: &str, at: &impl Fn(&str) -> String) -> Result<(), Error> {
    let BodyMotion::Sinusoidal { period, sine, cosine, ramp } = &body.motion else { return Ok(()) };
    positive(file, &at("motion.period"), *period, "s")?;
    finite(file, &at("motion.sine"), sine)?;
    finite(file, &at("motion.cosine"), cosine)?;
    not_negative(file, &at("motion.ramp"), ramp.unwrap_or(0.0), "s; 0 means none")?;
    let steepest = body.attitude_deg[1].abs() + sine[4].hypot(cosine[4]);
    if !(steepest <= STEEPEST) {
        let allowed = "a pitch lies within ±89 deg, where roll and yaw are defined";
        return refuse(file, at("motion"), format!("a pitch of up to {} deg", number(steepest)), allowed);
    }
    Ok(())
}

/// A free body has a mass, and its inertia is that of some distribution of mass: no principal moment is larger than the sum of the others.
fn mass(body: &Body, file: &str, at: &impl Fn(&str) -> String) -> Result<(), Error> {
    let of_cylinders: f64 = body.cylinders.iter().map(|cylinder| cylinder.mass).sum();
    if !(body.mass + of_cylinders > 0.0) {
        return refuse(
            file,
            at("mass"),
            number(body.mass),
            "a free body needs a mass greater than 0 kg, of its own or of its cylinders",
        );
    }
    let Some(inertia) = body.inertia.as_ref().map(|inertia| inertia.matrix()) else {
        if of_cylinders > 0.0 {
            return Ok(());
        }
        return refuse(
            file,
            at("inertia"),
            "nothing",
            "a free body needs an inertia [Ixx, Iyy, Izz] about its centre of mass, or cylinders with mass",
        );
    };
    finite(file, &at("inertia"), inertia.as_slice())?;
    let (skew, size) = ((inertia - inertia.transpose()).amax(), inertia.amax());
    if skew > 1.0e-9 * size {
        return refuse(file, at("inertia"), "a matrix that is not symmetric", "an inertia is symmetric");
    }
    let mut moments: [f64; 3] = SymmetricEigen::new(inertia).eigenvalues.into();
    moments.sort_by(f64::total_cmp);
    if !(moments[0] >= 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + 1.0e-9)) {
        let value = format!("principal moments {}, {}, {}", number(moments[0]), number(moments[1]), number(moments[2]));
        return refuse(
            file,
            at("inertia"),
            value,
            "no distribution of mass has it: none may be negative or larger than the sum of the other two",
        );
    }
    if !(moments[0] > 0.0 || of_cylinders > 0.0) {
        return refuse(
            file,
            at("inertia"),
            number(moments[0]),
            "a free body needs a principal moment greater than 0 kg·m² about every axis",
        );
    }
    Ok(())
}

/// Masses and motions of points.
pub(super) fn points(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, point) in scene.points.iter().enumerate() {
        let at = |key: &str| format!("points[{index}].{key}");
        let Point { position, mass, volume, drag_area, added_mass, force, motion, .. } = point;
        finite(file, &at("position"), position)?;
        finite(file, &at("force"), force)?;
        for (key, value, unit) in
            [("mass", mass, "kg"), ("volume", volume, "m³"), ("drag_area", drag_area, "m²"), ("added_mass", added_mass, "kg")]
        {
            not_negative(file, &at(key), *value, unit)?;
        }
        if let PointMotion::Sinusoidal { period, sine, cosine, ramp } = motion {
            sinusoid(file, &at("motion"), *period, [sine, cosine], *ramp)?;
        }
        if scene.environment.is_below_bed(*position) {
            let bed = number(scene.environment.bed_height(position[0], position[1]));
            return refuse(
                file,
                at("position"),
                triple(*position),
                format!("it lies below the seabed, which is at z = {bed} m there"),
            );
        }
        let hangs = |on: &Option<Mount>| matches!(on, Some(Mount::Point { point: name }) if *name == point.name);
        if point.is_free() && !scene.lines.iter().any(|line| hangs(&line.fairlead_on) || hangs(&line.anchor_on)) {
            return refuse(
                file,
                at("name"),
                format!("{:?}", point.name),
                "a free point without a line would fall; hang a line on it, or fix it",
            );
        }
    }
    Ok(())
}

/// Ends hang on what there is, and a line not with both ends on one place.
pub(super) fn ends(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        for (end, on, s) in [("fairlead", &line.fairlead_on, 0.0), ("anchor", &line.anchor_on, line.length())] {
            let Some(on) = on else { continue };
            let place = format!("lines[{index}].{end}");
            let (key, known): (&str, Vec<String>) = match on {
                Mount::Body { at, .. } => {
                    finite(file, &format!("{place}.at"), at)?;
                    ("body", scene.bodies.iter().map(|body| body.name.clone()).collect())
                }
                Mount::Point { .. } => ("point", scene.points.iter().map(|point| point.name.clone()).collect()),
            };
            if let Some(clamp) = on.clamp() {
                clamped(scene, index, clamp, &place, file)?;
            }
            let name = on.name().to_owned();
            if !known.contains(&name) {
                let allowed = format!("there is no {key} of that name{}", among(&name, &known));
                return refuse(file, format!("{place}.{key}"), format!("{name:?}"), allowed);
            }
            if !line.is_pinned(s) {
                let allowed = format!("the {end} hangs on {name:?}; a constraint may not hold it as well");
                return refuse(file, format!("lines[{index}].constraints"), "a constraint at that end", allowed);
            }
        }
        let one_place = match (&line.fairlead_on, &line.anchor_on) {
            (Some(Mount::Body { body, at, .. }), Some(Mount::Body { body: other, at: there, .. })) => {
                body == other && at == there
            }
            (Some(one), Some(other)) => one == other,
            _ => false,
        };
        if one_place {
            let name = line.fairlead_on.as_ref().map_or("", Mount::name);
            return refuse(
                file,
                format!("lines[{index}].anchor"),
                format!("{name:?} again"),
                "both ends are on one place; put them on two",
            );
        }
        if scene.solver.scheme == Scheme::Cable1994 && (line.fairlead_on.is_some() || line.anchor_on.is_some()) {
            return refuse(
                file,
                "solver.scheme",
                "\"cable-1994\"",
                "it knows lines between coordinates alone; use adams-moulton",
            );
        }
    }
    Ok(())
}

/// An end can be clamped to a body, and only if the line bends.
fn clamped(scene: &Scene, index: usize, clamp: &Clamp, place: &str, file: &str) -> Result<(), Error> {
    finite(file, &format!("{place}.direction"), &clamp.direction)?;
    if !(clamp.direction.iter().map(|x| x * x).sum::<f64>() > 0.0) {
        return refuse(file, format!("{place}.direction"), triple(clamp.direction), "it is a direction: not all may be 0");
    }
    if let Stiffness::Of(stiffness) = clamp.stiffness {
        positive(file, &format!("{place}.stiffness"), stiffness, "N·m/rad, or \"clamped\"")?;
    }
    let line = &scene.lines[index];
    let section = if place.ends_with("anchor") { line.sections.last() } else { line.sections.first() };
    let bends = section.and_then(|section| scene.line_types.get(&section.line_type)).is_some_and(|of| of.ei > 0.0);
    if !bends {
        let kind = section.map_or("", |section| section.line_type.as_str());
        let allowed = format!("a line without bending stiffness has no moment to clamp: give line_types.{kind}.ei");
        return refuse(file, format!("{place}.direction"), triple(clamp.direction), allowed);
    }
    Ok(())
}

/// Lines that meet at free bodies and points need something that holds them: an end that is fixed or driven, or a body with a stiffness of its own.
pub(super) fn held(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.environment.gravity < WEIGHTLESS {
        return Ok(());
    }
    let name = |on: &Option<Mount>| on.as_ref().filter(|on| scene.is_on_free(Some(on))).map(|on| on.name().to_owned());
    let ends: Vec<[Option<String>; 2]> =
        scene.lines.iter().map(|line| [name(&line.fairlead_on), name(&line.anchor_on)]).collect();
    let mut safe: Vec<String> =
        scene.bodies.iter().filter(|body| body.stiffness.is_some()).map(|body| body.name.clone()).collect();
    for pair in &ends {
        if let [Some(free), None] | [None, Some(free)] = pair {
            safe.push(free.clone());
        }
    }
    // Whatever a line joins with what is held is held.
    let mut before = usize::MAX;
    while before != safe.len() {
        before = safe.len();
        for pair in &ends {
            if let [Some(one), Some(other)] = pair {
                match (safe.contains(one), safe.contains(other)) {
                    (true, false) => safe.push(other.clone()),
                    (false, true) => safe.push(one.clone()),
                    _ => {}
                }
            }
        }
    }
    let loose = ends.iter().position(|pair| matches!(pair, [Some(one), Some(_)] if !safe.contains(one)));
    match loose {
        Some(index) => {
            let value = format!(
                "a line between {:?} and {:?}",
                ends[index][0].as_deref().unwrap_or(""),
                ends[index][1].as_deref().unwrap_or("")
            );
            let allowed = "nothing holds what these are joined with: give one of its lines an end that is fixed or driven, or a body a stiffness";
            refuse(file, format!("lines[{index}]"), value, allowed)
        }
        None => Ok(()),
    }
}

/// What a body's sinusoidal motion does to places of it, against the bed: where their sums of amplitudes reach.
pub(super) fn places_above_bed(scene: &Scene, file: &str) -> Result<(), Error> {
    for (index, line) in scene.lines.iter().enumerate() {
        let ends: [(&str, Triple, bool); 2] =
            [("fairlead", line.fairlead, line.fairlead_on.is_some()), ("anchor", line.anchor, line.anchor_on.is_some())];
        for (end, at, mounted) in ends {
            if mounted && scene.environment.is_below_bed(at) {
                let bed = number(scene.environment.bed_height(at[0], at[1]));
                return refuse(
                    file,
                    format!("lines[{index}].{end}"),
                    triple(at),
                    format!("it lies below the seabed, which is at z = {bed} m there"),
                );
            }
        }
    }
    Ok(())
}
