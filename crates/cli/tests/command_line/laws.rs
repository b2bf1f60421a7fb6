//! Contact laws.

use serde_json::{Value, json};

use crate::reproduce::{LAWS, names_of_laws, page};
use crate::{Workspace, npz, reference, rows, stickslip};

/// α of a homogeneous sphere.
const ALPHA: f64 = 2.0 / 7.0;

#[test]
fn a_law_is_listed_and_printed_as_a_file() {
    let listed = stickslip("laws");
    assert_eq!((listed.code, listed.stderr.as_str()), (0, ""));
    assert!(listed.stdout.contains("gran/hertz/history"), "{}", listed.stdout);
    let ran = stickslip("laws --format json");
    let laws: Value = serde_json::from_str(&ran.stdout).unwrap();
    for law in laws.as_array().unwrap() {
        let name = law["name"].as_str().unwrap();
        let printed = stickslip(&format!("laws {name} --format json"));
        let printed: Value = serde_json::from_str(&printed.stdout).unwrap();
        assert_eq!(printed, law["law"], "{name}");
        let shown = stickslip(&format!("laws {name}")).stdout;
        assert!(shown.contains(law["equations"].as_str().unwrap()), "{shown}");
        assert!(shown.contains(law["source"].as_str().unwrap()), "{shown}");
    }
    let unknown = stickslip("laws hooke");
    assert_eq!(unknown.code, 2);
    assert!(unknown.stderr.contains("expected a name that `stickslip laws` lists"));
}

#[test]
fn restitution_is_an_input() {
    let ran = stickslip("laws mfix/HERTZIAN --e-n 0.8 --format json");
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    let damping = found["damping"].as_f64().unwrap();
    // √5 ζ with ζ = −ln e/√(π² + ln² e), and 2 ζ for the code.
    let log = -0.8_f64.ln();
    let ratio = log / std::f64::consts::PI.hypot(log);
    assert!((damping - 5.0_f64.sqrt() * ratio).abs() < 1e-15, "{found}");
    let keyword = &found["keywords"][0];
    assert!((keyword["damping"].as_f64().unwrap() - 2.0 * ratio).abs() < 1e-15, "{found}");
    assert!((keyword["e_n"].as_f64().unwrap() - 0.819_152_472_7).abs() < 1e-9, "{found}");
    let law = "--law mfix/HERTZIAN --kappa 3 --psi 0.4 --format json";
    let given = stickslip(&format!("collide {law} --e-n 0.8"));
    let same = stickslip(&format!("collide {law} --damping {damping:?}"));
    assert_eq!((given.code, &given.stdout), (0, &same.stdout), "{}", given.stderr);

    let directory = Workspace::new();
    directory.write("in.csv", "psi,e_n\n0.4,0.8\n0.4,1\n0.4,2\n");
    let ran = directory.run("collide --batch in.csv --kappa 3 --law gran/hertz/history");
    let rows = rows(&ran.stdout);
    assert!((rows[1][2].parse::<f64>().unwrap() - 0.8).abs() < 1e-12, "{}", ran.stdout);
    assert!((rows[2][2].parse::<f64>().unwrap() - 1.0).abs() < 1e-12, "{}", ran.stdout);
    assert!(ran.stdout.contains("out of range; expected a number above 0, at most 1"));
    let undamped = "collide --kappa 3 --psi 0.4 --law yade/FrictPhys_CundallStrack --e-n 0.5";
    let refused = stickslip(undamped);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("no damping of this law has e_n = 0.5"), "{}", refused.stderr);

    // A law that cannot lose so much hides no other one.
    let all = stickslip("laws --e-n 0.1");
    let line = |name: &str| all.stdout.lines().find(|line| line.starts_with(name)).expect("a law");
    assert_eq!(all.code, 0, "{}", all.stderr);
    assert!(line("thornton").contains("no damping of this law has e_n = 0.1"), "{}", all.stdout);
    assert!(line("gran/hooke/history").contains("1.182310"), "{}", all.stdout);
    let refused = stickslip("laws --e-n 2");
    assert!(refused.code == 2 && refused.stdout.is_empty(), "{}", refused.stdout);
}

