//! Rules on gravity, water, bed and current.

use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
use crate::scene::current_file;
use crate::scene::types::Scene;

pub fn gravity(scene: &Scene, file: &str) -> Result<(), Error> {
    positive(file, "environment.gravity", scene.environment.gravity, "m/s²")
}

pub fn water_density(scene: &Scene, file: &str) -> Result<(), Error> {
    not_negative(file, "environment.water_density", scene.environment.water_density, "kg/m³")
}

pub fn depth(scene: &Scene, file: &str) -> Result<(), Error> {
    positive(file, "environment.depth", scene.environment.depth, "m: the seabed lies at z = -depth")
}

pub fn seabed(scene: &Scene, file: &str) -> Result<(), Error> {
    let seabed = &scene.environment.seabed;
    if let Some(stiffness) = seabed.stiffness {
        positive(file, "environment.seabed.stiffness", stiffness, "Pa; leave it out for the line's weight / diameter")?;
    }
    not_negative(file, "environment.seabed.damping", seabed.damping, "Pa·s")?;
    not_negative(file, "environment.seabed.friction", seabed.friction, "")
}

pub fn slope(scene: &Scene, file: &str) -> Result<(), Error> {
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
pub fn current(scene: &Scene, file: &str) -> Result<(), Error> {
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

/// A current over time is given once, by rows that make profiles, and not beside a steady one.
pub fn current_over_time(scene: &Scene, file: &str) -> Result<(), Error> {
    let place = "environment.current_over_time";
    let Some(current) = &scene.environment.current_over_time else { return Ok(()) };
    if !scene.environment.current.is_empty() {
        let allowed = "`current` is given too; put the steady current into the rows, or leave one of them out";
        return refuse(file, place, "a current beside a current", allowed);
    }
    let rows = match (&current.path, &current.rows) {
        (Some(_), None) => return Ok(()),
        (None, Some(rows)) => rows,
        (None, None) => {
            return refuse(file, place, "a current without rows", "it must have `path`, a CSV file t,z,u,v,w, or `rows`");
        }
        (Some(_), Some(_)) => return refuse(file, place, "a current with two sources", "give `path` or `rows`, not both"),
    };
    if rows.is_empty() {
        return refuse(file, format!("{place}.rows"), "an empty list", "it needs at least one row [t, z, u, v, w]");
    }
    current_file::check(rows).or_else(|(row, found, allowed)| refuse(file, format!("{place}.rows[{row}]"), found, allowed))
}
