//! All parts of a map, which together have its tiles.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use stickslip_plane::Tile;
use stickslip_plane::sweep::FailureCount;

use super::part_file::PartFile;
use super::results::Stored;
use super::task::Task;
use crate::error::FileError;

/// All parts of a map in their order.
#[derive(Debug)]
pub struct Parts(Vec<PartFile>);

impl Parts {
    /// Opens the parts at `paths`, which may have any order, and which this `program` made.
    ///
    /// # Errors
    /// [`FileError::Input`]: a file is not an intact part, a part is missing or is there with
    /// different results, or the parts are not those of one map.
    pub fn open(paths: &[PathBuf], program: &str) -> Result<Self, FileError> {
        let mut files: BTreeMap<usize, PartFile> = BTreeMap::new();
        let mut first: Option<PartFile> = None;
        for path in paths {
            let file = PartFile::open(path, program)?;
            file.require_beside(first.get_or_insert_with(|| file.clone()))?;
            match files.entry(file.part.number) {
                Entry::Vacant(place) => drop(place.insert(file)),
                Entry::Occupied(there) => file.require_same(there.get())?,
            }
        }
        let count = first.as_ref().map_or(0, |first| first.part.count);
        if let Some(first) = first.filter(|_| files.len() < count) {
            let missing = (1..=count).filter(|number| !files.contains_key(number));
            let reason = format!(
                "is one of {count} parts, and {} missing; expected all of them",
                named(missing, count - files.len())
            );
            return Err(FileError::input(&first.path, reason));
        }
        Ok(Self(files.into_values().collect()))
    }

    /// Checks every tile, and counts the points without a result. `checked` gets the number of
    /// points of each tile.
    ///
    /// # Errors
    /// [`FileError::Input`] names the file that is damaged or cannot be read.
    pub fn check(&self, checked: impl Fn(usize)) -> Result<FailureCount, FileError> {
        let mut count = FailureCount::default();
        for file in &self.0 {
            for index in file.tiles() {
                let tile = file.read(index).map_err(|error| file.unreadable(&error))?;
                let points = self.task().range(index);
                count.add(points.start, &tile);
                checked(points.len());
            }
        }
        Ok(count)
    }

    /// The file that has the tile `index`.
    fn file(&self, index: usize) -> &PartFile {
        &self.0[self.0.partition_point(|file| file.tiles().end <= index)]
    }
}

impl Stored for Parts {
    fn task(&self) -> &Task {
        self.0[0].task()
    }

    fn tiles(&self) -> Range<usize> {
        0..self.task().tiles()
    }

    fn read(&self, index: usize) -> io::Result<Tile> {
        let file = self.file(index);
        file.read(index)
            .map_err(|error| io::Error::other(format!("{}: {error}", file.path.display())))
    }

    fn unreadable(&self, error: &io::Error) -> FileError {
        FileError::input(&self.0[0].path, format!("or another part cannot be read: {error}"))
    }
}

/// The first of `count` numbers of parts in words, with their verb.
fn named(numbers: impl Iterator<Item = usize>, count: usize) -> String {
    const MOST: usize = 10;
    let shown: Vec<_> = numbers.take(MOST).map(|number| number.to_string()).collect();
    match shown.split_last() {
        Some((last, [])) => format!("part {last} is"),
        Some((last, others)) if count <= MOST => {
            format!("parts {} and {last} are", others.join(", "))
        }
        _ => format!("parts {} and {} others are", shown.join(", "), count - shown.len()),
    }
}
