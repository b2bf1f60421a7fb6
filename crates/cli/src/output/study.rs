//! The files of a study.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value, json};
use stickslip_studies::{Cell, Study, Table};

use super::file::{OutputFile, publish};
use crate::error::Failure;

/// Writes all files of `study` into `directory`, each at once or not at all.
///
/// # Errors
/// [`Failure::Output`]: a file cannot be written.
pub fn write_study(study: &Study, directory: &Path) -> Result<(), Failure> {
    for table in &study.tables {
        write(&directory.join(format!("{}.csv", table.name)), &csv(table))?;
    }
    for picture in &study.pictures {
        let path = directory.join(format!("{}.svg", picture.name));
        write(&path, picture.svg.document().as_bytes())?;
    }
    let mut json = study.json.clone();
    if let Value::Object(fields) = &mut json {
        fields.insert("title".to_owned(), study.title.into());
        fields.insert("findings".to_owned(), study.findings.clone().into());
        fields.insert("files".to_owned(), files(study));
    }
    let json = format!("{json:#}\n");
    write(&directory.join(format!("{}.json", study.name)), json.as_bytes())
}

/// What the files beside the JSON file hold.
fn files(study: &Study) -> Value {
    let tables = study.tables.iter().map(|table| {
        let columns = table.columns.iter();
        let columns: Map<_, _> =
            columns.map(|column| (column.name.to_owned(), column.meaning.into())).collect();
        (format!("{}.csv", table.name), json!({ "title": table.title, "columns": columns }))
    });
    let pictures = study
        .pictures
        .iter()
        .map(|picture| (format!("{}.svg", picture.name), json!({ "caption": picture.caption })));
    tables.chain(pictures).collect::<Map<_, _>>().into()
}

/// A table as a CSV file.
fn csv(table: &Table) -> Vec<u8> {
    let header = table.columns.iter().map(|column| column.name.to_owned()).collect();
    let rows = table.rows.iter().map(|row| row.iter().map(Cell::text).collect());
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in std::iter::once::<Vec<String>>(header).chain(rows) {
        // Writing to memory cannot fail, and a row of another length than the header's shows in the
        // file.
        let _ = writer.write_record(&row);
    }
    writer.into_inner().unwrap_or_default()
}

/// Makes sure that files can be written into `directory`, before there is work to lose; creates it
/// where it is missing.
///
/// # Errors
/// [`Failure::Usage`]: it is not a directory. [`Failure::Output`]: it cannot be created or written.
pub fn prepare(directory: &Path) -> Result<(), Failure> {
    if directory.exists() && !directory.is_dir() {
        let directory = directory.display();
        return Err(Failure::Usage(format!(
            "--out {directory} is not a directory; expected a directory, or a name that is not taken"
        )));
    }
    fs::create_dir_all(directory).map_err(|error| Failure::output(directory, error))?;
    // The user knows the directory, not the file that is tried.
    OutputFile::create_in(directory, &directory.join("probe")).map(drop).map_err(|failure| {
        match failure {
            Failure::Output { source, .. } => Failure::output(directory, source),
            other => other,
        }
    })
}

/// Writes a file at once or not at all.
///
/// # Errors
/// [`Failure::Output`]: it cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    publish([OutputFile::complete(path, bytes)?])
}
