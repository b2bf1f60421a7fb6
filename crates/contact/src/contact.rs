//! The parameters of a collision.

use stickslip_solver::InvalidValue;

use crate::law::{ContactEnd, CoulombTest, Damping, Friction, Law, Normal, Tangential};

/// The parameters of one collision in scaled variables: stiffness, impact ratio and damping.
///
/// Scaled units: time β^{−2/5} g_n^{−1/5}, length g_n^{4/5} β^{−2/5}, with β = ρ/m.
///
/// ```
/// use stickslip_contact::Contact;
///
/// let contact = Contact::new(63.0, 0.5, 0.0)?;
/// assert_eq!(contact.kappa(), 63.0);
/// assert!(Contact::new(-1.0, 0.5, 0.0).is_err());
/// # Ok::<(), stickslip_contact::InvalidValue>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    kappa: f64,
    psi: f64,
    damping: f64,
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_zero"))]
    tangential_damping: f64,
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_paper"))]
    law: Law,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

#[cfg(feature = "serde")]
fn is_paper(law: &Law) -> bool {
    *law == Law::PAPER
}

impl Contact {
    /// A collision with the scaled stiffness `kappa` = k_t/(α m β^{4/5} g_n^{2/5}) ≥ 0, the impact
    /// ratio `psi` = (g_t/g_n) α/μ > 0 and the scaled damping `damping` = A β^{2/5} g_n^{1/5} ≥ 0.
    ///
    /// With κ = 0 there is no spring, whatever the law, and ε_t = 1: this is the limit of small κ
    /// without a tangential dashpot. With one, κ = 0 is refused in laws with history.
    ///
    /// # Errors
    /// [`InvalidValue`] names the first parameter that is out of its range.
    pub fn new(kappa: f64, psi: f64, damping: f64) -> Result<Self, InvalidValue> {
        in_range("kappa", kappa, "a finite number, 0 or above", kappa >= 0.0)?;
        in_range("psi", psi, "a finite number above 0", psi > 0.0)?;
        in_range("damping", damping, "a finite number, 0 or above", damping >= 0.0)?;
        let law = if kappa == 0.0 { Law::PAPER.without_spring() } else { Law::PAPER };
        Ok(Self { kappa, psi, damping, tangential_damping: 0.0, law })
    }

    /// The same collision with another law, and with the tangential damping b =
    /// (γ_t/γ_n)/α ≥ 0, which is a ratio of the two damping constants.
    ///
    /// # Errors
    /// [`InvalidValue`]: the tangential damping is out of its range, also for κ = 0 and hysteretic
    /// forces, the damping has no effect in this law, a contact with this damping never ends, the
    /// force is hysteretic and the spring depends on the overlap, a number of [`Friction`] is out
    /// of its range, also for a dashpot beside Coulomb's limit, or a term has no meaning beside
    /// adhesion.
    pub fn with_law(self, law: Law, tangential_damping: f64) -> Result<Self, InvalidValue> {
        let Self { damping, kappa, .. } = self;
        let ok = tangential_damping >= 0.0;
        in_range("tangential_damping", tangential_damping, "a finite number, 0 or above", ok)?;
        let ok = damping == 0.0 || law.damping != Damping::None;
        in_range("damping", damping, "0, since this law has no damping", ok)?;
        let expected = match law.endless_from() {
            2.0 => "less than 2: from there on contacts of this law never end",
            least if least > 2.0 => {
                "less than 2.2360679774997896: from there on contacts of this law never end"
            }
            _ => "less than 1.1279881355201692: from there on contacts of this law never end",
        };
        in_range("damping", damping, expected, damping < law.endless_from())?;
        let Friction { dynamic, decay } = law.friction;
        in_range("dynamic", dynamic, "a number from 0 to 1", (0.0..=1.0).contains(&dynamic))?;
        in_range("decay", decay, "a finite number, 0 or above", decay >= 0.0)?;
        if law.coulomb_test == CoulombTest::Spring && !law.friction.is_constant() {
            let ok = !law.remembers() || damping * tangential_damping == 0.0;
            let expected = "0: where Coulomb's limit holds for the spring alone, a dashpot beside \
                            it changes the limit of a friction that decays, which is not computed";
            in_range("tangential_damping", tangential_damping, expected, ok)?;
        }
        if law.damping.is_hysteretic() {
            let ok = tangential_damping == 0.0;
            let expected = "0, since a hysteretic force has no dashpot";
            in_range("tangential_damping", tangential_damping, expected, ok)?;
            // The contact radius of yielded bodies is known, and that of others is no term.
            let steady = law.damping == Damping::Yielding && law.tangential == Tangential::Mindlin
                || law.tangential == Tangential::Constant && !law.rescaled;
            let elastic = law.damping != Damping::Yielding || law.normal == Normal::Hertz;
            if !elastic {
                let phrase = "yields, and its force is not that of Hertz";
                return Err(InvalidValue::phrase("the law", phrase, "a force of Hertz"));
            }
            if law.remembers() && !steady {
                let phrase = "has a hysteretic force and a spring that depends on the overlap";
                let expected = "a spring of constant stiffness that is not rescaled, or Mindlin's \
                                of bodies that yield, whose contact radius is known";
                return Err(InvalidValue::phrase("the law", phrase, expected));
            }
        }
        adhesion(&law)?;
        if kappa > 0.0 {
            return Ok(Self { tangential_damping, law, ..self });
        }
        let expected = "0 where kappa = 0, or a law without history: what a slip with a dashpot \
                        sets a spring to would stay for ever";
        let ok = !law.remembers() || damping * tangential_damping == 0.0;
        in_range("tangential_damping", tangential_damping, expected, ok)?;
        Ok(Self { tangential_damping, law: law.without_spring(), ..self })
    }

