//! The collisions that are timed and counted.

use stickslip::model::Contact;

/// The 200 collisions of tests/data/undamped_random.json.
pub fn contacts() -> Vec<Contact> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/undamped_random.json");
    let text = std::fs::read_to_string(path).expect("the reference file");
    let file: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let number = |value: &serde_json::Value| value.as_str().and_then(|text| text.parse().ok());
    file["cases"]
        .as_array()
        .expect("cases")
        .iter()
        .filter_map(|case| Contact::new(number(&case["kappa"])?, number(&case["psi"])?, 0.0).ok())
        .collect()
}
