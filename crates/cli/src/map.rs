//! A map of collisions: computed tile by tile, kept tile by tile, and put together at the end.
//!
//! Start reading here; then, in this order: `plane` (which collision belongs to which cell),
//! `tile`, `tiles` and `results` (what is kept, and where), `npz` and `csv` (the finished map),
//! `thumbnail` and `picture` (some of it, drawn).

mod csv;
pub mod npz;
pub mod picture;
mod plane;
mod results;
mod thumbnail;
mod tile;
mod tiles;

use std::fmt;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use crate::engine::{Engine, require_finite};
use crate::error::Failure;
use crate::figure::{Target, Unpublished};
use crate::output::OutputFile;
use crate::plan::{MapFormat, MapPlan};
use crate::version;

pub use plane::{Axis, Coordinates, Plane, Quantity};
use results::Results;
use thumbnail::Thumbnail;
pub use tile::Tile;
use tile::{NO_COUNT, NO_EPS_T};
use tiles::{Found, Task, Tiles};

/// Most columns and rows of the picture.
const MOST_PIXELS: usize = 1000;

/// Computes the map, or the rest of one that was begun before.
///
/// # Errors
/// Files cannot be written, another process makes the same map, or some points have no result; in
/// the last case the map is complete.
pub fn run(plan: &MapPlan) -> Result<(), Failure> {
    if let Some(target) = &plan.plot {
        target.check()?;
    }
    let pool = ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?;
    let tiles = Tiles::open(&plan.out, plan.task())?;
    let failed = |error: io::Error| Failure::output(&plan.out, error);
    let mut file = OutputFile::create_in(tiles.directory(), &plan.out).map_err(failed)?;

    let unreadable = |error| Failure::input(tiles.directory(), format!("cannot be read: {error}"));
    let found = tiles.find().map_err(unreadable)?;
    report(&tiles, &found);
    let bar = progress_bar(&tiles, &found);
    for index in found.missing {
        let points = tiles.task().range(index);
        let tile = pool.install(|| compute(&plan.plane, &plan.engine, points));
        tiles.keep(index, &tile)?;
        bar.inc(tile.eps_t.len() as u64);
    }
    bar.finish_and_clear();

    let written = match plan.format {
        MapFormat::Npz => npz::write(&mut file, &plan.plane, &tiles),
        MapFormat::Csv => csv::write(&mut file, &plan.plane, &tiles),
    };
    written.and_then(|()| file.store()).map_err(failed)?;
    let picture = plan.plot.as_ref().map(|target| draw(plan, &tiles, target)).transpose()?;
    let outcome = outcome(&plan.plane, &plan.engine, &plan.out, &tiles).map_err(failed)?;
    // Both are complete before one of them gets its name.
    file.publish().map_err(failed)?;
    if let Some(picture) = picture {
        picture.publish()?;
    }
    tiles.remove();
    outcome.map_or(Ok(()), Err)
}

impl MapPlan {
    fn task(&self) -> Task {
        let plane = &self.plane;
        // Up to κ = 64 a tile is 0.3 s of work for one core; beyond, work grows as √κ.
        let halvings = (0..9).filter(|n| plane.largest_stiffness() > 64.0 * 4.0_f64.powi(*n));
        let tile_points = 32768 >> halvings.count();
        let method = match self.engine.tolerances() {
            Some(tolerances) => format!(", rtol {:?}, atol {:?}", tolerances.rtol, tolerances.atol),
            None => String::new(),
        };
        // Digits that read back as the same numbers are as good as their bits.
        let description = format!(
            "program: {} {}, {}, tiles 1\n{plane}method: {}{method}\npoints a tile: {tile_points}\n",
            crate::NAME,
            env!("CARGO_PKG_VERSION"),
            version::build(),
            self.engine.name(),
        );
        Task { description, points: plane.points(), tile_points }
    }
}

