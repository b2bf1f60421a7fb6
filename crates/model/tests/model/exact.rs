//! The exact engine against the reference data, with narrower bounds than `reference.rs` has for
//! both engines.

use crate::common::{Case, cases, file, number};
use stickslip_model::exact::{self, CONTACT_TIME};
use stickslip_model::{Collision, Contact};

fn exact(contact: Contact) -> Collision {
    exact::collide(contact).expect("an undamped collision")
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
