//! The parameters of a collision.

/// The parameters of one collision in scaled variables: stiffness, impact ratio and damping.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Contact {
    kappa: f64,
    psi: f64,
    damping: f64,
}

impl Contact {
    /// A collision with the scaled stiffness `kappa` = k_t/(α m β^{4/5} g_n^{2/5}) > 0, the impact
    /// ratio `psi` = (g_t/g_n) α/μ > 0 and the scaled damping `damping` = A β^{2/5} g_n^{1/5} ≥ 0.
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
    /// The range in words.
    pub expected: &'static str,
}
