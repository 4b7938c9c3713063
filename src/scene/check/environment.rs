//! Rules on gravity, water, bed and current.

use crate::error::Error;
use crate::scene::check::finding::{finite, not_negative, number, positive, refuse};
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
