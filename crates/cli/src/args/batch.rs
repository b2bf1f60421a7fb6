//! The options of a batch: a file with a case in each row.

use std::path::PathBuf;

use super::shared;

/// A file with a case in each row, and the files for the results.
#[derive(Clone, Debug, clap::Args)]
pub struct BatchArguments {
    /// CSV file with a header row and one case per row; - is standard input
    #[arg(long, value_name = "IN.csv", help_heading = "Batch", requires = "out")]
    pub batch: Option<PathBuf>,

    /// CSV file for the results, one row per case in the order of the input
    #[arg(long, value_name = "OUT.csv", help_heading = "Batch", requires = "batch")]
    pub out: Option<PathBuf>,

    /// CSV file for every switch of every case
    #[arg(long, value_name = "EV.csv", help_heading = "Batch", requires = "batch")]
    pub events: Option<PathBuf>,

    /// Threads for a batch; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Batch", allow_hyphen_values = true)]
    #[arg(value_parser = shared::threads())]
    pub threads: Option<u16>,
}
