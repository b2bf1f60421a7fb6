//! The atlas itself.

use std::collections::BTreeMap;

use stickslip_tracer::Subdivision;

use super::boundary::Kind;
use super::frame::Frame;

/// A window divided by its boundaries into regions, which are labelled by itineraries.
pub type Regions = Subdivision<String, Kind>;

/// Every boundary in a window, and the regions between them.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// The window.
    pub frame: Frame,
    /// Accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// Boundaries, vertices and regions.
    pub regions: Regions,
    /// Itineraries of regions without a boundary, by index.
    pub unbounded: BTreeMap<usize, String>,
}

impl Atlas {
    /// The itinerary of a region: one character a phase, `+` and `-` for slip, `o` for stick.
    #[must_use]
    pub fn itinerary(&self, region: usize) -> &str {
        let own = self.regions.regions()[region].label.as_ref();
        own.or_else(|| self.unbounded.get(&region)).map_or("", String::as_str)
    }
}

/// The number of switches of an itinerary, which has a character for each phase.
#[must_use]
pub fn switch_count(itinerary: &str) -> usize {
    itinerary.len().saturating_sub(1)
}
