//! A finished map as a table, one row a point.

use std::io::{self, Write};

use csv::Writer;

use crate::map::plane::Plane;
use crate::map::results::Results;

/// Writes the header and one row a point, row of the map by row.
///
/// # Errors
/// `out` cannot be written, or a piece of the results cannot be read.
pub fn write(out: impl Write, plane: &Plane, results: &impl Results) -> io::Result<()> {
    let mut writer = Writer::from_writer(out);
    let quantities = plane.quantities();
    let names = quantities.iter().map(|quantity| quantity.name());
    writer.write_record(names.chain(["eps_t", "switch_count"]))?;
    results.each(|points, tile| {
        for (point, (eps_t, count)) in points.zip(tile.eps_t.iter().zip(&tile.switch_count)) {
            let (column, row) = plane.cell(point);
            for quantity in quantities {
                writer.write_field(format!("{:?}", plane.value(*quantity, column, row)))?;
            }
            writer.write_record([format!("{eps_t:?}"), count.to_string()])?;
        }
        Ok(())
    })?;
    writer.flush()
}
