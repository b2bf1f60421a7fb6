//! Parts that cannot be made or joined: bad options, and files that are missing, damaged or of
//! another map.

use std::fs;

use crate::parts::make;
use crate::{Ran, Workspace, rows};

/// A map of 4 tiles, three of 256 points and one of 132.
const LINE: &str = "map --kappa 0:1e6 --psi 0:2.9 --size 30x30 --method exact";

/// Checks that `ran` was refused with a message that begins with `start` and contains `parts`.
#[track_caller]
fn refused(ran: &Ran, start: &str, parts: &[&str]) {
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{}", ran.stderr);
    assert!(ran.stderr.starts_with(&format!("error: {start}")), "{start}: {}", ran.stderr);
    for part in parts {
        assert!(ran.stderr.contains(part), "no {part:?} in {}", ran.stderr);
    }
}

#[test]
fn parts_that_are_refused() {
    let workspace = Workspace::new();
    let expected = "expected K/N, two whole numbers with 1 <= K <= N <= 1000000, written like 3/64";
    for (part, problem) in [
        ("0/3", "out of range"),
        ("4/3", "out of range"),
        ("1/0", "out of range"),
        ("1/1000001", "out of range"),
        ("a/b", "not a part"),
        ("3", "not a part"),
        ("/64", "not a part"),
        ("-1/3", "not a part"),
        ("1.5/3", "not a part"),
        ("18446744073709551616/3", "not a part"),
    ] {
        let ran = workspace.run(&format!("{LINE} --part {part} --out 1.part"));
        let value = format!("invalid value '{part}' for '--part");
        refused(&ran, &value, &[problem, expected]);
    }
    let ran = workspace.run(&format!("{LINE} --part 1/3 --out 1.part --plot m.svg"));
    refused(&ran, "", &["--part", "--plot"]);
    let ran = workspace.run(&format!("{LINE} --part 1/3 --out -"));
    refused(&ran, "--out -: a part is not written to standard output", &["expected a file"]);
    assert_eq!(workspace.names(), [""; 0]);
}

#[test]
fn options_of_join_that_are_refused() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    let names = workspace.names();
    refused(&workspace.run("join --out m.npz"), "", &["PART"]);
    refused(&workspace.run("join 1.part 2.part"), "", &["--out"]);
    let ran = workspace.run("join 1.part - --out m.npz");
    refused(&ran, "PART -: a part is not read from standard input", &["expected a file"]);
    for out in ["m", "m.part", "-"] {
        let ran = workspace.run(&format!("join 1.part 2.part --out {out}"));
        refused(&ran, &format!("--out {out}: "), &["FILE.npz or FILE.csv"]);
    }
    fs::copy(workspace.path("2.part"), workspace.path("2.csv")).unwrap();
    let ran = workspace.run("join 1.part 2.csv --out ./2.csv");
    refused(&ran, "--out ./2.csv is the same file as PART", &[]);
    fs::rename(workspace.path("2.csv"), workspace.path("2.svg")).unwrap();
    let ran = workspace.run("join 1.part 2.svg --out m.csv --plot 2.svg");
    refused(&ran, "--plot 2.svg is the same file as PART", &[]);
    fs::remove_file(workspace.path("2.svg")).unwrap();
    assert_eq!(workspace.names(), names);
}

#[test]
fn missing_parts_are_named() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 4);
    for (given, missing) in [
        ("1.part 2.part 4.part", "part 3 is missing"),
        ("4.part 2.part", "parts 1 and 3 are missing"),
        ("3.part", "parts 1, 2 and 4 are missing"),
        ("3.part 3.part 3.part 3.part", "parts 1, 2 and 4 are missing"),
    ] {
        let ran = workspace.run(&format!("join {given} --out m.npz"));
        let start = format!("{}: is one of 4 parts, and {missing}", &given[..6]);
        refused(&ran, &start, &["expected all of them"]);
    }
    let ran = workspace.run("join 1.part 2.part 5.part --out m.npz");
    refused(&ran, "5.part: cannot be read: ", &[]);
    assert_eq!(workspace.run(&format!("{LINE} --part 7/100 --out far.part")).code, 0);
    let ran = workspace.run("join far.part --out m.npz");
    refused(
        &ran,
        "far.part: is one of 100 parts, and parts 1, 2, 3, 4, 5, 6, 8, 9, 10, 11 and 89 \
                   others are missing",
        &[],
    );
    assert!(!workspace.names().contains(&"m.npz".to_owned()));
}

