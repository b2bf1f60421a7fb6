//! The contact law, as the options choose it.

use stickslip_files::input::law;
use stickslip_model::Law;

use crate::args::LawArguments;
use crate::error::Failure;

/// The law that the options choose: a name, or otherwise a file.
///
/// # Errors
/// [`Failure::Usage`]: the law has no tangential damping. [`Failure::File`]: there is neither such
/// a name nor such a file, or the file does not describe a law.
pub fn chosen_law(arguments: &LawArguments) -> Result<Law, Failure> {
    let LawArguments { law: name, tangential_damping } = arguments;
    law::permits(name.as_deref(), "--tangential-damping", tangential_damping.unwrap_or(0.0))?;
    Ok(law::by_name_or_file(name.as_deref())?)
}
