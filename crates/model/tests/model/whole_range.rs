//! Both pairs over the whole range of parameters, at their default tolerances: the accuracy that
//! docs/validation.md states, on a part of what it was measured on.

use stickslip_model::{Collider, Collision, CollisionError, Contact, exact};
use stickslip_solver::EmbeddedPair;

use crate::common::{file, number};

/// The pairs with the tolerances of the command line, and the largest error of ε_t.
fn colliders() -> [(Collider, f64); 2] {
    let dopri5 = Collider::with_tolerances(EmbeddedPair::Dopri5, 1e-10, 1e-10);
    [(Collider::default(), 2e-11), (dopri5, 1e-7)]
}

/// κ from 1e-6 to 1e6 and ψ from 1e-10 to 10.
fn random(random: &mut fastrand::Rng) -> (f64, f64) {
    let mut power = |low: f64, high: f64| 10_f64.powf(low + (high - low) * random.f64());
    (power(-6.0, 6.0), power(-10.0, 1.0))
}

fn collide(collider: &Collider, kappa: f64, psi: f64, damping: f64) -> Collision {
    let collided = collider.collide(Contact::new(kappa, psi, damping).unwrap());
    collided.unwrap_or_else(|error: CollisionError| panic!("{kappa} {psi} {damping}: {error}"))
}

#[test]
fn undamped_contacts_have_the_switches_of_the_exact_solution() {
    let mut numbers = fastrand::Rng::with_seed(11);
    // Beside these, places where switches were missing, too many, or inaccurate.
    let known = [
        (0.5, 1e-9),
        (0.8961505019466045, 1e-8),
        (14367.82022641501, 9.287749420406055e-06),
        (13023.84383614779, 1.3469397069760043e-5),
        (5e6, 1e-6),
        (0.4019454035392955, 9.157667198417681e-9),
        (0.766342763533228, 1.5052851127529798e-8),
    ];
    let contacts = known.into_iter().chain((0..600).map(|_| random(&mut numbers)));
    for (kappa, psi) in contacts {
        let expected = exact::collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap();
        for (collider, tolerance) in colliders() {
            let found = collide(&collider, kappa, psi, 0.0);
            assert_eq!(found.itinerary(), expected.itinerary(), "{kappa} {psi} {collider:?}");
            assert_eq!(found.reversals, expected.reversals, "{kappa} {psi} {collider:?}");
            let error = (found.eps_t() - expected.eps_t()).abs();
            let tolerance = if kappa > 1e6 { 10.0 * tolerance } else { tolerance };
            assert!(error < tolerance, "{kappa} {psi} {collider:?}: {error:e}");
        }
    }
}

/// Beside a boundary of kind *end of contact* the last two switches are nearer to the end than the
/// rounding of the state. They are there as long as w is accurate enough to tell on which side of
/// the boundary the contact is.
#[test]
fn switches_just_before_the_end_are_there() {
    let mut numbers = fastrand::Rng::with_seed(13);
    let mut signed = |low: f64, high: f64| {
        let size = 10_f64.powf(low + (high - low) * numbers.f64());
        if numbers.bool() { size } else { -size }
    };
    for index in 0..400 {
        let (kappa, psi) = if index % 2 == 0 {
            // The boundary ψ = 2 of every stiffness above 0.57.
            (signed(0.0, 4.0).abs(), 2.0 + signed(-12.0, -6.0))
        } else {
            // Boundaries that end at κ_n as ψ → 0, for odd n.
            let kappa = exact::small_impact_boundary(1 + 2 * (index % 5));
            (kappa * (1.0 + signed(-9.0, -3.0)), signed(-12.9, -5.0).abs())
        };
        let contact = Contact::new(kappa, psi, 0.0).unwrap();
        let expected = exact::collide(contact).unwrap();
        for (collider, tolerance) in colliders() {
            let found = collide(&collider, kappa, psi, 0.0);
            if exact::distance(&contact).unwrap() > tolerance {
                assert_eq!(found.itinerary(), expected.itinerary(), "{kappa} {psi:e} {collider:?}");
                assert_eq!(found.reversals, expected.reversals, "{kappa} {psi:e} {collider:?}");
            }
        }
    }
}

