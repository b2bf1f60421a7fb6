//! The first instants of a stick phase, where the spring and its limit are almost equal.
//!
//! D = L − s·y starts with D = Ḋ = 0. Beside a slip graze the whole phase is so short that L and
//! s·y agree to all digits. The Taylor series of D, which starts with τ², keeps the digits.

use super::limit::pull;
use super::trajectory::{Half, Moment, NormalMotion};

/// Number of Taylor coefficients, for a phase that is shorter than a sixteenth of the time at which
/// it starts. The series converges up to that time: the remainder is below 16⁻¹⁴ of the whole.
const TERMS: usize = 16;

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
    /// the time to the crest, whose root coordinate is `crest`.
    pub fn new(
        kappa: f64,
        start: Moment,
        normal: NormalMotion,
        velocity: f64,
        crest: f64,
    ) -> Option<Self> {
        let age = start.time();
        let crest = Moment { half: Half::Compression, root: crest };
        let short = start.half == Half::Compression && start.time_until(crest) < age / 64.0;
        short.then(|| Self { series: series(kappa, normal, velocity), reach: age / 16.0 })
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

/// Coefficients of τ², τ³, … in L − s·y, from ẋ = v, v̇ = −F, xḞ = (3/2) F v and ÿ = −κ y.
fn series(kappa: f64, normal: NormalMotion, velocity: f64) -> [f64; TERMS] {
    const ORDER: usize = TERMS + 2;
    let numbered = || (0_u8..).map(f64::from).enumerate();
    let NormalMotion { u, v: speed, .. } = normal;
    let [mut x, mut v, mut f, mut y] = [[0.0; ORDER]; 4];
    x[0] = u * u;
    v[0] = speed;
    f[0] = u * u * u;
    y[0] = f[0] / kappa;
    y[1] = velocity;
    for (n, order) in numbered().take(ORDER - 1) {
        x[n + 1] = v[n] / (order + 1.0);
        v[n + 1] = -f[n] / (order + 1.0);
        // (n + 1) x₀ F_{n+1} = (3/2) Σ_j F_j v_{n−j} − Σ_j j F_j x_{n+1−j}
        let terms = numbered().take(n + 1);
        let sum: f64 = terms.map(|(j, power)| f[j] * (1.5 * v[n - j] - power * x[n + 1 - j])).sum();
        f[n + 1] = sum / ((order + 1.0) * x[0]);
        if n + 2 < ORDER {
            y[n + 2] = -kappa * y[n] / ((order + 1.0) * (order + 2.0));
        }
    }
    let mut series = [0.0; TERMS];
    for (n, coefficient) in series.iter_mut().enumerate() {
        *coefficient = f[n + 2] / kappa - y[n + 2];
    }
    // The first coefficient is small: its closed form keeps the digits.
    series[0] = 0.5 * pull(1.5 / kappa, u);
    series
}

#[cfg(test)]
mod tests {
    use super::super::trajectory::MIDDLE_ROOT;
    use super::*;

    #[test]
    fn series_is_the_difference_of_limit_and_spring() {
        let kappa: f64 = 1.0;
        let start = Moment { half: Half::Compression, root: 0.95 };
        let normal = NormalMotion::at(start);
        let velocity = 1.5 / kappa * normal.u * normal.v;
        let elongation = normal.u * normal.u * normal.u / kappa;
        let onset = Onset::new(kappa, start, normal, velocity, 0.955).unwrap();
        for part in [0.25, 0.5, 1.0] {
            let tau = part * onset.reach;
            let (value, ..) = onset.gap(tau).unwrap();
            let u = NormalMotion::at(start.after(tau)).u;
            let (sin, cos) = (kappa.sqrt() * tau).sin_cos();
            let direct = u * u * u / kappa - elongation * cos - velocity / kappa.sqrt() * sin;
            assert!((value - direct).abs() < 4e-16, "{value} {direct}");
        }
        assert!(onset.gap(1.01 * onset.reach).is_none());
        assert!(Onset::new(kappa, start, normal, velocity, MIDDLE_ROOT).is_none());
    }

    #[test]
    fn derivatives_belong_to_the_value() {
        let start = Moment { half: Half::Compression, root: 0.95 };
        let normal = NormalMotion::at(start);
        let onset = Onset::new(1.0, start, normal, 1.5 * normal.u * normal.v, 0.955).unwrap();
        let (tau, step) = (0.5 * onset.reach, 1e-5);
        let at = |tau| onset.gap(tau).unwrap();
        let (before, here, after) = (at(tau - step), at(tau), at(tau + step));
        assert!((0.5 * (after.0 - before.0) / step - here.1).abs() < 1e-10);
        assert!((0.5 * (after.1 - before.1) / step - here.2).abs() < 1e-9);
    }
}
