//! One boundary, followed with monitors, against closed forms.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_tracer::{
    Family, FreeRun, Point, Progress, TraceError, TraceOptions, VertexKind, Watch, Window,
    tracing::{End, Monitor, follow},
};

use crate::any::any;
use crate::guards::{Failed, Label, Margin};

/// A guard that fires inside the circle of radius ½ around the origin.
struct Disc;

impl Family for Disc {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok(vec![point.norm() < 0.5])
    }
    fn margin(&self, point: &Point, _: &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(point.norm() - 0.5))
    }
    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let margins = vec![((0, Vec::new()), point.norm() - 0.5)];
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}

const PLACES: [Point; 2] = [Point::new(0.0, 0.1), Point::new(0.3, 0.9)];

fn window(side: f64) -> Window {
    Window { low: Point::new(-side, -1.0), high: Point::new(side, 1.0) }
}

/// All around the circle: a wave whose six zeros are known, a jump, and what is not a number in
/// parts.
#[test]
fn monitors_of_a_closed_boundary_have_their_zeros() {
    let angle = |point: &Point| point.y.atan2(point.x);
    let wave = |point: &Point| (3.0 * angle(point) + 0.1).sin();
    let jump = |point: &Point| if point.x > 0.07 { 1.0 } else { -1.0 };
    let hole = |point: &Point| if point.x.abs() < 0.4 { f64::NAN } else { point.x };
    let options = TraceOptions::default();
    let monitors: [Monitor<'_>; 3] = [&wave, &jump, &hole];
    let found = follow(&any(Disc), &window(1.0), &options, &PLACES, &monitors, Watch::SILENT);
    let found = found.unwrap().unwrap();
    assert!(found.ends.is_none());
    assert_eq!(found.sides, [[false], [true]], "the margin is positive on the left");
    assert_eq!(found.nodes[0].point, found.nodes[found.nodes.len() - 1].point);
    let recomputed: Vec<f64> = found.nodes.iter().map(|node| wave(&node.point)).collect();
    assert_eq!(found.values[0], recomputed);
    let zeros = |monitor: usize| found.zeros.iter().filter(move |zero| zero.monitor == monitor);
    // The zeros lie at multiples of π/3, less 0.1/3.
    let turns = |zero: &Point| (3.0 * angle(zero) + 0.1) / PI;
    let mut turns: Vec<f64> = zeros(0).map(|zero| turns(&zero.point.unwrap())).collect();
    turns.sort_by(f64::total_cmp);
    assert_eq!(turns.len(), 6);
    assert!(turns.windows(2).all(|pair| pair[1] - pair[0] > 0.9), "{turns:?}");
    assert!(turns.iter().all(|turn| (turn - turn.round()).abs() < 3e-10), "{turns:?}");
    // A jump has its place, but no zero.
    assert_eq!(zeros(1).count(), 2);
    assert!(zeros(1).all(|zero| zero.point.is_none()));
    let changes = |pair: &[f64]| pair[0] * pair[1] < 0.0;
    for zero in zeros(1) {
        assert!(changes(&found.values[1][zero.node..=zero.node + 1]));
    }
    assert_eq!(zeros(2).count(), 0);
}

/// The window cuts the circle at x = ±0.3.
#[test]
fn a_boundary_that_leaves_the_window_has_both_ends() {
    let options = TraceOptions::default();
    let height = |point: &Point| point.y - 0.45;
    let steps = [AtomicUsize::new(0), AtomicUsize::new(0)];
    let report = |progress: Progress| match progress {
        Progress::Begin { steps: begun } => drop(steps[1].fetch_add(begun, Ordering::Relaxed)),
        Progress::Advance { steps: done } => drop(steps[0].fetch_add(done, Ordering::Relaxed)),
        Progress::Now { .. } => (),
    };
    let watch = Watch::from(&report);
    let found = follow(&any(Disc), &window(0.3), &options, &PLACES, &[&height], watch);
    let found = found.unwrap().unwrap();
    let [done, begun] = steps.map(AtomicUsize::into_inner);
    assert!(done == begun && done >= 2 * found.nodes.len() - 1, "{done} of {begun} steps");
    let ends = found.ends.unwrap();
    for (end, node) in ends.iter().zip([&found.nodes[0], &found.nodes[found.nodes.len() - 1]]) {
        let End::Vertex(special) = end else { panic!("{end:?}") };
        assert_eq!(special.kind, VertexKind::WindowEdge);
        assert!((node.point.x.abs() - 0.3).abs() < 1e-9 && (node.point.y - 0.4).abs() < 1e-9);
    }
    let mut places: Vec<f64> = found.zeros.iter().map(|zero| zero.point.unwrap().x).collect();
    places.sort_by(f64::total_cmp);
    let exact = (0.25_f64 - 0.45 * 0.45).sqrt();
    assert_eq!(places.len(), 2);
    assert!((places[0] + exact).abs() < 1e-10 && (places[1] - exact).abs() < 1e-10, "{places:?}");
    // Along the direction of the boundary the margin is positive, outside, on the left.
    let [first, second] = [&found.nodes[0], &found.nodes[1]];
    let along = second.point - first.point;
    assert!(Point::new(-along.y, along.x).dot(&first.point) > 0.0);
}

#[test]
fn there_is_nothing_to_follow_between_equal_labels() {
    let places = [Point::new(0.0, 0.1), Point::new(0.1, 0.0)];
    let options = TraceOptions::default();
    let found = follow(&any(Disc), &window(1.0), &options, &places, &[], Watch::SILENT);
    assert!(found.unwrap().is_none());
}

/// It ends with the run, or the value of a monitor, that is under way.
#[test]
fn a_boundary_can_be_abandoned() {
    let options = TraceOptions::default();
    let asked = AtomicUsize::new(0);
    let height = |point: &Point| point.y;
    let all = |most: usize| {
        asked.store(0, Ordering::Relaxed);
        let cancelled = || asked.fetch_add(1, Ordering::Relaxed) >= most;
        let watch = Watch::SILENT.cancelled_by(&cancelled);
        follow(&any(Disc), &window(1.0), &options, &PLACES, &[&height], watch).map(drop)
    };
    assert!(all(usize::MAX).is_ok());
    let whole = asked.load(Ordering::Relaxed);
    for most in [0, 1, whole / 2, whole - 1] {
        assert!(matches!(all(most), Err(TraceError::Cancelled)), "after {most} of {whole}");
        assert_eq!(asked.load(Ordering::Relaxed), most + 1);
    }
}
