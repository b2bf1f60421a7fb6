//! Regions that were traced, verified and looked at again, with all that speaks against them.

use crate::family::Family;
use crate::options::{TraceError, TraceOptions};
use crate::regions::finding::{Finding, SubdivisionError};
use crate::regions::locate::Location;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::report::{Verification, VerifyError};
use crate::regions::verify::{VerifyOptions, verify};
use crate::tracing::network::{NetworkOf, TraceStatistics, Unresolved};
use crate::tracing::trace::Tracer;
use crate::window::{Point, Window};

/// The options of an [`Atlas`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasOptions {
    /// How boundaries are traced.
    pub trace: TraceOptions,
    /// The accuracy that is claimed for the curves, see [`Subdivision::new`].
    pub tolerance: f64,
    /// Where the regions are compared with runs.
    pub verify: VerifyOptions,
    /// The greatest number of rounds, at least 1. In each round the regions are verified, and the
    /// tracer looks again where runs have other labels.
    pub rounds: usize,
}

impl Default for AtlasOptions {
    fn default() -> Self {
        let (trace, verify) = (TraceOptions::default(), VerifyOptions::default());
        Self { trace, tolerance: 1e-9, verify, rounds: 8 }
    }
}

/// The regions of a family in a window, with all that speaks against them.
///
/// ```
/// use std::convert::Infallible;
/// use stickslip_tracer::{Atlas, AtlasOptions, Family, FreeRun, Point, Window};
///
/// /// A guard that fires inside a small circle.
/// struct Disc;
///
/// impl Family for Disc {
///     type Label = bool;
///     type Margin = ();
///     type Error = Infallible;
///     fn label(&self, p: &Point) -> Result<bool, Infallible> {
///         Ok(p.norm() < 0.3)
///     }
///     fn margin(&self, p: &Point, (): &()) -> Result<Option<f64>, Infallible> {
///         Ok(Some(p.norm_squared() - 0.09))
///     }
///     fn free_run(&self, p: &Point) -> Result<FreeRun<bool, ()>, Infallible> {
///         Ok(FreeRun { label: self.label(p)?, margins: vec![((), p.norm_squared() - 0.09)] })
///     }
/// }
///
/// let window = Window { low: Point::new(-1.0, -1.0), high: Point::new(1.0, 1.0) };
/// let atlas = Atlas::of(&Disc, &window, &AtlasOptions::default())?;
/// assert!(atlas.agrees() && atlas.plane.regions().len() == 2);
/// assert_eq!(atlas.label(&Point::new(0.1, 0.2)), Some(&true));
/// # Ok::<(), stickslip_tracer::AtlasError<Infallible>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Atlas<Label, Margin, Error> {
    /// The regions.
    pub plane: Subdivision<Label, Margin>,
    /// What the trace could not explain.
    pub unresolved: Vec<Unresolved<Label>>,
    /// What the comparison with runs found.
    pub verification: Verification<Label, Error>,
    /// The work of the trace.
    pub statistics: TraceStatistics,
    /// The number of rounds.
    pub rounds: usize,
    /// Whether each region is in doubt.
    doubtful: Vec<bool>,
}

/// The atlas of a family.
pub type AtlasOf<F> = Atlas<<F as Family>::Label, <F as Family>::Margin, <F as Family>::Error>;

