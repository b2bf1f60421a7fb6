//! The exact engine against the reference data, with narrower bounds than `reference.rs` has for
//! both engines.

use std::f64::consts::PI;

use crate::common::{Case, cases, file, number};
use stickslip_model::exact::{self, CONTACT_TIME};
use stickslip_model::{Collider, Collision, Contact};

fn exact(contact: Contact) -> Collision {
    exact::collide(contact).expect("a collision")
}

/// Largest errors of the switches of one collision: the absolute error of times, springs and
/// velocities, and the relative error of times left.
///
/// The itinerary and the final velocity of the collision must be right.
fn errors(case: &Case) -> (f64, f64) {
    let collision = exact(case.contact);
    assert!(case.same_itinerary(&collision), "{:?}", case.contact);
    let error = (collision.final_velocity - case.number("w_final")).abs();
    assert!(error < 1e-15, "{:?}: w is off by {error}", case.contact);
    let (mut absolute, mut of_time_left) = (0.0_f64, 0.0_f64);
    for (switch, expected) in collision.switches.iter().zip(case.switches()) {
        let off = |value: f64, name: &str| (value - number(&expected[name])).abs();
        absolute = absolute.max(off(switch.time, "time")).max(off(switch.spring, "y"));
        absolute = absolute.max(off(switch.velocity, "w"));
        let left = off(switch.time_left, "time_left") / number(&expected["time_left"]);
        of_time_left = of_time_left.max(left);
    }
    (absolute, of_time_left)
}

#[test]
fn paper_and_random_collisions() {
    for (name, count) in [("undamped_paper", 33), ("undamped_random", 200)] {
        assert_eq!(number(&file(name)["contact_time"]), CONTACT_TIME);
        let cases = cases(name);
        assert_eq!(cases.len(), count);
        for case in &cases {
            let (absolute, of_time_left) = errors(case);
            assert!(absolute < 1e-14, "{:?}: {absolute}", case.contact);
            assert!(of_time_left < 1e-12, "{:?}: {of_time_left}", case.contact);
        }
    }
}

#[test]
fn collisions_beside_switch_boundaries() {
    for case in cases("undamped_hard") {
        let (absolute, of_time_left) = errors(&case);
        assert!(absolute < 1e-11, "{:?}: {absolute}", case.contact);
        // Close to the end the time left is proportional to w², and w is known to about 4e-16.
        let known = 2.0 * 4e-16 / case.number("w_final").abs();
        assert!(of_time_left < known + 1e-11, "{:?}: {of_time_left}", case.contact);
    }
}

#[test]
fn counts_change_at_the_switch_boundaries() {
    let boundaries = file("boundaries");
    for boundary in boundaries["boundaries"].as_array().expect("an array") {
        let (kappa, psi) = (number(&boundary["kappa"]), number(&boundary["psi"]));
        for distance in [1e-14, 1e-13, 1e-9] {
            for (factor, key) in [(1.0 - distance, "below"), (1.0 + distance, "above")] {
                let collision = exact(Contact::new(kappa, psi * factor, 0.0).expect("valid"));
                let count = collision.switches.len() as u64;
                assert_eq!(Some(count), boundary[key].as_u64(), "{boundary}, {distance}");
            }
        }
    }
}

/// Against a Taylor series with 66 digits, over the whole range of κ, ψ and a.
#[test]
fn damped_contacts_with_25_digits() {
    let cases = file("contacts_series")["cases"].as_array().expect("an array").clone();
    let mut count = 0;
    for case in cases {
        let [kappa, psi, damping] = [0, 1, 2].map(|column| case[column].as_f64().unwrap());
        if damping == 0.0 {
            continue;
        }
        count += 1;
        let [eps_t, eps_n, contact_time] = [4, 5, 6].map(|column| number(&case[column]));
        let found = exact(Contact::new(kappa, psi, damping).unwrap());
        assert_eq!(case[3], found.itinerary(), "{case}");
        assert!((found.eps_t() - eps_t).abs() < 2e-15 * (1.0 + kappa.sqrt()), "{case}");
        assert!((found.eps_n / eps_n - 1.0).abs() < 1e-15, "{case}");
        assert!((found.contact_time / contact_time - 1.0).abs() < 1e-15, "{case}");
        let left = found.energy.tangential_unbalanced() / found.energy.tangential_initial;
        assert!(left.abs() < 1e-13 * (1.0 + kappa.sqrt()), "{case}: {left}");
    }
    assert_eq!(count, 2000);
}