/// Contacts log-uniform over the whole range, by a Taylor series that decides on switches by
/// Descartes' rule.
#[test]
fn contacts_have_the_switches_and_digits_of_an_independent_series() {
    let mut compared = [0; 3];
    for (index, case) in file("contacts_series")["cases"].as_array().unwrap().iter().enumerate() {
        let [kappa, psi, damping] = [0, 1, 2].map(|column| case[column].as_f64().unwrap());
        let [eps_t, eps_n, time] = [4, 5, 6].map(|column| number(&case[column]));
        let check = |found: &Collision, tolerances: [f64; 2]| {
            let place = format!("{kappa} {psi:e} {damping:e}");
            assert_eq!(case[3], found.itinerary(), "{place}");
            let error = (found.eps_t() - eps_t).abs();
            assert!(error < tolerances[0], "{place}: {error:e}");
            for (found, expected) in [(found.eps_n, eps_n), (found.contact_time, time)] {
                assert!((found / expected - 1.0).abs() < tolerances[1], "{place}: {found}");
            }
        };
        if damping == 0.0 {
            let found = exact::collide(Contact::new(kappa, psi, damping).unwrap()).unwrap();
            check(&found, [1e-15 * (1.0 + kappa.sqrt()), 1e-15]);
            compared[0] += 1;
        }
        // The stiffest ones take most of the time.
        if kappa < 3e3 && index % 5 == 0 {
            let [dop853, dopri5] = colliders().map(|(collider, _)| collider);
            check(&collide(&dop853, kappa, psi, damping), [2e-11, 4e-12]);
            compared[1] += 1;
            if index % 10 == 0 {
                check(&collide(&dopri5, kappa, psi, damping), [1e-7, 1e-9]);
                compared[2] += 1;
            }
        }
    }
    assert!(compared[0] >= 300 && compared[1] > 300 && compared[2] > 150, "{compared:?}");
}

/// Contact time and ε_n depend on the damping alone.
#[test]
fn damped_contacts_end_when_they_should() {
    let mut numbers = fastrand::Rng::with_seed(12);
    for case in file("normal_motion")["cases"].as_array().unwrap() {
        let damping = case["damping"].as_f64().unwrap();
        let [time, eps_n] = ["contact_time", "eps_n"].map(|key| number(&case[key]));
        for _ in 0..4 {
            let (kappa, psi) = random(&mut numbers);
            let [one, other] = colliders().map(|(collider, tolerance)| {
                let found = collide(&collider, kappa, psi, damping);
                let errors = [found.contact_time / time - 1.0, found.eps_n / eps_n - 1.0];
                let bound = if tolerance < 1e-10 { 4e-12 } else { 1e-9 };
                let right = errors.iter().all(|error| error.abs() < bound);
                assert!(right, "{kappa} {psi} {damping} {collider:?}: {errors:?}");
                found
            });
            assert_eq!(one.itinerary(), other.itinerary(), "{kappa} {psi} {damping}");
            assert!((one.eps_t() - other.eps_t()).abs() < 1e-7, "{kappa} {psi} {damping}");
        }
    }
}

/// A slip that begins with the contact, by a tiny spring, is not one just before the end.
/// A contact of 24 000 steps, in which rounding would add up to 2.7e-11.
#[test]
fn errors_of_rounding_do_not_add_up() {
    let (kappa, psi, damping) = (907118.102355302, 1.81520634245102e-8, 1.5106079100825585);
    let contact = Contact::new(kappa, psi, damping).unwrap();
    let found = collide(&Collider::default(), kappa, psi, damping);
    let off = (found.eps_t() - exact::collide(contact).unwrap().eps_t()).abs();
    // Measured: 2.6e-12.
    assert!(off < 5e-12, "{off:e}");
}

#[test]
fn a_contact_of_one_slip_has_its_length() {
    let damping = 1.3416016022105013e-6;
    for (collider, _) in colliders() {
        let found = collide(&collider, 106065.88068271137, 4.540747178410921, damping);
        assert_eq!(found.itinerary(), "o+");
        assert!((found.contact_time - exact::CONTACT_TIME).abs() < 1e-5, "{found:?}");
        assert!((found.switches[0].time_left / found.contact_time - 1.0).abs() < 1e-12);
    }
}

/// Contacts whose end used to be missed: ε_n was off by 17 %, or ε_t had the wrong sign.
#[test]
fn strong_damping_ends_a_contact() {
    for (kappa, psi, damping) in
        [(20.176753929476245, 2.3609777910749106, 3511.353516158355), (2.79e-5, 1.66e-10, 3398.0)]
    {
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            for pair in EmbeddedPair::ALL {
                let collider = Collider::with_tolerances(pair, tolerance, tolerance);
                let found = collide(&collider, kappa, psi, damping);
                let expected = collide(&Collider::default(), kappa, psi, damping);
                let error = (found.contact_time / expected.contact_time - 1.0).abs();
                assert!(error < 10.0 * tolerance, "{damping} {pair} {tolerance}: {error:e}");
                assert!(found.eps_t() > 0.99, "{}", found.eps_t());
            }
        }
    }
}
