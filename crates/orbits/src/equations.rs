//! The equations of an orbit with a prescribed itinerary, and their derivatives.
//!
//! Segment i has the unknown state xᵢ at its start and the unknown duration Tᵢ; φᵢ is the smooth
//! flow of its mode, gᵢ the condition of the rule that ends it, and Rᵢ what the rule changes:
//!
//!   gᵢ(φᵢ(xᵢ, Tᵢ)) = 0,  xᵢ₊₁ = Rᵢ(φᵢ(xᵢ, Tᵢ)), the last one followed by the first.
//!
//! The time at the start is the last unknown. It stays where it is, unless time is explicit: then
//! the durations together are a multiple of a clock's period. All of this is smooth where an orbit
//! grazes, where a return map is not. Derivatives come from the variational equations.

mod event;
mod flow;
mod parts;

use nalgebra::{DMatrix, DVector};
use stickslip_expression::{Program, System};
use stickslip_solver::Options;

use crate::error::OrbitError;
use crate::itinerary::{Leg, require_of};
pub(crate) use event::{Event, EventFormulas, rate};
use flow::Flown;
pub(crate) use flow::{Flow, enlarge};
pub(crate) use parts::{clock_values, is_apart};
use parts::{clocks, is_held, ticks};

/// A condition is zero if it is less than this part of what it is made of.
const ZERO: f64 = 1e-9;

/// The unknowns of an orbit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Draft {
    pub parameters: Vec<f64>,
    pub start: f64,
    pub legs: Vec<Leg>,
    pub states: Vec<Vec<f64>>,
    pub durations: Vec<f64>,
}

impl Draft {
    pub fn period(&self) -> f64 {
        self.durations.iter().sum()
    }

    /// The times at the starts of the segments.
    pub fn starts(&self) -> Vec<f64> {
        let starts = self.durations.iter().scan(self.start, |s, duration| {
            let own = *s;
            *s += duration;
            Some(own)
        });
        starts.collect()
    }
}

/// The equations of an itinerary. Places are unknowns of size 1: those of a [`Draft`] over their
/// sizes in the first one, and behind them the active parameters over theirs.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    n: usize,
    legs: Vec<Leg>,
    active: Vec<usize>,
    parameters: Vec<f64>,
    flows: Vec<Flow>,
    events: Vec<EventFormulas>,
    /// The period of each clock and its derivatives by parameters, and how often it ticks.
    clocks: Vec<(Program, f64)>,
    /// Components that need not come back, since nothing changes them or nothing else reads them,
    /// or that come back whatever their value is.
    apart: Vec<bool>,
    /// The first draft.
    anchor: Draft,
    sizes: DVector<f64>,
    /// The sizes of equations.
    rows: DVector<f64>,
    options: Options,
}

/// The equations at a place.
#[derive(Clone, Debug)]
pub(crate) struct Evaluation {
    /// What has to vanish.
    pub values: DVector<f64>,
    /// Its derivatives by the unknowns, and by active parameters in further columns.
    pub slopes: DMatrix<f64>,
    /// The ends of the segments.
    pub ends: Vec<End>,
}

/// The end of a segment.
#[derive(Clone, Debug)]
pub(crate) struct End {
    pub flown: Flown,
    pub event: Event,
}

impl Equations {
    /// The equations of the itinerary of a draft, in which some parameters are unknown too. Each
    /// of those has a size.
    ///
    /// # Errors
    /// [`OrbitError`]: the itinerary is too long, or time is explicit and nothing says its period.
    pub fn new(
        system: &System,
        anchor: Draft,
        active: &[(usize, f64)],
        options: &Options,
    ) -> Result<Self, OrbitError> {
        let (n, m) = (system.components.len(), anchor.legs.len());
        require_of(system, &anchor.legs, &anchor.states)?;
        let legs = anchor.legs.clone();
        let mut graph = system.graph.clone();
        let places: Vec<usize> = active.iter().map(|(place, _)| *place).collect();
        let graph = &mut graph;
        let ticks = ticks(system, &anchor)?;
        let clocks = clocks(graph, system, &legs, &places)?;
        let flows = legs.iter().map(|leg| Flow::new(graph, system, leg.mode, &places));
        let flows: Vec<Flow> = flows.collect();
        let event = |(leg, tick): (&Leg, &Option<f64>)| {
            EventFormulas::new(graph, system, *leg, *tick, &places)
        };
        let events = legs.iter().zip(&ticks).map(event).collect();
        let apart = |place: usize| {
            let start = anchor.states[0][place];
            is_apart(system, &legs, place) || is_held(system, &legs, place, start)
        };
        let apart = (0..n).map(apart).collect();
        let sizes = sizes(&anchor, &flows, active, options)?;
        let least = sizes.rows(0, n).iter().fold(f64::INFINITY, |least, size| least.min(*size));
        let options = Options { atol: options.rtol * 0.1 * least, ..*options };
        let parameters = anchor.parameters.clone();
        let rows = DVector::from_element(m * (n + 1) + 1, 1.0);
        let mut equations = Self {
            n,
            legs,
            active: places,
            parameters,
            flows,
            events,
            clocks,
            apart,
            anchor,
            sizes,
            rows,
            options,
        };
        equations.measure_rows(system)?;
        Ok(equations)
    }

