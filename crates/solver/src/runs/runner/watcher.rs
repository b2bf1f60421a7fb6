//! Who watches a run: what it finds goes to an observer.

use crate::events::Note;
use crate::hybrid::{Grazing, HybridSystem, Observer, Pole, Preempted, Rest, SwitchEvent};
use crate::method::{DenseOf, State};
use crate::system::{Fixed, System};

/// Receives what a run finds.
pub(crate) trait Watcher<S: System> {
    const WANTS_SEGMENTS: bool;
    fn on_switch(&mut self, event: &Note<S>);
    fn on_grazing(&mut self, _: &Grazing<S::Mode>) {}
    fn on_pole(&mut self, _: &Pole<S::Mode>) {}
    fn on_preempted(&mut self, _: &Preempted<S::Mode>) {}
    fn on_rest(&mut self, _: &Rest<S::Mode>) {}
    fn forget(&mut self, _switches: usize) {}
    fn stops(&self, s: f64) -> bool;
    fn on_segment(&mut self, _: S::Mode, _: &DenseOf<S::State>) {}
    fn on_end(&mut self, _: S::Mode, _s: f64, _: &S::State) {}
}

/// An observer of a run of fixed dimension.
pub(super) struct FixedWatcher<'a, O>(pub(super) &'a mut O);

impl<S, O, const N: usize, const G: usize> Watcher<Fixed<'_, S, N, G>> for FixedWatcher<'_, O>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;
    #[inline(always)]
    fn on_switch(&mut self, note: &Note<Fixed<'_, S, N, G>>) {
        self.0.on_switch(&switch_event(note));
    }
    #[inline(always)]
    fn on_grazing(&mut self, grazing: &Grazing<S::Mode>) {
        self.0.on_grazing(grazing);
    }
    #[inline(always)]
    fn on_pole(&mut self, pole: &Pole<S::Mode>) {
        self.0.on_pole(pole);
    }
    #[inline(always)]
    fn on_preempted(&mut self, preempted: &Preempted<S::Mode>) {
        self.0.on_preempted(preempted);
    }
    #[inline(always)]
    fn on_rest(&mut self, rest: &Rest<S::Mode>) {
        self.0.on_rest(rest);
    }
    #[inline(always)]
    fn forget(&mut self, switches: usize) {
        self.0.forget(switches);
    }
    #[inline(always)]
    fn stops(&self, s: f64) -> bool {
        self.0.stops(s)
    }
    #[inline(always)]
    fn on_segment(&mut self, mode: S::Mode, dense: &DenseOf<State<N>>) {
        self.0.on_segment(mode, dense);
    }
    #[inline(always)]
    fn on_end(&mut self, mode: S::Mode, s: f64, state: &State<N>) {
        self.0.on_end(mode, s, state);
    }
}

/// The event of a note.
#[inline(always)]
pub(crate) fn switch_event<S: HybridSystem<N, G>, const N: usize, const G: usize>(
    note: &Note<Fixed<'_, S, N, G>>,
) -> SwitchEvent<S::Mode, N> {
    SwitchEvent {
        s: note.s,
        guard: note.guard,
        simultaneous: mask(&note.simultaneous),
        flatness: note.flatness,
        jump: note.jump(),
        from: note.from,
        to: note.to,
        before: note.before,
        after: note.after,
    }
}

/// The guards of a set among the first 64, one bit each.
fn mask(guards: &[bool]) -> u64 {
    let first = guards.iter().take(64).enumerate();
    first.fold(0, |bits, (guard, &one)| bits | u64::from(one) << guard)
}
