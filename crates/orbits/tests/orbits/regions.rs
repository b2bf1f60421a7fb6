//! Regions of orbits against closed forms.

use std::f64::consts::TAU;

use stickslip_expression::System;
use stickslip_orbits::{FollowedOrbits, Guess, OrbitAtlas, Orbits, RegionOptions};
use stickslip_tracer::{Point, Unnamed, regions::VerifyOptions};

use crate::impact::{self, Closed};
use crate::{ball, curves};

/// Few lines are enough for few curves.
fn options() -> RegionOptions {
    let usual = RegionOptions::default();
    let verify = VerifyOptions { random_points: 100, ..usual.verify };
    RegionOptions { cells: 3, verify, ..usual }
}

/// How many roots of μ² − tr μ + det are outside the unit circle.
fn outside(trace: f64, determinant: f64) -> usize {
    let root = trace * trace / 4.0 - determinant;
    if root < 0.0 {
        return if determinant > 1.0 { 2 } else { 0 };
    }
    let all = [trace / 2.0 + root.sqrt(), trace / 2.0 - root.sqrt()];
    all.into_iter().filter(|it| it.abs() > 1.0).count()
}

/// Compares an atlas with a closed form at random points.
fn compare(atlas: &OrbitAtlas, count: usize, least: usize, closed: impl Fn(Point) -> Vec<usize>) {
    let window = *atlas.plane.window();
    for curve in atlas.plane.curves() {
        let [first, last] = [&curve.nodes[0], &curve.nodes[curve.nodes.len() - 1]];
        let [first, last] = [first, last].map(|it| [it.point.x, it.point.y]);
        let count = curve.nodes.len();
        println!("{:?} {:?} {count} {first:?} {last:?}", curve.margin, curve.sides);
    }
    println!("{:?}", atlas.plane.findings());
    println!("{}", format!("{:?}", atlas.doubts(&Unnamed)).chars().take(2000).collect::<String>());
    assert!(atlas.agrees(), "{:?}", atlas.objection());
    let mut random = fastrand::Rng::with_seed(54);
    let mut seen: Vec<(FollowedOrbits, usize)> = Vec::new();
    for _ in 0..count {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + part.component_mul(&window.extent());
        let Some(label) = atlas.label(&point) else { panic!("{point:?} has no label") };
        let mut exact = closed(point);
        exact.sort_unstable();
        assert_eq!(label.0, exact, "{point:?}");
        match seen.iter_mut().find(|(own, _)| own == label) {
            Some((_, count)) => *count += 1,
            None => seen.push((label.clone(), 1)),
        }
    }
    println!("{seen:?}");
    assert!(seen.len() >= least, "{seen:?}");
}

/// Beside w = 0.99875, where the fold meets the graze.
#[test]
fn an_impact_oscillator_has_its_regions() {
    impacts(Closed { w: 0.97, a: 0.12, ..Closed::EXAMPLE }, [[0.96, 1.04], [0.06, 0.2]], 200);
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn an_impact_oscillator_has_regions_in_a_large_window() {
    impacts(Closed { w: 0.8, a: 0.5, ..Closed::EXAMPLE }, [[0.7, 1.1], [0.05, 0.6]], 500);
}

/// Compares the regions over frequency and amplitude with the closed form at random points.
fn impacts(closed: Closed, window: [[f64; 2]; 2], count: usize) {
    let orbits = impact::orbits();
    let orbit = impact::near(&orbits, &closed, closed.speeds()[0], 1e-6).expect("an orbit");
    let verify = VerifyOptions { random_points: 50, near_points: 1, ..options().verify };
    let options = RegionOptions { cells: 2, verify, ..options() };
    let atlas = orbits.regions(&orbit, [4, 3], window, &options).expect("it");
    compare(&atlas, count, 3, |point| {
        let own = Closed { w: point.x, a: point.y, ..closed };
        let speeds = own.speeds().into_iter().filter(|v| *v > 0.0 && own.room(*v) > 0.0);
        speeds.map(|v| outside(own.trace(v), own.determinant())).collect()
    });
}

#[test]
fn a_ball_has_its_regions() {
    let orbits = Orbits::new(&System::parse(ball::TEXT).expect("a system")).expect("orbits");
    let itinerary = ["period", "bounce"];
    let (time, state) = (Some(0.13), Some(&[0.0144, 0.5][..]));
    let guess = Guess { time, state, itinerary: &itinerary, ..Guess::default() };
    let orbit = orbits.find(&[0.02, TAU, 0.7], &guess).expect("an orbit");
    let window = [[0.005, 0.05], [0.5, 0.9]];
    let atlas = orbits.regions(&orbit, [0, 2], window, &options()).expect("it");
    compare(&atlas, 500, 3, |point| {
        let (a, r, w) = (point.x, point.y, TAU);
        let cos = (1.0 - r) / (2.0 * (1.0 + r) * a * w);
        let sine = (1.0 - cos * cos).sqrt();
        let both = [sine, -sine].into_iter().filter(|it| it.is_finite());
        let real = both.filter(|sine| {
            let phase = sine.atan2(cos);
            let height = |t: f64| a * sine + 0.5 * t - t * t / 2.0 - a * (w * t + phase).sin();
            (1..20_000).all(|k| height(f64::from(k) / 20_000.0) > -1e-13)
        });
        let trace = |sine: f64| 1.0 + r * r - (1.0 + r) * (1.0 + r) * a * w * w * sine;
        real.map(|sine| outside(trace(sine), r * r)).collect()
    });
}

/// The regions of a text over its first two parameters.
fn planted(text: &str, itinerary: &[&str], window: [[f64; 2]; 2]) -> OrbitAtlas {
    let system = System::parse(text).expect("a system");
    let orbits = Orbits::new(&system).expect("orbits");
    let guess = Guess { itinerary, ..Guess::default() };
    let orbit = orbits.find(&system.values(), &guess).expect("an orbit");
    orbits.regions(&orbit, [0, 1], window, &options()).expect("regions")
}

#[test]
fn grazes_that_cross_bound_a_corner() {
    let atlas = planted(curves::TWO_TOUCHES, &["phase"], [[0.5, 1.5], [0.6, 1.3]]);
    compare(
        &atlas,
        300,
        2,
        |point| {
            if point.x < 1.0 && point.y < 1.0 { vec![0] } else { Vec::new() }
        },
    );
    assert_eq!(atlas.plane.curves().len(), 2);
}

#[test]
fn three_orbits_in_a_cusp() {
    let atlas = planted(curves::CUSP, &["up", "down"], [[-0.9, 0.9], [-0.6, 1.4]]);
    compare(&atlas, 300, 2, |point| {
        let inside = 4.0 * point.y.powi(3) > 27.0 * point.x * point.x;
        if inside { vec![0, 0, 1] } else { vec![0] }
    });
}
