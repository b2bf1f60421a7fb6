//! Windows with many regions are refused before they are traced.

use std::cell::Cell;
use std::convert::Infallible;

use stickslip_tracer::{
    AtlasError, AtlasOptions, Family, FreeRun, Point, Serial, Surveyor, TraceError, TraceOptions,
    Tracer, Watch, Window,
};

/// A chessboard whose fields have numbers. It has no margins.
struct Chessboard {
    side: f64,
    free_runs: Cell<usize>,
}

impl Chessboard {
    fn new(side: f64) -> Self {
        Self { side, free_runs: Cell::new(0) }
    }
}

impl Family for Chessboard {
    type Label = [u32; 2];
    type Margin = ();
    type Error = Infallible;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn label(&self, point: &Point) -> Result<[u32; 2], Infallible> {
        Ok([point.x, point.y].map(|place| (place * self.side) as u32))
    }

    fn margin(&self, _: &Point, (): &()) -> Result<Option<f64>, Infallible> {
        Ok(None)
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<[u32; 2], ()>, Infallible> {
        self.free_runs.set(self.free_runs.get() + 1);
        Ok(FreeRun { label: self.label(point)?, margins: Vec::new() })
    }
}

const WINDOW: Window = Window { low: Point::new(0.0, 0.0), high: Point::new(1.0, 1.0) };

#[test]
fn fields_are_counted() {
    for side in [1_usize, 3, 7, 20, 50] {
        let board = Chessboard::new(side as f64);
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
    let board = Chessboard::new(40.0);
    let refused = surveyor.atlas(&board, &WINDOW).unwrap_err();
    let AtlasError::Trace(TraceError::TooManyCurves { regions, most: 500 }) = refused else {
        panic!("{refused:?}")
    };
    assert!((502..=1600).contains(&regions), "{regions}");
    assert_eq!(board.free_runs.get(), 0);
    let text = refused.to_string();
    assert!(text.contains("500 boundaries") && text.contains(&regions.to_string()), "{text}");
}
