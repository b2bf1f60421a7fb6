//! How far the settings of studies go: what settings are checked against, and what errors name.

use stickslip_plane::Range;

/// The largest stiffness of a study of convergence, which takes seconds at it. Work grows as √κ.
pub const MOST_STIFFNESS: f64 = 1e6;

/// The most cells along an axis of a map.
pub const MOST_CELLS: usize = 1000;
/// The most laws: a map of each takes about a second, and a page has them one below the other.
pub const MOST_LAWS: usize = 1000;

/// The stiffnesses of a study of stiff springs: from about 2 on all oscillations are alike, and at
/// 10¹⁰ a collision has 100 000 switches.
pub const STIFFNESSES: Range = Range { low: 3.0, high: 1e10 };
/// The most impact ratios: more lines cannot be distinguished in a picture.
pub const MOST_PSI: usize = 4;
