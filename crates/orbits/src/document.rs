//! Orbits and branches as documents, for every format that serde writes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use stickslip_expression::{InvalidValue, System};

use crate::branch::curve::{Meeting, SpecialCurve};
use crate::branch::{Branch, SpecialOrbit};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::itinerary::Leg;
use crate::orbit::{Obstacle, Orbit, Segment, Verdict};
use crate::regions::{FollowedOrbits, OrbitAtlas, OrbitBoundary, OrbitNames, RegionOptions};

/// The name of the layout of an orbit, with its version.
pub const ORBIT: &str = "stickslip.orbit/1";
/// The name of the layout of a branch, with its version.
pub const BRANCH: &str = "stickslip.orbit-branch/1";
/// The name of the layout of a curve of special orbits, with its version.
pub const CURVE: &str = "stickslip.orbit-curve/1";

/// The name of the layout of regions of an orbit, with its version.
pub const REGIONS: &str = "stickslip.orbit-regions/1";

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
    /// Whether all multipliers are less than 1 in size, by more than their errors.
    pub stable: bool,
    /// The largest error of a state or a duration, of its size.
    pub error: f64,
    /// The segments.
    pub segments: Vec<Segment<LegRecord>>,
}

/// The leg of a segment with names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LegRecord {
    /// The mode.
    pub mode: String,
    /// The rule that ends the segment.
    pub rule: String,
    /// Its place in the mode.
    pub place: usize,
    /// The mode that follows.
    pub next: String,
}

/// The rule of a special orbit, if there is one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RuleRecord {
    /// The name.
    pub rule: Option<String>,
    /// The place in the mode of the segment.
    pub place: Option<usize>,
}

/// A branch with names.
pub type BranchRecord = Branch<String, OrbitRecord, RuleRecord>;
/// A special orbit with names.
pub type SpecialRecord = SpecialOrbit<OrbitRecord, RuleRecord>;
/// A curve of special orbits with names.
pub type CurveRecord = SpecialCurve<String, OrbitRecord>;

/// A document of an orbit, a branch or a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document<T> {
    /// The name of the layout: [`ORBIT`], [`BRANCH`], [`CURVE`] or [`REGIONS`].
    pub schema: String,
    /// The name of the system.
    pub system: String,
    /// The names of the components of states.
    pub components: Vec<String>,
    /// What it holds.
    #[serde(flatten)]
    pub content: T,
}

/// What a document of one orbit holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OneOrbit {
    /// The orbit.
    pub orbit: OrbitRecord,
}

/// What a document of regions of an orbit holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrbitRegions {
    /// The orbit from which they were found.
    pub orbit: OrbitRecord,
    /// The regions, in the layout of every atlas.
    pub atlas: stickslip_tracer::document::FamilyAtlasDocument<FollowedOrbits, OrbitBoundary>,
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
        let leg = |leg: Leg| LegRecord {
            mode: mode(leg.mode),
            rule: leg.name(system),
            place: leg.rule,
            next: mode(leg.next),
        };
        let segment = |it: &Segment| it.clone().with(leg(it.leg));
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
            let LegRecord { mode: name, rule, place, next } = &own.leg;
            let leg = Leg { mode: mode(name)?, rule: *place, next: mode(next)? };
            let rules = &system.modes[leg.mode].rules;
            let known = rules.get(leg.rule).is_some_and(|it| it.name(leg.rule) == *rule);
            InvalidValue::check("rule", &**rule, "the rule at its place in its mode", known)?;
            segments.push(own.clone().with(leg));
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

impl<T> Document<T> {
    fn new(orbits: &Orbits, schema: &str, name: &str, content: T) -> Self {
        let components = orbits.system().components.iter().map(|it| it.name.clone()).collect();
        Self { schema: schema.to_owned(), system: name.to_owned(), components, content }
    }
}

impl Document<OneOrbit> {
    /// The document of an orbit. `name` is that of the system.
    #[must_use]
    pub fn of_orbit(orbits: &Orbits, name: &str, orbit: &Orbit) -> Self {
        let orbit = OrbitRecord::new(orbits.system(), orbit);
        Self::new(orbits, ORBIT, name, OneOrbit { orbit })
    }
}

impl Document<BranchRecord> {
    /// The document of a branch. `name` is that of the system.
    #[must_use]
    pub fn of_branch(orbits: &Orbits, name: &str, branch: &Branch) -> Self {
        let system = orbits.system();
        let special = |it: &SpecialOrbit| {
            let mode = it.segment.map(|segment| it.orbit.segments[segment].leg.mode);
            let name = |(mode, place): (usize, usize)| system.modes[mode].rules[place].name(place);
            let rule = RuleRecord { rule: mode.zip(it.rule).map(name), place: it.rule };
            let SpecialOrbit { kind, value, behind, segment, .. } = *it;
            let orbit = OrbitRecord::new(system, &it.orbit);
            SpecialOrbit { kind, value, behind, segment, rule, orbit }
        };
        let branch = Branch {
            parameter: system.parameters[branch.parameter].name.clone(),
            range: branch.range,
            points: branch.points.iter().map(|it| OrbitRecord::new(system, it)).collect(),
            specials: branch.specials.iter().map(special).collect(),
            closed: branch.closed,
            objection: branch.objection.clone(),
        };
        Self::new(orbits, BRANCH, name, branch)
    }