    /// The same collision without friction, μ = 0: there is no tangential force, and ε_t = 1. In
    /// the place of ψ, which would be infinite, is the impact ratio g_t/g_n times α.
    ///
    /// ```
    /// use stickslip_contact::{Contact, HistoryOf};
    ///
    /// let contact = Contact::new(63.0, 0.5, 0.1)?.without_friction();
    /// assert_eq!(contact.law().history, HistoryOf::None);
    /// # Ok::<(), stickslip_contact::InvalidValue>(())
    /// ```
    #[must_use]
    pub fn without_friction(self) -> Self {
        let law = Law { friction: Friction::COULOMB, ..self.law.without_spring() };
        Self { tangential_damping: 0.0, law, ..self }
    }

    /// The same κ, ψ and damping with the paper's law.
    pub(crate) fn with_paper_law(self) -> Self {
        Self { tangential_damping: 0.0, law: Law::PAPER, ..self }
    }

    /// Scaled stiffness κ of the tangential spring.
    pub fn kappa(&self) -> f64 {
        self.kappa
    }

    /// κ, or 1 where it is 0: by this and μ the tangential forces at switches are divided.
    pub fn force_unit(&self) -> f64 {
        if self.kappa > 0.0 { self.kappa } else { 1.0 }
    }

    /// Reduced impact ratio ψ = (g_t/g_n) α/μ.
    pub fn psi(&self) -> f64 {
        self.psi
    }

    /// Scaled damping a of the normal force; where it is hysteretic, k₂/k₁ − 1, or
    /// g_n/v_y where it yields.
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// Tangential damping b = (γ_t/γ_n)/α; 0 in the paper's law.
    pub fn tangential_damping(&self) -> f64 {
        self.tangential_damping
    }

    /// The contact law.
    pub fn law(&self) -> Law {
        self.law
    }

    /// Whether the paper's law holds: that is the law, or it differs in terms without effect.
    pub fn obeys_paper(&self) -> bool {
        self.law.acts_as_paper(self.damping, self.tangential_damping)
    }

    /// Checks that the paper's law holds, for `what` is computed for no other.
    ///
    /// # Errors
    /// [`OtherLaw`] unless [`Self::obeys_paper`].
    pub fn require_paper(&self, what: &'static str) -> Result<(), OtherLaw> {
        if self.obeys_paper() { Ok(()) } else { Err(OtherLaw { what }) }
    }
}

/// Checks the pull-off force of a law, and the terms beside it: LAMMPS combines adhesion with no
/// others.
fn adhesion(law: &Law) -> Result<(), InvalidValue> {
    let Law { pull_off, damping, .. } = *law;
    if !law.normal.is_adhesive() {
        let expected = "0, since this law has no adhesion";
        return in_range("pull_off", pull_off, expected, pull_off == 0.0);
    }
    let expected = "a finite number above 0: without pull-off the law is one of Hertz' force";
    in_range("pull_off", pull_off, expected, pull_off > 0.0)?;
    let beside = [
        (
            matches!(damping, Damping::None | Damping::Linear | Damping::Viscoelastic),
            "and a damping that is neither linear nor viscoelastic",
        ),
        (!law.limit_damping, "and a force that is kept from attracting"),
        (
            law.normal == Normal::Jkr || law.end == ContactEnd::Overlap,
            "and ends at a force, where DMT ends at x = 0",
        ),
        (law.coulomb_test == CoulombTest::Total, "and a Coulomb test of the spring alone"),
        (law.friction.is_constant(), "and a friction that depends on the velocity"),
    ];
    match beside.into_iter().find(|(ok, _)| !ok) {
        Some((_, what)) => {
            let phrase = format!("has adhesion {what}");
            Err(InvalidValue::phrase("the law", phrase, "terms that LAMMPS combines with adhesion"))
        }
        None => Ok(()),
    }
}

fn in_range(
    name: &'static str,
    value: f64,
    expected: &'static str,
    ok: bool,
) -> Result<(), InvalidValue> {
    InvalidValue::check(name, value, expected, ok && value.is_finite())
}

/// What was asked for is computed for the paper's contact law only.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{what} of a collision is computed for the paper's contact law only")]
pub struct OtherLaw {
    /// What was asked for.
    pub what: &'static str,
}
