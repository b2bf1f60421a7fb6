//! Verification: do runs at random points have the labels of their regions?
//!
//! `report` holds what a verification finds, `judge` compares the labels, and `limit` has the
//! statistics.

mod judge;
mod limit;
pub mod report;

use crate::family::Family;
use crate::regions::finding::SubdivisionError;
use crate::regions::locate::Location;
use crate::regions::region::CurveSide;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::judge::Judge;
use crate::regions::verify::report::{Checkpoint, Origin, Reason, Unverified, Verification};
use crate::window::Point;

/// Where labels are computed, besides the sample point of every region.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VerifyOptions {
    /// The number of random points, spread evenly over the window.
    pub random_points: usize,
    /// The number of random points on each side of every curve. The logarithms of their distances
    /// from the curve are spread evenly between `nearest` and `farthest`.
    pub near_points: usize,
    /// The least distance from the curve.
    pub nearest: f64,
    /// The greatest distance from the curve.
    pub farthest: f64,
    /// The seed of the random numbers. The same seed gives the same points.
    pub seed: u64,
}

impl Default for VerifyOptions {
    fn default() -> Self {
        Self { random_points: 10_000, near_points: 20, nearest: 1e-8, farthest: 1e-3, seed: 1 }
    }
}

/// Compares the labels of `plane` with runs of `family`, one after the other.
///
/// A run that fails is not an error of the verification, but [`Unverified`].
///
/// # Errors
/// The distances of `options` are not in order.
pub fn verify<F: Family>(
    plane: &Subdivision<F::Label, F::Margin>,
    family: &F,
    options: &VerifyOptions,
) -> Result<Verification<F::Label, F::Error>, SubdivisionError> {
    verify_with(plane, options, |points| points.iter().map(|point| family.label(point)).collect())
}

/// Compares the labels of `plane` with the results of `labels`, in the order of the points.
///
/// Unlike [`verify`] it needs all labels at once, so that runs can be parallel.
///
/// # Errors
/// The distances of `options` are not in order, or the numbers of labels and of points differ.
pub fn verify_with<Label: Clone + Ord, Margin, Error>(
    plane: &Subdivision<Label, Margin>,
    options: &VerifyOptions,
    labels: impl FnOnce(&[Point]) -> Vec<Result<Label, Error>>,
) -> Result<Verification<Label, Error>, SubdivisionError> {
    let found = verify_unless_cancelled(plane, options, |points| Some(labels(points)))?;
    Ok(found.unwrap_or_else(|| Verification::untried(plane)))
}

/// As [`verify_with`]; `None` if `labels` returns `None`, because it was cancelled.
///
/// # Errors
/// As [`verify_with`].
pub fn verify_unless_cancelled<Label: Clone + Ord, Margin, Error>(
    plane: &Subdivision<Label, Margin>,
    options: &VerifyOptions,
    labels: impl FnOnce(&[Point]) -> Option<Vec<Result<Label, Error>>>,
) -> Result<Option<Verification<Label, Error>>, SubdivisionError> {
    let VerifyOptions { nearest, farthest, .. } = *options;
    if !(nearest > 0.0 && nearest <= farthest && farthest.is_finite()) {
        return Err(SubdivisionError::Distances { nearest, farthest });
    }
    let mut unverified = Vec::new();
    let mut places = Vec::new();
    for (index, checkpoint) in checkpoints(plane, options).into_iter().enumerate() {
        match plane.locate(&checkpoint.point) {
            Location::Region(region) => places.push((checkpoint, region)),
            // The sample of a thin region. The samples of all regions come first.
            Location::OnBoundary { .. } if checkpoint.origin == Origin::Sample => {
                places.push((checkpoint, index));
            }
            // A point beside a curve near the window's boundary may lie outside and is left out.
            Location::Outside if !plane.window().contains(&checkpoint.point) => {}
            location => {
                unverified.push(Unverified { checkpoint, reason: Reason::Location(location) });
            }
        }
    }
    let points: Vec<Point> = places.iter().map(|(checkpoint, _)| checkpoint.point).collect();
    let Some(labels) = labels(&points) else { return Ok(None) };
    if labels.len() != points.len() {
        return Err(SubdivisionError::Labels { points: points.len(), labels: labels.len() });
    }
    let mut judge = Judge::new(plane, unverified);
    for ((checkpoint, region), label) in places.into_iter().zip(labels) {
        judge.consider(checkpoint, region, label);
    }
    Ok(Some(judge.finish()))
}

/// The points at which labels are computed. Sample points come first, so that the label of a region
/// is known before it is needed.
fn checkpoints<Label: Clone + Ord, Margin>(
    plane: &Subdivision<Label, Margin>,
    options: &VerifyOptions,
) -> Vec<Checkpoint> {
    let mut random = fastrand::Rng::with_seed(options.seed);
    let samples = plane.regions().iter().map(|region| region.sample);
    let mut checkpoints: Vec<Checkpoint> =
        samples.map(|point| Checkpoint { point, origin: Origin::Sample }).collect();
    let (low, size) = (plane.window().low, plane.window().high - plane.window().low);
    for _ in 0..options.random_points {
        let point = low + Point::new(random.f64() * size.x, random.f64() * size.y);
        checkpoints.push(Checkpoint { point, origin: Origin::Random });
    }
    let ratio = options.farthest / options.nearest;
    for curve in 0..plane.curves().len() {
        for side in [CurveSide::Left, CurveSide::Right] {
            for _ in 0..options.near_points {
                let (point, left) = plane.place_on(curve, random.f64());
                let distance = options.nearest * ratio.powf(random.f64());
                let away = if side == CurveSide::Left { distance } else { -distance };
                let point = point + away * left;
                checkpoints
                    .push(Checkpoint { point, origin: Origin::Near { curve, side, distance } });
            }
        }
    }
    checkpoints
}
