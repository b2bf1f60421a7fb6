//! Windows of collisions with more and more curves.

use std::error::Error;

use rayon::prelude::*;
use stickslip::model::Engine;
use stickslip::plane::Range;
use stickslip::plane::atlas::{self, CollisionAtlas, Frame};
use stickslip::plane::progress::SILENT;

use crate::{Row, timed};

/// A window of κ and ψ at one damping, and about how many curves it has.
pub struct Window {
    kappa: [f64; 2],
    psi: [f64; 2],
    damping: f64,
    pub about: usize,
}

const fn window(kappa: [f64; 2], psi: [f64; 2], damping: f64, about: usize) -> Window {
    Window { kappa, psi, damping, about }
}

/// The windows that are traced. The number of curves grows about as the greatest κ.
pub const WINDOWS: [Window; 8] = [
    window([0.05, 100.0], [0.01, 3.0], 0.0, 50),
    window([0.05, 100.0], [0.01, 3.0], 0.1, 80),
    window([100.0, 1000.0], [0.1, 2.0], 0.0, 350),
    window([100.0, 1000.0], [0.1, 2.0], 0.1, 350),
    window([100.0, 3000.0], [0.1, 2.0], 0.0, 1100),
    window([100.0, 3000.0], [0.1, 2.0], 0.1, 1100),
    window([100.0, 6000.0], [0.1, 2.0], 0.1, 2300),
    window([100.0, 12_000.0], [0.1, 2.0], 0.1, 4800),
];

/// The atlas of a window, compared with collisions.
pub fn row(window: &Window, points: usize) -> Result<Row, Box<dyn Error>> {
    let &Window { kappa, psi, damping, .. } = window;
    let [kappa, psi] = [kappa, psi].map(|[low, high]| Range { low, high });
    let frame = Frame::new(kappa, psi, damping);
    let (found, seconds) = timed(|| atlas::trace(frame, frame.tolerances().usual, SILENT));
    let found = found?;
    let regions = &found.regions;
    Ok(Row {
        what: format!(
            "κ {:?}:{:?}, ψ {:?}:{:?}, a = {damping:?}",
            kappa.low, kappa.high, psi.low, psi.high
        ),
        curves: regions.curves().len(),
        regions: regions.regions().len(),
        unresolved: found.report.unresolved.len(),
        findings: found.report.findings.len(),
        wrong: wrong(&found, points),
        objection: found.objection(),
        seconds,
    })
}

/// The number of random points, uniform in the logarithms of κ and ψ, whose region has other
/// switches than their collisions.
fn wrong(atlas: &CollisionAtlas, points: usize) -> usize {
    let [kappa, psi] = atlas.plane.sheet().sides;
    let plane = atlas.plane;
    let mut random = fastrand::Rng::with_seed(1);
    let mut place =
        |Range { low, high }: Range| (low * (high / low).powf(random.f64())).clamp(low, high);
    let points: Vec<[f64; 2]> = (0..points).map(|_| [place(kappa), place(psi)]).collect();
    let is_wrong = |point: &[f64; 2]| {
        let Ok(contact) = plane.contact_at(*point) else { return true };
        let Ok(region) = atlas.locate(*point).region else { return true };
        let found = Engine::Auto.collide(contact);
        found.map_or(true, |(found, _)| found.itinerary() != atlas.itinerary(region))
    };
    points.par_iter().filter(|point| is_wrong(point)).count()
}
