//! An impact in SI units.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use serde_json::Value;
use stickslip_model::spheres::{
    Elasticity, Encounter, Material, Motion, Sphere, Surface, Vector3, Wall, WallMotion,
};
use stickslip_model::{Collider, exact};

use crate::{Ran, Workspace, stickslip_in};

/// A file of the examples.
pub fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
}

/// The JSON value of a file of the examples.
pub fn example_value(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(example(name)).expect("an example")).expect("JSON")
}

fn run(line: &str) -> Ran {
    stickslip_in(&example(""), &format!("impact {line}"))
}

fn json(line: &str) -> Value {
    let ran = run(&format!("{line} --format json"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
    serde_json::from_str(&ran.stdout).expect("standard output is one JSON value and nothing else")
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn vector(value: &Value) -> Vector3<f64> {
    let numbers: Vec<f64> =
        value.as_array().expect("an array").iter().map(|v| v.as_f64().expect("a number")).collect();
    Vector3::from_column_slice(&numbers)
}

/// The steel spheres of the example, made with the library.
fn steel() -> Encounter {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
    let sphere = Sphere::homogeneous(0.02, &steel);
    let rest = Motion {
        position_m: Vector3::zeros(),
        velocity_m_per_s: Vector3::zeros(),
        spin_rad_per_s: Vector3::zeros(),
    };
    let falling = Motion {
        position_m: Vector3::new(0.0, 0.0, 0.04),
        velocity_m_per_s: Vector3::new(4.0, 0.0, -20.0),
        ..rest
    };
    Encounter::of_spheres((&sphere, &falling), (&sphere, &rest), &surface).unwrap()
}

#[test]
fn json_has_the_documented_keys_in_order() {
    let object = json("steel_spheres.json");
    assert_eq!(
        keys(&object),
        [
            "schema",
            "parameters",
            "method",
            "contact",
            "eps_n",
            "eps_t",
            "contact_time_s",
            "switch_count",
            "reversals",
            "itinerary",
            "spheres",
            "impulse_n_s",
            "switches",
            "energy_j",
            "observed",
            "comparison",
            "statistics"
        ]
    );
    assert_eq!(object["schema"], "stickslip.impact/1");
    assert_eq!(
        keys(&object["parameters"]),
        [
            "kappa",
            "psi",
            "damping",
            "alpha",
            "effective_mass_kg",
            "effective_radius_m",
            "elastic_constant_n_per_m1_5",
            "time_unit_s",
            "length_unit_m",
            "force_unit_n"
        ]
    );
    assert_eq!(
        keys(&object["contact"]),
        ["point_m", "normal", "tangent", "normal_m_per_s", "tangential_m_per_s"]
    );
    assert_eq!(keys(&object["spheres"][1]), ["velocity_m_per_s", "spin_rad_per_s"]);
    assert_eq!(
        keys(&object["switches"][0]),
        [
            "time_s",
            "time_left_s",
            "to",
            "side",
            "spring_m",
            "velocity_m_per_s",
            "normal_force_n",
            "tangential_force_n"
        ]
    );
    assert_eq!(
        keys(&object["energy_j"]),
        [
            "kinetic_before",
            "kinetic_after",
            "work_of_wall",
            "sliding",
            "damping",
            "tangential_damping",
            "spring_left",
            "compression_left",
            "unbalanced"
        ]
    );
    assert_eq!(
        keys(&object["observed"]),
        [
            "beta",
            "patch_psi_1",
            "patch_psi_2",
            "patch_impact_angle_rad",
            "patch_rebound_angle_rad",
            "centre_e_t",
            "centre_impact_angle_rad",
            "centre_rebound_angle_rad",
            "impulse_ratio"
        ]
    );
    assert_eq!(
        keys(&object["comparison"]),
        [
            "eps_n_series",
            "eps_n_pade",
            "eps_t_coulomb",
            "mindlin_stiffness_kg_per_s2",
            "mindlin_kappa",
            "undamped_compression_m",
            "undamped_normal_force_n"
        ]
    );
}

#[test]
fn json_reads_back_as_the_library_computes() {
    let encounter = steel();
    for (method, collision) in [
        ("dop853", Collider::default().collide(encounter.contact()).unwrap()),
        ("exact", exact::collide(encounter.contact()).unwrap()),
    ] {
        let object = json(&format!("steel_spheres.json --method {method}"));
        let outcome = encounter.outcome(&collision);
        assert_eq!(object["method"]["name"], method);
        assert_eq!(object["parameters"]["kappa"], encounter.contact().kappa());
        assert_eq!(object["eps_t"], outcome.eps_t.unwrap());
        assert_eq!(object["itinerary"], collision.itinerary());
        for (shown, motion) in object["spheres"].as_array().unwrap().iter().zip(&outcome.motions) {
            assert_eq!(vector(&shown["velocity_m_per_s"]), motion.velocity_m_per_s);
            assert_eq!(vector(&shown["spin_rad_per_s"]), motion.spin_rad_per_s);
        }
        assert_eq!(vector(&object["impulse_n_s"]), outcome.impulse_n_s);
        let switches = object["switches"].as_array().unwrap();
        assert_eq!((switches.len(), outcome.switches.len()), (44, 44));
        for (shown, switch) in switches.iter().zip(&outcome.switches) {
            assert_eq!(shown["time_s"], switch.time_s);
            assert_eq!(shown["side"].as_f64(), Some(switch.side.sign()));
            assert_eq!(shown["normal_force_n"], switch.normal_force_n);
        }
        assert_eq!(object["energy_j"]["unbalanced"], outcome.energy.unbalanced_j());
        assert_eq!(object["observed"]["beta"], -outcome.eps_t.unwrap());
    }
}

#[test]
fn a_sphere_and_a_wall() {
    let object = json("glass_on_wall.json");
    let glass = Material { young_modulus_pa: 63e9, poisson_ratio: 0.24, density_kg_per_m3: 2500.0 };
    let motion = Motion {
        position_m: Vector3::new(0.0, 0.0, 0.0015),
        velocity_m_per_s: Vector3::new(0.8, 0.3, -1.2),
        spin_rad_per_s: Vector3::new(0.0, -400.0, 50.0),
    };
    let wall_motion = WallMotion {
        point_m: Vector3::zeros(),
        normal: Vector3::z(),
        velocity_m_per_s: Vector3::new(0.0, 0.0, 0.1),
    };
    let steel = Elasticity { young_modulus_pa: 210e9, poisson_ratio: 0.3 };
    let surface =
        Surface { friction: 0.3, tangential_stiffness_kg_per_s2: 5e6, damping_time_s: 5e-8 };
    let sphere = Sphere::homogeneous(0.0015, &glass);
    let wall = Wall { elasticity: Some(steel) };
    let encounter =
        Encounter::with_wall((&sphere, &motion), (&wall, &wall_motion), &surface).unwrap();
    let collision = exact::collide(encounter.contact()).unwrap();
    let [after, _] = encounter.outcome(&collision).motions;
    let spheres = object["spheres"].as_array().unwrap();
    assert_eq!(spheres.len(), 1);
    assert_eq!(vector(&spheres[0]["velocity_m_per_s"]), after.velocity_m_per_s);
    assert_eq!(vector(&spheres[0]["spin_rad_per_s"]), after.spin_rad_per_s);

    // A rigid wall gives another elastic constant.
    let mut file = example_value("glass_on_wall.json");
    let fields = file["wall"].as_object_mut().unwrap();
    fields.remove("material");
    fields.insert("rigid".to_owned(), Value::Bool(true));
    let workspace = Workspace::new();
    workspace.write("rigid.json", file.to_string());
    let rigid = workspace.run("impact rigid.json --format json");
    let rigid: Value = serde_json::from_str(&rigid.stdout).unwrap();
    let constant = |object: &Value| object["parameters"]["elastic_constant_n_per_m1_5"].as_f64();
    assert!(constant(&rigid) > constant(&object));
}

#[test]
fn a_sphere_with_its_own_mass_and_moment_of_inertia() {
    let mut file = example_value("steel_spheres.json");
    let sphere = file["spheres"][0].as_object_mut().unwrap();
    sphere["material"].as_object_mut().unwrap().remove("density_kg_per_m3");
    sphere.insert("mass_kg".to_owned(), 0.3.into());
    let workspace = Workspace::new();
    let alpha = |file: &Value| {
        workspace.write("own.json", file.to_string());
        let ran = workspace.run("impact own.json --format json");
        let object: Value = serde_json::from_str(&ran.stdout).expect("JSON");
        object["parameters"]["alpha"].as_f64().expect("a number")
    };
    // Without a moment of inertia the sphere is homogeneous.
    assert!((alpha(&file) - 2.0 / 7.0).abs() < 1e-15);
    file["spheres"][0]["moment_of_inertia_kg_m2"] = (0.3 * 0.02 * 0.02 * 2.0 / 3.0).into();
    assert!(alpha(&file) > 2.0 / 7.0 + 1e-3);
}

#[test]
fn a_central_impact() {
    let mut file = example_value("steel_spheres.json");
    file["spheres"][0]["motion"]["velocity_m_per_s"] = serde_json::json!([0, 0, -20]);
    let workspace = Workspace::new();
    workspace.write("central.json", file.to_string());
    let ran = workspace.run("impact central.json --format json");
    let object: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    for path in ["/eps_t", "/contact/tangent", "/observed/beta", "/comparison/eps_t_coulomb"] {
        assert_eq!(object.pointer(path), Some(&Value::Null), "{path}");
    }
    assert_eq!(object["parameters"]["psi"], 0.0);
    assert_eq!((&object["switch_count"], &object["itinerary"]), (&0.into(), &"o".into()));
    assert_eq!(vector(&object["spheres"][0]["spin_rad_per_s"]), Vector3::zeros());
    assert!((object["spheres"][1]["velocity_m_per_s"][2].as_f64().unwrap() + 20.0).abs() < 1e-10);
    let table = workspace.run("impact central.json").stdout;
    assert!(table.contains("No switch.") && table.contains("none: central impact"), "{table}");
}

#[test]
fn the_table_shows_motions_switches_and_energy() {
    let Ran { code, stdout, stderr, .. } = run("glass_on_wall.json --method dop853 --verbose");
    assert_eq!((code, stderr.as_str()), (0, ""));
    for start in [
        "Impact with κ = 3.5133",
        "spheres[0] after: velocity [m/s] ",
        "spheres[0] after: spin [rad/s] ",
        "tangential restitution ε_t ",
        "contact time [s] ",
        "work of the wall [J] ",
        "patch: angle of rebound [rad] ",
        "Mindlin's stiffness [kg/s²] ",
        "steps accepted ",
    ] {
        assert!(stdout.lines().any(|line| line.starts_with(start)), "{start}\n{stdout}");
    }
    assert!(!stdout.contains("spheres[1]"));
    for line in ["steel_spheres.json", "steel_spheres.json --method dop853"] {
        assert!(!run(line).stdout.contains("steps accepted"), "{line}");
    }
}

#[test]
fn bodies_from_standard_input() {
    let mut child = Command::new(cargo_bin!("stickslip"))
        .args(["impact", "-", "--format", "json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let text = fs::read(example("steel_spheres.json")).unwrap();
    child.stdin.take().unwrap().write_all(&text).unwrap();
    let output = child.wait_with_output().unwrap();
    let object: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(object, json("steel_spheres.json"));
}
