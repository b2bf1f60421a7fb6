//! Collisions of LAMMPS, from `lammps_laws.json` and `lammps_adhesion.json`. Several packages share
//! this file.

use serde_json::Value;
use stickslip_model::{Contact, ContactEnd, Damping, HistoryOf, Law, Normal, Tangential};

/// α of a homogeneous sphere.
const ALPHA: f64 = 2.0 / 7.0;

/// The contact of a case, whose scaled units are those of the model but for α and μ.
pub fn contact(case: &Value) -> Contact {
    let scaled = &case["scaled"];
    let number = |name: &str| scaled[name].as_f64().expect("a number");
    let text = |name: &str| scaled[name].as_str().expect("a text");
    let (damping, tangential) = (number("cn"), text("tang"));
    let law = Law {
        normal: if text("normal") == "hooke" { Normal::Linear } else { Normal::Hertz },
        damping: match text("damp") {
            "const" => Damping::Linear,
            "sqrtx" => Damping::Viscoelastic,
            "quarter" => Damping::Tsuji,
            other => panic!("{other}"),
        },
        tangential: if tangential == "lin" { Tangential::Constant } else { Tangential::Mindlin },
        history: if tangential.ends_with("force") {
            HistoryOf::Force
        } else {
            HistoryOf::Displacement
        },
        rescaled: tangential.contains("rescale"),
        limit_damping: scaled["limit"].as_bool().expect("yes or no"),
        end: ContactEnd::Overlap,
        ..Law::PAPER
    };
    let psi = number("g0") * ALPHA / number("mu");
    Contact::new(number("kappa") / ALPHA, psi, damping)
        .and_then(|contact| contact.with_law(law, number("xt") / ALPHA))
        .expect("valid parameters")
}

/// The contact of a case of `adhesive_contacts.json` or `lammps_adhesion.json`.
pub fn adhesive_contact(case: &Value) -> Contact {
    let number = |name: &str| case[name].as_f64().expect("a value");
    let jkr = case["normal"] == "jkr";
    let law = Law {
        normal: if jkr { Normal::Jkr } else { Normal::Dmt },
        damping: if case["eta"] == "linear" { Damping::Linear } else { Damping::Viscoelastic },
        tangential: match case["tangential"].as_str().expect("a value") {
            "mindlin" => Tangential::Mindlin,
            _ => Tangential::Constant,
        },
        history: match case["history"].as_str().expect("a value") {
            "displacement" => HistoryOf::Displacement,
            "force" => HistoryOf::Force,
            _ => HistoryOf::None,
        },
        rescaled: case["rescaled"] == true,
        end: if jkr && case["end"] == "force" { ContactEnd::Force } else { ContactEnd::Overlap },
        pull_off: number("pull_off"),
        ..Law::PAPER
    };
    Contact::new(number("kappa"), number("psi"), number("damping"))
        .and_then(|contact| contact.with_law(law, number("tangential_damping")))
        .expect("valid parameters")
}
