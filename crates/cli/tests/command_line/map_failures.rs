//! Maps that cannot be made, points that cannot be computed, files that cannot be written.

use crate::{Workspace, npz, rows};

const WINDOW: &str = "--kappa 0:70 --psi 0:2.9";

/// Runs `map` with `line`, which must be refused with a message that contains all of `parts`.
fn refused(line: &str, parts: &[&str]) {
    let workspace = Workspace::new();
    let ran = workspace.run(&format!("map {line}"));
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}: {}", ran.stderr);
    for part in parts {
        assert!(ran.stderr.contains(part), "{line}: no {part:?} in {}", ran.stderr);
    }
    assert!(workspace.names().is_empty(), "{line}");
}

#[test]
fn windows_that_are_refused() {
    let expected = "expected LO:HI with finite numbers 0 <= LO < HI";
    for (range, problem) in [
        ("5", "not a range"),
        ("5:5", "out of range"),
        ("5:4", "out of range"),
        ("-1:5", "out of range"),
        (":5", "the lower end is empty"),
        ("nan:5", "the lower end is not a number"),
        ("0:inf", "the upper end is not finite"),
        ("0:1/0", "the upper end is division by 0"),
    ] {
        for (option, others) in
            [("--kappa", "--psi 0:1"), ("--psi", "--kappa 0:1"), ("--ratio", "--kappa 0:1")]
        {
            let line = format!("{option} {range} {others} --size 3x3 --out m.npz");
            refused(&line, &[option, &format!("'{range}'"), problem, expected]);
        }
    }
}

#[test]
fn sizes_that_are_refused() {
    let expected = "expected WxH, two whole numbers from 1 whose product is at most 10000000000";
    for (size, problem) in [
        ("10x", "not a size"),
        ("10", "not a size"),
        ("-1x5", "not a size"),
        ("1.5x2", "not a size"),
        ("nanx2", "not a size"),
        ("0x5", "out of range"),
        ("5x0", "out of range"),
        ("1000000x1000000", "out of range"),
        ("18446744073709551615x2", "out of range"),
        ("18446744073709551616x1", "not a size"),
    ] {
        let line = format!("{WINDOW} --size {size} --out m.npz");
        refused(&line, &["--size", &format!("'{size}'"), problem, expected]);
    }
}

#[test]
fn options_that_do_not_go_together() {
    let rest = "--size 3x3 --out m.npz";
    refused(&format!("{WINDOW} --ratio 0:1 {rest}"), &["--psi", "--ratio", "exactly one"]);
    refused(&format!("--kappa 0:1 {rest}"), &["--psi", "--ratio", "exactly one"]);
    refused(&format!("--psi 0:1 {rest}"), &["--kappa is missing"]);
    refused(&format!("{WINDOW} --mu 1 {rest}"), &["--mu", "--ratio only"]);
    refused(&format!("{WINDOW} --alpha 1 {rest}"), &["--alpha", "--ratio only"]);
    refused(&format!("{WINDOW} --rtol 1e-9 --method exact {rest}"), &["--rtol 1e-9", "exact"]);
    refused(&format!("{WINDOW} --threads 0 {rest}"), &["--threads", "1..=1024"]);
    refused(&format!("{WINDOW} --out m.npz"), &["--size"]);
    refused(&format!("{WINDOW} --size 3x3"), &["--out"]);
    for out in ["m.txt", "m", "npz", "m.npz.gz", ".npz"] {
        let line = format!("{WINDOW} --size 3x3 --out {out}");
        refused(&line, &[&format!("--out {out}:"), "FILE.npz or FILE.csv"]);
    }
}

#[test]
fn bodies_that_do_not_go_together_with_other_options() {
    let rest = "--size 3x3 --out m.npz";
    let velocities = "--normal 0:1 --tangential 0:1";
    for other in ["--kappa 0:1", "--psi 0:1", "--ratio 0:1", "--mu 1", "--alpha 1", "--damping 0"] {
        let option = other.split_once(' ').unwrap().0;
        refused(&format!("--bodies b.json {velocities} {other} {rest}"), &["--bodies", option]);
    }
    for one in ["--normal 0:1", "--tangential 0:1", ""] {
        refused(&format!("--bodies b.json {one} {rest}"), &["--normal", "--tangential", "both"]);
    }
    refused(&format!("{velocities} {rest}"), &["--bodies"]);
    refused(&format!("--bodies b.json {velocities} {rest}"), &["b.json: cannot be read"]);
}

#[test]
fn bodies_with_more_damping_than_any_method_takes() {
    let workspace = Workspace::new();
    let file = std::fs::read_to_string("../../examples/steel_pair.json").unwrap();
    workspace.write("b.json", file.replace("\"damping_time_s\": 0", "\"damping_time_s\": 1"));
    let line = "map --bodies b.json --normal 0:1 --tangential 0:1 --size 3x3 --out m.npz";
    let ran = workspace.run(line);
    assert_eq!(ran.code, 1);
    for part in ["damping = ", "the exact solution", "1e4"] {
        assert!(ran.stderr.contains(part), "{}", ran.stderr);
    }
}

