//! A boundary as far as it has been followed: the state from which the next step starts.

use std::collections::VecDeque;

use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::{Family, FreeRun};
use crate::tracing::end::Stop;
use crate::tracing::fit::Fit;
use crate::tracing::runs::{Runs, Traced};
use crate::window::Point;

/// An accepted place of a branch, with what is known there.
#[derive(Clone, Debug)]
pub struct Foothold<Label, Margin> {
    pub node: Node,
    /// The gradient of the margin that is followed.
    pub gradient: Point,
    /// The free runs on the left and on the right.
    pub sides: [FreeRun<Label, Margin>; 2],
}

/// The foothold of a family.
pub type FootholdOf<F> = Foothold<<F as Family>::Label, <F as Family>::Margin>;

/// A boundary as far as it has been followed.
pub struct Track<'a, 'f, F: Family> {
    pub runs: &'a Runs<'f, F>,
    /// The margin that is followed.
    pub margin: F::Margin,
    /// The labels on the left and on the right.
    pub sides: [F::Label; 2],
    /// 1 if the margin is positive on the left, −1 if it is positive on the right.
    pub orientation: f64,
    /// The known vertices.
    pub stops: &'a [Stop],
    /// The start of the branch.
    pub origin: Node,
    /// The last footholds, at most two, oldest first.
    pub footholds: VecDeque<FootholdOf<F>>,
    /// The length of the next step.
    pub step: f64,
    /// The radius of curvature at the last foothold.
    pub radius: f64,
    /// The number of accepted steps.
    pub taken: usize,
}

impl<F: Family> Track<'_, '_, F> {
    /// The tangent of the boundary at a place with this gradient.
    pub fn tangent(&self, gradient: &Point) -> Point {
        Point::new(gradient.y, -gradient.x) * (self.orientation / gradient.norm())
    }

    /// The foothold at a place of the boundary, with free runs on both sides; `Err` if their labels
    /// are not the labels of the branch.
    ///
    /// If another boundary is closer than the offset of the free runs, smaller offsets are tried,
    /// down to the accuracy of the place.
    pub fn foothold(
        &self,
        point: &Point,
        gradient: &Point,
    ) -> Traced<Result<FootholdOf<F>, FootholdOf<F>>, F> {
        let tangent = self.tangent(gradient);
        let left = Point::new(-tangent.y, tangent.x);
        let node = Node { point: *point, tangent };
        let mut widest = None;
        for offset in self.offsets(gradient) {
            let sides = [
                self.runs.free(&(point + left * offset))?,
                self.runs.free(&(point - left * offset))?,
            ];
            let holds = sides[0].label == self.sides[0] && sides[1].label == self.sides[1];
            let foothold = Foothold { node, gradient: *gradient, sides };
            if holds {
                return Ok(Ok(foothold));
            }
            widest.get_or_insert(foothold);
        }
        // The longest offset is ten times the resolution, so that there is one.
        Ok(Err(widest.unwrap()))
    }

    /// The distances beside a place with this gradient at which free runs are tried, longest first.
    pub fn offsets(&self, gradient: &Point) -> impl Iterator<Item = f64> + use<F> {
        let resolution = self.runs.resolution(gradient.norm());
        let longest = self.runs.options.offset.max(10.0 * resolution);
        std::iter::successors(Some(longest), |offset| Some(0.1 * offset))
            .take_while(move |&offset| offset >= 5.0 * resolution)
    }

    /// The boundary, to which cubics are fitted.
    pub fn fit(&self) -> Fit<'_, '_, F> {
        Fit { runs: self.runs, margin: &self.margin, radius: self.radius }
    }

    /// The node at `point`, where the branch ends, behind `last`.
    pub fn end_node(&self, last: &Node, point: &Point) -> Traced<Node, F> {
        self.fit().end(last, point)
    }

    /// The predicted place after a step of length `h` from the last node. It lies on the last
    /// cubic, continued, if the step is not much longer than this cubic; else it lies on the
    /// tangent.
    pub fn predict(&self, node: &Node, h: f64) -> Point {
        let before = self.footholds.len().checked_sub(2).map(|index| self.footholds[index].node);
        if let Some(before) = before {
            let arc = Cubic::between(&before, node);
            if h < 2.5 * arc.chord() && arc.chord() > self.runs.lengths.piece {
                return arc.at(1.0 + h / arc.chord());
            }
        }
        node.point + node.tangent * h
    }

    /// The margins in the free runs at both ends of a step, except the margin that is followed, in
    /// order: either the margins on whose zeros the label is sure to change, or the others.
    pub fn other_margins(
        &self,
        from: &FootholdOf<F>,
        beyond: Option<&FootholdOf<F>>,
        sure: bool,
    ) -> Vec<F::Margin> {
        let mut margins: Vec<F::Margin> = [Some(from), beyond]
            .into_iter()
            .flatten()
            .flat_map(|foothold| foothold.sides.iter())
            .flat_map(|run| run.margins.iter())
            .map(|(margin, _)| margin)
            .filter(|margin| **margin != self.margin && self.runs.is_sure(margin) == sure)
            .cloned()
            .collect();
        margins.sort();
        margins.dedup();
        margins
    }
}
