//! What the scheme `cable-1994` cannot do, and refuses rather than leaves out.

use crate::error::Error;
use crate::scene::check::finding::{in_type, number, refuse, sections};
use crate::scene::types::{LineType, Motion, Scene, Scheme, Stretch, Surface};

/// What other schemes do instead.
const ELSEWHERE: &str = "the scheme cable-1994 cannot do it; use adams-moulton";

/// Everything in a scene must be in the report, where its scheme is asked for.
pub fn cable_1994(scene: &Scene, file: &str) -> Result<(), Error> {
    if scene.solver.scheme != Scheme::Cable1994 {
        return Ok(());
    }
    if scene.solver.stretch == Some(Stretch::Exact) {
        let allowed = "the scheme cable-1994 is built on the report's law; leave solver.stretch out, or write \"report\"";
        return refuse(file, "solver.stretch", "\"exact\"", allowed);
    }
    sea_and_bed(scene, file)?;
    surface(scene, file)?;
    used_types(scene).try_for_each(|(name, line_type)| along_and_inside(name, line_type, file))?;
    for (index, line) in scene.lines.iter().enumerate() {
        if !line.attachments.is_empty() {
            return refuse(file, format!("lines[{index}].attachments"), "a clump weight or buoy", ELSEWHERE);
        }
        if !line.constraints.is_empty() {
            return refuse(file, format!("lines[{index}].constraints"), "a constraint", ELSEWHERE);
        }
    }
    step(scene, file)
}

fn sea_and_bed(scene: &Scene, file: &str) -> Result<(), Error> {
    let (seabed, waves) = (&scene.environment.seabed, &scene.environment.waves);
    if waves.is_some() {
        return refuse(file, "environment.waves", "a sea with waves", ELSEWHERE);
    }
    if scene.environment.current_over_time.is_some() {
        return refuse(file, "environment.current_over_time", "a current that changes", ELSEWHERE);
    }
    for (key, value) in [("friction", seabed.friction), ("damping", seabed.damping)] {
        if value != 0.0 {
            return refuse(file, format!("environment.seabed.{key}"), number(value), ELSEWHERE);
        }
    }
    if seabed.slope_deg != [0.0; 2] {
        let [x, y] = seabed.slope_deg.map(number);
        return refuse(file, "environment.seabed.slope_deg", format!("[{x}, {y}]"), ELSEWHERE);
    }
    Ok(())
}

/// The report has water above z = 0, too. Where a line may come there, the user must say that this is meant.
fn surface(scene: &Scene, file: &str) -> Result<(), Error> {
    let environment = &scene.environment;
    let rise = match &scene.motion {
        Motion::Sinusoidal { sine, cosine, .. } => sine[2].hypot(cosine[2]),
        _ => 0.0,
    };
    let floats = |line_type: &LineType| line_type.weight_in_water(environment.water_density, environment.gravity) < 0.0;
    let leaves = scene.lines.iter().any(|line| line.fairlead[2] + rise > 0.0 || line.anchor[2] > 0.0);
    if environment.surface == Surface::None || !(leaves || used_types(scene).any(|(_, line_type)| floats(line_type))) {
        return Ok(());
    }
    let allowed = "the line may rise above z = 0, where the scheme cable-1994 has water, too; \
                   accept that with environment.surface = \"none\", or use adams-moulton";
    refuse(file, "environment.surface", "\"pierced\"", allowed)
}

fn along_and_inside(name: &str, line_type: &LineType, file: &str) -> Result<(), Error> {
    for (key, value) in [("drag", line_type.drag.tangential), ("added_mass", line_type.added_mass.tangential)] {
        if value != 0.0 {
            return refuse(file, in_type(name, &format!("{key}.tangential")), number(value), ELSEWHERE);
        }
    }
    if line_type.tension_strain.is_some() {
        return refuse(file, in_type(name, "tension_strain"), "a table", ELSEWHERE);
    }
    if line_type.inner_fluid.is_some() {
        return refuse(file, in_type(name, "inner_fluid"), "a fluid", ELSEWHERE);
    }
    Ok(())
}

/// The factor 1 - C/h of the report must exceed one half.
fn step(scene: &Scene, file: &str) -> Result<(), Error> {
    let step = scene.solver.uncontrolled_step().unwrap_or(f64::INFINITY).min(scene.run.output_step);
    for (name, line_type) in used_types(scene) {
        if !(step > 2.0 * line_type.damping) {
            let allowed = format!(
                "the scheme cable-1994 takes steps of {} s here and is unstable where `damping` is half of that or more",
                number(step)
            );
            return refuse(file, in_type(name, "damping"), number(line_type.damping), allowed);
        }
    }
    Ok(())
}

/// The line types that a section names.
fn used_types(scene: &Scene) -> impl Iterator<Item = (&String, &LineType)> {
    let used = |name: &String| sections(scene).any(|(_, section)| section.line_type == *name);
    scene.line_types.iter().filter(move |(name, _)| used(name))
}
