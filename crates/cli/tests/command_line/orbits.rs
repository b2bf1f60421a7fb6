//! Periodic orbits of systems that are texts.

use serde_json::Value;

use crate::{Workspace, rows};

const BALL: &str = "parameter a = 0.02, r = 0.7\nstate x = 0.015, v = 0.5, phase = 0.8\n\
                    table = a*sin(phase)\nx' = v\nv' = -1\nphase' = 2*pi\n\
                    when x < table \"bounce\"\n  x := table\n  v := (1 + r)*table' - r*v\n\
                    when phase > 2*pi \"period\"\n  phase := phase - 2*pi\nend = 20\n";

#[test]
fn an_orbit_is_found_and_written() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let ran = directory.run(
        "orbit ball.slip --itinerary period,bounce --out orbit.json --plot orbit.svg --format json",
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    let orbit = &found["orbit"];
    assert_eq!(found["schema"], "stickslip.orbit/1");
    assert_eq!((&orbit["admissible"], &orbit["stable"]), (&true.into(), &true.into()));
    assert!((orbit["period"].as_f64().unwrap() - 1.0).abs() < 1e-13);
    // cos φ = T(1 − r)/(2(1 + r)Aω), and the product of the multipliers is r².
    let phase = orbit["segments"][0]["state"][2].as_f64().unwrap();
    let cos: f64 = 0.3 / (2.0 * 1.7 * 0.02 * std::f64::consts::TAU);
    assert!((phase - cos.acos()).abs() < 1e-11);
    let written: Value = serde_json::from_str(&directory.read("orbit.json")).unwrap();
    assert_eq!(written["orbit"], found["orbit"]);
    assert!(written["digests"]["orbit"].is_string());
    assert!(directory.read("orbit.svg").starts_with("<svg"));
    // A run settles to the same orbit.
    let settled = directory.run("orbit ball.slip --settle 100");
    assert_eq!(settled.code, 0, "{}", settled.stderr);
    assert!(settled.stdout.contains("followed by the system  yes"), "{}", settled.stdout);
    assert!(settled.stdout.contains("period                  1.000000000"), "{}", settled.stdout);
}

#[test]
fn a_branch_is_followed_and_written() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let ran = directory.run(
        "branch ball.slip --itinerary period,bounce --over a=0.005:0.05 --out branch.json \
         --table branch.csv --plot branch.svg --show v",
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("fold"), "{}", ran.stdout);
    let written: Value = serde_json::from_str(&directory.read("branch.json")).unwrap();
    assert_eq!(written["schema"], "stickslip.orbit-branch/1");
    let specials = written["specials"].as_array().unwrap();
    let flip = specials.iter().find(|it| it["kind"] == "flip").expect("a flip");
    assert!((flip["value"].as_f64().unwrap() - 0.029654967002).abs() < 1e-11);
    let table = rows(&directory.read("branch.csv"));
    assert_eq!(table[0][..6].join(","), "a,special,period,stable,followed,multiplier");
    let points = written["points"].as_array().unwrap().len();
    assert_eq!(table.len(), 1 + points + specials.len());
    // The flip over two parameters: Aω² sin φ = 2(1 + r²)/(1 + r)².
    let curve = directory.run(
        "curve ball.slip --branch branch.json --kind flip --x r=0.6:0.8 --y a=0.01:0.06 \
         --out curve.json --plot curve.svg",
    );
    assert_eq!(curve.code, 0, "{}", curve.stderr);
    let curve: Value = serde_json::from_str(&directory.read("curve.json")).unwrap();
    assert_eq!(curve["schema"], "stickslip.orbit-curve/1");
    let points = curve["points"].as_array().unwrap();
    assert!(points.len() > 5);
    for point in points {
        let [r, a] = ["r", "a"].map(|name| point["parameters"][name].as_f64().unwrap());
        let w = std::f64::consts::TAU;
        let cos = (1.0 - r) / (2.0 * (1.0 + r)) / w;
        let sin = 2.0 * (1.0 + r * r) / (1.0 + r).powi(2) / (w * w);
        assert!((a - cos.hypot(sin)).abs() < 1e-11, "{r} {a}");
    }
    let unknown = directory
        .run("curve ball.slip --branch branch.json --kind graze --x r=0.6:0.8 --y a=0.01:0.06");
    assert_eq!(unknown.code, 2, "{}", unknown.stderr);
    assert!(unknown.stderr.contains("--kind graze: expected one of the branch"));
    // It goes on from its last orbit.
    let near = directory.run("orbit ball.slip --near branch.json --set a=0.048 --format json");
    assert_eq!(near.code, 0, "{}", near.stderr);
    let near: Value = serde_json::from_str(&near.stdout).unwrap();
    assert_eq!(near["orbit"]["parameters"]["a"], 0.048);
    // The orbit of twice the period that begins at the flip.
    let doubled = directory.run("orbit ball.slip --near branch.json --switch flip --format json");
    assert_eq!(doubled.code, 0, "{}", doubled.stderr);
    let doubled: Value = serde_json::from_str(&doubled.stdout).unwrap();
    assert!((doubled["orbit"]["period"].as_f64().unwrap() - 2.0).abs() < 1e-12);
    let fold = directory.run("orbit ball.slip --near branch.json --switch fold");
    assert!(fold.stderr.contains("expected a `flip` or a `branch-point`"), "{}", fold.stderr);
    let damaged = directory.read("branch.json").replacen("\"period\":1.0", "\"period\":1.1", 1);
    directory.write("damaged.json", &damaged);
    let refused = directory.run("orbit ball.slip --near damaged.json");
    assert_eq!(refused.code, 2, "{}", refused.stderr);
    let picture = directory.read("branch.svg");
    assert!(picture.contains("stable") && picture.contains("flip") && picture.contains("fold"));
}

