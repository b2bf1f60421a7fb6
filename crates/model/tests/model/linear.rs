//! Linear contacts: the exact engine against LAMMPS, closed forms and the integrator.

use std::f64::consts::PI;

use stickslip_model::{
    Collider, Collision, Contact, ContactEnd, CoulombTest, Damping, Engine, HistoryOf, Law, Normal,
    Regime, Side, Tangential, exact::ExactError, linear, presets,
};

use crate::common::{file, number};
use crate::lammps;

const ATTRACTING: Law = Law {
    normal: Normal::Linear,
    damping: Damping::Linear,
    tangential: Tangential::Constant,
    history: HistoryOf::Displacement,
    rescaled: false,
    limit_damping: false,
    end: ContactEnd::Overlap,
    coulomb_test: CoulombTest::Total,
    friction: Law::PAPER.friction,
    pull_off: 0.0,
};
const LIMITED: Law = Law { limit_damping: true, ..ATTRACTING };
const TO_ZERO_FORCE: Law = Law { end: ContactEnd::Force, ..ATTRACTING };

const LAWS: [Law; 3] = [ATTRACTING, LIMITED, TO_ZERO_FORCE];

fn contact(law: Law, [kappa, psi, damping, tangential]: [f64; 4]) -> Contact {
    Contact::new(kappa, psi, damping).unwrap().with_law(law, tangential).unwrap()
}

fn collide(contact: Contact) -> Collision {
    linear::collide(contact).unwrap_or_else(|error| panic!("{contact:?}: {error}"))
}

fn integrate(contact: Contact) -> Collision {
    let collision = Collider::default().collide(contact);
    collision.unwrap_or_else(|error| panic!("{contact:?}: {error}"))
}

/// A random contact of a law, over-damped too where contacts end then.
fn random(law: Law, rng: &mut fastrand::Rng) -> Contact {
    let mut between = |low: f64, high: f64| low * (high / low).powf(rng.f64());
    let (kappa, psi, strong) = (between(1e-2, 1e3), between(1e-3, 5.0), between(1e-2, 20.0));
    let damping = match rng.u8(0..3) {
        0 => 0.0,
        1 if law != ATTRACTING => strong,
        _ => 1.9 * rng.f64(),
    };
    contact(law, [kappa, psi, damping, if rng.bool() { 2.0 * rng.f64() } else { 0.0 }])
}

fn assert_close(one: f64, other: f64, tolerance: f64, contact: Contact) {
    assert!((one - other).abs() <= tolerance, "{one} {other} {contact:?}");
}

/// Both engines find the same, to the accuracy of the integrator.
fn assert_same(one: &Collision, other: &Collision) {
    let contact = one.contact;
    assert_eq!(one.itinerary(), other.itinerary(), "{contact:?}");
    assert_eq!(one.reversals, other.reversals, "{contact:?}");
    assert_close(one.eps_t(), other.eps_t(), 3e-11, contact);
    assert_close(one.eps_n, other.eps_n, 1e-12, contact);
    assert_close(one.contact_time, other.contact_time, 1e-11 * one.contact_time, contact);
    assert_close(one.energy.damping, other.energy.damping, 1e-11, contact);
    assert_close(one.energy.compression_left, other.energy.compression_left, 1e-11, contact);
}

/// Both engines find the same switches. Where one nearly does not happen, its time is less certain
/// than the state.
fn assert_same_switches(one: &Collision, other: &Collision) {
    let contact = one.contact;
    assert_close(one.energy.sliding, other.energy.sliding, 1e-9, contact);
    let [dashpot, found] = [one, other].map(|it| it.energy.tangential_damping);
    assert_close(dashpot, found, 1e-9, contact);
    assert!(dashpot >= 0.0, "{contact:?}");
    for (one, other) in one.switches.iter().zip(&other.switches) {
        assert_eq!((one.to, one.side), (other.to, other.side), "{contact:?}");
        assert_close(one.time, other.time, 1e-7, contact);
        assert_close(one.time_left, other.time_left, 1e-7, contact);
        assert_close(one.velocity, other.velocity, 1e-7, contact);
        let kappa = contact.kappa();
        assert_close(kappa * one.spring, kappa * other.spring, 1e-7, contact);
    }
}

