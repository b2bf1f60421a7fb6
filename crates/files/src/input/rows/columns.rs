//! The columns of a CSV file that have a meaning: those of a file of collisions.

use std::collections::HashSet;

use csv::ByteRecord;

use crate::input::number;
use crate::input::parameter::Parameter;
use crate::input::recipe::{Given, Recipe, RecipeError};
use crate::input::rows::Reading;
use crate::output::rows::LOCATED;

/// The columns that have a meaning.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// The parameters that are read. Other columns pass through.
    parameters: &'static [Parameter],
    /// Whether options may give parameters too.
    options: bool,
    /// The names of the columns of results.
    results: &'static [&'static str],
}

impl Columns {
    /// The columns of a file of collisions whose results are these.
    pub const fn of_collisions(results: &'static [&'static str]) -> Self {
        Self { parameters: Self::COLLISION, options: true, results }
    }

    /// The parameters of a collision.
    const COLLISION: &[Parameter] = &[
        Parameter::Kappa,
        Parameter::Psi,
        Parameter::Ratio,
        Parameter::Mu,
        Parameter::Alpha,
        Parameter::Damping,
        Parameter::NormalRestitution,
        Parameter::TangentialDamping,
    ];

    /// What only options give, and a column would not change.
    const TERMS: [&str; 4] = ["law", "dynamic_friction", "friction_decay", "pull_off"];

    /// The columns of a file of points (κ, ψ) that are located in an atlas.
    pub const POINTS: Self =
        Self { parameters: &[Parameter::Kappa, Parameter::Psi], options: false, results: &LOCATED };

    /// The recipe that the columns of `header` make together with the values `given` as options.
    ///
    /// # Errors
    /// What is wrong with the columns, and what is expected.
    pub fn recipe(&self, header: &ByteRecord, given: &Given) -> Result<Recipe, String> {
        let names = names(header, self.results, "kappa,psi")?;
        if self.options {
            names.iter().try_for_each(|name| self.require_foreign(name))?;
        }
        let column = |parameter: Parameter| {
            let place = names.iter().position(|name| *name == parameter.name().as_bytes());
            place.filter(|_| self.parameters.contains(&parameter))
        };
        Recipe::new(given, column).map_err(|error| {
            let problem = if self.options {
                explain(error)
            } else {
                "kappa or psi is missing; expected columns kappa and psi".to_owned()
            };
            let names = names.join(&b", "[..]);
            format!("{problem}; the columns are: {}", String::from_utf8_lossy(&names))
        })
    }
}

impl Columns {
    /// Refuses the name of a column that looks as if it should be read.
    fn require_foreign(&self, name: &[u8]) -> Result<(), String> {
        let name = String::from_utf8_lossy(name);
        let plain = name.to_ascii_lowercase().replace(['-', ' '], "_");
        if Self::TERMS.contains(&&*plain) {
            return Err(format!(
                "column {name} is part of the law, which all rows share; expected --{}, or another \
                 name",
                plain.replace('_', "-")
            ));
        }
        let mut known = self.parameters.iter().map(|parameter| parameter.name());
        match known.find(|own| plain == *own && name != *own) {
            Some(own) => Err(format!("column {name} is not read; expected {own}, or another name")),
            None => Ok(()),
        }
    }
}

/// The names of the columns of `header`, without blanks around them. A header may be like
/// `example`.
///
/// # Errors
/// There is no header, two columns have the same name, or one has the name of one of `results`.
pub fn names<'a>(
    header: &'a ByteRecord,
    results: &[&str],
    example: &str,
) -> Result<Vec<&'a [u8]>, String> {
    if header.is_empty() {
        return Err(format!("is empty; expected a header row, for example {example}"));
    }
    let names: Vec<&[u8]> = header.iter().map(<[u8]>::trim_ascii).collect();
    let mut seen = HashSet::new();
    for name in &names {
        let shown = String::from_utf8_lossy(name);
        if !seen.insert(name) {
            return Err(format!("two columns are named '{shown}'; expected different names"));
        }
        if results.iter().any(|result| result.as_bytes() == *name) {
            return Err(format!(
                "column {shown} has the name of a result; expected names other than {}",
                results.join(", ")
            ));
        }
    }
    Ok(names)
}

/// Two numbers in columns that have names: a point.
#[derive(Clone, Copy, Debug)]
pub struct TwoColumns([usize; 2]);

impl TwoColumns {
    /// The columns with these names.
    ///
    /// # Errors
    /// What is wrong with the columns, and what is expected.
    pub fn named(header: &ByteRecord, axes: &[&str; 2], results: &[&str]) -> Result<Self, String> {
        let names = names(header, results, &axes.join(","))?;
        let place = |axis: &str| {
            let place = names.iter().position(|name| *name == axis.as_bytes());
            let [x, y] = axes;
            place.ok_or_else(|| format!("{axis} is missing; expected columns {x} and {y}"))
        };
        Ok(Self([place(axes[0])?, place(axes[1])?]))
    }
}

impl Reading for TwoColumns {
    type Case = (f64, f64);

    fn read(&mut self, fields: &ByteRecord) -> Result<(f64, f64), String> {
        let [x, y] = self.0.map(|column| {
            let text = String::from_utf8_lossy(&fields[column]);
            match number::parse(text.trim()) {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(format!("{text:?} is not a finite number")),
            }
        });
        Ok((x?, y?))
    }
}

/// What is wrong with the columns and options.
fn explain(error: RecipeError) -> String {
    match error {
        RecipeError::NoKappa => "kappa is missing; expected a column kappa or --kappa".to_owned(),
        RecipeError::NoImpact => {
            "psi and ratio are missing; expected exactly one of them, as a column or an option"
                .to_owned()
        }
        RecipeError::PsiAndRatio => {
            "psi and ratio are both given; expected exactly one of them, as a column or an \
             option"
                .to_owned()
        }
        RecipeError::GivenTwice { name } => {
            format!("the column {name} and --{name} are both given; expected one of them")
        }
        RecipeError::DampingTwice => {
            "damping and e_n are both given; expected one of them, as a column or an option"
                .to_owned()
        }
        RecipeError::Unused { name } => {
            format!("--{name} has no effect with psi; expected with ratio only")
        }
    }
}
