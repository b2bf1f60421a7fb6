//! Guards that vanish where another guard fires, if the run goes on unchanged.
//!
//! Mode and state are the same before and after such a switch, so that every guard goes on as it
//! came. A guard that is zero there to within rounding has no sign at that place. The step that
//! ends there tells from which side the guard comes. A step ahead, which is not accepted, tells to
//! which side it goes. If the two sides differ, the guard crosses. If it crosses in its direction,
//! it fires together with the guard that fired. In any case it starts the next step from a known
//! zero, and leaves it to a known side.

use std::marker::PhantomData;

use crate::events::along_step::{AlongStep, dense_output, rounding};
use crate::events::event::{Event, bit};
use crate::events::isolate::{noise, sides};
use crate::events::phase::{Phase, Standing};
use crate::events::quick::NODES;
use crate::hybrid::{Direction, HybridSystem, Statistics};
use crate::method::{Dense, Method, State, Step, Trial};
use crate::options::{Options, StepSize};

/// A step ahead is cut to a fifth at most this often, as is a step that is too coarse.
const CUTS: usize = 60;

/// A guard whose value exceeds this part of its largest value on the step is not at zero.
const NEAR: f64 = 1e-3;

/// The data that tell where the guards stand after an event that changes nothing.
pub(crate) struct Passage<'a, S: HybridSystem<N, G>, const N: usize, const G: usize> {
    pub(crate) system: &'a S,
    /// The phase before the step that ends at the event.
    pub(crate) phase: &'a Phase<S::Mode, G>,
    pub(crate) event: &'a Event<N>,
    /// The place of the event.
    pub(crate) s: f64,
    /// The size of the longest step ahead that does not pass the end of the run.
    pub(crate) ahead: f64,
    /// The size of the longest step ahead, regardless of the end of the run.
    pub(crate) ordinary: f64,
    pub(crate) options: &'a Options,
    pub(crate) statistics: &'a mut Statistics,
}

