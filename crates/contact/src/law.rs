//! A contact law as data.

use std::fmt;

use stickslip_solver::InvalidValue;

/// The terms of a contact law. [`Law::PAPER`] is that of Schwager, Becker and Pöschel; particle
/// codes compute others, which [`presets`](crate::presets) names.
///
/// In scaled units, with the overlap x, its rate v and the tangential velocity w:
///
/// ```text
/// dv/dt = −F     F = x or x^{3/2}, plus η v     η = a, a√x or a x^{1/4}
/// dw/dt = −Q     Q = k y + b η w     k = κ or κ√x     dy/dt = w
/// ```
///
/// A hysteretic force is x while the overlap grows, and (1 + a)(x − x₀) while it falls. b is the
/// tangential damping. Where |Q| would exceed |F|, dw/dt = −sgn(Q) |F|, and the history is
/// set such that Q has this size; with [`Friction`] that falls with the velocity, the limit is
/// a part of |F|. The source is the text of LAMMPS (29 Sep 2021):
/// `pair_gran_hooke_history`, `pair_gran_hertz_history` and `pair_granular`. Laws without history
/// have the dashpot alone, and in some codes Coulomb's limit holds for the spring alone:
/// [`CoulombTest`]. With adhesion, [`Normal::Dmt`] and [`Normal::Jkr`], the limit is another one.
///
/// ```
/// use stickslip_contact::{Contact, Law, Tangential};
///
/// let mindlin = Law { tangential: Tangential::Mindlin, ..Law::PAPER };
/// let contact = Contact::new(1.2, 0.3, 0.0)?.with_law(mindlin, 0.0)?;
/// // A spring that stiffens with the load is not conservative.
/// assert!(contact.law().spring_energy().creates());
/// # Ok::<(), stickslip_contact::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Law {
    /// The elastic part of the normal force.
    pub normal: Normal,
    /// The damping η of the normal force, or its hysteresis.
    pub damping: Damping,
    /// The stiffness k of the tangential spring.
    pub tangential: Tangential,
    /// What the spring remembers.
    pub history: HistoryOf,
    /// Whether the history shrinks with √x while the overlap falls.
    pub rescaled: bool,
    /// Whether the normal force is kept from attracting. Without effect where `end` is
    /// [`ContactEnd::Force`].
    pub limit_damping: bool,
    /// Where the contact ends.
    pub end: ContactEnd,
    /// What Coulomb's limit holds for.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "CoulombTest::is_usual"))]
    pub coulomb_test: CoulombTest,
    /// How the limit depends on the tangential velocity.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Friction::is_coulomb"))]
    pub friction: Friction,
    /// The force F_po that separates bodies with adhesion, as [`Normal`] has it; 0 without. In
    /// scaled units it is over m g_n and times the unit of time.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_zero"))]
    pub pull_off: f64,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The elastic part of the normal force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Normal {
    /// x.
    Linear,
    /// x^{3/2}.
    Hertz,
    /// x^{3/2} − F_po, with the adhesion of Derjaguin, Muller and Toporov: F_po = 4πγR, where 2γ is
    /// the work of adhesion. The contact begins and ends at x = 0.
    ///
    /// Here and in [`Self::Jkr`] Coulomb's limit holds for the elastic force plus twice F_po,
    /// without damping, and r, the contact radius in scaled units, stands for √x: r = √x in DMT.
    /// Source: LAMMPS, `gran_sub_mod_normal.cpp`; F_po + F in the sense of Thornton (1991).
    Dmt,
    /// r³ − (3/2) c r^{3/2}, with the adhesion of Johnson, Kendall and Roberts: x = r² − c √r,
    /// F_po = (9/16) c² = 3πγR. The contact begins at x = 0 with the force −(8/9) F_po, and ends at
    /// a negative overlap, where [`ContactEnd`] says.
    Jkr,
}

impl Normal {
    /// Whether the bodies attract each other by adhesion.
    pub fn is_adhesive(self) -> bool {
        matches!(self, Self::Dmt | Self::Jkr)
    }
}

