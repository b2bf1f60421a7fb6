//! Systems that are texts.

use serde_json::Value;

use crate::{Workspace, rows, stickslip};

const BALL: &str = "parameter g = 9.81, e = 0.5\nstate x = 4.905, v = 0\nx' = v\nv' = -g\n\
                    when x < 0 \"bounce\"\n  x := 0\n  v := -e*v\nend = 2.9\n";

#[test]
fn a_system_runs_and_is_written() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let outputs = "--events events.csv --course course.csv --points 30 --plot ball.svg";
    let ran = directory.run(&format!("run ball.slip {outputs}"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert!(ran.stdout.contains("bounce  1.000000000  main  main"), "{}", ran.stdout);
    assert!(ran.stdout.contains("guards         decided"), "{}", ran.stdout);
    let events = rows(&directory.read("events.csv"));
    assert_eq!(
        events[0].join(","),
        "time,event,mode_before,mode_after,x_before,v_before,x_after,v_after"
    );
    assert_eq!(events.len(), 6);
    assert!((events[2][0].parse::<f64>().unwrap() - 2.0).abs() < 1e-13);
    assert_eq!((events[1][1].as_str(), events[1][6].as_str()), ("bounce", "0.0"));
    // Even times, and both sides of each event.
    let course = rows(&directory.read("course.csv"));
    assert_eq!(course[0].join(","), "time,mode,event,x,v");
    assert_eq!(course.len(), 1 + 30 + 2 * 5);
    let at = |row: &[String], column: usize| row[column].parse::<f64>().unwrap();
    for row in &course[1..11] {
        assert!((at(row, 3) - (4.905 - 4.905 * at(row, 0).powi(2))).abs() < 1e-10, "{row:?}");
    }
    let picture = directory.read("ball.svg");
    assert!(picture.starts_with("<svg") && picture.contains("time t"));
}

#[test]
fn parameters_and_the_end_are_options() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let ran = directory.run("run ball.slip --set e=0 --set g=4.905 --end 1.4 --format json");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(
        (found["schema"].as_str(), found["outcome"].as_str()),
        (Some("stickslip.run/1"), Some("end"))
    );
    assert_eq!((&found["parameters"]["e"], &found["time"]), (&0.0.into(), &1.4.into()));
    assert!((found["state"]["x"].as_f64().unwrap() - (4.905 - 2.4525 * 1.96)).abs() < 1e-10);
    assert_eq!(found["decided"], true);
    for (options, message) in [
        ("--set h=1", "--set h: the system has no such parameter; it has g, e"),
        ("--set g", "expected NAME=VALUE"),
        ("--end 0", "expected an end after 0"),
        ("--method euler", "possible values: dopri5, dop853"),
        ("--events ball.slip", "is the same file as the system"),
    ] {
        let ran = directory.run(&format!("run ball.slip {options}"));
        assert_eq!(ran.code, 2, "{options}");
        assert!(ran.stderr.contains(message), "{options}: {}", ran.stderr);
        assert_eq!(directory.read("ball.slip"), BALL);
    }
}

#[test]
fn a_run_goes_on_behind_an_accumulation() {
    let directory = Workspace::new();
    let text = "state x = 0.5, v = 0\nx' = v\nmode fall\n  v' = -1\n  when x < 0 \"floor\"\n    \
                x := 0\n    v := -0.5*v\n    rest -> lie\n    v := 0\nmode lie\n  v' = 0\nend = 6\n";
    directory.write("ball.slip", text);
    let ran = directory.run("run ball.slip --format json --course course.csv --points 13");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((&found["outcome"], &found["mode"]), (&"end".into(), &"lie".into()));
    let rest = &found["rests"][0];
    assert!((rest["time"].as_f64().unwrap() - 3.0).abs() < 1e-9, "{rest}");
    assert_eq!((&rest["from"], &rest["to"]), (&"fall".into(), &"lie".into()));
    let course = rows(&directory.read("course.csv"));
    assert_eq!(course.last().unwrap()[..2], ["6.0", "lie"]);
    assert!(directory.run("run ball.slip").stdout.contains("accumulations passed  1"));
}

#[test]
fn mistakes_are_shown_with_their_place() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL.replace("-g", "-gg"));
    let ran = directory.run("run ball.slip");
    assert_eq!(ran.code, 2);
    let expected = "ball.slip: line 4, column 7: `gg` is not known; did you mean `g`?\n    \
                    v' = -gg\n          ^";
    assert!(ran.stderr.contains(expected), "{}", ran.stderr);
    directory.write("endless.slip", "state x = 0\nx' = 1\n");
    let ran = directory.run("run endless.slip");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("the system says no end"), "{}", ran.stderr);
    directory.write("wild.slip", "state x = 1\nx' = x^2\nend = 2\n");
    let ran = directory.run("run wild.slip --events e.csv");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("the run failed"), "{}", ran.stderr);
    assert!(!directory.path("e.csv").exists());
}

#[test]
fn a_system_is_printed_in_its_usual_form() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let tidy = directory.run("system ball.slip --format");
    assert_eq!((tidy.code, tidy.stdout.as_str()), (0, BALL));
    let shown = directory.run("system ball.slip");
    directory.write("again.slip", &shown.stdout);
    let [one, other] = ["ball", "again"].map(|name| directory.run(&format!("run {name}.slip")));
    assert_eq!(one.stdout, other.stdout);
    assert_eq!(stickslip("system nowhere.slip").code, 2);
}

#[test]
fn rules_that_lead_to_each_other_are_named() {
    let directory = Workspace::new();
    let text = "state x = 0\nmode up\n  x' = 1\n  when x > 1 \"top\" -> down\nmode down\n  x' = 1\n  \
                when x < 2 \"bottom\" -> up\nstart in up\nend = 5\n";
    directory.write("cycle.slip", text);
    for line in ["run cycle.slip", "converge cycle.slip --out study"] {
        let ran = directory.run(line);
        assert_eq!(ran.code, 1, "{line}");
        assert!(ran.stderr.contains("`top` of mode up, `bottom` of mode down"), "{}", ran.stderr);
    }
}