    /// The same equations, in which the sizes of components are no less than these.
    pub fn enlarged(mut self, least: &[f64]) -> Self {
        for place in 0..self.legs.len() * self.n {
            let size = self.sizes[place].max(least[place % self.n]);
            (self.sizes[place], self.rows[place]) = (size, size);
        }
        self
    }

    /// What happens where a rule acts.
    pub fn event(
        system: &System,
        leg: Leg,
        parameters: &[f64],
        (s, state): (f64, &[f64]),
    ) -> Event {
        let mut graph = system.graph.clone();
        EventFormulas::new(&mut graph, system, leg, None, &[]).at(parameters, s, state)
    }

    /// The number of unknowns without parameters.
    pub fn count(&self) -> usize {
        self.legs.len() * (self.n + 1) + 1
    }

    /// The parameters that are unknown, by their places in the system.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// The size of an unknown.
    pub fn size(&self, unknown: usize) -> f64 {
        self.sizes[unknown]
    }

    /// The segments.
    pub fn legs(&self) -> &[Leg] {
        &self.legs
    }

    /// The segment of an unknown.
    pub fn segment_of(&self, unknown: usize) -> usize {
        let states = self.legs.len() * self.n;
        match unknown.checked_sub(states) {
            None => unknown / self.n,
            Some(duration) => duration.min(self.legs.len() - 1),
        }
    }

    /// The place of a draft.
    pub fn place(&self, draft: &Draft) -> DVector<f64> {
        let states = draft.states.iter().flatten().copied();
        let parameters = self.active.iter().map(|&place| draft.parameters[place]);
        let all = states.chain(draft.durations.iter().copied()).chain([draft.start]);
        let all: Vec<f64> = all.chain(parameters).collect();
        DVector::from_vec(all).component_div(&self.sizes)
    }

    /// The draft at a place.
    pub fn draft(&self, place: &DVector<f64>) -> Draft {
        let (n, m) = (self.n, self.legs.len());
        let all = place.component_mul(&self.sizes.rows(0, place.len()));
        let all = all.as_slice();
        let mut parameters = self.parameters.clone();
        for (&own, value) in self.active.iter().zip(&all[self.count()..]) {
            parameters[own] = *value;
        }
        Draft {
            parameters,
            start: all[m * (n + 1)],
            legs: self.legs.clone(),
            states: (0..m).map(|i| all[n * i..n * (i + 1)].to_vec()).collect(),
            durations: all[m * n..m * (n + 1)].to_vec(),
        }
    }

