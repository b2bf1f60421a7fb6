//! Runs against a subdivision: does the label of a region hold where it is tried?

use crate::family::{Family, Point};
use crate::regions::finding::{Euler, SubdivisionError};
use crate::regions::locate::Location;
use crate::regions::subdivision::{Side, Subdivision};

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

/// A place at which a label was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Where.
    pub point: Point,
    /// Why there.
    pub origin: Origin,
}

/// Why a label was tried at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Origin {
    /// The sample point of a region.
    Sample,
    /// A random point of the window.
    Random,
    /// Beside a curve.
    Near {
        /// The curve.
        curve: usize,
        /// Which side of it.
        side: Side,
        /// Distance from it.
        distance: f64,
    },
}

/// A place at which the label is not that of the region.
#[derive(Clone, Debug, PartialEq)]
pub struct Mismatch<Label> {
    /// Where.
    pub checkpoint: Checkpoint,
    /// The region by location.
    pub region: usize,
    /// Its label.
    pub expected: Label,
    /// The label of the run.
    pub found: Label,
    /// The nearest place of the same region at which the label was as expected. A boundary that is
    /// missing, or one that is misplaced, leads between both points: a bracket to start
    /// tracing from.
    pub agreeing: Option<Point>,
}

/// A place about which nothing is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Unverified<Error> {
    /// Where.
    pub checkpoint: Checkpoint,
    /// Why.
    pub reason: Reason<Error>,
}

/// Why nothing is known about a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason<Error> {
    /// It is within the tolerance of a curve, or in no region.
    Location(Location),
    /// The region has no label: no curve bounds it, and the run at its sample point failed.
    NoLabel {
        /// The region.
        region: usize,
    },
    /// The run failed.
    Run(Error),
}

/// What a verification found.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification<Label, Error> {
    /// The counts of Euler's formula.
    pub euler: Euler,
    /// How many findings the subdivision has.
    pub findings: usize,
    /// How many places were tried in each region.
    pub tried: Vec<usize>,
    /// Where the label was another one, in the order in which places were tried.
    pub mismatches: Vec<Mismatch<Label>>,
    /// Places about which nothing is known.
    pub unverified: Vec<Unverified<Error>>,
    /// Curves beside which no label was tried on one side at least.
    pub untried_curves: Vec<usize>,
    /// Share of the window's area in regions that were tried without a mismatch.
    pub tried_area: f64,
    /// With 95 % confidence, the share of the window's area that has another label is below this:
    /// the upper limit of Clopper and Pearson (1934), from the random points.
    pub wrong_area_bound: f64,
}

impl<Label, Error> Verification<Label, Error> {
    /// Pairs of places in one region by location, of which one has the label of the region and the
    /// other has not: between them lies a boundary for
    /// [`Tracer::look_between`](crate::Tracer::look_between) to find.
    #[must_use]
    pub fn brackets(&self) -> Vec<[Point; 2]> {
        let bracket = |mismatch: &Mismatch<Label>| {
            mismatch.agreeing.map(|agreeing| [agreeing, mismatch.checkpoint.point])
        };
        self.mismatches.iter().filter_map(bracket).collect()
    }

    /// Whether nothing speaks against the subdivision.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.findings == 0 && self.euler.holds() && self.mismatches.is_empty()
    }
}

/// Verification cannot be done.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum VerifyError {
    /// The curves make no subdivision.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The distances from curves are not in order.
    #[error(
        "distances from {nearest:e} to {farthest:e}: both must be finite and above 0, the first not the greater"
    )]
    Distances {
        /// Least distance.
        nearest: f64,
        /// Greatest distance.
        farthest: f64,
    },
    /// Not one label a point came back.
    #[error("{points} points have {labels} labels")]
    Labels {
        /// How many points.
        points: usize,
        /// How many labels.
        labels: usize,
    },
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

struct Judge<'a, Label, Margin, Error> {
    plane: &'a Subdivision<Label, Margin>,
    expected: Vec<Option<Label>>,
    tried: Vec<usize>,
    wrong: Vec<bool>,
    agreeing: Vec<Vec<Point>>,
    mismatches: Vec<Mismatch<Label>>,
    unverified: Vec<Unverified<Error>>,
    /// Of every curve, whether a label was tried on the left and on the right.
    beside: Vec<[bool; 2]>,
    random: u64,
    wrong_random: u64,
}

