//! Files of impacts.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::fs;

use serde_json::Value;

use crate::impact::{example, example_value};
use crate::{Workspace, rows};

const BATCH: &str = "impact --batch in.csv --bodies bodies.json --out out.csv";

fn workspace(bodies: &str, input: &str) -> Workspace {
    let workspace = Workspace::with_input(input);
    workspace.write("bodies.json", fs::read(example(bodies)).unwrap());
    workspace
}

/// The field of a row in the column of a name.
fn field<'a>(table: &'a [Vec<String>], row: usize, name: &str) -> &'a str {
    let column = table[0].iter().position(|it| it == name);
    &table[row][column.unwrap_or_else(|| panic!("no column {name}"))]
}

/// Where the JSON of one impact has the result of a column.
fn pointer(column: &str) -> String {
    let place = match column {
        "kappa" | "psi" | "damping" => "parameters/",
        name if name.ends_with("_j") => return format!("/energy_j/{}", &name[..name.len() - 2]),
        name if name.contains("angle_rad") || ["centre_e_t", "impulse_ratio"].contains(&name) => {
            "observed/"
        }
        _ => "",
    };
    format!("/{place}{}", column.replace('[', "/").replace(']', "").replace('.', "/"))
}

/// Checks that a row has bit for bit the results of the single impact that `line` computes.
fn same(workspace: &Workspace, table: &[Vec<String>], row: usize, line: &str) {
    let ran = workspace.run(&format!("impact {line} --format json"));
    assert_eq!(ran.code, 0, "{line}: {}", ran.stderr);
    let object: Value = serde_json::from_str(&ran.stdout).unwrap();
    let first = table[0].iter().position(|name| name == "kappa").unwrap();
    for (name, shown) in table[0].iter().zip(&table[row]).skip(first) {
        if name == "status" {
            assert_eq!(shown, "ok");
            continue;
        }
        match object.pointer(&pointer(name)).unwrap_or_else(|| panic!("no {name}")) {
            Value::Null => assert_eq!(shown, "", "{name}"),
            Value::String(text) => assert_eq!(shown, text, "{name}"),
            number => {
                let number = number.as_f64().unwrap().to_bits();
                assert_eq!(shown.parse::<f64>().unwrap().to_bits(), number, "{name}: {line}");
            }
        }
    }
}

