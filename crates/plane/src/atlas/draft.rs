//! What the atlas of collisions has in the places of labels and margins, and what verifies it.

use rayon::prelude::*;
use stickslip_model::{Collider, CollisionError, Contact, InvalidValue};
use stickslip_tracer::{
    AtlasOptions, Curve, Draft, Executor, Point, TraceOptions,
    regions::VerifyOptions,
    tracing::{Network, NetworkOf},
};

use super::boundary::BoundaryKind;
use crate::family::general::itinerary;
use crate::family::{CollisionFamily, CollisionPlane};

/// The atlas of a plane: regions have itineraries, and boundaries their kinds.
///
/// Where the exact solution traces boundaries, integration verifies the regions: the two have
/// nothing in common.
pub(super) struct CollisionDraft<'p> {
    plane: &'p CollisionPlane,
    family: CollisionFamily,
    /// A contact with the law of all.
    any: Contact,
    /// The accuracy of the boundaries in the second parameter.
    tolerance: f64,
}

impl<'p> CollisionDraft<'p> {
    pub fn new(plane: &'p CollisionPlane, tolerance: f64) -> Result<Self, InvalidValue> {
        let any = plane.contact(&plane.window().low)?;
        Ok(Self { plane, family: plane.family(), any, tolerance })
    }
}

impl Draft for CollisionDraft<'_> {
    type Family = CollisionFamily;
    type Label = String;
    type Margin = BoundaryKind;
    type Failure = CollisionError;

    fn family(&self) -> &CollisionFamily {
        &self.family
    }

    /// Points are converted to the two parameters and back, because a file holds κ and ψ. A file
    /// then makes the same regions, bit for bit.
    fn drawn(&self, mut network: NetworkOf<CollisionFamily>) -> Network<String, BoundaryKind> {
        network.name_vertices();
        let mut network = network
            .map(|label| itinerary(&self.any, label), |margin| BoundaryKind::of(&self.any, margin));
        let written = |point: &mut Point| {
            let [x, y] = self.plane.sheet().snapped(point);
            *point = self.plane.point(x, y);
        };
        for node in network.curves.iter_mut().flat_map(|curve| &mut curve.nodes) {
            written(&mut node.point);
        }
        for vertex in &mut network.vertices {
            written(&mut vertex.point);
            vertex.margins.clear();
        }
        network
    }

    fn fitted(
        &self,
        options: &AtlasOptions,
        curves: &[Curve<String, BoundaryKind>],
    ) -> AtlasOptions {
        let nodes = curves.iter().flat_map(|curve| &curve.nodes);
        let tolerance = self.plane.sheet().resolution_of(nodes, self.tolerance);
        let nearest = 10.0 * tolerance;
        let farthest = nearest.max(1e-3 * self.plane.window().extent().min());
        AtlasOptions {
            tolerance,
            verify: VerifyOptions { nearest, farthest, ..options.verify },
            ..*options
        }
    }

    fn checks<E: Executor<CollisionFamily>>(
        &self,
        _: &E,
        points: &[Point],
    ) -> Vec<Result<String, CollisionError>> {
        points.par_iter().map(|point| integrated(self.plane, point)).collect()
    }

    fn other_options(&self, options: &TraceOptions) -> Vec<TraceOptions> {
        other_options(self.plane, *options)
    }
}

/// The itinerary of the collision at a traced point, by integration.
///
/// # Errors
/// [`CollisionError`] says why the collision cannot be computed.
pub(super) fn integrated(plane: &CollisionPlane, point: &Point) -> Result<String, CollisionError> {
    Ok(Collider::deciding().collide(plane.contact(point)?)?.itinerary())
}

/// Other options that may make a window right in which something is in doubt.
///
/// Where a vertex lies a hair beside an edge of the window, boundaries that are followed beyond the
/// edge may be right and those that are not may not, or the other way round. In a narrow window,
/// the usual error of margins may be so large that a vertex is missed, and a smaller one so small
/// that rounding makes vertices.
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

/// How far beyond the window boundaries may be followed, as a part of its shorter side: below half
/// of the window's lower end the second parameter is kept, see [`CollisionPlane::contact`].
pub(super) fn room_beyond(plane: &CollisionPlane) -> f64 {
    let [x, y] = plane.corners()[0];
    let room = plane.window().low.y - plane.point(x, 0.5 * y).y;
    (0.5 * room / plane.window().extent().min()).min(1e-3)
}
