//! One collision, computed, printed and drawn.

use std::io::{self, BufWriter, Write};

use crate::args::Format;
use crate::engine::{require_finite, require_finite_energy};
use crate::error::Failure;
use crate::figure;
use crate::plan::Point;
use crate::{json, table};

/// Computes the collision, draws it if that is wanted, and prints it to standard output.
///
/// # Errors
/// The collision cannot be computed, or the picture or standard output cannot be written.
pub fn run(point: &Point) -> Result<(), Failure> {
    let contact = point.contact;
    let failed = |source| Failure::computation(&contact, source);
    if let Some(target) = &point.plot {
        target.check()?;
    }
    let (collision, statistics) = point.engine.collide(contact).map_err(failed)?;
    require_finite(&collision).map_err(failed)?;
    require_finite_energy(&collision.energy).map_err(failed)?;
    if let Some(target) = &point.plot {
        let history = point.engine.history(contact).map_err(failed)?;
        target.write(&figure::collision::draw(&collision, &history))?.publish()?;
    }

    let mut out = BufWriter::new(io::stdout().lock());
    let (engine, statistics) = (&point.engine, statistics.as_ref());
    let written = match point.format {
        Format::Json => json::write(&mut out, engine, &collision, statistics),
        Format::Table => table::write(&mut out, engine, &collision, statistics),
    };
    Failure::unless_written(written.and_then(|()| out.flush()))
}
