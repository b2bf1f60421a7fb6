//! A branch that was written, and goes on from its ends.

use nalgebra::DVector;
use stickslip_expression::InvalidValue;
use stickslip_solver::GivenValue;

use super::point::{Along, Point};
use super::{Branch, BranchOptions, Half, NOT_LOCATED, SpecialKind, SpecialOrbit};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::itinerary::require_of;
use crate::orbit::Orbit;

/// How far what is written may be from an orbit, of the sizes of unknowns.
const WRITTEN: f64 = 1e-9;

impl Orbits {
    /// A branch that goes on from both of its ends, over a range that contains its own: beyond the
    /// ends of its range, and also from where it broke off. What it has stays as it is.
    ///
    /// ```
    /// use stickslip_expression::System;
    /// use stickslip_orbits::{BranchOptions, Guess, Orbits};
    ///
    /// let relay = System::parse(
    ///     "parameter width = 0.5\nstate x = 0\nmode up\n  x' = 1 - x\n  \
    ///      when x > width \"down\" -> down\nmode down\n  x' = -1 - x\n  \
    ///      when x < -width \"up\" -> up\nstart in up",
    /// )?;
    /// let orbits = Orbits::new(&relay)?;
    /// let guess = Guess { itinerary: &["down", "up"], ..Guess::default() };
    /// let orbit = orbits.find(&relay.values(), &guess)?;
    /// let options = BranchOptions::default();
    /// let branch = orbits.branch(&orbit, 0, [0.4, 0.6], &options)?;
    /// let resumed = orbits.resumed(&branch, [0.1, 0.9], &options)?;
    /// let ends = [&resumed.points[0], &resumed.points[resumed.points.len() - 1]];
    /// assert_eq!(ends.map(|it| it.parameters[0]), [0.1, 0.9]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`OrbitError`]: the branch is closed, is not of this system, or the range does not contain
    /// its own.
    pub fn resumed(
        &self,
        branch: &Branch,
        [low, high]: [f64; 2],
        options: &BranchOptions,
    ) -> Result<Branch, OrbitError> {
        options.validate()?;
        let Branch { parameter, range: [from, to], ref points, .. } = *branch;
        let [first, .., last] = &points[..] else {
            let expected = "at least one orbit";
            InvalidValue::check("the branch", points.len(), expected, !points.is_empty())?;
            return self.branch(&points[0], parameter, [low, high], options);
        };
        self.compiled.with(&first.parameters)?;
        self.require_parameter(parameter)?;
        let expected = format!("a range that contains that of the branch, {from:?}:{to:?}");
        let name = format!("the range of {}", self.system.parameters[parameter].name);
        InvalidValue::check(name, [low, high], expected, low <= from && to <= high)?;
        self.require_range(first, parameter, [low, high])?;
        let expected = "a branch with ends";
        let found = GivenValue::Phrase("comes back to its start".into());
        InvalidValue::check("the branch", found, expected, !branch.closed)?;
        let equations = self.along_parameter(first, parameter, [low, high])?;
        let along = Along::new(self, &equations, parameter, [low, high]);
        let start = along.end([&points[1], first])?;
        let end = along.end([&points[points.len() - 2], last])?;
        let ends = |behind: usize| {
            let is_end = |it: &SpecialOrbit| it.kind == SpecialKind::InfinitePeriod;
            branch.specials.iter().any(|it| is_end(it) && it.behind == behind)
        };
        let ahead = if ends(points.len()) {
            Half::default()
        } else {
            self.half(&along, &end, Some(&start.turned()), options)
        };
        let back = (!ahead.closed && !ends(0)).then(|| self.half(&along, &start, None, options));
        let lost = branch.objection.iter().flat_map(|it| it.split("; "));
        let lost: Vec<_> = lost.filter(|it| it.contains(NOT_LOCATED)).collect();
        let middle = Half {
            points: points.clone(),
            specials: branch.specials.clone(),
            closed: false,
            objection: (!lost.is_empty()).then(|| lost.join("; ")),
        };
        let whole = ahead.joined(middle, back, |special| &mut special.behind);
        Ok(whole.branch(parameter, [low, high]))
    }

