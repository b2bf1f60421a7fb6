//! Roots that are planted.

use stickslip_contact::numerics::root::{Jet, bracketed};

/// (x − a)(x² + c), which counts its evaluations.
fn cubic(a: f64, c: f64, count: &mut u32) -> impl FnMut(f64) -> Jet {
    move |x| {
        *count += 1;
        Jet {
            value: (x - a) * (x * x + c),
            slope: x * x + c + 2.0 * x * (x - a),
            curvature: 6.0 * x - 2.0 * a,
        }
    }
}

#[test]
fn planted_roots_are_found_from_any_guess() {
    for a in [1e-30, 3e-9, 0.3, 0.7, 0.999_999] {
        for guess in [0.0, 0.1, 0.5, 0.999, 7.0] {
            let mut count = 0;
            let root = bracketed(1.0, 0.0, guess, cubic(a, 0.01, &mut count));
            assert!((root - a).abs() <= 4e-16 * a, "{a} {guess}: {root}");
            assert!(count < 130, "{count}");
        }
    }
}

#[test]
fn close_guesses_take_few_evaluations() {
    let mut count = 0;
    bracketed(1.0, 0.0, 0.31, cubic(0.3, 0.01, &mut count));
    assert_eq!(count, 3);
}

#[test]
fn steps_without_progress_give_way_to_bisection() {
    // sign(x − a)·√|x − a|, for which Newton's steps go round in circles.
    let a = 0.377;
    let root = bracketed(1.0, 0.0, 0.4, |x: f64| {
        let off = (x - a).abs().sqrt();
        Jet { value: off.copysign(x - a), slope: 0.5 / off, curvature: 0.0 }
    });
    assert!((root - a).abs() < 1e-15);
}
