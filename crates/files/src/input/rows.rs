//! A CSV file with a case in each row, read in portions.
//!
//! Start reading here; then, in this order: `columns` (those of a file of collisions), `portions`
//! (the text of whole rows) and `scan` (where a row begins, and what no CSV file has).

mod columns;
mod portions;
mod scan;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

pub use csv::ByteRecord;
use rayon::prelude::*;
use stickslip_model::Contact;

use crate::error::FileError;
use crate::input::recipe::Recipe;
use crate::input::source::{self, Source};
pub use columns::{Columns, TwoColumns, names};
use portions::{Portion, Portions};

/// Largest number of rows in a portion.
const ROWS: usize = 16_384;
/// The number of rows that are read as one piece of work.
const ROWS_AT_ONCE: usize = 1024;

/// How the fields of a row become what is computed.
pub trait Reading: Clone + Send + Sync {
    /// What is computed.
    type Case: Send + Sync;

    /// What the fields of a row mean, of which there is one for each column.
    ///
    /// # Errors
    /// What is wrong in which column, and what is expected.
    fn read(&mut self, fields: &ByteRecord) -> Result<Self::Case, String>;
}

impl Reading for Recipe {
    type Case = Contact;

    fn read(&mut self, fields: &ByteRecord) -> Result<Contact, String> {
        // The recipe's columns are columns of the header.
        self.contact(|column| &fields[column])
    }
}

/// A CSV file. Its header has been read, and decides how rows are read.
pub struct Input<R: Reading> {
    path: PathBuf,
    /// The size of the file in bytes, if it is known.
    size: Option<u64>,
    portions: Portions<Box<dyn Read + Send>>,
    header: ByteRecord,
    reading: R,
}

/// One row of the file.
#[derive(Clone, Debug)]
pub struct Row<C> {
    /// The fields, as many as the header has.
    pub fields: ByteRecord,
    /// What is computed, or the reason why the row does not give it.
    pub case: Result<C, String>,
}

impl<R: Reading> Input<R> {
    /// Opens `path`, or standard input if it is `-`, and reads the header, with which `reading`
    /// begins.
    ///
    /// # Errors
    /// [`FileError::Input`]: the file cannot be read, or `reading` refuses the header.
    pub fn open(
        path: &Path,
        reading: impl FnOnce(&ByteRecord) -> Result<R, String>,
    ) -> Result<Self, FileError> {
        let Source { bytes, size } = source::open(path)?;
        let path = source::shown(path);
        let mut portions = Portions::new(bytes);
        let mut header = ByteRecord::new();
        let first = portions.next(1).map_err(|error| unreadable(path, &error))?;
        first.records().read(&mut header);
        let reading = reading(&header).map_err(|reason| FileError::input(path, reason))?;
        Ok(Self { path: path.to_owned(), size, portions, header, reading })
    }

    /// The names of the columns.
    pub fn header(&self) -> &ByteRecord {
        &self.header
    }

    /// The size of the file in bytes, if it is known.
    pub fn size(&self) -> Option<u64> {
        self.size
    }

    /// How many bytes have been read.
    pub fn position(&self) -> u64 {
        self.portions.position()
    }

    /// Reads the next portion into `rows`, on all threads of the present pool. It is empty at the
    /// end of the file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read_portion(&mut self, rows: &mut Vec<Row<R::Case>>) -> Result<(), FileError> {
        let portion = self.portions.next(ROWS).map_err(|error| unreadable(&self.path, &error))?;
        let blank = || Row { fields: ByteRecord::new(), case: Err(String::new()) };
        rows.resize_with(portion.rows(), blank);
        let (columns, reading) = (self.header.len(), &self.reading);
        let parts = portion.parts(ROWS_AT_ONCE);
        rows.par_chunks_mut(ROWS_AT_ONCE).zip(parts).for_each(|(rows, part)| {
            read_rows(&part, rows, columns, reading.clone());
        });
        Ok(())
    }
}

/// Reads the rows of `part` into `rows`, which have so many columns.
fn read_rows<R: Reading>(
    part: &Portion,
    rows: &mut [Row<R::Case>],
    columns: usize,
    mut reading: R,
) {
    let mut records = part.records();
    for Row { fields, case } in rows {
        let line = records.read(fields).unwrap_or_default();
        let read = match fields.len() {
            found if found == columns => reading.read(fields),
            found => Err(format!(
                "{found} fields; expected one for each column of the header, {columns}"
            )),
        };
        *case = read.map_err(|reason| format!("line {line}: {reason}"));
        if fields.len() != columns {
            let blanks = std::iter::repeat(&[] as &[u8]);
            *fields = fields.iter().chain(blanks).take(columns).collect();
        }
    }
}

fn unreadable(path: &Path, error: &io::Error) -> FileError {
    match error.kind() {
        // The scan says by itself what is wrong, and where.
        io::ErrorKind::InvalidData => FileError::input(path, error),
        _ => source::unreadable(path, error),
    }
}
