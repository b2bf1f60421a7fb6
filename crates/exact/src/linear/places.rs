//! Roots along a phase, accurate relative to the nearer of the two times from which they are
//! measured.

use stickslip_contact::numerics::root::{Jet, bracketed};

use super::normal::{Moment, Place};

/// The place between `above`, where f > 0, and `below` behind it, where f < 0, at which f vanishes.
/// The derivatives of f are rates in time. The first time that is tried is `guess`.
pub fn falling(
    start: &Moment,
    [above, below]: [Place; 2],
    guess: f64,
    f: impl Fn(Place) -> Jet,
) -> Place {
    let since = |since: f64| Place { since, left: start.left - since };
    let from_start =
        |end: Place| since(bracketed(above.since, end.since, guess, |time| f(since(time))));
    // The tail begins where the force vanishes: there the time since then is known.
    if start.left <= 0.0 || below.since <= below.left {
        return from_start(below);
    }
    let from_end = |begin: Place| {
        let left = |left: f64| Place { since: start.left - left, left };
        left(bracketed(begin.left, below.left, start.left - guess, |time| {
            let Jet { value, slope, curvature } = f(left(time));
            Jet { value, slope: -slope, curvature }
        }))
    };
    if above.since >= above.left {
        return from_end(above);
    }
    let middle = since(0.5 * start.left);
    let Jet { value, .. } = f(middle);
    if value > 0.0 {
        from_end(middle)
    } else if value < 0.0 {
        from_start(middle)
    } else {
        middle
    }
}
