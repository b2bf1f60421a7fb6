//! Parts of maps that are interrupted, made by several processes at once, or made where there is no
//! space.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;

use crate::map_interrupted::whole;
use crate::parts::backwards;
use crate::{Ran, Workspace, heeded};

/// The map of `map_interrupted`, with 79 tiles of 256 points. The collisions are stiff, so that a
/// tile takes about 10 ms.
const LINE: &str = "map --kappa 0:3e5 --psi 0:2.9 --size 100x200 --method exact";

fn command(workspace: &Workspace, line: &str) -> Command {
    let mut command = Command::new(cargo_bin!("stickslip"));
    command.args(line.split_whitespace()).current_dir(workspace.path(""));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn start(workspace: &Workspace, line: &str) -> Child {
    command(workspace, line).args(["--threads", "1"]).spawn().unwrap()
}

fn tiles(workspace: &Workspace, out: &str) -> usize {
    let entries = fs::read_dir(workspace.path(&format!("{out}.tiles"))).into_iter().flatten();
    let names = entries.flatten().map(|entry| entry.path());
    names.filter(|path| path.extension().is_some_and(|extension| extension == "tile")).count()
}

/// Waits until `child` has finished so many tiles of `out`.
fn wait_for(workspace: &Workspace, out: &str, count: usize) {
    let begun = Instant::now();
    while tiles(workspace, out) < count {
        assert!(begun.elapsed() < Duration::from_mins(1), "no progress");
        sleep(Duration::from_millis(1));
    }
}

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn signal(child: &mut Child, signal: &str) {
    send(child, signal);
    let number = signal.trim_start_matches('-').parse().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(number), "the part was finished before");
}

#[test]
fn interrupted_parts_go_on_where_they_stopped() {
    let workspace = Workspace::new();
    for (part, number, of) in [(1, 9, 39), (2, heeded(2), 40)] {
        let line = format!("{LINE} --part {part}/2 --out {part}.part");
        let mut kept = 0;
        for _ in 0..3 {
            let mut child = start(&workspace, &line);
            wait_for(&workspace, &format!("{part}.part"), kept + 2);
            signal(&mut child, &format!("-{number}"));
            kept = tiles(&workspace, &format!("{part}.part"));
        }
        let ran = workspace.run(&line);
        let expected = format!("{part}.part.tiles: going on with {kept} of {of} tiles\n");
        assert_eq!((ran.code, ran.stderr), (0, expected));
    }
    assert_eq!(workspace.names(), ["1.part", "2.part"]);
    assert_eq!(workspace.run("join 1.part 2.part --out m.npz").code, 0);
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

/// All parts at once in one directory, as a job array makes them, and one of them in two processes.
#[test]
fn parts_are_made_at_the_same_time() {
    let workspace = Workspace::new();
    let line = |part: usize| format!("{LINE} --part {part}/3 --out {part}.part");
    let children: Vec<_> = [1, 2, 3].map(|part| start(&workspace, &line(part))).into();
    wait_for(&workspace, "3.part", 1);
    // Stopped, it cannot be finished before the other process looks.
    send(&children[2], "-STOP");
    let second = workspace.run(&line(3));
    send(&children[2], "-CONT");
    let expected = format!("3.part.tiles: another process ({}) is making", children[2].id());
    assert_eq!(second.code, 1);
    assert!(second.stderr.starts_with(&format!("error: {expected}")), "{}", second.stderr);
    for child in children {
        let ran = Ran::from(child.wait_with_output().unwrap());
        assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    }
    assert_eq!(workspace.names(), ["1.part", "2.part", "3.part"]);
    assert_eq!(workspace.run(&format!("join {} --out m.npz", backwards(3))).code, 0);
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

/// Every job has the same `--out`, by mistake. One of them is made, and the others say why not.
#[test]
fn parts_with_one_file_for_all_are_refused() {
    let workspace = Workspace::new();
    let mut first = start(&workspace, &format!("{LINE} --part 1/2 --out m.npz"));
    wait_for(&workspace, "m.npz", 1);
    for (options, theirs, ours) in [
        ("--part 2/2", "'part: 1/2'", "'part: 2/2'"),
        ("--part 1/3", "'part: 1/2'", "'part: 1/3'"),
        ("", "'part: 1/2'", "''"),
    ] {
        let ran = workspace.run(&format!("{LINE} {options} --out m.npz"));
        assert_eq!(ran.code, 2);
        let expected = format!(
            "error: m.npz.tiles: holds the tiles of another map or part, with {theirs} where this \
             one has {ours}; expected the command that began it"
        );
        assert!(ran.stderr.starts_with(&expected), "{}", ran.stderr);
    }
    assert!(first.wait().unwrap().success());
    assert_eq!(workspace.names(), ["m.npz"]);
}

/// A kill between the end of a part and the end of its tiles.
#[test]
fn tiles_of_a_finished_part_are_removed() {
    let workspace = Workspace::new();
    let line = format!("{LINE} --part 2/4 --out 2.part");
    let mut child = start(&workspace, &line);
    wait_for(&workspace, "2.part", 2);
    signal(&mut child, "-9");
    let other = Workspace::new();
    assert_eq!(other.run(&line).code, 0);
    fs::copy(other.path("2.part"), workspace.path("2.part")).unwrap();
    let ran = workspace.run(&line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, "2.part: has part 2/4 already\n"));
    assert_eq!(workspace.names(), ["2.part"]);
}

/// Tiles that are cut off, of another map or of another part are made again.
#[test]
fn damaged_tiles_of_a_part_are_made_again() {
    let workspace = Workspace::new();
    let line = format!("{LINE} --part 2/2 --out 2.part");
    let mut child = start(&workspace, &line);
    wait_for(&workspace, "2.part", 4);
    signal(&mut child, "-9");
    let kept = tiles(&workspace, "2.part");
    let tile = |index: usize| workspace.path(&format!("2.part.tiles/{index}.tile"));
    fs::write(tile(39), "").unwrap();
    fs::copy(tile(41), tile(40)).unwrap();
    // This one is of the first part, and nobody looks at it.
    fs::copy(tile(41), tile(3)).unwrap();
    let ran = workspace.run(&line);
    let expected = format!("going on with {} of 40 tiles, 2 damaged and made again\n", kept - 2);
    assert_eq!((ran.code, ran.stderr), (0, format!("2.part.tiles: {expected}")));
    assert_eq!(workspace.names_in("2.part.tiles"), ["3.tile"]);
    assert_eq!(workspace.run(&format!("{LINE} --part 1/2 --out 1.part")).code, 0);
    assert_eq!(workspace.run("join 1.part 2.part --out m.npz").code, 0);
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

#[test]
fn names_with_blanks_and_a_hyphen_first() {
    let workspace = Workspace::new();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(cargo_bin!("stickslip"));
        Ran::from(command.current_dir(workspace.path("")).args(arguments).output().unwrap())
    };
    let map = ["map", "--kappa", "0:70", "--psi", "0:2", "--size", "9x9", "--part"];
    for (part, out) in [("1/2", "first part"), ("2/2", "./-2 \u{3c8}")] {
        let ran = run(&[&map[..], &[part, "--out", out]].concat());
        assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    }
    let ran = run(&["join", "--out", "the map.csv", "--", "-2 \u{3c8}", "first part"]);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.names(), ["-2 \u{3c8}", "first part", "the map.csv"]);
}

