//! Fits of what nobody should ask for: an answer or an error, and never a wrong one.

use std::f64::consts::FRAC_PI_2;

use stickslip_model::Law;
use stickslip_plane::{Range, progress::SILENT};
use stickslip_practice::fit::{
    self, Datum, FitError, FitSettings, FittedBodies, Free, Measured, Survey, Values,
};

use crate::oblique;

const VALUES: Values = Values { kappa: 6.0, mu: 0.2, tangential_damping: 0.0, damping: 0.0 };

fn bodies(law: Law) -> FittedBodies {
    FittedBodies::scaled(law, 2.0 / 7.0, &VALUES).unwrap()
}

fn datum(angle_deg: f64, value: f64, error: Option<f64>) -> Datum {
    Datum::at_angle(angle_deg.to_radians(), 1.0, Measured::EpsT, value, error)
}

fn refused(settings: &FitSettings) -> FitError {
    fit::run(settings, SILENT).expect_err("settings that are refused")
}

/// Whether the error is about a value whose name starts so.
fn names(error: &FitError, name: &str) -> bool {
    matches!(error, FitError::Value(invalid) if invalid.name.starts_with(name))
}

fn settings(data: Vec<Datum>) -> FitSettings {
    let mut settings = FitSettings::new(bodies(Law::PAPER), data);
    settings.ranges.kappa = Range { low: 1.0, high: 10.0 };
    settings
}

#[test]
fn bad_data_are_refused() {
    let message = |settings: &FitSettings| refused(settings).to_string();
    assert_eq!(message(&settings(vec![])), "0 data; expected 1 to 10000");
    let one = settings(vec![datum(30.0, 0.1, Some(0.1))]);
    let few = "1 data of the tangential motion for 2 free numbers; expected at least as many data";
    assert_eq!(message(&one), few);
    for (value, error) in [
        (f64::NAN, None),
        (f64::INFINITY, None),
        // Squares of these are no numbers.
        (1e300, None),
        (0.1, Some(1e-300)),
        (0.1, Some(0.0)),
        (0.1, Some(-1.0)),
        (0.1, Some(f64::NAN)),
        (0.1, Some(f64::INFINITY)),
    ] {
        let bad = settings(vec![datum(30.0, value, error), datum(40.0, 0.1, error)]);
        let invalid = refused(&bad);
        assert!(names(&invalid, "row "), "{value} {error:?}: {invalid:?}");
    }
    for angle in [90.0, 91.0, 0.0, -5.0, f64::NAN] {
        let bad = settings(vec![datum(angle, 0.1, None), datum(40.0, 0.1, None)]);
        // The cosine of a right angle is not quite 0: then there is an impact.
        if (angle.to_radians() - FRAC_PI_2).abs() > 1e-9 {
            assert!(names(&refused(&bad), "row "), "{angle}");
        }
    }
}

