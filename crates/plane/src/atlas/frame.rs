//! The window of an atlas.

use stickslip_model::{InvalidValue, Law, Reduction};

use crate::chart::{Chart, Range};
use crate::family::CollisionPlane;
use crate::sheet::{Sheet, ToleranceRange};

/// The window of an atlas, and what all its collisions have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Scaled stiffness κ; the lower end is above 0.
    pub kappa: Range,
    /// Reduced impact ratio ψ; the lower end is above 0.
    pub psi: Range,
    /// The impact ratios from which ψ was reduced, if the window was given in impact ratios.
    pub ratio: Option<RatioRange>,
    /// Scaled damping.
    pub damping: f64,
    /// The contact law.
    pub law: Law,
    /// Tangential damping.
    pub tangential_damping: f64,
}

/// An interval of impact ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioRange {
    /// The interval of g_t/g_n.
    pub range: Range,
    /// Friction and inertia, which reduce the ratio to ψ.
    pub reduction: Reduction,
}

impl Frame {
    /// A window of collisions that obey the paper's law.
    pub fn new(kappa: Range, psi: Range, damping: f64) -> Self {
        Self { kappa, psi, ratio: None, damping, law: Law::PAPER, tangential_damping: 0.0 }
    }

    /// The window of a plane of κ and ψ.
    pub(super) fn of(plane: &CollisionPlane) -> Self {
        let [kappa, psi] = plane.sheet().sides;
        let any = plane.first();
        let (law, tangential_damping) = (any.law(), any.tangential_damping());
        Self { law, tangential_damping, ..Self::new(kappa, psi, any.damping()) }
    }

    /// The window in its traced coordinates.
    fn sheet(&self) -> Sheet {
        let integrated = !self.law.acts_as_paper(self.damping, self.tangential_damping);
        let chart = Chart::of(self.kappa, self.psi);
        Sheet { sides: [self.kappa, self.psi], chart, integrated }
    }

    /// The accuracies in ψ that boundaries can have.
    pub fn tolerances(&self) -> ToleranceRange {
        self.sheet().tolerances()
    }

    /// Refuses a window that is too narrow for the accuracy of its boundaries.
    ///
    /// # Errors
    /// [`InvalidValue`] has the size of the window.
    pub fn require_wide(&self) -> Result<(), InvalidValue> {
        self.sheet().require_wide(CollisionPlane::SCALED)
    }

    /// The collisions in the window.
    ///
    /// # Errors
    /// [`InvalidValue`]: no collision has these values.
    pub fn plane(&self) -> Result<CollisionPlane, InvalidValue> {
        let Self { kappa, psi, damping, ratio, .. } = *self;
        let mu = ratio.map_or(1.0, |ratio| ratio.reduction.mu);
        let expected = "a number above 0: without friction eps_t is 1 everywhere";
        InvalidValue::check("mu", mu, expected, mu > 0.0)?;
        CollisionPlane::new((kappa.low, kappa.high), (psi.low, psi.high), damping)?
            .with_law(self.law, self.tangential_damping)
    }
}
