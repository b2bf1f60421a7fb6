//! Reference collisions read from tests/data.

use serde_json::Value;
use stickslip::model::{Collision, Contact};

/// A reference collision.
pub struct Case {
    /// Its parameters.
    pub contact: Contact,
    /// Its results.
    pub expected: Value,
}

impl Case {
    /// A number of the results, given as a decimal string.
    pub fn number(&self, key: &str) -> f64 {
        number(&self.expected[key])
    }

    /// The reference switches.
    pub fn switches(&self) -> &[Value] {
        self.expected["switches"].as_array().expect("an array of switches")
    }

    /// Whether regimes and sides of all switches agree.
    pub fn same_itinerary(&self, collision: &Collision) -> bool {
        self.switches().len() == collision.switches.len()
            && self.switches().iter().zip(&collision.switches).all(|(expected, switch)| {
                expected["to"] == switch.to.to_string()
                    && expected["side"].as_f64() == Some(switch.side.sign())
            })
    }
}

/// A number of a reference file.
pub fn number(value: &Value) -> f64 {
    value.as_str().expect("a decimal string").parse().expect("a number")
}

/// A reference file.
pub fn file(name: &str) -> Value {
    let path = format!("{}/tests/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a reference file");
    serde_json::from_str(&text).expect("JSON")
}

/// The cases of a reference file.
pub fn cases(name: &str) -> Vec<Case> {
    let file = file(name);
    let cases = file["cases"].as_array().expect("an array of cases");
    cases
        .iter()
        .map(|case| {
            let damping = case.get("damping").map_or(0.0, number);
            let contact = Contact::new(number(&case["kappa"]), number(&case["psi"]), damping);
            Case { contact: contact.expect("valid parameters"), expected: case.clone() }
        })
        .collect()
}
