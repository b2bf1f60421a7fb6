//! The verification of an atlas: collisions are compared with its regions.

use rayon::prelude::*;
use stickslip_model::Collider;
use stickslip_tracer::{
    Found, Location, Origin, Point, Reason, Unresolved, Verification, VerifyOptions, Vertex,
    verify_unless_cancelled,
};

use super::error::{AtlasError, LabelError};
use super::regions::Regions;
use crate::family::CollisionPlane;
use crate::progress::Watch;

/// What the verification of an atlas found, in the layout of the atlas file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VerificationReport {
    /// Whether nothing speaks against the atlas and nothing is unresolved.
    pub agrees: bool,
    /// The method that computed the collisions.
    pub method: String,
    /// The counts of Euler's formula.
    pub euler: EulerFields,
    /// Number of random points in the window.
    pub random_points: usize,
    /// Number of points on each side of each boundary.
    pub near_points: usize,
    /// Number of points that were tried in all, with a sample of each region among them.
    pub tried: usize,
    /// Number of points within the error of a boundary, which may lie on either side.
    pub undecided: usize,
    /// Collisions that have other switches than their region.
    pub mismatches: Vec<MismatchFields>,
    /// What the tracer saw and could not explain, and collisions that failed, in sentences.
    pub unresolved: Vec<String>,
    /// Contradictions between boundaries, in sentences.
    pub findings: Vec<String>,
    /// Boundaries that have a side on which no point could be tried.
    pub untried_boundaries: Vec<usize>,
    /// The share of the window's area in regions that were tried and have no mismatch.
    pub share_tried: f64,
    /// With 95 % confidence, a smaller share of the window than this is wrong.
    pub share_wrong_bound: f64,
}

/// The counts of V − E + F = 1 + C.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EulerFields {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces inside the window.
    pub faces: usize,
    /// Number of connected components.
    pub components: usize,
    /// Whether the formula holds.
    pub holds: bool,
}

/// A collision that has other switches than its region.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MismatchFields {
    /// κ of the collision.
    pub kappa: f64,
    /// ψ of the collision.
    pub psi: f64,
    /// The region in which the collision lies.
    pub region: usize,
    /// The itinerary of that region.
    pub expected: String,
    /// The itinerary of the collision.
    pub found: String,
    /// Whether the point was chosen beside a boundary, and not at random.
    pub near_boundary: bool,
}

/// Compares regions of a plane with collisions at the points of a round, in parallel; `None` if
/// `watch` cancels.
///
/// `unresolved` is what the tracer left open. Besides the report, the result has pairs of places
/// between which a boundary is missing.
///
/// # Errors
/// [`AtlasError::Verify`]: the distances from boundaries are not in order. This would be a defect
/// of this module.
pub(super) fn verify(
    plane: &CollisionPlane,
    (regions, unresolved): (Regions, Vec<String>),
    round: u64,
    watch: &Watch<'_>,
) -> Result<Option<Found<(Regions, VerificationReport)>>, AtlasError> {
    let options = options(&regions, round);
    let labels = |portion: &[Point]| -> Vec<_> {
        portion.par_iter().map(|point| itinerary(plane, point)).collect()
    };
    let labels = |points: &[Point]| watch.in_portions(points, labels);
    let Some(found) = verify_unless_cancelled(&regions, &options, labels)? else {
        return Ok(None);
    };
    let brackets = found.brackets();
    let report = VerificationReport::new(plane, &options, &regions, unresolved, found);
    Ok(Some(Found { result: (regions, report), brackets }))
}

/// The points of a round.
fn options(regions: &Regions, round: u64) -> VerifyOptions {
    let nearest = 10.0 * regions.tolerance();
    let farthest = nearest.max(1e-3 * regions.window().extent().min());
    VerifyOptions { random_points: 20_000, near_points: 20, nearest, farthest, seed: round }
}

impl VerificationReport {
    /// The report of regions of which none has been compared with collisions.
    pub(super) fn untried(
        plane: &CollisionPlane,
        regions: &Regions,
        unresolved: Vec<String>,
    ) -> Self {
        let options = options(regions, 1);
        Self::new(plane, &options, regions, unresolved, Verification::untried(regions))
    }

