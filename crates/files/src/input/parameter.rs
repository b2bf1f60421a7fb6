//! The parameters of a collision: their names and ranges on the command line and in files.

use std::borrow::Cow;

use stickslip_model::spheres::quantity;
use stickslip_model::spheres::quantity::PhysicalQuantity;
use stickslip_model::{Contact, Law};

use crate::input::number::{self, SYNTAX};

/// A parameter that an option or a column may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Scaled stiffness κ of the tangential spring.
    Kappa,
    /// Reduced impact ratio ψ.
    Psi,
    /// Impact ratio g_t/g_n.
    Ratio,
    /// Coefficient of friction μ.
    Mu,
    /// Tangential inertia α.
    Alpha,
    /// Scaled damping a.
    Damping,
    /// Coefficient of normal restitution, instead of the damping.
    NormalRestitution,
    /// Tangential damping (γ_t/γ_n)/α.
    TangentialDamping,
}

impl Parameter {
    /// The name of the column. The name of the option is the same after `--`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kappa => "kappa",
            Self::Psi => "psi",
            Self::Ratio => "ratio",
            Self::Mu => "mu",
            Self::Alpha => "alpha",
            Self::Damping => "damping",
            Self::NormalRestitution => quantity::NORMAL_RESTITUTION.name,
            Self::TangentialDamping => "tangential_damping",
        }
    }

    /// The value in `text`.
    ///
    /// # Errors
    /// The text is not a number, or out of the parameter's range.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        checked(text, &self.expected(), |value| self.check(value).is_ok())
    }

    /// The value in `text`, which must be above 0: what vanishes there has no limit to compare.
    ///
    /// # Errors
    /// The text is not a number above 0 in the parameter's range.
    pub fn parse_positive(self, text: &str) -> Result<f64, String> {
        let accepts = |value: f64| value > 0.0 && self.check(value).is_ok();
        checked(text, "a finite number above 0", accepts)
    }

    /// `value`, if it is in the parameter's range. The model decides on the ranges that it knows.
    ///
    /// # Errors
    /// What is expected.
    pub fn check(self, value: f64) -> Result<f64, Cow<'static, str>> {
        let contact = match self {
            Self::Kappa => Contact::new(value, 1.0, 0.0),
            Self::Psi => Contact::new(1.0, value, 0.0),
            Self::Damping => Contact::new(1.0, 1.0, value),
            Self::TangentialDamping => {
                Contact::new(1.0, 1.0, 0.0).and_then(|it| it.with_law(Law::PAPER, value))
            }
            Self::Mu => return quantity::FRICTION.check(value).map_err(|error| error.expected),
            Self::Ratio => {
                let ok = value > 0.0 && value.is_finite();
                return if ok { Ok(value) } else { Err("a finite number above 0".into()) };
            }
            Self::Alpha => return quantity::INERTIA.check(value).map_err(|error| error.expected),
            Self::NormalRestitution => {
                return quantity::NORMAL_RESTITUTION.check(value).map_err(|error| error.expected);
            }
        };
        contact.map(|_| value).map_err(|invalid| invalid.expected)
    }

    /// The range, for messages.
    fn expected(self) -> Cow<'static, str> {
        // NaN is in no range, so that each parameter answers here.
        self.check(f64::NAN).err().unwrap_or("a finite number".into())
    }
}

/// The value of a quantity in SI units in `text`.
///
/// # Errors
/// The text is not a number, or out of the quantity's range.
pub fn quantity(quantity: &PhysicalQuantity, text: &str) -> Result<f64, String> {
    checked(text, quantity.expected, |value| quantity.check(value).is_ok())
}

/// The number in `text`, if `accepts` accepts it.
fn checked(text: &str, expected: &str, accepts: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value = number::parse(text)
        .map_err(|problem| format!("{problem}; expected {expected}, {SYNTAX}"))?;
    if accepts(value) { Ok(value) } else { Err(format!("out of range; expected {expected}")) }
}
