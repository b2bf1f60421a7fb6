//! The comparison of the labels of runs and of regions, and its statistics.

use crate::regions::region::CurveSide;
use crate::regions::subdivision::Subdivision;
use crate::regions::verify::limit::upper_limit;
use crate::regions::verify::report::{
    Checkpoint, Mismatch, Origin, Reason, Unverified, Verification,
};
use crate::window::Point;

/// Compares the labels of runs and of regions, one after the other.
pub struct Judge<'a, Label, Margin, Error> {
    plane: &'a Subdivision<Label, Margin>,
    /// The labels of the regions.
    expected: Vec<Option<Label>>,
    /// The number of compared labels in every region.
    tried: Vec<usize>,
    /// Whether a region has a mismatch.
    wrong: Vec<bool>,
    /// The points of every region that have its label.
    agreeing: Vec<Vec<Point>>,
    mismatches: Vec<Mismatch<Label>>,
    unverified: Vec<Unverified<Error>>,
    /// Whether a label was compared on the left and on the right of every curve.
    beside: Vec<[bool; 2]>,
    /// The number of random points of the window.
    random: u64,
    /// The number of random points with another label than their region.
    wrong_random: u64,
}

impl<Label: Clone + Ord, Error> Verification<Label, Error> {
    /// A verification that has not compared anything yet.
    #[must_use]
    pub fn untried<Margin>(plane: &Subdivision<Label, Margin>) -> Self {
        Judge::new(plane, Vec::new()).finish()
    }
}

impl<'a, Label: Clone + Ord, Margin, Error> Judge<'a, Label, Margin, Error> {
    pub fn new(plane: &'a Subdivision<Label, Margin>, unverified: Vec<Unverified<Error>>) -> Self {
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

    /// Compares the label of a run in a region.
    pub fn consider(&mut self, checkpoint: Checkpoint, region: usize, label: Result<Label, Error>) {
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
        if !right && checkpoint.origin == Origin::Sample && self.plane.is_thin(region) {
            // The sample may lie beyond the boundary, by less than their errors.
            return;
        }
        self.tried[region] += 1;
        match checkpoint.origin {
            Origin::Sample => {}
            Origin::Random => {
                self.random += 1;
                self.wrong_random += u64::from(!right);
            }
            Origin::Near { curve, side, .. } => {
                self.beside[curve][usize::from(side == CurveSide::Right)] = true;
            }
        }
        if right {
            self.agreeing[region].push(checkpoint.point);
        } else {
            self.wrong[region] = true;
            self.mismatches.push(Mismatch { checkpoint, region, expected, found, agreeing: None });
        }
    }

    /// The result of the comparison.
    pub fn finish(mut self) -> Verification<Label, Error> {
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
        let mut found = Verification {
            euler: self.plane.euler(),
            findings: 0,
            tried: self.tried,
            mismatches: self.mismatches,
            unverified: self.unverified,
            untried_curves: (0..self.beside.len())
                .filter(|&curve| self.beside[curve].contains(&false))
                .collect(),
            tried_area: tried_area / self.plane.window().area(),
            wrong_area_bound: upper_limit(self.random, self.wrong_random),
        };
        found.findings = found.standing(self.plane).count();
        found
    }
}
