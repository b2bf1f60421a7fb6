//! The options that choose a contact law.

use std::path::Path;

use stickslip_files::input::law;
use stickslip_files::input::number;
use stickslip_files::input::parameter::Parameter;
use stickslip_model::{Contact, Friction, Law};

use super::files::Named;
use crate::error::Failure;

/// A contact law, and the parameter that only some laws have.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct LawArguments {
    /// Contact law: a name that `stickslip laws` lists, or a JSON file [default: paper]
    #[arg(long, value_name = "NAME|FILE.json", help_heading = "Contact law")]
    pub law: Option<String>,

    /// Tangential damping (γ_t/γ_n)/α, a ratio of damping constants; 0 or above [default: 0]
    #[arg(long, value_name = "B", help_heading = "Contact law", allow_hyphen_values = true)]
    #[arg(value_parser = |text: &str| Parameter::TangentialDamping.parse(text))]
    pub tangential_damping: Option<f64>,

    /// Dynamic over static friction μ_d/μ_s, with --friction-decay; 0 to 1 [default: 1]
    #[arg(long, value_name = "R", help_heading = "Contact law", allow_hyphen_values = true)]
    #[arg(requires = "friction_decay")]
    #[arg(value_parser = |text: &str| part_of_friction(text, |dynamic| (dynamic, 1.0)))]
    pub dynamic_friction: Option<f64>,

    /// Decay B of friction with the velocity w, as μ_d + (μ_s − μ_d) e^(−B |w|); 0 or above
    #[arg(long, value_name = "B", help_heading = "Contact law", allow_hyphen_values = true)]
    #[arg(requires = "dynamic_friction")]
    #[arg(value_parser = |text: &str| part_of_friction(text, |decay| (0.5, decay)))]
    pub friction_decay: Option<f64>,

    /// Scaled force F_po/(m g_n) · time that separates the bodies, with the law of granular/dmt or
    /// granular/jkr; above 0
    #[arg(long, value_name = "F", help_heading = "Contact law", allow_hyphen_values = true)]
    #[arg(value_parser = pull_off)]
    pub pull_off: Option<f64>,
}

impl LawArguments {
    /// The law that the options choose, a name or otherwise a file, and the tangential damping.
    pub fn chosen(&self) -> Result<(Law, f64), Failure> {
        let Self { law: name, tangential_damping, dynamic_friction, friction_decay, pull_off } =
            self;
        let damping = tangential_damping.unwrap_or(0.0);
        law::permits(name.as_deref(), "--tangential-damping", damping)?;
        let mut law = law::by_name_or_file(name.as_deref())?;
        if let (Some(dynamic), Some(decay)) = (*dynamic_friction, *friction_decay) {
            law.friction = Friction { dynamic, decay };
        }
        if let Some(force) = *pull_off {
            if !law.normal.is_adhesive() {
                let message = "--pull-off has no meaning in a law without adhesion; expected one of \
                               granular/dmt or granular/jkr";
                return Err(Failure::Usage(message.to_owned()));
            }
            law.pull_off = force;
        }
        Ok((law, damping))
    }
}

/// A pull-off force.
fn pull_off(text: &str) -> Result<f64, String> {
    let value = number::parse_option(text)?;
    let ok = value > 0.0 && value.is_finite();
    if ok { Ok(value) } else { Err("out of range; expected a finite number above 0".to_owned()) }
}

/// A number of a [`Friction`], which `with` completes.
fn part_of_friction(text: &str, with: impl Fn(f64) -> (f64, f64)) -> Result<f64, String> {
    let value = number::parse_option(text)?;
    let (dynamic, decay) = with(value);
    let law = Law { friction: Friction { dynamic, decay }, ..Law::PAPER };
    Contact::new(1.0, 1.0, 0.0)
        .and_then(|contact| contact.with_law(law, 0.0))
        .map(|_| value)
        .map_err(|error| format!("out of range; expected {}", error.expected))
}

/// The file of a law, which an output must not replace.
pub fn file(law: Option<&str>) -> Named<'_> {
    ("--law", law.map(Path::new))
}
