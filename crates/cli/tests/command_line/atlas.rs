//! Atlases, traced, verified and read back.

use std::fmt::Write;
use std::sync::OnceLock;

use roxmltree::Document;
use serde_json::Value;
use stickslip_model::{Contact, exact};

use crate::{Workspace, decimal, rows};

const WINDOW: &str = "trace --kappa 5:20 --psi 0.2:2.5";

/// The atlas of one window and its picture, which all tests share.
fn atlas() -> &'static (String, String) {
    static ATLAS: OnceLock<(String, String)> = OnceLock::new();
    ATLAS.get_or_init(|| {
        let workspace = Workspace::new();
        let ran = workspace.run(&format!("{WINDOW} --out a.json --plot a.svg"));
        assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
        assert_eq!(workspace.names(), ["a.json", "a.svg"]);
        (workspace.read("a.json"), workspace.read("a.svg"))
    })
}

fn parsed() -> Value {
    serde_json::from_str(&atlas().0).expect("JSON")
}

fn list<'a>(value: &'a Value, name: &str) -> &'a [Value] {
    value[name].as_array().unwrap_or_else(|| panic!("{name} is a list"))
}

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|index| value[index].as_f64().expect("a number"))
}

#[test]
fn an_atlas_has_the_fields_of_its_schema() {
    let atlas = parsed();
    assert_eq!(atlas["schema"], "stickslip.atlas/1");
    assert_eq!(pair(&atlas["window"]["kappa"]), [5.0, 20.0]);
    assert_eq!(pair(&atlas["window"]["psi"]), [0.2, 2.5]);
    assert_eq!(atlas["window"]["damping"], 0.0);
    assert_eq!(atlas["tolerance"], 1e-10 * 3.5);
    assert_eq!(atlas["verification"]["agrees"], true);
    assert_eq!(atlas["verification"]["method"], "dop853");
    assert!(atlas["verification"]["tried"].as_u64().unwrap() > 20_000);
    assert!(atlas["verification"]["share_wrong_bound"].as_f64().unwrap() < 2e-4);
    let (boundaries, vertices) = (list(&atlas, "boundaries"), list(&atlas, "vertices"));
    assert!(boundaries.len() > 3, "{}", boundaries.len());
    for (id, boundary) in boundaries.iter().enumerate() {
        assert_eq!(boundary["id"], id);
        assert_ne!(boundary["below"], boundary["above"]);
        for side in ["below", "above"] {
            let phases = boundary[side]["itinerary"].as_str().unwrap().len();
            assert_eq!(boundary[side]["switch_count"], phases - 1);
        }
        let points = list(boundary, "points");
        assert_eq!(points.len(), list(boundary, "tangents").len());
        for (why, end, point) in [("start", 0, &points[0]), ("end", 1, &points[points.len() - 1])] {
            let vertex =
                &vertices[usize::try_from(boundary["vertices"][end].as_u64().unwrap()).unwrap()];
            assert!(list(vertex, "boundaries").contains(&id.into()));
            let edge = vertex["kind"].as_str().unwrap().starts_with("window");
            assert_eq!(boundary[why], if edge { "window" } else { "vertex" });
            let [kappa, psi] = pair(point);
            assert!((kappa - vertex["kappa"].as_f64().unwrap()).abs() < 1e-8);
            assert!((psi - vertex["psi"].as_f64().unwrap()).abs() < 1e-8);
        }
    }
    let mut area = 0.0;
    for (id, region) in list(&atlas, "regions").iter().enumerate() {
        assert_eq!(region["id"], id);
        let [kappa, psi] = pair(&region["sample"]);
        let collision = exact::collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap();
        assert_eq!(region["itinerary"], collision.itinerary());
        assert_eq!(region["switch_count"], collision.switches.len());
        area += region["area_share"].as_f64().unwrap();
    }
    assert!((area - 1.0).abs() < 1e-9, "{area}");
}

