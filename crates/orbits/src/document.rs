//! Orbits and branches as documents, for every format that serde writes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use stickslip_expression::{InvalidValue, System};

use crate::branch::curve::{Meeting, SpecialCurve};
use crate::branch::{Branch, SpecialKind, SpecialOrbit};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::itinerary::Leg;
use crate::orbit::{Obstacle, Orbit, Segment, Verdict};

/// The name of the layout of an orbit, with its version.
pub const ORBIT: &str = "stickslip.orbit/1";
/// The name of the layout of a branch, with its version.
pub const BRANCH: &str = "stickslip.orbit-branch/1";
/// The name of the layout of a curve of special orbits, with its version.
pub const CURVE: &str = "stickslip.orbit-curve/1";

/// An orbit with names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrbitRecord {
    /// The values of the parameters.
    pub parameters: BTreeMap<String, f64>,
    /// The time at the start.
    pub start: f64,
    /// The period.
    pub period: f64,
    /// Real and imaginary parts of the multipliers, the largest first; `null` at a graze.
    pub multipliers: Option<Vec<[f64; 2]>>,
    /// Whether the system follows the orbit by itself.
    pub admissible: bool,
    /// Why it does not.
    pub obstacle: Option<String>,
    /// Whether all multipliers are less than 1 in size.
    pub stable: bool,
    /// The largest error of a state or a duration, of its size.
    pub error: f64,
    /// The segments.
    pub segments: Vec<SegmentRecord>,
}

/// A segment with names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SegmentRecord {
    /// The mode.
    pub mode: String,
    /// The rule that ends the segment.
    pub rule: String,
    /// Its place in the mode.
    pub place: usize,
    /// The mode that follows.
    pub next: String,
    /// The duration.
    pub duration: f64,
    /// The state at the start, in the order of the components.
    pub state: Vec<f64>,
    /// The state at the end, before the rule acts.
    pub end: Vec<f64>,
    /// The rate of the rule's condition there.
    pub rate: f64,
}

/// A document of one orbit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrbitDocument {
    /// The name of the layout, [`ORBIT`].
    pub schema: String,
    /// The name of the system.
    pub system: String,
    /// The names of the components of states.
    pub components: Vec<String>,
    /// The orbit.
    pub orbit: OrbitRecord,
}

/// A document of a branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BranchDocument {
    /// The name of the layout, [`BRANCH`].
    pub schema: String,
    /// The name of the system.
    pub system: String,
    /// The names of the components of states.
    pub components: Vec<String>,
    /// The parameter.
    pub parameter: String,
    /// Its range.
    pub range: [f64; 2],
    /// The orbits, in the order of the branch.
    pub points: Vec<OrbitRecord>,
    /// The special orbits, in the order of the branch.
    pub specials: Vec<SpecialRecord>,
    /// Whether the branch comes back to its start.
    pub closed: bool,
    /// What speaks against the branch.
    pub objection: Option<String>,
}

/// A special orbit with names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpecialRecord {
    /// What changes.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// The number of points before it.
    pub behind: usize,
    /// The segment at which it happens.
    pub segment: Option<usize>,
    /// The name of the rule.
    pub rule: Option<String>,
    /// Its place in the mode of the segment.
    pub place: Option<usize>,
    /// The orbit.
    pub orbit: OrbitRecord,
}

