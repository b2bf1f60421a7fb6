//! Systems and observers of fixed dimension.

use std::fmt::Debug;

use stickslip_solver::{
    Dense, Enclosure, Grazing, Guard, HybridSystem, Observer, Pole, State, SwitchEvent,
};

/// What a system consists of.
pub trait Parts<Mode, const N: usize, const G: usize> {
    fn field(&self, mode: Mode, s: f64, y: &State<N>) -> State<N>;
    fn guards(&self, mode: Mode) -> [Guard; G];
    fn guard_values(&self, mode: Mode, s: f64, y: &State<N>) -> [f64; G];
    fn guard_rates(&self, mode: Mode, s: f64, y: &State<N>) -> [f64; G];
    fn enclose_guards(&self, mode: Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G];
    fn settle(&self, mode: Mode) -> Mode;
    fn longest_first_step(&self, mode: Mode, s: f64, y: &State<N>) -> f64;
    fn transition(&self, mode: Mode, guard: usize, s: f64, y: &State<N>) -> (Mode, State<N>);
    fn transition_condition(&self, mode: Mode, guard: usize, s: f64, y: &State<N>) -> f64;
}

/// Passes calls of a trait on to what stands behind a reference.
macro_rules! pass_on {
    ($mode:ty, [$($to:tt)+], |$self:ident| $inner:expr) => {
        fn field(&$self, mode: $mode, s: f64, y: &State<N>) -> State<N> {
            <$($to)+>::field($inner, mode, s, y)
        }

        fn guards(&$self, mode: $mode) -> [Guard; G] {
            <$($to)+>::guards($inner, mode)
        }

        fn guard_values(&$self, mode: $mode, s: f64, y: &State<N>) -> [f64; G] {
            <$($to)+>::guard_values($inner, mode, s, y)
        }

        fn guard_rates(&$self, mode: $mode, s: f64, y: &State<N>) -> [f64; G] {
            <$($to)+>::guard_rates($inner, mode, s, y)
        }

        fn enclose_guards(
            &$self,
            mode: $mode,
            s: Enclosure,
            y: &[Enclosure; N],
        ) -> [Enclosure; G] {
            <$($to)+>::enclose_guards($inner, mode, s, y)
        }

        fn settle(&$self, mode: $mode) -> $mode {
            <$($to)+>::settle($inner, mode)
        }

        fn longest_first_step(&$self, mode: $mode, s: f64, y: &State<N>) -> f64 {
            <$($to)+>::longest_first_step($inner, mode, s, y)
        }

        fn transition(
            &$self,
            mode: $mode,
            guard: usize,
            s: f64,
            y: &State<N>,
        ) -> ($mode, State<N>) {
            <$($to)+>::transition($inner, mode, guard, s, y)
        }

        fn transition_condition(&$self, mode: $mode, guard: usize, s: f64, y: &State<N>) -> f64 {
            <$($to)+>::transition_condition($inner, mode, guard, s, y)
        }
    };
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> Parts<S::Mode, N, G> for S {
    pass_on!(S::Mode, [S as HybridSystem<N, G>], |self| self);
}

/// Any system of modes of one type.
pub struct Erased<'a, Mode, const N: usize, const G: usize, const READABLE: bool>(
    pub &'a dyn Parts<Mode, N, G>,
);

impl<Mode, const N: usize, const G: usize, const READABLE: bool> HybridSystem<N, G>
    for Erased<'_, Mode, N, G, READABLE>
where
    Mode: Copy + PartialEq + Debug,
{
    type Mode = Mode;

    const READABLE: bool = READABLE;

    pass_on!(Mode, [dyn Parts<Mode, N, G>], |self| self.0);
}

/// What an observer does.
pub trait Sees<Mode, const N: usize> {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>);
    fn on_grazing(&mut self, grazing: &Grazing<Mode>);
    fn on_pole(&mut self, pole: &Pole<Mode>);
    fn stops(&self) -> bool;
    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>);
    fn on_end(&mut self, mode: Mode, s: f64, state: &State<N>);
}

/// As `pass_on`.
macro_rules! tell {
    ([$($to:tt)+], |$self:ident| $inner:expr) => {
        fn on_switch(&mut $self, event: &SwitchEvent<Mode, N>) {
            <$($to)+>::on_switch($inner, event);
        }

        fn on_grazing(&mut $self, grazing: &Grazing<Mode>) {
            <$($to)+>::on_grazing($inner, grazing);
        }

        fn on_pole(&mut $self, pole: &Pole<Mode>) {
            <$($to)+>::on_pole($inner, pole);
        }

        fn stops(&$self) -> bool {
            <$($to)+>::stops($inner)
        }

        fn on_segment(&mut $self, mode: Mode, dense: &Dense<N>) {
            <$($to)+>::on_segment($inner, mode, dense);
        }

        fn on_end(&mut $self, mode: Mode, s: f64, state: &State<N>) {
            <$($to)+>::on_end($inner, mode, s, state);
        }
    };
}

impl<O: Observer<Mode, N>, Mode, const N: usize> Sees<Mode, N> for O {
    tell!([O as Observer<Mode, N>], |self| self);
}

/// Any observer of modes of one type.
pub struct Watching<'a, Mode, const N: usize, const WANTS_SEGMENTS: bool>(
    pub &'a mut dyn Sees<Mode, N>,
);

impl<Mode, const N: usize, const WANTS_SEGMENTS: bool> Observer<Mode, N>
    for Watching<'_, Mode, N, WANTS_SEGMENTS>
{
    const WANTS_SEGMENTS: bool = WANTS_SEGMENTS;

    tell!([dyn Sees<Mode, N>], |self| self.0);
}
