//! `join`: a map made of its parts.

use std::path::PathBuf;

use stickslip_files::input::source::is_standard_input;
use stickslip_files::map::{Parts, Stored};
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::picture::PictureFile;

use super::map::{IN_ARRAYS, MapFormat, computed, finish, require_all};
use crate::error::Failure;
use crate::output::console::deliver;
use crate::output::progress::Bar;
use crate::shared::files::{self, plotted, require_different};
use crate::version;

/// Join the parts of a map
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct JoinArguments {
    /// Files of all parts of a map, in any order, which map --part has written
    #[arg(value_name = "PART", required = true, help_heading = "Input")]
    pub parts: Vec<PathBuf>,

    /// File for the map: NumPy arrays in FILE.npz, or a table in FILE.csv
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub out: PathBuf,

    /// Picture of ε_t in colours, and of the regions with equal numbers of switches
    #[arg(long, value_name = "FILE.svg|.png|.pdf", help_heading = "Output")]
    #[arg(value_parser = files::picture())]
    pub plot: Option<PictureFile>,
}

/// Writes the map whose parts are in the files, with one tile in memory at a time.
///
/// # Errors
/// A part is missing, damaged or that of another map, a file cannot be written, or some points have
/// no result. In the last case the map is complete.
pub fn run(arguments: &JoinArguments) -> Result<(), Failure> {
    let JoinArguments { parts, out, plot } = arguments;
    if parts.iter().any(|part| is_standard_input(part)) {
        let message = "PART -: a part is not read from standard input; expected a file";
        return Err(Failure::Usage(message.to_owned()));
    }
    let inputs: Vec<_> = parts.iter().map(|part| ("PART", Some(&**part))).collect();
    require_different(&[("--out", Some(out)), plotted(plot.as_ref())], &inputs)?;
    let format = MapFormat::of(out)?;
    plot.as_ref().map_or(Ok(()), PictureFile::probe)?;
    let parts = Parts::open(parts, &version::program())?;
    let file = OutputFile::create(out)?;
    let bar = Bar::points(parts.task().points());
    let failures = parts.check(|points| bar.advance(points))?;
    drop(bar);
    let task = parts.task();
    let found = computed(task.points(), &failures, &task.engine);
    deliver(finish(&parts, Some((file, format)), plot.as_ref())?, found)?;
    require_all(&failures, &parts, (out, IN_ARRAYS))
}

/// What `join --help` says first.
const ABOUT: &str = "\
Join the parts of a map, which were computed with map --part, to the whole map.

The map is byte for byte the one that map would have written without --part. Nothing is computed. \
The parts say themselves what the map is, and they are not changed. All of them must have been \
made by the build of the program that joins them.";

/// What `join --help` says last.
const EXAMPLES: &str = "\
A part that is missing, damaged, of another map or of a map divided into another number of parts is \
refused, and so is a part that is given twice with different content.

Examples:
  stickslip join map-*.part --out map.npz
  stickslip join map-*.part --out map.csv --plot map.svg

  map --help shows a job array for Slurm that makes the parts.

Exit codes: 0 done, 1 the map has points without a result or cannot be written, 2 bad usage or bad \
input.";
