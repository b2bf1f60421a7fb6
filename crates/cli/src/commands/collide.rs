//! One collision, computed, printed and drawn.

use std::io::{self, BufWriter, Write};

use stickslip_figure::pictures;

use crate::args::Format;
use crate::error::Failure;
use crate::output::file::publish;
use crate::output::{json, text};
use crate::plan::SingleCollision;
use crate::schema;

/// Computes the collision, draws it if that is wanted, and prints it to standard output.
///
/// # Errors
/// The collision cannot be computed, or the picture or standard output cannot be written.
pub fn run(point: &SingleCollision) -> Result<(), Failure> {
    let contact = point.contact;
    let failed = |source| Failure::computation(&contact, source);
    if let Some(plot) = &point.plot {
        plot.probe()?;
    }
    let (collision, statistics) = point.engine.collide(contact).map_err(failed)?;
    collision.energy.require_finite().map_err(|error| failed(error.into()))?;
    if let Some(plot) = &point.plot {
        let history = point.engine.history(contact).map_err(failed)?;
        publish([plot.write(Ok(pictures::collision::draw(&collision, &history)))?])?;
    }

    let mut out = BufWriter::new(io::stdout().lock());
    let (engine, statistics) = (&point.engine, statistics.as_ref());
    let written = match point.format {
        Format::Json => json::write(&mut out, schema::COLLISION, &collision, engine, statistics),
        Format::Table => text::write(&mut out, engine, &collision, statistics),
    };
    Failure::unless_written(written.and_then(|()| out.flush()))
}
