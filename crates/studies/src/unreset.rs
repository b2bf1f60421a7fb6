//! Another model: a spring that is not reset to the limit while sliding.
//!
//! Equations (9) and (10) of Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), say that
//! the spring follows the motion, ẏ = w, and that its force is cut off at the limit. The text after
//! (18) adds that the spring is reset to the limit as long as the limit is active. That is the
//! model of all other modules. Here the sentence is left out:
//!
//! ```text
//! stick: ẏ = w, ẇ = −κ y     while κ|y| < F
//! slip:  ẏ = w, ẇ = −s F     while s κ y > F
//! ```
//!
//! The spring may then grow without limit, and a force that should only brake the motion turns it
//! round: at κ = 18 and ψ = 1, ε_t is −1.000 instead of 0.105. The coordinates are the same as in
//! [`stickslip_model::regularized`].

use stickslip_model::regularized::{END, OTHER_SIDE, Phase, PhaseProgress, SAME_SIDE};
use stickslip_model::{Collider, Collision, CollisionError, Contact, EnergyLedger, Regime, Switch};
use stickslip_solver::{
    Direction, Dop853, Guard, HybridSystem, Observer, Options, Outcome, Start, State, SwitchEvent,
    run,
};

/// The number of components of the state.
const STATE: usize = 6;
/// The number of guards of a phase.
const GUARDS: usize = 4;

const U: usize = 0;
const V: usize = 1;
/// √κ y/σ with σ = min(1, ψ).
const SPRING: usize = 2;
/// w/σ.
const W: usize = 3;
const T: usize = 4;
/// The normal energy taken by damping.
const DAMPING: usize = 5;

/// Guard of the motion's reversals, after the guards of [`stickslip_model::regularized`].
const TURN: usize = 3;

/// A collision with a spring that is not reset.
#[derive(Clone, Debug, PartialEq)]
pub struct UnresetCollision {
    /// The collision. Its energy counts what the spring holds beyond the limit as taken by
    /// sliding; sliding may give it back.
    pub collision: Collision,
    /// The largest |y|.
    pub largest_spring: f64,
}

/// Integrates the collision of `contact` with a spring that is not reset, by Dormand–Prince 8(5,3)
/// at the tolerances of [`Collider`].
///
/// ```
/// use stickslip_model::{Contact, exact};
/// use stickslip_studies::unreset;
///
/// let contact = Contact::new(18.0, 1.0, 0.0)?;
/// assert!((unreset::collide(contact)?.collision.eps_t() + 1.0).abs() < 1e-3);
/// assert!((exact::collide(contact)?.eps_t() - 0.105).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: the contact has another law, the integration fails, or the contact does not
/// end.
pub fn collide(contact: Contact) -> Result<UnresetCollision, CollisionError> {
    contact.require_paper("the unreset spring")?;
    let system = UnresetSpring::new(contact);
    let (rtol, atol) = (Collider::RTOL, Collider::ATOL);
    let options =
        Options { rtol, atol, first_step: Some(0.1), max_step: 0.1, ..Options::default() };
    let start = system.start();
    let mut account = Account {
        system,
        collision: Collision::before(contact),
        largest_spring: 0.0,
        entered: start.state,
        sliding: 0.0,
    };
    let run = run(Dop853, &system, start, f64::INFINITY, &options, &mut account)?;
    account.leave(run.mode, &run.state);
    if run.outcome != (Outcome::EndedByGuard { guard: END }) {
        return Err(CollisionError::Unfinished { outcome: run.outcome, time: run.state[T] });
    }
    let Account { mut collision, largest_spring, sliding, .. } = account;
    let velocity = system.velocity(&run.state);
    collision.contact_time = run.state[T];
    for switch in &mut collision.switches {
        switch.time_left = run.state[T] - switch.time;
    }
    collision.eps_n = -run.state[V];
    collision.final_velocity = velocity;
    collision.energy = EnergyLedger {
        tangential_initial: 0.5 * contact.psi() * contact.psi(),
        tangential_final: 0.5 * velocity * velocity,
        tangential_damping: 0.0,
        sliding,
        spring_left: 0.5 * system.stored(run.mode, &run.state),
        normal_initial: 0.5,
        normal_final: 0.5 * run.state[V] * run.state[V],
        damping: run.state[DAMPING],
        compression_left: 0.4 * run.state[U].powi(5),
    };
    Ok(UnresetCollision { collision, largest_spring })
}

/// The contact as a hybrid system.
#[derive(Clone, Copy)]
struct UnresetSpring {
    contact: Contact,
    omega: f64,
    /// σ.
    velocity_unit: f64,
}

impl UnresetSpring {
    fn new(contact: Contact) -> Self {
        let (omega, velocity_unit) = (contact.kappa().sqrt(), contact.psi().min(1.0));
        Self { contact, omega, velocity_unit }
    }

    fn start(&self) -> Start<Phase, STATE> {
        let mut state = State::zeros();
        state[V] = 1.0;
        state[W] = self.contact.psi() / self.velocity_unit;
        Start { mode: Phase::first(&self.contact), s: 0.0, state }
    }

    fn velocity(&self, y: &State<STATE>) -> f64 {
        self.velocity_unit * y[W]
    }

