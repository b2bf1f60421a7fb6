//! Maps in memory.

use stickslip_figure::pictures::grid;
use stickslip_figure::pictures::map::{MapPanel, MapValues};
use stickslip_model::Engine;
use stickslip_model::limits::coulomb;
use stickslip_plane::{Grid, Quantity, Tile, sweep};

/// A grid with its collisions, by the exact solution.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The grid.
    pub grid: Grid,
    /// All results.
    pub results: Tile,
}

impl Sweep {
    /// Computes the collisions of `grid`.
    pub fn new(grid: Grid) -> Self {
        Self { grid, results: sweep::compute(&grid, Engine::Exact, 0..grid.points()) }
    }

    /// The restitution as a panel of a picture.
    pub fn restitution<'a>(&'a self, heading: &'a str) -> MapPanel<'a> {
        self.panel(heading, MapValues::Restitution(&self.results.eps_t))
    }

    /// The number of switches as a panel of a picture.
    pub fn switches<'a>(&'a self, heading: &'a str) -> MapPanel<'a> {
        self.panel(heading, MapValues::Switches(&self.results.switch_count))
    }

    fn panel<'a>(&'a self, heading: &'a str, values: MapValues<'a>) -> MapPanel<'a> {
        let size = (self.grid.columns.cells, self.grid.rows.cells);
        grid::panel(&self.grid, heading, size, values)
    }

    /// `quantity` at a point.
    pub fn value(&self, quantity: Quantity, point: usize) -> f64 {
        let (column, row) = self.grid.cell(point);
        self.grid.value(quantity, column, row)
    }

    /// The point where `value` is largest, and the value there.
    pub fn largest(&self, value: impl Fn(usize) -> f64) -> (usize, f64) {
        let values = (0..self.grid.points()).map(|point| (point, value(point)));
        values.fold((0, f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most })
    }

    /// ε_t minus that of pure Coulomb sliding.
    pub fn above_sliding(&self, point: usize) -> f64 {
        let sliding = coulomb::restitution(self.value(Quantity::Psi, point), 1.0);
        self.results.eps_t[point] - sliding
    }

    /// The largest number of switches.
    pub fn most_switches(&self) -> i32 {
        self.results.switch_count.iter().copied().max().unwrap_or(0)
    }
}