#[test]
fn collisions_are_those_of_lammps() {
    let reference = file("lammps_laws");
    let mut compared = 0;
    for case in reference["cases"].as_array().unwrap() {
        let contact = lammps::contact(case);
        if !linear::solves(&contact) {
            continue;
        }
        let collision = collide(contact);
        let number = |name: &str| case[name].as_f64().unwrap();
        // Their coefficient has the other sign.
        let error = (collision.eps_t() + number("eps_t")).abs();
        assert!(error < 1e-4 + number("eps_t_error"), "{error:e} {case}");
        let error_n = (collision.eps_n - number("eps_n")).abs();
        assert!(error_n < 1e-5 + number("eps_n_error"), "{error_n:e} {case}");
        // With κ = 1 spring and limit vanish together.
        if contact.kappa() != 1.0 || contact.damping() > 0.0 {
            assert_same(&collision, &integrate(contact));
        }
        compared += 1;
    }
    assert!(compared > 30, "{compared}");
}

/// 40-digit solutions by Taylor series, whose switches are decided by Descartes' rule.
#[test]
fn collisions_are_those_of_the_reference() {
    let reference = file("linear_contacts");
    let mut worst = [0.0_f64; 4];
    for case in reference["cases"].as_array().unwrap() {
        let parameters = [0, 1, 2, 3].map(|index| case[index].as_f64().unwrap());
        let law = if case[4] == "overlap" { ATTRACTING } else { TO_ZERO_FORCE };
        let contact = contact(law, parameters);
        let collision = collide(contact);
        assert_eq!(collision.itinerary(), case[5].as_str().unwrap(), "{contact:?}");
        let [eps_t, eps_n, contact_time] = [6, 7, 8].map(|index| number(&case[index]));
        let times = case[9].as_array().unwrap().iter().map(number);
        let late = collision.switches.iter().zip(times).map(|(found, time)| found.time - time);
        let errors = [
            (collision.eps_t() - eps_t) / contact.kappa().sqrt().max(1.0),
            (collision.eps_n - eps_n) / eps_n,
            (collision.contact_time - contact_time) / contact_time,
            late.fold(0.0, |most, error: f64| if error.abs() > most { error.abs() } else { most }),
        ];
        worst = std::array::from_fn(|index| worst[index].max(errors[index].abs()));
    }
    let [eps_t, eps_n, contact_time, switch] = worst;
    assert!(eps_t < 2e-15 && eps_n < 2e-15 && contact_time < 1e-15 && switch < 1e-14, "{worst:?}");
}

#[test]
fn both_engines_agree() {
    let mut rng = fastrand::Rng::with_seed(11);
    let mut switches = 0;
    for law in LAWS {
        for _ in 0..700 {
            let contact = random(law, &mut rng);
            let collision = collide(contact);
            let integrated = integrate(contact);
            assert_same(&collision, &integrated);
            assert_same_switches(&collision, &integrated);
            switches += collision.switches.len();
        }
    }
    assert!(switches > 4000, "{switches}");
}

/// In gross sliding the friction has its limit all the time.
#[test]
fn gross_sliding_has_a_closed_form() {
    for law in LAWS {
        for damping in [0.0, 1e-9, 0.1, 1.0, 1.9, 2.0, 3.0, 50.0] {
            if damping >= law.endless_from() {
                continue;
            }
            let contact = contact(law, [7.0, 60.0, damping, 1.0]);
            let collision = collide(contact);
            assert_eq!(collision.itinerary(), "+", "{contact:?}");
            // Sines or hyperbolic ones: the rate at F = 0 is −e^{−aτ} with cos τν = a/2.
            let half: f64 = 0.5 * damping;
            let crest = match half {
                half if half < 1.0 => half.acos() / (1.0 - half * half).sqrt(),
                half if half > 1.0 => half.acosh() / (half * half - 1.0).sqrt(),
                _ => 1.0,
            };
            let released = (-damping * crest).exp();
            let (force_ends, behind) = (1.0 + released, released - collision.eps_n);
            let attracted = if law == ATTRACTING { behind } else { 0.0 };
            let expected = 1.0 - (force_ends + attracted) / 60.0;
            assert_close(collision.eps_t(), expected, 1e-15, contact);
            if law != ATTRACTING {
                assert_close(collision.eps_n, released, 1e-15, contact);
            }
        }
    }
}

