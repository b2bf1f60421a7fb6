//! What `timestep` is to do.

use stickslip_files::input::range::OneOrRange;
use stickslip_files::input::source::shown;
use stickslip_files::input::{bodies, law};
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Contact, Reduction};
use stickslip_practice::time_steps::{Seconds, Settings};

use super::law::chosen_law;
use crate::args::{Format, TimestepArguments};
use crate::error::Failure;

/// Errors of time steps to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct TimestepPlan {
    /// The impacts and the steps.
    pub settings: Settings,
    /// The times of the impact in SI units, if it is given in them.
    pub seconds: Option<Seconds>,
    /// The wanted error.
    pub wanted: Option<f64>,
    /// How the errors are printed.
    pub format: Format,
    /// The file of their picture, if it is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

/// Values in an interval.
const GRID: u16 = 8;

impl TimestepPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: an option is missing or out of range. [`Failure::File`]: a file cannot
    /// be used.
    pub fn new(arguments: &TimestepArguments) -> Result<Self, Failure> {
        let (contacts, reduction, seconds) = impacts(arguments)?;
        let settings = Settings {
            contacts,
            steps_per_contact: arguments.steps.clone(),
            phases: usize::from(arguments.phases),
            scheme: arguments.scheme,
            reduction,
        };
        settings.validate().map_err(|invalid| Failure::Usage(format!("--{invalid}")))?;
        if let Some(wanted) = arguments.error.filter(|wanted| *wanted <= 0.0) {
            let expected = "expected a finite number above 0";
            return Err(Failure::Usage(format!(
                "--error = {wanted:?} is out of range; {expected}"
            )));
        }
        Ok(Self {
            settings,
            seconds,
            wanted: arguments.error,
            format: arguments.format,
            plot: arguments.plot.clone(),
            threads: arguments.threads,
        })
    }
}

type Impacts = (Vec<Contact>, Reduction, Option<Seconds>);

/// The impacts of the options or of the file, with what weighs their energy and their times.
fn impacts(arguments: &TimestepArguments) -> Result<Impacts, Failure> {
    let Some(path) = &arguments.bodies else { return scaled(arguments) };
    let name = arguments.law.law.as_deref();
    let encounter = bodies::read_encounter(path, law::by_name_or_file(name)?, None)?;
    law::permits(name, "tangential damping", encounter.contact().tangential_damping())?;
    if encounter.is_central() {
        let reason = "the impact is central; expected a tangential velocity, without which there \
                      is no tangential restitution";
        return Err(Failure::input(shown(path), reason));
    }
    let pair = &encounter.impact.pair;
    let reduction = Reduction { mu: pair.surface.friction, alpha: pair.alpha };
    Ok((vec![encounter.contact()], reduction, Some(Seconds::new(&encounter))))
}

fn scaled(arguments: &TimestepArguments) -> Result<Impacts, Failure> {
    let missing = |name: &str| {
        Failure::Usage(format!("--{name} is missing; expected --kappa and --psi, or --bodies"))
    };
    let kappa = arguments.kappa.ok_or_else(|| missing("kappa"))?;
    let psi = arguments.psi.ok_or_else(|| missing("psi"))?;
    let ranged = |value| matches!(value, OneOrRange::Range(_));
    if arguments.grid.is_some() && !ranged(kappa) && !ranged(psi) {
        let expected = "expected with an interval LO:HI of --kappa or --psi only";
        return Err(Failure::Usage(format!("--grid has no effect; {expected}")));
    }
    let law = chosen_law(&arguments.law)?;
    let tangential_damping = arguments.law.tangential_damping.unwrap_or(0.0);
    let count = usize::from(arguments.grid.unwrap_or(GRID));
    let mut contacts = Vec::new();
    for kappa in kappa.values(count) {
        for psi in psi.values(count) {
            let contact = Contact::new(kappa, psi, arguments.damping.unwrap_or(0.0))
                .and_then(|contact| contact.with_law(law, tangential_damping))
                .map_err(|invalid| Failure::Usage(invalid.to_string()))?;
            contacts.push(contact);
        }
    }
    let usual = Reduction::default();
    let reduction = Reduction {
        mu: arguments.mu.unwrap_or(usual.mu),
        alpha: arguments.alpha.unwrap_or(usual.alpha),
    };
    Ok((contacts, reduction, None))
}
