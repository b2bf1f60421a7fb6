//! The options that choose a contact law.

use std::path::Path;

use stickslip_files::input::law;
use stickslip_files::input::parameter::Parameter;
use stickslip_model::Law;

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
}

impl LawArguments {
    /// The law that the options choose, a name or otherwise a file, and the tangential damping.
    pub fn chosen(&self) -> Result<(Law, f64), Failure> {
        let Self { law: name, tangential_damping } = self;
        let damping = tangential_damping.unwrap_or(0.0);
        law::permits(name.as_deref(), "--tangential-damping", damping)?;
        Ok((law::by_name_or_file(name.as_deref())?, damping))
    }
}

/// The file of a law, which an output must not replace.
pub fn file(law: Option<&str>) -> Named<'_> {
    ("--law", law.map(Path::new))
}
