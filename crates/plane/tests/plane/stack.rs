//! Atlases over the damping.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use stickslip_model::exact;
use stickslip_model::regularized::SAME_SIDE;
use stickslip_model::{Contact, InvalidValue};
use stickslip_plane::atlas::{AtlasError, Frame, trace};
use stickslip_plane::progress::SILENT;
use stickslip_plane::stack::{DampingLayer, DampingStack, stack};
use stickslip_solver::margin::{Hint, Margin, Place};
use stickslip_tracer::stack::Change;

use crate::windows::frame;

fn made(dampings: &[f64]) -> Result<DampingStack, AtlasError> {
    let frame = frame((5.0, 20.0), (0.2, 2.5));
    stack(frame, dampings, frame.tolerances().usual, SILENT)
}

/// Where special points meet.
struct Met {
    kind: &'static str,
    damping: f64,
    kappa: f64,
    psi: f64,
}

fn met(stack: &DampingStack, change: &Change<String>) -> Option<Met> {
    let meeting = change.meeting?;
    let [kappa, psi] = stack.plane.sheet().snapped(&meeting.point);
    Some(Met { kind: meeting.kind.name(), damping: meeting.value, kappa, psi })
}

/// A stack that several tests share.
static STACK: LazyLock<DampingStack> = LazyLock::new(|| made(&[0.0, 0.05, 0.2, 0.4]).unwrap());

/// Between two atlases that were traced directly, the number of regions with each itinerary changes
/// as the changes between them say.
#[test]
fn changes_lead_from_one_atlas_to_the_next() {
    let stack = &*STACK;
    assert_eq!(stack.objection(), None);
    assert!(!stack.changes.is_empty());
    assert_eq!(stack.layers[0].as_stacked, None);
    let mut undamped = stack.layers[0].region_counts();
    undamped.retain(|itinerary, _| stack.layers[1].region_counts().contains_key(itinerary));
    assert!(undamped.is_empty(), "{undamped:?}");
    for pair in stack.layers[1..].windows(2) {
        assert_eq!(pair[1].as_stacked, Some(true));
        let [low, high] = [pair[0].damping, pair[1].damping];
        let mut counts: BTreeMap<String, i64> = BTreeMap::new();
        let mut add = |itinerary: &str, count: i64| {
            *counts.entry(itinerary.to_owned()).or_default() += count;
        };
        for (itinerary, count) in pair[0].region_counts() {
            add(&itinerary, i64::try_from(count).unwrap());
        }
        for change in &stack.changes {
            let [from, to] = change.between;
            assert!(from < to && to - from < 1e-3 * to, "{change:?}");
            if from < low || to > high {
                continue;
            }
            for effect in &change.effects {
                add(
                    effect.label(),
                    if ["born", "splits"].contains(&effect.name()) { 1 } else { -1 },
                );
            }
        }
        for (itinerary, count) in pair[1].region_counts() {
            add(&itinerary, -i64::try_from(count).unwrap());
        }
        counts.retain(|_, count| *count != 0);
        assert!(counts.is_empty(), "{low} to {high}: {counts:?} in {:?}", stack.changes);
    }
}

/// Where a region is born, a collision beside the place has its switches a little later, and none
/// has them before.
#[test]
fn the_itinerary_of_a_region_appears_where_it_is_born() -> Result<(), InvalidValue> {
    let mut tried = 0;
    for change in &STACK.changes {
        let Some(meeting) = met(&STACK, change) else { continue };
        let [low, high] = change.between;
        assert!(low < meeting.damping && meeting.damping < high);
        for effect in change.effects.iter().filter(|effect| effect.name() == "born") {
            tried += 1;
            let seen = |damping: f64| -> Result<bool, InvalidValue> {
                for (i, j) in (-60..=60).flat_map(|i| (-60..=60).map(move |j| (i, j))) {
                    let kappa = meeting.kappa * (1.0 + 1e-4 * f64::from(i));
                    let psi = meeting.psi * (1.0 + 1e-4 * f64::from(j));
                    if !((5.0..=20.0).contains(&kappa) && (0.2..=2.5).contains(&psi)) {
                        continue;
                    }
                    let collision = exact::collide(Contact::new(kappa, psi, damping)?).unwrap();
                    if collision.itinerary() == *effect.label() {
                        return Ok(true);
                    }
                }
                Ok(false)
            };
            assert!(seen(meeting.damping * 1.01)?, "{change:?}");
            assert!(!seen(meeting.damping * 0.99)?, "{change:?}");
        }
    }
    assert!(tried > 0, "{:?}", STACK.changes);
    Ok(())
}

