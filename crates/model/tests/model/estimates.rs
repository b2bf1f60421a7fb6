//! Estimates beside results: they cover the errors, and tell how far other switches are.

use stickslip_model::{Collision, Contact, Engine, Estimate, Tolerances};

use crate::common::{file, number};

fn engines() -> [Engine; 5] {
    let at = |tolerance| Tolerances { rtol: tolerance, atol: tolerance };
    [
        Engine::Exact,
        Engine::Dop853(Tolerances::DOP853),
        Engine::Dop853(at(1e-8)),
        Engine::Dopri5(Tolerances::DOPRI5),
        Engine::Dopri5(at(1e-6)),
    ]
}

fn estimated(engine: Engine, contact: Contact) -> (Collision, Estimate) {
    let collided = engine.collide(contact);
    let (collision, _) = collided.unwrap_or_else(|error| panic!("{contact:?}: {error}"));
    let estimate = engine.estimate(&collision);
    (collision, estimate.unwrap_or_else(|error| panic!("{contact:?}: {error}")))
}

fn itinerary(contact: Contact) -> String {
    Engine::Auto.collide(contact).unwrap().0.itinerary()
}

/// Of the contacts with 25 digits, those that take little time.
fn reference() -> impl Iterator<Item = (Contact, String, f64)> {
    let cases = file("contacts_series")["cases"].as_array().unwrap().clone();
    cases.into_iter().filter_map(|case| {
        let [kappa, psi, damping] = [0, 1, 2].map(|index| case[index].as_f64().unwrap());
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let expected = (contact, case[3].as_str().unwrap().to_owned(), number(&case[4]));
        (kappa < 1e3).then_some(expected)
    })
}

#[test]
fn errors_are_covered_and_not_exaggerated() {
    for engine in engines() {
        let (mut uncovered, mut ratios) = (0, Vec::new());
        for (index, (contact, expected, eps_t)) in reference().enumerate() {
            if contact.damping() > 0.0 && engine != Engine::Exact && index % 8 != 0 {
                continue;
            }
            let (found, estimate) = estimated(engine, contact);
            let error = (found.eps_t() - eps_t).abs();
            uncovered += u32::from(error > estimate.eps_t_error);
            // What is below the rounding of ε_t is not an error of the engine.
            ratios.push(estimate.eps_t_error / error.max(1.1e-16));
            assert!(!estimate.certain || found.itinerary() == expected, "{engine:?} {contact:?}");
        }
        assert!(ratios.len() > 200 && uncovered <= 1, "{engine:?}: {uncovered}");
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        assert!((1.0..100.0).contains(&median), "{engine:?}: {median}");
    }
}

/// A distance below this is right to first order.
const NEAR: f64 = 0.1;

#[test]
fn nearer_than_the_distance_the_switches_are_the_same() {
    let mut random = fastrand::Rng::with_seed(31);
    let mut power = |low: f64, high: f64| 10_f64.powf(low + (high - low) * random.f64());
    let mut near = 0;
    for index in 0..600 {
        let damping = if index % 3 == 0 { power(-4.0, 2.0) } else { 0.0 };
        let (kappa, psi) = (power(-1.0, 3.0), power(-3.0, 0.5));
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let (found, Estimate { distance, .. }) = estimated(Engine::Auto, contact);
        if distance < NEAR {
            near += 1;
            for part in [-0.9, 0.9] {
                let beside = Contact::new(kappa, psi * (1.0 + part * distance), damping).unwrap();
                assert_eq!(itinerary(beside), found.itinerary(), "{contact:?} {distance:e}");
            }
        }
    }
    assert!(near > 150, "{near}");
}

#[test]
fn at_a_boundary_the_distance_vanishes() {
    let mut random = fastrand::Rng::with_seed(32);
    let mut tight = 0;
    for index in 0..80 {
        let damping = if index % 2 == 0 { 0.05 + random.f64() } else { 0.0 };
        let kappa = 0.3 + 80.0 * random.f64();
        let at = |psi: f64| Contact::new(kappa, psi, damping).unwrap();
        // The boundary that a bisection of ψ meets.
        let (mut low, mut high) = (0.05, 3.0);
        let below = itinerary(at(low));
        if itinerary(at(high)) == below {
            continue;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let side = if itinerary(at(middle)) == below { &mut low } else { &mut high };
            *side = middle;
        }
        for psi in [low * (1.0 - 1e-5), high * (1.0 + 1e-5)] {
            let (_, Estimate { distance, .. }) = estimated(Engine::Auto, at(psi));
            assert!(distance < 1.01e-5, "{:?}: {distance:e}", at(psi));
            tight += u32::from(distance > 1e-7);
        }
    }
    assert!(tight > 100, "{tight}");
}
