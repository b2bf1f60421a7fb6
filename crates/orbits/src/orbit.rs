//! A periodic orbit.

use crate::itinerary::Leg;

/// A multiplier so near the unit circle may be on it.
const NEUTRAL: f64 = 1e-10;

/// A periodic orbit as segments, each up to the rule of its leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// The values of the parameters.
    pub parameters: Vec<f64>,
    /// The time at the start of the first segment.
    pub start: f64,
    /// The segments.
    pub segments: Vec<Segment>,
    /// The sum of the durations.
    pub period: f64,
    /// The multipliers as real and imaginary parts, the largest first: eigenvalues of the
    /// derivative of the return to the start, without the trivial 1 of systems that do not depend
    /// on time. `None` at a graze, where one is infinite.
    pub multipliers: Option<Vec<[f64; 2]>>,
    /// Whether the system follows the orbit by itself.
    pub verdict: Verdict,
    /// The largest error of a state or a duration, of its size.
    pub error: f64,
}

/// A part of an orbit, in one mode.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Segment<L = Leg> {
    /// Its mode, and the rule that ends it.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub leg: L,
    /// Its length.
    pub duration: f64,
    /// The state at its start.
    pub state: Vec<f64>,
    /// The state at its end, before the rule acts.
    pub end: Vec<f64>,
    /// The rate of the rule's condition there. It is 0 at a graze.
    pub rate: f64,
}

impl<L> Segment<L> {
    /// The same segment with another leg.
    #[must_use]
    pub fn with<M>(self, leg: M) -> Segment<M> {
        let Self { duration, state, end, rate, .. } = self;
        Segment { leg, duration, state, end, rate }
    }
}

/// Whether the rules of an itinerary are those that act along an orbit.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// They are, and no other ones act: decided by bounds along the whole orbit.
    Admissible,
    /// They are not. The orbit solves the equations of its itinerary, and the system leaves it.
    Virtual(Obstacle),
    /// Rounding hides which rules act.
    Undecided(String),
}

/// Where and why a system leaves an orbit.
#[derive(Clone, Debug, PartialEq)]
pub enum Obstacle {
    /// Another rule acts on a segment.
    Acts {
        /// The segment.
        segment: usize,
        /// The rule, by its place in the mode.
        rule: usize,
        /// When.
        s: f64,
    },
    /// The rule at the end of the segment does not act there.
    Idle {
        /// The segment.
        segment: usize,
    },
    /// The rule at the end of the segment leads to this mode.
    Branches {
        /// The segment.
        segment: usize,
        /// The mode.
        to: usize,
    },
    /// The duration of the segment is negative.
    Backwards {
        /// The segment.
        segment: usize,
    },
}

impl Orbit {
    /// Whether the system follows the orbit by itself, which is decided along the whole orbit.
    #[must_use]
    pub fn is_admissible(&self) -> bool {
        self.verdict == Verdict::Admissible
    }

    /// Whether rounding hides if the system follows the orbit.
    pub(crate) fn is_undecided(&self) -> bool {
        matches!(self.verdict, Verdict::Undecided(_))
    }

    /// The time at the start of a segment, or at the end behind the last one.
    pub(crate) fn time(&self, segment: usize) -> f64 {
        self.start + self.segments[..segment].iter().map(|it| it.duration).sum::<f64>()
    }

    /// Whether all multipliers are less than 1 in size, by more than their errors.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        let inside = |[re, im]: &[f64; 2]| re.hypot(*im) < 1.0 - NEUTRAL;
        self.multipliers.as_ref().is_some_and(|all| all.iter().all(inside))
    }

    /// How many multipliers are larger than 1 in size, at least and at most; `None` at a graze.
    pub(crate) fn outside(&self) -> Option<[usize; 2]> {
        let all = self.multipliers.as_ref()?;
        let beyond = |least: f64| all.iter().filter(|[re, im]| re.hypot(*im) > least).count();
        Some([beyond(1.0 + NEUTRAL), beyond(1.0 - NEUTRAL)])
    }

    /// The largest size of a multiplier; infinite at a graze.
    #[must_use]
    pub fn largest_multiplier(&self) -> f64 {
        let sizes = self.multipliers.iter().flatten().map(|[re, im]| re.hypot(*im));
        if self.multipliers.is_some() { sizes.fold(0.0, f64::max) } else { f64::INFINITY }
    }
}
