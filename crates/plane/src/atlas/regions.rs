//! The atlas itself: a window, its boundaries, and the regions between them.

use std::collections::BTreeMap;

use stickslip_tracer::Subdivision;

use super::boundary::BoundaryKind;
use super::frame::Frame;
use crate::chart::Chart;

/// A window divided by its boundaries into regions, which are labelled by itineraries.
pub type Regions = Subdivision<String, BoundaryKind>;

/// Every boundary in a window, and the regions between them.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// The window.
    pub frame: Frame,
    /// The traced coordinates, in which the boundaries are cubics.
    pub chart: Chart,
    /// Accuracy of the boundaries in ψ.
    pub tolerance: f64,
    /// Boundaries, vertices and regions.
    pub regions: Regions,
    /// Itineraries of the regions that no boundary touches, by the index of the region.
    pub unbounded: BTreeMap<usize, String>,
}

impl Atlas {
    /// The itinerary of a region: one character per phase, `+` and `-` for slip, `o` for stick.
    ///
    /// # Panics
    /// If there is no region with this index.
    #[must_use]
    pub fn itinerary(&self, region: usize) -> &str {
        itinerary_in(&self.regions, &self.unbounded, region)
    }
}

/// The itinerary of a region, with those of the regions that no boundary touches.
pub(super) fn itinerary_in<'a>(
    regions: &'a Regions,
    unbounded: &'a BTreeMap<usize, String>,
    region: usize,
) -> &'a str {
    let own = regions.regions()[region].label.as_ref();
    own.or_else(|| unbounded.get(&region)).map_or("", String::as_str)
}

/// The number of switches of an itinerary, which has one character per phase.
///
/// ```
/// assert_eq!(stickslip_plane::atlas::switch_count("+o-"), 2);
/// ```
#[must_use]
pub fn switch_count(itinerary: &str) -> usize {
    itinerary.len().saturating_sub(1)
}