    /// The equations at a place.
    ///
    /// # Errors
    /// [`OrbitError::Run`].
    pub fn at(&self, place: &DVector<f64>) -> Result<Evaluation, OrbitError> {
        let (n, m, count) = (self.n, self.legs.len(), self.count());
        let draft = self.draft(place);
        let parameters = &draft.parameters;
        let mut values = DVector::zeros(count);
        let mut slopes = DMatrix::zeros(count, count + self.active.len());
        let mut ends = Vec::with_capacity(m);
        for (i, s) in draft.starts().into_iter().enumerate() {
            let duration = draft.durations[i];
            let flown =
                self.flows[i].run(parameters, (s, &draft.states[i]), duration, &self.options);
            let flown = flown.map_err(|error| OrbitError::Run { segment: i, error })?;
            let event = self.events[i].at(parameters, s + duration, &flown.state);
            let next = (i + 1) % m;
            for k in 0..n {
                let row = next * n + k;
                if next == 0 && self.apart[k] {
                    values[row] = draft.states[0][k] - self.anchor.states[0][k];
                    slopes[(row, k)] += 1.0;
                    continue;
                }
                values[row] = draft.states[next][k] - event.after[k];
                slopes[(row, row)] += 1.0;
                let own: DVector<f64> = event.after_by.row(k).transpose();
                self.add(&mut slopes, (row, i), (-1.0, &own), (&flown, &event));
            }
            values[m * n + i] = event.guard;
            let own = event.guard_by.clone();
            self.add(&mut slopes, (m * n + i, i), (1.0, &own), (&flown, &event));
            ends.push(End { flown, event });
        }
        self.close(&draft, &mut values, &mut slopes);
        for (column, &size) in self.sizes.iter().enumerate().take(slopes.ncols()) {
            slopes.column_mut(column).scale_mut(size);
        }
        for (row, &size) in self.rows.iter().enumerate() {
            values[row] /= size;
            slopes.row_mut(row).unscale_mut(size);
        }
        Ok(Evaluation { values, slopes, ends })
    }

    /// Adds to a row what a quantity at the end of segment `i` changes by, whose derivatives by
    /// state, time and parameters there are `by`.
    fn add(
        &self,
        slopes: &mut DMatrix<f64>,
        (row, i): (usize, usize),
        (sign, by): (f64, &DVector<f64>),
        (flown, event): (&Flown, &Event),
    ) {
        let (n, states, count) = (self.n, self.legs.len() * self.n, self.count());
        let along = by.rows(0, n);
        let mut add = |column: usize, value: f64| slopes[(row, column)] += sign * value;
        for k in 0..n {
            add(n * i + k, along.dot(&flown.by.column(k)));
        }
        add(states + i, along.dot(&event.slopes) + by[n]);
        // A later start moves the whole segment.
        let later = along.dot(&flown.by.column(n)) + by[n];
        for before in 0..i {
            add(states + before, later);
        }
        add(count - 1, later);
        for parameter in 0..self.active.len() {
            let own = along.dot(&flown.by.column(n + 1 + parameter)) + by[n + 1 + parameter];
            add(count + parameter, own);
        }
    }

    /// The equation of time.
    fn close(&self, draft: &Draft, values: &mut DVector<f64>, slopes: &mut DMatrix<f64>) {
        let (states, count) = (self.legs.len() * self.n, self.count());
        let row = count - 1;
        let Some((program, ticks)) = self.clocks.first() else {
            values[row] = draft.start - self.anchor.start;
            slopes[(row, row)] = 1.0;
            return;
        };
        let period = self.period(program, &draft.parameters);
        values[row] = draft.period() - ticks * period[0];
        for i in 0..self.legs.len() {
            slopes[(row, states + i)] = 1.0;
        }
        for (parameter, by) in period[1..].iter().enumerate() {
            slopes[(row, count + parameter)] = -ticks * by;
        }
    }

    /// The period of a clock, and its derivatives by the unknown parameters.
    fn period(&self, clock: &Program, parameters: &[f64]) -> Vec<f64> {
        let mut period = vec![f64::NAN; 1 + self.active.len()];
        clock.with(parameters).run(f64::NAN, &[], &mut period);
        period
    }

    /// The derivatives by the unknowns for a solution that comes back `factor` times as large: they
    /// are singular where that is a multiplier. Nothing is divided by the rate of a condition, so
    /// that they exist at grazes.
    pub fn returning(&self, slopes: &DMatrix<f64>, factor: f64) -> DMatrix<f64> {
        let count = self.count();
        let mut own = slopes.columns(0, count).into_owned();
        for k in (0..self.n).filter(|k| !self.apart[*k]) {
            own[(k, k)] += (factor - 1.0) * self.sizes[k] / self.rows[k];
        }
        let row = count - 1;
        if !self.clocks.is_empty() {
            own[(row, row)] += (1.0 - factor) * self.sizes[row] / self.rows[row];
        }
        own
    }

