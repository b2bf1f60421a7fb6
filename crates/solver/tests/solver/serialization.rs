//! The JSON of results.

use serde_json::to_string;
use stickslip_solver::{Grazing, Outcome, Statistics, fit_order};

#[test]
fn statistics() {
    let statistics = Statistics {
        accepted: 1,
        rejected: 2,
        too_coarse: 3,
        field: 4,
        guards: 5,
        resteps: 6,
        isolations: 7,
        switches: 8,
        grazings: 9,
    };
    let expected = r#"{"accepted":1,"rejected":2,"too_coarse":3,"field":4,"guards":5,"resteps":6,"isolations":7,"switches":8,"grazings":9}"#;
    assert_eq!(to_string(&statistics).expect("JSON"), expected);
}

#[test]
fn orders() {
    let errors: Vec<(f64, f64)> = (0..5).map(|i| 0.5_f64.powi(i)).map(|h| (h, h * h)).collect();
    let order = fit_order(&errors, 4.0).expect("a range");
    let [slope, deviation, drift] = [order.order, order.standard_error, order.drift];
    let [coarsest, finest] = [order.coarsest, order.finest];
    let expected = format!(
        r#"{{"order":{slope:?},"standard_error":{deviation:?},"drift":{drift:?},"coarsest":{coarsest:?},"finest":{finest:?},"points":5}}"#
    );
    assert_eq!(to_string(&order).expect("JSON"), expected);
}

#[test]
fn outcomes_and_touches() {
    let outcomes = [Outcome::EndedByGuard { guard: 2 }, Outcome::ReachedEnd];
    let expected = r#"[{"ended_by_guard":{"guard":2}},"reached_end"]"#;
    assert_eq!(to_string(&outcomes).expect("JSON"), expected);
    let grazing = Grazing { s: 0.5, mode: "slip", guard: 1, margin: -0.25 };
    let expected = r#"{"s":0.5,"mode":"slip","guard":1,"margin":-0.25}"#;
    assert_eq!(to_string(&grazing).expect("JSON"), expected);
}
