//! Orbits of a curve at which something else changes too.

use super::super::borders::Borders;
use super::super::change::Margin;
use super::super::locate::zero;
use super::super::test::Test;
use super::{Follower, Meeting, SpecialKind, Station, Tracked};
use crate::error::OrbitError;
use crate::orbit::Obstacle;

/// Conditions below this part of their largest value on a segment are zero by themselves.
const ZERO: f64 = 1e-9;
/// Two zeros of one kind so near each other, in parts of a step, are one.
const BESIDE: f64 = 0.01;

/// A meeting that was located.
pub(super) struct Met {
    pub kind: SpecialKind,
    pub segment: Option<usize>,
    pub station: Station,
}

impl Met {
    /// Whether it is an end of a curve of tori.
    pub fn is_resonance(&self) -> bool {
        matches!(self.kind, SpecialKind::Fold | SpecialKind::Flip)
    }
}

/// What may change its sign at a meeting.
enum Sought {
    Test(SpecialKind, Option<usize>, Test),
    /// The margin against an obstacle, which says what its zero is called.
    Margin(Obstacle, Margin),
    /// The direction in the plane of the parameters, along that at the start.
    Cusp,
}

impl Follower<'_> {
    /// What a meeting is called, with the number of points before it.
    pub fn named(&self, met: &Met, behind: usize) -> Meeting {
        let &Met { kind, segment, ref station } = met;
        let own = self.special.kind;
        let (one, other) = if own < kind { (own, kind) } else { (kind, own) };
        let name = match (one, other) {
            (SpecialKind::Fold, SpecialKind::NeimarkSacker) => "resonance-1-1".to_owned(),
            (SpecialKind::Flip, SpecialKind::NeimarkSacker) => "resonance-1-2".to_owned(),
            (SpecialKind::Grazing, SpecialKind::Grazing) => "double-graze".to_owned(),
            (_, SpecialKind::Cusp) => "cusp".to_owned(),
            (one, other) => format!("{}-{}", one.name(), other.name()),
        };
        let point = self.finished(station);
        Meeting { name, kind, tangent: point.tangent, segment, behind, orbit: point.orbit }
    }

    /// Where something else changes between two stations, in order.
    pub fn meetings(&self, from: &Station, to: &Station) -> Result<Vec<Met>, OrbitError> {
        let length = from.tangent.dot(&(&to.point.place - &from.point.place));
        let mut found: Vec<(f64, Met)> = Vec::new();
        for sought in self.sought(&from.tracked, from) {
            let values = [from, to].map(|station| self.sought_value(&sought, from, station));
            let [Some(one), Some(other)] = values else { continue };
            if (one < 0.0) == (other < 0.0) || other == 0.0 {
                continue;
            }
            // What is zero at every orbit does not change.
            let changes = [(from, one), (to, other)].into_iter().all(|(station, value)| {
                self.least(&sought, station).is_some_and(|least| value.abs() >= least)
            });
            if !changes {
                continue;
            }
            let place = zero((length, one, other), |at| {
                let station = self.ahead(from, at, None)?;
                Ok(self.sought_value(&sought, from, &station).map(|value| (value, station)))
            })?;
            let Some((at, station)) = place else { continue };
            let (kind, segment) = match &sought {
                Sought::Test(SpecialKind::NeimarkSacker, ..)
                    if !matches!(self.special.kind, SpecialKind::Fold | SpecialKind::Flip)
                        && !super::has_torus(&station.point) =>
                {
                    continue;
                }
                Sought::Test(kind, segment, _) => (*kind, *segment),
                Sought::Margin(obstacle, margin) => {
                    let known = self.along.margins(&from.point, obstacle);
                    let Some(own) = known.into_iter().find(|it| it.3 == *margin) else { continue };
                    (own.0, Some(own.1))
                }
                Sought::Cusp => {
                    let size = self.plane_tangent(&station.tangent).norm();
                    if size > 1e-3 * self.plane_tangent(&from.tangent).norm() {
                        continue;
                    }
                    (SpecialKind::Cusp, None)
                }
            };
            // The least extremum of a condition is zero where its rate at the event is.
            let same = |(other, met): &(f64, Met)| {
                (met.kind, met.segment) == (kind, segment) && (at - other).abs() <= BESIDE * length
            };
            if matches!(sought, Sought::Test(..)) || !found.iter().any(same) {
                found.push((at, Met { kind, segment, station }));
            }
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(found.into_iter().map(|(_, met)| met).collect())
    }

    fn sought(&self, own: &Tracked, from: &Station) -> Vec<Sought> {
        let equations = self.along.equations;
        let slopes = &from.point.evaluation.slopes;
        let bordered = |factor: f64| Borders::of(&equations.returning(slopes, factor));
        let kind = self.special.kind;
        let mut all = Vec::new();
        if kind == SpecialKind::Fold {
            all.push(Sought::Cusp);
        } else {
            all.push(Sought::Test(SpecialKind::Fold, None, Test::Singular(bordered(1.0))));
        }
        if kind != SpecialKind::Flip {
            all.push(Sought::Test(SpecialKind::Flip, None, Test::Flip(bordered(-1.0))));
        }
        if kind != SpecialKind::NeimarkSacker {
            all.push(Sought::Test(SpecialKind::NeimarkSacker, None, Test::NeimarkSacker));
        }
        let is_own = |margin: &Margin| matches!(own, Tracked::Margin(own) if own == margin);
        for (segment, leg) in equations.legs().iter().enumerate() {
            let grazes = matches!(own, Tracked::Test(Test::Rate(own)) if *own == segment);
            if !grazes {
                let test = Test::Rate(segment);
                all.push(Sought::Test(SpecialKind::Grazing, Some(segment), test));
            }
            let rules = self.along.orbits.system.modes[leg.mode].rules.len();
            for rule in (0..rules).filter(|rule| !(grazes && *rule == leg.rule)) {
                let acts = || Obstacle::Acts { segment, rule, s: f64::NAN };
                all.push(Sought::Margin(acts(), Margin::Inner { segment, rule }));
                if rule != leg.rule {
                    all.push(Sought::Margin(acts(), Margin::AtEnd { segment, rule }));
                }
            }
            let branches = Obstacle::Branches { segment, to: leg.next };
            all.push(Sought::Margin(branches, Margin::Choice { segment }));
            let backwards = Obstacle::Backwards { segment };
            all.push(Sought::Margin(backwards, Margin::Duration { segment }));
        }
        all.retain(|it| !matches!(it, Sought::Margin(_, margin) if is_own(margin)));
        all
    }

    /// What is as small as this is zero by rounding.
    fn least(&self, sought: &Sought, station: &Station) -> Option<f64> {
        match sought {
            Sought::Margin(_, margin) => {
                Some(ZERO * self.along.margin_size(margin, &station.point)?)
            }
            // Both walls are grazed at once by orbits that are symmetric.
            Sought::Test(_, _, Test::Rate(segment)) => {
                let rule = self.along.equations.legs()[*segment].rule;
                let margin = Margin::Inner { segment: *segment, rule };
                let size = self.along.margin_size(&margin, &station.point)?;
                Some(ZERO * size / station.point.orbit.period.abs())
            }
            _ => Some(0.0),
        }
    }

    fn sought_value(&self, sought: &Sought, from: &Station, station: &Station) -> Option<f64> {
        match sought {
            Sought::Test(_, _, test) => test.value(&self.along, &station.point),
            Sought::Margin(_, margin) => self.along.margin(margin, &station.point),
            Sought::Cusp => {
                let along = self.plane_tangent(&from.tangent);
                Some(along.dot(&self.plane_tangent(&station.tangent)))
            }
        }
    }
}