#[test]
fn a_written_branch_goes_on() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let part = "branch ball.slip --itinerary period,bounce --over a=0.018:0.025 --out part.json";
    let ran = directory.run(part);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("No special orbit"), "{}", ran.stdout);
    let ran = directory
        .run("branch ball.slip --near part.json --resume --over a=0.005:0.05 --out whole.json");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let [part, whole] = ["part.json", "whole.json"]
        .map(|name| -> Value { serde_json::from_str(&directory.read(name)).unwrap() });
    for (kind, value) in [("fold", 0.014043083214), ("flip", 0.029654967002)] {
        let specials = whole["specials"].as_array().unwrap();
        let own = specials.iter().find(|it| it["kind"] == kind).expect(kind);
        assert!((own["value"].as_f64().unwrap() - value).abs() < 1e-11, "{kind}");
    }
    // What it had is in it, in one piece.
    let states = |branch: &Value| -> Vec<Value> {
        let points = branch["points"].as_array().unwrap();
        points.iter().map(|it| it["segments"][0]["state"].clone()).collect()
    };
    let (part, whole) = (states(&part), states(&whole));
    assert!(whole.len() > part.len() && whole.windows(part.len()).any(|it| *it == part));
    let damaged = directory.read("part.json").replacen("\"period\":1.0", "\"period\":1.1", 1);
    directory.write("damaged.json", &damaged);
    let mut value: Value = serde_json::from_str(&directory.read("part.json")).unwrap();
    value.as_object_mut().unwrap().remove("digests");
    value["points"][3]["segments"][0]["state"][1] = 0.6.into();
    directory.write("changed.json", value.to_string());
    directory.write("light.slip", BALL.replace("v' = -1", "v' = -1.01"));
    directory.write("other.slip", BALL.replace("\"bounce\"", "\"jump\""));
    directory.run("orbit ball.slip --itinerary period,bounce --out orbit.json");
    for (arguments, said) in [
        ("ball.slip --near part.json --resume --over a=0.019:0.03", "contains that of the branch"),
        ("ball.slip --near part.json --resume --over r=0.6:0.8", "--over r: expected a"),
        ("ball.slip --near damaged.json --resume --over a=0.01:0.03", "has changed"),
        ("ball.slip --near changed.json --resume --over a=0.01:0.03", "from an orbit"),
        ("light.slip --near part.json --resume --over a=0.01:0.03", "from an orbit"),
        ("other.slip --near part.json --resume --over a=0.01:0.03", "the rule at its place"),
        ("ball.slip --near orbit.json --resume --over a=0.01:0.03", "missing field"),
        ("ball.slip --itinerary bounce --resume --over a=0.01:0.03", "--itinerary"),
        ("ball.slip --resume --over a=0.01:0.03", "--near"),
        ("ball.slip --settle 9 --switch flip --over a=0.01:0.03", "--settle"),
        ("ball.slip --near part.json --resume --set r=0.8 --over a=0.01:0.03", "--set"),
        ("ball.slip --near part.json --resume --over a=0.01:0.03 --out part.json", "same file"),
    ] {
        let ran = directory.run(&format!("branch {arguments}"));
        assert_eq!(ran.code, 2, "{arguments}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{arguments}: {}", ran.stderr);
    }
}

