//! Tables of ε_t.
//!
//! A particle code can look ε_t up. [`run`] makes a [`Table`] of it over (κ, ψ), with an error below
//! a bound everywhere. Pieces of polynomials follow the boundaries of the atlas, on which the
//! switches of a collision change and on which ε_t has kinks or roots.
//!
//! Start reading here; then, in this order: `settings`, `boundaries` (graphs of the atlas over κ),
//! `stretch` (coordinates in which roots are smooth), `slab`, `strip` (polynomials), `assembly`,
//! `table` (the arrays and the look-up), `verification`.

mod assembly;
mod boundaries;
mod chebyshev;
#[cfg(feature = "serde")]
mod document;
mod header;
mod hints;
mod settings;
mod slab;
mod stretch;
mod strip;
mod table;
mod verification;

use stickslip_model::{Contact, Engine, EngineError, InvalidParameter};
use stickslip_plane::atlas::{AtlasError, Frame, trace};
use stickslip_plane::progress::{Progress, Report, SILENT};

pub use chebyshev::{ACROSS, ALONG};
#[cfg(feature = "serde")]
pub use document::{Document, DocumentError, SCHEMA};
pub use header::{InvalidPrefix, require_prefix};
pub use hints::Keys;
pub use settings::{InvalidTable, Settings};
pub use stretch::Stretch;
pub use table::{Arrays, NO_REGION, Table};
pub use verification::Verification;

/// Makes a table of ε_t and verifies it, on the threads of the current rayon pool.
///
/// # Errors
/// [`TableError`]: the settings are out of range, there is no atlas or something speaks against it,
/// a collision cannot be computed, or the bound is not reached.
pub fn run(settings: &Settings, progress: Report<'_>) -> Result<Table, TableError> {
    settings.validate()?;
    let frame = Frame::new(settings.kappa, settings.psi, settings.damping);
    let traced = trace(frame, frame.tolerances().usual, SILENT)?;
    if !traced.report.agrees {
        return Err(TableError::Doubtful);
    }
    let begin = |steps| progress(Progress::Begin { steps });
    let done = || progress(Progress::Advance { steps: 1 });
    let arrays = assembly::arrays(settings, &traced.atlas, begin, done)?;
    let middle = Contact::new(settings.kappa.low, settings.psi.low, settings.damping)?;
    let (collision, _) = Engine::Exact.collide(middle).map_err(|source| TableError::Engine {
        kappa: settings.kappa.low,
        psi: settings.psi.low,
        source,
    })?;
    let regions = 0..traced.atlas.regions.regions().len();
    let named = regions.map(|region| traced.atlas.itinerary(region).to_owned());
    let none = Verification { points: 0, largest_error: 0.0, kappa: 0.0, psi: 0.0 };
    let mut table = Table {
        damping: settings.damping,
        eps_n: collision.eps_n,
        bound: settings.bound,
        kappa: [settings.kappa.low, settings.kappa.high],
        psi: [settings.psi.low, settings.psi.high],
        verification: none,
        regions: if settings.regions { named.collect() } else { Vec::new() },
        arrays,
    };
    table.verification = verification::verify(&table)?;
    let Verification { largest_error, kappa, psi, .. } = table.verification;
    if !strip::within(largest_error, settings.bound) {
        return Err(TableError::Coarse { kappa, psi, error: largest_error });
    }
    Ok(table)
}

/// Why there is no table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Settings are out of range.
    #[error(transparent)]
    Settings(#[from] InvalidTable),
    /// No collision has the parameters of the window.
    #[error(transparent)]
    Parameter(#[from] InvalidParameter),
    /// The window has no atlas.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
    /// Something speaks against the atlas.
    #[error("something speaks against the atlas of this window; `stickslip trace` says what")]
    Doubtful,
    /// A collision cannot be computed.
    #[error("kappa = {kappa:?}, psi = {psi:?}: {source}")]
    Engine {
        /// κ of the collision.
        kappa: f64,
        /// ψ of the collision.
        psi: f64,
        /// What the engine reports.
        source: EngineError,
    },
    /// The bound is not reached.
    #[error("the bound is not reached: the error is {error:e} at kappa = {kappa:?}, psi = {psi:?}")]
    Coarse {
        /// κ of the place.
        kappa: f64,
        /// ψ of the place.
        psi: f64,
        /// The error there.
        error: f64,
    },
    /// The table has too many strips.
    #[error("more than {most} strips; expected fewer in a smaller window or with a coarser bound")]
    Many {
        /// The largest number.
        most: usize,
    },
}
