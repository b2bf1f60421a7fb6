//! How much is done for an atlas.

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
}