#[test]
fn points_that_cannot_be_computed() {
    // The exact solution does not take ψ in the first row, and κ in the second column.
    let workspace = Workspace::new();
    let line = "map --kappa 0:2e16 --psi 0:3e-100 --size 2x3 --method exact";
    for name in ["m.csv", "m.npz"] {
        let ran = workspace.run(&format!("{line} --out {name}"));
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{}", ran.stderr);
        let start = format!(
            "error: 4 of 6 points could not be computed and are NaN and -1 in {name}; \
             the first, kappa = 5000000000000000.0, psi = 5e-101: psi = 5e-101 is out of the range"
        );
        assert!(ran.stderr.starts_with(&start), "{}", ran.stderr);
    }
    assert_eq!(workspace.names(), ["m.csv", "m.npz"]);
    let table = rows(&workspace.read("m.csv"));
    let failed: Vec<bool> = table[1..].iter().map(|row| row[2] == "NaN").collect();
    assert_eq!(failed, [true, true, false, true, false, true]);
    for (row, failed) in table[1..].iter().zip(&failed) {
        assert_eq!(row[3] == "-1", *failed, "{row:?}");
    }
    let map = npz(&workspace.path("m.npz"));
    let nan: Vec<bool> = map[2].1.doubles().iter().map(|value| value.is_nan()).collect();
    assert_eq!(nan, failed);
    assert!(map[3].1.integers().iter().zip(&failed).all(|(count, bad)| (*count == -1) == *bad));
}

#[test]
fn outputs_that_cannot_be_made() {
    let workspace = Workspace::with_input("");
    std::fs::create_dir(workspace.path("d.npz")).unwrap();
    for out in ["missing/m.npz", "in.csv/m.csv", "d.npz"] {
        let ran = workspace.run(&format!("map {WINDOW} --size 3x3 --out {out}"));
        assert_eq!(ran.code, 1, "{out}: {}", ran.stderr);
        let start = format!("error: {out}: cannot be written: ");
        assert!(ran.stderr.starts_with(&start), "{}", ran.stderr);
        assert_eq!(workspace.names(), ["d.npz", "in.csv"], "{out}");
    }
    // A file has the name of the directory of tiles.
    workspace.write("m.npz.tiles", "");
    let ran = workspace.run(&format!("map {WINDOW} --size 3x3 --out m.npz"));
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.starts_with("error: m.npz.tiles: cannot be written: "), "{}", ran.stderr);
    assert_eq!(workspace.read("m.npz.tiles"), "");
}

/// A limit on the size of files stands for a disk that fills up, first while the tiles are written
/// and then while the map is written.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_map_and_the_finished_tiles() {
    use std::process::Command;

    let line = format!("map {WINDOW} --size 300x200 --method exact --out m.npz");
    let whole = Workspace::new();
    assert_eq!(whole.run(&line).code, 0);
    let workspace = Workspace::new();
    workspace.write("m.npz", "old");
    for (blocks, kept, message) in [
        (64, &["lock", "task"][..], "m.npz.tiles/0.tile: cannot be written: File too large"),
        (
            500,
            &["0.tile", "1.tile", "2.tile", "3.tile", "lock", "task"],
            "m.npz: cannot be written: File too large",
        ),
    ] {
        // Signal 25, which is sent at the limit, is ignored. Writing then fails as on a full disk.
        let script = format!(
            "trap '' 25; ulimit -f {blocks}; exec '{}' {line}",
            assert_cmd::cargo::cargo_bin!("stickslip").display()
        );
        let mut command = Command::new("sh");
        command.args(["-c", &script]).current_dir(workspace.path(""));
        let output = command.output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.contains(message), "{error}");
        assert_eq!(workspace.names(), ["m.npz", "m.npz.tiles"]);
        assert_eq!(workspace.names_in("m.npz.tiles"), kept);
        assert_eq!(workspace.read("m.npz"), "old");
    }
    let ran = workspace.run(&line);
    assert_eq!(ran.code, 0);
    assert_eq!(ran.stderr, "m.npz.tiles: going on with 4 of 4 tiles\n");
    assert_eq!(workspace.names(), ["m.npz"]);
    let [one, two] = [&whole, &workspace].map(|w| std::fs::read(w.path("m.npz")).unwrap());
    assert!(one == two);
}

#[cfg(target_os = "linux")]
#[test]
fn devices_behind_links_stay_devices() {
    use std::os::unix::fs::symlink;

    let workspace = Workspace::new();
    for name in ["m.npz", "m.csv"] {
        symlink("/dev/full", workspace.path(name)).unwrap();
        let ran = workspace.run(&format!("map {WINDOW} --size 3x3 --out {name}"));
        assert_eq!(ran.code, 1);
        assert!(ran.stderr.contains(&format!("{name}: cannot be written: No space")));
    }
    assert_eq!(workspace.names(), ["m.csv", "m.csv.tiles", "m.npz", "m.npz.tiles"]);
    // The next attempt uses the tiles.
    std::fs::remove_file(workspace.path("m.csv")).unwrap();
    symlink("/dev/null", workspace.path("m.csv")).unwrap();
    let ran = workspace.run(&format!("map {WINDOW} --size 3x3 --out m.csv"));
    assert_eq!((ran.code, ran.stderr.contains("1 of 1 tiles")), (0, true), "{}", ran.stderr);
    assert!(!workspace.names().contains(&"m.csv.tiles".to_owned()));
}

#[cfg(unix)]
#[test]
fn behind_a_link_the_file_is_replaced() {
    let workspace = Workspace::new();
    std::fs::create_dir(workspace.path("far")).unwrap();
    workspace.write("far/away.npz", "old");
    std::os::unix::fs::symlink("far/away.npz", workspace.path("m.npz")).unwrap();
    let ran = workspace.run(&format!("map {WINDOW} --size 3x3 --out m.npz"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(workspace.names(), ["far", "m.npz"]);
    assert_eq!(workspace.names_in("far"), ["away.npz"]);
    assert!(std::fs::symlink_metadata(workspace.path("m.npz")).unwrap().is_symlink());
    assert_eq!(npz(&workspace.path("far/away.npz")).len(), 7);
}