#[test]
fn reference_boundaries_are_among_the_traced() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/boundaries.json");
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let inside = |case: &&Value| {
        let (kappa, psi) = (decimal(&case["kappa"]), decimal(&case["psi"]));
        (5.0..=20.0).contains(&kappa) && (0.2..2.5).contains(&psi)
    };
    let cases: Vec<_> = list(&file, "boundaries").iter().filter(inside).collect();
    assert!(cases.len() >= 6, "{}", cases.len());
    let workspace = Workspace::new();
    workspace.write("a.json", &atlas().0);
    // Just below and just above each boundary, the points are in the expected regions, and the
    // boundary has the expected distance.
    let apart = 1e-7;
    let mut points = "kappa,psi\n".to_owned();
    for case in &cases {
        for side in [-apart, apart] {
            let _ = writeln!(
                points,
                "{},{:?}",
                case["kappa"].as_str().unwrap(),
                decimal(&case["psi"]) + side
            );
        }
    }
    workspace.write("p.csv", points);
    let ran = workspace.run("locate --atlas a.json --batch p.csv --out o.csv");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let located = rows(&workspace.read("o.csv"));
    let atlas = parsed();
    for (case, rows) in cases.iter().zip(located[1..].chunks(2)) {
        for (row, side) in rows.iter().zip(["below", "above"]) {
            assert_eq!(row[2], case[side].to_string(), "{case}");
            let distance: f64 = row[5].parse().unwrap();
            assert!((distance - apart).abs() < 3.5e-10, "{case}: {distance:e}");
        }
        let between = |boundary: &&Value| {
            boundary["below"]["itinerary"] == rows[0][3].as_str()
                && boundary["above"]["itinerary"] == rows[1][3].as_str()
                && boundary["kind"] == case["kind"]
        };
        assert!(list(&atlas, "boundaries").iter().any(|b| between(&b)), "{case}");
    }
}

