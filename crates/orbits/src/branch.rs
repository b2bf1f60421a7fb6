//! Branches: an orbit followed over a parameter, by pseudo-arclength.
//!
//! The equations of an orbit are smooth through folds and through grazes, so a branch goes through
//! both. Behind a graze it may be an orbit of its equations that the system does not follow: it is
//! kept, and each point says so. `point` steps along the branch, `test` has the functions that are
//! zero at special orbits (some are bordered matrices, `borders`), `locate` finds their zeros,
//! `meet` where branches meet, `change` where the verdict changes, by conditions that `watches`
//! has, and `endless` where the period grows without bound. `curve` follows special orbits over two
//! parameters, `switched` goes over to another branch, and `resumed` goes on with a branch that was
//! written.

mod borders;
mod change;
pub(crate) mod curve;
mod endless;
mod locate;
mod meet;
pub(crate) mod point;
mod resumed;
mod switched;
mod test;
pub(crate) mod watches;

use stickslip_expression::InvalidValue;

use crate::equations::Equations;
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::orbit::Orbit;
use endless::{Rest, Steps};
use point::{Along, Point};

/// How a branch is followed. Lengths are in unknowns of size 1: states over their largest value,
/// times over the period, the parameter over the length of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BranchOptions {
    /// The first step.
    pub first_step: f64,
    /// The longest step.
    pub longest_step: f64,
    /// A branch that needs shorter steps ends, with an objection.
    pub shortest_step: f64,
    /// The greatest number of points.
    pub most_points: usize,
}

impl Default for BranchOptions {
    fn default() -> Self {
        Self { first_step: 0.01, longest_step: 0.05, shortest_step: 1e-7, most_points: 2000 }
    }
}

impl BranchOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first field that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let Self { first_step, longest_step, shortest_step, most_points } = *self;
        let check = |name: &'static str, value: f64, low: f64, high: f64| {
            let expected = format!("{low:e} to {high:?}");
            InvalidValue::check(name, value, expected, (low..=high).contains(&value))
        };
        check("shortest_step", shortest_step, 1e-12, 1e-2)?;
        check("longest_step", longest_step, shortest_step, 1.0)?;
        check("first_step", first_step, shortest_step, longest_step)?;
        let accepted = (2..=1_000_000).contains(&most_points);
        InvalidValue::check("most_points", most_points, "2 to 1000000", accepted)
    }
}

/// Orbits over a parameter. Parameters, orbits and rules are places in a system, or records with
/// names.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Branch<P = usize, O = Orbit, R = Option<usize>> {
    /// The parameter, by its place in the system.
    pub parameter: P,
    /// Its range.
    pub range: [f64; 2],
    /// The orbits, in the order of the branch.
    pub points: Vec<O>,
    /// The special orbits, in the order of the branch.
    pub specials: Vec<SpecialOrbit<O, R>>,
    /// Whether the branch comes back to its start.
    pub closed: bool,
    /// Why the branch is not complete, or not known as well as others are.
    pub objection: Option<String>,
}

/// An orbit at which something changes along a branch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpecialOrbit<O = Orbit, R = Option<usize>> {
    /// What changes.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// The number of points of the branch before it.
    pub behind: usize,
    /// The segment at which it happens, if it happens at one.
    pub segment: Option<usize>,
    /// The rule, by its place in the mode of the segment.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub rule: R,
    /// The orbit.
    pub orbit: O,
}

/// What changes at a special orbit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum SpecialKind {
    /// The parameter turns back, with the multiplier 1.
    Fold,
    /// The multiplier is −1.
    Flip,
    /// Two complex multipliers have the size 1.
    NeimarkSacker,
    /// Two curves of folds meet and turn back: only on a curve.
    Cusp,
    /// Two branches meet.
    BranchPoint,
    /// A condition touches zero.
    Grazing,
    /// A condition touches a surface along which the mode behind it slides.
    GrazingSliding,
    /// The condition for leaving a surface touches zero while the orbit slides.
    AddingSliding,
    /// An event lies on the edge of where a surface is slid along: crossing- or switching-sliding.
    SlidingEdge,
    /// Two conditions are zero at one event.
    CornerCollision,
    /// What chooses between two modes is zero.
    Choice,
    /// The duration of a segment is zero.
    VanishingSegment,
    /// The period grows without bound, and the branch ends.
    InfinitePeriod,
    /// The system begins or ends to follow the orbit, for a reason that is not named.
    Boundary,
}

