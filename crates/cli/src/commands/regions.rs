//! `regions`: where a periodic orbit exists and is stable over two parameters.

use std::io::{self, Write};
use std::path::PathBuf;

use stickslip_figure::pictures::family::draw_named;
use stickslip_files::output::file::OutputFile;
use stickslip_files::output::picture::PictureFile;
use stickslip_orbits::document::Document;
use stickslip_orbits::{OrbitAtlas, OrbitNames, RegionOptions};
use stickslip_tracer::Names;

use crate::error::Failure;
use crate::output::console::{counted, deliver, print};
use crate::output::progress::Bar;
use crate::output::text::{self, number};
use crate::shared::files::{picture, plotted, require_different, write_json};
use crate::shared::orbit::{GuessArguments, failure};
use crate::shared::system::{Axis, axis, place};
use crate::shared::threads::ThreadsArguments;

/// Map where a periodic orbit of a system of your own exists and is stable, over two parameters
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_long_help = EXAMPLES)]
pub struct RegionsArguments {
    /// Where the orbit is searched for.
    #[command(flatten)]
    pub guess: GuessArguments,

    /// The parameter on the horizontal axis, and its interval, in which its present value lies
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Regions")]
    pub x: Axis,

    /// The parameter on the vertical axis, and its interval, in which its present value lies
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, help_heading = "Regions")]
    pub y: Axis,

    /// Lines on which orbits are followed divide each side of the window into so many parts; 1 to
    /// 100
    #[arg(long, value_name = "N", help_heading = "Regions", default_value_t = 5)]
    #[arg(allow_hyphen_values = true)]
    pub cells: usize,

    /// JSON file for the regions
    #[arg(long, value_name = "REGIONS.json", help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// Picture of the regions and their boundaries
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    #[arg(value_parser = picture())]
    pub plot: Option<PictureFile>,

    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Finds the regions, writes what is wanted, and prints them.
///
/// # Errors
/// The system cannot be read, options do not fit it, there is no orbit, a file or standard output
/// cannot be written, or a region is in doubt. In the last case the files are complete and say so.
pub fn run(arguments: &RegionsArguments) -> Result<(), Failure> {
    let RegionsArguments { guess, x, y, out, plot, .. } = arguments;
    let (out, plot) = (out.as_deref(), plot.as_ref());
    require_different(&[("--out", out), plotted(plot)], &guess.inputs())?;
    plot.map_or(Ok(()), PictureFile::probe)?;
    let file = out.map(OutputFile::create).transpose()?;
    let options = RegionOptions { cells: arguments.cells, ..RegionOptions::default() };
    options.validate().map_err(|error| Failure::Usage(error.to_string()))?;
    let pool = arguments.threads.pool()?;
    let found = guess.find()?;
    let system = found.orbits.system();
    let parameters = [place(system, "--x", &x.name)?, place(system, "--y", &y.name)?];
    let window = [[x.range.low, x.range.high], [y.range.low, y.range.high]];
    let regions = || found.orbits.regions(&found.orbit, parameters, window, &options);
    let bar = Bar::watching(found.orbits.watch());
    let atlas = pool.install(regions).map_err(failure)?;
    drop(bar);
    let names = OrbitNames { axes: [x.name.clone(), y.name.clone()] };
    let mut stored = Vec::new();
    if let Some(file) = file {
        let orbit = (&found.orbit, parameters);
        let document = Document::of_regions(&found.orbits, &found.name, orbit, &atlas, &options);
        stored.push(write_json(file, &document)?);
    }
    if let Some(plot) = plot {
        let title = format!("{}: orbits that the system follows", found.name);
        stored.push(plot.write(Ok(draw_named(&atlas, &names, &title)))?);
    }
    deliver(stored, counted(atlas.plane.regions().len(), "region", "regions"))?;
    print(|out| table(out, &atlas, &names))?;
    let objection = atlas.doubts(&names).map(|doubts| doubts.objection());
    Failure::if_doubtful(out.unwrap_or(&guess.from.system), "map is", objection)
}

/// Prints a row for each region: its orbits, its part of the window, a point of it, and what
/// changes at its boundaries.
fn table(out: &mut dyn Write, atlas: &OrbitAtlas, names: &OrbitNames) -> io::Result<()> {
    let [x, y] = names.axes();
    let header = ["orbits", "part", x, y, "ends at"].map(str::to_owned);
    let whole = atlas.plane.window().area();
    let rows = atlas.plane.regions().iter().enumerate().map(|(index, region)| {
        let label = region.label.as_ref().filter(|_| !atlas.is_doubtful(index));
        let mut kinds: Vec<&str> = Vec::new();
        for (curve, _) in &region.boundary {
            let kind = names.kind(&atlas.plane.curves()[*curve].margin);
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        [
            label.map_or_else(|| "in doubt".to_owned(), |label| names.text(label)),
            number(region.area / whole),
            number(region.sample.x),
            number(region.sample.y),
            kinds.join(", "),
        ]
    });
    text::aligned(out, &std::iter::once(header).chain(rows).collect::<Vec<_>>())?;
    writeln!(out)?;
    text::pairs(out, &[("error of boundaries", number(atlas.plane.tolerance()))])
}

/// What `regions --help` says first.
const ABOUT: &str = "\
Map where a periodic orbit of a system of your own exists and is stable, over two parameters. Each \
region says which orbits of this itinerary the system follows there, and how many of their \
multipliers are outside the unit circle; each boundary says what changes there: a fold, a flip, a \
graze.

Orbits are followed along the lines of a grid. Special orbits that all of these lines miss are \
missed, unless one of the random points at which the regions are compared with orbits shows it.";

/// What `regions --help` says last.
const EXAMPLES: &str = "\
Examples:
  stickslip regions examples/orbits/ball.slip --itinerary period,bounce --x a=0.005:0.05 \
--y r=0.5:0.9 --plot regions.svg

Exit codes: 0 done, 1 the computation failed or a region is in doubt, 2 bad usage or bad input.";
