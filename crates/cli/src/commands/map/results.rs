//! The results of a whole map, in parts.

use std::io;
use std::ops::Range;

use stickslip_plane::Tile;

use super::tiles::Tiles;

/// All results of a map.
pub trait Results {
    /// Passes each part with its points to `take`, one after the other in order.
    ///
    /// # Errors
    /// A part cannot be read, or `take` fails.
    fn each(&self, take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()>;
}

/// The results are stored in files.
impl Results for Tiles {
    fn each(&self, mut take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()> {
        let task = self.task();
        (0..task.tiles()).try_for_each(|index| take(task.range(index), &self.read(index)?))
    }
}

/// All results are in memory.
impl Results for Tile {
    fn each(&self, mut take: impl FnMut(Range<usize>, &Tile) -> io::Result<()>) -> io::Result<()> {
        take(0..self.eps_t.len(), self)
    }
}
