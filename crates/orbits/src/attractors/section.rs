//! Poincaré maps as data, and bifurcation diagrams by brute force.

use stickslip_expression::{InvalidValue, Runnable};
use stickslip_solver::dynamic::{DynamicRun, DynamicSwitch, run_dynamic_with};
use stickslip_solver::{EmbeddedPair, Outcome, RunError};

use super::{Switches, coarse, require_end, require_skip};
use crate::error::OrbitError;
use crate::find::{Guess, Orbits};
use crate::settle::require_time;
use crate::watch::Watched;

/// Which events of a run are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section<'a> {
    /// The name of a rule, in any mode.
    pub rule: &'a str,
    /// The time before the first one.
    pub skip: f64,
    /// The time in which they are looked at.
    pub time: f64,
}

/// A point on a section.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionPoint {
    /// The time.
    pub s: f64,
    /// The state before the rule acts.
    pub state: Vec<f64>,
}

/// The points on a section at one value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The value.
    pub value: f64,
    /// The points.
    pub points: Vec<SectionPoint>,
    /// Why the run did not come to its end. The next one begins as the first one then.
    pub trouble: Option<String>,
}

impl Orbits {
    /// The points at which a run from the start of the guess reaches a section. Its itinerary is
    /// not used. Errors of a step are less than 1e-10; where orbits are unstable, they grow.
    ///
    /// # Errors
    /// [`OrbitError`]: there is no such rule, or the run does not come to its end.
    pub fn section(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
        section: &Section<'_>,
    ) -> Result<Vec<SectionPoint>, OrbitError> {
        let places = self.places(section)?;
        let runnable = self.start(parameters, guess)?;
        let mut points = Vec::new();
        let start = runnable.start().s;
        let watched = Watched::over(&self.watch, [start, start + section.skip + section.time]);
        let run = self.reach(&runnable, section, (&places, watched), &mut points);
        let run = run.map_err(|error| OrbitError::Run { segment: 0, error })?;
        require_end(run.outcome, run.s)?;
        Ok(points)
    }

    /// The points on a section over a parameter, upwards and downwards: each run begins where the
    /// one before it ended, so that the two differ where there are several attractors. They are
    /// computed side by side.
    ///
    /// # Errors
    /// [`OrbitError`]: there is no such rule, or a value cannot be used.
    pub fn diagram(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
        (parameter, values): (usize, &[f64]),
        section: &Section<'_>,
    ) -> Result<[Vec<Column>; 2], OrbitError> {
        let places = self.places(section)?;
        self.require_parameter(parameter)?;
        self.watch.begin(2 * values.len());
        let chain = |values: &mut dyn Iterator<Item = f64>| {
            let (mut parameters, mut columns) = (parameters.to_vec(), Vec::new());
            let mut last: Option<DynamicRun<usize>> = None;
            for value in values {
                self.require_wanted()?;
                if let Some(own) = parameters.get_mut(parameter) {
                    *own = value;
                }
                let runnable = match &last {
                    None => self.start(&parameters, guess)?,
                    Some(run) => self.halfway.starting(&parameters, run.mode, run.s, &run.state)?,
                };
                let mut points = Vec::new();
                let run = self.reach(
                    &runnable,
                    section,
                    (&places, Watched::one(&self.watch)),
                    &mut points,
                );
                self.watch.advance(1);
                let (run, trouble) = match run {
                    Ok(run) if run.outcome == Outcome::ReachedEnd => (Some(run), None),
                    Ok(run) => {
                        let ends = OrbitError::Ends { outcome: run.outcome, s: run.s };
                        (None, Some(ends.to_string()))
                    }
                    Err(error) => (None, Some(self.system.explained(&error))),
                };
                last = run;
                columns.push(Column { value, points, trouble });
            }
            Ok::<_, OrbitError>(columns)
        };
        let up = || chain(&mut values.iter().copied());
        let down = || chain(&mut values.iter().rev().copied());
        let (up, down) = rayon::join(up, down);
        Ok([up?, down?])
    }

    /// The modes and places of the rules of a section.
    fn places(&self, section: &Section<'_>) -> Result<Vec<(usize, usize)>, InvalidValue> {
        require_skip(section.skip)?;
        require_time("the time on the section", section.time)?;
        let all = self.system.modes.iter().enumerate().flat_map(|(mode, it)| {
            let named = it.rules.iter().enumerate();
            named.map(move |(place, rule)| ((mode, place), rule.name(place)))
        });
        let all: Vec<_> = all.collect();
        let own = all.iter().filter(|(_, name)| name == section.rule);
        let own: Vec<_> = own.map(|(place, _)| *place).collect();
        let mut known: Vec<&str> = all.iter().map(|(_, name)| name.as_str()).collect();
        known.sort_unstable();
        known.dedup();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let expected = format!("a rule of the system, which has {known}");
        InvalidValue::check("the section", section.rule, expected, !own.is_empty())?;
        Ok(own)
    }

    /// Runs a system past a section, and appends the points there.
    fn reach(
        &self,
        runnable: &Runnable,
        section: &Section<'_>,
        (places, watched): (&[(usize, usize)], Watched<'_>),
        points: &mut Vec<SectionPoint>,
    ) -> Result<DynamicRun<usize>, RunError> {
        let (mut found, modes) = (Switches::from(watched), self.system.modes.len());
        let start = runnable.start();
        let from = start.s + section.skip;
        let (pair, end) = (EmbeddedPair::Dop853, from + section.time);
        let run = run_dynamic_with(pair, runnable, start, end, &coarse(), &mut found);
        let is_own = |event: &DynamicSwitch<usize>| {
            let own = |guard: &usize| places.contains(&(event.from % modes, *guard));
            // An event that changes nothing is also that of the rules which vanish with it.
            let alone = event.from != event.to || event.before != event.after;
            own(&event.guard) || !alone && event.simultaneous.iter().any(own)
        };
        let own = found.events.into_iter().filter(|event| event.s >= from && is_own(event));
        points.extend(own.map(|event| SectionPoint { s: event.s, state: event.before }));
        run.map(|run| DynamicRun { mode: run.mode % modes, ..run })
    }
}