/// Why there is no atlas.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AtlasError<E: std::error::Error + 'static> {
    /// The trace failed.
    #[error(transparent)]
    Trace(#[from] TraceError<E>),
    /// The window or the tolerance makes no subdivision.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The options of the verification are not possible.
    #[error(transparent)]
    Verify(#[from] VerifyError),
}

impl<Label: Clone + Ord, Margin: Clone, Error> Atlas<Label, Margin, Error> {
    /// Traces, subdivides and verifies a family in a window, and looks again where the verification
    /// finds other labels, until it finds none or nothing new comes.
    ///
    /// What cannot be resolved is part of the result: [`Self::unresolved`] and
    /// [`Self::verification`] say what and where, and the regions that it touches are in doubt.
    ///
    /// # Errors
    /// The options or the window are not possible, or a run fails.
    pub fn of<F>(
        family: &F,
        window: &Window,
        options: &AtlasOptions,
    ) -> Result<Self, AtlasError<Error>>
    where
        F: Family<Label = Label, Margin = Margin, Error = Error>,
        Error: std::error::Error + 'static,
    {
        let mut tracer = Tracer::new(family, window, &options.trace)?;
        tracer.explore()?;
        let mut rounds = 1;
        loop {
            let atlas = Self::assemble(family, tracer.network(), options, rounds)?;
            let brackets = atlas.verification.brackets();
            if rounds >= options.rounds || !tracer.look_between(&brackets)? {
                return Ok(atlas);
            }
            rounds += 1;
        }
    }

    /// The regions of a network, verified.
    fn assemble<F>(
        family: &F,
        network: NetworkOf<F>,
        options: &AtlasOptions,
        rounds: usize,
    ) -> Result<Self, AtlasError<Error>>
    where
        F: Family<Label = Label, Margin = Margin, Error = Error>,
        Error: std::error::Error + 'static,
    {
        let NetworkOf::<F> { window, mut curves, vertices, statistics, mut unresolved } = network;
        let plane = loop {
            let made =
                Subdivision::new(window, curves.clone(), vertices.clone(), options.tolerance);
            match made {
                Err(SubdivisionError::NoLength { curve }) => {
                    let curve = curves.remove(curve);
                    let point = curve.nodes[0].point;
                    unresolved.push(Unresolved::NoLength { point, labels: curve.sides });
                }
                made => break made?,
            }
        };
        let verification = verify(&plane, family, &options.verify)?;
        let doubtful = doubtful(&plane, &unresolved, &verification);
        Ok(Self { plane, unresolved, verification, statistics, rounds, doubtful })
    }
}

impl<Label, Margin, Error> Atlas<Label, Margin, Error> {
    /// Whether nothing speaks against the atlas: nothing is unresolved, and the verification agrees.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.unresolved.is_empty() && self.verification.agrees()
    }

    /// Whether a region is in doubt: something unresolved, inconsistent, or refuted by a run lies in
    /// it or on its boundary. An index without a region is in doubt.
    #[must_use]
    pub fn is_doubtful(&self, region: usize) -> bool {
        self.doubtful.get(region).is_none_or(|doubtful| *doubtful)
    }

    /// The label at a point; `None` outside the window, on a boundary, and in a region in doubt.
    #[must_use]
    pub fn label(&self, point: &Point) -> Option<&Label> {
        match self.plane.locate(point) {
            Location::Region(region) if !self.is_doubtful(region) => {
                self.plane.regions()[region].label.as_ref()
            }
            _ => None,
        }
    }

    /// The part of the window's area in regions that are not in doubt.
    #[must_use]
    pub fn sure_area(&self) -> f64 {
        let regions = self.plane.regions().iter().zip(&self.doubtful);
        let sure = regions.filter(|(_, doubtful)| !**doubtful).map(|(region, _)| region.area);
        sure.sum::<f64>() / self.plane.window().extent().product()
    }
}

/// Whether something speaks against each region.
fn doubtful<Label, Margin, Error>(
    plane: &Subdivision<Label, Margin>,
    unresolved: &[Unresolved<Label>],
    verification: &Verification<Label, Error>,
) -> Vec<bool> {
    let mut regions: Vec<usize> = Vec::new();
    let at = |point: &Point, regions: &mut Vec<usize>| match plane.locate(point) {
        Location::Region(region) => regions.push(region),
        Location::OnBoundary { curve, .. } => {
            regions.extend(plane.regions_beside(curve).into_iter().flatten());
        }
        Location::Outside => {}
    };
    for what in unresolved {
        match what {
            Unresolved::Change { between, .. } => {
                for point in between {
                    at(point, &mut regions);
                }
            }
            Unresolved::Stalled { vertex } => at(&plane.vertices()[*vertex].point, &mut regions),
            Unresolved::TooManyNodes { point }
            | Unresolved::TooManyCurves { point }
            | Unresolved::NoLength { point, .. } => at(point, &mut regions),
        }
    }
    let beside = |curve: usize| plane.regions_beside(curve).into_iter().flatten();
    for finding in plane.findings() {
        match finding {
            Finding::EndAway { curve, .. }
            | Finding::Dangling { curve, .. }
            | Finding::SidesNotApart { curve, .. } => regions.extend(beside(*curve)),
            Finding::Crossing { curves, .. } => {
                regions.extend(curves.iter().flatten().flat_map(|curve| beside(*curve)));
            }
            Finding::Labels { region, .. } | Finding::Thin { region, .. } => regions.push(*region),
            Finding::VertexOffWindow { .. } | Finding::Euler(_) => {}
        }
    }
    regions.extend(verification.mismatches.iter().map(|mismatch| mismatch.region));
    let mut doubtful = vec![false; plane.regions().len()];
    for region in regions {
        doubtful[region] = true;
    }
    doubtful
}
