//! A file of collisions, which is read in portions, computed in parallel, and written in the order
//! of the input.

use rayon::prelude::*;
use stickslip_model::{Engine, Switch};

use crate::error::Failure;
use crate::input::rows::{Columns, Input, Row};
use crate::output::csv::CsvFile;
use crate::output::file::publish;
use crate::output::progress::Bar;
use crate::output::rows::{self, EVENTS, Summary};
use crate::plan::BatchPlan;
use crate::threads;

/// Computes every row of the input.
///
/// # Errors
/// The input cannot be used, an output cannot be written, or some rows have no result. In the last
/// case the outputs are complete.
pub fn run(plan: &BatchPlan) -> Result<(), Failure> {
    let mut input = Input::open(&plan.input, &plan.given, &Columns::COLLISIONS)?;
    let pool = threads::pool(plan.threads)?;
    let mut results = CsvFile::create(&plan.out)?;
    let mut events = plan.events.as_deref().map(CsvFile::create).transpose()?;
    results.write(|out| rows::write_header(out, input.header()))?;
    if let Some(events) = &mut events {
        events.write(|out| out.write_record(EVENTS))?;
    }

    let bar = Bar::bytes(input.size());
    let (mut count, mut failed) = (0, 0);
    let (mut portion, mut computed) = (Vec::new(), Vec::new());
    loop {
        input.read_portion(&mut portion)?;
        if portion.is_empty()
            || [Some(&results), events.as_ref()].into_iter().flatten().all(CsvFile::is_unheard)
        {
            break;
        }
        pool.install(|| compute(plan.engine, &portion, events.is_some(), &mut computed));
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
        bar.reach(input.position());
    }
    drop(bar);

    let stored = [Some(results), events].into_iter().flatten().map(CsvFile::store);
    publish(stored.collect::<Result<Vec<_>, _>>()?)?;
    if failed > 0 {
        return Err(Failure::Rows { failed, rows: count, path: plan.out.clone() });
    }
    Ok(())
}

/// The results of a row with its switches, if they are wanted, or the reason why it has none.
type Computed = Result<(Summary, Vec<Switch>), String>;

/// Computes a portion. Rows do not depend on each other, and so results do not depend on the order
/// of the work.
fn compute(engine: Engine, portion: &[Row], with_switches: bool, computed: &mut Vec<Computed>) {
    portion
        .par_iter()
        .map(|row| {
            let contact = row.contact.clone()?;
            let (collision, _) = engine.collide(contact).map_err(|e| e.to_string())?;
            let summary = Summary::from(&collision);
            let switches = if with_switches { collision.switches.to_vec() } else { Vec::new() };
            Ok((summary, switches))
        })
        .collect_into_vec(computed);
}
