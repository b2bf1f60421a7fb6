//! How an atlas is made: boundaries are traced, and regions are verified.

use std::collections::BTreeMap;

use stickslip_model::{Collider, Contact};
use stickslip_solver::margin::Margin;
use stickslip_tracer::{
    AtlasOptions, Curve, Extremum, Network, Node, Point, Subdivision, Survey, Surveyor,
    TraceOptions, Tracer, Unresolved, Vertex, Window,
};

use super::boundary::{BoundaryKind, itinerary};
use super::error::AtlasError;
use super::frame::Frame;
use super::regions::{Atlas, Regions, itinerary_in};
use super::verification::{self, VerificationReport};
use crate::family::CollisionPlane;
use crate::progress::{InParallel, Watch};
use crate::sheet::ToleranceRange;

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

/// A plane of collisions that boundaries divide into regions, with the result of the verification.
#[derive(Clone, Debug)]
pub struct Division {
    /// The collisions, and the traced coordinates, in which the boundaries are cubics.
    pub plane: CollisionPlane,
    /// Accuracy of the boundaries in the second parameter.
    pub tolerance: f64,
    /// Boundaries, vertices and regions.
    pub regions: Regions,
    /// Itineraries of the regions that no boundary touches, by the index of the region.
    pub unbounded: BTreeMap<usize, String>,
    /// The points at which boundaries turn back in one of the parameters.
    pub extrema: Vec<Extremum>,
    /// What the verification found.
    pub report: VerificationReport,
}

impl Division {
    /// The itinerary of a region: one character per phase, `+` and `-` for slip, `o` for stick.
    ///
    /// # Panics
    /// If there is no region with this index.
    #[must_use]
    pub fn itinerary(&self, region: usize) -> &str {
        itinerary_in(&self.regions, &self.unbounded, region)
    }
}

/// The largest number of rounds, each with a trace and a verification.
const ROUNDS: usize = 8;

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions, as
/// [`divide`] does.
///
/// # Errors
/// As [`divide`].
pub fn trace<'w>(
    frame: Frame,
    tolerance: f64,
    watch: impl Into<Watch<'w>>,
) -> Result<VerifiedAtlas, AtlasError> {
    let plane = frame.plane()?;
    let Division { regions, unbounded, extrema, report, .. } = divide(&plane, tolerance, watch)?;
    let atlas = Atlas { frame, chart: *plane.chart(), tolerance, regions, unbounded };
    Ok(VerifiedAtlas { atlas, extrema, report })
}

/// Traces the boundaries in the window of a plane, accurate to `tolerance` in its second parameter,
/// and verifies the regions.
///
/// The runs of the grid and of the verification are computed on the threads of the current rayon
/// pool. If the verification finds other switches than the regions have, the tracer looks again
/// there, in up to eight rounds. A window in which something is in doubt is traced in up to three
/// other ways, of which the first without a doubt counts. `watch` is told of every step. If it
/// cancels, the division is what was found so far, and its report says so.
///
/// ```
/// use stickslip_model::spheres::{BodyPair, Material, Surface};
/// use stickslip_plane::{CollisionPlane, Range, atlas, progress};
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let surface =
///     Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6 };
/// let pair = BodyPair::equal_spheres(0.02, &steel, &surface)?;
/// let sides = [Range { low: 15.0, high: 25.0 }, Range { low: 2.0, high: 6.0 }];
/// let plane = CollisionPlane::velocities(pair, sides)?;
/// let division = atlas::divide(&plane, plane.sheet().tolerances().usual, progress::SILENT)?;
/// assert!(division.report.agrees);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`AtlasError`]: the window or the tolerance is not possible, a run fails, or the curves do not
/// make regions. What speaks against the regions is not an error but part of the report.
pub fn divide<'w>(
    plane: &CollisionPlane,
    tolerance: f64,
    watch: impl Into<Watch<'w>>,
) -> Result<Division, AtlasError> {
    divide_watched(plane, tolerance, watch.into())
}

