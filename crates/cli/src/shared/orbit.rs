//! Where an orbit of a system is searched for.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use stickslip_expression::System;
use stickslip_files::input::{json, number, source};
use stickslip_orbits::document::{
    BRANCH, BranchRecord, Document, ORBIT, OrbitRecord, SpecialRecord,
};
use stickslip_orbits::{Branch, Guess, Orbit, OrbitError, Orbits};
use stickslip_plane::sealed;

use super::files::Named;
use super::system::{place as parameter, read, setting, time, title, values};
use crate::error::Failure;
use crate::output::progress::Bar;

/// A system, and where its runs start.
#[derive(Debug, clap::Args)]
pub struct StartArguments {
    /// The system, a text as docs/systems.md describes it; - is standard input
    #[arg(value_name = "SYSTEM.slip")]
    pub system: PathBuf,

    /// The value of a parameter; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "System")]
    pub set: Vec<(String, f64)>,

    /// The value of a component at the start, instead of that of the system; may be repeated
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "System")]
    pub start: Vec<(String, f64)>,

    /// The mode at the start, instead of that of the system
    #[arg(long, value_name = "MODE", help_heading = "System")]
    pub mode: Option<String>,

    /// The time at the start, instead of that of the system
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "System")]
    pub time: Option<f64>,
}

/// The orbit of a system.
#[derive(Debug, clap::Args)]
pub struct GuessArguments {
    /// The system, and where the orbit starts about.
    #[command(flatten)]
    pub from: StartArguments,

    /// The rules that end the segments of the orbit, in order
    #[arg(long, value_name = "RULE,RULE,…", value_delimiter = ',', help_heading = "Guess")]
    #[arg(required_unless_present_any = ["settle", "near"])]
    pub itinerary: Vec<String>,

    /// The orbit to which a run has settled after this time, instead of --itinerary
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    #[arg(help_heading = "Guess", conflicts_with = "itinerary")]
    pub settle: Option<f64>,

    /// The orbit near that of a file of `orbit`, or near the last one of a file of `branch`,
    /// instead of --itinerary; parameters that are not set are those of the file
    #[arg(long, value_name = "FILE.json", help_heading = "Guess")]
    #[arg(conflicts_with_all = ["itinerary", "settle", "start", "mode", "time", "durations"])]
    pub near: Option<PathBuf>,

    /// Of a branch in the file of --near: the orbit of twice the period that begins at a flip, or
    /// an orbit of the other branch at a branch-point; the first of the kind, or the N-th with
    /// KIND:N
    #[arg(long, value_name = "KIND[:N]", help_heading = "Guess", requires = "near")]
    #[arg(conflicts_with_all = ["itinerary", "settle", "set"])]
    pub switch: Option<String>,

    /// The durations of the segments; otherwise each is up to where its rule acts
    #[arg(long, value_name = "T,T,…", value_delimiter = ',', value_parser = number::parse_option)]
    #[arg(help_heading = "Guess", conflicts_with = "settle", allow_hyphen_values = true)]
    pub durations: Option<Vec<f64>>,
}

/// What is read of a file of orbits.
#[derive(Deserialize)]
struct Written {
    schema: String,
    orbit: Option<OrbitRecord>,
    points: Option<Vec<OrbitRecord>>,
    parameter: Option<String>,
    #[serde(default)]
    specials: Vec<SpecialRecord>,
}

/// How far from a special orbit another branch is entered.
const ASIDE: f64 = 0.05;
/// Largest number of bytes of a file.
const MOST_BYTES: u64 = 1 << 30;

/// A system with the start of its runs.
#[derive(Debug)]
pub struct StartedSystem {
    /// The name of the system in titles.
    pub name: String,
    /// The orbits of the system.
    pub orbits: Orbits,
    /// The values of its parameters.
    pub parameters: Vec<f64>,
    mode: Option<usize>,
    time: Option<f64>,
    state: Option<Vec<f64>>,
}

