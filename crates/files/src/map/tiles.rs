//! The directory in which the finished tiles of a map are stored until the map is complete.
//!
//! A tile holds successive points, not a square: the finished file is a concatenation of tiles. It
//! is written in one pass for each array with one tile in memory, and the files on disk are checked
//! tile by tile. Each tile names the task word for word, so that no two tasks are confused.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::input::part::MapPart;
use crate::output::file;
use crate::output::partial::{self, Partial};
use same_file::Handle;
use stickslip_plane::Tile;

use super::results::Stored;
use super::task::{Task, difference};
use crate::error::FileError;

/// The tiles of one task, or of one part of it. No other process makes them at the same time.
///
/// They are in a directory that has the description of the task from its first moment. A directory
/// without it is not the program's, and nothing in it is touched. In the directory, names that the
/// program does not give are left alone, and links are not followed.
#[derive(Debug)]
pub struct Tiles {
    directory: PathBuf,
    task: Task,
    /// The tiles that are made here.
    share: Range<usize>,
    /// The lock is held until the directory is removed or the process ends, however it ends.
    lock: File,
}

/// What was found of a map that was begun before.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The finished tiles.
    pub kept: BTreeSet<usize>,
    /// The number of tiles that are not what was written.
    pub damaged: usize,
}

impl Tiles {
    const LOCK: &str = "lock";
    const TASK: &str = "task";

    /// Opens the directory of the tiles of `out`, `OUT.tiles`, and creates it if it is missing. The
    /// tiles are those of a `part` of the task, or of all of it.
    ///
    /// # Errors
    /// The directory cannot be created, another process works there, its tiles are those of another
    /// task or part, or the program did not make it.
    pub fn open(out: &Path, task: Task, part: Option<MapPart>) -> Result<Self, FileError> {
        if out.is_dir() {
            return Err(FileError::output(out, io::ErrorKind::IsADirectory));
        }
        let mut directory = file::target(out).into_os_string();
        directory.push(".tiles");
        let directory = PathBuf::from(directory);
        let share = part.map_or(0..task.tiles(), |part| part.share(task.tiles()));
        let marker = match part {
            Some(part) => format!("{}part: {part}\n", task.description),
            None => task.description.clone(),
        };
        loop {
            if fs::symlink_metadata(&directory).is_err() {
                create(&directory, &marker).map_err(|error| FileError::output(out, error))?;
            }
            let opened = require_own(&directory, &marker).and_then(|()| take_lock(&directory));
            match opened {
                Ok(Some(lock)) => {
                    let tiles = Self { directory, task, share, lock };
                    tiles
                        .remove_partial(out)
                        .map_err(|e| FileError::output(&tiles.directory, e))?;
                    return Ok(tiles);
                }
                // Another process has just finished this map, and has removed the directory.
                Ok(None) => {}
                Err(_) if fs::symlink_metadata(&directory).is_err() => {}
                Err(failure) => return Err(failure),
            }
        }
    }

    /// The directory in which the tiles are.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Looks for finished tiles and checks each of them.
    ///
    /// # Errors
    /// A tile cannot be read.
    pub fn find(&self) -> io::Result<Found> {
        let mut found = Found::default();
        for entry in fs::read_dir(&self.directory)? {
            let Some(index) = self.index(&entry?.file_name()) else { continue };
            if self.read(index).is_ok() {
                found.kept.insert(index);
            } else {
                require_file(&self.path(index))?;
                found.damaged += 1;
            }
        }
        Ok(found)
    }

    /// Stores a finished tile.
    ///
    /// # Errors
    /// The tile cannot be written.
    pub fn keep(&self, index: usize, tile: &Tile) -> Result<(), FileError> {
        let bytes = tile.to_bytes(&self.task.label(index));
        // If a power cut leaves a tile incomplete, its checksum tells.
        file::write_unsynchronised(&self.path(index), &bytes)
    }

    /// Removes the program's own files, and then the directory if it is empty.
    ///
    /// If something cannot be removed, that does no harm, because the map is complete.
    pub fn remove(self) {
        let entries = || fs::read_dir(&self.directory).into_iter().flatten().flatten();
        for entry in entries().filter(|entry| self.index(&entry.file_name()).is_some()) {
            let _ = fs::remove_file(entry.path());
        }
        let own = [Self::TASK, Self::LOCK];
        let mut rest = entries().map(|entry| entry.file_name());
        // It goes at once, so that nobody finds it without its task.
        if rest.all(|name| own.iter().any(|own| name == *own))
            && let Ok(away) = Partial::directory(&self.directory)
            && fs::rename(&self.directory, away.path()).is_ok()
        {
            return;
        }
        // Some systems do not remove an open file.
        drop(self.lock);
        for name in own {
            let _ = fs::remove_file(self.directory.join(name));
        }
        let _ = fs::remove_dir(&self.directory);
    }

    fn path(&self, index: usize) -> PathBuf {
        self.directory.join(Self::name(index))
    }

    fn name(index: usize) -> String {
        format!("{index}.tile")
    }

    /// The index of the tile that is stored under `name`.
    fn index(&self, name: &OsStr) -> Option<usize> {
        let index = name.to_str()?.strip_suffix(".tile")?.parse().ok()?;
        (self.share.contains(&index) && name == OsStr::new(&Self::name(index))).then_some(index)
    }

