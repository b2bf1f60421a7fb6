//! A CSV file of collisions, read in portions.
//!
//! Start reading here; then, in this order: `columns` (which of them have a meaning) and `lines`
//! (on which line a row begins).

mod columns;
mod lines;

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use stickslip_model::Contact;

use crate::error::Failure;
use crate::input::recipe::{Given, Recipe};
pub use columns::Columns;
use lines::CountedFile;

/// A CSV file of collisions. Its header has been read.
#[derive(Debug)]
pub struct Input {
    path: PathBuf,
    reader: csv::Reader<CountedFile>,
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

    /// Opens `path` and reads the header.
    ///
    /// # Errors
    /// [`Failure::Input`]: the file cannot be read or is empty, or its columns do not make a
    /// collision together with the values `given` as options.
    pub fn open(path: &Path, given: &Given, columns: &Columns) -> Result<Self, Failure> {
        let unreadable =
            |error: io::Error| Failure::input(path, format!("cannot be read: {error}"));
        let file = File::open(path).map_err(unreadable)?;
        let mut reader =
            csv::ReaderBuilder::new().flexible(true).from_reader(CountedFile::new(file));
        let header = reader.byte_headers().map_err(|e| unreadable(e.into()))?.clone();
        let recipe =
            columns.recipe(&header, given).map_err(|reason| Failure::input(path, reason))?;
        Ok(Self { path: path.to_owned(), reader, header, recipe })
    }

    /// The names of the columns.
    pub fn header(&self) -> &ByteRecord {
        &self.header
    }

    /// The size of the file and the part of it that has been read, in bytes.
    pub fn progress(&self) -> (u64, u64) {
        (self.reader.get_ref().size(), self.reader.position().byte())
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
        let start = self.reader.position().clone();
        let mut fields = ByteRecord::new();
        let more = self.reader.read_byte_record(&mut fields).map_err(|error| {
            let error = io::Error::from(error);
            Failure::input(&self.path, format!("line {}: cannot be read: {error}", start.line()))
        })?;
        if !more {
            return Ok(None);
        }
        let end = self.reader.position().byte();
        let line = start.line() + self.reader.get_mut().consume(start.byte(), end);
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