    fn spring(&self, y: &State<STATE>) -> f64 {
        self.velocity_unit * y[SPRING] / self.omega
    }

    /// u² + a v, which is F/u.
    fn force_over_root(&self, y: &State<STATE>) -> f64 {
        y[U] * y[U] + self.contact.damping() * y[V]
    }

    fn force(&self, y: &State<STATE>) -> f64 {
        y[U] * self.force_over_root(y)
    }

    /// s κ y.
    fn pull(&self, phase: Phase, y: &State<STATE>) -> f64 {
        phase.side.sign() * self.velocity_unit * self.omega * y[SPRING]
    }

    /// κ y² of the part of the spring that gives its energy back: in slip, of the limit.
    fn stored(&self, phase: Phase, y: &State<STATE>) -> f64 {
        let pull = match phase.regime {
            Regime::Slip => self.force(y),
            Regime::Stick => self.pull(phase, y),
        };
        pull * pull / self.contact.kappa()
    }
}

impl HybridSystem<STATE, GUARDS> for UnresetSpring {
    type Mode = Phase;

    fn field(&self, phase: Phase, _s: f64, y: &State<STATE>) -> State<STATE> {
        let (u, v) = (y[U], y[V]);
        let force = self.force(y);
        let pull = match phase.regime {
            Regime::Slip => phase.side.sign() * force / self.velocity_unit,
            Regime::Stick => self.omega * y[SPRING],
        };
        let loss = 2.0 * self.contact.damping() * (u * v) * (u * v);
        let stretch = 2.0 * u * self.omega * y[W];
        State::from([v, -2.0 * u * force, stretch, -2.0 * u * pull, 2.0 * u, loss])
    }

    fn guards(&self, phase: Phase) -> [Guard; GUARDS] {
        let end = Guard::new(Direction::Below).terminal();
        let leave = Guard::new(Direction::Below);
        let turn = Guard::new(Direction::Either);
        match (phase.regime, phase.progress) {
            // A phase goes on after a reversal.
            (Regime::Slip, PhaseProgress::Settled) => [end, leave, Guard::OFF, turn.from_zero(1)],
            (Regime::Stick, PhaseProgress::Settled) => [end, leave, leave, turn.from_zero(1)],
            // Without damping the contact starts at u = 0, where the spring grows as u² and the
            // force as u³.
            (Regime::Slip, PhaseProgress::Touched) => {
                [end.from_zero(1), leave.from_zero(2), Guard::OFF, turn]
            }
            (Regime::Slip, _) => [end, leave.from_zero(1), Guard::OFF, turn],
            (Regime::Stick, PhaseProgress::Touched) => {
                [end, leave.from_zero(1), leave.from_zero(1), turn]
            }
            (Regime::Stick, _) => [end, leave.from_zero(1), leave, turn],
        }
    }

    fn guard_values(&self, phase: Phase, _s: f64, y: &State<STATE>) -> [f64; GUARDS] {
        let end = if self.contact.damping() > 0.0 { self.force_over_root(y) } else { y[U] };
        let (force, pull) = (self.force(y), self.pull(phase, y));
        match phase.regime {
            Regime::Slip => [end, pull - force, 1.0, y[W]],
            Regime::Stick => [end, force - pull, force + pull, y[W]],
        }
    }

    fn transition(
        &self,
        phase: Phase,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (Phase, State<STATE>) {
        match guard {
            TURN => (Phase { progress: PhaseProgress::Settled, ..phase }, *y),
            _ => (phase.after(guard == OTHER_SIDE), *y),
        }
    }
}

/// Records a run while it goes on.
struct Account {
    system: UnresetSpring,
    collision: Collision,
    largest_spring: f64,
    /// The state at the start of the phase.
    entered: State<STATE>,
    /// The energy taken by sliding before that.
    sliding: f64,
}

impl Account {
    /// Closes a phase that ends in state `y`.
    fn leave(&mut self, phase: Phase, y: &State<STATE>) {
        let (system, entered) = (&self.system, &self.entered);
        self.largest_spring = self.largest_spring.max(system.spring(y).abs());
        if phase.regime == Regime::Slip {
            // s w = s w₀ + v − v₀ and F dt = −dv turn ∫ F (s w − dL/dt) dt into differences.
            let slowed = entered[V] - y[V];
            let work = slowed * (phase.side.sign() * system.velocity(entered) - 0.5 * slowed);
            self.sliding += work - 0.5 * (system.stored(phase, y) - system.stored(phase, entered));
        }
    }
}

impl Observer<Phase, STATE> for Account {
    fn on_switch(&mut self, event: &SwitchEvent<Phase, STATE>) {
        let spring = self.system.spring(&event.after);
        match event.guard {
            SAME_SIDE | OTHER_SIDE => {
                self.leave(event.from, &event.before);
                self.entered = event.after;
                self.collision.switches.push(Switch {
                    time: event.after[T],
                    time_left: f64::NAN,
                    to: event.to.regime,
                    side: event.to.side,
                    spring,
                    velocity: self.system.velocity(&event.after),
                });
            }
            TURN => {
                self.collision.reversals += 1;
                self.largest_spring = self.largest_spring.max(spring.abs());
            }
            _ => {}
        }
    }
}
