//! Any family of runs as one type, so that the tracer is compiled once for all of them.

use stickslip::solver::margin::Margin;
use stickslip::tracer::{
    Family, FreeRun, Point,
    hybrid::{FamilyError, Itinerary},
};

/// A family of runs of a hybrid system.
pub type Runs<'a> = dyn Family<Label = Itinerary, Margin = Margin, Error = FamilyError> + Sync + 'a;

/// Any family of runs.
pub struct Any<'a>(pub &'a Runs<'a>);

impl Family for Any<'_> {
    type Label = Itinerary;
    type Margin = Margin;
    type Error = FamilyError;

    fn label(&self, point: &Point) -> Result<Itinerary, FamilyError> {
        self.0.label(point)
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, FamilyError> {
        self.0.margin(point, margin)
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, FamilyError> {
        self.0.moved(point, margin)
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        self.0.is_sure(margin)
    }

    fn cusps(&self, margin: &Margin) -> Vec<[Margin; 2]> {
        self.0.cusps(margin)
    }

    fn swallowtail(&self, margin: &Margin) -> Option<[Margin; 3]> {
        self.0.swallowtail(margin)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, FamilyError> {
        self.0.free_run(point)
    }
}