#[test]
fn located_points_are_computed_collisions() {
    let workspace = Workspace::new();
    workspace.write("a.json", &atlas().0);
    let mut random = 1_u64;
    let mut uniform = |low: f64, high: f64| {
        random =
            random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((random >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut points = "name,psi,kappa\n".to_owned();
    for index in 0..500 {
        let _ = writeln!(points, "p{index},{:?},{:?}", uniform(0.2, 2.5), uniform(5.0, 20.0));
    }
    workspace.write("p.csv", &points);
    let ran = workspace.run("locate --atlas a.json --batch p.csv --out o.csv");
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    assert_eq!(workspace.run("collide --batch p.csv --out c.csv").code, 0);
    let (located, computed) = (rows(&workspace.read("o.csv")), rows(&workspace.read("c.csv")));
    assert_eq!(located[0].join(","), "name,psi,kappa,switch_count,itinerary,region,distance");
    assert_eq!(located.len(), 501);
    for (located, computed) in located[1..].iter().zip(&computed[1..]) {
        assert_eq!(located[..3], computed[..3]);
        assert_eq!(located[3..5], computed[5..7], "{located:?}");
        assert!(located[6].parse::<f64>().unwrap() > 0.0);
    }
}

#[test]
fn points_that_cannot_be_located_are_named() {
    let workspace = Workspace::new();
    workspace.write("a.json", &atlas().0);
    // Without damping, no collision sticks above ψ = 2.
    workspace.write("p.csv", "kappa,psi\n6,0.5\n6,2\n4,1\n6,2.6\n6,x\n6\n");
    let ran = workspace.run("locate --atlas a.json --batch p.csv --out o.csv");
    assert_eq!(ran.code, 1);
    for part in ["4 of 6 points", "o.csv", "row 3", "kappa = 4.0, psi = 1.0", "outside"] {
        assert!(ran.stderr.contains(part), "{part}: {}", ran.stderr);
    }
    let located = rows(&workspace.read("o.csv"));
    assert_eq!(located[1][2], "4");
    // On the boundary itself the collision decides.
    let ran = workspace.run("collide --kappa 6 --psi 2 --method exact --format json");
    let computed: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(computed["itinerary"], *located[2][3]);
    assert!(located[2][5].parse::<f64>().unwrap() < 3.5e-10, "{:?}", located[2]);
    for row in &located[3..] {
        assert_eq!(row[2..5], ["", "", ""], "{row:?}");
    }
    assert_eq!(located[3][5], "");
}

#[test]
fn a_window_without_a_boundary_is_one_region() {
    let workspace = Workspace::new();
    let line = "trace --kappa 5:6 --ratio 2.9:3.5 --mu 0.4 --alpha 2/7 --out a.json --plot a.png";
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let found = "0 boundaries, 1 region, verified at 20001 points; wrote a.json, a.png\n";
    assert_eq!(ran.said, found);
    let atlas: Value = serde_json::from_str(&workspace.read("a.json")).unwrap();
    let psi = [2.9, 3.5].map(|ratio| ratio * (2.0 / 7.0) / 0.4);
    assert_eq!(pair(&atlas["window"]["psi"]), psi);
    assert_eq!(pair(&atlas["window"]["ratio"]), [2.9, 3.5]);
    assert_eq!(list(&atlas, "boundaries").len(), 0);
    assert_eq!(list(&atlas, "regions").len(), 1);
    assert_eq!(atlas["regions"][0]["itinerary"], "+");
    workspace.write("p.csv", "kappa,psi\n5.5,2.3\n");
    assert_eq!(workspace.run("locate --atlas a.json --batch p.csv --out o.csv").code, 0);
    assert_eq!(
        workspace.read("o.csv"),
        "kappa,psi,switch_count,itinerary,region,distance\n5.5,2.3,0,+,0,\n"
    );
    let ran = workspace.run("locate a.json --batch p.csv");
    assert_eq!((ran.code, ran.stdout), (0, workspace.read("o.csv")));
    assert_eq!(ran.said, "1 point located; wrote standard output\n");
}

fn of_kind<'a>(atlas: &'a Value, kind: &str) -> Vec<&'a Value> {
    list(atlas, "vertices").iter().filter(|vertex| vertex["kind"] == kind).collect()
}

#[test]
fn special_points_have_names() {
    let workspace = Workspace::new();
    // Grazes while sliding and while sticking merge where their law has B = 1, at ψ = 1.
    let ran = workspace.run("trace --kappa 1.4:1.7 --psi 0.9:1.1 --out a.json");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let atlas: Value = serde_json::from_str(&workspace.read("a.json")).unwrap();
    let [cusp] = of_kind(&atlas, "degenerate")[..] else { panic!("{}", atlas["vertices"]) };
    assert!((cusp["kappa"].as_f64().unwrap() - 1.568459328886909846).abs() < 2e-15, "{cusp}");
    assert!((cusp["psi"].as_f64().unwrap() - 1.0).abs() < 2e-15, "{cusp}");
    assert_eq!(list(cusp, "boundaries").len(), 2);
    assert_eq!(list(&atlas, "extrema").len(), 0);

    // On one boundary the spring is at zero at the end of contact. It ends where a graze takes its
    // place.
    let ran = workspace.run("trace --kappa 0.8:1.2 --psi 0.2:0.5 --damping 0.1 --out a.json");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let atlas: Value = serde_json::from_str(&workspace.read("a.json")).unwrap();
    let [end] = of_kind(&atlas, "graze-at-end")[..] else { panic!("{}", atlas["vertices"]) };
    assert_eq!(list(end, "boundaries").len(), 3);
    workspace.write("p.csv", "kappa,psi\n0.9,0.4\n");
    assert_eq!(workspace.run("locate --atlas a.json --batch p.csv --out o.csv").code, 0);
}

#[test]
fn boundaries_that_turn_back_have_extrema() {
    let workspace = Workspace::new();
    let ran = workspace.run("trace --kappa 7:9 --psi 0.06:0.1 --damping 0.1 --out a.json");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let atlas: Value = serde_json::from_str(&workspace.read("a.json")).unwrap();
    let [extremum] = list(&atlas, "extrema") else { panic!("{}", atlas["extrema"]) };
    assert_eq!(extremum["of"], "kappa");
    let place = ["kappa", "psi"].map(|name| extremum[name].as_f64().unwrap());
    let boundary =
        &atlas["boundaries"][usize::try_from(extremum["boundary"].as_u64().unwrap()).unwrap()];
    let points: Vec<_> = list(boundary, "points").iter().map(pair).collect();
    // All points of the boundary are on one side of the extremum in κ, and they are on both sides
    // of it in ψ.
    assert!(points.iter().all(|point| point[0] > place[0]), "{place:?} {points:?}");
    assert!(points.iter().any(|point| point[1] > place[1]));
    assert!(points.iter().any(|point| point[1] < place[1]));
}

#[test]
fn geojson_holds_what_the_atlas_has() {
    let workspace = Workspace::new();
    let ran = workspace.run(&format!("{WINDOW} --out a.json --geojson a.geojson"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.names(), ["a.geojson", "a.json"]);
    assert_eq!(workspace.read("a.json"), atlas().0);
    let (map, atlas): (Value, Value) =
        (serde_json::from_str(&workspace.read("a.geojson")).unwrap(), parsed());
    assert_eq!(map["type"], "FeatureCollection");
    let features = list(&map, "features");
    let of = |name: &str| -> Vec<&Value> {
        features.iter().filter(|feature| feature["properties"]["feature"] == name).collect()
    };
    let (regions, boundaries, vertices) = (of("region"), of("boundary"), of("vertex"));
    assert_eq!(regions.len() + boundaries.len() + vertices.len(), features.len());
    assert_eq!(regions.len(), list(&atlas, "regions").len());
    assert_eq!(boundaries.len(), list(&atlas, "boundaries").len());
    assert_eq!(vertices.len(), list(&atlas, "vertices").len());
    for (feature, vertex) in vertices.iter().zip(list(&atlas, "vertices")) {
        assert_eq!(feature["geometry"]["type"], "Point");
        assert_eq!(feature["properties"]["kind"], vertex["kind"]);
        let place = ["kappa", "psi"].map(|name| vertex[name].as_f64().unwrap());
        assert_eq!(pair(&feature["geometry"]["coordinates"]), place);
    }
    for (feature, boundary) in boundaries.iter().zip(list(&atlas, "boundaries")) {
        assert_eq!(feature["geometry"]["type"], "LineString");
        assert_eq!(feature["properties"]["kind"], boundary["kind"]);
        assert_eq!(feature["properties"]["below_itinerary"], boundary["below"]["itinerary"]);
        assert!(list(&feature["geometry"], "coordinates").len() >= list(boundary, "points").len());
    }
    // In the plane of ln κ and ln(1 + ψ) each polygon has the share of the window that its region
    // has.
    let window = 4.0_f64.ln() * (3.5_f64 / 1.2).ln();
    for (feature, region) in regions.iter().zip(list(&atlas, "regions")) {
        assert_eq!(feature["properties"]["itinerary"], region["itinerary"]);
        assert_eq!(feature["geometry"]["type"], "Polygon", "{region}");
        let rings = list(&feature["geometry"], "coordinates");
        let mut area = 0.0;
        for ring in rings {
            let points: Vec<[f64; 2]> = ring
                .as_array()
                .unwrap()
                .iter()
                .map(|point| [pair(point)[0].ln(), pair(point)[1].ln_1p()])
                .collect();
            assert_eq!(points[0], points[points.len() - 1]);
            area += points
                .windows(2)
                .map(|side| 0.5 * (side[0][0] * side[1][1] - side[0][1] * side[1][0]))
                .sum::<f64>();
        }
        let share = region["area_share"].as_f64().unwrap();
        assert!((area / window - share).abs() < 1e-4, "{} {share}", area / window);
    }
    let ran = workspace.run(&format!("{WINDOW} --out b.json --geojson b.json"));
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("--geojson b.json"), "{}", ran.stderr);
    let ran = workspace.run(&format!("{WINDOW} --out b.svg --plot ./b.svg"));
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("--plot ./b.svg is the same file as --out"), "{}", ran.stderr);
    let ran = workspace.run(&format!("{WINDOW} --out b.json --geojson no/b.json"));
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("no/b.json: cannot be written"), "{}", ran.stderr);
    assert_eq!(workspace.names(), ["a.geojson", "a.json"]);
}