    /// The report of a verification.
    fn new(
        plane: &CollisionPlane,
        options: &VerifyOptions,
        regions: &Regions,
        mut unresolved: Vec<String>,
        verification: Verification<String, LabelError>,
    ) -> Self {
        let mut undecided = 0;
        for open in &verification.unverified {
            let [kappa, psi] = scaled(plane, &open.checkpoint.point);
            let what = match &open.reason {
                Reason::Location(Location::OnBoundary { .. }) => {
                    undecided += 1;
                    continue;
                }
                Reason::Location(_) => "it lies in no region".to_owned(),
                Reason::NoLabel { region } => format!("region {region} has no known switches"),
                Reason::Run(error) => error.to_string(),
            };
            unresolved.push(format!("kappa = {kappa:?}, psi = {psi:?}: {what}"));
        }
        let agrees = verification.agrees() && unresolved.is_empty();
        let findings = verification.standing(regions).map(ToString::to_string).collect();
        let Verification { euler, mismatches, tried, untried_curves, .. } = verification;
        let mismatches = mismatches.into_iter().map(|mismatch| {
            let [kappa, psi] = scaled(plane, &mismatch.checkpoint.point);
            MismatchFields {
                kappa,
                psi,
                region: mismatch.region,
                expected: mismatch.expected,
                found: mismatch.found,
                near_boundary: matches!(mismatch.checkpoint.origin, Origin::Near { .. }),
            }
        });
        Self {
            agrees,
            method: "dop853".to_owned(),
            euler: EulerFields {
                vertices: euler.vertices,
                edges: euler.edges,
                faces: euler.faces,
                components: euler.components,
                holds: euler.holds(),
            },
            random_points: options.random_points,
            near_points: options.near_points,
            tried: tried.iter().sum(),
            undecided,
            mismatches: mismatches.collect(),
            unresolved,
            findings,
            untried_boundaries: untried_curves,
            share_tried: verification.tried_area,
            share_wrong_bound: verification.wrong_area_bound,
        }
    }

    /// A line that says what speaks against the atlas; `None` if nothing does.
    #[must_use]
    pub fn objection(&self) -> Option<String> {
        if self.agrees {
            return None;
        }
        let mismatch = self.mismatches.first().map(|mismatch| {
            let MismatchFields { kappa, psi, region, expected, found, .. } = mismatch;
            format!("kappa = {kappa:?}, psi = {psi:?} has {found}, region {region} {expected}")
        });
        let first = mismatch.iter().chain(&self.unresolved).chain(&self.findings).next();
        Some(format!(
            "{} mismatches, {} unresolved, {} findings; the first: {}",
            self.mismatches.len(),
            self.unresolved.len(),
            self.findings.len(),
            first.map_or("Euler's formula does not hold", String::as_str)
        ))
    }
}

/// The itinerary of the collision at a traced point, by integration.
///
/// Without damping, boundaries are traced by the exact solution, with which integration has
/// nothing in common.
///
/// # Errors
/// [`LabelError`] says why the collision cannot be computed.
pub(super) fn itinerary(plane: &CollisionPlane, point: &Point) -> Result<String, LabelError> {
    Ok(Collider::deciding().collide(plane.contact(point)?)?.itinerary())
}

/// κ and ψ of the collision at a traced point.
fn scaled(plane: &CollisionPlane, point: &Point) -> [f64; 2] {
    let contact = plane.contact_or_any(point);
    [contact.kappa(), contact.psi()]
}

/// What the tracer saw and could not explain, in sentences.
pub(crate) fn unresolved<Label, Margin>(
    plane: &CollisionPlane,
    vertices: &[Vertex<Margin>],
    unresolved: &[Unresolved<Label>],
) -> Vec<String> {
    let at = |point: &Point| {
        let [kappa, psi] = scaled(plane, point);
        format!("kappa = {kappa:?}, psi = {psi:?}")
    };
    let describe = |open: &Unresolved<Label>| match open {
        Unresolved::Change { between: [one, two], .. } => {
            format!("the switches change between {} and {} without a boundary", at(one), at(two))
        }
        Unresolved::Stalled { vertex } => {
            let place = at(&vertices[*vertex].point);
            format!("a boundary ends without a known cause at vertex {vertex}, {place}")
        }
        Unresolved::TooManyNodes { point } => {
            format!("a boundary has too many points and was left at {}", at(point))
        }
        Unresolved::NoLength { point, .. } => {
            format!("a boundary has no length at {}", at(point))
        }
        Unresolved::TooManyCurves { point } => {
            format!("too many boundaries; the next one starts at {}", at(point))
        }
    };
    unresolved.iter().map(describe).collect()
}
