//! Systems that can be read as black boxes.

use stickslip_solver::{Guard, HybridSystem, State};

/// A system without what it may say besides values.
pub struct BlackBox<'a, S>(pub &'a S);

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> HybridSystem<N, G> for BlackBox<'_, S> {
    type Mode = S::Mode;

    fn field(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        self.0.field(mode, s, y)
    }

    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.0.guards(mode)
    }

    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        self.0.guard_values(mode, s, y)
    }

    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        self.0.transition(mode, guard, s, y)
    }
}
