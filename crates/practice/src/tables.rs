//! Tables of ε_t and ε_n.
//!
//! A particle code can look the restitution up. [`run`] makes a [`RestitutionTable`] of it over (κ,
//! ψ) at one damping, or over the velocities (g_n, g_t) of two bodies, with errors below a bound
//! everywhere. Pieces of polynomials follow the boundaries on which the switches of a collision
//! change and on which ε_t has kinks or roots.
//!
//! The two axes are x and y in the code: κ and ψ, or g_n and g_t in m/s.
//!
//! ```
//! use stickslip_model::spheres::{BodyPair, Material, Surface};
//! use stickslip_plane::{Range, progress};
//! use stickslip_practice::tables::{self, TableSettings, TableWindow};
//!
//! let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
//! let surface =
//!     Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6 };
//! let window = TableWindow::Velocities {
//!     pair: BodyPair::equal_spheres(0.02, &steel, &surface)?,
//!     normal_m_per_s: Range { low: 1.0, high: 2.0 },
//!     tangential_m_per_s: Range { low: 1.0, high: 3.0 },
//! };
//! let settings = TableSettings { window, bound: 1e-5, regions: false };
//! let table = tables::run(&settings, progress::SILENT)?;
//! // Faster impacts lose more of their normal velocity.
//! assert!(table.eps_n(2.0) < table.eps_n(1.0) && table.eps_t(1.5, 2.0) < 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Start reading here; then, in this order: `settings`, `boundaries` and `chain` (boundaries as
//! graphs over x, and where they turn back), `stretch` (coordinates in which roots are smooth),
//! `slab`, `strip` (polynomials), `assembly`, `table` (the arrays and the look-up), `verification`.

mod assembly;
mod boundaries;
mod chain;
mod chebyshev;
mod document;
mod header;
mod hints;
mod keys;
mod settings;
mod slab;
mod stretch;
mod strip;
mod table;
mod verification;

use std::fmt;

use stickslip_model::{Collision, CollisionError, Contact, InvalidValue};
use stickslip_plane::CollisionPlane;
use stickslip_plane::atlas::{AtlasError, divide};
use stickslip_plane::progress::{Progress, Report, SILENT};

pub use chebyshev::{ACROSS, ALONG};
pub use document::{SCHEMA, TableDocument};
pub use header::require_prefix;
pub use keys::Keys;
pub use settings::{TableSettings, TableWindow};
pub use stretch::Stretch;
pub use table::{Arrays, NO_REGION, RestitutionTable, TableVerification};

/// Makes a table of ε_t and ε_n and verifies it, on the threads of the current rayon pool.
///
/// # Errors
/// [`TableError`]: the settings are out of range, the boundaries cannot be traced or something
/// speaks against them, a collision cannot be computed, or the bound is not reached.
pub fn run(settings: &TableSettings, progress: Report<'_>) -> Result<RestitutionTable, TableError> {
    settings.validate()?;
    let plane = settings.window.plane()?;
    let division = divide(&plane, plane.sheet().tolerances().usual, SILENT)?;
    if let Some(objection) = division.report.objection() {
        return Err(TableError::Doubtful { objection });
    }
    let begin = |steps| progress(Progress::Begin { steps });
    let done = || progress(Progress::Advance { steps: 1 });
    let arrays = assembly::arrays(settings, &division, begin, done)?;
    let constant_eps_n = match settings.window {
        TableWindow::Scaled { .. } => {
            let mut collision = Collision::before(Contact::new(1.0, 1.0, 0.0)?);
            Some(strip::restitution(&plane, plane.corners()[0], &mut collision)?[1])
        }
        TableWindow::Velocities { .. } => None,
    };
    let regions = 0..division.regions.regions().len();
    let named = regions.map(|region| division.itinerary(region).to_owned());
    let mut table = RestitutionTable {
        window: settings.window,
        constant_eps_n,
        bound: settings.bound,
        verification: TableVerification::NONE,
        regions: if settings.regions { named.collect() } else { Vec::new() },
        sides: settings.window.sides(),
        arrays,
    };
    table.verification = verification::verify(&table, &plane)?;
    let TableVerification { largest_error, largest_error_of_eps_n, x, y, .. } = table.verification;
    if !strip::within(largest_error, settings.bound) {
        return Err(TableError::Coarse {
            place: TablePlace::of(&plane, [x, y]),
            error: largest_error,
        });
    }
    if !strip::within(largest_error_of_eps_n, settings.bound) {
        return Err(TableError::CoarseNormal { error: largest_error_of_eps_n });
    }
    Ok(table)
}

/// A place of a window, shown as the names of both axes with their values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablePlace {
    /// The names of the axes.
    pub names: [&'static str; 2],
    /// The values.
    pub at: [f64; 2],
}

impl TablePlace {
    fn of(plane: &CollisionPlane, at: [f64; 2]) -> Self {
        Self { names: plane.names(), at }
    }
}

impl fmt::Display for TablePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { names: [x, y], at } = self;
        write!(f, "{x} = {:?}, {y} = {:?}", at[0], at[1])
    }
}

/// Why there is no table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// Settings or a document are out of range, or no collision has the parameters of the window.
    #[error(transparent)]
    Settings(#[from] InvalidValue),
    /// The boundaries of the window cannot be traced.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
    /// Something speaks against the traced boundaries.
    #[error("something speaks against the boundaries of this window: {objection}")]
    Doubtful {
        /// What it is.
        objection: String,
    },
    /// A collision cannot be computed.
    #[error("{place}: {source}")]
    Engine {
        /// The place of the collision.
        place: TablePlace,
        /// What the engine reports.
        source: Box<CollisionError>,
    },
    /// The bound is not reached.
    #[error("the bound is not reached: the error is {error:e} at {place}")]
    Coarse {
        /// The place.
        place: TablePlace,
        /// The error there.
        error: f64,
    },
    /// The bound is not reached by ε_n.
    #[error("the bound is not reached: the error of eps_n is {error:e}")]
    CoarseNormal {
        /// The largest error.
        error: f64,
    },
    /// A document is not a table: an array contradicts another one.
    #[error("{name} contradicts the other arrays at element {index}")]
    Contradiction {
        /// The array.
        name: &'static str,
        /// The first such element.
        index: usize,
    },
    /// The table has too many strips.
    #[error("more than {most} strips; expected fewer in a smaller window or with a coarser bound")]
    Many {
        /// The largest number.
        most: usize,
    },
}
