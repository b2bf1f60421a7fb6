//! Windows with many regions are refused before they are traced.

use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_solver::Margin;
use stickslip_tracer::{
    AtlasError, AtlasOptions, Family, FamilyError, FreeRun, Itinerary, Point, Serial, Surveyor,
    TraceError, TraceOptions, Tracer, Watch, Window,
};

use crate::any::any;

/// A chessboard whose fields have numbers, as if they were those of guards. It has no margins.
struct Chessboard<'a> {
    side: f64,
    free_runs: &'a AtomicUsize,
}

impl Family for Chessboard<'_> {
    type Label = Itinerary;
    type Margin = Margin;
    type Error = FamilyError;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn label(&self, point: &Point) -> Result<Itinerary, FamilyError> {
        let number = |place: f64| (place * self.side) as usize;
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
        let free_runs = &AtomicUsize::new(0);
        let board = any(Chessboard { side: side as f64, free_runs });
        let tracer = Tracer::new(&board, &WINDOW, &TraceOptions::default()).unwrap();
        let count = tracer.count_regions(&Serial, &Watch::SILENT, 10_000);
        assert_eq!(count, side * side);
    }
}

#[test]
fn a_window_with_too_many_curves_is_refused_before_it_is_traced() {
    let trace = TraceOptions { max_curves: 500, ..TraceOptions::default() };
    let options = AtlasOptions { trace, ..AtlasOptions::default() };
    let surveyor = Surveyor { options, ..Surveyor::default() };
    let free_runs = &AtomicUsize::new(0);
    let board = any(Chessboard { side: 40.0, free_runs });
    let refused = surveyor.atlas(&board, &WINDOW).unwrap_err();
    let AtlasError::Trace(TraceError::TooManyCurves { regions, most: 500 }) = refused else {
        panic!("{refused:?}")
    };
    assert!((502..=1600).contains(&regions), "{regions}");
    assert_eq!(free_runs.load(Ordering::Relaxed), 0);
    let text = refused.to_string();
    assert!(text.contains("500 boundaries") && text.contains(&regions.to_string()), "{text}");
}
