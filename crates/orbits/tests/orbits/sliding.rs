//! Grazing–sliding of a block on a belt, x″ + cx′ + x = A cos ωt + F while x′ < v_b.

use std::f64::consts::TAU;

use stickslip_expression::System;
use stickslip_orbits::{BranchOptions, Guess, Orbit, Orbits, SpecialKind};

use crate::branches::values;

const TEXT: &str = include_str!("../../../../examples/orbits/sticking.slip");

#[test]
fn a_block_begins_to_stick() {
    let orbits = Orbits::new(&System::parse(TEXT).expect("a system")).expect("orbits");
    let (w, c): (f64, f64) = (1.4, 0.1);
    let size = (1.0 - w * w).hypot(c * w);
    let grazes = size / w;
    let parameters = orbits.system().values();
    let guess = Guess { itinerary: &["phase"], ..Guess::default() };
    let orbit = orbits.find(&parameters, &guess).expect("an orbit");
    let multipliers = orbit.multipliers.clone().expect("no graze");
    let determinant = multipliers[0][0] * multipliers[1][0] - multipliers[0][1] * multipliers[1][1];
    assert!((determinant - (-c * TAU / w).exp()).abs() < 1e-9, "{multipliers:?}");
    assert!(orbit.is_admissible());
    let branch = orbits.branch(&orbit, 0, [0.1, 1.2], &BranchOptions::default()).expect("it");
    let found = values(&branch, SpecialKind::GrazingSliding);
    assert!((found[0] - grazes).abs() < 1e-10, "{found:?} {grazes}");
    // The graze over the frequency.
    let special = branch.specials.iter().find(|it| it.kind == SpecialKind::GrazingSliding);
    let window = [[1.1, 2.0], [0.1, 2.0]];
    let options = BranchOptions::default();
    let curve = orbits.curve(special.expect("a graze"), [1, 0], window, &options).expect("it");
    assert!(curve.points.len() > 20 && curve.objection.is_none(), "{:?}", curve.objection);
    for orbit in &curve.points {
        let [a, w] = [orbit.parameters[0], orbit.parameters[1]];
        assert!((a - (1.0 - w * w).hypot(c * w) / w).abs() < 1e-12, "{a} {w}");
    }

    // Behind it the orbit sticks for a while: one multiplier is 0, the other tends to H₁₁. It is a
    // power series of the time in which the block sticks, hence of √(a − a_gs).
    let at = |a: f64| {
        let parameters = [a, w, c, 0.4, 1.0];
        orbits.settled(&parameters, &Guess::default(), 400.0).expect("an orbit")
    };
    let roots: Vec<f64> = (0..8).map(|round| 0.01 * 0.5_f64.powi(round)).collect();
    let sticking = roots.iter().map(|root| {
        let orbit = at(grazes * (1.0 + root * root));
        assert_eq!(orbit.segments.len(), 3);
        assert!(orbit.is_admissible(), "{:?}", orbit.verdict);
        let multipliers = orbit.multipliers.expect("no graze");
        assert_eq!(multipliers[1], [0.0, 0.0]);
        multipliers[0][0]
    });
    let mut limits: Vec<f64> = sticking.collect();
    for apart in 1..limits.len() {
        for k in (apart..limits.len()).rev() {
            let ratio = roots[k - apart] / roots[k];
            limits[k] += (limits[k] - limits[k - 1]) / (ratio - 1.0);
        }
    }
    let (rate, time) = ((1.0 - c * c / 4.0).sqrt(), TAU / w);
    let h11 =
        (-c * time / 2.0).exp() * ((rate * time).cos() + c * (rate * time).sin() / (2.0 * rate));
    assert!((limits[7] - h11).abs() < 1e-9, "{limits:?} {h11}");
    // Far behind it the branch goes on: the orbit that sticks is followed by the system.
    let orbit = at(0.8);
    let branch = orbits.branch(&orbit, 0, [0.7, 1.2], &BranchOptions::default()).expect("it");
    assert!(
        branch
            .points
            .iter()
            .all(|it| it.multipliers.as_ref().is_some_and(|all| all[1] == [0.0; 2]))
    );
    assert!(branch.points.iter().any(Orbit::is_admissible));
}
