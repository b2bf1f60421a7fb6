//! The collisions that are timed and counted.

use stickslip::model::Contact;

/// The 200 collisions of tests/data/undamped_random.json, with the damping 0.1.
#[must_use]
pub fn damped() -> Vec<Contact> {
    with_damping(|_| 0.1)
}

/// The same, each with a damping of its own from 0.01 to 1.
#[must_use]
pub fn damped_differently() -> Vec<Contact> {
    with_damping(|index| 10_f64.powf(-2.0 + 0.01 * index as f64))
}

fn with_damping(damping: impl Fn(usize) -> f64) -> Vec<Contact> {
    let contacts = contacts().into_iter().enumerate();
    contacts
        .filter_map(|(index, contact)| {
            Contact::new(contact.kappa(), contact.psi(), damping(index)).ok()
        })
        .collect()
}

/// The 200 collisions of tests/data/undamped_random.json.
///
/// # Panics
/// The file is missing, or has no list of cases.
#[must_use]
pub fn contacts() -> Vec<Contact> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/undamped_random.json");
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
