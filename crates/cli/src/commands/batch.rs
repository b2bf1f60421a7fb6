//! A file of collisions, which is read in portions, computed in parallel, and written in the order
//! of the input.

use rayon::prelude::*;

use crate::error::Failure;
use crate::input::rows::{Columns, Input, Row};
use crate::output::csv::{CsvFile, Rows};
use crate::output::file::publish;
use crate::output::progress::Bar;
use crate::output::rows::{self, ESTIMATES, EVENTS, RESULTS};
use crate::plan::BatchPlan;
use crate::threads;

/// Largest number of rows that are computed as one piece of work.
const ROWS_AT_ONCE: usize = 128;
/// Rows are computed together until their collisions have about this many switches, which take
/// 100 MB as text. The memory of more rows is then that of the largest collision.
const SWITCHES: f64 = 1e6;

/// Computes every row of the input.
///
/// # Errors
/// The input cannot be used, an output cannot be written, or some rows have no result. In the last
/// case the outputs are complete.
pub fn run(plan: &BatchPlan) -> Result<(), Failure> {
    let names: &[&str] = if plan.estimate { &ESTIMATED } else { &RESULTS };
    let mut input = Input::open(&plan.input, &plan.given, &Columns::of_collisions(names))?;
    let pool = threads::pool(plan.threads)?;
    let mut results = CsvFile::create(&plan.out)?;
    let mut events = plan.events.as_deref().map(CsvFile::create).transpose()?;
    results
        .write(&header(input.header().iter().chain(names.iter().map(|name| name.as_bytes()))))?;
    if let Some(events) = &mut events {
        events.write(&header(EVENTS))?;
    }

    let bar = Bar::bytes(input.size());
    let (mut count, mut failed) = (0, 0);
    let (mut portion, mut next, mut computed) = (Vec::new(), Vec::new(), Vec::new());
    pool.install(|| input.read_portion(&mut portion))?;
    while !portion.is_empty() {
        let position = input.position();
        let mut rest = &portion[..];
        while !rest.is_empty() {
            let (present, later) = rest.split_at(together(rest));
            // The next portion is read while the last rows of this one are computed.
            let compute = || compute(plan, present, count, &mut computed);
            let read = || if later.is_empty() { input.read_portion(&mut next) } else { Ok(()) };
            let ((), read) = pool.join(compute, read);
            for part in &computed {
                results.write(&part.results)?;
                if let Some(events) = &mut events {
                    events.write(&part.events)?;
                }
                failed += part.failed;
            }
            read?;
            count += present.len() as u64;
            rest = later;
        }
        if [Some(&results), events.as_ref()].into_iter().flatten().all(CsvFile::is_unheard) {
            break;
        }
        std::mem::swap(&mut portion, &mut next);
        bar.reach(position);
    }
    drop(bar);

    let stored = [Some(results), events].into_iter().flatten().map(CsvFile::store);
    publish(stored.collect::<Result<Vec<_>, _>>()?)?;
    if failed > 0 {
        return Err(Failure::Rows { failed, rows: count, path: plan.out.clone() });
    }
    Ok(())
}

/// The columns of results with estimates.
const ESTIMATED: [&str; RESULTS.len() + ESTIMATES.len()] = {
    let mut names = [""; RESULTS.len() + ESTIMATES.len()];
    names.split_at_mut(RESULTS.len()).0.copy_from_slice(&RESULTS);
    names.split_at_mut(RESULTS.len()).1.copy_from_slice(&ESTIMATES);
    names
};

/// The header of a file.
fn header<T: AsRef<[u8]>>(names: impl IntoIterator<Item = T>) -> Rows {
    let mut header = Rows::default();
    header.fields(names);
    header.end();
    header
}

/// The number of the first `rows` that are computed together.
fn together(rows: &[Row]) -> usize {
    let mut switches = 0.0;
    let fits = rows.iter().take_while(|row| {
        let before = switches;
        // Without damping the number of switches grows as √κ t_c/π.
        switches += row.contact.as_ref().map_or(0.0, |contact| contact.kappa().sqrt());
        before < SWITCHES
    });
    fits.count()
}

/// What successive rows of the input make.
#[derive(Default)]
struct Computed {
    results: Rows,
    events: Rows,
    /// The number of rows without a result.
    failed: u64,
}

/// Computes `rows`, the first of which is the case `first`. Rows do not depend on each other, and
/// so results do not depend on the order of the work.
fn compute(plan: &BatchPlan, rows: &[Row], first: u64, computed: &mut Vec<Computed>) {
    let piece = piece(rows.len(), rayon::current_num_threads());
    computed.resize_with(rows.len().div_ceil(piece), Computed::default);
    let work = computed.par_iter_mut().zip(rows.par_chunks(piece)).enumerate();
    work.for_each(|(index, (part, rows))| {
        part.results.clear();
        part.events.clear();
        part.failed = 0;
        for (row, case) in rows.iter().zip(first + (index * piece) as u64..) {
            part.results.fields(&row.fields);
            if let Err(reason) = part.add(plan, row, case) {
                rows::write_failure(&mut part.results, &reason);
                if plan.estimate {
                    part.results.fields([""; ESTIMATES.len()]);
                }
                part.failed += 1;
            }
            part.results.end();
        }
    });
}

/// The number of rows in a piece of work, so that `threads` have several pieces each even where few
/// `rows` are computed together.
fn piece(rows: usize, threads: usize) -> usize {
    (rows / (4 * threads)).clamp(1, ROWS_AT_ONCE)
}

impl Computed {
    /// Adds what the row of the input with the number `case` makes, or adds nothing and returns the
    /// reason.
    fn add(&mut self, plan: &BatchPlan, row: &Row, case: u64) -> Result<(), String> {
        let contact = row.contact.clone()?;
        let (collision, _) = plan.engine.collide(contact).map_err(|error| error.to_string())?;
        let estimate = plan.estimate.then(|| plan.engine.estimate(&collision));
        match estimate {
            None => rows::write_collision(&mut self.results, &collision, "ok"),
            Some(Ok(estimate)) => {
                rows::write_collision(&mut self.results, &collision, "ok");
                rows::write_estimate(&mut self.results, &estimate);
            }
            Some(Err(error)) => {
                let status = format!("no estimate: {error}");
                rows::write_collision(&mut self.results, &collision, &status);
                self.results.fields([""; ESTIMATES.len()]);
                self.failed += 1;
            }
        }
        if plan.events.is_some() {
            rows::write_switches(&mut self.events, case, &collision);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_rows_are_several_pieces() {
        for (rows, threads, expected) in [(1, 8, 1), (110, 4, 6), (16_384, 2, 128), (40, 1, 10)] {
            assert_eq!(piece(rows, threads), expected);
        }
    }
}
