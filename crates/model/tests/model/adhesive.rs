//! Adhesion: DMT and JKR with friction, and bodies that stay together.

use stickslip_model::spheres::{Body, BodyPair, Constants, Encounter, Forces, Material, Sphere};
use stickslip_model::{
    Collision, CollisionError, Contact, ContactEnd, Damping, Engine, Law, Normal, Tolerances,
    presets, restitution,
};

use crate::common::file;
use crate::lammps::adhesive_contact;
use crate::laws::collide;

fn named(name: &str, pull_off: f64) -> Law {
    Law { pull_off, ..presets::find(name).unwrap().law }
}

fn contact([kappa, psi, damping, b]: [f64; 4], law: Law) -> Contact {
    Contact::new(kappa, psi, damping).and_then(|it| it.with_law(law, b)).unwrap()
}

/// 100 contacts of each kind, integrated in plain time by another program.
#[test]
fn adhesive_contacts_are_those_of_another_program() {
    let reference = file("adhesive_contacts");
    let cases = reference["cases"].as_array().unwrap();
    let (mut ended, mut wrong) = (0, Vec::new());
    for case in cases {
        let found = collide(adhesive_contact(case));
        assert_eq!(found.adheres, case["adheres"] == true, "{case}");
        if found.adheres {
            continue;
        }
        let number = |name: &str| case[name].as_f64().unwrap();
        let expected = [number("eps_t"), number("eps_n"), number("time")];
        let own = [found.eps_t(), found.eps_n, found.contact_time];
        let close = expected.iter().zip(own).all(|(expected, own)| (expected - own).abs() < 1e-7);
        if !close || found.itinerary() != case["itinerary"] {
            wrong.push(format!("{own:?} {} {case}", found.itinerary()));
        }
        let energy = found.energy;
        assert!(energy.normal_unbalanced().abs() < 1e-11, "{energy:?}");
        assert!(energy.tangential_unbalanced().abs() < 1e-11, "{energy:?}");
        ended += 1;
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(cases.len() == 200 && ended > 180, "{ended}");
}

/// The same contacts as LAMMPS steps through them, whose overlaps are not quite small.
#[test]
fn adhesive_contacts_are_those_of_lammps() {
    let reference = file("lammps_adhesion");
    let cases = reference["cases"].as_array().unwrap();
    for case in cases {
        let contact = adhesive_contact(case);
        let found = collide(contact);
        assert_eq!(found.adheres, case["adheres"] == true, "{case}");
        if !found.adheres {
            let number = |name: &str| case[name].as_f64().unwrap();
            // Overlaps are 2e-5 of the radius.
            let off = contact.psi() * (found.eps_t() - number("eps_t")).abs();
            assert!(off < 2e-5 + 2e-4 * contact.psi(), "{off} {case}");
            assert!((found.eps_n - number("eps_n")).abs() < 2e-4, "{} {case}", found.eps_n);
        }
    }
    assert_eq!(cases.len(), 150);
}

/// Without damping DMT gives back what it took. JKR loses the work of pull-off, the energy of the
/// compression between touch and pull-off, in closed form.
#[test]
fn pull_off_takes_its_energy() {
    for pull_off in [1e-3, 0.1, 0.4] {
        let rest = [2.0, 0.4, 0.0, 0.0];
        let dmt = collide(contact(rest, named("granular/dmt/viscoelastic/mindlin", pull_off)));
        assert!((dmt.eps_n - 1.0).abs() < 1e-11, "{}", dmt.eps_n);
        for (end, part) in parts() {
            let law = Law { end, ..named("granular/jkr/viscoelastic/mindlin", pull_off) };
            let found = collide(contact(rest, law));
            let work = work(pull_off, part);
            assert!((found.eps_n - (1.0 - 2.0 * work).sqrt()).abs() < 1e-11, "{}", found.eps_n);
            assert!((found.energy.damping - work).abs() < 1e-12, "{:?}", found.energy);
        }
    }
}

/// Where a contact of JKR ends, as u³/c.
fn parts() -> [(ContactEnd, f64); 2] {
    [(ContactEnd::Force, 0.75), (ContactEnd::Overlap, 0.25)]
}

/// The work of pull-off in JKR: ∫ F dx from u³ = c to u³ = q c, with x = u⁴ − c u.
fn work(pull_off: f64, part: f64) -> f64 {
    let c = 4.0 / 3.0 * pull_off.sqrt();
    let at = |q: f64| (0.4 * q * q - q + 0.375) * q.powf(4.0 / 3.0) * c.powf(10.0 / 3.0);
    at(part) - at(1.0)
}

/// The velocity below which elastic spheres stay together, in SI units. With pull-off at the least
/// overlap it is that of Thornton and Ning, Powder Technol. 99, 154 (1998): the work of pull-off is
/// 7.09 (Γ⁵R⁴/E*²)^{1/3}, where Γ is the work of adhesion.
#[test]
fn slow_bodies_stay_together() {
    let material =
        Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_per_m3: 2500.0 };
    let (radius, surface_energy) = (1e-4, 0.05);
    let sphere = Sphere::homogeneous(radius, &material);
    let constants = Constants {
        friction: 0.3,
        damping_time_s: Some(0.0),
        surface_energy_j_per_m2: Some(surface_energy),
        ..Constants::default()
    };
    for (end, _) in parts() {
        let law = Law { end, ..named("granular/jkr/viscoelastic/mindlin", 0.0) };
        let forces = Forces::new(law, &constants).unwrap();
        let pair = BodyPair::new(&sphere, &Body::Sphere(sphere), forces).unwrap();
        let modulus = 1e9 / (2.0 * (1.0 - 0.3 * 0.3));
        let adhesion = (2.0_f64 * surface_energy).powi(5) * (0.5 * radius).powi(4);
        let factor = if end == ContactEnd::Overlap { 7.09 } else { 7.09 * 0.12279 / 0.24862 };
        let work = factor * (adhesion / (modulus * modulus)).cbrt();
        let critical = (2.0 * work / pair.effective_mass_kg).sqrt();
        for (velocity, adheres) in [(0.998 * critical, true), (1.002 * critical, false)] {
            let found = collide(pair.impact(velocity, velocity).unwrap().contact);
            assert_eq!(found.adheres, adheres, "{end:?} {velocity}");
            assert_eq!(found.eps_n.is_nan() && found.eps_t().is_nan(), adheres);
        }
        let impact = pair.impact(2.0 * critical, critical).unwrap();
        let first = Encounter::of_velocities(
            &sphere,
            &Body::Sphere(sphere),
            (2.0 * critical, critical),
            forces,
        );
        let outcome = first.unwrap().outcome(&collide(impact.contact));
        let pull_off = 3.0 * std::f64::consts::PI * surface_energy * 0.5 * radius;
        for switch in &outcome.switches {
            let limit = 0.3 * (switch.normal_force_n + 2.0 * pull_off);
            assert!((switch.tangential_force_n.abs() / limit - 1.0).abs() < 1e-12);
        }
        assert!(outcome.energy.unbalanced_j().abs() < 1e-12 * outcome.energy.kinetic_before_j);
    }
}

