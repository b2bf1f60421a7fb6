//! The options of `locate`.

use std::path::PathBuf;

/// Options of `locate`.
#[derive(Debug, clap::Args)]
pub struct LocateArguments {
    /// Atlas that trace has made
    #[arg(long, value_name = "ATLAS.json", help_heading = "Input")]
    pub atlas: PathBuf,

    /// CSV file with a header row that names kappa and psi, and one point a row
    #[arg(long, value_name = "POINTS.csv", help_heading = "Input")]
    pub batch: PathBuf,

    /// CSV file for the results, one row a point in the order of the input
    #[arg(long, value_name = "OUT.csv", help_heading = "Output")]
    pub out: PathBuf,
}

/// Text of `locate --help`.
pub const ABOUT: &str = "\
Look up the switches of collisions in an atlas, without computing a collision.

POINTS.csv has the columns kappa and psi; others pass through. OUT.csv has the input's columns \
followed by switch_count, itinerary, region and distance: that to the nearest boundary of the atlas \
at the same κ, in ψ. A point outside the window, or so close to a boundary that the boundary's error \
leaves the side open, has no count, itinerary and region; it is named on standard error, and the \
exit code is 1.";

/// What follows it.
pub const EXAMPLES: &str = "\
Examples:
  stickslip locate --atlas atlas.json --batch POINTS.csv --out OUT.csv

Exit codes: 0 done, 1 a point cannot be located, 2 bad usage or bad input.";
