//! CSV text, read in portions of whole rows.

use std::io::{self, Read};

use super::scan::{Begin, Scan};

/// The number of bytes that are read at once.
const BYTES: usize = 1 << 16;
/// A portion has at most about so many bytes, and at least one row.
const MOST_BYTES: usize = 1 << 24;

/// A source of CSV text.
pub struct Portions<R> {
    source: R,
    scan: Scan,
    ended: bool,
    /// What has been read and is not used yet; it begins with this byte of the source.
    text: Vec<u8>,
    offset: u64,
    /// The rows that begin in `text`.
    begins: Vec<Begin>,
    /// The rows that have been handed out.
    used: usize,
}

/// The text of some rows.
#[derive(Clone, Copy, Debug)]
pub struct Portion<'a> {
    text: &'a [u8],
    begins: &'a [Begin],
}

impl<R: Read> Portions<R> {
    /// Nothing has been read yet.
    pub fn new(source: R) -> Self {
        let (text, begins) = (Vec::new(), Vec::new());
        Self { source, scan: Scan::new(), ended: false, text, offset: 0, begins, used: 0 }
    }

    /// The next rows, at most `rows`. There are none at the end.
    ///
    /// # Errors
    /// The source cannot be read, or is not a CSV file of a sensible size.
    pub fn next(&mut self, rows: usize) -> io::Result<Portion<'_>> {
        let used = self.begins.get(self.used).map_or(self.text.len(), |next| self.place(next));
        self.text.drain(..used);
        self.offset += used as u64;
        self.begins.drain(..self.used);
        // A row is whole when the next one begins.
        let enough = |text: &[u8], begins: &[Begin]| {
            begins.len() > rows || (begins.len() > 1 && text.len() >= MOST_BYTES)
        };
        while !(self.ended || enough(&self.text, &self.begins)) {
            let read = self.text.len();
            self.text.resize(read + BYTES, 0);
            let count = self.source.read(&mut self.text[read..]);
            self.text.truncate(read + count.as_ref().map_or(0, |count| *count));
            self.ended = match count {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => false,
                count => count? == 0,
            };
            self.scan.take(&self.text[read..], &mut self.begins)?;
        }
        if self.ended {
            self.scan.end(&mut self.begins)?;
        }
        let whole = if self.ended { self.begins.len() } else { self.begins.len() - 1 };
        self.used = whole.min(rows);
        let begins = &self.begins[..self.used];
        let end = self.begins.get(self.used).map_or(self.text.len(), |next| self.place(next));
        let start = begins.first().map_or(end, |first| self.place(first));
        Ok(Portion { text: &self.text[start..end], begins })
    }

    /// The number of bytes that have been read.
    pub fn position(&self) -> u64 {
        self.offset + self.text.len() as u64
    }

    /// The place in `text` where a row begins.
    fn place(&self, begin: &Begin) -> usize {
        place(begin, self.offset)
    }
}

/// The place of a row in a text that begins with the byte `offset` of the source.
#[expect(clippy::cast_possible_truncation, reason = "it is a place in a text in memory")]
fn place(begin: &Begin, offset: u64) -> usize {
    (begin.byte - offset) as usize
}

impl Portion<'_> {
    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.begins.len()
    }

    /// Parts of `rows` rows each, but for the last one.
    pub fn parts(&self, rows: usize) -> Vec<Self> {
        let offset = self.begins.first().map_or(0, |first| first.byte);
        let starts = self.begins.chunks(rows).map(|begins| place(&begins[0], offset));
        let ends = starts.clone().skip(1).chain([self.text.len()]);
        let parts = self.begins.chunks(rows).zip(starts.zip(ends));
        parts.map(|(begins, (start, end))| Self { text: &self.text[start..end], begins }).collect()
    }

    /// The rows with the lines on which they begin.
    pub fn records(&self) -> Records<'_> {
        // A mark at the start of what a reader gets would be dropped. A blank line is not a row.
        let text = b"\n".chain(self.text);
        let mut reader = csv::ReaderBuilder::new();
        let reader = reader.has_headers(false).flexible(true).from_reader(text);
        Records { reader, begins: self.begins.iter() }
    }
}

/// The rows of a portion.
pub struct Records<'a> {
    reader: csv::Reader<io::Chain<&'a [u8], &'a [u8]>>,
    begins: std::slice::Iter<'a, Begin>,
}

impl Records<'_> {
    /// Reads the next row into `fields` and returns the line on which it begins.
    pub fn read(&mut self, fields: &mut csv::ByteRecord) -> Option<u64> {
        let begin = self.begins.next()?;
        // Reading rows of bytes from memory has no errors.
        self.reader.read_byte_record(fields).is_ok_and(|read| read).then_some(begin.line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives few bytes at a time.
    struct Trickle<'a>(&'a [u8], usize);

    impl Read for Trickle<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(self.0.len()).min(buffer.len());
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn portions_of_any_size_have_the_same_rows() {
        let text = b"\xef\xbb\xbfa,b\r\n\r\n1,\"x\r\ny\"\n\xef\xbb\xbf2,\"\"\"\"\n\n\n,\r3,4";
        let expected: [(u64, [&[u8]; 2]); 5] = [
            (1, [b"a", b"b"]),
            (3, [b"1", b"x\r\ny"]),
            (5, [b"\xef\xbb\xbf2", b"\""]),
            (8, [b"", b""]),
            (9, [b"3", b"4"]),
        ];
        for (bytes, rows) in (1..8).flat_map(|bytes| (1..7).map(move |rows| (bytes, rows))) {
            let mut portions = Portions::new(Trickle(text, bytes));
            let mut found = Vec::new();
            loop {
                let portion = portions.next(rows).unwrap();
                if portion.rows() == 0 {
                    break;
                }
                for part in portion.parts(2) {
                    let (mut records, mut fields) = (part.records(), csv::ByteRecord::new());
                    while let Some(line) = records.read(&mut fields) {
                        found.push((line, fields.clone()));
                    }
                }
            }
            let expected = expected.map(|(line, fields)| (line, fields.into_iter().collect()));
            assert_eq!(found, expected, "{bytes} bytes, {rows} rows");
        }
    }
}
