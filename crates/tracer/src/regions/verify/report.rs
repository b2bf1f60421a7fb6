//! What a verification finds, and its error.

use crate::regions::finding::{Euler, SubdivisionError};
use crate::regions::locate::Location;
use crate::regions::region::Side;
use crate::window::Point;

/// A place at which a label was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Where.
    pub point: Point,
    /// Why there.
    pub origin: Origin,
}

/// Why a label was tried at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Origin {
    /// The sample point of a region.
    Sample,
    /// A random point of the window.
    Random,
    /// Beside a curve.
    Near {
        /// The curve.
        curve: usize,
        /// Which side of it.
        side: Side,
        /// Distance from it.
        distance: f64,
    },
}

/// A place at which the label is not that of the region.
#[derive(Clone, Debug, PartialEq)]
pub struct Mismatch<Label> {
    /// Where.
    pub checkpoint: Checkpoint,
    /// The region by location.
    pub region: usize,
    /// Its label.
    pub expected: Label,
    /// The label of the run.
    pub found: Label,
    /// The nearest place of the same region at which the label was as expected. A boundary that is
    /// missing, or one that is misplaced, leads between both points: a bracket to start
    /// tracing from.
    pub agreeing: Option<Point>,
}

/// A place about which nothing is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Unverified<Error> {
    /// Where.
    pub checkpoint: Checkpoint,
    /// Why.
    pub reason: Reason<Error>,
}

/// Why nothing is known about a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason<Error> {
    /// It is within the tolerance of a curve, or in no region.
    Location(Location),
    /// The region has no label: no curve bounds it, and the run at its sample point failed.
    NoLabel {
        /// The region.
        region: usize,
    },
    /// The run failed.
    Run(Error),
}

/// What a verification found.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification<Label, Error> {
    /// The counts of Euler's formula.
    pub euler: Euler,
    /// How many findings the subdivision has.
    pub findings: usize,
    /// How many places were tried in each region.
    pub tried: Vec<usize>,
    /// Where the label was another one, in the order in which places were tried.
    pub mismatches: Vec<Mismatch<Label>>,
    /// Places about which nothing is known.
    pub unverified: Vec<Unverified<Error>>,
    /// Curves beside which no label was tried on one side at least.
    pub untried_curves: Vec<usize>,
    /// Share of the window's area in regions that were tried without a mismatch.
    pub tried_area: f64,
    /// With 95 % confidence, the share of the window's area that has another label is below this:
    /// the upper limit of Clopper and Pearson (1934), from the random points.
    pub wrong_area_bound: f64,
}

impl<Label, Error> Verification<Label, Error> {
    /// Pairs of places in one region by location, of which one has the label of the region and the
    /// other has not: between them lies a boundary for
    /// [`Tracer::look_between`](crate::Tracer::look_between) to find.
    #[must_use]
    pub fn brackets(&self) -> Vec<[Point; 2]> {
        let bracket = |mismatch: &Mismatch<Label>| {
            mismatch.agreeing.map(|agreeing| [agreeing, mismatch.checkpoint.point])
        };
        self.mismatches.iter().filter_map(bracket).collect()
    }

    /// Whether nothing speaks against the subdivision.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.findings == 0 && self.euler.holds() && self.mismatches.is_empty()
    }
}

/// Verification cannot be done.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum VerifyError {
    /// The curves make no subdivision.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The distances from curves are not in order.
    #[error(
        "distances from {nearest:e} to {farthest:e}: both must be finite and above 0, the first not the greater"
    )]
    Distances {
        /// Least distance.
        nearest: f64,
        /// Greatest distance.
        farthest: f64,
    },
    /// Not one label a point came back.
    #[error("{points} points have {labels} labels")]
    Labels {
        /// How many points.
        points: usize,
        /// How many labels.
        labels: usize,
    },
}
