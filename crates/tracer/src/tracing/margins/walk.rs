//! Walks along a segment: from a run to the first zero of its margins, to a run just behind it, and
//! so on.

use crate::family::Family;
use crate::lengths::angle;
use crate::tracing::corrector::correct;
use crate::tracing::margins::Lines;
use crate::tracing::margins::line::{Line, trace};
use crate::tracing::runs::{Runs, Sampled, Traced};
use crate::window::Point;

/// The most zeros on one walk.
const STEPS: usize = 24;

impl<F: Family> Lines<'_, F> {
    /// Searches for zeros of margins between two places, both ways.
    pub(super) fn between(&mut self, one: &Sampled<F>, other: &Sampled<F>) -> Traced<(), F> {
        let ahead = self.walk(one, other)?;
        let behind = self.walk(other, one)?;
        let [here, there] = [&ahead.1.label, &behind.1.label];
        let left = *here != other.1.label && *there != one.1.label && here != there;
        let close = (behind.0 - ahead.0).norm() <= self.runs.lengths.close;
        if left && !close {
            // Neither walk has come to the other end.
            let point = ahead.0.lerp(&behind.0, 0.5);
            let middle = (point, self.runs.free(&point)?);
            self.between(&ahead, &middle)?;
            self.between(&middle, &behind)?;
        }
        Ok(())
    }

    /// Walks from one place to another, and begins the lines on the way. Returns the last run.
    fn walk(&mut self, from: &Sampled<F>, to: &Sampled<F>) -> Traced<Sampled<F>, F> {
        let mut here = from.clone();
        for _ in 0..STEPS {
            let way = Way { runs: &self.runs, lines: &self.all, ends: [here.0, to.0] };
            // Zeros closer together belong to one change.
            let near = 0.3 * self.runs.lengths.half / way.length();
            let zeros = way.zeros(&here, to, near)?;
            let Some(first) = zeros.first().map(|zero| zero.0) else { break };
            for (_, point, margin) in &zeros {
                self.begin(point, margin, &(to.0 - here.0))?;
            }
            let next = first + near;
            if next >= 1.0 {
                break;
            }
            let point = here.0.lerp(&to.0, next);
            here = (point, self.runs.free(&point)?);
        }
        Ok(here)
    }

    /// Follows a margin through a zero on a segment in the direction `across`, unless its line is
    /// known. Returns whether something new was found.
    pub(super) fn begin(
        &mut self,
        zero: &Point,
        margin: &F::Margin,
        across: &Point,
    ) -> Traced<bool, F> {
        /// Lines that meet at less are one: a hundred times the error of a direction.
        const ONE: f64 = 100.0 * angle::DEPENDENT;
        let runs = &self.runs;
        let lengths = runs.lengths;
        let near = 0.3 * lengths.half;
        let known = |line: &&Line<F::Margin>| line.margin == *margin;
        if self.all.iter().filter(known).any(|line| line.near(zero, near).is_some())
            || self.all.len() >= self.most()
        {
            return Ok(false);
        }
        let direction = Point::new(-across.y, across.x).normalize();
        let gradient = runs.gradient(zero, margin, &direction, lengths.beyond)?;
        let Some(gradient) = gradient else { return Ok(false) };
        let Some(found) = correct(runs, margin, zero, &gradient, lengths.close)? else {
            return Ok(false);
        };
        let tangent = Point::new(gradient.y, -gradient.x).normalize();
        // Margins that are one function have one line.
        let coincides = self.all.iter().any(|line| {
            line.near(&found.point, lengths.same)
                .is_some_and(|(place, _)| line.tangent(place).perp(&tangent).abs() < ONE)
        });
        if coincides {
            return Ok(false);
        }
        self.seeds += 1;
        let Some(new) = trace(runs, margin, &found.point, &gradient)? else {
            return Ok(false);
        };
        for old in self.all.iter_mut().filter(|line| line.margin == new.margin) {
            if new.is_part_of(old, lengths.touch) {
                return Ok(false);
            }
            if old.is_part_of(&new, lengths.touch) {
                // It was lost too early.
                *old = new;
                self.changes += 1;
                return Ok(true);
            }
        }
        self.all.push(new);
        self.changes += 1;
        Ok(true)
    }
}

/// A segment, along which places run from 0 to 1.
struct Way<'r, 'f, F: Family> {
    runs: &'r Runs<'f, F>,
    lines: &'r [Line<F::Margin>],
    ends: [Point; 2],
}

/// A value at a place of a way.
type Height = (f64, f64);

/// A zero on a way: its place, its point, and the margin that vanishes there.
type Zero<F> = (f64, Point, <F as Family>::Margin);

impl<F: Family> Way<'_, '_, F> {
    fn point(&self, place: f64) -> Point {
        self.ends[0].lerp(&self.ends[1], place)
    }

    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    fn value(&self, place: f64, margin: &F::Margin) -> Traced<Option<f64>, F> {
        self.runs.margin(&self.point(place), margin)
    }

    fn moved(&self, place: f64, margin: &F::Margin) -> Traced<F::Margin, F> {
        self.runs.moved(&self.point(place), margin)
    }

