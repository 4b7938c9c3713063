//! moorline: the mooring line that a ship simulator plugs in.
//!
//! The map of the house. Each layer knows only what stands above it in this list:
//! `error`, `algebra`, `scene`, `sea`, `rod`, `cable1994`, `solve`, `report` and `fmi`, `cli`. `tests/house.rs` holds it to that.
#![deny(unsafe_code)]
#![warn(missing_docs)]

/// Command line: one function per command. Uses everything, used by nothing.
pub mod cli {
    pub mod arguments;
    pub mod check;
    pub mod console;
    pub mod convert;
    pub mod dispatch;
    pub mod fit;
    pub mod interrupt;
    pub mod offsets;
    pub mod pack;
    pub mod progress;
    pub mod run;
    pub mod schema;
    pub mod seeds;
    pub mod statics;
    pub mod stop;
}
/// Every failure as data, and the only file that words it.
pub mod error;

/// Numbers only: shape functions, quadrature, block-tridiagonal systems. No mooring.
pub mod algebra {
    pub mod banded;
    pub mod block_tridiagonal;
    pub mod definite;
    pub mod dimension;
    pub mod fourier;
    pub mod lanes;
    pub mod polynomial;
    pub mod real;
    pub mod root;
    pub mod rotation;
    pub mod shape;
    pub mod sinusoid;
    pub mod spline;
    pub mod stokes;
    pub mod tensor;
    pub mod triple;
}

/// What the user said: plain data, read and checked. No nodes, no steps.
pub mod scene {
    pub mod bodies;
    pub mod cable;
    pub mod check;
    pub mod current_file;
    pub mod elevation_file;
    pub mod load_file;
    pub mod moordyn;
    pub mod motion_file;
    pub mod placing;
    pub mod pose_file;
    pub mod read;
    mod rows;
    pub mod state;
    pub mod text;
    pub mod types;
}

/// The discrete line: elements and the loads on them. No time steps, no files.
pub mod rod {
    pub mod awash;
    pub mod axial;
    pub mod bending;
    pub mod body;
    pub mod catenary;
    pub mod clamp;
    pub mod cylinder;
    pub mod elasticity;
    pub mod element;
    pub mod element_tangent;
    pub mod ends;
    pub mod flows;
    pub mod friction;
    pub mod grading;
    pub mod hold;
    pub mod joint;
    pub mod line;
    pub mod lying;
    pub mod mesh;
    pub mod morison;
    pub mod motion;
    pub mod parts;
    pub mod physics;
    pub mod pose;
    pub mod properties;
    pub mod rigid;
    pub mod seabed;
    pub mod state;
    pub mod stretch;
    pub mod surface;
    pub mod system;
    pub mod touching;
}

/// What the water does at a place.
pub mod sea {
    pub mod beside;
    pub mod clock;
    pub mod columns;
    pub mod current;
    pub mod drawing;
    pub mod figures;
    pub mod layer;
    pub mod near;
    pub mod random;
    pub mod region;
    pub mod series;
    pub mod shelf;
    pub mod spectrum;
    pub mod spreading;
    pub mod stream;
    pub mod stretching;
    pub mod wave;
    pub mod waves;
}

/// The method of the 1994 report, in a room of its own.
pub mod cable1994 {
    pub mod element;
    pub mod line;
    pub mod mat;
    pub mod setup;
    pub mod shapes;
    pub mod statics;
    pub mod step;
}

/// Statics and time.
pub mod solve {
    pub mod adams_moulton;
    pub mod between;
    pub mod bow;
    pub mod condensed;
    pub mod controller;
    pub mod counters;
    pub mod departure;
    pub mod esdirk;
    pub mod fleet;
    pub mod generalized_alpha;
    pub mod group;
    pub mod line_state;
    pub mod linearised;
    pub mod loads;
    pub mod memory;
    pub mod meshing;
    pub mod mixed;
    pub mod mooring;
    pub mod motion;
    pub mod network;
    pub mod newton;
    pub mod open_lines;
    pub mod outputs;
    pub mod part;
    pub mod partition;
    pub mod plane;
    pub mod relaxation;
    pub mod rest;
    pub mod rounding;
    pub mod scale;
    pub mod scheme;
    pub mod schemes;
    pub mod search;
    pub mod simulation;
    pub mod snapshot;
    pub mod stability;
    pub mod stable;
    pub mod start;
    pub mod statics;
    pub mod tangent;
    pub mod turn;
    pub mod unknowns;
}

/// The FMU: FMI 2.0 co-simulation around the facade of `solve`.
pub mod fmi {
    pub mod body_variables;
    pub mod experiment;
    pub mod filter;
    pub mod fit;
    #[allow(unsafe_code)]
    pub mod fmi2;
    pub mod freshness;
    pub mod input_path;
    pub mod inputs;
    pub mod instance;
    #[allow(unsafe_code)]
    pub mod own_place;
    pub mod pack;
    pub mod phase;
    pub mod refusal;
    pub mod resource;
    pub mod segment;
    pub mod snapshot;
    pub mod swing;
    pub mod variables;
    pub mod vessel;
    pub mod warnings;
}

/// What a run leaves behind: tables and a page to look at.
pub mod report {
    pub mod cable_files;
    pub mod course;
    pub mod extremes;
    pub mod moordyn_out;
    pub mod offsets;
    pub mod page;
    pub mod page_data;
    pub mod rainflow;
    pub mod record;
    #[cfg(test)]
    pub mod sample;
    pub mod schedule;
    pub mod seeds;
    pub mod statistics;
    pub mod statistics_page;
    pub mod tables;
    pub mod units;
    pub mod vtk;
    pub mod welch;
}
