//! A table, made, verified and written.

use std::io::{self, Write};

use rawzip::ZipArchiveWriter;
use stickslip_practice::tables::{self, ACROSS, ALONG, Document, Table, Verification, Window};

use crate::error::Failure;
use crate::output::console::print;
use crate::output::file::{OutputFile, publish};
use crate::output::json;
use crate::output::npz::{array, number, plain, text};
use crate::output::progress::Bar;
use crate::output::text::pairs;
use crate::plan::{TableFormat, TablePlan};
use crate::{threads, version};

/// Makes a table, writes its files and prints what it is.
///
/// # Errors
/// There is no table, or its files or standard output cannot be written.
pub fn run(plan: &TablePlan) -> Result<(), Failure> {
    let pool = threads::pool(plan.threads)?;
    let files = plan.out.iter().map(|(path, format)| Ok((OutputFile::create(path)?, *format)));
    let files = files.collect::<Result<Vec<_>, Failure>>()?;
    let bar = Bar::steps();
    let table = pool.install(|| tables::run(&plan.settings, &|progress| bar.report(progress)));
    drop(bar);
    let table = table?;
    let stored = files.into_iter().map(|(file, format)| {
        let content = match format {
            TableFormat::Json => json::line(&Document::from(&table)),
            TableFormat::Npz => archive(&table),
            TableFormat::Header => {
                table.c_header(&plan.prefix).map(String::into_bytes).map_err(io::Error::other)
            }
        };
        let content = content.map_err(|error| file.failure(error))?;
        file.finish(&content)
    });
    publish(stored.collect::<Result<Vec<_>, Failure>>()?)?;
    print(|out| summary(out, &table))
}

fn summary(out: &mut dyn Write, table: &Table) -> io::Result<()> {
    let Verification { points, largest_error, x, y, largest_error_of_eps_n } = table.verification;
    let [slabs, strips] = table.pieces();
    let (names, units) = match table.window {
        Window::Scaled { .. } => (["κ", "ψ"], ""),
        Window::Velocities { .. } => (["g_n", "g_t"], " m/s"),
    };
    let [first, second] = names;
    let normal = match table.constant_eps_n {
        Some(eps_n) => ("ε_n", format!("{eps_n:?}")),
        None => ("largest error of ε_n", format!("{largest_error_of_eps_n:.2e}")),
    };
    pairs(
        out,
        &[
            ("bound of the errors", format!("{:?}", table.bound)),
            (
                "largest error of ε_t",
                format!("{largest_error:.2e} at {first} = {x:?}{units}, {second} = {y:?}{units}"),
            ),
            normal,
            ("points compared", points.to_string()),
            ("pieces", format!("{strips} in {slabs} intervals of {first}")),
            ("size in memory", format!("{} bytes", table.bytes())),
        ],
    )
}

/// The table as NumPy arrays, with the names of [`tables::Arrays`].
fn archive(table: &Table) -> io::Result<Vec<u8>> {
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
        Window::Scaled { damping, .. } => numbers.push(("damping", damping)),
        Window::Velocities { pair, .. } => {
            text(&mut archive, "pair", &serde_json::to_string(&pair)?)?;
        }
    }
    numbers.extend(table.constant_eps_n.map(|eps_n| ("eps_n", eps_n)));
    for (name, value) in numbers {
        number(&mut archive, name, value)?;
    }
    text(&mut archive, "itineraries", &table.regions.join(" "))?;
    text(&mut archive, "version", &version::program())?;
    archive.finish().map_err(plain)?;
    Ok(bytes)
}
