//! Where a vertical line crosses boundaries.

use stickslip_tracer::{Cubic, Node, Point};

use super::regions::Atlas;

impl Atlas {
    /// ψ of all boundaries at `kappa`, in ascending order. They are as accurate as the boundaries.
    #[must_use]
    pub fn boundaries_at(&self, kappa: f64) -> Vec<f64> {
        let x = self.plane.chart().abscissa(kappa);
        let curves = self.regions.curves().iter().flat_map(|curve| curve.nodes.windows(2));
        let psi = curves.flat_map(|nodes| crossings(nodes, x));
        let mut psi: Vec<f64> = psi.map(|place| self.plane.parameters(&place)[1]).collect();
        psi.sort_by(f64::total_cmp);
        psi
    }
}

/// The places at which the cubic between two nodes crosses the line at `x`.
pub fn crossings(nodes: &[Node], x: f64) -> Vec<Point> {
    let [first, second] = nodes else { return Vec::new() };
    let cubic = Cubic::between(first, second);
    let right = |t: f64| cubic.at(t).x > x;
    let mut found = Vec::new();
    let mut from = 0.0;
    for to in cubic.monotone_cuts().into_iter().chain([1.0]) {
        if right(from) != right(to) {
            found.push(cubic.at(crossing(from, to, right)));
        }
        from = to;
    }
    found
}

/// The place between `from` and `to` at which `right` changes, by bisection to the last bit.
fn crossing(mut from: f64, mut to: f64, right: impl Fn(f64) -> bool) -> f64 {
    let at_start = right(from);
    loop {
        let middle = f64::midpoint(from, to);
        if middle <= from || middle >= to {
            return middle;
        }
        if right(middle) == at_start { from = middle } else { to = middle }
    }
}
