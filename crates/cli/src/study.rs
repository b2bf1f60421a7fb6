//! What a study hands out: numbers for programs, tables for spreadsheets, pictures and sentences
//! for people.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::ThreadPoolBuilder;
use serde_json::{Map, Value, json};

use crate::error::Failure;
use crate::figure::Svg;
use crate::output::OutputFile;

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
    /// It.
    pub svg: Svg,
}

impl Cell {
    /// As it stands in JSON; NaN becomes null.
    pub fn json(&self) -> Value {
        match self {
            Self::Number(value) => Value::from(*value),
            Self::Count(count) => Value::from(*count),
            Self::Text(text) => Value::from(text.as_str()),
        }
    }

    /// As it stands in a file: numbers in the shortest form that reads back exactly.
    pub fn text(&self) -> String {
        match self {
            Self::Number(value) if value.is_nan() => String::new(),
            Self::Number(value) => format!("{value:?}"),
            Self::Count(count) => count.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

impl Study {
    /// Writes all files into `directory`, each at once or not at all.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<(), Failure> {
        for table in &self.tables {
            write(&directory.join(format!("{}.csv", table.name)), &table.csv())?;
        }
        for picture in &self.pictures {
            let path = directory.join(format!("{}.svg", picture.name));
            write(&path, picture.svg.document().as_bytes())?;
        }
        let mut json = self.json.clone();
        if let Value::Object(fields) = &mut json {
            fields.insert("title".to_owned(), self.title.into());
            fields.insert("findings".to_owned(), self.findings.clone().into());
            fields.insert("files".to_owned(), self.files());
        }
        let json = format!("{json:#}\n");
        write(&directory.join(format!("{}.json", self.name)), json.as_bytes())
    }

    /// What the files beside the JSON file hold.
    fn files(&self) -> Value {
        let tables = self.tables.iter().map(|table| {
            let columns = table.columns.iter();
            let columns: Map<_, _> =
                columns.map(|column| (column.name.to_owned(), column.meaning.into())).collect();
            (format!("{}.csv", table.name), json!({ "title": table.title, "columns": columns }))
        });
        let pictures = self.pictures.iter().map(|picture| {
            (format!("{}.svg", picture.name), json!({ "caption": picture.caption }))
        });
        tables.chain(pictures).collect::<Map<_, _>>().into()
    }
}

impl Table {
    /// The table as JSON: an object a row, with the names of the columns.
    pub fn json(&self) -> Value {
        let object = |row: &Vec<Cell>| {
            let names = self.columns.iter().map(|column| column.name.to_owned());
            Value::Object(names.zip(row.iter().map(Cell::json)).collect())
        };
        self.rows.iter().map(object).collect()
    }

    /// The table as a CSV file.
    fn csv(&self) -> Vec<u8> {
        let header = self.columns.iter().map(|column| column.name.to_owned()).collect();
        let rows = self.rows.iter().map(|row| row.iter().map(Cell::text).collect());
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in std::iter::once::<Vec<String>>(header).chain(rows) {
            // Writing to memory cannot fail, and a row of another length than the header's shows in
            // the file.
            let _ = writer.write_record(&row);
        }
        writer.into_inner().unwrap_or_default()
    }
}

/// Makes a study on `threads` threads, `None` being one for each core, writes its files into
/// `directory` and prints its findings.
///
/// # Errors
/// Files cannot be written, which is tried first, or `make` fails.
pub fn carry_out(
    directory: &Path,
    threads: Option<usize>,
    make: impl FnOnce(&ProgressBar) -> Result<Study, Failure> + Send,
) -> Result<(), Failure> {
    prepare(directory)?;
    let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build()?;
    // Shows itself on a terminal only.
    let style = ProgressStyle::with_template("{bar:25} {percent}%, {eta} left");
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let study = pool.install(|| make(&bar));
    bar.finish_and_clear();
    let study = study?;
    study.write(directory)?;
    let mut out = io::stdout().lock();
    Failure::unless_written(study.findings.iter().try_for_each(|line| writeln!(out, "{line}")))
}

/// Makes sure that files can be written into `directory`, before there is work to lose; creates it
/// where it is missing.
///
/// # Errors
/// It cannot be created or written.
pub fn prepare(directory: &Path) -> Result<(), Failure> {
    if directory.exists() && !directory.is_dir() {
        let directory = directory.display();
        return Err(Failure::Usage(format!(
            "--out {directory} is not a directory; expected a directory, or a name that is not taken"
        )));
    }
    let failure = |error| Failure::output(directory, error);
    fs::create_dir_all(directory).map_err(failure)?;
    OutputFile::create(&directory.join("probe")).map(drop).map_err(failure)
}

/// Writes a file at once or not at all.
///
/// # Errors
/// It cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = OutputFile::create(path).and_then(|mut file| {
        file.write_all(bytes)?;
        file.store()?;
        file.publish()
    });
    written.map_err(|error| Failure::output(path, error))
}
