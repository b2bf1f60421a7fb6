//! Runs against a subdivision: does the label of a region hold where it is tried?
//!
//! `report` holds what a verification finds, `judge` compares the labels.

mod judge;
pub mod report;

use crate::family::Family;
use crate::regions::locate::Location;
use crate::regions::region::Side;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::judge::Judge;
use crate::regions::verify::report::{
    Checkpoint, Origin, Reason, Unverified, Verification, VerifyError,
};
use crate::window::Point;

/// Where labels are tried, besides the sample point of every region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerifyOptions {
    /// Points spread evenly at random over the window.
    pub random_points: usize,
    /// Points on each side of every curve, at distances between `nearest` and `farthest` whose
    /// logarithms are spread evenly.
    pub near_points: usize,
    /// Least distance from the curve.
    pub nearest: f64,
    /// Greatest distance from the curve.
    pub farthest: f64,
    /// The same seed gives the same points.
    pub seed: u64,
}

impl Default for VerifyOptions {
    fn default() -> Self {
        Self { random_points: 10_000, near_points: 20, nearest: 1e-8, farthest: 1e-3, seed: 1 }
    }
}

/// Tries the labels of `plane` against runs of `family`, one after the other.
///
/// # Errors
/// Distances that are not in order. A run that fails is no error but [`Unverified`].
pub fn verify<F: Family>(
    plane: &Subdivision<F::Label, F::Margin>,
    family: &F,
    options: &VerifyOptions,
) -> Result<Verification<F::Label, F::Error>, VerifyError> {
    verify_with(plane, options, |points| points.iter().map(|point| family.label(point)).collect())
}

/// As [`verify`], with all labels asked for at once, so that runs can be parallel: `labels` returns
/// them in the order of the points.
///
/// # Errors
/// Distances that are not in order, or another number of labels than of points.
pub fn verify_with<Label: Clone + Ord, Margin, Error>(
    plane: &Subdivision<Label, Margin>,
    options: &VerifyOptions,
    labels: impl FnOnce(&[Point]) -> Vec<Result<Label, Error>>,
) -> Result<Verification<Label, Error>, VerifyError> {
    let VerifyOptions { nearest, farthest, .. } = *options;
    if !(nearest > 0.0 && nearest <= farthest && farthest.is_finite()) {
        return Err(VerifyError::Distances { nearest, farthest });
    }
    let mut unverified = Vec::new();
    let mut places = Vec::new();
    for checkpoint in checkpoints(plane, options) {
        match plane.locate(&checkpoint.point) {
            Location::Region(region) => places.push((checkpoint, region)),
            // A place beside a curve at the window's boundary may be outside: there is nothing to
            // try.
            Location::Outside if !plane.window().contains(&checkpoint.point) => {}
            location => {
                unverified.push(Unverified { checkpoint, reason: Reason::Location(location) });
            }
        }
    }
    let points: Vec<Point> = places.iter().map(|(checkpoint, _)| checkpoint.point).collect();
    let labels = labels(&points);
    if labels.len() != points.len() {
        return Err(VerifyError::Labels { points: points.len(), labels: labels.len() });
    }
    let mut judge = Judge::new(plane, unverified);
    for ((checkpoint, region), label) in places.into_iter().zip(labels) {
        judge.consider(checkpoint, region, label);
    }
    Ok(judge.finish())
}

/// The sample points first, so that a region's label is known before it is needed.
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
        for side in [Side::Left, Side::Right] {
            for _ in 0..options.near_points {
                let (point, left) = plane.place_on(curve, random.f64());
                let distance = options.nearest * ratio.powf(random.f64());
                let away = if side == Side::Left { distance } else { -distance };
                let point = point + away * left;
                checkpoints
                    .push(Checkpoint { point, origin: Origin::Near { curve, side, distance } });
            }
        }
    }
    checkpoints
}
