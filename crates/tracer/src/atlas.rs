//! Regions that were traced, verified and looked at again, with all that speaks against them.

use std::fmt::Debug;

use crate::doubts::Doubts;
use crate::effort::Effort;
use crate::family::Family;
use crate::names::{Names, Unnamed};
use crate::options::TraceOptions;
use crate::regions::finding::{Finding, SubdivisionError};
use crate::regions::locate::Location;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::report::{Mismatch, Reason, Unverified, Verification};
use crate::regions::verify::{VerifyOptions, verify_unless_cancelled};
use crate::tracing::network::{Network, TraceStatistics, Unresolved};
use crate::tracing::tracer::state::State;
use crate::window::{Point, Window};

/// The options of an [`Atlas`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AtlasOptions {
    /// How boundaries are traced.
    pub trace: TraceOptions,
    /// The accuracy that is claimed for the curves, see [`Subdivision::new`].
    pub tolerance: f64,
    /// Where the regions are compared with runs. The seed is that of the first round; each further
    /// round has the next one, and so other points.
    pub verify: VerifyOptions,
    /// The greatest number of rounds, at least 1. In each round the regions are verified, and the
    /// tracer looks again where runs have other labels.
    pub rounds: usize,
    /// The effort that was made: it sets the numbers above by [`Effort::applied`]. Only a screen
    /// leaves a window as it is in which something is in doubt.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Effort::is_default"))]
    pub effort: Effort,
}

impl Default for AtlasOptions {
    fn default() -> Self {
        let (trace, verify) = (TraceOptions::default(), VerifyOptions::default());
        Self { trace, tolerance: 1e-9, verify, rounds: 8, effort: Effort::Default }
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
/// assert_eq!(atlas.objection(), None);
/// # Ok::<(), stickslip_tracer::TraceError<Infallible>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Atlas<Label, Margin> {
    /// The regions.
    pub plane: Subdivision<Label, Margin>,
    /// What the trace could not explain.
    pub unresolved: Vec<Unresolved<Label>>,
    /// What the comparison with runs found. Errors of runs are sentences here.
    pub verification: Verification<Label, String>,
    /// The work of the trace.
    pub statistics: TraceStatistics,
    /// The number of rounds.
    pub rounds: usize,
    /// Whether each region is in doubt.
    pub(crate) doubtful: Vec<bool>,
    /// Where the survey goes on, if it was cancelled.
    pub(crate) unfinished: Option<Box<State<Label, Margin>>>,
}

/// The atlas of a family.
pub type AtlasOf<F> = Atlas<<F as Family>::Label, <F as Family>::Margin>;

impl<Label: Clone + Ord, Margin: Clone> Atlas<Label, Margin> {
    /// The atlas of a network that was found in another way, verified by `labels` at many points.
    ///
    /// # Errors
    /// The network or the distances of the verification have no meaning.
    pub fn verified<E: ToString>(
        network: Network<Label, Margin>,
        options: &AtlasOptions,
        labels: impl FnOnce(&[Point]) -> Vec<Result<Label, E>>,
    ) -> Result<Self, SubdivisionError> {
        let mut atlas = Self::unverified(network, options, 1)?;
        atlas.verify(options, |points| Some(labels(points)))?;
        Ok(atlas)
    }

    /// The regions of a network, of which none is verified yet.
    pub(crate) fn unverified(
        network: Network<Label, Margin>,
        options: &AtlasOptions,
        rounds: usize,
    ) -> Result<Self, SubdivisionError> {
        let Network { window, curves, vertices, statistics, mut unresolved } = network;
        let (plane, left_out) =
            Subdivision::leaving_out(window, &curves, &vertices, options.tolerance)?;
        unresolved.extend(left_out.into_iter().map(|index| Unresolved::no_length(&curves[index])));
        let verification = Verification::untried(&plane);
        let doubtful = doubtful(&plane, &unresolved, &verification);
        let unfinished = None;
        Ok(Self { plane, unresolved, verification, statistics, rounds, doubtful, unfinished })
    }

    /// Verifies the regions by the labels at many points, and keeps the errors of runs as
    /// sentences. Returns `false` if this was cancelled, which `labels` tells by `None`.
    pub(crate) fn verify<E: ToString>(
        &mut self,
        options: &AtlasOptions,
        labels: impl FnOnce(&[Point]) -> Option<Vec<Result<Label, E>>>,
    ) -> Result<bool, SubdivisionError> {
        let sentence = |error: E| error.to_string();
        // Regions that no curve bounds have the labels of their samples.
        let mut samples: Vec<(Point, Label)> = Vec::new();
        let open = self.plane.regions().iter().filter(|region| region.label.is_none());
        let open: Vec<Point> = open.map(|region| region.sample).collect();
        let labels = |points: &[Point]| {
            let labels = labels(points)?;
            for (point, label) in points.iter().zip(&labels) {
                if let (true, Ok(label)) = (open.contains(point), label) {
                    samples.push((*point, label.clone()));
                }
            }
            Some(labels.into_iter().map(|label| label.map_err(sentence)).collect())
        };
        let seed = options.verify.seed.wrapping_add(self.rounds as u64 - 1);
        let points = VerifyOptions { seed, ..options.verify };
        let Some(found) = verify_unless_cancelled(&self.plane, &points, labels)? else {
            return Ok(false);
        };
        self.verification = found;
        let known = |sample: &Point| samples.iter().find(|(point, _)| point == sample);
        self.plane.label_rest(|sample| known(sample).map(|(_, label)| label.clone()));
        self.doubtful = doubtful(&self.plane, &self.unresolved, &self.verification);
        Ok(true)
    }
}

impl<Label, Margin> Atlas<Label, Margin> {
    /// Whether nothing speaks against the atlas: the survey is finished, nothing is unresolved, the
    /// verification agrees, and none of its runs failed.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.is_finished()
            && self.unresolved.is_empty()
            && self.verification.agrees()
            && self.verification.failed().next().is_none()
    }

