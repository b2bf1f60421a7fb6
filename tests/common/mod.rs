//! Reference collisions, read from tests/data. Several packages share this file.

use std::path::Path;

use serde_json::Value;
use stickslip_model::{Collision, Contact};

/// A reference collision.
pub struct Case {
    /// The parameters.
    pub contact: Contact,
    /// The results, as in the file.
    pub expected: Value,
}

impl Case {
    /// A number among the results, which the file has as a decimal string.
    pub fn number(&self, key: &str) -> f64 {
        number(&self.expected[key])
    }

    /// The switches, as in the file.
    pub fn switches(&self) -> &[Value] {
        self.expected["switches"].as_array().expect("an array of switches")
    }

    /// Whether all switches of `collision` have the regimes and sides of the reference.
    pub fn same_itinerary(&self, collision: &Collision) -> bool {
        self.switches().len() == collision.switches.len()
            && self.switches().iter().zip(&collision.switches).all(|(expected, switch)| {
                expected["to"] == switch.to.to_string()
                    && expected["side"].as_f64() == Some(switch.side.sign())
            })
    }
}

/// A number of a reference file, from its decimal string.
pub fn number(value: &Value) -> f64 {
    value.as_str().expect("a decimal string").parse().expect("a number")
}

/// A reference file, from `tests/data` of the package or of the workspace around it.
pub fn file(name: &str) -> Value {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let file = folders
        .map(|folder| folder.join(format!("tests/data/{name}.json")))
        .find(|file| file.is_file())
        .expect("a reference file");
    let text = std::fs::read_to_string(file).expect("a text");
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
