//! Slabs and strips become the arrays of a table.

use rayon::prelude::*;
use stickslip_model::{Collision, Contact};
use stickslip_plane::atlas::CollisionAtlas;
use stickslip_tracer::regions::Location;

use super::boundaries::Boundaries;
use super::chebyshev::{ACROSS, ALONG, coefficients, extrema, nodes, powers, rounded, value};
use super::settings::{TableSettings, TableWindow};
use super::slab::{Graph, Slab, Stack};
use super::stretch::Stretch;
use super::strip::{Demand, Gap, Refusal, Strip, restitution, within};
use super::table::{Arrays, NO_REGION};
use super::{TableError, TablePlace};

/// The relative error of graphs as a part of the bound: at a graze the slope of ε_t over ln y jumps
/// by less than the inverse.
const GRAPHS: f64 = 1.0 / 16.0;
/// The least relative error of graphs.
const FINEST_GRAPHS: f64 = 1e-13;
/// How many times as large as the errors at which strips are accepted the bound is.
const SAFETY: f64 = 2.0;

/// A slab with its strips, upwards, and the region of each.
struct Filled {
    slab: Slab,
    /// ε_n, unless it is one number.
    normal: Option<Graph>,
    strips: Vec<(Strip, u32)>,
    edge: Graph,
}

/// The arrays of a table. `begin` receives the number of intervals between walls, and `done` is
/// called for each of them.
///
/// # Errors
/// [`TableError`]: a collision cannot be computed, the bound is not reached, or there are too many
/// strips.
pub fn arrays(
    settings: &TableSettings,
    division: &CollisionAtlas,
    begin: impl Fn(usize),
    done: impl Fn() + Sync,
) -> Result<Arrays, TableError> {
    let boundaries = Boundaries::of(division);
    let slabs: Vec<Slab> =
        boundaries.walls.windows(2).flat_map(|walls| Slab::between([walls[0], walls[1]])).collect();
    begin(slabs.len());
    let bound = (GRAPHS * settings.bound).max(FINEST_GRAPHS);
    // The roundings of all coefficients of a strip or a graph add up to far less than the bound.
    let [x, y] = settings.window.sides();
    let graph_grid = places(bound * y.low / 100.0);
    let demand = Demand {
        plane: division.plane,
        bound: settings.bound / SAFETY,
        grid: places(settings.bound / 5000.0),
        graph_grid,
    };
    let has_normals = matches!(settings.window, TableWindow::Velocities { .. });
    let task = Task { division, demand, has_normals };
    let filled = slabs.into_par_iter().map(|slab| {
        let middle = f64::midpoint(slab.low, slab.high);
        let stack =
            Stack { bound, grid: graph_grid, ..Stack::at(&boundaries, &division.plane, middle) };
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
    arrays.walls.push(x.high);
    arrays.first_strips.push(index(arrays.strip_stretches.len())?);
    arrays.set_hints([x, y])?;
    Ok(arrays)
}

struct Task<'a> {
    division: &'a CollisionAtlas,
    demand: Demand,
    has_normals: bool,
}

impl Task<'_> {
    /// Adds the filled slabs of an interval in ascending order.
    fn fill(&self, slab: Slab, stack: &Stack, filled: &mut Vec<Filled>) -> Result<(), TableError> {
        if let Some(graphs) = stack.graphs(&slab) {
            match self.filled(slab, &graphs) {
                Ok(done) => {
                    filled.push(done);
                    return Ok(());
                }
                Err(Refusal::Failed(error)) => return Err(error),
                Err(Refusal::Wide { y, error }) if slab.is_narrow() => {
                    let place = TablePlace::of(&self.division.plane, [slab.x(0.5), y]);
                    return Err(TableError::Coarse { place, error });
                }
                Err(Refusal::Wide { .. }) => {}
            }
        }
        for half in slab.halves() {
            self.fill(half, stack, filled)?;
        }
        Ok(())
    }

    fn filled(&self, slab: Slab, graphs: &[Graph]) -> Result<Filled, Refusal> {
        let normal = if self.has_normals { Some(self.normal(&slab)?) } else { None };
        let strips = self.strips(&slab, graphs)?;
        Ok(Filled { slab, normal, strips, edge: graphs[graphs.len() - 1] })
    }

    /// ε_n over the stretched coordinate of a slab.
    fn normal(&self, slab: &Slab) -> Result<Graph, Refusal> {
        let y = self.division.plane.sheet().sides[1].low;
        let any = Contact::new(1.0, 1.0, 0.0).map_err(TableError::from)?;
        let mut collision = Collision::before(any);
        let mut eps_n = |along: f64| {
            let place = [slab.x(along), y];
            restitution(&self.division.plane, place, &mut collision).map(|[_, eps_n]| eps_n)
        };
        let mut values = [0.0; ALONG];
        for (value, along) in values.iter_mut().zip(nodes::<ALONG>()) {
            *value = eps_n(along)?;
        }
        let graph = powers(&coefficients(&values)).map(|c| rounded(c, self.demand.grid));
        for along in extrema(ALONG) {
            let error = (value(&graph, along) - eps_n(along)?).abs();
            if !within(error, self.demand.bound) {
                return Err(Refusal::Wide { y, error });
            }
        }
        Ok(graph)
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
            let y = f64::midpoint(value(low, along), value(high, along));
            let point = self.division.plane.point(slab.x(along), y);
            match self.division.regions.locate(&point) {
                Location::Region(region) => u32::try_from(region).ok(),
                _ => None,
            }
        });
        found.unwrap_or(NO_REGION)
    }
}

/// The places after the decimal point of numbers as fine as `unit`.
fn places(unit: f64) -> i32 {
    // Bounds and y are such that the logarithm is small.
    #[allow(clippy::cast_possible_truncation)]
    let places = -unit.log10().floor() as i32;
    places.max(0)
}

pub(super) fn index(count: usize) -> Result<u32, TableError> {
    let most = TableSettings::MOST_STRIPS;
    u32::try_from(count).map_err(|_| TableError::Many { most })
}

impl Arrays {
    fn push(&mut self, filled: &Filled, settings: &TableSettings) -> Result<(), TableError> {
        let Filled { slab, normal, strips, edge } = filled;
        if self.strip_stretches.len() + strips.len() > TableSettings::MOST_STRIPS {
            return Err(TableError::Many { most: TableSettings::MOST_STRIPS });
        }
        self.walls.push(slab.low);
        self.scales.push(1.0 / (slab.high - slab.low));
        self.slab_stretches.push(slab.stretch);
        self.normals.extend(normal.iter().flatten());
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
