//! Maps in parts, when nothing goes wrong: joined, they are the whole map.

use std::fs;
#[cfg(unix)]
use std::process::Command;

#[cfg(unix)]
use crate::stickslip;
use crate::{Workspace, rows};

/// Makes all parts of the map `line` as `1.part` and so on.
pub fn make(workspace: &Workspace, line: &str, count: usize) {
    for part in 1..=count {
        let ran = workspace.run(&format!("{line} --part {part}/{count} --out {part}.part"));
        assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""), "{line}");
    }
}

/// The names of all parts, the last part first.
pub fn backwards(count: usize) -> String {
    let names: Vec<_> = (1..=count).rev().map(|part| format!("{part}.part")).collect();
    names.join(" ")
}

/// Checks that the map `line` is the same, byte for byte, from `count` parts and without parts.
fn same(workspace: &Workspace, line: &str, count: usize) {
    make(workspace, line, count);
    for name in ["m.npz", "m.csv"] {
        let ran = workspace.run(&format!("join {} --out {name}", backwards(count)));
        assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""), "{line}");
        assert_eq!(workspace.run(&format!("{line} --out whole.{name}")).code, 0);
        let whole = format!("whole.{name}");
        let [joined, whole] = [name, &whole].map(|name| fs::read(workspace.path(name)).unwrap());
        assert!(joined == whole, "{line} {name}");
    }
    let mut names: Vec<_> = (1..=count).map(|part| format!("{part}.part")).collect();
    names.extend(["m.csv", "m.npz", "whole.m.csv", "whole.m.npz"].map(str::to_owned));
    names.sort();
    assert_eq!(workspace.names(), names);
}

#[test]
fn joined_parts_are_the_whole_map() {
    // With stiff springs a tile has 256 or 512 points, and the last tile of a map is not full.
    for (line, count) in [
        ("map --kappa 0:1e6 --psi 0:2.9 --size 67x31 --method exact", 4),
        ("map --kappa 1e5:3e5 --psi 0:2.9 --size 40x50 --damping 0.05", 3),
        ("map --kappa 0:1e6 --ratio 0:3.5 --mu 0.3 --alpha 1/3 --size 31x67", 9),
        ("map --kappa 0:70 --psi 0:2.9 --size 8x5 --damping 0.1 --method dopri5 --atol 1e-7", 1),
        ("map --kappa 2/7:70 --ratio 0:2 --size 8x5 --rtol 3e-9", 1),
    ] {
        same(&Workspace::new(), line, count);
    }
}

#[test]
fn a_map_of_two_bodies_in_parts() {
    two_bodies_in_parts("13x11");
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_larger_map_of_two_bodies_in_parts() {
    two_bodies_in_parts("13x29");
}

fn two_bodies_in_parts(size: &str) {
    let workspace = Workspace::new();
    let file = fs::read_to_string("../../examples/steel_pair.json").unwrap();
    // Stiff, so that the tiles are small, and with digits that have to be kept.
    let file = file.replace("1e12", "1.1e16").replace("0.02", "0.020000000000000004");
    let file = file.replace("\"damping_time_s\": 0", "\"damping_time_s\": 1.2345678901234567e-7");
    workspace.write("pair.json", &file);
    let line = format!("map --bodies pair.json --normal 0:200 --tangential 0:100 --size {size}");
    make(&workspace, &line, 3);
    // The parts know the bodies.
    fs::remove_file(workspace.path("pair.json")).unwrap();
    let other = Workspace::new();
    other.write("pair.json", &file);
    assert_eq!(workspace.run("join 2.part 3.part 1.part --out m.npz").code, 0);
    assert_eq!(workspace.run("join 2.part 3.part 1.part --out m.csv").code, 0);
    for name in ["m.npz", "m.csv"] {
        assert_eq!(other.run(&format!("{line} --out {name}")).code, 0);
        assert!(fs::read(workspace.path(name)).unwrap() == fs::read(other.path(name)).unwrap());
    }
}

/// Parts are tiles. A map with fewer tiles than parts has empty parts, and that is not a failure.
#[test]
fn more_parts_than_tiles() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:1e6 --psi 0:2.9 --size 30x30 --method exact";
    let mut empty = 0;
    for part in 1..=7 {
        let ran = workspace.run(&format!("{line} --part {part}/7 --out {part}.part"));
        assert_eq!((ran.code, ran.stdout.as_str()), (0, ""));
        if !ran.stderr.is_empty() {
            empty += 1;
            let expected = format!("part {part}/7 is empty, because the map has 4 tiles only\n");
            assert_eq!(ran.stderr, format!("{part}.part: {expected}"));
        }
    }
    assert_eq!(empty, 3);
    assert_eq!(workspace.run(&format!("join {} --out m.csv", backwards(7))).code, 0);
    assert_eq!(workspace.run(&format!("{line} --out w.csv")).code, 0);
    assert!(workspace.read("m.csv") == workspace.read("w.csv"));
    // Far more.
    let ran = workspace.run(&format!("{line} --part 999999/1000000 --out far.part"));
    assert_eq!(ran.code, 0);
    assert!(ran.stderr.starts_with("far.part: part 999999/1000000 is empty"), "{}", ran.stderr);
}

