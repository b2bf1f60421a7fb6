//! A pair that is chosen at run time.

use std::fmt;
use std::str::FromStr;

use stickslip_number::InvalidValue;

use crate::method::dop853::Dop853;
use crate::method::dopri5::Dopri5;
use crate::method::tableau::Method;

/// A pair that is chosen at run time, for [`run_with`](crate::run_with). It has the name of its
/// method ([`Method::NAME`]).
///
/// ```
/// use stickslip_solver::EmbeddedPair;
///
/// let pair: EmbeddedPair = "dopri5".parse()?;
/// assert_eq!((pair, pair.order()), (EmbeddedPair::Dopri5, 5));
/// assert!(EmbeddedPair::ALL.iter().all(|pair| pair.to_string().parse() == Ok(*pair)));
/// assert!("euler".parse::<EmbeddedPair>().is_err());
/// # Ok::<(), stickslip_solver::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EmbeddedPair {
    /// Dormand–Prince 5(4): [`Dopri5`].
    Dopri5,
    /// Dormand–Prince 8(5,3): [`Dop853`].
    #[default]
    Dop853,
}

impl EmbeddedPair {
    /// All pairs.
    pub const ALL: [Self; 2] = [Self::Dopri5, Self::Dop853];

    /// The usual name of the pair.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dopri5 => Dopri5::NAME,
            Self::Dop853 => Dop853::NAME,
        }
    }

    /// The order of the solution that is propagated.
    #[must_use]
    pub const fn order(self) -> usize {
        match self {
            Self::Dopri5 => Dopri5::ORDER,
            Self::Dop853 => Dop853::ORDER,
        }
    }

    /// The number of stages of a step.
    #[must_use]
    pub const fn stages(self) -> usize {
        match self {
            Self::Dopri5 => Dopri5::STAGES,
            Self::Dop853 => Dop853::STAGES,
        }
    }

    /// The degree of the dense output.
    #[must_use]
    pub const fn dense_degree(self) -> usize {
        match self {
            Self::Dopri5 => Dopri5::DENSE_DEGREE,
            Self::Dop853 => Dop853::DENSE_DEGREE,
        }
    }
}

impl From<Dopri5> for EmbeddedPair {
    fn from(Dopri5: Dopri5) -> Self {
        Self::Dopri5
    }
}

impl From<Dop853> for EmbeddedPair {
    fn from(Dop853: Dop853) -> Self {
        Self::Dop853
    }
}

impl fmt::Display for EmbeddedPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for EmbeddedPair {
    type Err = InvalidValue;

    fn from_str(name: &str) -> Result<Self, InvalidValue> {
        let found = Self::ALL.into_iter().find(|pair| pair.name() == name);
        found.ok_or_else(|| InvalidValue::new("method", name, "\"dopri5\" or \"dop853\""))
    }
}