impl<S: HybridSystem<N, G>, const N: usize, const G: usize> Passage<'_, S, N, G> {
    /// Where the guards stand.
    pub(crate) fn standing<M: Method>(mut self) -> Standing<G> {
        let (event, phase) = (self.event, self.phase);
        let stays = event.elapsed == 0.0;
        let mut standing = Standing {
            fired: 0,
            zero_orders: [0; G],
            sides: [0.0; G],
            hidden: [0.0; G],
            due: [false; G],
        };
        let (mut fired, mut due) = (0, [false; G]);
        let mut stand = |guard: usize, side: f64, hidden: f64| {
            // If no time has passed, the known zero keeps its order.
            let order = if stays { phase.zero_orders[guard] } else { 0 };
            standing.zero_orders[guard] = order.max(1);
            standing.sides[guard] = side;
            standing.hidden[guard] = hidden;
        };
        self.statistics.guards += 1;
        let values = self.system.guard_values(phase.mode, self.s, &event.state);
        let hidden = self.hidden::<M>(event.guard, 0.0);
        stand(event.guard, -event.sign, hidden.max(values[event.guard].abs()));
        for guard in (0..G).filter(|&guard| guard != event.guard) {
            let direction = phase.guards[guard].direction();
            if direction == Direction::Off {
                continue;
            }
            if stays && phase.zero_orders[guard] > 0 {
                stand(guard, phase.sides[guard], phase.hidden[guard]);
                due[guard] = phase.due[guard];
                continue;
            }
            let hidden = self.hidden::<M>(guard, values[guard]);
            let at_zero = values[guard].abs() <= hidden;
            let (from, to) = if at_zero {
                (self.side_before::<M>(guard, hidden), self.side_after::<M>(guard, hidden))
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
            // A bound of the domain fires as long as it is negative. A terminal guard ends the run
            // with an event of its own.
            let by_itself =
                phase.guards[guard].ends_run() || direction == Direction::Below || bit(guard) == 0;
            if fires && !by_itself {
                fired |= bit(guard);
            }
            due[guard] = fires && by_itself && direction != Direction::Below;
            if due[guard] {
                stand(guard, from, hidden.max(values[guard].abs()));
            } else if at_zero {
                stand(guard, if to == 0.0 { from } else { to }, hidden);
            }
        }
        Standing { fired, due, ..standing }
    }

    /// The largest absolute value that a guard may have at its zero because of rounding and noise,
    /// on the scales of the step that ends there. Noise is not measured if `value` is far from
    /// zero.
    fn hidden<M: Method>(&mut self, guard: usize, value: f64) -> f64 {
        let (system, phase, event) = (self.system, self.phase, self.event);
        let value_at = |s: f64, y: &State<N>| system.guard_values(phase.mode, s, y)[guard];
        self.statistics.guards += N + 2;
        let s_scale = self.s.abs().max(event.step.s.abs());
        let y_scale = event.state.zip_map(&event.step.y0, |y, y0| y.abs().max(y0.abs()));
        let rounding = rounding(value_at, (self.s, &event.state), (s_scale, &y_scale));
        let known = if phase.zero_orders[guard] > 0 { phase.hidden[guard] } else { 0.0 };
        let hidden = known.max(rounding);
        // A step that is as short as the rounding of the time would show no scatter.
        let at_end = self.event.elapsed >= self.ordinary;
        let mut step =
            if at_end { self.up_to_here::<M>() } else { self.step_ahead::<M>(self.ordinary) };
        let nodes = step.interior.iter().zip(&NODES[1..]);
        let nodes = nodes.map(|(y, theta)| value_at(step.s + theta * step.h, y).abs());
        let largest = nodes.fold(phase.values[guard].abs(), f64::max);
        self.statistics.guards += NODES.len() - 2;
        if value.abs() > hidden && value.abs() > NEAR * largest {
            return hidden;
        }
        let dense = self.dense::<M>(&mut step);
        hidden.max(noise(&mut self.curve::<M>(guard, &step, &dense), at_end))
    }

    /// The step that ends at the event.
    fn up_to_here<M: Method>(&mut self) -> Step<N> {
        let mut step = Step::blank();
        self.system.step::<M>(
            self.phase.mode,
            &self.event.step.shortened(self.event.elapsed),
            &mut step,
        );
        self.count::<M>();
        step
    }

    /// A step of size `h` from the event on.
    fn step_ahead<M: Method>(&mut self, h: f64) -> Step<N> {
        let (mode, s, y) = (self.phase.mode, self.s, &self.event.state);
        let slope = &self.system.field(mode, s, y);
        self.statistics.field += 1;
        let tolerances = (self.options.rtol, self.options.atol);
        let mut step = Step::blank();
        self.system.step::<M>(mode, &Trial { s, y, slope, h, tolerances }, &mut step);
        self.count::<M>();
        step
    }

    /// The sign of a guard at the start of the step that ends at the event, 0 if it has none.
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

    /// The sign of a guard before the event, 0 if it is not known.
    fn side_before<M: Method>(&mut self, guard: usize, hidden: f64) -> f64 {
        let start = self.side_at_start(guard);
        let elapsed = self.event.elapsed;
        // A guard that fires in either direction has kept its sign, or it would have fired.
        if elapsed == 0.0
            || (start != 0.0 && self.phase.guards[guard].direction() == Direction::Either)
        {
            return start;
        }
        let mut step = self.up_to_here::<M>();
        match self.sides::<M>(guard, hidden, &mut step) {
            Some([_, last]) if last != 0.0 => last,
            _ => start,
        }
    }

    /// The sign of a guard after the event, 0 if it is not known.
    fn side_after<M: Method>(&mut self, guard: usize, hidden: f64) -> f64 {
        let mut h = self.ahead;
        for _ in 0..CUTS {
            if h <= 0.0 {
                break;
            }
            let mut step = self.step_ahead::<M>(h);
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

    /// The first and the last sign that a guard shows on a step, or `None` if the step does not
    /// tell.
    fn sides<M: Method>(
        &mut self,
        guard: usize,
        hidden: f64,
        step: &mut Step<N>,
    ) -> Option<[f64; 2]> {
        self.statistics.guards += 1;
        let end = self.system.guard_values(self.phase.mode, step.s + step.h, &step.y1)[guard];
        let dense = self.dense::<M>(step);
        sides(&mut self.curve::<M>(guard, step, &dense), hidden, end).ok().flatten()
    }

    fn dense<M: Method>(&mut self, step: &mut Step<N>) -> Dense<N> {
        let (system, mode) = (self.system, self.phase.mode);
        self.statistics.field += M::DENSE_STAGES - 1;
        dense_output::<_, M, N, G>(system, mode, step)
    }

    fn curve<'b, M: Method>(
        &'b mut self,
        guard: usize,
        step: &'b Step<N>,
        dense: &'b Dense<N>,
    ) -> AlongStep<'b, S, M, N, G> {
        let statistics = &mut *self.statistics;
        let (system, mode, method) = (self.system, self.phase.mode, PhantomData);
        AlongStep { system, mode, guard, sign: 1.0, step, dense, statistics, method }
    }
}