/// Laws that are not computed say so by their names.
#[test]
fn laws_that_are_not_computed_say_why() {
    for (name, why) in [
        ("sjkr", "this adhesion is not computed"),
        ("cohesion", "this adhesion is not computed"),
        ("rolling/sds", "rolling and twisting friction are not computed"),
        ("granular/mdr", "this plasticity is not computed, but thornton"),
    ] {
        for command in [format!("laws {name}"), format!("collide --kappa 3 --psi 1 --law {name}")] {
            let refused = stickslip(&command);
            assert_eq!(refused.code, 2, "{command}");
            assert!(refused.stderr.contains(why), "{}", refused.stderr);
        }
    }
}

#[test]
fn a_law_without_history_needs_no_stiffness() {
    let ran = stickslip(
        "collide --psi 0.5 --damping 0.3 --law gran/hooke --tangential-damping 1.75 --format json",
    );
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert!((found["eps_t"].as_f64().unwrap() - 0.197_878).abs() < 6e-7, "{found}");
    let spring = stickslip("collide --psi 0.5 --damping 0.3 --law gran/hooke/history");
    assert!(spring.stderr.contains("--kappa is missing"), "{}", spring.stderr);
}

#[test]
fn a_collision_is_the_same_by_name_by_file_and_in_a_batch() {
    let directory = Workspace::new();
    let name = "granular/hertz/tsuji/mindlin_rescale/force+limit_damping";
    directory.write("law.json", stickslip(&format!("laws {name} --format json")).stdout);
    directory.write("in.csv", "kappa,psi,damping,tangential_damping\n3,0.4,0.3,3.5\n3,0.4,0.3,0\n");
    let one = "collide --kappa 3 --psi 0.4 --damping 0.3 --tangential-damping 3.5 --format json";
    let by_name = directory.run(&format!("{one} --law {name}"));
    let by_file = directory.run(&format!("{one} --law law.json"));
    assert_eq!((by_name.code, &by_name.stdout), (0, &by_file.stdout));
    let found: Value = serde_json::from_str(&by_name.stdout).unwrap();
    assert_eq!(found["parameters"]["law"]["rescaled"], true);
    assert_eq!(found["parameters"]["tangential_damping"], 3.5);
    let ran = directory.run("collide --batch in.csv --law law.json --out out.csv");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let rows = rows(&directory.read("out.csv"));
    assert_eq!(rows[1][5].parse::<f64>().unwrap(), found["eps_t"].as_f64().unwrap());
    assert_ne!(rows[1][5], rows[2][5]);
}

#[test]
fn a_start_near_its_border_is_told() {
    let at = |psi: &str| {
        format!("collide --kappa 2 --psi {psi} --law granular/hertz/tsuji/mindlin/force")
    };
    let near = stickslip(&at("0.7499"));
    assert!(near.stdout.contains("Near the border of stick and slip"), "{}", near.stdout);
    let found = stickslip(&format!("{} --format json", at("0.7499")));
    let found: Value = serde_json::from_str(&found.stdout).unwrap();
    let margin = found["start_margin"].as_f64().unwrap();
    assert!((margin - (1.0 - 4.0 / 3.0 * 0.7499)).abs() < 1e-14, "{margin}");
    assert!(!stickslip(&at("0.5")).stdout.contains("Near the border"));
    let paper = stickslip("collide --kappa 2 --psi 0.5 --format json");
    assert!(!paper.stdout.contains("start_margin"));
}

