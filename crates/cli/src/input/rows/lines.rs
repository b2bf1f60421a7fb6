//! On which line of a CSV file a row begins.

use std::fs::File;
use std::io::{self, Read};

/// A file that remembers the bytes which the CSV reader has not yet made into rows.
///
/// The reader's position before a row may lie before blank lines, or between the two bytes of a
/// line end. The bytes tell on which line the row really begins.
#[derive(Debug)]
pub struct CountedFile {
    file: File,
    /// What has been read since `start`.
    bytes: Vec<u8>,
    start: u64,
}

impl CountedFile {
    pub fn new(file: File) -> Self {
        Self { file, bytes: Vec::new(), start: 0 }
    }

    /// The size of the file in bytes.
    pub fn size(&self) -> u64 {
        self.file.metadata().map_or(0, |metadata| metadata.len())
    }

    /// Forgets everything before byte `to`. Returns the number of line ends that precede the row
    /// which the reader found after byte `from`.
    pub fn consume(&mut self, from: u64, to: u64) -> u64 {
        let offset = |position: u64| {
            let offset = usize::try_from(position.saturating_sub(self.start));
            offset.map_or(self.bytes.len(), |offset| offset.min(self.bytes.len()))
        };
        let (from, to_offset) = (offset(from), offset(to));
        let ends = self.bytes[from..to_offset].iter().take_while(|b| matches!(b, b'\r' | b'\n'));
        let count = ends.filter(|byte| **byte == b'\n').count();
        self.bytes.drain(..to_offset);
        self.start = self.start.max(to);
        count as u64
    }
}

impl Read for CountedFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.bytes.extend_from_slice(&buffer[..count]);
        Ok(count)
    }
}
