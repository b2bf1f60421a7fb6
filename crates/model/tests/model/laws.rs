//! Contact laws of particle codes, against LAMMPS.

use serde_json::Value;
use stickslip_model::{Contact, Damping, End, Engine, HistoryOf, Law, Normal, Tangential};

use crate::common::file;

/// α of a homogeneous sphere.
const ALPHA: f64 = 2.0 / 7.0;

/// The contact of a case, whose scaled units are those of this crate but for α and μ.
fn contact(case: &Value) -> Contact {
    let scaled = &case["scaled"];
    let number = |name: &str| scaled[name].as_f64().unwrap();
    let text = |name: &str| scaled[name].as_str().unwrap();
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
        limit_damping: scaled["limit"].as_bool().unwrap(),
        end: End::Overlap,
    };
    let psi = number("g0") * ALPHA / number("mu");
    Contact::new(number("kappa") / ALPHA, psi, damping)
        .and_then(|contact| contact.with_law(law, number("xt") / ALPHA))
        .unwrap()
}

#[test]
fn collisions_are_those_of_lammps() {
    let reference = file("lammps_laws");
    let mut errors = Vec::new();
    for case in reference["cases"].as_array().unwrap() {
        let contact = contact(case);
        let number = |name: &str| case[name].as_f64().unwrap();
        let name = case["law"].as_str().unwrap();
        let (collision, _) = match Engine::Auto.collide(contact) {
            Ok(found) => found,
            Err(error) => {
                println!("ERR {name}: {error} {contact:?}");
                continue;
            }
        };
        let error = (collision.eps_t() + number("eps_t")).abs();
        let normal = (collision.eps_n - number("eps_n")).abs();
        println!(
            "{error:.2e} {:.2e} {normal:.2e} {name} {} k {:.3} psi {:.3} a {:.3} b {:.3}",
            number("eps_t_error"),
            collision.itinerary(),
            contact.kappa(),
            contact.psi(),
            contact.damping(),
            contact.tangential_damping()
        );
        errors.push((error, number("eps_t_error"), normal, name.to_owned()));
    }
    assert_eq!(errors.len(), 264);
}
