//! Moorings of scenes in equilibrium.

use moorline::error::Error;
use moorline::scene::read::Loaded;
use moorline::solve::mooring::Mooring;
use moorline::solve::simulation::Outputs;

/// Puts the parts of a mooring in equilibrium at t = 0: outputs of its lines, in the order of the scene.
pub fn settle(mooring: &mut Mooring, lines: usize) -> Result<Vec<Outputs>, Error> {
    let mut outputs = vec![None; lines];
    for part in &mut mooring.parts {
        part.settle(0.0)?;
        for (local, index) in part.lines().to_vec().into_iter().enumerate() {
            outputs[index] = Some(part.outputs(local));
        }
    }
    Ok(outputs.into_iter().flatten().collect())
}

/// The mooring of a scene in equilibrium at t = 0, with the outputs of its lines.
pub fn settled(loaded: &Loaded) -> (Mooring, Vec<Outputs>) {
    let mut mooring = Mooring::new(loaded).unwrap_or_else(|error| panic!("{error}"));
    let outputs = settle(&mut mooring, loaded.scene.lines.len()).unwrap_or_else(|error| panic!("{error}"));
    (mooring, outputs)
}
