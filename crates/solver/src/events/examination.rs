//! What the examination of a step needs, and the values of its guards.

use crate::events::notices::Notices;
use crate::events::phase::Phase;
use crate::events::quick::{BETWEEN, NODES, between};
use crate::hybrid::{HybridSystem, Statistics, SwitchEvent};
use crate::method::{State, Step, Trial};

/// The data that the examination of a step needs.
pub(crate) struct Examination<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    pub(crate) phase: &'a Phase<S::Mode, G>,
    /// The step before it was shortened.
    pub(crate) trial: &'a Trial<'a, N>,
    /// The shortest time on which a guard of a black box may change, infinite if it is not known.
    pub(crate) guard_scale: f64,
    /// The events on this step that change nothing.
    pub(crate) notes: &'a mut Vec<SwitchEvent<S::Mode, N>>,
    pub(crate) statistics: &'a mut Statistics,
    /// Whether steps are shown, so that the step of an event must end exactly there.
    pub(crate) wants_segments: bool,
    /// The touches and poles on this step.
    pub(crate) notices: &'a mut Notices<S::Mode>,
}

impl<S, const N: usize, const G: usize> Examination<'_, S, N, G>
where
    S: HybridSystem<N, G>,
{
    /// The values of all guards at the [`NODES`] of a step.
    pub(crate) fn values_on(&mut self, step: &Step<N>) -> [[f64; G]; 6] {
        values_on(self.system, self.phase, step, self.statistics)
    }

    /// Whether the values of each guard between the [`NODES`] are those that the values at the
    /// nodes predict.
    pub(crate) fn confirmed(&mut self, step: &Step<N>, values: &[[f64; G]; 6]) -> [bool; G] {
        confirmed(self.system, self.phase, self.guard_scale, step, values, self.statistics)
    }
}

/// The values of all guards at the [`NODES`] of a step.
#[inline(always)]
pub(crate) fn values_on<S: HybridSystem<N, G>, const N: usize, const G: usize>(
    system: &S,
    phase: &Phase<S::Mode, G>,
    step: &Step<N>,
    statistics: &mut Statistics,
) -> [[f64; G]; 6] {
    let at = |theta: f64, y: &State<N>| system.guard_values(phase.mode, step.s + theta * step.h, y);
    statistics.guards += if G > 0 { 5 } else { 0 };
    [
        phase.values,
        at(NODES[1], &step.interior[0]),
        at(NODES[2], &step.interior[1]),
        at(NODES[3], &step.interior[2]),
        at(NODES[4], &step.interior[3]),
        at(1.0, &step.y1),
    ]
}

/// Whether the values of each guard between the [`NODES`] are those that the values at the nodes
/// predict. This is asked of black boxes only, and not of guards that are declared to be smooth.
#[inline(always)]
pub(crate) fn confirmed<S: HybridSystem<N, G>, const N: usize, const G: usize>(
    system: &S,
    phase: &Phase<S::Mode, G>,
    guard_scale: f64,
    step: &Step<N>,
    values: &[[f64; G]; 6],
    statistics: &mut Statistics,
) -> [bool; G] {
    if S::READABLE || phase.smooth {
        return [true; G];
    }
    if step.h > guard_scale {
        return [false; G];
    }
    let [a, b, c, d] = &step.interior;
    let states = [&step.y0, a, b, c, d, &step.y1];
    let mut confirmed = [true; G];
    statistics.guards += BETWEEN.len();
    for (place, theta) in BETWEEN.into_iter().enumerate() {
        let y = State::from_fn(|i, _| between(place, &states.map(|state| state[i])));
        let found = system.guard_values(phase.mode, step.s + theta * step.h, &y);
        for guard in 0..G {
            let column = column(values, guard);
            let expected = between(place, &column);
            let size = column.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            // NaN is not confirmed.
            let off = (found[guard] - expected).abs();
            let sure = phase.guards[guard].needs_no_look();
            confirmed[guard] &= sure || off <= (0.5 * expected.abs()).max(0.01 * size);
        }
    }
    confirmed
}

/// The values of one guard at the [`NODES`]. Written out, it compiles to little.
#[inline(always)]
pub(crate) fn column<const G: usize>(values: &[[f64; G]; 6], guard: usize) -> [f64; 6] {
    let [a, b, c, d, e, f] = values;
    [a[guard], b[guard], c[guard], d[guard], e[guard], f[guard]]
}
