//! A finished map as a table with one row per point.

use std::io::{self, Write};

use crate::output::csv::number;
use csv::Writer;
use stickslip_plane::Grid;

use super::provenance::{Fact, Provenance};
use super::results::Results;

/// Writes the header and one row per point, in the order of the rows of the map. What all points
/// have in common is repeated in each row.
///
/// # Errors
/// `out` cannot be written, or a part of the results cannot be read.
pub fn write(
    out: impl Write,
    grid: &Grid,
    provenance: &Provenance,
    results: &impl Results,
) -> io::Result<()> {
    let mut writer = Writer::from_writer(out);
    let quantities = grid.quantities();
    let names = quantities.iter().map(|quantity| quantity.name());
    let facts = provenance.0.iter().map(|(name, _)| *name);
    writer.write_record(names.chain(["eps_t", "switch_count"]).chain(facts))?;
    let facts = provenance.0.iter().map(|(_, fact)| match fact {
        Fact::Number(value) => number(*value),
        Fact::Text(text) => text.clone(),
    });
    let facts: Vec<String> = facts.collect();
    results.each(|points, tile| {
        for (point, (eps_t, count)) in points.zip(tile.eps_t.iter().zip(&tile.switch_count)) {
            let (column, row) = grid.cell(point);
            for quantity in quantities {
                writer.write_field(number(grid.value(*quantity, column, row)))?;
            }
            writer.write_field(number(*eps_t))?;
            writer.write_field(count.to_string())?;
            writer.write_record(&facts)?;
        }
        Ok(())
    })?;
    writer.flush()
}
