//! The last instants of a stiff contact: the inner problem of the limit κ → ∞, which has no
//! parameter.
//!
//! Just before the end of contact |v| = 1: x is the time left, and L = x^{3/2}/κ. With
//! σ = √κ · (time left), y = κ^{−7/4} Y and w = κ^{−5/4} W the law becomes
//!
//! ```text
//! stick:           Ẏ = W          Ẇ = −Y
//! slip on side s:  Y = sσ^{3/2}   Ẇ = −sσ^{3/2}
//! ```
//!
//! where σ falls at the rate 1. A stick phase starts where sY = σ^{3/2} and sW = −(3/2)√σ. The σ of
//! this *onset* decides all that follows. The motion is a map from one onset to the next, half a
//! swing later and on the other side. Each onset of an orbit that comes from σ → ∞ has a [`phase`],
//! which falls by 1 from each onset to the next. The last slip ends with |W| = F, a function of the
//! phase alone with the period 1. It gives the final velocity of a collision, |w_final| = κ^{−5/4}
//! F.
//!
//! [`peak`] has the largest F in closed form; `docs/physics.md` derives it. Stick phases are solved
//! exactly, with one root for each. Onsets and phases are good to 1e-13, F to 4e-13, the closed
//! forms to 2e-15.
//!
//! ```
//! use stickslip_model::limits::inner;
//!
//! let last = inner::last_half_swing(0.119493019326600);
//! assert!((last.final_velocity().unwrap() - inner::peak().velocity).abs() < 1e-13);
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use stickslip_contact::numerics::root::{Jet, bracketed};

/// The σ from which on the phase of an onset is computed from its series; the error there is 1e-15.
pub const FAR: f64 = 100.0;

/// Coefficients b₁, b₂ … of the phase, σ/π + Σ b_k σ^{−k/2}.
///
/// The series falls by 1 from each onset to the next. It was computed with 60 digits from the
/// series of the map; b₁ = 2√(3/π).
pub const PHASE: [f64; 15] = [
    1.954410047611679686345538,
    -0.2387324146378430036533256,
    0.9209940371518396396315965,
    -1.5,
    0.8010375859662124734815084,
    -2.670353755551324252693247,
    2.35182405915559050834497,
    -3.790473681541038285591131,
    6.325802358154104436485476,
    -8.052448583913427692458385,
    15.86578449255723283272501,
    -19.26748379991024823812973,
    38.23478179910072417209245,
    -30.03691706208997159859093,
    54.08757197881407225993713,
];

/// A stick phase and the slip phase that follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSwing {
    /// σ at the start of the stick phase.
    pub onset: f64,
    /// σ at its end, which is on the other side.
    pub release: f64,
    /// sW in slip, carried on to the end of contact.
    carried: f64,
}

impl HalfSwing {
    /// The half swing from an onset at σ = `onset` > 0.
    ///
    /// As L̈ > 0, the spring cannot reach its limit again on the side where it starts. On the other
    /// side it reaches the limit before its peak, which is at least as high as the limit at the
    /// onset.
    pub fn from_onset(onset: f64) -> Self {
        let (spring, velocity) = (onset * onset.sqrt(), -1.5 * onset.sqrt());
        let motion = |release: f64| {
            let (sin, cos) = (onset - release).sin_cos();
            (spring * cos + velocity * sin, velocity * cos - spring * sin)
        };
        let zero = onset - spring.atan2(-velocity);
        let release = bracketed(
            zero,
            (zero - FRAC_PI_2).max(0.0),
            onset - PI + (3.0 * PI / onset).sqrt(),
            |release| {
                let (y, w) = motion(release);
                let root = release.sqrt();
                Jet { value: release * root + y, slope: 1.5 * root - w, curvature: 0.75 / root - y }
            },
        );
        let carried = -motion(release).1 - 0.4 * release * release * release.sqrt();
        Self { onset, release, carried }
    }

    /// |W| at the end of contact, if the slip phase lasts until then.
    pub fn final_velocity(&self) -> Option<f64> {
        (self.carried >= 0.0).then_some(self.carried)
    }

    /// σ at the start of the next stick phase, if there is one.
    pub fn next_onset(&self) -> Option<f64> {
        (self.carried < 0.0).then(|| {
            // The condition is sW = carried + (2/5)σ^{5/2} = −(3/2)√σ, a polynomial in √σ.
            let root = bracketed(0.0, self.release.sqrt(), self.release.sqrt(), |root| {
                let cube = root * root * root;
                Jet {
                    value: -self.carried - 0.4 * cube * root * root - 1.5 * root,
                    slope: -2.0 * cube * root - 1.5,
                    curvature: -8.0 * cube,
                }
            });
            root * root
        })
    }
}

