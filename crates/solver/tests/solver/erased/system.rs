//! Systems and observers of fixed dimension.

use stickslip_solver::method::Dense;
use stickslip_solver::{
    Enclosure, Grazing, Guard, HybridSystem, Observer, Run, Schedule, Start, State, SwitchEvent,
    hybrid::Pole,
};

use super::modes::Modes;

/// What a system consists of, with numbers for its modes, and with guards that are off behind its
/// own up to the number `W`.
pub trait Parts<const N: usize, const W: usize> {
    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N>;
    fn guards(&self, mode: usize) -> [Guard; W];
    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W];
    fn guard_rates(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W];
    fn enclose_guards(&self, mode: usize, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; W];
    fn settle(&self, mode: usize, y: &State<N>) -> usize;
    fn longest_first_step(&self, mode: usize, s: f64, y: &State<N>) -> f64;
    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>);
    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64;
    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_>;
    fn rest(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> Option<(usize, State<N>)>;
}

/// A system of `G` guards whose modes have numbers.
pub struct Numbered<'a, S, Mode, const G: usize> {
    pub system: &'a S,
    pub modes: &'a Modes<Mode>,
}

/// A list that goes on with a value.
fn padded<T: Copy, const G: usize, const W: usize>(own: [T; G], off: T) -> [T; W] {
    std::array::from_fn(|i| own.get(i).copied().unwrap_or(off))
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize, const W: usize> Parts<N, W>
    for Numbered<'_, S, S::Mode, G>
{
    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N> {
        self.system.field(self.modes.mode(mode), s, y)
    }

    fn guards(&self, mode: usize) -> [Guard; W] {
        padded(self.system.guards(self.modes.mode(mode)), Guard::OFF)
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W] {
        padded(self.system.guard_values(self.modes.mode(mode), s, y), f64::NAN)
    }

    fn guard_rates(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W] {
        padded(self.system.guard_rates(self.modes.mode(mode), s, y), f64::NAN)
    }

    fn enclose_guards(&self, mode: usize, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; W] {
        padded(self.system.enclose_guards(self.modes.mode(mode), s, y), Enclosure::ENTIRE)
    }

    fn settle(&self, mode: usize, y: &State<N>) -> usize {
        self.modes.number(self.system.settle(self.modes.mode(mode), y))
    }

    fn longest_first_step(&self, mode: usize, s: f64, y: &State<N>) -> f64 {
        self.system.longest_first_step(self.modes.mode(mode), s, y)
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        let (mode, y) = self.system.transition(self.modes.mode(mode), guard, s, y);
        (self.modes.number(mode), y)
    }

    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64 {
        self.system.transition_condition(self.modes.mode(mode), guard, s, y)
    }

    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        self.system.schedule(self.modes.mode(mode), guard)
    }

    fn rest(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> Option<(usize, State<N>)> {
        let (mode, y) = self.system.rest(self.modes.mode(mode), guard, s, y)?;
        Some((self.modes.number(mode), y))
    }
}

/// Any system.
pub struct Erased<'a, const N: usize, const W: usize, const READABLE: bool>(
    pub &'a dyn Parts<N, W>,
);

impl<const N: usize, const W: usize, const READABLE: bool> HybridSystem<N, W>
    for Erased<'_, N, W, READABLE>
{
    type Mode = usize;

    const READABLE: bool = READABLE;

    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N> {
        self.0.field(mode, s, y)
    }

    fn guards(&self, mode: usize) -> [Guard; W] {
        self.0.guards(mode)
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W] {
        self.0.guard_values(mode, s, y)
    }

    fn guard_rates(&self, mode: usize, s: f64, y: &State<N>) -> [f64; W] {
        self.0.guard_rates(mode, s, y)
    }

    fn enclose_guards(&self, mode: usize, s: Enclosure, y: &[Enclosure; N]) -> [Enclosure; W] {
        self.0.enclose_guards(mode, s, y)
    }

    fn settle(&self, mode: usize, y: &State<N>) -> usize {
        self.0.settle(mode, y)
    }

    fn longest_first_step(&self, mode: usize, s: f64, y: &State<N>) -> f64 {
        self.0.longest_first_step(mode, s, y)
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        self.0.transition(mode, guard, s, y)
    }

    fn transition_condition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> f64 {
        self.0.transition_condition(mode, guard, s, y)
    }

    fn schedule(&self, mode: usize, guard: usize) -> Schedule<'_> {
        self.0.schedule(mode, guard)
    }

    fn rest(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> Option<(usize, State<N>)> {
        self.0.rest(mode, guard, s, y)
    }
}

