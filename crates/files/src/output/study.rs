//! The files of a study.

use std::path::Path;

use serde_json::{Map, Value, json};
use stickslip_figure::pictures::studies::Picture;
use stickslip_studies::{Cell, Study, StudyTable};

use super::file::write;
use crate::error::FileError;

/// Writes all files of `study` and its `pictures` into `directory`, each of them at once or not at
/// all.
///
/// # Errors
/// [`FileError::Output`]: a file cannot be written.
pub fn write_study(study: &Study, pictures: &[Picture], directory: &Path) -> Result<(), FileError> {
    for table in &study.tables {
        write(&directory.join(format!("{}.csv", table.name)), &csv(table))?;
    }
    for picture in pictures {
        let path = directory.join(format!("{}.svg", picture.name));
        write(&path, picture.svg.document().as_bytes())?;
    }
    let mut json = study.json.clone();
    if let Value::Object(fields) = &mut json {
        fields.insert("title".to_owned(), study.title.into());
        fields.insert("findings".to_owned(), study.findings.clone().into());
        fields.insert("files".to_owned(), files(study, pictures));
    }
    let json = format!("{json:#}\n");
    write(&directory.join(format!("{}.json", study.name)), json.as_bytes())
}

/// A description of the files beside the JSON file.
fn files(study: &Study, pictures: &[Picture]) -> Value {
    let tables = study.tables.iter().map(|table| {
        let columns = table.columns.iter();
        let columns: Map<_, _> =
            columns.map(|column| (column.name.to_owned(), column.meaning.into())).collect();
        (format!("{}.csv", table.name), json!({ "title": table.title, "columns": columns }))
    });
    let pictures = pictures
        .iter()
        .map(|picture| (format!("{}.svg", picture.name), json!({ "caption": picture.caption })));
    tables.chain(pictures).collect::<Map<_, _>>().into()
}

/// A table as a CSV file.
fn csv(table: &StudyTable) -> Vec<u8> {
    let header = table.columns.iter().map(|column| column.name.to_owned()).collect();
    let rows = table.rows.iter().map(|row| row.iter().map(Cell::text).collect());
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in std::iter::once::<Vec<String>>(header).chain(rows) {
        // Writing to memory cannot fail. If a row is longer or shorter than the header, it is
        // missing in the file.
        let _ = writer.write_record(&row);
    }
    writer.into_inner().unwrap_or_default()
}
