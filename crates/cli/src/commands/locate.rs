//! Points, looked up in an atlas.

use stickslip_files::input::atlas;
use stickslip_files::input::recipe::Given;
use stickslip_files::input::rows::{Columns, Input};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::publish;
use stickslip_files::output::rows::LOCATED;
use stickslip_plane::atlas::switch_count;

use crate::error::Failure;
use crate::plan::LocatePlan;
use crate::threads;

/// Locates every point of the input.
///
/// # Errors
/// The atlas or the input cannot be used, the output cannot be written, or some points cannot be
/// located. In the last case the output is complete.
pub fn run(plan: &LocatePlan) -> Result<(), Failure> {
    let atlas = atlas::read(&plan.atlas)?;
    let points = |header: &_| Columns::POINTS.recipe(header, &Given::default());
    let mut input = Input::open(&plan.input, points)?;
    let pool = threads::pool(Some(1))?;
    let mut table = CsvFile::create(&plan.out)?;
    let mut text = Rows::default();
    text.fields(input.header().iter().chain(LOCATED.iter().map(|name| name.as_bytes())));
    text.end();
    let (mut rows, mut failed, mut first) = (0, 0, None);
    let mut portion = Vec::new();
    loop {
        table.write(&std::mem::take(&mut text))?;
        pool.install(|| input.read_portion(&mut portion))?;
        if portion.is_empty() {
            break;
        }
        for row in &portion {
            let located = row.case.as_ref().map(|contact| atlas.locate(contact));
            let distance = located.as_ref().ok().and_then(|located| located.distance);
            let region = match located {
                Ok(located) => located.region.map_err(|why| format!("row {}: {why}", rows + 1)),
                Err(reason) => Err(reason.clone()),
            };
            text.fields(&row.fields);
            if let Ok(region) = region {
                let itinerary = atlas.itinerary(region);
                text.count(switch_count(itinerary));
                text.field(itinerary);
                text.field(region.to_string());
            } else {
                text.fields([""; LOCATED.len() - 1]);
            }
            match distance {
                Some(distance) => text.number(distance),
                None => text.field(""),
            }
            text.end();
            rows += 1;
            if let Err(reason) = region {
                failed += 1;
                first.get_or_insert(reason);
            }
        }
    }
    publish([table.store()?])?;
    match first {
        Some(first) => Err(Failure::Unlocated { failed, rows, path: plan.out.clone(), first }),
        None => Ok(()),
    }
}
