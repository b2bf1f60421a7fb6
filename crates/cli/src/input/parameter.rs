//! The parameters of a collision as they are named and bounded on the command line and in files.

use stickslip_model::Contact;

use crate::input::number::{self, NotANumber};

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
}

impl Parameter {
    /// Name of the column; the option is `--` and the same.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kappa => "kappa",
            Self::Psi => "psi",
            Self::Ratio => "ratio",
            Self::Mu => "mu",
            Self::Alpha => "alpha",
            Self::Damping => "damping",
        }
    }

    /// The value in `text`.
    ///
    /// # Errors
    /// [`Unacceptable`]: not a number, or out of the parameter's range.
    pub fn parse(self, text: &str) -> Result<f64, Unacceptable> {
        let value = number::parse(text)
            .map_err(|problem| Unacceptable::Number { problem, expected: self.expected() })?;
        match self.objection(value) {
            None => Ok(value),
            Some(expected) => Err(Unacceptable::Range { expected }),
        }
    }

    /// What is expected.
    fn expected(self) -> &'static str {
        // No parameter accepts NaN, so that every range answers here.
        self.objection(f64::NAN).unwrap_or("a finite number")
    }

    /// What is expected, if `value` is not. The model's own ranges come from the model.
    fn objection(self, value: f64) -> Option<&'static str> {
        let positive =
            |value: f64| (!(value > 0.0 && value.is_finite())).then_some("a finite number above 0");
        let contact = match self {
            Self::Ratio | Self::Mu => return positive(value),
            Self::Alpha => {
                return (!(value > 0.0 && value <= 1.0)).then_some("a number above 0, at most 1");
            }
            Self::Kappa => Contact::new(value, 1.0, 0.0),
            Self::Psi => Contact::new(1.0, value, 0.0),
            Self::Damping => Contact::new(1.0, 1.0, value),
        };
        contact.err().map(|invalid| invalid.expected)
    }
}

/// Why a text is not expected as a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unacceptable {
    /// Not a number.
    #[error("{problem}; expected {expected}, written like 18, 1.5e3 or 2/7")]
    Number {
        /// What is wrong with it.
        problem: NotANumber,
        /// What is expected.
        expected: &'static str,
    },
    /// A number out of range.
    #[error("out of range; expected {expected}")]
    Range {
        /// What is expected.
        expected: &'static str,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_has_a_range() {
        use Parameter::{Alpha, Damping, Kappa, Mu, Psi, Ratio};
        for parameter in [Kappa, Psi, Ratio, Mu, Alpha, Damping] {
            assert!(parameter.objection(f64::NAN).is_some(), "{parameter:?}");
            assert!(parameter.parse("-1").is_err(), "{parameter:?}");
            assert!(parameter.parse("1").is_ok(), "{parameter:?}");
            assert_eq!(parameter.parse("0").is_ok(), parameter == Parameter::Damping);
        }
        assert!(Parameter::Alpha.parse("1.0000001").is_err());
    }
}
