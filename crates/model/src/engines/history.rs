//! The course of a collision in time, at every moment and not at its switches alone.

mod followed;
mod record;

use crate::laws::general::{self, GeneralContact};
use crate::laws::phase::{Regime, Side};
use crate::laws::regularized::{Regularized, components};

pub(crate) use followed::Followed;
pub(crate) use record::{Course, Record};

/// A collision at one moment, in scaled and reduced variables.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Snapshot {
    /// Scaled time t since the start of contact.
    pub time: f64,
    /// Scaled compression x.
    pub compression: f64,
    /// Rate v = dx/dt of the compression.
    pub normal_velocity: f64,
    /// Scaled normal force F, in the paper's law x^{3/2} + a √x v, in units of m β^{2/5} g_n^{6/5}.
    pub normal_force: f64,
    /// Reduced elongation y of the spring, s F/κ while sliding; in other laws −F_t/(μκ).
    pub spring: f64,
    /// Reduced tangential force F_t/μ, in the paper's law −κ y, in the units of the normal force;
    /// |F_t|/μ ≤ |F|.
    pub tangential_force: f64,
    /// Reduced tangential velocity w.
    pub velocity: f64,
}

/// The course of one collision, from [`Collider::history`](crate::Collider::history).
///
/// States are those of the integrator's dense output. At the default tolerances of Dormand–Prince
/// 8(5,3) they differ from the closed form by at most 1e-11 in x, 4e-12 in v and w, and
/// 4e-12/min(κ, √κ) in y. This was measured at 1500 times of each of 20 undamped collisions with κ
/// from 0.02 to 1e4 and ψ from 0.01 to 3. Switches are where the integrator finds them: unlike
/// [`Collider::collide`](crate::Collider::collide), nothing is computed once more near a graze.
///
/// ```
/// use stickslip_model::{Collider, Contact, Regime};
///
/// let history = Collider::default().history(Contact::new(63.0, 0.5, 0.0)?)?;
/// let middle = history.at(0.5 * history.duration()).ok_or("outside the contact")?;
/// // The largest compression is (5/4)^{2/5}.
/// assert!((middle.compression - 1.25_f64.powf(0.4)).abs() < 1e-11);
///
/// // +o-o+o-: seven phases, each at any number of moments.
/// assert_eq!(history.phases().len(), 7);
/// for phase in history.phases().filter(|phase| phase.regime() == Regime::Slip) {
///     for moment in phase.samples(10) {
///         let limit = -phase.side().sign() * moment.normal_force;
///         assert!((moment.tangential_force - limit).abs() < 1e-14);
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct History(Run);

/// The run of a contact that obeys the paper's law, or another one.
#[derive(Clone, Debug)]
enum Run {
    Paper(Record<Regularized, { components::STATE }>),
    Other(Record<GeneralContact, { general::STATE }>),
}

/// One phase of a [`History`].
#[derive(Clone, Copy)]
pub struct PhaseHistory<'a> {
    course: &'a dyn Course,
    index: usize,
}

/// One moment of a [`History`], with what holds there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The state.
    pub snapshot: Snapshot,
    /// The law that holds; at a switch, that of the phase that begins.
    pub regime: Regime,
    /// The side of sliding, as [`PhaseHistory::side`].
    pub side: Side,
    /// The number of the switch that happens at this moment, from 0.
    pub switch: Option<usize>,
}

impl History {
    /// Most steps of the integrator that are kept; they take about 160 MB.
    ///
    /// Without damping, κ = 1e9 takes 200 000 steps at the default tolerances.
    pub const MOST_STEPS: usize = 300_000;

    /// The course of a contact that obeys the paper's law.
    pub(crate) fn of_paper(record: Record<Regularized, { components::STATE }>) -> Self {
        Self(Run::Paper(record))
    }

    /// The course of a contact with another law.
    pub(crate) fn of_other(record: Record<GeneralContact, { general::STATE }>) -> Self {
        Self(Run::Other(record))
    }

    fn course(&self) -> &dyn Course {
        match &self.0 {
            Run::Paper(record) => record,
            Run::Other(record) => record,
        }
    }