impl SpecialKind {
    /// The name, as documents have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Flip => "flip",
            Self::NeimarkSacker => "neimark-sacker",
            Self::Cusp => "cusp",
            Self::BranchPoint => "branch-point",
            Self::Grazing => "grazing",
            Self::GrazingSliding => "grazing-sliding",
            Self::AddingSliding => "adding-sliding",
            Self::SlidingEdge => "sliding-edge",
            Self::CornerCollision => "corner-collision",
            Self::Choice => "choice",
            Self::VanishingSegment => "vanishing-segment",
            Self::InfinitePeriod => "infinite-period",
            Self::Boundary => "boundary",
        }
    }
}

/// What is said of a change between two points of a branch that is not found.
const NOT_LOCATED: &str = "is not located";
/// Steps are divided down to this length where several multipliers pass the unit circle.
const TOGETHER: f64 = 1e-4;

/// One end of a branch or a curve, or both together. What is special has the number of points
/// before it.
struct Half<S, P = Orbit> {
    points: Vec<P>,
    specials: Vec<S>,
    closed: bool,
    objection: Option<String>,
}

impl<S, P> Default for Half<S, P> {
    fn default() -> Self {
        Self { points: Vec::new(), specials: Vec::new(), closed: false, objection: None }
    }
}

impl<S, P> Half<S, P> {
    /// Says what is not known, besides what is said already.
    fn object(&mut self, reason: String) {
        self.objection = match self.objection.take() {
            Some(before) => Some(format!("{before}; {reason}")),
            None => Some(reason),
        };
    }

    /// Both ends together, with at least one point between them.
    fn joined(
        mut self,
        mut middle: Self,
        back: Option<Self>,
        behind: impl Fn(&mut S) -> &mut usize,
    ) -> Self {
        let mut joined = back.unwrap_or_default();
        let before = joined.points.len();
        let last = before + middle.points.len() - 1;
        joined.points.reverse();
        joined.specials.reverse();
        for special in &mut joined.specials {
            let own = behind(special);
            *own = before + 1 - *own;
        }
        for special in &mut middle.specials {
            *behind(special) += before;
        }
        for special in &mut self.specials {
            *behind(special) += last;
        }
        joined.points.append(&mut middle.points);
        joined.points.append(&mut self.points);
        joined.specials.append(&mut middle.specials);
        joined.specials.append(&mut self.specials);
        joined.closed = self.closed;
        [middle.objection, self.objection].into_iter().flatten().for_each(|it| joined.object(it));
        joined
    }
}

impl SpecialOrbit {
    /// Refuses a segment or a rule that the orbit does not have.
    fn require_of(&self, orbits: &Orbits) -> Result<(), InvalidValue> {
        let segments = &self.orbit.segments;
        let segment = self.segment.unwrap_or(0);
        let expected = format!("one of {} segments", segments.len());
        InvalidValue::check("the segment", segment, expected, segment < segments.len())?;
        let rules = orbits.system.modes.get(segments[segment].leg.mode);
        let rules = rules.map_or(0, |mode| mode.rules.len());
        let (rule, expected) = (self.rule.unwrap_or(0), format!("one of {rules} rules"));
        InvalidValue::check("the rule", rule, expected, self.rule.is_none() || rule < rules)
    }
}

impl Half<SpecialOrbit> {
    fn branch(self, parameter: usize, range: [f64; 2]) -> Branch {
        let Self { points, specials, closed, objection } = self;
        Branch { parameter, range, points, specials, closed, objection }
    }
}

