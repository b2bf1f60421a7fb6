//! How changes of the structure are isolated between two values of the third parameter.

use crate::atlas::AtlasOf;
use crate::family::Family;
use crate::stack::candidates::candidates;
use crate::stack::change::Change;
use crate::stack::meeting::{Box3, Meeting, solve};
use crate::stack::structure::Structure;
use crate::stack::{StackError, StackOptions};
use crate::window::Window;
use crate::{Atlas, AtlasError, TraceError};

/// An atlas at a value of the third parameter, with its structure.
pub(super) struct Sample<F: Family> {
    pub value: f64,
    pub atlas: AtlasOf<F>,
    pub structure: Structure<F::Label>,
}

/// A change, and the structure behind it.
type Found<F> = (Change<<F as Family>::Label>, Structure<<F as Family>::Label>);

type Searched<T, F> = Result<T, StackError<<F as Family>::Error>>;

/// The atlas beside a meeting.
enum Beside<F: Family> {
    /// That at the end of the interval.
    End,
    /// One inside the interval.
    Between(Box<Sample<F>>),
    /// One that is in doubt.
    Doubtful,
}

impl<F: Family> Beside<F> {
    /// The atlas, unless it is in doubt.
    fn or<'a>(&'a self, end: &'a Sample<F>) -> Option<&'a Sample<F>> {
        match self {
            Self::End => Some(end),
            Self::Between(sample) => Some(sample),
            Self::Doubtful => None,
        }
    }
}

/// A search for changes.
pub(super) struct Search<'a, F: Family, At> {
    family: &'a At,
    window: Window,
    options: StackOptions,
    count: usize,
    found: Vec<Found<F>>,
    /// Values that were solved for and at which the structure does not change.
    refuted: Vec<f64>,
}

impl<'a, F: Family, At: Fn(f64) -> F> Search<'a, F, At> {
    pub fn new(family: &'a At, window: Window, options: StackOptions) -> Self {
        Self { family, window, options, count: 0, found: Vec::new(), refuted: Vec::new() }
    }

    /// The number of atlases so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The atlas at a value.
    pub fn sample(&mut self, value: f64) -> Searched<Sample<F>, F> {
        self.count += 1;
        let family = (self.family)(value);
        let at = StackError::at(value);
        let atlas = Atlas::of(&family, &self.window, &self.options.atlas).map_err(&at)?;
        let structure = Structure::of(&atlas.plane, &family).map_err(|source| {
            // The error of a run has its place.
            let point = self.window.low;
            at(AtlasError::Trace(TraceError::Run { point, source }))
        })?;
        Ok(Sample { value, atlas, structure })
    }

    /// The width of a bracket that is narrow enough, around a value.
    fn width(&self, low: f64, high: f64) -> f64 {
        self.options.width * low.abs().max(high.abs())
    }

    /// Finds the changes between two atlases that agree.
    pub fn refine(&mut self, low: &Sample<F>, high: &Sample<F>) -> Searched<(), F> {
        let Some(differing) = low.structure.differing(&high.structure) else { return Ok(()) };
        if high.value - low.value <= self.width(low.value, high.value) {
            self.push([low, high], None, false);
            return Ok(());
        }
        for meeting in self.meetings([low, high], &differing) {
            if self.isolated(low, high, &meeting)? {
                return Ok(());
            }
            self.refuted.push(meeting.value);
        }
        self.bisect(low, high)
    }

