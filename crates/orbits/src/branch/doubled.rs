//! From a flip to the orbit of twice the period.

use nalgebra::DVector;
use stickslip_expression::InvalidValue;

use super::borders::null_vectors;
use crate::equations::{Draft, Equations};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::newton::correct;
use crate::orbit::Orbit;

impl Orbits {
    /// The orbit of twice the period that begins at a flip, beside it by `aside` of the size of its
    /// states, at the value of the parameter where it is so far away.
    ///
    /// # Errors
    /// [`OrbitError`]; no orbit is found if there is no flip nearby.
    pub fn doubled(&self, flip: &Orbit, parameter: usize, aside: f64) -> Result<Orbit, OrbitError> {
        let accepted = aside > 0.0 && aside <= 0.5;
        InvalidValue::check("the distance from a flip", aside, "above 0, to 0.5", accepted)?;
        self.compiled.with(&flip.parameters)?;
        let count = self.system.parameters.len();
        let expected = format!("the place of one of {count} parameters");
        InvalidValue::check("the parameter", parameter, expected, parameter < count)?;
        let one = flip.draft();
        let value = flip.parameters[parameter].abs();
        let size = if value > 0.0 { value } else { 1.0 };
        let active = [(parameter, size)];
        let single = Equations::new(&self.system, one.clone(), &active, &self.options)?;
        let place = single.place(&one);
        let slopes = single.at(&place)?.slopes;
        let direction = null_vectors(&single.returning(&slopes, -1.0)).1;
        let mut sides = [1.0, -1.0].map(|sign| {
            let mut moved = place.clone();
            let count = single.count();
            let aside = moved.rows(0, count) + sign * aside * &direction;
            moved.rows_mut(0, count).copy_from(&aside);
            single.draft(&moved)
        });
        let [first, second] = &mut sides;
        let joined = |one: &Draft, other: &Draft| Draft {
            parameters: one.parameters.clone(),
            start: one.start,
            legs: [&one.legs[..], &other.legs].concat(),
            states: [&one.states[..], &other.states].concat(),
            durations: [&one.durations[..], &other.durations].concat(),
        };
        let (middle, double) = (joined(&one, &one), joined(first, second));
        let equations = Equations::new(&self.system, middle.clone(), &active, &self.options)?;
        let (from, to) = (equations.place(&middle), equations.place(&double));
        let apart = &to - &from;
        let length = apart.norm();
        let away = apart / length;
        let condition = |place: &DVector<f64>| (away.dot(&(place - &from)) - length, away.clone());
        let zero = correct(&equations, &to, &[&condition])?;
        let (found, evaluation) = (equations.draft(&zero.at), equations.at(&zero.at)?);
        self.orbit(&equations, &found, &evaluation, zero.error)
    }
}
