//! Observed orders in fixed steps, through all switches of a collision.
//!
//! In the regularised coordinates both methods keep their order; in plain time the power 3/2 of the contact law takes it
//! down to about 2.5, which is why the regularised coordinates exist.

use stickslip::model::plain_time::{self, PlainTime};
use stickslip::model::{Collider, Contact, exact};
use stickslip::solver::{Dop853, Dopri5, Method, Options, Start, StepSize, run};

/// Collisions with two to eight switches: their errors together show the order, where that of a single one passes
/// through zero now and then.
fn contacts() -> impl Iterator<Item = Contact> {
    (0..60).map(|i| {
        let (kappa, psi) = (8.0 + f64::from(i), 0.3 + 0.02 * f64::from(i % 12));
        Contact::new(kappa, psi, 0.0).expect("valid")
    })
}

fn fixed(h: f64) -> Options {
    Options { step_size: StepSize::Fixed(h), ..Options::default() }
}

/// Order by least squares through (log h, log error).
fn fitted_order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(h, error)| (h.ln(), error.ln())).collect();
    let mean = logs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let products = logs.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum::<f64>();
    products / logs.iter().map(|p| (p.0 - mean.0).powi(2)).sum::<f64>()
}

/// Root mean square errors of the final velocity for step sizes between `coarse` and `fine`.
fn order(coarse: f64, fine: f64, velocity: impl Fn(Contact, f64) -> f64) -> f64 {
    let count = 12;
    let points: Vec<(f64, f64)> = (0..count)
        .map(|i| {
            let h = coarse * (fine / coarse).powf(f64::from(i) / f64::from(count - 1));
            let squares = contacts().map(|contact| {
                let expected = exact::collide(contact).expect("no damping").final_velocity;
                (velocity(contact, h) - expected).powi(2)
            });
            (h, squares.sum::<f64>().sqrt())
        })
        .collect();
    fitted_order(&points)
}

fn regularized<M: Method>(method: M, coarse: f64, fine: f64) -> f64 {
    let velocity = |contact, h| {
        let collision = Collider::unrefined(method, fixed(h)).collide(contact);
        let collision = collision.expect("a collision");
        let expected = exact::collide(contact).expect("no damping").itinerary();
        assert_eq!(collision.itinerary(), expected, "{contact:?}, {h}");
        collision.final_velocity
    };
    order(coarse, fine, velocity)
}

fn plain<M: Method>(method: M, coarse: f64, fine: f64) -> f64 {
    order(coarse, fine, |contact, h| {
        let system = PlainTime::new(contact);
        let start = Start { mode: system.first(), s: 0.0, state: system.start() };
        let end = run(method, &system, start, 10.0, &fixed(h), &mut ()).expect("a run");
        end.state[plain_time::W]
    })
}

#[test]
fn regularised_coordinates_keep_the_order() {
    let dopri5 = regularized(Dopri5, 0.006, 0.0006);
    let dop853 = regularized(Dop853, 0.025, 0.01);
    println!("dopri5 {dopri5:.3}, dop853 {dop853:.3}");
    assert!((dopri5 - 5.0).abs() < 0.1, "{dopri5}");
    assert!((dop853 - 8.0).abs() < 0.2, "{dop853}");
}

#[test]
fn plain_time_loses_it() {
    let dopri5 = plain(Dopri5, 0.04, 0.001);
    let dop853 = plain(Dop853, 0.04, 0.001);
    println!("dopri5 {dopri5:.3}, dop853 {dop853:.3}");
    for order in [dopri5, dop853] {
        assert!((2.2..2.8).contains(&order), "{order}");
    }
}
