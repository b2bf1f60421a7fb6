//! A table, made, verified and written.

use std::io::{self, Write};

use stickslip_files::output::file::{OutputFile, publish};
use stickslip_files::output::{json, table_npz};
use stickslip_practice::tables::{self, Document, Table, Verification, Window};

use crate::error::Failure;
use crate::output::console::print;
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
            TableFormat::Npz => table_npz::archive(&table, &version::program()),
            TableFormat::Header => {
                table.c_header(&plan.prefix).map(String::into_bytes).map_err(io::Error::other)
            }
        };
        let content = content.map_err(|error| file.failure(error))?;
        file.finish(&content)
    });
    publish(stored.collect::<Result<Vec<_>, _>>()?)?;
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
