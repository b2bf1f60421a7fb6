//! One system of a family, in a dimension that the solver's margins know.

use std::sync::Arc;

use stickslip_solver::{DynamicSystem, Guard, HybridSystem, Method, Start, State, Step, Trial};
use stickslip_tracer::{Point, Problem};

use crate::families::blueprint::Blueprint;
use crate::hybrid::system::System;
use crate::hybrid::trouble::Trouble;

/// The systems of a family, with at most `N` components and `G` guards.
pub struct Members {
    pub blueprint: Arc<Blueprint>,
    pub trouble: Arc<Trouble>,
}

/// One of them. Components beyond those of the system are 0 throughout.
pub struct Member<const N: usize, const G: usize> {
    system: System,
    blueprint: Arc<Blueprint>,
}

impl<const N: usize, const G: usize> Problem<N, G> for Members {
    type System = Member<N, G>;

    fn at(&self, point: &Point) -> (Member<N, G>, Start<usize, N>) {
        let system = self.blueprint.system([point.x, point.y], self.trouble.clone());
        let (mode, s, ref from) = self.blueprint.start;
        let mut state = State::<N>::zeros();
        let own = &mut state.as_mut_slice()[..from.len()];
        own.copy_from_slice(from);
        let mode = system.change(mode, &self.blueprint.first, s, own);
        (Member { system, blueprint: self.blueprint.clone() }, Start { mode, s, state })
    }
}

impl<const N: usize, const G: usize> Member<N, G> {
    /// The components of the system.
    fn own<'y>(&self, y: &'y State<N>) -> &'y [f64] {
        &y.as_slice()[..self.blueprint.dimension()]
    }
}

impl<const N: usize, const G: usize> HybridSystem<N, G> for Member<N, G> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N> {
        let mut slope = State::<N>::zeros();
        let own = &mut slope.as_mut_slice()[..self.blueprint.dimension()];
        self.system.field(mode, s, self.own(y), own);
        slope
    }

    fn guards(&self, mode: usize) -> [Guard; G] {
        let mut guards = [Guard::OFF; G];
        for (&place, guard) in self.blueprint.places[mode].iter().zip(self.system.guards(mode)) {
            guards[place] = *guard;
        }
        guards
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; G] {
        let places = &self.blueprint.places[mode];
        let (mut listed, mut values) = ([1.0; G], [1.0; G]);
        self.system.guard_values(mode, s, self.own(y), &mut listed[..places.len()]);
        for (&place, value) in places.iter().zip(listed) {
            values[place] = value;
        }
        values
    }

    /// The error of a step is a mean over the components of the system.
    fn step<M: Method>(&self, mode: usize, trial: &Trial<'_, N>, step: &mut Step<N>) {
        let (rtol, atol) = trial.tolerances;
        let part = (self.blueprint.dimension() as f64 / N as f64).sqrt();
        let tolerances = (rtol * part, atol * part);
        step.take_with::<M>(&mut |s, y| self.field(mode, s, y), trial, |_| tolerances);
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        let mut after = *y;
        let own = &mut after.as_mut_slice()[..self.blueprint.dimension()];
        let listed = self.blueprint.places[mode].iter().position(|&place| place == guard);
        let to = listed.map_or(mode, |guard| self.system.transition(mode, guard, s, own));
        (to, after)
    }

    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64 {
        let listed = self.blueprint.places[mode].iter().position(|&place| place == guard);
        listed.map_or(f64::NAN, |guard| self.system.condition(mode, guard, s, self.own(y)))
    }
}
