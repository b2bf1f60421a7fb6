//! What a law may have beside a spring and a dashpot: friction that decays, hysteresis, adhesion;
//! and the limits without friction and without a spring.

use serde_json::{Value, json};

use crate::{Workspace, rows, stickslip};

/// Friction that decays with the velocity: as options, in a file of a law, as bodies, and where it
/// is refused.
#[test]
fn decaying_friction_is_a_property_of_every_law() {
    let one = "collide --kappa 30 --psi 0.5 --law gran/hertz/history --format json";
    let options = "--dynamic-friction 0.4 --friction-decay 5";
    let json = |text: &str| -> Value { serde_json::from_str(text).unwrap() };
    let found = json(&stickslip(&format!("{one} {options}")).stdout);
    let friction = json!({ "dynamic": 0.4, "decay": 5.0 });
    assert_eq!(found["parameters"]["law"]["friction"], friction);
    assert_ne!(found["eps_t"], json(&stickslip(one).stdout)["eps_t"]);
    // The paper's law is integrated.
    let paper = stickslip(&format!("collide --kappa 3 --psi 0.5 {options} --format json"));
    assert_eq!(json(&paper.stdout)["method"]["name"], "dop853", "{}", paper.stderr);

    let directory = Workspace::new();
    let mut law = found["parameters"]["law"].clone();
    directory.write("law.json", law.to_string());
    let same = directory.run("collide --kappa 30 --psi 0.5 --law law.json --format json");
    assert_eq!(json(&same.stdout)["eps_t"], found["eps_t"], "{}", same.stderr);
    law["friction"]["decay"] = json!(-1);
    directory.write("law.json", law.to_string());
    let refused = directory.run("collide --kappa 30 --psi 0.5 --law law.json");
    assert_eq!(refused.code, 2, "{}", refused.stdout);
    assert!(refused.stderr.contains("decay = -1"), "{}", refused.stderr);
    for (given, expected) in [
        ("--dynamic-friction 0.4", "--friction-decay"),
        ("--dynamic-friction 1.4 --friction-decay 1", "a number from 0 to 1"),
        ("--dynamic-friction 0.4 --friction-decay -1", "0 or above"),
    ] {
        let refused = stickslip(&format!("{one} {given}"));
        assert_eq!(refused.code, 2);
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    }

    let sphere = json!({
        "radius_m": 1e-3,
        "material": { "young_modulus_pa": 1e7, "poisson_ratio": 0.3, "density_kg_per_m3": 2500 },
    });
    let bodies = json!({ "spheres": [sphere, sphere], "surface": {
        "friction": 0.5,
        "dynamic_friction": 0.2,
        "friction_decay_s_per_m": 20,
        "tangential_stiffness_kg_per_s2": 4e3,
        "damping_time_s": 0,
    } });
    directory.write("bodies.json", bodies.to_string());
    let impact = "impact bodies.json --normal 0.1 --tangential 0.25 --format json";
    let ran = directory.run(impact);
    let found = json(&ran.stdout);
    let friction = &found["parameters"]["law"]["friction"];
    assert_eq!(friction["dynamic"], 0.4, "{}", ran.stderr);
    // β μ_s g_n/α.
    let decay = friction["decay"].as_f64().unwrap();
    assert!((decay - 20.0 * 0.5 * 0.1 * 3.5).abs() < 1e-12, "{decay}");
    // A map has the same impacts.
    let map =
        "map --bodies bodies.json --normal 0.05:0.15 --tangential 0.2:0.3 --size 1x1 --out m.csv";
    let ran = directory.run(map);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let text = directory.read("m.csv");
    let eps_t = format!("{:?}", found["eps_t"].as_f64().unwrap());
    assert!(text.contains(&eps_t[..12]), "{text} {eps_t}");

    for (command, expected) in [
        ("trace --kappa 1:4 --psi 0.3:2 --out atlas.json", "is not traced"),
        ("table --kappa 1:4 --psi 0.3:2 --out table.h --prefix t", "is not traced"),
    ] {
        let refused = directory.run(&format!("{command} {options}"));
        assert_ne!(refused.code, 0);
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    }
}

