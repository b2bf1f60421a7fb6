//! Windows with many regions are refused before they are traced.

use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_solver::margin::Margin;
use stickslip_tracer::{
    AtlasOptions, Family, FreeRun, Point, Serial, Surveyor, TraceError, TraceOptions, Watch,
    Window,
    hybrid::{FamilyError, Itinerary},
    tracing::{Count, Tracer},
};

use crate::any::any;

/// A chessboard whose fields have numbers, as if they were those of guards. It has no margins. The
/// lines between its fields are even in a power of the coordinates, so that a high power makes
/// fields small towards one corner.
struct Chessboard<'a> {
    side: f64,
    power: i32,
    free_runs: &'a AtomicUsize,
}

/// The count of such a board.
fn count(side: f64, power: i32, enough: usize) -> Count {
    let free_runs = &AtomicUsize::new(0);
    let board = any(Chessboard { side, power, free_runs });
    let tracer = Tracer::new(&board, &WINDOW, &TraceOptions::default()).unwrap();
    tracer.count(&Serial, &Watch::SILENT, enough)
}

impl Family for Chessboard<'_> {
    type Label = Itinerary;
    type Margin = Margin;
    type Error = FamilyError;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn label(&self, point: &Point) -> Result<Itinerary, FamilyError> {
        let number = |place: f64| (place.powi(self.power) * self.side) as usize;
        Ok(Itinerary::Fires(vec![number(point.x), number(point.y)]))
    }

    fn margin(&self, _: &Point, _: &Margin) -> Result<Option<f64>, FamilyError> {
        Ok(None)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, FamilyError> {
        self.free_runs.fetch_add(1, Ordering::Relaxed);
        Ok(FreeRun { label: self.label(point)?, margins: Vec::new() })
    }
}

const WINDOW: Window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };

#[test]
fn fields_are_counted() {
    for side in [1_usize, 3, 7, 20, 50] {
        let Count { regions, curves } = count(side as f64, 1, 10_000);
        assert_eq!(regions, side * side);
        let all = 2 * side * (side - 1);
        assert!(curves.abs_diff(all) <= all / 8, "{curves}, and not {all}");
    }
}

/// 120 lines of each kind, of which all but one cross the last tenth of a side and more than a half
/// the last twentieth: the fields there are far smaller than the places of the coarsest grid.
#[test]
fn fields_in_a_corner_are_counted() {
    for enough in [5_000, 10_000] {
        let Count { curves, .. } = count(120.0, 12, enough);
        assert!(curves >= enough && curves <= 2 * 120 * 119, "{curves} of {enough}");
    }
    let Count { regions, curves } = count(30.0, 12, 5_000);
    assert_eq!(regions, 900);
    assert!(curves.abs_diff(1740) <= 1740 / 8, "{curves}");
}

#[test]
fn a_window_with_too_many_curves_is_refused_before_it_is_traced() {
    let trace = TraceOptions { max_curves: 500, ..TraceOptions::default() };
    let options = AtlasOptions { trace, ..AtlasOptions::default() };
    let surveyor = Surveyor { options, ..Surveyor::default() };
    let free_runs = &AtomicUsize::new(0);
    let board = any(Chessboard { side: 40.0, power: 1, free_runs });
    let refused = surveyor.atlas(&board, &WINDOW).unwrap_err();
    let TraceError::TooManyCurves { regions, curves, most: 500 } = refused else {
        panic!("{refused:?}")
    };
    assert!(regions <= 1600 && (501..=3120).contains(&curves), "{regions}, {curves}");
    assert_eq!(free_runs.load(Ordering::Relaxed), 0);
    let text = refused.to_string();
    assert!(text.contains("at most 500") && text.contains(&curves.to_string()), "{text}");
}
