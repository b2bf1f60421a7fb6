//! The options of `join`.

use std::path::PathBuf;

use stickslip_files::output::picture::PictureFile;

use super::shared;

/// Options of `join`.
#[derive(Debug, clap::Args)]
pub struct JoinArguments {
    /// Files of all parts of a map, in any order, which map --part has written
    #[arg(value_name = "PART", required = true, help_heading = "Input")]
    pub parts: Vec<PathBuf>,

    /// File for the map: NumPy arrays in FILE.npz, or a table in FILE.csv
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub out: PathBuf,

    /// Picture of ε_t in colours, and of the regions with equal numbers of switches
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = shared::picture())]
    pub plot: Option<PictureFile>,
}

/// What `join --help` says first.
pub const ABOUT: &str = "\
Join the parts of a map, which were computed with map --part, to the whole map.

The map is byte for byte the one that map would have written without --part. Nothing is computed. \
The parts say themselves what the map is, and they are not changed. All of them must have been \
made by the build of the program that joins them.";

/// What `join --help` says last.
pub const EXAMPLES: &str = "\
A part that is missing, damaged, of another map or of a map divided into another number of parts is \
refused, and so is a part that is given twice with different content.

Examples:
  stickslip join map-*.part --out map.npz
  stickslip join map-*.part --out map.csv --plot map.svg

  map --help shows a job array for Slurm that makes the parts.

Exit codes: 0 done, 1 the map has points without a result or cannot be written, 2 bad usage or bad \
input.";