impl Verdict {
    /// Why the system does not follow the orbit, in words.
    #[must_use]
    pub fn reason(&self, system: &System, orbit: &Orbit) -> Option<String> {
        let mode = |segment: usize| orbit.segments[segment].leg.mode;
        let name = |segment: usize| orbit.segments[segment].leg.name(system);
        match self {
            Self::Admissible => None,
            Self::Undecided(reason) => Some(format!("not decided: {reason}")),
            Self::Virtual(Obstacle::Acts { segment, rule, s }) => {
                let own = &system.modes[mode(*segment)].rules;
                let rule = own.get(*rule).map_or_else(String::new, |own| own.name(*rule));
                Some(format!("rule `{rule}` acts on segment {segment}, at t = {s:?}"))
            }
            Self::Virtual(Obstacle::Idle { segment }) => Some(format!(
                "rule `{}` does not act at the end of segment {segment}",
                name(*segment)
            )),
            Self::Virtual(Obstacle::Branches { segment, to }) => {
                let to = &system.modes[*to].name;
                Some(format!(
                    "rule `{}` leads to mode {to} behind segment {segment}",
                    name(*segment)
                ))
            }
            Self::Virtual(Obstacle::Backwards { segment }) => {
                Some(format!("the duration of segment {segment} is negative"))
            }
        }
    }
}

impl OrbitRecord {
    /// The orbit of a system with names.
    #[must_use]
    pub fn new(system: &System, orbit: &Orbit) -> Self {
        let names = system.parameters.iter().map(|it| it.name.clone());
        let mode = |place: usize| system.modes[place].name.clone();
        let segment = |it: &Segment| SegmentRecord {
            mode: mode(it.leg.mode),
            rule: it.leg.name(system),
            place: it.leg.rule,
            next: mode(it.leg.next),
            duration: it.duration,
            state: it.state.clone(),
            end: it.end.clone(),
            rate: it.rate,
        };
        Self {
            parameters: names.zip(orbit.parameters.iter().copied()).collect(),
            start: orbit.start,
            period: orbit.period,
            multipliers: orbit.multipliers.clone(),
            admissible: orbit.is_admissible(),
            obstacle: orbit.verdict.reason(system, orbit),
            stable: orbit.is_stable(),
            error: orbit.error,
            segments: orbit.segments.iter().map(segment).collect(),
        }
    }

    /// The orbit of a system, solved for and decided again.
    ///
    /// # Errors
    /// [`OrbitError`]: the record is not of this system, or there is no such orbit.
    pub fn orbit(&self, orbits: &Orbits) -> Result<Orbit, OrbitError> {
        let written = self.read(orbits)?;
        orbits.continued(&written, &written.parameters)
    }

    /// The orbit as it is written.
    fn read(&self, orbits: &Orbits) -> Result<Orbit, InvalidValue> {
        let system = orbits.system();
        let mode = |name: &str| {
            let place = system.modes.iter().position(|it| it.name == *name);
            place.ok_or_else(|| InvalidValue::new("mode", name, "a mode of the system"))
        };
        let value = |name: &String| {
            let value = self.parameters.get(name).copied();
            value.ok_or_else(|| InvalidValue::new("parameters", &**name, "a value for it"))
        };
        let names = system.parameters.iter().map(|it| value(&it.name));
        let parameters = names.collect::<Result<Vec<f64>, _>>()?;
        let mut segments = Vec::with_capacity(self.segments.len());
        for own in &self.segments {
            let leg = Leg { mode: mode(&own.mode)?, rule: own.place, next: mode(&own.next)? };
            let rules = &system.modes[leg.mode].rules;
            let known = rules.get(leg.rule).is_some_and(|it| it.name(leg.rule) == own.rule);
            InvalidValue::check("rule", &*own.rule, "the rule at its place in its mode", known)?;
            let (state, end) = (own.state.clone(), own.end.clone());
            segments.push(Segment { leg, state, duration: own.duration, end, rate: own.rate });
        }
        InvalidValue::check("segments", segments.len(), "at least 1", !segments.is_empty())?;
        Ok(Orbit {
            parameters,
            start: self.start,
            segments,
            period: self.period,
            multipliers: None,
            verdict: Verdict::Undecided("as it was written".to_owned()),
            error: self.error,
        })
    }
}

impl OrbitDocument {
    /// The document of an orbit. `name` is that of the system.
    #[must_use]
    pub fn new(orbits: &Orbits, name: &str, orbit: &Orbit) -> Self {
        let system = orbits.system();
        Self {
            schema: ORBIT.to_owned(),
            system: name.to_owned(),
            components: system.components.iter().map(|it| it.name.clone()).collect(),
            orbit: OrbitRecord::new(system, orbit),
        }
    }
}

