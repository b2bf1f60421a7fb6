//! Phases that are far shorter than those beside them.

use stickslip_model::{Contact, Damping, Engine, Tangential};

use crate::itinerary::{ENGINES, Verdict, judged, laws, random};

/// A part of what `validation/examples/itineraries.rs` judges.
#[test]
fn contacts_of_every_law_have_the_right_switches() {
    let mut numbers = fastrand::Rng::with_seed(41);
    let (mut right, mut near) = (0, 0);
    for (name, law) in laws() {
        for contact in random(law, 1e3, 16, &mut numbers) {
            for (engine, verdict) in ENGINES.into_iter().zip(judged(contact)) {
                match verdict {
                    Verdict::Right => right += 1,
                    Verdict::Near => near += 1,
                    // A damping below the range of the integrators.
                    Verdict::Refused(_) => assert!(contact.damping() < 1e-8, "{contact:?}"),
                    Verdict::Wrong(reason) => {
                        panic!("{name}, {}: {reason}: {contact:?}", engine.name())
                    }
                }
            }
        }
    }
    assert!(right > 500 && near < right / 10, "{right} {near}");
}

/// The first stick phase is (a/κψ)² long, which is 1e-28 here. The stick phase that follows the
/// slip began with steps as short, and ended at once in nearly every second contact.
#[test]
fn the_first_phase_does_not_end_those_that_follow() {
    let mut numbers = fastrand::Rng::with_seed(42);
    let mut between = |low: f64, high: f64| low * (high / low).powf(numbers.f64());
    let known = Contact::new(98.71539359459462, 1.9876985150958069, 1.847118717275313e-8).unwrap();
    let constant = laws().into_iter().filter(|(_, law)| law.tangential == Tangential::Constant);
    for (name, law) in constant.filter(|(_, law)| law.damping != Damping::None) {
        let random = (0..8).map(|_| {
            let damping = between(1e-8, 3e-8);
            Contact::new(between(1e4, 1e5), between(1.0, 2.5), damping).unwrap()
        });
        for contact in [known].into_iter().chain(random) {
            let contact = contact.with_law(law, 0.0).unwrap();
            for (engine, verdict) in ENGINES.into_iter().zip(judged(contact)) {
                assert_eq!(verdict, Verdict::Right, "{name}, {}: {contact:?}", engine.name());
            }
        }
    }
}

/// At this stiffness the spring vanishes where the contact ends, and at ψ = 0.286425 it falls as
/// fast as its limit there: a slip of 4e-6 is 2e-11 from vanishing.
#[test]
fn a_slip_that_nearly_vanishes_just_before_the_end_is_not_certain() {
    let at = |psi: f64| Contact::new(1.1337695566992612, psi, 0.5).unwrap();
    for (psi, duration) in [(0.28642789842, 4.4e-6), (0.28642503451605367, 1.04e-8)] {
        let (exact, _) = Engine::Exact.collide(at(psi)).unwrap();
        assert_eq!(exact.itinerary(), "o+o-");
        let slip = exact.switches[1].time - exact.switches[0].time;
        assert!((slip / duration - 1.0).abs() < 0.01, "{slip}");
        for engine in ENGINES {
            let (found, _) = engine.collide(at(psi)).unwrap();
            let estimate = engine.estimate(&found).unwrap();
            assert!(!estimate.certain && estimate.distance < 3e-11, "{psi} {estimate:?}");
        }
    }
}
