//! Any family as one type, so that the tracer is compiled once for all with the same labels,
//! margins and errors: it is compiled anew for each type of family, which takes seconds. Systems
//! with two guards as one type, for the same reason.

use std::fmt::Debug;
use std::hash::Hash;

use stickslip_solver::{Guard, HybridSystem, State};
use stickslip_tracer::{Family, FreeRun, Point};

/// Any family with these labels, margins and errors.
pub struct Any<'a, Label, Margin, Error>(Boxed<'a, Label, Margin, Error>);

type Boxed<'a, L, M, E> = Box<dyn Family<Label = L, Margin = M, Error = E> + Sync + 'a>;

/// The family as one of any type.
pub fn any<'a, F>(family: F) -> Any<'a, F::Label, F::Margin, F::Error>
where
    F: Family + Sync + 'a,
{
    Any(Box::new(family))
}

impl<Label, Margin, Error> Family for Any<'_, Label, Margin, Error>
where
    Label: Clone + Debug + Eq + Ord + Hash,
    Margin: Clone + Debug + Eq + Ord + Hash,
    Error: std::error::Error + 'static,
{
    type Label = Label;
    type Margin = Margin;
    type Error = Error;

    fn label(&self, point: &Point) -> Result<Label, Error> {
        self.0.label(point)
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Error> {
        self.0.margin(point, margin)
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, Error> {
        self.0.moved(point, margin)
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        self.0.is_sure(margin)
    }

    fn cusps(&self, margin: &Margin) -> Vec<[Margin; 2]> {
        self.0.cusps(margin)
    }

    fn swallowtail(&self, margin: &Margin) -> Option<[Margin; 3]> {
        self.0.swallowtail(margin)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Error> {
        self.0.free_run(point)
    }
}

/// Any system with two guards whose modes are numbers. What else a system may say is as provided.
pub struct AnySystem<const N: usize>(Box<dyn Parts<N>>);

/// The system as one of any type.
pub fn any_system<const N: usize>(
    system: impl HybridSystem<N, 2, Mode = usize> + 'static,
) -> AnySystem<N> {
    AnySystem(Box::new(system))
}

/// What a system consists of.
trait Parts<const N: usize> {
    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N>;
    fn guards(&self, mode: usize) -> [Guard; 2];
    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; 2];
    fn guard_rates(&self, mode: usize, s: f64, y: &State<N>) -> [f64; 2];
    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>);
    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64;
}

/// Passes calls of a trait on to what stands behind a reference.
macro_rules! pass_on {
    ([$($to:tt)+], |$self:ident| $inner:expr) => {
        fn field(&$self, mode: usize, s: f64, y: &State<N>) -> State<N> {
            <$($to)+>::field($inner, mode, s, y)
        }

        fn guards(&$self, mode: usize) -> [Guard; 2] {
            <$($to)+>::guards($inner, mode)
        }

        fn guard_values(&$self, mode: usize, s: f64, y: &State<N>) -> [f64; 2] {
            <$($to)+>::guard_values($inner, mode, s, y)
        }

        fn guard_rates(&$self, mode: usize, s: f64, y: &State<N>) -> [f64; 2] {
            <$($to)+>::guard_rates($inner, mode, s, y)
        }

        fn transition(
            &$self,
            mode: usize,
            guard: usize,
            s: f64,
            y: &State<N>,
        ) -> (usize, State<N>) {
            <$($to)+>::transition($inner, mode, guard, s, y)
        }

        fn transition_condition(&$self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64 {
            <$($to)+>::transition_condition($inner, mode, guard, s, y)
        }
    };
}

impl<S: HybridSystem<N, 2, Mode = usize>, const N: usize> Parts<N> for S {
    pass_on!([S as HybridSystem<N, 2>], |self| self);
}

impl<const N: usize> HybridSystem<N, 2> for AnySystem<N> {
    type Mode = usize;

    pass_on!([dyn Parts<N>], |self| &*self.0);
}
