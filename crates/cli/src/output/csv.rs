//! CSV files, and numbers in them.

use std::path::Path;

use csv::{Writer, WriterBuilder};

use super::file::{OutputFile, StoredFile};
use crate::error::Failure;

/// The shortest digits that read back as `value`.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A CSV file that is being written.
pub struct CsvFile(Writer<OutputFile>);

impl CsvFile {
    /// Starts to write `path`.
    ///
    /// # Errors
    /// [`Failure::Output`]: the file cannot be created.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let file = OutputFile::create(path)?;
        Ok(Self(WriterBuilder::new().flexible(true).from_writer(file)))
    }

    /// Writes rows.
    ///
    /// # Errors
    /// [`Failure::Output`]: they cannot be written.
    pub fn write(
        &mut self,
        rows: impl FnOnce(&mut Writer<OutputFile>) -> csv::Result<()>,
    ) -> Result<(), Failure> {
        let written = rows(&mut self.0);
        written.map_err(|error| self.0.get_ref().failure(error))
    }

    /// Whether it is a pipe that nobody reads any more.
    pub fn is_unheard(&self) -> bool {
        self.0.get_ref().is_unheard()
    }

    /// The file with all rows.
    ///
    /// # Errors
    /// [`Failure::Output`]: the file cannot be stored.
    pub fn store(mut self) -> Result<StoredFile, Failure> {
        if let Err(error) = self.0.flush() {
            return Err(self.0.get_ref().failure(error));
        }
        match self.0.into_inner() {
            Ok(file) => file.store(),
            Err(failed) => {
                let error = failed.error().kind();
                Err(failed.into_inner().get_ref().failure(error))
            }
        }
    }
}
