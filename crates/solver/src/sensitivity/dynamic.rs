//! Derivatives of runs whose dimension is known at run time only.

use std::cell::RefCell;

use num_dual::Dual64;

use super::ROUNDING;
use crate::dynamic::{
    DynamicEvent, DynamicObserver, DynamicStart, DynamicSystem, ReadableDynamic, run_dynamic,
};
use crate::error::RunError;
use crate::hybrid::{Guard, Outcome, Schedule, Statistics};
use crate::method::Method;
use crate::options::Options;
use stickslip_number::{Enclosure, InvalidValue, Number};

/// A readable dynamic system whose transitions are generic in their numbers, so that its runs have
/// derivatives ([`sensitivities_dynamic`]). Its parameters are components of the state whose slope
/// is 0.
pub trait ReadableReset: ReadableDynamic {
    /// Changes the state `y` on `guard` to the one that follows when it fires, as
    /// [`ReadableDynamic::transition`], which best calls this. Where the two differ there are no
    /// derivatives, and the run fails with [`RunError::State`].
    fn reset<T: Number>(&self, mode: Self::Mode, guard: usize, s: T, y: &mut [T]);
}

/// A switch, or the end of a run, with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicSwitchSensitivity<Mode> {
    /// The guard that fired, or `None` if the run reached its end.
    pub guard: Option<usize>,
    /// The mode that ends here.
    pub mode: Mode,
    /// The place of the switch or of the end, and its derivatives.
    pub s: Vec<f64>,
    /// The state at the place, before the transition, and its derivatives at the place, which moves
    /// too.
    pub states: Vec<Vec<f64>>,
}

/// A run with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicSensitivities<Mode> {
    /// The switches, in order.
    pub switches: Vec<DynamicSwitchSensitivity<Mode>>,
    /// The end of the run.
    pub end: DynamicSwitchSensitivity<Mode>,
    /// Why the run ended.
    pub outcome: Outcome,
    /// The work done. One evaluation of the right-hand side covers state and derivatives together.
    pub statistics: Statistics,
}

