//! The threads on which the work runs.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::Failure;

/// A pool of `count` threads, or of one thread for each core.
///
/// # Errors
/// [`Failure::Threads`]: the threads cannot be started.
pub fn pool(count: Option<u16>) -> Result<ThreadPool, Failure> {
    Ok(ThreadPoolBuilder::new().num_threads(count.map_or(0, usize::from)).build()?)
}
