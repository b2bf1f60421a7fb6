//! A finished map as an archive of NumPy arrays.

use std::io::{self, Write};

use crate::output::npz::{array, number, plain, text};
use rawzip::ZipArchiveWriter;
use stickslip_model::Engine;
use stickslip_plane::{Extent, Grid, Tile};

use super::provenance::{Fact, Provenance};
use super::results::Results;

/// Writes the coordinates, both arrays of results, and, as arrays without dimensions, what made
/// them. One part of the results at a time is in memory.
///
/// # Errors
/// `out` cannot be written, or a part of the results cannot be read.
pub fn write(
    out: impl Write,
    grid: &Grid,
    provenance: &Provenance,
    results: &impl Results,
) -> io::Result<()> {
    let mut archive = ZipArchiveWriter::new(out);
    let (columns, rows) = (grid.columns.cells, grid.rows.cells);
    let points = format!("{rows}, {columns}");
    for quantity in grid.quantities() {
        let (rows, columns, shape) = match grid.extent(*quantity) {
            Extent::Columns => (1, columns, &format!("{columns},")),
            Extent::Rows => (rows, 1, &format!("{rows},")),
            Extent::Points => (rows, columns, &points),
        };
        let values = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| grid.value(*quantity, column, row)));
        array(&mut archive, quantity.name(), "<f8", shape, |out| {
            values.map(f64::to_le_bytes).try_for_each(|bytes| out.write_all(&bytes))
        })?;
    }
    array(&mut archive, "eps_t", "<f8", &points, |out| {
        results.each(|_, tile| {
            tile.eps_t.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
        })
    })?;
    array(&mut archive, "switch_count", "<i4", &points, |out| {
        results.each(|_, tile| {
            tile.switch_count.iter().try_for_each(|count| out.write_all(&count.to_le_bytes()))
        })
    })?;
    for (name, fact) in &provenance.0 {
        match fact {
            Fact::Number(value) => number(&mut archive, name, *value)?,
            Fact::Text(value) => text(&mut archive, name, value)?,
        }
    }
    archive.finish().map_err(plain)?.flush()
}

/// The map of `grid` with its `results`, which `engine` computed in this `program`, as an archive
/// in memory.
///
/// # Errors
/// The archive cannot be made.
pub fn archive(grid: &Grid, engine: &Engine, results: &Tile, program: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write(&mut bytes, grid, &Provenance::new(grid, engine, program), results)?;
    Ok(bytes)
}