#[test]
fn a_part_under_any_name_and_drawn_when_joined() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:70 --psi 0:2.9 --size 20x30";
    for (part, name) in [(1, "a.npz"), (2, "b.csv")] {
        assert_eq!(workspace.run(&format!("{line} --part {part}/2 --out {name}")).code, 0);
    }
    assert_eq!(workspace.run("join b.csv ./a.npz --out m.npz --plot m.svg").code, 0);
    assert_eq!(workspace.run(&format!("{line} --out w.npz --plot w.svg")).code, 0);
    assert!(workspace.read("m.svg") == workspace.read("w.svg"));
    // A part begins with a line for readers.
    let bytes = fs::read(workspace.path("a.npz")).unwrap();
    assert!(bytes.starts_with(b"Part of a map; the command stickslip join makes the map of all"));
}

/// The same part given twice does no harm, and neither does a link.
#[test]
fn a_part_that_is_there_twice() {
    let workspace = Workspace::new();
    make(&workspace, "map --kappa 0:1e6 --psi 0:2.9 --size 30x30 --method exact", 2);
    fs::copy(workspace.path("2.part"), workspace.path("copy.part")).unwrap();
    let ran = workspace.run("join copy.part 1.part 2.part 1.part --out m.csv");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(rows(&workspace.read("m.csv")).len(), 901);
}

/// Whoever repeats all jobs of an array does no work twice.
#[test]
fn a_part_that_is_there_is_not_computed_again() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:1e6 --psi 0:2.9 --size 30x30 --part 1/2 --out 1.part";
    assert_eq!(workspace.run(line).code, 0);
    let bytes = fs::read(workspace.path("1.part")).unwrap();
    let written = || fs::metadata(workspace.path("1.part")).unwrap().modified().unwrap();
    let before = written();
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, "1.part: has part 1/2 already\n"));
    assert_eq!(written(), before);
    // If it is damaged, or that of another map, it is made again.
    let mut damaged = bytes.clone();
    *damaged.last_mut().unwrap() ^= 1;
    workspace.write("1.part", damaged);
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(fs::read(workspace.path("1.part")).unwrap() == bytes);
    let ran = workspace.run(&line.replace("2.9", "3"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(fs::read(workspace.path("1.part")).unwrap() != bytes);
    assert_eq!(workspace.names(), ["1.part"]);
}

/// The job array in the help text can be copied as it is.
#[cfg(unix)]
#[test]
fn the_help_has_a_job_array() {
    let ran = stickslip("map --help");
    let (_, script) = ran.stdout.split_once("  #!/bin/sh\n").unwrap();
    let (script, rest) = script.split_once("\n\n").unwrap();
    let workspace = Workspace::new();
    workspace.write(
        "job.sh",
        script.replace("  stickslip map", "echo map").replace("20000x20000", "9x9"),
    );
    let mut command = Command::new("sh");
    command.arg("job.sh").current_dir(workspace.path(""));
    command.env("SLURM_ARRAY_TASK_ID", "3").env("SLURM_CPUS_PER_TASK", "2");
    let line = String::from_utf8(command.output().unwrap().stdout).unwrap();
    let expected = "--size 9x9 --part 3/64 --threads 2 --out map-3.part\n";
    assert!(line.ends_with(expected), "{line}");
    assert_eq!(workspace.run(&line).code, 0);
    assert_eq!(workspace.names(), ["job.sh", "map-3.part"]);
    assert!(rest.contains("  stickslip join map-*.part --out map.npz\n"), "{rest}");
}