/// The phase of an onset at σ = `onset` > 0, otherwise NaN. It is about σ/π, the number of half
/// swings to come if all of them lasted π.
pub fn phase(onset: f64) -> f64 {
    if onset.is_nan() || onset <= 0.0 {
        return f64::NAN;
    }
    let (mut onset, mut passed) = (onset, 0.0);
    while onset < FAR {
        onset = previous_onset(onset);
        passed += 1.0;
    }
    far_phase(onset, PHASE.len()) - passed
}

/// The last half swing of the orbit whose onsets have `phase` and the phases that differ from it by
/// whole numbers.
pub fn last_half_swing(phase: f64) -> HalfSwing {
    last_half_swing_from(phase, FAR, PHASE.len())
}

/// As [`last_half_swing`], from the first onset at σ > `start` and with the first `terms`
/// coefficients of [`PHASE`]. It shows how fast both converge. `start` is from 10 to 1e6; the work
/// grows with it.
pub fn last_half_swing_from(phase: f64, start: f64, terms: usize) -> HalfSwing {
    let phase = phase - phase.floor() + (start.clamp(10.0, 1e6) / PI).ceil();
    let mut onset = PI * phase;
    // The series is almost linear: each pass leaves a hundredth of the error.
    for _ in 0..40 {
        onset += PI * (phase - far_phase(onset, terms));
    }
    let mut swing = HalfSwing::from_onset(onset);
    while let Some(onset) = swing.next_onset() {
        swing = HalfSwing::from_onset(onset);
    }
    swing
}

/// The half swing with the largest final velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// σ at the onset.
    pub onset: f64,
    /// σ at the release.
    pub release: f64,
    /// F, which is |W| at the end of contact.
    pub velocity: f64,
    /// Coefficient of the next order: the largest κ^{5/4}|w_final| is `velocity` + `correction`
    /// κ^{−5/4} + O(κ^{−5/2}).
    pub correction: f64,
}

/// The half swing with the largest F, in closed form. Its stick phase lasts exactly a quarter of a
/// period.
///
/// Let x be `release`. Then x³ = (9/4)(x + π/2), which has one positive root, and F = (8/27)x^{9/2}
/// − (2/5)x^{5/2} = 4.4848423519475….
///
/// ```
/// use stickslip_model::limits::inner::{HalfSwing, peak};
///
/// let peak = peak();
/// let found = HalfSwing::from_onset(peak.onset);
/// assert!((found.release - peak.release).abs() < 1e-14);
/// assert!((found.final_velocity().unwrap() - peak.velocity).abs() < 1e-14);
/// ```
pub fn peak() -> Peak {
    // Cardano's formula.
    let half = 9.0 * PI / 16.0;
    let root = (half * half - 27.0 / 64.0).sqrt();
    let release = (half + root).cbrt() + (half - root).cbrt();
    let onset = release + FRAC_PI_2;
    let square = release * release;
    Peak {
        onset,
        release,
        velocity: onset * onset.sqrt() - 0.4 * square * release.sqrt(),
        correction: (0.2 * square * square * release - onset.powi(4)) * 6.0 / 35.0,
    }
}

/// The phase of an onset far from the end, by the first `terms` coefficients.
fn far_phase(onset: f64, terms: usize) -> f64 {
    let step = onset.sqrt().recip();
    let series = PHASE.iter().take(terms).rev().fold(0.0, |sum, b| (sum + b) * step);
    onset / PI + series
}

