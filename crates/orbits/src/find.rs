//! Orbits from a guess, and from an orbit at other parameters.

use std::sync::Arc;

use stickslip_expression::{Compiled, InvalidValue, Rule, Runnable, System, Trigger};
use stickslip_solver::{EmbeddedPair, GivenValue, Options, Outcome};

use crate::admissible::{Halfway, verdict};
use crate::equations::{Draft, Equations, Evaluation, clock_values};
use crate::error::OrbitError;
use crate::itinerary::{Leg, modes_after, require_short, rules_named};
use crate::multipliers::multipliers;
use crate::newton::correct;
use crate::orbit::{Orbit, Segment, Verdict};
use crate::watch::OrbitWatch;

/// Steps of the search for the events of a guess.
const GUESS_STEPS: usize = 100_000;
/// The least period, of the largest time of the guess.
const LEAST_PERIOD: f64 = 1e-7;

/// The periodic orbits of a system.
#[derive(Clone, Debug)]
pub struct Orbits {
    pub(crate) system: System,
    pub(crate) compiled: Compiled,
    /// What decides whether the system follows an orbit.
    pub(crate) halfway: Halfway,
    /// The accuracy of flows and runs.
    pub(crate) options: Options,
    /// How far what is searched for is, and whether anybody waits for it.
    pub(crate) watch: Arc<OrbitWatch>,
}

/// Where an orbit is searched for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guess<'a> {
    /// The mode at the start; the first one of the system if it is not given.
    pub mode: Option<usize>,
    /// The time at the start; that of the system if it is not given.
    pub time: Option<f64>,
    /// The state at the start; that of the system if it is not given.
    pub state: Option<&'a [f64]>,
    /// The names of the rules that end the segments, in order.
    pub itinerary: &'a [&'a str],
    /// The durations of the segments. If they are not given, each is up to where its rule acts.
    pub durations: Option<&'a [f64]>,
}

impl Orbits {
    /// The orbits of a system.
    ///
    /// # Errors
    /// [`InvalidValue`] if the parts of the system do not fit together, if its equations jump
    /// within a mode, where derivatives of a smooth flow do not exist, or if what follows an event
    /// is no formula.
    pub fn new(system: &System) -> Result<Self, InvalidValue> {
        let compiled = system.compile()?;
        let accepted = system.slides.is_empty();
        let found =
            GivenValue::Phrase("slides along several surfaces, or those of functions".into());
        InvalidValue::check("the system", found, "modes with one surface at most", accepted)?;
        let expected = "modes, or `sliding on`, in place of `if`, `sign` and `floor` in equations";
        let accepted = !system.branches();
        let found = GivenValue::Phrase("has equations that jump within a mode".into());
        InvalidValue::check("the system", found, expected, accepted)?;
        let options = Options { max_steps: 1_000_000, ..Options::with_tolerance(1e-13) };
        let halfway = Halfway::new(system, &compiled)?;
        let watch = Arc::default();
        Ok(Self { system: system.clone(), compiled, halfway, options, watch })
    }

    /// The same orbits, which say how far they are. What is searched for ends soon, with
    /// [`OrbitError::Stopped`] or incomplete, once the watch is stopped.
    #[must_use]
    pub fn watched(&self, watch: Arc<OrbitWatch>) -> Self {
        Self { watch, ..self.clone() }
    }

    /// How far what is searched for is.
    #[must_use]
    pub fn watch(&self) -> Arc<OrbitWatch> {
        Arc::clone(&self.watch)
    }

