//! The course of a collision in time.

use std::f64::consts::PI;

use stickslip_model::history::{History, Snapshot};
use stickslip_model::limits::largest;
use stickslip_model::{
    Collider, Collision, CollisionError, Contact, Engine, Regime, Tolerances, exact,
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
fn the_course_of_the_exact_engine_is_that_of_the_integrator() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut moments = 0;
    for case in 0..120 {
        let mut uniform = |low: f64, high: f64| low + (high - low) * random.f64();
        let (kappa, psi) = (10.0_f64.powf(uniform(-2.0, 3.0)), uniform(0.01, 3.0));
        let damping = if case % 2 == 0 { 0.0 } else { 10.0_f64.powf(uniform(-4.0, 1.0)) };
        let contact = Contact::new(kappa, psi, damping).unwrap();
        let (collision, _, exact) = Engine::Auto.followed(contact).unwrap();
        let integrated = Collider::default().history(contact).unwrap();
        assert!((exact.duration() / integrated.duration() - 1.0).abs() < 1e-11);
        // Switches are those of the collision, and what ends there is what begins.
        let times: Vec<_> = exact.phases().skip(1).map(|phase| phase.begin().time).collect();
        assert_eq!(times, collision.switches.iter().map(|it| it.time).collect::<Vec<_>>());
        let spring = 1e-10 / kappa.min(kappa.sqrt());
        let same = |one: Snapshot, other: Snapshot| {
            for (one, other, error) in [
                (one.compression, other.compression, 1e-10),
                (one.normal_velocity, other.normal_velocity, 1e-10),
                (one.normal_force, other.normal_force, 1e-10),
                (one.spring, other.spring, spring),
                (one.tangential_force, other.tangential_force, kappa * spring),
                (one.velocity, other.velocity, 1e-10),
            ] {
                assert!((one - other).abs() < error, "{contact:?} {one} {other}");
            }
        };
        let phases: Vec<_> = exact.phases().collect();
        for pair in phases.windows(2) {
            same(pair[0].end(), pair[1].begin());
        }
        let last = phases[phases.len() - 1].end();
        assert!((last.velocity - collision.final_velocity).abs() < 1e-13, "{contact:?}");
        if exact.phases().len() == integrated.phases().len() {
            for index in 0..=40 {
                let time = exact.duration() * (f64::from(index) / 40.0);
                // The integrator's end may be a rounding before.
                let Some(other) = integrated.at(time) else { continue };
                same(exact.at(time).unwrap(), other);
                moments += 1;
            }
        }
        for phase in exact.phases() {
            let samples: Vec<_> = phase.samples(9).collect();
            assert!(samples.len() == 10 || phase.begin().time == phase.end().time);
            assert!(samples.is_sorted_by(|one, next| one.time <= next.time));
        }
    }
    assert!(moments > 100 * 41, "{moments}");
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

/// Time from the start of contact to the moment at which v = cos θ, without damping: u⁵ is
/// (5/4) sin²θ, so that dt = (4/5) (5/4)^{2/5} sin^{−1/5} θ dθ, and with θ = τ⁵ the integrand is
/// smooth. Gauss' rule with three nodes on two hundred pieces has an error below 1e-13.
fn time_at(angle: f64) -> f64 {
    const PIECES: u32 = 200;
    let first = angle.min(PI - angle);
    let width = first.powf(0.2) / f64::from(PIECES);
    let rate = |tau: f64| {
        let angle = tau.powi(5);
        5.0 * tau.powi(3) * (angle / angle.sin()).powf(0.2)
    };
    let sum: f64 = (0..PIECES)
        .map(|piece| {
            let middle = (f64::from(piece) + 0.5) * width;
            let off = 0.5 * width * 0.6_f64.sqrt();
            5.0 * rate(middle - off) + 8.0 * rate(middle) + 5.0 * rate(middle + off)
        })
        .sum();
    let time = 0.8 * 1.25_f64.powf(0.4) * width / 18.0 * sum;
    if angle == first { time } else { exact::CONTACT_TIME - time }
}

/// v without damping at a time.
fn rate_at(time: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if time_at(middle) < time { low = middle } else { high = middle }
    }
    low.cos()
}

/// The closed form without damping where v = cos `angle`, at this `time`: compression, rate of the
/// compression, spring and tangential velocity. `rates` are v at the switches.
fn closed_form(collision: &Collision, rates: &[f64], (angle, time): (f64, f64)) -> [f64; 4] {
    let (u, v) = ((1.25 * angle.sin().powi(2)).powf(0.2), angle.cos());
    let kappa = collision.contact.kappa();
    let passed = collision.switches.partition_point(|switch| switch.time <= time);
    let Some(last) = passed.checked_sub(1) else {
        return [u * u, v, u * u * u / kappa, collision.contact.psi() + (v - 1.0)];
    };
    let (switch, w) = (&collision.switches[last], collision.switches[last].velocity);
    if switch.to == Regime::Slip {
        let side = switch.side.sign();
        return [u * u, v, side * u * u * u / kappa, w + side * (v - rates[last])];
    }
    let (omega, y) = (kappa.sqrt(), switch.spring);
    let (sin, cos) = (omega * (time - switch.time)).sin_cos();
    [u * u, v, y * cos + w / omega * sin, w * cos - y * omega * sin]
}

#[test]
fn integrated_histories_follow_the_closed_form() {
    assert!((time_at(0.5 * PI) - 0.5 * exact::CONTACT_TIME).abs() < 1e-13);
    let places: Vec<_> = (1..1500).map(|i| PI * f64::from(i) / 1500.0).collect();
    let places: Vec<_> = places.into_iter().map(|angle| (angle, time_at(angle))).collect();
    let mut largest = [0.0_f64; 4];
    for kappa in [0.02, 0.3, 18.0, 63.0, 1e4] {
        for psi in [0.01, 0.4, 1.3, 3.0] {
            let contact = Contact::new(kappa, psi, 0.0).unwrap();
            let collision = exact::collide(contact).unwrap();
            let rates: Vec<_> = collision.switches.iter().map(|it| rate_at(it.time)).collect();
            let history = Collider::default().history(contact).unwrap();
            let scales = [1.0, 1.0, kappa.min(kappa.sqrt()), 1.0];
            for &place in &places {
                let at = history.at(place.1).unwrap();
                let integrated = [at.compression, at.normal_velocity, at.spring, at.velocity];
                let closed = closed_form(&collision, &rates, place);
                for j in 0..4 {
                    largest[j] = largest[j].max((integrated[j] - closed[j]).abs() * scales[j]);
                }
            }
        }
    }
    // Measured: 5.6e-12, 2.4e-12, 2.6e-12, 1.8e-12.
    let limits = [1e-11, 4e-12, 4e-12, 4e-12];
    assert!(largest.iter().zip(limits).all(|(&error, limit)| error < limit), "{largest:?}");
}
