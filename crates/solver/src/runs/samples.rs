//! Output at given times.

use stickslip_number::InvalidValue;

use crate::hybrid::schedule::check_order;
use crate::hybrid::{Observer, SwitchEvent};
use crate::method::{Dense, State};
use crate::runs::trajectory::TrajectorySegment;

/// The part of a step by which its end may be rounded.
const ROUNDING: f64 = 1e-9;

/// The state at a given time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<Mode, const N: usize> {
    /// The time.
    pub s: f64,
    /// The mode at that time.
    pub mode: Mode,
    /// The state at that time.
    pub state: State<N>,
}

/// An observer that records the state at given times, and the switches.
///
/// The times have no influence on the steps: the states come from the dense output. At a switch a
/// sample has the mode and the state after it, or after the last switch if several come at once. A
/// time that is equal to the end of the run has the final state, wherever and why ever the run
/// ends. Times are ascending or descending, and samples are in the order of the run, be it forwards
/// or [backwards](crate::run_backwards).
///
/// ```
/// use stickslip_solver::{Dop853, Options, Samples, State, integrate};
///
/// let circle = |_s: f64, y: &State<2>| State::from([y[1], -y[0]]);
/// let mut samples = Samples::at(&[0.0, 0.5, 1.0, 1.5])?;
/// let start = State::from([0.0, 1.0]);
/// let end = integrate(Dop853, circle, 0.0, start, 1.0, &Options::default(), &mut samples)?;
/// let [first, middle, last] = samples.samples[..] else { return Err("three samples".into()) };
/// assert_eq!((first.state, last.state), (start, end.state));
/// assert!((middle.state[0] - 0.5_f64.sin()).abs() < 1e-9);
/// assert_eq!(samples.missing(), [1.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Samples<Mode, const N: usize> {
    /// The states at the times that lie in the run.
    pub samples: Vec<Sample<Mode, N>>,
    /// All switches, including the one that ended the run.
    pub switches: Vec<SwitchEvent<Mode, N>>,
    times: Vec<f64>,
    /// How many of the times are done.
    done: usize,
    missing: Vec<f64>,
    /// The last segment, until it is known where the next one starts.
    last: Option<TrajectorySegment<Mode, N>>,
}

impl<Mode: Copy, const N: usize> Samples<Mode, N> {
    /// Samples at `times`.
    ///
    /// # Errors
    /// [`InvalidValue`] unless the times are numbers in ascending or in descending order. Equal
    /// times may follow each other.
    pub fn new(times: Vec<f64>) -> Result<Self, InvalidValue> {
        check_order(&times)?;
        Ok(Self {
            samples: Vec::with_capacity(times.len()),
            switches: Vec::new(),
            times,
            done: 0,
            missing: Vec::new(),
            last: None,
        })
    }

    /// Samples at `times`.
    ///
    /// # Errors
    /// Those of [`Samples::new`].
    pub fn at(times: &[f64]) -> Result<Self, InvalidValue> {
        Self::new(times.to_vec())
    }

    /// The times outside the run, once it has ended. A run that fails has no end; its times after
    /// the last step are not among them.
    #[must_use]
    pub fn missing(&self) -> &[f64] {
        &self.missing
    }

    /// Takes the times before `s` from the last segment.
    fn until(&mut self, s: f64, forwards: bool) {
        while let Some(&next) = self.times.get(self.done) {
            if if forwards { next >= s } else { next <= s } {
                return;
            }
            self.done += 1;
            let found = self.last.as_ref().and_then(|segment| {
                let theta = (next - segment.dense.start()) / segment.dense.size();
                (-ROUNDING..=1.0 + ROUNDING)
                    .contains(&theta)
                    .then(|| (segment.mode, segment.dense.at(theta.clamp(0.0, 1.0))))
            });
            match found {
                Some((mode, state)) => self.samples.push(Sample { s: next, mode, state }),
                None => self.missing.push(next),
            }
        }
    }

    /// Puts the times that are left into the order of the run.
    fn turn(&mut self, forwards: bool) {
        let left = &mut self.times[self.done..];
        if let [first, .., last] = *left
            && if forwards { first > last } else { first < last }
        {
            left.reverse();
        }
    }
}

impl<Mode: Copy, const N: usize> Observer<Mode, N> for Samples<Mode, N> {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.switches.push(*event);
    }

    fn forget(&mut self, switches: usize) {
        Observer::forget(&mut self.switches, switches);
    }

    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>) {
        let forwards = dense.size() > 0.0;
        if self.last.is_none() {
            self.turn(forwards);
        }
        self.until(dense.start(), forwards);
        self.last = Some(TrajectorySegment { mode, dense: *dense });
    }

    fn on_end(&mut self, mode: Mode, s: f64, state: &State<N>) {
        let forwards = self.last.as_ref().is_none_or(|segment| segment.dense.size() > 0.0);
        self.turn(forwards);
        self.until(s, forwards);
        while let Some(&next) = self.times.get(self.done)
            && next == s
        {
            self.samples.push(Sample { s, mode, state: *state });
            self.done += 1;
        }
        self.missing.extend_from_slice(&self.times[self.done..]);
        self.done = self.times.len();
    }
}
