//! Files of collisions.

use std::fmt::Write;

use stickslip_model::{Collider, Contact, exact};
use stickslip_solver::Dop853;

use crate::{Workspace, decimal, reference, rows};

const HEADER: &str = "eps_n,eps_t,switch_count,itinerary,contact_time,reversals,status";

/// A batch that takes little time.
const ROUGH: &str = "collide --batch in.csv --method dopri5 --rtol 1e-3 --atol 1e-3";

/// A file of `count` collisions all over the plane. Some of them are damped.
fn plane(count: u32) -> String {
    let mut text = "kappa,psi,damping\n".to_owned();
    for i in 0..count {
        let kappa = 0.5 + 0.37 * f64::from(i % 211);
        let psi = 0.05 + 2.3 * f64::from(i % 97) / 97.0;
        let damping = if i % 5 == 0 { 0.01 * f64::from(1 + i % 11) } else { 0.0 };
        writeln!(text, "{kappa},{psi},{damping}").unwrap();
    }
    text
}

#[test]
fn numbers_read_back_as_the_library_computes() {
    let workspace = Workspace::with_input("psi,kappa,damping\n2/7,63,0\n1.5,1.8e1,0.05\n");
    let line = "collide --batch in.csv --out out.csv --events ev.csv --method dop853";
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    let by = "by dop853 (rtol 4e-13, atol 4e-13)";
    assert_eq!(ran.said, format!("2 rows computed {by}; wrote out.csv, ev.csv\n"));
    let table = rows(&workspace.read("out.csv"));
    assert_eq!(table[0].join(","), format!("psi,kappa,damping,{HEADER}"));
    let events = rows(&workspace.read("ev.csv"));
    assert_eq!(events[0].join(","), "case,index,time,time_left,to,side,spring,velocity");
    let mut events = events.into_iter().skip(1);

    for (case, (kappa, psi, damping)) in
        [(63.0, 2.0 / 7.0, 0.0), (18.0, 1.5, 0.05)].into_iter().enumerate()
    {
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let collision = Collider::new(Dop853).collide(contact).unwrap();
        let row = &table[case + 1][3..];
        let same = |text: &str, value: f64| {
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
        };
        same(&row[0], collision.eps_n);
        same(&row[1], collision.eps_t());
        assert_eq!(row[2], collision.switches.len().to_string());
        assert_eq!(row[3], collision.itinerary());
        same(&row[4], collision.contact_time);
        assert_eq!(row[5], collision.reversals.to_string());
        assert_eq!(row[6], "ok");
        for (index, switch) in collision.switches.iter().enumerate() {
            let event = events.next().unwrap();
            assert_eq!(event[..2], [case.to_string(), index.to_string()]);
            same(&event[2], switch.time);
            same(&event[3], switch.time_left);
            assert_eq!(event[4], switch.to.to_string());
            assert_eq!(event[5], format!("{}", switch.side.sign()));
            same(&event[6], switch.spring);
            same(&event[7], switch.velocity);
        }
    }
    assert_eq!(events.next(), None);
}

#[test]
fn events_say_the_same_as_json() {
    let workspace = Workspace::with_input("kappa,psi\n63,0.5\n");
    assert_eq!(workspace.run("collide --batch in.csv --out o --events e").code, 0);
    let json = workspace.run("collide --kappa 63 --psi 0.5 --format json").stdout;
    let object: serde_json::Value = serde_json::from_str(&json).unwrap();
    let events = rows(&workspace.read("e"));
    assert_eq!(events.len(), 7);
    for (event, switch) in events[1..].iter().zip(object["switches"].as_array().unwrap()) {
        for (column, name) in events[0].iter().enumerate().skip(2) {
            match &switch[name.as_str()] {
                serde_json::Value::String(text) => assert_eq!(text, &event[column]),
                number => assert_eq!(number.as_f64(), event[column].parse().ok(), "{name}"),
            }
        }
    }
}

