//! Enclosures of formulas against their values at places.

use stickslip_solver::{Enclosure, Interval, Number};

/// A formula with everything that a number can do.
fn formula<T: Number>(x: T, kind: usize) -> T {
    match kind {
        0 => (x * 3.0).sin() * x.exp() - x.powi(3) / (x * x + 2.0),
        1 => (x * x + 0.5).sqrt() + (x + 4.0).ln().tanh(),
        2 => (x * 0.3).asin() + x.atan() * (x * 0.2).acos(),
        3 => (x * 0.4).tan() + x.sinh() * x.cosh() - (x + 5.0).powf(1.7),
        4 => (x * 2.0).cos().max(x).min(T::from(0.7)),
        5 => (x - 0.3).abs() * x + (x * 4.0).floor(),
        _ => (x - 0.2).select(x * x, -x) - 0.1,
    }
}

/// Values and difference quotients of any two places of an interval are enclosed.
#[test]
fn formulas_are_enclosed() {
    let mut random = fastrand::Rng::with_seed(2);
    for kind in 0..7 {
        for _ in 0..5000 {
            let (middle, radius) = (2.0 * random.f64() - 1.0, 10_f64.powf(-4.0 * random.f64()));
            let range = Interval::new(middle - radius, middle + radius);
            let found = formula(Enclosure::variable(range), kind);
            let [a, b] = [(); 2].map(|()| middle + radius * (2.0 * random.f64() - 1.0));
            let (at_a, at_b) = (formula(a, kind), formula(b, kind));
            assert!(found.value.contains(at_a) && found.value.contains(at_b));
            let slope = (at_a - at_b) / (a - b);
            let slack = 1e-13 / (a - b).abs();
            let inside = Interval::around(slope, slack);
            assert!(
                (a - b).abs() < 1e-9
                    || found.slope.hull(inside) == found.slope
                    || found.slope.lower() <= slope + slack && found.slope.upper() >= slope - slack,
                "{kind} {range:?} {found:?} {slope}"
            );
            let c = 0.5 * (a + b);
            let bend = 4.0 * (at_a - 2.0 * formula(c, kind) + at_b) / (a - b).powi(2);
            let slack = 1e-12 / (a - b).powi(2);
            assert!(
                (a - b).abs() < 1e-4
                    || found.bend.lower() <= bend + slack && found.bend.upper() >= bend - slack,
                "{kind} {range:?} {found:?} {bend}"
            );
        }
    }
}

/// A narrow enclosure of a smooth formula has the derivatives to many digits.
#[test]
fn enclosures_are_tight() {
    for kind in 0..4 {
        let found = formula(Enclosure::variable(Interval::point(0.37)), kind);
        for part in [found.value, found.slope, found.bend] {
            assert!(part.width() < 1e-12, "{kind} {found:?}");
        }
    }
}
