//! What the examination of a step needs, and the values of its guards.

use crate::events::event::Note;
use crate::events::notices::Notices;
use crate::events::phase::Phase;
use crate::events::quick::{BETWEEN, NODES, between};
use crate::hybrid::Statistics;
use crate::lists::List;
use crate::method::{StepOf, Store, TrialOf};
use crate::system::{PerGuard, Room, System};

/// The data that the examination of a step needs.
pub(crate) struct Examination<'a, S: System> {
    pub(crate) system: &'a S,
    pub(crate) phase: &'a Phase<S>,
    /// The step before it was shortened.
    pub(crate) trial: &'a TrialOf<'a, S::State>,
    /// The time from the start of the phase to the start of the step.
    pub(crate) age: f64,
    /// By how much rounding may have moved a time at the start of the step.
    pub(crate) drift: f64,
    /// The size of a step that nothing cuts.
    pub(crate) usual: f64,
    /// The shortest time on which a guard of a black box may change, infinite if it is not known.
    pub(crate) guard_scale: f64,
    /// The events on this step that change nothing.
    pub(crate) notes: &'a mut Vec<Note<S>>,
    pub(crate) statistics: &'a mut Statistics,
    /// Whether steps are shown, so that the step of an event must end exactly there.
    pub(crate) wants_segments: bool,
    /// The touches and poles on this step.
    pub(crate) notices: &'a mut Notices<S::Mode>,
    pub(crate) room: &'a mut Room<S>,
}

impl<S: System> Examination<'_, S> {
    /// The values of all guards at the [`NODES`] of a step.
    pub(crate) fn values_on(
        &mut self,
        step: &StepOf<S::State>,
        values: &mut [PerGuard<S, f64>; 6],
    ) {
        values_on(self.system, self.phase, step, values, self.statistics);
    }

    /// Whether the values of each guard between the [`NODES`] are those that the values at the
    /// nodes predict.
    pub(crate) fn confirmed(
        &mut self,
        step: &StepOf<S::State>,
        values: &[PerGuard<S, f64>; 6],
        confirmed: &mut PerGuard<S, bool>,
    ) {
        let (phase, scale) = (self.phase, self.guard_scale);
        let room = &mut *self.room;
        self::confirmed(self.system, phase, scale, step, values, confirmed, self.statistics, room);
    }
}

/// The values of all guards at the [`NODES`] of a step.
#[inline(always)]
pub(crate) fn values_on<S: System>(
    system: &S,
    phase: &Phase<S>,
    step: &StepOf<S::State>,
    values: &mut [PerGuard<S, f64>; 6],
    statistics: &mut Statistics,
) {
    let mut at = |node: usize, theta: f64, y: &S::State| {
        system.guard_values(phase.mode, step.s + theta * step.h, y, &mut values[node]);
    };
    at(1, NODES[1], &step.interior[0]);
    at(2, NODES[2], &step.interior[1]);
    at(3, NODES[3], &step.interior[2]);
    at(4, NODES[4], &step.interior[3]);
    at(5, 1.0, &step.y1);
    values[0].set(&phase.values);
    statistics.guards += if phase.count() > 0 { 5 } else { 0 };
}

/// Whether the values at the [`NODES`] predict the values of each guard between them. Only black
/// boxes are checked, and not guards that are declared to be smooth.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "in a struct, the compiler keeps them in memory")]
pub(crate) fn confirmed<S: System>(
    system: &S,
    phase: &Phase<S>,
    guard_scale: f64,
    step: &StepOf<S::State>,
    values: &[PerGuard<S, f64>; 6],
    confirmed: &mut PerGuard<S, bool>,
    statistics: &mut Statistics,
    room: &mut Room<S>,
) {
    confirmed.parts_mut().fill(true);
    if S::READABLE || phase.smooth {
        return;
    }
    if step.h > guard_scale {
        confirmed.parts_mut().fill(false);
        return;
    }
    let [a, b, c, d] = &step.interior;
    let states = [&step.y0, a, b, c, d, &step.y1];
    statistics.guards += BETWEEN.len();
    let (mut y, mut found) = (room.state(), room.row());
    for (place, theta) in BETWEEN.into_iter().enumerate() {
        S::State::each(&mut y, states, |_, states| between(place, &states));
        system.guard_values(phase.mode, step.s + theta * step.h, &y, &mut found);
        for guard in 0..phase.count() {
            let column = column::<S>(values, guard);
            let expected = between(place, &column);
            let size = column.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            // NaN is not confirmed.
            let off = (found[guard] - expected).abs();
            let sure = phase.guards[guard].needs_no_look();
            confirmed[guard] &= sure || off <= (0.5 * expected.abs()).max(0.01 * size);
        }
    }
    room.give(y);
    room.give_row(found);
}

/// The values of one guard at the [`NODES`]. Written out, it compiles to little.
#[inline(always)]
pub(crate) fn column<S: System>(values: &[PerGuard<S, f64>; 6], guard: usize) -> [f64; 6] {
    let [a, b, c, d, e, f] = values;
    [a[guard], b[guard], c[guard], d[guard], e[guard], f[guard]]
}