/// Walton's and Braun's law: as a collision, as bodies, with ε_n as an input, and where it is
/// refused.
#[test]
fn hysteretic_forces_are_a_law_like_others() {
    let one = "collide --kappa 3 --psi 0.4 --law walton-braun --e-n 0.5 --format json";
    let found: Value = serde_json::from_str(&stickslip(one).stdout).unwrap();
    assert_eq!(found["parameters"]["damping"], 3.0);
    assert!((found["eps_n"].as_f64().unwrap() - 0.5).abs() < 1e-12, "{found}");
    let refused = stickslip(&format!("{one} --tangential-damping 0.1"));
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("tangential"), "{}", refused.stderr);

    let directory = Workspace::new();
    let sphere = json!({
        "radius_m": 1e-3,
        "material": { "young_modulus_pa": 1e7, "poisson_ratio": 0.3, "density_kg_per_m3": 2500 },
    });
    let bodies = |surface: Value| json!({ "spheres": [sphere, sphere], "surface": surface });
    let surface = json!({
        "friction": 0.5,
        "normal_stiffness_kg_per_s2": 5e4,
        "tangential_stiffness_kg_per_s2": 4e4,
        "unloading_stiffness_ratio": 4,
    });
    directory.write("bodies.json", bodies(surface.clone()).to_string());
    let impact = "impact bodies.json --normal 0.1 --tangential 0.05 --format json --law";
    let ran = directory.run(&format!("{impact} walton-braun"));
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert!((found["eps_n"].as_f64().unwrap() - 0.5).abs() < 1e-12, "{}", ran.stderr);
    let other = directory.run(&format!("{impact} walton-braun/hardening"));
    assert!(
        other.stderr.contains("unloading_stiffness_ratio = 4 has no meaning"),
        "{}",
        other.stderr
    );
    // Without friction, and without a spring.
    for (name, at) in [("friction", 0.0), ("tangential_stiffness_kg_per_s2", 0.0)] {
        let mut surface = surface.clone();
        surface[name] = json!(at);
        directory.write("bodies.json", bodies(surface).to_string());
        let ran = directory.run(&format!("{impact} walton-braun"));
        let found: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!(found["eps_t"], 1.0, "{}", ran.stderr);
        assert_eq!(found["itinerary"], if name == "friction" { "+" } else { "o" });
    }
    // Bodies that yield.
    let mut yields = surface.clone();
    for name in ["normal_stiffness_kg_per_s2", "unloading_stiffness_ratio"] {
        yields.as_object_mut().unwrap().remove(name);
    }
    yields["yield_velocity_m_per_s"] = json!(0.025);
    directory.write("bodies.json", bodies(yields.clone()).to_string());
    let ran = directory.run(&format!("{impact} thornton"));
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert!((found["eps_n"].as_f64().unwrap() - 0.812_278_872_4).abs() < 1e-9, "{}", ran.stderr);
    yields["yield_pressure_pa"] = json!(1e6);
    directory.write("bodies.json", bodies(yields).to_string());
    let both = directory.run(&format!("{impact} thornton"));
    assert!(both.stderr.contains("are both given"), "{}", both.stderr);
    let one = "collide --kappa 3 --psi 0.4 --law thornton --e-n 0.8 --format json";
    let found: Value = serde_json::from_str(&directory.run(one).stdout).unwrap();
    assert!((found["eps_n"].as_f64().unwrap() - 0.8).abs() < 1e-12);
    let yielding = "trace --kappa 1:4 --psi 0.3:2 --damping 4 --law thornton --out atlas.json";
    let refused = directory.run(yielding);
    assert!(refused.stderr.contains("where bodies begin to yield"), "{}", refused.stderr);
    let trace = "trace --kappa 1:4 --psi 0.3:2 --damping 0.4 --law walton-braun --out atlas.json";
    let refused = directory.run(trace);
    assert_ne!(refused.code, 0);
    assert!(refused.stderr.contains("which is not traced"), "{}", refused.stderr);
}

