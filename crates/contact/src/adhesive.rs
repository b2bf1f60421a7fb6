//! A contact with adhesion, DMT or JKR, in coordinates in which everything is smooth.
//!
//! The variable is u, a root of the contact radius: u = √x in DMT, where the radius is that of
//! Hertz, and u⁴ − c u = x in JKR, where u is the root of the radius. With dt = (dx/du) ds the
//! equations are polynomial in u: du/ds = v. The radius of JKR as a function of x is a root of a
//! quartic, whose derivative is infinite where the overlap is least. As a variable it is neither:
//! the end of contact is where u falls to a known value, at the rate v.
//!
//! Coulomb's limit is the elastic force plus twice the force F_po that separates the bodies. It
//! does not vanish at the ends of contact, so that there is no attracting tail, and no power of u
//! to be divided out.
//!
//! Whether the bodies stay together is an event: the energy of the normal motion only falls, and
//! once it is below that of bodies at rest at the end of contact ([`HELD`]), they never get there.

use stickslip_solver::{Direction, Guard, Number, ReadableSystem, State};

mod equations;
mod shape;

use crate::contact::Contact;
use crate::general::{
    Beginning, CREST, ContactMode, ContactSystem, ModeProgress, REVERSAL, STATE, Stage, U, V,
};
use crate::phase::{END, OTHER_SIDE, Regime, SAME_SIDE, Side, longest_first_step};
use equations::Equations;

/// Number of guards.
pub const GUARDS: usize = 6;
/// Guard of the energy without which the bodies never separate.
pub const HELD: usize = 5;

/// A contact with adhesion, as a hybrid system. Its components and modes are those of
/// [`GeneralContact`](crate::general::GeneralContact).
#[derive(Clone, Copy, Debug)]
pub struct AdhesiveContact {
    contact: Contact,
    equations: Equations,
    beginning: Beginning,
    /// Whether reversals of the tangential velocity are events.
    reversals: bool,
}

impl AdhesiveContact {
    /// The system of one contact, whose law is adhesive.
    pub fn new(contact: Contact) -> Self {
        let equations = Equations::new(&contact).off_the_border(contact.psi());
        let beginning = equations.beginning(contact.psi());
        Self { contact, equations, beginning, reversals: false }
    }

    /// How the contact starts.
    pub fn beginning(&self) -> Beginning {
        self.beginning
    }

    /// See [`Contact::start_margin`].
    pub(crate) fn start_margin(&self) -> Option<f64> {
        Equations::new(&self.contact).start_room(self.contact.psi())
    }

    /// See [`Contact::start_layer`]: limit and dashpot are constant, and the reset spring grows as
    /// the radius.
    pub(crate) fn start_layer(&self) -> Option<f64> {
        let excess = 1.0 - self.equations.start_room(self.contact.psi())?;
        let overturned = self.beginning == Beginning::Overturned;
        overturned.then(|| ((excess + 1.0) / (excess - 1.0)).powi(2))
    }

    /// The mode that follows `mode` where `guard` fires.
    fn after(mode: ContactMode, guard: usize) -> ContactMode {
        let progress = ModeProgress::Switched;
        match (guard, mode.regime) {
            (END | HELD | REVERSAL, _) => mode,
            (CREST, _) => {
                let progress = ModeProgress::Settled;
                ContactMode { stage: Stage::Unloading, progress, ..mode }
            }
            (OTHER_SIDE, Regime::Stick) => {
                let side = mode.side.opposite();
                ContactMode { regime: Regime::Slip, side, progress, ..mode }
            }
            (_, Regime::Stick) => ContactMode { regime: Regime::Slip, progress, ..mode },
            (_, Regime::Slip) => ContactMode { regime: Regime::Stick, progress, ..mode },
        }
    }
}

impl ContactSystem for AdhesiveContact {
    fn contact(&self) -> Contact {
        self.contact
    }

    fn with_reversals(self) -> Self {
        Self { reversals: true, ..self }
    }

    fn first(&self) -> ContactMode {
        let (regime, side, progress) = match self.beginning {
            Beginning::Stick => (Regime::Stick, Side::Positive, ModeProgress::Touched),
            Beginning::Reset => (Regime::Stick, Side::Positive, ModeProgress::Reset),
            Beginning::Slip => (Regime::Slip, Side::Positive, ModeProgress::Touched),
            Beginning::Overturned => (Regime::Slip, Side::Negative, ModeProgress::Touched),
        };
        ContactMode { regime, side, stage: Stage::Main, progress, heading: Side::Positive }
    }

    fn start(&self) -> State<STATE> {
        self.equations.enter(self.first(), &self.equations.start(self.contact.psi())).into()
    }

    fn velocity(&self, y: &State<STATE>) -> f64 {
        self.equations.velocity(array(y))
    }

