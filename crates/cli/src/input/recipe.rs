//! Where the parameters of a contact come from: options, or columns of a file.

use stickslip_model::{Contact, Reduction};

use crate::input::parameter::{Parameter, Unacceptable};

/// Values given as options.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// `--kappa`.
    pub kappa: Option<f64>,
    /// `--psi`.
    pub psi: Option<f64>,
    /// `--ratio`.
    pub ratio: Option<f64>,
    /// `--mu`.
    pub mu: Option<f64>,
    /// `--alpha`.
    pub alpha: Option<f64>,
    /// `--damping`.
    pub damping: Option<f64>,
}

impl Given {
    fn get(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Kappa => self.kappa,
            Parameter::Psi => self.psi,
            Parameter::Ratio => self.ratio,
            Parameter::Mu => self.mu,
            Parameter::Alpha => self.alpha,
            Parameter::Damping => self.damping,
        }
    }
}

/// How to make a contact: one source for each parameter that it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    kappa: Source,
    impact: Impact,
    damping: Source,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Impact {
    Psi(Source),
    Ratio { ratio: Source, mu: Source, alpha: Source },
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Value(f64),
    Column { parameter: Parameter, index: usize },
}

impl Recipe {
    /// The recipe that options make, together with the columns of a file: `column` tells the place
    /// of a parameter's column.
    ///
    /// # Errors
    /// [`RecipeError`]: κ is missing, ψ or the ratio is missing or given twice, a value is given
    /// twice or would not be used.
    pub fn new(
        given: &Given,
        column: impl Fn(Parameter) -> Option<usize>,
    ) -> Result<Self, RecipeError> {
        let source = |parameter: Parameter| match (given.get(parameter), column(parameter)) {
            (Some(_), Some(_)) => Err(RecipeError::GivenTwice { name: parameter.name() }),
            (Some(value), None) => Ok(Some(Source::Value(value))),
            (None, Some(index)) => Ok(Some(Source::Column { parameter, index })),
            (None, None) => Ok(None),
        };
        let kappa = source(Parameter::Kappa)?.ok_or(RecipeError::NoKappa)?;
        let impact = match (source(Parameter::Psi)?, source(Parameter::Ratio)?) {
            (Some(_), Some(_)) => return Err(RecipeError::PsiAndRatio),
            (None, None) => return Err(RecipeError::NoImpact),
            (Some(psi), None) => {
                for parameter in [Parameter::Mu, Parameter::Alpha] {
                    if given.get(parameter).is_some() {
                        return Err(RecipeError::Unused { name: parameter.name() });
                    }
                }
                Impact::Psi(psi)
            }
            (None, Some(ratio)) => Impact::Ratio {
                ratio,
                mu: source(Parameter::Mu)?.unwrap_or(Source::Value(Reduction::default().mu)),
                alpha: source(Parameter::Alpha)?
                    .unwrap_or(Source::Value(Reduction::default().alpha)),
            },
        };
        let damping = source(Parameter::Damping)?.unwrap_or(Source::Value(0.0));
        Ok(Self { kappa, impact, damping })
    }

    /// The contact, with `field` giving the text in a column.
    ///
    /// # Errors
    /// [`ValueError`] names the parameter and its text or value.
    pub fn contact<'a>(&self, field: impl Fn(usize) -> &'a [u8]) -> Result<Contact, ValueError> {
        let value = |source: Source| match source {
            Source::Value(value) => Ok(value),
            Source::Column { parameter, index } => {
                let text = String::from_utf8_lossy(field(index));
                parameter.parse(&text).map_err(|problem| ValueError::Field {
                    name: parameter.name(),
                    text: quoted(&text),
                    problem,
                })
            }
        };
        let psi = match self.impact {
            Impact::Psi(psi) => value(psi)?,
            Impact::Ratio { ratio, mu, alpha } => {
                let ratio = value(ratio)?;
                let (alpha, mu) = (value(alpha)?, value(mu)?);
                Reduction { mu, alpha }.psi(ratio)
            }
        };
        let contact = Contact::new(value(self.kappa)?, psi, value(self.damping)?);
        // Every single value is in its range by now; what is left is ψ made from three of them.
        contact.map_err(|invalid| ValueError::Psi { psi, expected: invalid.expected })
    }
}

/// Options, or options and columns, do not make a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecipeError {
    /// Nothing gives κ.
    NoKappa,
    /// Nothing gives ψ or the ratio.
    NoImpact,
    /// Both are given.
    PsiAndRatio,
    /// An option repeats a column.
    GivenTwice {
        /// The parameter.
        name: &'static str,
    },
    /// An option has no effect.
    Unused {
        /// The parameter.
        name: &'static str,
    },
}

/// A value from which no contact can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// A field of a file is not expected.
    #[error("{name} = {text}: {problem}")]
    Field {
        /// The column.
        name: &'static str,
        /// What it holds.
        text: String,
        /// Why that is not expected.
        problem: Unacceptable,
    },
    /// Ratio, α and μ are each expected, but not the ψ that they make.
    #[error("psi = ratio·alpha/mu = {psi:?} is out of range; expected {expected}")]
    Psi {
        /// The value.
        psi: f64,
        /// What is expected.
        expected: &'static str,
    },
}

/// `text` such that it can be shown on a line of its own.
fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("'{shown}'")
}
