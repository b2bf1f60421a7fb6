//! A finished map as an archive of NumPy arrays.
//!
//! The arrays have the format .npy 1.0 as in numpy/lib/format.py. They are stored without
//! compression in a ZIP archive. Its entries have no time, so that the same map is always the same
//! bytes.

use std::io::{self, BufWriter, Write};

use rawzip::{Error, ErrorKind, ZipArchiveWriter};
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
            Fact::Number(value) => {
                array(&mut archive, name, "<f8", "", |out| out.write_all(&value.to_le_bytes()))?;
            }
            // In NumPy a character takes four bytes.
            Fact::Text(text) => {
                let element = format!("<U{}", text.chars().count());
                array(&mut archive, name, &element, "", |out| {
                    text.chars().try_for_each(|c| out.write_all(&u32::from(c).to_le_bytes()))
                })?;
            }
        }
    }
    archive.finish().map_err(plain)?.flush()
}

/// The map of `grid` with its `results`, which `engine` computed, as an archive in memory.
///
/// # Errors
/// The archive cannot be made.
pub fn archive(grid: &Grid, engine: &Engine, results: &Tile) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write(&mut bytes, grid, &Provenance::new(grid, engine), results)?;
    Ok(bytes)
}

/// Writes the entry `name`.npy, whose content `elements` writes.
fn array<W: Write>(
    archive: &mut ZipArchiveWriter<W>,
    name: &str,
    element: &str,
    shape: &str,
    elements: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let (mut entry, config) =
        archive.new_file(format!("{name}.npy").as_str()).start().map_err(plain)?;
    let mut buffer = BufWriter::with_capacity(1 << 16, config.wrap(&mut entry));
    buffer.write_all(&header(element, shape))?;
    elements(&mut buffer)?;
    let (_, descriptor) = buffer.into_inner()?.finish().map_err(plain)?;
    entry.finish(descriptor).map_err(plain)?;
    Ok(())
}

/// The header of a .npy file. It is padded so that the elements begin at a multiple of 64 bytes.
fn header(element: &str, shape: &str) -> Vec<u8> {
    const FIXED: usize = 10;
    let mut text =
        format!("{{'descr': '{element}', 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (FIXED + text.len() + 1).next_multiple_of(64) - FIXED;
    text = format!("{text:<width$}\n", width = length - 1);
    // The shape has at most two numbers of eleven digits, so that the length is far below 65536.
    let [low, high, ..] = length.to_le_bytes();
    [b"\x93NUMPY\x01\x00", &[low, high][..], text.as_bytes()].concat()
}

/// The error of the file or, if the archive is wrong, an error that says so.
fn plain(error: Error) -> io::Error {
    match error.into_kind() {
        ErrorKind::IO(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_that_of_numpy() {
        // numpy.lib.format.write_array_header_1_0 of a 2 × 3 array of doubles.
        let text = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
        let expected = format!("{text}{}\n", " ".repeat(118 - text.len() - 1));
        let header = header("<f8", "2, 3");
        assert_eq!(header[..10], *b"\x93NUMPY\x01\x00\x76\x00");
        assert_eq!(String::from_utf8_lossy(&header[10..]), expected);
    }
}