#[test]
fn with_damping_collisions_begin_in_stick() {
    let workspace = Workspace::new();
    let ran = workspace.run("trace --kappa 5:8 --psi 0.5:1.5 --damping 0.05 --out a.json");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let atlas: Value = serde_json::from_str(&workspace.read("a.json")).unwrap();
    assert_eq!(atlas["verification"]["method"], "dop853");
    for region in list(&atlas, "regions") {
        assert!(region["itinerary"].as_str().unwrap().starts_with('o'), "{region}");
    }
}

#[test]
fn pictures_show_boundaries_by_kind_and_counts() {
    let document = Document::parse(&atlas().1).expect("XML");
    let group = |class: &str| {
        document.descendants().find(|node| node.attribute("class") == Some(class)).expect("a group")
    };
    let atlas = parsed();
    for kind in ["end-of-contact", "stick-graze", "slip-graze"] {
        let lines = group(kind).children().filter(|node| node.has_tag_name("polyline")).count();
        let of_kind = list(&atlas, "boundaries").iter().filter(|b| b["kind"] == kind);
        assert_eq!(lines, of_kind.count(), "{kind}");
    }
    let counts: Vec<String> =
        list(&atlas, "regions").iter().map(|region| region["switch_count"].to_string()).collect();
    let labels: Vec<_> = group("regions")
        .children()
        .filter_map(|node| node.text())
        .map(str::trim)
        .filter(|text| !text.is_empty())
        .collect();
    assert!(labels.len() >= 3, "{labels:?}");
    assert!(labels.iter().all(|label| counts.iter().any(|count| count == label)), "{labels:?}");
}

