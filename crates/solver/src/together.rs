//! Guards that vanish where another one fires, in a run that goes on unchanged.
//!
//! The mode and the state are the same before and after such a switch, so that every guard goes on as it came. One that is zero there
//! to within rounding has no sign at that place: the step that ends there tells from which side it comes, and a step ahead, which is
//! not taken, to which it goes. It crosses if the two differ, and fires together with the guard that fired if that is its direction.
//! Either way it starts the next step from a known zero, which it leaves to a known side.

use crate::along_step::{AlongStep, rounding};
use crate::event::{Event, bit};
use crate::guard::Direction;
use crate::hybrid::{HybridSystem, Statistics};
use crate::isolate::sides;
use crate::method::{Method, State, Step, Trial};
use crate::options::{Options, StepSize};
use crate::phase::Phase;

/// A step ahead is cut to a fifth at most this often, like a step that is too coarse.
const CUTS: usize = 60;

/// Where the guards stand after an event that changes nothing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standing<const G: usize> {
    /// Guards that have fired with the event, one bit each.
    pub(crate) fired: u32,
    /// Orders of the zeros at which guards stand; 0 for those that do not.
    pub(crate) zero_orders: [u32; G],
    /// The signs with which they leave these zeros; 0 where it is not known.
    pub(crate) sides: [f64; G],
}

/// All that tells where the guards stand after an event that changes nothing.
pub(crate) struct Passage<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    /// As it was before the step that ends at the event.
    pub(crate) phase: &'a Phase<S::Mode, G>,
    pub(crate) event: &'a Event<N>,
    /// The place of the event.
    pub(crate) s: f64,
    /// The longest step ahead.
    pub(crate) ahead: f64,
    pub(crate) options: &'a Options,
    pub(crate) statistics: &'a mut Statistics,
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> Passage<'_, S, N, G> {
    pub(crate) fn standing<M: Method>(mut self) -> Standing<G> {
        let (event, phase) = (self.event, self.phase);
        let stays = event.elapsed == 0.0;
        let mut standing = Standing { fired: 0, zero_orders: [0; G], sides: [0.0; G] };
        let mut fired = 0;
        let mut stand = |guard: usize, side: f64| {
            // No time has passed since the zero that was known.
            let order = if stays { phase.zero_orders[guard] } else { 0 };
            standing.zero_orders[guard] = order.max(1);
            standing.sides[guard] = side;
        };
        stand(event.guard, -event.sign);
        self.statistics.guards += 1;
        let values = self.system.guard_values(phase.mode, self.s, &event.state);
        for guard in (0..G).filter(|&guard| guard != event.guard) {
            let direction = phase.guards[guard].direction();
            if direction == Direction::Off {
                continue;
            }
            if stays && phase.zero_orders[guard] > 0 {
                stand(guard, phase.sides[guard]);
                continue;
            }
            let hidden = self.hidden(guard);
            let at_zero = values[guard].abs() <= hidden;
            let (from, to) = if at_zero {
                (self.side_before::<M>(guard, hidden), self.side_behind::<M>(guard, hidden))
            } else if event.has_passed(guard) {
                let to = values[guard].signum();
                let came_back = direction == Direction::Either && self.side_at_start(guard) == to;
                (if came_back { to } else { -to }, to)
            } else {
                continue;
            };
            let fires = match direction {
                Direction::Rising => from < 0.0 && to > 0.0,
                Direction::Either => from * to < 0.0,
                _ => from > 0.0 && to < 0.0,
            };
            // A bound of the domain fires as long as it is negative; the run ends with an event of its own.
            let by_itself =
                phase.guards[guard].ends_run() || direction == Direction::Below || bit(guard) == 0;
            if fires && !by_itself {
                fired |= bit(guard);
            }
            if fires && by_itself && direction != Direction::Below {
                stand(guard, from);
            } else if at_zero {
                stand(guard, if to == 0.0 { from } else { to });
            }
        }
        standing.fired = fired;
        standing
    }

    /// What rounding leaves of a guard at its zero, in units that the step up to there has.
    fn hidden(&mut self, guard: usize) -> f64 {
        self.statistics.guards += N + 2;
        let (mode, step) = (self.phase.mode, &self.event.step);
        let value = |s: f64, y: &State<N>| self.system.guard_values(mode, s, y)[guard];
        let like = self.event.state.zip_map(&step.y0, |y, y0| y.abs().max(y0.abs()));
        rounding(value, (self.s, &self.event.state), (self.s.abs().max(step.s.abs()), &like))
    }

    fn side_at_start(&self, guard: usize) -> f64 {
        let value = self.phase.values[guard];
        if self.phase.zero_orders[guard] > 0 {
            self.phase.sides[guard]
        } else if value == 0.0 {
            0.0
        } else {
            value.signum()
        }
    }

    /// The side from which a guard comes to the event; 0 where it is not known.
    fn side_before<M: Method>(&mut self, guard: usize, hidden: f64) -> f64 {
        let start = self.side_at_start(guard);
        let elapsed = self.event.elapsed;
        // One that fires either way has kept its side: it would have fired.
        if elapsed == 0.0 || (start != 0.0 && self.phase.guards[guard].direction() == Direction::Either) {
            return start;
        }
        let mut step = Step::blank();
        self.system.step::<M>(self.phase.mode, &self.event.step.shortened(elapsed), &mut step);
        self.count::<M>();
        match self.sides::<M>(guard, hidden, &mut step) {
            Some([_, last]) if last != 0.0 => last,
            _ => start,
        }
    }

    /// The side to which a guard goes after the event; 0 where it is not known.
    fn side_behind<M: Method>(&mut self, guard: usize, hidden: f64) -> f64 {
        let (mode, y) = (self.phase.mode, &self.event.state);
        let slope = self.system.field(mode, self.s, y);
        self.statistics.field += 1;
        let mut h = self.ahead;
        for _ in 0..CUTS {
            if !(h > 0.0) {
                break;
            }
            let tolerances = (self.options.rtol, self.options.atol);
            let mut step = Step::blank();
            self.system.step::<M>(mode, &Trial { s: self.s, y, slope: &slope, h, tolerances }, &mut step);
            self.count::<M>();
            let good = match self.options.step_size {
                StepSize::Adaptive => step.error < 1.0,
                StepSize::Fixed(_) => step.y1.sum().is_finite(),
            };
            if good && let Some([first, _]) = self.sides::<M>(guard, hidden, &mut step) {
                return first;
            }
            h *= 0.2;
        }
        0.0
    }

    fn count<M: Method>(&mut self) {
        self.statistics.resteps += 1;
        self.statistics.field += M::STAGES - 1 + usize::from(M::ERROR_USES_END);
    }

    /// The first and the last side that a guard shows inside a step; `None` if the step does not tell.
    fn sides<M: Method>(&mut self, guard: usize, hidden: f64, step: &mut Step<N>) -> Option<[f64; 2]> {
        let (system, mode) = (self.system, self.phase.mode);
        let dense = step.dense::<M>(&mut |s, y| system.field(mode, s, y));
        self.statistics.field += M::DENSE_STAGES - 1;
        self.statistics.guards += 1;
        let end = system.guard_values(mode, step.s + step.h, &step.y1)[guard];
        let mut curve = AlongStep::<'_, S, M, N, G> {
            system,
            mode,
            guard,
            sign: 1.0,
            step,
            dense: &dense,
            statistics: &mut *self.statistics,
            method: std::marker::PhantomData,
        };
        sides(&mut curve, hidden, end).ok().flatten()
    }
}
