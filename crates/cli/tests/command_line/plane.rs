//! Atlases and maps of systems that are texts.

use serde_json::Value;

use crate::{Workspace, rows};

/// The bounces of a ball from a height of 1 with gravity 1: number n is after
/// √2·(1 + 2e + … + 2eⁿ⁻¹).
const BALL: &str = "parameter height = 1, e = 0.5, unused = 3\nstate x = height, v = 0\nx' = v\n\
                    v' = -1\nwhen x < 0 \"bounce\"\n  x := 0\n  v := -e*v\nend = 3.2\n";

/// When bounce `n` comes.
fn bounce(n: i32, height: f64, e: f64) -> f64 {
    (2.0 * height).sqrt() * (1.0 + (1..n).map(|k| 2.0 * e.powi(k)).sum::<f64>())
}

#[test]
fn the_atlas_of_a_ball_is_that_of_its_closed_form() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let window = "--x e=0.2:0.5 --y height=0.9:1.2 --max-events 4";
    let files = "--out atlas.json --plot atlas.svg";
    let ran = directory.run(&format!("trace ball.slip {window} {files}"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let atlas: Value = serde_json::from_str(&directory.read("atlas.json")).unwrap();
    assert_eq!(atlas["schema"], "stickslip.family-atlas/1");
    assert_eq!(atlas["family"], "ball");
    assert_eq!(atlas["guards"].as_array().unwrap(), &["bounce"]);
    assert_eq!(atlas["axes"].as_array().unwrap(), &["e", "height"]);
    let mut seen = 0;
    for curve in atlas["curves"].as_array().unwrap() {
        // The guard is at zero at the end after so many bounces.
        let bounces = curve["margin"]["exits"].as_array().unwrap().len();
        let n = i32::try_from(1 + bounces).unwrap();
        for node in curve["nodes"].as_array().unwrap() {
            let point: [f64; 2] = serde_json::from_value(node["point"].clone()).unwrap();
            let off = bounce(n, point[1], point[0]) - 3.2;
            assert!(off.abs() < 1e-8, "{n}: {point:?} {off:e}");
            seen += 1;
        }
    }
    assert!(seen > 10 && atlas["regions"].as_array().unwrap().len() >= 3, "{seen}");
    assert!(directory.read("atlas.svg").contains("regions with their number of events"));
    // Points are located without the system.
    directory.write("points.csv", "height,name,e\n1,a,0.21\n1.1,b,0.45\n1.5,c,0.3\n");
    let ran = directory.run("locate --atlas atlas.json --batch points.csv --out located.csv");
    assert_eq!(ran.code, 1);
    let message = "row 3: e = 0.3, height = 1.5 lies outside the window";
    assert!(ran.stderr.contains("1 of 3 points") && ran.stderr.contains(message), "{}", ran.stderr);
    let located = rows(&directory.read("located.csv"));
    assert_eq!(located[0].join(","), "height,name,e,event_count,itinerary,region,distance");
    for (row, e, height) in [(1, 0.21, 1.0), (2, 0.45, 1.1)] {
        let count = (1..5).take_while(|&n| bounce(n, height, e) < 3.2).count();
        let more = if count == 4 { "; …" } else { "" };
        assert_eq!(located[row][3], count.to_string());
        assert_eq!(located[row][4], format!("{}{more}", vec!["bounce"; count].join("; ")));
    }
    assert_eq!(located[3][3..], ["", "", "", ""]);
    let ran = directory.run("locate atlas.json --kappa 1 --psi 1");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("--batch, a file with the columns e and height"), "{}", ran.stderr);
    directory.write("others.csv", "height,f\n1,2\n");
    let ran = directory.run("locate --atlas atlas.json --batch others.csv --out located.csv");
    assert!(ran.stderr.contains("e is missing; expected columns e and height"), "{}", ran.stderr);
    // The same bits on one thread.
    let again = "--threads 1 --out again.json";
    assert_eq!(directory.run(&format!("trace ball.slip {window} {again}")).code, 0);
    assert!(directory.read("atlas.json") == directory.read("again.json"));
}

