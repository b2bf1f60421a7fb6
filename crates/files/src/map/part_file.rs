//! The file of one part of a map: a header, and the tiles of the part as they were kept.
//!
//! The header is a line for readers, a line of JSON and a checksum. As the tiles, each with its own
//! checksum, it says what the whole task is. Nothing in the file is compressed, and a tile is found
//! without reading others. So a part is what a whole map keeps until it is complete, and to join
//! parts is what a whole map does in the end. The header holds the task as data too: `join` needs
//! no options.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::input::part::MapPart;
use crate::input::range::Size;
use crate::input::source::unreadable;
use serde::{Deserialize, Serialize};
use stickslip_model::Engine;
use stickslip_plane::{Grid, Tile};

use super::results::Stored;
use super::task::{Task, difference};
use super::tiles::Tiles;
use crate::error::FileError;

/// The first line of the file.
const TITLE: &str = "Part of a map; the command stickslip join makes the map of all parts.\n";
/// More bytes than any header has.
const MOST_HEADER: u64 = 1 << 16;
const EXPECTED: &str = "expected a file that stickslip map --part wrote";

/// What the header says.
#[derive(Serialize, Deserialize)]
struct Header {
    #[serde(flatten)]
    origin: Origin,
    grid: Grid,
    engine: Engine,
}

/// What is read first, because another version of the program may write the rest otherwise.
#[derive(Serialize, Deserialize)]
struct Origin {
    /// The description of the task.
    task: String,
    part: String,
}

/// A part of a map, stored in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct PartFile {
    /// The file.
    pub path: PathBuf,
    /// Which part this is.
    pub part: MapPart,
    task: Task,
    /// Where the first tile begins.
    begin: u64,
}

/// Writes a `part` of a map, whose `tiles` are all finished.
///
/// # Errors
/// `out` cannot be written, or a tile cannot be read.
pub fn write(out: impl Write, part: MapPart, tiles: &Tiles) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    let task = tiles.task();
    let origin = Origin { task: task.description.clone(), part: part.to_string() };
    let header = Header { origin, grid: task.grid, engine: task.engine };
    let header = format!("{TITLE}{}\n", serde_json::to_string(&header)?);
    out.write_all(&empty().to_bytes(&header))?;
    for index in tiles.tiles() {
        out.write_all(&tiles.read(index)?.to_bytes(&task.label(index)))?;
    }
    out.flush()
}

/// The file at `out`, if it holds this `part` of the map that `task` makes.
///
/// # Errors
/// [`FileError::Input`]: it holds another part of this map, since the parts need a file each.
/// Anything else is replaced, as with every output.
pub fn find(out: &Path, part: MapPart, task: &Task) -> Result<Option<PartFile>, FileError> {
    let there = PartFile::open(out, &task.program).ok();
    match there.filter(|there| there.is_of(task) && there.part.count == part.count) {
        Some(there) if there.part != part => {
            let reason = format!(
                "holds part {} of this map, which part {part} would replace; \
                 expected another --out for each part",
                there.part
            );
            Err(FileError::input(out, reason))
        }
        same => Ok(same),
    }
}

impl PartFile {
    /// Reads the header of the file at `path`, and checks that the file has its length.
    ///
    /// # Errors
    /// [`FileError::Input`]: the file cannot be read, is not a part, is damaged, or was made by
    /// another build than this `program`.
    pub fn open(path: &Path, program: &str) -> Result<Self, FileError> {
        let unreadable = |error: io::Error| unreadable(path, &error);
        // A pipe would block whoever opens it.
        let length = match fs::metadata(path).map_err(unreadable)? {
            metadata if metadata.is_file() => metadata.len(),
            _ => return Err(FileError::input(path, format!("is not a regular file; {EXPECTED}"))),
        };
        let mut start = Vec::new();
        let file = File::open(path).map_err(unreadable)?;
        file.take(MOST_HEADER).read_to_end(&mut start).map_err(unreadable)?;
        if !start.starts_with(TITLE.as_bytes()) {
            return Err(FileError::input(path, format!("is not a part of a map; {EXPECTED}")));
        }
        let damaged = || FileError::input(path, format!("is damaged in its header; {EXPECTED}"));
        let (header, begin) = header(&start).ok_or_else(damaged)?;
        let Origin { task, part } = serde_json::from_str(header).map_err(|_| damaged())?;
        let (theirs, ours) = (task.lines().next().unwrap_or(""), Task::beginning(program));
        if theirs != ours {
            let reason = format!(
                "was made by another build, with '{theirs}' where this one has '{ours}'; \
                 expected all parts, and stickslip join, by one build"
            );
            return Err(FileError::input(path, reason));
        }
        let part = MapPart::parse(&part).map_err(|_| damaged())?;
        let Header { grid, engine, .. } = serde_json::from_str(header).map_err(|_| damaged())?;
        if !(1..=Size::MOST).contains(&grid.points()) {
            return Err(damaged());
        }
        let description = task;
        let file =
            Self { path: path.to_owned(), part, task: Task::new(grid, engine, program), begin };
        if file.task.description != description {
            return Err(damaged());
        }
        let expected = begin + file.task.bytes_of(&file.tiles());
        if length == expected {
            Ok(file)
        } else {
            Err(file.damaged(&format!("it has {length} of {expected} bytes")))
        }
    }

