//! How an atlas is made: boundaries are traced, and regions are verified.

use stickslip_model::Collider;
use stickslip_tracer::{
    AtlasOptions, Effort, Point, Surveyor, TraceOptions, Window, regions::VerifyOptions,
};

use super::draft::{CollisionDraft, integrated, room_beyond};
use super::error::AtlasError;
use super::frame::Frame;
use super::regions::CollisionAtlas;
use super::verification::VerificationReport;
use crate::family::CollisionPlane;
use crate::progress::{InParallel, Watch};
use crate::sheet::ToleranceRange;

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions, as
/// [`divide`] does.
///
/// # Errors
/// As [`divide`].
pub fn trace<'w>(
    frame: Frame,
    tolerance: f64,
    watch: impl Into<Watch<'w>>,
) -> Result<CollisionAtlas, AtlasError> {
    trace_with(frame, tolerance, Effort::Default, watch)
}

/// As [`trace`], with another effort, which the report names.
///
/// # Errors
/// As [`divide`].
pub fn trace_with<'w>(
    frame: Frame,
    tolerance: f64,
    effort: Effort,
    watch: impl Into<Watch<'w>>,
) -> Result<CollisionAtlas, AtlasError> {
    let divided = divide_watched(&frame.plane()?, tolerance, effort, watch.into())?;
    Ok(CollisionAtlas { ratio: frame.ratio, ..divided })
}

/// Traces the boundaries in the window of a plane, accurate to `tolerance` in its second parameter,
/// and verifies the regions.
///
/// The runs of the grid and of the verification are computed on the threads of the current rayon
/// pool. If the verification finds other switches than the regions have, the tracer looks again
/// there, in up to eight rounds. A window in which something is in doubt is traced by margins, and
/// in both ways with up to three other options; the first result without a doubt counts. `watch` is
/// told of every step. If it
/// cancels, the atlas is what was found so far, and its report says so.
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
/// let atlas = atlas::divide(&plane, plane.sheet().tolerances().usual, progress::SILENT)?;
/// assert!(atlas.report.agrees);
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
) -> Result<CollisionAtlas, AtlasError> {
    divide_watched(plane, tolerance, Effort::Default, watch.into())
}

/// [`divide`], compiled once, in this crate: what is generic is compiled in every crate that calls
/// it, and here the whole tracer comes along.
fn divide_watched(
    plane: &CollisionPlane,
    tolerance: f64,
    effort: Effort,
    watch: Watch<'_>,
) -> Result<CollisionAtlas, AtlasError> {
    require_traceable(plane, tolerance)?;
    let options = effort.applied(AtlasOptions {
        trace: trace_options(plane, tolerance),
        verify: VerifyOptions { random_points: 20_000, ..VerifyOptions::default() },
        ..AtlasOptions::default()
    });
    let surveyor = Surveyor { options, executor: InParallel, watch };
    let draft = CollisionDraft::new(plane, tolerance)?;
    let drawn = surveyor.draw(&draft, &plane.window());
    let (drawn, extrema) = drawn.map_err(|error| AtlasError::of(plane, error))?;
    let report = VerificationReport::new(plane, &options, &drawn);
    let mut regions = drawn.plane;
    regions.label_rest(|sample| integrated(plane, sample).ok());
    Ok(CollisionAtlas { plane: *plane, ratio: None, tolerance, regions, extrema, report })
}

/// Refuses a plane in which boundaries cannot be accurate to `tolerance`, or not be verified, or of
/// which no corner can be computed.
pub(crate) fn require_traceable(plane: &CollisionPlane, tolerance: f64) -> Result<(), AtlasError> {
    plane.sheet().require_wide(plane.names())?;
    plane.require_smooth()?;
    let ToleranceRange { finest, coarsest, .. } = plane.sheet().tolerances();
    if !(finest..=coarsest).contains(&tolerance) {
        return Err(AtlasError::Tolerance { tolerance, finest, coarsest });
    }
    for corner in plane.corners() {
        Collider::require(&plane.contact_at(corner)?)?;
    }
    let Window { low, high } = plane.window();
    let corners = [low, high, Point::new(low.x, high.y), Point::new(high.x, low.y)];
    let computed = corners.map(|corner| integrated(plane, &corner));
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
