//! Hysteretic normal forces, and the limits of no spring and no friction.

use stickslip_model::spheres::{Body, Encounter, ImpactReport, Sphere};
use stickslip_model::spheres::{BodyPair, Constants, Forces, Material, Surface};
use stickslip_model::{
    Contact, ContactEnd, Damping, Engine, HistoryOf, Law, Normal, Tangential, Tolerances, presets,
    restitution,
};

use crate::common::file;
use crate::laws::{collide, laws};

fn hysteretic(normal: Normal) -> Law {
    let law = presets::find("walton-braun").unwrap().law;
    Law { normal, ..law }
}

fn contact(kappa: f64, psi: f64, damping: f64, law: Law) -> Contact {
    Contact::new(kappa, psi, damping).and_then(|it| it.with_law(law, 0.0)).unwrap()
}

/// Compares contacts with those of a file, which another program integrated in plain time.
fn compare(name: &str, count: usize, law: impl Fn(&serde_json::Value) -> Law) {
    let reference = file(name);
    let cases = reference["cases"].as_array().unwrap();
    for case in cases {
        let number = |name: &str| case[name].as_f64().unwrap();
        let law = Law { end: ContactEnd::Force, ..law(case) };
        let found = collide(contact(number("kappa"), number("psi"), number("damping"), law));
        let expected = [number("eps_t"), number("eps_n"), number("time")];
        let own = [found.eps_t(), found.eps_n, found.contact_time];
        let close = expected.iter().zip(own).all(|(expected, own)| (expected - own).abs() < 1e-7);
        assert!(close, "{own:?} {case}");
        assert!(found.energy.tangential_unbalanced().abs() < 1e-11, "{:?} {case}", found.energy);
        assert_eq!(found.itinerary(), case["itinerary"].as_str().unwrap(), "{case}");
    }
    assert_eq!(cases.len(), count);
}

#[test]
fn hysteretic_contacts_are_those_of_another_program() {
    compare("hysteretic_contacts", 100, |case| {
        hysteretic(if case["normal"] == "hertz" { Normal::Hertz } else { Normal::Linear })
    });
}

#[test]
fn contacts_that_yield_are_those_of_another_program() {
    compare("yielding_contacts", 160, |case| Law {
        tangential: if case["mindlin"] == true {
            Tangential::Mindlin
        } else {
            Tangential::Constant
        },
        history: if case["history"] == "force" {
            HistoryOf::Force
        } else {
            HistoryOf::Displacement
        },
        rescaled: case["rescaled"] == true,
        ..yielding()
    });
}

