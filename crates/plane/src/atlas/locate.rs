//! Points looked up in an atlas.

use std::fmt;

use stickslip_model::Engine;
use stickslip_tracer::{Point, Window, regions::Location};

use super::regions::CollisionAtlas;
use crate::chart::{Chart, Range};

/// The place of a collision in an atlas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// The index of the region, or the reason why the region is not known.
    pub region: Result<usize, Unlocated>,
    /// Distance in the second parameter to the nearest boundary at the same first one; `None` if
    /// there is no such boundary.
    pub distance: Option<f64>,
}

/// A point has no known region.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unlocated {
    /// The point is within a boundary's error, and its collision has the switches of no region
    /// there.
    #[error(
        "{place} is on boundary {boundary} within its error, and its collision has other switches \
         than the regions there"
    )]
    OnBoundary {
        /// The point.
        place: ParameterPlace,
        /// The index of the boundary.
        boundary: usize,
    },
    /// The point is on the edge of the window, and its collision has other switches than the region
    /// there: a boundary runs along the edge.
    #[error(
        "{place} is on the edge of the window, and its collision has other switches than the region \
         there"
    )]
    OnEdge {
        /// The point.
        place: ParameterPlace,
    },
    /// The point is outside the window.
    #[error(
        "{place} is outside the window of the atlas, {} {:?} to {:?}, {} {:?} to {:?}",
        place.names[0], window[0].low, window[0].high, place.names[1], window[1].low, window[1].high
    )]
    Outside {
        /// The point.
        place: ParameterPlace,
        /// The window of the atlas.
        window: [Range; 2],
    },
}

/// A place in the window of an atlas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterPlace {
    /// The names of both parameters.
    pub names: [&'static str; 2],
    /// The values of both parameters.
    pub values: [f64; 2],
}

impl fmt::Display for ParameterPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { names, values } = self;
        write!(f, "{} = {:?}, {} = {:?}", names[0], values[0], names[1], values[1])
    }
}

impl CollisionAtlas {
    /// Looks up a collision by its two parameters: κ and ψ, or the velocities. Within the error of
    /// a boundary, the collision itself decides, computed by the best engine for it.
    pub fn locate(&self, parameters: [f64; 2]) -> Located {
        let [x, y] = parameters;
        let point = self.plane.point(x, y);
        let place = ParameterPlace { names: self.plane.names(), values: parameters };
        let region = match self.regions.locate(&point) {
            Location::Region(region) if !self.is_at_edge(&point) => Ok(region),
            // A boundary may lie on the edge of the window.
            Location::Region(region) => match self.itinerary_at(parameters) {
                Some(itinerary) if itinerary != self.itinerary(region) => {
                    Err(Unlocated::OnEdge { place })
                }
                _ => Ok(region),
            },
            Location::OnBoundary { curve: boundary, .. } => {
                let region = self.decided(boundary, parameters);
                region.ok_or(Unlocated::OnBoundary { place, boundary })
            }
            Location::Outside => {
                Err(Unlocated::Outside { place, window: self.plane.sheet().sides })
            }
        };
        // ψ₂ − ψ₁ = (1 + ψ₁)(e^(y₂ − y₁) − 1): further up than down for equal distances in y.
        let Chart { spread, height, psi: from, .. } = *self.plane.chart();
        let [below, above] = self.regions.vertical_distances(&point);
        let below = below.map(|distance| -(-height * distance).exp_m1());
        let above = above.map(|distance| (height * distance).exp_m1());
        let nearest = [below, above].into_iter().flatten().reduce(f64::min);
        Located { region, distance: nearest.map(|part| (spread + y - from) * part) }
    }

    /// Whether a point is closer to the edge of the window than boundaries are known.
    fn is_at_edge(&self, point: &Point) -> bool {
        let resolution = self.regions.tolerance();
        let Window { low, high } = *self.regions.window();
        (point - low).min() <= resolution || (high - point).min() <= resolution
    }

    /// The itinerary of the collision itself.
    fn itinerary_at(&self, parameters: [f64; 2]) -> Option<String> {
        let contact = self.plane.contact_at(parameters).ok()?;
        let (collision, _) = Engine::Auto.collide(contact).ok()?;
        Some(collision.itinerary())
    }

    /// The region beside `boundary`, or beside one that meets it, in which collisions have the
    /// switches of this one.
    fn decided(&self, boundary: usize, parameters: [f64; 2]) -> Option<usize> {
        let itinerary = self.itinerary_at(parameters)?;
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