/// μ = 0 and κ = 0 as options and in batches, and where they have no meaning.
#[test]
fn no_friction_and_no_spring_are_limits() {
    for options in ["--kappa 3 --ratio 0.7 --mu 0", "--kappa 0 --psi 0.5", "--kappa 0 --ratio 1"] {
        let ran = stickslip(&format!("collide {options} --damping 0.2 --format json"));
        let found: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!((&found["eps_t"], &found["switch_count"]), (&json!(1.0), &json!(0)));
        let paper = stickslip("collide --kappa 3 --psi 0.5 --damping 0.2 --format json");
        let paper: Value = serde_json::from_str(&paper.stdout).unwrap();
        assert_eq!(found["eps_n"], paper["eps_n"]);
    }
    let directory = Workspace::new();
    directory.write("in.csv", "kappa,ratio,mu\n3,0.7,0\n0,0.7,0.4\n3,0.7,0.4\n3,0.7,-1\n");
    let ran = directory.run("collide --batch in.csv --law gran/hooke/history --damping 0.2");
    let rows = rows(&ran.stdout);
    let column = rows[0].iter().position(|name| name == "eps_t").unwrap();
    let eps_t: Vec<_> = rows[1..4].iter().map(|row| row[column].parse::<f64>().unwrap()).collect();
    assert!(eps_t[..2] == [1.0, 1.0] && eps_t[2] < 0.9, "{}", ran.stdout);
    assert!(ran.stdout.contains("out of range; expected a finite number, 0 or above"));
    for (command, why) in [
        (
            "collide --kappa 0 --psi 0.5 --damping 0.2 --law gran/hooke/history \
          --tangential-damping 1",
            "or a law without history",
        ),
        ("trace --kappa 1:2 --ratio 0.5:1 --mu 0 --out atlas.json", "without friction"),
        ("trace --kappa 0:2 --psi 0.5:1 --out atlas.json", "LO > 0"),
        ("map --kappa 1:2 --ratio 0.5:1 --mu 0 --size 4x4 --out map.csv", "without friction"),
    ] {
        let refused = directory.run(command);
        assert_eq!(refused.code, 2, "{command}");
        assert!(refused.stderr.contains(why), "{}", refused.stderr);
    }
}