    /// Scaled duration t_c of the contact.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.course().duration()
    }

    /// The phases in order; there is one more than there are switches.
    #[must_use]
    pub fn phases(&self) -> impl ExactSizeIterator<Item = PhaseHistory<'_>> {
        let course = self.course();
        (0..course.phases()).map(move |index| PhaseHistory { course, index })
    }

    /// The collision at a scaled time, at a switch in the phase that begins; `None` outside the
    /// contact.
    #[must_use]
    pub fn at(&self, time: f64) -> Option<Snapshot> {
        (0.0..=self.duration()).contains(&time).then(|| self.course().at(time))
    }

    /// `intervals` + 1 moments evenly spaced in time from the first to the last, at least these
    /// two, and between them every switch. A moment of the time of a switch is the switch.
    ///
    /// ```
    /// use stickslip_model::{Collider, Contact};
    ///
    /// let history = Collider::default().history(Contact::new(63.0, 0.5, 0.0)?)?;
    /// let moments: Vec<_> = history.moments(100).collect();
    /// // +o-o+o- has six switches.
    /// assert_eq!(moments.len(), 101 + 6);
    /// assert!(moments.is_sorted_by(|one, next| one.snapshot.time < next.snapshot.time));
    /// assert_eq!(moments.iter().filter_map(|it| it.switch).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moments(&self, intervals: usize) -> impl Iterator<Item = Moment> {
        let (duration, intervals) = (self.duration(), intervals.max(1));
        let time = move |index: usize| duration * (index as f64 / intervals as f64);
        let mut next = 1;
        let last = self.phases().len() - 1;
        self.phases().enumerate().flat_map(move |(index, phase)| {
            let in_phase = move |snapshot| {
                let (regime, side) = (phase.regime(), phase.side());
                Moment { snapshot, regime, side, switch: None }
            };
            let begin = Moment { switch: index.checked_sub(1), ..in_phase(phase.begin()) };
            let end = in_phase(phase.end());
            while next < intervals && time(next) <= begin.snapshot.time {
                next += 1;
            }
            let from = next;
            while next < intervals && time(next) < end.snapshot.time {
                next += 1;
            }
            let between = (from..next).map(move |index| in_phase(self.course().at(time(index))));
            let end = (index == last).then_some(end);
            std::iter::once(begin).chain(between).chain(end)
        })
    }
}

impl PhaseHistory<'_> {
    /// The law that holds.
    #[must_use]
    pub fn regime(&self) -> Regime {
        self.course.phase(self.index).0
    }

    /// The side of sliding or, in stick, the side from which the spring comes.
    #[must_use]
    pub fn side(&self) -> Side {
        self.course.phase(self.index).1
    }

    /// The first moment of the phase.
    #[must_use]
    pub fn begin(&self) -> Snapshot {
        self.course.begin(self.index)
    }

    /// The last moment of the phase; of the last phase, that at which the overlap vanishes or the
    /// law ends the contact.
    #[must_use]
    pub fn end(&self) -> Snapshot {
        self.course.end(self.index)
    }

    /// `intervals` + 1 moments from the first to the last. There are only these two if `intervals`
    /// is 0, or if the phase is too short for a step. Where the force ends before the overlap,
    /// there is one more at the end of the force.
    ///
    /// They are evenly spaced in s, with dt = 2√x ds or that of the law's own smooth coordinates.
    /// In time they are closer to each other near the ends of contact.
    pub fn samples(&self, intervals: usize) -> impl Iterator<Item = Snapshot> + use<> {
        self.course.samples(self.index, intervals).into_iter()
    }
}

#[cfg(test)]
mod tests {
    use stickslip_solver::{Dop853, Options, Outcome, Statistics};

    use super::*;
    use crate::{Collider, CollisionError, Contact, Engine, Tolerances};

    fn history(kappa: f64, psi: f64, damping: f64) -> History {
        Collider::default().history(Contact::new(kappa, psi, damping).unwrap()).unwrap()
    }

    /// At this distance from the switches, a difference quotient sees one law only.
    const REACH: f64 = 1e-4;

