//! The sources of the parameters of a contact: options, or columns of a file.

use std::fmt::Display;

use stickslip_model::restitution;
use stickslip_model::{Contact, InvalidValue, Law, Reduction};

use crate::input::parameter::Parameter;

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
    /// `--e-n`.
    pub e_n: Option<f64>,
    /// `--tangential-damping`.
    pub tangential_damping: Option<f64>,
    /// `--law`.
    pub law: Law,
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
            Parameter::NormalRestitution => self.e_n,
            Parameter::TangentialDamping => self.tangential_damping,
        }
    }
}

/// How to make a contact: one source for each parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    kappa: Source,
    impact: ImpactParameter<Source>,
    /// Used with the impact ratio only, and so is `alpha`.
    mu: Source,
    alpha: Source,
    damping: DampingSource,
    tangential_damping: Source,
    law: Law,
}

/// The parameter that gives the impact ratio, in either of two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImpactParameter<T> {
    /// The reduced impact ratio ψ.
    Psi(T),
    /// The impact ratio g_t/g_n, which μ and α reduce to ψ.
    Ratio(T),
}

/// What gives the damping.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DampingSource {
    Scaled(Source),
    /// The coefficient of normal restitution.
    Restitution(Source),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Value(f64),
    Column { parameter: Parameter, index: usize },
}

impl<T> ImpactParameter<T> {
    /// The one of ψ and the ratio that is given, where options give μ and α.
    ///
    /// # Errors
    /// [`RecipeError`]: none of them is given, or both are, or μ or α would not be used.
    pub fn new(
        (psi, ratio): (Option<T>, Option<T>),
        (mu, alpha): (Option<f64>, Option<f64>),
    ) -> Result<Self, RecipeError> {
        match (psi, ratio) {
            (Some(_), Some(_)) => Err(RecipeError::PsiAndRatio),
            (None, None) => Err(RecipeError::NoImpact),
            (Some(_), None) if mu.is_some() => {
                Err(RecipeError::Unused { name: Parameter::Mu.name() })
            }
            (Some(_), None) if alpha.is_some() => {
                Err(RecipeError::Unused { name: Parameter::Alpha.name() })
            }
            (Some(psi), None) => Ok(Self::Psi(psi)),
            (None, Some(ratio)) => Ok(Self::Ratio(ratio)),
        }
    }
}

impl Recipe {
    /// The recipe that options make together with the columns of a file. `column` gives the index
    /// of a parameter's column.
    ///
    /// # Errors
    /// [`RecipeError`]: κ is missing where the law has a spring, exactly one of ψ and the ratio is
    /// not given, or a value is given twice or would not be used.
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
        // Without a spring κ has no effect.
        let any = (!given.law.remembers()).then_some(Source::Value(1.0));
        let kappa = source(Parameter::Kappa)?.or(any).ok_or(RecipeError::NoKappa)?;
        let forms = (source(Parameter::Psi)?, source(Parameter::Ratio)?);
        let impact = ImpactParameter::new(forms, (given.mu, given.alpha))?;
        let usual = Reduction::default();
        let mu = source(Parameter::Mu)?.unwrap_or(Source::Value(usual.mu));
        let alpha = source(Parameter::Alpha)?.unwrap_or(Source::Value(usual.alpha));
        let damping = match (source(Parameter::Damping)?, source(Parameter::NormalRestitution)?) {
            (Some(_), Some(_)) => return Err(RecipeError::DampingTwice),
            (damping, None) => DampingSource::Scaled(damping.unwrap_or(Source::Value(0.0))),
            (None, Some(e_n)) => DampingSource::Restitution(e_n),
        };
        let tangential_damping =
            source(Parameter::TangentialDamping)?.unwrap_or(Source::Value(0.0));
        let law = given.law;
        Ok(Self { kappa, impact, mu, alpha, damping, tangential_damping, law })
    }

    /// The contact. `field` gives the text in a column.
    ///
    /// # Errors
    /// The text names the parameter and its text or value.
    pub fn contact<'a>(&self, field: impl Fn(usize) -> &'a [u8]) -> Result<Contact, String> {
        let value = |source: Source| match source {
            Source::Value(value) => Ok(value),
            Source::Column { parameter, index } => {
                let text = String::from_utf8_lossy(field(index));
                let name = parameter.name();
                let field = |problem| format!("{name} = {}: {problem}", quoted(&text));
                parameter.parse(&text).map_err(field)
            }
        };
        let said = |error: &dyn Display| error.to_string();
        let (psi, rubs) = match self.impact {
            ImpactParameter::Psi(psi) => (value(psi)?, true),
            ImpactParameter::Ratio(ratio) => {
                let ratio = value(ratio)?;
                let (alpha, mu) = (value(self.alpha)?, value(self.mu)?);
                (reduced(&Reduction { mu, alpha }, ratio)?, mu > 0.0)
            }
        };
        let tangential_damping = value(self.tangential_damping)?;
        let damping = match self.damping {
            DampingSource::Scaled(damping) => value(damping)?,
            DampingSource::Restitution(e_n) => {
                restitution::damping(self.law, value(e_n)?).map_err(|error| said(&error))?
            }
        };
        let contact = Contact::new(value(self.kappa)?, psi, damping);
        contact
            .and_then(|contact| contact.with_law(self.law, tangential_damping))
            .map(|contact| if rubs { contact } else { contact.without_friction() })
            .map_err(|error| said(&error))
    }
}

/// ψ at the impact ratio `ratio`.
///
/// # Errors
/// ψ is out of its range, although the ratio, μ and α are in theirs.
pub fn reduced(reduction: &Reduction, ratio: f64) -> Result<f64, String> {
    let psi = reduction.psi(ratio);
    Parameter::Psi
        .check(psi)
        .map_err(|expected| InvalidValue::new("psi = ratio·alpha/mu", psi, expected).to_string())
}

/// The reason why options, or options and columns, do not make a recipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecipeError {
    /// κ is not given.
    NoKappa,
    /// Neither ψ nor the ratio is given.
    NoImpact,
    /// ψ and the ratio are both given.
    PsiAndRatio,
    /// An option and a column give the same parameter.
    GivenTwice {
        /// The name of the parameter.
        name: &'static str,
    },
    /// The damping and the coefficient of normal restitution are both given.
    DampingTwice,
    /// An option has no effect.
    Unused {
        /// The name of the parameter.
        name: &'static str,
    },
}

/// `text` as it is shown in messages: in quotation marks, on one line, and not too long.
pub fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("'{shown}'")
}
