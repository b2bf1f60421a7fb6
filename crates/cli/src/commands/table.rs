//! A table, made, verified and written.

use std::io::{self, Write};

use rawzip::ZipArchiveWriter;
use stickslip_practice::tables::{self, ACROSS, ALONG, Document, Table};

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
    let tables::Verification { points, largest_error, kappa, psi } = table.verification;
    let [slabs, strips] = table.pieces();
    pairs(
        out,
        &[
            ("bound of the error of ε_t", format!("{:?}", table.bound)),
            ("largest error found", format!("{largest_error:.2e} at κ = {kappa:?}, ψ = {psi:?}")),
            ("points compared", points.to_string()),
            ("pieces", format!("{strips} in {slabs} intervals of κ")),
            ("size in memory", format!("{} bytes", table.bytes())),
            ("ε_n", format!("{:?}", table.eps_n)),
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
    let line = |length: usize| format!("{length},");
    for (name, shape, values) in [
        ("kappa", line(2), &table.kappa[..]),
        ("psi", line(2), &table.psi),
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
    for (name, value) in [
        ("damping", table.damping),
        ("eps_n", table.eps_n),
        ("bound", table.bound),
        ("largest_error", table.verification.largest_error),
    ] {
        number(&mut archive, name, value)?;
    }
    text(&mut archive, "itineraries", &table.regions.join(" "))?;
    text(&mut archive, "version", &version::program())?;
    archive.finish().map_err(plain)?;
    Ok(bytes)
}
