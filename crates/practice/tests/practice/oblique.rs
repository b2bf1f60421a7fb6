//! The two data sets of tests/data/oblique_impacts.json.

use serde_json::Value;
use stickslip_model::spheres::{
    Body, BodyPair, Constants, Elasticity, Forces, Material, Sphere, Wall,
};
use stickslip_model::{Law, presets};
use stickslip_practice::fit::{Datum, FittedBodies, Measured, Values};

/// The data of one experiment in the file.
fn experiment(name: &str) -> Value {
    let text = include_str!("../../../../tests/data/oblique_impacts.json");
    let file: Value = serde_json::from_str(text).unwrap();
    file[name].clone()
}

fn column(values: &Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn data(experiment: &Value, speed: f64, quantity: Measured, name: &str) -> Vec<Datum> {
    let angles = column(&experiment["angle_from_normal_deg"]);
    let values = column(&experiment[name]);
    let datum = |(angle, value): (&f64, &f64)| {
        Datum::at_angle(angle.to_radians(), speed, quantity, *value, None)
    };
    angles.iter().zip(&values).map(datum).collect()
}

/// The aluminium-oxide sphere on glass under a law, and e_t of its centre.
pub fn aluminium_oxide(law: Law) -> (FittedBodies, Vec<Datum>) {
    let found = experiment("kharaz_2001");
    let number = |value: &Value| value.as_f64().unwrap();
    let elasticity = |body: &Value| Elasticity {
        young_modulus_pa: number(&body["youngs_modulus_Pa"]),
        poisson_ratio: number(&body["poissons_ratio"]),
    };
    let Elasticity { young_modulus_pa, poisson_ratio } = elasticity(&found["sphere"]);
    let density_kg_per_m3 = number(&found["density_kg_m3"]);
    let material = Material { young_modulus_pa, poisson_ratio, density_kg_per_m3 };
    let sphere = Sphere::homogeneous(0.5 * number(&found["diameter_m"]), &material);
    let wall = Body::Wall(Wall { elasticity: Some(elasticity(&found["plate"])) });
    let forces = Forces::new(law, &constants(law)).unwrap();
    let bodies = FittedBodies::of_sphere(&sphere, BodyPair::new(&sphere, &wall, forces).unwrap());
    let speed = number(&found["speed_m_s"]);
    (bodies, data(&found, speed, Measured::CentreRestitution, "e_t_of_the_centre"))
}

/// The spins of the aluminium-oxide sphere.
pub fn spins() -> Vec<Datum> {
    let found = experiment("kharaz_2001");
    let speed = found["speed_m_s"].as_f64().unwrap();
    data(&found["spin"], speed, Measured::Spin, "spin_rad_s")
}

/// Spheres without size under a law, and e_t of their centre.
pub fn benchmark(law: Law) -> (FittedBodies, Vec<Datum>) {
    let found = experiment("chung_ooi_test_4");
    let values = Values { kappa: 1.0, mu: 0.1, tangential_damping: 0.0, damping: 0.0 };
    let bodies = FittedBodies::scaled(law, 2.0 / 7.0, &values).unwrap();
    (bodies, data(&found, 1.0, Measured::CentreRestitution, "e_t_of_the_centre"))
}

/// Constants that a law needs, of which those that are not fitted have no effect without damping.
fn constants(law: Law) -> Constants {
    use stickslip_model::{Damping, Normal, Tangential};
    let damped = law.damping != Damping::None;
    Constants {
        friction: 0.1,
        normal_stiffness_kg_per_s2: (law.normal == Normal::Linear).then_some(1e7),
        tangential_stiffness_kg_per_s2: (law.tangential == Tangential::Constant).then_some(1e6),
        damping_coefficient: damped.then_some(0.0),
        ..Constants::default()
    }
}

/// The law with a name.
pub fn law(name: &str) -> Law {
    presets::find(name).unwrap().law
}
