//! Where a system begins or ceases to follow the orbits of a branch.

use stickslip_solver::{Direction, EmbeddedPair};

use super::point::{Along, Point};
use super::{SpecialKind, SpecialOrbit};
use crate::equations::{Equations, Event};
use crate::error::OrbitError;
use crate::itinerary::{Leg, modes_after};
use crate::orbit::{Obstacle, Verdict};

/// Halvings of a step before a function is sought that changes its sign.
const COARSE: usize = 6;
/// Halvings of a step, at most.
const FINE: usize = 44;

impl Along<'_> {
    /// Where the verdict changes between two neighbours, unless a special orbit is found there.
    pub fn change(
        &self,
        from: &Point,
        to: &Point,
        length: f64,
        found: &[(f64, SpecialOrbit)],
    ) -> Result<Option<(f64, SpecialOrbit)>, OrbitError> {
        let begins = from.orbit.is_admissible();
        if begins == to.orbit.is_admissible() {
            return Ok(None);
        }
        let (mut low, mut high) = (0.0, length);
        let [mut low_point, mut high_point] = [from.clone(), to.clone()];
        let narrow = 1e-13 * length;
        for round in 0..FINE {
            let explained = found.iter().any(|(at, special)| {
                special.segment.is_some() && (low - narrow..=high + narrow).contains(at)
            });
            if round >= COARSE {
                if explained {
                    return Ok(None);
                }
                let virtual_side = if begins { &high_point } else { &low_point };
                if round == COARSE
                    && let Some(special) =
                        self.named(from, [(low, &low_point), (high, &high_point)], virtual_side)
                {
                    return Ok(Some(special));
                }
            }
            if high - low <= narrow {
                break;
            }
            let mut middle = 0.5 * (low + high);
            let mut point = self.ahead(from, middle)?;
            // A point on the change itself has neither side.
            if round < COARSE && point.orbit.is_undecided() {
                middle = 0.625 * low + 0.375 * high;
                point = self.ahead(from, middle)?;
            }
            if point.orbit.is_admissible() == begins {
                (low, low_point) = (middle, point);
            } else {
                (high, high_point) = (middle, point);
            }
        }
        let special = self.special(SpecialKind::Boundary, None, None, high_point);
        Ok(Some((high, special)))
    }

    /// The special orbit between two points, if a function for what stands against the orbit
    /// changes its sign there.
    fn named(
        &self,
        from: &Point,
        [(low, low_point), (high, high_point)]: [(f64, &Point); 2],
        beyond: &Point,
    ) -> Option<(f64, SpecialOrbit)> {
        let Verdict::Virtual(obstacle) = &beyond.orbit.verdict else { return None };
        for (kind, segment, rule, margin) in self.margins(from, obstacle) {
            let values = (self.margin(&margin, low_point), self.margin(&margin, high_point));
            let (Some(one), Some(other)) = values else { continue };
            if (one < 0.0) == (other < 0.0) {
                continue;
            }
            let zero =
                self.zero(low_point, (high - low, one, other), |it| self.margin(&margin, it));
            // The tangent at the point below is not that at the start of the step.
            if let Ok(Some((at, point))) = zero {
                return Some((low + at, self.special(kind, Some(segment), rule, point)));
            }
        }
        None
    }

    /// The functions that may change their sign where an obstacle begins.
    pub fn margins(
        &self,
        from: &Point,
        obstacle: &Obstacle,
    ) -> Vec<(SpecialKind, usize, Option<usize>, Margin)> {
        let legs = self.equations.legs();
        let system = &self.orbits.system;
        // Whether a mode to which a rule leads slides along what the rule waits for.
        let slides = |leg: Leg, segment: usize| {
            let (above, below) = modes_after(leg.rule(system), leg.mode);
            [above, below].into_iter().any(|next| {
                next != leg.mode
                    && self.at_both_ends(from, segment, Leg { next, ..leg }, Event::slides_behind)
            })
        };
        match *obstacle {
            Obstacle::Acts { segment, rule, .. } => {
                let leg = Leg { rule, ..legs[segment] };
                let inner = self.touch(from, segment, slides(leg, segment));
                let corner = SpecialKind::CornerCollision;
                vec![
                    (inner, segment, Some(rule), Margin::Inner { segment, rule }),
                    (corner, segment, Some(rule), Margin::AtEnd { segment, rule }),
                    (corner, segment, Some(rule), Margin::AtStart { segment, rule }),
                ]
            }
            Obstacle::Branches { segment, .. } => {
                let own = from.evaluation.ends[segment].event.slides_behind();
                let edge = own || slides(legs[segment], segment);
                let kind = if edge { SpecialKind::SlidingEdge } else { SpecialKind::Choice };
                vec![(kind, segment, Some(legs[segment].rule), Margin::Choice { segment })]
            }
            Obstacle::Backwards { segment } => {
                let kind = SpecialKind::VanishingSegment;
                vec![(kind, segment, Some(legs[segment].rule), Margin::Duration { segment })]
            }
            Obstacle::Idle { .. } => Vec::new(),
        }
    }

    /// What a condition that touches zero on a segment is called. Its rule may lead to sliding
    /// along what is touched; or the segment slides, and the rule ends that.
    pub fn touch(&self, point: &Point, segment: usize, slides_behind: bool) -> SpecialKind {
        let own = self.equations.legs()[segment].mode;
        let modes = self.orbits.system.modes.iter().enumerate().filter(|(mode, _)| *mode != own);
        let mut ways = modes.flat_map(|(mode, it)| {
            let rules = it.rules.iter().enumerate();
            let leading = rules.filter(move |(_, rule)| {
                let (above, below) = modes_after(rule, mode);
                above == own || below == own
            });
            leading.map(move |(rule, _)| Leg { mode, rule, next: own })
        });
        let stays = |event: &Event| self.equations.is_at(event) && event.slides_behind();
        if slides_behind {
            SpecialKind::GrazingSliding
        } else if ways.any(|way| self.at_both_ends(point, segment, way, stays)) {
            SpecialKind::AddingSliding
        } else {
            SpecialKind::Grazing
        }
    }

    /// Whether something holds of the rule of a leg in the states at both ends of a segment.
    fn at_both_ends(
        &self,
        point: &Point,
        segment: usize,
        leg: Leg,
        holds: impl Fn(&Event) -> bool,
    ) -> bool {
        let (orbit, own) = (&point.orbit, &point.orbit.segments[segment]);
        [&own.state, &own.end].into_iter().all(|state| {
            let at = (orbit.start, &state[..]);
            holds(&Equations::event(&self.orbits.system, leg, &orbit.parameters, at))
        })
    }

    /// A function that is positive where there is no obstacle, if it has a value.
    pub fn margin(&self, margin: &Margin, point: &Point) -> Option<f64> {
        let orbit = &point.orbit;
        match *margin {
            Margin::Choice { segment } => Some(point.evaluation.ends[segment].event.choice),
            Margin::Duration { segment } => Some(orbit.segments[segment].duration),
            Margin::AtEnd { segment, rule } => {
                let end = &orbit.segments[segment].end;
                self.condition(point, (segment, rule), (orbit.time(segment + 1), end))
            }
            Margin::AtStart { segment, rule } => {
                let state = &orbit.segments[segment].state;
                self.condition(point, (segment, rule), (orbit.time(segment), state))
            }
            Margin::Inner { segment, rule } => {
                self.extrema(point, (segment, rule))?.into_iter().min_by(f64::total_cmp)
            }
        }
    }

    /// What a margin is measured by.
    pub fn margin_size(&self, margin: &Margin, point: &Point) -> Option<f64> {
        if let Margin::Choice { segment } = *margin {
            // What chooses whether to slide is a rate.
            let event = &point.evaluation.ends[segment].event;
            return Some(if event.slides_behind() { event.rate_size() } else { 0.0 });
        }
        if let Margin::Duration { .. } = margin {
            return Some(point.orbit.period.abs());
        }
        let (Margin::Inner { segment, rule }
        | Margin::AtEnd { segment, rule }
        | Margin::AtStart { segment, rule }) = *margin
        else {
            return Some(0.0);
        };
        let both = [Margin::AtStart { segment, rule }, Margin::AtEnd { segment, rule }];
        let [one, other] = both.map(|it| self.margin(&it, point));
        let inside = self.extrema(point, (segment, rule))?;
        let largest = inside.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        Some(largest.max(one?.abs()).max(other?.abs()))
    }

    /// The condition of a rule of the mode of a segment, so that it acts as it falls.
    fn condition(
        &self,
        point: &Point,
        (segment, rule): (usize, usize),
        (s, state): (f64, &[f64]),
    ) -> Option<f64> {
        let mode = self.equations.legs()[segment].mode;
        let watched = self.watches.of(&self.orbits.system, mode, rule)?;
        let mut value = [f64::NAN];
        watched.value.with(&point.orbit.parameters).run(s, state, &mut value);
        Some(if watched.direction == Direction::Rising { -value[0] } else { value[0] })
    }

    /// The extrema of the condition of a rule inside a segment. They are events of its rate, which
    /// bounds decide.
    fn extrema(&self, point: &Point, (segment, rule): (usize, usize)) -> Option<Vec<f64>> {
        let leg = self.equations.legs()[segment];
        let watched = self.watches.of(&self.orbits.system, leg.mode, rule)?;
        let orbit = &point.orbit;
        let (own, start) = (&orbit.segments[segment], orbit.time(segment));
        let runnable = watched.extrema.with(&orbit.parameters).ok()?;
        let runnable = runnable.starting(Some(leg.mode), Some(start), Some(&own.state)).ok()?;
        let mut events = Vec::new();
        let end = start + own.duration;
        let run = runnable.events(EmbeddedPair::Dop853, end, &self.orbits.options, &mut events);
        let _ = run.ok()?;
        let at_start = self.condition(point, (segment, rule), (start, &own.state))?;
        // What acts in both directions acts from the side on which the segment is.
        let turned = watched.direction == Direction::Either && at_start < 0.0;
        let sign = if turned { -1.0 } else { 1.0 };
        let values = events
            .iter()
            .filter_map(|event| self.condition(point, (segment, rule), (event.s, &event.before)));
        Some(values.map(|value| sign * value).collect())
    }
}

/// A function along a branch that changes its sign where an obstacle begins.
#[derive(Clone, PartialEq)]
pub(crate) enum Margin {
    /// The least extremum of a rule's condition inside a segment.
    Inner { segment: usize, rule: usize },
    /// The condition at the end of a segment.
    AtEnd { segment: usize, rule: usize },
    /// The condition at its start.
    AtStart { segment: usize, rule: usize },
    /// What chooses the mode behind a segment.
    Choice { segment: usize },
    /// The duration of a segment.
    Duration { segment: usize },
}
