//! The account of a run while it goes on: switches, reversals and the work of sliding.

use stickslip_contact::phase::{END, Phase};
use stickslip_contact::regularized::Regularized;
use stickslip_contact::regularized::components::{STATE, T};
use stickslip_contact::{Collision, Regime, Switch};
use stickslip_solver::method::Dense;
use stickslip_solver::{Observer, State, SwitchEvent};

use super::last_slip::{self, LastStick};
use super::reversals;

/// The running account of a collision.
pub struct Account<'a> {
    system: Regularized,
    collision: &'a mut Collision,
    /// State in which the phase began.
    entered: State<STATE>,
    /// Elongation of the spring when it began.
    spring: f64,
    /// Time at which it began.
    pub elapsed: f64,
    /// Energy taken by sliding in the phases before.
    pub sliding: f64,
    /// The largest flatness of a switch so far.
    pub flatness: f64,
}

impl<'a> Account<'a> {
    /// The account of a run that begins in state `start`; switches go into `collision`.
    pub fn new(system: Regularized, collision: &'a mut Collision, start: State<STATE>) -> Self {
        Self {
            system,
            collision,
            entered: start,
            spring: 0.0,
            elapsed: 0.0,
            sliding: 0.0,
            flatness: 0.0,
        }
    }

    /// Closes a phase that ends in state `y` with the elongation `spring`.
    fn leave(&mut self, phase: Phase, y: &State<STATE>, spring: f64) {
        let kappa = self.collision.contact.kappa();
        let [v0, v1] = [&self.entered, y].map(|y| self.system.compression_rate(y));
        let w0 = self.system.velocity(&self.entered);
        let w1 = self.system.velocity(y);
        self.collision.reversals += match phase.regime {
            Regime::Slip => usize::from(reversals::changed(w0, w1)),
            Regime::Stick => reversals::on_spring(kappa, (self.spring, w0), w1, y[T]),
        };
        if phase.regime == Regime::Slip {
            // With s w = s w₀ + v − v₀ and F dt = −dv, ∫ F (s w − dL/dt) dt is made of differences.
            let work = (v0 - v1) * (phase.side.sign() * w0 + 0.5 * (v1 - v0));
            self.sliding += work - 0.5 * kappa * (spring * spring - self.spring * self.spring);
        }
        self.spring = spring;
        self.entered = *y;
    }

    /// Closes the phase in which the contact ends, in state `y`, and returns the duration of the
    /// last slip.
    pub fn finish(&mut self, phase: Phase, y: &State<STATE>) -> f64 {
        let (slip, length) = match phase.regime {
            Regime::Slip => (phase, y[T]),
            Regime::Stick => {
                let slip = last_slip::after(phase, self.system.spring(phase, y));
                self.switch(phase, slip, y);
                (slip, 0.0)
            }
        };
        if let Some(stick) = last_slip::stick(&self.system, slip, y) {
            self.stick(&stick, y);
            self.leave(slip, y, 0.0);
            return stick.ends[1].0;
        }
        let short = match self.collision.switches.last() {
            Some(switch) => last_slip::time_left(&self.system, y, switch.spring, length),
            None => None,
        };
        // At the end the spring is at its limit, which is 0.
        self.leave(slip, y, 0.0);
        short.unwrap_or(length)
    }

    /// Records the switches of a stick phase just before the end, whose state is `y`.
    fn stick(&mut self, LastStick { side, ends: [start, end] }: &LastStick, y: &State<STATE>) {
        let lengths = [y[T] - start.0, start.0 - end.0];
        let switches = [(Regime::Stick, *side, start), (Regime::Slip, side.opposite(), end)];
        for ((to, side, (_, spring)), length) in switches.into_iter().zip(lengths) {
            self.elapsed += length;
            let velocity = self.system.velocity(y);
            let time = self.elapsed;
            self.collision.switches.push(Switch {
                time,
                time_left: length,
                to,
                side,
                spring: *spring,
                velocity,
            });
        }
    }

    /// Records the switch from phase `from` to phase `to` in state `y`.
    fn switch(&mut self, from: Phase, to: Phase, y: &State<STATE>) {
        // Where the limit is small, the spring of a stick phase is known better than the limit.
        self.leave(from, y, self.system.spring(from, y));
        self.elapsed += y[T];
        self.collision.switches.push(Switch {
            time: self.elapsed,
            time_left: y[T],
            to: to.regime,
            side: to.side,
            spring: self.spring,
            velocity: self.system.velocity(y),
        });
    }
}

impl Observer<Phase, STATE> for Account<'_> {
    fn on_switch(&mut self, event: &SwitchEvent<Phase, STATE>) {
        if event.guard == END {
            return;
        }
        self.flatness = self.flatness.max(event.flatness);
        self.switch(event.from, event.to, &event.before);
    }
}

/// The account of a run, and another observer of the same run.
pub struct Observed<'a, A, O> {
    pub account: A,
    pub course: &'a mut O,
}

impl<A, O, Mode: Copy, const N: usize> Observer<Mode, N> for Observed<'_, A, O>
where
    A: Observer<Mode, N>,
    O: Observer<Mode, N>,
{
    const WANTS_SEGMENTS: bool = O::WANTS_SEGMENTS;

    fn on_segment(&mut self, mode: Mode, step: &Dense<N>) {
        self.course.on_segment(mode, step);
    }

    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.account.on_switch(event);
        self.course.on_switch(event);
    }
}
