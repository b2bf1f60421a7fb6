//! The systems whose runs make courses: the paper's contact, and the contact of any law, with
//! adhesion or without.

use stickslip_contact::adhesive::HELD;
use stickslip_contact::general::{self, CREST, ContactMode, ContactSystem, REVERSAL};
use stickslip_contact::phase::{END, Phase};
use stickslip_contact::regularized::{Regularized, components};
use stickslip_contact::{Regime, Side};
use stickslip_solver::{Start, State, SwitchEvent};

use super::Snapshot;

/// A contact whose run can be kept.
pub trait Followed<const N: usize>: Copy {
    /// A phase, or a part of one with equations of its own.
    type Mode: Copy;
    /// The component that is the time since the clock was last set to zero.
    const CLOCK: usize;

    /// Where the run begins.
    fn start(&self) -> Start<Self::Mode, N>;

    /// The state at a time before the run begins, which is soon after the contact does.
    fn before_start(&self, time: f64) -> State<N>;

    /// How fast time grows with s.
    fn clock_rate(&self, y: &State<N>) -> f64;

    /// The contact in the state `y`; its time is the time of the clock.
    fn snapshot(&self, mode: Self::Mode, y: &State<N>) -> Snapshot;

    /// What holds in a mode.
    fn phase(mode: Self::Mode) -> (Regime, Side);

    /// What begins with an event.
    fn begins(event: &SwitchEvent<Self::Mode, N>) -> Begins;

    /// How long the overlap goes on when the force has ended in the state `y`.
    fn flight(&self, mode: Self::Mode, y: &State<N>) -> f64;
}

/// What begins with an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begins {
    /// Nothing; all goes on.
    Nothing,
    /// Other equations within a phase.
    Part,
    /// A phase.
    Phase,
    /// Nothing more; the contact has ended.
    ContactEnd,
}

impl Followed<{ components::STATE }> for Regularized {
    type Mode = Phase;
    const CLOCK: usize = components::T;

    fn start(&self) -> Start<Phase, { components::STATE }> {
        Start { mode: Phase::first(&self.contact()), s: 0.0, state: Self::start(self) }
    }

    fn before_start(&self, _time: f64) -> State<{ components::STATE }> {
        Self::start(self)
    }

    fn clock_rate(&self, y: &State<{ components::STATE }>) -> f64 {
        2.0 * y[components::U]
    }

    fn snapshot(&self, phase: Phase, y: &State<{ components::STATE }>) -> Snapshot {
        let spring = self.spring(phase, y);
        Snapshot {
            time: y[components::T],
            compression: y[components::U] * y[components::U],
            normal_velocity: self.compression_rate(y),
            normal_force: self.normal_force(y),
            spring,
            tangential_force: -self.contact().kappa() * spring,
            velocity: self.velocity(y),
            limit: self.normal_force(y),
        }
    }

    fn phase(phase: Phase) -> (Regime, Side) {
        (phase.regime, phase.side)
    }

    fn begins(event: &SwitchEvent<Phase, { components::STATE }>) -> Begins {
        if event.guard == END { Begins::ContactEnd } else { Begins::Phase }
    }

    fn flight(&self, _phase: Phase, _y: &State<{ components::STATE }>) -> f64 {
        0.0
    }
}

impl<S: ContactSystem> Followed<{ general::STATE }> for S {
    type Mode = ContactMode;
    const CLOCK: usize = general::T;

    fn start(&self) -> Start<ContactMode, { general::STATE }> {
        Start { mode: self.first(), s: 0.0, state: ContactSystem::start(self) }
    }

    fn before_start(&self, time: f64) -> State<{ general::STATE }> {
        self.state_before_start(time)
    }

    fn clock_rate(&self, y: &State<{ general::STATE }>) -> f64 {
        ContactSystem::clock_rate(self, y)
    }

    fn snapshot(&self, mode: ContactMode, y: &State<{ general::STATE }>) -> Snapshot {
        Snapshot {
            time: y[general::T],
            compression: self.overlap(mode, y),
            normal_velocity: self.compression_rate(y),
            normal_force: self.normal_force(mode, y),
            spring: self.spring(mode, y),
            tangential_force: -self.tangential_force(mode, y),
            velocity: self.velocity(y),
            limit: self.limit(mode, y),
        }
    }

    fn phase(mode: ContactMode) -> (Regime, Side) {
        (mode.regime, mode.side)
    }

    fn begins(event: &SwitchEvent<ContactMode, { general::STATE }>) -> Begins {
        match event.guard {
            HELD => Begins::ContactEnd,
            REVERSAL if event.from == event.to => Begins::Nothing,
            REVERSAL | CREST => Begins::Part,
            END if event.from.stage == event.to.stage => Begins::ContactEnd,
            END if event.from.regime == event.to.regime => Begins::Part,
            _ => Begins::Phase,
        }
    }

    fn flight(&self, mode: ContactMode, y: &State<{ general::STATE }>) -> f64 {
        ContactSystem::flight(self, mode, y)
    }
}
