//! A collision, phase by phase.

use stickslip_contact::{Collision, EnergyLedger, Regime, Side, Switch};

use super::Linear;
use super::normal::{Moment, Place, Stage};
use super::slip::Slip;
use super::stick::{Release, Stick};
use crate::exact::{ExactError, MOST_SWITCHES};

/// A phase.
enum Phase<'a> {
    Stick(Stick<'a>),
    Slip(Slip<'a>),
}

/// What comes after a phase.
enum Next<'a> {
    /// Another regime, or the same in another stage.
    Phase(Phase<'a>),
    /// The end of contact, with this velocity w.
    End(f64),
}

/// The running account of a collision.
struct Run<'a, 'c> {
    linear: &'a Linear,
    collision: &'c mut Collision,
    /// The kinetic energy lost in slip.
    sliding: f64,
    /// Energy that the dashpot has taken in stick.
    dashpot: f64,
}

/// Computes the collision of a contact.
pub fn run(linear: &Linear, collision: &mut Collision) -> Result<(), ExactError> {
    let mut phase = first(linear, collision);
    let mut run = Run { linear, collision, sliding: 0.0, dashpot: 0.0 };
    let velocity = loop {
        let next = match &phase {
            Phase::Stick(stick) => run.stick(stick),
            Phase::Slip(slip) => run.slip(slip),
        };
        phase = match next {
            Next::Phase(phase) => phase,
            Next::End(velocity) => break velocity,
        };
        run.require_few()?;
    };
    run.finish(velocity);
    Ok(())
}

/// The phase with which a contact starts.
fn first<'a>(linear: &'a Linear, collision: &mut Collision) -> Phase<'a> {
    let contact = collision.contact;
    let (kappa, psi, damping) = (contact.kappa(), contact.psi(), contact.damping());
    let at = (Stage::Main, linear.normal.start());
    let damped = damping > 0.0;
    let ratio = if damped { contact.tangential_damping() } else { kappa };
    let room = super::unless_rounding((-ratio).mul_add(psi, 1.0), 1.0);
    let slope = 1.0 - damping * damping;
    collision.start = Regime::Stick;
    if room >= 0.0 {
        let force = linear.dashpot * psi;
        let pull = kappa * psi - linear.dashpot * force;
        let near = (damping * room, if damped { slope - pull } else { room });
        let far = (damping + force, slope + pull);
        return Phase::Stick(Stick::relaxed(linear, at, Side::Positive, psi, [near, far]));
    }
    // The history is reset to the limit, which is a.
    let excess = if damped { kappa * psi - linear.dashpot * damping - slope } else { -room };
    if excess < 0.0 {
        return Phase::Stick(Stick::at_limit(linear, at, Side::Positive, psi, -excess));
    }
    collision.start = Regime::Slip;
    Phase::Slip(Slip::new(linear, at, Side::Positive, psi, excess))
}

impl<'a> Run<'a, '_> {
    /// Follows a stick phase to its end.
    fn stick(&mut self, stick: &Stick<'a>) -> Next<'a> {
        let Some(release) = stick.release() else {
            let end = stick.end();
            let [velocity, _] = stick.motion_at(end.since);
            self.collision.reversals += stick.reversals(end.since, velocity);
            self.dashpot += stick.taken_by_dashpot(end.since);
            // Limit and spring vanish together.
            if stick.stage == Stage::Main && self.linear.normal.attracts {
                let tail = (Stage::Tail, self.linear.normal.zero());
                return Next::Phase(Phase::Stick(Stick::touched(
                    self.linear,
                    tail,
                    stick.side,
                    velocity,
                )));
            }
            return Next::End(velocity);
        };
        let Release { place, side, velocity, excess } = release;
        self.collision.reversals += stick.reversals(place.since, velocity);
        self.dashpot += stick.taken_by_dashpot(place.since);
        let moment = stick.start.after(place);
        let (limit, _) = self.linear.normal.limit(stick.stage, &moment);
        self.switch(&moment, (Regime::Slip, side), side.sign() * limit, velocity);
        Next::Phase(Phase::Slip(Slip::new(
            self.linear,
            (stick.stage, moment),
            side,
            velocity,
            excess,
        )))
    }

    /// Follows a slip phase to its end.
    fn slip(&mut self, slip: &Slip<'a>) -> Next<'a> {
        let side = slip.side;
        if let Some(place) = slip.onset() {
            let velocity = self.slipped(slip, place);
            let moment = slip.start.after(place);
            let at = (slip.stage, moment);
            let (limit, _) = self.linear.normal.limit(slip.stage, &moment);
            self.switch(&moment, (Regime::Stick, side), side.sign() * limit, velocity);
            let stick = Stick::at_limit(self.linear, at, side, velocity, 0.0);
            return Next::Phase(Phase::Stick(stick));
        }
        let velocity = self.slipped(slip, slip.end());
        if slip.stage == Stage::Tail || !self.linear.normal.attracts {
            return Next::End(velocity);
        }
        let moment = self.linear.normal.zero();
        let tail = (Stage::Tail, moment);
        let (_, slope) = self.linear.normal.limit(Stage::Tail, &moment);
        let excess = self.linear.kappa * side.sign() * velocity - slope;
        let excess = super::unless_rounding(excess, slope);
        Next::Phase(if excess >= 0.0 {
            Phase::Slip(Slip::new(self.linear, tail, side, velocity, excess))
        } else {
            self.switch(&moment, (Regime::Stick, side), 0.0, velocity);
            Phase::Stick(Stick::touched(self.linear, tail, side, velocity))
        })
    }

    /// Accounts for the slip up to `place`, and returns the velocity there.
    fn slipped(&mut self, slip: &Slip<'a>, place: Place) -> f64 {
        let velocity = slip.velocity_at(place);
        self.collision.reversals += usize::from((velocity < 0.0) != (slip.velocity < 0.0));
        self.sliding += 0.5 * (slip.velocity - velocity) * (slip.velocity + velocity);
        velocity
    }

    fn switch(&mut self, at: &Moment, (to, side): (Regime, Side), force: f64, velocity: f64) {
        let Linear { kappa, normal, .. } = self.linear;
        let time_left = at.left + normal.rest;
        let spring = force / kappa;
        self.collision.switches.push(Switch {
            time: at.time,
            time_left,
            to,
            side,
            spring,
            velocity,
        });
    }

    fn require_few(&self) -> Result<(), ExactError> {
        let Collision { contact, switches, .. } = &*self.collision;
        match switches.get(MOST_SWITCHES) {
            None => Ok(()),
            Some(first) => Err(ExactError::TooManySwitches {
                limit: MOST_SWITCHES,
                kappa: contact.kappa(),
                psi: contact.psi(),
                time_left: first.time_left,
            }),
        }
    }

    /// Closes the account with the velocity at the end.
    fn finish(self, velocity: f64) {
        let Self { linear: Linear { normal, .. }, collision, sliding, dashpot } = self;
        collision.eps_n = normal.restitution();
        collision.final_velocity = velocity;
        collision.contact_time = normal.force_ends + normal.rest;
        let [tangential_initial, tangential_final] =
            [collision.contact.psi(), velocity].map(|w| 0.5 * w * w);
        let (damping, compression_left) = normal.energy(collision.contact.law().end);
        collision.energy = EnergyLedger {
            tangential_initial,
            tangential_final,
            sliding,
            tangential_damping: dashpot,
            spring_left: tangential_initial - tangential_final - sliding - dashpot,
            normal_initial: 0.5,
            normal_final: 0.5 * collision.eps_n * collision.eps_n,
            damping,
            compression_left,
        };
    }
}