#[test]
fn the_stack_of_a_ball_changes_where_a_boundary_passes_a_corner() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL.replace("unused = 3", "until = 3").replace("3.2", "until"));
    let window = "--x e=0.2:0.5 --y height=0.9:1.2 --max-events 4";
    let line =
        format!("stack ball.slip {window} --over until=1.95,2.2,3.2 --out s.json --plot s.svg");
    let ran = directory.run(&line);
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    let stack: Value = serde_json::from_str(&directory.read("s.json")).unwrap();
    assert_eq!(
        (&stack["schema"], &stack["objection"]),
        (&"stickslip.family-stack/1".into(), &Value::Null)
    );
    assert_eq!(stack["axes"].as_array().unwrap(), &["e", "height", "until"]);
    assert_eq!(stack["layers"].as_array().unwrap().len(), 3);
    // An event comes at the end at a corner.
    let mut expected = Vec::new();
    for (n, e, height) in (0..16).map(|k| (1 + k / 4, [0.2, 0.5][k % 2], [0.9, 1.2][k / 2 % 2])) {
        let until = bounce(i32::try_from(n).unwrap(), height, e);
        expected.extend((1.95..3.2).contains(&until).then_some((until, e, height)));
    }
    expected.sort_by(|one, other| one.0.total_cmp(&other.0));
    assert!(expected.len() >= 6, "{expected:?}");
    let changes = stack["changes"].as_array().unwrap();
    assert_eq!(changes.len(), expected.len(), "{changes:?}");
    let mut effects = Vec::new();
    for (change, (until, e, height)) in changes.iter().zip(expected) {
        assert_eq!(change["meeting"]["kind"], "corner");
        let found: Vec<f64> = serde_json::from_value(change["meeting"]["point"].clone()).unwrap();
        let value = change["meeting"]["value"].as_f64().unwrap();
        let off = (value - until).abs().max((found[0] - e).abs()).max((found[1] - height).abs());
        assert!(off < 1e-8, "{off:e}: {change} beside {until}");
        effects.extend(change["effects"].as_array().unwrap().iter().map(Value::to_string));
    }
    let born = [r#"{"born":{"fires":[0,0,0]}}"#, r#"{"born":{"begins":[0,0,0,0]}}"#];
    assert_eq!(effects, [born[0], born[1], r#"{"dies":{"fires":[0]}}"#]);
    assert!(directory.read("s.svg").contains("place of a change up to the next until"));
    for (option, message) in [
        ("", "--over is missing"),
        ("--over until=3", "two values or more in ascending order"),
        ("--over until=3,2", "two values or more in ascending order"),
        ("--over e=0.2,0.3", "expected another parameter than --x and --y"),
        ("--over u=1,2", "it has height, e, until"),
        ("--over until=1,2 --kappa 1:2", "cannot be used with"),
    ] {
        let ran = directory.run(&format!("stack ball.slip {window} {option} --out s.json"));
        assert!(ran.code == 2 && ran.stderr.contains(message), "{option}: {}", ran.stderr);
    }
    let lacks = directory.run("stack --kappa 1:2 --out s.json");
    assert!(lacks.code == 2 && lacks.stderr.contains("--psi"), "{}", lacks.stderr);
}

#[test]
fn the_map_of_a_ball_counts_its_bounces() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let window = "--x e=0.1:0.5 --y height=0.9:1.3 --size 8x5 --end 3";
    let ran = directory.run(&format!("map ball.slip {window} --out map.csv --plot map.svg"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let table = rows(&directory.read("map.csv"));
    assert_eq!(table[0].join(","), "e,height,event_count,outcome,end_mode,end_time,end_x,end_v");
    assert_eq!(table.len(), 1 + 40);
    let mut accumulated = 0;
    for row in &table[1..] {
        let at = |column: usize| row[column].parse::<f64>().unwrap();
        let (e, height, count) = (at(0), at(1), row[2].parse::<i32>().unwrap());
        // All bounces come before √(2·height)·(1 + e)/(1 − e).
        let limit = (2.0 * height).sqrt() * (1.0 + e) / (1.0 - e);
        if limit < 3.0 {
            assert_eq!(row[3], "accumulation", "{row:?}");
            assert!((at(5) - limit).abs() < 1e-9, "{row:?}");
            accumulated += 1;
            continue;
        }
        assert!(count == 0 || bounce(count, height, e) < 3.0, "{row:?}");
        assert!(bounce(count + 1, height, e) > 3.0, "{row:?}");
        let (since, up) = (3.0 - bounce(count, height, e), e.powi(count) * (2.0 * height).sqrt());
        assert!((at(6) - (up - 0.5 * since) * since).abs() < 1e-10, "{row:?}");
        assert_eq!((row[3].as_str(), row[4].as_str(), at(5)), ("end", "main", 3.0));
    }
    assert!(accumulated > 5 && accumulated < 35, "{accumulated}");
    let picture = directory.read("map.svg");
    assert!(picture.contains("number of events") && picture.contains("x at the end"));
    let ran = directory.run(&format!("map ball.slip {window} --out map.npz"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
}

#[test]
fn runs_that_fail_are_counted() {
    let directory = Workspace::new();
    directory.write("wild.slip", "parameter a = 1, b = 1\nstate x = sqrt(a)\nx' = b*x^2\nend = 1");
    let ran = directory.run("map wild.slip --x a=-1:1 --y b=0.1:0.5 --size 4x2 --out map.csv");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("4 of 8 runs failed"), "{}", ran.stderr);
    assert!(directory.read("map.csv").contains("-0.75,0.2,-1,failed,,NaN,NaN"));
}

#[test]
fn what_does_not_fit_is_named() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    for (options, message) in [
        ("--x e=0.2:0.5 --y mass=1:2 --out a.json", "--y mass: the system has no such parameter"),
        ("--x e=0.2:0.5 --y e=1:2 --out a.json", "--x and --y are both e"),
        ("--x e=0.5:0.2 --y height=1:2 --out a.json", "expected NAME=LO:HI with LO below HI"),
        ("--x e=0.2:inf --y height=1:2 --out a.json", "expected NAME=LO:HI"),
        ("--x e --y height=1:2 --out a.json", "expected NAME=LO:HI"),
        ("--x e=0.2:0.5 --out a.json", "--y <NAME=LO:HI>"),
        ("--x e=0.2:0.5 --y height=1:2 --kappa 1:2 --out a.json", "cannot be used with"),
        ("--x e=0.2:0.5 --y height=1:2 --geojson g.json --out a.json", "cannot be used with"),
        ("--x e=0.2:0.5 --y height=1:2 --tolerance 1 --out a.json", "a thousandth of the window"),
        ("--x e=0.2:0.5 --y height=1:2 --out ball.slip", "is the same file as the system"),
        ("--x e=0.2:0.5 --y height=1:2 --set mass=1 --out a.json", "no such parameter"),
    ] {
        let ran = directory.run(&format!("trace ball.slip {options}"));
        assert_eq!(ran.code, 2, "{options}: {}", ran.stderr);
        assert!(ran.stderr.contains(message), "{options}: {}", ran.stderr);
    }
    assert_eq!(directory.read("ball.slip"), BALL);
    let ran = directory.run("trace --x e=0.2:0.5 --kappa 1:2 --psi 1:2 --out a.json");
    assert_eq!(ran.code, 2);
    let ran = directory.run("map ball.slip --x e=0:1 --y height=1:2 --size 3x3 --out map.txt");
    assert!(ran.stderr.contains("the name does not tell the format"), "{}", ran.stderr);
    directory.write("endless.slip", "parameter a = 1, b = 1\nstate x = 0\nx' = 1\n");
    let ran = directory.run("trace endless.slip --x a=0:1 --y b=1:2 --out a.json");
    assert!(ran.stderr.contains("the system says no end"), "{}", ran.stderr);
}