    /// Whether it is a part of the map that `task` makes.
    fn is_of(&self, task: &Task) -> bool {
        self.task.description == task.description
    }

    /// Refuses this part unless it and the part `first` can be joined.
    ///
    /// # Errors
    /// [`FileError::Input`]: it belongs to another map, or the map was divided otherwise.
    pub fn require_beside(&self, first: &Self) -> Result<(), FileError> {
        let other = first.path.display();
        let (ours, theirs) = difference(&self.task.description, &first.task.description);
        let reason = if ours != theirs {
            format!(
                "is a part of another map than {other}, with '{ours}' where that has '{theirs}'; \
                 expected the parts of one map"
            )
        } else if self.part.count != first.part.count {
            format!(
                "is part {} where {other} is part {}; expected the same number of parts in all",
                self.part, first.part
            )
        } else {
            return Ok(());
        };
        Err(FileError::input(&self.path, reason))
    }

    /// Refuses this part unless it has the same results as `other`, which is the same part.
    ///
    /// # Errors
    /// [`FileError::Input`]: it has other results, or a tile cannot be read.
    pub fn require_same(&self, other: &Self) -> Result<(), FileError> {
        for index in self.tiles() {
            let [ours, theirs] = [self, other].map(|file| {
                let bytes = file.bytes(index);
                bytes.map_err(|error| unreadable(&file.path, &error))
            });
            if ours? != theirs? {
                let reason = format!(
                    "is part {} like {}, with other content; expected each part once",
                    self.part,
                    other.path.display()
                );
                return Err(FileError::input(&self.path, reason));
            }
        }
        Ok(())
    }

    /// The failure to use this file, because it is not what was written.
    pub fn damaged(&self, how: &str) -> FileError {
        let reason = format!(
            "is damaged: {how}; expected the file as it was written, or made again with --part {}",
            self.part
        );
        FileError::input(&self.path, reason)
    }

    /// The bytes of a tile, as they are in the file.
    fn bytes(&self, index: usize) -> io::Result<Vec<u8>> {
        let begin = self.begin + self.task.bytes_of(&(self.tiles().start..index));
        let length = Tile::length(&self.task.label(index), self.task.range(index).len());
        let mut bytes = vec![0; length];
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

impl Stored for PartFile {
    fn task(&self) -> &Task {
        &self.task
    }

    fn tiles(&self) -> Range<usize> {
        self.part.share(self.task.tiles())
    }

    fn read(&self, index: usize) -> io::Result<Tile> {
        let (label, points) = (self.task.label(index), self.task.range(index).len());
        let tile = Tile::from_bytes(&self.bytes(index)?, &label, points);
        tile.ok_or_else(|| io::Error::other(format!("tile {index} is not what was written")))
    }

    fn unreadable(&self, error: &io::Error) -> FileError {
        self.damaged(&error.to_string())
    }
}

/// The JSON at the `start` of a file, and where the tiles begin, unless it is damaged.
fn header(start: &[u8]) -> Option<(&str, u64)> {
    let json = &start[TITLE.len()..];
    let end = TITLE.len() + json.iter().position(|byte| *byte == b'\n')? + 1;
    let label = str::from_utf8(&start[..end]).ok()?;
    let length = Tile::length(label, 0);
    Tile::from_bytes(start.get(..length)?, label, 0)?;
    Some((&label[TITLE.len()..], length as u64))
}

/// A tile without points, whose bytes are a label and its checksum.
fn empty() -> Tile {
    Tile { eps_t: Vec::new(), switch_count: Vec::new() }
}
