//! What is traced: runs that depend on two parameters, and their margins.

use std::fmt::Debug;
use std::hash::Hash;

use crate::window::Point;

/// Runs that depend on two parameters.
///
/// In a *free run* every guard fires that can. Its *label* says what happens: the sequence of its
/// switches, called its itinerary. A *margin* is the value of a guard at the place where the guard
/// comes closest to firing; where the label changes, a margin vanishes. A margin belongs to the
/// itinerary that leads to its place. It is computed with this itinerary prescribed, even where the
/// free run has another one, so that it is a smooth function of the parameters through zero.
pub trait Family {
    /// What a free run does. All points of one region have the same label.
    type Label: Clone + Debug + Eq + Ord + Hash;
    /// The name of a margin.
    type Margin: Clone + Debug + Eq + Ord + Hash;
    /// Why a run failed.
    type Error: std::error::Error + 'static;

    /// The label of the free run at `point`.
    ///
    /// # Errors
    /// The run failed.
    fn label(&self, point: &Point) -> Result<Self::Label, Self::Error>;

    /// The value of `margin` at `point`: positive where its guard does not fire, negative where it
    /// does, and smooth through zero.
    ///
    /// `None` if the guard has no such extremum at `point`, or if the itinerary that leads to it
    /// cannot be followed.
    ///
    /// # Errors
    /// The run failed.
    fn margin(&self, point: &Point, margin: &Self::Margin) -> Result<Option<f64>, Self::Error>;

    /// The name that `margin` has at `point`, which lies on its boundary.
    ///
    /// A family whose margins name minima by their places updates the place here, since places move
    /// along the boundary. The default returns `margin` unchanged.
    ///
    /// # Errors
    /// The run failed.
    fn moved(&self, _point: &Point, margin: &Self::Margin) -> Result<Self::Margin, Self::Error> {
        Ok(margin.clone())
    }

    /// Whether the label changes wherever this margin passes through zero, if the free run has the
    /// itinerary that leads to it.
    ///
    /// Return `false` for a margin whose zero may leave the label unchanged. The tracer then
    /// follows it only where it has seen the label change. The default is that the label changes.
    fn is_sure(&self, _margin: &Self::Margin) -> bool {
        true
    }

    /// Pairs of margins that vanish together where the extremum of `margin` may merge with another
    /// one on its zero: at a cusp, where its boundary ends with the boundary of the other extremum.
    ///
    /// Near a cusp neither of the two extrema determines its place to all digits. The margins
    /// returned here must be smooth around it, and their boundaries must cross there. They need not
    /// be margins of any free run. The default is that none are known.
    fn cusps(&self, _margin: &Self::Margin) -> Vec<[Self::Margin; 2]> {
        Vec::new()
    }

    /// Three margins that vanish together where three extrema merge on their zero, the extremum of
    /// `margin` among them: at a swallowtail, which a plane has at single values of a third
    /// parameter. Only a [`Stack`](crate::stack::Stack) uses them. The default is that none are
    /// known.
    fn swallowtail(&self, _margin: &Self::Margin) -> Option<[Self::Margin; 3]> {
        None
    }

    /// The free run at `point` with all its margins.
    ///
    /// On a boundary close to `point`, one of these margins vanishes, or one of the margins of the
    /// free runs on the other side of the boundary.
    ///
    /// The tracer also watches each listed margin along boundaries and on the grid. So it finds
    /// boundaries that touch or that cross twice between two nodes, and islands smaller than the
    /// cells of the grid, if a free run beside them lists their margin. The margin of a guard that
    /// has fired may be listed too, with a negative value.
    ///
    /// # Errors
    /// The run failed.
    fn free_run(&self, point: &Point) -> Result<FreeRun<Self::Label, Self::Margin>, Self::Error>;
}

/// What a free run does, and how far it is from doing something else.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeRun<Label, Margin> {
    /// The label, as [`Family::label`] returns it.
    pub label: Label,
    /// Each margin once, with the value that [`Family::margin`] returns.
    pub margins: Vec<(Margin, f64)>,
}
