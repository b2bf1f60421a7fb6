//! The events that a run found, against the true ones.
//!
//! `peers.py` judges by the same rules.

use super::{Case, ExpectedOutcome, Place, Truth};

/// A found event is misplaced if it is farther than the tolerance from a true one, but not farther
/// than this many tolerances.
const MISPLACED: f64 = 1e3;

/// How many events are right, and how many are wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Events found within the tolerance of their place.
    pub right: usize,
    /// True events that were not found.
    pub missed: usize,
    /// Found events that do not exist.
    pub invented: usize,
    /// Found events that are far from their place.
    pub misplaced: usize,
    /// The largest error of a place that is right.
    pub error: f64,
}

impl Verdict {
    /// Whether nothing is wrong.
    pub fn is_right(&self) -> bool {
        self.missed == 0 && self.invented == 0 && self.misplaced == 0
    }

    /// Compares the events that a run found with those of the case.
    pub(super) fn of(case: &Case, mut found: Vec<Place>) -> Self {
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        match &case.truth {
            Truth::All(truth) => Self::of_all(case, truth.clone(), found),
            Truth::Sampled(count, samples) => {
                Self::of_samples(case.tolerance, *count, samples, &found)
            }
        }
    }

    fn of_all(case: &Case, mut truth: Vec<Place>, mut found: Vec<Place>) -> Self {
        let last = truth.last().map_or(case.end, |event| event.0);
        let errors = match_events(case.tolerance, &mut truth, &mut found);
        if let ExpectedOutcome::Zeno(place) | ExpectedOutcome::Stuck(place) = case.outcome {
            // Infinitely many events lie between the last one that is listed and the accumulation.
            let ignored = last - case.tolerance..=place + case.tolerance;
            found.retain(|event| !ignored.contains(&event.0));
        }
        let misplaced = match_events(MISPLACED * case.tolerance, &mut truth, &mut found).len();
        Self {
            right: errors.len(),
            missed: truth.len(),
            invented: found.len(),
            misplaced,
            error: errors.into_iter().fold(0.0, f64::max),
        }
    }

    fn of_samples(
        tolerance: f64,
        count: usize,
        samples: &[(usize, Place)],
        found: &[Place],
    ) -> Self {
        let off = |(index, (time, _)): &(usize, Place)| {
            found.get(*index).map_or(f64::INFINITY, |event| (event.0 - time).abs())
        };
        let (near, far): (Vec<f64>, Vec<f64>) =
            samples.iter().map(off).partition(|&error| error <= tolerance);
        let shared = found.len().min(count);
        Self {
            right: shared.saturating_sub(far.len()),
            missed: count - shared,
            invented: found.len() - shared,
            misplaced: far.len(),
            error: near.into_iter().fold(0.0, f64::max),
        }
    }
}

/// Takes out the pairs of events of one guard that are `within` a distance, greedily in the order
/// of time, and returns their distances.
fn match_events(within: f64, truth: &mut Vec<Place>, found: &mut Vec<Place>) -> Vec<f64> {
    let mut distances = Vec::new();
    truth.retain(|&(time, guard)| {
        let near = |event: &Place| event.1 == guard && (event.0 - time).abs() <= within;
        let place = found.iter().position(near);
        if let Some(k) = place {
            distances.push((found.remove(k).0 - time).abs());
        }
        place.is_none()
    });
    distances
}