#[test]
fn parts_of_other_maps() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    let damped = "--psi 0:2.9 --damping 1e-3";
    let pair = fs::read_to_string("../../examples/steel_pair.json").unwrap();
    workspace.write("a.json", &pair);
    workspace.write("b.json", pair.replacen("0.02,", "0.0200000001,", 1));
    let bodies = "--bodies a.json --normal 0:9 --tangential 0:9";
    for (one, other, theirs, ours) in [
        ("0:2.9", "0:2.9000000000000004", "psi from 0.0 to 2.9000000000000004'", "to 2.9'"),
        ("--psi", "--ratio", "rows: 30, ratio", "rows: 30, psi"),
        ("30x30", "29x30", "columns: 29,", "columns: 30,"),
        ("--psi 0:2.9", damped, "'damping: 0.001'", "'damping: 0.0'"),
        ("exact", "dop853", "'method: dop853, rtol 4e-13, atol 4e-13'", "'method: exact'"),
        ("exact", "dop853 --rtol 1e-9", "'method: dop853, rtol 1e-9, atol 4e-13'", "exact'"),
        ("--kappa 0:1e6 --psi 0:2.9", bodies, "normal_m_per_s from", "kappa from"),
    ] {
        let line = LINE.replace(one, other);
        let ran = workspace.run(&format!("{line} --part 2/2 --out other.part"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let ran = workspace.run("join 1.part other.part --out m.npz");
        let start = "other.part: is a part of another map than 1.part, with ";
        refused(&ran, start, &[theirs, ours, "expected the parts of one map"]);
    }
    for file in ["a", "b"] {
        let line = LINE.replace(
            "--kappa 0:1e6 --psi 0:2.9",
            &bodies.replace("a.json", &format!("{file}.json")),
        );
        assert_eq!(workspace.run(&format!("{line} --part 1/1 --out {file}.part")).code, 0);
    }
    let ran = workspace.run("join a.part b.part --out m.npz");
    refused(&ran, "b.part: is a part of another map than a.part, with 'bodies: BodyPair", &[]);
    assert_eq!(workspace.run(&format!("{LINE} --part 2/3 --out third.part")).code, 0);
    let ran = workspace.run("join 1.part third.part --out m.npz");
    refused(
        &ran,
        "third.part: is part 2/3 where 1.part is part 1/2; expected the same number",
        &[],
    );
}

/// A part with other results under the same description, as a broken machine would make it.
#[test]
fn a_part_twice_with_other_content() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    let mut bytes = fs::read(workspace.path("2.part")).unwrap();
    bytes[2000] ^= 1;
    workspace.write("also.part", &bytes);
    let ran = workspace.run("join 1.part 2.part also.part --out m.npz");
    refused(&ran, "also.part: is part 2/2 like 2.part, with other content", &["each part once"]);
}

#[test]
fn parts_by_another_build() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    let text = |name: &str| fs::read(workspace.path(name)).unwrap();
    let (title, json, _) = header(&text("1.part"));
    for (here, there) in
        [("fused", "rounded"), ("rounded", "fused"), ("stickslip 0.", "stickslip 7.")]
    {
        if !json.contains(here) {
            continue;
        }
        let label = format!("{title}{}", json.replacen(here, there, 1));
        workspace.write("old.part", empty_tile(&label));
        let ran = workspace.run("join old.part 2.part --out m.npz");
        let start = "old.part: was made by another build, with 'program: stickslip ";
        refused(
            &ran,
            start,
            &[there, here, "expected all parts, and stickslip join, by one build"],
        );
        // Nor does such a part stand in the way of a new one.
        assert_eq!(workspace.run(&format!("{LINE} --part 2/2 --out old.part")).stderr, "");
        assert!(text("old.part") == text("2.part"));
    }
}

/// A header that is intact, and says what no map is.
#[test]
fn headers_that_no_program_writes() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 1);
    let bytes = fs::read(workspace.path("1.part")).unwrap();
    let (title, json, tiles) = header(&bytes);
    for (from, to) in [
        ("\"cells\":30", "\"cells\":0"),
        ("\"cells\":30", "\"cells\":31"),
        ("\"cells\":30", "\"cells\":18446744073709551615"),
        ("\"cells\":30", "\"cells\":-1"),
        ("\"high\":2.9", "\"high\":null"),
        ("\"1/1\"", "\"1/0\""),
        ("\"1/1\"", "\"9/1\""),
        ("\"1/1\"", "1"),
        ("\"exact\"", "\"euler\""),
        ("\"psi\":{\"damping\"", "\"phi\":{\"damping\""),
        ("{\"task\"", "[\"task\""),
    ] {
        assert!(json.contains(from), "{from}");
        let label = format!("{title}{}", json.replacen(from, to, 1));
        workspace.write("bad.part", [empty_tile(&label), tiles.to_vec()].concat());
        let ran = workspace.run("join bad.part --out m.npz");
        refused(&ran, "bad.part: is damaged", &["expected a file that stickslip map --part wrote"]);
    }
}

