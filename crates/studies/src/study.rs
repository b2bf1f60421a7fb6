//! What a study results in: numbers for programs, tables for spreadsheets, pictures and sentences for
//! people.

use serde_json::Value;
use stickslip_figure::Svg;

/// The result of a study.
#[derive(Debug)]
pub struct Study {
    /// The stem of its JSON file.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// What was found, a sentence with its numbers each.
    pub findings: Vec<String>,
    /// All numbers, in an object; its file has the title, the findings and what the other files
    /// hold besides.
    pub json: Value,
    /// The same as tables.
    pub tables: Vec<Table>,
    /// The same as pictures.
    pub pictures: Vec<Picture>,
}

/// Rows of values.
#[derive(Clone, Debug)]
pub struct Table {
    /// The stem of its CSV file.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, with a value for each column.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// What it holds, with the unit.
    pub meaning: &'static str,
}

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number; NaN is written as nothing.
    Number(f64),
    /// A count.
    Count(u64),
    /// Words.
    Text(String),
}

/// A picture with what a reader needs to understand it.
#[derive(Debug)]
pub struct Picture {
    /// The stem of its file.
    pub name: &'static str,
    /// What it shows.
    pub caption: String,
    /// The picture itself.
    pub svg: Svg,
}

impl Cell {
    /// As it stands in JSON; NaN becomes null.
    #[must_use]
    pub fn json(&self) -> Value {
        match self {
            Self::Number(value) => Value::from(*value),
            Self::Count(count) => Value::from(*count),
            Self::Text(text) => Value::from(text.as_str()),
        }
    }

    /// As it stands in a file: numbers in the shortest form that reads back exactly.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::Number(value) if value.is_nan() => String::new(),
            Self::Number(value) => format!("{value:?}"),
            Self::Count(count) => count.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

impl Table {
    /// The table as JSON: an object a row, with the names of the columns.
    #[must_use]
    pub fn json(&self) -> Value {
        let object = |row: &Vec<Cell>| {
            let names = self.columns.iter().map(|column| column.name.to_owned());
            Value::Object(names.zip(row.iter().map(Cell::json)).collect())
        };
        self.rows.iter().map(object).collect()
    }
}
