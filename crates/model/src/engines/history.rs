//! The course of a collision in time, at every moment and not at its switches alone.
//!
//! A collision has no list of samples. The integrator's dense output is kept instead, or the
//! switches between which the exact solution is known, so that a picture can ask for as many
//! moments of a phase as it needs.

mod closed;
mod followed;
mod record;

use stickslip_contact::adhesive::AdhesiveContact;
use stickslip_contact::general::{self, GeneralContact};
use stickslip_contact::regularized::{Regularized, components};
use stickslip_contact::{Collision, Contact, Regime, Side, Switch};
use stickslip_exact::exact;
use stickslip_solver::Outcome;

use super::error::CollisionError;
use closed::Closed;
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
    /// |F_t|/μ is at most the [`limit`](Self::limit).
    pub tangential_force: f64,
    /// Reduced tangential velocity w.
    pub velocity: f64,
    /// Coulomb's limit over μ: |F| with one coefficient and without adhesion.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub limit: f64,
}

/// The course of one collision, from [`Engine::history`](crate::Engine::history) or
/// [`Collider::history`](crate::Collider::history).
///
/// That of the exact engine has the switches of its collision, and closed forms between them: x, v
/// and w are within 1e-14, and y within 1e-14/min(κ, √κ).
///
/// That of an integrator comes from its dense output. At the default tolerances of Dormand–Prince
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
    Closed(Box<Closed>),
    Paper(Record<Regularized, { components::STATE }>),
    Other(Record<GeneralContact, { general::STATE }>),
    Adhesive(Record<AdhesiveContact, { general::STATE }>),
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
    /// The law that holds; at a switch, the law of the phase that begins.
    pub regime: Regime,
    /// The side of sliding, as [`PhaseHistory::side`].
    pub side: Side,
    /// The number of the switch that happens at this moment, from 0.
    pub switch: Option<usize>,
}

impl History {
    /// Most steps of the integrator that are kept, which take about 160 MB, or most switches of the
    /// exact solution.
    ///
    /// Without damping, κ = 1e9 takes 200 000 steps at the default tolerances, and has 32 000
    /// switches.
    pub const MOST_STEPS: usize = 300_000;

    /// The course from the exact solution of the paper's law.
    ///
    /// # Errors
    /// [`CollisionError`]: the contact is out of the range of the exact engine, or has more than
    /// [`Self::MOST_STEPS`] switches.
    pub fn exact(contact: Contact) -> Result<Self, CollisionError> {
        Self::of_exact(exact::collide(contact)?)
    }

    /// The course of a collision of the exact engine, which has few enough switches.
    pub(crate) fn of_exact(collision: Collision) -> Result<Self, CollisionError> {
        match collision.switches.get(Self::MOST_STEPS) {
            Some(&Switch { time, .. }) => {
                Err(CollisionError::Unfinished { outcome: Outcome::StepLimit, time })
            }
            None => Ok(Self(Run::Closed(Box::new(Closed(collision))))),
        }
    }

    /// The course of a contact that obeys the paper's law.
    pub(crate) fn of_paper(record: Record<Regularized, { components::STATE }>) -> Self {
        Self(Run::Paper(record))
    }

    /// The course of a contact with another law.
    pub(crate) fn of_other(record: Record<GeneralContact, { general::STATE }>) -> Self {
        Self(Run::Other(record))
    }

    /// The course of a contact with adhesion.
    pub(crate) fn of_adhesive(record: Record<AdhesiveContact, { general::STATE }>) -> Self {
        Self(Run::Adhesive(record))
    }

    fn course(&self) -> &dyn Course {
        match &self.0 {
            Run::Closed(closed) => &**closed,
            Run::Paper(record) => record,
            Run::Other(record) => record,
            Run::Adhesive(record) => record,
        }
    }

    /// Scaled duration t_c of the contact.
    pub fn duration(&self) -> f64 {
        self.course().duration()
    }

    /// The phases in order; there is one more than there are switches.
    pub fn phases(&self) -> impl ExactSizeIterator<Item = PhaseHistory<'_>> {
        let course = self.course();
        (0..course.phases()).map(move |index| PhaseHistory { course, index })
    }

    /// The collision at a scaled time, at a switch in the phase that begins; `None` outside the
    /// contact.
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
    pub fn regime(&self) -> Regime {
        self.course.phase(self.index).0
    }

    /// The side of sliding or, in stick, the side from which the spring comes.
    pub fn side(&self) -> Side {
        self.course.phase(self.index).1
    }

    /// The first moment of the phase.
    pub fn begin(&self) -> Snapshot {
        self.course.begin(self.index)
    }

    /// The last moment of the phase; of the last phase, that at which the overlap vanishes or the
    /// law ends the contact.
    pub fn end(&self) -> Snapshot {
        self.course.end(self.index)
    }

    /// `intervals` + 1 moments from the first to the last. There are only these two if `intervals`
    /// is 0, or if the phase is too short for a step. Where the force ends before the overlap,
    /// there is one more at the end of the force.
    ///
    /// They are evenly spaced in a coordinate in which the motion is smooth: in s, where dt = 2√x
    /// ds, in that of another law, or in φ, where t = t_c sin² φ, for the exact engine. In time
    /// they are closer to each other near the ends of contact.
    pub fn samples(&self, intervals: usize) -> impl Iterator<Item = Snapshot> + use<> {
        self.course.samples(self.index, intervals).into_iter()
    }
}
