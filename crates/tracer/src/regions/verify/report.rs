//! What a verification finds, and its error.

use crate::regions::finding::{Euler, Finding};
use crate::regions::locate::Location;
use crate::regions::region::CurveSide;
use crate::regions::subdivision::Subdivision;
use crate::window::Point;

/// A point at which a label was computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint {
    /// The point.
    pub point: Point,
    /// Why this point was chosen.
    pub origin: Origin,
}

/// Why a point was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Origin {
    /// The sample point of a region.
    Sample,
    /// A random point of the window.
    Random,
    /// A random point beside a curve.
    Near {
        /// The index of the curve.
        curve: usize,
        /// The side of the curve.
        side: CurveSide,
        /// The distance from the curve.
        distance: f64,
    },
}

/// A point at which the label differs from the label of its region.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mismatch<Label> {
    /// The point.
    pub checkpoint: Checkpoint,
    /// The index of the region in which the point lies.
    pub region: usize,
    /// The label of the region.
    pub expected: Label,
    /// The label of the run.
    pub found: Label,
    /// The nearest point of the same region at which the label was as expected. Between the two
    /// points passes a boundary that is missing or misplaced, so that tracing can start there.
    pub agreeing: Option<Point>,
}

/// A point that could not be verified.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Unverified<Error> {
    /// The point.
    pub checkpoint: Checkpoint,
    /// Why the point could not be verified.
    pub reason: Reason<Error>,
}

/// Why a point could not be verified.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Reason<Error> {
    /// The point is closer to a curve than the tolerance, or in no region.
    Location(Location),
    /// The region has no label, because no curve bounds it and the run at its sample point failed.
    NoLabel {
        /// The index of the region.
        region: usize,
    },
    /// The run failed.
    Run(Error),
}

/// What a verification found.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Verification<Label, Error> {
    /// The counts of Euler's formula.
    pub euler: Euler,
    /// The number of findings of the subdivision that [stand](Self::standing).
    pub findings: usize,
    /// The number of points in each region at which a label was compared.
    pub tried: Vec<usize>,
    /// The points with another label, in the order in which the points were chosen.
    pub mismatches: Vec<Mismatch<Label>>,
    /// The points that could not be verified.
    pub unverified: Vec<Unverified<Error>>,
    /// The indices of curves without a compared label on at least one side.
    pub untried_curves: Vec<usize>,
    /// The fraction of the window's area in regions with compared labels and without a mismatch.
    pub tried_area: f64,
    /// With 95 % confidence, the fraction of the window's area with another label is below this
    /// value. It is the upper limit of Clopper and Pearson (1934) for the random points.
    pub wrong_area_bound: f64,
}

impl<Label, Error> Verification<Label, Error> {
    /// Pairs of points in one region, the first with the label of the region and the second with
    /// another label. Between them passes a boundary, which
    /// [`Tracer::look_between`](crate::tracing::Tracer::look_between) can find.
    #[must_use]
    pub fn brackets(&self) -> Vec<[Point; 2]> {
        let bracket = |mismatch: &Mismatch<Label>| {
            mismatch.agreeing.map(|agreeing| [agreeing, mismatch.checkpoint.point])
        };
        self.mismatches.iter().filter_map(bracket).collect()
    }

    /// The points without a known label: the run failed, or the point is in no region. Points
    /// within the error of a curve are left out, since the curve leaves their region open.
    pub fn failed(&self) -> impl Iterator<Item = &Unverified<Error>> {
        let on_curve = |reason: &Reason<Error>| {
            matches!(reason, Reason::Location(Location::OnBoundary { .. }))
        };
        self.unverified.iter().filter(move |open| !on_curve(&open.reason))
    }

    /// The findings of the subdivision that the runs do not settle. A region that is not wider than
    /// the tolerance is there if the run at its sample point has its label.
    pub fn standing<'p, Margin>(
        &self,
        plane: &'p Subdivision<Label, Margin>,
    ) -> impl Iterator<Item = &'p Finding<Label>> {
        plane.findings().iter().filter(|finding| match finding {
            Finding::Thin { region, .. } => self.tried.get(*region).is_none_or(|tried| *tried == 0),
            _ => true,
        })
    }

    /// Whether there is no evidence against the subdivision.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.findings == 0 && self.euler.holds() && self.mismatches.is_empty()
    }
}