/// The onset before the one at σ = `next`.
fn previous_onset(next: f64) -> f64 {
    let target = 0.4 * next * next * next.sqrt() + 1.5 * next.sqrt();
    // The carried velocity falls from the peak on. The last half swing is the longest and lasts
    // 5.81.
    let low = (next + PI).max(peak().onset);
    bracketed(low, next + 6.0, next + PI + 9.65 / (4.0 + next).powf(1.5), |onset| {
        let swing = HalfSwing::from_onset(onset);
        let slope = (onset - swing.release).cos() * (onset * onset.sqrt() + 0.75 / onset.sqrt());
        Jet { value: swing.carried + target, slope, curvature: 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Phase, σ at the last onset and F, computed with 40 digits and 21 coefficients from σ = 1500.
    const PROFILE: [(f64, f64, f64); 8] = [
        (0.0, 2.955804240154131554830447, 4.243210506901899416795425),
        (0.125, 3.601198694756546685411251, 4.484337462282218579856209),
        (0.25, 4.184858627326715946030437, 4.203445346791521742226114),
        (0.375, 4.730265529876086138189549, 3.408755836882763729186045),
        (0.5, 5.24964356071897088735981, 2.095662806917261938024183),
        (0.625, 5.750177126876924429253452, 0.2536379818595663556801978),
        (0.75, 1.12648314505293777491103, 1.945132226186669208429296),
        (0.875, 2.193639050703248059449878, 3.44042739033152686676141),
    ];

    #[test]
    fn the_peak_has_its_closed_form() {
        let peak = peak();
        // All were computed with 40 digits: F as the largest value of the map, the correction from
        // the derivative of the first order of the map in κ^{−5/4}, the phase from onsets up to
        // σ = 1500.
        assert!((peak.release - 2.0035095171077777508).abs() < 1e-15);
        assert!((peak.velocity - 4.4848423519475425884).abs() < 2e-15);
        assert!((peak.correction + 26.873347995682891380).abs() < 2e-14);
        assert!((phase(peak.onset) - 2.1194930193265999017).abs() < 1e-13);
    }

    #[test]
    fn no_half_swing_is_larger_than_the_peak() {
        let peak = peak();
        for side in [-1.0, 1.0] {
            for distance in [1e-3, 0.1, 1.0, 2.0] {
                let beside = HalfSwing::from_onset(peak.onset + side * distance).final_velocity();
                // The second derivative of F is −7 at the peak, and smaller in size beside it.
                assert!(beside.unwrap() < peak.velocity - 0.1 * distance * distance);
            }
        }
    }

    #[test]
    fn profile_and_phase_have_their_reference_values() {
        for (p, onset, velocity) in PROFILE {
            let last = last_half_swing(p);
            let found = last.final_velocity().unwrap();
            assert!((last.onset - onset).abs() < 1e-13, "{p}: {}", last.onset);
            // F changes by up to 17 in one phase, and onsets are known to 1e-14.
            assert!((found - velocity).abs() < 4e-13, "{p}: {found}");
            let back = phase(onset) - p;
            assert!((back - back.round()).abs() < 1e-13, "{p}: {back}");
            // F has the period 1.
            assert!((last_half_swing(p - 3.0).onset - onset).abs() < 1e-13);
        }
    }

    #[test]
    fn half_swings_obey_the_law() {
        for onset in [1e-12, 1e-6, 0.01, 0.3, 1.0, 3.0, 5.8, 5.81, 10.0, 100.0, 1e4] {
            let swing = HalfSwing::from_onset(onset);
            let angle = onset - swing.release;
            let (y0, w0) = (onset.powf(1.5), -1.5 * onset.sqrt());
            let limit = swing.release.powf(1.5);
            let y = y0 * angle.cos() + w0 * angle.sin();
            assert!((y + limit).abs() < 2e-15 * y0.hypot(w0), "{onset}");
            let w = w0 * angle.cos() - y0 * angle.sin();
            match swing.next_onset() {
                // On side −1, −W falls by ∫ σ^{3/2} dσ to the rate of the limit.
                Some(next) => {
                    let rate = -1.5 * next.sqrt();
                    let change = 0.4 * (swing.release.powf(2.5) - next.powf(2.5));
                    assert!(
                        (-w - change - rate).abs() < 1e-15 * swing.release.powf(2.5),
                        "{onset}"
                    );
                    assert!((previous_onset(next) - onset).abs() < 1e-14 * onset, "{onset}");
                }
                None => assert!(onset < 5.8084052515448512),
            }
        }
        assert!(HalfSwing::from_onset(5.8084052515448505).final_velocity().unwrap() < 1e-14);
    }

    #[test]
    fn phases_fall_by_one_as_fast_as_the_series_converges() {
        // With n coefficients the error of the fall is O(σ^{−(n + 3)/2}); these are twice the
        // measured factors.
        const FACTORS: [f64; 15] = [
            1.0, 7.0, 22.0, 9.0, 55.0, 52.0, 92.0, 210.0, 240.0, 690.0, 720.0, 2200.0, 1600.0,
            3400.0, 5200.0,
        ];
        for start in [30.0_f64, 60.0, 100.0] {
            let next = HalfSwing::from_onset(start).next_onset().unwrap();
            for (n, factor) in FACTORS.iter().enumerate() {
                let fall = far_phase(start, n + 1) - far_phase(next, n + 1);
                let limit = factor * start.powf(-0.5 * n as f64 - 2.0) + 1e-14;
                assert!((fall - 1.0).abs() < limit, "{start} {n}: {fall}");
            }
        }
    }
}
