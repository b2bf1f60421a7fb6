//! Tells the program what it is built from and for, which `--version` shows. The same sources,
//! target and compiler give the same text. Also tells the tests whether the data that they read
//! exist.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The sources of the program, relative to this package in the repository.
const SOURCES: [&str; 20] = [
    "src",
    "build.rs",
    "templates",
    "../contact/src",
    "../exact/src",
    "../expression/src",
    "../figure/assets",
    "../figure/src",
    "../files/src",
    "../model/src",
    "../number/src",
    "../orbits/src",
    "../page/explorer.html",
    "../plane/src",
    "../practice/src",
    "../reproduction/src",
    "../studies/src",
    "../solver/src",
    "../tracer/src",
    "../../Cargo.lock",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(in_repository)");
    if Path::new("../../tests/data/README.md").exists() {
        println!("cargo::rustc-cfg=in_repository");
    }
    let variable = |name| env::var(name).unwrap_or_default();
    let commit = packaged_commit().or_else(repository_commit);
    tell("COMMIT", commit.as_deref().unwrap_or("not known"));
    tell("TARGET", &variable("TARGET"));
    tell("FEATURES", &variable("CARGO_CFG_TARGET_FEATURE").replace(',', " "));
    let flags = variable("CARGO_ENCODED_RUSTFLAGS");
    let processor =
        flags.split('\x1f').filter_map(|flag| flag.split_once("target-cpu=")).next_back();
    tell("PROCESSOR", processor.map_or("least of the target", |(_, name)| name));
    tell("COMPILER", &output(&variable("RUSTC"), &["--version"]).unwrap_or_default());
    tell("PROFILE", &format!("{}, opt-level {}", variable("PROFILE"), variable("OPT_LEVEL")));
}

/// Gives the program a text under the name `STICKSLIP_{name}`.
fn tell(name: &str, value: &str) {
    println!("cargo::rustc-env=STICKSLIP_{name}={value}");
}

/// The commit that `cargo package` recorded.
fn packaged_commit() -> Option<String> {
    let text = fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let commit = text.split_once("\"sha1\": \"")?.1.split_once('"')?.0;
    Some(marked(commit, text.contains("\"dirty\": true")))
}

/// The commit of the repository, if this package is part of it and was not merely unpacked inside
/// it.
fn repository_commit() -> Option<String> {
    git(&["ls-files", "--error-unmatch", "Cargo.toml"])?;
    let commit = git(&["rev-parse", "HEAD"])?;
    let branch = git(&["rev-parse", "--symbolic-full-name", "HEAD"])?;
    // If a path does not exist, the script would run every time.
    let state = ["HEAD", "logs/HEAD", &branch];
    let state = state.into_iter().filter_map(|name| git(&["rev-parse", "--git-path", name]));
    for path in state.chain(SOURCES.map(str::to_owned)).filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    let status = ["status", "--porcelain", "--"];
    let changes = git(&[&status[..], &SOURCES].concat())?;
    Some(marked(&commit, !changes.is_empty()))
}

/// `commit`, marked if the sources differ from it.
fn marked(commit: &str, changed: bool) -> String {
    format!("{commit}{}", if changed { ", with changes" } else { "" })
}

fn git(arguments: &[&str]) -> Option<String> {
    output("git", &[&["--no-optional-locks"], arguments].concat())
}

/// What `program` prints, if it succeeds.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim_end().to_owned())
}
