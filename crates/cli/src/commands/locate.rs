//! Points, looked up in an atlas.

use stickslip_plane::atlas::switch_count;

use crate::error::Failure;
use crate::input::atlas;
use crate::input::recipe::Given;
use crate::input::rows::{Columns, Input};
use crate::output::csv::{CsvFile, number};
use crate::output::file::publish;
use crate::output::rows::{LOCATED, write_fields};
use crate::plan::LocatePlan;

/// Locates every point of the input.
///
/// # Errors
/// The atlas or the input cannot be used, the output cannot be written, or some points cannot be
/// located. In the last case the output is complete.
pub fn run(plan: &LocatePlan) -> Result<(), Failure> {
    let atlas = atlas::read(&plan.atlas)?;
    let mut input = Input::open(&plan.input, &Given::default(), &Columns::POINTS)?;
    let mut table = CsvFile::create(&plan.out)?;
    table.write(|out| write_fields(out, input.header(), LOCATED))?;
    let (mut rows, mut failed, mut first) = (0, 0, None);
    let mut portion = Vec::new();
    loop {
        input.read_portion(&mut portion)?;
        if portion.is_empty() {
            break;
        }
        for row in &portion {
            let located = row.contact.as_ref().map(|contact| atlas.locate(contact));
            let distance = located.as_ref().ok().and_then(|located| located.distance);
            let distance = distance.map(number).unwrap_or_default();
            let region = match located {
                Ok(located) => located.region.map_err(|why| format!("row {}: {why}", rows + 1)),
                Err(reason) => Err(reason.clone()),
            };
            let fields = match &region {
                Ok(region) => {
                    let itinerary = atlas.itinerary(*region).to_owned();
                    [switch_count(&itinerary).to_string(), itinerary, region.to_string(), distance]
                }
                Err(_) => [String::new(), String::new(), String::new(), distance],
            };
            table.write(|out| write_fields(out, &row.fields, fields.each_ref().map(|f| &**f)))?;
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
