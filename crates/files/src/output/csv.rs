//! CSV files, and the text of their rows.

use std::io::Write;
use std::ops::Range;
use std::path::Path;

use super::file::{OutputFile, StoredFile};
use crate::error::FileError;

/// Sizes of numbers whose shortest digits [`ryu`] writes as [`f64`]'s `Debug` does. It has its own
/// rule for smaller ones.
const PLAIN: Range<f64> = 1e-4..f64::INFINITY;

/// The shortest digits that read back as `value`.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The number of bytes that rows keep when they are dropped.
const MOST_KEPT: usize = 1 << 20;

/// Rows of a CSV file as text.
#[derive(Debug, Default)]
pub struct Rows {
    text: Vec<u8>,
    /// Whether the present row has a field.
    begun: bool,
}

impl Rows {
    /// Drops all rows, and keeps the memory unless it is much.
    pub fn clear(&mut self) {
        self.text.clear();
        self.text.shrink_to(MOST_KEPT);
        self.begun = false;
    }

    /// Adds a field, in quotes if it needs them.
    pub fn field(&mut self, field: impl AsRef<[u8]>) {
        let field = field.as_ref();
        if field.iter().any(|byte| matches!(byte, b',' | b'"' | b'\r' | b'\n')) {
            self.separate();
            self.text.push(b'"');
            for part in field.split_inclusive(|byte| *byte == b'"') {
                self.text.extend_from_slice(part);
                self.text.extend(part.ends_with(b"\"").then_some(b'"'));
            }
            self.text.push(b'"');
        } else {
            self.plain(field);
        }
    }

    /// Adds several fields.
    pub fn fields<T: AsRef<[u8]>>(&mut self, fields: impl IntoIterator<Item = T>) {
        fields.into_iter().for_each(|field| self.field(field));
    }

    /// Adds a number with the shortest digits that read back as it, as [`number`] does.
    pub fn number(&mut self, value: f64) {
        if PLAIN.contains(&value.abs()) {
            self.plain(ryu::Buffer::new().format_finite(value).as_bytes());
        } else {
            self.plain(number(value).as_bytes());
        }
    }

    /// Adds a whole number.
    pub fn count(&mut self, count: impl itoa::Integer) {
        self.plain(itoa::Buffer::new().format(count).as_bytes());
    }

    /// Ends the row.
    pub fn end(&mut self) {
        self.text.push(b'\n');
        self.begun = false;
    }

    /// Adds a field that needs no quotes.
    fn plain(&mut self, field: &[u8]) {
        self.separate();
        self.text.extend_from_slice(field);
    }

    fn separate(&mut self) {
        if std::mem::replace(&mut self.begun, true) {
            self.text.push(b',');
        }
    }
}

/// A CSV file that is being written.
pub struct CsvFile {
    file: OutputFile,
    /// Rows that are not written yet.
    pub rows: Rows,
}

impl CsvFile {
    /// Starts to write `path`.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be created.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        Ok(Self { file: OutputFile::create(path)?, rows: Rows::default() })
    }

    /// Makes sure that `path` can be written.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be created.
    pub fn probe(path: &Path) -> Result<(), FileError> {
        OutputFile::create(path).map(drop)
    }

    /// Writes rows.
    ///
    /// # Errors
    /// [`FileError::Output`]: they cannot be written.
    pub fn write(&mut self, rows: &Rows) -> Result<(), FileError> {
        self.file.write_all(&rows.text).map_err(|error| self.file.failure(error))
    }

    /// Ends a row of [`Self::rows`], which are written when they are many.
    ///
    /// # Errors
    /// [`FileError::Output`]: they cannot be written.
    pub fn end(&mut self) -> Result<(), FileError> {
        self.rows.end();
        if self.rows.text.len() < MOST_KEPT { Ok(()) } else { self.flush() }
    }

    fn flush(&mut self) -> Result<(), FileError> {
        let mut rows = std::mem::take(&mut self.rows);
        self.write(&rows)?;
        rows.clear();
        self.rows = rows;
        Ok(())
    }

    /// Whether it is a pipe that nobody reads any more.
    pub fn is_unheard(&self) -> bool {
        self.file.is_unheard()
    }

    /// The file with all rows.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be stored.
    pub fn store(mut self) -> Result<StoredFile, FileError> {
        self.flush()?;
        self.file.store()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn text(write: impl FnOnce(&mut Rows)) -> Vec<u8> {
        let mut rows = Rows::default();
        write(&mut rows);
        rows.text
    }

    proptest! {
        #[test]
        fn numbers_have_their_shortest_digits(bits: u64, exponent in -25..25_i32, digits in 0..10_000_i32) {
            let short = f64::from(digits) * 10_f64.powi(exponent);
            for value in [f64::from_bits(bits), short, -short, 10_f64.powi(exponent)] {
                let written = String::from_utf8(text(|rows| rows.number(value))).unwrap();
                let expected = number(value);
                // Two shortest numbers may be equally near.
                let read = |text: &str| text.parse().map(f64::to_bits);
                let as_good =
                    written.len() == expected.len() && read(&written) == read(&expected);
                prop_assert!(written == expected || as_good, "{written} and {expected}");
            }
        }

        #[test]
        fn fields_read_back(fields: Vec<Vec<u8>>) {
            prop_assume!(fields.len() > 1);
            let written = text(|rows| { rows.fields(&fields); rows.end(); });
            let mut reader =
                csv::ReaderBuilder::new().has_headers(false).from_reader(&written[..]);
            let read = reader.byte_records().next().unwrap().unwrap();
            // A byte order mark at the start of a file is not part of the field.
            prop_assume!(!fields[0].starts_with(b"\xef\xbb\xbf"));
            prop_assert!(read.iter().eq(fields.iter().map(|field| &field[..])));
        }
    }

    #[test]
    fn fields_are_quoted_where_they_need_it() {
        let written = text(|rows| {
            rows.fields(["a", " b", "c,d", "e\"f", ""]);
            rows.count(17_usize);
            rows.end();
            rows.number(-0.0);
            rows.end();
        });
        assert_eq!(written, b"a, b,\"c,d\",\"e\"\"f\",,17\n-0.0\n");
    }
}
