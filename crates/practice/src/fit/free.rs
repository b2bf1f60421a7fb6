//! What can be fitted, and where it is looked for.

use stickslip_plane::Range;

/// A number that can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Free {
    /// The tangential stiffness, as κ at normal incidence.
    Kappa,
    /// Coefficient of friction μ.
    Mu,
    /// Tangential damping b.
    TangentialDamping,
    /// Damping a at normal incidence, which is fitted to ε_n alone.
    Damping,
}

impl Free {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Kappa, Self::Mu, Self::TangentialDamping, Self::Damping];

    /// The name in files: `kappa`, `mu`, `tangential_damping` or `damping`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kappa => "kappa",
            Self::Mu => "mu",
            Self::TangentialDamping => "tangential_damping",
            Self::Damping => "damping",
        }
    }

    /// The number with a name; `k_t` is another one for `kappa`.
    pub fn find(name: &str) -> Option<Self> {
        let name = if name == "k_t" { "kappa" } else { name };
        Self::ALL.into_iter().find(|free| free.name() == name)
    }
}
impl serde::Serialize for Free {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// The ranges in which numbers are fitted.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Ranges {
    /// κ at normal incidence.
    pub kappa: Range,
    /// μ.
    pub mu: Range,
    /// Tangential damping b.
    pub tangential_damping: Range,
    /// Damping a at normal incidence.
    pub damping: Range,
}

impl Default for Ranges {
    /// κ from 0.1 to 150, μ from 0.01 to 2, b from 0 to 4, a from 0 to 3.
    fn default() -> Self {
        let range = |low, high| Range { low, high };
        Self {
            kappa: range(0.1, 150.0),
            mu: range(0.01, 2.0),
            tangential_damping: range(0.0, 4.0),
            damping: range(0.0, 3.0),
        }
    }
}

impl Ranges {
    /// The range of a number.
    pub fn of(&self, free: Free) -> Range {
        match free {
            Free::Kappa => self.kappa,
            Free::Mu => self.mu,
            Free::TangentialDamping => self.tangential_damping,
            Free::Damping => self.damping,
        }
    }

    /// The range of a number, to be changed.
    pub fn of_mut(&mut self, free: Free) -> &mut Range {
        match free {
            Free::Kappa => &mut self.kappa,
            Free::Mu => &mut self.mu,
            Free::TangentialDamping => &mut self.tangential_damping,
            Free::Damping => &mut self.damping,
        }
    }
}
