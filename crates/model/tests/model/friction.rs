//! Friction that decays with the tangential velocity, from a static to a dynamic coefficient.

use stickslip_model::spheres::{
    Body, BodyPair, Constants, Encounter, Forces, ImpactReport, Material, Sphere,
};
use stickslip_model::{
    CollisionError, Contact, ContactEnd, CoulombTest, Damping, Engine, Friction, HistoryOf, Law,
    Normal, Regime, Tangential, presets,
};

use crate::common::file;
use crate::laws::{collide, laws};
use crate::plain;

fn contact(kappa: f64, psi: f64, damping: f64, law: Law) -> Contact {
    Contact::new(kappa, psi, damping).and_then(|it| it.with_law(law, 0.0)).unwrap()
}

/// Contacts integrated in plain time by another program. Measured errors of w are below 2e-11.
#[test]
fn decaying_friction_is_that_of_another_program() {
    let reference = file("decaying_friction");
    let cases = reference["cases"].as_array().unwrap();
    let (mut worst, mut others) = (0.0_f64, 0);
    for case in cases {
        let number = |name: &str| case[name].as_f64().unwrap();
        let mindlin = case["mindlin"].as_bool().unwrap();
        let law = Law {
            normal: if case["normal"] == "hertz" { Normal::Hertz } else { Normal::Linear },
            damping: match case["damping_of"].as_str().unwrap() {
                "linear" => Damping::Linear,
                "tsuji" => Damping::Tsuji,
                _ => Damping::None,
            },
            tangential: if mindlin { Tangential::Mindlin } else { Tangential::Constant },
            history: HistoryOf::Force,
            rescaled: mindlin,
            limit_damping: true,
            end: ContactEnd::Overlap,
            friction: Friction { dynamic: number("dynamic"), decay: number("decay") },
            ..Law::PAPER
        };
        let contact = Contact::new(number("kappa"), number("psi"), number("damping"))
            .and_then(|contact| contact.with_law(law, number("tangential_damping")))
            .unwrap();
        let found = collide(contact);
        let error = contact.psi() * (found.eps_t() - number("eps_t")).abs();
        worst = worst.max(error);
        assert!((found.eps_n - number("eps_n")).abs() < 1e-9, "{case}");
        // The other program begins at the time 1e-12, before which the first phase may end.
        let own = found.itinerary();
        let brief = found.switches.first().is_some_and(|switch| switch.time < 1e-12);
        let own = if brief { &own[1..] } else { &own[..] };
        others += usize::from(own != case["itinerary"].as_str().unwrap());
    }
    assert!(worst < 1e-9, "{worst:e}");
    assert_eq!((others, cases.len()), (0, 150));
}

/// Every law with every part of its friction, in plain time.
#[test]
fn every_law_may_have_decaying_friction() {
    let mut rng = fastrand::Rng::with_seed(6705);
    let (mut ran, mut refused) = (0, 0);
    let plain = |law: &Law| law.tangential == Tangential::Constant && !law.rescaled;
    let dashpots = laws().into_iter().filter(plain).filter(|law| law.damping != Damping::None);
    let dashpots = dashpots.map(|law| Law { history: HistoryOf::None, ..law });
    for law in laws().into_iter().chain(dashpots) {
        for coulomb_test in [CoulombTest::Total, CoulombTest::Spring] {
            let mut between = |low: f64, high: f64| low * (high / low).powf(rng.f64());
            let (kappa, psi) = (between(0.05, 100.0), between(0.02, 3.0));
            let damping = match law.damping {
                Damping::None => 0.0,
                _ => between(0.02, law.endless_from().min(1.5)),
            };
            let friction = Friction { dynamic: between(1e-3, 1.0), decay: between(0.05, 30.0) };
            let has_dashpot = law.history == HistoryOf::None || rng.bool();
            let dashpot = if has_dashpot { 2.0 * rng.f64() } else { 0.0 };
            let law = Law { friction, coulomb_test, ..law };
            let made = Contact::new(kappa, psi, damping).and_then(|it| it.with_law(law, dashpot));
            let Ok(contact) = made else {
                let error = made.unwrap_err().to_string();
                assert!(error.contains("a friction that decays"), "{error}");
                assert!(coulomb_test == CoulombTest::Spring && damping * dashpot > 0.0);
                refused += 1;
                continue;
            };
            let found = collide(contact);
            let energy = found.energy;
            assert!(energy.normal_unbalanced().abs() < 1e-9, "{contact:?}");
            let plain = plain::collide(contact).unwrap_or_else(|| panic!("{contact:?}"));
            let error = (found.eps_t() - plain.eps_t).abs() * contact.psi();
            assert!(error < 2e-6, "{error:e} {contact:?}");
            ran += 1;
        }
    }
    assert!(ran > 150 && refused > 10, "{ran} {refused}");
}

