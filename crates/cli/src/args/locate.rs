//! The options of `locate`.

use std::path::PathBuf;

/// Options of `locate`.
#[derive(Debug, clap::Args)]
pub struct LocateArguments {
    /// Atlas that the command trace has written
    #[arg(long, value_name = "ATLAS.json", help_heading = "Input")]
    pub atlas: PathBuf,

    /// CSV file with a header row that names kappa and psi, or the parameters of a system, and one
    /// point per row; - is standard input
    #[arg(long, value_name = "POINTS.csv", help_heading = "Input")]
    pub batch: PathBuf,

    /// CSV file for the results, one row per point in the order of the input
    #[arg(long, value_name = "OUT.csv", help_heading = "Output")]
    pub out: PathBuf,
}

/// What `locate --help` says first.
pub const ABOUT: &str = "\
Look up the switches of collisions in an atlas.

POINTS.csv has the columns kappa and psi; other columns pass through. OUT.csv has the columns of the \
input followed by switch_count, itinerary, region and distance. The distance, in ψ, is that to the \
nearest boundary of the atlas at the same κ. Within the error of a boundary, the collision itself is \
computed, and decides. A point has no count, itinerary and region if it lies outside the window, or \
if its collision has the switches of no region there. The first such point is named on standard \
error, and the exit code is 1.

In an atlas of a system of your own, the columns are the parameters on its axes, and event_count takes \
the place of switch_count. Nothing is run: within the error of a boundary and in regions in doubt, a \
point is not located.";

/// What `locate --help` says last.
pub const EXAMPLES: &str = "\
Examples:
  stickslip locate --atlas atlas.json --batch POINTS.csv --out OUT.csv

Exit codes: 0 done, 1 a point cannot be located, 2 bad usage or bad input.";