impl Orbits {
    /// The branch of an orbit over a range of a parameter, in both directions from the orbit.
    ///
    /// # Errors
    /// [`OrbitError`] if the branch does not begin; where it breaks off later,
    /// [`Branch::objection`] says why.
    pub fn branch(
        &self,
        orbit: &Orbit,
        parameter: usize,
        [low, high]: [f64; 2],
        options: &BranchOptions,
    ) -> Result<Branch, OrbitError> {
        options.validate()?;
        self.compiled.with(&orbit.parameters)?;
        self.require_range(orbit, parameter, [low, high])?;
        let equations = self.along_parameter(orbit, parameter, [low, high])?;
        let along = Along::new(self, &equations, parameter, [low, high]);
        let start = along.first(&orbit.draft())?;
        let ahead = self.half(&along, &start, None, options);
        let back = (!ahead.closed).then(|| self.half(&along, &start.turned(), None, options));
        let middle = Half { points: vec![start.orbit], ..Half::default() };
        let whole = ahead.joined(middle, back, |special| &mut special.behind);
        Ok(whole.branch(parameter, [low, high]))
    }

    /// The equations of an orbit with a parameter that has a range.
    fn along_parameter(
        &self,
        orbit: &Orbit,
        parameter: usize,
        [low, high]: [f64; 2],
    ) -> Result<Equations, OrbitError> {
        Equations::new(&self.system, orbit.draft(), &[(parameter, high - low)], &self.options)
    }

    /// The value of the parameter at a point, in words.
    fn at(&self, along: &Along<'_>, point: &Point) -> String {
        let name = &self.system.parameters[along.parameter].name;
        format!("{name} = {:?}", along.value(&point.place))
    }

    /// Follows a branch in one direction, without its first point. It is closed where it comes back
    /// to its start, or to the other end of what is known.
    fn half(
        &self,
        along: &Along<'_>,
        start: &Point,
        other: Option<&Point>,
        options: &BranchOptions,
    ) -> Half<SpecialOrbit> {
        let mut half = Half::default();
        let (closes, soonest) = other.map_or((start, 5), |other| (other, 0));
        let mut last = start.clone();
        let mut step = options.first_step;
        let mut steps = Steps::new(&start.orbit, along.parameter, along.range);
        while !along.is_at_end(&last) {
            if half.points.len() + 1 >= options.most_points {
                half.object(format!("the branch goes on behind {} points", options.most_points));
                break;
            }
            let next = match along.step(&last, step) {
                // On a change itself neither side is seen: a point before it is as good.
                Ok(next) if next.orbit.is_undecided() && !last.orbit.is_undecided() => {
                    along.step(&last, 0.9 * step).unwrap_or(next)
                }
                Ok(next) => next,
                Err(_) if 0.5 * step >= options.shortest_step => {
                    step *= 0.5;
                    continue;
                }
                Err(error) => {
                    let at = self.at(along, &last);
                    half.object(format!("the branch breaks off at {at}: {error}"));
                    break;
                }
            };
            let turn = last.tangent.dot(&next.tangent);
            let found = along.specials(&last, &next);
            if let Ok(found) = &found
                && locate::passes_unseen(&last.orbit, &next.orbit, found)
            {
                let length = last.tangent.dot(&(&next.place - &last.place));
                if length > TOGETHER {
                    step = 0.5 * length;
                    continue;
                }
                let at = self.at(along, &last);
                half.object(format!("several multipliers pass the unit circle at once near {at}"));
            }
            half.closed = half.points.len() >= soonest && last.passes(&next, closes);
            match found {
                Ok(found) => {
                    let behind = half.points.len() + 1;
                    let found = found.into_iter();
                    half.specials.extend(found.map(|it| SpecialOrbit { behind, ..it }));
                }
                Err(error) => {
                    let at = self.at(along, &last);
                    half.object(format!("what changes near {at} {NOT_LOCATED}: {error}"));
                }
            }
            if half.closed {
                break;
            }
            half.points.push(next.orbit.clone());
            self.watch.count();
            match steps.rest(&next.orbit) {
                Some(Rest::Endless(segment)) => {
                    let (behind, kind) = (half.points.len() + 1, SpecialKind::InfinitePeriod);
                    let special = along.special(kind, Some(segment), None, next);
                    half.specials.push(SpecialOrbit { behind, ..special });
                    break;
                }
                Some(Rest::Upright) => {
                    let at = self.at(along, &next);
                    half.object(format!("the branch goes on at {at} alone"));
                    break;
                }
                None => {}
            }
            if turn > 0.995 {
                step = (1.5 * step).min(options.longest_step);
            } else if turn < 0.98 {
                step *= 0.7;
            }
            last = next;
        }
        half
    }
}
