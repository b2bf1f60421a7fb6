//! Where a vertical line crosses the boundaries of an atlas.

use stickslip_tracer::Cubic;

use super::regions::Atlas;

impl Atlas {
    /// ψ of all boundaries at `kappa`, in ascending order. They are as accurate as the boundaries.
    #[must_use]
    pub fn boundaries_at(&self, kappa: f64) -> Vec<f64> {
        let x = self.chart.point(kappa, self.frame.psi.low).x;
        let mut psi = Vec::new();
        for nodes in self.regions.curves().iter().flat_map(|curve| curve.nodes.windows(2)) {
            let cubic = Cubic::between(&nodes[0], &nodes[1]);
            let right = |t: f64| cubic.at(t).x > x;
            let cuts = cubic.monotone_cuts();
            let mut from = 0.0;
            for to in cuts.into_iter().chain([1.0]) {
                if right(from) != right(to) {
                    let place = cubic.at(crossing(from, to, right));
                    psi.push(self.chart.parameters(&place)[1]);
                }
                from = to;
            }
        }
        psi.sort_by(f64::total_cmp);
        psi
    }
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
