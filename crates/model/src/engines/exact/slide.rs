//! The slip phase, and where it turns into a stick phase.
//!
//! While sliding on side s, s·w − v is constant, and the phase ends where g = s·w − dL/dt =
//! s·w − b u v, with b = 3/(2κ), falls through 0. All slip phases of a collision share the function
//!
//! h = (1 − |v|) + b u |v|.
//!
//! Let C be s·w carried back to the start of contact. Then g is C − h in the compression and
//! h − (2 − C) in the decompression. From either end of contact h rises from 0 up to its crest. The
//! crest is the largest compression if b u ≤ 1 there (κ ≥ 1.568…), and otherwise the one zero of
//! dh/dt before it. Between the crests of the two halves g does not fall. There are three cases:
//!
//! - The phase ends in the compression if it starts before the crest and C is below h at the crest.
//! - Otherwise it ends in the decompression if C < 2.
//! - Otherwise it lasts to the end of contact.

use super::limit::{Crest, pull};
use super::refined_onset::refined_onset;
use super::trajectory::{Half, LARGEST_U, MIDDLE_ROOT, Moment, NormalMotion};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::root::{Jet, bracketed};

/// Value of b u at the largest compression above which h is nearly flat somewhere: there dg/dt is
/// −u³(1 − b u), and before it |dg/dt| is not smaller.
const FLAT: f64 = 0.97;

/// The properties that all slip phases of one collision share.
#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// Scaled stiffness κ.
    pub kappa: f64,
    /// b = 3/(2κ).
    pub bend: f64,
    /// The place where h is largest, if that is not the largest compression.
    pub crest: Option<Crest>,
}

/// The start of a slip phase, in the orientation of its side.
#[derive(Clone, Copy, Debug)]
pub struct SlipPhase {
    /// The moment at which it starts.
    pub start: Moment,
    /// 1 − |v| at the start.
    pub deficit: f64,
    /// s·w at the start.
    pub velocity: f64,
}

impl SlipPhase {
    /// The slip phase with which the contact starts.
    pub fn at_impact(psi: f64) -> Self {
        Self { start: Moment::START, deficit: 0.0, velocity: psi }
    }

    /// The slip phase that starts at `start` with s·w = `velocity`.
    pub fn new(start: Moment, normal: NormalMotion, velocity: f64) -> Self {
        Self { start, deficit: normal.deficit, velocity }
    }

    /// s·w at a later moment of the phase.
    pub fn velocity_at(&self, moment: Moment, normal: NormalMotion) -> DoubleDouble {
        match moment.half {
            Half::Compression => DoubleDouble::sum(self.at_start(), -normal.deficit),
            Half::Decompression => DoubleDouble::sum(self.at_end(), normal.deficit),
        }
    }

    /// s·w carried back to the start of contact.
    pub fn at_start(&self) -> f64 {
        match self.start.half {
            Half::Compression => self.velocity + self.deficit,
            Half::Decompression => self.at_end() + 2.0,
        }
    }

    /// s·w carried on to the end of contact.
    pub fn at_end(&self) -> f64 {
        match self.start.half {
            Half::Compression => self.at_start() - 2.0,
            Half::Decompression => self.velocity - self.deficit,
        }
    }
}

impl Slide {
    /// The slip phases at stiffness `kappa`.
    pub fn new(kappa: f64) -> Self {
        let bend = 1.5 / kappa;
        Self { kappa, bend, crest: (bend * LARGEST_U > 1.0).then(|| Crest::new(kappa, bend)) }
    }

    /// The spring's limit L = u³/κ.
    pub fn limit(&self, normal: NormalMotion) -> f64 {
        normal.u * normal.u * normal.u / self.kappa
    }

    /// The moment at which the slip phase turns into stick; `None` if it lasts to the end of
    /// contact.
    pub fn stick_onset(&self, sliding: &SlipPhase) -> Option<Moment> {
        self.onset_before_crest(sliding).or_else(|| self.onset_after_crest(sliding))
    }

    /// The moment at which the slip phase turns into stick before the crest of the compression, if
    /// it does.
    pub fn onset_before_crest(&self, sliding: &SlipPhase) -> Option<Moment> {
        let Crest { root: crest, height } = self.highest();
        let carried_back = sliding.at_start();
        let meets = sliding.start.is_before(Moment { half: Half::Compression, root: crest })
            && carried_back < height;
        if !meets {
            return None;
        }
        let root = self.inverse(carried_back, sliding.start.root, crest);
        let root = if self.bend * LARGEST_U > FLAT {
            refined_onset(self.kappa, self.bend, carried_back, root, crest)
        } else {
            root
        };
        Some(Moment { half: Half::Compression, root })
    }

    /// The moment at which the slip phase turns into stick, if it does and if it has not done so
    /// before the crest of the compression.
    pub fn onset_after_crest(&self, sliding: &SlipPhase) -> Option<Moment> {
        let Crest { root: crest, .. } = self.highest();
        let carried_on = sliding.at_end();
        (carried_on < 0.0).then(|| {
            let first = match sliding.start.half {
                Half::Compression => crest,
                Half::Decompression => sliding.start.root.min(crest),
            };
            Moment { half: Half::Decompression, root: self.inverse(-carried_on, 0.0, first) }
        })
    }

    /// The place where h is largest.
    pub fn highest(&self) -> Crest {
        self.crest.unwrap_or(Crest { root: MIDDLE_ROOT, height: 1.0 })
    }

    /// The root coordinate at which h is `target`, between `low` and `high` on the rising piece.
    fn inverse(&self, target: f64, low: f64, high: f64) -> f64 {
        // h = b u + (1 − |v|)(1 − b u). Close to an end of contact the first term dominates, for a
        // stiff spring the second. Up to h = 1 each of them alone gives a u above the root.
        let soft = target / self.bend;
        let u = if target < 1.0 {
            soft.min((1.25 * target * (2.0 - target)).powf(0.2))
        } else {
            soft.min(LARGEST_U)
        };
        let guess = u * (1.0 + 0.0571 * u * (u * u) * (u * u));
        bracketed(high, low, guess, |root| {
            let NormalMotion { u, v, deficit } =
                NormalMotion::at(Moment { half: Half::Compression, root });
            let pull = pull(self.bend, u);
            let pull_per_u = 3.0 * u * u - self.bend * (0.5 / (u * u) + 5.6 * u * u * u);
            Jet {
                value: deficit + self.bend * u * v - target,
                slope: 2.0 * root * pull,
                curvature: 2.0 * pull + 2.0 * root * root / u * v * pull_per_u,
            }
        })
    }
}
