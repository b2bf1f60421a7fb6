//! Files of two bodies.

use std::fs;

use serde_json::{Value, json};
use stickslip_files::input::bodies::read_pair;
use stickslip_model::Law;
use stickslip_model::spheres::{BodyPair, Material, Surface};

fn sphere(height_m: f64, velocity_m_per_s: [f64; 3]) -> Value {
    json!({
        "radius_m": 0.02,
        "material": {"young_modulus_pa": 210e9, "poisson_ratio": 0.3, "density_kg_per_m3": 7850},
        "motion": {
            "position_m": [0, 0, height_m],
            "velocity_m_per_s": velocity_m_per_s,
            "spin_rad_per_s": [0, 0, 0],
        },
    })
}

#[test]
fn two_bodies_are_the_same_with_and_without_motions() {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
    let expected = BodyPair::equal_spheres(0.02, &steel, &surface).unwrap();
    let mut spheres = [sphere(0.04, [4.0, 0.0, -20.0]), sphere(0.0, [0.0; 3])];
    for with_motion in [true, false] {
        if !with_motion {
            for sphere in &mut spheres {
                sphere.as_object_mut().unwrap().remove("motion").unwrap();
            }
        }
        let surface = json!({
            "friction": 0.4, "tangential_stiffness_kg_per_s2": 1e12, "damping_time_s": 0,
        });
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(&file, json!({"spheres": spheres, "surface": surface}).to_string()).unwrap();
        assert_eq!(read_pair(file.path(), Law::PAPER).unwrap(), expected, "{with_motion}");
    }
}
