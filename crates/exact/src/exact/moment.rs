//! Moments of the contact, and the normal motion there as far as the tangential motion depends on
//! it.

use std::fmt::Debug;

/// A half of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Time is counted from the start.
    Compression,
    /// Time is counted back from the end.
    Decompression,
}

impl Half {
    /// The other half.
    pub fn other(self) -> Self {
        match self {
            Self::Compression => Self::Decompression,
            Self::Decompression => Self::Compression,
        }
    }

    /// The sign of the root coordinate's rate in time.
    pub fn sign(self) -> f64 {
        match self {
            Self::Compression => 1.0,
            Self::Decompression => -1.0,
        }
    }
}

/// A time of the contact, in a coordinate that a trajectory chooses and that is 0 at both ends.
///
/// Moments near either end that are closer together than neighbouring floating-point numbers around
/// t_c are still distinguished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The half of the contact, which gives the nearer end.
    pub half: Half,
    /// The root coordinate r, 0 at the end of contact that the half belongs to. Near both ends the
    /// motion is smooth in it, not in time.
    pub root: f64,
}

impl Moment {
    /// The first moment of contact.
    pub const START: Self = Self { half: Half::Compression, root: 0.0 };
    /// The last moment of contact.
    pub const END: Self = Self { half: Half::Decompression, root: 0.0 };

    /// Whether this moment lies before `other`.
    pub fn is_before(self, other: Self) -> bool {
        match (self.half, other.half) {
            (Half::Compression, Half::Decompression) => true,
            (Half::Decompression, Half::Compression) => false,
            (Half::Compression, Half::Compression) => self.root < other.root,
            (Half::Decompression, Half::Decompression) => self.root > other.root,
        }
    }

    /// The later one of this moment and `other`.
    pub fn or_later(self, other: Self) -> Self {
        if self.is_before(other) { other } else { self }
    }
}

/// A moment with the normal motion there.
#[derive(Clone, Copy, Debug)]
pub struct At<M> {
    /// The moment.
    pub moment: Moment,
    /// The normal motion.
    pub motion: M,
}

/// The tangential spring.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Scaled stiffness κ.
    pub kappa: f64,
    /// ω = √κ.
    pub omega: f64,
    /// 1/κ.
    pub compliance: f64,
    /// b = 3/(2κ).
    pub bend: f64,
}

impl Spring {
    /// A spring of the stiffness `kappa`.
    pub fn new(kappa: f64) -> Self {
        Self { kappa, omega: kappa.sqrt(), compliance: 1.0 / kappa, bend: 1.5 / kappa }
    }
}

/// The normal motion at a moment, as far as the tangential motion depends on it.
pub trait Motion: Copy + Debug {
    /// |v − v₀|, with v₀ at the end of the contact from which the moment is counted.
    fn deficit(&self) -> f64;
    /// Compression, its rate and the normal force.
    fn normal(&self) -> [f64; 3];
    /// The spring's limit L.
    fn limit(&self, spring: &Spring) -> f64;
    /// dL/dt.
    fn limit_rate(&self, spring: &Spring) -> f64;
    /// P = κL + L̈, which drives the spring and its limit apart: in slip it is −dg/dt, in stick it
    /// is D̈ + κD for D = L ∓ y.
    fn pull(&self, spring: &Spring) -> f64;
}