/// What an observer does, with numbers for modes.
pub trait Sees<const N: usize> {
    fn on_switch(&mut self, event: &SwitchEvent<usize, N>);
    fn on_grazing(&mut self, grazing: &Grazing<usize>);
    fn on_pole(&mut self, pole: &Pole<usize>);
    fn forget(&mut self, switches: usize);
    fn stops(&self, s: f64) -> bool;
    fn on_segment(&mut self, mode: usize, dense: &Dense<N>);
    fn on_end(&mut self, mode: usize, s: f64, state: &State<N>);
}

/// An observer that is told of modes with numbers.
pub struct Told<'a, O, Mode> {
    pub observer: &'a mut O,
    pub modes: &'a Modes<Mode>,
}

impl<O: Observer<Mode, N>, Mode: Copy + PartialEq, const N: usize> Sees<N> for Told<'_, O, Mode> {
    fn on_switch(&mut self, event: &SwitchEvent<usize, N>) {
        let SwitchEvent { s, guard, simultaneous, flatness, jump, from, to, before, after } =
            *event;
        let [from, to] = [from, to].map(|mode| self.modes.mode(mode));
        self.observer.on_switch(&SwitchEvent {
            s,
            guard,
            simultaneous,
            flatness,
            jump,
            from,
            to,
            before,
            after,
        });
    }

    fn on_grazing(&mut self, grazing: &Grazing<usize>) {
        self.observer.on_grazing(&self.modes.grazing(grazing));
    }

    fn on_pole(&mut self, pole: &Pole<usize>) {
        self.observer.on_pole(&self.modes.pole(pole));
    }

    fn forget(&mut self, switches: usize) {
        self.observer.forget(switches);
    }

    fn stops(&self, s: f64) -> bool {
        self.observer.stops(s)
    }

    fn on_segment(&mut self, mode: usize, dense: &Dense<N>) {
        self.observer.on_segment(self.modes.mode(mode), dense);
    }

    fn on_end(&mut self, mode: usize, s: f64, state: &State<N>) {
        self.observer.on_end(self.modes.mode(mode), s, state);
    }
}

/// Any observer.
pub struct Watching<'a, const N: usize, const WANTS_SEGMENTS: bool>(pub &'a mut dyn Sees<N>);

impl<const N: usize, const WANTS_SEGMENTS: bool> Observer<usize, N>
    for Watching<'_, N, WANTS_SEGMENTS>
{
    const WANTS_SEGMENTS: bool = WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &SwitchEvent<usize, N>) {
        self.0.on_switch(event);
    }

    fn on_grazing(&mut self, grazing: &Grazing<usize>) {
        self.0.on_grazing(grazing);
    }

    fn on_pole(&mut self, pole: &Pole<usize>) {
        self.0.on_pole(pole);
    }

    fn forget(&mut self, switches: usize) {
        self.0.forget(switches);
    }

    fn stops(&self, s: f64) -> bool {
        self.0.stops(s)
    }

    fn on_segment(&mut self, mode: usize, dense: &Dense<N>) {
        self.0.on_segment(mode, dense);
    }

    fn on_end(&mut self, mode: usize, s: f64, state: &State<N>) {
        self.0.on_end(mode, s, state);
    }
}

impl<Mode: Copy + PartialEq> Modes<Mode> {
    /// The start of a run, with a number for its mode.
    pub fn start<const N: usize>(&self, start: Start<Mode, N>) -> Start<usize, N> {
        let Start { mode, s, state } = start;
        Start { mode: self.number(mode), s, state }
    }

    /// The end of a run.
    pub fn end<const N: usize>(&self, run: Run<usize, N>) -> Run<Mode, N> {
        let Run { outcome, s, mode, state, decided, statistics } = run;
        Run { outcome, s, mode: self.mode(mode), state, decided, statistics }
    }
}
