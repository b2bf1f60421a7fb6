//! Hints: roughly in which slab and in which strip a point is.

use std::f64::consts::PI;

use stickslip_plane::Range;

use super::TableError;
use super::assembly::index;
use super::chebyshev::value;
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

/// The first bits of numbers above 0, which give their size roughly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// How many bits are left out.
    pub shift: u32,
    /// The first bits of the least number.
    pub first: u64,
    /// The number of keys.
    pub count: usize,
}

impl Keys {
    /// At most `most` keys of the numbers from `low` to `high`.
    pub(super) fn new(low: f64, high: f64, most: u64) -> Self {
        let [first, last] = [low, high].map(f64::to_bits);
        let is_short = |&shift: &u32| (last >> shift) - (first >> shift) < most;
        Self::with_shift((0..u64::BITS).find(is_short).unwrap_or(0), low, high)
    }

    /// The keys that leave out `shift` bits.
    pub(super) fn with_shift(shift: u32, low: f64, high: f64) -> Self {
        let [first, last] = [low, high].map(|end| end.to_bits() >> shift);
        // There are few.
        #[allow(clippy::cast_possible_truncation)]
        Self { shift, first, count: (last - first + 1) as usize }
    }

    /// The key of a number.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)]
    pub(super) fn of(self, value: f64) -> usize {
        ((value.to_bits() >> self.shift) - self.first) as usize
    }

    /// The least number of each key.
    pub(super) fn least(self) -> impl Iterator<Item = f64> {
        (self.first..).take(self.count).map(move |key| f64::from_bits(key << self.shift))
    }
}
