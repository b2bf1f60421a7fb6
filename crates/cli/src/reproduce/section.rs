//! What a part of the report hands out.

use std::path::Path;

use crate::error::Failure;
use crate::study::{self, Study};

/// A study with what else the page needs.
#[derive(Debug)]
pub struct Section {
    /// What was computed.
    pub study: Study,
    /// The names of its tables that stand on the page.
    pub shown: Vec<&'static str>,
    /// Files beside those of the study.
    pub files: Vec<DataFile>,
    /// What speaks against its results.
    pub objections: Vec<Failure>,
}

/// A file of data.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub title: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

impl From<Study> for Section {
    fn from(study: Study) -> Self {
        Self { study, shown: Vec::new(), files: Vec::new(), objections: Vec::new() }
    }
}

impl Section {
    /// The names of all files with data, and what they hold.
    pub fn data(&self) -> Vec<(String, &str)> {
        let tables = self.study.tables.iter();
        let tables = tables.map(|table| (format!("{}.csv", table.name), table.title.as_str()));
        let files = self.files.iter().map(|file| (file.name.clone(), file.title.as_str()));
        tables.chain(files).collect()
    }

    /// Writes all files into `directory`, each at once or not at all.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<(), Failure> {
        for file in &self.files {
            study::write(&directory.join(&file.name), &file.bytes)?;
        }
        self.study.write(directory)
    }
}
