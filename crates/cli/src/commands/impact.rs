//! The impact of two bodies from a file, computed and printed.

mod table;

use std::io::{self, BufWriter, Write};

use stickslip_model::{Engine, ImpactReport};

use crate::args::{Format, ImpactArguments};
use crate::error::Failure;
use crate::input::bodies;
use crate::output::json;
use crate::schema;

/// Reads the bodies, computes their impact and prints it to standard output.
///
/// # Errors
/// The file cannot be used, the impact cannot be computed, or standard output cannot be written.
pub fn run(arguments: &ImpactArguments) -> Result<(), Failure> {
    let engine = arguments.method.engine(None)?;
    let encounter = bodies::read_encounter(&arguments.file)?;
    let damping_time_s = encounter.impact.pair.surface.damping_time_s;
    if engine == Engine::Exact && damping_time_s > 0.0 {
        return Err(Failure::Usage(format!(
            "surface.damping_time_s = {damping_time_s:?} cannot be used with --method exact, which \
             holds without damping; expected 0, or --method dop853 or dopri5"
        )));
    }
    let contact = encounter.contact();
    let failed = |source| Failure::computation(&contact, source);
    let (collision, statistics) = engine.collide(contact).map_err(failed)?;
    let impact = ImpactReport::new(&encounter, collision);
    impact.require_finite().map_err(|error| failed(error.into()))?;

    let mut out = BufWriter::new(io::stdout().lock());
    let written = match arguments.format {
        Format::Json => {
            json::write(&mut out, schema::IMPACT, &impact, &engine, statistics.as_ref())
        }
        Format::Table => table::write(&mut out, &engine, &impact, statistics.as_ref()),
    };
    Failure::unless_written(written.and_then(|()| out.flush()))
}
