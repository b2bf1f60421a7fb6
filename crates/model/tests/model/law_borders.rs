//! Contacts on the border between two ways to start, to switch or to end.

use stickslip_model::general::GeneralContact;
use stickslip_model::{
    Collider, Contact, ContactEnd, Damping, HistoryOf, Law, Regime, Tangential, presets,
};
use stickslip_solver::Dop853;

use crate::laws::{collide, laws};

/// The four ways in which a contact may start.
#[test]
fn contacts_start_in_stick_or_slip() {
    let start = |name: &str, (kappa, psi, damping, tangential): (f64, f64, f64, f64)| {
        let law = presets::find(name).unwrap().law;
        let contact = Contact::new(kappa, psi, damping).unwrap();
        collide(contact.with_law(law, tangential).unwrap()).itinerary()
    };
    for (name, parameters, expected) in [
        ("gran/hooke/history", (2.0, 0.4, 0.0, 0.0), 'o'),
        ("gran/hooke/history", (2.0, 0.6, 0.0, 0.0), '+'),
        ("gran/hooke/history", (2.0, 0.6, 0.1, 0.0), 'o'),
        ("gran/hooke/history", (2.0, 0.6, 0.1, 3.0), '+'),
        // The dashpot exceeds the limit, but the spring of the reset history falls behind it.
        ("gran/hooke/history", (0.5, 0.6, 0.1, 3.0), 'o'),
        ("granular/hertz/tsuji/mindlin/force", (2.0, 0.6, 0.1, 3.0), '+'),
        ("granular/hertz/tsuji/mindlin", (2.0, 0.6, 0.1, 1.0), 'o'),
        ("granular/hertz/tsuji/mindlin", (2.0, 0.6, 0.1, 3.0), '-'),
        ("granular/hertz/tsuji/mindlin/force", (2.0, 0.7, 0.0, 0.0), 'o'),
        ("granular/hertz/tsuji/mindlin/force", (2.0, 0.8, 0.0, 0.0), '+'),
    ] {
        let itinerary = start(name, parameters);
        assert!(itinerary.starts_with(expected), "{name} {parameters:?}: {itinerary}");
    }
}

/// However near a contact is to starting otherwise, it has a result, and ε_t is continuous.
#[test]
fn contacts_on_the_verge_of_slip_are_resolved() {
    for law in laws() {
        let damped = law.damping != Damping::None;
        let (kappa, tangential_damping) = if damped { (2.0, 2.0) } else { (2.0, 0.0) };
        // ψ at which a contact starts to slip: where dashpot or spring grow as the limit does.
        let verge = match (damped, law.tangential, law.history) {
            (false, Tangential::Mindlin, HistoryOf::Force) => 0.75,
            _ => 0.5,
        };
        let at = |psi: f64| {
            let damping = if damped { 0.3 } else { 0.0 };
            let contact = Contact::new(kappa, psi, damping).unwrap();
            collide(contact.with_law(law, tangential_damping).unwrap()).eps_t()
        };
        for exponent in 2..10 {
            let distance = 10.0_f64.powi(-exponent);
            let [below, above] = [at(verge * (1.0 - distance)), at(verge * (1.0 + distance))];
            // Some laws turn the force over at once.
            let overturns = damped
                && law.history == HistoryOf::Displacement
                && law.tangential == Tangential::Mindlin
                && law.damping != Damping::Viscoelastic;
            let continuous = (below - above).abs() < 20.0 * distance.sqrt();
            assert!(continuous || overturns, "{law:?} {distance:e}: {below} {above}");
        }
    }
}