#[test]
fn the_same_atlas_with_any_number_of_threads() {
    let workspace = Workspace::new();
    for threads in [1, 3] {
        let ran = workspace.run(&format!("{WINDOW} --threads {threads} --out a.json --plot a.svg"));
        assert_eq!(ran.code, 0);
        assert_eq!((workspace.read("a.json"), workspace.read("a.svg")), *atlas());
    }
}

#[test]
fn bad_windows_are_refused() {
    let workspace = Workspace::new();
    for (options, parts) in [
        ("--kappa 0:20 --psi 0.2:2", ["--kappa", "LO > 0"]),
        ("--kappa 5:20 --psi 0:2", ["--psi", "LO > 0"]),
        ("--kappa 5:20 --ratio 0:2", ["--ratio", "LO > 0"]),
        ("--kappa 5:20", ["--psi", "--ratio"]),
        ("--psi 1:2", ["--kappa", "missing"]),
        ("--kappa 5:20 --psi 0.2:2 --ratio 1:2", ["--psi", "--ratio"]),
        ("--kappa 5:20 --psi 0.2:2 --mu 0.4", ["--mu", "--ratio"]),
        ("--kappa 5:20 --psi 0.2:2 --tolerance 1e-3", ["--tolerance", "e-11 to 2.7"]),
        ("--kappa 5:20 --psi 0.2:2 --tolerance 1e-12", ["--tolerance", "3e-11"]),
        ("--kappa 5:20 --psi 0.2:0.20000001", ["too narrow", "expected"]),
    ] {
        let ran = workspace.run(&format!("trace {options} --out a.json"));
        assert_eq!(ran.code, 2, "{options}: {}", ran.stderr);
        for part in parts {
            assert!(ran.stderr.contains(part), "{options}: {}", ran.stderr);
        }
    }
    let ran = workspace.run(&format!("{WINDOW} --out no/a.json"));
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("no/a.json: cannot be written"), "{}", ran.stderr);
    assert_eq!(workspace.names().len(), 0);
}

