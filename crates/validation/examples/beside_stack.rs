//! Atlases traced directly, beside a stack over the damping: each has the regions that the changes
//! of the stack leave.
//!
//! Run with `cargo run --release -p validation --example beside_stack -- STACK.json [DAMPING]…`,
//! with the file that `stickslip stack` writes. Without dampings there are up to ten, each in the
//! middle, in the logarithm, between two changes that have no atlas of the stack there: of the gaps
//! in their order the widest in each tenth. A region counts by its itinerary. Prints a Markdown
//! table, and fails if the regions are others or anything speaks against an atlas.

use std::collections::BTreeMap;
use std::error::Error;
use std::time::Instant;

use serde_json::Value;
use stickslip::plane::Range;
use stickslip::plane::atlas::{self, Frame};
use stickslip::plane::progress::SILENT;

/// The numbers of regions with each itinerary.
type Regions = BTreeMap<String, i64>;

/// A damping at which regions change, and what is added or removed.
struct Change {
    between: [f64; 2],
    effects: Vec<(String, i64)>,
}

/// What a stack says about regions.
struct Stack {
    frame: Frame,
    /// The damped atlases of the stack.
    layers: Vec<(f64, Regions)>,
    changes: Vec<Change>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("expected the file of a stack")?;
    let dampings = arguments.map(|text| text.parse()).collect::<Result<Vec<f64>, _>>()?;
    let stack = Stack::read(&serde_json::from_str(&std::fs::read_to_string(path)?)?)
        .ok_or("the file is not a stack")?;
    let dampings = if dampings.is_empty() { stack.between_changes(10) } else { dampings };
    println!("| a | curves | regions | as the stack says | objections | time |");
    println!("|---|---|---|---|---|---|");
    let mut right = true;
    for damping in dampings {
        let frame = Frame { damping, ..stack.frame };
        let start = Instant::now();
        let found = atlas::trace(frame, frame.tolerances().usual, SILENT)?;
        let seconds = start.elapsed().as_secs_f64();
        let mut regions = Regions::new();
        for region in 0..found.regions.regions().len() {
            *regions.entry(found.itinerary(region).to_owned()).or_default() += 1;
        }
        let expected =
            stack.regions(damping).ok_or("a damping is inside the bracket of a change")?;
        let objection = found.objection();
        println!(
            "| {damping:?} | {} | {} | {} | {} | {seconds:.1} s |",
            found.regions.curves().len(),
            regions.values().sum::<i64>(),
            if regions == expected { "yes" } else { "no" },
            objection.as_deref().unwrap_or("none")
        );
        if regions != expected {
            eprintln!("{damping:?}: {regions:?}, and not {expected:?}");
        }
        right &= regions == expected && objection.is_none();
    }
    if right { Ok(()) } else { Err("an atlas is not as the stack says".into()) }
}

impl Stack {
    /// What the file of a stack says; `None` if it is none.
    fn read(file: &Value) -> Option<Self> {
        let side = |name: &str| {
            Some(Range { low: file[name][0].as_f64()?, high: file[name][1].as_f64()? })
        };
        let frame = Frame::new(side("kappa")?, side("psi")?, 0.0);
        let layers = file["layers"].as_array()?.iter().map(|layer| {
            let counts = layer["regions"].as_object()?.iter();
            let regions =
                counts.map(|(itinerary, count)| Some((itinerary.clone(), count.as_i64()?)));
            Some((layer["damping"].as_f64()?, regions.collect::<Option<Regions>>()?))
        });
        let mut layers: Vec<_> = layers.collect::<Option<_>>()?;
        layers.retain(|(damping, _)| *damping > 0.0);
        let changes = file["changes"].as_array()?.iter().map(|change| {
            let place = change["meeting"]["damping"].as_f64();
            let [low, high] = [0, 1].map(|end| place.or(change["between"][end].as_f64()));
            let effects = change["effects"].as_array()?.iter().map(|effect| {
                let by = match effect["effect"].as_str()? {
                    "born" | "splits" => 1,
                    "dies" | "merge" => -1,
                    _ => return None,
                };
                Some((effect["itinerary"].as_str()?.to_owned(), by))
            });
            Some(Change { between: [low?, high?], effects: effects.collect::<Option<_>>()? })
        });
        Some(Self { frame, layers, changes: changes.collect::<Option<_>>()? })
    }

    /// The regions at a damping, from those of the last atlas before it and the changes between the
    /// two; `None` inside the bracket of a change, and below the first atlas.
    fn regions(&self, damping: f64) -> Option<Regions> {
        let (start, regions) = self.layers.iter().rfind(|(at, _)| *at <= damping)?;
        let mut regions = regions.clone();
        for Change { between: [low, high], effects } in &self.changes {
            if (*low..=*high).contains(&damping) {
                return None;
            }
            for (itinerary, by) in effects.iter().filter(|_| high > start && *high < damping) {
                *regions.entry(itinerary.clone()).or_default() += by;
            }
        }
        regions.retain(|_, count| *count != 0);
        Some(regions)
    }

    /// Dampings between changes: the gaps in their order are divided into `count` groups, and the
    /// widest of each group has one in its middle.
    fn between_changes(&self, count: usize) -> Vec<f64> {
        let gaps: Vec<[f64; 2]> = self
            .changes
            .windows(2)
            .map(|pair| [pair[0].between[1], pair[1].between[0]])
            .filter(|[low, high]| {
                let part = |at: f64| (at / low).ln() / (high / low).ln();
                let in_middle = |at: f64| (0.25..=0.75).contains(&part(at));
                high > low && !self.layers.iter().any(|(at, _)| in_middle(*at))
            })
            .collect();
        let width = |[low, high]: &&[f64; 2]| high / low;
        (0..count)
            .map(|group| &gaps[group * gaps.len() / count..(group + 1) * gaps.len() / count])
            .filter_map(|group| group.iter().max_by(|one, two| width(one).total_cmp(&width(two))))
            .map(|[low, high]| (low * high).sqrt())
            .collect()
    }
}
