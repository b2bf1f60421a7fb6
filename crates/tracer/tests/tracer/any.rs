//! Any family as one type, so that the tracer is compiled once for all with the same labels,
//! margins and errors: it is compiled anew for each type of family, which takes seconds.

use std::fmt::Debug;
use std::hash::Hash;

use stickslip_tracer::{Family, FreeRun, Point};

/// Any family with these labels, margins and errors.
pub struct Any<'a, Label, Margin, Error>(Boxed<'a, Label, Margin, Error>);

type Boxed<'a, L, M, E> = Box<dyn Family<Label = L, Margin = M, Error = E> + Sync + 'a>;

/// The family as one of any type.
pub fn any<'a, F>(family: F) -> Any<'a, F::Label, F::Margin, F::Error>
where
    F: Family + Sync + 'a,
{
    Any(Box::new(family))
}

impl<Label, Margin, Error> Family for Any<'_, Label, Margin, Error>
where
    Label: Clone + Debug + Eq + Ord + Hash,
    Margin: Clone + Debug + Eq + Ord + Hash,
    Error: std::error::Error + 'static,
{
    type Label = Label;
    type Margin = Margin;
    type Error = Error;

    fn label(&self, point: &Point) -> Result<Label, Error> {
        self.0.label(point)
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Error> {
        self.0.margin(point, margin)
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, Error> {
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

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Error> {
        self.0.free_run(point)
    }
}
