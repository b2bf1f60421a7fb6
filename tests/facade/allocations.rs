//! A collision allocates nothing.

use std::error::Error;
use std::hint::black_box;

use crate::common::cases;
use allocation_counter::measure;
use stickslip::model::regularized::{END, Phase, Regularized};
use stickslip::model::spheres::{Encounter, Material, Motion, Sphere, Surface, Vector3};
use stickslip::model::{Collider, Collision, Contact, FEW_SWITCHES, exact};
use stickslip::solver::{Dop853, Dopri5, Options, Outcome, Start, run};

const UNDAMPED: [&str; 3] = ["undamped_random", "undamped_paper", "undamped_hard"];

#[test]
fn the_counter_counts() {
    assert_eq!(measure(|| drop(black_box(vec![1.0]))).count_total, 1);
    // More switches than a collision has room for.
    let contact = Contact::new(1e4, 1.0, 0.0).expect("valid");
    assert!(measure(|| drop(black_box(Collider::default().collide(contact)))).count_total > 0);
    assert!(measure(|| drop(black_box(exact::collide(contact)))).count_total > 0);
}

/// Collides the reference contacts that have few switches, and compares the results: w to `error`.
fn collisions_allocate_nothing<E: Error>(
    names: &[&str],
    error: f64,
    collide: impl Fn(Contact) -> Result<Collision, E>,
) {
    let (mut compared, mut most) = (0, 0);
    for case in names.iter().flat_map(|name| cases(name)) {
        let (contact, count) = (case.contact, case.switches().len());
        if count > FEW_SWITCHES {
            continue;
        }
        let mut collision = None;
        let counted = measure(|| {
            collision = Some(collide(contact).unwrap_or_else(|e| panic!("{contact:?}: {e}")));
        });
        assert_eq!(counted.count_total, 0, "{contact:?}");
        let collision = collision.expect("a collision");
        assert!((collision.final_velocity - case.number("w_final")).abs() < error, "{contact:?}");
        assert!(error > 1e-9 || case.same_itinerary(&collision), "{contact:?}");
        compared += 1;
        most = most.max(count);
    }
    assert!(compared > 280 && most > 12, "{compared} {most}");
}

/// Those close to a graze, which are computed twice, included.
#[test]
fn integrated_collisions_allocate_nothing() {
    let names = &[&UNDAMPED[..], &["damped_random"]].concat();
    collisions_allocate_nothing(names, 1e-12, |contact| Collider::default().collide(contact));
    let names = &["undamped_random", "undamped_paper", "damped_random"];
    let collider = Collider::with_tolerances(Dopri5, 1e-9, 1e-9);
    collisions_allocate_nothing(names, 1e-8, |contact| collider.collide(contact));
}

#[test]
fn exact_collisions_allocate_nothing() {
    collisions_allocate_nothing(&UNDAMPED, 1e-12, exact::collide);
}

/// From two spheres in SI units to their motions after the impact.
#[test]
fn encounters_allocate_nothing() {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 0.0 };
    let sphere = Sphere::homogeneous(0.02, &steel);
    let still = Motion {
        position_m: Vector3::zeros(),
        velocity_m_per_s: Vector3::zeros(),
        spin_rad_per_s: Vector3::zeros(),
    };
    let falling = Motion {
        position_m: Vector3::new(0.0, 0.0, 0.04),
        velocity_m_per_s: Vector3::new(4.0, 0.0, -20.0),
        ..still
    };
    let mut switches = 0;
    let counted = measure(|| {
        let encounter = Encounter::of_spheres((&sphere, &falling), (&sphere, &still), &surface)
            .expect("an encounter");
        let collision = Collider::default().collide(encounter.contact()).expect("a collision");
        switches = black_box(encounter.outcome(&collision)).switches.len();
    });
    assert!(counted.count_total == 0 && switches > 0, "{counted:?}, {switches} switches");
}

/// With any number of switches, once the memory has grown.
#[test]
fn sweeps_allocate_nothing() {
    let contact = |psi| Contact::new(1e6, psi, 0.0).expect("valid");
    let collider = Collider::default();
    let mut integrated = Collision::before(contact(1.0));
    let mut closed = integrated.clone();
    let mut sweep = |psis: &[f64]| {
        for &psi in psis {
            collider.collide_into(contact(psi), &mut integrated).expect("a collision");
            exact::collide_into(contact(psi), &mut closed).expect("a collision");
        }
        assert!(closed.switches.len() == integrated.switches.len() && closed.switches.len() > 500);
    };
    assert!(measure(|| sweep(&[1.0])).count_total > 0);
    assert_eq!(measure(|| sweep(&[0.97, 0.98, 1.0])).count_total, 0);
}

/// ε_t and the number of switches alone need no list at all.
#[test]
fn runs_allocate_nothing() {
    for (kappa, damping) in [(63.0, 0.0), (63.0, 0.1), (1e4, 0.0), (1e6, 0.0)] {
        let contact = Contact::new(kappa, 1.0, damping).expect("valid");
        let (mut eps_t, mut count) = (f64::NAN, 0);
        let counted = measure(|| {
            let system = Regularized::new(contact);
            let start = Start { mode: Phase::first(&contact), s: 0.0, state: system.start() };
            let options = Options { rtol: 4e-13, atol: 4e-13, max_step: 0.1, ..Options::default() };
            let end = run(Dop853, &system, start, f64::INFINITY, &options, &mut ()).expect("a run");
            assert_eq!(end.outcome, Outcome::EndedByGuard { guard: END });
            eps_t = system.velocity(&end.state) / contact.psi();
            count = end.statistics.switches;
        });
        assert_eq!(counted.count_total, 0, "{contact:?}");
        let collision = Collider::default().collide(contact).expect("a collision");
        assert_eq!(count, collision.switches.len());
        assert!((eps_t - collision.eps_t()).abs() < 1e-12, "{contact:?}");
    }
}
