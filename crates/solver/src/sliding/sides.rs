//! The mode of a sliding system: on which side of each surface it is.

use std::fmt;

use crate::sliding::MOST;

/// Where a state is with respect to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceSide {
    /// Where the surface's function is positive; its sign is +1.
    Above,
    /// Where the surface's function is negative; its sign is −1.
    Below,
    /// On the surface, along which the state slides.
    Sliding,
}

impl SurfaceSide {
    /// The sign of the side, 0 while it slides.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Above => 1.0,
            Self::Below => -1.0,
            Self::Sliding => 0.0,
        }
    }

    /// The side on which a surface's function has this value.
    pub(super) fn of(value: f64) -> Self {
        if value < 0.0 { Self::Below } else { Self::Above }
    }
}

/// Why the solution does not go on from a state on one or more surfaces, or goes on in several
/// ways.
///
/// A transition cannot fail, so a refusal is a mode. Its field is NaN, which ends the run with an
/// error, and the switch to the mode says why.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The equations for the multipliers are singular: infinitely many of them hold the state on
    /// the surfaces.
    #[error("the equations for the multipliers of the surfaces are singular")]
    Singular,
    /// The solution can go on in several ways.
    #[error("the solution is not unique: it can leave the surfaces in several ways")]
    NotUnique,
    /// The solution can go on in none of the ways that are considered.
    #[error("neither a side of the surfaces nor sliding along them continues the solution")]
    NoSolution,
    /// The field is not a sum of parts that each depend on one sign.
    #[error("the field is not affine in the signs of the surfaces")]
    NotAffine,
    /// The field, a surface or a rate is not finite.
    #[error("the field or a surface is not finite")]
    NotFinite,
}

/// The sides of all surfaces, and how the guards of the mode start.
#[expect(clippy::struct_field_names, reason = "the sides are one of the fields")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Sides {
    pub(super) count: usize,
    pub(super) sides: [SurfaceSide; MOST],
    /// The orders of the zeros from which the two guards of each surface start.
    pub(super) zeros: [[u8; 2]; MOST],
    /// Whether another way to go on was left out.
    pub(super) unique: bool,
    pub(super) refusal: Option<Refusal>,
}

impl Sides {
    /// These sides of the first `count` surfaces, with guards that do not start from zero.
    pub(super) fn new(count: usize, sides: [SurfaceSide; MOST]) -> Self {
        Self { count, sides, zeros: [[0; 2]; MOST], unique: true, refusal: None }
    }

    /// These sides, from which the solution does not go on.
    pub(super) fn refused(self, refusal: Refusal) -> Self {
        Self { refusal: Some(refusal), zeros: [[0; 2]; MOST], ..self }
    }

    pub(super) fn all(&self) -> &[SurfaceSide] {
        &self.sides[..self.count]
    }

    /// The surfaces along which the state slides.
    pub(super) fn sliding(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.count).filter(|&i| self.sides[i] == SurfaceSide::Sliding)
    }
}

/// A mode of a sliding system: the mode of the system itself, and the side of each surface.
///
/// Modes come from [`Filippov::mode`](crate::sliding::Filippov::mode) and from transitions.
#[derive(Clone, Copy, PartialEq)]
pub struct SlidingMode<Mode> {
    /// The mode of the system itself.
    pub own: Mode,
    pub(super) surfaces: Sides,
}

impl<Mode> SlidingMode<Mode> {
    /// A mode with these sides of up to 4 surfaces, from which a transition leads on: for systems
    /// that keep modes of their own.
    pub fn at(own: Mode, sides: &[SurfaceSide]) -> Self {
        let mut all = [SurfaceSide::Above; MOST];
        all.iter_mut().zip(sides).for_each(|(all, side)| *all = *side);
        Self { own, surfaces: Sides::new(sides.len().min(MOST), all) }
    }

    /// Whether the state has just left this surface, whose function starts from a double zero: the
    /// rate of the function is zero, too.
    #[must_use]
    pub fn is_released(&self, surface: usize) -> bool {
        let released = |zeros: &[u8; 2]| zeros[0] > 1;
        self.sides().get(surface).is_some_and(|&side| side != SurfaceSide::Sliding)
            && self.surfaces.zeros.get(surface).is_some_and(released)
    }

    /// The side of each surface.
    #[must_use]
    pub fn sides(&self) -> &[SurfaceSide] {
        self.surfaces.all()
    }

    /// Whether the solution could go on in this way only, where the mode was entered.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        self.surfaces.unique
    }

    /// A mode from which nothing goes on: the right-hand side is NaN.
    pub fn refused(own: Mode, refusal: Refusal) -> Self {
        let surfaces = Sides::new(0, [SurfaceSide::Above; MOST]).refused(refusal);
        Self { own, surfaces }
    }

    /// This mode after its first step, where its guards have left their zeros.
    pub(super) fn settled(self) -> Self {
        Self { surfaces: Sides { zeros: [[0; 2]; MOST], ..self.surfaces }, ..self }
    }

    /// Why the solution does not go on. The right-hand side is then NaN, so that a run ends with
    /// [`RunError::Field`](crate::RunError::Field) right behind the switch to this mode.
    #[must_use]
    pub fn refusal(&self) -> Option<Refusal> {
        self.surfaces.refusal
    }
}

/// For instance `() [Above, Sliding]`.
impl<Mode: fmt::Debug> fmt::Debug for SlidingMode<Mode> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} {:?}", self.own, self.sides())?;
        match self.refusal() {
            Some(refusal) => write!(f, " refused: {refusal}"),
            None if !self.is_unique() => write!(f, " not unique"),
            None => Ok(()),
        }
    }
}
