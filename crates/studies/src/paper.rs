//! What the paper's figures mean: their friction and inertia, and the two readings of the axis that
//! they call κ.

use stickslip_model::Reduction;

/// Friction and inertia of all figures: μ = 0.4, homogeneous spheres.
pub const REDUCTION: Reduction = Reduction::HOMOGENEOUS;
/// Coefficient of friction of all figures.
pub const MU: f64 = REDUCTION.mu;
/// Tangential inertia of all figures.
pub const ALPHA: f64 = REDUCTION.alpha;
/// The stiffness of Figures 4 and 5, as their axis shows it.
pub const STIFFNESS: f64 = 18.0;

/// What the axis of stiffness of Figures 3 to 6 shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// κ of equation (24), as it is called.
    Printed,
    /// ακ, the reading with which the figures agree.
    Axis,
}

impl Reading {
    /// Both readings.
    pub const ALL: [Self; 2] = [Self::Printed, Self::Axis];

    /// What tells its files from those of the other.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Axis => "axis",
        }
    }

    /// What the axis is called.
    #[must_use]
    pub fn axis(self) -> &'static str {
        match self {
            Self::Printed => "κ",
            Self::Axis => "ακ",
        }
    }

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Printed => "axis read as κ of (24)",
            Self::Axis => "axis read as ακ",
        }
    }

    /// κ of equation (24) where the axis shows `value`.
    #[must_use]
    pub fn kappa(self, value: f64) -> f64 {
        match self {
            Self::Printed => value,
            Self::Axis => value / ALPHA,
        }
    }
}

/// ψ at the impact ratio g_t/g_n.
#[must_use]
pub fn psi(ratio: f64) -> f64 {
    REDUCTION.psi(ratio)
}

/// The impact ratio g_t/g_n at ψ.
#[must_use]
pub fn ratio(psi: f64) -> f64 {
    REDUCTION.ratio(psi)
}
