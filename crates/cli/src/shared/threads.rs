//! The threads on which the work runs.

use clap::builder::RangedI64ValueParser;
use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip_plane::progress::Report;

use crate::error::Failure;
use crate::output::progress::Bar;

/// On how many threads the work runs.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct ThreadsArguments {
    /// Threads; 1 to 1024 [default: one for each core]; results do not depend on it
    #[arg(long, value_name = "N", help_heading = "Output", allow_hyphen_values = true)]
    #[arg(value_parser = threads())]
    pub threads: Option<u16>,
}

impl ThreadsArguments {
    /// The threads, as one pool.
    ///
    /// # Errors
    /// [`Failure::Threads`]: they cannot be started.
    pub fn pool(self) -> Result<ThreadPool, Failure> {
        pool(self.threads)
    }

    /// Does `work` on the threads, with a progress bar of its steps.
    ///
    /// # Errors
    /// As of [`Self::pool`].
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
    clap::value_parser!(u16).range(1..=1024)
}

/// A pool of `count` threads, or of one thread for each core.
///
/// # Errors
/// [`Failure::Threads`]: the threads cannot be started.
pub fn pool(count: Option<u16>) -> Result<ThreadPool, Failure> {
    Ok(ThreadPoolBuilder::new().num_threads(count.map_or(0, usize::from)).build()?)
}