    /// What speaks against the atlas; `None` if it [agrees](Self::agrees).
    #[must_use]
    pub fn doubts(&self, names: &impl Names<Label, Margin>) -> Option<Doubts> {
        if self.agrees() {
            return None;
        }
        let Verification { mismatches, .. } = &self.verification;
        let mismatch = |mismatch: &Mismatch<Label>| {
            let Mismatch { checkpoint, region, expected, found, .. } = mismatch;
            let [expected, found] = [expected, found].map(|label| names.text(label));
            let place = names.place(&checkpoint.point);
            format!("{place} has {found}, its region {region} {expected}")
        };
        let failed = |open: &Unverified<String>| {
            let what = match &open.reason {
                Reason::Location(_) => "it lies in no region",
                Reason::NoLabel { region } => &format!("region {region} has no known switches"),
                Reason::Run(error) => error,
            };
            format!("{}: {what}", names.place(&open.checkpoint.point))
        };
        let unresolved = self.unresolved.iter();
        Some(Doubts {
            finished: self.is_finished(),
            mismatches: mismatches.iter().map(mismatch).collect(),
            unresolved: unresolved
                .map(|what| names.unresolved(what, self.plane.vertices()))
                .collect(),
            findings: self.verification.standing(&self.plane).map(ToString::to_string).collect(),
            failed: self.verification.failed().map(failed).collect(),
        })
    }

    /// What speaks against the atlas, in one sentence without names; `None` if it
    /// [agrees](Self::agrees).
    #[must_use]
    pub fn objection(&self) -> Option<String>
    where
        Label: Debug,
    {
        self.doubts(&Unnamed).map(|doubts| doubts.objection())
    }

    /// Whether the survey came to its end. If it was cancelled, all regions are in doubt, and
    /// [`Surveyor::resume`](crate::Surveyor::resume) goes on.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.unfinished.is_none()
    }

    /// Whether a region is in doubt: something unresolved, inconsistent, or refuted by a run lies
    /// in it or on its boundary. An index without a region is in doubt.
    #[must_use]
    pub fn is_doubtful(&self, region: usize) -> bool {
        !self.is_finished() || self.doubtful.get(region).is_none_or(|doubtful| *doubtful)
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

    /// The label at a point of the window, decided everywhere: within the error of a curve or of
    /// the window's edge, and in regions in doubt, by the family's run there. `None` outside the
    /// window.
    ///
    /// # Errors
    /// The run failed.
    pub fn decide<F>(&self, family: &F, point: &Point) -> Result<Option<Label>, F::Error>
    where
        F: Family<Label = Label>,
        Label: Clone,
    {
        let Window { low, high } = *self.plane.window();
        if !self.plane.window().contains(point) {
            return Ok(None);
        }
        // A curve may lie on the edge of the window.
        let inside = (point - low).inf(&(high - point)).min() > self.plane.tolerance();
        match self.label(point).filter(|_| inside) {
            Some(label) => Ok(Some(label.clone())),
            None => family.label(point).map(Some),
        }
    }

    /// The part of the window's area in regions that are not in doubt.
    #[must_use]
    pub fn sure_area(&self) -> f64 {
        let regions = self.plane.regions().iter().enumerate();
        let sure = regions.filter(|(index, _)| !self.is_doubtful(*index));
        // The sum of no numbers would be −0.
        let sure = sure.fold(0.0, |sum, (_, region)| sum + region.area);
        sure / self.plane.window().extent().product()
    }
}

/// Whether something speaks against each region.
pub(crate) fn doubtful<Label, Margin>(
    plane: &Subdivision<Label, Margin>,
    unresolved: &[Unresolved<Label>],
    verification: &Verification<Label, String>,
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
    for finding in verification.standing(plane) {
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
    for open in verification.failed() {
        at(&open.checkpoint.point, &mut regions);
    }
    let mut doubtful = vec![false; plane.regions().len()];
    for region in regions {
        doubtful[region] = true;
    }
    doubtful
}

impl Effort {
    /// Options with this effort, from those with the usual one.
    #[must_use]
    pub fn applied(self, usual: AtlasOptions) -> AtlasOptions {
        let AtlasOptions { trace, verify, rounds, .. } = usual;
        let (cells, random_points, near_points, rounds) = match self {
            Self::Screen => {
                let near_points = verify.near_points.div_ceil(5);
                ((trace.cells / 2).max(2), verify.random_points.div_ceil(40), near_points, 1)
            }
            Self::Default => (trace.cells, verify.random_points, verify.near_points, rounds),
            Self::Certain => {
                let [random, near] = [verify.random_points, verify.near_points];
                let cells = (2 * trace.cells).min(TraceOptions::MOST_CELLS);
                (cells, random.saturating_mul(5), near.saturating_mul(5), 2 * rounds)
            }
        };
        AtlasOptions {
            effort: self,
            trace: TraceOptions { cells, ..trace },
            verify: VerifyOptions { random_points, near_points, ..verify },
            rounds,
            ..usual
        }
    }
}