/// How the normal force loses energy: its damping η, or hysteresis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Damping {
    /// 0.
    None,
    /// a.
    Linear,
    /// a √x.
    Viscoelastic,
    /// a x^{1/4}.
    Tsuji,
    /// 0: the force is hysteretic. Behind greatest compression it falls to 0 at the overlap x₀ that
    /// is left, F = (1 + a)(x − x₀) or (1 + a)(x − x₀)^{3/2}. For a linear force this is the law of
    /// Walton and Braun, J. Rheol. 30, 949 (1986), with the stiffnesses k₁ while the overlap grows
    /// and k₂ = (1 + a) k₁ while it falls, and ε_n = √(k₁/k₂).
    Hysteretic,
    /// As [`Self::Hysteretic`], but a is proportional to the greatest overlap, and so to the normal
    /// velocity where the force is linear: the law of Luding, Granular Matter 10, 235 (2008),
    /// without adhesion and below its largest stiffness, and Walton's and Braun's with
    /// k₂ = k₁ + S F.
    Hardening,
    /// 0: the bodies yield. With a = g_n/v_y above 1, where v_y is the least normal velocity at
    /// which they do, the force follows its tangent behind the overlap x_y = (5/4a²)^{2/5}, and
    /// while the overlap falls, it is that of Hertz with a larger radius, √r (x − x₀)^{3/2}.
    /// Only for [`Normal::Hertz`]. This is the law of Thornton, J. Appl. Mech. 64, 383 (1997),
    /// with a tangential spring of constant stiffness or of Mindlin's, where the contact radius
    /// while the overlap falls is √(r (x − x₀)).
    Yielding,
}

impl Damping {
    /// Whether the force depends on the rate of the overlap.
    pub fn is_viscous(self) -> bool {
        matches!(self, Self::Linear | Self::Viscoelastic | Self::Tsuji)
    }

    /// Whether the force is another one while the overlap falls.
    pub fn is_hysteretic(self) -> bool {
        matches!(self, Self::Hysteretic | Self::Hardening | Self::Yielding)
    }
}

/// The stiffness k of the tangential spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Tangential {
    /// κ.
    Constant,
    /// κ √x.
    Mindlin,
}

/// What the spring remembers. With a constant stiffness displacement and force mean the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum HistoryOf {
    /// Its elongation y, with dy/dt = w and the force k y.
    Displacement,
    /// Its force q, with dq/dt = k w.
    Force,
    /// Nothing: there is no spring, and Q = b η w. κ has no effect.
    None,
}

/// What Coulomb's limit holds for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum CoulombTest {
    /// Spring and dashpot together.
    #[default]
    Total,
    /// The spring alone. The dashpot acts in stick, where the force may exceed the limit, and not
    /// in slip.
    Spring,
}

impl CoulombTest {
    #[cfg(feature = "serde")]
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_usual(&self) -> bool {
        *self == Self::Total
    }
}

/// Friction that falls with the tangential velocity, from μ_s at rest to μ_d.
///
/// The limit is μ(w) |F| with μ(w) = μ_d + (μ_s − μ_d) e^(−B |w|), at every moment, in stick too,
/// where w is that of the surfaces: a spring that sticks is stretched with it. So slip begins
/// where |Q| would exceed μ(w) |F|, and ends as with one coefficient, where the spring would fall
/// behind the limit; w need not be 0 there. In scaled units μ_s is 1, also in ψ = (g_t/g_n) α/μ_s.
///
/// Source: Kratos Multiphysics, `DEM_D_Hertz_viscous_Coulomb_CL.cpp` (commit 03f57bf, with
/// `STATIC_FRICTION`, `DYNAMIC_FRICTION` and `FRICTION_DECAY`), as of its pull request 8518.
/// Before it, and in MercuryDPM (`SlidingFrictionInteraction.cc`), the limit jumps from μ_s |F| to
/// μ_d |F| and the spring with it. It sticks again in the next step, so that the force swings
/// between both limits, infinitely often at the start of a contact that begins in slip: what comes
/// of that depends on the time step, and has no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Friction {
    /// μ_d/μ_s, from 0 to 1.
    pub dynamic: f64,
    /// The decay B, 0 or above: in SI units it is β μ_s g_n/α, where β is that of
    /// e^(−β |g|) in s/m.
    pub decay: f64,
}

impl Default for Friction {
    fn default() -> Self {
        Self::COULOMB
    }
}

impl Friction {
    /// One coefficient.
    pub const COULOMB: Self = Self { dynamic: 1.0, decay: 0.0 };

    /// Whether the coefficient is the same at all velocities.
    pub fn is_constant(&self) -> bool {
        self.dynamic == 1.0 || self.decay == 0.0
    }

    /// μ(w)/μ_s at the reduced velocity `w`.
    pub fn share(&self, w: f64) -> f64 {
        self.dynamic + (1.0 - self.dynamic) * (-self.decay * w.abs()).exp()
    }

    #[cfg(feature = "serde")]
    fn is_coulomb(&self) -> bool {
        *self == Self::COULOMB
    }
}

/// Where a contact ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum ContactEnd {
    /// Where the normal force would begin to attract; in [`Normal::Jkr`] where it attracts most,
    /// F = −F_po and x = −(c/4) (3c/4)^{1/3}, as bodies part that are pulled with a given force.
    Force,
    /// Where the overlap vanishes; in [`Normal::Jkr`] where it is least, x = −3 (c/4)^{4/3} and
    /// F = −(5/9) F_po, beyond which no contact is in equilibrium.
    Overlap,
}

