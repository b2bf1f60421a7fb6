//! A guard as a function along a dynamic step, and the effect of rounding on it.

use std::marker::PhantomData;

use crate::dynamic::dense::DynamicDense;
use crate::dynamic::step::{Origin, Step};
use crate::dynamic::system::{DynamicSystem, SignedGuard};
use crate::error::RunError;
use crate::events::along_step::SLIGHT;
use crate::events::aside::{Aside, resolution};
use crate::events::isolate::Curve;
use crate::hybrid::Statistics;
use crate::method::Method;

/// Up to this dimension the components are moved one by one to see what rounding does.
const FEW: usize = 8;
/// The number of patterns of signs by which larger states are moved.
const PATTERNS: usize = 8;

/// Room for states and values that live during one call.
pub(crate) struct Work {
    /// A step to a trial place.
    pub(crate) restep: Step,
    /// A state along the dense output or near a switch.
    pub(crate) state: Vec<f64>,
    /// A state that is moved a little away from another one.
    pub(crate) moved: Vec<f64>,
    /// A slope.
    pub(crate) slope: Vec<f64>,
    /// The slope at the end of a trial step, and the change of the slope there.
    pub(crate) end_slope: Vec<f64>,
    pub(crate) bend: Vec<f64>,
    /// The sizes of the components near an event.
    pub(crate) scale: Vec<f64>,
    /// The values of the guards at one place.
    pub(crate) values: Vec<f64>,
}

impl Work {
    pub(crate) fn new(n: usize) -> Self {
        let room = || vec![0.0; n];
        Self {
            restep: Step::new(n),
            state: room(),
            moved: room(),
            slope: room(),
            end_slope: room(),
            bend: room(),
            scale: room(),
            values: Vec::new(),
        }
    }
}

/// Some bits that depend on `i` irregularly (the finaliser of splitmix64).
fn scramble(i: usize) -> u64 {
    let mut z = (i as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The change of a guard at (`s`, `y`) if time and state change by some units in the last place of
/// `s_scale` and of the components' sizes `y_scale`; see
/// [`crate::events::along_step::rounding`]. `moved` and `values` are room. Returns the evaluations
/// of the guards too.
///
/// A large state is not moved component by component. All components move at once, by ± their
/// rounding, with irregular signs that are the same in every run: once all upwards, and then seven
/// times at random. If a_i is the effect of component i, such a change is Σ ±a_i. Its mean square
/// is Σ a_i², which is also the mean square of what independent roundings do. One random change is
/// at least half that root with a probability of at least 3/16 (Paley and Zygmund) whatever the
/// a_i are, and always is if only one component matters. The largest of all is taken four times, as
/// the sum for small states is. What adds up coherently, as in a mean of positive components, is
/// seen by the change with equal signs.
pub(crate) fn rounding<S: DynamicSystem>(
    at: &SignedGuard<'_, S>,
    (s, y): (f64, &[f64]),
    (s_scale, y_scale): (f64, &[f64]),
    moved: &mut [f64],
    values: &mut [f64],
) -> (f64, usize) {
    let here = at.value(s, y, values);
    let by_time = (at.value(s + SLIGHT * s_scale.abs(), y, values) - here).abs();
    moved.copy_from_slice(y);
    let (mut by_state, mut count) = (0.0, 2);
    if y.len() <= FEW {
        for i in 0..y.len() {
            moved[i] += SLIGHT * y_scale[i].abs();
            by_state += (at.value(s, moved, values) - here).abs();
            moved[i] = y[i];
            count += 1;
        }
    } else {
        for pattern in 0..PATTERNS {
            for (i, moved) in moved.iter_mut().enumerate() {
                let change = SLIGHT * y_scale[i].abs();
                let down = pattern > 0 && scramble(i) >> pattern & 1 == 1;
                *moved = y[i] + if down { -change } else { change };
            }
            let change = (at.value(s, moved, values) - here).abs();
            // NaN stays.
            by_state = if change <= by_state { by_state } else { change };
            count += 1;
        }
    }
    let change = by_time + by_state;
    let effect = if change.is_finite() { 4.0 * f64::EPSILON / SLIGHT * change } else { 0.0 };
    (effect, count)
}

/// A guard along a step, for isolation.
pub(crate) struct AlongStep<'a, S: DynamicSystem, M> {
    pub(crate) at: SignedGuard<'a, S>,
    pub(crate) origin: Origin<'a>,
    pub(crate) dense: DynamicDense<'a>,
    pub(crate) work: &'a mut Work,
    pub(crate) statistics: &'a mut Statistics,
    pub(crate) method: PhantomData<M>,
}

impl<S: DynamicSystem, M: Method> AlongStep<'_, S, M> {
    fn place(&self, theta: f64) -> f64 {
        self.origin.s + theta * self.dense.size()
    }
}

impl<S: DynamicSystem, M: Method> Curve for AlongStep<'_, S, M> {
    fn dense(&mut self, theta: f64) -> f64 {
        self.dense.write(theta, &mut self.work.state);
        self.statistics.guards += 1;
        self.at.value(self.place(theta), &self.work.state, &mut self.work.values)
    }

    fn coarse(&mut self, theta: f64) -> f64 {
        self.dense.write_coarse(theta, &mut self.work.state);
        self.statistics.guards += 1;
        self.at.value(self.place(theta), &self.work.state, &mut self.work.values)
    }

    fn rounding(&mut self) -> (f64, f64) {
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|theta| {
            let s = self.place(theta);
            let Work { state, moved, values, .. } = &mut *self.work;
            self.dense.write(theta, state);
            let (effect, count) = rounding(&self.at, (s, state), (s, state), moved, values);
            self.statistics.guards += count;
            effect
        });
        (start, start.max(middle).max(end))
    }

    fn truth(&mut self, theta: f64) -> Result<f64, RunError> {
        let SignedGuard { system, mode, guard, .. } = self.at;
        let field = |s: f64, y: &[f64], slope: &mut [f64]| system.field(mode, s, y, slope);
        let Work { restep, values, .. } = &mut *self.work;
        let (s, h) = (self.origin.s, self.dense.size());
        let mut aside = Aside::new(guard, s, resolution(s, h));
        let mut place = theta;
        loop {
            restep.take_end::<M>(&field, self.origin, place * h);
            self.statistics.resteps += 1;
            self.statistics.field += M::STAGES - 1;
            self.statistics.guards += 1;
            let value = self.at.value(s + place * h, &restep.y1, values);
            if !value.is_nan() {
                return Ok(value);
            }
            place = aside.of(theta)?;
        }
    }
}
