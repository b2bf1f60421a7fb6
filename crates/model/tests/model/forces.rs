//! Contact laws in SI units, against the parameters with which LAMMPS ran.

use serde_json::Value;
use stickslip_model::spheres::{
    Body, BodyPair, Constants, Elasticity, Forces, Material, Sphere, Surface,
};
use stickslip_model::{
    Collider, Contact, ContactEnd, Damping, Law, Normal, Tangential, presets, restitution,
};

use crate::common::file;
use crate::lammps::contact;

/// The forces that a case of LAMMPS asks for. Prefactors without `material` multiply powers of √R
/// or the effective mass, as its manual says of each damping.
fn forces(case: &Value, law: Law) -> Forces {
    let (si, scaled) = (&case["si"], &case["scaled"]);
    let number = |name: &str| si[name].as_f64().unwrap();
    let (mass, root) = (number("meff"), number("Reff").sqrt());
    let linear = law.normal == Normal::Linear;
    let of_material = si["normal"] == "hertz/material";
    let own_stiffness = si["kt"].as_f64().or_else(|| si["kt"].as_str()?.parse().ok());
    let mindlin = law.tangential == Tangential::Mindlin;
    let gamma = si["damp"].as_f64().or_else(|| si["gamma_n"].as_f64()).unwrap() * mass;
    let tsuji = si["damping"] == "tsuji";
    let power = if law.damping == Damping::Linear { 1.0 } else { root };
    let constants = Constants {
        friction: number("mu"),
        normal_stiffness_kg_per_s2: linear.then(|| number("kn")),
        hertz_stiffness_kg_per_s2_m0_5: (!linear && !of_material).then(|| number("kn") * root),
        tangential_stiffness_kg_per_s2: own_stiffness.filter(|_| !mindlin),
        mindlin_stiffness_kg_per_s2_m0_5: own_stiffness.filter(|_| mindlin).map(|k| k * root),
        damping_coefficient: (!tsuji).then_some(gamma * power),
        damping_ratio: tsuji.then(|| scaled["cn"].as_f64().unwrap()),
        tangential_damping_ratio: scaled["xt"].as_f64(),
        ..Constants::default()
    };
    Forces::new(law, &constants).unwrap()
}

#[test]
fn si_parameters_of_lammps_are_its_scaled_ones() {
    let reference = file("lammps_laws");
    let mut cases = 0;
    for case in reference["cases"].as_array().unwrap() {
        let expected = contact(case);
        let si = |name: &str| case["si"][name].as_f64();
        let (radius_m, mass_kg) = (si("R").unwrap(), si("m").unwrap());
        let sphere = Sphere {
            radius_m,
            mass_kg,
            moment_of_inertia_kg_m2: Sphere::homogeneous_moment(radius_m, mass_kg),
            elasticity: Elasticity {
                young_modulus_pa: si("E").unwrap_or(1e9),
                poisson_ratio: si("nu").unwrap_or(0.0),
            },
        };
        let pair =
            BodyPair::new(&sphere, &Body::Sphere(sphere), forces(case, expected.law())).unwrap();
        let impact = pair.impact(si("u0").unwrap(), si("g0").unwrap()).unwrap();
        let parameters = |c: &Contact| [c.kappa(), c.psi(), c.damping(), c.tangential_damping()];
        let found = impact.contact;
        assert_eq!(found.law(), expected.law());
        for (one, other) in parameters(&found).into_iter().zip(parameters(&expected)) {
            assert!((one - other).abs() <= 1e-11 * other, "{case}: {one} {other}");
        }
        cases += 1;
    }
    assert_eq!(cases, 264);
}

const STEEL: Material =
    Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };

#[test]
fn the_paper_s_law_has_a_surface_or_constants() {
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e8, damping_time_s: 1e-6 };
    let constants = Constants {
        friction: 0.4,
        tangential_stiffness_kg_per_s2: Some(1e8),
        damping_time_s: Some(1e-6),
        ..Constants::default()
    };
    let sphere = Sphere::homogeneous(0.02, &STEEL);
    let pair = |forces: Forces| BodyPair::new(&sphere, &Body::Sphere(sphere), forces).unwrap();
    let of_constants = Forces::new(Law::PAPER, &constants).unwrap();
    assert_eq!(pair(Forces::from(&surface)), pair(of_constants));
    // γ = A ρ, and ρ may be given.
    let rho = pair(of_constants).elastic_constant;
    let own = Constants {
        hertz_stiffness_kg_per_s2_m0_5: Some(rho),
        damping_coefficient: Some(1e-6 * rho),
        damping_time_s: None,
        ..constants
    };
    let own = pair(Forces::new(Law::PAPER, &own).unwrap()).impact(1.0, 1.0).unwrap();
    let expected = pair(of_constants).impact(1.0, 1.0).unwrap();
    assert!((own.contact.damping() / expected.contact.damping() - 1.0).abs() < 1e-15);
    assert_eq!(own.contact.kappa(), expected.contact.kappa());
}