    #[test]
    fn obeys_the_law_in_plain_time() {
        let mut quotients = 0;
        for (kappa, psi, damping) in [(63.0, 0.5, 0.0), (18.0, 1.0, 0.2), (0.3, 0.7, 1.0)] {
            let history = history(kappa, psi, damping);
            for phase in history.phases() {
                let (begin, end) = (phase.begin().time + REACH, phase.end().time - REACH);
                for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
                    let time = begin + part * (end - begin);
                    if end <= begin || time < 0.02 || time > history.duration() - 0.02 {
                        continue;
                    }
                    let at = |time| history.at(time).unwrap();
                    let (before, now, after) = (at(time - REACH), at(time), at(time + REACH));
                    assert!((now.time - time).abs() < 1e-14);
                    let rate =
                        |of: fn(&Snapshot) -> f64| (of(&after) - of(&before)) / (2.0 * REACH);
                    let root = now.compression.sqrt();
                    let force = root * (now.compression + damping * now.normal_velocity);
                    assert!((now.normal_force - force).abs() < 1e-14);
                    // The error of the quotient is REACH²/6 times the third derivative.
                    assert!((rate(|s| s.compression) - now.normal_velocity).abs() < 1e-7);
                    assert!((rate(|s| s.normal_velocity) + force).abs() < 1e-6);
                    assert!((rate(|s| s.velocity) + kappa * now.spring).abs() < 1e-6);
                    match phase.regime() {
                        Regime::Slip => {
                            let limit = phase.side().sign() * force / kappa;
                            assert!((now.spring - limit).abs() < 1e-14);
                        }
                        Regime::Stick => {
                            assert!((rate(|s| s.spring) - now.velocity).abs() < 1e-6);
                            assert!(kappa * now.spring.abs() < force);
                        }
                    }
                    quotients += 1;
                }
            }
        }
        assert!(quotients >= 60, "{quotients}");
    }

    #[test]
    fn phases_meet_at_the_switches_of_the_collision() {
        for (kappa, psi, damping) in [(63.0, 0.5, 0.0), (18.0, 1.0, 0.2), (1e4, 0.4, 0.0)] {
            let history = history(kappa, psi, damping);
            let contact = Contact::new(kappa, psi, damping).unwrap();
            let collision = Collider::default().collide(contact).unwrap();
            let phases: Vec<_> = history.phases().collect();
            assert_eq!(phases.len(), collision.switches.len() + 1);
            for (pair, switch) in phases.windows(2).zip(&collision.switches) {
                let (end, begin) = (pair[0].end(), pair[1].begin());
                assert_eq!((pair[1].regime(), pair[1].side()), (switch.to, switch.side));
                for moment in [end, begin, history.at(switch.time).unwrap()] {
                    assert!((moment.time - switch.time).abs() < 1e-12);
                    assert!((moment.spring - switch.spring).abs() < 1e-12);
                    assert!((moment.velocity - switch.velocity).abs() < 1e-11);
                }
            }
            assert!((history.duration() - collision.contact_time).abs() < 1e-13);
            assert_eq!(history.at(0.0).unwrap().velocity, psi);
            let last = history.at(history.duration()).unwrap();
            assert!((last.velocity - collision.final_velocity).abs() < 1e-11);
        }
    }

    #[test]
    fn a_collision_with_its_course_is_the_same_collision() {
        let mut random = fastrand::Rng::with_seed(17);
        let mut refined = 0;
        for case in 0..1500 {
            let mut uniform = |low: f64, high: f64| low + (high - low) * random.f64();
            let kappa = 10.0_f64.powf(uniform(-2.0, if case % 50 == 0 { 5.0 } else { 3.0 }));
            let psi = [uniform(0.0, 3.0), 10.0_f64.powf(uniform(-6.0, 2.0))][case % 2];
            let damping = [0.0, 0.0, 10.0_f64.powf(uniform(-6.0, 1.0))][case % 3];
            let contact = Contact::new(kappa, psi, damping).unwrap();
            let integrator = Engine::Dop853(Tolerances::DOP853);
            for engine in [integrator, Engine::Dopri5(Tolerances::DOPRI5)] {
                let (alone, work) = engine.collide(contact).unwrap();
                let (collision, work_with_course, history) = engine.followed(contact).unwrap();
                // All digits, and the signs of zeros.
                assert_eq!(format!("{collision:?}"), format!("{alone:?}"));
                let (work, more) = (work.unwrap(), work_with_course.unwrap());
                // The course ends at every switch, to which the step is repeated.
                assert!(more.resteps >= work.resteps && more.field >= work.field);
                let Statistics { resteps, field, .. } = work;
                assert_eq!(Statistics { resteps, field, ..more }, work);
                if case % 100 == 0 {
                    let course = engine.history(contact).unwrap();
                    assert_eq!(format!("{history:?}"), format!("{course:?}"));
                }
            }
            let options = Collider::default().options_for(&contact).unwrap();
            let plain = Collider::unrefined(Dop853, options).collide(contact).ok();
            let collision = Collider::default().collide(contact).ok();
            refined += usize::from(format!("{plain:?}") != format!("{collision:?}"));
        }
        // Near grazes the same switches are computed once more.
        assert!(refined > 15, "{refined}");
    }

    #[test]
    fn samples_are_in_order_and_of_the_requested_number() {
        let history = history(63.0, 0.5, 0.0);
        for phase in history.phases() {
            let samples: Vec<_> = phase.samples(12).collect();
            assert_eq!(samples.len(), 13);
            assert_eq!((samples[0], samples[12]), (phase.begin(), phase.end()));
            assert!(samples.windows(2).all(|pair| pair[0].time < pair[1].time));
            for sample in &samples[1..12] {
                let at = history.at(sample.time).unwrap();
                assert!((at.velocity - sample.velocity).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn says_when_it_has_too_many_steps() {
        let contact = Contact::new(63.0, 0.5, 0.0).unwrap();
        for max_steps in 0..60 {
            let options = Options { max_steps, ..Options::default() };
            let error = Collider::unrefined(Dop853, options).history(contact).unwrap_err();
            let CollisionError::Unfinished { outcome, time } = error else { panic!("{error}") };
            assert_eq!(outcome, Outcome::StepLimit, "{max_steps}");
            assert!((0.0..3.3).contains(&time), "{max_steps}: {time}");
        }
    }

    #[test]
    fn nothing_is_outside_the_contact() {
        let history = history(18.0, 0.4, 0.0);
        for time in [-1e-300, history.duration() + 1e-12, f64::NAN, f64::INFINITY] {
            assert_eq!(history.at(time), None);
        }
    }
}