#[test]
fn bad_questions_are_refused() {
    let data = vec![datum(30.0, 0.1, None), datum(40.0, 0.1, None), datum(50.0, 0.1, None)];
    let with = |change: &dyn Fn(&mut FitSettings)| {
        let mut settings = settings(data.clone());
        change(&mut settings);
        refused(&settings)
    };
    let twice = with(&|it| it.free = vec![Free::Mu, Free::Mu]);
    assert_eq!(twice.to_string(), "mu is free twice; expected different names");
    let begins = |error: FitError, text: &str| {
        assert!(error.to_string().starts_with(text), "{error}");
    };
    begins(with(&|it| it.free = vec![]), "0 free numbers besides the damping");
    let three = vec![Free::Kappa, Free::Mu, Free::TangentialDamping];
    begins(with(&|it| it.free = three.clone()), "3 free numbers besides the damping");
    for range in [(0.0, 1.0), (2.0, 1.0), (1.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        let invalid = with(&|it| it.ranges.mu = Range { low: range.0, high: range.1 });
        assert!(names(&invalid, "the range"), "{range:?}: {invalid}");
    }
    assert!(names(&with(&|it| it.level = 1.0), "level"));
    assert!(names(&with(&|it| it.eps_n = Some(1.1)), "eps_n"));
    let undamped = with(&|it| it.free = vec![Free::Kappa, Free::TangentialDamping]);
    begins(undamped, "tangential_damping is free, but has no effect without damping");
    let law = oblique::law("yade/FrictPhys_CundallStrack");
    let damping = with(&|it| {
        it.bodies = bodies(law);
        it.eps_n = Some(0.9);
    });
    assert!(names(&damping, "eps_n"), "{damping:?}");
    let endless = with(&|it| {
        it.bodies = bodies(oblique::law("gran/hooke/history"));
        it.free = vec![Free::Damping, Free::Mu];
        it.ranges.damping.high = 2.0;
    });
    begins(endless, "damping up to 2.0 has contacts that never end");
}

/// As many data as free numbers without errors: there is a fit, but nothing to tell intervals from.
#[test]
fn no_intervals_without_a_degree_of_freedom() {
    let angles = [10.0_f64, 30.0].map(f64::to_radians);
    let values = fit::predicted(&bodies(Law::PAPER), 1.0, Measured::EpsT, &angles).unwrap();
    let data = vec![datum(10.0, values[0], None), datum(30.0, values[1], None)];
    let found = Survey::new(&settings(data), SILENT).unwrap().fit().unwrap();
    assert!(found.minima[0].misfit < 1e-12, "{:?}", found.minima);
    assert_eq!((found.threshold, &found.intervals[0].pieces), (None, &None));
}

/// Errors so large that the data say nothing: the intervals are the whole ranges, and say so.
#[test]
fn huge_errors_leave_everything_open() {
    let data = [10.0, 20.0, 30.0].map(|angle| datum(angle, 0.0, Some(1e6)));
    let found = Survey::new(&settings(data.to_vec()), SILENT).unwrap().fit().unwrap();
    for (interval, (low, high)) in found.intervals.iter().zip([(1.0, 10.0), (0.01, 2.0)]) {
        let [piece] = &interval.pieces.as_ref().unwrap()[..] else { panic!("{interval:?}") };
        assert!((piece.low / low - 1.0).abs() < 1e-12 && (piece.high / high - 1.0).abs() < 1e-12);
        assert!(piece.from_end_of_range && piece.to_end_of_range);
    }
}

/// Sliding at all angles: the data do not know the stiffness, and the interval says so.
#[test]
fn sliding_alone_does_not_tell_the_stiffness() {
    let values = Values { mu: 0.02, ..VALUES };
    let slippery = FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &values).unwrap();
    let angles = [50.0_f64, 60.0, 70.0].map(f64::to_radians);
    let predicted = fit::predicted(&slippery, 1.0, Measured::EpsT, &angles).unwrap();
    let data = [50.0, 60.0, 70.0].iter().zip(predicted);
    let data: Vec<Datum> = data.map(|(angle, value)| datum(*angle, value, Some(1e-3))).collect();
    let mut settings = settings(data);
    settings.ranges.mu.high = 0.1;
    let found = Survey::new(&settings, SILENT).unwrap().fit().unwrap();
    let kappa = found.intervals[0].pieces.as_ref().unwrap();
    assert!(kappa[0].from_end_of_range && kappa[kappa.len() - 1].to_end_of_range, "{kappa:?}");
    assert_eq!(found.intervals[1].holds(0.02), Some(true));
    assert!((found.minima[0].values.mu - 0.02).abs() < 1e-6, "{:?}", found.minima[0]);
}

/// Errors far smaller than the steps of the search: intervals are not missed between its places.
#[test]
fn tiny_errors_have_tiny_intervals() {
    let angles = [8.0_f64, 15.0, 25.0, 35.0].map(f64::to_radians);
    let predicted = fit::predicted(&bodies(Law::PAPER), 1.0, Measured::EpsT, &angles).unwrap();
    let data = angles.iter().zip(predicted);
    let data = data.map(|(angle, value)| datum(angle.to_degrees(), value, Some(1e-7)));
    let found = Survey::new(&settings(data.collect()), SILENT).unwrap().fit().unwrap();
    for (interval, truth) in found.intervals.iter().zip([6.0, 0.2]) {
        let [piece] = &interval.pieces.as_ref().unwrap()[..] else { panic!("{interval:?}") };
        assert!(piece.high - piece.low < 1e-4 && interval.holds(truth) == Some(true), "{piece:?}");
    }
}

/// 12 of 15 are expected, with a standard deviation of 1.5.
#[test]
fn intervals_hold_the_truth() {
    let held = held(15);
    assert!(held.iter().all(|held| (8..=15).contains(held)), "{held:?}");
}

/// 48 of 60 are expected, with a standard deviation of 3.1.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let held = held(60);
    assert!(held.iter().all(|held| (38..=58).contains(held)), "{held:?}");
}

/// A small part of the battery of docs/validation.md: of `sets` of data with errors, how many have
/// the truth in their interval.
fn held(sets: u32) -> [usize; 2] {
    let angles = [5.0, 12.0, 20.0, 28.0, 36.0, 45.0, 60.0];
    let radians = angles.map(f64::to_radians);
    let exact = fit::predicted(&bodies(Law::PAPER), 1.0, Measured::EpsT, &radians).unwrap();
    let data = angles.iter().zip(&exact).map(|(angle, value)| datum(*angle, *value, Some(0.02)));
    let mut settings = settings(data.collect());
    settings.ranges.mu = Range { low: 0.05, high: 0.8 };
    settings.level = 0.8;
    let survey = Survey::new(&settings, SILENT).unwrap();
    let mut random = fastrand::Rng::with_seed(5);
    let mut held = [0; 2];
    for _ in 0..sets {
        let noisy: Vec<f64> =
            exact.iter().map(|value| value + 0.02 * normal(&mut random)).collect();
        let found = survey.fit_of(&noisy).unwrap();
        for (held, (interval, truth)) in held.iter_mut().zip(found.intervals.iter().zip([6.0, 0.2]))
        {
            *held += usize::from(interval.holds(truth) == Some(true));
        }
    }
    held
}

/// A normal random number, by Box and Muller.
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}
