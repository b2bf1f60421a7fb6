//! Standard input and output in the place of files, pipes whose reader goes away, full disks, and
//! signals.

use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Output, Stdio};

use assert_cmd::cargo::cargo_bin;

use crate::{Ran, Workspace, heeded};

const ROWS: &str = "kappa,psi\n18,0.5\n63,1\n";

fn stickslip(workspace: &Workspace, line: &str) -> Command {
    let mut command = Command::new(cargo_bin!("stickslip"));
    command.args(line.split_whitespace()).current_dir(workspace.path(""));
    command
}

/// Runs with `input` as standard input.
fn with_input(workspace: &Workspace, line: &str, input: &[u8]) -> Ran {
    let mut command = stickslip(workspace, line);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let mut pipe = child.stdin.take().expect("a pipe");
    // A program that refuses its arguments does not read.
    let _ = pipe.write_all(input);
    drop(pipe);
    Ran::from(child.wait_with_output().expect("an end"))
}

#[test]
fn a_batch_from_standard_input_is_that_from_a_file() {
    let workspace = Workspace::with_input(ROWS);
    assert_eq!(workspace.run("collide --batch in.csv --out file.csv").code, 0);
    let ran = with_input(&workspace, "collide --batch - --out out.csv", ROWS.as_bytes());
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.read("out.csv"), workspace.read("file.csv"));
    let ran = with_input(&workspace, "collide --batch - --out /dev/stdout", ROWS.as_bytes());
    assert_eq!((ran.code, ran.stdout), (0, workspace.read("file.csv")));
    let bad = with_input(&workspace, "collide --batch - --out out.csv", b"kappa\n18\n");
    assert_eq!(bad.code, 2);
    assert!(bad.stderr.starts_with("error: standard input: "), "{}", bad.stderr);
    let both = with_input(&workspace, "locate --atlas - --batch - --out out.csv", b"");
    assert!(both.code == 2 && both.stderr.contains("--atlas - and --batch -"), "{}", both.stderr);
}

#[test]
fn a_named_pipe_is_read_as_a_file() {
    let workspace = Workspace::new();
    assert!(Command::new("mkfifo").arg(workspace.path("pipe")).status().unwrap().success());
    let line = "collide --batch pipe --out out.csv --events ev.csv";
    let child = stickslip(&workspace, line).stderr(Stdio::piped()).spawn().unwrap();
    fs::write(workspace.path("pipe"), ROWS).unwrap();
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.read("out.csv").lines().count(), 3);
}

/// A shell writes a line before the program and one after it into the same file.
#[test]
fn standard_output_is_written_where_it_stands() {
    let workspace = Workspace::with_input(ROWS);
    assert_eq!(workspace.run("collide --batch in.csv --out file.csv").code, 0);
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        let mut all = File::create(workspace.path("all")).unwrap();
        all.write_all(b"# head\n").unwrap();
        let out = all.try_clone().unwrap();
        let line = format!("collide --batch in.csv --out {name}");
        assert!(stickslip(&workspace, &line).stdout(out).status().unwrap().success());
        all.write_all(b"# tail\n").unwrap();
        let expected = format!("# head\n{}# tail\n", workspace.read("file.csv"));
        assert_eq!(workspace.read("all"), expected, "{name}");
    }
}