/// Two cusps and the crossing between them become one point: the region between them dies, of which
/// atlases closer than about 1e-4 to the damping do not tell. P, D and W vanish where the turns
/// meet.
#[test]
fn a_region_dies_in_a_swallowtail() -> Result<(), InvalidValue> {
    dies_in_a_swallowtail((1.0, 5.0), (0.5, 1.0))
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_region_dies_in_a_swallowtail_of_a_wider_window() -> Result<(), InvalidValue> {
    dies_in_a_swallowtail((0.8, 12.0), (0.2, 1.5))
}

fn dies_in_a_swallowtail(kappa: (f64, f64), psi: (f64, f64)) -> Result<(), InvalidValue> {
    let window = frame(kappa, psi);
    let tolerance = window.tolerances().usual;
    let stack = stack(window, &[0.41, 0.4108, 0.412], tolerance, SILENT).unwrap();
    assert_eq!(stack.objection(), None, "{:?}", stack.changes);
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let [effect] = &change.effects[..] else { panic!("{change:?}") };
    assert_eq!((effect.name(), &effect.label()[..]), ("dies", "o+o+o-"));
    let meeting = met(&stack, change).unwrap();
    assert_eq!(meeting.kind, "swallowtail");
    let [low, high] = change.between;
    assert!(low < meeting.damping && meeting.damping < high, "{change:?}");
    let place = Contact::new(meeting.kappa, meeting.psi, meeting.damping)?;
    let top = Margin {
        exits: Vec::new(),
        guard: SAME_SIDE,
        place: Place::Minimum { near: Hint(2.0), number: 1 },
    };
    for margin in exact::swallowtail(&place, &top).unwrap() {
        let value = exact::margin(&place, &margin).unwrap().unwrap();
        assert!(value.abs() < 1e-11, "{margin:?} {value:e}");
    }
    for (damping, expected) in [(low, 1), (high, 0)] {
        let counts = |layer: &DampingLayer| layer.region_counts().get("o+o+o-").copied();
        let direct = trace(Frame { damping, ..window }, tolerance, SILENT).unwrap();
        assert_eq!(direct.objection(), None);
        let layer = DampingLayer { damping, atlas: direct, as_stacked: None };
        let others = counts(&stack.layers[2]).unwrap_or(0);
        assert_eq!(counts(&layer).unwrap_or(0), others + expected, "{damping}");
    }
    Ok(())
}

/// Another meeting of the same boundaries is a ten-thousandth of the damping beside this one, where
/// a graze leaves through an end and through the edge of the window.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_meeting_beside_a_change_is_not_its_cause() {
    let window = frame((0.5, 30.0), (0.05, 2.0));
    let tolerance = window.tolerances().usual;
    let stack = stack(window, &[4e-4, 0.002], tolerance, SILENT).unwrap();
    assert_eq!(stack.objection(), None, "{:?}", stack.changes);
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let meeting = met(&stack, change).unwrap();
    let [low, high] = change.between;
    assert!(high - low < 2e-4 * low && low < meeting.damping && meeting.damping < high);
    let regions = [0.99995, 1.00005].map(|part| {
        let damping = part * meeting.damping;
        let direct = trace(Frame { damping, ..window }, tolerance, SILENT).unwrap();
        assert_eq!(direct.objection(), None);
        direct.regions.regions().len()
    });
    assert_eq!(regions, [15, 16], "{change:?}");
}

/// Behind the change, the crossing is a few 1e-8 inside the window, and the region that is born
/// reaches the edge a few 1e-7 beside it.
#[test]
fn a_region_is_born_in_a_sharp_crossing_on_the_edge() {
    let window = frame((0.3, 0.6), (0.01, 0.5));
    let stack = stack(window, &[4.59e-6, 4.6e-6], window.tolerances().usual, SILENT).unwrap();
    assert_eq!(stack.objection(), None, "{:?}", stack.changes);
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let meeting = met(&stack, change).unwrap();
    assert_eq!((meeting.kind, meeting.psi), ("edge", 0.01));
    let [low, high] = change.between;
    assert!(high - low < 1.1e-5 * low && low < meeting.damping && meeting.damping < high);
}

/// A layer that was not compared with the changes, and is not inside one, speaks against the stack.
#[test]
fn a_layer_that_was_not_compared_is_an_objection() {
    let mut stack = STACK.clone();
    assert_eq!(stack.objection(), None);
    assert_eq!(stack.layers[2].damping, 0.2);
    stack.layers[2].as_stacked = None;
    let reason = stack.objection().unwrap();
    assert_eq!(reason, "damping = 0.2: changes on both sides are not known");
}

#[test]
fn dampings_ascend_from_above_zero() {
    for dampings in [&[][..], &[0.0, 0.1], &[0.2, 0.1], &[0.1, 0.0, 0.2], &[-0.1, 0.1], &[0.1]] {
        let refused = AtlasError::Dampings { dampings: dampings.to_vec() };
        assert_eq!(made(dampings).unwrap_err(), refused);
    }
}
