//! The program, run as a process and judged by its output and its exit code.
//!
//! The tests read data, examples and notebooks of the repository. In the published package there
//! are no tests here.

#![cfg(in_repository)]

mod asymptote;
mod atlas;
mod audit;
mod batch;
mod batch_failures;
mod collide;
mod completions;
mod converge;
mod courses;
mod exit_codes;
mod explore;
mod fit;
mod impact;
mod impact_batch;
mod impact_failures;
mod inside;
mod laws;
mod man;
mod map;
mod map_failures;
#[cfg(unix)]
mod map_interrupted;
mod notebooks_data;
mod option_lists;
mod orbits;
mod particle_codes;
mod parts;
mod parts_failures;
#[cfg(unix)]
mod parts_interrupted;
mod pictures;
mod plane;
mod reproduce;
mod run;
mod stack;
#[cfg(unix)]
mod streams;
mod table;
mod terms_of_laws;
mod timestep;
mod usage;
mod version;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::cargo::cargo_bin_cmd;
use tempfile::TempDir;

/// `signal`, or 15 where the tests themselves run with `signal` ignored: shells start background
/// jobs without interrupts, and children inherit that.
#[cfg(unix)]
fn heeded(signal: u32) -> u32 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    if ignored.unwrap_or(0) >> (signal - 1) & 1 == 1 { 15 } else { signal }
}

/// The exit code and the output of a run.
struct Ran {
    code: i32,
    stdout: String,
    /// Standard error without what was `said`.
    stderr: String,
    /// The line on standard error about what was found and written; empty if nothing was.
    said: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the program prints UTF-8");
        let all = text(output.stderr);
        let is_said = |line: &&str| line.starts_with("wrote ") || line.contains("; wrote ");
        let lines = || all.split_inclusive('\n');
        Self {
            code: output.status.code().expect("the program is not killed"),
            stdout: text(output.stdout),
            stderr: lines().filter(|line| !is_said(line)).collect(),
            said: lines().filter(is_said).collect(),
        }
    }
}

/// Runs `stickslip` with the arguments in `line`, separated by blanks.
fn stickslip(line: &str) -> Ran {
    stickslip_in(Path::new("."), line)
}

/// Runs `stickslip` in a directory with the arguments in `line`, separated by blanks.
fn stickslip_in(directory: &Path, line: &str) -> Ran {
    let output = cargo_bin_cmd!("stickslip")
        .current_dir(directory)
        .args(line.split_whitespace())
        .output()
        .expect("the program starts");
    Ran::from(output)
}

/// A temporary directory with the files of a test.
struct Workspace(TempDir);

impl Workspace {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary directory"))
    }

    /// A directory with the file `in.csv`.
    fn with_input(content: &str) -> Self {
        let workspace = Self::new();
        workspace.write("in.csv", content);
        workspace
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("the file is written");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("the file is there")
    }

    fn run(&self, line: &str) -> Ran {
        stickslip_in(self.0.path(), line)
    }

    /// All names in the directory, hidden names included.
    fn names(&self) -> Vec<String> {
        self.names_in(".")
    }

    /// All names in a directory inside this one.
    fn names_in(&self, directory: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(directory)).expect("the directory is there");
        let name = |entry: std::io::Result<fs::DirEntry>| {
            entry.expect("an entry").file_name().into_string().expect("a name in UTF-8")
        };
        let mut names: Vec<_> = entries.map(name).collect();
        names.sort();
        names
    }
}

/// The rows of a CSV text, the header included.
fn rows(csv: &str) -> Vec<Vec<String>> {
    csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(csv.as_bytes())
        .records()
        .map(|record| record.expect("rows of equal length").iter().map(str::to_owned).collect())
        .collect()
}

/// An array of a .npz file.
struct Array {
    /// Shape and type of the elements, as NumPy writes them.
    shape: String,
    element: String,
    data: Vec<u8>,
}

impl Array {
    fn doubles(&self) -> Vec<f64> {
        assert_eq!(self.element, "<f8");
        self.data.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
    }

    fn integers(&self) -> Vec<i32> {
        assert_eq!(self.element, "<i4");
        self.data.as_chunks().0.iter().map(|bytes| i32::from_le_bytes(*bytes)).collect()
    }

    fn is_text(&self) -> bool {
        self.element.starts_with("<U")
    }

    /// The text of an array without dimensions.
    fn text(&self) -> String {
        let characters = self.data.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
        let text: String = characters.map(|c| char::from_u32(c).expect("a character")).collect();
        assert_eq!(self.element, format!("<U{}", text.chars().count()));
        text
    }

    /// All elements, as a table shows them.
    fn fields(&self) -> Vec<String> {
        match self.element.as_str() {
            "<f8" => self.doubles().iter().map(|value| format!("{value:?}")).collect(),
            "<i4" => self.integers().iter().map(i32::to_string).collect(),
            _ => vec![self.text()],
        }
    }
}

/// What a map says about the program that made it.
fn version_in_maps() -> String {
    let text = stickslip("--version").stdout;
    let name = text.lines().next().expect("a name");
    let build = text.lines().find_map(|line| line.strip_prefix("built for ")).expect("a build");
    format!("{name}, {}", build.trim())
}

/// The arrays of a .npz file with their names, in order.
fn npz(path: &Path) -> Vec<(String, Array)> {
    let bytes = fs::read(path).expect("the file is there");
    let archive = rawzip::ZipArchive::from_slice(&bytes).expect("an archive");
    let entries = archive.entries().map(|entry| {
        let header = entry.expect("an entry");
        let name = String::from_utf8_lossy(header.file_path().as_bytes()).into_owned();
        let entry = archive.get_entry(header.wayfinder()).expect("its data");
        let mut data = Vec::new();
        let mut reader = entry.verifying_reader(entry.data());
        std::io::Read::read_to_end(&mut reader, &mut data).expect("the right checksum");
        (name.strip_suffix(".npy").expect("an array").to_owned(), array(&data))
    });
    entries.collect()
}

fn array(file: &[u8]) -> Array {
    assert_eq!(file[..8], *b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
    let (header, data) = file[10..].split_at(length);
    let header = std::str::from_utf8(header).expect("ASCII");
    let between = |start, end| header.split_once(start)?.1.split_once(end).map(|x| x.0.to_owned());
    Array {
        shape: between("'shape': (", ")").expect("a shape"),
        element: between("'descr': '", "'").expect("a type"),
        data: data.to_vec(),
    }
}

/// The list named `key`, `cases` or `boundaries`, of a file of reference values.
fn reference(name: &str, key: &str) -> Vec<serde_json::Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data").join(name);
    let text = fs::read_to_string(path).expect("reference data");
    let file: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    file[key].as_array().expect("a list").clone()
}

/// A decimal string of the reference data.
fn decimal(value: &serde_json::Value) -> f64 {
    value.as_str().expect("a string").parse().expect("a number")
}
