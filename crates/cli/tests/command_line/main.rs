//! The program as its users meet it: run as a process, judged by its output and exit code.

mod batch;
mod batch_failures;
mod impact;
mod impact_failures;
mod point;
mod usage;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::cargo::cargo_bin_cmd;
use tempfile::TempDir;

/// What a run left behind.
struct Ran {
    code: i32,
    stdout: String,
    stderr: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the program prints UTF-8");
        Self {
            code: output.status.code().expect("the program is not killed"),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }
}

/// Runs `stickslip` with the arguments in `line`, separated by blanks.
fn stickslip(line: &str) -> Ran {
    stickslip_in(Path::new("."), line)
}

/// The same in a directory.
fn stickslip_in(directory: &Path, line: &str) -> Ran {
    let output = cargo_bin_cmd!("stickslip")
        .current_dir(directory)
        .args(line.split_whitespace())
        .output()
        .expect("the program starts");
    Ran::from(output)
}

/// A directory for a batch.
struct Workspace(TempDir);

impl Workspace {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary directory"))
    }

    /// One with the file `in.csv`.
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

    /// All names in the directory, hidden ones too.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the directory is there");
        let name = |entry: std::io::Result<fs::DirEntry>| {
            entry.expect("an entry").file_name().into_string().expect("a name in UTF-8")
        };
        let mut names: Vec<_> = entries.map(name).collect();
        names.sort();
        names
    }
}

/// The rows of a CSV text, header included.
fn rows(csv: &str) -> Vec<Vec<String>> {
    csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(csv.as_bytes())
        .records()
        .map(|record| record.expect("rows of equal length").iter().map(str::to_owned).collect())
        .collect()
}

/// The cases of a file of reference values.
fn reference(name: &str) -> Vec<serde_json::Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data").join(name);
    let text = fs::read_to_string(path).expect("reference data");
    let file: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    file["cases"].as_array().expect("cases").clone()
}

/// A decimal string of the reference data.
fn decimal(value: &serde_json::Value) -> f64 {
    value.as_str().expect("a string").parse().expect("a number")
}
