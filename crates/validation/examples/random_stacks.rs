//! Random stacks over the damping: is each complete, and do atlases traced directly between its
//! dampings have the regions that its changes leave?
//!
//! Windows are log-uniform: κ from 0.05 to 20 up to five times that, ψ from 0.05 to 2 up to twenty
//! times that; so are the four dampings, from 1e-6 to 5. An atlas is traced in the middle, in the
//! logarithm, between neighbouring ones, unless a bracket of a change holds it or the lower of the
//! two. Fails if anything speaks against a stack or an atlas, or if regions are others.
//!
//! Run with `cargo run --release -p validation --example random_stacks -- [STACKS] [FIRST]`; 25
//! stacks without arguments.

use std::collections::BTreeMap;
use std::error::Error;

use stickslip::plane::Range;
use stickslip::plane::atlas::{self, Frame};
use stickslip::plane::progress::SILENT;
use stickslip::plane::stack::{DampingLayer, DampingStack, stack};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut count = |usual: u64| arguments.next().map_or(Ok(usual), |argument| argument.parse());
    let (stacks, first) = (count(25)?, count(0)?);
    let mut complete = 0;
    for number in first..first + stacks {
        let mut random = fastrand::Rng::with_seed(number);
        let mut log_uniform = |low: f64, high: f64| low * (high / low).powf(random.f64());
        let mut range = |low, high, most| {
            let low = log_uniform(low, high);
            Range { low, high: low * log_uniform(1.2, most) }
        };
        let frame = Frame::new(range(0.05, 20.0, 5.0), range(0.05, 2.0, 20.0), 0.0);
        let mut dampings = [0; 4].map(|_| log_uniform(1e-6, 5.0));
        dampings.sort_by(f64::total_cmp);
        let tolerance = frame.tolerances().usual;
        let made = stack(frame, &dampings, tolerance, SILENT)?;
        let mut objections: Vec<String> = made.objection().into_iter().collect();
        let mut compared = 0;
        for pair in made.layers.windows(2) {
            let damping = (pair[0].damping * pair[1].damping).sqrt();
            let Some(expected) = regions(&made, &pair[0], damping) else { continue };
            let atlas = atlas::trace(Frame { damping, ..frame }, tolerance, SILENT)?;
            objections.extend(atlas.objection());
            let direct = DampingLayer { damping, atlas, as_stacked: None };
            if signed(&direct) != expected {
                objections.push(format!("at {damping:?} there are other regions"));
            }
            compared += 1;
        }
        println!(
            "{number:4} κ {:?}:{:?} ψ {:?}:{:?} a {dampings:?}: {} changes, {} atlases, {compared} \
             beside: {objections:?}",
            frame.kappa.low,
            frame.kappa.high,
            frame.psi.low,
            frame.psi.high,
            made.changes.len(),
            made.atlases
        );
        complete += u64::from(objections.is_empty());
    }
    println!("{complete} of {stacks} complete");
    if complete == stacks { Ok(()) } else { Err("something speaks against a stack".into()) }
}

/// The numbers of regions at a damping, from those of the layer before it and the changes between
/// the two; `None` inside the bracket of a change.
fn regions(
    stack: &DampingStack,
    before: &DampingLayer,
    damping: f64,
) -> Option<BTreeMap<String, i64>> {
    let mut counts = signed(before);
    for change in &stack.changes {
        let [low, high] = change.between;
        if high < before.damping || low > damping {
            continue;
        }
        if low < before.damping || high > damping {
            return None;
        }
        for effect in &change.effects {
            let count: &mut i64 = counts.entry(effect.label().clone()).or_default();
            *count += if matches!(effect.name(), "born" | "splits") { 1 } else { -1 };
        }
    }
    counts.retain(|_, count| *count != 0);
    Some(counts)
}

/// The numbers of regions of a layer.
fn signed(layer: &DampingLayer) -> BTreeMap<String, i64> {
    let signed = |count| i64::try_from(count).unwrap_or(i64::MAX);
    let counts = layer.region_counts().into_iter();
    counts.map(|(itinerary, count)| (itinerary, signed(count))).collect()
}