/// Spring and limit vanish together: the spring holds to the end, to which the integrator adds a
/// slip within its tolerances.
#[test]
fn springs_that_vanish_with_their_limit_hold() {
    for law in LAWS {
        for swings in 1..=40_u32 {
            let kappa = f64::from(swings * swings);
            for part in [1e-9, 0.3, 0.999] {
                let contact = contact(law, [kappa, part / kappa, 0.0, 0.0]);
                let collision = collide(contact);
                assert_eq!(collision.itinerary(), "o", "{contact:?}");
                let expected = if swings.is_multiple_of(2) { 1.0 } else { -1.0 };
                assert_close(collision.eps_t(), expected, 1e-13, contact);
                assert_eq!(collision.reversals, swings as usize);
            }
        }
        // The same oscillator for both: Q = ψ F and w = ψ v throughout, up to ψ = 1.
        for damping in [0.0, 1e-6, 0.5, 1.0, 1.5, 2.0, 30.0] {
            for psi in [1e-3, 0.5, 1.0] {
                if damping >= law.endless_from() {
                    continue;
                }
                let contact = contact(law, [1.0, psi, damping, 1.0]);
                let collision = collide(contact);
                assert_eq!(collision.itinerary(), "o", "{contact:?}");
                assert_close(collision.eps_t(), -collision.eps_n, 4e-15, contact);
            }
        }
    }
}

/// A force that begins at its limit sticks, and the sign of the smallest difference decides.
#[test]
fn starts_are_right_beside_their_border() {
    let start = |law: Law, parameters: [f64; 4]| {
        let collision = collide(contact(law, parameters));
        (collision.itinerary(), collision)
    };
    for law in LAWS {
        // κψ = 1 without damping; bψ = 1 with it.
        for (kappa, psi) in [(10.0, 0.1), (2.0, 0.5), (0.6, 1.0 / 0.6), (47.0, 1.0 / 47.0)] {
            for (a, b) in [(0.0, 0.0), (0.2, 1.0 / psi)] {
                let of = |part: f64| if a > 0.0 { [kappa, b * part] } else { [kappa * part, b] };
                let at = |part: f64| {
                    let [kappa, b] = of(part);
                    start(law, [kappa, psi, a, b])
                };
                let [on, below, above] = [1.0, 1.0 - 1e-12, 1.0 + 1e-12].map(at);
                assert_eq!(on.0, below.0, "{law:?} {kappa} {a}");
                assert!(below.0.starts_with('o'), "{law:?} {kappa} {a}");
                for (_, found) in [&on, &below, &above] {
                    assert_same(found, &integrate(found.contact));
                    assert!((found.eps_t() - on.1.eps_t()).abs() < 1e-10);
                }
                // Above, the contact slips or sticks with a reset history.
                let excess = if a > 0.0 { kappa * psi - a * a * b - 1.0 + a * a } else { 1.0 };
                assert_eq!(above.0.starts_with('o'), excess < 0.0, "{law:?} {kappa} {a}");
            }
        }
    }
    // No spring holds where κψ = 1 and κ < 1: it slips at once, or after no time.
    let (itinerary, collision) = start(TO_ZERO_FORCE, [0.5, 2.0, 0.0, 0.0]);
    assert_eq!((itinerary.as_str(), collision.switches[0].time), ("o+", 0.0));
}

/// Round numbers, at which functions vanish together.
#[test]
fn round_numbers_agree() {
    let mut compared = 0;
    for law in LAWS {
        for damping in [0.0, 1e-6, 0.5, 1.0, 1.5, 2.0, 4.0, 100.0] {
            for kappa in [0.01, 0.25, 1.0, 2.0, 4.0, 9.0, 10.0, 100.0, 400.0] {
                for psi in [1e-3, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0] {
                    for tangential in [0.0, 0.5, 1.0, 2.0, 4.0] {
                        if damping >= law.endless_from() || (damping == 0.0 && tangential > 0.0) {
                            continue;
                        }
                        let contact = contact(law, [kappa, psi, damping, tangential]);
                        let collision = collide(contact);
                        let touches = collision.itinerary() == "o" && kappa * psi <= 1.0;
                        // Q at F = 0 is −1.2e-12 κψ by 40 digits: o- is right, but out of reach.
                        let apart = (kappa, psi, damping, tangential) == (4.0, 1e-3, 1e-6, 4.0);
                        if !touches && !apart {
                            assert_same(&collision, &integrate(contact));
                            compared += 1;
                        }
                        assert!(!apart || collision.itinerary().starts_with("o-"));
                    }
                }
            }
        }
    }
    assert!(compared > 3500, "{compared}");
}

