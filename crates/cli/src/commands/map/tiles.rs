//! The directory in which the finished tiles of a map are stored until the map is complete.

use std::fs::{self, File, TryLockError};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use stickslip_plane::Tile;

use crate::error::Failure;
use crate::output::file;

/// A map, divided into tiles of successive points, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Task {
    /// Everything on which the results depend, one fact per line.
    pub description: String,
    /// The number of points.
    pub points: usize,
    /// The number of points in each tile. The last tile may have fewer.
    pub tile_points: usize,
}

impl Task {
    /// The number of tiles.
    pub fn tiles(&self) -> usize {
        self.points.div_ceil(self.tile_points)
    }

    /// The points of tile `index`.
    pub fn range(&self, index: usize) -> Range<usize> {
        let start = index * self.tile_points;
        start..(start + self.tile_points).min(self.points)
    }

    /// The index of the tile that has `point`, and the point's index in it.
    pub fn place(&self, point: usize) -> (usize, usize) {
        (point / self.tile_points, point % self.tile_points)
    }

    fn label(&self, index: usize) -> String {
        format!("{}tile: {index}\n", self.description)
    }
}

/// The tiles of one task. No other process makes them at the same time.
#[derive(Debug)]
pub struct Tiles {
    directory: PathBuf,
    task: Task,
    /// The lock is held until the directory is removed or the process ends, however it ends.
    lock: File,
}

/// What was found of a map that was begun before.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The number of finished tiles.
    pub kept: usize,
    /// The number of tiles that are not what was written.
    pub damaged: usize,
    /// The tiles that have to be made, damaged tiles included.
    pub missing: Vec<usize>,
}

impl Tiles {
    const LOCK: &str = "lock";
    const TASK: &str = "task";

    /// Opens the directory of the tiles of `out`, `OUT.tiles`, and creates it if it is missing.
    ///
    /// # Errors
    /// The directory cannot be created, another process works there, or its tiles are those of
    /// another task.
    pub fn open(out: &Path, task: Task) -> Result<Self, Failure> {
        if out.is_dir() {
            return Err(Failure::output(out, io::ErrorKind::IsADirectory));
        }
        let mut directory = file::target(out).into_os_string();
        directory.push(".tiles");
        let directory = PathBuf::from(directory);
        match fs::create_dir(&directory) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                return Err(Failure::output(out, error));
            }
            _ => {}
        }
        let unusable = |error: io::Error| Failure::output(&directory, error);
        let lock = File::create(directory.join(Self::LOCK)).map_err(unusable)?;
        // Where files cannot be locked, two processes do the same work twice, which does no harm.
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            return Err(Failure::Busy(directory));
        }
        match fs::read(directory.join(Self::TASK)) {
            Ok(kept) => require_same(&directory, &kept, &task.description)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                // A power cut must not damage it: unlike a tile, it could not be made again.
                file::write(&directory.join(Self::TASK), task.description.as_bytes())?;
            }
            Err(error) => return Err(unusable(error)),
        }
        remove_partial(&directory).map_err(unusable)?;
        Ok(Self { directory, task, lock })
    }

    /// The directory in which the tiles are.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// The task whose tiles these are.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// Looks for finished tiles and checks each of them.
    ///
    /// # Errors
    /// A tile cannot be read.
    pub fn find(&self) -> io::Result<Found> {
        let mut found = Found::default();
        for index in 0..self.task.tiles() {
            match self.bytes(index)? {
                Some(bytes) if self.decode(index, &bytes).is_some() => {
                    found.kept += 1;
                    continue;
                }
                Some(_) => found.damaged += 1,
                None => {}
            }
            found.missing.push(index);
        }
        Ok(found)
    }

    /// Stores a finished tile.
    ///
    /// # Errors
    /// The tile cannot be written.
    pub fn keep(&self, index: usize, tile: &Tile) -> Result<(), Failure> {
        let bytes = tile.to_bytes(&self.task.label(index));
        // If a power cut leaves a tile incomplete, its checksum tells.
        file::write_unsynchronised(&self.path(index), &bytes)
    }

    /// Reads a finished tile.
    ///
    /// # Errors
    /// The tile cannot be read, or is not what was written.
    pub fn read(&self, index: usize) -> io::Result<Tile> {
        let bytes = self.bytes(index)?.unwrap_or_default();
        self.decode(index, &bytes).ok_or_else(|| {
            let path = self.path(index);
            io::Error::other(format!("{} has changed since it was checked", path.display()))
        })
    }

    /// Removes the program's own files, and then the directory if it is empty.
    ///
    /// If something cannot be removed, that does no harm, because the map is complete.
    pub fn remove(self) {
        for index in 0..self.task.tiles() {
            let _ = fs::remove_file(self.path(index));
        }
        let _ = fs::remove_file(self.directory.join(Self::TASK));
        // Some systems do not remove an open file.
        drop(self.lock);
        let _ = fs::remove_file(self.directory.join(Self::LOCK));
        let _ = fs::remove_dir(&self.directory);
    }

    fn path(&self, index: usize) -> PathBuf {
        self.directory.join(format!("{index}.tile"))
    }

    fn bytes(&self, index: usize) -> io::Result<Option<Vec<u8>>> {
        match fs::read(self.path(index)) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn decode(&self, index: usize, bytes: &[u8]) -> Option<Tile> {
        Tile::from_bytes(bytes, &self.task.label(index), self.task.range(index).len())
    }
}

/// Removes files that a killed process has left incomplete.
fn remove_partial(directory: &Path) -> io::Result<()> {
    for entry in fs::read_dir(directory)? {
        let path = entry?.path();
        if path.as_os_str().as_encoded_bytes().ends_with(file::PARTIAL.as_bytes()) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Refuses a directory whose task is `kept`, unless that is the task with `description`.
fn require_same(directory: &Path, kept: &[u8], description: &str) -> Result<(), Failure> {
    if kept == description.as_bytes() {
        return Ok(());
    }
    let kept = String::from_utf8_lossy(kept);
    let mut lines = kept.lines().chain(std::iter::repeat("")).zip(description.lines());
    let (theirs, ours) = lines.find(|(theirs, ours)| theirs != ours).unwrap_or(("", ""));
    Err(Failure::input(
        directory,
        format!(
            "holds the tiles of another map, with '{theirs}' where this one has '{ours}'; \
             expected the command that began it, another --out, or no such directory"
        ),
    ))
}
