//! The collision whose spring is not reset, compared with the law in plain time.

use stickslip_model::{Collider, Contact};
use stickslip_studies::unreset::{UnresetCollision, collide};

fn collision(kappa: f64, psi: f64, damping: f64) -> UnresetCollision {
    collide(Contact::new(kappa, psi, damping).unwrap()).unwrap()
}

/// The law of (9) and (10) in plain time, integrated by the classical Runge–Kutta method in
/// small fixed steps.
fn in_plain_time(kappa: f64, psi: f64, damping: f64) -> (f64, f64, usize) {
    let force = |x: f64, v: f64| (x.max(0.0).sqrt() * (x.max(0.0) + damping * v)).max(0.0);
    let field = |[x, v, y, w]: [f64; 4]| {
        let limit = force(x, v);
        [v, -limit, w, -y.signum() * limit.min(kappa * y.abs())]
    };
    let mut state = [0.0, 1.0, 0.0, psi];
    let (mut largest, mut reversals) = (0.0_f64, 0);
    let h = 1e-5;
    loop {
        let moved = |k: [f64; 4], part: f64| std::array::from_fn(|i| state[i] + part * h * k[i]);
        let k1 = field(state);
        let k2 = field(moved(k1, 0.5));
        let k3 = field(moved(k2, 0.5));
        let k4 = field(moved(k3, 1.0));
        let next: [f64; 4] = std::array::from_fn(|i| {
            state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])
        });
        reversals += usize::from((next[3] < 0.0) != (state[3] < 0.0));
        state = next;
        largest = largest.max(state[2].abs());
        if state[0] <= 0.0 || (state[1] < 0.0 && force(state[0], state[1]) <= 0.0) {
            return (state[3], largest, reversals);
        }
    }
}

/// The largest differences are 3e-11 in w and 6e-6 in y; the latter is part of a step at the
/// end.
#[test]
fn obeys_the_law_in_plain_time() {
    for (kappa, psi, damping) in
        [(18.0, 1.0, 0.0), (18.0, 0.3, 0.0), (63.0, 0.7, 0.2), (0.4, 1.5, 0.0), (5.0, 0.2, 1.0)]
    {
        let UnresetCollision { collision, largest_spring } = collision(kappa, psi, damping);
        let (velocity, largest, reversals) = in_plain_time(kappa, psi, damping);
        assert!((collision.final_velocity - velocity).abs() < 6e-11, "{kappa} {psi} {damping}");
        assert!((largest_spring - largest).abs() < 1e-5, "{kappa} {psi} {damping}");
        assert_eq!(collision.reversals, reversals);
        assert!(collision.energy.tangential_unbalanced().abs() < 5e-14);
        assert!(collision.energy.normal_unbalanced().abs() < 1e-12);
    }
}

#[test]
fn the_spring_is_at_the_limit_where_it_switches_and_beyond_it_in_slip() {
    let UnresetCollision { collision, largest_spring } = collision(18.0, 0.3, 0.0);
    assert!(collision.switches.len() >= 2, "{}", collision.itinerary());
    let limit = stickslip_model::limits::largest::FORCE / 18.0;
    assert!(collision.switches.iter().all(|switch| switch.spring.abs() <= limit));
    assert!(largest_spring < 0.3 * collision.contact_time);
    assert!(self::collision(18.0, 1.5, 0.0).largest_spring > 10.0 * limit);
}

#[test]
fn the_normal_motion_is_that_of_the_reset_spring() {
    let contact = Contact::new(18.0, 0.4, 0.3).unwrap();
    let reset = Collider::default().collide(contact).unwrap();
    let unreset = collide(contact).unwrap().collision;
    assert!((reset.eps_n - unreset.eps_n).abs() < 1e-12);
    assert!((reset.contact_time - unreset.contact_time).abs() < 1e-12);
}
