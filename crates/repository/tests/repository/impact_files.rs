//! Files that `impact` refuses, with a message that names the field and what is expected. The
//! schema refuses the same files, except where positions and velocities matter.

use std::fs;

use jsonschema::Validator;
use serde_json::{Value, json};
use stickslip_cli::{Failure, FileError};

use crate::root;

const POSITIVE: &str = "expected a finite number above 0";

fn schema() -> Validator {
    let schema = fs::read_to_string(root().join("docs/impact.schema.json")).expect("the schema");
    jsonschema::draft202012::new(&serde_json::from_str(&schema).expect("JSON")).expect("a schema")
}

/// The file of an example.
fn example_value(name: &str) -> Value {
    let text = fs::read_to_string(root().join("examples").join(name)).expect("an example");
    serde_json::from_str(&text).expect("JSON")
}

/// Computes the impact that `text` describes.
fn run(text: impl AsRef<[u8]>) -> Result<(), Failure> {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let file = directory.path().join("bodies.json");
    fs::write(&file, text).expect("a file");
    stickslip_cli::run(["stickslip".as_ref(), "impact".as_ref(), file.as_os_str()])
}

/// `text` must be refused as bad input, with a message that contains all of `parts`.
fn refused(text: impl AsRef<[u8]>, parts: &[&str]) {
    let refusal = run(text);
    let Err(failure @ Failure::File(FileError::Input { .. })) = refusal else {
        panic!("{parts:?}: {refusal:?}")
    };
    let message = failure.to_string();
    for part in ["bodies.json: "].iter().chain(parts) {
        assert!(message.contains(part), "no {part:?} in {message}");
    }
    assert_eq!(message.lines().count(), 1, "{message}");
}

/// A copy of `file` in which the field at `path` is `value`, or missing. An array may grow by one.
fn with(file: &Value, path: &str, value: Option<Value>) -> Value {
    let mut file = file.clone();
    let (parent, name) = path.rsplit_once('/').expect("a path");
    match (file.pointer_mut(parent).expect("a parent"), value) {
        (Value::Object(fields), Some(value)) => drop(fields.insert(name.to_owned(), value)),
        (Value::Object(fields), None) => drop(fields.remove(name).expect("a field")),
        (Value::Array(items), value) => {
            let index: usize = name.parse().expect("an index");
            items.splice(index..items.len().min(index + 1), value);
        }
        _ => panic!("{path}"),
    }
    file
}

/// Every field with a number: its path in the file, and its name in messages.
const NUMBERS: [(&str, &str); 9] = [
    ("/spheres/0/radius_m", "spheres[0].radius_m"),
    ("/spheres/1/radius_m", "spheres[1].radius_m"),
    ("/spheres/0/material/young_modulus_pa", "spheres[0].material.young_modulus_pa"),
    ("/spheres/1/material/poisson_ratio", "spheres[1].material.poisson_ratio"),
    ("/spheres/1/material/density_kg_per_m3", "spheres[1].material.density_kg_per_m3"),
    ("/surface/friction", "surface.friction"),
    ("/surface/tangential_stiffness_kg_per_s2", "surface.tangential_stiffness_kg_per_s2"),
    ("/surface/damping_time_s", "surface.damping_time_s"),
    ("/spheres/0/mass_kg", "spheres[0].mass_kg"),
];

/// The range and the unit of the field `name`.
fn range(name: &str) -> &'static str {
    match name.rsplit('.').next() {
        Some("radius_m") => "above 0, in m",
        Some("young_modulus_pa") => "above 0, in Pa",
        Some("poisson_ratio") => "above -1, at most 0.5, without unit",
        Some("density_kg_per_m3") => "above 0, in kg/m³",
        Some("friction") => "0 or above, without unit",
        Some("tangential_stiffness_kg_per_s2") => "0 or above, in kg/s²",
        Some("damping_time_s") => "0 or above, in s",
        Some("mass_kg") => "above 0, in kg",
        Some("moment_of_inertia_kg_m2") => "above 0, in kg m²",
        _ => panic!("{name}"),
    }
}

/// The steel spheres, the first with mass and moment of inertia of its own.
fn spheres() -> Value {
    let file = example_value("steel_spheres.json");
    let file = with(&file, "/spheres/0/material/density_kg_per_m3", None);
    let file = with(&file, "/spheres/0/mass_kg", Some(json!(0.3)));
    with(&file, "/spheres/0/moment_of_inertia_kg_m2", Some(json!(4e-5)))
}

