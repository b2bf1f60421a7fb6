//! Files that cannot be used, rows that cannot be computed, results that cannot be stored.

use crate::{Workspace, rows};

const BATCH: &str = "collide --batch in.csv --out out.csv";

/// Runs a batch with the file `input`, which must be refused as a whole with a message that
/// contains all of `parts`.
fn refused(input: &str, options: &str, parts: &[&str]) {
    let workspace = Workspace::with_input(input);
    let ran = workspace.run(&format!("{BATCH} --events ev.csv {options}"));
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{input:?}: {}", ran.stderr);
    for part in ["in.csv"].iter().chain(parts) {
        assert!(ran.stderr.contains(part), "{input:?}: no {part:?} in {}", ran.stderr);
    }
    assert_eq!(workspace.names(), ["in.csv"], "{input:?}");
}

#[test]
fn headers_that_do_not_make_a_collision() {
    refused("psi\n1\n", "", &["kappa", "--kappa", "columns are: psi"]);
    refused("Kappa,psi\n1,1\n", "", &["column Kappa is not read", "expected kappa"]);
    refused("kappa;psi\n1;1\n", "", &["kappa is missing", "kappa;psi"]);
    refused("kappa\n1\n", "", &["psi and ratio are missing", "exactly one"]);
    refused("kappa,psi,ratio\n1,1,1\n", "", &["psi and ratio are both given", "exactly one"]);
    refused("kappa,psi\n1,1\n", "--ratio 1", &["psi and ratio are both given"]);
    refused("kappa,psi\n1,1\n", "--kappa 1", &["column kappa", "--kappa"]);
    refused("kappa,ratio,mu\n1,1,1\n", "--mu 1", &["column mu", "--mu"]);
    refused("kappa,psi\n1,1\n", "--mu 1", &["--mu", "ratio only"]);
    refused("kappa,psi,kappa\n1,1,1\n", "", &["two columns", "'kappa'"]);
    refused("kappa,psi,id, id\n1,1,1,1\n", "", &["two columns", "'id'"]);
    refused("kappa,psi,status\n1,1,x\n", "", &["column status", "name of a result"]);
    refused("", "", &["empty", "header row"]);
    refused("\n\n", "", &["empty", "header row"]);
}

#[test]
fn inputs_that_cannot_be_read() {
    let workspace = Workspace::new();
    let ran = workspace.run(BATCH);
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("in.csv: cannot be read"), "{}", ran.stderr);
    let ran = workspace.run("collide --batch . --out out.csv");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains(".: cannot be read"), "{}", ran.stderr);
    assert!(workspace.names().is_empty());
}

#[test]
fn outputs_that_are_the_input_or_each_other() {
    for (line, parts) in [
        ("collide --batch in.csv --out in.csv", ["--out", "--batch"]),
        ("collide --batch in.csv --out ./in.csv", ["--out", "--batch"]),
        ("collide --batch in.csv --out o --events in.csv", ["--events", "--batch"]),
        ("collide --batch in.csv --out o --events ./o", ["--events", "--out"]),
    ] {
        let workspace = Workspace::with_input("kappa,psi\n1,1\n");
        let ran = workspace.run(line);
        assert_eq!(ran.code, 2, "{line}");
        for part in parts.into_iter().chain(["same file"]) {
            assert!(ran.stderr.contains(part), "{line}: {}", ran.stderr);
        }
        assert_eq!(workspace.names(), ["in.csv"]);
        assert_eq!(workspace.read("in.csv"), "kappa,psi\n1,1\n");
    }
}

#[test]
fn a_row_that_cannot_be_computed_does_not_stop_the_others() {
    let input = "id,kappa,psi,damping\n\
                 a,18,1,0\n\
                 b,18,abc,0\n\
                 c,,1,0\n\
                 \n\
                 d,18,-1,0\n\
                 \"e\ne\",18,1,nan\n\
                 f,18\n\
                 g,18,1,0,9,9\n\
                 h,18,1/0,0\n\
                 i,63,1,0\n";
    let workspace = Workspace::with_input(input);
    let ran = workspace.run(&format!("{BATCH} --events ev.csv"));
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert_eq!(
        ran.stderr,
        "error: 7 of 9 rows could not be computed; the column status of out.csv says why\n"
    );
    let table = rows(&workspace.read("out.csv"));
    assert_eq!(table.len(), 10);
    let written = "written like 18, 1.5e3 or 2/7";
    for (row, (id, status)) in table[1..].iter().zip([
        ("a", "ok".to_owned()),
        (
            "b",
            format!(
                "line 3: psi = 'abc': not a number; expected a finite number above 0, {written}"
            ),
        ),
        (
            "c",
            format!("line 4: kappa = '': empty; expected a finite number, 0 or above, {written}"),
        ),
        ("d", "line 6: psi = '-1': out of range; expected a finite number above 0".to_owned()),
        (
            "e\ne",
            format!(
                "line 7: damping = 'nan': not a number; \
                 expected a finite number, 0 or above, {written}"
            ),
        ),
        ("f", "line 9: 2 fields; expected one for each column of the header, 4".to_owned()),
        ("g", "line 10: 6 fields; expected one for each column of the header, 4".to_owned()),
        (
            "h",
            format!(
                "line 11: psi = '1/0': division by 0; \
                 expected a finite number above 0, {written}"
            ),
        ),
        ("i", "ok".to_owned()),
    ]) {
        assert_eq!((row[0].as_str(), &row[10]), (id, &status));
        let results = &row[4..10];
        assert!(results.iter().all(|field| field.is_empty() == (status != "ok")), "{row:?}");
    }
    // The events of the last row have its number.
    let events = rows(&workspace.read("ev.csv"));
    let cases: Vec<_> = events[1..].iter().map(|event| event[0].as_str()).collect();
    assert_eq!(cases.iter().filter(|case| **case == "0").count(), 4);
    assert_eq!(cases.iter().filter(|case| **case == "8").count(), 8);
    assert_eq!(cases.len(), 12);
}

