//! Hints: roughly in which slab and in which strip a point is.

use std::f64::consts::PI;

use stickslip_plane::Range;

use super::TableError;
use super::assembly::index;
use super::chebyshev::value;
use super::keys::Keys;
use super::settings::TableSettings;
use super::slab::Graph;
use super::table::Arrays;

/// Most keys of x, and of y in each slab.
const MOST_KEYS: [u64; 2] = [2048, 256];

impl Arrays {
    /// Sets keys and hints for a window.
    ///
    /// # Errors
    /// [`TableError::Many`]: there are too many strips.
    pub(super) fn set_hints(&mut self, [x, y]: [Range; 2]) -> Result<(), TableError> {
        self.set_keys([x, y]);
        self.fill_hints()
    }

    fn set_keys(&mut self, [x, y]: [Range; 2]) {
        self.slab_keys = Keys::new(x.low, x.high, MOST_KEYS[0]);
        self.strip_keys = Keys::new(y.low, y.high, MOST_KEYS[1]);
    }

    /// Sets keys and hints as [`Self::set_hints`] does, but keeps the length of the keys unless
    /// they are too many: old tables have half as many keys of y.
    pub(super) fn restore_hints(&mut self, [x, y]: [Range; 2]) -> Result<(), TableError> {
        let shift = self.strip_keys.shift;
        self.set_keys([x, y]);
        let shift = shift.clamp(self.strip_keys.shift, u64::BITS - 1);
        self.strip_keys = Keys::with_shift(shift, y.low, y.high);
        self.fill_hints()
    }

    fn fill_hints(&mut self) -> Result<(), TableError> {
        (self.slab_hints, self.strip_hints) = (Vec::new(), Vec::new());
        let inner = &self.walls[1..self.scales.len()];
        for least in self.slab_keys.least() {
            self.slab_hints.push(index(inner.partition_point(|&wall| wall <= least))?);
        }
        let (graphs, _) = self.graphs.as_chunks();
        for slab in self.first_strips.windows(2) {
            // The upper edge of the window is not a strip.
            let sides = &graphs[slab[0] as usize + 1..slab[1] as usize - 1];
            let bounds: Vec<f64> = sides.iter().map(upper_bound).collect();
            let mut below = 0;
            for least in self.strip_keys.least() {
                while below < bounds.len() && bounds[below] <= least {
                    below += 1;
                }
                let many = TableError::Many { most: TableSettings::MOST_STRIPS };
                self.strip_hints.push(u16::try_from(below).map_err(|_| many)?);
            }
        }
        Ok(())
    }
}

/// An upper bound of a graph. A polynomial of degree 7 exceeds its values at 128 places as dense as
/// the extrema of T₁₂₇ by less than a part 1/200 of their range.
fn upper_bound(graph: &Graph) -> f64 {
    const PLACES: u32 = 127;
    let at = |k: u32| {
        let angle = PI * f64::from(k) / f64::from(PLACES);
        value(graph, 0.5 - 0.5 * angle.cos())
    };
    let values = (0..=PLACES).map(at);
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    high + (high - low) / 200.0 + 1e-15 * high
}