#[test]
fn the_examples_are_accepted() {
    let schema = schema();
    for name in [
        "steel_spheres.json",
        "glass_on_wall.json",
        "steel_pair.json",
        "hooke_spheres.json",
        "adhesive_spheres.json",
    ] {
        let errors: Vec<_> =
            schema.iter_errors(&example_value(name)).map(|e| e.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
    assert!(schema.is_valid(&spheres()));
    run(spheres().to_string()).expect("an impact");
}

#[test]
fn numbers_out_of_range_missing_or_of_another_type() {
    let (schema, file) = (schema(), spheres());
    let inertia = ("/spheres/0/moment_of_inertia_kg_m2", "spheres[0].moment_of_inertia_kg_m2");
    for (path, name) in NUMBERS.into_iter().chain([inertia]) {
        for bad in
            [json!(-3), json!(-1e300), json!("1"), json!([1]), json!({}), json!(true), json!(null)]
        {
            let bad_file = with(&file, path, Some(bad.clone()));
            // An optional field may be null, which is nothing.
            if bad.is_null() && name.ends_with("kg_m2") {
                continue;
            }
            let range = if bad.is_null() && name.contains("kg") && !name.contains("stiffness") {
                "exactly one of them"
            } else {
                range(name)
            };
            refused(bad_file.to_string(), &[name, "expected ", range]);
            assert!(!schema.is_valid(&bad_file), "{name} = {bad}");
        }
        if name != inertia.1 {
            let missing = with(&file, path, None);
            refused(missing.to_string(), &[name, "missing", "expected "]);
            assert!(!schema.is_valid(&missing), "{name}");
        }
    }
    for (path, name) in [
        ("/spheres/0/radius_m", "spheres[0].radius_m = 0.0 "),
        ("/spheres/0/moment_of_inertia_kg_m2", "spheres[0].moment_of_inertia_kg_m2 = 0.0 "),
    ] {
        let zero = with(&file, path, Some(json!(0)));
        refused(zero.to_string(), &[name, "out of range", POSITIVE]);
        assert!(!schema.is_valid(&zero));
    }
    for bad in [0.500001, 1.0, -1.0] {
        let bad = with(&file, "/spheres/0/material/poisson_ratio", Some(json!(bad)));
        refused(bad.to_string(), &["spheres[0].material.poisson_ratio", "above -1, at most 0.5"]);
        assert!(!schema.is_valid(&bad));
    }
}

#[test]
fn vectors_that_are_not_three_numbers() {
    let schema = schema();
    let pair = example_value("steel_spheres.json");
    let wall = example_value("glass_on_wall.json");
    let motion = "/spheres/0/motion";
    for (file, path, name, unit) in [
        (&pair, format!("{motion}/position_m"), "spheres[0].motion.position_m", "in m"),
        (
            &pair,
            format!("{motion}/velocity_m_per_s"),
            "spheres[0].motion.velocity_m_per_s",
            "in m/s",
        ),
        (&pair, format!("{motion}/spin_rad_per_s"), "spheres[0].motion.spin_rad_per_s", "in rad/s"),
        (&wall, "/wall/motion/point_m".to_owned(), "wall.motion.point_m", "in m"),
        (&wall, "/wall/motion/normal".to_owned(), "wall.motion.normal", "without unit"),
        (
            &wall,
            "/wall/motion/velocity_m_per_s".to_owned(),
            "wall.motion.velocity_m_per_s",
            "in m/s",
        ),
    ] {
        for bad in [
            None,
            Some(json!(null)),
            Some(json!(1)),
            Some(json!("0 0 1")),
            Some(json!([])),
            Some(json!([0, 1])),
            Some(json!([0, 0, 1, 0])),
            Some(json!([0, 0, "1"])),
            Some(json!([0, null, 1])),
            Some(json!({"x": 0, "y": 0, "z": 1})),
        ] {
            let bad = with(file, &path, bad);
            refused(bad.to_string(), &[name, "expected three finite numbers", unit]);
            assert!(!schema.is_valid(&bad), "{name}");
        }
    }
    let no_normal = with(&wall, "/wall/motion/normal", Some(json!([0, 0, 0])));
    refused(no_normal.to_string(), &["normal", "not all 0"]);
    assert!(!schema.is_valid(&no_normal));
}

#[test]
fn unknown_missing_and_contradicting_parts() {
    let schema = schema();
    let pair = example_value("steel_spheres.json");
    let wall = example_value("glass_on_wall.json");
    let sphere = pair["spheres"][0].clone();
    for (file, path, value, parts) in [
        (&pair, "/speres", Some(json!([])), &["speres", "unknown field", "`spheres`"][..]),
        (
            &pair,
            "/spheres/0/radius",
            Some(json!(1)),
            &["spheres[0].radius", "unknown", "`radius_m`"],
        ),
        (
            &pair,
            "/spheres/1/motion/spin",
            Some(json!([0, 0, 0])),
            &["spheres[1].motion.spin", "unknown"],
        ),
        (&pair, "/surface/mu", Some(json!(0.4)), &["surface.mu", "unknown", "`friction`"]),
        (&wall, "/wall/normal", Some(json!([0, 0, 1])), &["wall.normal", "unknown"]),
        (&wall, "/wall/motion/position_m", Some(json!([0, 0, 1])), &["wall.motion.position_m"]),
        (&pair, "/comment", Some(json!(3)), &["comment", "string"]),
        (&pair, "/surface", None, &["surface is missing", "expected an object"]),
        (&pair, "/surface", Some(json!([0.4, 1e12, 0])), &["surface", "expected an object"]),
        (&pair, "/spheres/0/material", None, &["spheres[0].material is missing"]),
        (&pair, "/spheres/0/material", Some(json!("steel")), &["spheres[0].material", "an object"]),
        (
            &pair,
            "/spheres",
            None,
            &["spheres has 0 entries", "two spheres, or one sphere and a wall"],
        ),
        (&pair, "/spheres", Some(json!({})), &["spheres", "expected a sequence"]),
        (&pair, "/spheres/1", None, &["spheres has 1 entries", "no wall"]),
        (&pair, "/spheres/2", Some(sphere.clone()), &["spheres has 3 entries"]),
        (&wall, "/spheres/1", Some(sphere), &["spheres has 2 entries", "a wall"]),
        (
            &wall,
            "/wall/material",
            None,
            &["wall.material and wall.rigid", "missing", "exactly one"],
        ),
        (&wall, "/wall/rigid", Some(json!(true)), &["wall.material and wall.rigid", "both given"]),
        (&wall, "/wall/rigid", Some(json!(1)), &["wall.rigid", "boolean"]),
        (&wall, "/wall/material/density_kg_per_m3", Some(json!(7850)), &["density", "infinite"]),
        (&pair, "/spheres/0/mass_kg", Some(json!(0.3)), &["mass_kg", "density", "both given"]),
        (
            &pair,
            "/spheres/0/moment_of_inertia_kg_m2",
            Some(json!(1)),
            &["moment_of", "mass_kg only"],
        ),
    ] {
        let bad = with(file, path, value);
        refused(bad.to_string(), parts);
        assert!(!schema.is_valid(&bad), "{path}");
    }
}

/// The schema cannot tell these from others.
#[test]
fn bodies_that_do_not_collide() {
    let schema = schema();
    let pair = example_value("steel_spheres.json");
    let wall = example_value("glass_on_wall.json");
    let position = "/spheres/0/motion/position_m";
    let velocity = "/spheres/0/motion/velocity_m_per_s";
    for (file, path, value, parts) in [
        (
            &pair,
            position,
            json!([0, 0, 0.041]),
            &["distance of the centres = 0.041 m", "apart", "0.04 m"][..],
        ),
        (
            &pair,
            position,
            json!([0, 0, 0.0399]),
            &["distance of the centres = 0.0399 m", "overlap"],
        ),
        (&pair, position, json!([0, 0, 0]), &["distance of the centres = 0 m", "overlap"]),
        (&wall, position, json!([0, 0, 0.0016]), &["height of the centre above the wall", "apart"]),
        (
            &wall,
            position,
            json!([0, 0, -0.0015]),
            &["height of the centre above the wall", "overlap"],
        ),
        (&pair, velocity, json!([4, 0, 20]), &["velocity of approach = -20 m/s", "above 0"]),
        (&pair, velocity, json!([4, 0, 0]), &["velocity of approach = ", "above 0"]),
        (&wall, velocity, json!([4, 0, 0.1]), &["velocity of approach = ", "above 0"]),
    ] {
        let bad = with(file, path, Some(value));
        refused(bad.to_string(), parts);
        assert!(schema.is_valid(&bad), "{path}");
    }
    let still = with(&pair, "/spheres/0/motion", None);
    refused(still.to_string(), &["spheres[0].motion is missing"]);
    let still = with(&wall, "/wall/motion", None);
    refused(still.to_string(), &["wall.motion is missing"]);
}