#[test]
fn a_reader_that_goes_away_has_seen_enough() {
    let many = format!("kappa,psi\n{}", "18,0.5\n".repeat(50_000));
    let workspace = Workspace::with_input(&many);
    for (line, written) in [
        ("collide --batch in.csv --method exact --out /dev/stdout", None),
        ("collide --batch in.csv --method exact --out out.csv --events /dev/stdout", Some(50_001)),
    ] {
        let mut command = stickslip(&workspace, line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        assert!(first.contains("psi") || first.starts_with("case,"), "{first}");
        let ran = Ran::from(child.wait_with_output().unwrap());
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
        // The other file is complete.
        if let Some(lines) = written {
            assert_eq!(workspace.read("out.csv").lines().count(), lines);
        }
    }
}

/// Command lines that write to standard output.
const WRITING: [&str; 5] = [
    "--help",
    "--version",
    "collide --help",
    "collide --kappa 18 --psi 1",
    "collide --batch in.csv --out /dev/stdout",
];

#[cfg(any(target_os = "linux", target_os = "macos"))]
#[test]
fn a_closed_standard_output_is_a_failure_where_it_is_written() {
    let workspace = Workspace::with_input(ROWS);
    let run = |line: &str| {
        let mut shell = Command::new("sh");
        shell.args(["-c", r#"exec "$0" "$@" >&-"#, cargo_bin!("stickslip").to_str().unwrap()]);
        shell.args(line.split_whitespace()).current_dir(workspace.path(""));
        Ran::from(shell.output().unwrap())
    };
    for line in WRITING {
        let ran = run(line);
        assert_eq!(ran.code, 1, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains("cannot be written: it is closed"), "{line}: {}", ran.stderr);
    }
    assert_eq!(run("collide --batch in.csv --out out.csv").code, 0);
    assert_eq!(run("collide --kappa -1 --psi 1").code, 2);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_a_failure() {
    let workspace = Workspace::with_input(ROWS);
    for line in WRITING {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let Output { status, stderr, .. } =
            stickslip(&workspace, line).stdout(full).output().unwrap();
        let stderr = String::from_utf8(stderr).unwrap();
        assert_eq!(status.code(), Some(1), "{line}: {stderr}");
        assert!(stderr.contains("cannot be written"), "{line}: {stderr}");
    }
}

/// A batch that waits for input has its incomplete files. They go with it.
#[test]
fn signals_leave_no_incomplete_files() {
    use std::os::unix::process::ExitStatusExt;

    for signal in [heeded(1), heeded(2), 15] {
        let workspace = Workspace::new();
        let mut command = stickslip(&workspace, "collide --batch - --out out.csv --events ev.csv");
        let mut child = command.stdin(Stdio::piped()).spawn().unwrap();
        // To wait for the child would close its input, and the batch could end before the signal.
        let mut input = child.stdin.take().unwrap();
        input.write_all(ROWS.as_bytes()).unwrap();
        let mut waited = 0;
        while workspace.names().len() < 2 {
            waited += 1;
            assert!(waited < 6000, "{:?}", workspace.names());
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        let id = child.id().to_string();
        let kill = Command::new("kill").args([format!("-{signal}"), id]).status().unwrap();
        assert!(kill.success());
        assert_eq!(child.wait().unwrap().signal(), i32::try_from(signal).ok());
        assert_eq!(workspace.names(), [""; 0]);
    }
}

/// An output never replaces an input or another output, under whatever name.
#[test]
fn one_file_under_two_names_is_refused() {
    use std::os::unix::fs::symlink;

    let workspace = Workspace::with_input(ROWS);
    fs::create_dir(workspace.path("sub")).unwrap();
    symlink(workspace.path("in.csv"), workspace.path("link.csv")).unwrap();
    // Links to files that are not there yet.
    symlink("a.json", workspace.path("later.json")).unwrap();
    symlink("later.json", workspace.path("a.svg")).unwrap();
    symlink(workspace.path("m.npz"), workspace.path("sub/m.png")).unwrap();
    symlink(workspace.path("sub"), workspace.path("also")).unwrap();
    let names = workspace.names();
    for line in [
        "trace --kappa 1:2 --psi 1:2 --out a.json --geojson ./a.json",
        "trace --kappa 1:2 --psi 1:2 --out a.json --geojson later.json",
        "trace --kappa 1:2 --psi 1:2 --out a.json --plot a.svg",
        "trace --kappa 1:2 --psi 1:2 --out sub/a.json --geojson also/a.json",
        "map --kappa 1:2 --psi 1:2 --size 3x3 --out m.npz --plot sub/m.png",
        "map --kappa 1:2 --psi 1:2 --size 3x3 --out m.npz --plot also/../sub/m.png",
        "collide --batch in.csv --out link.csv",
        "collide --batch link.csv --out sub/../in.csv",
        "collide --batch in.csv --out out.csv --events sub/../out.csv",
    ] {
        let ran = workspace.run(line);
        assert_eq!(ran.code, 2, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains("is the same file as"), "{line}: {}", ran.stderr);
        assert_eq!(workspace.names(), names, "{line}");
        assert_eq!(workspace.read("in.csv"), ROWS);
    }
    // A link to a file that is not there yet is written through.
    assert_eq!(workspace.run("trace --kappa 1:2 --psi 1:2 --out later.json").code, 0);
    assert!(fs::symlink_metadata(workspace.path("a.json")).unwrap().is_file());
}
