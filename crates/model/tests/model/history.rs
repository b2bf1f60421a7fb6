//! The course of a collision in time.

use stickslip_model::{
    Collider, CollisionError, Contact, Engine, History, Regime, Snapshot, Tolerances, exact,
    largest,
};
use stickslip_solver::{Dop853, Options, Outcome, Statistics};

fn history(kappa: f64, psi: f64, damping: f64) -> History {
    Collider::default().history(Contact::new(kappa, psi, damping).unwrap()).unwrap()
}

/// At this distance from the switches, a difference quotient sees one law only.
const REACH: f64 = 1e-4;

#[test]
fn obeys_the_law_in_plain_time() {
    let mut quotients = 0;
    for (kappa, psi, damping) in [(63.0, 0.5, 0.0), (18.0, 1.0, 0.2), (0.3, 0.7, 1.0)] {
        let history = history(kappa, psi, damping);
        for phase in history.phases() {
            let (begin, end) = (phase.begin().time + REACH, phase.end().time - REACH);
            for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let time = begin + part * (end - begin);
                if end <= begin || time < 0.02 || time > history.duration() - 0.02 {
                    continue;
                }
                let at = |time| history.at(time).unwrap();
                let (before, now, after) = (at(time - REACH), at(time), at(time + REACH));
                assert!((now.time - time).abs() < 1e-14);
                let rate = |of: fn(&Snapshot) -> f64| (of(&after) - of(&before)) / (2.0 * REACH);
                let root = now.compression.sqrt();
                let force = root * (now.compression + damping * now.normal_velocity);
                assert!((now.normal_force - force).abs() < 1e-14);
                // The error of the quotient is REACH²/6 times the third derivative.
                assert!((rate(|s| s.compression) - now.normal_velocity).abs() < 1e-7);
                assert!((rate(|s| s.normal_velocity) + force).abs() < 1e-6);
                assert!((rate(|s| s.velocity) + kappa * now.spring).abs() < 1e-6);
                match phase.regime() {
                    Regime::Slip => {
                        let limit = phase.side().sign() * force / kappa;
                        assert!((now.spring - limit).abs() < 1e-14);
                    }
                    Regime::Stick => {
                        assert!((rate(|s| s.spring) - now.velocity).abs() < 1e-6);
                        assert!(kappa * now.spring.abs() < force);
                    }
                }
                quotients += 1;
            }
        }
    }
    assert!(quotients >= 60, "{quotients}");
}

#[test]
fn phases_meet_at_the_switches_of_the_collision() {
    for (kappa, psi, damping) in [(63.0, 0.5, 0.0), (18.0, 1.0, 0.2), (1e4, 0.4, 0.0)] {
        let history = history(kappa, psi, damping);
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let collision = Collider::default().collide(contact).unwrap();
        let phases: Vec<_> = history.phases().collect();
        assert_eq!(phases.len(), collision.switches.len() + 1);
        for (pair, switch) in phases.windows(2).zip(&collision.switches) {
            let (end, begin) = (pair[0].end(), pair[1].begin());
            assert_eq!((pair[1].regime(), pair[1].side()), (switch.to, switch.side));
            for moment in [end, begin, history.at(switch.time).unwrap()] {
                assert!((moment.time - switch.time).abs() < 1e-12);
                assert!((moment.spring - switch.spring).abs() < 1e-12);
                assert!((moment.velocity - switch.velocity).abs() < 1e-11);
            }
        }
        assert!((history.duration() - collision.contact_time).abs() < 1e-13);
        assert_eq!(history.at(0.0).unwrap().velocity, psi);
        let last = history.at(history.duration()).unwrap();
        assert!((last.velocity - collision.final_velocity).abs() < 1e-11);
    }
}

