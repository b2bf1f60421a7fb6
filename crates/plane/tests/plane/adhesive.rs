//! Atlases of laws with adhesion.

use stickslip_model::{Collider, Law, presets};
use stickslip_plane::CollisionPlane;
use stickslip_plane::atlas::Frame;
use stickslip_solver::Dopri5;

use crate::windows::{frame, traced};

fn adhesive(name: &str, pull_off: f64, [damping, tangential_damping]: [f64; 2]) -> Frame {
    let law = Law { pull_off, ..presets::find(name).unwrap().law };
    Frame { law, damping, tangential_damping, ..frame((1.2, 4.0), (0.4, 1.5)) }
}

/// The pair that has no part in the atlas finds the itineraries of its regions.
#[test]
fn contacts_with_adhesion_are_divided() {
    let mut random = fastrand::Rng::with_seed(55);
    for (name, pull_off, dampings) in [
        ("granular/dmt/viscoelastic/mindlin", 0.1, [0.3, 0.5]),
        ("granular/jkr/viscoelastic/linear_history", 0.05, [0.2, 0.0]),
    ] {
        let atlas = traced(adhesive(name, pull_off, dampings));
        assert!(atlas.report.agrees, "{name}: {:?}", atlas.objection());
        assert!(atlas.regions.curves().len() > 1, "{name}");
        let mut compared = 0;
        for _ in 0..300 {
            let [kappa, psi] = [(1.2, 4.0), (0.4, 1.5)].map(|(low, high)| {
                let part: f64 = random.f64();
                low + (high - low) * part
            });
            let Ok(region) = atlas.locate([kappa, psi]).region else { continue };
            let contact = atlas.plane.contact_at([kappa, psi]).unwrap();
            let found = Collider::new(Dopri5).collide(contact).unwrap();
            assert_eq!(atlas.itinerary(region), found.itinerary(), "{name}: {kappa}, {psi}");
            compared += 1;
        }
        assert!(compared > 290, "{compared}");
    }
}

/// Without damping and almost without pull-off, Derjaguin, Muller and Toporov's contact is one of
/// Hertz, which has equations of its own. What happens at the end, where Hertz' limit vanishes,
/// moves with the root of the pull-off.
#[test]
fn a_weak_pull_off_moves_boundaries_by_little() {
    const PULL_OFF: f64 = 1e-8;
    let weak = traced(adhesive("granular/dmt/viscoelastic/mindlin", PULL_OFF, [0.0; 2]));
    let hertz = presets::find("granular/hertz/viscoelastic/mindlin").unwrap().law;
    let window = frame((1.2, 4.0), (0.4, 1.5));
    let without = traced(Frame { law: hertz, ..window });
    for kappa in [1.5, 2.5, 3.8] {
        let [found, expected] = [&weak, &without].map(|atlas| atlas.boundaries_at(kappa));
        assert!(!expected.is_empty());
        for psi in &expected {
            let near = found.iter().any(|other| (other - psi).abs() < 3.0 * PULL_OFF.sqrt());
            assert!(near, "{kappa}: {found:?}, {expected:?}");
        }
    }
}

#[test]
fn bodies_that_stay_together_are_refused() {
    let law = presets::find("granular/jkr/viscoelastic/linear_history").unwrap().law;
    let plane = CollisionPlane::new((1.0, 2.0), (0.5, 1.0), 1.0).unwrap();
    let error = plane.with_law(Law { pull_off: 1.0, ..law }, 0.0).unwrap_err().to_string();
    assert!(error.contains("stay together") && error.contains("less damping"), "{error}");
}
