//! What the tracer follows: a family of runs in two parameters, and the margins that they leave.

use std::fmt::Debug;
use std::hash::Hash;

use nalgebra::Vector2;

/// A point of the parameter plane, in the coordinates in which it is traced.
///
/// A family that spans decades chooses logarithms here and converts on its own side.
pub type Point = Vector2<f64>;

/// Runs that depend on two parameters.
///
/// A free run has a *label*, the itinerary of its switches. Where the label changes, a *margin*
/// vanishes: the value of a guard where it comes closest to firing. A margin belongs to the
/// itinerary that leads to that place and is followed through zero with the itinerary held fixed,
/// so that it is a smooth function of the parameters.
pub trait Family {
    /// What a free run does; two points of one region have the same.
    type Label: Clone + Debug + Eq + Ord + Hash;
    /// Which margin.
    type Margin: Clone + Debug + Eq + Ord + Hash;
    /// Why a run failed.
    type Error: std::error::Error + 'static;

    /// The label of the free run at `point`.
    ///
    /// # Errors
    /// The run failed.
    fn label(&self, point: &Point) -> Result<Self::Label, Self::Error>;

    /// The margin `margin` at `point`: positive where its guard does not fire, negative beyond,
    /// smooth through zero.
    ///
    /// `None` where there is no such extremum, or the itinerary that leads to it cannot be
    /// followed.
    ///
    /// # Errors
    /// The run failed.
    fn margin(&self, point: &Point, margin: &Self::Margin) -> Result<Option<f64>, Self::Error>;

    /// `margin` as it is to be named at `point`, which lies on its boundary: a family that tells
    /// the minima of a guard apart by where they are moves such hints along.
    ///
    /// # Errors
    /// The run failed.
    fn moved(&self, _point: &Point, margin: &Self::Margin) -> Result<Self::Margin, Self::Error> {
        Ok(margin.clone())
    }

    /// The free run at `point` with all its margins: a boundary through a place close by is the
    /// zero of one of them, or of one of those at the places on the boundary's other side.
    ///
    /// Each listed margin is also watched along boundaries and on the grid: two boundaries that
    /// touch or cross twice between two nodes, and islands smaller than the grid's cells, are
    /// found if a free run beside them lists the margin. A margin may be listed with a negative
    /// value, for a guard that has fired.
    ///
    /// # Errors
    /// The run failed.
    fn free_run(&self, point: &Point) -> Result<FreeRun<Self::Label, Self::Margin>, Self::Error>;
}

/// What a free run does and how far it is from doing something else.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeRun<Label, Margin> {
    /// The same as [`Family::label`] returns.
    pub label: Label,
    /// Each margin once, with the value that [`Family::margin`] returns.
    pub margins: Vec<(Margin, f64)>,
}

/// A rectangle of the parameter plane, in the coordinates of [`Point`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The corner with the least coordinates.
    pub low: Point,
    /// The corner with the greatest.
    pub high: Point,
}

impl Window {
    /// Width and height.
    #[must_use]
    pub fn extent(&self) -> Point {
        self.high - self.low
    }

    /// Whether a point lies inside or on the edge.
    #[must_use]
    pub fn contains(&self, point: &Point) -> bool {
        (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&point[axis]))
    }
}
