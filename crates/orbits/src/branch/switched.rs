//! From a flip to the orbit of twice the period, and from a branch point to the other branch.

use nalgebra::DVector;
use stickslip_expression::InvalidValue;

use super::borders::{null_vector, plane};
use super::{SpecialKind, SpecialOrbit};
use crate::equations::{Draft, Equations};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::newton::correct;
use crate::orbit::Orbit;

impl Orbits {
    /// The orbit on the branch that begins or passes at a special orbit, beside it by `aside` of
    /// the size of its states, at the value of the parameter where it is so far away. A `flip`
    /// leads to an orbit of twice the period. At a `branch-point` the other branch is meant, not
    /// that on which the special orbit was found with a neighbour, which is `beside` it.
    ///
    /// # Errors
    /// [`OrbitError`]: no orbit is found, or the special orbit is of another kind.
    pub fn switched(
        &self,
        special: &SpecialOrbit,
        beside: &Orbit,
        parameter: usize,
        aside: f64,
    ) -> Result<Orbit, OrbitError> {
        let accepted = aside > 0.0 && aside <= 0.5;
        let name = "the distance from a special orbit";
        InvalidValue::check(name, aside, "above 0, to 0.5", accepted)?;
        self.compiled.with(&special.orbit.parameters)?;
        self.require_parameter(parameter)?;
        let one = special.orbit.draft();
        self.compiled.with(&beside.parameters)?;
        // A special orbit may be where the parameter is 0, and its neighbour is not.
        let of = |orbit: &Orbit| orbit.parameters[parameter].abs();
        let value = of(&special.orbit).max(of(beside));
        let active = [(parameter, if value > 0.0 { value } else { 1.0 })];
        let single = Equations::new(&self.system, one.clone(), &active, &self.options)?;
        let place = single.place(&one);
        let slopes = single.at(&place)?.slopes;
        let moved = |by: f64, direction: &DVector<f64>| single.draft(&(&place + by * direction));
        let (middle, aside) = match special.kind {
            SpecialKind::Flip => {
                let direction = null_vector(&single.returning(&slopes, -1.0));
                let direction = direction.insert_row(single.count(), 0.0);
                let [first, second] = [aside, -aside].map(|by| moved(by, &direction));
                (joined(&one, &one), joined(&first, &second))
            }
            SpecialKind::BranchPoint => {
                let other = beside.draft();
                let accepted = other.legs == one.legs && other.states.len() == one.states.len();
                let expected = "an orbit of the branch beside the special one";
                InvalidValue::check("the neighbour", other.legs.len(), expected, accepted)?;
                let known = single.place(&other) - &place;
                let [u, v] = plane(&slopes);
                let across = known.dot(&v) * &u - known.dot(&u) * &v;
                let direction = across.try_normalize(0.0).ok_or(NOWHERE)?;
                (one.clone(), moved(aside, &direction))
            }
            other => {
                let expected = "a `flip` or a `branch-point`";
                return Err(InvalidValue::new("the special orbit", other.name(), expected).into());
            }
        };
        let equations = Equations::new(&self.system, middle.clone(), &active, &self.options)?;
        let (from, to) = (equations.place(&middle), equations.place(&aside));
        let apart = &to - &from;
        let length = apart.norm();
        let away = apart / length;
        let condition = |place: &DVector<f64>| (away.dot(&(place - &from)) - length, away.clone());
        let zero = correct(&equations, &to, &[&condition])?;
        let (found, evaluation) = (equations.draft(&zero.at), equations.at(&zero.at)?);
        self.orbit(&equations, &found, &evaluation, zero.error)
    }
}

const NOWHERE: OrbitError = OrbitError::nowhere("the neighbour does not say which branch is known");

/// Two rounds, one after the other.
fn joined(one: &Draft, other: &Draft) -> Draft {
    Draft {
        parameters: one.parameters.clone(),
        start: one.start,
        legs: [&one.legs[..], &other.legs].concat(),
        states: [&one.states[..], &other.states].concat(),
        durations: [&one.durations[..], &other.durations].concat(),
    }
}