#[test]
fn constants_that_do_not_fit_are_refused() {
    let refused =
        |law: Law, constants: Constants| Forces::new(law, &constants).unwrap_err().to_string();
    let hooke = Law { normal: Normal::Linear, damping: Damping::Linear, ..Law::PAPER };
    let complete = Constants {
        friction: 0.5,
        normal_stiffness_kg_per_s2: Some(1e5),
        tangential_stiffness_kg_per_s2: Some(3e4),
        damping_ratio: Some(0.2),
        ..Constants::default()
    };
    assert!(Forces::new(hooke, &complete).is_ok());
    for (constants, expected) in [
        (Constants { friction: -0.1, ..complete }, "friction = -0.1 is out of range"),
        (
            Constants { normal_stiffness_kg_per_s2: None, ..complete },
            "normal_stiffness_kg_per_s2 is missing; expected in this law: a finite number above 0",
        ),
        (
            Constants { hertz_stiffness_kg_per_s2_m0_5: Some(1e9), ..complete },
            "hertz_stiffness_kg_per_s2_m0_5 = 1000000000 has no meaning in this law",
        ),
        (
            Constants { mindlin_stiffness_kg_per_s2_m0_5: Some(1e9), ..complete },
            "mindlin_stiffness_kg_per_s2_m0_5 = 1000000000 has no meaning",
        ),
        (Constants { damping_ratio: Some(-0.1), ..complete }, "damping_ratio = -0.1 is out of"),
        (
            Constants { damping_ratio: None, ..complete },
            "damping_coefficient is missing; expected in this law: it, damping_time_s,",
        ),
        (
            Constants { damping_time_s: Some(1e-6), ..complete },
            "damping_time_s and damping_ratio are both given",
        ),
        (
            Constants { damping_coefficient: Some(1.0), ..complete },
            "damping_coefficient and damping_ratio are both given",
        ),
    ] {
        let message = refused(hooke, constants);
        assert!(message.starts_with(expected), "{message}");
    }
    let both = Constants { e_n: Some(0.9), ..complete };
    assert!(refused(hooke, both).starts_with("damping_ratio and e_n are both given"));
    let undamped = Constants { damping_ratio: None, ..complete };
    let message = refused(hooke, Constants { e_n: Some(1.1), ..undamped });
    assert!(
        message.starts_with("e_n = 1.1 is out of range; expected a number above 0"),
        "{message}"
    );
    let at = Constants { e_n: Some(0.9), e_n_at_m_per_s: Some(0.1), ..undamped };
    assert!(refused(hooke, at).starts_with("e_n_at_m_per_s = 0.1 has no meaning"));
    let velocity = Law { damping: Damping::Viscoelastic, ..hooke };
    let message = refused(velocity, Constants { e_n: Some(0.9), ..undamped });
    assert!(message.starts_with("e_n_at_m_per_s is missing"), "{message}");
    // A damping without unit is that of Tsuji's law.
    let message = refused(Law { normal: Normal::Hertz, ..hooke }, complete);
    assert!(message.starts_with("normal_stiffness_kg_per_s2 = 100000 has no"), "{message}");
    let undamped = Law { damping: Damping::None, ..hooke };
    let message = refused(undamped, complete);
    assert!(message.starts_with("damping_ratio = 0.2 has no meaning"), "{message}");
    assert!(Forces::new(undamped, &Constants { damping_ratio: None, ..complete }).is_ok());
}

