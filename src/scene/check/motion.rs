//! Rules on the motion of fairleads, and warnings about a file of it.

use crate::error::Error;
use crate::scene::check::finding::{distance, number, refuse, sinusoid, triple};
use crate::scene::motion_file::Table;
use crate::scene::types::{Motion, Scene, Triple};

/// A motion file that begins farther than this from the scene's fairlead [m] may have other axes.
const FAR: f64 = 5.0;

pub fn motion_numbers(scene: &Scene, file: &str) -> Result<(), Error> {
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
pub fn motion_above_bed(scene: &Scene, file: &str) -> Result<(), Error> {
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

pub fn file_moves_one_line(scene: &Scene, file: &str) -> Result<(), Error> {
    let moved = scene.lines.iter().filter(|line| line.fairlead_on.is_none()).count();
    if matches!(scene.motion, Motion::File { .. }) && moved > 1 {
        let allowed = format!("its absolute positions belong to one fairlead, and the scene has {moved} lines");
        return refuse(file, "motion.kind", "\"file\"", allowed);
    }
    Ok(())
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
