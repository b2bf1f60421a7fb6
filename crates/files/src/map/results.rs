//! The results of a map, in tiles.

use std::io;
use std::ops::Range;

use stickslip_plane::Tile;
use stickslip_plane::sweep::FailureCount;

use super::task::Task;
use crate::error::FileError;

/// All results of a map or of a part of it.
pub trait Results {
    /// Passes each tile with its points to `take`, one after the other in order.
    ///
    /// # Errors
    /// A tile cannot be read, or `take` fails.
    fn each(&self, take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()>;

    /// The points without a result.
    ///
    /// # Errors
    /// A tile cannot be read.
    fn failures(&self) -> io::Result<FailureCount> {
        let mut count = FailureCount::default();
        self.each(|points, tile| {
            count.add(points.start, tile);
            Ok(())
        })?;
        Ok(count)
    }
}

/// The results of successive tiles of a task, which are stored in files.
pub trait Stored {
    /// The task whose tiles these are.
    fn task(&self) -> &Task;

    /// Which tiles these are.
    fn tiles(&self) -> Range<usize>;

    /// Reads a tile.
    ///
    /// # Errors
    /// The tile cannot be read, or is not what was written.
    fn read(&self, index: usize) -> io::Result<Tile>;

    /// The failure to read a tile.
    fn unreadable(&self, error: &io::Error) -> FileError;
}

impl<S: Stored> Results for S {
    fn each(&self, mut take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()> {
        self.tiles().try_for_each(|index| take(self.task().range(index), &self.read(index)?))
    }
}

/// All results are in memory.
impl Results for Tile {
    fn each(&self, mut take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()> {
        take(0..self.eps_t.len(), self)
    }
}
