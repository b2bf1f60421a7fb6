//! A CSV file of collisions, read in portions.
//!
//! Start reading here; then, in this order: `columns` (which of them have a meaning), `portions`
//! (the text of whole rows) and `scan` (where a row begins, and what no CSV file has).

mod columns;
mod portions;
mod scan;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use rayon::prelude::*;
use stickslip_model::Contact;

use crate::error::Failure;
use crate::input::recipe::{Given, Recipe};
use crate::input::source::{self, Source};
pub use columns::Columns;
use portions::{Portion, Portions};

/// Largest number of rows in a portion.
const ROWS: usize = 16_384;
/// The number of rows that are read as one piece of work.
const ROWS_AT_ONCE: usize = 1024;

/// A CSV file of collisions. Its header has been read.
pub struct Input {
    path: PathBuf,
    /// The size of the file in bytes, if it is known.
    size: Option<u64>,
    portions: Portions<Box<dyn Read + Send>>,
    header: ByteRecord,
    recipe: Recipe,
}

/// One row of the file.
#[derive(Clone, Debug)]
pub struct Row {
    /// The fields, as many as the header has.
    pub fields: ByteRecord,
    /// The collision, or the reason why the row does not give one.
    pub contact: Result<Contact, String>,
}

impl Input {
    /// Opens `path`, or standard input if it is `-`, and reads the header.
    ///
    /// # Errors
    /// [`Failure::Input`]: the file cannot be read or is empty, or its columns do not make a
    /// collision together with the values `given` as options.
    pub fn open(path: &Path, given: &Given, columns: &Columns) -> Result<Self, Failure> {
        let Source { bytes, size } = source::open(path)?;
        let path = source::shown(path);
        let mut portions = Portions::new(bytes);
        let mut header = ByteRecord::new();
        let first = portions.next(1).map_err(|error| unreadable(path, &error))?;
        first.records().read(&mut header);
        let recipe =
            columns.recipe(&header, given).map_err(|reason| Failure::input(path, reason))?;
        Ok(Self { path: path.to_owned(), size, portions, header, recipe })
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
    pub fn read_portion(&mut self, rows: &mut Vec<Row>) -> Result<(), Failure> {
        let portion = self.portions.next(ROWS).map_err(|error| unreadable(&self.path, &error))?;
        let blank = || Row { fields: ByteRecord::new(), contact: Err(String::new()) };
        rows.resize_with(portion.rows(), blank);
        let (columns, recipe) = (self.header.len(), &self.recipe);
        let parts = portion.parts(ROWS_AT_ONCE);
        rows.par_chunks_mut(ROWS_AT_ONCE).zip(parts).for_each(|(rows, part)| {
            read_rows(&part, rows, columns, recipe);
        });
        Ok(())
    }
}

/// Reads the rows of `part` into `rows`, by the `recipe` for so many columns.
fn read_rows(part: &Portion, rows: &mut [Row], columns: usize, recipe: &Recipe) {
    let mut records = part.records();
    for Row { fields, contact } in rows {
        let line = records.read(fields).unwrap_or_default();
        let read = read_contact(fields, columns, recipe);
        *contact = read.map_err(|reason| format!("line {line}: {reason}"));
        if fields.len() != columns {
            let blanks = std::iter::repeat(&[] as &[u8]);
            *fields = fields.iter().chain(blanks).take(columns).collect();
        }
    }
}

fn read_contact(fields: &ByteRecord, columns: usize, recipe: &Recipe) -> Result<Contact, String> {
    if fields.len() != columns {
        let found = fields.len();
        return Err(format!(
            "{found} fields; expected one for each column of the header, {columns}"
        ));
    }
    // The recipe's columns are columns of the header.
    recipe.contact(|column| &fields[column]).map_err(|error| error.to_string())
}

fn unreadable(path: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        // The scan says by itself what is wrong, and where.
        io::ErrorKind::InvalidData => Failure::input(path, error),
        _ => source::unreadable(path, error),
    }
}