#[test]
fn collisions_are_those_of_lammps() {
    let directory = Workspace::new();
    for case in reference("lammps_laws.json", "cases").iter().step_by(20) {
        let scaled = &case["scaled"];
        let number = |name: &str| scaled[name].as_f64().unwrap();
        let tangential = scaled["tang"].as_str().unwrap();
        let law = json!({
            "normal": if scaled["normal"] == "hooke" { "linear" } else { "hertz" },
            "damping": match scaled["damp"].as_str().unwrap() {
                "const" => "linear",
                "sqrtx" => "viscoelastic",
                _ => "tsuji",
            },
            "tangential": if tangential == "lin" { "constant" } else { "mindlin" },
            "history": if tangential.ends_with("force") { "force" } else { "displacement" },
            "rescaled": tangential.contains("rescale"),
            "limit_damping": scaled["limit"],
            "end": "overlap",
        });
        directory.write("law.json", law.to_string());
        let ran = directory.run(&format!(
            "collide --kappa {} --psi {} --damping {} --tangential-damping {} --law law.json \
             --format json",
            number("kappa") / ALPHA,
            number("g0") * ALPHA / number("mu"),
            number("cn"),
            number("xt") / ALPHA
        ));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let found: Value = serde_json::from_str(&ran.stdout).unwrap();
        let expected = -case["eps_t"].as_f64().unwrap();
        let error = (found["eps_t"].as_f64().unwrap() - expected).abs();
        assert!(error < 1e-4 + case["eps_t_error"].as_f64().unwrap(), "{case}");
    }
}

