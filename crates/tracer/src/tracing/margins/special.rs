//! Places that the margins of lines are solved for: where a line ends by itself or touches another.
//!
//! What two lines that cross tell of their crossing, a line that ends may not tell of its end: its
//! margin is singular there or exists on one side only. But other conditions hold there whose zero
//! is simple.

use nalgebra::Vector1;

use crate::conditions::{Limits, secant, solve};
use crate::cubic::Cubic;
use crate::curve::Node;
use crate::family::Family;
use crate::lengths::angle;
use crate::tracing::branch::tangency::Root;
use crate::tracing::corrector::{correct, crossing, stationary};
use crate::tracing::fit::mirrored;
use crate::tracing::margins::line::{Line, Place};
use crate::tracing::margins::meet::{Crossing, Nearness};
use crate::tracing::margins::{Lines, Solved};
use crate::tracing::runs::Traced;
use crate::window::Point;

impl<F: Family> Lines<'_, F> {
    /// The cusp in which a line that was lost ends, if the family knows it.
    pub(super) fn cusp(&self, index: usize, end: usize) -> Traced<Option<Solved>, F> {
        let (runs, lengths, line) = (&self.runs, &self.runs.lengths, &self.all[index]);
        let (name, last) = (line.name(end), line.last(end));
        let mut places = Vec::new();
        for [one, two] in runs.cusps(name) {
            let reach = lengths.around;
            let found =
                crossing(runs, [&one, &two], &last.point, &last.tangent, lengths.scale, reach)?;
            places.extend(found);
        }
        let away = |(place, _): &Solved| (place - last.point).norm();
        places.sort_by(|one, other| away(one).total_cmp(&away(other)));
        for place in places {
            if self.leads_to(line, end, &place.0)? {
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    /// The place where a line that was lost ends because the gradient of its margin vanishes.
    pub(super) fn flat(&self, index: usize, end: usize) -> Traced<Option<Solved>, F> {
        let (runs, lengths, line) = (&self.runs, &self.runs.lengths, &self.all[index]);
        let (name, last) = (line.name(end), line.last(end));
        let found = stationary(runs, name, &last.point, lengths.close, lengths.around)?;
        let Some(place) = found else { return Ok(None) };
        // Differences over a long step may be differences of errors.
        let slope = |point: &Point| -> Traced<Option<f64>, F> {
            let gradient = runs.gradient(point, name, &last.tangent, lengths.scale)?;
            Ok(gradient.map(|gradient| gradient.norm()))
        };
        let away = |point: &Point| (point - last.point).norm() > lengths.close;
        let mut points = line.nodes.iter().map(|node| node.point).filter(away);
        let Some(before) = (if end == 0 { points.next() } else { points.next_back() }) else {
            return Ok(None);
        };
        let flattens = match (slope(&before)?, slope(&place)?) {
            (Some(before), Some(here)) => here <= 0.1 * before,
            _ => true,
        };
        let leads = flattens && self.leads_to(line, end, &place)?;
        Ok(leads.then_some((place, lengths.same)))
    }

    /// Whether a line that was lost leads to a place ahead: the margin is small on the way, as far
    /// as it exists.
    fn leads_to(&self, line: &Line<F::Margin>, end: usize, place: &Point) -> Traced<bool, F> {
        let (runs, lengths) = (&self.runs, &self.runs.lengths);
        let (name, last) = (line.name(end), line.last(end));
        let chord = place - last.point;
        if chord.norm() <= lengths.same {
            return Ok(true);
        }
        if chord.dot(&last.tangent) < 0.0 {
            return Ok(false);
        }
        let tip = chord.norm() <= lengths.close;
        let gradient = runs.gradient(&last.point, name, &last.tangent, chord.norm())?;
        // The margin may exist in a wedge that is narrower than differences.
        let Some(gradient) = gradient else {
            return Ok(tip && chord.angle(&last.tangent) < angle::PARALLEL);
        };
        let error = if tip { lengths.same } else { runs.options.interpolation };
        let floor = error * gradient.norm() + runs.options.noise;
        let arc = Cubic::between(
            &last,
            &Node { point: *place, tangent: mirrored(&last.tangent, &chord) },
        );
        for theta in [0.3, 0.7, 1.0] {
            let value = runs.margin(&arc.at(theta), name)?;
            if value.map_or(!tip, |value| value.abs() > floor) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The place where a line begins on another one with its tangent, because its margin has a
    /// square root in the margin of the other.
    pub(super) fn root_end(
        &self,
        index: usize,
        end: usize,
        (other, place): (usize, Place),
    ) -> Traced<Option<Solved>, F> {
        let (runs, lengths) = (&self.runs, &self.runs.lengths);
        let (line, passing) = (&self.all[index], &self.all[other]);
        let (own, graze) = (line.name(end), &passing.names[place.piece]);
        let last = line.last(end);
        let foot = passing.at(place);
        let along = passing.tangent(place);
        let along = if along.dot(&last.tangent) < 0.0 { -along } else { along };
        if own == graze || along.perp(&last.tangent).abs() > angle::PARALLEL {
            return Ok(None);
        }
        let gradient = runs.gradient(&foot, graze, &along, lengths.scale)?;
        let Some(gradient) = gradient else { return Ok(None) };
        let mut best: Option<(f64, Point)> = None;
        for side in [1.0, -1.0] {
            let mut root = Root { runs, own, graze, foot, along, gradient, side };
            // From the place itself, the next one has its error only.
            for least in [-lengths.piece, -lengths.close] {
                let Some((place, error)) = root.place()? else { break };
                // The line goes on beside the other one, and does not come back.
                let Some(point) = root.point(place)?.filter(|_| place > least) else { break };
                if best.is_none_or(|(least, _)| error < least) {
                    best = Some((error, point));
                }
                root.foot = point;
            }
        }
        Ok(best.map(|(error, point)| (point, error)))
    }

    /// The place where two lines touch that are nearest to each other near this place.
    pub(super) fn touch(&self, near: &Nearness) -> Traced<Option<Crossing>, F> {
        let (runs, lengths) = (&self.runs, &self.runs.lengths);
        let [one, other] = near.lines.map(|line| &self.all[line]);
        let names = [&one.names[near.places[0].piece], &other.names[near.places[1].piece]];
        if names[0] == names[1] {
            return Ok(None);
        }
        let cubic = one.cubic(near.places[0].piece);
        let chord = cubic.chord();
        let tangent = one.tangent(near.places[0]);
        let Some(gradient) = runs.gradient(&near.point, names[0], &tangent, lengths.scale)? else {
            return Ok(None);
        };
        let reach = 0.3 * chord + 100.0 * runs.options.tolerance;
        let mut found = None;
        // The sine of the angle between the gradients, over the length along the first line.
        let sine = |at: f64, found: &mut Option<(Point, f64)>| -> Traced<Option<f64>, F> {
            let guess = cubic.at(near.places[0].theta + at / chord);
            let Some(on) = correct(runs, names[0], &guess, &gradient, reach)? else {
                return Ok(None);
            };
            let gradient = |name| runs.gradient(&on.point, name, &tangent, lengths.scale);
            let (Some(own), Some(crosswise)) = (gradient(names[0])?, gradient(names[1])?) else {
                return Ok(None);
            };
            *found = Some((on.point, crosswise.norm()));
            Ok(Some(own.perp(&crosswise) / (own.norm() * crosswise.norm())))
        };
        let mut before = None;
        let tolerance = 10.0 * runs.options.tolerance;
        let limits = Limits { stalled: lengths.same, ..Limits::new(chord, tolerance) };
        let zero: Traced<_, F> = solve(&Vector1::zeros(), &limits, |at, _| {
            let Some(value) = sine(at.x, &mut found)? else { return Ok(None) };
            let mut slope = secant(&mut before, at.x, value);
            if slope.is_none() {
                let step = 0.1 * chord;
                let Some(ahead) = sine(at.x + step, &mut found)? else { return Ok(None) };
                slope = Some((ahead - value) / step);
            }
            Ok(Some((Vector1::new(value), slope.map(Vector1::new))))
        });
        let Ok(zero) = zero? else { return Ok(None) };
        let Some(_) = sine(zero.at.x, &mut found)? else { return Ok(None) };
        let Some((point, slope)) = found else { return Ok(None) };
        let Some(value) = runs.margin(&point, names[1])? else { return Ok(None) };
        let floor = runs.options.interpolation.max(10.0 * runs.resolution(slope));
        if value.abs() > floor * slope || runs.is_singular(&point, names[1], &tangent)? {
            return Ok(None);
        }
        Ok(Some(Crossing { lines: near.lines, places: near.places, point }))
    }
}
