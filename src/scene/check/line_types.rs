//! Rules on line types, and a warning of those that nobody uses.

use crate::error::Error;
use crate::scene::check::finding::{finite, in_type, not_negative, number, positive, refuse, sections};
use crate::scene::types::{Fatigue, NormalTangential, Scene};

pub fn line_types_exist(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.line_types.is_empty() {
        return refuse(file, "line_types", "{ }", "a scene needs at least one line type with ea, mass and diameter");
    }
    Ok(())
}

pub fn line_type_names(scene: &Scene, file: &str) -> Result<(), Error> {
    match scene.line_types.keys().find(|name| name.trim().is_empty() || name.contains(char::is_control)) {
        Some(name) => refuse(file, "line_types", format!("{name:?}"), "a line type needs a name of printable characters"),
        None => Ok(()),
    }
}

pub fn line_type_numbers(scene: &Scene, file: &str) -> Result<(), Error> {
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

/// Exponents and constants of T–N curves of ropes and chains in use, generously; a constant that goes with stress in MPa is far above.
const EXPONENTS: std::ops::RangeInclusive<f64> = 1.0..=20.0;
const CONSTANTS: std::ops::RangeInclusive<f64> = 1.0e-3..=1.0e7;

/// A T–N curve has an exponent and a constant of its kind, and a breaking load that ranges are measured by.
pub fn fatigue(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        let Some(Fatigue { m, k }) = line_type.fatigue else { continue };
        if !EXPONENTS.contains(&m) {
            let allowed = "it must lie between 1 and 20; 3 is usual for chain, 4 to 5 for wire rope, 9 to 14 for polyester";
            return refuse(file, in_type(name, "fatigue.m"), number(m), allowed);
        }
        if !CONSTANTS.contains(&k) {
            let allowed = "it must lie between 0.001 and 1e7: N = k·R^-m, R being range over breaking load; of a stress curve \
                           N = a·S^-m, k = a·(area / breaking load)^m";
            return refuse(file, in_type(name, "fatigue.k"), number(k), allowed);
        }
        if line_type.breaking_load.is_none() {
            let allowed = "`fatigue` measures ranges by the breaking load: give it [N], or leave `fatigue` out";
            return refuse(file, in_type(name, "breaking_load"), "nothing", allowed);
        }
    }
    Ok(())
}

/// A table begins at [0, 0] and rises, in strain and in tension.
pub fn tension_tables(scene: &Scene, file: &str) -> Result<(), Error> {
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

pub fn inner_fluids(scene: &Scene, file: &str) -> Result<(), Error> {
    for (name, line_type) in &scene.line_types {
        if let Some(fluid) = &line_type.inner_fluid {
            not_negative(file, &in_type(name, "inner_fluid.density"), fluid.density, "kg/m³")?;
            not_negative(file, &in_type(name, "inner_fluid.area"), fluid.area, "m²")?;
            finite(file, &in_type(name, "inner_fluid.pressure"), &[fluid.pressure])?;
        }
    }
    Ok(())
}

pub fn weight_given_once(scene: &Scene, file: &str) -> Result<(), Error> {
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
pub fn weight_leaves_buoyancy(scene: &Scene, file: &str) -> Result<(), Error> {
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

/// Warning: a line type that no section names.
pub fn unused_line_types(scene: &Scene) -> Vec<String> {
    let used = |name: &String| sections(scene).any(|(_, section)| section.line_type == *name);
    let unused = scene.line_types.keys().filter(|name| !used(name));
    unused.map(|name| format!("line_types.{name} is used by no section")).collect()
}