    fn compression_rate(&self, y: &State<STATE>) -> f64 {
        y[V]
    }

    fn overlap(&self, _mode: ContactMode, y: &State<STATE>) -> f64 {
        self.equations.shape.overlap(y[U])
    }

    fn compression_energy(&self, y: &State<STATE>) -> f64 {
        self.equations.shape.energy_since_touch(y[U])
    }

    fn clock_rate(&self, y: &State<STATE>) -> f64 {
        self.equations.shape.clock(y[U]).0
    }

    fn taken_by_dashpot(&self, y: &State<STATE>) -> f64 {
        self.equations.taken_by_dashpot(array(y))
    }

    fn normal_force(&self, _mode: ContactMode, y: &State<STATE>) -> f64 {
        self.equations.normal_force(array(y))
    }

    fn limit(&self, _mode: ContactMode, y: &State<STATE>) -> f64 {
        self.equations.limit(y[U])
    }

    fn tangential_force(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        match mode.regime {
            Regime::Slip => mode.side.sign() * self.limit(mode, y),
            Regime::Stick => self.equations.pull(mode.stage, array(y)),
        }
    }
}

impl ReadableSystem<STATE, GUARDS> for AdhesiveContact {
    type Mode = ContactMode;

    #[inline(always)]
    fn field<T: Number>(&self, mode: ContactMode, _s: T, y: &[T; STATE]) -> [T; STATE] {
        self.equations.field(mode, y)
    }

    fn guards(&self, mode: ContactMode) -> [Guard; GUARDS] {
        let below = Guard::new(Direction::Below).smooth();
        let touched = matches!(mode.progress, ModeProgress::Touched | ModeProgress::Reset);
        let end = below.terminal();
        let end =
            if touched && self.equations.shape.starts_at_end() { end.from_zero(1) } else { end };
        let [same, other] = match (mode.regime, mode.progress) {
            _ if self.equations.is_frictionless() => [Guard::OFF; 2],
            // Without history the force leaves its limit at a rate.
            (Regime::Slip, ModeProgress::Switched) if !self.equations.remembers() => {
                [below.from_zero(1), Guard::OFF]
            }
            (Regime::Slip, _) => [below, Guard::OFF],
            (Regime::Stick, ModeProgress::Reset) => {
                // Where u starts from 0, time grows as s².
                let order = if self.equations.shape.starts_at_end() { 2 } else { 1 };
                [below.from_zero(order), below]
            }
            (Regime::Stick, ModeProgress::Switched) => {
                [below.from_zero(if self.equations.remembers() { 2 } else { 1 }), below]
            }
            (Regime::Stick, _) => [below, below],
        };
        let turns = self.equations.rescaled && mode.stage == Stage::Main;
        let crest = if turns { below } else { Guard::OFF };
        let reversal = Guard::new(Direction::Either).smooth();
        let reversal = if self.reversals { reversal } else { Guard::OFF };
        [end, same, other, crest, reversal, below.terminal()]
    }

    #[inline(always)]
    fn guard_values<T: Number>(&self, mode: ContactMode, _s: T, y: &[T; STATE]) -> [T; GUARDS] {
        self.equations.guards(mode, y)
    }

    fn longest_first_step(&self, mode: ContactMode, s: f64, y: &State<STATE>) -> f64 {
        let end = self.guard_values(mode, s, array(y))[END];
        longest_first_step(end, y[V])
    }

    fn settle(&self, mode: ContactMode, y: &State<STATE>) -> ContactMode {
        let opens = mode.regime == Regime::Slip
            || mode.progress == ModeProgress::Touched
            || mode.progress != ModeProgress::Settled && self.equations.is_open(mode, array(y));
        if opens { ContactMode { progress: ModeProgress::Settled, ..mode } } else { mode }
    }

    fn transition(
        &self,
        mode: ContactMode,
        guard: usize,
        _s: f64,
        y: &State<STATE>,
    ) -> (ContactMode, State<STATE>) {
        let next = Self::after(mode, guard);
        match guard {
            SAME_SIDE | OTHER_SIDE => (next, self.equations.enter(next, array(y)).into()),
            CREST => {
                let turned = self.equations.turn(array(y));
                // A contact that begins to stick here would lose the gap to its limit in rounding.
                let switched = mode.progress == ModeProgress::Switched;
                if switched && self.equations.is_at_limit(mode, array(y)) {
                    let next = ContactMode { progress: ModeProgress::Switched, ..next };
                    return (next, self.equations.at_limit(next, turned).into());
                }
                (next, turned.into())
            }
            _ => (next, *y),
        }
    }
}

fn array(y: &State<STATE>) -> &[f64; STATE] {
    &y.data.0[0]
}
