//! The JSON of results: names and order of fields, and values.

use serde_json::{Value, json, to_value};
use stickslip_solver::method::fit_order;
use stickslip_solver::{Grazing, Outcome, Statistics};

/// The names of the fields of an object, in order.
fn names(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

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
        enclosures: 8,
        switches: 9,
        grazings: 10,
    };
    let value = to_value(statistics).expect("JSON");
    let expected = [
        "accepted",
        "rejected",
        "too_coarse",
        "field",
        "guards",
        "resteps",
        "isolations",
        "enclosures",
        "switches",
        "grazings",
    ];
    assert_eq!(names(&value), expected);
    for (number, name) in (1..).zip(expected) {
        assert_eq!(value[name], json!(number), "{name}");
    }
}

#[test]
fn orders() {
    let errors: Vec<(f64, f64)> = (0..5).map(|i| 0.5_f64.powi(i)).map(|h| (h, h * h)).collect();
    let order = fit_order(&errors, 4.0).expect("a range");
    let value = to_value(order).expect("JSON");
    let expected = ["order", "standard_error", "drift", "coarsest", "finest", "points"];
    assert_eq!(names(&value), expected);
    assert_eq!(value["order"], json!(order.order));
    assert_eq!(value["points"], json!(5));
}

#[test]
fn outcomes_and_touches() {
    let outcomes = [Outcome::EndedByGuard { guard: 2 }, Outcome::ReachedEnd];
    let value = to_value(outcomes).expect("JSON");
    assert_eq!(value, json!([{ "ended_by_guard": { "guard": 2 } }, "reached_end"]));
    let grazing = Grazing { s: 0.5, mode: "slip", guard: 1, margin: -0.25 };
    let value = to_value(grazing).expect("JSON");
    assert_eq!(names(&value), ["s", "mode", "guard", "margin"]);
    assert_eq!(value, json!({ "s": 0.5, "mode": "slip", "guard": 1, "margin": -0.25 }));
}
