//! A file of collisions: read in portions, computed in parallel, written in the order of the input.

use std::path::{Path, PathBuf};

use csv::Writer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use stickslip_model::Switch;

use crate::engine::{Engine, require_finite};
use crate::error::Failure;
use crate::input::{Columns, Input, Row};
use crate::output::OutputFile;
use crate::plan::Batch;
use crate::rows::{self, EVENTS, Summary};

/// Computes every row of the input.
///
/// # Errors
/// The input cannot be used, an output cannot be written, or some rows have no result; in the last
/// case the outputs are complete.
pub fn run(batch: &Batch) -> Result<(), Failure> {
    let mut input = Input::open(&batch.input, &batch.given, &Columns::COLLISIONS)?;
    let pool = ThreadPoolBuilder::new().num_threads(batch.threads.unwrap_or(0)).build()?;
    let mut results = Table::create(&batch.out)?;
    let mut events = batch.events.as_deref().map(Table::create).transpose()?;
    results.write(|out| rows::write_header(out, input.header()))?;
    if let Some(events) = &mut events {
        events.write(|out| out.write_record(EVENTS))?;
    }

    let bar = progress_bar(&input);
    let (mut count, mut failed) = (0, 0);
    let (mut portion, mut computed) = (Vec::new(), Vec::new());
    loop {
        input.read_portion(&mut portion)?;
        if portion.is_empty() {
            break;
        }
        pool.install(|| compute(batch.engine, &portion, events.is_some(), &mut computed));
        for (row, result) in portion.iter().zip(&computed) {
            let summary = result.as_ref().map(|(summary, _)| summary);
            results
                .write(|out| rows::write_row(out, &row.fields, summary.map_err(String::as_str)))?;
            if let (Some(events), Ok((_, switches))) = (&mut events, result) {
                events.write(|out| rows::write_switches(out, count, switches))?;
            }
            failed += u64::from(result.is_err());
            count += 1;
        }
        bar.set_position(input.progress().1);
    }
    bar.finish_and_clear();

    let stored = [Some(results), events].into_iter().flatten().map(Table::store);
    // Every file is complete before any of them gets its name.
    let stored = stored.collect::<Result<Vec<_>, _>>()?;
    for (path, file) in stored {
        file.publish().map_err(|error| Failure::output(&path, error))?;
    }
    if failed > 0 {
        return Err(Failure::Rows { failed, rows: count, path: batch.out.clone() });
    }
    Ok(())
}

/// A row's results and, where wanted, its switches; or why there are none.
type Computed = Result<(Summary, Vec<Switch>), String>;

/// Computes a portion. Each row depends on itself alone, so that the order of work does not show.
fn compute(engine: Engine, portion: &[Row], with_switches: bool, computed: &mut Vec<Computed>) {
    portion
        .par_iter()
        .map(|row| {
            let contact = row.contact.clone()?;
            let (collision, _) = engine.collide(contact).map_err(|e| e.to_string())?;
            require_finite(&collision).map_err(|e| e.to_string())?;
            let summary = Summary::from(&collision);
            let switches = if with_switches { collision.switches.to_vec() } else { Vec::new() };
            Ok((summary, switches))
        })
        .collect_into_vec(computed);
}

/// A CSV file on its way, with the name by which the user knows it.
pub struct Table {
    path: PathBuf,
    writer: Writer<OutputFile>,
}

impl Table {
    /// Starts to write `path`.
    ///
    /// # Errors
    /// It cannot be created.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let file = OutputFile::create(path).map_err(|error| Failure::output(path, error))?;
        let writer = csv::WriterBuilder::new().flexible(true).from_writer(file);
        Ok(Self { path: path.to_owned(), writer })
    }

    /// Writes rows.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn write(
        &mut self,
        rows: impl FnOnce(&mut Writer<OutputFile>) -> csv::Result<()>,
    ) -> Result<(), Failure> {
        rows(&mut self.writer).map_err(|error| Failure::output(&self.path, error))
    }

    /// The file with all rows, which needs its name only.
    ///
    /// # Errors
    /// It cannot be stored.
    pub fn store(self) -> Result<(PathBuf, OutputFile), Failure> {
        let Self { path, mut writer } = self;
        let stored = writer
            .flush()
            .and_then(|()| writer.into_inner().map_err(|failed| failed.error().kind().into()))
            .and_then(|mut file| file.store().map(|()| file));
        match stored {
            Ok(file) => Ok((path, file)),
            Err(error) => Err(Failure::output(&path, error)),
        }
    }
}

/// Shows itself on a terminal only.
fn progress_bar(input: &Input) -> ProgressBar {
    const TEMPLATE: &str = "{bar:40} {percent}% of {total_bytes}, {eta} left";
    let style = ProgressStyle::with_template(TEMPLATE);
    let target = ProgressDrawTarget::stderr();
    ProgressBar::with_draw_target(Some(input.progress().0), target)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
