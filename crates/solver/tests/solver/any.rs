//! Systems of one mode as one type for each dimension and number of guards, so that runs along them
//! are compiled once: a run is compiled anew for each type of system, which takes a second.

use stickslip_solver::{Guard, HybridSystem, State};

/// Any black box of one mode.
pub struct Any<'a, const N: usize, const G: usize>(Box<dyn OneMode<N, G> + 'a>);

pub fn any<'a, const N: usize, const G: usize>(
    system: impl HybridSystem<N, G, Mode = ()> + 'a,
) -> Any<'a, N, G> {
    Any(Box::new(system))
}

/// What a system of one mode is made of.
trait OneMode<const N: usize, const G: usize> {
    fn field(&self, s: f64, y: &State<N>) -> State<N>;
    fn guards(&self) -> [Guard; G];
    fn guard_values(&self, s: f64, y: &State<N>) -> [f64; G];
    fn transition(&self, guard: usize, s: f64, y: &State<N>) -> State<N>;
}

impl<S: HybridSystem<N, G, Mode = ()>, const N: usize, const G: usize> OneMode<N, G> for S {
    fn field(&self, s: f64, y: &State<N>) -> State<N> {
        self.field((), s, y)
    }

    fn guards(&self) -> [Guard; G] {
        self.guards(())
    }

    fn guard_values(&self, s: f64, y: &State<N>) -> [f64; G] {
        self.guard_values((), s, y)
    }

    fn transition(&self, guard: usize, s: f64, y: &State<N>) -> State<N> {
        self.transition((), guard, s, y).1
    }
}

impl<const N: usize, const G: usize> HybridSystem<N, G> for Any<'_, N, G> {
    type Mode = ();

    fn field(&self, (): (), s: f64, y: &State<N>) -> State<N> {
        self.0.field(s, y)
    }

    fn guards(&self, (): ()) -> [Guard; G] {
        self.0.guards()
    }

    fn guard_values(&self, (): (), s: f64, y: &State<N>) -> [f64; G] {
        self.0.guard_values(s, y)
    }

    fn transition(&self, (): (), guard: usize, s: f64, y: &State<N>) -> ((), State<N>) {
        ((), self.0.transition(guard, s, y))
    }
}

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