/// An orbit that was found, with its system.
#[derive(Debug)]
pub struct FoundOrbit {
    /// The name of the system in titles.
    pub name: String,
    /// The orbits of the system.
    pub orbits: Orbits,
    /// The orbit.
    pub orbit: Orbit,
}

impl StartedSystem {
    /// The start, as a guess without an itinerary.
    pub fn guess(&self) -> Guess<'_> {
        let Self { mode, time, ref state, .. } = *self;
        Guess { mode, time, state: state.as_deref(), ..Guess::default() }
    }
}

impl StartArguments {
    /// Reads the system.
    ///
    /// # Errors
    /// [`Failure`]: it cannot be read, or options do not fit it.
    pub fn read(&self) -> Result<StartedSystem, Failure> {
        let (system, _) = read(&self.system)?;
        let parameters = values(&system, &self.set)?;
        let mode = self.mode.as_deref().map(|name| place(&system, name)).transpose()?;
        let orbits = Orbits::new(&system).map_err(|error| Failure::Usage(error.to_string()))?;
        let state = self.state(&system, &parameters)?;
        let (name, time) = (title(&self.system), self.time);
        Ok(StartedSystem { name, orbits, parameters, mode, time, state })
    }

    /// The state at the start, if some component has another value than the system says.
    fn state(&self, system: &System, parameters: &[f64]) -> Result<Option<Vec<f64>>, Failure> {
        if self.start.is_empty() {
            return Ok(None);
        }
        let runnable =
            system.with(parameters).map_err(|error| Failure::Usage(error.to_string()))?;
        let mut state = runnable.start().state.to_vec();
        for (name, value) in &self.start {
            state[component(system, "--start", name)?] = *value;
        }
        Ok(Some(state))
    }
}

impl GuessArguments {
    /// The files that are read.
    pub fn inputs(&self) -> [Named<'_>; 2] {
        [("the system", Some(&*self.from.system)), ("--near", self.near.as_deref())]
    }

    /// Finds the orbit.
    ///
    /// # Errors
    /// [`Failure`]: the system cannot be read, options do not fit it, or there is no orbit.
    pub fn find(&self) -> Result<FoundOrbit, Failure> {
        if let Some(path) = &self.near {
            return self.near(path);
        }
        let started = self.from.read()?;
        let itinerary: Vec<&str> = self.itinerary.iter().map(String::as_str).collect();
        let (itinerary, durations) = (&itinerary[..], self.durations.as_deref());
        let guess = Guess { itinerary, durations, ..started.guess() };
        let _bar = Bar::watching(started.orbits.watch());
        let orbit = match self.settle {
            Some(time) => started.orbits.settled(&started.parameters, &guess, time),
            None => started.orbits.find(&started.parameters, &guess),
        };
        let orbit = orbit.map_err(failure)?;
        Ok(FoundOrbit { name: started.name, orbits: started.orbits, orbit })
    }

    /// The branch in the file of --near, with its system and its last orbit.
    ///
    /// # Errors
    /// [`Failure`]: the system or the branch cannot be read, or the branch is not of the system.
    pub fn branch(&self, path: &Path) -> Result<(FoundOrbit, Branch), Failure> {
        let (orbits, name) = self.system()?;
        let written: Document<BranchRecord> = document(path)?;
        let unusable = |error: OrbitError| Failure::input(source::shown(path), error);
        let branch = written.branch(&orbits).map_err(unusable)?;
        let orbit = branch.points[branch.points.len() - 1].clone();
        Ok((FoundOrbit { name, orbits, orbit }, branch))
    }

    /// The orbits of the system, and its name.
    fn system(&self) -> Result<(Orbits, String), Failure> {
        let (system, _) = read(&self.from.system)?;
        let orbits = Orbits::new(&system).map_err(|error| Failure::Usage(error.to_string()))?;
        Ok((orbits, title(&self.from.system)))
    }