#[test]
fn lines_are_counted_right_in_a_long_file() {
    for end in ["\n", "\r\n"] {
        // Each row takes three lines. One of them is blank.
        let row = format!("\"two{end}lines\",18,3{end}{end}");
        let input = format!("note,kappa,psi{end}{}last,18,?{end}", row.repeat(20_000));
        let workspace = Workspace::with_input(&input);
        assert_eq!(workspace.run(&format!("{BATCH} --method exact")).code, 1);
        let table = rows(&workspace.read("out.csv"));
        assert!(table[20_001][9].starts_with("line 60002: psi = '?'"), "{:?}", table[20_001]);
        assert_eq!(table[20_000][0], format!("two{end}lines"));
    }
}

/// What no CSV file of collisions has is refused with its line, and nothing is written.
#[test]
fn sizes_are_bounded() {
    let rows = "18,0.5\n".repeat(1000);
    let wide = |columns: usize| {
        format!("kappa,psi{}\n18,0.5{}\n", ",x".repeat(columns - 2), ",1".repeat(columns - 2))
    };
    for (input, parts) in [
        (format!("kappa,psi\n18,1\n18,\"0.5\n{rows}"), ["line 3:", "quote", "within 100 lines"]),
        ("kappa,psi\n\n18,1\n\"18,1\n".to_owned(), ["line 4:", "quote", "not closed"]),
        ("\"kappa,psi\n18,1\n".to_owned(), ["line 1:", "quote", "not closed"]),
        ("\u{feff}\"kappa,psi\n18,1\n".to_owned(), ["line 1:", "quote", "not closed"]),
        (format!("kappa,psi\r\n18,{}", "1".repeat(2_000_000)), ["line 2:", "field", "1048576"]),
        (format!("kappa,psi{}1,1\n", "\n".repeat(1_000_002)), ["line", "blank lines", "1000000"]),
        (wide(10_001), ["line 1:", "fields", "at most 10000"]),
        (
            format!("kappa,psi\n18,1{}\n", ",".repeat(10_000)),
            ["line 2:", "fields", "at most 10000"],
        ),
    ] {
        let workspace = Workspace::with_input(&input);
        let ran = workspace.run(BATCH);
        assert_eq!(ran.code, 2, "{parts:?}: {}", ran.stderr);
        for part in parts {
            assert!(ran.stderr.contains(part), "no {part:?} in {}", ran.stderr);
        }
        assert_eq!(workspace.names(), ["in.csv"]);
    }
    // What is just inside.
    for input in [
        format!("kappa,psi,note\n18,1,\"{}\"\n", "line\n".repeat(99)),
        "\u{feff}\"kappa\",psi,note\n18,1,\"a \"\"quote\"\"\"\n".to_owned(),
        "kappa,psi,note\n18,1,5\" of rain\n18,1,\"\"\n".to_owned(),
        format!("kappa,psi,note\n18,1,{}", "x".repeat(1 << 20)),
    ] {
        let workspace = Workspace::with_input(&input);
        let ran = workspace.run(&format!("{BATCH} --method exact"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
    }
}

/// The message about columns does not repeat thousands of them.
#[test]
fn a_header_of_many_columns_is_shown_shortened() {
    let header: Vec<_> = (0..9_000).map(|column| format!("c{column}")).collect();
    let workspace = Workspace::with_input(&format!("{},psi\n", header.join(",")));
    let ran = workspace.run(BATCH);
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("kappa is missing") && ran.stderr.contains('…'), "{}", ran.stderr);
    assert!(ran.stderr.len() < 3000);
}

#[test]
fn a_row_that_the_method_cannot_compute() {
    let workspace = Workspace::with_input("kappa,psi,damping\n18,1,2e4\n1e17,1,0\n18,1,0\n");
    let ran = workspace.run(&format!("{BATCH} --method exact"));
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    let table = rows(&workspace.read("out.csv"));
    assert!(table[1][9].contains("damping = 20000.0"), "{:?}", table[1]);
    assert!(table[2][9].contains("1e16"), "{:?}", table[2]);
    assert_eq!(table[3][9], "ok");
}

#[test]
fn a_long_or_strange_text_is_shown_shortened() {
    let workspace =
        Workspace::with_input(&format!("kappa,psi\n18,{}\n18,\t\u{7}\n", "9x".repeat(99)));
    assert_eq!(workspace.run(BATCH).code, 1);
    let table = rows(&workspace.read("out.csv"));
    assert!(table[1][8].contains(&format!("psi = '{}…': not", "9x".repeat(20))), "{:?}", table[1]);
    assert!(table[2][8].contains(r"psi = '\t\u{7}': not"), "{:?}", table[2]);
}

#[test]
fn outputs_that_cannot_be_made() {
    for (out, events) in [
        ("missing/out.csv", "ev.csv"),
        ("out.csv", "missing/ev.csv"),
        ("in.csv/out.csv", "ev.csv"),
        (".", "ev.csv"),
    ] {
        let workspace = Workspace::with_input("kappa,psi\n18,1\n");
        let line = format!("collide --batch in.csv --out {out} --events {events}");
        let ran = workspace.run(&line);
        assert_eq!(ran.code, 1, "{line}: {}", ran.stderr);
        let bad = if events.contains('/') { events } else { out };
        assert!(
            ran.stderr.starts_with(&format!("error: {bad}: cannot be written: ")),
            "{}",
            ran.stderr
        );
        assert!(!ran.stderr.contains("partial"), "{}", ran.stderr);
        assert_eq!(workspace.names(), ["in.csv"], "{line}");
    }
}

/// A limit on the size of files stands for a disk that fills up while results are written.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_everything_as_it_was() {
    use std::fmt::Write;
    use std::process::Command;

    let mut input = "kappa,psi\n".to_owned();
    for i in 1..=2000 {
        writeln!(input, "63,{}", 0.001 * f64::from(i)).unwrap();
    }
    let workspace = Workspace::with_input(&input);
    workspace.write("out.csv", "old");
    // Signal 25, which is sent at the limit, is ignored. Writing then fails as on a full disk.
    let script = format!(
        "trap '' 25; ulimit -f 16; exec '{}' {BATCH} --events ev.csv --method exact",
        assert_cmd::cargo::cargo_bin!("stickslip").display()
    );
    let output =
        Command::new("sh").args(["-c", &script]).current_dir(workspace.path("")).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot be written"), "{message}");
    assert_eq!(workspace.names(), ["in.csv", "out.csv"]);
    assert_eq!(workspace.read("out.csv"), "old");
}

