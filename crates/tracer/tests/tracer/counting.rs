//! Windows with many regions are refused before they are traced.

use std::cell::Cell;
use std::convert::Infallible;

use stickslip_tracer::{
    AtlasError, AtlasOptions, Count, Family, FreeRun, Point, Serial, Surveyor, TraceError,
    TraceOptions, Tracer, Watch, Window,
};

/// A chessboard whose fields have numbers. It has no margins. The lines between its fields are even
/// in a power of the coordinates, so that a high power makes fields small towards one corner.
struct Chessboard {
    side: f64,
    power: i32,
    free_runs: Cell<usize>,
}

impl Chessboard {
    fn new(side: f64) -> Self {
        Self { side, power: 1, free_runs: Cell::new(0) }
    }

    fn count(&self, enough: usize) -> Count {
        let tracer = Tracer::new(self, &WINDOW, &TraceOptions::default()).unwrap();
        tracer.count(&Serial, &Watch::SILENT, enough)
    }
}

impl Family for Chessboard {
    type Label = [u32; 2];
    type Margin = ();
    type Error = Infallible;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn label(&self, point: &Point) -> Result<[u32; 2], Infallible> {
        Ok([point.x, point.y].map(|place| (place.powi(self.power) * self.side) as u32))
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
        let Count { regions, curves } = Chessboard::new(side as f64).count(10_000);
        assert_eq!(regions, side * side);
        let all = 2 * side * (side - 1);
        assert!(curves.abs_diff(all) <= all / 8, "{curves}, and not {all}");
    }
}

/// 120 lines of each kind, of which all but one cross the last tenth of a side and more than a half
/// the last twentieth: the fields there are far smaller than the places of the coarsest grid.
#[test]
fn fields_in_a_corner_are_counted() {
    let board = |side: f64| Chessboard { power: 12, ..Chessboard::new(side) };
    for enough in [5_000, 10_000] {
        let Count { curves, .. } = board(120.0).count(enough);
        assert!(curves >= enough && curves <= 2 * 120 * 119, "{curves} of {enough}");
    }
    let Count { regions, curves } = board(30.0).count(5_000);
    assert_eq!(regions, 900);
    assert!(curves.abs_diff(1740) <= 1740 / 8, "{curves}");
}

#[test]
fn a_window_with_too_many_curves_is_refused_before_it_is_traced() {
    let trace = TraceOptions { max_curves: 500, ..TraceOptions::default() };
    let options = AtlasOptions { trace, ..AtlasOptions::default() };
    let surveyor = Surveyor { options, ..Surveyor::default() };
    let board = Chessboard::new(40.0);
    let refused = surveyor.atlas(&board, &WINDOW).unwrap_err();
    let AtlasError::Trace(TraceError::TooManyCurves { regions, curves, most: 500 }) = refused
    else {
        panic!("{refused:?}")
    };
    assert!(regions <= 1600 && (501..=3120).contains(&curves), "{regions}, {curves}");
    assert_eq!(board.free_runs.get(), 0);
    let text = refused.to_string();
    assert!(text.contains("at most 500") && text.contains(&curves.to_string()), "{text}");
}
