//! How an atlas is made: boundaries are traced, and regions are verified.

use std::collections::BTreeMap;

use stickslip_model::{Collider, Contact, InvalidParameter, OutOfDomain};
use stickslip_solver::Margin;
use stickslip_tracer::{
    Curve, Extremum, Network, Node, Point, Subdivision, SubdivisionError, TraceError, TraceOptions,
    Tracer, VerifyError, Vertex,
};

use super::boundary::{BoundaryKind, itinerary};
use super::frame::{Frame, ToleranceRange, TooNarrow, noise};
use super::regions::{Atlas, Regions};
use super::verification::{self, LabelError, VerificationReport};
use crate::chart::Chart;
use crate::family::{CollisionFamilyError, CollisionPlane};
use crate::progress::{Progress, Report};

/// An atlas with the result of its verification.
#[derive(Clone, Debug)]
pub struct VerifiedAtlas {
    /// The atlas.
    pub atlas: Atlas,
    /// The points at which boundaries turn back in κ or ψ.
    pub extrema: Vec<Extremum>,
    /// What the verification found.
    pub report: VerificationReport,
}

/// The reason why a window has no atlas.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AtlasError {
    /// No collision has the parameters of the window.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// The window is too narrow.
    #[error(transparent)]
    Narrow(#[from] TooNarrow),
    /// The window is out of the range of the integrator, which verifies an atlas.
    #[error("an atlas is verified by integration: {0}")]
    Unverifiable(#[from] OutOfDomain),
    /// The boundaries cannot have this accuracy in the window.
    #[error(
        "the tolerance {tolerance:?} is out of range; expected {finest:e} to {coarsest:e} in this window"
    )]
    Tolerance {
        /// The accuracy that was asked for.
        tolerance: f64,
        /// The finest possible.
        finest: f64,
        /// The coarsest possible.
        coarsest: f64,
    },
    /// A run of the tracer failed.
    #[error("kappa = {kappa:?}, psi = {psi:?}: {source}")]
    Run {
        /// κ of the run.
        kappa: f64,
        /// ψ of the run.
        psi: f64,
        /// The error of the run.
        source: CollisionFamilyError,
    },
    /// The tracer failed for another reason than a run.
    #[error(transparent)]
    Trace(TraceError<CollisionFamilyError>),
    /// The curves do not make regions.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The verification failed.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// A collision cannot be computed.
    #[error(transparent)]
    Label(#[from] LabelError),
}

/// The largest number of rounds, each with a trace and a verification.
const ROUNDS: u64 = 8;

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions.
///
/// The verification computes collisions on the threads of the current rayon pool. If it finds
/// other switches than the atlas has, the tracer looks again there, in up to eight rounds.
/// `progress` is told when a round begins and ends.
///
/// # Errors
/// [`AtlasError`]: the window or the tolerance is not possible, a run fails, or the curves do not
/// make regions. What speaks against an atlas is not an error but part of its report.
pub fn trace(
    frame: Frame,
    tolerance: f64,
    progress: Report<'_>,
) -> Result<VerifiedAtlas, AtlasError> {
    let plane = traceable(&frame, tolerance)?;
    let window = plane.window();
    let any = plane.contact(&window.low)?;
    let family = plane.family();
    let options = trace_options(&frame, plane.chart(), tolerance);
    let failed = |error| AtlasError::of(&plane, error);
    let mut tracer = Tracer::new(&family, &window, &options).map_err(failed)?;
    progress(Progress::Begin { steps: 1 });
    tracer.explore().map_err(failed)?;
    let mut round = 1;
    loop {
        let mut network = tracer.network();
        network.name_vertices();
        let unresolved = verification::unresolved(plane.chart(), &network);
        let atlas = atlas(frame, tolerance, network, &any)?;
        let (report, brackets) = verification::verify(&atlas, unresolved, round)?;
        progress(Progress::Advance { steps: 1 });
        let again = round < ROUNDS && tracer.look_between(&brackets).map_err(failed)?;
        if !again {
            let extrema = tracer.extrema().map_err(failed)?;
            return Ok(VerifiedAtlas { atlas, extrema, report });
        }
        progress(Progress::Begin { steps: 1 });
        round += 1;
    }
}

