//! Guards of a dynamic system that are zero where the span of a run ends: what
//! [`crate::events::arrival`] does, on buffers.

use crate::dynamic::curve::{Work, rounding};
use crate::dynamic::event::Event;
use crate::dynamic::examination::Examination;
use crate::dynamic::step::Step;
use crate::dynamic::system::DynamicSystem;
use crate::events::arrival::{REACH, SAME};
use crate::hybrid::Direction;

impl<S: DynamicSystem> Examination<'_, S> {
    /// Finds guards that are zero at the end of `step`, to within rounding, and cross there in
    /// their direction. Such a guard fires, since no other step will find it. Of those that
    /// change something, the one that precedes is returned.
    pub(crate) fn arrive(&mut self, step: &Step) -> Option<Event> {
        let s0 = self.origin.s;
        let s = s0 + step.h;
        let mut event: Option<Event> = None;
        for guard in 0..self.phase.values.len() {
            let (direction, largest) =
                (self.phase.guards[guard].direction(), self.phase.largest[guard]);
            let far = largest > 0.0 && self.tables.end_of(guard).abs() > 1e-6 * largest;
            if direction == Direction::Off
                || far
                || self.notes_of(guard).any(|note| s0 + note.elapsed >= s - SAME * step.h)
            {
                continue;
            }
            let at = self.signed(guard, 1.0);
            let Work { moved, slope, scale, values, .. } = &mut *self.work;
            for ((scale, start), end) in scale.iter_mut().zip(self.origin.y).zip(&step.y1) {
                *scale = start.abs().max(end.abs());
            }
            let at_end = at.value(s, &step.y1, values);
            let s_scale = s.abs().max(s0.abs());
            let (hidden, count) = rounding(&at, (s, &step.y1), (s_scale, scale), moved, values);
            self.statistics.guards += count + 3;
            self.statistics.field += 1;
            let reach = REACH * step.h;
            at.system.field(at.mode, s, &step.y1, slope);
            let [behind, ahead] = [-reach, reach].map(|by| {
                for ((moved, y), slope) in moved.iter_mut().zip(&step.y1).zip(&*slope) {
                    *moved = y + slope * by;
                }
                at.value(s + by, moved, values)
            });
            let shows = behind.abs() > 4.0 * hidden && ahead.abs() > 4.0 * hidden;
            let crosses = shows && (behind < 0.0) != (ahead < 0.0);
            if at_end.abs() > hidden || !crosses || !direction.fires_from(behind) {
                continue;
            }
            let found = Event {
                guard,
                simultaneous: Vec::new(),
                slope: ((ahead - behind) / (2.0 * reach)).abs(),
                elapsed: step.h,
                state: step.y1.clone(),
                residual: at_end.abs(),
                sign: behind.signum(),
                beyond: step.h,
                jump: false,
            };
            if self.is_noted(&found) {
                let together = self.notes.last().is_some_and(|last| last.elapsed == step.h);
                self.note(found, together);
                continue;
            }
            // Of guards that fire together the one that precedes decides, and names the others.
            event = Some(match event {
                None => found,
                Some(first) => {
                    let precedes = self.rank(guard) < self.rank(first.guard);
                    let (first, other) = if precedes { (found, first) } else { (first, found) };
                    first.together_with(&other)
                }
            });
        }
        event
    }
}
