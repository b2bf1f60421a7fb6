//! κ, ψ and a as 24 bytes, with the checks of `tests/checks/collision.rs`.

#![no_main]

#[path = "../../tests/checks/collision.rs"]
mod checks;

use libfuzzer_sys::fuzz_target;
use stickslip::model::Contact;

fuzz_target!(|bits: [u64; 3]| {
    let [kappa, psi, damping] = bits.map(f64::from_bits);
    // Collisions of the stiffest springs take seconds.
    if (1e5..1e17).contains(&kappa) {
        return;
    }
    let Ok(contact) = Contact::new(kappa, psi, damping) else { return };
    if let Err(reason) = checks::every_engine(contact) {
        panic!("{reason}");
    }
});
