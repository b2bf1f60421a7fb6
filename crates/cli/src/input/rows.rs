//! A CSV file of collisions, read in portions.
//!
//! Start reading here; then, in this order: `columns` (which of them have a meaning) and `scan` (on
//! which line a row begins, and what no CSV file has).

mod columns;
mod scan;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use stickslip_model::Contact;

use crate::error::Failure;
use crate::input::recipe::{Given, Recipe};
use crate::input::source::{self, Source};
pub use columns::Columns;
use scan::Scanned;

/// A CSV file of collisions. Its header has been read.
pub struct Input {
    path: PathBuf,
    /// The size of the file in bytes, if it is known.
    size: Option<u64>,
    reader: csv::Reader<Scanned<Box<dyn Read>>>,
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
    /// Largest number of rows in a portion.
    const ROWS: usize = 4096;
    /// A portion ends when its collisions have about this many switches, which take 200 MB. Memory
    /// is then bounded even if a single collision has a million switches.
    const SWITCHES: f64 = 4e6;

    /// Opens `path`, or standard input if it is `-`, and reads the header.
    ///
    /// # Errors
    /// [`Failure::Input`]: the file cannot be read or is empty, or its columns do not make a
    /// collision together with the values `given` as options.
    pub fn open(path: &Path, given: &Given, columns: &Columns) -> Result<Self, Failure> {
        let Source { bytes, size } = source::open(path)?;
        let path = source::shown(path);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(Scanned::new(bytes));
        let header = reader.byte_headers().map_err(|error| unreadable(path, error))?;
        let header = header.clone();
        reader.get_mut().next_row();
        let recipe =
            columns.recipe(&header, given).map_err(|reason| Failure::input(path, reason))?;
        Ok(Self { path: path.to_owned(), size, reader, header, recipe })
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
        self.reader.position().byte()
    }

    /// Reads the next portion into `rows`. It is empty at the end of the file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read_portion(&mut self, rows: &mut Vec<Row>) -> Result<(), Failure> {
        rows.clear();
        let mut switches = 0.0;
        while rows.len() < Self::ROWS && switches < Self::SWITCHES {
            let Some(row) = self.read_row()? else { break };
            // Without damping the number of switches grows as √κ t_c/π.
            switches += row.contact.as_ref().map_or(0.0, |contact| contact.kappa().sqrt());
            rows.push(row);
        }
        Ok(())
    }

    fn read_row(&mut self) -> Result<Option<Row>, Failure> {
        let mut fields = ByteRecord::new();
        let more = self.reader.read_byte_record(&mut fields);
        if !more.map_err(|error| unreadable(&self.path, error))? {
            return Ok(None);
        }
        let line = self.reader.get_mut().next_row().unwrap_or_default();
        let contact = self.contact(&fields).map_err(|reason| format!("line {line}: {reason}"));
        if fields.len() != self.header.len() {
            let blanks = std::iter::repeat(&[] as &[u8]);
            fields = fields.iter().chain(blanks).take(self.header.len()).collect();
        }
        Ok(Some(Row { fields, contact }))
    }

    fn contact(&self, fields: &ByteRecord) -> Result<Contact, String> {
        if fields.len() != self.header.len() {
            return Err(format!(
                "{} fields; expected one for each column of the header, {}",
                fields.len(),
                self.header.len()
            ));
        }
        // The recipe's columns are columns of the header.
        self.recipe.contact(|column| &fields[column]).map_err(|error| error.to_string())
    }
}

fn unreadable(path: &Path, error: csv::Error) -> Failure {
    match error.into_kind() {
        // The scan says by itself what is wrong, and where.
        csv::ErrorKind::Io(error) if error.kind() == io::ErrorKind::InvalidData => {
            Failure::input(path, error)
        }
        csv::ErrorKind::Io(error) => source::unreadable(path, &error),
        // Rows of bytes have no other errors.
        other => Failure::input(path, format!("cannot be read: {other:?}")),
    }
}
