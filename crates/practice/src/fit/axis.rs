//! Coordinates in which fitted numbers are searched, and the places of the global search.

use std::f64::consts::PI;

use stickslip_plane::Range;

use super::bodies::Values;
use super::free::Free;

/// Places of the global search in half a period of the tangential spring. ε_t goes up and down once
/// while the phase √κ t_c of the spring grows by 2π.
pub const PLACES_IN_HALF_PERIOD: f64 = 12.0;
/// The largest ratio of neighbouring places of √κ and of μ, less 1.
pub const LARGEST_STEP: f64 = 0.06;
/// Distance of the places of the tangential damping.
const DASHPOT_STEP: f64 = 0.1;
/// Places of the damping.
const DAMPING_PLACES: u32 = 121;

/// A fitted number with the places at which the global search looks, in rising order. Coordinates
/// are √κ, ln μ, b and a.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What is fitted.
    pub free: Free,
    /// The places, as coordinates.
    pub places: Vec<f64>,
    range: Range,
}

impl Axis {
    /// The axis of a number in a range. `phase` is the largest phase of the spring in a contact
    /// over √κ, where κ belongs to normal incidence.
    pub fn new(free: Free, range: Range, phase: f64) -> Self {
        let Range { low, high } = range;
        let places = match free {
            Free::Kappa => {
                let longest = PI / (PLACES_IN_HALF_PERIOD * phase);
                let step = |root: f64| f64::min(longest, LARGEST_STEP * root);
                rising(low.sqrt(), high.sqrt(), step)
            }
            Free::Mu => rising(low.ln(), high.ln(), |_| LARGEST_STEP.ln_1p()),
            Free::TangentialDamping => rising(low, high, |_| DASHPOT_STEP),
            Free::Damping => rising(low, high, |_| (high - low) / f64::from(DAMPING_PLACES - 1)),
        };
        Self { free, places, range }
    }

    /// The value at a coordinate.
    pub fn value(&self, at: f64) -> f64 {
        // The ends equal the ends of the range, without rounding.
        let ends = self.ends();
        if at == ends.0 || at == ends.1 {
            return if at == ends.0 { self.range.low } else { self.range.high };
        }
        match self.free {
            Free::Kappa => at * at,
            Free::Mu => at.exp(),
            Free::TangentialDamping | Free::Damping => at,
        }
    }

    /// The coordinate of a value.
    pub fn coordinate(&self, value: f64) -> f64 {
        match self.free {
            Free::Kappa => value.sqrt(),
            Free::Mu => value.ln(),
            Free::TangentialDamping | Free::Damping => value,
        }
    }

    /// The ends of the axis.
    pub fn ends(&self) -> (f64, f64) {
        (self.places[0], self.places[self.places.len() - 1])
    }

    /// The distance between the places around a coordinate.
    pub fn step(&self, at: f64) -> f64 {
        let upper = self.places.partition_point(|place| *place < at);
        let upper = upper.clamp(1, self.places.len() - 1);
        self.places[upper] - self.places[upper - 1]
    }

    /// Sets the number in `values` to that at a coordinate.
    pub fn set(&self, values: &mut Values, at: f64) {
        let field = match self.free {
            Free::Kappa => &mut values.kappa,
            Free::Mu => &mut values.mu,
            Free::TangentialDamping => &mut values.tangential_damping,
            Free::Damping => &mut values.damping,
        };
        *field = self.value(at);
    }
}

/// Numbers from `low` to `high`, at most `step` apart.
fn rising(low: f64, high: f64, step: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut places = vec![low];
    let mut at = low;
    loop {
        at += step(at);
        // No place is so close to the end that rounding would count.
        if at >= high - 0.01 * step(at) {
            places.push(high);
            return places;
        }
        places.push(at);
    }
}
