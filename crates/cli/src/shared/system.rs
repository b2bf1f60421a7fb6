//! Systems that are texts: their options, their parameters and their runs.

use std::path::{Path, PathBuf};

use stickslip_expression::{Runnable, System, SystemFamily};
use stickslip_files::input::{number, source};
use stickslip_plane::Range;
use stickslip_solver::Options;
use stickslip_tracer::{Accumulation, AtlasOptions, Point, RunNames, Window};

use super::method::{atol, rtol};
use crate::error::Failure;
use crate::output::console::say;

/// The largest text of a system, in bytes.
const MOST_TEXT: u64 = 100_000_000;

/// The runs of a system over two of its parameters.
#[derive(Debug, clap::Args)]
pub struct PlaneArguments {
    /// A system of your own instead of collisions: a text as docs/systems.md describes it; - is
    /// standard input
    #[arg(value_name = "SYSTEM.slip", requires_all = ["x", "y"])]
    pub system: Option<PathBuf>,

    /// The parameter on the horizontal axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub x: Option<Axis>,

    /// The parameter on the vertical axis, and its interval
    #[arg(long, value_name = "NAME=LO:HI", value_parser = axis, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub y: Option<Axis>,

    /// What else differs from the text.
    #[command(flatten)]
    pub given: GivenArguments,

    /// Events after which a run is not told apart from others; where events accumulate, there are
    /// boundaries without end unless this is a small number [default: 10000000; for an atlas, 4 to
    /// 12 if events accumulate in the window]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(allow_hyphen_values = true, requires = "system", help_heading = "System of your own")]
    pub max_events: Option<u32>,

    /// Relative tolerance of a step of a system; 1e-15 to 0.1 [default: 1e-13]
    #[arg(long = "system-rtol", value_name = "R", value_parser = rtol, requires = "system")]
    #[arg(allow_hyphen_values = true, help_heading = "System of your own")]
    pub system_rtol: Option<f64>,

    /// Absolute tolerance of a step of a system; above 0 [default: 1e-13]
    #[arg(long = "system-atol", value_name = "T", value_parser = atol, requires = "system")]
    #[arg(allow_hyphen_values = true, help_heading = "System of your own")]
    pub system_atol: Option<f64>,
}

/// What differs from the text of a system.
#[derive(Debug, clap::Args)]
pub struct GivenArguments {
    /// The value of a parameter; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, requires = "system")]
    #[arg(help_heading = "System of your own")]
    pub set: Vec<(String, f64)>,

    /// Where runs end, instead of the end that the system says
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(requires = "system", help_heading = "System of your own")]
    pub end: Option<f64>,
}

/// A parameter on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name.
    pub name: String,
    /// Its interval.
    pub range: Range,
}

/// Reads a system, and its text.
pub fn read(path: &Path) -> Result<(System, String), Failure> {
    let text = source::read(path, MOST_TEXT)?;
    let shown = source::shown(path);
    let text =
        String::from_utf8(text).map_err(|_| Failure::input(shown, "is not a text in UTF-8"))?;
    let refused = |error| Failure::Text { path: shown.to_owned(), error };
    let system = System::parse(&text).map_err(refused)?;
    Ok((system, text))
}

/// The name of a system in titles: that of its file.
pub fn title(path: &Path) -> String {
    let name = source::shown(path).file_stem();
    name.map_or_else(String::new, |it| it.to_string_lossy().into_owned())
}

/// The values of the parameters of a system, some of which are set.
pub fn values(system: &System, set: &[(String, f64)]) -> Result<Vec<f64>, Failure> {
    let mut values = system.values();
    for (name, value) in set {
        values[place(system, "--set", name)?] = *value;
    }
    Ok(values)
}

/// The place of a parameter.
pub fn place(system: &System, option: &str, name: &str) -> Result<usize, Failure> {
    let place = system.parameters.iter().position(|it| it.name == *name);
    place.ok_or_else(|| {
        let names: Vec<_> = system.parameters.iter().map(|it| it.name.as_str()).collect();
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Failure::Usage(format!("{option} {name}: the system has no such parameter; it has {known}"))
    })
}

