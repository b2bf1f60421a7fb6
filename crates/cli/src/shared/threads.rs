//! The threads on which the work runs.

use std::env;
use std::ffi::OsStr;

use clap::builder::RangedI64ValueParser;
use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip_plane::progress::Report;

use crate::error::Failure;
use crate::output::progress::Bar;

/// The greatest number of threads.
const MOST: u16 = 1024;

/// The variable of the environment that says how many threads there are.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// On how many threads the work runs.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct ThreadsArguments {
    /// Threads; 1 to 1024 [default: RAYON_NUM_THREADS, or one for each core]; results do not depend
    /// on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = threads())]
    pub threads: Option<u16>,
}

impl ThreadsArguments {
    /// The threads, as one pool.
    pub fn pool(self) -> Result<ThreadPool, Failure> {
        pool(self.threads)
    }

    /// Does `work` on the threads, with a progress bar of its steps.
    pub fn with_steps<T: Send>(
        self,
        work: impl FnOnce(Report<'_>) -> T + Send,
    ) -> Result<T, Failure> {
        let pool = self.pool()?;
        let bar = Bar::steps();
        Ok(pool.install(|| work(&|progress| bar.report(progress))))
    }
}

/// Reads a number of threads.
pub fn threads() -> RangedI64ValueParser<u16> {
    clap::value_parser!(u16).range(1..=i64::from(MOST))
}

/// A pool of `count` threads, of as many as the environment says, or of one thread for each core.
pub fn pool(count: Option<u16>) -> Result<ThreadPool, Failure> {
    let count = match count {
        Some(count) => usize::from(count),
        None => in_environment(&env::var_os(VARIABLE).unwrap_or_default())?,
    };
    Ok(ThreadPoolBuilder::new().num_threads(count).build()?)
}

/// The number of threads that the environment names with `value`; 0, which stands for one thread
/// for each core, if it is empty.
fn in_environment(value: &OsStr) -> Result<usize, Failure> {
    if value.is_empty() {
        return Ok(0);
    }
    let count = value.to_str().and_then(|text| text.parse().ok());
    count.filter(|count| (1..=usize::from(MOST)).contains(count)).ok_or_else(|| {
        let value = value.to_string_lossy();
        Failure::Usage(format!("{VARIABLE} = {value:?}; expected a whole number from 1 to {MOST}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_has_the_limits_of_the_option() {
        for (text, count) in [("", 0), ("1", 1), ("1024", 1024)] {
            assert_eq!(in_environment(text.as_ref()).unwrap(), count);
        }
        for text in ["0", "1025", "-1", "two", " 2", "99999999999999999999"] {
            let message = in_environment(text.as_ref()).unwrap_err().to_string();
            let expected = "expected a whole number from 1 to 1024";
            assert_eq!(message, format!("RAYON_NUM_THREADS = {text:?}; {expected}"));
        }
    }
}
