//! A map of collisions. It is computed and stored tile by tile, and put together at the end.

use std::path::Path;

use rayon::ThreadPool;
use stickslip_figure::pictures::grid;
use stickslip_files::map::{
    Found, Provenance, Results, Stored, Task, Tiles, csv, npz, part_file, thumbnail,
};
use stickslip_files::output::file::{OutputFile, StoredFile, publish};
use stickslip_files::output::picture::PictureFile;
use stickslip_plane::sweep::{self, FailureCount};

use crate::error::Failure;
use crate::output::console::say;
use crate::output::progress::Bar;
use crate::plan::{MapFormat, MapOutput, MapPlan};
use crate::{threads, version};

/// Largest number of columns, and of rows, in the picture.
const MOST_PIXELS: usize = 1000;

/// Computes the map or a part of it, or the rest of one that was begun before.
///
/// # Errors
/// Files cannot be written, another process makes the same map, or some points have no result. In
/// the last case the map is complete.
pub fn run(plan: &MapPlan) -> Result<(), Failure> {
    plan.plot.as_ref().map(PictureFile::probe).transpose()?;
    let pool = threads::pool(plan.threads)?;
    let task = Task::new(plan.grid, plan.engine, &version::program());
    let part = match plan.output {
        MapOutput::Part(part) => Some(part),
        MapOutput::Whole(_) => None,
    };
    if let Some(part) = part
        && let Some(there) = part_file::find(&plan.out, part, &task)?
        && let Ok(failures) = there.failures()
    {
        say(format_args!("{}: has part {part} already", plan.out.display()));
        // A process that was killed in its last moment has left them.
        Tiles::open(&plan.out, task, Some(part)).map(Tiles::remove).ok();
        return require_all(&failures, &there, &plan.out);
    }
    let tiles = Tiles::open(&plan.out, task, part)?;
    let mut file = OutputFile::create_in(tiles.directory(), &plan.out)?;
    compute(&tiles, &pool)?;
    let failures = tiles.failures().map_err(|error| tiles.unreadable(&error))?;
    let files = match plan.output {
        MapOutput::Whole(format) => finish(&tiles, file, format, plan.plot.as_ref())?,
        MapOutput::Part(part) => {
            part_file::write(&mut file, part, &tiles).map_err(|error| file.failure(error))?;
            vec![file.store()?]
        }
    };
    publish(files)?;
    if let Some(part) = part.filter(|_| tiles.tiles().is_empty()) {
        let (out, count) = (plan.out.display(), tiles.task().tiles());
        say(format_args!("{out}: part {part} is empty, because the map has {count} tiles only"));
    }
    let outcome = require_all(&failures, &tiles, &plan.out);
    tiles.remove();
    outcome
}

/// Computes all tiles that are not there yet.
fn compute(tiles: &Tiles, pool: &ThreadPool) -> Result<(), Failure> {
    let found = tiles.find().map_err(|error| tiles.unreadable(&error))?;
    report(tiles, &found);
    let task = tiles.task();
    let kept: usize = found.kept.iter().map(|index| task.range(*index).len()).sum();
    let bar = Bar::points(task.points_of(&tiles.tiles()) - kept);
    for index in tiles.tiles().filter(|index| !found.kept.contains(index)) {
        let points = task.range(index);
        let tile = pool.install(|| sweep::compute(&task.grid, task.engine, points));
        tiles.keep(index, &tile)?;
        bar.advance(tile.eps_t.len());
    }
    Ok(())
}

/// Writes the map whose results are `stored`, and its picture, completely, except for the names of
/// the files.
///
/// # Errors
/// A file cannot be written, or a tile cannot be read.
pub fn finish(
    stored: &impl Stored,
    mut file: OutputFile,
    format: MapFormat,
    plot: Option<&PictureFile>,
) -> Result<Vec<StoredFile>, Failure> {
    let Task { grid, engine, program, .. } = stored.task();
    let provenance = Provenance::new(grid, engine, program);
    let written = match format {
        MapFormat::Npz => npz::write(&mut file, grid, &provenance, stored),
        MapFormat::Csv => csv::write(&mut file, grid, &provenance, stored),
    };
    written.map_err(|error| file.failure(error))?;
    let picture = plot.map(|plot| draw(stored, plot)).transpose()?;
    Ok([file.store()?].into_iter().chain(picture).collect())
}

/// Tells which of the points in the finished file `out` have no result.
///
/// # Errors
/// [`Failure::Points`] names the first of them.
pub fn require_all(
    failures: &FailureCount,
    stored: &impl Stored,
    out: &Path,
) -> Result<(), Failure> {
    let task = stored.task();
    match failures.failed(&task.grid, task.engine) {
        Some(failed) => {
            let (path, points) = (out.to_owned(), task.points_of(&stored.tiles()));
            Err(Failure::Points { failed: Box::new(failed), points, path })
        }
        None => Ok(()),
    }
}

/// Writes the picture completely, except for the name of its file.
fn draw(stored: &impl Stored, plot: &PictureFile) -> Result<StoredFile, Failure> {
    let thumbnail = thumbnail::read(stored, MOST_PIXELS);
    let (size, results) = thumbnail.map_err(|error| stored.unreadable(&error))?;
    Ok(plot.write(grid::draw(&stored.task().grid, size, &results))?)
}

/// Says on standard error which tiles were found, if the map was begun before.
fn report(tiles: &Tiles, found: &Found) {
    let (kept, damaged) = (found.kept.len(), found.damaged);
    if kept + damaged == 0 {
        return;
    }
    let directory = tiles.directory().display();
    let tiles = tiles.tiles().len();
    let damaged = match damaged {
        0 => String::new(),
        _ => format!(", {damaged} damaged and made again"),
    };
    say(format_args!("{directory}: going on with {kept} of {tiles} tiles{damaged}"));
}
