//! Points looked up in an atlas.

use stickslip_model::{Contact, Engine};
use stickslip_tracer::{Location, Point, Window};

use super::frame::Frame;
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
    /// The point is within a boundary's error, and its collision has the switches of no region
    /// there.
    #[error(
        "kappa = {kappa:?}, psi = {psi:?} is on boundary {boundary} within its error, and its \
         collision has other switches than the regions there"
    )]
    OnBoundary {
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
        /// The index of the boundary.
        boundary: usize,
    },
    /// The point is on the edge of the window, and its collision has other switches than the region
    /// there: a boundary runs along the edge.
    #[error(
        "kappa = {kappa:?}, psi = {psi:?} is on the edge of the window, and its collision has other \
         switches than the region there"
    )]
    OnEdge {
        /// κ of the point.
        kappa: f64,
        /// ψ of the point.
        psi: f64,
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
    /// Looks up a collision by its κ and ψ. Within the error of a boundary, the collision itself
    /// decides, computed by the best engine for it. Damping and law are those of the atlas,
    /// whatever those of `contact` are.
    #[must_use]
    pub fn locate(&self, contact: &Contact) -> Located {
        let (kappa, psi) = (contact.kappa(), contact.psi());
        let point = self.chart.point(kappa, psi);
        let region = match self.regions.locate(&point) {
            Location::Region(region) if !self.is_at_edge(&point) => Ok(region),
            // A boundary may lie on the edge of the window.
            Location::Region(region) => match self.itinerary_of(contact) {
                Some(itinerary) if itinerary != self.itinerary(region) => {
                    Err(Unlocated::OnEdge { kappa, psi })
                }
                _ => Ok(region),
            },
            Location::OnBoundary { curve: boundary, .. } => {
                let region = self.decided(boundary, contact);
                region.ok_or(Unlocated::OnBoundary { kappa, psi, boundary })
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

    /// Whether a point is closer to the edge of the window than boundaries are known.
    fn is_at_edge(&self, point: &Point) -> bool {
        let resolution = self.regions.tolerance();
        let Window { low, high } = *self.regions.window();
        (point - low).min() <= resolution || (high - point).min() <= resolution
    }

    /// The itinerary of the collision itself, with the damping of the atlas.
    fn itinerary_of(&self, contact: &Contact) -> Option<String> {
        let Frame { damping, law, tangential_damping, .. } = self.frame;
        let contact = Contact::new(contact.kappa(), contact.psi(), damping)
            .and_then(|contact| contact.with_law(law, tangential_damping))
            .ok()?;
        let (collision, _) = Engine::Auto.collide(contact).ok()?;
        Some(collision.itinerary())
    }

    /// The region beside `boundary`, or beside one that meets it, in which collisions have the
    /// switches of this one.
    fn decided(&self, boundary: usize, contact: &Contact) -> Option<usize> {
        let itinerary = self.itinerary_of(contact)?;
        let curves = self.regions.curves();
        let ends = |curve: usize| curves[curve].ends.into_iter().flatten();
        let meeting = (0..curves.len())
            .filter(|&other| ends(other).any(|end| ends(boundary).any(|own| own == end)));
        let beside = |curve: usize| self.regions.regions_beside(curve).into_iter().flatten();
        std::iter::once(boundary)
            .chain(meeting)
            .flat_map(beside)
            .find(|&region| self.itinerary(region) == itinerary)
    }
}
