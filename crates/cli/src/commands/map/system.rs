//! A map of the runs of a system of one's own.

use std::io::{self, Write};

use rayon::prelude::*;
use stickslip_figure::pictures::map::{self, MapAxis, MapPanel, MapValues};
use stickslip_files::output::csv::CsvFile;
use stickslip_files::output::file::{OutputFile, StoredFile};
use stickslip_files::output::npz::{Archive, array, number, plain, text, texts};
use stickslip_files::output::picture::PictureFile;
use stickslip_tracer::{Point, hybrid::DynamicFired};

use super::{MapArguments, MapFormat};
use crate::commands::run::outcome;
use crate::error::Failure;
use crate::output::console::{counted, deliver};
use crate::output::progress::Bar;
use crate::shared::files::{plotted, require_different};
use crate::shared::system::SystemPlane;
use crate::version;

/// The largest number of points of a map, which is in memory.
const MOST_POINTS: usize = 100_000_000;

/// So many components are drawn.
const MOST_PANELS: usize = 3;
/// A picture has at most so many columns and rows.
const MOST_PIXELS: usize = 1000;

/// What the run at a point comes to.
struct Cell {
    /// The number of events before the end; negative if the run has no result.
    events: i32,
    outcome: &'static str,
    mode: i32,
    time: f64,
    state: Vec<f64>,
}

/// Computes the map and writes it.
///
/// # Errors
/// Options contradict each other, files cannot be written, or some points have no result. In the
/// last case the map is complete.
pub fn run(plane: &SystemPlane, arguments: &MapArguments) -> Result<(), Failure> {
    let MapArguments { size, plot, threads, .. } = arguments;
    let plot = plot.as_ref();
    let (path, shown) = arguments.main_file()?;
    let out = arguments.out.as_deref();
    let system = ("the system", arguments.plane.system.as_deref());
    require_different(&[("--out", out), plotted(plot)], &[system])?;
    let (columns, rows) = (size.columns, size.rows);
    if columns.saturating_mul(rows) > MOST_POINTS {
        return Err(Failure::Usage(format!(
            "--size: {columns}x{rows} points; expected at most {MOST_POINTS} of a system"
        )));
    }
    let format = out.map(|out| MapFormat::of(out).map(|format| (out, format))).transpose()?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let pool = threads.pool()?;
    let x = centres(plane.window.low.x, plane.window.high.x, columns);
    let y = centres(plane.window.low.y, plane.window.high.y, rows);
    let bar = Bar::points(columns * rows);
    let mut cells: Vec<Cell> = Vec::with_capacity(columns * rows);
    for &y in &y {
        let row = || x.par_iter().map(|&x| cell(plane, &Point::new(x, y))).collect::<Vec<_>>();
        cells.extend(pool.install(row));
        bar.advance(columns);
    }
    drop(bar);
    let map = Map { plane, x, y, cells };
    let data = match format {
        Some((out, MapFormat::Npz)) => {
            let mut file = OutputFile::create(out)?;
            map.archive(&mut file).map_err(|error| file.failure(error))?;
            Some(file.store()?)
        }
        Some((out, MapFormat::Csv)) => Some(map.table(out)?),
        None => None,
    };
    let picture = plot.map(|plot| map.draw(plot)).transpose()?;
    let points = map.cells.len();
    let failed = map.cells.iter().filter(|cell| cell.events < 0).count();
    let found = format!("{} computed", counted(points - failed, "run", "runs"));
    deliver(data.into_iter().chain(picture), found)?;
    if failed > 0 {
        return Err(Failure::Runs { failed, points, shown, path: path.to_owned() });
    }
    Ok(())
}

/// The centres of equal parts of an interval.
fn centres(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low + (high - low) * ((i as f64 + 0.5) / count as f64)).collect()
}

fn cell(plane: &SystemPlane, point: &Point) -> Cell {
    let Ok(Some(DynamicFired { run, fired })) = plane.family.run(point) else {
        let state = vec![f64::NAN; plane.system.components.len()];
        return Cell { events: -1, outcome: "failed", mode: -1, time: f64::NAN, state };
    };
    Cell {
        events: i32::try_from(fired.len()).unwrap_or(i32::MAX),
        outcome: outcome(run.outcome).0,
        mode: i32::try_from(run.mode).unwrap_or(i32::MAX),
        time: run.s,
        state: run.state,
    }
}

/// The runs at all points, row by row.
struct Map<'a> {
    plane: &'a SystemPlane,
    x: Vec<f64>,
    y: Vec<f64>,
    cells: Vec<Cell>,
}

