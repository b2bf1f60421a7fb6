//! Windows with more boundaries than are traced.

use stickslip_plane::atlas::{AtlasError, trace};
use stickslip_plane::progress::SILENT;
use stickslip_tracer::TraceError;

use crate::windows::frame;

/// Nearly all boundaries of this window lie in one corner, in a twentieth of its area in traced
/// coordinates, where each place of an even grid has other switches.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_window_from_soft_to_stiff_springs_is_refused() {
    let frame = frame((1e-4, 3e4), (0.01, 1e3));
    let refused = trace(frame, frame.tolerances().usual, SILENT).unwrap_err();
    let AtlasError::Trace(TraceError::TooManyCurves { regions, curves, most }) = refused else {
        panic!("{refused}")
    };
    assert_eq!(most, 10_000);
    assert!(curves > most && regions > 2000, "{curves} curves, {regions} regions");
}