#[test]
fn damaged_atlases_are_refused() {
    let workspace = Workspace::new();
    workspace.write("p.csv", "kappa,psi\n6,0.5\n");
    let refused = |text: &str, parts: &[&str]| {
        workspace.write("a.json", text);
        let ran = workspace.run("locate --atlas a.json --batch p.csv --out o.csv");
        assert_eq!(ran.code, 2, "{parts:?}: {}", ran.stderr);
        for part in ["a.json"].iter().chain(parts) {
            assert!(ran.stderr.contains(part), "no {part:?} in {}", ran.stderr);
        }
        assert_eq!(workspace.names(), ["a.json", "p.csv"]);
    };
    refused("", &["line 1"]);
    refused(&atlas().0[..5000], &["line 1 column 5000"]);
    refused("{}", &["schema"]);
    refused(&format!("\u{feff}{}", atlas().0), &["line 1 column 1"]);
    refused(
        &atlas().0.replace(r#""tolerance":"#, r#""tolerance":1e-9,"tolerance":"#),
        &["tolerance"],
    );
    refused(&atlas().0.replace(r#""damping":0.0"#, r#""damping":NaN"#), &["line 1"]);
    refused(r#"{"schema": "stickslip.atlas/2"}"#, &["stickslip.atlas/2", "stickslip.atlas/1"]);
    // Whatever was edited is noticed by its digest, and without digests by what it contradicts.
    let refused_with = |change: &dyn Fn(&mut Value), parts: &[&str]| {
        let mut atlas = parsed();
        change(&mut atlas);
        refused(&atlas.to_string(), &["has changed since the file was written"]);
        atlas.as_object_mut().unwrap().remove("digests");
        refused(&atlas.to_string(), parts);
    };
    for removed in 0..list(&parsed(), "boundaries").len() {
        refused_with(
            &|atlas| {
                let boundaries = atlas["boundaries"].as_array_mut().unwrap();
                boundaries.remove(removed);
                for (id, boundary) in boundaries.iter_mut().enumerate() {
                    boundary["id"] = id.into();
                }
            },
            &[],
        );
    }
    refused_with(&|atlas| atlas["boundaries"][0]["id"] = 7.into(), &["boundaries[0].id = 7"]);
    refused_with(&|atlas| atlas["boundaries"][0]["kind"] = "x".into(), &["boundaries[0].kind"]);
    refused_with(
        &|atlas| atlas["boundaries"][0]["points"][1][0] = Value::Null,
        &["boundaries[0].points[1]"],
    );
    refused_with(
        &|atlas| atlas["boundaries"][0]["points"][1][0] = (-1).into(),
        &["boundaries[0].points[1]"],
    );
    refused_with(&|atlas| atlas["boundaries"][0]["vertices"][1] = 9999.into(), &["9999"]);
    refused_with(
        &|atlas| atlas["boundaries"][0]["above"]["itinerary"] = "+oo".into(),
        &["boundaries[0].above"],
    );
    refused_with(&|atlas| atlas["boundaries"][0]["tangents"][0][0] = 3.into(), &["tangent"]);
    refused_with(&|atlas| atlas["window"]["psi"][0] = 0.into(), &["window.psi"]);
    refused_with(&|atlas| atlas["tolerance"] = 0.into(), &["tolerance"]);
    refused_with(&|atlas| atlas["tolerance"] = 1e-3.into(), &["tolerance"]);
    refused_with(
        &|atlas| {
            let (one, other) = (atlas["regions"][0].clone(), atlas["regions"][1].clone());
            atlas["regions"][0]["itinerary"] = other["itinerary"].clone();
            atlas["regions"][0]["switch_count"] = other["switch_count"].clone();
            assert_ne!(one["itinerary"], other["itinerary"]);
        },
        &["regions[0]"],
    );
    refused_with(&|atlas| atlas["verification"]["agrees"] = false.into(), &["verification"]);
    refused_with(&|atlas| atlas["regions"].as_array_mut().unwrap().clear(), &["regions"]);
    refused_with(
        &|atlas| atlas["regions"][0]["sample"] = atlas["regions"][1]["sample"].clone(),
        &["regions[0]"],
    );
}

#[test]
fn bad_points_are_refused() {
    let workspace = Workspace::new();
    workspace.write("a.json", &atlas().0);
    for (points, part) in [
        ("", "is empty"),
        ("kappa,ratio\n", "expected columns kappa and psi"),
        ("kappa,psi,region\n", "column region has the name of a result"),
    ] {
        workspace.write("p.csv", points);
        let ran = workspace.run("locate --atlas a.json --batch p.csv --out o.csv");
        assert_eq!(ran.code, 2, "{points:?}");
        assert!(ran.stderr.contains(part), "{points:?}: {}", ran.stderr);
    }
    let ran = workspace.run("locate --atlas a.json --batch p.csv --out a.json");
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    // Columns of parameters that an atlas does not need pass through.
    workspace.write("p.csv", "kappa,psi,ratio,damping\n6,0.5,x,y\n");
    assert_eq!(workspace.run("locate --atlas a.json --batch p.csv --out o.csv").code, 0);
    assert!(workspace.read("o.csv").contains("6,0.5,x,y,4,"));
}

#[test]
fn one_point_is_located_without_files() {
    let workspace = Workspace::new();
    workspace.write("a.json", &atlas().0);
    let ran = workspace.run("locate a.json --kappa 6 --psi 0.5");
    assert_eq!((ran.code, ran.stderr.as_str(), ran.said.as_str()), (0, "", ""));
    let line = |start: &str| {
        let found = ran.stdout.lines().find_map(|line| line.strip_prefix(start));
        found.unwrap_or_else(|| panic!("{start}: {}", ran.stdout)).trim()
    };
    let computed = workspace.run("collide --kappa 6 --psi 0.5 --format json").stdout;
    let computed: Value = serde_json::from_str(&computed).unwrap();
    assert_eq!(line("switches "), computed["switch_count"].to_string());
    assert_eq!(line("itinerary ").split(' ').next(), computed["itinerary"].as_str());
    assert!(line("distance to a boundary in ψ ").parse::<f64>().unwrap() > 0.0);
    assert!(line("region ").parse::<usize>().is_ok());
    for (line, code, expected) in [
        ("locate a.json --kappa 4 --psi 0.5", 1, "outside the window"),
        ("locate a.json --kappa 6", 2, "--psi"),
        ("locate a.json", 2, "--batch"),
        ("locate --kappa 6 --psi 1", 2, "ATLAS.json"),
        ("locate a.json --kappa 6 --psi 0.5 --out o.csv", 2, "--out"),
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (code, ""), "{line}");
        assert!(ran.stderr.contains(expected), "{line}: {}", ran.stderr);
    }
}
