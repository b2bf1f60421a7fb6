//! Linear contacts.

use stickslip_model::{
    Collider, Collision, Contact, Damping, End, Engine, HistoryOf, Law, Normal, Tangential, linear,
};

fn laws() -> Vec<Law> {
    let law = Law {
        normal: Normal::Linear,
        damping: Damping::Linear,
        tangential: Tangential::Constant,
        history: HistoryOf::Displacement,
        rescaled: false,
        limit_damping: false,
        end: End::Overlap,
    };
    vec![law, Law { limit_damping: true, ..law }, Law { end: End::Force, ..law }]
}

#[test]
fn explore() {
    for law in laws() {
        println!("{law:?}");
        for a in [0.0, 1e-6, 0.5, 1.0, 1.5, 2.0, 4.0, 100.0] {
            for kappa in [0.01, 0.25, 1.0, 2.0, 4.0, 9.0, 10.0, 100.0, 400.0] {
                for psi in [1e-3, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0] {
                    for b in [0.0, 0.5, 1.0, 2.0, 4.0] {
                        if a == 0.0 && b > 0.0 { continue; }
                        let Ok(contact) = Contact::new(kappa, psi, a).and_then(|c| c.with_law(law, b)) else { continue };
                        let one = linear::collide(contact);
                        let other = Collider::default().collide(contact);
                        match (one, other) {
                            (Ok(one), Ok(other)) => {
                                let d = (one.eps_t() - other.eps_t()).abs();
                                if one.itinerary() != other.itinerary() || d > 3e-11 || one.reversals != other.reversals {
                                    println!("κ {kappa} ψ {psi} a {a} b {b}: {} {} Δ {d:.1e} rev {} {}", one.itinerary(), other.itinerary(), one.reversals, other.reversals);
                                }
                            }
                            (one, other) => println!("κ {kappa} ψ {psi} a {a} b {b}: {:?} {:?}", one.map(|c| c.itinerary()), other.map(|c| c.itinerary())),
                        }
                    }
                }
            }
        }
    }
}
