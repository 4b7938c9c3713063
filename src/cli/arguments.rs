//! What can be typed: the commands and their arguments.

use crate::error::Error;
use crate::scene::read::{self, Loaded};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

const AFTER_HELP: &str = "\
Without a command, moorline runs the built-in case of Lindahl & Sjöberg (1983) and writes the results into `out`.

Exit codes: 0 done; 2 bad input; 3 no convergence; 130 stopped with Ctrl-C.";

/// Mooring lines: static equilibrium and dynamics, with a report to look at.
#[derive(Debug, Parser)]
#[command(name = "moorline", version, after_help = AFTER_HELP, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    /// How to run the built-in case, where there is no command.
    #[command(flatten)]
    pub run: RunOptions,
    /// The command, if there is one.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// A command and its arguments.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Statics, then dynamics; writes timeseries.csv, nodes.csv, summary.json and report.html
    Run(RunArguments),
    /// Static equilibrium: end forces, tensions, touchdown, node table
    Statics(StaticsArguments),
    /// Find the value of the scene that gives a wanted static result, such as a pretension, and write the scene
    Fit(FitArguments),
    /// Validate a scene and say which physics is on, what is skipped and why, mesh and cost
    Check(SceneArguments),
    /// Print the JSON Schema of the scene
    Schema,
    /// Write an FMU: a co-simulation unit for FMI 2.0 masters
    Pack(PackArguments),
    /// JSON scene to CABLE or MoorDyn file and back; says what the other format cannot hold
    Convert(ConvertArguments),
}

/// `moorline run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// Scene file, CABLE file or MoorDyn file; without one, the built-in case of Lindahl & Sjöberg
    pub scene: Option<PathBuf>,
    /// Where to and how.
    #[command(flatten)]
    pub options: RunOptions,
}

impl RunArguments {
    /// Reads and checks the scene, moved as `--motion` says.
    pub fn load(&self) -> Result<Loaded, Error> {
        let sets = &self.options.sets;
        match (&self.scene, &self.options.motion) {
            (Some(scene), Some(motion)) => read::load_moved(scene, motion, sets),
            (Some(scene), None) => read::load(scene, sets),
            (None, Some(motion)) => Err(Error::Value {
                file: String::from("built-in scene"),
                place: String::from("--motion"),
                value: motion.display().to_string(),
                allowed: String::from("name the MoorDyn file that it moves, `moorline run mooring.txt --motion FILE`"),
            }),
            (None, None) => read::built_in(sets),
        }
    }
}

/// How to run, whatever the scene.
#[derive(Debug, Args)]
pub struct RunOptions {
    /// Directory of the results; made where it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub output: PathBuf,
    /// Value to put into the scene before it is checked, such as run.duration=60; repeatable
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub sets: Vec<String>,
    /// Seeds of the random sea, such as 1:20 or 3,7,9: a run of each on all cores, into DIR/seed-N, and one summary
    #[arg(long, value_name = "SEEDS", allow_hyphen_values = true)]
    pub seeds: Option<String>,
    /// Motion of what is coupled in a MoorDyn file: the driver of OpenFAST for it, or the table that a driver names
    #[arg(long, value_name = "FILE")]
    pub motion: Option<PathBuf>,
    /// Write the snapshots for ParaView too: DIR/vtk/lines.pvd, and bodies.pvd where there are bodies
    #[arg(long)]
    pub vtk: bool,
    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// `moorline statics`.
#[derive(Debug, Args)]
pub struct StaticsArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Print JSON instead of tables
    #[arg(long)]
    pub json: bool,
    /// Hold a body aside, such as vessel.x=-20:20:1 (x, y, z in m; roll, pitch, yaw in deg), and write force, moment and tensions over the offset
    #[arg(long, value_name = "BODY.WAY=FROM:TO:STEP", conflicts_with = "json")]
    pub offsets: Option<String>,
    /// Directory of offsets.csv and offsets.html; made where it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub output: PathBuf,
}

/// `moorline fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Scene file
    pub scene: PathBuf,
    /// Number of the scene to change, such as lines[0].sections[0].length
    #[arg(long, value_name = "PLACE")]
    pub change: String,
    /// Static result that is wanted, such as bow.tension=1.2e6
    #[arg(long, value_name = "NAME.RESULT=VALUE", allow_hyphen_values = true)]
    pub until: String,
    /// Where to look; without it, from a quarter to four times the present value
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    pub range: Option<String>,
    /// The scene to write; without it, SCENE.fitted.json
    #[arg(short, long, value_name = "FILE.json")]
    pub output: Option<PathBuf>,
    /// Value to put into the scene before it is checked; repeatable
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub sets: Vec<String>,
}

/// A scene and what to change in it.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Scene file, CABLE file or MoorDyn file
    pub scene: PathBuf,
    /// Value to put into the scene before it is checked, such as environment.depth=100; repeatable
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub sets: Vec<String>,
}

impl SceneArguments {
    /// Reads and checks the scene.
    pub fn load(&self) -> Result<Loaded, Error> {
        read::load(&self.scene, &self.sets)
    }
}

/// `moorline pack`.
#[derive(Debug, Args)]
pub struct PackArguments {
    /// Scene file, CABLE file or MoorDyn file; without one, the built-in case of Lindahl & Sjöberg
    pub scene: Option<PathBuf>,
    /// The FMU to write
    #[arg(short, long, value_name = "FILE.fmu")]
    pub output: PathBuf,
    /// Value to put into the scene before it is checked; repeatable
    #[arg(long = "set", value_name = "PLACE=VALUE")]
    pub sets: Vec<String>,
    /// Names of variables without dots (stern_fairlead_position_x), for tools that make buses of them
    #[arg(long)]
    pub flat_names: bool,
}

/// `moorline convert`.
#[derive(Debug, Args)]
pub struct ConvertArguments {
    /// JSON scene, CABLE file or MoorDyn file
    pub input: PathBuf,
    /// JSON scene, or of a JSON scene a CABLE file; a name that ends in .txt is a MoorDyn file
    pub output: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }
}
