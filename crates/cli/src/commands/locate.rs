//! Points looked up in an atlas.

use stickslip_model::Contact;
use stickslip_tracer::Location;

use super::frame::traced;
use super::{Atlas, switch_count};
use crate::batch::Table;
use crate::error::Failure;
use crate::input::{Columns, Input};
use crate::plan::LocatePlan;
use crate::recipe::Given;
use crate::rows::{LOCATED, number, write_fields};

/// Locates every point of the input.
///
/// # Errors
/// The atlas or the input cannot be used, the output cannot be written, or some points have no
/// place; in the last case the output is complete.
pub fn run(plan: &LocatePlan) -> Result<(), Failure> {
    let atlas = Atlas::read(&plan.atlas)?;
    let mut input = Input::open(&plan.input, &Given::default(), &Columns::POINTS)?;
    let mut table = Table::create(&plan.out)?;
    table.write(|out| write_fields(out, input.header(), LOCATED))?;
    let (mut rows, mut failed, mut first) = (0, 0, None);
    let mut portion = Vec::new();
    loop {
        input.read_portion(&mut portion)?;
        if portion.is_empty() {
            break;
        }
        for row in &portion {
            let located = match &row.contact {
                Ok(contact) => atlas.locate(contact),
                Err(reason) => Located { region: Err(reason.clone()), distance: None },
            };
            let distance = located.distance.map(number).unwrap_or_default();
            let fields = match &located.region {
                Ok(region) => {
                    let itinerary = atlas.itinerary(*region).to_owned();
                    [switch_count(&itinerary).to_string(), itinerary, region.to_string(), distance]
                }
                Err(_) => [String::new(), String::new(), String::new(), distance],
            };
            table.write(|out| write_fields(out, &row.fields, fields.each_ref().map(|f| &**f)))?;
            rows += 1;
            if let Err(reason) = located.region {
                failed += 1;
                first.get_or_insert_with(|| {
                    if row.contact.is_err() { reason } else { format!("row {rows}: {reason}") }
                });
            }
        }
    }
    let (path, file) = table.store()?;
    file.publish().map_err(|error| Failure::output(&path, error))?;
    match first {
        Some(first) => Err(Failure::Unlocated { failed, rows, path, first }),
        None => Ok(()),
    }
}

/// Where a point lies.
struct Located {
    /// The region, or why there is none.
    region: Result<usize, String>,
    /// Distance to the nearest boundary at the same κ, in ψ.
    distance: Option<f64>,
}

impl Atlas {
    fn locate(&self, contact: &Contact) -> Located {
        let (kappa, psi) = (contact.kappa(), contact.psi());
        let point = traced([kappa, psi]);
        let place = format!("kappa = {kappa:?}, psi = {psi:?}");
        let region = match self.map.locate(&point) {
            Location::Region(region) => Ok(region),
            Location::OnBoundary { curve, .. } => {
                Err(format!("{place} is on boundary {curve} within its error"))
            }
            Location::Outside => Err(format!(
                "{place} is outside the window of the atlas, kappa {:?} to {:?}, psi {:?} to {:?}",
                self.frame.kappa.low,
                self.frame.kappa.high,
                self.frame.psi.low,
                self.frame.psi.high
            )),
        };
        // ψ₂ − ψ₁ = (1 + ψ₁)(e^(y₂ − y₁) − 1): further up than down for equal distances in y.
        let [below, above] = self.map.vertical_distances(&point);
        let below = below.map(|distance| -(-distance).exp_m1());
        let nearest = [below, above.map(f64::exp_m1)].into_iter().flatten().reduce(f64::min);
        Located { region, distance: nearest.map(|part| (1.0 + psi) * part) }
    }
}
