//! Work on many cases: in parallel, without the interpreter's lock, and interruptible.

use std::ops::Range;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::failed;

/// The time between two looks for Ctrl-C.
pub const PAUSE: Duration = Duration::from_millis(50);
/// Cases that one thread computes together, at most.
const PART: usize = 256;
/// Parts of a piece, at least: threads that are done early take more of them.
const PARTS: usize = 16;
/// Cases between two looks for Ctrl-C, at most.
const PIECE: usize = 1 << 15;

/// Calls `work` on all pieces of `0..count`, in order. Between them it looks for Ctrl-C, and tells
/// `progress` how many cases are done. A piece takes about [`PAUSE`].
pub fn in_pieces(
    py: Python<'_>,
    count: usize,
    progress: Option<&Py<PyAny>>,
    mut work: impl FnMut(Range<usize>) -> PyResult<()>,
) -> PyResult<()> {
    let (mut first, mut size) = (0, 1);
    while first < count {
        let (last, begun) = (count.min(first + size), Instant::now());
        work(first..last)?;
        py.check_signals()?;
        if let Some(progress) = progress {
            progress.call1(py, (last, count))?;
        }
        size = if begun.elapsed() > PAUSE { (size / 2).max(1) } else { PIECE.min(2 * size) };
        first = last;
    }
    Ok(())
}

/// The number of cases of a part, in a piece of so many cases.
fn part_size(cases: usize) -> usize {
    cases.div_ceil(PARTS).clamp(1, PART)
}

/// The threads of one call; none where the caller's own is enough. And what is told how far it is.
pub struct Threads(Option<ThreadPool>, Option<Py<PyAny>>);

impl Threads {
    /// `threads` threads, or as many as there are cores if it is 0, for `count` cases.
    pub fn new(threads: usize, count: usize) -> PyResult<Self> {
        if threads == 1 || count <= PART {
            return Ok(Self(None, None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)?;
        Ok(Self(Some(pool), None))
    }

    /// The same threads, with a callable that is told how far the call is.
    pub fn telling(self, progress: Option<Py<PyAny>>) -> Self {
        Self(self.0, progress)
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
        in_pieces(py, count, self.1.as_ref(), |piece| {
            let size = part_size(piece.len());
            let parts = piece.len().div_ceil(size);
            let part = |index: usize| {
                let start = piece.start + index * size;
                work(start..piece.end.min(start + size))
            };
            let made: Vec<T> = py.detach(|| match &self.0 {
                Some(pool) => pool.install(|| (0..parts).into_par_iter().map(part).collect()),
                None => (0..parts).map(part).collect(),
            });
            made.into_iter().try_for_each(&mut take)
        })
    }

    /// Gives parts of a piece to `work`, each with the number of its first.
    pub fn fill<T: Send>(
        &self,
        py: Python<'_>,
        piece: &mut [T],
        work: impl Fn(usize, &mut [T]) + Sync,
    ) {
        let size = part_size(piece.len());
        py.detach(|| match &self.0 {
            Some(pool) => pool.install(|| {
                let parts = piece.par_chunks_mut(size).enumerate();
                parts.for_each(|(index, part)| work(index * size, part));
            }),
            None => work(0, piece),
        });
    }
}
