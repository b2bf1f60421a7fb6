//! What `converge`, `asymptote` and `laws --out` are to do.

use std::fmt::Display;
use std::path::PathBuf;

use stickslip_files::input::recipe::Given;
use stickslip_studies::{contact_laws, convergence, own_system, stiff_springs};

use super::collision::contact;
use super::system::SystemRun;
use crate::args::{AsymptoteArguments, CollisionArguments, ConvergeArguments, LawsArguments};
use crate::error::Failure;

/// A study to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyPlan<S> {
    /// What is studied.
    pub settings: S,
    /// The directory of the files.
    pub out: PathBuf,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl StudyPlan<convergence::Settings> {
    /// The study of convergence that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which options contradict each other.
    pub fn convergence(arguments: &ConvergeArguments) -> Result<Self, Failure> {
        let ConvergeArguments { kappa, psi, ratio, collision, ref out, threads, .. } = *arguments;
        let CollisionArguments { mu, alpha, damping } = collision;
        let settings = if [kappa, psi, ratio, mu, alpha].iter().all(Option::is_none) {
            let usual = convergence::Settings::usual(damping.unwrap_or(0.0));
            usual.map_err(|invalid| Failure::Usage(invalid.to_string()))?
        } else {
            let contact =
                contact(&Given { kappa, psi, ratio, mu, alpha, damping, ..Given::default() })?;
            convergence::Settings { contacts: vec![contact] }
        };
        settings.validate().map_err(refused)?;
        Ok(Self { settings, out: out.clone(), threads })
    }
}

impl StudyPlan<own_system::Settings> {
    /// The study of a system of one's own that `arguments` make; `None` if they name none.
    ///
    /// # Errors
    /// [`Failure`]: the system cannot be read, or options do not fit it.
    pub fn own_system(arguments: &ConvergeArguments) -> Result<Option<Self>, Failure> {
        let ConvergeArguments { system: Some(path), given, out, threads, .. } = arguments else {
            return Ok(None);
        };
        let SystemRun { name, system, runnable, end, .. } =
            SystemRun::new(path, &given.set, given.end)?;
        let settings = own_system::Settings { name, system, runnable, end };
        Ok(Some(Self { settings, out: out.clone(), threads: *threads }))
    }
}

impl StudyPlan<stiff_springs::Settings> {
    /// The study of stiff springs that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which option is out of range.
    pub fn stiff_springs(arguments: &AsymptoteArguments) -> Result<Self, Failure> {
        let AsymptoteArguments { kappa, psi, out, threads } = arguments;
        let settings = stiff_springs::Settings { kappa: *kappa, psi: psi.clone() };
        settings.validate().map_err(refused)?;
        Ok(Self { settings, out: out.clone(), threads: *threads })
    }
}

impl StudyPlan<contact_laws::Settings> {
    /// The study of contact laws that `arguments` make; `None` if laws are only printed.
    ///
    /// # Errors
    /// [`Failure::Usage`] says which option is out of range.
    pub fn contact_laws(arguments: &LawsArguments) -> Result<Option<Self>, Failure> {
        let LawsArguments { damping, tangential_damping, cells, threads, .. } = *arguments;
        let Some(out) = &arguments.out else { return Ok(None) };
        let usual = contact_laws::Settings::default();
        let settings = contact_laws::Settings {
            damping: damping.unwrap_or(usual.damping),
            tangential_damping: tangential_damping.unwrap_or(usual.tangential_damping),
            cells: cells.map_or(usual.cells, usize::from),
            ..usual
        };
        settings.validate().map_err(refused)?;
        Ok(Some(Self { settings, out: out.clone(), threads }))
    }
}

/// The failure of settings that are out of range. The settings have the names of the options.
fn refused(invalid: impl Display) -> Failure {
    Failure::Usage(format!("--{invalid}"))
}
