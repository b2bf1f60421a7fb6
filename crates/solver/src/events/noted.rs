//! Events that only report a crossing, since nothing changes there: a step is not cut at them.
//!
//! The guard is examined again behind the bracket of its crossing, as soon as its values have left
//! their noise. If another guard changes something at that instant and precedes the note, the note
//! waits for its turn.

use crate::events::event::{Crossed, Event, Note, only};
use crate::events::examination::Examination;
use crate::hybrid::Direction;
use crate::lists::List;
use crate::method::Store;
use crate::system::System;

impl<S: System> Examination<'_, S> {
    /// Whether an event only reports a crossing: mode and state go on unchanged.
    pub(crate) fn is_noted(&self, event: &Event<S>) -> bool {
        let about = self.phase.guards[event.guard];
        let before = self.notes_of(event.guard).count();
        if about.direction() == Direction::Below
            || before + 1 == about.fires_until_end() as usize
            || !event.state.parts().iter().all(|value| value.is_finite())
        {
            return false;
        }
        let s = self.trial.s + event.elapsed;
        let mut after = event.state.clone();
        self.system.transition(self.phase.mode, event.guard, s, &mut after) == self.phase.mode
            && after == event.state
    }

    /// The notes of a guard on this step.
    pub(crate) fn notes_of(&self, guard: usize) -> impl Iterator<Item = &Note<S>> {
        self.notes.iter().filter(move |note| note.guard == guard || note.simultaneous[guard])
    }

    /// Notes an event that changes nothing. If it is `together` with the event before, both are one
    /// event.
    pub(crate) fn note(&mut self, event: &Event<S>, together: bool) {
        if together
            && let Some(last) = self.notes.last_mut()
            && last.guard != event.guard
            && !last.simultaneous[event.guard]
        {
            last.simultaneous[event.guard] = true;
            last.crossed[event.guard] = event.crossed[event.guard];
            return;
        }
        let crossed = event.own();
        self.notes.push(Note {
            s: self.trial.s + event.elapsed,
            guard: event.guard,
            simultaneous: List::of(self.phase.count(), false),
            flatness: self.phase.flatness(event.guard, crossed.slope),
            crossed: only(self.phase.count(), event.guard, crossed),
            from: self.phase.mode,
            to: self.phase.mode,
            before: event.state.clone(),
            after: event.state.clone(),
        });
    }

    /// Lets guards that were noted at the instant of `event`, and whose turn is only behind its
    /// guard, wait for their turn: what acts before may change what they do.
    pub(crate) fn take_back(&mut self, event: &mut Event<S>) {
        if self.notes.is_empty() {
            return;
        }
        let s = self.trial.s + event.elapsed;
        let since = s - 2.0 * self.error_of(event) - 8.0 * f64::EPSILON * s.abs();
        let mut notes = std::mem::take(self.notes);
        let phase = self.phase;
        notes.retain_mut(|note| {
            let crossed = note.crossed[note.guard].unwrap_or(Crossed::AT_ONCE);
            let place = (&event.step, note.s - self.trial.s, &note.before);
            if note.s < since - self.error_at((note.guard, crossed), place, 0.0) {
                return true;
            }
            let mut first: Option<usize> = None;
            for guard in 0..phase.count() {
                let Some(crossed) = note.crossed[guard] else { continue };
                if phase.precedes(guard, event.guard) {
                    first = first.filter(|&first| phase.precedes(first, guard)).or(Some(guard));
                } else {
                    event.crossed[guard] = event.crossed[guard].or(Some(crossed));
                    note.crossed[guard] = None;
                    note.simultaneous[guard] = false;
                }
            }
            let Some(guard) = first else { return false };
            if guard != note.guard {
                note.simultaneous[guard] = false;
                note.simultaneous[note.guard] = note.crossed[note.guard].is_some();
                note.guard = guard;
                let slope = note.crossed[guard].map_or(f64::INFINITY, |crossed| crossed.slope);
                note.flatness = phase.flatness(guard, slope);
            }
            event.since = event.since.min(note.s);
            true
        });
        *self.notes = notes;
    }
}
