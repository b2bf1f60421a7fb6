//! Curves of special orbits over two parameters, by pseudo-arclength.
//!
//! What is zero along a branch at a special orbit is one more equation, and a second parameter one
//! more unknown. Its derivatives are differences of its values, which are computed once for each
//! place: they make the search a little slower, and its result no less accurate. `station` has
//! places and the way from one to the next, `meetings` where something else changes too.

mod meetings;
mod station;

use nalgebra::{DVector, Vector2};
use stickslip_expression::InvalidValue;
use stickslip_tracer::{Cubic, Node};

use super::change::Margin;
use super::point::{Along, Point};
use super::test::{Test, has_torus};
use super::{BranchOptions, Half, SpecialKind, SpecialOrbit};
use crate::equations::Equations;
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::orbit::Orbit;
use meetings::Met;

/// Halvings of a step for closer points, at most.
const DEEPEST: usize = 10;

/// Special orbits of one kind over two parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpecialCurve<P = usize, O = Orbit> {
    /// Their kind.
    pub kind: SpecialKind,
    /// The parameters, by their places in the system.
    pub parameters: [P; 2],
    /// The window, an interval for each parameter.
    pub window: [[f64; 2]; 2],
    /// The orbits, in the order of the curve.
    pub points: Vec<O>,
    /// The direction of the curve at each of them, of length 1 in the plane of the parameters.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tangents: Vec<[f64; 2]>,
    /// Orbits at which something else changes too, in the order of the curve.
    pub meetings: Vec<Meeting<O>>,
    /// Whether the curve comes back to its start.
    pub closed: bool,
    /// Why the curve is not complete.
    pub objection: Option<String>,
}

/// An orbit that is special twice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Meeting<O = Orbit> {
    /// What it is called: `resonance-1-1` where both multipliers of a torus are 1, `resonance-1-2`
    /// where they are −1, `double-graze`, `cusp`, and otherwise what changes and what is followed,
    /// as `fold-grazing`.
    #[cfg_attr(feature = "serde", serde(default))]
    pub name: String,
    /// What changes besides.
    pub kind: SpecialKind,
    /// The direction of the curve there, of length 1 in the plane of the parameters; that towards
    /// the place if it is a cusp.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tangent: [f64; 2],
    /// The segment at which it happens, if it happens at one.
    pub segment: Option<usize>,
    /// The number of points of the curve before it.
    pub behind: usize,
    /// The orbit.
    pub orbit: O,
}

/// What is zero along a curve.
#[derive(Clone)]
enum Tracked {
    Test(Test),
    Margin(Margin),
}

/// A place on a curve, with its direction.
#[derive(Clone)]
struct Station {
    point: Point,
    tangent: DVector<f64>,
    /// What is zero there, and its derivatives, with which the next place is searched for.
    tracked: Tracked,
    gradient: DVector<f64>,
}

/// What a curve follows.
struct Follower<'a> {
    along: Along<'a>,
    special: &'a SpecialOrbit,
    window: [[f64; 2]; 2],
    /// How far a cubic between two points may be from the curve, if it matters.
    interpolation: Option<f64>,
}

/// An orbit of a curve with its direction.
struct CurvePoint {
    orbit: Orbit,
    tangent: [f64; 2],
}

impl Orbits {
    /// The curve of a special orbit over two parameters, in both directions from it.
    ///
    /// # Errors
    /// [`OrbitError`] if the curve does not begin: for instance for a kind that no function says,
    /// `branch-point`, `infinite-period` and `boundary`.
    pub fn curve(
        &self,
        special: &SpecialOrbit,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        options: &BranchOptions,
    ) -> Result<SpecialCurve, OrbitError> {
        self.curve_within(special, parameters, window, options, None)
    }

    /// As [`Self::curve`], with so many points that the cubics between them are as near to the
    /// curve as this.
    pub(crate) fn curve_within(
        &self,
        special: &SpecialOrbit,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        options: &BranchOptions,
        interpolation: Option<f64>,
    ) -> Result<SpecialCurve, OrbitError> {
        options.validate()?;
        self.compiled.with(&special.orbit.parameters)?;
        let [one, other] = parameters;
        let expected = "the places of two parameters";
        InvalidValue::check("the parameters", one, expected, one != other)?;
        for (place, range) in parameters.into_iter().zip(window) {
            self.require_range(&special.orbit, place, range)?;
        }
        special.require_of(self)?;
        let active = [0, 1].map(|k| (parameters[k], window[k][1] - window[k][0]));
        let draft = special.orbit.draft();
        let equations = Equations::new(&self.system, draft.clone(), &active, &self.options)?;
        let (equations, range) = (&equations, window[0]);
        let along = Along { judged: false, ..Along::new(self, equations, one, range) };
        let follower = Follower { along, special, window, interpolation };
        // The special orbit may have been written and read.
        let start = follower.ahead(&follower.station(equations.place(&draft), None)?, 0.0, None)?;
        let ahead = follower.half(&start, options);
        let turned = Station { tangent: -&start.tangent, ..start.clone() };
        let mut back = (!ahead.closed).then(|| follower.half(&turned, options));
        if let Some(back) = &mut back {
            let points = back.points.iter_mut().map(|it| &mut it.tangent);
            for tangent in points.chain(back.specials.iter_mut().map(|it| &mut it.tangent)) {
                *tangent = tangent.map(|it| -it);
            }
        }
        let middle = Half { points: vec![follower.finished(&start)], ..Half::default() };
        let Half { points, specials: meetings, closed, objection } =
            ahead.joined(middle, back, |meeting| &mut meeting.behind);
        let kind = special.kind;
        let (points, tangents) = points.into_iter().map(|it| (it.orbit, it.tangent)).unzip();
        Ok(SpecialCurve { kind, parameters, window, points, tangents, meetings, closed, objection })
    }
}