/// What becomes of the energy in the tangential spring while it sticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpringEnergy {
    /// It comes back.
    Conserved,
    /// Part of it is lost, and none created.
    Lost,
    /// It grows by itself while the overlap grows.
    CreatedLoading,
    /// It grows by itself while the overlap falls.
    CreatedUnloading,
    /// There is no spring.
    Absent,
}

impl SpringEnergy {
    /// Whether the spring creates energy.
    pub fn creates(self) -> bool {
        matches!(self, Self::CreatedLoading | Self::CreatedUnloading)
    }
}

impl fmt::Display for SpringEnergy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Conserved => "conserves energy",
            Self::Lost => "loses energy",
            Self::CreatedLoading => "creates energy while loading",
            Self::CreatedUnloading => "creates energy while unloading",
            Self::Absent => "is absent",
        })
    }
}

impl Default for Law {
    fn default() -> Self {
        Self::PAPER
    }
}

impl Law {
    /// The law of Schwager, Becker and Pöschel.
    pub const PAPER: Self = Self {
        normal: Normal::Hertz,
        damping: Damping::Viscoelastic,
        tangential: Tangential::Constant,
        history: HistoryOf::Displacement,
        rescaled: false,
        limit_damping: false,
        end: ContactEnd::Force,
        coulomb_test: CoulombTest::Total,
        friction: Friction::COULOMB,
        pull_off: 0.0,
    };

    /// The equations in scaled units, in one line.
    pub fn equations(&self) -> String {
        let elastic = match self.normal {
            Normal::Linear => "x",
            Normal::Hertz => "x^(3/2)",
            Normal::Dmt => "x^(3/2) − F_po",
            Normal::Jkr => "r³ − 2 √F_po r^(3/2)",
        };
        let root = if self.normal == Normal::Jkr { "r" } else { "√x" };
        let eta = match self.damping {
            Damping::None | Damping::Hysteretic | Damping::Hardening | Damping::Yielding => "",
            Damping::Linear => "a",
            Damping::Viscoelastic if self.normal == Normal::Jkr => "a r",
            Damping::Viscoelastic => "a √x",
            Damping::Tsuji => "a x^(1/4)",
        };
        let damped = self.damping.is_viscous();
        let normal = match (damped, self.limit_damping && self.end == ContactEnd::Overlap) {
            _ if self.damping == Damping::Yielding => {
                let force = "F = x^(3/2), x_y^(1/2) (3x − x_y)/2 where x > x_y, √r (x − x₀)^(3/2) \
                             where v < 0";
                let mindlin = self.tangential == Tangential::Mindlin && self.remembers();
                let radius =
                    if mindlin { "; r_c = √x, √(r (x − x₀)) where v < 0" } else { "" };
                format!("{force}{radius}")
            }
            _ if self.damping.is_hysteretic() => {
                let falling = match self.normal {
                    Normal::Linear => "(1 + a)(x − x₀)",
                    _ => "(1 + a)(x − x₀)^(3/2)",
                };
                format!("F = {elastic}, {falling} where v < 0")
            }
            (false, _) => format!("F = {elastic}"),
            (true, false) => format!("F = {elastic} + {eta} v"),
            (true, true) => format!("F = max(0, {elastic} + {eta} v)"),
        };
        let overlap =
            if self.normal == Normal::Jkr { "x = r² − (4/3) √(F_po r), " } else { "" };
        let stiffness = match self.tangential {
            Tangential::Constant => "κ".to_owned(),
            Tangential::Mindlin if self.damping == Damping::Yielding => "κ r_c".to_owned(),
            Tangential::Mindlin => format!("κ {root}"),
        };
        let tested = self.coulomb_test == CoulombTest::Total;
        let dashpot = if damped && tested { format!(" + b {eta} w") } else { String::new() };
        let rescaled = |history| match self.normal {
            _ if !self.rescaled => String::new(),
            Normal::Jkr => format!(" (+ {history} (dr/dt)/r where v < 0)"),
            _ => format!(" (+ {history} v/(2x) where v < 0)"),
        };
        let tangential = match self.history {
            HistoryOf::Displacement => {
                format!("Q = {stiffness} y{dashpot}, dy/dt = w{}", rescaled("y"))
            }
            HistoryOf::Force => {
                format!("Q = q{dashpot}, dq/dt = {stiffness} w{}", rescaled("q"))
            }
            HistoryOf::None if damped => format!("Q = b {eta} w"),
            HistoryOf::None => "Q = 0".to_owned(),
        };
        let beside = if damped && !tested && self.remembers() {
            format!("; in stick b {eta} w beside Q")
        } else {
            String::new()
        };
        let end = match self.end {
            ContactEnd::Force if self.normal == Normal::Jkr => "F = −F_po",
            ContactEnd::Overlap if self.normal == Normal::Jkr => "dx/dr = 0",
            ContactEnd::Force => "F = 0",
            ContactEnd::Overlap => "x = 0",
        };
        let limit = if self.normal.is_adhesive() {
            let dmt = self.normal == Normal::Dmt;
            if dmt { "x^(3/2) + F_po" } else { "r³ − 2 √F_po r^(3/2) + 2 F_po" }.to_owned()
        } else if self.friction.is_constant() {
            "|F|".to_owned()
        } else {
            let Friction { dynamic, decay } = self.friction;
            format!("({dynamic} + {} e^(−{decay} |w|)) |F|", 1.0 - dynamic)
        };
        format!("{overlap}{normal}; {tangential}; |Q| ≤ {limit}{beside}; ends at {end}")
    }