    /// The first zero of the margins of the first run, and others up to `near` behind it, in order.
    ///
    /// Behind the first zero the run has another itinerary, and what vanishes there is asked of the
    /// next run. So most margins are only asked whether they vanish before the first zero so far.
    fn zeros(&self, here: &Sampled<F>, there: &Sampled<F>, near: f64) -> Traced<Vec<Zero<F>>, F> {
        let differ = here.1.label != there.1.label;
        let vanishes = |(margin, value): &&(F::Margin, f64)| {
            *value != 0.0 && (differ || self.runs.is_sure(margin))
        };
        let mut margins: Vec<&(F::Margin, f64)> = here.1.margins.iter().filter(vanishes).collect();
        // The smallest ones are likely to vanish first.
        margins.sort_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
        let mut zeros: Vec<Zero<F>> = Vec::new();
        let mut end = 1.0;
        for (margin, value) in margins {
            let listed = there.1.margins.iter().find(|(other, _)| other == margin);
            let last = match listed {
                Some((_, last)) if zeros.is_empty() => Some(*last),
                _ => self.value(end, margin)?,
            };
            let known = last.and_then(|last| self.known(margin, *value * last, end));
            let found = match known {
                Some(place) => Some((place, margin.clone())),
                None => self.zero(margin, *value, (end, last))?,
            };
            if let Some((place, name)) = found {
                zeros.push((place, self.point(place), name));
                end = end.min(place + near);
            }
        }
        zeros.retain(|zero| zero.0 <= end);
        zeros.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(zeros)
    }

    /// The first place before `end` where a known line of a margin crosses the way. `None` if the
    /// margin has other zeros too, by its signs at the start and at the end: their `product`.
    fn known(&self, margin: &F::Margin, product: f64, end: f64) -> Option<f64> {
        let [a, b] = self.ends;
        let places = self.lines.iter().flat_map(|line| line.crossings(&a, &b, margin));
        let places: Vec<f64> = places.filter(|place| *place <= end).collect();
        let is_all = !places.len().is_multiple_of(2) && product < 0.0;
        places.into_iter().min_by(f64::total_cmp).filter(|_| is_all)
    }

    /// A zero of a margin with this value at the start, before the place `end`, where it has the
    /// value `last` if it exists there. With its name at the zero.
    fn zero(
        &self,
        margin: &F::Margin,
        value: f64,
        (end, last): (f64, Option<f64>),
    ) -> Traced<Option<(f64, F::Margin)>, F> {
        let mut name = margin.clone();
        let bracket = match last {
            Some(last) => Some([(0.0, value), (end, last)]),
            None => self.bracket(value, end, &mut name)?,
        };
        match bracket {
            Some([low, high]) if low.1 * high.1 <= 0.0 => self.narrowed(low, high, name),
            _ => Ok(None),
        }
    }

    /// Two places between which a margin vanishes that ceases to exist on the way, by the secant
    /// method with steps that are a little too long.
    fn bracket(
        &self,
        value: f64,
        mut end: f64,
        name: &mut F::Margin,
    ) -> Traced<Option<[Height; 2]>, F> {
        const ROUNDS: usize = 30;
        /// A margin that would need so many times the rest of the way does not vanish on it. One
        /// that falls to zero at the end as a root of a root needs four times the rest.
        const FARTHEST: f64 = 4.0;
        let (mut low, mut height, mut step) = (0.0, value, 0.05 * end);
        for _ in 0..ROUNDS {
            let next = (low + step).min(0.5 * (low + end));
            if next - low < 1e-9 {
                break;
            }
            match self.value(next, name)? {
                None => (end, step) = (next, 0.5 * (next - low)),
                Some(here) if here * value <= 0.0 => {
                    return Ok(Some([(low, height), (next, here)]));
                }
                Some(here) => {
                    let need = -here * (next - low) / (here - height);
                    *name = self.moved(next, name)?;
                    (low, height) = (next, here);
                    if !(need > 0.0 && need < FARTHEST * (end - low)) {
                        return Ok(None);
                    }
                    step = (1.1 * need).min(0.5);
                }
            }
        }
        Ok(None)
    }

    /// The zero between two places, by the Illinois method with a bisection in every third round.
    fn narrowed(
        &self,
        mut low: Height,
        mut high: Height,
        mut name: F::Margin,
    ) -> Traced<Option<(f64, F::Margin)>, F> {
        const ROUNDS: usize = 80;
        let sign = low.1.signum();
        let width = 10.0 * self.runs.lengths.same / self.length();
        let mut kept_low = None;
        for round in 0..ROUNDS {
            if high.0 - low.0 < width {
                break;
            }
            let mut place = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            if round % 3 == 2 || !(place > low.0 && place < high.0) {
                place = f64::midpoint(low.0, high.0);
            }
            let Some(here) = self.value(place, &name)? else { return Ok(None) };
            name = self.moved(place, &name)?;
            if here == 0.0 {
                return Ok(Some((place, name)));
            }
            let is_low = here * sign > 0.0;
            if is_low {
                low = (place, here);
            } else {
                high = (place, here);
            }
            if kept_low == Some(!is_low) {
                // The other end was kept twice.
                if is_low { high.1 *= 0.5 } else { low.1 *= 0.5 }
            }
            kept_low = Some(!is_low);
        }
        Ok(Some((f64::midpoint(low.0, high.0), name)))
    }
}