/// With damping, bodies of DMT separate above a velocity and stay together below it. Near it ε_n
/// vanishes as a root, and so the energy that is left as the difference of the velocities.
#[test]
fn damped_bodies_stay_together_up_to_a_velocity() {
    let at = |pull_off: f64| {
        let law = named("granular/dmt/mass_velocity/linear_history", pull_off);
        collide(contact([3.0, 0.5, 0.3, 1.0], law))
    };
    let (mut low, mut high) = (1e-3, 1.0);
    assert!(!at(low).adheres && at(high).adheres);
    while high - low > 1e-13 {
        let middle = 0.5 * (low + high);
        if at(middle).adheres { high = middle } else { low = middle }
    }
    let left = |part: f64| at(low * (1.0 - part)).eps_n.powi(2);
    assert!((left(2e-6) / left(1e-6) - 2.0).abs() < 1e-3, "{} {}", left(2e-6), left(1e-6));
    // Strong damping creeps to rest and never turns.
    let law = named("granular/dmt/viscoelastic/mindlin", 0.1);
    let found = collide(contact([3.0, 0.5, 20.0, 0.5], law));
    assert!(found.adheres && found.contact_time > 0.0);
    let energy = found.energy;
    assert!(energy.normal_unbalanced().abs() < 1e-11, "{energy:?}");
}

/// A weak adhesion changes little.
#[test]
fn weak_adhesion_is_nearly_none() {
    for (name, without) in [
        ("granular/dmt/viscoelastic/linear_history", "granular/hertz/viscoelastic/linear_history"),
        ("granular/jkr/viscoelastic/mindlin", "granular/hertz/viscoelastic/mindlin"),
    ] {
        let numbers = [4.0, 0.6, 0.0, 0.0];
        let plain = collide(contact(numbers, presets::find(without).unwrap().law));
        let off = |pull_off: f64| {
            let found = collide(contact(numbers, named(name, pull_off)));
            (found.eps_t() - plain.eps_t()).abs()
        };
        assert!(off(1e-7) < 2e-3 && off(1e-7) < 0.2 * off(1e-4), "{} {}", off(1e-7), off(1e-4));
    }
}

/// In gross sliding the impulse is μ times that of the limit: ∫ (F + 2 f) dt, and the normal motion
/// has ∫ F dt = 1 + ε_n where nothing else acts.
#[test]
fn sliding_rubs_with_twice_the_pull_off() {
    for kind in ["dmt", "jkr"] {
        let (pull_off, name) = (0.2, format!("granular/{kind}/viscoelastic/linear_history"));
        let found = collide(contact([200.0, 12.0, 0.0, 0.0], named(&name, pull_off)));
        assert_eq!(found.itinerary(), "o+", "{name}");
        let first = found.switches[0];
        assert!(first.time < 0.01);
        // Up to the short stick phase at the start.
        let expected = 12.0 - (1.0 + found.eps_n) - 2.0 * pull_off * found.contact_time;
        assert!((found.final_velocity - expected).abs() < 2.0 * first.time, "{name}");
    }
}