impl BranchDocument {
    /// The document of a branch. `name` is that of the system.
    #[must_use]
    pub fn new(orbits: &Orbits, name: &str, branch: &Branch) -> Self {
        let system = orbits.system();
        let special = |it: &SpecialOrbit| {
            let mode = it.segment.map(|segment| it.orbit.segments[segment].leg.mode);
            let rule = mode.zip(it.rule);
            SpecialRecord {
                kind: it.kind,
                value: it.value,
                behind: it.behind,
                segment: it.segment,
                place: it.rule,
                rule: rule.map(|(mode, rule)| system.modes[mode].rules[rule].name(rule)),
                orbit: OrbitRecord::new(system, &it.orbit),
            }
        };
        Self {
            schema: BRANCH.to_owned(),
            system: name.to_owned(),
            components: system.components.iter().map(|it| it.name.clone()).collect(),
            parameter: system.parameters[branch.parameter].name.clone(),
            range: branch.range,
            points: branch.points.iter().map(|it| OrbitRecord::new(system, it)).collect(),
            specials: branch.specials.iter().map(special).collect(),
            closed: branch.closed,
            objection: branch.objection.clone(),
        }
    }
}

/// A document of a curve of special orbits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveDocument {
    /// The name of the layout, [`CURVE`].
    pub schema: String,
    /// The name of the system.
    pub system: String,
    /// The names of the components of states.
    pub components: Vec<String>,
    /// What changes along the curve.
    pub kind: SpecialKind,
    /// The parameters.
    pub parameters: [String; 2],
    /// The window, an interval for each parameter.
    pub window: [[f64; 2]; 2],
    /// The orbits, in the order of the curve.
    pub points: Vec<OrbitRecord>,
    /// Orbits at which something else changes too.
    pub meetings: Vec<MeetingRecord>,
    /// Whether the curve comes back to its start.
    pub closed: bool,
    /// What speaks against the curve.
    pub objection: Option<String>,
}

/// An orbit that is special twice, with names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeetingRecord {
    /// What changes besides.
    pub kind: SpecialKind,
    /// The segment at which it happens.
    pub segment: Option<usize>,
    /// The number of points before it.
    pub behind: usize,
    /// The orbit.
    pub orbit: OrbitRecord,
}

impl CurveDocument {
    /// The document of a curve. `name` is that of the system.
    #[must_use]
    pub fn new(orbits: &Orbits, name: &str, curve: &SpecialCurve) -> Self {
        let system = orbits.system();
        let meeting = |it: &Meeting| MeetingRecord {
            kind: it.kind,
            segment: it.segment,
            behind: it.behind,
            orbit: OrbitRecord::new(system, &it.orbit),
        };
        Self {
            schema: CURVE.to_owned(),
            system: name.to_owned(),
            components: system.components.iter().map(|it| it.name.clone()).collect(),
            kind: curve.kind,
            parameters: curve.parameters.map(|place| system.parameters[place].name.clone()),
            window: curve.window,
            points: curve.points.iter().map(|it| OrbitRecord::new(system, it)).collect(),
            meetings: curve.meetings.iter().map(meeting).collect(),
            closed: curve.closed,
            objection: curve.objection.clone(),
        }
    }
}

impl SpecialRecord {
    /// The special orbit of a system, as it is written.
    ///
    /// # Errors
    /// [`InvalidValue`]: the record is not of this system.
    pub fn special(&self, orbits: &Orbits) -> Result<SpecialOrbit, InvalidValue> {
        let orbit = self.orbit.read(orbits)?;
        let Self { kind, value, behind, segment, place, .. } = *self;
        Ok(SpecialOrbit { kind, value, behind, segment, rule: place, orbit })
    }
}
