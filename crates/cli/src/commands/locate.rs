//! Points, looked up in an atlas.

use stickslip_files::input::atlas::{self, AnyAtlas, RunsAtlas};
use stickslip_files::input::recipe::Given;
use stickslip_files::input::rows::{Columns, Input, TwoColumns};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::publish;
use stickslip_files::output::rows::{LOCATED, LOCATED_RUNS};
use stickslip_plane::atlas::switch_count;
use stickslip_solver::Margin;
use stickslip_tracer::{Atlas, Itinerary, Location, Point};

use crate::error::Failure;
use crate::plan::LocatePlan;
use crate::threads;

/// Locates every point of the input.
///
/// # Errors
/// The atlas or the input cannot be used, the output cannot be written, or some points cannot be
/// located. In the last case the output is complete.
pub fn run(plan: &LocatePlan) -> Result<(), Failure> {
    let atlas = match atlas::read(&plan.atlas)? {
        AnyAtlas::Collisions(atlas) => atlas,
        AnyAtlas::Runs(atlas) => return runs(plan, &atlas),
    };
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

/// Locates every point of the input in an atlas of a system of one's own.
fn runs(plan: &LocatePlan, found: &RunsAtlas) -> Result<(), Failure> {
    let RunsAtlas { atlas, axes, guards } = found;
    let points = |header: &_| TwoColumns::named(header, axes, &LOCATED_RUNS);
    let mut input = Input::open(&plan.input, points)?;
    let pool = threads::pool(Some(1))?;
    let mut table = CsvFile::create(&plan.out)?;
    let mut text = Rows::default();
    text.fields(input.header().iter().chain(LOCATED_RUNS.iter().map(|name| name.as_bytes())));
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
            text.fields(&row.fields);
            rows += 1;
            let point = row.case.as_ref().map(|&(x, y)| Point::new(x, y));
            let region = point.map_err(Clone::clone).and_then(|point| {
                region_of(atlas, &point).map_err(|why| {
                    let [x, y] = axes;
                    format!("row {rows}: {x} = {}, {y} = {} {why}", point.x, point.y)
                })
            });
            match region {
                Ok((region, label)) => {
                    let (count, itinerary) = itinerary(label, guards);
                    text.field(count);
                    text.field(itinerary);
                    text.count(region);
                }
                Err(reason) => {
                    text.fields([""; LOCATED_RUNS.len() - 1]);
                    failed += 1;
                    first.get_or_insert(reason);
                }
            }
            match point.ok().and_then(|point| atlas.plane.vertical_distance(&point)) {
                Some(distance) => text.number(distance),
                None => text.field(""),
            }
            text.end();
        }
    }
    publish([table.store()?])?;
    match first {
        Some(first) => Err(Failure::Unlocated { failed, rows, path: plan.out.clone(), first }),
        None => Ok(()),
    }
}

/// The region of a point, and what runs do there, or why that is not known.
fn region_of<'a>(
    atlas: &'a Atlas<Itinerary, Margin>,
    point: &Point,
) -> Result<(usize, &'a Itinerary), &'static str> {
    match atlas.plane.locate(point) {
        Location::Outside => Err("lies outside the window"),
        Location::OnBoundary { .. } => Err("lies on a boundary within its error"),
        Location::Region(region) if atlas.is_doubtful(region) => Err("lies in a region in doubt"),
        Location::Region(region) => {
            let label = atlas.plane.regions()[region].label.as_ref();
            label.map(|label| (region, label)).ok_or("lies in a region that is not known")
        }
    }
}

/// The number of events and their names.
fn itinerary(label: &Itinerary, guards: &[String]) -> (String, String) {
    let Some(fired) = label.fired() else {
        let word = match label {
            Itinerary::Accumulates => "accumulates",
            Itinerary::Fails => "fails",
            _ => "unfinished",
        };
        return (String::new(), word.to_owned());
    };
    let name = |&guard: &usize| guards.get(guard).map_or("", String::as_str);
    let names: Vec<&str> = fired.iter().map(name).collect();
    let goes_on = matches!(label, Itinerary::Begins(_));
    let more = if goes_on { "; …" } else { "" };
    (fired.len().to_string(), format!("{}{more}", names.join("; ")))
}