impl<'a, Label: Clone + Ord, Margin, Error> Judge<'a, Label, Margin, Error> {
    fn new(plane: &'a Subdivision<Label, Margin>, unverified: Vec<Unverified<Error>>) -> Self {
        let count = plane.regions().len();
        Self {
            plane,
            expected: plane.regions().iter().map(|region| region.label.clone()).collect(),
            tried: vec![0; count],
            wrong: vec![false; count],
            agreeing: vec![Vec::new(); count],
            mismatches: Vec::new(),
            unverified,
            beside: vec![[false; 2]; plane.curves().len()],
            random: 0,
            wrong_random: 0,
        }
    }

    fn consider(&mut self, checkpoint: Checkpoint, region: usize, label: Result<Label, Error>) {
        let found = match label {
            Ok(found) => found,
            Err(error) => {
                self.unverified.push(Unverified { checkpoint, reason: Reason::Run(error) });
                return;
            }
        };
        if checkpoint.origin == Origin::Sample && self.expected[region].is_none() {
            self.expected[region] = Some(found.clone());
        }
        let Some(expected) = self.expected[region].clone() else {
            self.unverified.push(Unverified { checkpoint, reason: Reason::NoLabel { region } });
            return;
        };
        let right = found == expected;
        self.tried[region] += 1;
        match checkpoint.origin {
            Origin::Sample => {}
            Origin::Random => {
                self.random += 1;
                self.wrong_random += u64::from(!right);
            }
            Origin::Near { curve, side, .. } => {
                self.beside[curve][usize::from(side == Side::Right)] = true;
            }
        }
        if right {
            self.agreeing[region].push(checkpoint.point);
        } else {
            self.wrong[region] = true;
            self.mismatches.push(Mismatch { checkpoint, region, expected, found, agreeing: None });
        }
    }

    fn finish(mut self) -> Verification<Label, Error> {
        for mismatch in &mut self.mismatches {
            let distance = |point: &Point| (point - mismatch.checkpoint.point).norm_squared();
            mismatch.agreeing = self.agreeing[mismatch.region]
                .iter()
                .copied()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
        let tried_area: f64 = self
            .plane
            .regions()
            .iter()
            .zip(self.tried.iter().zip(&self.wrong))
            .filter(|&(_, (&tried, &wrong))| tried > 0 && !wrong)
            .map(|(region, _)| region.area)
            .sum();
        Verification {
            euler: self.plane.euler(),
            findings: self.plane.findings().len(),
            tried: self.tried,
            mismatches: self.mismatches,
            unverified: self.unverified,
            untried_curves: (0..self.beside.len())
                .filter(|&curve| self.beside[curve].contains(&false))
                .collect(),
            tried_area: tried_area / self.plane.window().area(),
            wrong_area_bound: upper_limit(self.random, self.wrong_random),
        }
    }
}

/// The probability p for which `wrong` or fewer of `tried` have the probability 5 %.
fn upper_limit(tried: u64, wrong: u64) -> f64 {
    if wrong >= tried {
        return 1.0;
    }
    let (n, m) = (tried as f64, wrong as f64);
    let choose: f64 = (0..wrong).map(|i| ((n - i as f64) / (i as f64 + 1.0)).ln()).sum();
    let at_most = |p: f64| {
        let mut term = (choose + m * p.ln() + (n - m) * (-p).ln_1p()).exp();
        let mut sum = term;
        for k in (0..wrong).rev() {
            term *= (k as f64 + 1.0) * (1.0 - p) / ((n - k as f64) * p);
            sum += term;
        }
        sum
    };
    let (mut low, mut high) = (m / n, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at_most(middle) > 0.05 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::upper_limit;

    #[test]
    fn limits_are_those_of_tables() {
        assert_eq!(upper_limit(0, 0), 1.0);
        assert!((upper_limit(100, 0) - (1.0 - 0.05_f64.powf(0.01))).abs() < 1e-12);
        // One-sided 95 % limits: 1 of 10, and n − 1 of n, for which 1 − pⁿ = 0.05.
        assert!((upper_limit(10, 1) - 0.394163).abs() < 1e-6);
        assert!((upper_limit(10, 9) - 0.95_f64.powf(0.1)).abs() < 1e-12);
        assert!(upper_limit(100_000, 5_000) < 0.052);
    }
}
