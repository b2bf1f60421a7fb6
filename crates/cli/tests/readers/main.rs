//! Files that are damaged at random, a fixed number of times. Each is read or refused, and nothing
//! else happens. The fuzz targets (`fuzz/`) check the same for as long as they run.

#![cfg(in_repository)]

#[path = "checks.rs"]
#[allow(dead_code, reason = "a fuzz target uses the rest")]
mod checks;

use std::fs;
use std::path::Path;
use std::process::Command;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::{RngAlgorithm, TestError, TestRng, TestRunner};

/// Texts that are inserted: parts of numbers, CSV and JSON.
const TOKENS: [&str; 28] = [
    "0",
    "-",
    "1e400",
    "1e-400",
    "/",
    ".",
    "e",
    "inf",
    "NaN",
    "null",
    "true",
    "\"",
    ",",
    "\n",
    "\r\n",
    "{",
    "}",
    "[",
    "]",
    ":",
    "\\u0000",
    "\u{feff}",
    "é",
    "\0",
    "kappa",
    "psi",
    "ratio",
    "{\"schema\":\"stickslip.atlas/1\"}",
];

/// A change of a file at a place.
#[derive(Clone, Debug)]
enum Edit {
    Insert(Index, &'static str),
    Replace(Index, &'static str),
    Delete(Index, usize),
    Repeat(Index, usize),
    Set(Index, u8),
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let (at, token) = (any::<Index>, || select(TOKENS.to_vec()));
    let edit = prop_oneof![
        (at(), token()).prop_map(|(at, token)| Edit::Insert(at, token)),
        (at(), token()).prop_map(|(at, token)| Edit::Replace(at, token)),
        (at(), 1_usize..20).prop_map(|(at, count)| Edit::Delete(at, count)),
        (at(), 1_usize..40).prop_map(|(at, count)| Edit::Repeat(at, count)),
        (at(), any::<u8>()).prop_map(|(at, byte)| Edit::Set(at, byte)),
    ];
    vec(edit, 0..6)
}

fn edited(seed: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for edit in edits {
        if bytes.is_empty() {
            break;
        }
        let size = bytes.len();
        match edit {
            Edit::Insert(at, token) => {
                let at = at.index(size);
                bytes.splice(at..at, token.bytes());
            }
            Edit::Replace(at, token) => {
                let at = at.index(size);
                bytes.splice(at..size.min(at + token.len()), token.bytes());
            }
            Edit::Delete(at, count) => {
                let at = at.index(size);
                bytes.drain(at..size.min(at + count));
            }
            Edit::Repeat(at, count) => {
                let at = at.index(size);
                bytes.extend_from_within(at..size.min(at + count));
            }
            Edit::Set(at, byte) => bytes[at.index(size)] = *byte,
        }
    }
    bytes
}

/// Checks `seed`, and `seed` with random changes, which are the same every time.
fn hold(cases: u32, seed: &[u8], check: impl Fn(&[u8]) -> Result<(), String>) {
    check(seed).unwrap();
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let ran = TestRunner::new_with_rng(config, rng)
        .run(&edits(), |edits| check(&edited(seed, &edits)).map_err(TestCaseError::fail));
    if let Err(TestError::Fail(reason, edits)) = ran {
        panic!("{reason}\nminimal: {:?}", String::from_utf8_lossy(&edited(seed, &edits)));
    }
}

fn repository(path: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)).unwrap()
}

#[test]
fn batches() {
    // Fuzzing found this name, which would have broken the message that shows it.
    checks::batch(b"\"a\nb\",psi\n1,1\n").unwrap();
    hold(2000, &repository("fuzz/seeds/batch/quoted.csv"), checks::batch);
}

#[test]
fn atlases() {
    hold(1000, &repository("fuzz/seeds/atlas/small.json"), checks::atlas);
}

/// An impact is printed, so that this test starts processes.
#[test]
fn impacts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("in.json");
    for name in ["steel_spheres", "glass_on_wall"] {
        hold(150, &repository(&format!("examples/{name}.json")), |json| {
            fs::write(&path, json).map_err(|error| error.to_string())?;
            let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
            let ran = command.args(["impact", "--format", "json"]).arg(&path).output().unwrap();
            let (out, said) = (ran.stdout, String::from_utf8_lossy(&ran.stderr));
            let printed = serde_json::from_slice::<serde_json::Value>(&out);
            let fits = match ran.status.code() {
                Some(0) => {
                    said.is_empty() && printed.is_ok() && !out.windows(4).any(|w| w == b"null")
                }
                Some(1 | 2) => {
                    out.is_empty() && said.starts_with("error: ") && said.lines().count() == 1
                }
                _ => false,
            };
            if fits { Ok(()) } else { Err(format!("{:?}: {said}", ran.status)) }
        });
    }
}