/// Computes successive points. Each depends on itself alone, so that the order of work does not
/// show.
pub fn compute(plane: &Plane, engine: &Engine, points: Range<usize>) -> Tile {
    let mut tile = Tile { eps_t: Vec::new(), switch_count: Vec::new() };
    points
        .into_par_iter()
        .map(|index| point(plane, engine, index).unwrap_or((NO_EPS_T, NO_COUNT)))
        .unzip_into_vecs(&mut tile.eps_t, &mut tile.switch_count);
    tile
}

/// The tangential restitution and the number of switches at a point.
///
/// # Errors
/// Why there are none.
fn point(plane: &Plane, engine: &Engine, index: usize) -> Result<(f64, i32), String> {
    let (column, row) = plane.cell(index);
    let contact = plane.contact(column, row).map_err(|e| e.to_string())?;
    let (collision, _) = engine.collide(contact).map_err(|e| e.to_string())?;
    require_finite(&collision).map_err(|e| e.to_string())?;
    let count = i32::try_from(collision.switches.len()).map_err(|e| e.to_string())?;
    Ok((collision.eps_t(), count))
}

/// Writes the picture, but for its name.
fn draw<'a>(plan: &MapPlan, tiles: &Tiles, target: &'a Target) -> Result<Unpublished<'a>, Failure> {
    let unreadable = |error| Failure::input(tiles.directory(), format!("cannot be read: {error}"));
    let thumbnail = Thumbnail::read(&plan.plane, tiles, MOST_PIXELS).map_err(unreadable)?;
    let picture = picture::draw(&plan.plane, &thumbnail).map_err(|error| target.failure(error))?;
    target.write(&picture)
}

/// Says how many points of the map at `path` could not be computed, if there are any, and why the
/// first.
///
/// # Errors
/// The results cannot be read.
pub fn outcome(
    plane: &Plane,
    engine: &Engine,
    path: &Path,
    results: &impl Results,
) -> io::Result<Option<Failure>> {
    let (mut failed, mut first) = (0, None);
    results.each(|points, tile| {
        for (point, count) in points.zip(&tile.switch_count) {
            if *count == NO_COUNT {
                failed += 1;
                first.get_or_insert(point);
            }
        }
        Ok(())
    })?;
    Ok(first.map(|first| {
        let (column, row) = plane.cell(first);
        let [kappa, psi] = [Quantity::Kappa, Quantity::Psi].map(|q| plane.value(q, column, row));
        // Computed once more for its reason, which the results do not keep.
        let reason = point(plane, engine, first).err().unwrap_or_default();
        Failure::Points {
            failed,
            points: plane.points(),
            path: path.to_owned(),
            first: format!("kappa = {kappa:?}, psi = {psi:?}: {reason}"),
        }
    }))
}

/// Says on standard error what was found of a map that was begun before.
fn report(tiles: &Tiles, found: &Found) {
    let Found { kept, damaged, .. } = found;
    if kept + damaged == 0 {
        return;
    }
    let directory = tiles.directory().display();
    let tiles = tiles.task().tiles();
    let damaged = match damaged {
        0 => String::new(),
        _ => format!(", {damaged} damaged and made again"),
    };
    // If standard error is closed, nobody wants to know.
    let _ = writeln!(io::stderr(), "{directory}: going on with {kept} of {tiles} tiles{damaged}");
}

/// Shows itself on a terminal only; counts what is left to do, so that the rate is right.
fn progress_bar(tiles: &Tiles, found: &Found) -> ProgressBar {
    const TEMPLATE: &str = "{bar:25} {percent}% of {human_len} points, {rate}/s, {eta} left";
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        // Writing into the line of the bar does not fail.
        let _ = write!(out, "{:.0}", state.per_sec());
    };
    let style = ProgressStyle::with_template(TEMPLATE).map(|style| style.with_key("rate", rate));
    let points: usize = found.missing.iter().map(|index| tiles.task().range(*index).len()).sum();
    ProgressBar::with_draw_target(Some(points as u64), ProgressDrawTarget::stderr())
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