    /// The derivative of the return to the start, by saltation, without components that nothing
    /// changes; `None` at a graze. Where time is not explicit, the slopes at the start are its
    /// trivial direction.
    pub fn monodromy(&self, ends: &[End]) -> Option<(DMatrix<f64>, Option<DVector<f64>>)> {
        let n = self.n;
        let mut product = DMatrix::identity(n, n);
        for End { flown, event } in ends {
            product = event.saltation() * flown.by.columns(0, n) * product;
        }
        let moving: Vec<usize> = (0..n).filter(|k| !self.apart[*k]).collect();
        let product = product.select_rows(&moving).select_columns(&moving);
        let last = &ends.last()?.event.slopes_after;
        let trivial = self.clocks.is_empty().then(|| last.select_rows(&moving));
        product.iter().all(|it| it.is_finite()).then_some((product, trivial))
    }

    /// The event at the end of a segment.
    pub fn end(&self, segment: usize, parameters: &[f64], (s, state): (f64, &[f64])) -> Event {
        self.events[segment].at(parameters, s, state)
    }

    /// Whether the condition of an event is zero.
    pub fn is_at(&self, event: &Event) -> bool {
        let parts = (0..self.n).map(|k| (event.guard_by[k] * self.sizes[k]).abs());
        event.guard.abs() <= ZERO * parts.fold(0.0, f64::max)
    }

    /// The state after a part of a segment.
    pub fn within(&self, draft: &Draft, i: usize, duration: f64) -> Result<Vec<f64>, OrbitError> {
        let start = (draft.starts()[i], &draft.states[i][..]);
        let flown = self.flows[i].run(&draft.parameters, start, duration, &self.options);
        flown.map(|it| it.state).map_err(|error| OrbitError::Run { segment: i, error })
    }

    /// Whether what depends on the time is the same one period later, at both ends of segments, and
    /// all clocks tick again.
    pub fn repeats(&self, draft: &Draft, ends: &[End]) -> bool {
        let (period, starts) = (draft.period(), draft.starts());
        let sizes = &self.sizes.as_slice()[..self.n];
        let is_same = |i: usize, s: f64, state: &[f64]| {
            let at = |s: f64| self.events[i].at(&draft.parameters, s, state);
            at(s).is_like(&at(s + period), sizes, period)
        };
        let ticks_again = |(program, ticks): &(Program, f64)| {
            let own = self.period(program, &draft.parameters)[0];
            (period - ticks * own).abs() <= ZERO * period
        };
        self.clocks.is_empty()
            || self.clocks.iter().all(ticks_again)
                && (0..self.legs.len()).all(|i| {
                    is_same(i, starts[i], &draft.states[i])
                        && is_same(i, starts[i] + draft.durations[i], &ends[i].flown.state)
                })
    }

    /// Gives each equation its size, and refuses conditions that nothing moves.
    fn measure_rows(&mut self, system: &System) -> Result<(), OrbitError> {
        let (n, m, count) = (self.n, self.legs.len(), self.count());
        let slopes = self.at(&self.place(&self.anchor))?.slopes;
        for row in 0..m * n {
            self.rows[row] = self.sizes[row % n];
        }
        for i in 0..m {
            let size = slopes.row(m * n + i).norm();
            let is_still = size == 0.0;
            if is_still || !size.is_finite() {
                let rule = self.legs[i].name(system);
                return Err(OrbitError::StillGuard { segment: i, rule });
            }
            self.rows[m * n + i] = size;
        }
        self.rows[count - 1] = self.sizes[count - 1];
        Ok(())
    }
}

/// The sizes of the unknowns of a draft: of components, the largest ones along the whole orbit. At
/// its events a component may be zero. What is below the absolute tolerance of runs is zero
/// throughout.
fn sizes(
    draft: &Draft,
    flows: &[Flow],
    active: &[(usize, f64)],
    options: &Options,
) -> Result<DVector<f64>, OrbitError> {
    let m = draft.legs.len();
    let mut largest = vec![0.0; draft.states[0].len()];
    for (segment, s) in draft.starts().into_iter().enumerate() {
        let start = (s, &draft.states[segment][..]);
        flows[segment]
            .measure(&draft.parameters, start, draft.durations[segment], options, &mut largest)
            .map_err(|error| OrbitError::Run { segment, error })?;
    }
    let above = |least: f64, size: f64| if size > least && size.is_finite() { size } else { 1.0 };
    for size in &mut largest {
        *size = above(options.atol, *size);
    }
    let time = above(0.0, draft.period().abs());
    let states = (0..m).flat_map(|_| largest.iter().copied());
    let times = std::iter::repeat_n(time, m + 1);
    let sizes = states.chain(times).chain(active.iter().map(|(_, size)| *size));
    Ok(DVector::from_vec(sizes.collect()))
}
