//! Maps in memory.

use stickslip_model::coulomb;

use super::bench::Bench;
use super::section::DataFile;
use crate::engine::Engine;
use crate::error::Failure;
use crate::figure::map::{Map, Values};
use crate::map::{self, Plane, Quantity, Tile};

/// A plane with its collisions, by the exact solution.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The plane.
    pub plane: Plane,
    /// All results.
    pub results: Tile,
}

impl Sweep {
    /// Computes the collisions of `plane`.
    pub fn new(bench: &Bench, plane: Plane) -> Self {
        let points = 0..plane.points();
        let results = bench.pool.install(|| map::compute(&plane, &Engine::Exact, points));
        Self { plane, results }
    }

    /// The restitution as a panel of a picture.
    pub fn restitution<'a>(&'a self, heading: &'a str) -> Map<'a> {
        self.panel(heading, Values::Restitution(&self.results.eps_t))
    }

    /// The number of switches as a panel of a picture.
    pub fn switches<'a>(&'a self, heading: &'a str) -> Map<'a> {
        self.panel(heading, Values::Switches(&self.results.switch_count))
    }

    fn panel<'a>(&'a self, heading: &'a str, values: Values<'a>) -> Map<'a> {
        let size = (self.plane.columns.cells, self.plane.rows.cells);
        map::picture::panel(&self.plane, heading, size, values)
    }

    /// `quantity` at a point.
    pub fn value(&self, quantity: Quantity, point: usize) -> f64 {
        let (column, row) = self.plane.cell(point);
        self.plane.value(quantity, column, row)
    }

    /// The point with the largest `value`, and that.
    pub fn largest(&self, value: impl Fn(usize) -> f64) -> (usize, f64) {
        let values = (0..self.plane.points()).map(|point| (point, value(point)));
        values.fold((0, f64::NEG_INFINITY), |most, next| if next.1 > most.1 { next } else { most })
    }

    /// By how much ε_t differs from that of pure Coulomb sliding.
    pub fn excess(&self, point: usize) -> f64 {
        let sliding = coulomb::restitution(self.value(Quantity::Psi, point), 1.0);
        self.results.eps_t[point] - sliding
    }

    /// The largest number of switches.
    pub fn most_switches(&self) -> i32 {
        self.results.switch_count.iter().copied().max().unwrap_or(0)
    }

    /// The file `name`.npz, and what speaks against it.
    ///
    /// # Errors
    /// It does not fit into memory.
    pub fn data(
        &self,
        bench: &Bench,
        name: &str,
        title: String,
    ) -> Result<(DataFile, Option<Failure>), Failure> {
        let name = format!("{name}.npz");
        let path = bench.out.join(&name);
        let failed = |error| Failure::output(&path, error);
        let mut bytes = Vec::new();
        map::npz::write(&mut bytes, &self.plane, &self.results).map_err(failed)?;
        let objection = map::outcome(&self.plane, &Engine::Exact, &path, &self.results);
        Ok((DataFile { name, title, bytes }, objection.map_err(failed)?))
    }
}