impl Map<'_> {
    fn archive(&self, out: &mut OutputFile) -> io::Result<()> {
        let mut archive = Archive::new(out);
        let [x, y] = &self.plane.names.axes;
        let (columns, rows) = (self.x.len(), self.y.len());
        let shape = format!("{rows}, {columns}");
        let write = |out: &mut dyn Write, values: &mut dyn Iterator<Item = f64>| {
            for value in values {
                out.write_all(&value.to_le_bytes())?;
            }
            Ok(())
        };
        for (name, values) in [(x, &self.x), (y, &self.y)] {
            let shape = format!("{},", values.len());
            array(&mut archive, name, "<f8", &shape, |out| {
                write(out, &mut values.iter().copied())
            })?;
        }
        for (name, of) in
            [("event_count", (|it| it.events) as fn(&Cell) -> i32), ("end_mode", |it| it.mode)]
        {
            array(&mut archive, name, "<i4", &shape, |out| {
                self.cells.iter().try_for_each(|cell| out.write_all(&of(cell).to_le_bytes()))
            })?;
        }
        texts(&mut archive, "outcome", &shape, self.cells.iter().map(|cell| cell.outcome))?;
        array(&mut archive, "end_time", "<f8", &shape, |out| {
            write(out, &mut self.cells.iter().map(|cell| cell.time))
        })?;
        for (place, component) in self.plane.system.components.iter().enumerate() {
            let name = format!("end_{}", component.name);
            array(&mut archive, &name, "<f8", &shape, |out| {
                write(out, &mut self.cells.iter().map(|cell| cell.state[place]))
            })?;
        }
        let fixed = self.plane.family.parameters().iter().zip(&self.plane.system.parameters);
        for (value, parameter) in fixed.filter(|(_, it)| it.name != *x && it.name != *y) {
            number(&mut archive, &parameter.name, *value)?;
        }
        let modes: Vec<&str> = self.plane.system.modes.iter().map(|it| it.name.as_str()).collect();
        text(&mut archive, "modes", &modes.join(", "))?;
        text(&mut archive, "version", &version::program())?;
        archive.finish().map_err(plain)?.flush()
    }

    fn table(&self, path: &std::path::Path) -> Result<StoredFile, Failure> {
        let mut file = CsvFile::create(path)?;
        let rows = &mut file.rows;
        rows.fields(self.plane.names.axes.iter().map(String::as_str));
        rows.fields(["event_count", "outcome", "end_mode", "end_time"]);
        rows.fields(self.plane.system.components.iter().map(|it| format!("end_{}", it.name)));
        file.end()?;
        for (y, row) in self.y.iter().zip(self.cells.chunks(self.x.len())) {
            for (x, cell) in self.x.iter().zip(row) {
                let rows = &mut file.rows;
                rows.number(*x);
                rows.number(*y);
                rows.count(cell.events);
                rows.field(cell.outcome);
                let mode = usize::try_from(cell.mode).ok();
                rows.field(mode.map_or("", |mode| &self.plane.system.modes[mode].name));
                rows.number(cell.time);
                cell.state.iter().for_each(|&value| rows.number(value));
                file.end()?;
            }
        }
        Ok(file.store()?)
    }

    /// The picture, of every cell or of every so manyth.
    fn draw(&self, plot: &PictureFile) -> Result<StoredFile, Failure> {
        let by = |count: usize| count.div_ceil(MOST_PIXELS);
        let (across, up) = (by(self.x.len()), by(self.y.len()));
        let rows = self.cells.chunks(self.x.len()).step_by(up);
        let shown: Vec<&Cell> = rows.flat_map(|row| row.iter().step_by(across)).collect();
        let (columns, rows) = (self.x.len().div_ceil(across), self.y.len().div_ceil(up));
        // Events that accumulate have no number.
        let known = |cell: &&Cell| if cell.outcome == "accumulation" { -1 } else { cell.events };
        let counts: Vec<i32> = shown.iter().map(known).collect();
        let times: Vec<f64> = shown.iter().map(|cell| cell.time).collect();
        let names = self.plane.system.components.iter().take(MOST_PANELS).enumerate();
        let values: Vec<(String, Vec<f64>)> =
            std::iter::once(("time at the end".to_owned(), times))
                .chain(names.map(|(place, component)| {
                    let values = shown.iter().map(|cell| cell.state[place]);
                    (format!("{} at the end", component.name), values.collect())
                }))
                .collect();
        let (low, high) = (self.plane.window.low, self.plane.window.high);
        let panel = |heading, values| MapPanel {
            heading,
            horizontal: MapAxis { name: &self.plane.names.axes[0], range: (low.x, high.x) },
            vertical: MapAxis { name: &self.plane.names.axes[1], range: (low.y, high.y) },
            columns,
            rows,
            values,
            lines: Vec::new(),
            points: Vec::new(),
        };
        let mut panels = vec![panel("number of events", MapValues::Switches(&counts))];
        for (heading, values) in &values {
            // Where all runs end at one time, that is known.
            let first = values[0];
            if values.iter().any(|&value| value != first) {
                panels.push(panel(heading, MapValues::Restitution(values)));
            }
        }
        let size = format!("{} × {} runs", self.x.len(), self.y.len());
        let title = format!("{}: {size}", self.plane.names.family);
        Ok(plot.write(map::draw(&title, &panels))?)
    }
}
