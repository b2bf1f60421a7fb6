//! Points looked up in an atlas.

use stickslip_model::Contact;
use stickslip_tracer::Location;

use super::regions::Atlas;
use crate::chart::Chart;

/// The place of a collision in an atlas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// The index of the region, or the reason why the region is not known.
    pub region: Result<usize, Unlocated>,
    /// Distance in ψ to the nearest boundary at the same κ; `None` if there is no such boundary.
    pub distance: Option<f64>,
}

/// A point has no known region.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unlocated {
    /// The point is so close to a boundary that the boundary's error leaves the side open.
    #[error("kappa = {kappa:?}, psi = {psi:?} is on boundary {boundary} within its error")]
    OnBoundary {
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
        /// The index of the boundary.
        boundary: usize,
    },
    /// The point is outside the window.
    #[error(
        "kappa = {kappa:?}, psi = {psi:?} is outside the window of the atlas, kappa {:?} to {:?}, \
         psi {:?} to {:?}",
        window[0][0], window[0][1], window[1][0], window[1][1]
    )]
    Outside {
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
        /// The window of the atlas: the ends of κ, and the ends of ψ.
        window: [[f64; 2]; 2],
    },
}

impl Atlas {
    /// Looks up a collision by its κ and ψ. The damping of `contact` is not compared with that of
    /// the atlas.
    #[must_use]
    pub fn locate(&self, contact: &Contact) -> Located {
        let (kappa, psi) = (contact.kappa(), contact.psi());
        let point = self.chart.point(kappa, psi);
        let region = match self.regions.locate(&point) {
            Location::Region(region) => Ok(region),
            Location::OnBoundary { curve: boundary, .. } => {
                Err(Unlocated::OnBoundary { kappa, psi, boundary })
            }
            Location::Outside => {
                let window = [self.frame.kappa, self.frame.psi].map(|side| [side.low, side.high]);
                Err(Unlocated::Outside { kappa, psi, window })
            }
        };
        // ψ₂ − ψ₁ = (1 + ψ₁)(e^(y₂ − y₁) − 1): further up than down for equal distances in y.
        let Chart { spread, height, psi: from, .. } = self.chart;
        let [below, above] = self.regions.vertical_distances(&point);
        let below = below.map(|distance| -(-height * distance).exp_m1());
        let above = above.map(|distance| (height * distance).exp_m1());
        let nearest = [below, above].into_iter().flatten().reduce(f64::min);
        Located { region, distance: nearest.map(|part| (spread + psi - from) * part) }
    }
}