    /// Removes files that a killed process has left incomplete: those of tiles and of `out`.
    fn remove_partial(&self, out: &Path) -> io::Result<()> {
        let out = file::target(out);
        for entry in fs::read_dir(&self.directory)? {
            let entry = entry?;
            let name = entry.file_name();
            let is_own = partial::completed(&name).is_some_and(|complete| {
                Some(OsStr::new(complete)) == out.file_name()
                    || self.index(complete.as_ref()).is_some()
            });
            if is_own && entry.file_type()?.is_file() {
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
}

impl Stored for Tiles {
    fn task(&self) -> &Task {
        &self.task
    }

    fn tiles(&self) -> Range<usize> {
        self.share.clone()
    }

    fn read(&self, index: usize) -> io::Result<Tile> {
        let (path, label) = (self.path(index), self.task.label(index));
        let points = self.task.range(index).len();
        let length = Tile::length(&label, points) as u64;
        let tile = if require_file(&path)? == length {
            Tile::from_bytes(&fs::read(&path)?, &label, points)
        } else {
            None
        };
        tile.ok_or_else(|| io::Error::other(format!("{} is not what was written", path.display())))
    }

    fn unreadable(&self, error: &io::Error) -> FileError {
        FileError::input(&self.directory, format!("cannot be read: {error}"))
    }
}

/// Makes `directory` with the description of its task. It is not there without it.
fn create(directory: &Path, description: &str) -> io::Result<()> {
    let beside = Partial::directory(directory)?;
    let mut marker = File::create_new(beside.path().join(Tiles::TASK))?;
    marker.write_all(description.as_bytes())?;
    // A power cut must not damage it: unlike a tile, it could not be made again.
    marker.sync_all()?;
    match beside.publish(directory) {
        // Another process has been quicker.
        Err(error) if is_taken(error.kind()) => Ok(()),
        published => published,
    }
}

/// Whether there is a directory with the name already.
fn is_taken(error: io::ErrorKind) -> bool {
    matches!(error, io::ErrorKind::AlreadyExists | io::ErrorKind::DirectoryNotEmpty)
}

/// Refuses a directory that the program did not make for the task with `description`.
fn require_own(directory: &Path, description: &str) -> Result<(), FileError> {
    const MOST_BYTES: u64 = 1 << 16;
    const EXPECTED: &str =
        "expected a directory that stickslip map began, another --out, or no such name";
    if !fs::symlink_metadata(directory).is_ok_and(|metadata| metadata.is_dir()) {
        let error = io::Error::other(format!("it is not a directory; {EXPECTED}"));
        return Err(FileError::output(directory, error));
    }
    let marker = directory.join(Tiles::TASK);
    if !require_file(&marker).is_ok_and(|length| length <= MOST_BYTES) {
        return Err(FileError::input(
            directory,
            format!("is not a directory of tiles; {EXPECTED}"),
        ));
    }
    let kept = fs::read(&marker).map_err(|error| FileError::output(directory, error))?;
    require_same(directory, &kept, description)
}

/// Locks the directory and says who holds it, or `None` if it has been removed.
fn take_lock(directory: &Path) -> Result<Option<File>, FileError> {
    let unusable = |error: io::Error| FileError::output(directory, error);
    let path = directory.join(Tiles::LOCK);
    if fs::symlink_metadata(&path).is_ok() {
        require_file(&path).map_err(unusable)?;
    }
    let open = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path);
    let mut lock = match open {
        Ok(lock) => lock,
        Err(_) if fs::symlink_metadata(directory).is_err() => return Ok(None),
        Err(error) => return Err(unusable(error)),
    };
    // Where files cannot be locked, two processes do the same work twice, which does no harm.
    if let Err(TryLockError::WouldBlock) = lock.try_lock() {
        let mut holder = String::new();
        // If it cannot be read, the message says less.
        let _ = lock.take(64).read_to_string(&mut holder);
        let holder = holder.trim().parse().ok();
        return Err(FileError::Busy { directory: directory.to_owned(), holder });
    }
    let locked = lock.try_clone().and_then(Handle::from_file).map_err(unusable)?;
    if !Handle::from_path(&path).is_ok_and(|there| there == locked) {
        return Ok(None);
    }
    let written = lock.set_len(0).and_then(|()| write!(lock, "{}", std::process::id()));
    written.map_err(unusable)?;
    Ok(Some(lock))
}

/// The length of the regular file at `path`. A link is not one.
fn require_file(path: &Path) -> io::Result<u64> {
    let metadata = fs::symlink_metadata(path)?;
    if metadata.is_file() {
        Ok(metadata.len())
    } else {
        Err(io::Error::other(format!("{} is not a regular file", path.display())))
    }
}

/// Refuses a directory whose task is `kept`, unless that is the task with `description`.
fn require_same(directory: &Path, kept: &[u8], description: &str) -> Result<(), FileError> {
    if kept == description.as_bytes() {
        return Ok(());
    }
    let kept = String::from_utf8_lossy(kept);
    let (theirs, ours) = difference(&kept, description);
    Err(FileError::input(
        directory,
        format!(
            "holds the tiles of another map or part, with '{theirs}' where this one has '{ours}'; \
             expected the command that began it, another --out, or no such directory"
        ),
    ))
}
