//! The parameters of a collision, and what a collision returns.

use std::fmt;

use smallvec::SmallVec;

use crate::energy::EnergyLedger;

/// One collision in scaled variables: the two numbers that decide the switching, and the damping.
///
/// Scaled units: time β^{−2/5} g_n^{−1/5}, length g_n^{4/5} β^{−2/5}, with β = ρ/m.
///
/// ```
/// use stickslip_model::Contact;
///
/// let contact = Contact::new(63.0, 0.5, 0.0)?;
/// assert_eq!(contact.kappa(), 63.0);
/// assert!(Contact::new(-1.0, 0.5, 0.0).is_err());
/// # Ok::<(), stickslip_model::InvalidParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    kappa: f64,
    psi: f64,
    damping: f64,
}

impl Contact {
    /// A collision with scaled stiffness `kappa` = k_t/(α m β^{4/5} g_n^{2/5}) > 0,
    /// impact ratio `psi` = (g_t/g_n) α/μ > 0 and scaled damping `damping` = A β^{2/5} g_n^{1/5} ≥
    /// 0.
    ///
    /// # Errors
    /// [`InvalidParameter`] names the first parameter that is out of its range.
    pub fn new(kappa: f64, psi: f64, damping: f64) -> Result<Self, InvalidParameter> {
        let in_range = |name, value: f64, expected, ok: bool| {
            if ok && value.is_finite() {
                Ok(())
            } else {
                Err(InvalidParameter { name, value, expected })
            }
        };
        in_range("kappa", kappa, "a finite number above 0", kappa > 0.0)?;
        in_range("psi", psi, "a finite number above 0", psi > 0.0)?;
        in_range("damping", damping, "a finite number, 0 or above", damping >= 0.0)?;
        Ok(Self { kappa, psi, damping })
    }

    /// Scaled stiffness κ of the tangential spring.
    #[must_use]
    pub fn kappa(&self) -> f64 {
        self.kappa
    }

    /// Reduced impact ratio ψ = (g_t/g_n) α/μ.
    #[must_use]
    pub fn psi(&self) -> f64 {
        self.psi
    }

    /// Scaled damping a of the normal force.
    #[must_use]
    pub fn damping(&self) -> f64 {
        self.damping
    }
}

/// A parameter of a collision is out of its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value} is out of range; expected {expected}")]
pub struct InvalidParameter {
    /// The parameter's name.
    pub name: &'static str,
    /// The value that was given.
    pub value: f64,
    /// What is expected.
    pub expected: &'static str,
}

/// Which law the tangential force obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Regime {
    /// Coulomb sliding: the force is at its limit μ F_n.
    Slip,
    /// The tangential spring, below the limit.
    Stick,
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Slip => "slip",
            Self::Stick => "stick",
        })
    }
}

/// The side of the spring's limit: the sign s of the elongation y = s L while sliding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// s = +1, the side of the initial motion.
    Positive,
    /// s = −1.
    Negative,
}

impl Side {
    /// The sign s = ±1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The other side.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }
}

/// A switch between Coulomb sliding and the spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// Scaled time since the start of contact.
    pub time: f64,
    /// Scaled time until the end of contact, accurate relative to itself however small it is.
    pub time_left: f64,
    /// The regime that begins.
    pub to: Regime,
    /// The side of the sliding that begins, or for a switch to stick, of the sliding that ends.
    pub side: Side,
    /// Reduced elongation y of the spring.
    pub spring: f64,
    /// Reduced tangential velocity w.
    pub velocity: f64,
}

/// Switches of which a collision allocates nothing: as many as it may have below κ = 240.
pub const FEW_SWITCHES: usize = 16;

/// The switches of a collision: a slice whose first [`FEW_SWITCHES`] lie in the collision itself.
pub type Switches = SmallVec<[Switch; FEW_SWITCHES]>;

/// The outcome of one collision in reduced variables.
///
/// The same type comes from the integrator and from the exact engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// The collision's parameters.
    pub contact: Contact,
    /// Coefficient of normal restitution ε_n = −ẋ(t_c)/ẋ(0).
    pub eps_n: f64,
    /// Reduced tangential velocity w at the end of contact; ε_t = w/ψ.
    pub final_velocity: f64,
    /// Scaled duration t_c of the contact.
    pub contact_time: f64,
    /// The regime in which the contact starts: slip without damping, stick with it.
    pub start: Regime,
    /// Every switch, in order of time.
    pub switches: Switches,
    /// Number of sign changes of the tangential velocity during contact.
    pub reversals: usize,
    /// Where the energy went.
    pub energy: EnergyLedger,
}

impl Collision {
    /// Coefficient of tangential restitution ε_t = g_t(t_c)/g_t(0); −1 is full reversal.
    #[must_use]
    pub fn eps_t(&self) -> f64 {
        self.final_velocity / self.contact.psi
    }

    /// One character a phase: `+` and `-` for slip on side ±1, `o` for stick.
    #[must_use]
    pub fn itinerary(&self) -> String {
        let start = match self.start {
            Regime::Slip => '+',
            Regime::Stick => 'o',
        };
        let entered = self.switches.iter().map(|switch| match (switch.to, switch.side) {
            (Regime::Stick, _) => 'o',
            (Regime::Slip, Side::Positive) => '+',
            (Regime::Slip, Side::Negative) => '-',
        });
        std::iter::once(start).chain(entered).collect()
    }
}
