//! Where contact laws give back more tangential energy than they took: the regions with |ε_t| above
//! 1 and their boundaries, compared with random collisions.
//!
//! Windows reach in κ from 0.5 to 30 and in ψ from 0.05 to 3, undamped. Points are uniform in the
//! logarithms. Fails if a point is wrong.
//!
//! Run with `cargo run --release -p validation --example gaining -- [POINTS] [PART]`; 100 000
//! points without arguments; with PART only laws whose names contain it.

use std::error::Error;
use std::time::Instant;

use rayon::prelude::*;
use stickslip::model::{Collider, presets};
use stickslip::plane::atlas::Frame;
use stickslip::plane::gaining::{self, Gaining};
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
        let law = preset.law;
        if !law.spring_energy().creates() || seen.contains(&law) {
            continue;
        }
        seen.push(law);
        let frame = Frame { law, ..Frame::new(KAPPA, PSI, 0.0) };
        let start = Instant::now();
        let gaining = gaining::trace(frame, frame.tolerances().usual, SILENT)?;
        let seconds = start.elapsed().as_secs_f64();
        let plane = frame.plane()?;
        let counts = (0..points)
            .into_par_iter()
            .map(|point| checked(&gaining, &plane, point))
            .map(|([truth, found], told)| {
                [truth != found, !told, truth == Some(true)].map(u64::from)
            })
            .reduce(|| [0; 3], |one, two| [0, 1, 2].map(|place| one[place] + two[place]));
        all_wrong += counts[0];
        println!(
            "{}: {} lines, {:?}, {seconds:.0} s; {} wrong, {} told by the collision, {} with |ε_t| above 1; {}",
            preset.name,
            gaining.lines().len(),
            gaining.extent(),
            counts[0],
            counts[1],
            counts[2],
            if gaining.agrees() { "complete" } else { "in doubt" }
        );
    }
    if all_wrong > 0 { Err(format!("{all_wrong} points are wrong").into()) } else { Ok(()) }
}

/// Whether |ε_t| is above 1 at a random point, and what is answered; and whether the regions told.
fn checked(gaining: &Gaining, plane: &CollisionPlane, seed: u64) -> ([Option<bool>; 2], bool) {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut value = |Range { low, high }: Range| low * (high / low).powf(random.f64());
    let contact = plane.contact(&plane.point(value(KAPPA), value(PSI))).ok();
    let collided = contact.and_then(|contact| Collider::default().collide(contact).ok());
    let truth = collided.map(|collision| collision.eps_t().abs() > 1.0);
    let told = contact.is_some_and(|contact| {
        gaining.atlas.label(&plane.point(contact.kappa(), contact.psi())).is_some()
    });
    ([truth, contact.and_then(|contact| gaining.gains(&contact))], told)
}
