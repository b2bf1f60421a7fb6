//! Maps that are interrupted, continued, damaged, or made by two processes at once.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use assert_cmd::cargo::cargo_bin;

use crate::{Workspace, heeded};

/// A map with 79 tiles of 256 points. The collisions are stiff, so that a tile takes about 10 ms.
const LINE: &str = "map --kappa 0:3e5 --psi 0:2.9 --size 100x200 --method exact --out m.npz";
const TILES: usize = 79;
const DIRECTORY: &str = "m.npz.tiles";

/// The map without interruption, to which parts are joined too.
pub fn whole() -> &'static [u8] {
    static MAP: OnceLock<Vec<u8>> = OnceLock::new();
    MAP.get_or_init(|| made_with("2"))
}

/// The map without interruption, made with a number of threads.
fn made_with(threads: &str) -> Vec<u8> {
    let workspace = Workspace::new();
    let ran = workspace.run(&format!("{LINE} --threads {threads}"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.names(), ["m.npz"]);
    fs::read(workspace.path("m.npz")).unwrap()
}

fn start(workspace: &Workspace, line: &str) -> Child {
    Command::new(cargo_bin!("stickslip"))
        .args(line.split_whitespace())
        .args(["--threads", "1"])
        .current_dir(workspace.path(""))
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// The finished tiles by name, with what would change if a tile were written again.
fn tiles(workspace: &Workspace) -> BTreeMap<String, (u64, i64, i64)> {
    let Ok(entries) = fs::read_dir(workspace.path(DIRECTORY)) else { return BTreeMap::new() };
    let entries = entries.map(|entry| entry.unwrap());
    entries
        .filter(|entry| entry.path().extension().is_some_and(|extension| extension == "tile"))
        .map(|entry| {
            let metadata = entry.metadata().unwrap();
            let name = entry.file_name().into_string().unwrap();
            (name, (metadata.ino(), metadata.mtime(), metadata.mtime_nsec()))
        })
        .collect()
}

/// Starts the map and ends it with `signal` after it has finished at least `more` further tiles and
/// continued for the time `longer`. The map must not be finished when the signal comes.
fn interrupt(workspace: &Workspace, more: usize, longer: Duration, signal: &str) {
    interrupt_line(workspace, LINE, more, longer, signal);
}

fn interrupt_line(workspace: &Workspace, line: &str, more: usize, longer: Duration, signal: &str) {
    let before = tiles(workspace).len();
    let mut child = start(workspace, line);
    let begun = Instant::now();
    while tiles(workspace).len() < before + more {
        assert!(begun.elapsed() < Duration::from_mins(1), "no progress");
        sleep(Duration::from_millis(1));
    }
    sleep(longer);
    let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let number = signal.trim_start_matches('-').parse().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(number), "the map was finished before");
    let found = tiles(workspace).len();
    assert!(found >= before + more && found < TILES, "{found} tiles");
    assert_eq!(workspace.names(), [DIRECTORY]);
}

fn finish(workspace: &Workspace, message: &str) {
    let ran = workspace.run(LINE);
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    assert_eq!(ran.stderr, format!("{DIRECTORY}: going on with {message}\n"));
    assert_eq!(workspace.names(), ["m.npz"]);
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn ten_kills_leave_no_trace() {
    let workspace = Workspace::new();
    let mut kept = BTreeMap::new();
    let mut random = 7_u64;
    for _ in 0..10 {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let longer = Duration::from_micros((random >> 33) % 30_000);
        interrupt(&workspace, 1, longer, "-9");
        let now = tiles(&workspace);
        // Tiles that were finished before have not been made again.
        assert!(kept.iter().all(|(name, file)| now.get(name) == Some(file)));
        kept = now;
    }
    finish(&workspace, &format!("{} of {TILES} tiles", kept.len()));
    let map = fs::read(workspace.path("m.npz")).unwrap();
    assert!(map == whole());
    for threads in ["1", "4"] {
        assert!(map == made_with(threads), "--threads {threads}");
    }
}

#[test]
fn an_interrupt_from_the_keyboard_loses_nothing() {
    let workspace = Workspace::new();
    interrupt(&workspace, 2, Duration::ZERO, &format!("-{}", heeded(2)));
    interrupt(&workspace, 2, Duration::ZERO, "-15");
    let kept = tiles(&workspace).len();
    finish(&workspace, &format!("{kept} of {TILES} tiles"));
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

#[test]
fn tiles_that_are_not_what_was_written_are_made_again() {
    let workspace = Workspace::new();
    interrupt(&workspace, 8, Duration::ZERO, "-9");
    let kept = tiles(&workspace).len();
    let tile = |index: usize| workspace.path(&format!("{DIRECTORY}/{index}.tile"));
    let change = |index, change: fn(&mut Vec<u8>)| {
        let mut bytes = fs::read(tile(index)).unwrap();
        change(&mut bytes);
        fs::write(tile(index), bytes).unwrap();
    };
    change(0, Vec::clear);
    change(1, |bytes| bytes.truncate(bytes.len() - 1));
    change(2, |bytes| bytes.push(0));
    // A bit of a result, and a bit of the description of the map.
    change(3, |bytes| *bytes.iter_mut().rev().nth(2000).unwrap() ^= 1);
    change(4, |bytes| bytes[10] ^= 1);
    // This tile is intact, but it is another one.
    fs::copy(tile(6), tile(5)).unwrap();
    // This tile is intact, but of another map. Only the last digit of the window differs.
    let other = Workspace::new();
    let line = LINE.replace("0:2.9", "0:2.9000000000000004");
    interrupt_line(&other, &line, 8, Duration::ZERO, "-9");
    fs::copy(other.path(&format!("{DIRECTORY}/7.tile")), tile(7)).unwrap();
    finish(&workspace, &format!("{} of {TILES} tiles, 7 damaged and made again", kept - 7));
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

#[test]
fn the_tiles_of_another_map_are_left_alone() {
    let workspace = Workspace::new();
    interrupt(&workspace, 2, Duration::ZERO, "-9");
    let kept = tiles(&workspace);
    for (from, to, theirs, ours) in [
        ("0:2.9", "0:2.9000000000000004", "rows: 200, psi from 0.0 to 2.9", "2.9000000000000004"),
        ("--psi", "--ratio", "rows: 200, psi", "rows: 200, ratio"),
        ("100x200", "200x100", "columns: 100,", "columns: 200,"),
        ("exact", "dop853", "method: exact", "method: dop853, rtol 4e-13, atol 4e-13"),
    ] {
        let ran = workspace.run(&LINE.replace(from, to));
        assert_eq!(ran.code, 2, "{}", ran.stderr);
        for part in [DIRECTORY, "another map", theirs, ours, "expected"] {
            assert!(ran.stderr.contains(part), "no {part:?} in {}", ran.stderr);
        }
        assert_eq!(tiles(&workspace), kept);
    }
    finish(&workspace, &format!("{} of {TILES} tiles", kept.len()));
}

#[test]
fn a_second_process_is_refused() {
    let workspace = Workspace::new();
    let mut first = start(&workspace, LINE);
    while tiles(&workspace).len() < 2 {
        sleep(Duration::from_millis(1));
    }
    let second = workspace.run(LINE);
    assert_eq!(second.code, 1);
    let holder = first.id();
    let expected = format!(
        "error: {DIRECTORY}: another process ({holder}) is making this map; \
         expected another --out, or to wait\n"
    );
    assert_eq!(second.stderr, expected);
    assert!(first.wait().unwrap().success());
    assert_eq!(workspace.names(), ["m.npz"]);
    assert!(fs::read(workspace.path("m.npz")).unwrap() == whole());
}

#[test]
fn only_its_own_files_are_removed() {
    let workspace = Workspace::new();
    interrupt(&workspace, 2, Duration::ZERO, "-9");
    let kept = tiles(&workspace).len();
    let theirs = [".m.npz.x-.partial", "0.tile.partial", "00.tile", "79.tile", "notes.txt"];
    for name in theirs.into_iter().chain([".m.npz.x.partial", ".7.tile.Ab3.partial"]) {
        workspace.write(&format!("{DIRECTORY}/{name}"), "");
    }
    finish_beside(&workspace, kept);
    assert_eq!(workspace.names_in(DIRECTORY), theirs);
}

/// Finishes the map in a directory that stays, because it has files of others.
fn finish_beside(workspace: &Workspace, kept: usize) {
    let ran = workspace.run(LINE);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(ran.stderr, format!("{DIRECTORY}: going on with {kept} of {TILES} tiles\n"));
    assert_eq!(workspace.names(), ["m.npz", DIRECTORY]);
}

/// A directory that the program did not make stays as it is, byte for byte.
#[test]
fn a_directory_of_others_is_refused() {
    let refused = |workspace: &Workspace, code: i32, what: &str| {
        let ran = workspace.run(LINE);
        assert_eq!(ran.code, code, "{}", ran.stderr);
        let expected = format!("error: {DIRECTORY}: {what}; expected a directory that stickslip");
        assert!(ran.stderr.starts_with(&expected), "{}", ran.stderr);
    };
    let workspace = Workspace::new();
    fs::create_dir(workspace.path(DIRECTORY)).unwrap();
    refused(&workspace, 2, "is not a directory of tiles");
    for name in ["lock", "0.tile", ".m.npz.x.partial"] {
        workspace.write(&format!("{DIRECTORY}/{name}"), "theirs");
    }
    refused(&workspace, 2, "is not a directory of tiles");
    workspace.write(&format!("{DIRECTORY}/task"), "theirs");
    let ran = workspace.run(LINE);
    assert!(ran.code == 2 && ran.stderr.contains("'theirs'"), "{}", ran.stderr);
    // A pipe would block whoever opens it.
    fs::remove_file(workspace.path(&format!("{DIRECTORY}/task"))).unwrap();
    let pipe = workspace.path(&format!("{DIRECTORY}/task"));
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    refused(&workspace, 2, "is not a directory of tiles");
    for name in ["lock", "0.tile", ".m.npz.x.partial"] {
        assert_eq!(workspace.read(&format!("{DIRECTORY}/{name}")), "theirs");
    }
    // Nor is a link followed, wherever it leads.
    let other = Workspace::new();
    std::os::unix::fs::symlink(workspace.path(DIRECTORY), other.path(DIRECTORY)).unwrap();
    refused(&other, 1, "cannot be written: it is not a directory");
}

#[test]
fn links_in_the_place_of_files_are_not_followed() {
    for name in ["0.tile", "lock", "task"] {
        let workspace = Workspace::new();
        interrupt(&workspace, 2, Duration::ZERO, "-9");
        let path = workspace.path(&format!("{DIRECTORY}/{name}"));
        fs::remove_file(&path).unwrap();
        let theirs = Workspace::with_input("theirs");
        std::os::unix::fs::symlink(theirs.path("in.csv"), &path).unwrap();
        let ran = workspace.run(LINE);
        assert_ne!(ran.code, 0, "{name}");
        let what = if name == "task" { "not a directory of tiles" } else { "not a regular file" };
        assert!(ran.stderr.contains(what), "{name}: {}", ran.stderr);
        assert_eq!(theirs.read("in.csv"), "theirs");
        assert!(fs::symlink_metadata(&path).unwrap().is_symlink());
    }
}

/// The first tiles of a map of 10¹⁰ points come as soon as those of a small one.
#[test]
fn a_huge_map_begins_at_once() {
    let workspace = Workspace::new();
    let line = LINE.replace("100x200", "100000x100000").replace("0:3e5", "1:2");
    interrupt_line(&workspace, &line, 2, Duration::ZERO, "-15");
    assert!(workspace.names_in(DIRECTORY).iter().all(|name| !name.contains("partial")));
}
