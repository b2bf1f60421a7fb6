//! The two meanings of the stiffness in the figures of the paper.

/// Coefficient of friction of all figures.
pub const MU: f64 = 0.4;
/// Tangential inertia of homogeneous spheres.
pub const ALPHA: f64 = 2.0 / 7.0;

/// What the axis of stiffness of Figures 3 to 6 shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// κ of equation (24), as it is called.
    Printed,
    /// ακ.
    Axis,
}

impl Reading {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Printed, Self::Axis];

    /// What tells its files from those of the other.
    pub fn name(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Axis => "axis",
        }
    }

    /// What the axis is called.
    pub fn axis(self) -> &'static str {
        match self {
            Self::Printed => "κ",
            Self::Axis => "ακ",
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Printed => "axis read as κ of (24)",
            Self::Axis => "axis read as ακ",
        }
    }

    /// κ of equation (24) where the axis shows `value`.
    pub fn kappa(self, value: f64) -> f64 {
        match self {
            Self::Printed => value,
            Self::Axis => value / ALPHA,
        }
    }
}

/// ψ at the impact ratio g_t/g_n.
pub fn psi(ratio: f64) -> f64 {
    ratio * ALPHA / MU
}

/// The impact ratio g_t/g_n at ψ.
pub fn ratio(psi: f64) -> f64 {
    psi * MU / ALPHA
}