    /// Refuses to go on if nobody waits.
    pub(crate) fn require_wanted(&self) -> Result<(), OrbitError> {
        if self.watch.is_stopped() { Err(OrbitError::Stopped) } else { Ok(()) }
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The orbit near a guess: from its start, the rules of the itinerary act one after another,
    /// and other rules are not looked at. Which mode follows a rule that chooses one is as there.
    /// If this round is too far from an orbit, the next one is taken.
    ///
    /// # Errors
    /// [`OrbitError`].
    pub fn find(&self, parameters: &[f64], guess: &Guess<'_>) -> Result<Orbit, OrbitError> {
        let (draft, (s, state)) = self.followed(parameters, guess)?;
        let error = match self.solve(&draft) {
            Err(error) if guess.durations.is_none() => error,
            found => return found,
        };
        let (mode, time) = (Some(draft.legs[0].mode), Some(s));
        let next = Guess { mode, time, state: Some(&state), ..*guess };
        let found = self.followed(parameters, &next).and_then(|(draft, _)| self.solve(&draft));
        found.map_err(|_| error)
    }

    /// The orbit of the same itinerary at other parameters, near enough that the search finds it.
    ///
    /// # Errors
    /// [`OrbitError`].
    pub fn continued(&self, orbit: &Orbit, parameters: &[f64]) -> Result<Orbit, OrbitError> {
        self.compiled.with(parameters)?;
        self.solve(&Draft { parameters: parameters.to_vec(), ..orbit.draft() })
    }

    /// Times and states along an orbit for a smooth curve, each segment in so many parts.
    ///
    /// # Errors
    /// [`OrbitError`]: a segment cannot be computed.
    pub fn course(&self, orbit: &Orbit, parts: usize) -> Result<Vec<(f64, Vec<f64>)>, OrbitError> {
        self.compiled.with(&orbit.parameters)?;
        let draft = orbit.draft();
        let equations = Equations::new(&self.system, draft.clone(), &[], &self.options)?;
        let mut course = Vec::with_capacity((parts + 1) * orbit.segments.len());
        for (i, s) in draft.starts().into_iter().enumerate() {
            for part in 0..=parts {
                let duration = draft.durations[i] * part as f64 / parts.max(1) as f64;
                course.push((s + duration, equations.within(&draft, i, duration)?));
            }
        }
        Ok(course)
    }

    /// The system at the start of a guess.
    pub(crate) fn start(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
    ) -> Result<Runnable, InvalidValue> {
        self.compiled.with(parameters)?.starting(guess.mode, guess.time, guess.state)
    }

    /// Refuses what is not the place of a parameter.
    pub(crate) fn require_parameter(&self, place: usize) -> Result<(), InvalidValue> {
        let count = self.system.parameters.len();
        let expected = format!("the place of one of {count} parameters");
        InvalidValue::check("the parameter", place, expected, place < count)
    }

    /// Refuses a range of a parameter in which its value at an orbit does not lie.
    pub(crate) fn require_range(
        &self,
        orbit: &Orbit,
        place: usize,
        [low, high]: [f64; 2],
    ) -> Result<(), InvalidValue> {
        self.require_parameter(place)?;
        let (name, value) = (&self.system.parameters[place].name, orbit.parameters[place]);
        let ordered = low < high && low.is_finite() && high.is_finite();
        let range = format!("the range of {name}");
        InvalidValue::check(range, [low, high], "LO:HI, finite, with LO < HI", ordered)?;
        let expected = format!("a value in the range {low:?}:{high:?}");
        InvalidValue::check(name.clone(), value, expected, (low..=high).contains(&value))
    }

    /// What the rules of an itinerary do from its start, and when and in which state they end.
    fn followed(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
    ) -> Result<(Draft, (f64, Vec<f64>)), OrbitError> {
        let runnable = self.start(parameters, guess)?;
        let start = runnable.start();
        require_short(guess.itinerary.len(), start.state.len())?;
        if let Some(durations) = guess.durations {
            let (count, expected) = (durations.len(), "one for each rule of the itinerary");
            let accepted = count == guess.itinerary.len();
            InvalidValue::check("the number of durations", count, expected, accepted)?;
        }
        let mut draft = Draft {
            parameters: parameters.to_vec(),
            start: start.s,
            legs: Vec::new(),
            states: Vec::new(),
            durations: Vec::new(),
        };
        let (mut mode, mut s, mut state) = (start.mode, start.s, start.state.to_vec());
        for (segment, name) in guess.itinerary.iter().enumerate() {
            let until = guess.durations.map(|durations| s + durations[segment]);
            let own = rules_named(&self.system, mode, name)?.into_iter().map(|rule| {
                let first = self.first(parameters, segment, (mode, rule), (s, &state), until);
                first.map(|(end, before)| (rule, end, before))
            });
            // Of rules with one name, that which acts first.
            let (rule, end, before) = own.reduce(earlier).unwrap_or_else(|| {
                Err(OrbitError::NoEvent { segment, rule: (*name).to_owned(), steps: 0 })
            })?;
            // The event itself, by the system: its transition alone.
            let leg = Leg { mode, rule, next: mode };
            let event = Equations::event(&self.system, leg, parameters, (end, &before));
            let (above, below) = modes_after(leg.rule(&self.system), mode);
            let next = if event.choice < 0.0 { below } else { above };
            draft.legs.push(Leg { next, ..leg });
            draft.durations.push(end - s);
            draft.states.push(std::mem::replace(&mut state, event.after.as_slice().to_vec()));
            (mode, s) = (next, end);
        }
        let first = draft.legs[0].mode;
        if mode != first {
            let [found, expected] = [mode, first].map(|mode| self.system.modes[mode].name.clone());
            let expected = format!("one that ends in mode {expected}, where it starts");
            let found = GivenValue::Phrase(format!("ends in mode {found}").into());
            return Err(InvalidValue::new("itinerary", found, expected).into());
        }
        Ok((draft, (s, state)))
    }

    /// Where a rule acts first, while others are not looked at; or what is there at a given time.
    fn first(
        &self,
        parameters: &[f64],
        segment: usize,
        (mode, rule): (usize, usize),
        (s, state): (f64, &[f64]),
        until: Option<f64>,
    ) -> Result<(f64, Vec<f64>), OrbitError> {
        let own = &self.system.modes[mode].rules[rule];
        let mut alone = self.system.clone();
        let once = Rule { ends_after: 1, ..Rule::new(own.trigger.clone()) };
        let mut end = f64::INFINITY;
        alone.modes[mode].rules = vec![once];
        if let Some(until) = until {
            end = until;
            alone.modes[mode].rules.clear();
        } else if let Trigger::Every { period, phase } = own.trigger {
            let [period, phase] = clock_values(&self.system, parameters, period, phase)?;
            // A tick at the start is that before.
            end = phase + period * (((s - phase) / period + 1e-9).floor() + 1.0);
            alone.modes[mode].rules.clear();
        }
        let runnable = alone.with(parameters)?.starting(Some(mode), Some(s), Some(state))?;
        let options = Options { max_steps: GUESS_STEPS, ..self.options };
        let run = runnable.events(EmbeddedPair::Dop853, end, &options, &mut Vec::new());
        let run = run.map_err(|error| OrbitError::Run { segment, error })?;
        match run.outcome {
            Outcome::EndedByGuard { .. } => Ok((run.s, run.state)),
            Outcome::ReachedEnd if end.is_finite() => Ok((run.s, run.state)),
            _ => Err(OrbitError::NoEvent { segment, rule: own.name(rule), steps: GUESS_STEPS }),
        }
    }

    /// The orbit near a draft.
    pub(crate) fn solve(&self, draft: &Draft) -> Result<Orbit, OrbitError> {
        self.require_wanted()?;
        let latest = draft.start.abs().max(draft.period().abs());
        let equations = Equations::new(&self.system, draft.clone(), &[], &self.options)?;
        let zero = correct(&equations, &equations.place(draft), &[])?;
        let (found, evaluation) = (equations.draft(&zero.at), equations.at(&zero.at)?);
        let (period, least) = (found.period(), LEAST_PERIOD * latest);
        if period.is_nan() || period <= least {
            return Err(OrbitError::NoLength { period, least });
        }
        self.orbit(&equations, &found, &evaluation, zero.error)
    }

    /// The orbit at a solution of its equations, with its verdict.
    pub(crate) fn orbit(
        &self,
        equations: &Equations,
        draft: &Draft,
        evaluation: &Evaluation,
        error: f64,
    ) -> Result<Orbit, OrbitError> {
        if !equations.repeats(draft, &evaluation.ends) {
            let expected = "a clock whose period is that of what depends on the time";
            let found = format!("repeats after {:?}, and equations do not", draft.period());
            let found = GivenValue::Phrase(found.into());
            return Err(InvalidValue::new("itinerary", found, expected).into());
        }
        self.judged(equations, &Self::sketched(equations, draft, evaluation, error))
    }

    /// The same orbit with its verdict.
    pub(crate) fn judged(&self, equations: &Equations, orbit: &Orbit) -> Result<Orbit, OrbitError> {
        self.require_wanted()?;
        let verdict = verdict(&self.halfway, equations, orbit, &self.options)?;
        Ok(Orbit { verdict, ..orbit.clone() })
    }

    /// The orbit at a solution of its equations, without verdict.
    pub(crate) fn sketched(
        equations: &Equations,
        draft: &Draft,
        evaluation: &Evaluation,
        error: f64,
    ) -> Orbit {
        let ends = &evaluation.ends;
        let monodromy = equations.monodromy(ends);
        let segments = draft.legs.iter().enumerate().map(|(i, &leg)| Segment {
            leg,
            state: draft.states[i].clone(),
            duration: draft.durations[i],
            end: ends[i].flown.state.clone(),
            rate: ends[i].event.rate(),
        });
        Orbit {
            parameters: draft.parameters.clone(),
            start: draft.start,
            segments: segments.collect(),
            period: draft.period(),
            multipliers: monodromy.and_then(|(it, trivial)| multipliers(&it, trivial.as_ref())),
            verdict: Verdict::Undecided("not looked at".to_owned()),
            error,
        }
    }
}

/// A rule, with when and in which state it acts.
type Acted = Result<(usize, f64, Vec<f64>), OrbitError>;

/// Which of two rules acts earlier.
fn earlier(one: Acted, other: Acted) -> Acted {
    match (&one, &other) {
        (Ok((_, s, _)), Ok((_, other_s, _))) if other_s < s => other,
        (Err(_), Ok(_)) => other,
        _ => one,
    }
}

impl Orbit {
    pub(crate) fn draft(&self) -> Draft {
        Draft {
            parameters: self.parameters.clone(),
            start: self.start,
            legs: self.segments.iter().map(|it| it.leg).collect(),
            states: self.segments.iter().map(|it| it.state.clone()).collect(),
            durations: self.segments.iter().map(|it| it.duration).collect(),
        }
    }
}