    /// The branch. Its orbits are looked at again: each is one of this system, and whether the
    /// system follows it is decided anew.
    ///
    /// # Errors
    /// [`OrbitError`]: the document is not of a branch of this system.
    pub fn branch(&self, orbits: &Orbits) -> Result<Branch, OrbitError> {
        let (system, content) = (orbits.system(), &self.content);
        let expected = format!("{BRANCH:?}");
        InvalidValue::check("schema", &*self.schema, expected, self.schema == BRANCH)?;
        let own: Vec<&str> = system.components.iter().map(|it| &*it.name).collect();
        let expected = format!("those of the system, {}", own.join(", "));
        let found = self.components.join(", ");
        InvalidValue::check("components", &*found, expected, self.components == own)?;
        let name = &content.parameter;
        let parameter = system.parameters.iter().position(|it| it.name == *name);
        let unknown = || InvalidValue::new("parameter", &**name, "a parameter of the system");
        let points = content.points.iter().map(|it| it.read(orbits));
        let specials = content.specials.iter().map(|it| it.special(orbits));
        orbits.reread(Branch {
            parameter: parameter.ok_or_else(unknown)?,
            range: content.range,
            points: points.collect::<Result<_, _>>()?,
            specials: specials.collect::<Result<_, _>>()?,
            closed: content.closed,
            objection: content.objection.clone(),
        })
    }
}

impl Document<CurveRecord> {
    /// The document of a curve. `name` is that of the system.
    #[must_use]
    pub fn of_curve(orbits: &Orbits, name: &str, curve: &SpecialCurve) -> Self {
        let system = orbits.system();
        let meeting = |it: &Meeting| {
            let Meeting { kind, segment, behind, tangent, .. } = *it;
            let (name, orbit) = (it.name.clone(), OrbitRecord::new(system, &it.orbit));
            Meeting { name, kind, tangent, segment, behind, orbit }
        };
        let curve = SpecialCurve {
            kind: curve.kind,
            parameters: curve.parameters.map(|place| system.parameters[place].name.clone()),
            window: curve.window,
            points: curve.points.iter().map(|it| OrbitRecord::new(system, it)).collect(),
            tangents: curve.tangents.clone(),
            meetings: curve.meetings.iter().map(meeting).collect(),
            closed: curve.closed,
            objection: curve.objection.clone(),
        };
        Self::new(orbits, CURVE, name, curve)
    }
}

impl Document<OrbitRegions> {
    /// The document of the regions of an orbit, which were found with `options`. `name` is that of
    /// the system.
    #[must_use]
    pub fn of_regions(
        orbits: &Orbits,
        name: &str,
        (orbit, parameters): (&Orbit, [usize; 2]),
        atlas: &OrbitAtlas,
        options: &RegionOptions,
    ) -> Self {
        let system = orbits.system();
        let axes = parameters.map(|place| &*system.parameters[place].name);
        let options = options.of_atlas(atlas.plane.window());
        let atlas =
            stickslip_tracer::document::FamilyAtlasDocument::new(atlas, &options, name, axes);
        let orbit = OrbitRecord::new(system, orbit);
        Self::new(orbits, REGIONS, name, OrbitRegions { orbit, atlas })
    }

    /// The regions, and their names. They are made of the curves again.
    ///
    /// # Errors
    /// [`OrbitError`]: the document is not of regions, or contradicts itself.
    pub fn read(self) -> Result<(OrbitAtlas, OrbitNames), OrbitError> {
        let expected = format!("{REGIONS:?}");
        InvalidValue::check("schema", &*self.schema, expected, self.schema == REGIONS)?;
        let document = self.content.atlas;
        let names = OrbitNames { axes: document.axes.clone() };
        let atlas = document.atlas().map_err(|error| OrbitError::Regions(error.to_string()))?;
        Ok((atlas, names))
    }
}

impl SpecialRecord {
    /// The special orbit of a system, as it is written.
    ///
    /// # Errors
    /// [`InvalidValue`]: the record is not of this system.
    pub fn special(&self, orbits: &Orbits) -> Result<SpecialOrbit, InvalidValue> {
        let orbit = self.orbit.read(orbits)?;
        let Self { kind, value, behind, segment, .. } = *self;
        let rule = self.rule.place;
        Ok(SpecialOrbit { kind, value, behind, segment, rule, orbit })
    }
}
