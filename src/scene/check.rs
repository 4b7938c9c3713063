//! Plausibility of a scene: one rule, one function, one finding.
//!
//! What passes can be computed: every number is finite and of the right sign, every name means something, every line can reach.
//! Numbers beyond 1e15 in size, and positive ones below 1e-12, are taken for slips: products of them would leave the range of f64.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "conditions are written so that NaN fails them")]

mod bodies;
mod cable_1994;
mod environment;
mod finding;
mod line_types;
mod lines;
mod motion;
mod points;
mod reach;
mod settings;
mod waves;

use crate::error::Error;
use crate::scene::types::Scene;
pub use motion::motion_table;
pub use waves::beyond_records;

/// A rule looks at the scene and finds one thing wrong, or nothing; the text is the file's name for the message.
type Rule = fn(&Scene, &str) -> Result<(), Error>;

/// All rules, in the order in which a reader would mend: numbers, names, geometry, then what is not there yet.
const RULES: [Rule; 38] = [
    environment::gravity,
    environment::water_density,
    environment::depth,
    environment::seabed,
    environment::slope,
    environment::current,
    environment::current_over_time,
    waves::waves,
    line_types::line_types_exist,
    line_types::line_type_names,
    line_types::line_type_numbers,
    line_types::fatigue,
    line_types::tension_tables,
    line_types::inner_fluids,
    line_types::weight_given_once,
    line_types::weight_leaves_buoyancy,
    lines::lines_exist,
    lines::line_names,
    lines::sections_exist,
    lines::section_types,
    lines::lengths,
    lines::elements,
    points::attachments,
    points::constraints,
    bodies::names,
    bodies::bodies,
    bodies::points,
    bodies::ends,
    bodies::held,
    bodies::places_above_bed,
    lines::ends_above_bed,
    motion::motion_numbers,
    motion::motion_above_bed,
    motion::file_moves_one_line,
    settings::run,
    settings::solver,
    reach::reach,
    cable_1994::cable_1994,
];

/// Checks a scene; `file` names it in the message. Returns warnings, or the first thing that is wrong.
pub fn check(scene: &Scene, file: &str) -> Result<Vec<String>, Error> {
    for rule in RULES {
        rule(scene, file)?;
    }
    Ok([line_types::unused_line_types(scene), waves::breaking_waves(scene), points::without_effect(scene)].concat())
}
