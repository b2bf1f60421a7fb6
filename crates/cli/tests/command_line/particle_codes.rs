//! The page for users of particle codes: all of its commands run, and print what it says.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::Workspace;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// What takes long on the page, and as little as shows that the command runs.
const SHORTER: [(&str, &str); 3] = [
    ("--size 300x200", "--size 30x20"),
    ("--kappa 1:20 ", "--kappa 1:6 "),
    ("--out laws", "--out laws --cells 12"),
];

/// The commands of the page, each with the lines that it prints there.
fn commands(page: &str) -> Vec<(String, Vec<String>)> {
    let mut commands: Vec<(String, Vec<String>)> = Vec::new();
    for block in page.split("```console\n").skip(1) {
        let block = block.split("```").next().unwrap_or_default();
        for line in block.lines() {
            match line.strip_prefix("$ ") {
                Some(command) => commands.push((command.to_owned(), Vec::new())),
                None if line == "…" => {}
                None => commands.last_mut().expect("a command").1.push(line.to_owned()),
            }
        }
    }
    commands
}

#[test]
fn quick_commands_of_the_page_run() {
    let quick = ["map", "trace", "fit"].map(|name| format!("stickslip {name} "));
    run(|command| quick.iter().any(|name| command.starts_with(name)));
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn every_command_of_the_page_runs() {
    let workspace = run(|_| true);
    // The gases have lost energy, the one with the constant more.
    if has_compiler() {
        let last = |name: &str| {
            let text = workspace.read(name);
            let line = text.lines().last().expect("a line").to_owned();
            line.split(',').nth(2).and_then(|cell| cell.parse::<f64>().ok()).expect("an energy")
        };
        let (table, constant) = (last("table.csv"), last("constant.csv"));
        assert!(constant < table && table < 1e-3, "{table} {constant}");
    }
}

fn has_compiler() -> bool {
    Command::new("cc").arg("--version").output().is_ok()
}

/// Runs those of the commands that are chosen, in a workspace with the examples.
fn run(chosen: impl Fn(&str) -> bool) -> Workspace {
    let workspace = Workspace::new();
    let folder = workspace.path("examples");
    fs::create_dir_all(&folder).expect("a folder");
    for entry in fs::read_dir(Path::new(ROOT).join("examples")).expect("the examples") {
        let path = entry.expect("an example").path();
        if path.is_file() {
            fs::copy(&path, folder.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
    let page = fs::read_to_string(Path::new(ROOT).join("docs/particle-codes.md")).expect("a page");
    let commands = commands(&page);
    assert!(commands.len() >= 9, "{commands:?}");
    let has_compiler = has_compiler();
    let program = Path::new(env!("CARGO_BIN_EXE_stickslip")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    for (command, expected) in commands {
        if !chosen(&command) || !command.starts_with("stickslip ") && !has_compiler {
            continue;
        }
        let shorter = SHORTER.iter().fold(command.clone(), |line, (long, short)| {
            assert!(page.contains(long), "{long}");
            line.replace(long, short)
        });
        let ran = Command::new("sh")
            .args(["-c", &shorter])
            .env("PATH", &path)
            .current_dir(workspace.path("."))
            .output()
            .expect("a shell");
        let stderr = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{command}: {stderr}");
        let printed = String::from_utf8_lossy(&ran.stdout);
        for line in expected {
            assert!(printed.contains(&line), "{command}: {line}: {printed}");
        }
    }
    workspace
}
