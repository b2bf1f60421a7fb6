//! Guards that are zero where the span of a run ends.

use crate::events::along_step::rounding;
use crate::events::event::{Event, bit};
use crate::events::examination::Examination;
use crate::hybrid::{Direction, HybridSystem};
use crate::method::Step;

/// The part of the step over which a guard is differenced, on both sides of the end.
pub(crate) const REACH: f64 = 1e-3;
/// An event this close to the end of its step is the one at the end.
pub(crate) const SAME: f64 = 1e-6;

impl<S, const N: usize, const G: usize> Examination<'_, S, N, G>
where
    S: HybridSystem<N, G>,
{
    /// Finds guards that are zero at the end of `step`, to within rounding, and cross there in
    /// their direction. Such a guard fires, since no other step will find it.
    pub(crate) fn arrive(&mut self, step: &Step<N>, event: &mut Option<Event<N>>) {
        let (system, mode) = (self.system, self.phase.mode);
        let (s, y) = (step.s + step.h, &step.y1);
        let values = system.guard_values(mode, s, y);
        self.statistics.guards += 1;
        let (s_scale, y_scale) =
            (s.abs().max(step.s.abs()), y.zip_map(&step.y0, |a, b| a.abs().max(b.abs())));
        for (guard, &at_end) in values.iter().enumerate() {
            let direction = self.phase.guards[guard].direction();
            let far =
                self.phase.largest[guard] > 0.0 && at_end.abs() > 1e-6 * self.phase.largest[guard];
            if direction == Direction::Off
                || far
                || self.notes_of(guard).any(|note| note.s >= s - SAME * step.h)
            {
                continue;
            }
            let value = |s: f64, y: &_| system.guard_values(mode, s, y)[guard];
            let hidden = rounding(value, (s, y), (s_scale, &y_scale));
            self.statistics.guards += N + 4;
            self.statistics.field += 1;
            let reach = REACH * step.h;
            let away = system.field(mode, s, y) * reach;
            let (behind, ahead) = (value(s - reach, &(y - away)), value(s + reach, &(y + away)));
            let shows = behind.abs() > 4.0 * hidden && ahead.abs() > 4.0 * hidden;
            let crosses = shows && (behind < 0.0) != (ahead < 0.0);
            if at_end.abs() > hidden || !crosses || !direction.fires_from(behind) {
                continue;
            }
            let found = Event {
                guard,
                simultaneous: 0,
                slope: ((ahead - behind) / (2.0 * reach)).abs(),
                elapsed: step.h,
                state: step.y1,
                residual: at_end.abs(),
                sign: behind.signum(),
                beyond: step.h,
                jump: false,
                step: *step,
            };
            if self.is_noted(&found) {
                let together = self.notes.last().is_some_and(|last| last.s == s);
                self.note(&found, together);
                continue;
            }
            // Of guards that fire together the one that precedes decides, and names the others.
            *event = Some(match event.take() {
                None => found,
                Some(first) if self.precedes(guard, first.guard) => {
                    Event { simultaneous: first.simultaneous | bit(first.guard), ..found }
                }
                Some(first) => Event { simultaneous: first.simultaneous | bit(guard), ..first },
            });
        }
    }
}
