//! Events that accumulate in the runs of a window, and how many of them count.

use crate::family::Family;
use crate::hybrid::Itinerary;
use crate::window::{Point, Window};

/// Where runs in a window have so many events that they accumulate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Accumulation {
    /// The events up to which runs should be told apart.
    pub events: usize,
    /// The number of runs on a lattice in which events accumulate.
    pub runs: usize,
    /// The number of runs on the lattice.
    pub of: usize,
}

impl Accumulation {
    /// The events up to which runs are followed: the greatest number of switches of a family that
    /// is looked at.
    pub const EVENTS: usize = 200;

    /// Whether events accumulate in runs of the window; `None` if this is seen nowhere.
    ///
    /// Where events accumulate there are boundaries without end, and a run may have more events
    /// than can be waited for. Runs on a lattice are followed up to [`Self::EVENTS`] events. Nine
    /// tenths of those that end have no more than the result, which is from 4 to 12.
    pub fn seen(family: &impl Family<Label = Itinerary>, window: &Window) -> Option<Self> {
        const CELLS: usize = 16;
        const MOST: usize = 12;
        const LEAST: usize = 4;
        let cell = window.extent() / CELLS as f64;
        let place = |index: usize| {
            let part = Point::new((index / CELLS) as f64 + 0.5, (index % CELLS) as f64 + 0.5);
            window.low + cell.component_mul(&part)
        };
        let labels = (0..CELLS * CELLS).filter_map(|index| family.label(&place(index)).ok());
        let (mut runs, mut counts) = (0, Vec::new());
        for label in labels {
            match label {
                Itinerary::Fires(events) => counts.push(events.len()),
                Itinerary::Begins(_) | Itinerary::Accumulates => runs += 1,
                Itinerary::Unfinished | Itinerary::Fails | Itinerary::NoStart(_) => {}
            }
        }
        counts.sort_unstable();
        let most = counts.get(counts.len() * 9 / 10).map_or(LEAST, |&most| most);
        let events = most.clamp(LEAST, MOST);
        (runs > 0).then_some(Self { events, runs, of: CELLS * CELLS })
    }

    /// The one of two that counts more events, for windows whose atlases are compared.
    #[must_use]
    pub fn or_more(self, other: Option<Self>) -> Self {
        other.filter(|other| other.events > self.events).unwrap_or(self)
    }
}