#[test]
fn regions_are_written() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let ran = directory.run(
        "regions ball.slip --itinerary period,bounce --x a=0.01:0.03 --y r=0.65:0.75 --cells 2 \
         --out regions.json --plot regions.svg",
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    for said in ["none", "stable", "fold", "error of boundaries"] {
        assert!(ran.stdout.contains(said), "{said}: {}", ran.stdout);
    }
    let text = directory.read("regions.json");
    assert!(text.contains("stickslip.orbit-regions/1"));
    let picture = directory.read("regions.svg");
    assert!(picture.contains("fold") && picture.contains("stable"));
    // Points are looked up. The fold is at a = 0.014043 and the flip at 0.029655 for r = 0.7.
    directory.write("points.csv", "name,r,a\none,0.7,0.0139\ntwo,0.7,0.0142\nthree,0.7,0.0297\n");
    let located = directory.run("locate regions.json --batch points.csv");
    assert_eq!(located.code, 0, "{}", located.stderr);
    let found = rows(&located.stdout);
    assert_eq!(found[0].join(","), "name,r,a,orbit_count,orbits,region,distance");
    let found: Vec<String> = found[1..].iter().map(|row| row[3..5].join(",")).collect();
    assert_eq!(found, ["0,none", "1,stable", "1,unstable"]);
    directory.write("points.csv", "a,r\n0.02,0.7\n5,0.7\n");
    let located = directory.run("locate regions.json --batch points.csv --out located.csv");
    assert_eq!(located.code, 1, "{}", located.stderr);
    assert!(
        located.stderr.contains("a = 5, r = 0.7 lies outside the window"),
        "{}",
        located.stderr
    );
    assert_eq!(rows(&directory.read("located.csv")).len(), 3);
    let needs = directory.run("locate regions.json --kappa 1 --psi 1");
    assert!(needs.code == 2 && needs.stderr.contains("the columns a and r"), "{}", needs.stderr);
    // Files that are damaged, or of another kind.
    let whole = directory.read("regions.json");
    let cut: String = whole.chars().take(whole.len() / 2).collect();
    let renamed = whole.replacen("orbit-regions/1", "orbit-regions/2", 1);
    let changed = whole.replacen("\"low\":[0.01", "\"low\":[0.02", 1);
    assert_ne!(changed, whole);
    let value: Value = serde_json::from_str(&whole).unwrap();
    let without = |change: &dyn Fn(&mut Value)| {
        let mut value = value.clone();
        value.as_object_mut().unwrap().remove("digests");
        change(&mut value);
        value.to_string()
    };
    let fewer = without(&|it| drop(it["atlas"]["regions"].as_array_mut().unwrap().pop()));
    let beyond = without(&|it| it["atlas"]["curves"][0]["ends"][0] = 77.into());
    for (text, said) in [
        (&cut, "at line 1 column"),
        (&renamed, "schema"),
        (&changed, "atlas has changed since the file was written"),
        (&fewer, "other regions than the document lists"),
        (&beyond, "77"),
    ] {
        directory.write("regions.json", text);
        let ran = directory.run("locate regions.json --batch points.csv");
        assert_eq!(ran.code, 2, "{said}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{said}: {}", ran.stderr);
    }
    let refused = directory.run("regions ball.slip --itinerary period,bounce --x a=0:1 --y a=0:1");
    assert!(refused.code == 2 && refused.stderr.contains("two parameters"), "{}", refused.stderr);
}