    /// A branch as it was written, whose orbits are looked at again: each is one of this system,
    /// and whether the system follows it is decided anew.
    #[cfg_attr(not(feature = "serde"), allow(dead_code, reason = "documents alone are reread"))]
    pub(crate) fn reread(&self, branch: Branch) -> Result<Branch, OrbitError> {
        let Branch { parameter, range, closed, objection, .. } = branch;
        let count = branch.points.len();
        let Some(first) = branch.points.first() else {
            return Err(InvalidValue::new("points", 0, "at least one orbit").into());
        };
        self.compiled.with(&first.parameters)?;
        self.require_range(first, parameter, range)?;
        let equations = self.along_parameter(first, parameter, range)?;
        let along = Along::new(self, &equations, parameter, range);
        let mut before = 0;
        let special = |special: SpecialOrbit| {
            let in_order = (before..=count).contains(&special.behind);
            InvalidValue::check("behind", special.behind, "an order of the points", in_order)?;
            before = special.behind;
            let own = special.orbit.parameters[parameter];
            let fits = (special.value - own).abs() <= WRITTEN * own.abs();
            InvalidValue::check("value", special.value, "that of its orbit", fits)?;
            special.require_of(self)?;
            let orbit = along.reread(&special.orbit)?;
            Ok::<_, OrbitError>(SpecialOrbit { orbit, ..special })
        };
        let specials = branch.specials.into_iter().map(special).collect::<Result<_, _>>()?;
        let points = branch.points.iter().map(|it| along.reread(it)).collect::<Result<_, _>>()?;
        Ok(Branch { parameter, range, points, specials, closed, objection })
    }
}

impl Along<'_> {
    /// The last of two neighbours, in the direction from the first one.
    fn end(&self, [before, last]: [&Orbit; 2]) -> Result<Point, OrbitError> {
        let [one, other] = [before, last].map(|it| self.written(it));
        let (one, other) = (one?, other?);
        let way = &other - &one;
        let length = way.norm();
        let from = Point { tangent: way / length, ..self.sketch(one)? };
        let end = self.ahead(&from, length)?;
        self.require_near((&end.place - &other).amax(), last)?;
        Ok(end)
    }

    /// An orbit as it was written, with a verdict of its own.
    fn reread(&self, orbit: &Orbit) -> Result<Orbit, OrbitError> {
        let evaluation = self.equations.at(&self.written(orbit)?)?;
        self.require_near(evaluation.values.amax(), orbit)?;
        self.orbits.orbit(self.equations, &orbit.draft(), &evaluation, orbit.error)
    }

    /// The place of an orbit that was written.
    fn written(&self, orbit: &Orbit) -> Result<DVector<f64>, OrbitError> {
        let mut draft = orbit.draft();
        let expected = "those of the first orbit";
        let (count, same) = (draft.legs.len(), draft.legs == self.equations.legs());
        InvalidValue::check("the segments", count, expected, same)?;
        require_of(&self.orbits.system, &draft.legs, &draft.states)?;
        let place = self.equations.place(&draft);
        let others = self.equations.draft(&place).parameters;
        draft.parameters[self.parameter] = others[self.parameter];
        let found = GivenValue::Phrase("change along the branch".into());
        let expected = "those of the first orbit, but for the one of the branch";
        InvalidValue::check("the parameters", found, expected, draft.parameters == others)?;
        let expected = "finite durations";
        let finite = place.iter().all(|it| it.is_finite());
        InvalidValue::check("the period", draft.period(), expected, finite)?;
        Ok(place)
    }

    /// Refuses an orbit that is not of this system.
    fn require_near(&self, away: f64, orbit: &Orbit) -> Result<(), InvalidValue> {
        let name = &self.orbits.system.parameters[self.parameter].name;
        let value = orbit.parameters[self.parameter];
        let what = format!("the distance of what is written at {name} = {value:?} from an orbit");
        let expected = format!("at most {WRITTEN:e} of its size, as in a branch of this system");
        InvalidValue::check(what, away, expected, away <= WRITTEN)
    }
}
