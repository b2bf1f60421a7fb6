//! The impact ratio g_t/g_n and its reduced form ψ.

/// The numbers μ and α that reduce the impact ratio: ψ = (g_t/g_n)·α/μ, equation (23) of Schwager,
/// Becker and Pöschel (2008).
///
/// ```
/// use stickslip_model::Reduction;
///
/// // Homogeneous spheres with μ = 0.4: from g_t/g_n = 2μ/α on, where ψ = 2, there is sliding only.
/// let reduction = Reduction::default();
/// assert!((reduction.ratio(2.0) - 2.8).abs() < 1e-15);
/// assert!((reduction.psi(2.8) - 2.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reduction {
    /// Coulomb's coefficient of friction μ.
    pub mu: f64,
    /// Tangential inertia α: 2/7 for homogeneous spheres, at most 1.
    pub alpha: f64,
}

impl Reduction {
    /// μ = 0.4 and α = 2/7, homogeneous spheres: the values of all figures of the paper.
    pub const HOMOGENEOUS: Self = Self { mu: 0.4, alpha: 2.0 / 7.0 };

    /// ψ at the impact ratio g_t/g_n.
    #[must_use]
    pub fn psi(&self, ratio: f64) -> f64 {
        ratio * self.alpha / self.mu
    }

    /// The impact ratio g_t/g_n at ψ.
    #[must_use]
    pub fn ratio(&self, psi: f64) -> f64 {
        psi * self.mu / self.alpha
    }
}

impl Default for Reduction {
    /// [`Self::HOMOGENEOUS`].
    fn default() -> Self {
        Self::HOMOGENEOUS
    }
}