#[test]
fn sections_and_basins_are_written() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    let ran = directory.run(
        "section ball.slip --rule bounce --skip 200 --for 20 --table points.csv --plot points.svg",
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let table = rows(&directory.read("points.csv"));
    assert_eq!((table[0].join(","), table.len()), ("t,x,v,phase".to_owned(), 21));
    // The product of the multipliers is r², and the phase neither grows nor shrinks.
    let said = ran.stdout.lines().find(|line| line.contains("exponents")).expect("exponents");
    let (_, said) = said.split_at("Lyapunov exponents".len());
    let said: Vec<f64> = said.split(',').map(|it| it.trim().parse().expect("a number")).collect();
    assert!((said.iter().sum::<f64>() - 2.0 * 0.7_f64.ln()).abs() < 0.05, "{said:?}");
    let diagram = |threads: usize| {
        let ran = directory.run(&format!(
            "section ball.slip --rule bounce --skip 50 --for 10 --over a=0.02:0.0204 --values 5 \
             --table diagram.csv --plot diagram.svg --exponents exponents.svg --show v \
             --threads {threads}"
        ));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        assert!(directory.read("diagram.svg").contains("downwards"));
        assert!(directory.read("exponents.svg").contains("Lyapunov exponents"));
        directory.read("diagram.csv")
    };
    let alone = diagram(1);
    assert_eq!(rows(&alone)[0].join(","), "a,direction,t,x,v,phase");
    assert_eq!(alone, diagram(2));
    let ran = directory.run(
        "basins ball.slip --x x=0.014:0.017 --y v=0.49:0.51 --size 3x2 --settle 200 --table basins.csv \
         --plot basins.svg",
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.contains("orbit of period 1.000000000"), "{}", ran.stdout);
    let table = rows(&directory.read("basins.csv"));
    assert_eq!((table[0].join(","), table.len()), ("x,v,attractor".to_owned(), 7));
    assert!(directory.read("basins.svg").starts_with("<svg"));
}

#[test]
fn what_has_no_orbit_is_refused() {
    let directory = Workspace::new();
    directory.write("ball.slip", BALL);
    for (arguments, code, said) in [
        ("orbit ball.slip", 2, "--itinerary"),
        ("orbit ball.slip --itinerary bonce", 2, "a rule of mode main, which has bounce, period"),
        ("orbit ball.slip --itinerary period --mode up", 2, "--mode up: expected one of main"),
        (
            "orbit ball.slip --itinerary period --start y=1",
            2,
            "--start y: the state has x, v, phase",
        ),
        ("orbit ball.slip --itinerary period --set b=1", 2, "--set b: the system has no such"),
        ("section ball.slip --rule bonce --for 1", 2, "which has bounce, period"),
        ("section ball.slip --rule bounce --for 0", 2, "the time on the section = 0"),
        ("section ball.slip --rule bounce --for 1 --over b=0:1", 2, "--over b"),
        ("basins ball.slip --x x=0:1 --y x=0:1 --settle 1", 2, "the places of two of 3"),
        ("basins ball.slip --x x=0:1 --y y=0:1 --settle 1", 2, "--y y: the state has x, v, phase"),
        ("orbit ball.slip --settle 0.5", 1, "the run does not settle"),
        ("branch ball.slip --itinerary period,bounce --over b=0:1", 2, "--over b"),
        ("branch ball.slip --itinerary period,bounce --over a=1:2", 2, "a = 0.02 is out of range"),
        (
            "branch ball.slip --itinerary period,bounce --over a=0:1 --longest-step 2",
            2,
            "1e-7 to 1",
        ),
    ] {
        let ran = directory.run(arguments);
        assert_eq!(ran.code, code, "{arguments}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{arguments}: {}", ran.stderr);
    }
}
