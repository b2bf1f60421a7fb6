//! What is asked of a table.

use stickslip_plane::Range;

/// The window of a table and its bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Scaled stiffness κ.
    pub kappa: Range,
    /// Reduced impact ratio ψ.
    pub psi: Range,
    /// Scaled damping.
    pub damping: f64,
    /// The bound of the error of ε_t, from [`Self::FINEST`] to [`Self::COARSEST`].
    pub bound: f64,
    /// Whether the table has the regions of the atlas.
    pub regions: bool,
}

impl Default for Settings {
    /// κ from 0.5 to 100 and ψ from 0.01 to 3 without damping, to 1e-8, without regions.
    fn default() -> Self {
        Self {
            kappa: Range { low: 0.5, high: 100.0 },
            psi: Range { low: 0.01, high: 3.0 },
            damping: 0.0,
            bound: 1e-8,
            regions: false,
        }
    }
}

impl Settings {
    /// The finest bound.
    pub const FINEST: f64 = 1e-12;
    /// The coarsest bound.
    pub const COARSEST: f64 = 1e-3;
    /// Most strips, for which up to 850 MB are needed.
    pub const MOST_STRIPS: usize = 1_000_000;

    /// Checks all settings but those that an atlas checks.
    ///
    /// # Errors
    /// [`InvalidTable`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidTable> {
        if !(Self::FINEST..=Self::COARSEST).contains(&self.bound) {
            return Err(InvalidTable::Bound { value: self.bound });
        }
        for (name, Range { low, high }) in [("kappa", self.kappa), ("psi", self.psi)] {
            if !(low > 0.0 && high > low && high.is_finite()) {
                return Err(InvalidTable::Range { name, low, high });
            }
        }
        Ok(())
    }
}

/// Settings are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidTable {
    /// The bound is out of range.
    #[error(
        "bound = {value:?} is out of range; expected {:e} to {:e}",
        Settings::FINEST,
        Settings::COARSEST
    )]
    Bound {
        /// The bound.
        value: f64,
    },
    /// An interval is empty or out of range.
    #[error("{name} = {low:?} to {high:?} is out of range; expected an ascending interval above 0")]
    Range {
        /// `kappa` or `psi`.
        name: &'static str,
        /// The lower end.
        low: f64,
        /// The upper end.
        high: f64,
    },
}
