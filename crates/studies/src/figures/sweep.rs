//! Maps in memory.

use std::sync::Arc;

use stickslip_figure::pictures::grid;
use stickslip_figure::pictures::map::{MapPanel, Values};
use stickslip_model::{Engine, coulomb};
use stickslip_plane::sweep::{self, FailureCount};
use stickslip_plane::{Grid, Quantity, Tile};

use super::section::{Content, DataFile, Objection};

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
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        Self { grid, results: sweep::compute(&grid, Engine::Exact, 0..grid.points()) }
    }

    /// The restitution as a panel of a picture.
    #[must_use]
    pub fn restitution<'a>(&'a self, heading: &'a str) -> MapPanel<'a> {
        self.panel(heading, Values::Restitution(&self.results.eps_t))
    }

    /// The number of switches as a panel of a picture.
    #[must_use]
    pub fn switches<'a>(&'a self, heading: &'a str) -> MapPanel<'a> {
        self.panel(heading, Values::Switches(&self.results.switch_count))
    }

    fn panel<'a>(&'a self, heading: &'a str, values: Values<'a>) -> MapPanel<'a> {
        let size = (self.grid.columns.cells, self.grid.rows.cells);
        grid::panel(&self.grid, heading, size, values)
    }

    /// `quantity` at a point.
    #[must_use]
    pub fn value(&self, quantity: Quantity, point: usize) -> f64 {
        let (column, row) = self.grid.cell(point);
        self.grid.value(quantity, column, row)
    }

    /// The point with the largest `value`, and that.
    #[must_use]
    pub fn largest(&self, value: impl Fn(usize) -> f64) -> (usize, f64) {
        let values = (0..self.grid.points()).map(|point| (point, value(point)));
        values.fold((0, f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most })
    }

    /// By how much ε_t differs from that of pure Coulomb sliding.
    #[must_use]
    pub fn excess(&self, point: usize) -> f64 {
        let sliding = coulomb::restitution(self.value(Quantity::Psi, point), 1.0);
        self.results.eps_t[point] - sliding
    }

    /// The largest number of switches.
    #[must_use]
    pub fn most_switches(&self) -> i32 {
        self.results.switch_count.iter().copied().max().unwrap_or(0)
    }

    /// The file `name`.npz, and what speaks against it.
    pub(super) fn data(
        self: &Arc<Self>,
        name: &str,
        title: String,
    ) -> (DataFile, Option<Objection>) {
        let file = format!("{name}.npz");
        let mut count = FailureCount::default();
        count.add(0, &self.results);
        let failed = count.failed(&self.grid, Engine::Exact);
        let points = self.grid.points();
        let objection =
            failed.map(|failed| Objection::Points { file: file.clone(), points, failed });
        (DataFile { name: file, title, content: Content::Map(Arc::clone(self)) }, objection)
    }
}
