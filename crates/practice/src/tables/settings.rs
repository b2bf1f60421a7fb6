//! The settings of a table.

use stickslip_model::spheres::BodyPair;
use stickslip_model::{InvalidValue, Law};
use stickslip_plane::atlas::Frame;
use stickslip_plane::{CollisionPlane, Range};

use super::TableError;

/// The window of a table and its bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSettings {
    /// The window.
    pub window: TableWindow,
    /// The bound of the errors, from [`Self::FINEST`] to [`Self::COARSEST`].
    pub bound: f64,
    /// Whether the table has the regions of the atlas.
    pub regions: bool,
}

/// The window of a table: intervals of its two axes, which are above 0, and what all its collisions
/// have in common.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum TableWindow {
    /// κ and ψ at one damping.
    Scaled {
        /// Scaled stiffness κ.
        kappa: Range,
        /// Reduced impact ratio ψ.
        psi: Range,
        /// Scaled damping.
        damping: f64,
        /// The contact law.
        #[serde(default, skip_serializing_if = "is_paper")]
        law: Law,
        /// Tangential damping b = (γ_t/γ_n)/α.
        #[serde(default, skip_serializing_if = "is_zero")]
        tangential_damping: f64,
    },
    /// The velocities of the surfaces of two bodies.
    Velocities {
        /// The bodies.
        pair: BodyPair,
        /// Normal velocity g_n in m/s.
        normal_m_per_s: Range,
        /// Tangential velocity g_t in m/s.
        tangential_m_per_s: Range,
    },
}

impl TableWindow {
    /// The names of both axes.
    pub fn names(&self) -> [&'static str; 2] {
        match self {
            Self::Scaled { .. } => CollisionPlane::SCALED,
            Self::Velocities { .. } => CollisionPlane::VELOCITIES,
        }
    }

    /// The intervals of both axes.
    pub fn sides(&self) -> [Range; 2] {
        match *self {
            Self::Scaled { kappa, psi, .. } => [kappa, psi],
            Self::Velocities { normal_m_per_s, tangential_m_per_s, .. } => {
                [normal_m_per_s, tangential_m_per_s]
            }
        }
    }

    /// Whether the collisions of the window are integrated.
    fn is_integrated(&self) -> bool {
        let (law, damped, tangential_damping) = match *self {
            Self::Scaled { law, damping, tangential_damping, .. } => {
                (law, damping, tangential_damping)
            }
            Self::Velocities { pair, .. } => {
                (pair.law, pair.surface.damping_time_s, pair.tangential_damping_ratio)
            }
        };
        !law.acts_as_paper(damped, tangential_damping)
    }

    /// The collisions of the window.
    ///
    /// # Errors
    /// [`InvalidValue`]: a value that no collision can have.
    pub fn plane(&self) -> Result<CollisionPlane, InvalidValue> {
        match *self {
            Self::Scaled { kappa, psi, damping, law, tangential_damping } => {
                let frame = Frame::new(kappa, psi, damping);
                Frame { law, tangential_damping, ..frame }.plane()
            }
            Self::Velocities { pair, .. } => CollisionPlane::velocities(pair, self.sides()),
        }
    }
}

impl Default for TableSettings {
    /// κ from 0.5 to 100 and ψ from 0.01 to 3 without damping, to 1e-8, without regions.
    fn default() -> Self {
        let kappa = Range { low: 0.5, high: 100.0 };
        let psi = Range { low: 0.01, high: 3.0 };
        let (damping, tangential_damping, law) = (0.0, 0.0, Law::PAPER);
        let window = TableWindow::Scaled { kappa, psi, damping, law, tangential_damping };
        Self { window, bound: 1e-8, regions: false }
    }
}

impl TableSettings {
    /// The finest bound.
    pub const FINEST: f64 = 1e-12;
    /// The finest bound where collisions are integrated.
    pub const FINEST_INTEGRATED: f64 = 1e-9;
    /// The coarsest bound.
    pub const COARSEST: f64 = 1e-3;
    /// Most strips, for which up to 850 MB are needed.
    pub const MOST_STRIPS: usize = 1_000_000;

    /// Checks all settings but those that an atlas checks.
    ///
    /// # Errors
    /// [`TableError::Settings`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), TableError> {
        let finest =
            if self.window.is_integrated() { Self::FINEST_INTEGRATED } else { Self::FINEST };
        let coarsest = Self::COARSEST;
        if !(finest..=coarsest).contains(&self.bound) {
            let expected = format!("{finest:e} to {coarsest:e}");
            return Err(InvalidValue::new("bound", self.bound, expected).into());
        }
        for (name, Range { low, high }) in self.window.names().into_iter().zip(self.window.sides())
        {
            let accepted = low > 0.0 && high > low && high.is_finite();
            let expected = "an ascending interval above 0";
            InvalidValue::check(name, [low, high], expected, accepted)?;
        }
        Ok(())
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_paper(law: &Law) -> bool {
    *law == Law::PAPER
}
