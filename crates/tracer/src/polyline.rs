//! Curves as pictures draw them.

use crate::cubic::Cubic;
use crate::curve::Curve;
use crate::window::Point;

impl<Label, Margin> Curve<Label, Margin> {
    /// Points along the curve that are so close that straight lines between them look smooth in a
    /// picture of a window of this extent.
    #[must_use]
    pub fn polyline(&self, extent: &Point) -> Vec<Point> {
        /// The largest number of straight lines between two nodes.
        const MOST_LINES: f64 = 16.0;
        /// The number of straight lines for a piece of the curve as long as the window is high.
        const LINES: f64 = 60.0;
        let mut points = vec![self.nodes[0].point];
        for nodes in self.nodes.windows(2) {
            let cubic = Cubic::between(&nodes[0], &nodes[1]);
            let length = (nodes[1].point - nodes[0].point).component_div(extent).norm();
            let lines = (LINES * length).ceil().clamp(1.0, MOST_LINES);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let count = lines as u32;
            points.extend((1..=count).map(|line| cubic.at(f64::from(line) / lines)));
        }
        points
    }
}
