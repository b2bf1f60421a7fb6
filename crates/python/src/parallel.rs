//! Work on many cases: in parallel, without the interpreter's lock, and interruptible.

use std::ops::Range;

use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::failed;

/// Cases that one thread computes together.
const PART: usize = 256;
/// Cases after which Ctrl-C is looked for.
pub const PIECE: usize = 1 << 15;

/// The threads of one call; none where the caller's own is enough.
pub struct Threads(Option<ThreadPool>);

impl Threads {
    /// `threads` threads, or as many as there are cores if it is 0, for `count` cases.
    pub fn new(threads: usize, count: usize) -> PyResult<Self> {
        if threads == 1 || count <= PART {
            return Ok(Self(None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)?;
        Ok(Self(Some(pool)))
    }

    /// A pool, even if one thread is enough.
    pub fn pool(threads: usize) -> PyResult<ThreadPool> {
        ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)
    }

    /// Gives parts of `count` cases to `work`, and what it makes of them, in order, to `take`.
    pub fn each<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl Fn(Range<usize>) -> T + Sync,
        mut take: impl FnMut(T) -> PyResult<()>,
    ) -> PyResult<()> {
        for first in (0..count).step_by(PIECE) {
            let last = count.min(first + PIECE);
            let parts = (last - first).div_ceil(PART);
            let part = |index: usize| {
                let start = first + index * PART;
                work(start..last.min(start + PART))
            };
            let made: Vec<T> = py.detach(|| match &self.0 {
                Some(pool) => pool.install(|| (0..parts).into_par_iter().map(part).collect()),
                None => (0..parts).map(part).collect(),
            });
            made.into_iter().try_for_each(&mut take)?;
            py.check_signals()?;
        }
        Ok(())
    }

    /// Gives parts of `all`, of at most a [`PIECE`], to `work`, each with the number of its first.
    pub fn fill<T: Send>(
        &self,
        py: Python<'_>,
        all: &mut [T],
        work: impl Fn(usize, &mut [T]) + Sync,
    ) -> PyResult<()> {
        py.detach(|| match &self.0 {
            Some(pool) => pool.install(|| {
                let parts = all.par_chunks_mut(PART).enumerate();
                parts.for_each(|(index, part)| work(index * PART, part));
            }),
            None => work(0, all),
        });
        py.check_signals()
    }
}