/// Force and limit start alike: κψ = 1 without damping (2/3 of it with a history of force), and bψ
/// = 1 with it. Such a contact starts in stick, and has the ε_t of its neighbours.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn contacts_on_the_border_of_slip_stick() {
    let mut checked = Vec::new();
    for preset in presets::ALL {
        let border = if preset.law.history == HistoryOf::Force { 1.5 } else { 1.0 };
        for (kappa, psi) in [(2.0, 0.5), (4.0, 0.25), (10.0, 0.1), (1.25, 0.8), (0.6, 1.0 / 0.6)] {
            for (a, b) in [(0.0, 0.0), (0.2, 1.0 / psi)] {
                let psi = if a > 0.0 { psi } else { psi * border };
                let b = if a > 0.0 && preset.law.damping == Damping::None { continue } else { b };
                // Without damping, laws that differ in damping alone have the same equations.
                let law = if a > 0.0 {
                    preset.law
                } else {
                    let law =
                        Law { damping: Damping::None, end: ContactEnd::Overlap, ..preset.law };
                    Law { limit_damping: false, ..law }
                };
                if checked.contains(&(law, kappa, a)) {
                    continue;
                }
                let at = |part: f64| {
                    let [kappa, b] = if a > 0.0 { [kappa, b * part] } else { [kappa * part, b] };
                    Contact::new(kappa, psi, a).unwrap().with_law(law, b).unwrap()
                };
                let general = GeneralContact::new(at(1.0));
                let [Some(room), _] = general.beginning_margins() else { continue };
                if room.abs() > 1e-15 {
                    continue;
                }
                checked.push((law, kappa, a));
                let beside = collide(at(1.0 - 1e-13));
                for part in [1.0, 1.0 - 2e-16, 1.0 + 3e-16] {
                    let on = collide(at(part));
                    assert_eq!(on.itinerary(), beside.itinerary(), "{} {kappa} {a}", preset.name);
                    assert!((on.eps_t() - beside.eps_t()).abs() < 1e-10, "{}", preset.name);
                    assert!(on.itinerary().starts_with('o'));
                }
            }
        }
    }
    assert!(checked.len() > 40, "{}", checked.len());
}

/// At b = ψ = 1 a contact is on the border of slip, and its dashpots leave no term in the guard of
/// slip. What ends a contact does not matter to its beginning.
#[test]
fn contacts_on_the_border_of_slip_with_even_dashpots() {
    let damped = |law: &Law| law.damping != Damping::None && law.end == ContactEnd::Force;
    for law in laws().into_iter().filter(damped) {
        let at = |psi: f64| {
            let contact = Contact::new(2.0, psi, 0.2).unwrap().with_law(law, 1.0).unwrap();
            collide(contact)
        };
        let [on, beside] = [at(1.0), at(1.0 - 1e-12)];
        assert_eq!(on.itinerary(), beside.itinerary(), "{law:?}");
        assert!((on.eps_t() - beside.eps_t()).abs() < 1e-9, "{law:?}");
    }
}

/// With ψ = 1 and no damping the first slip ends at greatest compression, from where a rescaled
/// history obeys other equations.
#[test]
fn switches_at_greatest_compression_are_made_once() {
    let rescaled = laws().into_iter().filter(|law| law.rescaled && law.damping == Damping::None);
    for law in rescaled.filter(|law| law.end == ContactEnd::Force) {
        for kappa in (1..=60).map(|it| 1.25 * 1.07_f64.powi(it)).chain([2.0, 5.0, 10.0, 18.0]) {
            let at = |psi: f64, collider: Collider| {
                let contact = Contact::new(kappa, psi, 0.0).unwrap().with_law(law, 0.0).unwrap();
                collider.collide(contact).unwrap_or_else(|error| panic!("{contact:?}: {error}"))
            };
            let beside = [1.0 - 1e-6, 1.0 + 1e-6].map(|psi| at(psi, Collider::default()));
            if beside[0].itinerary() != beside[1].itinerary() {
                continue;
            }
            for tolerance in [1e-13, 4e-13, 1e-10, 1e-8] {
                let on = at(1.0, Collider::with_tolerances(Dop853, tolerance, tolerance));
                assert_eq!(on.itinerary(), beside[0].itinerary(), "{law:?} {kappa} {tolerance}");
            }
        }
    }
}

/// A stick phase that begins within rounding of the end at F = 0: the slip that follows is there,
/// and shorter than the phase.
#[test]
fn damped_contacts_that_end_without_force_end_in_slip() {
    let law = Law { tangential: Tangential::Mindlin, history: HistoryOf::Force, ..Law::PAPER };
    let law = Law { rescaled: true, ..law };
    let contact = |kappa, psi| {
        Contact::new(kappa, psi, 0.526_401_281_585_396_2)
            .and_then(|contact| contact.with_law(law, 0.555_541_821_098_004_5))
            .unwrap()
    };
    for step in -200..200 {
        let psi = 0.080_471_668_589_775_4 * (1.0 + 1e-11 * f64::from(step));
        let collision = collide(contact(13.815_822_154_146_71, psi));
        let itinerary = collision.itinerary();
        assert!(!itinerary.ends_with('o'), "{psi:?} {itinerary}");
        let last = collision.switches.last().unwrap();
        assert!(last.to == Regime::Slip && last.time_left >= 0.0, "{psi:?} {last:?}");
    }
}