#[test]
fn a_collision_with_its_course_is_the_same_collision() {
    let mut random = fastrand::Rng::with_seed(17);
    let mut refined = 0;
    for case in 0..1500 {
        let mut uniform = |low: f64, high: f64| low + (high - low) * random.f64();
        let kappa = 10.0_f64.powf(uniform(-2.0, if case % 50 == 0 { 5.0 } else { 3.0 }));
        let psi = [uniform(0.0, 3.0), 10.0_f64.powf(uniform(-6.0, 2.0))][case % 2];
        let damping = [0.0, 0.0, 10.0_f64.powf(uniform(-6.0, 1.0))][case % 3];
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let integrator = Engine::Dop853(Tolerances::DOP853);
        for engine in [integrator, Engine::Dopri5(Tolerances::DOPRI5)] {
            let (alone, work) = engine.collide(contact).unwrap();
            let (collision, work_with_course, history) = engine.followed(contact).unwrap();
            // All digits, and the signs of zeros.
            assert_eq!(format!("{collision:?}"), format!("{alone:?}"));
            let (work, more) = (work.unwrap(), work_with_course.unwrap());
            // The course ends at every switch, to which the step is repeated.
            assert!(more.resteps >= work.resteps && more.field >= work.field);
            let Statistics { resteps, field, .. } = work;
            assert_eq!(Statistics { resteps, field, ..more }, work);
            if case % 100 == 0 {
                let course = engine.history(contact).unwrap();
                assert_eq!(format!("{history:?}"), format!("{course:?}"));
            }
        }
        let plain = Collider::deciding().collide(contact).ok();
        let collision = Collider::default().collide(contact).ok();
        refined += usize::from(format!("{plain:?}") != format!("{collision:?}"));
    }
    // Near grazes the same switches are computed once more.
    assert!(refined > 15, "{refined}");
}

#[test]
fn samples_are_in_order_and_of_the_requested_number() {
    let history = history(63.0, 0.5, 0.0);
    for phase in history.phases() {
        let samples: Vec<_> = phase.samples(12).collect();
        assert_eq!(samples.len(), 13);
        assert_eq!((samples[0], samples[12]), (phase.begin(), phase.end()));
        assert!(samples.windows(2).all(|pair| pair[0].time < pair[1].time));
        for sample in &samples[1..12] {
            let at = history.at(sample.time).unwrap();
            assert!((at.velocity - sample.velocity).abs() < 1e-12);
        }
    }
}

#[test]
fn says_when_it_has_too_many_steps() {
    let contact = Contact::new(63.0, 0.5, 0.0).unwrap();
    for max_steps in 0..60 {
        let options = Options { max_steps, ..Options::default() };
        let error = Collider::unrefined(Dop853, options).history(contact).unwrap_err();
        let CollisionError::Unfinished { outcome, time } = error else { panic!("{error}") };
        assert_eq!(outcome, Outcome::StepLimit, "{max_steps}");
        assert!((0.0..3.3).contains(&time), "{max_steps}: {time}");
    }
}

#[test]
fn nothing_is_outside_the_contact() {
    let history = history(18.0, 0.4, 0.0);
    for time in [-1e-300, history.duration() + 1e-12, f64::NAN, f64::INFINITY] {
        assert_eq!(history.at(time), None);
    }
}

#[test]
fn the_largest_elongation_is_that_of_the_course_in_time() {
    for (kappa, psi) in [(0.3, 0.5), (1.56, 1.0), (18.0, 0.3), (18.0, 0.8), (63.0, 0.1)] {
        let contact = Contact::new(kappa, psi, 0.0).unwrap();
        let largest = largest::spring(&exact::collide(contact).unwrap()).unwrap();
        let history = Collider::default().history(contact).unwrap();
        let springs = history.phases().flat_map(|phase| {
            phase.samples(2000).map(|moment| moment.spring.abs()).collect::<Vec<_>>()
        });
        let sampled = springs.fold(0.0, f64::max);
        // A sample misses a maximum by the square of its distance.
        assert!((largest / sampled - 1.0).abs() < 3e-6, "{kappa} {psi}: {largest} {sampled}");
    }
}