#[test]
fn other_columns_pass_through_unchanged() {
    // Names and fields have quotes, blanks, a line end, and bytes that are not UTF-8.
    let header = b"id,\xE9tat, psi ,\"a, \"\"b\"\"\",kappa";
    let row = b" 007 ,\xFF,1,\"x\ny\",18";
    let workspace = Workspace::new();
    workspace.write("in.csv", [&header[..], b"\n", row, b"\n"].concat());
    let ran = workspace.run("collide --batch in.csv --out out.csv");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let written = std::fs::read(workspace.path("out.csv")).unwrap();
    let first = [&header[..], b",", HEADER.as_bytes(), b"\n", row, b","].concat();
    assert_eq!(written[..first.len()], first);
    assert_eq!(String::from_utf8_lossy(&written).lines().count(), 3);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    // There are more rows than a portion has.
    let workspace = Workspace::with_input(&plane(20_000));
    let mut first = None;
    for threads in ["--threads 1", "--threads 2", "--threads 4", ""] {
        let ran = workspace.run(&format!("{ROUGH} --out o --events e {threads}"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let results = (workspace.read("o"), workspace.read("e"));
        assert_eq!(rows(&results.0).len(), 20_001);
        assert!(first.get_or_insert_with(|| results.clone()) == &results, "{threads}");
    }
}

#[test]
fn cases_are_numbered_through_all_portions() {
    let workspace = Workspace::with_input(&plane(17_000));
    assert_eq!(workspace.run(&format!("{ROUGH} --out o --events e")).code, 0);
    let counts: Vec<usize> =
        rows(&workspace.read("o"))[1..].iter().map(|row| row[5].parse().unwrap()).collect();
    let mut found = vec![0; counts.len()];
    for event in &rows(&workspace.read("e"))[1..] {
        let (case, index): (usize, usize) = (event[0].parse().unwrap(), event[1].parse().unwrap());
        assert_eq!(index, found[case]);
        found[case] += 1;
    }
    assert_eq!(found, counts);
}

#[test]
fn collisions_with_very_many_switches() {
    let workspace = Workspace::with_input("kappa,psi\n1e10,1\n18,1\n1e10,0.5\n1e10,0.3\n");
    let ran = workspace.run("collide --batch in.csv --out o --method exact");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let table = rows(&workspace.read("o"));
    let contact = Contact::new(1e10, 0.3, 0.0).unwrap();
    assert_eq!(table[4][5], exact::collide(contact).unwrap().itinerary());
    assert_eq!(table[2][4], "4");
}

#[test]
fn options_give_what_the_file_does_not() {
    let expected = |kappa: f64, psi: f64| {
        let contact = Contact::new(kappa, psi, 0.0).unwrap();
        format!("{:?}", exact::collide(contact).unwrap().eps_t())
    };
    for (input, options, kappa, psi) in [
        ("psi\n0.5\n", "--kappa 18", 18.0, 0.5),
        ("kappa\n18\n", "--psi 0.5", 18.0, 0.5),
        ("kappa\n18\n", "--ratio 1.4", 18.0, 1.4 * (2.0 / 7.0) / 0.4),
        ("kappa,ratio\n18,1.4\n", "", 18.0, 1.4 * (2.0 / 7.0) / 0.4),
        ("kappa,ratio,mu\n18,1.4,0.5\n", "--alpha 0.3", 18.0, 1.4 * 0.3 / 0.5),
        ("kappa,ratio,alpha,mu\n18,1.4,1/4,1/2\n", "--damping 0", 18.0, 1.4 * 0.25 / 0.5),
        ("mu\n0.5\n", "--kappa 18 --ratio 1.4", 18.0, 1.4 * (2.0 / 7.0) / 0.5),
        // Beside psi, the columns mu and alpha have no meaning.
        ("kappa,psi,mu,alpha\n18,0.5,?,\n", "", 18.0, 0.5),
    ] {
        let workspace = Workspace::with_input(input);
        let line = format!("collide --batch in.csv --out out.csv --method exact {options}");
        let ran = workspace.run(&line);
        assert_eq!(ran.code, 0, "{input:?}: {}", ran.stderr);
        let table = rows(&workspace.read("out.csv"));
        let column = table[0].iter().position(|name| name == "eps_t").unwrap();
        assert_eq!(table[1][column], expected(kappa, psi), "{input:?} {options}");
    }
}

#[test]
fn blanks_and_line_ends() {
    // The file has a byte order mark, Windows line ends, blanks around names and numbers, blank
    // lines, and no line end at its end.
    let workspace = Workspace::with_input("\u{feff}kappa , psi\r\n\r\n 18, 1\r\n\r\n\r\n63,1");
    let ran = workspace.run("collide --batch in.csv --out out.csv");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let table = rows(&workspace.read("out.csv"));
    let counts: Vec<_> = table[1..].iter().map(|row| row[4].as_str()).collect();
    assert_eq!(counts, ["4", "8"]);
}

#[test]
fn a_header_without_rows() {
    let workspace = Workspace::with_input("kappa,psi\n");
    let ran = workspace.run("collide --batch in.csv --out out.csv --events ev.csv");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(ran.said.starts_with("0 rows computed"), "{}", ran.said);
    assert_eq!(workspace.read("out.csv"), format!("kappa,psi,{HEADER}\n"));
    assert_eq!(rows(&workspace.read("ev.csv")).len(), 1);
}

#[test]
fn earlier_results_are_replaced() {
    let workspace = Workspace::with_input("kappa,psi\n18,1\n");
    workspace.write("out.csv", "old");
    assert_eq!(workspace.run("collide --batch in.csv --out out.csv").code, 0);
    assert!(workspace.read("out.csv").starts_with("kappa,psi,eps_n"));
    assert_eq!(workspace.names(), ["in.csv", "out.csv"]);
}

#[test]
fn the_reference_collisions_in_one_file() {
    let cases = reference("undamped_random.json", "cases");
    let mut input = "kappa,psi\n".to_owned();
    for case in &cases {
        let (kappa, psi) = (case["kappa"].as_str().unwrap(), case["psi"].as_str().unwrap());
        writeln!(input, "{kappa},{psi}").unwrap();
    }
    let workspace = Workspace::with_input(&input);
    assert_eq!(workspace.run("collide --batch in.csv --out out.csv").code, 0);
    let table = rows(&workspace.read("out.csv"));
    assert_eq!(table.len(), cases.len() + 1);
    for (case, row) in cases.iter().zip(&table[1..]) {
        let error = row[3].parse::<f64>().unwrap() - decimal(&case["eps_t"]);
        assert!(error.abs() * decimal(&case["psi"]) < 1e-12, "{row:?}: {error}");
        assert_eq!(row[4], case["switch_count"].to_string(), "{row:?}");
        assert_eq!(row[5].len(), row[4].parse::<usize>().unwrap() + 1);
    }
}

#[test]
fn estimates_follow_the_results() {
    let workspace = Workspace::with_input("kappa,psi,damping\n18,1.99,0\n18,-1,0\n63,0.5,0.01\n");
    let ran = workspace.run("collide --batch in.csv --out out.csv --estimate");
    assert_eq!(ran.code, 1);
    let table = rows(&workspace.read("out.csv"));
    assert_eq!(
        table[0].join(","),
        format!("kappa,psi,damping,{HEADER},eps_t_error,distance,certain")
    );
    assert_eq!(table[2][10..], ["", "", ""]);
    for row in [&table[1], &table[3]] {
        let [error, distance] = [10, 11].map(|column| row[column].parse::<f64>().unwrap());
        assert!(error > 0.0 && error < 2e-11 && distance > 1e-3, "{row:?}");
        assert_eq!(row[12], "true");
    }
    // A column may have the name of an estimate that is not wanted.
    let workspace = Workspace::with_input("kappa,psi,distance\n18,1,7\n");
    assert_eq!(workspace.run("collide --batch in.csv --out o").code, 0);
    let ran = workspace.run("collide --batch in.csv --out o --estimate");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("column distance has the name of a result"), "{}", ran.stderr);
}

#[test]
fn terms_of_the_law_are_no_columns() {
    for term in ["dynamic_friction", "friction_decay", "pull_off", "pull-off", "LAW"] {
        let workspace = Workspace::with_input(&format!("kappa,psi,{term}\n18,1,0.5\n"));
        let ran = workspace.run("collide --batch in.csv --out o");
        assert_eq!(ran.code, 2);
        let option = format!("expected --{}", term.replace('_', "-").to_lowercase());
        assert!(ran.stderr.contains(&option), "{}", ran.stderr);
    }
    for (name, own) in [("E-N", "e_n"), ("tangential-damping", "tangential_damping")] {
        let workspace = Workspace::with_input(&format!("kappa,psi,{name}\n18,1,0.5\n"));
        let ran = workspace.run("collide --batch in.csv --out o");
        assert_eq!(ran.code, 2);
        let said = format!("column {name} is not read; expected {own}, or another name");
        assert!(ran.stderr.contains(&said), "{}", ran.stderr);
    }
}

#[test]
fn results_go_to_standard_output_unless_a_file_is_named() {
    let workspace = Workspace::with_input("kappa,psi\n18,1\n");
    assert_eq!(workspace.run("collide --batch in.csv --out out.csv").code, 0);
    let table = workspace.read("out.csv");
    for line in ["collide --batch in.csv", "collide --batch in.csv --out -"] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (0, table.as_str()), "{}", ran.stderr);
        assert_eq!(ran.said, "1 row computed by the exact solution; wrote standard output\n");
    }
    assert_eq!(workspace.names(), ["in.csv", "out.csv"]);
    let ran = workspace.run("collide --batch in.csv --events /dev/stdout");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("same file"), "{}", ran.stderr);
}
