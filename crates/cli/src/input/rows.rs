//! A CSV file of collisions, read in portions.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use csv::ByteRecord;
use stickslip_model::Contact;

use crate::error::Failure;
use crate::input::parameter::Parameter;
use crate::input::recipe::{Given, Recipe, RecipeError};
use crate::output::rows::{LOCATED, RESULTS};

/// A CSV file of collisions, open after its header.
#[derive(Debug)]
pub struct Input {
    path: PathBuf,
    reader: csv::Reader<Window>,
    header: ByteRecord,
    recipe: Recipe,
}

/// Which columns have a meaning.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Parameters that are read; other columns pass through.
    parameters: &'static [Parameter],
    /// Whether options may stand for them.
    options: bool,
    /// Names that the results have.
    results: &'static [&'static str],
}

impl Columns {
    /// Those of a file of collisions.
    pub const COLLISIONS: Self = Self {
        parameters: &[
            Parameter::Kappa,
            Parameter::Psi,
            Parameter::Ratio,
            Parameter::Mu,
            Parameter::Alpha,
            Parameter::Damping,
        ],
        options: true,
        results: &RESULTS,
    };
    /// Those of a file of points (κ, ψ) that are located.
    pub const POINTS: Self =
        Self { parameters: &[Parameter::Kappa, Parameter::Psi], options: false, results: &LOCATED };
}

/// One row of the file.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its fields, as many as the header has.
    pub fields: ByteRecord,
    /// The collision, or why the row holds none.
    pub contact: Result<Contact, String>,
}

impl Input {
    /// Most rows of a portion.
    const ROWS: usize = 4096;
    /// A portion ends when its collisions have about this many switches, 200 MB: memory stays
    /// bounded where a single collision has a million.
    const SWITCHES: f64 = 4e6;

    /// Opens `path` and reads the header.
    ///
    /// # Errors
    /// [`Failure::Input`]: the file cannot be read, is empty, or its columns do not make a
    /// collision together with the values `given` as options.
    pub fn open(path: &Path, given: &Given, columns: &Columns) -> Result<Self, Failure> {
        let unreadable =
            |error: io::Error| Failure::input(path, format!("cannot be read: {error}"));
        let file = File::open(path).map_err(unreadable)?;
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(Window::new(file));
        let header = reader.byte_headers().map_err(|e| unreadable(e.into()))?.clone();
        let recipe =
            recipe(&header, given, columns).map_err(|reason| Failure::input(path, reason))?;
        Ok(Self { path: path.to_owned(), reader, header, recipe })
    }

    /// The names of the columns.
    pub fn header(&self) -> &ByteRecord {
        &self.header
    }

    /// Size of the file and the part of it that has been read, in bytes.
    pub fn progress(&self) -> (u64, u64) {
        let length = self.reader.get_ref().file.metadata().map_or(0, |metadata| metadata.len());
        (length, self.reader.position().byte())
    }

    /// Reads the next portion into `rows`; empty at the end of the file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read_portion(&mut self, rows: &mut Vec<Row>) -> Result<(), Failure> {
        rows.clear();
        let mut switches = 0.0;
        while rows.len() < Self::ROWS && switches < Self::SWITCHES {
            let Some(row) = self.read_row()? else { break };
            // Without damping the count grows as √κ t_c/π.
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

/// A file that remembers what the CSV reader has not yet made into rows.
///
/// The reader's position before a row may lie before blank lines, or between the two bytes of a
/// line end; the bytes tell on which line the row really starts.
#[derive(Debug)]
struct Window {
    file: File,
    /// What has been read since `start`.
    bytes: Vec<u8>,
    start: u64,
}

impl Window {
    fn new(file: File) -> Self {
        Self { file, bytes: Vec::new(), start: 0 }
    }

    /// Forgets everything before byte `to`; the number of line ends that precede the row which
    /// the reader found after byte `from`.
    fn consume(&mut self, from: u64, to: u64) -> u64 {
        let offset = |position: u64| {
            let offset = usize::try_from(position.saturating_sub(self.start));
            offset.map_or(self.bytes.len(), |offset| offset.min(self.bytes.len()))
        };
        let (from, to_offset) = (offset(from), offset(to));
        let ends = self.bytes[from..to_offset].iter().take_while(|b| matches!(b, b'\r' | b'\n'));
        let count = ends.filter(|byte| **byte == b'\n').count();
        self.bytes.drain(..to_offset);
        self.start = self.start.max(to);
        count as u64
    }
}

impl Read for Window {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.bytes.extend_from_slice(&buffer[..count]);
        Ok(count)
    }
}

/// The recipe that the columns of `header` make, together with the values given as options.
fn recipe(header: &ByteRecord, given: &Given, columns: &Columns) -> Result<Recipe, String> {
    if header.is_empty() {
        return Err("is empty; expected a header row, for example kappa,psi".to_owned());
    }
    let names: Vec<&[u8]> = header.iter().map(<[u8]>::trim_ascii).collect();
    for (index, name) in names.iter().enumerate() {
        let shown = String::from_utf8_lossy(name);
        if names[..index].contains(name) {
            return Err(format!("two columns are named '{shown}'; expected different names"));
        }
        if columns.results.iter().any(|result| result.as_bytes() == *name) {
            return Err(format!(
                "column {shown} has the name of a result; expected names other than {}",
                columns.results.join(", ")
            ));
        }
    }
    let column = |parameter: Parameter| {
        let place = names.iter().position(|name| *name == parameter.name().as_bytes());
        place.filter(|_| columns.parameters.contains(&parameter))
    };
    Recipe::new(given, column).map_err(|error| {
        let problem = if columns.options {
            explain(error)
        } else {
            "kappa or psi is missing; expected columns kappa and psi".to_owned()
        };
        format!("{problem}; the columns are: {}", String::from_utf8_lossy(&names.join(&b", "[..])))
    })
}

/// What is wrong with the columns.
fn explain(error: RecipeError) -> String {
    match error {
        RecipeError::NoKappa => "kappa is missing; expected a column kappa or --kappa".to_owned(),
        RecipeError::NoImpact => {
            "psi and ratio are missing; expected exactly one of them, as a column or an option"
                .to_owned()
        }
        RecipeError::PsiAndRatio => {
            "psi and ratio are both given; expected exactly one of them, as a column or an \
             option"
                .to_owned()
        }
        RecipeError::GivenTwice { name } => {
            format!("the column {name} and --{name} are both given; expected one of them")
        }
        RecipeError::Unused { name } => {
            format!("--{name} has no effect with psi; accepted with ratio only")
        }
    }
}
