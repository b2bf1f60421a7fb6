//! A table: its arrays, and how it is looked up.

use stickslip_plane::Range;

use super::chebyshev::{double_value, value};
use super::keys::Keys;
use super::settings::TableWindow;
use super::stretch::Stretch;

/// No region.
pub const NO_REGION: u32 = u32::MAX;

/// ε_t and ε_n over a window.
///
/// The first axis x is κ, or the normal velocity g_n in m/s; the second axis y is ψ, or the
/// tangential velocity g_t in m/s.
///
/// A look-up finds the slab of x, then the strip between two graphs, and evaluates the polynomial
/// of the strip. It uses sums, products, quotients and square roots only. The C header
/// does the same in the same order and has the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct RestitutionTable {
    /// The window.
    pub window: TableWindow,
    /// ε_n of a table over (κ, ψ), which is one number at one damping.
    pub constant_eps_n: Option<f64>,
    /// The bound of the errors of ε_t and ε_n.
    pub bound: f64,
    /// What the verification found.
    pub verification: TableVerification,
    /// The itineraries of the atlas' regions, by their numbers; empty unless the settings include
    /// regions.
    pub regions: Vec<String>,
    /// The intervals of x and y: the window.
    pub(super) sides: [Range; 2],
    /// The arrays that are looked up.
    pub(super) arrays: Arrays,
}

/// What the comparison of a table with collisions found.
///
/// The table was made from other points. These are random in each strip, and on both sides of each
/// boundary, at distances in y from 1e-15 to 0.1 of its strip.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableVerification {
    /// The number of points.
    pub points: u64,
    /// The largest error of ε_t.
    pub largest_error: f64,
    /// x at the largest error of ε_t: κ, or g_n in m/s.
    pub x: f64,
    /// y at the largest error of ε_t: ψ, or g_t in m/s.
    pub y: f64,
    /// The largest error of ε_n.
    pub largest_error_of_eps_n: f64,
}

impl TableVerification {
    /// No comparison.
    pub(super) const NONE: Self =
        Self { points: 0, largest_error: 0.0, x: 0.0, y: 0.0, largest_error_of_eps_n: 0.0 };
}

/// The arrays of a [`RestitutionTable`], as its files have them.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arrays {
    /// How slabs are found.
    pub slab_keys: Keys,
    /// The slab of the least x with each key.
    pub slab_hints: Vec<u32>,
    /// How strips are found.
    pub strip_keys: Keys,
    /// For each slab and key of y, the number of strips of the slab that are surely below.
    pub strip_hints: Vec<u16>,
    /// The x between which slabs lie, ascending; one more than slabs.
    pub walls: Vec<f64>,
    /// 1/(width in x) of each slab.
    pub scales: Vec<f64>,
    /// How x is stretched in each slab.
    pub slab_stretches: Vec<Stretch>,
    /// Eight coefficients of ε_n in each slab, over the stretched x; empty where ε_n is one number.
    pub normals: Vec<f64>,
    /// The first strip of each slab, and the number of strips at the end. The last strip of a slab
    /// is only the upper edge of the window, for the one below it.
    pub first_strips: Vec<u32>,
    /// Eight coefficients of y on the lower side of each strip, over the stretched x.
    pub graphs: Vec<f64>,
    /// How y is stretched in each strip.
    pub strip_stretches: Vec<Stretch>,
    /// The region of each strip, [`NO_REGION`] if it has none; empty unless the settings include
    /// regions.
    pub regions: Vec<u32>,
    /// The first row of each strip. A strip has up to eight rows, and ends where the next one
    /// begins.
    pub first_rows: Vec<u32>,
    /// Rows of twelve coefficients of ε_t, for the powers of the stretched x. Coefficients are for
    /// powers of the stretched y.
    pub rows: Vec<f64>,
}

/// Where a point is in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TablePlace {
    strip: usize,
    /// The stretched coordinates in the strip.
    along: f64,
    across: f64,
}

impl RestitutionTable {
    /// ε_t at x and y; not a number outside the table, or if x or y is not a number.
    pub fn eps_t(&self, x: f64, y: f64) -> f64 {
        self.place(x, y).map_or(f64::NAN, |place| self.arrays.value(place))
    }

