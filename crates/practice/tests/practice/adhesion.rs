//! Time steps of contacts with adhesion.

use serde_json::Value;
use stickslip_model::{Contact, ContactEnd, Law, Reduction, presets};
use stickslip_plane::progress;
use stickslip_practice::time_steps::{
    self, Scheme, Status, SteppedQuantity, Stepping, TimeStepSettings, TimeStepsError, step,
    undamped_contact_time,
};

use crate::lammps::adhesive_contact;
use crate::time_steps::run;

const JKR: &str = "granular/jkr/viscoelastic/mindlin";
const DMT: &str = "granular/dmt/mass_velocity/mindlin";

/// The contact of a law of LAMMPS with κ, ψ, damping and pull-off force.
fn contact(name: &str, [kappa, psi, damping, pull_off]: [f64; 4]) -> Contact {
    let law = Law { pull_off, ..presets::find(name).expect("a law").law };
    let contact = Contact::new(kappa, psi, damping).expect("parameters");
    contact.with_law(law, 0.5).expect("parameters")
}

/// Collisions of LAMMPS itself, in as many steps, with normals that turn.
#[test]
fn steps_with_adhesion_are_those_of_lammps() {
    let text = include_str!("../../../../tests/data/lammps_adhesion.json");
    let reference: Value = serde_json::from_str(text).expect("JSON");
    let reduction = Reduction { mu: 0.3, alpha: 2.0 / 7.0 };
    let mut count = 0;
    for case in reference["cases"].as_array().expect("cases") {
        let contact = adhesive_contact(case);
        let of = |name: &str, scheme| {
            let results = case[name].as_object().into_iter().flatten();
            results.map(move |(steps, expected)| (scheme, steps, expected))
        };
        let synchronized = of("synchronized", Scheme::SynchronizedVerlet);
        for (scheme, steps, expected) in of("in_steps", Scheme::Lammps).chain(synchronized) {
            let stepping = Stepping { scheme, overlap: 0.01, reduction };
            let steps: f64 = steps.parse().expect("a number");
            let dt = undamped_contact_time(contact.law()) / steps;
            let found = step(&contact, dt, 0.5, &stepping, 10.0).expect("an end");
            let [eps_n, eps_t] = [0, 1].map(|it| expected[it].as_f64().expect("a number"));
            let off = (found.eps_n - eps_n).abs().max((found.eps_t - eps_t).abs());
            // Synchronized dashpots differ by the order of the square of a step's turn.
            let dashed = scheme != Scheme::Lammps && contact.tangential_damping() > 0.0;
            let most = if dashed { 1e-6 } else { 1e-10 };
            assert!(off < most, "{scheme:?} {steps} {off:e} {case}");
            count += 1;
        }
    }
    assert_eq!(count, 432 + 369);
}

/// Where the overlap ends is no end of LAMMPS, but of the literature.
#[test]
fn errors_fall_as_the_step_does_with_adhesion() {
    let ends = [(JKR, ContactEnd::Force), (JKR, ContactEnd::Overlap), (DMT, ContactEnd::Overlap)];
    for (name, end) in ends {
        for parameters in [[4.0, 0.7, 0.1, 0.2], [18.0, 0.3, 0.0, 0.01], [0.5, 2.0, 0.3, 0.1]] {
            let contact = contact(name, parameters);
            let law = Law { end, ..contact.law() };
            let result = run(vec![contact.with_law(law, 0.5).expect("a law")], &[1e2, 1e3, 1e5]);
            for row in &result.rows {
                assert_eq!(row.status, Status::Ok, "{name} {end:?} {parameters:?} {row:?}");
                for quantity in SteppedQuantity::ALL {
                    let worst = row.errors(quantity).expect("errors").worst.error;
                    let most = 30.0 / row.steps_per_contact;
                    assert!(worst < most, "{name} {end:?} {parameters:?} {quantity:?} {row:?}");
                }
            }
        }
    }
}

/// Bodies that stay together have no restitution to compare with, and steps that hold bodies which
/// separate have no end.
#[test]
fn steps_that_hold_bodies_together_are_unfinished() {
    let refused = |contact| {
        let settings = TimeStepSettings { contacts: vec![contact], ..TimeStepSettings::default() };
        time_steps::run(&settings, progress::SILENT)
    };
    // JKR without damping holds what is slower than its pull-off: 0.2456 (16 F/9)^(5/3) = 1.
    let border = 9.0 / 16.0 * (1.0_f64 / 0.245_6).powf(0.6);
    let error = refused(contact(JKR, [18.0, 0.6, 0.0, 1.01 * border])).expect_err("a refusal");
    assert!(matches!(error, TimeStepsError::Contact(_)), "{error}");
    assert!(error.to_string().contains("the bodies stay together, held by adhesion"), "{error}");
    let result = run(vec![contact(JKR, [18.0, 0.6, 0.0, 0.99 * border])], &[4.0, 1e4]);
    let statuses: Vec<Status> = result.rows.iter().map(|row| row.status).collect();
    assert_eq!(statuses, [Status::Unfinished, Status::Ok]);
    assert!(result.rows[0].unfinished > 0 && result.rows[0].eps_n.is_none());
}
