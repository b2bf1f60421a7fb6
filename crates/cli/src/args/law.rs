//! The options that choose a contact law.

use stickslip_files::input::parameter::Parameter;

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