    /// ε_n at x; not a number outside the table, or if x is not a number.
    pub fn eps_n(&self, x: f64) -> f64 {
        match self.constant_eps_n {
            _ if !is_inside(x, self.sides[0]) => f64::NAN,
            Some(constant) => constant,
            None => self.arrays.normal(x),
        }
    }

    /// The number of the region at x and y, an index of [`Self::regions`]. `None` outside the
    /// table, in a strip too thin to have a region, or if the settings do not include regions.
    pub fn region(&self, x: f64, y: f64) -> Option<usize> {
        let strip = self.place(x, y)?.strip;
        let region = *self.arrays.regions.get(strip)?;
        (region != NO_REGION).then_some(region as usize)
    }

    /// The arrays that are looked up.
    pub fn arrays(&self) -> &Arrays {
        &self.arrays
    }

    /// The number of slabs and of strips.
    pub fn pieces(&self) -> [usize; 2] {
        let slabs = self.arrays.scales.len();
        // Each slab has an edge.
        [slabs, self.arrays.strip_stretches.len() - slabs]
    }

    /// The size of the arrays in bytes.
    pub fn bytes(&self) -> usize {
        self.arrays.bytes()
    }

    #[inline(always)]
    fn place(&self, x: f64, y: f64) -> Option<TablePlace> {
        let inside = is_inside(x, self.sides[0]) && is_inside(y, self.sides[1]);
        inside.then(|| self.arrays.place(x, y))
    }
}

/// Whether a value is in an interval.
#[inline(always)]
fn is_inside(value: f64, Range { low, high }: Range) -> bool {
    value >= low && value <= high
}

impl Arrays {
    /// The slab of an x of the window, and the stretched coordinate in it.
    #[inline(always)]
    fn slab(&self, x: f64) -> (usize, f64) {
        let last = self.scales.len() - 1;
        let mut slab = self.slab_hints[self.slab_keys.of(x)] as usize;
        while slab < last && self.walls[slab + 1] <= x {
            slab += 1;
        }
        let part = ((x - self.walls[slab]) * self.scales[slab]).min(1.0);
        (slab, self.slab_stretches[slab].of(part))
    }

    /// ε_n at an x of the window.
    fn normal(&self, x: f64) -> f64 {
        let (slab, along) = self.slab(x);
        let (normals, _) = self.normals.as_chunks();
        value(&normals[slab], along)
    }

    /// The place of a point of the window.
    #[inline(always)]
    fn place(&self, x: f64, y: f64) -> TablePlace {
        let (slab, along) = self.slab(x);
        let [first, end] = [slab, slab + 1].map(|slab| self.first_strips[slab] as usize);
        let row = slab * self.strip_keys.count;
        let mut strip = first + usize::from(self.strip_hints[row + self.strip_keys.of(y)]);
        let mut low = self.side(strip, along);
        let mut high = self.side(strip + 1, along);
        while strip + 2 < end && high <= y {
            strip += 1;
            low = high;
            high = self.side(strip + 1, along);
        }
        let part = (y - low) / (high - low);
        // Also where a strip has no width and the quotient is not a number.
        let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
        TablePlace { strip, along, across: self.strip_stretches[strip].of(part) }
    }

    /// y on the lower side of a strip.
    #[inline(always)]
    fn side(&self, strip: usize, along: f64) -> f64 {
        let (graphs, _) = self.graphs.as_chunks();
        value(&graphs[strip], along)
    }

    /// The value at a place.
    #[inline(always)]
    fn value(&self, TablePlace { strip, along, across }: TablePlace) -> f64 {
        let [first, end] = [strip, strip + 1].map(|strip| self.first_rows[strip] as usize);
        let (rows, _) = self.rows.as_chunks();
        double_value(&rows[first..end], along, across)
    }

    /// The size of the arrays in bytes.
    fn bytes(&self) -> usize {
        let doubles = [&self.walls, &self.scales, &self.normals, &self.graphs];
        let doubles = doubles.map(Vec::len).iter().sum::<usize>() + self.rows.len();
        let fours = [&self.slab_hints, &self.first_strips, &self.regions, &self.first_rows];
        let ones = self.slab_stretches.len() + self.strip_stretches.len();
        let twos = 2 * self.strip_hints.len();
        8 * doubles + 4 * fours.map(Vec::len).iter().sum::<usize>() + twos + ones
    }
}