/// w vanishes at the very moment of the first switch, where the overlap is greatest.
#[test]
fn reversals_at_switches_are_counted() {
    for (kappa, damping, tangential) in [(400.0, 0.0, 0.0), (2.0, 0.5, 1.0), (100.0, 4.0, 1.0)] {
        let contact = contact(LIMITED, [kappa, 1.0, damping, tangential]);
        for collision in [collide(contact), integrate(contact)] {
            let reversed = collision.final_velocity < 0.0;
            assert_eq!(!collision.reversals.is_multiple_of(2), reversed, "{contact:?}");
            assert!(collision.reversals > 0, "{contact:?}");
        }
    }
}

/// A strong dashpot stops the motion, which then creeps back below the integrator's tolerances.
#[test]
fn strong_dashpots_reverse_once() {
    for (parameters, itinerary) in [
        ([5e-12, 0.008, 2.578, 51.9], "o-"),
        ([1.4e-8, 1.4e-7, 0.0675, 22279.0], "o-"),
        ([2535.8, 1.58e-5, 1.99, 461.0], "o-"),
        ([2.27e-11, 247.8, 3.41, 84.95], "o+"),
    ] {
        let contact = contact(TO_ZERO_FORCE, parameters);
        let [exact, integrated] = [collide(contact), integrate(contact)];
        assert_eq!(exact.itinerary(), itinerary, "{contact:?}");
        assert_eq!(exact.reversals, usize::from(itinerary == "o-"));
        assert!(integrated.reversals <= 1, "{} {contact:?}", integrated.reversals);
        assert_close(exact.eps_t(), integrated.eps_t(), 2e-10, contact);
    }
}

/// Over the whole range collisions end, are finite and keep their accounts.
#[test]
fn the_whole_range_has_results() {
    let mut rng = fastrand::Rng::with_seed(3);
    let (mut computed, mut refused) = (0, 0);
    for _ in 0..3000 {
        let law = LAWS[rng.usize(0..3)];
        let mut between = |low: f64, high: f64| low * (high / low).powf(rng.f64());
        let (kappa, psi, damping) =
            (between(1e-60, 1e7), between(1e-60, 1e60), between(1e-60, 1e4));
        let tangential = between(1e-10, 1e10);
        let tangential = if rng.bool() { tangential } else { 0.0 };
        let damping = if law == ATTRACTING { damping.min(1.99) } else { damping };
        let damping = if rng.u8(0..4) == 0 { 0.0 } else { damping };
        let contact = contact(law, [kappa, psi, damping, tangential]);
        let collision = match linear::collide(contact) {
            Ok(collision) => collision,
            Err(error) => {
                assert!(matches!(error, ExactError::Domain(_)), "{error} {contact:?}");
                refused += 1;
                continue;
            }
        };
        computed += 1;
        collision.require_finite().unwrap();
        collision.energy.require_finite().unwrap();
        assert!(collision.energy.normal_unbalanced().abs() < 1e-14, "{contact:?}");
        assert!(collision.eps_t() <= 1.0 + 1e-13 && collision.eps_n <= 1.0, "{contact:?}");
        for pair in collision.switches.windows(2) {
            assert!(pair[0].time <= pair[1].time && pair[0].time_left >= pair[1].time_left);
            assert!((pair[0].to == Regime::Stick) != (pair[1].to == Regime::Stick));
        }
        let last = collision.switches.last();
        assert!(last.is_none_or(|last| last.time_left >= 0.0), "{contact:?}");
    }
    assert!(computed > 2000 && refused > 10, "{computed} {refused}");
}

