//! What `table` is to do.

use std::path::{Path, PathBuf};

use stickslip_files::input::bodies::read_pair;
use stickslip_model::Law;
use stickslip_practice::tables::{Settings, Window};

use super::files::require_different;
use crate::args::TableArguments;
use crate::error::Failure;

/// A table to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct TablePlan {
    /// The window and the bound.
    pub settings: Settings,
    /// What names in a C header begin with.
    pub prefix: String,
    /// The files, and their formats.
    pub out: Vec<(PathBuf, TableFormat)>,
    /// The number of threads; `None` is one for each core.
    pub threads: Option<u16>,
}

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// JSON.
    Json,
    /// NumPy arrays.
    Npz,
    /// A header for C.
    Header,
}

impl TablePlan {
    /// The plan that `arguments` make.
    ///
    /// # Errors
    /// [`Failure::Usage`]: an option is out of range, or a file has no known format or is named
    /// twice.
    pub fn new(arguments: &TableArguments) -> Result<Self, Failure> {
        let window = window(arguments)?;
        let settings = Settings { window, bound: arguments.bound, regions: arguments.regions };
        settings.validate().map_err(|invalid| Failure::Usage(format!("--{invalid}")))?;
        let named: Vec<_> =
            arguments.out.iter().map(|out| ("--out", Some(out.as_path()))).collect();
        require_different(&named, &[("--bodies", arguments.bodies.as_deref())])?;
        let out = arguments.out.iter().map(|out| Ok((out.clone(), TableFormat::of(out)?)));
        let prefix = arguments.prefix.clone();
        stickslip_practice::tables::require_prefix(&prefix)
            .map_err(|invalid| Failure::Usage(format!("--{invalid}")))?;
        Ok(Self {
            settings,
            prefix,
            out: out.collect::<Result<_, Failure>>()?,
            threads: arguments.threads,
        })
    }
}

/// The window that the options give: of κ and ψ, or of velocities.
fn window(arguments: &TableArguments) -> Result<Window, Failure> {
    let TableArguments { kappa, psi, damping, bodies, normal, tangential, .. } = arguments;
    match (bodies, normal, tangential, kappa, psi) {
        (Some(file), &Some(normal_m_per_s), &Some(tangential_m_per_s), _, _) => {
            let pair = read_pair(file, Law::PAPER)?;
            Ok(Window::Velocities { pair, normal_m_per_s, tangential_m_per_s })
        }
        (None, _, _, &Some(kappa), &Some(psi)) => {
            Ok(Window::Scaled { kappa, psi, damping: damping.unwrap_or(0.0) })
        }
        // The parser of the options asks for either.
        _ => {
            let expected = "expected --kappa and --psi, or --bodies, --normal and --tangential";
            Err(Failure::Usage(format!("no window; {expected}")))
        }
    }
}

impl TableFormat {
    /// The format that the name of the file `out` tells.
    fn of(out: &Path) -> Result<Self, Failure> {
        match out.extension().and_then(|extension| extension.to_str()) {
            Some("json") => Ok(Self::Json),
            Some("npz") => Ok(Self::Npz),
            Some("h") => Ok(Self::Header),
            _ => Err(Failure::Usage(format!(
                "--out {}: the name does not tell the format; expected FILE.json, FILE.npz or FILE.h",
                out.display()
            ))),
        }
    }
}