/// Refuses runs without an end.
fn require_end(system: &System, end: Option<f64>) -> Result<(), Failure> {
    if end.is_none() && system.end.is_none() && !system.ends_itself() {
        let message = "the system says no end; expected --end, `end = …`, or a rule -> end";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(())
}

/// A run of a system.
#[derive(Debug)]
pub struct SystemRun {
    /// The name of the system in titles.
    pub name: String,
    /// The system.
    pub system: System,
    /// The values of its parameters.
    pub parameters: Vec<f64>,
    /// The system with these values.
    pub runnable: Runnable,
    /// Where the run ends.
    pub end: f64,
}

impl SystemRun {
    /// The run of the system in a file, with some parameters set, and with another end if one is
    /// given.
    pub fn new(path: &Path, set: &[(String, f64)], end: Option<f64>) -> Result<Self, Failure> {
        let (system, _) = read(path)?;
        let parameters = values(&system, set)?;
        let runnable =
            system.with(&parameters).map_err(|error| Failure::Usage(error.to_string()))?;
        let given = end;
        let end = given.unwrap_or(runnable.end());
        if end.is_nan() || end <= runnable.start().s {
            let start = runnable.start().s;
            return Err(Failure::Usage(format!(
                "the run ends at {end}; expected an end after {start}"
            )));
        }
        require_end(&system, given)?;
        Ok(Self { name: title(path), system, parameters, runnable, end })
    }
}

/// The runs of a system over a window of two of its parameters.
#[derive(Debug)]
pub struct SystemPlane {
    /// The system.
    pub system: System,
    /// The runs.
    pub family: SystemFamily,
    /// The names of the system in titles, of the parameters on the axes and of the rules.
    pub names: RunNames,
    /// The window.
    pub window: Window,
}

impl SystemPlane {
    /// The plane that `arguments` describe, if they name a system.
    pub fn new(arguments: &PlaneArguments) -> Result<Option<Self>, Failure> {
        let PlaneArguments { system, x, y, given: GivenArguments { set, end }, .. } = arguments;
        let (Some(path), Some(x), Some(y)) = (system, x, y) else { return Ok(None) };
        let (system, _) = read(path)?;
        let parameters = values(&system, set)?;
        let axis = |option: &str, axis: &Axis| place(&system, option, &axis.name);
        let places = [axis("--x", x)?, axis("--y", y)?];
        if places[0] == places[1] {
            return Err(Failure::Usage(format!(
                "--x and --y are both {}; expected two parameters",
                x.name
            )));
        }
        require_end(&system, *end)?;
        let defaults = Options::with_tolerance(1e-13);
        let options = Options {
            rtol: arguments.system_rtol.unwrap_or(defaults.rtol),
            atol: arguments.system_atol.unwrap_or(defaults.atol),
            max_switches: arguments.max_events.map_or(defaults.max_switches, |most| most as usize),
            ..defaults
        };
        let family = SystemFamily::new(&system, places, &parameters, *end, options);
        let family = family.map_err(|error| Failure::Usage(error.to_string()))?;
        Ok(Some(Self {
            names: RunNames {
                family: title(path),
                axes: [x.name.clone(), y.name.clone()],
                guards: family.rules().to_vec(),
            },
            family,
            window: Window {
                low: Point::new(x.range.low, y.range.low),
                high: Point::new(x.range.high, y.range.high),
            },
            system,
        }))
    }

    /// The family of an atlas, or of those with these values of a third parameter. If events
    /// accumulate in some runs, and `most` does not say how many count, so few count that there are
    /// boundaries with an end; standard error says so.
    pub fn family_of_atlas(&self, most: Option<u32>, over: &[(usize, f64)]) -> SystemFamily {
        let family = self.family.clone();
        if most.is_some() {
            return family;
        }
        let with = over.iter().map(|&(third, value)| family.with(third, value));
        let members = with.chain(over.is_empty().then(|| family.clone()));
        let seen = members.filter_map(|member| member.accumulation(&self.window));
        match seen.reduce(|one, other| one.or_more(Some(other))) {
            Some(Accumulation { events, runs, of }) => {
                say(format_args!(
                    "events accumulate in {runs} of {of} runs on a grid: runs are told apart up to \
                     event {events}; --max-events chooses another number"
                ));
                family.up_to(events)
            }
            None => family,
        }
    }

    /// The options of an atlas.
    pub fn atlas_options(&self, tolerance: Option<f64>) -> Result<AtlasOptions, Failure> {
        let tolerance = tolerance.unwrap_or(1e-9);
        let most = 1e-3 * self.window.extent().min();
        if !(tolerance > 0.0 && tolerance < most) {
            return Err(Failure::Usage(format!(
                "--tolerance {tolerance}: expected above 0 and below {most}, a thousandth of the \
                 window"
            )));
        }
        Ok(AtlasOptions { tolerance, ..AtlasOptions::default() })
    }
}

/// Reads `name=value`.
pub fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, such as mu=0.4")?;
    let value = number::parse(value)?;
    Ok((name.trim().to_owned(), value))
}

/// Reads a time.
pub fn time(text: &str) -> Result<f64, String> {
    let value = number::parse(text)?;
    if value.is_finite() { Ok(value) } else { Err("expected a finite number".to_owned()) }
}

/// Reads `name=lo:hi`.
pub fn axis(text: &str) -> Result<Axis, String> {
    const EXPECTED: &str = "expected NAME=LO:HI with LO below HI, such as mu=0.1:0.5";
    let (name, range) = text.split_once('=').ok_or(EXPECTED)?;
    let (low, high) = range.split_once(':').ok_or(EXPECTED)?;
    let end = |text| number::parse(text).map_err(|problem| format!("{problem}; {EXPECTED}"));
    let (low, high) = (end(low)?, end(high)?);
    if !(low.is_finite() && high.is_finite() && low < high) {
        return Err(format!("{low} to {high}; {EXPECTED}"));
    }
    Ok(Axis { name: name.trim().to_owned(), range: Range { low, high } })
}
