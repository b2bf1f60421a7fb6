//! Contact laws: by their names, or in JSON files.

use std::path::Path;

use stickslip_model::Law;
use stickslip_model::presets::{self, Preset};

use super::{json, source};
use crate::error::FileError;

/// Largest number of bytes of a file.
const MOST_BYTES: u64 = 1 << 16;

/// Refuses a tangential damping, called `what`, in a law that is known to have none.
///
/// # Errors
/// [`FileError::Option`]: the law has no tangential damping.
pub fn permits(law: Option<&str>, what: &str, damping: f64) -> Result<(), FileError> {
    match law.and_then(presets::find) {
        Some(preset) if damping != 0.0 && !preset.tangential_damping => {
            Err(FileError::Option(format!(
                "{what} {damping:?} has no meaning in the law {}: {}; expected 0, or a file of the \
                 law that is meant",
                preset.name, preset.checked
            )))
        }
        _ => Ok(()),
    }
}

/// The law with this name, or otherwise in this file; without either, the paper's.
///
/// # Errors
/// [`FileError::Input`]: there is neither such a name nor such a file, or the file does not
/// describe a law.
pub fn by_name_or_file(text: Option<&str>) -> Result<Law, FileError> {
    let Some(text) = text else { return Ok(Law::PAPER) };
    presets::find(text).map_or_else(|| read(Path::new(text)), |preset| Ok(preset.law))
}

/// The preset with this name.
///
/// # Errors
/// [`FileError::Option`]: there is none.
pub fn named(name: &str) -> Result<Preset, FileError> {
    presets::find(name).ok_or_else(|| {
        if let Some(why) = presets::refusal(name) {
            return FileError::Option(format!("no contact law is named {name:?}: {why}"));
        }
        let expected = "expected a name that `stickslip laws` lists";
        FileError::Option(format!("no contact law is named {name:?}; {expected}{}", near(name)))
    })
}

/// `; perhaps …` with the names that look like `name`.
fn near(name: &str) -> String {
    let names = presets::near(name);
    if names.is_empty() { String::new() } else { format!("; perhaps {}", names.join(" or ")) }
}

/// The law in the file at `path`.
fn read(path: &Path) -> Result<Law, FileError> {
    if !source::is_standard_input(path) && !path.exists() {
        if let Some(why) = presets::refusal(&path.to_string_lossy()) {
            return Err(FileError::input(path, format!("is neither a file nor a law: {why}")));
        }
        let near = near(&path.to_string_lossy());
        let reason = format!("is neither a file nor a name that `stickslip laws` lists{near}");
        return Err(FileError::input(path, reason));
    }
    let text = source::read(path, MOST_BYTES)?;
    json::object(&text).map_err(|reason| FileError::input(source::shown(path), reason))
}