    /// The orbit near that of a file.
    fn near(&self, path: &Path) -> Result<FoundOrbit, Failure> {
        let (orbits, name) = self.system()?;
        let system = orbits.system();
        let written: Written = document(path)?;
        let unusable = |reason: String| Failure::input(source::shown(path), reason);
        if let Some(kind) = &self.switch {
            let (BRANCH, Some(points), Some(over)) =
                (&*written.schema, &written.points, &written.parameter)
            else {
                return Err(unusable(format!("expected a branch in the layout {BRANCH:?}")));
            };
            let record = special(&written.specials, "--switch", kind)?;
            let beside = points.get(record.behind.saturating_sub(1));
            let beside = beside.ok_or_else(|| unusable("has no orbit beside it".to_owned()))?;
            let known = record.special(&orbits).map_err(|error| unusable(error.to_string()))?;
            let beside = beside.orbit(&orbits).map_err(failure)?;
            let over = parameter(system, "--near", over)?;
            let orbit = orbits.switched(&known, &beside, over, ASIDE).map_err(failure)?;
            return Ok(FoundOrbit { name, orbits, orbit });
        }
        let record = match (&*written.schema, written.orbit, written.points) {
            (ORBIT, Some(orbit), _) => Some(orbit),
            (BRANCH, _, Some(mut points)) => points.pop(),
            _ => None,
        };
        let expected = format!("expected an orbit in the layout {ORBIT:?} or {BRANCH:?}");
        let record = record.ok_or_else(|| unusable(expected))?;
        let orbit = record.orbit(&orbits).map_err(failure)?;
        let mut parameters = orbit.parameters.clone();
        for (name, value) in &self.from.set {
            parameters[parameter(system, "--set", name)?] = *value;
        }
        let orbit = orbits.continued(&orbit, &parameters).map_err(failure)?;
        Ok(FoundOrbit { name, orbits, orbit })
    }
}

/// Reads a document of orbits.
///
/// # Errors
/// [`Failure`]: it cannot be read, or has changed since it was written.
pub fn document<T: DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let unusable = |reason: String| Failure::input(source::shown(path), reason);
    let text = source::read(path, MOST_BYTES)?;
    sealed::check(&text).map_err(|damaged| unusable(damaged.to_string()))?;
    json::parse(&text).map_err(unusable)
}

/// The special orbit that an option names: the first one of a kind, or the N-th.
///
/// # Errors
/// [`Failure::Usage`]: there is none.
pub fn special<'a>(
    specials: &'a [SpecialRecord],
    option: &str,
    given: &str,
) -> Result<&'a SpecialRecord, Failure> {
    let (kind, wanted) = given.split_once(':').unwrap_or((given, "1"));
    let count = wanted.parse::<usize>().ok().and_then(|count| count.checked_sub(1));
    let mut found = specials.iter().filter(|it| it.kind.name() == kind);
    count.and_then(|count| found.nth(count)).ok_or_else(|| {
        let known: Vec<_> = specials.iter().map(|it| it.kind.name()).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        Failure::Usage(format!("{option} {given}: expected one of the branch: {known}"))
    })
}

/// Why there is no orbit, as the program says it.
pub fn failure(error: OrbitError) -> Failure {
    match error {
        OrbitError::Value(error) => Failure::Usage(error.to_string()),
        error => Failure::Orbit(error),
    }
}

/// The place of a mode.
fn place(system: &System, name: &str) -> Result<usize, Failure> {
    let place = system.modes.iter().position(|it| it.name == *name);
    place.ok_or_else(|| {
        let names: Vec<_> = system.modes.iter().map(|it| it.name.as_str()).collect();
        Failure::Usage(format!("--mode {name}: expected one of {}", names.join(", ")))
    })
}

/// The place of a component.
///
/// # Errors
/// [`Failure::Usage`]: there is no such component.
pub fn component(system: &System, option: &str, name: &str) -> Result<usize, Failure> {
    let place = system.components.iter().position(|it| it.name == *name);
    place.ok_or_else(|| {
        let names: Vec<_> = system.components.iter().map(|it| it.name.as_str()).collect();
        Failure::Usage(format!("{option} {name}: the state has {}", names.join(", ")))
    })
}