#[test]
fn what_is_no_law_is_refused() {
    let directory = Workspace::new();
    directory.write("law.json", r#"{"normal": "hooke"}"#);
    directory.write("extra.json", r#"{"stiffness": 3}"#);
    let list = r#" ["hertz", "none", "constant", "force", false, false, "force"]"#;
    directory.write("list.json", list);
    for (law, expected, code) in [
        ("nowhere", "is neither a file nor a name", 2),
        ("gran/hook/histroy", "`stickslip laws` lists; perhaps gran/hooke/history", 2),
        ("GRAN/hertz", "perhaps gran/hertz/history", 2),
        ("law.json", "normal: unknown variant `hooke`, expected one of `linear`, `hertz`", 2),
        ("extra.json", "unknown field `stiffness`", 2),
        ("list.json", "is a list; expected an object with named fields", 2),
        ("granular/hertz/tsuji/mindlin --damping 2.3", "never end", 2),
        ("yade/FrictPhys_CundallStrack --damping 0.1", "this law has no damping", 2),
        ("mfix/LSD --damping 0.1 --tangential-damping 1", "has no meaning in the law mfix/LSD", 2),
        ("gran/hertz/history --method exact", "there is no exact solution", 1),
        ("gran/hooke/history --estimate", "for the paper's contact law only", 1),
    ] {
        let ran = directory.run(&format!("collide --kappa 3 --psi 0.4 --law {law}"));
        assert_eq!(ran.code, code, "{law}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{law}: {}", ran.stderr);
    }
}

#[test]
fn linear_contacts_have_an_exact_solution() {
    let options = "--kappa 3 --psi 0.4 --damping 0.3 --law gran/hooke/history --format json";
    let [exact, integrated] = ["exact", "dop853"].map(|method| {
        let ran = stickslip(&format!("collide {options} --method {method}"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        serde_json::from_str::<Value>(&ran.stdout).unwrap()
    });
    assert_eq!(exact["method"]["name"], "exact");
    assert_eq!(exact["itinerary"], integrated["itinerary"]);
    let eps_t = [&exact, &integrated].map(|found| found["eps_t"].as_f64().unwrap());
    assert!((eps_t[0] - eps_t[1]).abs() < 1e-11, "{eps_t:?}");
}

#[test]
fn pictures_are_in_the_units_of_the_law() {
    let directory = Workspace::new();
    for (law, unit) in [("gran/hooke/history", "−1/2"), ("gran/hertz/history", "−2/5")] {
        let law = format!("--damping 0.3 --tangential-damping 0.5 --law {law}");
        let ran = directory.run(&format!("collide --kappa 12 --psi 0.6 {law} --plot a.svg"));
        assert_eq!(ran.code, 0, "{}", ran.stderr);
        let picture = directory.read("a.svg");
        assert!(picture.contains(unit) && picture.contains("b = 0.5"), "{law}");
    }
}

#[test]
fn a_badly_conditioned_start_is_said() {
    let law = "--law granular/hertz/tsuji/mindlin --damping 0.3 --tangential-damping 4";
    let ran = stickslip(&format!("collide --kappa 3 --psi 0.5 {law}"));
    assert!(ran.stdout.contains("only when the overlap is 8.100e1 times"), "{}", ran.stdout);
    let calm = stickslip(&format!("collide --kappa 3 --psi 0.1 {law}"));
    assert!(!calm.stdout.contains("Badly conditioned"), "{}", calm.stdout);
}

#[test]
fn maps_and_atlases_know_their_law() {
    let directory = Workspace::new();
    let law = "--law gran/hooke/history+limit_damping";
    let window = "--kappa 1:3 --psi 0.3:0.9";
    let ran = directory.run(&format!("map {window} --size 4x3 --damping 0.1 {law} --out map.npz"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let arrays = npz(&directory.path("map.npz"));
    let text = |name: &str| arrays.iter().find(|array| array.0 == name).unwrap().1.text();
    assert!(text("law").contains(r#""normal":"linear""#));

    let ran = directory.run(&format!("trace {window} {law} --out atlas.json --plot atlas.svg"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let atlas: Value = serde_json::from_str(&directory.read("atlas.json")).unwrap();
    assert_eq!(atlas["window"]["law"]["limit_damping"], true);
    let kinds: Vec<&Value> =
        atlas["boundaries"].as_array().unwrap().iter().map(|boundary| &boundary["kind"]).collect();
    assert!(kinds.iter().any(|kind| *kind == "start-of-contact"), "{kinds:?}");
    directory.write("points.csv", "kappa,psi\n1.1,0.35\n2,0.6\n2.9,0.85\n1.5,0.666666666666\n");
    let ran = directory.run("locate --atlas atlas.json --batch points.csv --out located.csv");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    directory.run(&format!("collide --batch points.csv {law} --out collided.csv"));
    let (located, collided) =
        (rows(&directory.read("located.csv")), rows(&directory.read("collided.csv")));
    for (located, collided) in located.iter().zip(&collided).skip(1) {
        assert_eq!((&located[2], &located[3]), (&collided[4], &collided[5]));
    }
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn lines_on_which_a_law_begins_to_gain_are_written() {
    let directory = Workspace::new();
    let window = "trace --kappa 1.2:1.3 --psi 0.85:1 --out atlas.json --gaining gaining.json";
    let ran = directory.run(&format!("{window} --law gran/hertz/history"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let gaining: Value = serde_json::from_str(&directory.read("gaining.json")).unwrap();
    assert_eq!(gaining["schema"], "stickslip.gaining/1");
    assert_eq!((&gaining["agrees"], &gaining["objections"]), (&true.into(), &json!([])));
    let [line] = &gaining["lines"].as_array().unwrap()[..] else { panic!("{gaining}") };
    let points = line["points"].as_array().unwrap();
    // Below the line |ε_t| is above 1.
    let rightwards = points[points.len() - 1][0].as_f64() > points[0][0].as_f64();
    assert_eq!(line["gains_left"], !rightwards);
    let middle = &points[points.len() / 2];
    let collide = format!("collide --kappa {} --psi {}", middle[0], middle[1]);
    let ran = directory.run(&format!("{collide} --law gran/hertz/history --format json"));
    let collision: Value = serde_json::from_str(&ran.stdout).unwrap();
    let off = collision["eps_t"].as_f64().unwrap() - line["eps_t"].as_f64().unwrap();
    assert!(off.abs() < 1e-8, "{collision}");
}

#[test]
fn the_law_of_the_paper_has_no_lines_on_which_it_begins_to_gain() {
    let directory = Workspace::new();
    let window = "trace --kappa 1.2:1.3 --psi 0.85:1 --out atlas.json --gaining gaining.json";
    assert_eq!(directory.run(window).code, 0);
    let gaining: Value = serde_json::from_str(&directory.read("gaining.json")).unwrap();
    assert_eq!(gaining["schema"], "stickslip.gaining/1");
    assert_eq!((&gaining["agrees"], &gaining["lines"]), (&true.into(), &json!([])));
    let same = "trace --kappa 1:2 --psi 1:2 --out a.json --gaining a.json";
    assert_eq!(directory.run(same).code, 2);
}

#[test]
fn impacts_have_the_constants_of_their_law() {
    let directory = Workspace::new();
    let file = std::fs::read_to_string("../../examples/hooke_spheres.json").unwrap();
    directory.write("bodies.json", &file);
    let law = "--law gran/hooke/history";
    let ran = directory.run(&format!("impact bodies.json {law} --format json"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let impact: Value = serde_json::from_str(&ran.stdout).unwrap();
    let parameters = &impact["parameters"];
    assert_eq!(parameters["law"]["normal"], "linear");
    assert!((parameters["kappa"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!((impact["eps_n"].as_f64().unwrap() - 0.9).abs() < 1e-9);
    let number = |value: &Value| value.as_f64().unwrap();
    // The scaled collision has the same results.
    let names = ["kappa", "psi", "damping", "tangential_damping"];
    let [kappa, psi, a, b] = names.map(|name| number(&parameters[name]));
    assert!((b - 1.75).abs() < 1e-14);
    let scaled =
        format!("--kappa {kappa:?} --psi {psi:?} --damping {a:?} --tangential-damping {b:?}");
    let ran = stickslip(&format!("collide {scaled} {law} --format json"));
    let collision: Value = serde_json::from_str(&ran.stdout).unwrap();
    for name in ["eps_n", "eps_t", "switch_count", "itinerary"] {
        assert_eq!(impact[name], collision[name], "{name}");
    }
    let unit = number(&parameters["time_unit_s"]);
    let (time, scaled) = (number(&impact["contact_time_s"]), number(&collision["contact_time"]));
    assert!((time / (scaled * unit) - 1.0).abs() < 1e-14);
    for switch in impact["switches"].as_array().unwrap() {
        let [normal, tangential] =
            ["normal_force_n", "tangential_force_n"].map(|name| number(&switch[name]));
        assert!(switch["spring_m"].is_null());
        assert!((tangential.abs() - 0.3 * normal).abs() <= 1e-12 * normal);
    }
    assert!(impact["comparison"]["eps_n_pade"].is_null());
    let table = directory.run(&format!("impact bodies.json {law}"));
    assert!(table.stdout.contains("Law F = x + a v"), "{}", table.stdout);
    assert!(table.stdout.contains("none in this law"), "{}", table.stdout);

    let map = "map --bodies bodies.json --normal 0.05:0.2 --tangential 0:0.4 --size 3x2";
    let ran = directory.run(&format!("{map} {law} --out map.npz"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let arrays = npz(&directory.path("map.npz"));
    let law_of_map = arrays.iter().find(|array| array.0 == "law").unwrap().1.text();
    assert!(law_of_map.contains(r#""normal":"linear""#), "{law_of_map}");
    let damping = arrays.iter().find(|array| array.0 == "tangential_damping").unwrap();
    assert!((damping.1.doubles()[0] - 1.75).abs() < 1e-14);

    for (law, expected) in [
        ("", "surface.normal_stiffness_kg_per_s2 = 50000 has no meaning in this law"),
        ("--law gran/hertz/history", "surface.normal_stiffness_kg_per_s2 = 50000 has no"),
        ("--law mfix/LSD", "has no meaning in the law mfix/LSD"),
    ] {
        let ran = directory.run(&format!("impact bodies.json {law}"));
        assert_eq!(ran.code, 2, "{}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{}", ran.stderr);
    }
}

#[test]
fn the_page_shows_every_law() {
    let workspace = Workspace::new();
    let line = "laws --out laws --cells 6 --damping 0.1 --tangential-damping 0.5 --threads 2";
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    assert!(ran.stderr.ends_with("everything is on laws/laws.html\n"), "{}", ran.stderr);
    assert_eq!(workspace.names_in("laws"), names_of_laws());

    let text = workspace.read("laws/laws.html");
    let page = page(&text);
    let has = |tag: &str, at: &str| {
        page.descendants().filter(|node| node.has_tag_name(tag)).any(|node| {
            node.descendants().filter_map(|node| node.text()).collect::<String>().contains(at)
        })
    };
    let laws: Value = serde_json::from_str(&stickslip("laws --format json").stdout).unwrap();
    let adhesive = |law: &&Value| law["law"]["normal"] == "dmt" || law["law"]["normal"] == "jkr";
    for law in laws.as_array().unwrap().iter().filter(|law| !adhesive(law)) {
        let name = law["name"].as_str().unwrap();
        assert!(has("td", name) && has("figcaption", name), "{name}");
    }
    for node in page.descendants().filter_map(|node| node.attribute("href")) {
        let there = match node.split_once('#') {
            Some(("", name)) => page.descendants().any(|node| node.attribute("id") == Some(name)),
            _ => node.starts_with("data:") || workspace.path("laws").join(node).is_file(),
        };
        assert!(there, "{node}");
    }

    // A row for each law, and the same numbers as `collide`.
    let table = rows(&workspace.read("laws/contact_laws.csv"));
    assert_eq!(table.len(), 1 + LAWS);
    let column = |name: &str| table[0].iter().position(|column| column == name).unwrap();
    for (number, row) in table.iter().enumerate().skip(1) {
        let [kappa, psi] = ["at_kappa", "at_psi"].map(|name| &row[column(name)]);
        let law = row[column("names")].split(", ").next().unwrap();
        assert!(workspace.read(&format!("laws/law_{number:02}_maps.svg")).contains(law), "{law}");
        let line = format!("collide --kappa {kappa} --psi {psi} --law {law} --format json");
        let found: Value = serde_json::from_str(&stickslip(&line).stdout).unwrap();
        let largest: f64 = row[column("largest")].parse().unwrap();
        let error = found["eps_t"].as_f64().unwrap().abs() - largest;
        // `collide` computes the paper's law exactly.
        assert!(error.abs() < 1e-12, "{line}: {error:e}");
    }

    let again = workspace.run(&line.replace("--out laws", "--out one").replace('2', "1"));
    assert_eq!(again.code, 0, "{}", again.stderr);
    for name in names_of_laws() {
        let [one, two] = ["laws", "one"].map(|out| workspace.read(&format!("{out}/{name}")));
        assert!(one == two, "{name}");
    }
}

#[test]
fn a_page_is_refused_before_any_work() {
    let workspace = Workspace::with_input("a file");
    for (line, expected) in [
        ("laws --cells 5", "--out <DIR>"),
        ("laws gran/hertz/history --out laws", "cannot be used with"),
        ("laws --out laws --cells 0", "0 is not in 1..=1000"),
        ("laws --out laws --damping -1", "'-1' for '--damping <A>': out of range"),
        ("laws --out laws --tangential-damping inf", "not finite"),
        ("laws --out in.csv", "--out in.csv is not a directory"),
    ] {
        let ran = workspace.run(line);
        assert_eq!(ran.code, 2, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{line}: {}", ran.stderr);
    }
    assert_eq!(workspace.names(), ["in.csv"]);
}
