//! How a solution goes on from surfaces, where the mode that follows is no formula.

use stickslip_number::Dual;
use stickslip_solver::dynamic::DynamicSystem;
use stickslip_solver::sliding::{SampledFilippov, SlidingMode, SurfaceSide, SwitchedDynamic};

use crate::program::Program;
use crate::resets::Resets;
use crate::sliding::several::{count, parts, place_of};
use crate::sliding::{ABOVE, ABOVE_RELEASED, BELOW, BELOW_RELEASED, SLIDING};

/// The fields beside surfaces, with which the solver decides how a solution goes on.
#[derive(Clone, Debug)]
pub(crate) struct Continuation {
    /// The place of the first mode of the slide.
    pub(crate) first: usize,
    pub(crate) count: usize,
    pub(crate) surfaces: Program,
    /// The slopes for each choice of sides.
    pub(crate) corners: Vec<Program>,
}

/// What leads to a decision: a rule of a surface, or one that changes the state.
struct Switched<'a> {
    continuation: &'a Continuation,
    resets: Option<&'a Resets>,
}

impl Continuation {
    pub(crate) fn with(&self, parameters: &[f64]) -> Self {
        Self {
            surfaces: self.surfaces.with(parameters),
            corners: self.corners.iter().map(|it| it.with(parameters)).collect(),
            ..*self
        }
    }

    /// The mode in which a run starts; the one without a field if it is not unique.
    pub(crate) fn start(&self, s: f64, y: &[f64]) -> usize {
        let system = SampledFilippov::new(Switched { continuation: self, resets: None });
        let mode = system.mode(false, s, y);
        mode.map_or(self.undecided(), |mode| self.place(&mode))
    }

    /// The mode that follows a rule, with the state behind it.
    pub(crate) fn next(
        &self,
        mode: usize,
        guard: Option<usize>,
        resets: &Resets,
        (s, y): (f64, &mut [f64]),
    ) -> usize {
        let system = SampledFilippov::new(Switched { continuation: self, resets: Some(resets) });
        let from = self.mode(mode, resets, s, y);
        let to = system.transition(from, guard.unwrap_or(2 * self.count), s, y);
        self.place(&to)
    }

    /// A number that vanishes where another mode follows a rule.
    pub(crate) fn condition(
        &self,
        mode: usize,
        guard: Option<usize>,
        resets: &Resets,
        (s, y): (f64, &[f64]),
    ) -> f64 {
        let system = SampledFilippov::new(Switched { continuation: self, resets: Some(resets) });
        let from = self.mode(mode, resets, s, y);
        system.transition_condition(from, guard.unwrap_or(2 * self.count), s, y)
    }

    fn undecided(&self) -> usize {
        self.first + count(self.count) - 1
    }

    /// The sides in a mode; of one that does not slide, those behind its rule.
    fn mode(&self, mode: usize, resets: &Resets, s: f64, y: &[f64]) -> SlidingMode<bool> {
        let own = mode.checked_sub(self.first).filter(|&place| place + 1 < count(self.count));
        let sides: Vec<SurfaceSide> = if let Some(place) = own {
            let side = |part| match part {
                ABOVE | ABOVE_RELEASED => SurfaceSide::Above,
                BELOW | BELOW_RELEASED => SurfaceSide::Below,
                _ => SurfaceSide::Sliding,
            };
            parts(place, self.count).map(side).collect()
        } else {
            let (mut behind, mut values) = (y.to_vec(), vec![0.0; self.count]);
            resets.apply(s, &mut behind);
            self.surfaces.run(s, &behind, &mut values);
            let side =
                |&value: &f64| if value < 0.0 { SurfaceSide::Below } else { SurfaceSide::Above };
            values.iter().map(side).collect()
        };
        SlidingMode::at(false, &sides)
    }

    /// The place of a mode.
    fn place(&self, mode: &SlidingMode<bool>) -> usize {
        if mode.refusal().is_some() || !mode.is_unique() {
            return self.undecided();
        }
        let part = |(surface, side): (usize, &SurfaceSide)| match (side, mode.is_released(surface))
        {
            (SurfaceSide::Sliding, _) => SLIDING,
            (SurfaceSide::Above, false) => ABOVE,
            (SurfaceSide::Above, true) => ABOVE_RELEASED,
            (SurfaceSide::Below, false) => BELOW,
            (SurfaceSide::Below, true) => BELOW_RELEASED,
        };
        self.first + place_of(mode.sides().iter().enumerate().map(part))
    }
}

impl SwitchedDynamic for Switched<'_> {
    /// Whether a rule has changed the state.
    type Mode = bool;

    fn count(&self) -> usize {
        self.continuation.count
    }

    fn field(&self, _: bool, signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]) {
        let above = signs.iter().enumerate().filter(|(_, sign)| **sign > 0.0);
        let corner: usize = above.map(|(surface, _)| 1 << surface).sum();
        self.continuation.corners[corner].run(s, y, slope);
    }

    fn surfaces(&self, _: bool, s: f64, y: &[f64], values: &mut [f64]) {
        self.continuation.surfaces.run(s, y, values);
    }

    fn rates(&self, _: bool, s: f64, y: &[f64], slope: &[f64], rates: &mut [f64]) {
        let dual = |(&value, &slope): (&f64, &f64)| Dual { value, slope };
        let along: Vec<Dual<f64>> = y.iter().zip(slope).map(dual).collect();
        let mut found = vec![Dual::from(0.0); rates.len()];
        self.continuation.surfaces.run(Dual { value: s, slope: 1.0 }, &along, &mut found);
        rates.iter_mut().zip(found).for_each(|(rate, found)| *rate = found.slope);
    }

    fn transition(&self, _: bool, _guard: usize, s: f64, y: &mut [f64]) -> bool {
        if let Some(resets) = self.resets {
            resets.apply(s, y);
        }
        true
    }
}
