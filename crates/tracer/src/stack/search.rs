//! How changes of the structure are isolated between two values of the third parameter.
//!
//! Atlases close to a meeting do not show it. Beside a swallowtail, for example, the region between
//! the cusps has a length with the power 3/2 of the distance and a width with its square; closer
//! than some 1e-5 of the parameter it is not seen. So a change is first looked for in a bracket as
//! narrow as the options ask, and if atlases do not differ there, 10 and 100 times as far from the
//! meeting. Narrow brackets come first, and only meetings between the two atlases count: what is
//! solved for close to a change need not be its cause.
//!
//! A small region that dies in a bracket dies at a solution close behind it, if the atlases beside
//! that solution have the structure of the bracket's end. A birth is the other way round.

use std::cell::Cell;

use crate::TraceError;
use crate::executor::Executor;
use crate::family::Family;
use crate::lengths::Lengths;
use crate::lengths::of_stack::{FAR, GAP, NARROW, UNSEEN};
use crate::regions::region::Region;
use crate::stack::StackOptions;
use crate::stack::candidates::candidates;
use crate::stack::change::{Change, Effect};
use crate::stack::meeting::{Box3, Solved, StackMeeting, solve, touching};
use crate::stack::structure::{Sample, Structure};
use crate::survey::Surveyor;
use crate::watch::{Progress, Watch};
use crate::window::Window;

/// A change, and the structure behind it.
type LocatedChange<F> = (Change<<F as Family>::Label>, Structure<<F as Family>::Label>);

type Searched<T, F> = Result<T, TraceError<<F as Family>::Error>>;

/// The atlas beside a meeting.
enum Beside<F: Family> {
    /// The atlas at the end of the interval.
    End,
    /// An atlas inside the interval.
    Between(Box<Sample<F>>),
    /// An atlas that is in doubt.
    Doubtful,
    /// No atlas: their greatest number is reached, or the watch cancels.
    Refused,
}

impl<F: Family> Beside<F> {
    /// The atlas, unless it is in doubt.
    fn or<'a>(&'a self, end: &'a Sample<F>) -> Option<&'a Sample<F>> {
        match self {
            Self::End => Some(end),
            Self::Between(sample) => Some(sample),
            Self::Doubtful | Self::Refused => None,
        }
    }
}

/// A search for changes.
pub(super) struct Search<'a, F: Family, At, E> {
    family: &'a At,
    window: Window,
    options: StackOptions,
    surveyor: Surveyor<'a, E>,
    watch: Watch<'a>,
    /// The first value and the last one.
    range: [f64; 2],
    count: usize,
    cancelled: Cell<bool>,
    found: Vec<LocatedChange<F>>,
    /// The meetings at which the structure does not change.
    tried: Vec<Tried<F::Label>>,
}

/// A meeting at which the structure does not change, according to the atlases within reach.
struct Tried<Label> {
    meeting: StackMeeting,
    reach: Reach,
    /// The values of atlases on both sides that are not in doubt, and their structure.
    around: Option<([f64; 2], Structure<Label>)>,
}

/// How far from a meeting the atlases may be that differ.
#[derive(Clone, Copy, PartialEq)]
enum Reach {
    /// As close as the width of a bracket.
    Close,
    /// Farther: closer atlases are in doubt, or regions are too small there to be seen.
    Far,
}

impl<'a, F: Family, At: Fn(f64) -> F, E: Executor<F>> Search<'a, F, At, E> {
    pub fn new(
        family: &'a At,
        window: Window,
        options: StackOptions,
        surveyor: Surveyor<'a, E>,
        watch: Watch<'a>,
        range: [f64; 2],
    ) -> Self {
        Self {
            family,
            window,
            options,
            surveyor,
            watch,
            range,
            count: 0,
            cancelled: Cell::new(false),
            found: Vec::new(),
            tried: Vec::new(),
        }
    }