/// [`divide`], compiled once, in this crate: what is generic is compiled in every crate that calls
/// it, and here the whole tracer comes along.
///
/// Where a vertex lies a hair beside an edge of the window, boundaries that are followed beyond the
/// edge may be right and those that are not may not, or the other way round. In a narrow window,
/// the usual error of margins may be so large that a vertex is missed, and a smaller one so small
/// that rounding makes vertices.
fn divide_watched(
    plane: &CollisionPlane,
    tolerance: f64,
    watch: Watch<'_>,
) -> Result<Division, AtlasError> {
    require_traceable(plane, tolerance)?;
    let surveyor = Surveyor { options: AtlasOptions::default(), executor: InParallel, watch };
    let options = trace_options(plane, tolerance);
    let first = surveyed(plane, tolerance, &options, &surveyor)?;
    if first.report.agrees {
        return Ok(first);
    }
    for other in other_options(plane, options) {
        if surveyor.watch.is_cancelled() {
            break;
        }
        if let Ok(other) = surveyed(plane, tolerance, &other, &surveyor)
            && other.report.agrees
        {
            return Ok(other);
        }
    }
    Ok(first)
}

/// Other options that may make a window right in which something is in doubt.
fn other_options(plane: &CollisionPlane, options: TraceOptions) -> Vec<TraceOptions> {
    /// With a shorter side than this, in logarithms, a window is narrow.
    const NARROW: f64 = 1e-3;
    let beyond = if options.beyond > 0.0 { 0.0 } else { room_beyond(plane) };
    let beyond = |options| TraceOptions { beyond, ..options };
    let mut others = vec![beyond(options)];
    let [width, height] = plane.sheet().extents();
    let finer = TraceOptions { noise: margin_error(plane), ..options };
    if width.min(height) < NARROW && finer.noise < options.noise {
        others.extend([finer, beyond(finer)]);
    }
    others
}

/// The error of margins in a window, where their slope in the logarithms is 1. Integrated ones have
/// the usual one. Those of the exact engine are ten times as accurate up to κ = 100, and lose
/// digits as √κ grows (`examples/margin_errors.rs` of `validation`). Steeper ones may be off by
/// more, which moves their zeros by as little.
fn margin_error(plane: &CollisionPlane) -> f64 {
    let usual = TraceOptions::default().noise;
    if plane.sheet().integrated {
        return usual;
    }
    let contacts = plane.corners().into_iter().filter_map(|corner| plane.contact_at(corner).ok());
    let stiffest = contacts.map(|contact| contact.kappa()).fold(100.0, f64::max);
    (1e-15 * stiffest.sqrt()).min(usual)
}

/// The regions of a plane that a survey with these options makes.
fn surveyed(
    plane: &CollisionPlane,
    tolerance: f64,
    options: &TraceOptions,
    surveyor: &Surveyor<'_, InParallel>,
) -> Result<Division, AtlasError> {
    let any = plane.contact(&plane.window().low)?;
    let family = plane.family();
    let failed = |error| AtlasError::of(plane, error);
    let mut tracer = Tracer::new(&family, &plane.window(), options).map_err(failed)?;
    tracer.require_few(&surveyor.executor, &surveyor.watch).map_err(failed)?;
    let survey = surveyor.survey(&mut tracer, ROUNDS, Survey::BEGINNING, |network, round| {
        let found = assess(plane, tolerance, network, &any)?;
        verification::verify(plane, found, round as u64, &surveyor.watch)
    });
    let survey = survey.map_err(|error| match error {
        AtlasError::Trace(error) => failed(error),
        error => error,
    })?;
    let (regions, mut report) = if let Some(found) = survey.result {
        found
    } else {
        let (regions, unresolved) = assess(plane, tolerance, tracer.network(), &any)?;
        let report = VerificationReport::untried(plane, &regions, unresolved);
        (regions, report)
    };
    if !survey.finished {
        report.agrees = false;
        report.unresolved.insert(0, "cancelled before the end".to_owned());
    }
    let extrema = tracer.extrema().map_err(failed)?;
    let unbounded = unbounded(plane, &regions);
    Ok(Division { plane: *plane, tolerance, regions, unbounded, extrema, report })
}