/// The damping that follows from ε_n is that of an impact with this ε_n, and the damping ratio is
/// what particle codes call so.
#[test]
fn restitution_is_an_input() {
    let elasticity = Elasticity { young_modulus_pa: 1e7, poisson_ratio: 0.3 };
    let (radius_m, mass_kg) = (1e-3, 1e-5);
    let moment_of_inertia_kg_m2 = Sphere::homogeneous_moment(radius_m, mass_kg);
    let sphere = Sphere { radius_m, mass_kg, moment_of_inertia_kg_m2, elasticity };
    let eps_n = |law: Law, constants: Constants| {
        let forces = Forces::new(law, &constants).unwrap();
        let pair = BodyPair::new(&sphere, &Body::Sphere(sphere), forces).unwrap();
        restitution::eps_n(law, pair.impact(0.3, 0.1).unwrap().contact.damping()).unwrap()
    };
    for preset in presets::ALL {
        for limited in [false, true] {
            let law = Law { limit_damping: limited, ..preset.law };
            let linear = law.normal == Normal::Linear;
            let constant = law.tangential == Tangential::Constant && law.remembers();
            let constants = Constants {
                friction: 0.5,
                normal_stiffness_kg_per_s2: linear.then_some(1e4),
                tangential_stiffness_kg_per_s2: constant.then_some(5e3),
                e_n_at_m_per_s: restitution::depends_on_velocity(law).then_some(0.3),
                ..Constants::default()
            };
            for e_n in [0.2, 0.8, 0.99] {
                if law.damping == Damping::None {
                    assert!(Forces::new(law, &Constants { e_n: Some(e_n), ..constants }).is_err());
                    continue;
                }
                let found = eps_n(law, Constants { e_n: Some(e_n), ..constants });
                assert!((found - e_n).abs() < 2e-12, "{} {e_n} {found}", preset.name);
            }
            if let (Some(_), false) = (restitution::critical_damping(law), limited) {
                let found =
                    eps_n(law, Constants { critical_damping_ratio: Some(0.1), ..constants });
                let expected = if law.limit_damping { found } else { 0.729_247_614_287_671 };
                assert!((found - expected).abs() < 1e-12, "{} {found}", preset.name);
            }
        }
    }
    // The field whose name is older, and whose unit is another.
    let law = presets::find("gran/hooke/history").unwrap().law;
    let older = Constants {
        friction: 0.5,
        normal_stiffness_kg_per_s2: Some(1e4),
        tangential_stiffness_kg_per_s2: Some(5e3),
        damping_ratio: Some(0.1),
        ..Constants::default()
    };
    assert!((eps_n(law, older) - 0.854_467_893_007).abs() < 1e-11);
}

/// Closed forms against the integrator, which knows nothing of them.
#[test]
fn restitution_in_closed_form_is_that_of_a_run() {
    for name in ["gran/hooke/history", "granular/hertz/tsuji/mindlin"] {
        let law = presets::find(name).unwrap().law;
        for law in [law, Law { limit_damping: true, ..law }, Law { end: ContactEnd::Force, ..law }]
        {
            for damping in [1e-3, 0.05, 0.4, 1.3, 1.413, 1.415, 1.9, 2.0, 2.1, 7.0] {
                if damping >= law.endless_from() {
                    continue;
                }
                let contact = Contact::new(1.1, 0.3, damping)
                    .and_then(|contact| contact.with_law(law, 0.0))
                    .unwrap();
                let run = Collider::default().collide(contact).unwrap().eps_n;
                let found = restitution::eps_n(law, damping).unwrap();
                assert!((found - run).abs() < 4e-12, "{name} {damping} {found} {run}");
            }
        }
    }
    let undamped = presets::find("yade/FrictPhys_CundallStrack").unwrap().law;
    // An ε_n that the search meets by chance.
    for name in ["gran/hertz/history", "granular/hooke/linear_history", "paper"] {
        let law = presets::find(name).unwrap().law;
        for a in [0.5, 1.0, 2.0] {
            let back = restitution::damping(law, restitution::eps_n(law, a).unwrap()).unwrap();
            assert!((back - a).abs() < 1e-9, "{name} {a} {back}");
        }
    }
    assert!(restitution::damping(undamped, 0.9).is_err());
    assert_eq!(restitution::damping(undamped, 1.0), Ok(0.0));
    assert!(restitution::damping(Law::PAPER, 0.0).is_err());
    let tsuji = presets::find("granular/hertz/tsuji/mindlin").unwrap().law;
    assert!((restitution::damping(tsuji, 1e-9).unwrap() - 2.2113).abs() < 1e-3);
}
