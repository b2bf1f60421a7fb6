//! Roots along a trajectory, in its root coordinate.

use stickslip_contact::numerics::root::{Jet, bracketed};

use super::Trajectory;
use crate::exact::moment::{At, Half, Moment};

/// The derivatives of a function in time as derivatives in the root coordinate.
pub fn along_root<T: Trajectory>(
    path: &T,
    at: &At<T::Motion>,
    value: f64,
    rate: f64,
    acceleration: f64,
) -> Jet {
    let [time_per_root, bend] = path.time_along_root(at);
    Jet {
        value,
        slope: rate * time_per_root,
        curvature: acceleration * time_per_root * time_per_root + rate * bend,
    }
}

/// The root between `low`, where f > 0, and `high`, where f < 0, which may be in different halves.
pub fn root_between<T: Trajectory>(
    path: &T,
    mut low: Moment,
    mut high: Moment,
    guess: Option<Moment>,
    f: impl Fn(&At<T::Motion>) -> Jet,
) -> Moment {
    if low.half != high.half {
        let [early, late] = path.middle();
        let middle = Moment { half: Half::Decompression, root: late };
        if f(&path.at(middle)).value < 0.0 {
            high = Moment { half: Half::Compression, root: early };
        } else {
            low = middle;
        }
    }
    let half = low.half;
    let guess = match guess {
        Some(moment) if moment.half == half => moment.root,
        _ => 0.5 * (low.root + high.root),
    };
    let root = bracketed(low.root, high.root, guess, |root| f(&path.at(Moment { half, root })));
    Moment { half, root }
}