/// Where the itinerary changes with ψ, both engines change it at the same place.
#[test]
fn changes_of_the_itinerary_are_at_the_same_places() {
    let mut rng = fastrand::Rng::with_seed(23);
    let mut found = 0;
    for law in LAWS {
        for _ in 0..150 {
            let beside = random(law, &mut rng);
            let at = |psi: f64| {
                let parameters =
                    [beside.kappa(), psi, beside.damping(), beside.tangential_damping()];
                contact(law, parameters)
            };
            let (mut low, mut high) = (beside.psi(), 1.1 * beside.psi());
            let first = collide(at(low)).itinerary();
            if first == collide(at(high)).itinerary() {
                continue;
            }
            while high - low > 1e-15 * high {
                let middle = 0.5 * (low + high);
                let side =
                    if collide(at(middle)).itinerary() == first { &mut low } else { &mut high };
                if middle == *side {
                    break;
                }
                *side = middle;
            }
            for psi in [low * (1.0 - 1e-9), high * (1.0 + 1e-9)] {
                assert_same(&collide(at(psi)), &integrate(at(psi)));
            }
            found += 1;
        }
    }
    assert!(found > 30, "{found}");
}

/// A release just before the end has its time left to all digits: Q is nearly constant there.
#[test]
fn short_times_left_are_accurate() {
    for exponent in [3, 6, 9, 12, 15] {
        // With κ = 1/4 half of a swing is a whole contact: Q(π) = κψ sin(π/2)/ω = ψ/2.
        let psi = 10.0_f64.powi(-exponent);
        let collision = collide(contact(TO_ZERO_FORCE, [0.25, psi, 0.0, 0.0]));
        assert_eq!(collision.itinerary(), "o+");
        // sin z = (ψ/2) cos(z/2).
        let z = 0.5 * psi;
        let left = z + z * z * z * (1.0 / 6.0 - 0.125);
        let found = collision.switches[0].time_left;
        assert!((found - left).abs() < 4e-16 * left + z.powi(5), "{found} {left}");
        assert!((collision.switches[0].time + found - PI).abs() < 1e-15);
    }
}

#[test]
fn terms_without_effect_have_none() {
    let mut rng = fastrand::Rng::with_seed(41);
    for law in LAWS {
        let contact = random(law, &mut rng);
        let force = Law { history: HistoryOf::Force, ..law };
        let other = contact.with_law(force, contact.tangential_damping()).unwrap();
        assert_eq!(collide(contact).switches, collide(other).switches);
    }
    // Without damping its kind does not matter, nor where the contact ends.
    let [one, other] = [Damping::Tsuji, Damping::None]
        .map(|damping| collide(contact(Law { damping, ..TO_ZERO_FORCE }, [9.5, 0.3, 0.0, 2.0])));
    let third = collide(contact(ATTRACTING, [9.5, 0.3, 0.0, 0.0]));
    assert_eq!(one.switches, other.switches);
    assert_eq!(one.switches, third.switches);
}

#[test]
fn the_method_exact_is_this_engine_for_linear_contacts_only() {
    let law = presets::find("gran/hooke/history").unwrap().law;
    let linear_contact = contact(law, [12.0, 0.7, 0.3, 0.5]);
    let (collision, statistics) = Engine::Exact.collide(linear_contact).unwrap();
    assert_eq!(collision, collide(linear_contact));
    assert_eq!(collision.start_side, Side::Positive);
    assert!(statistics.is_none());
    assert!(matches!(Engine::Auto.resolved(&linear_contact), Engine::Dop853(_)));
    for preset in presets::ALL {
        let contact = contact(preset.law, [3.0, 0.5, 0.0, 0.0]);
        let error = linear::collide(contact).err();
        assert_eq!(error, (!linear::solves(&contact)).then_some(ExactError::Law), "{preset:?}");
    }
    for parameters in [[1e11, 0.5, 0.0, 0.0], [1.0, 1e-61, 0.0, 0.0], [1.0, 0.5, 1.99995, 0.0]] {
        let refused = linear::collide(contact(law, parameters));
        assert!(matches!(refused, Err(ExactError::Domain(_))), "{parameters:?}");
    }
}