#[cfg(target_os = "linux")]
#[test]
fn devices_are_written_and_stay_devices() {
    use std::os::unix::fs::FileTypeExt;

    let workspace = Workspace::with_input("kappa,psi\n18,1\n");
    let ran = workspace.run("collide --batch in.csv --out /dev/full");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("/dev/full: cannot be written: No space"), "{}", ran.stderr);
    let ran = workspace.run("collide --batch in.csv --out /dev/stdout --events /dev/null");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(rows(&ran.stdout).len(), 2);
    for device in ["/dev/full", "/dev/null"] {
        assert!(std::fs::metadata(device).unwrap().file_type().is_char_device(), "{device}");
    }
}

/// A part of a byte order mark is text of the first field, wherever that ends.
#[test]
fn a_part_of_a_mark_belongs_to_the_header() {
    let header = |bytes: &[u8]| [bytes, b"\"x,kappa,psi\n\"a\",18,1\nb,18,1\n"].concat();
    for (input, rows, message) in [
        (header(b"\xef"), 2, ""),
        (header(b"\xef\xbb"), 2, ""),
        (b"\xef\nkappa,psi\n18,1\n".to_vec(), 0, "kappa is missing"),
        (b"\xef\xbb\r\nkappa,psi\n18,1\n".to_vec(), 0, "kappa is missing"),
        (b"\xef\xbb".to_vec(), 0, "kappa is missing"),
        (b"\xef\xbb\xbf".to_vec(), 0, "is empty"),
    ] {
        let workspace = Workspace::new();
        workspace.write("in.csv", &input);
        let ran = workspace.run(BATCH);
        assert_eq!(ran.code, if rows > 0 { 0 } else { 2 }, "{input:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(message), "{}", ran.stderr);
        if rows > 0 {
            let written = std::fs::read(workspace.path("out.csv")).unwrap();
            assert_eq!(written.split(|byte| *byte == b'\n').count(), rows + 2);
        }
    }
}