/// As [`sensitivities`](super::sensitivities), for a system whose dimension is known at run time.
///
/// `directions` are derivatives of the state at the start, each of the same dimension. All results
/// have the value first and then its derivative in each direction.
///
/// ```
/// use stickslip_solver::dynamic::{DynamicStart, ReadableDynamic};
/// use stickslip_solver::sensitivity::{ReadableReset, sensitivities_dynamic};
/// use stickslip_solver::{Direction, Dop853, Guard, Number, Options};
///
/// /// Balls that bounce: heights, velocities, and a coefficient of restitution.
/// struct Balls(Vec<Guard>);
///
/// impl ReadableDynamic for Balls {
///     type Mode = ();
///     fn field<T: Number>(&self, (): (), _time: T, y: &[T], slope: &mut [T]) {
///         let n = self.0.len();
///         for ball in 0..n {
///             (slope[ball], slope[n + ball]) = (y[n + ball], T::from(-9.81));
///         }
///         slope[2 * n] = T::from(0.0);
///     }
///     fn guards(&self, (): ()) -> &[Guard] {
///         &self.0
///     }
///     fn guard_values<T: Number>(&self, (): (), _time: T, y: &[T], values: &mut [T]) {
///         values.copy_from_slice(&y[..values.len()]);
///     }
///     fn transition(&self, (): (), guard: usize, time: f64, y: &mut [f64]) {
///         self.reset((), guard, time, y);
///     }
/// }
///
/// impl ReadableReset for Balls {
///     fn reset<T: Number>(&self, (): (), guard: usize, _time: T, y: &mut [T]) {
///         let n = self.0.len();
///         (y[guard], y[n + guard]) = (T::from(0.0), -(y[2 * n] * y[n + guard]));
///     }
/// }
///
/// // Two balls are thrown up. The second has velocity v, and is back after 2v/g.
/// let (v, e) = (4.905, 0.5);
/// let balls = Balls(vec![Guard::new(Direction::Below).from_zero(1); 2]);
/// let start = DynamicStart { mode: (), s: 0.0, state: &[0.0, 0.0, 20.0, v, e] };
/// let by_v_and_e = [vec![0.0, 0.0, 0.0, 1.0, 0.0], vec![0.0, 0.0, 0.0, 0.0, 1.0]];
/// let options = Options::default();
/// let found = sensitivities_dynamic(Dop853, &balls, start, &by_v_and_e, 1.6, &options)?;
/// let [time, by_v, by_e] = found.switches[1].s[..] else { panic!("three numbers") };
/// assert!((time - 2.0 * (1.0 + e) * v / 9.81).abs() < 1e-14);
/// assert!((by_v - 2.0 * (1.0 + e) / 9.81).abs() < 1e-14);
/// assert!((by_e - 2.0 * v / 9.81).abs() < 1e-14);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
///
/// # Errors
/// Those of [`sensitivities`](super::sensitivities), and [`RunError::Option`] for a direction of
/// another dimension than the state.
pub fn sensitivities_dynamic<M: Method, S: ReadableReset>(
    method: M,
    system: &S,
    start: DynamicStart<'_, S::Mode>,
    directions: &[Vec<f64>],
    end: f64,
    options: &Options,
) -> Result<DynamicSensitivities<S::Mode>, RunError> {
    let n = start.state.len();
    if let Some(index) = directions.iter().position(|direction| direction.len() != n) {
        let (name, found) = (format!("components of direction {index}"), directions[index].len());
        return Err(InvalidValue::new(name, found, format!("{n}, as of the state")).into());
    }
    let all: Vec<_> = (0..n).collect();
    let (along, slopes) = (RefCell::new(vec![Dual64::from(0.0); n]), RefCell::default());
    let varied = Varied { system, n, all, along, slopes };
    let state = [start.state, &directions.concat()].concat();
    let from = DynamicStart { state: &state, ..start };
    let mut recorded = Recorded { varied: &varied, switches: Vec::new() };
    let run = run_dynamic(method, &varied, from, end, options, &mut recorded)?;
    let Recorded { mut switches, .. } = recorded;
    let ended = match run.outcome {
        Outcome::EndedByGuard { .. } => switches.pop(),
        _ => None,
    };
    let end = ended.unwrap_or_else(|| {
        let mut s = vec![0.0; 1 + directions.len()];
        s[0] = run.s;
        DynamicSwitchSensitivity {
            guard: None,
            mode: run.mode,
            s,
            states: varied.parted(&run.state),
        }
    });
    Ok(DynamicSensitivities { switches, end, outcome: run.outcome, statistics: run.statistics })
}

/// A system together with derivatives of its state, one behind the other.
struct Varied<'a, S> {
    system: &'a S,
    n: usize,
    /// The components of the state.
    all: Vec<usize>,
    /// Room for a state and for its slope along a direction.
    along: RefCell<Vec<Dual64>>,
    slopes: RefCell<Vec<Dual64>>,
}

impl<S: ReadableReset> Varied<'_, S> {
    fn parted(&self, y: &[f64]) -> Vec<Vec<f64>> {
        y.chunks_exact(self.n.max(1)).map(<[f64]>::to_vec).collect()
    }

    /// Writes the derivative of a function of the state to `change`. The function writes its values
    /// behind the state `y`, which moves by `by`.
    fn change(
        &self,
        (y, by): (&[f64], &[f64]),
        change: &mut [f64],
        of: impl FnOnce(&mut [Dual64], &mut [Dual64]),
    ) {
        let (along, slopes) = (&mut *self.along.borrow_mut(), &mut *self.slopes.borrow_mut());
        for ((along, &y), &by) in along.iter_mut().zip(y).zip(by) {
            *along = Dual64::new(y, by);
        }
        slopes.resize(change.len(), Dual64::from(f64::NAN));
        of(along, slopes);
        for (change, slope) in change.iter_mut().zip(slopes) {
            *change = slope.eps;
        }
    }

    /// The place where `guard` fires at the state `y`, with its derivatives, and those of the state
    /// there.
    fn moved(&self, mode: S::Mode, guard: usize, s: f64, y: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut states = self.parted(y);
        let Some((state, directions)) = states.split_first_mut() else {
            return (vec![s], states);
        };
        let (mut slope, mut changes) = (vec![0.0; self.n], vec![0.0; self.guards(mode).len()]);
        self.system.field(mode, s, state, &mut slope);
        let mut rate = |s: Dual64, by: &[f64]| {
            self.change((state, by), &mut changes, |y, values| {
                self.system.guard_values(mode, s, y, values);
            });
            changes[guard]
        };
        let along = rate(Dual64::new(s, 1.0), &slope);
        let mut place = vec![s];
        for by in directions {
            let earlier = -rate(Dual64::from(s), by) / along;
            by.iter_mut().zip(&slope).for_each(|(by, slope)| *by += slope * earlier);
            place.push(earlier);
        }
        (place, states)
    }
}