/// The collisions in `frame`, if boundaries can be accurate to `tolerance` there, and verified.
pub(crate) fn traceable(frame: &Frame, tolerance: f64) -> Result<CollisionPlane, AtlasError> {
    let plane = frame.plane()?;
    frame.require_wide()?;
    let ToleranceRange { finest, coarsest, .. } = frame.tolerances();
    if !(finest..=coarsest).contains(&tolerance) {
        return Err(AtlasError::Tolerance { tolerance, finest, coarsest });
    }
    let window = plane.window();
    for corner in [window.low, window.high] {
        Collider::require(&plane.contact(&corner)?)?;
    }
    Ok(plane)
}

/// The options of a trace that is accurate to `tolerance` in ψ.
pub(crate) fn trace_options(frame: &Frame, chart: &Chart, tolerance: f64) -> TraceOptions {
    let (usual, noise) = (TraceOptions::default(), noise(chart));
    TraceOptions {
        tolerance: usual.tolerance.max(0.1 * noise),
        interpolation: frame.interpolation(chart, tolerance),
        offset: usual.offset.max(10.0 * noise),
        ..usual
    }
}

impl AtlasError {
    /// The error of a trace of `plane`.
    #[must_use]
    pub fn of(plane: &CollisionPlane, error: TraceError<CollisionFamilyError>) -> Self {
        match error {
            TraceError::Run { point, source } => {
                let [kappa, psi] = plane.parameters(&point);
                Self::Run { kappa, psi, source }
            }
            error => Self::Trace(error),
        }
    }

    /// The error of an atlas of `plane`.
    pub(crate) fn of_atlas(
        plane: &CollisionPlane,
        error: stickslip_tracer::AtlasError<CollisionFamilyError>,
    ) -> Self {
        match error {
            stickslip_tracer::AtlasError::Trace(error) => Self::of(plane, error),
            stickslip_tracer::AtlasError::Subdivision(error) => Self::Subdivision(error),
            stickslip_tracer::AtlasError::Verify(error) => Self::Verify(error),
        }
    }
}

/// The atlas that the traced curves make.
fn atlas(
    frame: Frame,
    tolerance: f64,
    network: Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<Atlas, AtlasError> {
    let chart = frame.chart();
    let regions = regions(&frame, &chart, tolerance, network, any)?;
    let unbounded = regions
        .regions()
        .iter()
        .enumerate()
        .filter(|(_, region)| region.label.is_none())
        .map(|(index, region)| {
            Ok((index, verification::itinerary(&frame, &chart, &region.sample)?))
        })
        .collect::<Result<BTreeMap<_, _>, LabelError>>()?;
    Ok(Atlas { frame, chart, tolerance, regions, unbounded })
}

/// The regions that the traced curves make.
///
/// Points are converted to (κ, ψ) and back, because a file holds κ and ψ. A file then makes the
/// same regions, bit for bit.
fn regions(
    frame: &Frame,
    chart: &Chart,
    tolerance: f64,
    network: Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<Regions, AtlasError> {
    let written = |point: &Point| {
        let [kappa, psi] = frame.snapped(chart.parameters(point));
        chart.point(kappa, psi)
    };
    let curves = network.curves.into_iter().map(|curve| Curve {
        margin: BoundaryKind::of(any, &curve.margin),
        sides: curve.sides.map(|guards| itinerary(any, &guards)),
        nodes: curve
            .nodes
            .iter()
            .map(|node| Node { point: written(&node.point), tangent: node.tangent })
            .collect(),
        ends: curve.ends,
    });
    let curves: Vec<_> = curves.collect();
    let vertices = network.vertices.into_iter().map(|vertex| Vertex {
        point: written(&vertex.point),
        kind: vertex.kind,
        margins: Vec::new(),
    });
    let vertices: Vec<_> = vertices.collect();
    let resolution = frame.resolution(chart, tolerance);
    Ok(Subdivision::new(frame.window(chart), curves, vertices, resolution)?)
}