/// In gross sliding dw/dt = −μ(w) F has the integral ln(r e^(Bw) + 1 − r) = … − r B ∫F dt, where
/// ∫F dt = 1 + ε_n.
#[test]
fn gross_sliding_is_in_closed_form() {
    for name in ["kratos/DEM_D_Linear_viscous_Coulomb", "gran/hertz/history", "walton-braun"] {
        for (dynamic, decay) in [(0.5, 0.3), (0.2, 3.0), (0.9, 40.0), (1e-3, 0.1)] {
            // With a dashpot the contact sticks at first.
            for damping in if name == "walton-braun" { vec![0.0, 0.4] } else { vec![0.0] } {
                let friction = Friction { dynamic, decay };
                let law = Law { friction, ..presets::find(name).unwrap().law };
                let found = collide(contact(1.5, 6.0, damping, law));
                assert_eq!(found.itinerary(), "+", "{name} {dynamic} {decay}");
                let before = dynamic * (decay * 6.0).exp() + 1.0 - dynamic;
                let after = before * (-dynamic * decay * (1.0 + found.eps_n)).exp();
                let expected = ((after - (1.0 - dynamic)) / dynamic).ln() / decay;
                let error = (found.final_velocity - expected).abs();
                assert!(error < 1e-11, "{error:e} {name} {dynamic} {decay} {damping}");
            }
        }
    }
    // The fastest decay leaves the dynamic coefficient.
    let friction = Friction { dynamic: 0.3, decay: 1e9 };
    let law = Law { friction, ..presets::find("walton-braun").unwrap().law };
    let found = collide(contact(1.5, 6.0, 0.4, law));
    assert!((found.final_velocity - 6.0 + 0.3 * (1.0 + found.eps_n)).abs() < 1e-12);
}

/// One coefficient, however it is said, is Coulomb's friction to the last bit.
#[test]
fn friction_that_does_not_decay_is_coulombs() {
    for law in laws() {
        let damping = if law.damping == Damping::None { 0.0 } else { 0.3 };
        let usual = collide(contact(7.0, 0.6, damping, law));
        for friction in
            [Friction { dynamic: 1.0, decay: 3.0 }, Friction { dynamic: 0.2, decay: 0.0 }]
        {
            let same = collide(contact(7.0, 0.6, damping, Law { friction, ..law }));
            assert_eq!(same.final_velocity.to_bits(), usual.final_velocity.to_bits());
        }
        // And what tends to it.
        let friction = Friction { dynamic: 1.0 - 1e-9, decay: 2.0 };
        let near = collide(contact(7.0, 0.6, damping, Law { friction, ..law }));
        assert!((near.final_velocity - usual.final_velocity).abs() < 1e-6, "{law:?}");
        let friction = Friction { dynamic: 0.3, decay: 1e-9 };
        let near = collide(contact(7.0, 0.6, damping, Law { friction, ..law }));
        assert!((near.final_velocity - usual.final_velocity).abs() < 1e-6, "{law:?}");
    }
}