/// A limit on the size of files stands for a disk that fills up.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_parts() {
    let workspace = Workspace::new();
    let limited = |blocks: usize, line: &str| {
        // Signal 25, which is sent at the limit, is ignored. Writing then fails as on a full disk.
        let program = cargo_bin!("stickslip").display();
        let script = format!("trap '' 25; ulimit -f {blocks}; exec '{program}' {line}");
        let mut command = Command::new("sh");
        command.args(["-c", &script]).current_dir(workspace.path(""));
        Ran::from(command.output().unwrap())
    };
    let line = format!("{LINE} --part 2/2 --out 2.part");
    let ran = limited(100, &line);
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("2.part: cannot be written: File too large"), "{}", ran.stderr);
    assert_eq!(workspace.names(), ["2.part.tiles"]);
    let ran = workspace.run(&line);
    assert_eq!((ran.code, ran.stderr.contains("going on with 40 of 40")), (0, true));
    assert_eq!(workspace.run(&format!("{LINE} --part 1/2 --out 1.part")).code, 0);
    workspace.write("m.csv", "old");
    let ran = limited(100, "join 1.part 2.part --out m.csv");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.starts_with("error: m.csv: cannot be written: "), "{}", ran.stderr);
    assert_eq!(workspace.names(), ["1.part", "2.part", "m.csv"]);
    assert_eq!(workspace.read("m.csv"), "old");
}

/// The last part of 10¹⁰ points begins at once, and an end from the keyboard leaves its tiles.
#[test]
fn a_part_of_a_huge_map_begins_at_once() {
    let workspace = Workspace::new();
    let line = LINE.replace("100x200", "100000x100000").replace("0:3e5", "1:2");
    let mut child = start(&workspace, &format!("{line} --part 64/64 --out 64.part"));
    wait_for(&workspace, "64.part", 1);
    signal(&mut child, "-15");
    let names = workspace.names_in("64.part.tiles");
    assert!(names.contains(&"300407.tile".to_owned()), "{names:?}");
    assert!(names.iter().all(|name| !name.contains("partial")), "{names:?}");
}

/// A pipe in the place of a part would block whoever opens it.
#[test]
fn a_pipe_is_not_a_part() {
    let workspace = Workspace::new();
    assert!(Command::new("mkfifo").arg(workspace.path("1.part")).status().unwrap().success());
    let ran = workspace.run("join 1.part --out m.npz");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.starts_with("error: 1.part: is not a regular file"), "{}", ran.stderr);
}
