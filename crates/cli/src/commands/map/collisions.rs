//! A map of collisions. It is computed and stored tile by tile, and put together at the end.

use std::path::{Path, PathBuf};

use rayon::ThreadPool;
use stickslip_figure::pictures;
use stickslip_files::input::part::MapPart;
use stickslip_files::input::source::is_standard_input;
use stickslip_files::input::{bodies, law};
use stickslip_files::map::{
    Found, Provenance, Results, Stored, Task, Tiles, csv, npz, part_file, thumbnail,
};
use stickslip_files::output::file::{OutputFile, StoredFile};
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Engine, Law};
use stickslip_plane::atlas::RatioRange;
use stickslip_plane::sweep::{self, FailureCount};
use stickslip_plane::{Coordinates, Grid, GridAxis, Range};

use super::{MapArguments, MapFormat};
use crate::error::Failure;
use crate::output::console::{counted, deliver, say};
use crate::output::progress::Bar;
use crate::output::text::describe;
use crate::shared::collision::{ImpactRange, window};
use crate::shared::files::{plotted, require_different};
use crate::version;

/// Largest number of columns, and of rows, in the picture.
const MOST_PIXELS: usize = 1000;

/// Computes the map or a part of it, or the rest of one that was begun before.
///
/// # Errors
/// Files cannot be written, another process makes the same map, or some points have no result. In
/// the last case the map is complete.
pub fn run(arguments: &MapArguments) -> Result<(), Failure> {
    let MapArguments { part, plot, bodies, threads, .. } = arguments;
    let (part, plot) = (*part, plot.as_ref());
    let (out, shown) = arguments.main_file()?;
    let outputs = [("--out", arguments.out.as_deref()), plotted(plot)];
    require_different(&outputs, &[("--bodies", bodies.as_deref())])?;
    let output = MapOutput::of(arguments)?;
    let (grid, engine) = grid(arguments)?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let pool = threads.pool()?;
    let task = Task::new(grid, engine, &version::program());
    if let Some(part) = part
        && let Some(there) = part_file::find(out, part, &task)?
        && let Ok(failures) = there.failures()
    {
        say(format_args!("{}: has part {part} already", out.display()));
        // A process that was killed in its last moment has left them.
        Tiles::open(out, task, Some(part)).map(Tiles::remove).ok();
        return require_all(&failures, &there, (out, shown));
    }
    let tiles = Tiles::open(out, task, part)?;
    let create = |out: &PathBuf| OutputFile::create_in(tiles.directory(), out);
    let file = arguments.out.as_ref().map(create).transpose()?;
    compute(&tiles, &pool)?;
    let failures = tiles.failures().map_err(|error| tiles.unreadable(&error))?;
    let files = match (output, file) {
        (MapOutput::Part(part), Some(mut file)) => {
            part_file::write(&mut file, part, &tiles).map_err(|error| file.failure(error))?;
            vec![file.store()?]
        }
        (MapOutput::Whole(format), Some(file)) => finish(&tiles, Some((file, format)), plot)?,
        (MapOutput::Picture, _) | (_, None) => finish(&tiles, None, plot)?,
    };
    let count = tiles.task().points_of(&tiles.tiles());
    deliver(files, computed(count, &failures, &engine))?;
    if let Some(part) = part.filter(|_| tiles.tiles().is_empty()) {
        let (out, count) = (out.display(), tiles.task().tiles());
        say(format_args!("{out}: part {part} is empty, because the map has {count} tiles only"));
    }
    let outcome = require_all(&failures, &tiles, (out, shown));
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
pub fn finish(
    stored: &impl Stored,
    data: Option<(OutputFile, MapFormat)>,
    plot: Option<&PictureFile>,
) -> Result<Vec<StoredFile>, Failure> {
    let Task { grid, engine, program, .. } = stored.task();
    let write = |(mut file, format): (OutputFile, MapFormat)| {
        let provenance = Provenance::new(grid, engine, program);
        let written = match format {
            MapFormat::Npz => npz::write(&mut file, grid, &provenance, stored),
            MapFormat::Csv => csv::write(&mut file, grid, &provenance, stored),
        };
        written.map_err(|error| file.failure(error))?;
        file.store()
    };
    let data = data.map(write).transpose()?;
    let picture = plot.map(|plot| draw(stored, plot)).transpose()?;
    Ok(data.into_iter().chain(picture).collect())
}

/// How many of the points have a result, and what computed them.
pub fn computed(points: usize, failures: &FailureCount, engine: &Engine) -> String {
    let points = counted(points - failures.points(), "point", "points");
    format!("{points} computed by {}", describe(engine))
}

/// Tells which of the points in the finished file `out` have no result, and are `shown` so.
pub fn require_all(
    failures: &FailureCount,
    stored: &impl Stored,
    (out, shown): (&Path, &'static str),
) -> Result<(), Failure> {
    let task = stored.task();
    match failures.failed(&task.grid, task.engine) {
        Some(failed) => {
            let (path, points) = (out.to_owned(), task.points_of(&stored.tiles()));
            Err(Failure::Points { failed: Box::new(failed), points, shown, path })
        }
        None => Ok(()),
    }
}

/// Writes the picture completely, except for the name of its file.
fn draw(stored: &impl Stored, plot: &PictureFile) -> Result<StoredFile, Failure> {
    let thumbnail = thumbnail::read(stored, MOST_PIXELS);
    let (size, results) = thumbnail.map_err(|error| stored.unreadable(&error))?;
    Ok(plot.write(pictures::grid::draw(&stored.task().grid, size, &results))?)
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

/// The cells of the map, and what computes the collisions.
fn grid(arguments: &MapArguments) -> Result<(Grid, Engine), Failure> {
    let MapArguments { size, bodies, .. } = arguments;
    let (mut law, mut tangential_damping) = arguments.law.chosen()?;
    let MapAxes { columns, rows, coordinates, engine } = match bodies {
        Some(file) => MapAxes::of_bodies(arguments, file, law)?,
        None => MapAxes::scaled(arguments, (law, tangential_damping))?,
    };
    if let Coordinates::Velocities { pair } = coordinates {
        (law, tangential_damping) = (pair.law, pair.tangential_damping());
        law::permits(arguments.law.law.as_deref(), "tangential damping", tangential_damping)?;
    }
    let columns = GridAxis { range: columns, cells: size.columns };
    let rows = GridAxis { range: rows, cells: size.rows };
    Ok((Grid { columns, rows, coordinates, law, tangential_damping }, engine))
}

/// The axes of a map, what they mean, and what computes the collisions.
struct MapAxes {
    columns: Range,
    rows: Range,
    coordinates: Coordinates,
    engine: Engine,
}

impl MapAxes {
    /// The axes κ and ψ, or κ and g_t/g_n.
    fn scaled(arguments: &MapArguments, law: (Law, f64)) -> Result<Self, Failure> {
        let MapArguments { kappa, psi, ratio, collisions, ref method, .. } = *arguments;
        let (columns, impact) = window(kappa, (psi, ratio), collisions)?;
        let engine = method.engine(law)?;
        let damping = collisions.damping(law.0)?;
        let (rows, coordinates) = match impact {
            ImpactRange::Psi(psi) => (psi, Coordinates::Psi { damping }),
            ImpactRange::Ratio(RatioRange { range, reduction }) => {
                (range, Coordinates::Ratio { reduction, damping })
            }
        };
        Ok(Self { columns, rows, coordinates, engine })
    }

    /// The axes g_n and g_t of the bodies in `file`.
    fn of_bodies(arguments: &MapArguments, file: &Path, law: Law) -> Result<Self, Failure> {
        let (Some(columns), Some(rows)) = (arguments.normal, arguments.tangential) else {
            let message = "--normal or --tangential is missing; expected --bodies with both";
            return Err(Failure::Usage(message.to_owned()));
        };
        let pair = bodies::read_pair(file, law)?;
        let law = (pair.law, pair.tangential_damping());
        let engine = arguments.method.engine(law)?;
        Ok(Self { columns, rows, coordinates: Coordinates::Velocities { pair }, engine })
    }
}

/// What a map is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MapOutput {
    /// The whole map.
    Whole(MapFormat),
    /// One of its parts, which are to be joined.
    Part(MapPart),
    /// Only its picture.
    Picture,
}

impl MapOutput {
    fn of(arguments: &MapArguments) -> Result<Self, Failure> {
        let MapArguments { part, out, .. } = arguments;
        let Some(out) = out else { return Ok(Self::Picture) };
        match part {
            None => MapFormat::of(out).map(Self::Whole),
            Some(_) if is_standard_input(out) => {
                let message = "--out -: a part is not written to standard output; expected a file";
                Err(Failure::Usage(message.to_owned()))
            }
            Some(part) => Ok(Self::Part(*part)),
        }
    }
}
