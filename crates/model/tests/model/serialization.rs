//! Names and order of the fields of serialised results.

use serde_json::{Value, json};
use stickslip_model::spheres::{
    Encounter, ImpactReport, Material, Motion, Sphere, Surface, Vector3, Wall, WallMotion,
};
use stickslip_model::{Collision, Contact, Engine, Tolerances};

/// The layout of a value: the names of an object in order, the layout of an array's first element,
/// and the kind of everything else.
fn layout(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(_) => "bool".to_owned(),
        Value::Number(_) => "number".to_owned(),
        Value::String(_) => "string".to_owned(),
        Value::Array(elements) => {
            format!("[{}]", elements.first().map_or(String::new(), layout))
        }
        Value::Object(fields) => {
            let fields = fields.iter().map(|(name, value)| match layout(value).as_str() {
                "number" => name.clone(),
                kind => format!("{name}: {kind}"),
            });
            format!("{{{}}}", fields.collect::<Vec<_>>().join(", "))
        }
    }
}

fn collision(contact: Contact) -> Collision {
    Engine::Dop853(Tolerances::DOP853).collide(contact).expect("a collision").0
}

#[test]
fn a_collision() {
    let collision = collision(Contact::new(18.0, 1.0, 0.05).expect("valid"));
    let value = serde_json::to_value(&collision).expect("JSON");
    assert_eq!(
        layout(&value),
        "{parameters: {kappa, psi, damping}, eps_n, eps_t, w_final, contact_time, switch_count, \
         reversals, itinerary: string, \
         switches: [{time, time_left, to: string, side, spring, velocity}], \
         energy: {tangential_initial, tangential_final, sliding, spring_left, normal_initial, \
         normal_final, damping, compression_left}}"
    );
    assert_eq!(value["parameters"], json!({ "kappa": 18.0, "psi": 1.0, "damping": 0.05 }));
    assert_eq!(value["itinerary"], "o+o-o+");
    assert_eq!((&value["switch_count"], &value["reversals"]), (&json!(5), &json!(2)));
    assert_eq!(value["eps_t"], collision.eps_t());
    assert_eq!(value["w_final"], collision.final_velocity);
    let switches = value["switches"].as_array().expect("an array");
    assert_eq!(switches.len(), 5);
    let to: Vec<_> = switches.iter().map(|switch| (&switch["to"], &switch["side"])).collect();
    assert_eq!(to[1..3], [(&json!("stick"), &json!(1)), (&json!("slip"), &json!(-1))]);
    assert_eq!(switches[4]["velocity"], collision.switches[4].velocity);
    assert_eq!(value["energy"]["damping"], collision.energy.damping);
}