#[test]
fn rows_are_the_single_impacts_bit_for_bit() {
    for (bodies, options) in [
        ("steel_pair.json", ""),
        ("steel_pair.json", "--method auto"),
        ("glass_on_wall.json", "--method dopri5 --rtol 1e-8"),
        ("hooke_spheres.json", "--law gran/hooke/history"),
    ] {
        let velocities = [(1.0, 0.3), (0.01, 0.004), (3.0, 0.0), (0.2, 2.0)];
        let mut input = "normal_m_per_s,tangential_m_per_s\n".to_owned();
        for (normal, tangential) in velocities {
            writeln!(input, "{normal},{tangential}").unwrap();
        }
        let workspace = workspace(bodies, &input);
        let ran = workspace.run(&format!("{BATCH} {options}"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{bodies}");
        let table = rows(&workspace.read("out.csv"));
        for (row, (normal, tangential)) in velocities.into_iter().enumerate() {
            let given = format!("--normal {normal} --tangential {tangential}");
            same(&workspace, &table, row + 1, &format!("bodies.json {given} {options}"));
        }
        // A central impact has no tangential restitution.
        assert_eq!((field(&table, 3, "eps_t"), field(&table, 3, "itinerary")), ("", "o"));
    }
}

#[test]
fn columns_change_what_they_name() {
    let input = "wall.motion.velocity_m_per_s[2],spheres[0].motion.spin_rad_per_s[1],\
                 spheres[0].radius_m,spheres[0].motion.position_m[2],surface.friction,\
                 spheres[0].material.poisson_ratio,wall.material.young_modulus_pa\n\
                 0.2,30,0.0015,0.0015,1/3,0.3,1e11\n-0.1,-40,0.002,2e-3,0.4,-0.5,3e9\n";
    let workspace = workspace("glass_on_wall.json", input);
    let ran = workspace.run(&format!("{BATCH} --events ev.csv"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let table = rows(&workspace.read("out.csv"));
    let events = rows(&workspace.read("ev.csv"));
    for (row, values) in [
        [0.2, 30.0, 0.0015, 0.0015, 1.0 / 3.0, 0.3, 1e11],
        [-0.1, -40.0, 0.002, 0.002, 0.4, -0.5, 3e9],
    ]
    .into_iter()
    .enumerate()
    {
        let mut file = example_value("glass_on_wall.json");
        for (name, value) in table[0].iter().zip(values) {
            let place = format!("/{}", name.replace('[', "/").replace(']', "").replace('.', "/"));
            *file.pointer_mut(&place).unwrap() = value.into();
        }
        workspace.write("one.json", file.to_string());
        same(&workspace, &table, row + 1, "one.json");
        let ran = workspace.run("impact one.json --format json");
        let object: Value = serde_json::from_str(&ran.stdout).unwrap();
        let case = row.to_string();
        let own: Vec<_> = events[1..].iter().filter(|event| event[0] == case).collect();
        let switches = object["switches"].as_array().unwrap();
        assert_eq!(own.len(), switches.len());
        for (event, switch) in own.iter().zip(switches) {
            for (name, shown) in events[0].iter().zip(event.iter()).skip(2) {
                match &switch[name.as_str()] {
                    Value::String(text) => assert_eq!(text, shown),
                    number => assert_eq!(number.as_f64(), shown.parse().ok(), "{name}"),
                }
            }
        }
    }
}

/// Objects and vectors that the file lacks come from columns, and a file may hold no number at all.
#[test]
fn a_file_without_numbers() {
    let input = "spheres[0].radius_m,spheres[0].mass_kg,spheres[0].material.young_modulus_pa,\
                 spheres[0].material.poisson_ratio,surface.friction,surface.damping_time_s,\
                 surface.tangential_stiffness_kg_per_s2,speed_m_per_s\n\
                 0.01,0.02,1e9,0.3,0.4,0,1e6,2\n";
    let workspace = workspace("steel_pair.json", input);
    workspace.write("bodies.json", "{\"spheres\": [{}], \"wall\": {\"rigid\": true}}");
    let ran = workspace.run(&format!("{BATCH} --angle 0.5"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let table = rows(&workspace.read("out.csv"));
    assert_eq!(field(&table, 1, "status"), "ok");
    let angle: f64 = field(&table, 1, "patch_impact_angle_rad").parse().unwrap();
    assert!((angle - 0.5).abs() < 1e-15);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let mut input = "normal_m_per_s,surface.friction\n".to_owned();
    for row in 0..2000 {
        writeln!(input, "{},{}", 0.01 * f64::from(row % 300), 0.1 + 0.001 * f64::from(row))
            .unwrap();
    }
    let workspace = workspace("glass_on_wall.json", &input);
    let mut first = None;
    for threads in [1, 2, 5] {
        let line = format!("{BATCH} --events e --tangential 0.3 --method auto --threads {threads}");
        // Every 300th row does not approach.
        assert_eq!(workspace.run(&line).code, 1);
        let results = (workspace.read("out.csv"), workspace.read("e"));
        assert_eq!(results.0.matches(",ok\n").count(), 1993);
        assert!(first.get_or_insert_with(|| results.clone()) == &results, "{threads}");
    }
}

#[test]
fn a_row_that_cannot_be_computed_does_not_stop_the_others() {
    let input = "\u{feff}id, speed_m_per_s ,angle_rad,surface.friction\r\n\
                 a,2,0.5,0.3\r\n\r\n\
                 b,0,0.5,0.3\r\nc,2,1.5707963267948966,0.3\r\nd,2,-0.1,0.3\r\ne,nan,0.5,0.3\r\n\
                 f,1e400,0.5,0.3\r\ng,2,0.5,\r\nh,2,0.5\r\ni,2,0.5,0.3,7\r\nj,1e200,0.5,0.3\r\n\
                 \"k\",\" 2\",\"0.5\",\"0.3\"\r\n";
    let workspace = workspace("steel_pair.json", input);
    let ran = workspace.run(BATCH);
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("9 of 11 rows could not be computed"), "{}", ran.stderr);
    let table = rows(&workspace.read("out.csv"));
    let angle = "expected a number, 0 or above and below π/2, in rad";
    let written = "written like 18, 1.5e3 or 2/7";
    for (row, expected) in [
        (2, "line 4: speed_m_per_s = '0': out of range; expected a finite number above 0, in m/s"),
        (3, &format!("line 5: angle_rad = '1.5707963267948966': out of range; {angle}")),
        (4, &format!("line 6: angle_rad = '-0.1': out of range; {angle}")),
        (
            5,
            &format!(
                "line 7: speed_m_per_s = 'nan': not a number; expected a finite number above 0, in \
                 m/s, {written}"
            ),
        ),
        (
            6,
            &format!(
                "line 8: speed_m_per_s = '1e400': not finite; expected a finite number above 0, in \
                 m/s, {written}"
            ),
        ),
        (
            7,
            &format!(
                "line 9: surface.friction = '': empty; expected a finite number, 0 or above, \
                 without unit, {written}"
            ),
        ),
        (8, "line 10: 3 fields; expected one for each column of the header, 4"),
        (9, "line 11: 5 fields; expected one for each column of the header, 4"),
    ] {
        assert_eq!(field(&table, row, "status"), expected);
        assert_eq!(field(&table, row, "eps_n"), "");
    }
    assert!(field(&table, 10, "status").contains("kinetic_before_j is not a finite number"));
    assert_eq!(table[1][4..], table[11][4..]);
}

/// A contact that never ends, by its damping, has a reason and leaves the other rows alone.
#[test]
fn a_contact_that_never_ends() {
    let input = "surface.damping_ratio\n0.1\n5\n0.2\n";
    let workspace = workspace("hooke_spheres.json", input);
    let ran = workspace.run(&format!("{BATCH} --law gran/hooke/history --normal 1 --tangential 1"));
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    let table = rows(&workspace.read("out.csv"));
    let status = [1, 2, 3].map(|row| field(&table, row, "status"));
    assert_eq!((status[0], status[2]), ("ok", "ok"));
    assert!(status[1].contains("contacts of this law never end"), "{}", status[1]);
}

/// Runs a batch that must be refused as a whole with a message that contains all of `parts`.
fn refused(bodies: &str, input: &str, options: &str, parts: &[&str]) {
    let workspace = workspace(bodies, input);
    let ran = workspace.run(&format!("{BATCH} {options}"));
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{input:?}: {}", ran.stderr);
    for part in parts {
        assert!(ran.stderr.contains(part), "{input:?}: no {part:?} in {}", ran.stderr);
    }
    assert_eq!(workspace.names(), ["bodies.json", "in.csv"], "{input:?}");
}

#[test]
fn headers_that_do_not_make_impacts() {
    let pair = "steel_pair.json";
    let speeds = "--normal 1 --tangential 1";
    refused(pair, "", "", &["in.csv", "empty", "normal_m_per_s,tangential_m_per_s"]);
    refused(pair, "id\n1\n", "", &["in.csv", "lacks a motion", "speed_m_per_s and angle_rad"]);
    for (header, part) in [
        ("normal_m_per_s", "without tangential_m_per_s"),
        ("tangential_m_per_s", "without normal_m_per_s"),
        ("speed_m_per_s", "without angle_rad"),
        ("angle_rad", "without speed_m_per_s"),
        ("angle_rad,speed_m_per_s,normal_m_per_s", "expected one of both pairs"),
        ("speed_m_per_s,speed_m_per_s", "two columns are named"),
        ("spheres[0].radius_m,spheres[0].radius_m", "two columns are named"),
        ("status", "name of a result"),
        ("spheres[1].spin_rad_per_s[0]", "name of a result"),
        ("spheres[2].radius_m", "is not a number of these bodies"),
        ("spheres[0].diameter_m", "is not a number of these bodies"),
        ("sphere.radius_m", "is not a number of these bodies"),
        ("wall.material.young_modulus_pa", "is not a number of these bodies"),
        ("Surface.Friction", "surface.friction, surface.dynamic_friction"),
        ("friction", "surface.friction"),
        ("radius_m", "spheres[0].radius_m"),
        ("velocity_m_per_s", "spheres[0].motion.velocity_m_per_s[0]"),
        ("mu", "is not a number of these bodies"),
        ("angle_deg", "angle_rad"),
        ("Angle_rad", "angle_rad"),
        ("law", "is not a number of these bodies"),
        ("spheres[0].motion.spin_rad_per_s[1]", "position_m is missing"),
    ] {
        refused(pair, &format!("{header}\n{}\n", header.replace(|c| c != ',', "1")), "", &[part]);
    }
    refused(pair, "normal_m_per_s\n1\n", speeds, &["column normal_m_per_s and --normal"]);
    refused(pair, "speed_m_per_s,angle_rad\n1,1\n", "--normal 1", &["expected one of both pairs"]);
    refused(pair, "id\n1\n", "--normal 1 --angle 1 --speed 1", &["--normal or --tangential"]);
    let motion = "spheres[0].motion.velocity_m_per_s[0]\n1\n";
    refused("steel_spheres.json", motion, speeds, &["velocities of the surfaces and the column"]);
}

/// What is wrong in every row is refused at once.
#[test]
fn bodies_that_no_row_makes_right() {
    let speeds = "--normal 1 --tangential 1";
    let mass = "spheres[0].mass_kg\n1\n";
    refused("steel_pair.json", mass, speeds, &["spheres[0].mass_kg", "both given"]);
    let stiffness = "surface.normal_stiffness_kg_per_s2\n1\n";
    refused("steel_pair.json", stiffness, speeds, &["no meaning in this law"]);
    refused("hooke_spheres.json", "id\n1\n", speeds, &["no meaning in this law"]);
    let law = "--law gran/none";
    refused("steel_pair.json", "id\n1\n", &format!("{speeds} {law}"), &["gran/none", "laws"]);
    let exact = format!("{speeds} --method exact --rtol 1e-9");
    refused("steel_pair.json", "id\n1\n", &exact, &["--rtol", "exact"]);
}

#[test]
fn a_header_without_rows() {
    let workspace = workspace("steel_pair.json", "speed_m_per_s,angle_rad\n");
    assert_eq!(workspace.run(BATCH).code, 0);
    assert_eq!(rows(&workspace.read("out.csv")).len(), 1);
}

#[test]
fn options_that_do_not_fit() {
    let workspace = workspace("steel_pair.json", "speed_m_per_s,angle_rad\n1,1\n");
    let right = format!("{FRAC_PI_2:?}");
    for (line, parts) in [
        ("impact --batch in.csv --out out.csv", ["--bodies", "JSON file"]),
        ("impact bodies.json --out o", ["--out", "--batch"]),
        ("impact bodies.json --batch in.csv --out o", ["FILE.json", "--batch"]),
        ("impact bodies.json --bodies bodies.json", ["FILE.json", "--bodies"]),
        (&format!("{BATCH} --course c.csv"), ["--course", "--batch"]),
        (&format!("{BATCH} --format json"), ["--format", "--batch"]),
        ("impact --batch in.csv --bodies bodies.json --out in.csv", ["same file", "--batch"]),
        (
            "impact --batch in.csv --bodies bodies.json --out ./bodies.json",
            ["same file", "--bodies"],
        ),
        (&format!("{BATCH} --events out.csv"), ["same file", "--out"]),
        ("impact --batch - --bodies - --out o", ["--bodies -", "--batch -"]),
        ("impact bodies.json --points 5", ["--course", "required"]),
        ("impact bodies.json --course c.csv --points 1", ["--points", "2..=10000000"]),
        (
            "impact bodies.json --normal 1 --tangential 1 --course ./bodies.json",
            ["same file", "FILE"],
        ),
        ("impact bodies.json --speed 1", ["--speed", "--angle"]),
        (&format!("impact bodies.json --speed 1 --angle {right}"), ["--angle", "below π/2"]),
        ("impact bodies.json --normal 0 --tangential 1", ["--normal", "above 0"]),
        ("impact bodies.json", ["spheres[0].motion", "missing"]),
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}: {}", ran.stderr);
        assert!(parts.iter().all(|part| ran.stderr.contains(part)), "{line}: {}", ran.stderr);
        assert_eq!(workspace.names(), ["bodies.json", "in.csv"], "{line}");
    }
}
