//! How an atlas is made of what the tracer finds in a family.

use std::fmt::Debug;

use crate::atlas::AtlasOptions;
use crate::curve::Curve;
use crate::executor::Executor;
use crate::family::Family;
use crate::options::TraceOptions;
use crate::tracing::network::{Network, NetworkOf};
use crate::window::Point;

/// A family, with what its atlas has in the places of labels and margins, and with labels that
/// verify it.
///
/// The tracer compares the labels of the family and follows its margins. The atlas may have others
/// that are known without the family, such as texts that a file can hold. Its regions are verified
/// by labels that may come from elsewhere than those by which it was traced.
/// [`Surveyor::draw`](crate::Surveyor::draw) makes the atlas.
pub trait Draft {
    /// What is traced.
    type Family: Family;
    /// The labels of the atlas.
    type Label: Clone + Debug + Ord;
    /// What the curves of the atlas have in the place of margins.
    type Margin: Clone;
    /// Why a region cannot be verified at a point.
    type Failure: ToString;

    /// What is traced.
    fn family(&self) -> &Self::Family;

    /// The network as it stands in the atlas.
    fn drawn(&self, network: NetworkOf<Self::Family>) -> Network<Self::Label, Self::Margin>;

    /// The options of an atlas with these curves, of which it may depend how accurate they are.
    fn fitted(
        &self,
        options: &AtlasOptions,
        _curves: &[Curve<Self::Label, Self::Margin>],
    ) -> AtlasOptions {
        *options
    }

    /// The labels at points by which the regions are verified.
    fn checks<E: Executor<Self::Family>>(
        &self,
        executor: &E,
        points: &[Point],
    ) -> Vec<Result<Self::Label, Self::Failure>>;

    /// Other options with which a window may be traced in which something is in doubt. The first
    /// atlas that agrees counts.
    fn other_options(&self, _options: &TraceOptions) -> Vec<TraceOptions> {
        Vec::new()
    }
}

/// A family whose atlas has its own labels and margins, and that verifies itself.
pub(crate) struct Own<'f, F>(pub &'f F);

impl<F: Family> Draft for Own<'_, F> {
    type Family = F;
    type Label = F::Label;
    type Margin = F::Margin;
    type Failure = F::Error;

    fn family(&self) -> &F {
        self.0
    }

    fn drawn(&self, network: NetworkOf<F>) -> NetworkOf<F> {
        network
    }

    fn checks<E: Executor<F>>(
        &self,
        executor: &E,
        points: &[Point],
    ) -> Vec<Result<F::Label, F::Error>> {
        executor.labels(self.0, points)
    }
}
