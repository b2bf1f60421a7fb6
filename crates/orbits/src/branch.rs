//! Branches: an orbit followed over a parameter, by pseudo-arclength.
//!
//! The equations of an orbit are smooth through folds and through grazes, so a branch goes through
//! both. Behind a graze it may be an orbit of its equations that the system does not follow: it is
//! kept, and each point says so. `point` steps along the branch, `test` has the functions that are
//! zero at special orbits (some are bordered matrices, `borders`), `locate` finds their zeros,
//! `meet` where branches meet, and `change` where the verdict changes, by conditions that `watches`
//! has. `curve` follows special orbits over two parameters, and `switched` goes over to another
//! branch.

mod borders;
mod change;
pub(crate) mod curve;
mod locate;
mod meet;
pub(crate) mod point;
mod switched;
mod test;
pub(crate) mod watches;

use stickslip_expression::InvalidValue;

use crate::equations::Equations;
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::orbit::Orbit;
use point::{Along, Point};
use watches::Watches;

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
            Self::Boundary => "boundary",
        }
    }
}

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
    /// Both ends together, with the point between them.
    fn joined(
        mut self,
        start: P,
        back: Option<Self>,
        behind: impl Fn(&mut S) -> &mut usize,
    ) -> Self {
        let mut joined = back.unwrap_or_default();
        let before = joined.points.len();
        joined.points.reverse();
        joined.specials.reverse();
        for special in &mut joined.specials {
            let own = behind(special);
            *own = before + 1 - *own;
        }
        for special in &mut self.specials {
            *behind(special) += before;
        }
        joined.points.push(start);
        joined.points.append(&mut self.points);
        joined.specials.append(&mut self.specials);
        joined.closed = self.closed;
        joined.objection = match (self.objection, joined.objection) {
            (Some(one), Some(other)) => Some(format!("{one}; {other}")),
            (one, other) => one.or(other),
        };
        joined
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
        let draft = orbit.draft();
        let active = [(parameter, high - low)];
        let equations = Equations::new(&self.system, draft.clone(), &active, &self.options)?;
        let (range, judged) = ([low, high], true);
        let along = Along {
            orbits: self,
            equations: &equations,
            parameter,
            range,
            judged,
            watches: Watches::default(),
        };
        let start = along.first(&draft)?;
        let ahead = self.half(&along, &start, options);
        let back = (!ahead.closed).then(|| self.half(&along, &start.turned(), options));
        let Half { points, specials, closed, objection } =
            ahead.joined(start.orbit, back, |special| &mut special.behind);
        Ok(Branch { parameter, range, points, specials, closed, objection })
    }

    /// The value of the parameter at a point, in words.
    fn at(&self, along: &Along<'_>, point: &Point) -> String {
        let name = &self.system.parameters[along.parameter].name;
        format!("{name} = {:?}", along.value(&point.place))
    }

    /// Follows a branch in one direction, without its first point.
    fn half(
        &self,
        along: &Along<'_>,
        start: &Point,
        options: &BranchOptions,
    ) -> Half<SpecialOrbit> {
        let mut half = Half::default();
        let mut last = start.clone();
        let mut step = options.first_step;
        while !along.is_at_end(&last) {
            if half.points.len() + 1 >= options.most_points {
                half.objection =
                    Some(format!("the branch goes on behind {} points", options.most_points));
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
                    half.objection = Some(format!("the branch breaks off at {at}: {error}"));
                    break;
                }
            };
            let turn = last.tangent.dot(&next.tangent);
            half.closed = half.points.len() > 4 && last.passes(&next, start);
            match along.specials(&last, &next) {
                Ok(found) => {
                    let behind = half.points.len() + 1;
                    let found = found.into_iter();
                    half.specials.extend(found.map(|it| SpecialOrbit { behind, ..it }));
                }
                Err(error) => {
                    half.objection = Some(format!(
                        "what changes near {} is not located: {error}",
                        self.at(along, &last)
                    ));
                }
            }
            if half.closed {
                break;
            }
            half.points.push(next.orbit.clone());
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
