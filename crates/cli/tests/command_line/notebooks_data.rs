//! The data for notebooks. The commands in their README files make them, every column is described,
//! and the notebooks find what they read.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Array, Workspace, audit, converge, npz, reproduce, rows};

/// Relative tolerance of numbers. On the machine that made the data all bits are the same, whatever
/// the optimisation, but for the last one of a power (`powi`). Other machines have other
/// mathematical libraries.
const RELATIVE: f64 = 1e-9;

/// Absolute tolerances of numbers that are differences of larger numbers, by the beginning of the
/// file's name.
const ABSOLUTE: [(&str, f64); 12] = [
    ("asymptote_collisions", 1e-9),
    ("asymptote_convergence", 1e-10),
    ("asymptote_counts", 0.0),
    ("asymptote_envelope", 0.0),
    ("asymptote_profile", 1e-12),
    ("asymptote_restitution", 0.0),
    ("atlas", 1e-9),
    // These are slopes through errors of 1e-14.
    ("convergence_orders", 1e-2),
    ("convergence", 1e-12),
    ("figure4_boundaries", 1e-9),
    ("figure", 1e-10),
    ("statements", 1e-9),
];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A document without its digests, which change with the last digit of any number.
fn without_digests(text: &str) -> String {
    text.split_once(",\"digests\":{").map_or(text.to_owned(), |(fields, _)| format!("{fields}}}\n"))
}

fn names(directory: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(directory).expect("a directory");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    entries.map(|entry| name(entry).into_string().expect("UTF-8")).collect()
}

fn extension(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(_, extension)| extension)
}

/// The files that the commands of a folder make.
struct Remade {
    folder: PathBuf,
    /// Where commands that are not run for other tests too write.
    workspace: Workspace,
    /// The directory that the commands call `out`.
    out: PathBuf,
    /// Standard output that goes to a file, by the name of the file.
    printed: BTreeMap<String, String>,
}

impl Remade {
    /// Runs the commands in the folder's README, or takes what they made for other tests.
    fn new(name: &str) -> Self {
        let folder = repository().join("notebooks-data").join(name);
        let workspace = Workspace::new();
        for directory in [format!("notebooks-data/{name}"), "examples".to_owned()] {
            fs::create_dir_all(workspace.path(&directory)).expect("a directory");
        }
        let bodies = "examples/steel_pair.json";
        fs::copy(repository().join(bodies), workspace.path(bodies)).expect("the example");
        let mut printed = BTreeMap::new();
        let mut out = workspace.path("out");
        let readme = read(&folder.join("README.md"));
        let lines: Vec<_> = readme
            .lines()
            .filter_map(|line| line.strip_prefix("cargo run --release -- "))
            .collect();
        assert!(!lines.is_empty());
        for line in lines {
            let (line, _) = line.split_once(" && ").unwrap_or((line, ""));
            let (command, target) = line.split_once(" > ").unwrap_or((line, ""));
            let stdout = match command {
                "reproduce --out out" => {
                    out = reproduce::RUN.path("out");
                    String::new()
                }
                _ if command.starts_with("trace --kappa 0.05:100 --psi 0.01:3 --out ") => {
                    out = reproduce::ATLAS.path(".");
                    String::new()
                }
                "converge --out out" => {
                    out = converge::USUAL.0.path("new/study");
                    String::new()
                }
                _ if command.starts_with("reproduce --statement") => audit::PRINTED.clone(),
                _ => {
                    let ran = workspace.run(command);
                    assert_eq!(ran.code, 0, "{line}: {}", ran.stderr);
                    ran.stdout
                }
            };
            if let Some((_, name)) = target.rsplit_once('/') {
                printed.insert(name.to_owned(), stdout);
            }
        }
        Self { folder, workspace, out, printed }
    }

    /// The path at which a command has written the file.
    fn path(&self, name: &str) -> PathBuf {
        let direct = self.workspace.path("notebooks-data");
        let direct = direct.join(self.folder.file_name().expect("a name")).join(name);
        if direct.exists() { direct } else { self.out.join(name) }
    }

    /// Compares all files of the folder, and looks for their columns in its README.
    fn check(&self) {
        let readme = read(&self.folder.join("README.md"));
        for name in names(&self.folder).iter().filter(|name| *name != "README.md") {
            let stored = self.folder.join(name);
            let (_, absolute) = ABSOLUTE
                .iter()
                .find(|(start, _)| name.starts_with(start))
                .unwrap_or_else(|| panic!("no tolerance for {name}"));
            let described = |column: &str| {
                assert!(readme.contains(&format!("`{column}`")), "{name}: {column}");
            };
            if extension(name) == "npz" {
                let [ours, theirs] = [&stored, &self.path(name)].map(|path| npz(path));
                for (array, _) in &ours {
                    described(array);
                }
                compare_arrays(&ours, &theirs, *absolute);
                continue;
            }
            let ours = read(&stored);
            let theirs = self.printed.get(name).cloned().unwrap_or_else(|| read(&self.path(name)));
            let [ours, theirs] = [&ours, &theirs].map(|text| without_digests(text));
            if let Err(difference) = compare(&ours, &theirs, *absolute) {
                panic!("{name}: {difference}");
            }
            if extension(name) == "csv" {
                for column in &rows(&ours)[0] {
                    described(column);
                }
            }
        }
    }
}

