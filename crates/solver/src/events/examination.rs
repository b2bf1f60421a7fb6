//! What the examination of a step needs, and the values of its guards.

use crate::events::phase::Phase;
use crate::events::quick::NODES;
use crate::hybrid::{HybridSystem, Observer, Statistics};
use crate::method::{State, Step, Trial};

/// The data that the examination of a step needs.
pub(crate) struct Examination<'a, S: HybridSystem<N, G>, O, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    pub(crate) phase: &'a Phase<S::Mode, G>,
    /// The step before it was shortened.
    pub(crate) trial: &'a Trial<'a, N>,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) observer: &'a mut O,
}

impl<S, O, const N: usize, const G: usize> Examination<'_, S, O, N, G>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    /// The values of all guards at the [`NODES`] of a step.
    #[inline(always)]
    pub(crate) fn values_on(&mut self, step: &Step<N>) -> [[f64; G]; 6] {
        let at = |theta: f64, y: &State<N>| {
            self.system.guard_values(self.phase.mode, step.s + theta * step.h, y)
        };
        self.statistics.guards += 5;
        [
            self.phase.values,
            at(NODES[1], &step.interior[0]),
            at(NODES[2], &step.interior[1]),
            at(NODES[3], &step.interior[2]),
            at(NODES[4], &step.interior[3]),
            at(1.0, &step.y1),
        ]
    }
}