/// During the contact the force is at most μ(w) F, and has this size in slip.
#[test]
fn the_force_stays_below_its_limit() {
    let law = Law {
        friction: Friction { dynamic: 0.4, decay: 5.0 },
        ..presets::find("gran/hertz/history").unwrap().law
    };
    let (collision, _, history) = Engine::Auto.followed(contact(30.0, 0.5, 0.2, law)).unwrap();
    assert!(collision.reversals >= 2 && collision.switches.len() >= 4, "{collision:?}");
    for phase in history.phases() {
        for moment in phase.samples(200) {
            let limit = moment.normal_force.abs() * law.friction.share(moment.velocity);
            let excess = moment.tangential_force.abs() - limit;
            assert!(excess < 1e-9, "{excess:e} {moment:?}");
            assert!(phase.regime() == Regime::Stick || excess.abs() < 1e-9, "{moment:?}");
        }
    }
}

const HERTZ: &str = "kratos/DEM_D_Hertz_viscous_Coulomb";

/// Numbers far beyond those of surfaces run, and numbers that have no meaning are refused.
#[test]
fn extreme_decays_run_or_are_refused() {
    let mut rng = fastrand::Rng::with_seed(8744);
    for name in ["paper", "gran/hooke/history", "gran/hertz/history", HERTZ] {
        for decay in [1e-12, 1e-3, 3.0, 10.0, 30.0, 100.0, 1e3, 1e5, 1e9] {
            for dynamic in [0.0, 1e-6, 0.5, 1.0 - 1e-12] {
                let friction = Friction { dynamic, decay };
                let law = Law { friction, ..presets::find(name).unwrap().law };
                let (kappa, psi) = (0.1 * 1e3_f64.powf(rng.f64()), 1e-3 * 1e4_f64.powf(rng.f64()));
                let damping = if rng.bool() { 0.3 } else { 0.0 };
                let contact = contact(kappa, psi, damping, law);
                match Engine::Auto.collide(contact) {
                    Ok((found, _)) => {
                        assert!(found.final_velocity.abs() <= 1.2 * psi, "{found:?}");
                    }
                    Err(CollisionError::Domain(_)) if friction.share(psi) < 1e-8 => {}
                    Err(error) => panic!("{error} {contact:?}"),
                }
            }
        }
    }
    let law = presets::find("gran/hooke/history").unwrap().law;
    let friction = Friction { dynamic: 0.5, decay: 1e300 };
    let error = Engine::Auto.collide(contact(1.0, 1.0, 0.0, Law { friction, ..law })).unwrap_err();
    assert!(error.to_string().contains("the decay of friction = 1e300"), "{error}");
    for (dynamic, decay) in [
        (1.1, 1.0),
        (-0.1, 1.0),
        (f64::NAN, 1.0),
        (0.5, -1.0),
        (0.5, f64::INFINITY),
        (0.5, f64::NAN),
    ] {
        let law = Law { friction: Friction { dynamic, decay }, ..law };
        assert!(Contact::new(1.0, 1.0, 0.0).unwrap().with_law(law, 0.0).is_err());
    }
}

