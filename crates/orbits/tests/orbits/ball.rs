//! A ball on a table A sin ωt, whose orbits with one bounce in n periods have a closed form.

use std::f64::consts::{PI, TAU};

use stickslip_expression::System;
use stickslip_orbits::{Guess, Orbits, Verdict};

use crate::impact::impacts;

/// Time is explicit; a clock says its period.
pub const TEXT: &str = include_str!("../../../../examples/orbits/ball.slip");

#[test]
fn random_parameters_have_the_orbits_of_the_closed_form() {
    random_sets(2, 300);
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn thousand_parameters_have_the_orbits_of_the_closed_form() {
    random_sets(3, 1000);
}

/// Compares so many sets of parameters that have an orbit.
fn random_sets(seed: u64, count: usize) {
    let orbits = Orbits::new(&System::parse(TEXT).expect("a system")).expect("orbits");
    let mut random = fastrand::Rng::with_seed(seed);
    let (mut sets, mut compared, mut admissible, mut worst) = (0, 0, 0, [0.0_f64; 3]);
    while sets < count {
        let before = compared;
        let mut draw = |low: f64, high: f64| low + (high - low) * random.f64();
        let (r, w) = (draw(0.2, 0.95), draw(1.0, 10.0));
        let (n, part) = (random.usize(1..4), random.f64());
        let period = TAU * n as f64 / w;
        let fold = period * (1.0 - r) / (2.0 * (1.0 + r) * w);
        let a = fold * (1.01 + 5.0 * part);
        let cos = fold / a;
        // Both phases at which the table has the speed that a bounce needs.
        for sine in [(1.0 - cos * cos).sqrt(), -(1.0 - cos * cos).sqrt()] {
            let phase = sine.atan2(cos);
            let up = period / 2.0;
            let time = phase / w;
            // Whether the ball is above the table between two bounces.
            let height = |t: f64| a * sine + up * t - t * t / 2.0 - a * (w * t + phase).sin();
            let least = (1..40_000).map(|k| height(period * f64::from(k) / 40_000.0));
            let room = least.fold(f64::INFINITY, f64::min);
            // Near the start and the end the height is the square of a small time, or less.
            let sure = if room < 0.0 { room < -1e-9 } else { sine > 0.01 || a * w * w < 1.0 };
            if !sure {
                continue;
            }
            let state = [a * sine, up * (1.0 + 1e-5)];
            let mut itinerary = vec!["period"; n];
            itinerary.push("bounce");
            let mut durations = vec![TAU / w; itinerary.len()];
            durations[0] = PI / w - time;
            durations[itinerary.len() - 1] = PI / w + time;
            let guess = Guess {
                time: Some(time),
                state: Some(&state),
                itinerary: &itinerary,
                durations: Some(&durations),
                ..Guess::default()
            };
            let orbit = orbits.find(&[a, w, r], &guess);
            let orbit = orbit.unwrap_or_else(|error| panic!("{a} {w} {r} {n} {sine}: {error}"));
            compared += 1;
            let [one, other] = orbit.multipliers.clone().expect("no graze")[..] else {
                panic!("two multipliers")
            };
            let trace = 1.0 + r * r - (1.0 + r) * (1.0 + r) * a * w * w * sine;
            let size = orbit.largest_multiplier().max(1.0);
            for (worst, error) in worst.iter_mut().zip([
                (orbit.start - time).abs() / period,
                (one[0] + other[0] - trace).abs() / size,
                (one[0] * other[0] - one[1] * other[1] - r * r).abs() / size,
            ]) {
                *worst = worst.max(error);
            }
            match orbit.verdict {
                Verdict::Admissible => assert!(room > -1e-9, "{a} {w} {r} {n} {sine}: {room}"),
                Verdict::Virtual(_) => {
                    assert!(room < 0.0, "{a} {w} {r} {n} {sine}: {room} {orbit:?}");
                }
                Verdict::Undecided(ref reason) => panic!("{a} {w} {r} {n} {sine}: {reason}"),
            }
            // A run from the middle between two bounces, by its events alone.
            let middle = [a * sine + period * period / 8.0, 0.0];
            let half = period / 2.0;
            let times = impacts(&orbits, &[a, w, r], (time + half, &middle), period);
            let expected = time + period;
            let followed = matches!(times[..], [own] if (own - expected).abs() < 1e-6 * period);
            assert_eq!(orbit.is_admissible(), followed, "{a} {w} {r} {n} {sine}: {times:?}");
            admissible += usize::from(orbit.is_admissible());
        }
        sets += usize::from(compared > before);
    }
    println!("{sets} sets, {compared} orbits, {admissible} admissible, errors {worst:?}");
    assert!(5 * admissible > count && 10 * (compared - admissible) > count);
    assert!(worst.iter().all(|error| *error < 1e-9), "{worst:?}");
}