#[test]
fn files_that_are_not_what_was_written() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    let bytes = fs::read(workspace.path("2.part")).unwrap();
    let join = |bytes: &[u8]| {
        workspace.write("bad.part", bytes);
        let ran = workspace.run("join 1.part bad.part --out m.npz --plot m.svg");
        assert_eq!(workspace.names(), ["1.part", "2.part", "bad.part"]);
        ran
    };
    let end = bytes.len();
    refused(&join(&[]), "bad.part: is not a part of a map", &["--part wrote"]);
    refused(&join(b"PK\x03\x04"), "bad.part: is not a part of a map", &[]);
    refused(&join(&bytes[..200]), "bad.part: is damaged in its header", &[]);
    for cut in [700, 2000, end - 1] {
        let expected = format!("bad.part: is damaged: it has {cut} of {end} bytes");
        refused(&join(&bytes[..cut]), &expected, &["made again with --part 2/2"]);
    }
    let longer = [&bytes[..], b"\n"].concat();
    refused(&join(&longer), "bad.part: is damaged: it has", &[]);
    // Every bit counts.
    for place in (0..end).step_by(end / 60) {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        refused(&join(&changed), "bad.part: is ", &["expected"]);
    }
    let tile = |bytes: &mut Vec<u8>| bytes[end - 100] ^= 16;
    let mut changed = bytes.clone();
    tile(&mut changed);
    let expected = "bad.part: is damaged: tile 3 is not what was written; expected the file as it \
                    was written, or made again with --part 2/2";
    refused(&join(&changed), expected, &[]);
}

#[test]
fn points_that_cannot_be_computed() {
    let workspace = Workspace::new();
    // The tiles have 64 points. The exact solution takes neither the first row nor the last column.
    let line = "map --kappa 0:1.01e16 --psi 0:1e-97 --size 101x2 --method exact";
    let whole = workspace.run(&format!("{line} --out w.npz"));
    let ran = workspace.run(&format!("{line} --part 1/2 --out 1.part"));
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    let [start, end] =
        [" points could not be computed and are NaN and -1 in ", "; the first, kappa = "];
    assert!(ran.stderr.contains(&format!("128{start}1.part{end}")), "{}", ran.stderr);
    let again = workspace.run(&format!("{line} --part 1/2 --out 1.part"));
    assert_eq!(
        (again.code, again.stderr),
        (1, format!("1.part: has part 1/2 already\n{}", ran.stderr))
    );
    workspace.run(&format!("{line} --part 2/2 --out 2.part"));
    let joined = workspace.run("join 2.part 1.part --out m.npz");
    assert_eq!(joined.code, 1);
    assert_eq!(joined.stderr.replace("m.npz", "w.npz"), whole.stderr);
    assert!(
        fs::read(workspace.path("m.npz")).unwrap() == fs::read(workspace.path("w.npz")).unwrap()
    );
    workspace.run("join 2.part 1.part --out m.csv");
    assert_eq!(rows(&workspace.read("m.csv")).len(), 203);
}

#[test]
fn outputs_that_cannot_be_made() {
    let workspace = Workspace::new();
    make(&workspace, LINE, 2);
    fs::create_dir(workspace.path("d.npz")).unwrap();
    let names = workspace.names();
    for (line, out) in [
        ("join 1.part 2.part --out missing/m.npz", "missing/m.npz"),
        ("join 1.part 2.part --out d.npz", "d.npz"),
        ("join 1.part 2.part --out m.npz --plot missing/m.svg", "missing/m.svg"),
        (&format!("{LINE} --part 1/2 --out missing/1.part"), "missing/1.part"),
        (&format!("{LINE} --part 1/2 --out d.npz"), "d.npz"),
    ] {
        let ran = workspace.run(line);
        assert_eq!(ran.code, 1, "{}", ran.stderr);
        assert!(
            ran.stderr.starts_with(&format!("error: {out}: cannot be written: ")),
            "{}",
            ran.stderr
        );
        assert_eq!(workspace.names(), names);
    }
    for part in ["d.npz", "/dev/null"] {
        let ran = workspace.run(&format!("join 1.part {part} --out m.npz"));
        refused(&ran, &format!("{part}: is not a regular file"), &["--part wrote"]);
    }
}

/// Each part has a file of its own. Whoever forgets that loses nothing.
#[test]
fn another_part_of_the_same_map_is_not_replaced() {
    let workspace = Workspace::new();
    assert_eq!(workspace.run(&format!("{LINE} --part 1/2 --out m.npz")).code, 0);
    let before = fs::read(workspace.path("m.npz")).unwrap();
    let ran = workspace.run(&format!("{LINE} --part 2/2 --out m.npz"));
    let expected = "m.npz: holds part 1/2 of this map, which part 2/2 would replace; \
                    expected another --out for each part";
    refused(&ran, expected, &[]);
    assert!(fs::read(workspace.path("m.npz")).unwrap() == before);
    assert_eq!(workspace.names(), ["m.npz"]);
    // The whole map does replace it, and so does a map divided otherwise.
    assert_eq!(workspace.run(&format!("{LINE} --part 2/3 --out m.npz")).code, 0);
    assert_eq!(workspace.run(&format!("{LINE} --out m.npz")).code, 0);
    refused(&workspace.run("join m.npz --out n.npz"), "m.npz: is not a part", &[]);
}

/// Title and JSON of the header of a part, and its tiles.
fn header(bytes: &[u8]) -> (String, String, &[u8]) {
    let title = bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let end = title + bytes[title..].iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (text(&bytes[..title]), text(&bytes[title..end]), &bytes[end + 16..])
}

/// A header with the right checksum.
fn empty_tile(label: &str) -> Vec<u8> {
    stickslip_plane::Tile { eps_t: Vec::new(), switch_count: Vec::new() }.to_bytes(label)
}