/// The constants in SI units: μ_d/μ_s, and β μ_s g_n/α.
#[test]
fn decaying_friction_has_si_units() {
    let law = presets::find("gran/hooke/history").unwrap().law;
    let constants = Constants {
        friction: 0.5,
        dynamic_friction: Some(0.2),
        friction_decay_s_per_m: Some(3.0),
        normal_stiffness_kg_per_s2: Some(2e5),
        tangential_stiffness_kg_per_s2: Some(1e6),
        damping_coefficient: Some(0.0),
        ..Constants::default()
    };
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let sphere = Sphere::homogeneous(1e-3, &steel);
    let pair = |constants: &Constants| {
        BodyPair::new(&sphere, &Body::Sphere(sphere), Forces::new(law, constants).unwrap()).unwrap()
    };
    let made = pair(&constants).impact(0.7, 0.9).unwrap().contact;
    let Friction { dynamic, decay } = made.law().friction;
    assert_eq!(dynamic, 0.4);
    assert!((decay - 3.0 * 0.5 * 0.7 * 3.5).abs() < 1e-14, "{decay}");
    // The same share of the normal force at the velocities of this impact.
    let share = made.law().friction.share(made.psi());
    assert!((share - (0.4 + 0.6 * (-3.0_f64 * 0.9).exp())).abs() < 1e-15);
    // The forces at switches, in N.
    let forces = Forces::new(law, &constants).unwrap();
    let encounter =
        Encounter::of_velocities(&sphere, &Body::Sphere(sphere), (0.7, 0.9), forces).unwrap();
    let report = ImpactReport::new(&encounter, collide(encounter.contact()));
    assert!(report.outcome.switches.len() >= 2 && report.comparison.eps_t_coulomb.is_none());
    for switch in &report.outcome.switches {
        let mu = 0.2 + 0.3 * (-3.0 * switch.velocity_m_per_s.abs()).exp();
        let error = switch.tangential_force_n.abs() - mu * switch.normal_force_n;
        assert!(error.abs() < 1e-12 * switch.normal_force_n, "{switch:?}");
        // Force and overlap of a linear contact without damping.
        let time = switch.time_s * (2e5 / (0.5 * sphere.mass_kg)).sqrt();
        let largest = 0.7 * (2e5 * 0.5 * sphere.mass_kg).sqrt();
        let error = switch.normal_force_n - largest * time.sin();
        assert!(error.abs() < 1e-9 * largest, "{switch:?} {error}");
    }
    // Without friction nothing decays, and ε_t is 1.
    let none = Constants { friction: 0.0, dynamic_friction: Some(0.0), ..constants };
    assert_eq!(collide(pair(&none).impact(0.7, 0.9).unwrap().contact).eps_t(), 1.0);
    let refused = |constants: Constants| Forces::new(law, &constants).unwrap_err().to_string();
    let above = refused(Constants { dynamic_friction: Some(0.6), ..constants });
    assert!(above.contains("at most friction"), "{above}");
    let alone = refused(Constants { friction_decay_s_per_m: None, ..constants });
    assert!(alone.contains("friction_decay_s_per_m is missing"), "{alone}");
    let alone = refused(Constants { dynamic_friction: None, ..constants });
    assert!(alone.contains("dynamic_friction is missing"), "{alone}");
    let scaled = Law { friction: Friction { dynamic: 0.5, decay: 1.0 }, ..law };
    let error = Forces::new(scaled, &constants).unwrap_err().to_string();
    assert!(error.contains("of the bodies instead"), "{error}");
}

/// Why a limit that jumps from μ_s |F| to μ_d |F|, and the spring with it, is no law here: in the
/// steps of MercuryDPM the results at ever shorter steps do not come closer to each other.
#[test]
fn a_friction_that_jumps_has_no_limit_of_small_steps() {
    let stepped = |dynamic: f64, dt: f64| {
        let (kappa, psi) = (8.0, 0.7);
        let (mut x, mut v, mut w, mut q) = (-0.37 * dt, 1.0, psi, 0.0_f64);
        loop {
            x += dt * v;
            if x <= 0.0 && v < 0.0 {
                return w / psi;
            }
            if x > 0.0 {
                q += kappa * w * dt;
                if q.abs() > x {
                    q = (dynamic * x).copysign(q);
                }
                v -= dt * x;
                w -= dt * q;
            }
        }
    };
    let spread = |dynamic: f64, first: f64| {
        let found: Vec<f64> =
            (0..12).map(|k| stepped(dynamic, first * 2.0_f64.powf(-0.25 * f64::from(k)))).collect();
        found.iter().copied().fold(f64::MIN, f64::max) - found.into_iter().fold(f64::MAX, f64::min)
    };
    // With one coefficient the spread falls with the step.
    assert!(spread(1.0, 1e-3) < 5e-3 && spread(1.0, 1e-4) < 5e-4);
    for first in [1e-3, 1e-4, 2e-5] {
        assert!(spread(0.5, first) > 0.02, "{first} {}", spread(0.5, first));
    }
}
