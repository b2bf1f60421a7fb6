//! What `converge` is to do.

use std::path::{Path, PathBuf};

use stickslip_model::Contact;

use crate::args::{CollisionArguments, ConvergeArguments};
use crate::error::Failure;
use crate::plan::explain;
use crate::recipe::{Given, Recipe};

/// The largest stiffness of a study, which takes seconds at it; work grows as √κ.
const MOST_STIFFNESS: f64 = 1e6;

/// A study of convergence.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvergePlan {
    /// The collisions whose errors are measured.
    pub contacts: Vec<Contact>,
    /// The directory of its files.
    pub out: PathBuf,
    /// Number of threads; `None` is one for each core.
    pub threads: Option<usize>,
}

impl ConvergePlan {
    /// The usual study, without damping.
    ///
    /// # Errors
    /// None of its collisions is out of range.
    pub fn usual(out: &Path) -> Result<Self, Failure> {
        Ok(Self { contacts: usual(0.0)?, out: out.to_owned(), threads: None })
    }

    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options do not go together.
    pub fn new(arguments: &ConvergeArguments) -> Result<Self, Failure> {
        let ConvergeArguments { kappa, psi, ratio, collision, .. } = *arguments;
        let CollisionArguments { mu, alpha, damping } = collision;
        let contacts = if [kappa, psi, ratio, mu, alpha].iter().all(Option::is_none) {
            usual(damping.unwrap_or(0.0))?
        } else {
            let given = Given { kappa, psi, ratio, mu, alpha, damping };
            let recipe = Recipe::new(&given, |_| None).map_err(|e| Failure::Usage(explain(e)))?;
            vec![recipe.contact(|_| &[]).map_err(|e| Failure::Usage(e.to_string()))?]
        };
        if let Some(stiff) = contacts.iter().find(|contact| contact.kappa() > MOST_STIFFNESS) {
            return Err(Failure::Usage(format!(
                "--kappa {:?} is out of range; expected a number above 0, at most {MOST_STIFFNESS:?}",
                stiff.kappa()
            )));
        }
        let threads = arguments.threads.map(usize::from);
        Ok(Self { contacts, out: arguments.out.clone(), threads })
    }
}

/// Collisions with two to eight switches without damping.
fn usual(damping: f64) -> Result<Vec<Contact>, Failure> {
    let points = [18.0, 63.0]
        .into_iter()
        .flat_map(|kappa| (1..20).map(move |tenths| (kappa, f64::from(tenths) / 10.0)));
    points
        .map(|(kappa, psi)| Contact::new(kappa, psi, damping))
        .collect::<Result<_, _>>()
        .map_err(|invalid| Failure::Usage(invalid.to_string()))
}
