//! The derivatives of the system with respect to its parameters, by dual numbers in the equations.

use num_dual::Dual64;
use stickslip_solver::State;
use stickslip_solver::sensitivity::{Differentiable, Variation};

use super::Regularized;
use super::components::{STATE, U, array};
use super::equations::{ContactParameter, Equations};
use crate::phase::{END, GUARDS, OTHER_SIDE, Phase, SAME_SIDE};

/// The number of parameters.
pub const PARAMETERS: usize = ContactParameter::ALL.len();

impl Regularized {
    /// The equations and a state, with their derivatives along a change.
    pub fn along(
        &self,
        y: &State<STATE>,
        change: &Variation<STATE>,
    ) -> (Equations<Dual64>, [Dual64; STATE]) {
        let equations =
            self.equations.by(change.parameter.map(|index| ContactParameter::ALL[index]));
        (equations, std::array::from_fn(|i| Dual64::new(array(y)[i], change.y[i])))
    }
}

/// The terms of damping are always computed, so that they have a derivative at a = 0.
impl Differentiable<STATE, GUARDS> for Regularized {
    fn field_change(
        &self,
        phase: Phase,
        _s: f64,
        y: &State<STATE>,
        change: &Variation<STATE>,
    ) -> State<STATE> {
        let (equations, y) = self.along(y, change);
        equations.field::<true>(phase, &y).map(|part| part.eps).into()
    }

    fn guard_changes(
        &self,
        phase: Phase,
        _s: f64,
        y: &State<STATE>,
        change: &Variation<STATE>,
    ) -> [f64; GUARDS] {
        let (equations, y) = self.along(y, change);
        let guards = equations.guards::<true>(phase, &y).map(|guard| guard.eps);
        // u² + a v has a double zero at the end of contact without damping.
        let damped = self.contact().damping() > 0.0;
        [if damped { guards[END] } else { y[U].eps }, guards[SAME_SIDE], guards[OTHER_SIDE]]
    }

    fn transition_change(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
        change: &Variation<STATE>,
    ) -> State<STATE> {
        let next = self.next(phase, guard, y);
        let (equations, y) = self.along(y, change);
        equations.enter::<true>(next, &y).map(|part| part.eps).into()
    }
}