/// The regions of a network, and what the tracer could not explain.
fn assess(
    plane: &CollisionPlane,
    tolerance: f64,
    mut network: Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<(Regions, Vec<String>), AtlasError> {
    network.name_vertices();
    let (regions, left_out) = regions(plane, tolerance, &network, any)?;
    let left_out = left_out.into_iter().map(|index| Unresolved::no_length(&network.curves[index]));
    network.unresolved.extend(left_out);
    let unresolved = verification::unresolved(plane, &network.vertices, &network.unresolved);
    Ok((regions, unresolved))
}

/// Refuses a plane in which boundaries cannot be accurate to `tolerance`, or not be verified, or of
/// which no corner can be computed.
pub(crate) fn require_traceable(plane: &CollisionPlane, tolerance: f64) -> Result<(), AtlasError> {
    plane.sheet().require_wide(plane.names())?;
    let ToleranceRange { finest, coarsest, .. } = plane.sheet().tolerances();
    if !(finest..=coarsest).contains(&tolerance) {
        return Err(AtlasError::Tolerance { tolerance, finest, coarsest });
    }
    for corner in plane.corners() {
        Collider::require(&plane.contact_at(corner)?)?;
    }
    let Window { low, high } = plane.window();
    let corners = [low, high, Point::new(low.x, high.y), Point::new(high.x, low.y)];
    let computed = corners.map(|corner| verification::itinerary(plane, &corner));
    if let [Err(error), Err(_), Err(_), Err(_)] = computed {
        return Err(error.into());
    }
    Ok(())
}

/// The options of a trace that is accurate to `tolerance` in the second parameter.
///
/// In a window whose sides are many e-folds long, cells and steps are smaller parts of a side.
pub(crate) fn trace_options(plane: &CollisionPlane, tolerance: f64) -> TraceOptions {
    /// The e-folds up to which the usual parts of a side will do.
    const SIDE: f64 = 4.0;
    let (usual, noise) = (TraceOptions::default(), plane.sheet().noise());
    let fineness = (plane.window().extent().min() / SIDE).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "32 to 1024")]
    let cells = (usual.cells as f64 * fineness.min(32.0)).ceil() as usize;
    // The stored figures of the paper's law keep their digits.
    let beyond = if plane.obeys_paper() { 0.0 } else { room_beyond(plane) };
    TraceOptions {
        beyond,
        tolerance: usual.tolerance.max(0.1 * noise),
        interpolation: plane.sheet().interpolation(tolerance),
        offset: usual.offset.max(10.0 * noise),
        max_step: usual.max_step / fineness,
        cells,
        ..usual
    }
}

/// How far beyond the window boundaries may be followed, as a part of its shorter side: below half
/// of the window's lower end the second parameter is kept, see [`CollisionPlane::contact`].
fn room_beyond(plane: &CollisionPlane) -> f64 {
    let [x, y] = plane.corners()[0];
    let room = plane.window().low.y - plane.point(x, 0.5 * y).y;
    (0.5 * room / plane.window().extent().min()).min(1e-3)
}

/// The itineraries of the regions that no boundary touches, where collisions can be computed.
fn unbounded(plane: &CollisionPlane, regions: &Regions) -> BTreeMap<usize, String> {
    let regions = regions.regions().iter().enumerate();
    regions
        .filter(|(_, region)| region.label.is_none())
        .filter_map(|(index, region)| {
            Some((index, verification::itinerary(plane, &region.sample).ok()?))
        })
        .collect()
}

/// The regions that the traced curves make, and the curves that have no length in them.
///
/// Points are converted to the two parameters and back, because a file holds κ and ψ. A file then
/// makes the same regions, bit for bit.
fn regions(
    plane: &CollisionPlane,
    tolerance: f64,
    network: &Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<(Regions, Vec<usize>), AtlasError> {
    let sheet = plane.sheet();
    let written = |point: &Point| {
        let [x, y] = sheet.snapped(point);
        plane.point(x, y)
    };
    let curves = network.curves.iter().map(|curve| Curve {
        margin: BoundaryKind::of(any, &curve.margin),
        sides: curve.sides.each_ref().map(|guards| itinerary(any, guards)),
        nodes: curve
            .nodes
            .iter()
            .map(|node| Node { point: written(&node.point), tangent: node.tangent })
            .collect(),
        ends: curve.ends,
    });
    let curves: Vec<_> = curves.collect();
    let vertices = network.vertices.iter().map(|vertex| Vertex {
        point: written(&vertex.point),
        kind: vertex.kind,
        margins: Vec::new(),
    });
    let vertices: Vec<_> = vertices.collect();
    let nodes = curves.iter().flat_map(|curve| &curve.nodes);
    let resolution = sheet.resolution_of(nodes, tolerance);
    Ok(Subdivision::leaving_out(sheet.window(), &curves, &vertices, resolution)?)
}
