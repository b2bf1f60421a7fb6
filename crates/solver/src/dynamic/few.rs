//! Systems of few components and guards, on states of fixed dimension.
//!
//! A system is padded to 2, 4 or 8 components, which stay 0, and to as many guards, which are
//! off. The mean error of a step is taken over the components that exist. For two components a run
//! on buffers is ten times slower, because buffers are moved where arrays dissolve.
//!
//! Not every system asks for this ([`DynamicSystem::ON_FIXED_STATES`]), since the engine is
//! compiled thrice more for each type that does. Systems of formulas do: they are one type for all
//! texts and recorded functions.

use crate::dynamic::dense::DynamicDense;
use crate::dynamic::results::{DynamicEvent, DynamicObserver};
use crate::dynamic::system::{DynamicStart, DynamicSystem};
use crate::hybrid::{
    Grazing, Guard, HybridSystem, Observer, Pole, Preempted, Rest, Schedule, Start, SwitchEvent,
};
use crate::method::{Dense, Method, State, Step, Trial};
use stickslip_number::{Enclosure, Interval};

/// Returns what a function makes of a system that has been padded, if the system is small enough
/// and wants to. It is a macro since the function is generic in the dimensions.
macro_rules! on_fixed_states {
    ($system:expr, $start:expr, |$padded:ident, $from:ident, $n:ident| $body:expr) => {
        if S::ON_FIXED_STATES {
            let $n = $start.state.len();
            match ($n, $system.most_guards()) {
                (1..=2, 0..=2) => {
                    let $padded = $crate::dynamic::few::Padded::<S, 2, 2>::new($system, $n);
                    let $from = $crate::dynamic::few::start(&$start);
                    return $body;
                }
                (1..=4, 0..=4) => {
                    let $padded = $crate::dynamic::few::Padded::<S, 4, 4>::new($system, $n);
                    let $from = $crate::dynamic::few::start(&$start);
                    return $body;
                }
                (1..=8, 0..=8) => {
                    let $padded = $crate::dynamic::few::Padded::<S, 8, 8>::new($system, $n);
                    let $from = $crate::dynamic::few::start(&$start);
                    return $body;
                }
                _ => {}
            }
        }
    };
}
pub(crate) use on_fixed_states;

/// Where a run of a system that has been padded starts.
pub(crate) fn start<Mode: Copy, const N: usize>(start: &DynamicStart<'_, Mode>) -> Start<Mode, N> {
    let state = State::from_fn(|i, _| start.state.get(i).copied().unwrap_or(0.0));
    Start { mode: start.mode, s: start.s, state }
}

/// A system of `n` ≤ `N` components, padded.
pub(crate) struct Padded<'a, S, const N: usize, const G: usize> {
    system: &'a S,
    n: usize,
    /// What the mean over all components is to be multiplied by.
    share: f64,
}

impl<'a, S: DynamicSystem, const N: usize, const G: usize> Padded<'a, S, N, G> {
    pub(crate) fn new(system: &'a S, n: usize) -> Self {
        Self { system, n, share: (N as f64 / n as f64).sqrt() }
    }

    #[inline(always)]
    fn slopes(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        let mut slope = State::<N>::zeros();
        self.system.field(mode, s, &y.as_slice()[..self.n], &mut slope.as_mut_slice()[..self.n]);
        slope
    }

    /// A list for the guards of a mode.
    #[inline(always)]
    fn list<T: Copy>(&self, mode: S::Mode, value: T, fill: impl FnOnce(&mut [T])) -> [T; G] {
        let mut list = [value; G];
        fill(&mut list[..self.system.guards(mode).len().min(G)]);
        list
    }
}

