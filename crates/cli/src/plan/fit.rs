//! What `fit` is to do.

use std::path::Path;

use stickslip_files::input::{bodies, law, measured, source};
use stickslip_files::output::picture::PictureFile;
use stickslip_model::{Contact, Law, presets};
use stickslip_practice::fit::{Bodies, Free, Settings, Values};

use super::files::require_different;
use super::law::chosen_law;
use crate::args::{FitArguments, Format};
use crate::error::Failure;

/// A fit to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct FitPlan {
    /// The data, and what is fitted.
    pub settings: Settings,
    /// How the fit is printed.
    pub format: Format,
    /// The file of its picture, if it is drawn.
    pub plot: Option<PictureFile>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

impl FitPlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: an option is missing or out of range. [`Failure::File`]: a file cannot
    /// be used.
    pub fn new(arguments: &FitArguments) -> Result<Self, Failure> {
        let FitArguments { data, bodies: file, free, .. } = arguments;
        let standard = source::is_standard_input;
        if standard(data) && file.as_deref().is_some_and(standard) {
            let expected = "expected a file for one of them";
            return Err(Failure::Usage(format!(
                "DATA.csv and --bodies are both standard input; {expected}"
            )));
        }
        let plot = ("--plot", arguments.plot.as_ref().map(PictureFile::path));
        let inputs = [("DATA.csv", Some(data.as_path())), ("--bodies", file.as_deref())];
        require_different(&[plot], &inputs)?;
        let name = arguments.law.law.as_deref();
        if free.contains(&Free::TangentialDamping) {
            permits(name)?;
        }
        let bodies = match file {
            Some(file) => in_file(file, name)?,
            None => scaled(arguments, chosen_law(&arguments.law)?)?,
        };
        if let Some(speed) = arguments.speed.filter(|speed| *speed <= 0.0) {
            let expected = "expected a finite number above 0, in m/s";
            return Err(Failure::Usage(format!("--speed = {speed:?} is out of range; {expected}")));
        }
        let scaled = bodies.are_scaled();
        let mut settings = Settings::new(bodies, measured::read(data, arguments.speed, scaled)?);
        settings.free.clone_from(free);
        for (index, (free, range)) in arguments.range.iter().enumerate() {
            let name = free.name();
            if !settings.free.contains(free) {
                let expected = "expected what is in --free";
                return Err(Failure::Usage(format!("--range {name} has no effect; {expected}")));
            }
            if arguments.range[..index].iter().any(|(other, _)| other == free) {
                return Err(Failure::Usage(format!(
                    "--range {name} is given twice; expected one range"
                )));
            }
            *settings.ranges.of_mut(*free) = *range;
        }
        settings.eps_n = arguments.eps_n;
        settings.level = arguments.level;
        settings.relative_errors = arguments.relative_errors;
        settings.validate().map_err(|invalid| Failure::input(source::shown(data), invalid))?;
        let FitArguments { format, threads, .. } = *arguments;
        Ok(Self { settings, format, plot: arguments.plot.clone(), threads })
    }
}

/// Refuses a free tangential damping in a law that is known to have none.
fn permits(name: Option<&str>) -> Result<(), Failure> {
    match name.and_then(presets::find) {
        Some(preset) if !preset.tangential_damping => Err(Failure::Usage(format!(
            "tangential_damping cannot be fitted in the law {}: {}; expected other free numbers, or \
             a file of the law that is meant",
            preset.name, preset.checked
        ))),
        _ => Ok(()),
    }
}

fn in_file(file: &Path, name: Option<&str>) -> Result<Bodies, Failure> {
    let law = law::by_name_or_file(name)?;
    let (sphere, pair) = bodies::read_sphere_and_pair(file, law)?;
    law::permits(name, "tangential damping", pair.tangential_damping())?;
    Ok(Bodies::of_sphere(&sphere, pair))
}

/// Bodies of which nothing but α is known.
fn scaled(arguments: &FitArguments, law: Law) -> Result<Bodies, Failure> {
    let FitArguments { kappa, mu, damping, free, .. } = arguments;
    let fixed = |name: &str, value: Option<f64>, which: Free| match (value, free.contains(&which)) {
        (Some(value), true) => Err(Failure::Usage(format!(
            "--{name} {value:?} has no effect, since it is fitted; expected it without {name} in --free"
        ))),
        (value, _) => Ok(value),
    };
    let needed = |name: &str, value: Option<f64>, which: Free| {
        let value = fixed(name, value, which)?;
        // What is fitted may have any value.
        let any = free.contains(&which).then_some(1.0);
        value.or(any).ok_or_else(|| {
            Failure::Usage(format!(
                "--{name} is missing; expected it, {name} in --free, or --bodies"
            ))
        })
    };
    let dashpot = arguments.law.tangential_damping;
    let values = Values {
        kappa: needed("kappa", *kappa, Free::Kappa)?,
        mu: needed("mu", *mu, Free::Mu)?,
        tangential_damping: fixed("tangential-damping", dashpot, Free::TangentialDamping)?
            .unwrap_or(0.0),
        damping: fixed("damping", *damping, Free::Damping)?.unwrap_or(0.0),
    };
    if let (Some(damping), Some(eps_n)) = (damping, arguments.eps_n) {
        return Err(Failure::Usage(format!(
            "--damping {damping:?} and --eps-n {eps_n:?} are both given; expected one of them"
        )));
    }
    let alpha = arguments.alpha.unwrap_or(stickslip_model::Reduction::default().alpha);
    Contact::new(values.kappa, 1.0, values.damping)
        .and_then(|contact| contact.with_law(law, values.tangential_damping))
        .and_then(|_| Bodies::scaled(law, alpha, &values))
        .map_err(|invalid| Failure::Usage(invalid.to_string()))
}
