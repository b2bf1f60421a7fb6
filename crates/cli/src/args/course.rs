//! The options of the course of one collision in time.

use std::path::PathBuf;

/// Where the course is written, and how dense it is.
#[derive(Clone, Debug, clap::Args)]
pub struct CourseArguments {
    /// CSV file for forces, overlap and velocities against time, at even times and every switch
    #[arg(long, value_name = "FILE.csv", help_heading = "Output", conflicts_with = "batch")]
    pub course: Option<PathBuf>,

    /// Number of even times of --course, with the start and the end; 2 to 10000000
    #[arg(long, value_name = "N", help_heading = "Output", requires = "course")]
    #[arg(default_value_t = 1000, allow_hyphen_values = true)]
    #[arg(value_parser = clap::value_parser!(u32).range(2..=10_000_000))]
    pub points: u32,
}
