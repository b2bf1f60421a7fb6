//! A map of collisions. It is computed and stored tile by tile, and put together at the end.
//!
//! Start reading here; then, in this order: `tiles` and `results` (what is stored, and where),
//! `provenance` (what a map says about itself), `npz` and `csv` (the finished map), `thumbnail`
//! (the part of it that is drawn).

mod csv;
mod npz;
mod provenance;
mod results;
mod thumbnail;
mod tiles;

use std::io;

use stickslip_figure::pictures::grid;
use stickslip_plane::sweep::{self, FailureCount};

use crate::error::Failure;
use crate::output::console::say;
use crate::output::file::{OutputFile, StoredFile, publish};
use crate::output::picture::PictureFile;
use crate::output::progress::Bar;
use crate::plan::{MapFormat, MapPlan};
use crate::{threads, version};
use provenance::Provenance;
use results::Results;
use tiles::{Found, Task, Tiles};

pub use npz::archive;

/// Largest number of columns, and of rows, in the picture.
const MOST_PIXELS: usize = 1000;

/// Computes the map, or the rest of one that was begun before.
///
/// # Errors
/// Files cannot be written, another process makes the same map, or some points have no result. In
/// the last case the map is complete.
pub fn run(plan: &MapPlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(plan.threads)?;
    let tiles = Tiles::open(&plan.out, task(plan))?;
    let mut file = OutputFile::create_in(tiles.directory(), &plan.out)?;

    let found = tiles.find().map_err(|error| unreadable(&tiles, &error))?;
    report(&tiles, &found);
    let kept: usize = found.kept.iter().map(|index| tiles.task().range(*index).len()).sum();
    let bar = Bar::points(plan.grid.points() - kept);
    for index in (0..tiles.task().tiles()).filter(|index| !found.kept.contains(index)) {
        let points = tiles.task().range(index);
        let tile = pool.install(|| sweep::compute(&plan.grid, plan.engine, points));
        tiles.keep(index, &tile)?;
        bar.advance(tile.eps_t.len());
    }
    drop(bar);

    let provenance = Provenance::new(&plan.grid, &plan.engine);
    let written = match plan.format {
        MapFormat::Npz => npz::write(&mut file, &plan.grid, &provenance, &tiles),
        MapFormat::Csv => csv::write(&mut file, &plan.grid, &provenance, &tiles),
    };
    written.map_err(|error| file.failure(error))?;
    let picture = plan.plot.as_ref().map(|plot| draw(plan, &tiles, plot)).transpose()?;
    let mut count = FailureCount::default();
    let counted = tiles.each(|points, tile| {
        count.add(points.start, tile);
        Ok(())
    });
    counted.map_err(|error| unreadable(&tiles, &error))?;
    publish([file.store()?].into_iter().chain(picture))?;
    tiles.remove();
    match count.failed(&plan.grid, plan.engine) {
        Some(failed) => {
            let (path, points) = (plan.out.clone(), plan.grid.points());
            Err(Failure::Points { failed: Box::new(failed), points, path })
        }
        None => Ok(()),
    }
}

fn task(plan: &MapPlan) -> Task {
    let grid = &plan.grid;
    // Up to κ = 64 a tile takes one core 0.3 s. Beyond, work grows as √κ.
    let halvings = (0..9).filter(|n| grid.largest_stiffness() > 64.0 * 4.0_f64.powi(*n));
    let tile_points = 32768 >> halvings.count();
    let method = match plan.engine.tolerances() {
        Some(tolerances) => format!(", rtol {:?}, atol {:?}", tolerances.rtol, tolerances.atol),
        None => String::new(),
    };
    // The digits read back as the same numbers, so that equal texts mean equal tasks.
    let description = format!(
        "program: {}, tiles 2\n{grid}method: {}{method}\npoints a tile: {tile_points}\n",
        version::program(),
        plan.engine.name(),
    );
    Task { description, points: grid.points(), tile_points }
}

fn unreadable(tiles: &Tiles, error: &io::Error) -> Failure {
    Failure::input(tiles.directory(), format!("cannot be read: {error}"))
}

/// Writes the picture completely, except for the name of its file.
fn draw(plan: &MapPlan, tiles: &Tiles, plot: &PictureFile) -> Result<StoredFile, Failure> {
    let thumbnail = thumbnail::read(&plan.grid, tiles, MOST_PIXELS);
    let (size, results) = thumbnail.map_err(|error| unreadable(tiles, &error))?;
    plot.write(grid::draw(&plan.grid, size, &results))
}

/// Says on standard error which tiles were found, if the map was begun before.
fn report(tiles: &Tiles, found: &Found) {
    let (kept, damaged) = (found.kept.len(), found.damaged);
    if kept + damaged == 0 {
        return;
    }
    let directory = tiles.directory().display();
    let tiles = tiles.task().tiles();
    let damaged = match damaged {
        0 => String::new(),
        _ => format!(", {damaged} damaged and made again"),
    };
    say(format_args!("{directory}: going on with {kept} of {tiles} tiles{damaged}"));
}