    /// The number of atlases so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether the watch has cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.set(self.cancelled.get() || self.watch.is_cancelled());
        self.cancelled.get()
    }

    /// Whether the search came to its end.
    pub fn is_finished(&self) -> bool {
        !self.cancelled.get()
    }

    /// The atlas at a value.
    pub fn sample(&mut self, value: f64) -> Searched<Sample<F>, F> {
        self.count += 1;
        let family = (self.family)(value);
        let at = |source| TraceError::Layer { value, source: Box::new(source) };
        let atlas = self.surveyor.atlas(&family, &self.window).map_err(at)?;
        self.cancelled.set(self.cancelled.get() || !atlas.is_finished());
        let structure = Structure::of(&atlas.plane, &family).map_err(|source| {
            // The error of a run has its place.
            let point = self.window.low;
            at(TraceError::Run { point, source })
        })?;
        Ok(Sample { value, atlas, structure })
    }

    /// The atlas at a value between two others.
    fn between(&mut self, value: f64) -> Searched<Beside<F>, F> {
        if self.count >= self.options.atlases || self.is_cancelled() {
            return Ok(Beside::Refused);
        }
        self.watch.report(Progress::Begin { steps: 1 });
        let sample = self.sample(value)?;
        if !sample.atlas.is_finished() {
            return Ok(Beside::Refused);
        }
        self.watch.report(Progress::Advance { steps: 1 });
        let agrees = sample.atlas.agrees();
        Ok(if agrees { Beside::Between(Box::new(sample)) } else { Beside::Doubtful })
    }

    /// The width of a bracket that is narrow enough, around a value.
    fn width(&self, low: f64, high: f64) -> f64 {
        let width = self.options.width * low.abs().max(high.abs());
        if low <= 0.0 && 0.0 <= high {
            width.max(Lengths::PARTS.least * (self.range[1] - self.range[0]))
        } else {
            width
        }
    }

    /// Finds the changes between two atlases that agree.
    pub fn refine(&mut self, low: &Sample<F>, high: &Sample<F>) -> Searched<(), F> {
        let Some(differing) = low.structure.differing(&high.structure) else { return Ok(()) };
        if high.value - low.value <= self.width(low.value, high.value) {
            let mut change = Change::new([low, high], None, false);
            change.meeting = self.enclosed([low, high], &differing);
            if change.meeting.is_none()
                && let Some((meeting, between)) =
                    self.unseen(low, high, &change.effects, &differing)
            {
                (change.meeting, change.between) = (Some(meeting), between);
            }
            self.found.push((change, high.structure.clone()));
            return Ok(());
        }
        if self.is_cancelled() {
            self.push([low, high], None, true);
            return Ok(());
        }
        if self.solved(low, high, &differing, Reach::Close)? {
            return Ok(());
        }
        self.bisect(low, high, &differing)
    }

    /// Whether a change between two atlases is solved for. Then all changes between them are added.
    fn solved(
        &mut self,
        low: &Sample<F>,
        high: &Sample<F>,
        differing: &[Vec<usize>; 2],
        reach: Reach,
    ) -> Searched<bool, F> {
        let between = [low.value, high.value];
        for meeting in self.meetings([low, high], differing, between, reach) {
            if self.isolated(low, high, &meeting, reach)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Where points of two atlases may meet between two values, each value once.
    fn meetings(
        &self,
        ends: [&Sample<F>; 2],
        differing: &[Vec<usize>; 2],
        values: [f64; 2],
        reach: Reach,
    ) -> Vec<StackMeeting> {
        /// The number of candidates of each atlas that are tried, and of solutions.
        const TRIED: usize = 60;
        const SOLVED: usize = 4;
        let within = Box3 { window: self.window, values };
        let near = self.width(values[0], values[1]);
        let (mut tried, mut vague) = (Vec::new(), Vec::new());
        let mut meetings: Vec<StackMeeting> = Vec::new();
        let tried_before = |tried: &&Tried<_>| reach == Reach::Close || tried.reach == Reach::Far;
        let mut add = |found: StackMeeting| {
            let is_near = |other: f64| (other - found.value).abs() < near;
            let mut before = self.tried.iter().filter(tried_before);
            let known = before.any(|tried| is_near(tried.meeting.value))
                || meetings.iter().any(|other| is_near(other.value));
            if !known {
                meetings.push(found);
            }
            meetings.len() == SOLVED
        };
        for (sample, regions) in ends.into_iter().zip(differing) {
            let here = (self.family)(sample.value);
            for candidate in candidates(&here, sample, regions).into_iter().take(TRIED) {
                if self.is_cancelled() {
                    return Vec::new();
                }
                if tried.contains(&(candidate.conditions.clone(), sample.value)) {
                    continue;
                }
                let guess = (candidate.guess, sample.value);
                let found = solve(self.family, candidate.conditions.clone(), guess, &within);
                tried.push((candidate.conditions, sample.value));
                let enough = match found {
                    Some(Solved::Sure(meeting)) => add(meeting),
                    Some(Solved::Vague(place)) => {
                        vague.push(place);
                        false
                    }
                    None => false,
                };
                if enough {
                    return meetings;
                }
            }
        }
        for place in vague {
            if self.is_cancelled() {
                return Vec::new();
            }
            if touching(self.family, &place, &within).is_some_and(&mut add) {
                break;
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
        meeting: &StackMeeting,
        reach: Reach,
    ) -> Searched<bool, F> {
        let widths: &[f64] = match reach {
            Reach::Close => &[0.5],
            Reach::Far => &FAR,
        };
        let mut around = None;
        // A value may be 0.
        let least = Lengths::PARTS.beyond * (high.value - low.value);
        let width = self.options.width * meeting.value.abs().max(least);
        for part in widths {
            let below = self.beside(meeting.value - part * width, [low, high])?;
            let above = self.beside(meeting.value + part * width, [low, high])?;
            if matches!(below, Beside::Refused) || matches!(above, Beside::Refused) {
                return Ok(false);
            }
            let (Some(below), Some(above)) = (below.or(low), above.or(high)) else { continue };
            if below.structure.differing(&above.structure).is_some() {
                self.refine(low, below)?;
                self.push([below, above], Some(*meeting), false);
                self.refine(above, high)?;
                return Ok(true);
            }
            around.get_or_insert_with(|| {
                let between = [below.value, above.value];
                (between, below.structure.clone())
            });
        }
        self.tried.push(Tried { meeting: *meeting, reach, around });
        Ok(false)
    }

    /// The atlas at a value beside a meeting.
    fn beside(&mut self, value: f64, ends: [&Sample<F>; 2]) -> Searched<Beside<F>, F> {
        if value <= ends[0].value || value >= ends[1].value {
            return Ok(Beside::End);
        }
        self.between(value)
    }

    /// Divides the search at an atlas between the two that agrees. If that atlas is about as close
    /// to both as atlases may be to a meeting, or if there is no such atlas, meetings are searched
    /// for up to there.
    fn bisect(
        &mut self,
        low: &Sample<F>,
        high: &Sample<F>,
        differing: &[Vec<usize>; 2],
    ) -> Searched<(), F> {
        /// Where the atlas may be, as parts of the interval.
        const PLACES: [f64; 4] = [0.5, 0.4, 0.65, 0.25];
        let width = self.width(low.value, high.value);
        let narrow = high.value - low.value <= NARROW * width;
        if narrow && self.solved(low, high, differing, Reach::Far)? {
            return Ok(());
        }
        let mut places = PLACES.map(|part| low.value + part * (high.value - low.value)).to_vec();
        // Where regions may be too small to be seen, an atlas does not help.
        let too_close = |place: f64| {
            let is = |tried: &Tried<_>, reach: Reach, value: f64, widths: f64| {
                tried.reach == reach && (tried.meeting.value - value).abs() <= widths * width
            };
            self.tried.iter().any(|tried| {
                let again = |other: &_| is(other, Reach::Far, tried.meeting.value, 1.0);
                is(tried, Reach::Close, place, FAR[1]) && !self.tried.iter().any(again)
            })
        };
        if !narrow {
            places.sort_by_key(|&place| too_close(place));
        }
        for place in places {
            if let Beside::Between(middle) = self.between(place)? {
                self.refine(low, &middle)?;
                return self.refine(&middle, high);
            }
        }
        if !narrow && self.solved(low, high, differing, Reach::Far)? {
            return Ok(());
        }
        self.push([low, high], None, true);
        Ok(())
    }

    /// The meeting between two atlases that differ and are as close to each other as those beside a
    /// meeting are. It may be one beside which atlases were in doubt before.
    fn enclosed(&self, ends: [&Sample<F>; 2], differing: &[Vec<usize>; 2]) -> Option<StackMeeting> {
        /// How much farther it is looked for, in widths: differences of values close to each other
        /// are too inaccurate.
        const AROUND: f64 = 1000.0;
        let [low, high] = ends.map(|sample| sample.value);
        let is_between = |meeting: &StackMeeting| low < meeting.value && meeting.value < high;
        let in_doubt = self.tried.iter().filter(|tried| tried.around.is_none());
        let before = in_doubt.map(|tried| tried.meeting).find(is_between);
        let around = AROUND * self.width(low, high);
        let values = [(low - around).max(self.range[0]), (high + around).min(self.range[1])];
        let again = || self.meetings(ends, differing, values, Reach::Close);
        before.or_else(|| again().into_iter().find(is_between))
    }

    /// A meeting beside a change that atlases have enclosed, and the bracket that holds both: a
    /// region that is born or dies there is too small to be seen in atlases that are closer to the
    /// meeting. Between the change and the meeting, the atlases have one structure.
    fn unseen(
        &self,
        low: &Sample<F>,
        high: &Sample<F>,
        effects: &[Effect<F::Label>],
        differing: &[Vec<usize>; 2],
    ) -> Option<(StackMeeting, [f64; 2])> {
        let greatest = low.value.abs().max(high.value.abs());
        let near = (NARROW * self.width(low.value, high.value)).min(UNSEEN * greatest);
        let Lengths { around: beside, close, .. } = Lengths::of(self.window.extent().min());
        let found = self.tried.iter().filter_map(|Tried { meeting, around, .. }| {
            let (between, structure) = around.as_ref()?;
            let dies = meeting.value > high.value;
            let (seen, regions, unseen) =
                if dies { (low, &differing[0], high) } else { (high, &differing[1], low) };
            let is_it = |&region: &usize| {
                let label = seen.structure.label(region).clone();
                let effect = if dies { Effect::Dies(label) } else { Effect::Born(label) };
                let Region { sample, clearance, .. } = &seen.atlas.plane.regions()[region];
                *clearance <= close
                    && (sample - meeting.point).norm() <= beside
                    && effects.contains(&effect)
            };
            let gap = if dies { meeting.value - high.value } else { low.value - meeting.value };
            let is_cause = (0.0..=near).contains(&gap)
                && regions.iter().any(is_it)
                && unseen.structure.differing(structure).is_none();
            let ends = if dies { [low.value, between[1]] } else { [between[0], high.value] };
            is_cause.then_some((*meeting, ends, gap))
        });
        let nearest = found.min_by(|one, other| one.2.total_cmp(&other.2));
        nearest.map(|(meeting, ends, _)| (meeting, ends))
    }

    fn push(&mut self, ends: [&Sample<F>; 2], meeting: Option<StackMeeting>, doubtful: bool) {
        let change = Change::new(ends, meeting, doubtful);
        self.found.push((change, ends[1].structure.clone()));
    }

    /// The changes found, in order, with the structure behind each. Brackets that overlap become
    /// one change, in doubt. So do brackets that almost touch each other, unless both are solved
    /// for: the structure changes there in steps too small to show whether there is one change or
    /// several.
    pub fn joined(mut self) -> Vec<LocatedChange<F>> {
        let found = std::mem::take(&mut self.found);
        let is_one = |one: &Change<F::Label>, other: &Change<F::Label>| {
            let [low, high] = other.between;
            let unsolved = one.meeting.is_none() || other.meeting.is_none();
            let gap = low - one.between[1];
            gap < 0.0 || unsolved && gap <= GAP * self.width(low, high)
        };
        let mut joined: Vec<LocatedChange<F>> = Vec::new();
        for (mut change, behind) in found {
            while let Some((mut last, _)) = joined.pop_if(|(last, _)| is_one(last, &change)) {
                last.join(change);
                change = last;
            }
            joined.push((change, behind));
        }
        joined
    }
}