/// Adhesion: an option, a file of a law, bodies, and bodies that stay together.
#[test]
fn adhesion_is_computed_where_bodies_may_stay_together() {
    let law = "--law granular/jkr/viscoelastic/mindlin";
    let json = |command: &str| -> Value {
        let ran = stickslip(&format!("{command} --format json"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        serde_json::from_str(&ran.stdout).unwrap()
    };
    let found = json(&format!("collide --kappa 18 --psi 0.6 {law} --pull-off 0.2"));
    let work = 0.122_791 * (16.0 * 0.2 / 9.0_f64).powf(5.0 / 3.0);
    let eps_n = found["eps_n"].as_f64().unwrap();
    assert!((eps_n - (1.0 - 2.0 * work).sqrt()).abs() < 1e-5, "{found}");
    assert_eq!(found["parameters"]["law"]["pull_off"], 0.2);
    assert!(found.get("adheres").is_none());
    let held = format!("collide --kappa 18 --psi 0.6 {law} --pull-off 5");
    let found = json(&held);
    assert_eq!((&found["adheres"], &found["eps_n"]), (&json!(true), &Value::Null));
    let shown = stickslip(&held);
    assert!(shown.stdout.contains("The bodies stay together"), "{}", shown.stdout);

    let directory = Workspace::new();
    let printed = stickslip("laws granular/jkr/viscoelastic/mindlin --format json").stdout;
    let mut law: Value = serde_json::from_str(&printed).unwrap();
    (law["pull_off"], law["end"]) = (json!(0.2), json!("overlap"));
    directory.write("law.json", law.to_string());
    directory.write("in.csv", "kappa,psi,damping\n18,0.6,0\n18,0.6,2\n");
    let ran = directory.run("collide --batch in.csv --law law.json");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let rows = rows(&ran.stdout);
    let usual = 0.248_62 * (16.0 * 0.2 / 9.0_f64).powf(5.0 / 3.0);
    let eps_n: f64 = rows[1][3].parse().unwrap();
    assert!((eps_n - (1.0 - 2.0 * usual).sqrt()).abs() < 1e-5, "{}", ran.stdout);
    assert_eq!((rows[2][3].as_str(), rows[2][9].as_str()), ("", "adheres"), "{}", ran.stdout);

    let bodies = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/adhesive_spheres.json");
    let name = "--law granular/jkr/viscoelastic/mindlin";
    let impact = json(&format!("impact {bodies} {name}"));
    assert!(impact["eps_n"].as_f64().unwrap() < 1.0, "{impact}");
    let slow = format!("impact {bodies} {name} --normal 1e-3 --tangential 1e-3");
    let found = json(&slow);
    assert_eq!((&found["adheres"], &found["impulse_n_s"][0]), (&json!(true), &Value::Null));
    assert!(stickslip(&slow).stdout.contains("The bodies stay together"));
    directory.write("slow.csv", "normal_m_per_s,tangential_m_per_s\n0.1,0.1\n0.001,0.001\n");
    let ran = directory.run(&format!("impact --batch slow.csv --bodies {bodies} {name}"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stdout.lines().nth(1).unwrap().ends_with(",ok"), "{}", ran.stdout);
    assert!(ran.stdout.lines().nth(2).unwrap().ends_with(",,,adheres"), "{}", ran.stdout);

    let scaled = "--law granular/dmt/viscoelastic/mindlin --pull-off 0.1";
    for (command, why) in [
        (format!("collide --kappa 3 --psi 1 {name}"), "without pull-off"),
        ("collide --kappa 3 --psi 1 --pull-off 0.1".to_owned(), "without adhesion"),
        (format!("collide --kappa 3 --psi 1 {name} --pull-off 0"), "above 0"),
        (format!("trace --kappa 1:2 --psi 0.5:1 --out atlas.json {scaled}"), "boundaries are"),
        (format!("collide --kappa 3 --psi 1 --e-n 0.8 {scaled}"), "the damping of an e_n is"),
        ("laws granular/dmt/viscoelastic/mindlin --e-n 0.8".to_owned(), "has adhesion"),
    ] {
        let refused = directory.run(&command);
        assert_eq!(refused.code, 2, "{command}: {}", refused.stderr);
        assert!(refused.stderr.contains(why), "{command}: {}", refused.stderr);
    }
    let steps = json(&format!("timestep --kappa 1:2 --psi 0.5:1 --steps 20 {scaled}"));
    assert_eq!(steps["rows"][0]["status"], "ok", "{steps}");
    let ran = stickslip(&format!("timestep --bodies {bodies} {name} --steps 20"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let ran = stickslip(&format!("timestep --kappa 18 --psi 0.6 {name} --pull-off 5"));
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("the bodies stay together"), "{}", ran.stderr);
    let window = "--kappa 1:2 --psi 0.5:1 --out table.json";
    let ran = directory.run(&format!("table {window} {scaled}"));
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert!(ran.stderr.contains("boundaries are not computed"), "{}", ran.stderr);
    // Slow grains of a map have no restitution, and that is no failure.
    let map = "--normal 0:0.06 --tangential 0.1:0.2 --size 2x1 --out map.csv --plot map.svg";
    let mapped = directory.run(&format!("map --bodies {bodies} {name} {map}"));
    assert_eq!(mapped.code, 0, "{}", mapped.stderr);
    let rows = directory.read("map.csv");
    let column = |name: &str| {
        let place = rows.lines().next().unwrap().split(',').position(|it| it == name).unwrap();
        rows.lines().skip(1).map(|row| row.split(',').nth(place).unwrap()).collect::<Vec<_>>()
    };
    let one = format!("impact {bodies} --normal 0.045 --tangential 0.15 {name} --format json");
    let one: Value = serde_json::from_str(&directory.run(&one).stdout).unwrap();
    let [none, parts] = column("eps_t")[..] else { panic!("{rows}") };
    assert_eq!(none, "NaN");
    assert!((parts.parse::<f64>().unwrap() - one["eps_t"].as_f64().unwrap()).abs() < 1e-9);
    assert!(!column("switch_count").contains(&"-1"), "{rows}");
    assert!(directory.read("map.svg").contains("stay together"));
    let plotted = directory.run(&format!("{held} --plot held.svg"));
    assert!(plotted.code == 1 && plotted.stderr.contains("stay together"), "{}", plotted.stderr);
    let plotted = directory.run(&format!("collide --kappa 18 --psi 0.6 {scaled} --plot ends.svg"));
    assert_eq!(plotted.code, 0, "{}", plotted.stderr);
    assert!(directory.read("ends.svg").contains("friction limit/μ"));
}