/// ε_n = √(k₁/k₂), (k₁/k₂)^(1/3) with x^(3/2), and 1/√(1 + S v √(m/k₁)) where k₂ = k₁(1 + S ξ).
#[test]
fn the_normal_restitution_is_in_closed_form() {
    for (normal, power) in [(Normal::Linear, 0.5), (Normal::Hertz, 1.0 / 3.0)] {
        let law = hysteretic(normal);
        for damping in [0.0, 1e-12, 0.01, 1.0, 30.0, 1e4] {
            let expected = (1.0_f64 + damping).powf(-power);
            let found = collide(contact(4.0, 0.7, damping, law)).eps_n;
            assert!((found - expected).abs() < 1e-12, "{normal:?} {damping} {found} {expected}");
            assert!((restitution::eps_n(law, damping).unwrap() - expected).abs() < 1e-15);
            let back = restitution::damping(law, expected).unwrap();
            assert!((back - damping).abs() < 1e-12 * (1.0 + damping), "{back} {damping}");
        }
        assert!(!restitution::depends_on_velocity(law));
    }
    let preset = presets::find("walton-braun/hardening").unwrap();
    let constants = Constants {
        friction: 0.3,
        normal_stiffness_kg_per_s2: Some(2e5),
        tangential_stiffness_kg_per_s2: Some(8e4),
        hardening_per_m: Some(3e4),
        ..Constants::default()
    };
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let sphere = Sphere::homogeneous(1e-3, &steel);
    let forces = Forces::new(preset.law, &constants).unwrap();
    let pair = BodyPair::new(&sphere, &Body::Sphere(sphere), forces).unwrap();
    for velocity in [0.01, 0.1, 1.0] {
        let found = collide(pair.impact(velocity, velocity).unwrap().contact).eps_n;
        let greatest = velocity * (pair.effective_mass_kg / 2e5).sqrt();
        let expected = 1.0 / (1.0 + 3e4 * greatest).sqrt();
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    // The same k₂ at one velocity.
    let e_n = Constants { hardening_per_m: None, e_n: Some(0.6), ..constants };
    let e_n = Constants { e_n_at_m_per_s: Some(0.1), ..e_n };
    let pair =
        BodyPair::new(&sphere, &Body::Sphere(sphere), Forces::new(preset.law, &e_n).unwrap());
    let found = collide(pair.unwrap().impact(0.1, 0.2).unwrap().contact).eps_n;
    assert!((found - 0.6).abs() < 1e-12);
}

/// ε_t = 1 − (1 + ε_n)/ψ in gross sliding, whatever the normal force; the energies add up; and the
/// contact lasts (1 + √(k₁/k₂)) π/2, and until the overlap is gone x₀/ε_n longer.
#[test]
fn hysteretic_contacts_slide_lose_and_last_as_they_must() {
    for a in [0.3, 8.0] {
        let law = hysteretic(Normal::Linear);
        let found = collide(contact(5.0, 4.0, a, law));
        assert_eq!(found.itinerary(), "+");
        assert!((found.eps_t() - 1.0 + (1.0 + found.eps_n) / 4.0).abs() < 1e-12);
        let e_n = (1.0_f64 + a).powf(-0.5);
        let loaded = std::f64::consts::FRAC_PI_2 * (1.0 + e_n);
        let left = a / (1.0 + a);
        assert!((found.contact_time - loaded - left / e_n).abs() < 1e-11);
        let ends = collide(contact(5.0, 4.0, a, Law { end: ContactEnd::Force, ..law }));
        assert!((ends.contact_time - loaded).abs() < 1e-11);
        for found in [found, ends, collide(contact(30.0, 0.6, a, law))] {
            let energy = found.energy;
            assert!(energy.normal_unbalanced().abs() < 1e-12, "{energy:?}");
            assert!(energy.tangential_unbalanced().abs() < 1e-12);
            assert!((energy.damping - 0.5 * left).abs() < 1e-12);
        }
    }
    // Without hysteresis nothing is left of it.
    let plain = Law { damping: Damping::None, ..hysteretic(Normal::Linear) };
    let [one, other] = [plain, hysteretic(Normal::Linear)].map(|law| contact(12.0, 0.5, 0.0, law));
    assert!((collide(one).eps_t() - collide(other).eps_t()).abs() < 1e-12);
}

/// The course of a contact that is left with an overlap.
#[test]
fn the_course_keeps_the_overlap_that_is_left() {
    let law = Law { end: ContactEnd::Force, ..hysteretic(Normal::Linear) };
    let history = Engine::Auto.history(contact(20.0, 0.5, 3.0, law)).unwrap();
    let crest = history.at(std::f64::consts::FRAC_PI_2).unwrap();
    assert!((crest.compression - 1.0).abs() < 1e-10 && (crest.normal_force - 1.0).abs() < 1e-10);
    let falls = history.at(1.8).unwrap();
    assert!((falls.normal_force - 4.0 * (falls.compression - 0.75)).abs() < 1e-10, "{falls:?}");
    let end = history.phases().last().unwrap().end();
    assert!((end.compression - 0.75).abs() < 1e-10, "{end:?}");
}

fn yielding() -> Law {
    presets::find("thornton").unwrap().law
}

/// Thornton, J. Appl. Mech. 64, 383 (1997), eq. 45, and 1 up to the yield velocity.
#[test]
fn the_restitution_of_bodies_that_yield_is_thorntons() {
    let law = yielding();
    for damping in [0.0, 0.5, 1.0, 1.0 + 1e-9, 1.1, 4.0, 100.0, 1e4] {
        let ratio = 1.0 / f64::max(damping, 1.0);
        let part = ratio / (ratio + 2.0 * (1.2 - 0.2 * ratio * ratio).sqrt());
        let square = 1.2 * 3.0_f64.sqrt() * (1.0 - ratio * ratio / 6.0) * part.sqrt();
        let found = collide(contact(4.0, 0.7, damping, law));
        assert!((found.eps_n - square.sqrt()).abs() < 1e-12, "{damping} {}", found.eps_n);
        assert!((restitution::eps_n(law, damping).unwrap() - square.sqrt()).abs() < 1e-14);
        assert!(found.energy.normal_unbalanced().abs() < 1e-12, "{:?}", found.energy);
        assert!(found.energy.tangential_unbalanced().abs() < 1e-12);
        if damping > 1.0 + 1e-6 {
            let back = restitution::damping(law, square.sqrt()).unwrap();
            assert!((back / damping - 1.0).abs() < 1e-11, "{back} {damping}");
        }
        let slides = collide(contact(4.0, 4.0, damping, law));
        assert!((slides.eps_t() - 1.0 + (1.0 + slides.eps_n) / 4.0).abs() < 1e-12);
    }
    assert!(restitution::depends_on_velocity(law));
    assert_eq!(format!("{:.2}", restitution::eps_n(law, 4.0).unwrap()), "0.81");
    // Without yield it is Hertz' law.
    let elastic = Law { damping: Damping::None, ..law };
    let of = |damping: f64, law: Law| collide(contact(12.0, 0.5, damping, law)).eps_t();
    assert!((of(1.0, law) - of(0.0, elastic)).abs() < 1e-11);
    assert!((of(1.0 + 1e-7, law) - of(0.0, elastic)).abs() < 1e-6);
}

/// The yield velocity in SI units, and from the pressure in the contact.
#[test]
fn bodies_yield_from_a_velocity_or_a_pressure_on() {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let sphere = Sphere::homogeneous(1e-3, &steel);
    let usual = Constants {
        friction: 0.3,
        tangential_stiffness_kg_per_s2: Some(1e7),
        ..Constants::default()
    };
    let pair = |constants: &Constants| {
        let forces = Forces::new(yielding(), constants)?;
        Ok::<_, stickslip_model::CollisionError>(
            BodyPair::new(&sphere, &Body::Sphere(sphere), forces).unwrap(),
        )
    };
    let pressure = Constants { yield_pressure_pa: Some(1e9), ..usual };
    let found = pair(&pressure).unwrap();
    // Thornton's eq. 43: v_y = (π/2E*)² √(8πR³/(15m)) p_y^{5/2}, with 1/m' = 2/m.
    let (modulus, radius) = (0.5 * 210e9 / (1.0 - 0.09), 5e-4_f64);
    let factor = (std::f64::consts::PI / (2.0 * modulus)).powi(2);
    let root = 8.0 * std::f64::consts::PI * radius.powi(3) / (15.0 * found.effective_mass_kg);
    let velocity = factor * root.sqrt() * 1e9_f64.powf(2.5);
    let (name, constant) = found.damping_constant();
    assert_eq!(name, "yield_velocity_m_per_s");
    assert!((constant / velocity - 1.0).abs() < 1e-12, "{constant} {velocity}");
    let same = Constants { yield_velocity_m_per_s: Some(velocity), ..usual };
    for speed in [0.5 * velocity, 20.0 * velocity] {
        let of =
            |constants| collide(pair(constants).unwrap().impact(speed, speed).unwrap().contact);
        assert!((of(&pressure).eps_t() - of(&same).eps_t()).abs() < 1e-10);
        assert_eq!(of(&same).eps_n < 1.0 - 1e-9, speed > velocity);
    }
    let e_n = Constants { e_n: Some(0.6), e_n_at_m_per_s: Some(2.0), ..usual };
    let found = collide(pair(&e_n).unwrap().impact(2.0, 1.0).unwrap().contact);
    assert!((found.eps_n - 0.6).abs() < 1e-12);
    for (constants, expected) in [
        (usual, "yield_velocity_m_per_s is missing"),
        (Constants { yield_pressure_pa: Some(-1.0), ..usual }, "expected a finite number above 0"),
        (Constants { yield_pressure_pa: Some(1e9), ..same }, "are both given"),
        (Constants { e_n: Some(1.0), ..e_n }, "expected below 1"),
        (Constants { hardening_per_m: Some(1.0), ..usual }, "has no meaning in this law"),
    ] {
        let error = pair(&constants).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

/// Both pairs find the same switches, whatever yields when.
#[test]
fn both_pairs_agree_on_contacts_that_yield() {
    let mut random = fastrand::Rng::with_seed(383);
    let mut log = |low: f64, high: f64| low * (high / low).powf(random.f64());
    for _ in 0..200 {
        let [kappa, psi, damping] = [log(0.1, 1e5), log(1e-2, 1e2), log(1.0, 1e3)];
        let law = Law { history: HistoryOf::Force, ..yielding() };
        let contact = contact(kappa, psi, damping, law);
        let one = collide(contact);
        let (other, _) = Engine::Dopri5(Tolerances::DOPRI5).collide(contact).unwrap();
        assert_eq!(one.itinerary(), other.itinerary(), "{contact:?}");
        let apart = psi * (one.eps_t() - other.eps_t()).abs();
        assert!(apart < 1e-9, "{contact:?} {apart:e}");
    }
}

/// Every combination with a hysteretic force runs or is refused with the reason.
#[test]
fn combinations_with_hysteresis_run_or_are_refused() {
    let mut ran = 0;
    for law in laws() {
        for damping in [Damping::Hysteretic, Damping::Hardening, Damping::Yielding] {
            let law = Law { damping, ..law };
            let made = Contact::new(3.0, 0.4, 1.5).and_then(|it| it.with_law(law, 0.0));
            let steady = law.tangential == Tangential::Constant && !law.rescaled
                || law.tangential == Tangential::Mindlin && damping == Damping::Yielding;
            match made {
                Ok(contact) => {
                    let found = collide(contact);
                    assert!(steady && found.eps_n < 1.0, "{law:?}");
                    ran += 1;
                }
                Err(error) => {
                    let yields = damping == Damping::Yielding && law.normal != Normal::Hertz;
                    assert!(!steady || yields, "{law:?}");
                    let expected =
                        if yields { "a force of Hertz" } else { "a spring of constant stiffness" };
                    assert!(error.to_string().contains(expected), "{error}");
                }
            }
        }
    }
    assert!(ran > 40, "{ran}");
    let dashpot = Contact::new(3.0, 0.4, 0.5)
        .and_then(|contact| contact.with_law(hysteretic(Normal::Linear), 0.2));
    let error = dashpot.unwrap_err().to_string();
    assert!(error.contains("a hysteretic force has no dashpot"), "{error}");
}

/// With κ = 0 and without a tangential dashpot every law is the one without history, and 1 is where
/// ε_t tends to as κ vanishes.
#[test]
fn no_stiffness_is_the_limit_of_small_ones() {
    for law in laws() {
        let damping = if law.damping == Damping::None { 0.0 } else { 0.3 };
        let of = |kappa: f64, law: Law| collide(contact(kappa, 0.9, damping, law));
        let none = of(0.0, law);
        assert_eq!(none.contact.law().history, HistoryOf::None);
        let other = of(7.0, law.without_spring());
        assert_eq!(none.final_velocity.to_bits(), other.final_velocity.to_bits(), "{law:?}");
        assert_eq!((none.eps_t(), none.switches.len()), (1.0, 0));
        let small = of(1e-9, law);
        assert!((1.0 - small.eps_t()).abs() < 1e-7, "{law:?}");
    }
    // The paper's law by its exact engine.
    for damping in [0.0, 0.3] {
        let none = Contact::new(0.0, 0.9, damping).unwrap();
        let (found, statistics) = Engine::Exact.collide(none).unwrap();
        assert!(statistics.is_none() && found.eps_t() == 1.0);
        let (other, _) = Engine::Exact.collide(Contact::new(5.0, 0.9, damping).unwrap()).unwrap();
        assert_eq!(found.eps_n.to_bits(), other.eps_n.to_bits());
        assert!(found.energy.normal_unbalanced().abs() < 1e-12);
        assert_eq!(found.energy.tangential_unbalanced(), 0.0);
        assert!((collide(none).eps_n - found.eps_n).abs() < 1e-12);
    }
    // A slip with a dashpot sets the spring to a force that does not vanish with κ.
    let law = presets::find("gran/hooke/history").unwrap().law;
    let of = |kappa: f64, law: Law| Contact::new(kappa, 0.9, 0.3)?.with_law(law, 0.8);
    let none = collide(of(0.0, law.without_spring()).unwrap());
    let small = collide(of(1e-9, law).unwrap());
    assert!((none.eps_t() - small.eps_t()).abs() > 1e-2);
    let error = of(0.0, law).unwrap_err().to_string();
    assert!(error.contains("or a law without history"), "{error}");
}

/// Without friction the tangential velocity, and with it every spin, is kept.
#[test]
fn impacts_without_friction_keep_the_tangential_velocity() {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.0, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6 };
    let sphere = Sphere::homogeneous(0.02, &steel);
    let meet = |surface: &Surface| {
        Encounter::of_velocities(&sphere, &Body::Sphere(sphere), (2.0, 3.0), surface).unwrap()
    };
    let encounter = meet(&surface);
    let collision = collide(encounter.contact());
    let report = ImpactReport::new(&encounter, collision.clone());
    let outcome = &report.outcome;
    assert_eq!(outcome.eps_t, Some(1.0));
    assert_eq!((report.itinerary().as_str(), outcome.switches.len()), ("+", 0));
    assert_eq!(outcome.motions[0].velocity_m_per_s.x, 3.0);
    assert_eq!(outcome.motions[0].spin_rad_per_s.norm(), 0.0);
    assert!(
        (outcome.motions[0].velocity_m_per_s.z + outcome.motions[1].velocity_m_per_s.z + 2.0).abs()
            < 1e-12
    );
    assert!(outcome.energy.unbalanced_j().abs() < 1e-12 * outcome.energy.kinetic_before_j);
    let rough = Surface { friction: 0.3, ..surface };
    assert!((collide(meet(&rough).contact()).eps_n - outcome.eps_n).abs() < 1e-12);
    // So it is without a spring, in the paper's law.
    let none = Surface { tangential_stiffness_kg_per_s2: 0.0, ..rough };
    let encounter = meet(&none);
    assert_eq!(encounter.outcome(&collide(encounter.contact())).eps_t, Some(1.0));
}
