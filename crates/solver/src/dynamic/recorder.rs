//! Observers that record a run of a dynamic system.

use crate::dynamic::dense::DynamicDense;
use crate::dynamic::results::{DynamicEvent, DynamicObserver, DynamicSwitch};
use crate::hybrid::{Grazing, Pole, Preempted, Rest};
use crate::runs::both::tell_both;

/// An accepted step that is kept, with its dense output.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicSegment<Mode> {
    /// The mode in which the step was taken.
    pub mode: Mode,
    /// The place where the step starts.
    pub s: f64,
    /// The size of the step. It is negative if the run goes backwards.
    pub h: f64,
    /// [`DynamicDense::coefficients`].
    pub coefficients: Vec<f64>,
}

impl<Mode> DynamicSegment<Mode> {
    /// The state at `s`, of `n` components: NaN if the coefficients are not those of a step of so
    /// many.
    #[must_use]
    pub fn at(&self, s: f64, n: usize) -> Vec<f64> {
        let dense = DynamicDense::from_coefficients(self.s, self.h, n, &self.coefficients);
        dense.map_or_else(|| vec![f64::NAN; n], |dense| dense.at((s - self.s) / self.h))
    }
}

/// Records all that a run of a [`DynamicSystem`](crate::dynamic::DynamicSystem) reports, and the
/// state at any time, as [`Recorder`](crate::Recorder) does of other runs.
///
/// ```
/// use stickslip_solver::dynamic::{DynamicRecorder, DynamicStart, DynamicSystem, run_dynamic};
/// use stickslip_solver::{Dop853, Guard, Options};
///
/// struct Circle;
///
/// impl DynamicSystem for Circle {
///     type Mode = ();
///
///     fn field(&self, (): (), _s: f64, y: &[f64], slope: &mut [f64]) {
///         slope.copy_from_slice(&[y[1], -y[0]]);
///     }
///     fn guards(&self, (): ()) -> &[Guard] {
///         &[]
///     }
///     fn guard_values(&self, (): (), _s: f64, _y: &[f64], _values: &mut [f64]) {}
/// }
///
/// let start = DynamicStart { mode: (), s: 0.0, state: &[0.0, 1.0] };
/// let mut recorder = DynamicRecorder::default();
/// run_dynamic(Dop853, &Circle, start, 3.0, &Options::default(), &mut recorder)?.finished()?;
/// let ((), y) = recorder.at(1.5).expect("within the run");
/// assert!((y[0] - 1.5_f64.sin()).abs() < 1e-9);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DynamicRecorder<Mode> {
    /// All switches, including the one that ended the run.
    pub switches: Vec<DynamicSwitch<Mode>>,
    /// All touches.
    pub grazings: Vec<Grazing<Mode>>,
    /// All poles.
    pub poles: Vec<Pole<Mode>>,
    /// All guards that crossed zero and did not act.
    pub preempted: Vec<Preempted<Mode>>,
    /// Where switches accumulated and the run went on behind them.
    pub rests: Vec<Rest<Mode>>,
    /// The steps, in order.
    pub segments: Vec<DynamicSegment<Mode>>,
    /// The number of components.
    dimension: usize,
    /// The end of the run, which may be behind a switch.
    end: Option<(f64, Mode, Vec<f64>)>,
}

impl<Mode> Default for DynamicRecorder<Mode> {
    fn default() -> Self {
        Self {
            switches: Vec::new(),
            grazings: Vec::new(),
            poles: Vec::new(),
            preempted: Vec::new(),
            rests: Vec::new(),
            segments: Vec::new(),
            dimension: 0,
            end: None,
        }
    }
}

impl<Mode: Copy> DynamicRecorder<Mode> {
    /// The mode and the state at `s`, or `None` if `s` is outside the run. At a switch these are
    /// the mode and the state after it, in the direction of the run, also at the end.
    #[must_use]
    pub fn at(&self, s: f64) -> Option<(Mode, Vec<f64>)> {
        if let Some((end, mode, state)) = &self.end
            && s == *end
        {
            return Some((*mode, state.clone()));
        }
        let begun = |it: &DynamicSegment<Mode>| if it.h < 0.0 { it.s >= s } else { it.s <= s };
        let segment = self.segments.get(self.segments.partition_point(begun).checked_sub(1)?)?;
        let theta = (s - segment.s) / segment.h;
        // The place of the end of the last step may be rounded.
        let within = theta <= 1.0 + 1e-9;
        within.then(|| (segment.mode, segment.at(segment.s + segment.h * theta, self.dimension)))
    }
}

impl<Mode: Copy> DynamicObserver<Mode> for DynamicRecorder<Mode> {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>) {
        self.switches.push(event.to_switch());
    }
    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.grazings.push(*grazing);
    }
    fn on_pole(&mut self, pole: &Pole<Mode>) {
        self.poles.push(*pole);
    }
    fn on_preempted(&mut self, preempted: &Preempted<Mode>) {
        self.preempted.push(*preempted);
    }
    fn on_rest(&mut self, rest: &Rest<Mode>) {
        self.rests.push(*rest);
    }
    fn forget(&mut self, switches: usize) {
        self.switches.truncate(self.switches.len().saturating_sub(switches));
    }
    fn on_segment(&mut self, mode: Mode, dense: &DynamicDense<'_>) {
        self.dimension = dense.dimension();
        let (s, h, coefficients) = (dense.start(), dense.size(), dense.coefficients().to_vec());
        self.segments.push(DynamicSegment { mode, s, h, coefficients });
    }
    fn on_end(&mut self, mode: Mode, s: f64, state: &[f64]) {
        self.end = Some((s, mode, state.to_vec()));
    }
}

/// Two observers of one run. The first one is called first, and the run stops if either of them
/// stops it. Segments go only to observers that want them.
impl<A, B, Mode: Copy> DynamicObserver<Mode> for (A, B)
where
    A: DynamicObserver<Mode>,
    B: DynamicObserver<Mode>,
{
    const WANTS_SEGMENTS: bool = A::WANTS_SEGMENTS || B::WANTS_SEGMENTS;

    fn on_switch(&mut self, event: &DynamicEvent<'_, Mode>) {
        self.0.on_switch(event);
        self.1.on_switch(event);
    }
    tell_both!();

    fn on_segment(&mut self, mode: Mode, dense: &DynamicDense<'_>) {
        if A::WANTS_SEGMENTS {
            self.0.on_segment(mode, dense);
        }
        if B::WANTS_SEGMENTS {
            self.1.on_segment(mode, dense);
        }
    }
    fn on_end(&mut self, mode: Mode, s: f64, state: &[f64]) {
        self.0.on_end(mode, s, state);
        self.1.on_end(mode, s, state);
    }
}
