//! How much is done for an atlas.

use crate::atlas::AtlasOptions;
use crate::options::TraceOptions;
use crate::regions::verify::VerifyOptions;

/// How much is done for an atlas. What it found speaks for itself only together with this.
///
/// ```
/// use stickslip_tracer::{AtlasOptions, Effort};
///
/// let usual = AtlasOptions::default();
/// let screen = Effort::Screen.applied(usual);
/// assert_eq!((screen.trace.cells, screen.verify.random_points, screen.rounds), (16, 250, 1));
/// let certain = Effort::Certain.applied(usual);
/// assert_eq!((certain.trace.cells, certain.verify.random_points), (64, 50_000));
/// assert_eq!(Effort::Default.applied(usual), usual);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Effort {
    /// A first look. The grid is half as fine along each axis; regions are compared with a fortieth
    /// of the random runs and a fifth of those beside curves; there is one round, and what is in
    /// doubt then stays so, since the window is traced in no other way.
    Screen,
    /// The options as they are.
    #[default]
    Default,
    /// The grid is twice as fine along each axis, regions are compared with five times as many
    /// runs, and there are twice as many rounds.
    Certain,
}

impl Effort {
    /// All of them, from the least.
    pub const ALL: [Self; 3] = [Self::Screen, Self::Default, Self::Certain];

    /// Its name, in lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Screen => "screen",
            Self::Default => "default",
            Self::Certain => "certain",
        }
    }

    /// Whether it is the usual one.
    #[must_use]
    pub fn is_default(&self) -> bool {
        *self == Self::Default
    }

    /// Options with this effort, from those with the usual one.
    #[must_use]
    pub fn applied(self, usual: AtlasOptions) -> AtlasOptions {
        let AtlasOptions { trace, verify, rounds, .. } = usual;
        let (cells, random_points, near_points, rounds) = match self {
            Self::Screen => {
                let near_points = verify.near_points.div_ceil(5);
                ((trace.cells / 2).max(2), verify.random_points.div_ceil(40), near_points, 1)
            }
            Self::Default => (trace.cells, verify.random_points, verify.near_points, rounds),
            Self::Certain => {
                let [random, near] = [verify.random_points, verify.near_points];
                let cells = (2 * trace.cells).min(TraceOptions::MOST_CELLS);
                (cells, random.saturating_mul(5), near.saturating_mul(5), 2 * rounds)
            }
        };
        AtlasOptions {
            effort: self,
            trace: TraceOptions { cells, ..trace },
            verify: VerifyOptions { random_points, near_points, ..verify },
            rounds,
            ..usual
        }
    }
}