#[test]
fn engines() {
    let object = |engine: Engine| serde_json::to_string(&engine).expect("JSON");
    let tolerances = Tolerances { rtol: 1e-9, atol: 1e-8 };
    assert_eq!(object(Engine::Dop853(tolerances)), r#"{"name":"dop853","rtol":1e-9,"atol":1e-8}"#);
    assert_eq!(object(Engine::Dopri5(tolerances)), r#"{"name":"dopri5","rtol":1e-9,"atol":1e-8}"#);
    assert_eq!(object(Engine::Exact), r#"{"name":"exact"}"#);
    assert_eq!(object(Engine::Auto), r#"{"name":"auto"}"#);
}

/// A glass bead on a rigid floor, with this velocity and damping time.
fn report(velocity_m_per_s: [f64; 3], damping_time_s: f64) -> ImpactReport {
    let glass = Material { young_modulus_pa: 63e9, poisson_ratio: 0.24, density_kg_per_m3: 2500.0 };
    let surface = Surface { friction: 0.3, tangential_stiffness_kg_per_s2: 5e6, damping_time_s };
    let motion = Motion {
        position_m: Vector3::new(0.0, 0.0, 0.0015),
        velocity_m_per_s: velocity_m_per_s.into(),
        spin_rad_per_s: Vector3::zeros(),
    };
    let floor = WallMotion {
        point_m: Vector3::zeros(),
        normal: Vector3::z(),
        velocity_m_per_s: Vector3::zeros(),
    };
    let bead = Sphere::homogeneous(0.0015, &glass);
    let wall = Wall { elasticity: None };
    let encounter = Encounter::with_wall((&bead, &motion), (&wall, &floor), &surface);
    let encounter = encounter.expect("bodies that touch and approach");
    ImpactReport::new(&encounter, collision(encounter.contact()))
}

const LAYOUT: &str = "{parameters: {kappa, psi, damping, alpha, effective_mass_kg, \
    effective_radius_m, elastic_constant_n_per_m1_5, time_unit_s, length_unit_m, force_unit_n}, \
    contact: {point_m: [number], normal: [number], tangent: [number], normal_m_per_s, \
    tangential_m_per_s}, eps_n, eps_t, contact_time_s, switch_count, reversals, \
    itinerary: string, spheres: [{velocity_m_per_s: [number], spin_rad_per_s: [number]}], \
    impulse_n_s: [number], switches: [{time_s, time_left_s, to: string, side, spring_m, \
    velocity_m_per_s, normal_force_n, tangential_force_n}], energy_j: {kinetic_before, \
    kinetic_after, work_of_wall, sliding, damping, tangential_damping, spring_left, \
    compression_left, unbalanced}, \
    observed: {beta, patch_psi_1, patch_psi_2, patch_impact_angle_rad, patch_rebound_angle_rad, \
    centre_e_t, centre_impact_angle_rad, centre_rebound_angle_rad, impulse_ratio}, \
    comparison: {eps_n_series, eps_n_pade, eps_t_coulomb, mindlin_stiffness_kg_per_s2, \
    mindlin_kappa, undamped_compression_m, undamped_normal_force_n}}";

#[test]
fn an_impact() {
    let report = report([0.8, 0.3, -1.2], 5e-8);
    assert_eq!(report.require_finite(), Ok(()));
    let value = serde_json::to_value(&report).expect("JSON");
    assert_eq!(layout(&value), LAYOUT);
    let (impact, outcome) = (&report.encounter.impact, &report.outcome);
    assert_eq!(value["parameters"]["psi"], impact.contact.psi());
    assert_eq!(value["parameters"]["elastic_constant_n_per_m1_5"], impact.pair.elastic_constant);
    assert_eq!(value["parameters"]["force_unit_n"], impact.force_unit_n());
    assert_eq!(value["contact"]["point_m"], json!([0.0, 0.0, 0.0]));
    assert_eq!(value["contact"]["normal"], json!([0.0, 0.0, 1.0]));
    assert_eq!(value["itinerary"], report.collision.itinerary());
    assert_eq!(value["switch_count"], outcome.switches.len());
    let velocity: [f64; 3] = outcome.motions[0].velocity_m_per_s.into();
    assert_eq!(
        value["spheres"],
        json!([{
            "velocity_m_per_s": velocity,
            "spin_rad_per_s": <[f64; 3]>::from(outcome.motions[0].spin_rad_per_s),
        }])
    );
    assert_eq!(value["energy_j"]["unbalanced"], outcome.energy.unbalanced_j());
    assert_eq!(value["comparison"]["mindlin_kappa"], impact.pair.mindlin_kappa());
    assert!(value["comparison"]["eps_t_coulomb"].is_number());
}

/// What needs a tangential direction is null, and there is neither ψ nor a switch.
#[test]
fn a_central_impact() {
    let value = serde_json::to_value(report([0.0, 0.0, -1.2], 5e-8)).expect("JSON");
    let central = LAYOUT
        .replace("tangent: [number]", "tangent: null")
        .replace("eps_n, eps_t,", "eps_n, eps_t: null,")
        .replace("beta,", "beta: null,")
        .replace("centre_e_t,", "centre_e_t: null,")
        .replace("eps_t_coulomb,", "eps_t_coulomb: null,");
    let (before, after) = central.split_once("switches: [").expect("switches");
    let (_, after) = after.split_once("], energy_j").expect("the end of the switches");
    assert_eq!(layout(&value), format!("{before}switches: [], energy_j{after}"));
    assert_eq!(value["parameters"]["psi"], 0.0);
    assert_eq!((&value["itinerary"], &value["reversals"]), (&json!("o"), &json!(0)));
}
