//! The integration of a contact with any law, with adhesion or without.

use stickslip_contact::adhesive::HELD;
use stickslip_contact::general::{CREST, ContactMode, ContactSystem, DAMPING, REVERSAL, STATE, T};
use stickslip_contact::phase::END;
use stickslip_contact::{Collision, ContactEnd, CoulombTest, EnergyLedger, Law, Regime, Switch};
use stickslip_solver::{
    EmbeddedPair, HybridSystem, Observer, Options, Outcome, RunError, Start, State, Statistics,
    SwitchEvent, run_with,
};

use super::account::Observed;
use crate::engines::domain;
use crate::engines::error::CollisionError;

/// Integrates the collision of `system` into `collision`, while `course` observes the run too.
pub fn collide<S, const G: usize>(
    pair: EmbeddedPair,
    system: S,
    options: &Options,
    collision: &mut Collision,
    course: &mut impl Observer<ContactMode, STATE>,
) -> Result<Statistics, CollisionError>
where
    S: ContactSystem + HybridSystem<STATE, G, Mode = ContactMode>,
{
    let system = system.with_reversals();
    let contact = system.contact();
    collision.reset(contact);
    let start = Start { mode: system.first(), s: 0.0, state: system.start() };
    (collision.start, collision.start_side) = (start.mode.regime, start.mode.side);
    let account = Account {
        system,
        collision,
        phase: start.mode,
        entered: start.state,
        elapsed: 0.0,
        sliding: 0.0,
        lasting: 0.0,
        forward: true,
    };
    let mut observed = Observed { account, course };
    let run = run_with(pair, &system, start, f64::INFINITY, options, &mut observed);
    let tests_spring = contact.law().coulomb_test == CoulombTest::Spring;
    let run = match run {
        Err(RunError::Cycle { .. }) if tests_spring => {
            return Err(CollisionError::Creeping { time: observed.account.elapsed });
        }
        Err(RunError::GuardIdenticallyZero { .. }) if !contact.law().friction.is_constant() => {
            return Err(domain::lost(&contact).into());
        }
        run => run?,
    };
    let account = observed.account;
    match run.outcome {
        Outcome::EndedByGuard { guard: END } => {}
        Outcome::EndedByGuard { guard: HELD } => account.collision.adheres = true,
        outcome => {
            let time = account.elapsed + run.state[T];
            return Err(CollisionError::Unfinished { outcome, time });
        }
    }
    account.finish(&system, run.mode, run.state);
    Ok(run.statistics)
}

/// The running account of a collision.
struct Account<'a, S> {
    system: S,
    collision: &'a mut Collision,
    /// The phase so far.
    phase: ContactMode,
    /// The state in which it began.
    entered: State<STATE>,
    /// The time at which it began.
    elapsed: f64,
    /// Tangential energy taken by sliding.
    sliding: f64,
    /// The time since the last recorded switch.
    lasting: f64,
    /// Whether w is positive, as far as the reversals say.
    forward: bool,
}

/// Velocity, and rate of velocity, in units of ψ below which the sign is due to tolerances.
const NO_VELOCITY: f64 = 1e-9;

impl<S: ContactSystem> Account<'_, S> {
    /// Closes the phase in state `y`.
    fn leave(&mut self, y: &State<STATE>) {
        if self.phase.regime == Regime::Slip {
            let [w0, w1] = [&self.entered, y].map(|y| self.system.velocity(y));
            self.sliding += 0.5 * (w0 - w1) * (w0 + w1);
        }
        // A reversal at the moment of a switch is not an event of its own.
        let w = self.system.velocity(y);
        if self.counts(w) && (w > 0.0) != self.forward {
            self.reverse();
        }
        self.elapsed += y[T];
        self.lasting += y[T];
        self.entered = *y;
    }

    /// Whether a velocity or its rate is known to have its sign.
    fn counts(&self, value: f64) -> bool {
        value.abs() > NO_VELOCITY * self.collision.contact.psi()
    }

    fn reverse(&mut self) {
        self.forward = !self.forward;
        self.collision.reversals += 1;
    }

    /// Records the switch from the phase, which ends in state `before`, to `next`.
    fn switch(&mut self, next: ContactMode, before: &State<STATE>, y: &State<STATE>) {
        self.leave(before);
        self.phase = next;
        self.collision.switches.push(Switch {
            time: self.elapsed,
            // Until the end, the time since the switch before.
            time_left: std::mem::take(&mut self.lasting),
            to: next.regime,
            side: next.side,
            spring: self.system.spring(next, y),
            velocity: self.system.velocity(y),
        });
    }

    /// Closes the account in the mode and the state at the end.
    fn finish<const G: usize>(
        mut self,
        hybrid: &impl HybridSystem<STATE, G, Mode = ContactMode>,
        mode: ContactMode,
        mut y: State<STATE>,
    ) {
        if let Some((guard, length)) = self.system.last_slip(mode, &y) {
            let (next, after) = hybrid.transition(mode, guard, 0.0, &y);
            self.switch(next, &y, &after);
            (self.lasting, y) = (length, after);
        }
        let y = &y;
        self.leave(y);
        let Self { system, collision, sliding, lasting, .. } = self;
        let contact = collision.contact;
        let rate = system.compression_rate(y);
        let flight = if collision.adheres { 0.0 } else { system.flight(self.phase, y) };
        collision.contact_time = self.elapsed + flight;
        let mut left = lasting + flight;
        for switch in collision.switches.iter_mut().rev() {
            left += std::mem::replace(&mut switch.time_left, left);
        }
        collision.eps_n = if collision.adheres { f64::NAN } else { -rate };
        collision.final_velocity = system.velocity(y);
        let [tangential_initial, tangential_final] =
            [contact.psi(), collision.final_velocity].map(|w| 0.5 * w * w);
        let compression = system.compression_energy(y);
        // Where the force is limited, damping takes the rest of the compression, and pull-off takes
        // what it takes.
        let Law { end, normal, .. } = contact.law();
        let [taken, compression_left] = match end {
            _ if collision.adheres => [0.0, compression],
            ContactEnd::Force if !normal.is_adhesive() => [0.0, compression],
            _ => [compression, 0.0],
        };
        let tangential_damping = system.taken_by_dashpot(y);
        let normal_final = 0.5 * rate * rate;
        collision.energy = EnergyLedger {
            tangential_initial,
            tangential_final,
            sliding,
            tangential_damping,
            spring_left: tangential_initial - tangential_final - sliding - tangential_damping,
            normal_initial: 0.5,
            normal_final,
            damping: y[DAMPING] + taken,
            compression_left,
        };
    }
}

impl<S: ContactSystem> Observer<ContactMode, STATE> for Account<'_, S> {
    fn on_switch(&mut self, event: &SwitchEvent<ContactMode, STATE>) {
        match event.guard {
            REVERSAL => {
                // A strong dashpot stops the motion, and the rest is noise.
                if self.counts(self.system.tangential_force(event.from, &event.before)) {
                    self.reverse();
                }
            }
            // The phase goes on.
            CREST => self.phase.stage = event.to.stage,
            END if event.from.stage == event.to.stage => {}
            HELD => {}
            // Slip goes on where the normal force begins to attract.
            END if event.to.regime == self.phase.regime => {
                self.leave(&event.before);
                self.phase = event.to;
            }
            _ => self.switch(event.to, &event.before, &event.after),
        }
    }
}
