//! Observers that record a run, and its trajectory as dense output.

use crate::hybrid::{Grazing, Observer, SwitchEvent};
use crate::method::{Dense, State};

/// An accepted step with its dense output.
#[derive(Clone, Copy, Debug)]
pub struct TrajectorySegment<Mode, const N: usize> {
    /// The mode in which the step was taken.
    pub mode: Mode,
    /// The state along the step.
    pub dense: Dense<N>,
}

/// The dense output of a whole run.
#[derive(Clone, Debug)]
pub struct Trajectory<Mode, const N: usize> {
    segments: Vec<TrajectorySegment<Mode, N>>,
    /// The end of the run, which may be behind a switch.
    end: Option<(f64, Mode, State<N>)>,
}

impl<Mode, const N: usize> Default for Trajectory<Mode, N> {
    fn default() -> Self {
        Self { segments: Vec::new(), end: None }
    }
}

impl<Mode: Copy, const N: usize> Trajectory<Mode, N> {
    /// The steps, in order.
    #[must_use]
    pub fn segments(&self) -> &[TrajectorySegment<Mode, N>] {
        &self.segments
    }

    /// The mode and the state at `s`, or `None` if `s` is outside the run. At a switch these are
    /// the mode and the state after it, in the direction of the run, also at the end.
    #[must_use]
    pub fn at(&self, s: f64) -> Option<(Mode, State<N>)> {
        if let Some((end, mode, state)) = self.end
            && s == end
        {
            return Some((mode, state));
        }
        let after = self.segments.partition_point(|TrajectorySegment { dense, .. }| {
            if dense.size() < 0.0 { dense.start() >= s } else { dense.start() <= s }
        });
        let segment = self.segments.get(after.checked_sub(1)?)?;
        let theta = (s - segment.dense.start()) / segment.dense.size();
        // The place of the end of the last step may be rounded.
        (theta <= 1.0 + 1e-9).then(|| (segment.mode, segment.dense.at(theta.min(1.0))))
    }
}

/// Collects every switch, including the one that ends the run, at the cost of one copy each.
impl<Mode: Copy, const N: usize> Observer<Mode, N> for Vec<SwitchEvent<Mode, N>> {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.push(*event);
    }

    fn forget(&mut self, switches: usize) {
        self.truncate(self.len().saturating_sub(switches));
    }
}

/// Records switches, touches and the trajectory.
///
/// The trajectory costs twice the stages. A `Vec` as the observer records only the switches.
///
/// ```
/// use stickslip_solver::{Dopri5, Options, Recorder, State, integrate};
///
/// let circle = |_s: f64, y: &State<2>| State::from([y[1], -y[0]]);
/// let mut recorder = Recorder::default();
/// let options = Options::default();
/// integrate(Dopri5, circle, 0.0, State::from([0.0, 1.0]), 3.0, &options, &mut recorder)?;
/// let (_, y) = recorder.trajectory.at(1.5).ok_or("outside the run")?;
/// assert!((y[0] - 1.5_f64.sin()).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Recorder<Mode, const N: usize> {
    /// All switches, including the one that ended the run.
    pub switches: Vec<SwitchEvent<Mode, N>>,
    /// All touches.
    pub grazings: Vec<Grazing<Mode>>,
    /// The state at any time of the run.
    pub trajectory: Trajectory<Mode, N>,
}

impl<Mode, const N: usize> Default for Recorder<Mode, N> {
    fn default() -> Self {
        Self { switches: Vec::new(), grazings: Vec::new(), trajectory: Trajectory::default() }
    }
}

impl<Mode: Copy, const N: usize> Observer<Mode, N> for Recorder<Mode, N> {
    const WANTS_SEGMENTS: bool = true;

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.switches.push(*event);
    }

    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.grazings.push(*grazing);
    }

    fn forget(&mut self, switches: usize) {
        Observer::forget(&mut self.switches, switches);
    }

    fn on_segment(&mut self, mode: Mode, dense: &Dense<N>) {
        self.trajectory.segments.push(TrajectorySegment { mode, dense: *dense });
    }

    fn on_end(&mut self, mode: Mode, s: f64, state: &State<N>) {
        self.trajectory.end = Some((s, mode, *state));
    }
}