impl Follower<'_> {
    /// The direction at a place in the plane of the parameters.
    fn plane_tangent(&self, tangent: &DVector<f64>) -> Vector2<f64> {
        let [x, y] = self.parameters(tangent);
        let [across, up] = self.window.map(|[low, high]| high - low);
        Vector2::new(x * across, y * up)
    }

    fn node(&self, station: &Station) -> Node {
        let orbit = &station.point.orbit;
        let [x, y] = [0, 1].map(|k| orbit.parameters[self.places()[k]]);
        let tangent = self.plane_tangent(&station.tangent);
        Node { point: Vector2::new(x, y), tangent: tangent.try_normalize(0.0).unwrap_or(tangent) }
    }

    /// The parameters, by their places in the system.
    fn places(&self) -> [usize; 2] {
        let active = self.along.equations.active();
        [active[0], active[1]]
    }

    /// The orbit of a station with its verdict.
    fn finished(&self, station: &Station) -> CurvePoint {
        let own = &station.point.orbit;
        let judged = self.along.orbits.judged(self.along.equations, own);
        let orbit = judged.unwrap_or_else(|_| own.clone());
        CurvePoint { orbit, tangent: self.node(station).tangent.into() }
    }

    /// The stations between two others that make cubics near enough.
    fn between(&self, from: &Station, to: &Station, depth: usize, found: &mut Vec<Station>) {
        let Some(most) = self.interpolation else { return };
        let length = from.tangent.dot(&(&to.point.place - &from.point.place));
        let Ok(middle) = self.ahead(from, 0.5 * length, None) else { return };
        let [one, other, own] = [from, to, &middle].map(|it| self.node(it));
        let near = distance(&Cubic::between(&one, &other), &own.point) <= most;
        if depth < DEEPEST && !near {
            self.between(from, &middle, depth + 1, found);
        }
        found.push(middle.clone());
        if depth < DEEPEST && !near {
            self.between(&middle, to, depth + 1, found);
        }
    }

    /// Follows a curve in one direction, without its first point.
    fn half(&self, start: &Station, options: &BranchOptions) -> Half<Meeting, CurvePoint> {
        let (mut half, mut last) = (Half::default(), start.clone());
        let mut step = options.first_step;
        loop {
            if half.points.len() + 1 >= options.most_points {
                let most = options.most_points;
                half.object(format!("the curve goes on behind {most} points"));
                return half;
            }
            let (next, is_last) = match self.next(&last, step) {
                Ok(found) => found,
                Err(_) if 0.5 * step >= options.shortest_step => {
                    step *= 0.5;
                    continue;
                }
                Err(error) => {
                    let at = &last.point.orbit.parameters;
                    half.object(format!("the curve breaks off at {at:?}: {error}"));
                    return half;
                }
            };
            let mut meetings = self.meetings(&last, &next).unwrap_or_else(|error| {
                half.object(format!("a meeting is not located: {error}"));
                Vec::new()
            });
            let away = &start.point.place - &last.point.place;
            let along = last.tangent.dot(&away);
            half.closed = half.points.len() > 4
                && (0.0..=step).contains(&along)
                && (away - along * &last.tangent).norm() < 0.2 * step
                && last.tangent.dot(&start.tangent) > 0.9;
            // A curve of tori ends at its resonances.
            let ends = self.special.kind == SpecialKind::NeimarkSacker && !has_torus(&next.point);
            let resonance = ends.then(|| meetings.iter().position(Met::is_resonance));
            if let Some(place) = resonance {
                match place {
                    Some(place) => meetings.truncate(place + 1),
                    None => half.object("multipliers cease to be complex".to_owned()),
                }
            }
            let to = match (&resonance, half.closed) {
                (Some(Some(place)), _) => &meetings[*place].station,
                (_, true) => start,
                _ => &next,
            };
            let mut between = Vec::new();
            let mut from = &last;
            for cusp in meetings.iter().filter(|it| it.kind == SpecialKind::Cusp) {
                self.between(from, &cusp.station, 0, &mut between);
                from = &cusp.station;
            }
            self.between(from, to, 0, &mut between);
            let at =
                |station: &Station| last.tangent.dot(&(&station.point.place - &last.point.place));
            for meeting in &meetings {
                let before = between.iter().filter(|it| at(it) < at(&meeting.station)).count();
                let behind = half.points.len() + 1 + before;
                half.specials.push(self.named(meeting, behind));
            }
            half.points.extend(between.iter().map(|it| self.finished(it)));
            if half.closed || resonance == Some(None) {
                return half;
            }
            half.points.push(self.finished(to));
            self.along.orbits.watch.count();
            if is_last || ends {
                return half;
            }
            if last.tangent.dot(&next.tangent) > 0.995 {
                step = (1.5 * step).min(options.longest_step);
            }
            last = next;
        }
    }
}

/// How far a point is from a cubic near its middle.
pub(crate) fn distance(cubic: &Cubic, point: &Vector2<f64>) -> f64 {
    let mut t = 0.5;
    for _ in 0..4 {
        let along = cubic.derivative(t);
        let step = along.dot(&(point - cubic.at(t))) / along.norm_squared();
        if step.is_finite() {
            t = (t + step).clamp(0.0, 1.0);
        }
    }
    (point - cubic.at(t)).norm()
}
