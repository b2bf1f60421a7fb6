//! An atlas of every contact law that has a name: is it complete, and are all points right?
//!
//! Windows reach in κ from 0.5 to 30 and in ψ from 0.05 to 3, undamped and with damping 0.2. Points
//! are uniform in the logarithms; each is located and compared with a collision. Fails if a point
//! is wrong.
//!
//! Run with `cargo run --release -p validation --example atlases_of_laws -- [POINTS] [PART]`;
//! 100 000 points without arguments; with PART only laws whose names contain it.

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use rayon::prelude::*;
use stickslip::model::{Collider, Damping, presets};
use stickslip::plane::atlas::{self, CollisionAtlas, Frame};
use stickslip::plane::progress::SILENT;
use stickslip::plane::{CollisionPlane, Range};

const KAPPA: Range = Range { low: 0.5, high: 30.0 };
const PSI: Range = Range { low: 0.05, high: 3.0 };

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let points: u64 = arguments.next().map_or(Ok(100_000), |argument| argument.parse())?;
    let part = arguments.next().unwrap_or_default();
    let mut seen = Vec::new();
    let mut all_wrong = 0;
    for preset in presets::ALL.iter().filter(|preset| preset.name.contains(&part)) {
        for damping in [0.0, 0.2] {
            let law = preset.law;
            if seen.contains(&(law, damping)) || (damping > 0.0 && law.damping == Damping::None) {
                continue;
            }
            seen.push((law, damping));
            print!("{} a = {damping}: ", preset.name);
            std::io::stdout().flush()?;
            let frame = Frame { law, ..Frame::new(KAPPA, PSI, damping) };
            let start = Instant::now();
            let found = match atlas::trace(frame, frame.tolerances().usual, SILENT) {
                Ok(found) => found,
                Err(error) => {
                    println!("{error}");
                    continue;
                }
            };
            let seconds = start.elapsed().as_secs_f64();
            let plane = frame.plane()?;
            let [wrong, open] = (0..points)
                .into_par_iter()
                .map(|point| checked(&found, &plane, point))
                .map(|checked| [checked == Some(false), checked.is_none()].map(u64::from))
                .reduce(|| [0; 2], |one, two| [one[0] + two[0], one[1] + two[1]]);
            all_wrong += wrong;
            println!(
                "{} boundaries, {} regions, {seconds:.0} s; {wrong} wrong, {open} not in a region; {}",
                found.regions.curves().len(),
                found.regions.regions().len(),
                found.objection().as_deref().unwrap_or("complete")
            );
        }
    }
    if all_wrong > 0 { Err(format!("{all_wrong} points are wrong").into()) } else { Ok(()) }
}

/// Whether the atlas is right at a random point; `None` where it names no region.
fn checked(atlas: &CollisionAtlas, plane: &CollisionPlane, seed: u64) -> Option<bool> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut value = |Range { low, high }: Range| low * (high / low).powf(random.f64());
    let contact = plane.contact(&plane.point(value(KAPPA), value(PSI))).ok()?;
    let region = atlas.locate([contact.kappa(), contact.psi()]).region.ok()?;
    let collision = Collider::default().collide(contact).ok()?;
    Some(atlas.itinerary(region) == collision.itinerary())
}