impl<S: DynamicSystem, const N: usize, const G: usize> HybridSystem<N, G> for Padded<'_, S, N, G> {
    type Mode = S::Mode;
    const READABLE: bool = S::READABLE;

    #[inline]
    fn field(&self, mode: S::Mode, s: f64, y: &State<N>) -> State<N> {
        self.slopes(mode, s, y)
    }
    #[inline]
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.list(mode, Guard::OFF, |list| list.copy_from_slice(self.system.guards(mode)))
    }
    #[inline]
    fn guard_values(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let y = &y.as_slice()[..self.n];
        self.list(mode, f64::NAN, |values| self.system.guard_values(mode, s, y, values))
    }
    fn guard_rates(&self, mode: S::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let y = &y.as_slice()[..self.n];
        self.list(mode, f64::NAN, |rates| self.system.guard_rates(mode, s, y, rates))
    }
    #[inline]
    fn enclose_guards(&self, mode: S::Mode, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; G] {
        let y = &y[..self.n];
        self.list(mode, Enclosure::ENTIRE, |all| self.system.enclose_guards(mode, s, y, all))
    }
    fn enclose_rates(&self, mode: S::Mode, s: Interval, y: &[Interval; N]) -> [Interval; G] {
        let y = &y[..self.n];
        self.list(mode, Interval::ENTIRE, |all| self.system.enclose_rates(mode, s, y, all))
    }
    #[inline]
    fn step<M: Method>(&self, mode: S::Mode, trial: &Trial<'_, N>, step: &mut Step<N>) {
        let own = self.system.tolerances();
        let tolerances = |i: usize| own.get(i).copied().unwrap_or(trial.tolerances);
        step.take_with::<M>(&mut |s, y| self.slopes(mode, s, y), trial, tolerances);
        step.error *= self.share;
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        let mut after = *y;
        let to = self.system.transition(mode, guard, s, &mut after.as_mut_slice()[..self.n]);
        (to, after)
    }
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        self.system.counter(mode, guard)
    }
    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        self.system.schedule(mode, guard)
    }
    fn rest(
        &self,
        mode: S::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(S::Mode, State<N>)> {
        let mut after = *y;
        let to = self.system.rest(mode, guard, s, &mut after.as_mut_slice()[..self.n])?;
        Some((to, after))
    }
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        self.system.transition_condition(mode, guard, s, &y.as_slice()[..self.n])
    }
}

/// Reports to the observer of a system what happens to the padded system.
pub(crate) struct Unpadded<'a, O> {
    pub(crate) observer: &'a mut O,
    pub(crate) n: usize,
}

impl<Mode: Copy, O: DynamicObserver<Mode>, const N: usize> Observer<Mode, N> for Unpadded<'_, O> {
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        let &SwitchEvent { s, guard, flatness, jump, from, to, .. } = event;
        let mut simultaneous = [0; 8];
        let mut count = 0;
        for other in (0..8).filter(|other| event.simultaneous >> other & 1 == 1) {
            simultaneous[count] = other;
            count += 1;
        }
        let simultaneous = &simultaneous[..count];
        let (before, after) =
            (&event.before.as_slice()[..self.n], &event.after.as_slice()[..self.n]);
        let event =
            DynamicEvent { s, guard, simultaneous, flatness, jump, from, to, before, after };
        self.observer.on_switch(&event);
    }
    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.observer.on_grazing(grazing);
    }
    fn on_pole(&mut self, pole: &Pole<Mode>) {
        self.observer.on_pole(pole);
    }
    fn on_preempted(&mut self, preempted: &Preempted<Mode>) {
        self.observer.on_preempted(preempted);
    }
    fn on_rest(&mut self, rest: &Rest<Mode>) {
        self.observer.on_rest(rest);
    }
    fn forget(&mut self, switches: usize) {
        self.observer.forget(switches);
    }
    fn stops(&self, s: f64) -> bool {
        self.observer.stops(s)
    }
    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>) {
        let mut r = [0.0; 64];
        let degree = dense.degree;
        for (to, from) in r.chunks_exact_mut(self.n).zip(&dense.r[..=degree]) {
            to.copy_from_slice(&from.as_slice()[..self.n]);
        }
        let r = &r[..(degree + 1) * self.n];
        self.observer
            .on_segment(mode, &DynamicDense { s: dense.s, h: dense.h, n: self.n, degree, r });
    }
    fn on_end(&mut self, mode: Mode, s: f64, state: &State<N>) {
        self.observer.on_end(mode, s, &state.as_slice()[..self.n]);
    }
}
