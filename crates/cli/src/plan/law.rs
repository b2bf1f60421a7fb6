//! The contact law, as the options choose it.

use stickslip_model::Law;

use crate::args::LawArguments;
use crate::error::Failure;
use crate::input::law;

/// The law that the options choose: a name, or otherwise a file.
///
/// # Errors
/// [`Failure::Usage`]: the law has no tangential damping. [`Failure::Input`]: there is neither such
/// a name nor such a file, or the file does not describe a law.
pub fn chosen_law(arguments: &LawArguments) -> Result<Law, Failure> {
    let LawArguments { law: name, tangential_damping } = arguments;
    law::permits(name.as_deref(), "--tangential-damping", tangential_damping.unwrap_or(0.0))?;
    law::by_name_or_file(name.as_deref())
}
