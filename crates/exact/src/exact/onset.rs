//! The first instants of a stick phase, where the spring and its limit are almost equal.
//!
//! D = L − s·y starts with D = Ḋ = 0. Beside a slip graze the whole phase is so short that L and
//! s·y agree to all digits; so is the last phase beside the boundary at which slip lasts to the end
//! of contact. The Taylor series of D, which starts with τ², keeps the digits.

use super::moment::{At, Moment, Motion, Spring};
use super::normal::{ORDER, Trajectory};

/// Number of Taylor coefficients, for a phase that is shorter than a sixteenth of the time within
/// which the series converges: the remainder is below 16⁻¹⁴ of the whole.
const TERMS: usize = ORDER - 2;

/// The Taylor series of D around the start of a stick phase.
#[derive(Clone, Copy, Debug)]
pub struct Onset {
    /// Coefficients of τ², τ³, …
    series: [f64; TERMS],
    /// The largest τ for which the series is used.
    pub reach: f64,
}

impl Onset {
    /// The series for a phase that starts at `start`, if it may be short. Its length is three times
    /// the time to the first turn, or ends with the contact.
    pub fn new<T: Trajectory>(
        path: &T,
        spring: &Spring,
        start: &At<T::Motion>,
        velocity: f64,
        turns: Option<[Moment; 2]>,
    ) -> Option<Self> {
        let radius = path.series_radius(start);
        let near_turn = turns.is_some_and(|[turn, _]| {
            start.moment.is_before(turn) && path.elapsed(start, &path.at(turn)) < radius / 64.0
        });
        let short = near_turn || path.time_left(start) < radius / 64.0;
        short.then(|| Self { series: series(path, spring, start, velocity), reach: radius / 16.0 })
    }

    /// D, dD/dt and d²D/dt² a time `tau` after the start, if that is within reach.
    pub fn gap(&self, tau: f64) -> Option<(f64, f64, f64)> {
        if tau > self.reach {
            return None;
        }
        // Horner's rule for p = D/τ², dp/dτ and half of d²p/dτ².
        let (mut p, mut p1, mut p2) = (0.0, 0.0, 0.0);
        for coefficient in self.series.iter().rev() {
            p2 = p2 * tau + p1;
            p1 = p1 * tau + p;
            p = p * tau + coefficient;
        }
        Some((tau * tau * p, tau * (2.0 * p + tau * p1), 2.0 * (p + tau * (2.0 * p1 + tau * p2))))
    }
}

/// Coefficients of τ², τ³, … in L − s·y, from ÿ = −κ y.
fn series<T: Trajectory>(
    path: &T,
    spring: &Spring,
    start: &At<T::Motion>,
    velocity: f64,
) -> [f64; TERMS] {
    let force = path.force_series(start);
    let mut y = [0.0; ORDER];
    y[0] = force[0] / spring.kappa;
    y[1] = velocity;
    for (n, order) in (0_u8..).map(f64::from).enumerate().take(TERMS) {
        y[n + 2] = -spring.kappa * y[n] / ((order + 1.0) * (order + 2.0));
    }
    let mut series = [0.0; TERMS];
    for (n, coefficient) in series.iter_mut().enumerate() {
        *coefficient = force[n + 2] / spring.kappa - y[n + 2];
    }
    // The first coefficient is small: its closed form keeps the digits.
    series[0] = 0.5 * start.motion.pull(spring);
    series
}

#[cfg(test)]
mod tests {
    use super::super::moment::Half;
    use super::super::normal::undamped::Undamped;
    use super::*;

    /// A phase that starts before a turn, at rest relative to its limit.
    fn phase(kappa: f64) -> (Spring, At<<Undamped as Trajectory>::Motion>, f64) {
        let spring = Spring::new(kappa);
        let start = Undamped.at(Moment { half: Half::Compression, root: 0.95 });
        let velocity = start.motion.limit_rate(&spring);
        (spring, start, velocity)
    }

    fn turns(root: f64) -> [Moment; 2] {
        [Half::Compression, Half::Decompression].map(|half| Moment { half, root })
    }

    #[test]
    fn series_is_the_difference_of_limit_and_spring() {
        let (spring, start, velocity) = phase(1.0);
        let elongation = start.motion.limit(&spring);
        let onset = Onset::new(&Undamped, &spring, &start, velocity, Some(turns(0.955))).unwrap();
        for part in [0.25, 0.5, 1.0] {
            let tau = part * onset.reach;
            let (value, ..) = onset.gap(tau).unwrap();
            let limit = Undamped.at(Undamped.after(&start, tau, 0.0)).motion.limit(&spring);
            let (sin, cos) = (spring.omega * tau).sin_cos();
            let direct = limit - elongation * cos - velocity / spring.omega * sin;
            assert!((value - direct).abs() < 4e-16, "{value} {direct}");
        }
        assert!(onset.gap(1.01 * onset.reach).is_none());
        let far = turns(Undamped.middle()[0]);
        assert!(Onset::new(&Undamped, &spring, &start, velocity, Some(far)).is_none());
    }

    #[test]
    fn derivatives_belong_to_the_value() {
        let (spring, start, velocity) = phase(1.0);
        let onset = Onset::new(&Undamped, &spring, &start, velocity, Some(turns(0.955))).unwrap();
        let (tau, step) = (0.5 * onset.reach, 1e-5);
        let at = |tau| onset.gap(tau).unwrap();
        let (before, here, after) = (at(tau - step), at(tau), at(tau + step));
        assert!((0.5 * (after.0 - before.0) / step - here.1).abs() < 1e-10);
        assert!((0.5 * (after.1 - before.1) / step - here.2).abs() < 1e-9);
    }
}