/// The normal motion is tabulated on intervals of √a, and changes its units at a = 1.
#[test]
fn nothing_jumps_where_intervals_of_the_damping_meet() {
    for octave in 0..9 {
        for quarter in 0..4 {
            let root = 0.25 * f64::from(1 << octave) * (1.0 + 0.25 * f64::from(quarter));
            for (kappa, psi) in [(0.9, 0.4), (18.0, 1.0), (400.0, 0.03)] {
                let at = |damping: f64| exact(Contact::new(kappa, psi, damping).unwrap());
                let edge = (root * root).min(1e4);
                let [below, above] = [at(edge.next_down().next_down()), at(edge)];
                assert_eq!(below.itinerary(), above.itinerary(), "{edge}");
                for (one, other) in [
                    (below.eps_t(), above.eps_t()),
                    (below.eps_n, above.eps_n),
                    (below.contact_time, above.contact_time),
                ] {
                    assert!((one - other).abs() < 3e-14, "a = {edge}, κ = {kappa}: {one} {other}");
                }
            }
        }
    }
}

/// A damping of nothing is no damping: a contact that sticks for an instant at its start.
#[test]
fn the_weakest_damping_is_none() {
    for (kappa, psi) in [(0.3, 0.5), (1.2, 1.0), (18.0, 0.4), (63.0, 0.5), (1e4, 1.7)] {
        let none = exact(Contact::new(kappa, psi, 0.0).unwrap());
        let weak = exact(Contact::new(kappa, psi, 1e-60).unwrap());
        assert_eq!(weak.itinerary(), format!("o{}", none.itinerary()));
        assert!((weak.eps_t() - none.eps_t()).abs() < 1e-14 * (1.0 + kappa.sqrt()), "{kappa}");
        assert!((weak.contact_time - none.contact_time).abs() < 1e-15 && weak.eps_n == 1.0);
    }
}

/// Under a weak damping the first slip begins at √t = 2a/(κψ + √(κ²ψ² − 4a)) if κψ > 2√a, and else
/// the contact sticks on.
#[test]
fn the_first_slip_under_the_weakest_damping() {
    for damping in [1e-60, 1e-40, 1e-20, 1e-18, 1e-16, 1e-12, 1e-10] {
        for part in [-1.0_f64, -1e-5, 1e-5, 1.0] {
            let kappa = 2.0 * f64::sqrt(damping);
            let psi = 1.0 + 0.5 * part;
            let found = exact(Contact::new(kappa, psi, damping).unwrap());
            if part < 0.0 {
                assert_eq!(found.itinerary(), "o+", "{damping:e} {psi}");
                continue;
            }
            assert_eq!(found.itinerary(), "o+o+", "{damping:e} {psi}");
            let pull = kappa * psi;
            let root = 2.0 * damping / (pull + (pull * pull - 4.0 * damping).sqrt());
            let off = found.switches[0].time / (root * root) - 1.0;
            // The motion up to then changes the limit by parts of a and of √a κ.
            assert!(
                off.abs() < 1e-9 + 1e4 * damping.sqrt().min(1e-12),
                "{damping:e} {psi}: {off:e}"
            );
        }
    }
}

/// The last half swing of the first stick phase ends with the contact, within rounding, and the
/// exact solution has the result of the integration.
#[test]
fn contacts_whose_first_swing_ends_with_them() {
    for damping in [1e-4, 0.019, 0.16, 0.37, 0.588, 0.613, 1.3, 7.0, 200.0] {
        let contact_time = exact(Contact::new(1.0, 1.0, damping).unwrap()).contact_time;
        for half_swings in 1..=12_u32 {
            let kappa = (f64::from(half_swings) * PI / contact_time).powi(2);
            for part in [0.03, 0.4, 0.98, 1.02] {
                let psi = part * 2.0 * damping.sqrt() / kappa;
                let at = |kappa| Contact::new(kappa, psi, damping).unwrap();
                let integrated = Collider::default().collide(at(kappa)).unwrap();
                for ulps in -3..=3_i64 {
                    let kappa = f64::from_bits(kappa.to_bits().wrapping_add_signed(ulps));
                    let found = exact(at(kappa));
                    let off = (found.eps_t() - integrated.eps_t()).abs();
                    assert!(off < 2e-11, "{kappa:?} {psi:?} {damping:?}: {off:e}");
                }
            }
        }
    }
}
