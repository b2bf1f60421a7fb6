//! The result of a study: numbers for programs, tables for spreadsheets, sentences for people.
//!
//! All texts are written in the markup of `stickslip_figure::markup`.

use serde::Serialize;
use serde_json::{Value, json};

/// The result of a study.
#[derive(Debug)]
pub struct Study {
    /// The stem of the name of its JSON file.
    pub name: &'static str,
    /// The title of the study.
    pub title: &'static str,
    /// The main results, in sentences that stand alone: for the opening of a page on which there
    /// are several studies.
    pub headlines: Vec<String>,
    /// All results, in sentences with their numbers.
    pub findings: Vec<String>,
    /// All numbers, as an object. Its file also holds the title, the findings and the meaning of
    /// the other files.
    pub json: Value,
    /// The same numbers as tables.
    pub tables: Vec<StudyTable>,
}

/// Rows of values.
#[derive(Clone, Debug)]
pub struct StudyTable {
    /// The stem of the name of its CSV file.
    pub name: &'static str,
    /// What the table shows.
    pub title: String,
    /// The columns.
    pub columns: Vec<StudyColumn>,
    /// The rows, each with a value for every column.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StudyColumn {
    /// The name of the column in the header of a file.
    pub name: &'static str,
    /// What the column holds, with the unit.
    pub meaning: &'static str,
    heading: Option<&'static str>,
}

/// A value of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A number. NaN is an empty cell, and null in JSON.
    Number(f64),
    /// A count.
    Count(usize),
    /// Words.
    Text(String),
}

impl StudyColumn {
    /// A column for files.
    pub const fn new(name: &'static str, meaning: &'static str) -> Self {
        Self { name, meaning, heading: None }
    }

    /// A column of a table that is also shown on a page, with a heading of one to three words.
    pub const fn headed(name: &'static str, heading: &'static str, meaning: &'static str) -> Self {
        Self { name, meaning, heading: Some(heading) }
    }

    /// The heading of the column on a page: short, with the unit, in markup. Columns of tables that
    /// no page shows have only their name.
    pub const fn heading(&self) -> &'static str {
        match self.heading {
            Some(heading) => heading,
            None => self.name,
        }
    }
}

impl Cell {
    /// The value as it stands in a file. A number has the shortest form that reads back exactly.
    /// Text has no marks of code.
    pub fn text(&self) -> String {
        match self {
            Self::Number(value) if value.is_nan() => String::new(),
            Self::Number(value) => format!("{value:?}"),
            Self::Count(count) => count.to_string(),
            Self::Text(text) => text.replace('`', ""),
        }
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count)
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl StudyTable {
    /// The table as JSON: an object for each row, with the names of the columns.
    pub fn json(&self) -> Value {
        let names = || self.columns.iter().map(|column| column.name.to_owned());
        let values = |row: &Vec<Cell>| row.iter().map(|cell| json!(cell)).collect::<Vec<_>>();
        self.rows.iter().map(|row| Value::Object(names().zip(values(row)).collect())).collect()
    }
}
