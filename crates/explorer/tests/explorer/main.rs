//! The interface as a page uses it.

use serde_json::{Value, json};

use stickslip_explorer::course_stride;
use stickslip_explorer::state::State;

fn ask(state: &mut State, request: &Value) -> Value {
    let request = request.to_string();
    state.fill(request.as_bytes());
    state.call();
    serde_json::from_str(&state.text).expect("an answer")
}

fn scene(law: &str) -> Value {
    json!({
        "do": "scene",
        "scene": {
            "kind": "spheres", "axes": "kappa-psi", "law": law, "damping": 0.0,
            "tangential_damping": 0.0, "mu": 0.4, "alpha": 0.2857142857142857,
            "x": { "low": 5.0, "high": 20.0, "log": true },
            "y": { "low": 0.2, "high": 2.5, "log": false },
        },
    })
}

#[test]
fn a_collision_its_course_a_map_and_an_atlas() {
    let mut state = State::default();
    assert_eq!(state.map([4, 4], 0..4), 0);
    assert_eq!(ask(&mut state, &scene("paper"))["fields"][0], "eps_t");
    let found = ask(&mut state, &json!({ "do": "collision", "x": 63.0, "y": 0.5 }));
    assert_eq!(found["itinerary"], "+o-o+o-");
    assert!((found["eps_t"].as_f64().expect("a number") + 0.04165220748).abs() < 1e-10);
    assert_eq!(state.course([63.0, 0.5], 100), 107);
    assert_eq!(state.map([6, 5], 1..5), 24);
    assert_eq!((state.values.len(), state.codes.len()), (4 * 24, 24));
    let atlas = ask(&mut state, &json!({ "do": "atlas" }));
    assert_eq!(atlas["agrees"], true, "{}", atlas["objection"]);
    assert_eq!(atlas["regions"].as_array().map(Vec::len), Some(7));
}

#[test]
fn bodies_that_adhere_may_stay_together() {
    let mut state = State::default();
    let mut adhere = scene("granular/dmt/viscoelastic/mindlin");
    adhere["scene"]["pull_off"] = json!(0.5);
    assert_eq!(ask(&mut state, &adhere)["fields"][0], "eps_t");
    // Coulomb's limit is the elastic force and twice the pull-off.
    assert!(state.course([10.0, 1.0], 50) > 50);
    for moment in state.numbers.chunks(course_stride()) {
        assert!((moment[8] - moment[3] - 1.0).abs() < 1e-9, "{moment:?}");
    }
    adhere["scene"]["damping"] = json!(2.0);
    ask(&mut state, &adhere);
    let found = ask(&mut state, &json!({ "do": "collision", "x": 10.0, "y": 1.0 }));
    assert_eq!((&found["adheres"], &found["eps_t"]), (&json!(true), &Value::Null));
    assert_eq!(state.course([10.0, 1.0], 50), 0);
    assert!(state.text.contains("stay together"), "{}", state.text);
    assert_eq!(state.map([1, 1], 0..1), 1);
    assert!(state.values[0].is_nan() && state.counts[0] < 100);
}

#[test]
fn mistakes_are_answers() {
    let mut state = State::default();
    assert!(ask(&mut state, &json!({ "do": "atlas" }))["error"].is_string());
    assert!(ask(&mut state, &json!({ "do": "nothing" }))["error"].is_string());
    assert!(ask(&mut state, &scene("no such law"))["error"].is_string());
    ask(&mut state, &scene("paper"));
    assert!(
        ask(&mut state, &json!({ "do": "collision", "x": -1.0, "y": 1.0 }))["error"].is_string()
    );
    assert_eq!(state.course([-1.0, 1.0], 10), 0);
    assert!(!state.text.is_empty());
    let wrong = ask(&mut state, &json!({ "do": "parse", "text": "state x = 1\nx' = y" }));
    assert_eq!((&wrong["line"], &wrong["column"]), (&json!(2), &json!(6)));
}

#[test]
fn the_points_of_the_paper_are_sixteen_intervals() {
    let mut state = State::default();
    let line = ask(&mut state, &json!({ "do": "line", "kappa": 63.0, "highest": 20.0 / 7.0 }));
    let counts: Vec<usize> = line
        .as_array()
        .expect("intervals")
        .iter()
        .map(|it| it["itinerary"].as_str().expect("an itinerary").len() - 1)
        .collect();
    assert_eq!(counts, [0, 2, 4, 6, 8, 6, 8, 6, 4, 6, 4, 2, 4, 2, 4, 2]);
}

#[test]
fn a_system_runs_and_has_an_atlas() {
    let text = include_str!("../../../../examples/systems/ball.slip");
    let mut state = State::default();
    let parsed = ask(&mut state, &json!({ "do": "parse", "text": text }));
    assert_eq!(parsed["parameters"][0]["range"], json!([1.0, 20.0]));
    let run = ask(&mut state, &json!({ "do": "run", "text": text, "set": { "e": 0.25 } }));
    assert!((run["events"][0]["time"].as_f64().expect("a time") - 1.0).abs() < 1e-12);
    let scene = json!({
        "kind": "system", "text": text, "across": "e", "up": "g", "most_events": 6,
        "x": { "low": 0.3, "high": 0.7, "log": false },
        "y": { "low": 5.0, "high": 15.0, "log": false },
    });
    ask(&mut state, &json!({ "do": "scene", "scene": scene }));
    let atlas = ask(&mut state, &json!({ "do": "atlas" }));
    assert_eq!(atlas["agrees"], true, "{}", atlas["objection"]);
    assert_eq!(state.map([3, 3], 0..3), 9);
    let codes: Vec<u64> = atlas["regions"]
        .as_array()
        .expect("regions")
        .iter()
        .filter_map(|it| it["code"].as_u64())
        .collect();
    assert!(state.codes.iter().all(|code| codes.contains(&u64::from(*code))));
}