/// Compares arrays. Doubles may differ by the tolerance, everything else is the same.
fn compare_arrays(one: &[(String, Array)], other: &[(String, Array)], absolute: f64) {
    assert_eq!(one.len(), other.len());
    for ((name, ours), (other, theirs)) in one.iter().zip(other) {
        assert_eq!((name, &ours.shape), (other, &theirs.shape));
        if ours.element == "<i4" {
            assert!(ours.integers() == theirs.integers(), "{name}");
            continue;
        }
        if ours.is_text() {
            // The program that made the data may have been built for another machine.
            assert!(name == "version" || ours.text() == theirs.text(), "{name}");
            continue;
        }
        for (ours, theirs) in ours.doubles().into_iter().zip(theirs.doubles()) {
            assert!(close(ours, theirs, absolute), "{name}: {ours} {theirs}");
        }
    }
}

fn close(one: f64, other: f64, absolute: f64) -> bool {
    (one - other).abs() <= absolute + RELATIVE * one.abs().max(other.abs())
}

/// Compares texts. Numbers with a point or an exponent may differ by the tolerance, everything else
/// is the same.
fn compare(one: &str, other: &str, absolute: f64) -> Result<(), String> {
    if one.lines().count() != other.lines().count() {
        return Err(format!("{} and {} lines", one.lines().count(), other.lines().count()));
    }
    for (number, (one, other)) in (1..).zip(one.lines().zip(other.lines())) {
        let [one, other] = [one, other].map(tokens);
        let same = one.len() == other.len() && one.iter().zip(&other).all(|(one, other)| {
            let real = |token: &str| {
                token.contains(['.', 'e']).then(|| token.parse::<f64>().ok()).flatten()
            };
            one == other
                || matches!((real(one), real(other)), (Some(a), Some(b)) if close(a, b, absolute))
        });
        if !same {
            let different = one.iter().zip(&other).find(|(one, other)| one != other);
            return Err(format!("line {number}: {different:?}"));
        }
    }
    Ok(())
}

/// A line, divided into what may be numbers and what is between them.
fn tokens(line: &str) -> Vec<&str> {
    line.split_inclusive([',', ' ', '[', ']', '"', ';'])
        .flat_map(|part| {
            let cut = part.len() - usize::from(part.ends_with([',', ' ', '[', ']', '"', ';']));
            let (token, separator) = part.split_at(cut);
            // The number may be at the end of a sentence.
            let (token, end) = token.split_at(token.trim_end_matches(['.', ':', ')']).len());
            [token, end, separator]
        })
        .collect()
}

#[test]
fn commands_make_the_figures() {
    Remade::new("figures").check();
}

#[test]
fn a_command_makes_the_boundaries() {
    Remade::new("boundaries").check();
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_command_makes_the_study_of_convergence() {
    Remade::new("convergence").check();
}

#[test]
fn a_command_makes_the_study_of_stiff_springs() {
    Remade::new("stiff_springs").check();
}

#[test]
fn a_command_makes_the_statements() {
    Remade::new("statements").check();
}

#[test]
fn there_is_no_other_folder() {
    let folders = ["boundaries", "convergence", "figures", "statements", "stiff_springs"];
    let all = folders.iter().chain(&["README.md", "make.sh"]).map(|name| (*name).to_owned());
    assert_eq!(names(&repository().join("notebooks-data")), all.collect());
}

#[test]
fn a_dropped_column_and_a_changed_number_are_noticed() {
    let text = "kappa,w,count,itinerary\n10.0,0.25,4,+o-\n1e3,-2.5e-7,12,o\n";
    assert_eq!(compare(text, text, 0.0), Ok(()));
    for (from, to, same) in [
        ("0.25", "0.2500000001", true),
        ("-2.5e-7", "-2.5000000001e-7", true),
        ("0.25", "0.250000001", false),
        ("-2.5e-7", "2.5e-7", false),
        ("0.25", "", false),
        (",4", ",5", false),
        (",12", ",12.0", false),
        ("+o-", "+o", false),
        ("w,", "", false),
        ("1e3,-2.5e-7,12,o\n", "", false),
    ] {
        assert_eq!(compare(text, &text.replace(from, to), 0.0).is_ok(), same, "{from} {to}");
    }
    assert!(compare("within 1.1e-15, it", "within 2.2e-15, it", 1e-9).is_ok());
    assert!(compare("up to 1.5.", "up to 1.6.", 1e-9).is_err());
    assert!(compare("[[1.0,2.0]]", "[[1.0,2.1]]", 1e-9).is_err());
}
