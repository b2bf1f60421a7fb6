//! CSV files of measured impacts.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use stickslip_practice::fit::{self, Datum, FitSettings, MeasuredColumn};

use super::{number, source};
use crate::error::FileError;

/// Largest number of bytes of a file.
const MOST_BYTES: u64 = 1 << 22;
/// The column that is not read.
const COMMENT: &str = "comment";

/// The data in the file at `path`, or in standard input if it is `-`. Rows have the numbers of
/// their lines.
///
/// # Errors
/// [`FileError::Input`]: the file cannot be read, or does not describe measured impacts.
pub fn read(path: &Path, speed: Option<f64>, scaled: bool) -> Result<Vec<Datum>, FileError> {
    let text = source::read(path, MOST_BYTES)?;
    let failed = |reason: String| FileError::input(source::shown(path), reason);
    let (columns, lines) = columns(&text).map_err(failed)?;
    fit::data(&columns, &lines, speed, scaled).map_err(|invalid| failed(invalid.to_string()))
}

/// The columns of a text, and the lines of its rows.
fn columns(text: &[u8]) -> Result<(Vec<MeasuredColumn>, Vec<usize>), String> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text);
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    if header.is_empty() {
        let example = "for example centre_impact_angle_deg,centre_e_t";
        return Err(format!("is empty; expected a header row, {example}"));
    }
    let column = |name: &str| MeasuredColumn { name: name.to_owned(), values: Vec::new() };
    let mut columns: Vec<MeasuredColumn> = header.iter().map(column).collect();
    let mut lines = Vec::new();
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| error.to_string())? {
        let line = record.position().map_or(0, csv::Position::line);
        lines.push(usize::try_from(line).unwrap_or(usize::MAX));
        if lines.len() > FitSettings::MOST_DATA {
            return Err(format!("has too many rows; expected at most {}", FitSettings::MOST_DATA));
        }
        for (column, cell) in columns.iter_mut().zip(&record) {
            let blank = cell.is_empty() || column.name == COMMENT;
            let value = (!blank).then(|| number::parse(cell)).transpose();
            column.values.push(value.map_err(|problem| {
                let name = &column.name;
                let expected = format!("expected a finite number, {}, or nothing", number::SYNTAX);
                format!("line {line}: {name} = '{cell}' is {problem}; {expected}")
            })?);
        }
    }
    if lines.is_empty() {
        return Err("has no rows; expected measured impacts".to_owned());
    }
    columns.retain(|column| column.name != COMMENT);
    Ok((columns, lines))
}
