//! Slabs and strips become the arrays of a table.

use rayon::prelude::*;
use stickslip_plane::atlas::Atlas;
use stickslip_tracer::Location;

use super::TableError;
use super::boundaries::Boundaries;
use super::chebyshev::{ACROSS, value};
use super::settings::Settings;
use super::slab::{Graph, Slab, Stack};
use super::stretch::Stretch;
use super::strip::{Demand, Gap, Refusal, Strip};
use super::table::{Arrays, NO_REGION};

/// The relative error of graphs as a part of the bound: at a graze the slope of ε_t over ln ψ jumps
/// by less than the inverse.
const GRAPHS: f64 = 1.0 / 16.0;
/// The least relative error of graphs.
const FINEST_GRAPHS: f64 = 1e-13;
/// How many times as large as the errors at which strips are accepted the bound is.
const SAFETY: f64 = 2.0;

/// A slab with its strips, upwards, and the region of each.
struct Filled {
    slab: Slab,
    strips: Vec<(Strip, u32)>,
    edge: Graph,
}

/// The arrays of a table. `done` is called for each interval between two walls, whose number
/// `begin` is told.
///
/// # Errors
/// [`TableError`]: a collision cannot be computed, the bound is not reached, or there are too many
/// strips.
pub fn arrays(
    settings: &Settings,
    atlas: &Atlas,
    begin: impl Fn(usize),
    done: impl Fn() + Sync,
) -> Result<Arrays, TableError> {
    let boundaries = Boundaries::of(atlas);
    let slabs: Vec<Slab> =
        boundaries.walls.windows(2).flat_map(|walls| Slab::between([walls[0], walls[1]])).collect();
    begin(slabs.len());
    let bound = (GRAPHS * settings.bound).max(FINEST_GRAPHS);
    // The roundings of all coefficients of a strip or a graph add up to far less than the bound.
    let graph_grid = places(bound * settings.psi.low / 100.0);
    let demand = Demand {
        damping: settings.damping,
        bound: settings.bound / SAFETY,
        grid: places(settings.bound / 5000.0),
        graph_grid,
    };
    let task = Task { atlas, demand };
    let filled = slabs.into_par_iter().map(|slab| {
        let middle = f64::midpoint(slab.low, slab.high);
        let stack =
            Stack { bound, grid: graph_grid, ..Stack::at(&boundaries, middle, settings.psi) };
        let mut filled = Vec::new();
        let result = task.fill(slab, &stack, &mut filled);
        done();
        result.map(|()| filled)
    });
    // The first failure is the same for any number of threads.
    let filled: Vec<Result<Vec<Filled>, TableError>> = filled.collect();
    let mut arrays = Arrays::default();
    for filled in filled {
        for slab in filled? {
            arrays.push(&slab, settings)?;
        }
    }
    arrays.walls.push(settings.kappa.high);
    arrays.first_strips.push(index(arrays.strip_stretches.len())?);
    arrays.set_hints(settings.kappa, settings.psi)?;
    Ok(arrays)
}

struct Task<'a> {
    atlas: &'a Atlas,
    demand: Demand,
}

impl Task<'_> {
    /// Adds the filled slabs of an interval in ascending order.
    fn fill(&self, slab: Slab, stack: &Stack, filled: &mut Vec<Filled>) -> Result<(), TableError> {
        if let Some(graphs) = stack.graphs(&slab) {
            match self.strips(&slab, &graphs) {
                Ok(strips) => {
                    filled.push(Filled { slab, strips, edge: graphs[graphs.len() - 1] });
                    return Ok(());
                }
                Err(Refusal::Failed(error)) => return Err(error),
                Err(Refusal::Wide { psi, error }) if slab.is_narrow() => {
                    return Err(TableError::Coarse { kappa: slab.kappa(0.5), psi, error });
                }
                Err(Refusal::Wide { .. }) => {}
            }
        }
        for half in slab.halves() {
            self.fill(half, stack, filled)?;
        }
        Ok(())
    }

    fn strips(&self, slab: &Slab, graphs: &[Graph]) -> Result<Vec<(Strip, u32)>, Refusal> {
        let mut all = Vec::new();
        for pair in graphs.windows(2) {
            let gap = Gap { slab, low: &pair[0], high: &pair[1], demand: self.demand };
            let strips = gap.strips()?;
            let region = self.region(slab, &pair[0], &pair[1]);
            all.extend(strips.into_iter().map(|strip| (strip, region)));
        }
        Ok(all)
    }

    /// The number of the region between two graphs.
    fn region(&self, slab: &Slab, low: &Graph, high: &Graph) -> u32 {
        // Where the gap begins as a wedge it is too thin.
        let found = [0.5, 0.75, 0.25, 0.95, 0.05].into_iter().find_map(|along| {
            let psi = f64::midpoint(value(low, along), value(high, along));
            let point = self.atlas.chart.point(slab.kappa(along), psi);
            match self.atlas.regions.locate(&point) {
                Location::Region(region) => u32::try_from(region).ok(),
                _ => None,
            }
        });
        found.unwrap_or(NO_REGION)
    }
}

/// The places after the decimal point of numbers as fine as `unit`.
fn places(unit: f64) -> i32 {
    // Bounds and ψ are such that the logarithm is small.
    #[allow(clippy::cast_possible_truncation)]
    let places = -unit.log10().floor() as i32;
    places.max(0)
}

pub(super) fn index(count: usize) -> Result<u32, TableError> {
    let most = Settings::MOST_STRIPS;
    u32::try_from(count).map_err(|_| TableError::Many { most })
}

impl Arrays {
    fn push(&mut self, filled: &Filled, settings: &Settings) -> Result<(), TableError> {
        let Filled { slab, strips, edge } = filled;
        if self.strip_stretches.len() + strips.len() > Settings::MOST_STRIPS {
            return Err(TableError::Many { most: Settings::MOST_STRIPS });
        }
        self.walls.push(slab.low);
        self.scales.push(1.0 / (slab.high - slab.low));
        self.slab_stretches.push(slab.stretch);
        self.first_strips.push(index(self.strip_stretches.len())?);
        for (strip, region) in strips {
            self.push_graph(&strip.low, strip.stretch)?;
            self.rows.extend(strip.rows.iter().flatten());
            if settings.regions {
                self.regions.push(*region);
            }
        }
        self.push_graph(edge, Stretch::None)?;
        if settings.regions {
            self.regions.push(NO_REGION);
        }
        Ok(())
    }

    fn push_graph(&mut self, graph: &Graph, stretch: Stretch) -> Result<(), TableError> {
        self.graphs.extend(graph);
        self.strip_stretches.push(stretch);
        self.first_rows.push(index(self.rows.len() / ACROSS)?);
        Ok(())
    }
}
