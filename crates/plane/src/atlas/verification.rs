//! What the comparison of an atlas with collisions found.

use stickslip_tracer::{
    Atlas, AtlasOptions, Doubts, Effort,
    regions::{Origin, Verification},
};

use super::boundary::BoundaryKind;
use crate::family::CollisionPlane;

/// What the verification of an atlas found, in the layout of the atlas file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VerificationReport {
    /// Whether nothing speaks against the atlas and nothing is unresolved.
    pub agrees: bool,
    /// The method that computed the collisions.
    pub method: String,
    /// How much was done.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Effort::is_default"))]
    pub effort: Effort,
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

impl VerificationReport {
    /// The report of an atlas that was verified with these options.
    pub(super) fn new(
        plane: &CollisionPlane,
        options: &AtlasOptions,
        atlas: &Atlas<String, BoundaryKind>,
    ) -> Self {
        let doubts = atlas.doubts(plane).unwrap_or_default();
        let cancelled = (!atlas.is_finished()).then(|| "cancelled before the end".to_owned());
        let unresolved = cancelled.into_iter().chain(doubts.unresolved).chain(doubts.failed);
        let Verification { euler, mismatches, tried, unverified, untried_curves, .. } =
            &atlas.verification;
        let mismatches = mismatches.iter().map(|mismatch| {
            let contact = plane.contact_or_any(&mismatch.checkpoint.point);
            MismatchFields {
                kappa: contact.kappa(),
                psi: contact.psi(),
                region: mismatch.region,
                expected: mismatch.expected.clone(),
                found: mismatch.found.clone(),
                near_boundary: matches!(mismatch.checkpoint.origin, Origin::Near { .. }),
            }
        });
        Self {
            agrees: atlas.agrees(),
            method: "dop853".to_owned(),
            effort: options.effort,
            euler: EulerFields {
                vertices: euler.vertices,
                edges: euler.edges,
                faces: euler.faces,
                components: euler.components,
                holds: euler.holds(),
            },
            random_points: options.verify.random_points,
            near_points: options.verify.near_points,
            tried: tried.iter().sum(),
            undecided: unverified.len() - atlas.verification.failed().count(),
            mismatches: mismatches.collect(),
            unresolved: unresolved.collect(),
            findings: doubts.findings,
            untried_boundaries: untried_curves.clone(),
            share_tried: atlas.verification.tried_area,
            share_wrong_bound: atlas.verification.wrong_area_bound,
        }
    }

    /// A line that says what speaks against the atlas; `None` if nothing does.
    pub fn objection(&self) -> Option<String> {
        let mismatch = |mismatch: &MismatchFields| {
            let MismatchFields { kappa, psi, region, expected, found, .. } = mismatch;
            format!("kappa = {kappa:?}, psi = {psi:?} has {found}, its region {region} {expected}")
        };
        let doubts = Doubts {
            finished: true,
            mismatches: self.mismatches.iter().map(mismatch).collect(),
            unresolved: self.unresolved.clone(),
            findings: self.findings.clone(),
            failed: Vec::new(),
        };
        (!self.agrees).then(|| doubts.objection())
    }
}
