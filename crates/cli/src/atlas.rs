//! An atlas: all boundaries of a window on which the switches of a collision change, and the
//! regions between them.
//!
//! Start reading here; then, in this order: `frame` (the window and its coordinates), `boundary`
//! (what the tracer's curves mean), `trace` and `verification` (how an atlas is made), `document`
//! and `file` (how it is stored), `locate` (how it is looked up), `crossings` (its boundaries at
//! one stiffness), `polyline`, `picture` and `geojson` (how it is drawn, here and elsewhere).

mod boundary;
mod crossings;
mod document;
mod file;
mod frame;
mod geojson;
pub mod locate;
mod picture;
mod polyline;
pub mod trace;
mod verification;

use std::collections::BTreeMap;

use stickslip_tracer::Subdivision;

pub use boundary::Kind;
pub use frame::{Frame, Ratio, scaled};
pub use picture::{boundaries, draw};
pub use trace::{Made, make};

/// The window parted by its boundaries; labels are itineraries.
pub type Map = Subdivision<String, Kind>;

/// An atlas in memory.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// The window.
    pub frame: Frame,
    /// Accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// Its parts.
    pub map: Map,
    /// Itineraries of regions without a boundary, by index.
    pub unbounded: BTreeMap<usize, String>,
}

impl Atlas {
    /// The itinerary of a region.
    pub fn itinerary(&self, region: usize) -> &str {
        let own = self.map.regions()[region].label.as_ref();
        own.or_else(|| self.unbounded.get(&region)).map_or("", String::as_str)
    }
}

/// The number of switches of an itinerary, which has a character for each phase.
pub fn switch_count(itinerary: &str) -> usize {
    itinerary.len().saturating_sub(1)
}
