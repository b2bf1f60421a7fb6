//! A table: its arrays, and how it is looked up.

use super::chebyshev::{double_value, value};
use super::hints::Keys;
use super::stretch::Stretch;
use super::verification::Verification;

/// No region.
pub const NO_REGION: u32 = u32::MAX;

/// ε_t over (κ, ψ), and ε_n, at one damping.
///
/// A look-up finds the slab of κ, then the strip between two graphs, and evaluates the polynomial
/// of the strip. It uses sums, products, quotients and square roots only. The C header
/// does the same in the same order and has the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Scaled damping.
    pub damping: f64,
    /// ε_n, which is one number at one damping.
    pub eps_n: f64,
    /// The bound of the error of ε_t.
    pub bound: f64,
    /// The ends of κ.
    pub kappa: [f64; 2],
    /// The ends of ψ.
    pub psi: [f64; 2],
    /// What the verification found.
    pub verification: Verification,
    /// The itineraries of the atlas' regions, by their numbers; empty unless they were asked for.
    pub regions: Vec<String>,
    /// The arrays that are looked up.
    pub(super) arrays: Arrays,
}

/// The arrays of a [`Table`], as its files have them.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Arrays {
    /// How slabs are found.
    pub slab_keys: Keys,
    /// The slab of the least κ with each key.
    pub slab_hints: Vec<u32>,
    /// How strips are found.
    pub strip_keys: Keys,
    /// For each slab and key of ψ, the number of strips of the slab that are surely below.
    pub strip_hints: Vec<u16>,
    /// The κ between which slabs lie, ascending; one more than slabs.
    pub walls: Vec<f64>,
    /// 1/(width in κ) of each slab.
    pub scales: Vec<f64>,
    /// How κ is stretched in each slab.
    pub slab_stretches: Vec<Stretch>,
    /// The first strip of each slab, and the number of strips at the end. The last strip of a slab
    /// is only the upper edge of the window, for the one below it.
    pub first_strips: Vec<u32>,
    /// Eight coefficients of ψ on the lower side of each strip, over the stretched κ.
    pub graphs: Vec<f64>,
    /// How ψ is stretched in each strip.
    pub strip_stretches: Vec<Stretch>,
    /// The region of each strip, [`NO_REGION`] if it has none; empty unless regions were asked for.
    pub regions: Vec<u32>,
    /// The first row of each strip, of which it has up to eight; its end is where that of the next
    /// strip is.
    pub first_rows: Vec<u32>,
    /// Rows of twelve coefficients of ε_t, for the powers of the stretched κ. Coefficients are for
    /// powers of the stretched ψ.
    pub rows: Vec<f64>,
}

/// Where a point is in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    strip: usize,
    /// The stretched coordinates in the strip.
    along: f64,
    across: f64,
}

impl Table {
    /// ε_t at κ and ψ; not a number outside the table, or if κ or ψ is not a number.
    #[must_use]
    pub fn eps_t(&self, kappa: f64, psi: f64) -> f64 {
        self.place(kappa, psi).map_or(f64::NAN, |place| self.arrays.value(place))
    }

    /// The number of the region at κ and ψ, an index of [`Self::regions`]. `None` outside the table,
    /// in a strip too thin to have one, or if regions were not asked for.
    #[must_use]
    pub fn region(&self, kappa: f64, psi: f64) -> Option<usize> {
        let strip = self.place(kappa, psi)?.strip;
        let region = *self.arrays.regions.get(strip)?;
        (region != NO_REGION).then_some(region as usize)
    }

    /// The arrays that are looked up.
    #[must_use]
    pub fn arrays(&self) -> &Arrays {
        &self.arrays
    }

    /// The number of slabs and of strips.
    #[must_use]
    pub fn pieces(&self) -> [usize; 2] {
        let slabs = self.arrays.scales.len();
        // Each slab has an edge.
        [slabs, self.arrays.strip_stretches.len() - slabs]
    }

    /// The size of the arrays in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.arrays.bytes()
    }

    #[inline(always)]
    fn place(&self, kappa: f64, psi: f64) -> Option<Place> {
        let inside = kappa >= self.kappa[0]
            && kappa <= self.kappa[1]
            && psi >= self.psi[0]
            && psi <= self.psi[1];
        inside.then(|| self.arrays.place(kappa, psi))
    }
}

impl Arrays {
    /// The place of a point of the window.
    #[inline(always)]
    fn place(&self, kappa: f64, psi: f64) -> Place {
        let last = self.scales.len() - 1;
        let mut slab = self.slab_hints[self.slab_keys.of(kappa)] as usize;
        while slab < last && self.walls[slab + 1] <= kappa {
            slab += 1;
        }
        let part = ((kappa - self.walls[slab]) * self.scales[slab]).min(1.0);
        let along = self.slab_stretches[slab].of(part);
        let [first, end] = [slab, slab + 1].map(|slab| self.first_strips[slab] as usize);
        let row = slab * self.strip_keys.count;
        let mut strip = first + usize::from(self.strip_hints[row + self.strip_keys.of(psi)]);
        let mut low = self.side(strip, along);
        let mut high = self.side(strip + 1, along);
        while strip + 2 < end && high <= psi {
            strip += 1;
            low = high;
            high = self.side(strip + 1, along);
        }
        let part = (psi - low) / (high - low);
        // Also where a strip has no width and the quotient is not a number.
        let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
        Place { strip, along, across: self.strip_stretches[strip].of(part) }
    }

    /// ψ on the lower side of a strip.
    #[inline(always)]
    fn side(&self, strip: usize, along: f64) -> f64 {
        let (graphs, _) = self.graphs.as_chunks();
        value(&graphs[strip], along)
    }

    /// The value at a place.
    #[inline(always)]
    fn value(&self, Place { strip, along, across }: Place) -> f64 {
        let [first, end] = [strip, strip + 1].map(|strip| self.first_rows[strip] as usize);
        let (rows, _) = self.rows.as_chunks();
        double_value(&rows[first..end], along, across)
    }

    /// The size of the arrays in bytes.
    fn bytes(&self) -> usize {
        let doubles = [&self.walls, &self.scales, &self.graphs];
        let doubles = doubles.map(Vec::len).iter().sum::<usize>() + self.rows.len();
        let fours = [&self.slab_hints, &self.first_strips, &self.regions, &self.first_rows];
        let ones = self.slab_stretches.len() + self.strip_stretches.len();
        let twos = 2 * self.strip_hints.len();
        8 * doubles + 4 * fours.map(Vec::len).iter().sum::<usize>() + twos + ones
    }
}
