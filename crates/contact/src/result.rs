//! The result of a collision, the same for every engine.

use smallvec::SmallVec;

use crate::contact::Contact;
use crate::phase::{OTHER_SIDE, Phase, Regime, SAME_SIDE, Side};

mod energy;

pub use energy::EnergyLedger;

/// The result of one collision in reduced variables, from any engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// The collision's parameters.
    pub contact: Contact,
    /// Whether the bodies stay together for ever, held by adhesion. Then there is no restitution,
    /// [`Self::eps_n`] and [`Self::eps_t`] are NaN, and all else is up to where that is certain:
    /// the energy of the normal motion only falls, and there it is that of bodies at rest where
    /// they would separate.
    pub adheres: bool,
    /// Coefficient of normal restitution ε_n = −ẋ(t_c)/ẋ(0).
    pub eps_n: f64,
    /// Reduced tangential velocity w at the end of contact; ε_t = w/ψ.
    pub final_velocity: f64,
    /// Scaled duration t_c of the contact.
    pub contact_time: f64,
    /// The regime in which the contact starts: slip without damping, stick with it.
    pub start: Regime,
    /// The side of the slip with which it starts; only a few contact laws start on side −1.
    pub start_side: Side,
    /// Every switch, in order of time.
    pub switches: Switches,
    /// Number of sign changes of the tangential velocity during contact.
    pub reversals: usize,
    /// The energy before, during and after the contact.
    pub energy: EnergyLedger,
}

/// A switch between Coulomb sliding and the spring.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Switch {
    /// Scaled time since the start of contact.
    pub time: f64,
    /// Scaled time until the end of contact, accurate relative to itself however small it is.
    pub time_left: f64,
    /// The regime that begins.
    pub to: Regime,
    /// The side of the sliding that begins or, at a switch to stick, of the sliding that ends.
    pub side: Side,
    /// Reduced elongation y of the spring; in other laws than the paper's, the tangential force
    /// over −μκ.
    pub spring: f64,
    /// Reduced tangential velocity w.
    pub velocity: f64,
}

/// Number of switches up to which a collision allocates nothing: no collision with κ below 240 has
/// more. The switches lie in the collision itself; copying the longer struct costs the exact engine
/// 1 % of its instructions.
pub const FEW_SWITCHES: usize = 16;

/// The switches of a collision. Up to [`FEW_SWITCHES`] of them are stored in the collision itself.
pub type Switches = SmallVec<[Switch; FEW_SWITCHES]>;

impl Collision {
    /// A collision that has not been computed yet: its coefficient, velocity and duration are NaN,
    /// it has no switches, and its energies are 0.
    pub fn before(contact: Contact) -> Self {
        Self {
            contact,
            adheres: false,
            eps_n: f64::NAN,
            final_velocity: f64::NAN,
            contact_time: f64::NAN,
            start: Phase::first(&contact).regime,
            start_side: Side::Positive,
            switches: Switches::new(),
            reversals: 0,
            energy: EnergyLedger::default(),
        }
    }

    /// Makes this [`Collision::before`] of `contact`, and keeps its memory.
    pub fn reset(&mut self, contact: Contact) {
        self.contact = contact;
        self.adheres = false;
        (self.eps_n, self.final_velocity, self.contact_time) = (f64::NAN, f64::NAN, f64::NAN);
        self.start = Phase::first(&contact).regime;
        self.start_side = Side::Positive;
        self.switches.clear();
        self.reversals = 0;
        self.energy = EnergyLedger::default();
    }

    /// Coefficient of tangential restitution ε_t = g_t(t_c)/g_t(0); −1 is full reversal.
    pub fn eps_t(&self) -> f64 {
        if self.adheres { f64::NAN } else { self.final_velocity / self.contact.psi() }
    }

    /// One character for each phase: `+` and `-` for slip on side +1 and −1, `o` for stick.
    pub fn itinerary(&self) -> String {
        let start = (self.start, self.start_side);
        let entered = self.switches.iter().map(|switch| (switch.to, switch.side));
        let phases = std::iter::once(start).chain(entered);
        phases
            .map(|phase| match phase {
                (Regime::Stick, _) => 'o',
                (Regime::Slip, Side::Positive) => '+',
                (Regime::Slip, Side::Negative) => '-',
            })
            .collect()
    }

    /// The guards that fired, [`SAME_SIDE`](crate::regularized::SAME_SIDE) or
    /// [`OTHER_SIDE`](crate::regularized::OTHER_SIDE) for each switch, as the
    /// margins of the exact solution name them.
    pub fn fired(&self) -> Vec<usize> {
        let mut side = self.start_side;
        let guard = |switch: &Switch| {
            let same = std::mem::replace(&mut side, switch.side) == switch.side;
            if same { SAME_SIDE } else { OTHER_SIDE }
        };
        self.switches.iter().map(guard).collect()
    }

    /// Checks that all results but the energies are finite numbers, but for restitutions of bodies
    /// that stick; see [`EnergyLedger::require_finite`] for energies.
    ///
    /// # Errors
    /// [`NotFinite`] names the first that is not.
    pub fn require_finite(&self) -> Result<(), NotFinite> {
        let [eps_n, eps_t] = if self.adheres { [0.0; 2] } else { [self.eps_n, self.eps_t()] };
        let results = [
            ("eps_n", eps_n),
            ("eps_t", eps_t),
            ("w_final", self.final_velocity),
            ("contact_time", self.contact_time),
        ];
        let switches = self.switches.iter().flat_map(|switch| {
            [
                ("the time of a switch", switch.time),
                ("the time left at a switch", switch.time_left),
                ("the spring at a switch", switch.spring),
                ("the velocity at a switch", switch.velocity),
            ]
        });
        NotFinite::among(results.into_iter().chain(switches))
    }
}

/// A result is beyond the range of doubles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} is not a finite number")]
pub struct NotFinite {
    /// The name of the result.
    pub name: &'static str,
}

impl NotFinite {
    /// Checks that all results, given with their names, are finite numbers.
    ///
    /// # Errors
    /// [`NotFinite`] names the first that is not.
    pub fn among(values: impl IntoIterator<Item = (&'static str, f64)>) -> Result<(), Self> {
        match values.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((name, _)) => Err(Self { name }),
            None => Ok(()),
        }
    }
}