    /// Where points may meet between two atlases, each value once.
    fn meetings(&self, ends: [&Sample<F>; 2], differing: &[Vec<usize>; 2]) -> Vec<Meeting> {
        /// The number of candidates of each atlas that are tried, and of solutions.
        const TRIED: usize = 60;
        const SOLVED: usize = 4;
        let values = ends.map(|sample| sample.value);
        let within = Box3 { window: self.window, values };
        let near = self.width(values[0], values[1]);
        let mut tried = Vec::new();
        let mut meetings: Vec<Meeting> = Vec::new();
        for (sample, regions) in ends.into_iter().zip(differing) {
            for candidate in candidates(sample, regions).into_iter().take(TRIED) {
                if tried.contains(&(candidate.conditions.clone(), sample.value)) {
                    continue;
                }
                let guess = (candidate.guess, sample.value);
                let found = solve(self.family, candidate.conditions.clone(), guess, &within);
                tried.push((candidate.conditions, sample.value));
                let known = |value: f64| {
                    let is_near = |other: f64| (other - value).abs() < near;
                    self.refuted.iter().any(|&other| is_near(other))
                        || meetings.iter().any(|other| is_near(other.value))
                };
                if let Some(meeting) = found.filter(|meeting| !known(meeting.value)) {
                    meetings.push(meeting);
                }
                if meetings.len() == SOLVED {
                    return meetings;
                }
            }
        }
        meetings
    }

    /// Whether the structure changes at a meeting between two atlases. If so, the change is added,
    /// and the rest on both of its sides is searched.
    fn isolated(
        &mut self,
        low: &Sample<F>,
        high: &Sample<F>,
        meeting: &Meeting,
    ) -> Searched<bool, F> {
        let mut reach = 0.5 * self.width(low.value, high.value);
        for _ in 0..3 {
            let below = self.beside(meeting.value - reach, [low, high])?;
            let above = self.beside(meeting.value + reach, [low, high])?;
            if let (Some(below), Some(above)) = (below.or(low), above.or(high))
                && below.structure.differing(&above.structure).is_some()
            {
                self.refine(low, below)?;
                self.push([below, above], Some(*meeting), false);
                self.refine(above, high)?;
                return Ok(true);
            }
            reach *= 10.0;
        }
        Ok(false)
    }

    /// The atlas at a value beside a meeting.
    fn beside(&mut self, value: f64, ends: [&Sample<F>; 2]) -> Searched<Beside<F>, F> {
        if value <= ends[0].value || value >= ends[1].value {
            return Ok(Beside::End);
        }
        if self.count >= self.options.atlases {
            return Ok(Beside::Doubtful);
        }
        let sample = self.sample(value)?;
        Ok(if sample.atlas.agrees() { Beside::Between(Box::new(sample)) } else { Beside::Doubtful })
    }

    /// Divides the search at an atlas between the two that agrees.
    fn bisect(&mut self, low: &Sample<F>, high: &Sample<F>) -> Searched<(), F> {
        /// Where the atlas may be, as parts of the interval.
        const PLACES: [f64; 4] = [0.5, 0.4, 0.65, 0.25];
        for part in PLACES {
            if self.count >= self.options.atlases {
                break;
            }
            let middle = self.sample(low.value + part * (high.value - low.value))?;
            if middle.atlas.agrees() {
                self.refine(low, &middle)?;
                return self.refine(&middle, high);
            }
        }
        self.push([low, high], None, true);
        Ok(())
    }

    fn push(&mut self, ends: [&Sample<F>; 2], meeting: Option<Meeting>, doubtful: bool) {
        let change = Change::new(ends, meeting, doubtful);
        self.found.push((change, ends[1].structure.clone()));
    }

    /// The changes found, in order, with the structure behind each. Brackets that almost touch each
    /// other are one, in doubt, unless both are solved for: there the structure changes in steps that
    /// are too small to tell one change from several.
    pub fn joined(self) -> Vec<Found<F>> {
        /// The greatest gap between brackets that are joined, in widths.
        const GAP: f64 = 10.0;
        let mut joined: Vec<Found<F>> = Vec::new();
        for (change, behind) in self.found {
            if let Some((last, structure)) = joined.last_mut()
                && (last.meeting.is_none() || change.meeting.is_none())
                && change.between[0] - last.between[1]
                    <= GAP * self.options.width * change.between[1].abs()
            {
                last.join(change);
                *structure = behind;
            } else {
                joined.push((change, behind));
            }
        }
        joined
    }
}