impl<S: ReadableReset> DynamicSystem for Varied<'_, S> {
    type Mode = S::Mode;
    const READABLE: bool = true;

    fn field(&self, mode: S::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        let ((y, directions), (slope, changes)) = (y.split_at(self.n), slope.split_at_mut(self.n));
        self.system.field(mode, s, y, slope);
        if self.n == 0 {
            return;
        }
        let each = directions.chunks_exact(self.n).zip(changes.chunks_exact_mut(self.n));
        for (by, change) in each {
            self.change((y, by), change, |y, slope| {
                self.system.field(mode, Dual64::from(s), y, slope);
            });
        }
    }
    fn guards(&self, mode: S::Mode) -> &[Guard] {
        ReadableDynamic::guards(self.system, mode)
    }
    fn guard_values(&self, mode: S::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        ReadableDynamic::guard_values(self.system, mode, s, &y[..self.n], values);
    }
    fn reads(&self, mode: S::Mode) -> &[usize] {
        match ReadableDynamic::reads(self.system, mode) {
            [] => &self.all,
            some => some,
        }
    }
    fn enclose_guards(
        &self,
        mode: S::Mode,
        s: Enclosure,
        y: &[Enclosure],
        values: &mut [Enclosure],
    ) {
        ReadableDynamic::guard_values(self.system, mode, s, &y[..self.n], values);
    }
    fn counter(&self, mode: S::Mode, guard: usize) -> usize {
        ReadableDynamic::counter(self.system, mode, guard)
    }
    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        ReadableDynamic::schedule(self.system, mode, guard)
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &mut [f64]) -> S::Mode {
        let (place, states) = self.moved(mode, guard, s, y);
        let (after, directions) = y.split_at_mut(self.n);
        let next = ReadableDynamic::transition(self.system, mode, guard, s, after);
        let Some((before, moved)) = states.split_first() else { return next };
        let mut slope = vec![0.0; self.n];
        self.system.field(next, s, after, &mut slope);
        let size = after.iter().chain(before).fold(0.0_f64, |size, y| size.max(y.abs()));
        let each = directions.chunks_exact_mut(self.n).zip(moved).zip(&place[1..]);
        for ((change, by), &later) in each {
            let mut same = true;
            self.change((before, by), change, |y, reset| {
                self.system.reset(mode, guard, Dual64::new(s, later), y);
                let close = |(y, after): (&Dual64, &f64)| (y.re - after).abs() <= ROUNDING * size;
                same = y.iter().zip(&*after).all(close);
                reset.copy_from_slice(y);
            });
            for (change, slope) in change.iter_mut().zip(&slope) {
                *change = if same { *change - slope * later } else { f64::NAN };
            }
        }
        next
    }
}

/// Records the switches with their derivatives.
struct Recorded<'a, S: ReadableReset> {
    varied: &'a Varied<'a, S>,
    switches: Vec<DynamicSwitchSensitivity<S::Mode>>,
}

impl<S: ReadableReset> DynamicObserver<S::Mode> for Recorded<'_, S> {
    fn on_switch(&mut self, event: &DynamicEvent<'_, S::Mode>) {
        let (s, states) = self.varied.moved(event.from, event.guard, event.s, event.before);
        let (guard, mode) = (Some(event.guard), event.from);
        self.switches.push(DynamicSwitchSensitivity { guard, mode, s, states });
    }
    fn forget(&mut self, switches: usize) {
        self.switches.truncate(self.switches.len().saturating_sub(switches));
    }
}