/// Two methods with other tolerances find the same phases, over the whole range.
#[test]
fn methods_agree_with_adhesion() {
    let mut random = fastrand::Rng::with_seed(1971);
    let (mut held, mut compared) = (0, 0);
    for _ in 0..600 {
        let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
        let numbers =
            [between(1e-3, 1e4), between(1e-4, 30.0), between(1e-4, 10.0), between(0.05, 5.0)];
        let pull_off = between(1e-7, 10.0);
        let preset = presets::ADHESIVE[random.usize(..presets::ADHESIVE.len())];
        let end = if random.bool() { preset.law.end } else { ContactEnd::Overlap };
        let contact = contact(numbers, Law { pull_off, end, ..preset.law });
        let rough = Engine::Dopri5(Tolerances { rtol: 1e-11, atol: 1e-11 });
        let (usual, other) = match [Engine::Auto, rough].map(|engine| engine.collide(contact)) {
            [Ok((usual, _)), Ok((other, _))] => (usual, other),
            // A strong damping creeps for long until a weak adhesion holds: that is refused.
            [Err(_), _] | [_, Err(_)] if contact.damping() > 1.0 => continue,
            other => panic!("{contact:?}: {other:?}"),
        };
        assert_eq!(usual.adheres, other.adheres, "{contact:?}");
        if usual.adheres {
            held += 1;
            continue;
        }
        // A switch nearer to a graze or to the end than the tolerance may differ, but not the end.
        let sure = usual.itinerary() == other.itinerary();
        compared += usize::from(sure);
        let off = (usual.eps_t() - other.eps_t()).abs() * contact.psi().min(1.0);
        assert!(off < 1e-7, "{off} {contact:?}");
        assert!((usual.eps_n - other.eps_n).abs() < 1e-6, "{contact:?}");
    }
    assert!(held > 60 && compared + held > 520, "{held} {compared}");
}

/// Every combination with adhesion runs or is refused with the reason.
#[test]
fn combinations_with_adhesion_run_or_are_refused() {
    let mut ran = 0;
    for law in crate::laws::laws() {
        for normal in [Normal::Dmt, Normal::Jkr] {
            let law = Law { normal, pull_off: 0.05, ..law };
            let ok = matches!(law.damping, Damping::Linear | Damping::Viscoelastic | Damping::None)
                && !law.limit_damping
                && (normal == Normal::Jkr || law.end == ContactEnd::Overlap);
            let damping = if law.damping == Damping::None { 0.0 } else { 0.2 };
            let made = Contact::new(3.0, 0.4, damping).and_then(|it| it.with_law(law, 0.5));
            match made {
                Ok(contact) => {
                    let found = collide(contact);
                    assert!(ok && (found.adheres || found.eps_n <= 1.0 + 1e-11), "{law:?}");
                    ran += 1;
                }
                Err(error) => assert!(!ok && error.to_string().contains("adhesion"), "{law:?}"),
            }
        }
    }
    assert!(ran > 20, "{ran}");
    let refused = |law: Law| {
        let contact = Contact::new(3.0, 0.4, 0.1).and_then(|it| it.with_law(law, 0.0));
        contact.unwrap_err().to_string()
    };
    let dmt = named("granular/dmt/viscoelastic/mindlin", 0.0);
    assert!(refused(dmt).contains("without pull-off the law is one of Hertz' force"));
    assert!(refused(Law { pull_off: 0.1, ..Law::PAPER }).contains("this law has no adhesion"));
    let error = restitution::damping(dmt, 0.8).unwrap_err().to_string();
    assert!(error.contains("the law has adhesion"), "{error}");
}

/// The course of bodies that separate, and none of those that do not.
#[test]
fn a_course_ends_where_the_bodies_separate() {
    for (end, part) in parts() {
        let law = Law { end, ..named("granular/jkr/viscoelastic/mindlin_rescale/force", 0.05) };
        let contact = contact([8.0, 0.5, 0.05, 0.7], law);
        let (found, _, history): (Collision, _, _) = Engine::Auto.followed(contact).unwrap();
        let last = history.phases().last().unwrap().end();
        let c: f64 = 4.0 / 3.0 * 0.05_f64.sqrt();
        let expected = (part * c).cbrt() * (part - 1.0) * c;
        assert!((last.compression - expected).abs() < 1e-10, "{last:?} {expected}");
        assert!((last.velocity - found.final_velocity).abs() < 1e-12);
        assert!((history.duration() - found.contact_time).abs() < 1e-12);
        for moment in history.moments(200) {
            let snapshot = moment.snapshot;
            assert!(snapshot.tangential_force.abs() < snapshot.limit + 1e-10, "{moment:?}");
            assert!(snapshot.limit > 0.05 - 1e-12, "{moment:?}");
        }
    }
    let law = named("granular/jkr/viscoelastic/mindlin", 2.0);
    let error = Engine::Auto.followed(contact([8.0, 0.5, 0.0, 0.0], law)).unwrap_err();
    assert!(matches!(error, CollisionError::Adheres { .. }), "{error}");
}