    /// The law without the spring: what becomes of the law as κ vanishes.
    #[must_use]
    pub fn without_spring(self) -> Self {
        Self { history: HistoryOf::None, ..self }
    }

    /// Whether there is a spring.
    pub fn remembers(&self) -> bool {
        self.history != HistoryOf::None
    }

    /// The part of the tangential damping b that Coulomb's limit holds for.
    pub(crate) fn tested_damping(self, tangential_damping: f64) -> f64 {
        let tested = self.coulomb_test == CoulombTest::Total || !self.remembers();
        if tested { tangential_damping } else { 0.0 }
    }

    /// Refuses a law with adhesion, for which `what` is not computed.
    ///
    /// # Errors
    /// [`InvalidValue`]: the bodies attract each other.
    pub fn require_no_adhesion(&self, what: &str) -> Result<(), InvalidValue> {
        if !self.normal.is_adhesive() {
            return Ok(());
        }
        let expected =
            format!("a law without it: {what} not computed for bodies that may stay together");
        Err(InvalidValue::phrase("the law", "has adhesion", expected))
    }

    /// What becomes of the energy in the tangential spring while it sticks.
    ///
    /// With the stiffness k(x) a spring with the force Q holds Q²/(2k). Where the elongation y is
    /// kept, its change is Q w + y² k'v/2, and where the force is kept, Q w − Q² k'v/(2k²). A
    /// history that is rescaled while the overlap falls adds Q² v/(2kx) to either, which is
    /// negative and, where the force is kept, twice what the falling stiffness creates.
    pub fn spring_energy(&self) -> SpringEnergy {
        match (self.tangential, self.history, self.rescaled) {
            (_, HistoryOf::None, _) => SpringEnergy::Absent,
            (Tangential::Constant, _, false) => SpringEnergy::Conserved,
            (Tangential::Constant, _, true) | (_, HistoryOf::Force, true) => SpringEnergy::Lost,
            (_, HistoryOf::Displacement, _) => SpringEnergy::CreatedLoading,
            (_, HistoryOf::Force, false) => SpringEnergy::CreatedUnloading,
        }
    }

    /// Whether a contact with this law and these dampings obeys the paper's: terms that differ
    /// have no effect on it.
    pub fn acts_as_paper(&self, damping: f64, tangential_damping: f64) -> bool {
        let elastic = self.normal == Normal::Hertz
            && self.tangential == Tangential::Constant
            && self.remembers()
            && !self.rescaled
            && self.friction.is_constant();
        let damped = self.damping == Damping::Viscoelastic
            && tangential_damping == 0.0
            && self.end == ContactEnd::Force;
        elastic && (damping == 0.0 || damped)
    }

    /// The least damping with which a contact never ends, because an attracting tail holds it
    /// for ever; infinite where all contacts end.
    ///
    /// With x = uⁿ the end is a line that every trajectory crosses, unless one arrives at u = 0
    /// with v = 0. For linear damping of a linear force that is known from its sines, for Tsuji's
    /// of Hertz' force from v = −A x^{5/4}, 5A²/4 − aA + 1 = 0. For linear damping of Hertz' force
    /// the last trajectory to escape arrives along v = −a x. No other law has a trajectory that
    /// arrives.
    pub fn endless_from(&self) -> f64 {
        if self.limit_damping || self.end == ContactEnd::Force {
            return f64::INFINITY;
        }
        match (self.normal, self.damping) {
            (Normal::Linear, Damping::Linear) => 2.0,
            (Normal::Hertz, Damping::Tsuji) => 5.0_f64.sqrt(),
            (Normal::Hertz, Damping::Linear) => HERTZ_LINEAR,
            _ => f64::INFINITY,
        }
    }
}

/// The damping from which Hertz' force with linear damping has contacts that never end: there the
/// trajectory that arrives at x = 0 along v = −a x starts from x = 0 with v = 1. By a Taylor
/// integration with 30 digits: `tests/data/endless_contacts.py`.
const HERTZ_LINEAR: f64 = 1.127_988_135_520_169_2;
