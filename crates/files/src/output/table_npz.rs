//! Tables as archives of NumPy arrays.

use std::io;

use rawzip::ZipArchiveWriter;
use stickslip_model::Law;
use stickslip_practice::tables::{ACROSS, ALONG, RestitutionTable, TableWindow};

use super::npz::{array, number, plain, text};

/// The table that this `program` made as NumPy arrays, with the names of
/// [`Arrays`](stickslip_practice::tables::Arrays).
///
/// # Errors
/// The archive cannot be made.
pub fn archive(table: &RestitutionTable, program: &str) -> io::Result<Vec<u8>> {
    let arrays = table.arrays();
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    let graphs = format!("{}, {ALONG}", arrays.graphs.len() / ALONG);
    let rows = format!("{}, {ACROSS}", arrays.rows.len() / ACROSS);
    let normals = format!("{}, {ALONG}", arrays.normals.len() / ALONG);
    let line = |length: usize| format!("{length},");
    let ends = table.window.sides().map(|side| [side.low, side.high]);
    let [first, second] = table.window.names();
    for (name, shape, values) in [
        (first, line(2), &ends[0][..]),
        (second, line(2), &ends[1]),
        ("normals", normals, &arrays.normals),
        ("walls", line(arrays.walls.len()), &arrays.walls),
        ("scales", line(arrays.scales.len()), &arrays.scales),
        ("graphs", graphs, &arrays.graphs),
        ("rows", rows, &arrays.rows),
    ] {
        array(&mut archive, name, "<f8", &shape, |out| {
            values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
        })?;
    }
    for (name, values) in [
        ("slab_hints", &arrays.slab_hints),
        ("first_strips", &arrays.first_strips),
        ("first_rows", &arrays.first_rows),
        ("strip_regions", &arrays.regions),
    ] {
        array(&mut archive, name, "<u4", &line(values.len()), |out| {
            values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
        })?;
    }
    let shape = format!("{}, {}", arrays.scales.len(), arrays.strip_keys.count);
    array(&mut archive, "strip_hints", "<u2", &shape, |out| {
        arrays.strip_hints.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
    })?;
    for (name, values) in
        [("slab_stretches", &arrays.slab_stretches), ("strip_stretches", &arrays.strip_stretches)]
    {
        array(&mut archive, name, "<u1", &line(values.len()), |out| {
            values.iter().try_for_each(|value| out.write_all(&[*value as u8]))
        })?;
    }
    for (name, keys) in [("slab_keys", arrays.slab_keys), ("strip_keys", arrays.strip_keys)] {
        array(&mut archive, name, "<u8", "2,", |out| {
            out.write_all(&u64::from(keys.shift).to_le_bytes())?;
            out.write_all(&keys.first.to_le_bytes())
        })?;
    }
    let mut numbers = vec![
        ("bound", table.bound),
        ("largest_error", table.verification.largest_error),
        ("largest_error_of_eps_n", table.verification.largest_error_of_eps_n),
    ];
    match table.window {
        TableWindow::Scaled { damping, law, tangential_damping, .. } => {
            numbers.push(("damping", damping));
            if law != Law::PAPER {
                numbers.push(("tangential_damping", tangential_damping));
                text(&mut archive, "law", &serde_json::to_string(&law)?)?;
            }
        }
        TableWindow::Velocities { pair, .. } => {
            text(&mut archive, "pair", &serde_json::to_string(&pair)?)?;
        }
    }
    numbers.extend(table.constant_eps_n.map(|eps_n| ("eps_n", eps_n)));
    for (name, value) in numbers {
        number(&mut archive, name, value)?;
    }
    text(&mut archive, "itineraries", &table.regions.join(" "))?;
    text(&mut archive, "version", program)?;
    archive.finish().map_err(plain)?;
    Ok(bytes)
}
